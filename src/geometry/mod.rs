//! Shapes: triangle meshes and their mass, convex cores and their distance, rays against moving triangles.

pub mod mass;
pub mod mesh;

pub use mass::Moments;
pub use mesh::{Extents, TriangleMesh};
