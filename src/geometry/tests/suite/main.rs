//! Geometry: rays against moving meshes, measured against every triangle.

mod rays;
