//! Shapes: triangle meshes and their mass, convex cores, their distance and overlap, rays against moving triangles.

pub mod bodies;
pub mod convex;
pub mod hull;
pub mod mass;
pub mod mesh;
pub mod penetration;
pub mod rays;
pub mod support;

pub use mass::Moments;
pub use mesh::{Extents, TriangleMesh};
