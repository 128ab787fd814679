//! Shapes: triangle meshes and their mass, convex cores and their distance, rays against moving triangles.

pub mod convex;
pub mod mesh;
pub mod rays;

pub use mesh::TriangleMesh;
