//! Shapes: triangle meshes and their mass, convex cores and their distance, rays against moving triangles.

pub mod mesh;

pub use mesh::TriangleMesh;
