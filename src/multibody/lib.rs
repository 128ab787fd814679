//! Rigid-body dynamics with exact joints, contacts and friction.
//!
//! There are two solvers for the same articulation. Constrained dynamics ([`dynamics`]) solves the equations of motion with Lagrange
//! multipliers. Position-based motion ([`procedural`]) follows pointer grabs and targets within a fixed budget. Joints stay closed to
//! rounding. Both have contacts, friction, gears, clutches, springs, limits and kinematic bodies.
//!
//! The crate reads no clock, file or device: the caller passes the length of each step. It takes external forces and returns
//! impacts, and knows nothing of exhibits, wind and sound. The same input gives the same bits in debug and release builds, with
//! any instruction set.
//!
//! | module | contents |
//! |---|---|
//! | [`articulation`] | constraints, limits and springs; their Jacobian rows; sparse and dense solvers |
//! | [`collision`] | convex colliders with rounding, contact manifolds, swept tests |
//! | [`dynamics`] | [`dynamics::Dynamics`]: integration, contacts, impacts, sleep |
//! | [`procedural`] | [`procedural::Procedural`]: position-based motion |
//!
//! A pendulum keeps its energy for ten seconds:
//!
//! ```
//! use soffio_geometry::bodies::{MassProperties, RigidBody};
//! use soffio_math::{DMat3, DVec3, Pose};
//! use soffio_multibody::articulation::{Anchor, Constraint, ConstraintKind};
//! use soffio_multibody::dynamics::forces::Damping;
//! use soffio_multibody::dynamics::{Articulation, Dynamics, Integrator, Settings, Solver};
//!
//! // A ball of 1 kg, one metre beside the point of the world that it hangs from.
//! let ball = MassProperties { mass: 1.0, center: DVec3::ZERO, inertia: DMat3::from_diagonal(DVec3::splat(1e-3)) };
//! let bodies = vec![RigidBody::at_rest(ball, Pose { position: DVec3::X, ..Pose::IDENTITY })];
//! let (a, b) = (Anchor { body: Some(0), point: DVec3::NEG_X }, Anchor { body: None, point: DVec3::ZERO });
//! let constraints = [Constraint::new("hook", ConstraintKind::PointToPoint { a, b })];
//! let articulation = Articulation {
//!     bodies,
//!     damping: vec![Damping::default()],
//!     constraints: &constraints,
//!     limits: &[],
//!     springs: &[],
//!     kinematic_bodies: &[],
//!     colliders: &[],
//!     pairs: Vec::new(),
//! };
//! let settings = Settings {
//!     gravity: 9.81 * DVec3::NEG_Y,
//!     friction: false,
//!     stabilization_time: 0.04,
//!     integrator: Integrator::Auto,
//!     solver: Solver::Sparse,
//! };
//! let mut dynamics = Dynamics::new(articulation, settings);
//! let before = dynamics.energy();
//! for _ in 0..2400 {
//!     dynamics.step(1.0 / 240.0, &[[0.0; 6]], &mut Vec::new());
//! }
//! assert!(dynamics.joint_error() < 1e-9, "metres");
//! assert!((dynamics.energy() - before).abs() < 1e-3 * 9.81, "of the 9.81 J between top and bottom");
//! ```
//!
//! `cargo run -p soffio-multibody --example double_pendulum` prints how well a chaotic double pendulum keeps its energy.

pub mod articulation;
pub mod collision;
pub mod dynamics;
pub mod procedural;
