//! Shapes: triangle meshes and their mass, convex cores, their distance and overlap, rays against moving triangles.
//!
//! It turns drawn triangles into what mechanics needs: mass, centre and inertia of solids, sheets and wires; distance and
//! overlap of convex shapes; the first triangle on a ray.
//!
//! It never moves anything, and it knows no forces, files, clocks or devices. The same input gives the same bits.
//!
//! | module or type | holds |
//! |---|---|
//! | [`TriangleMesh`] | corners (m) and triangles; area, volume, closedness, bounds |
//! | [`Moments`] | mass (kg), first and second moments, summed from solids, sheets and wires |
//! | [`bodies`] | [`bodies::MassProperties`] and [`bodies::RigidBody`], the state of one body |
//! | [`support`], [`convex`], [`penetration`] | convex cores, their closest points, and the depth of an overlap |
//! | [`hull`] | convex hulls of point sets |
//! | [`rays`] | rays against rigid meshes that move, by bounding volume hierarchies |
//!
//! ```
//! use soffio_geometry::TriangleMesh;
//! use soffio_math::DVec3;
//!
//! // A tetrahedron with three edges of 1 m along the axes, filled with water.
//! let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
//! let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let mesh = TriangleMesh { positions, triangles };
//! assert!(mesh.is_closed());
//! let moments = mesh.solid_moments(1000.0);
//! assert!((moments.mass - 1000.0 / 6.0).abs() < 1e-9);
//! assert!(moments.center().distance(DVec3::splat(0.25)) < 1e-12);
//! ```

pub mod bodies;
mod boxes;
pub mod convex;
pub mod hull;
pub mod mass;
pub mod mesh;
pub mod penetration;
pub mod rays;
pub mod support;

pub use mass::Moments;
pub use mesh::{Extents, TriangleMesh};
