//! Rigid bodies with exact joints.
//!
//! Two ways to move the same articulation: constrained dynamics ([`dynamics`]), which solves the equations of motion with
//! Lagrange multipliers, and position-based motion ([`procedural`]), which follows hands and targets within a fixed budget.
//! Joints stay closed to rounding. Contacts, friction, gears, clutches, springs, limits and keyed drives are part of both.
//!
//! It never reads a clock, a file or a device: time is the length of the step that the caller passes. It knows no exhibits,
//! no wind and no sound; external forces come in, and impacts come out. The same input gives the same bits in debug and
//! release builds, at any instruction set.
//!
//! | module | holds |
//! |---|---|
//! | [`articulation`] | constraints, limits and springs; their Jacobian rows; sparse and dense solvers |
//! | [`collision`] | convex colliders with rounding, contact manifolds, swept tests |
//! | [`dynamics`] | [`dynamics::Dynamics`]: integration, contacts, impacts, sleep |
//! | [`procedural`] | [`procedural::Procedural`]: position-based motion |
//!
//! A pendulum in ten seconds keeps its energy:
//!
//! ```
//! use soffio_geometry::bodies::{MassProperties, RigidBody};
//! use soffio_math::{DMat3, DVec3, Pose};
//! use soffio_multibody::articulation::{Anchor, Constraint, ConstraintKind};
//! use soffio_multibody::dynamics::forces::Damping;
//! use soffio_multibody::dynamics::{Dynamics, Articulation, Integrator, Settings, Solver};
//!
//! // A ball of 1 kg, one metre beside the point of the world that it hangs from.
//! let ball = MassProperties { mass: 1.0, center: DVec3::ZERO, inertia: DMat3::from_diagonal(DVec3::splat(1e-3)) };
//! let bodies = vec![RigidBody::at_rest(ball, Pose { position: DVec3::X, ..Pose::IDENTITY })];
//! let (a, b) = (Anchor { body: Some(0), point: DVec3::NEG_X }, Anchor { body: None, point: DVec3::ZERO });
//! let constraints = [Constraint::new("hook", ConstraintKind::PointToPoint { a, b })];
//! let figure = Articulation {
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
//! let mut dynamics = Dynamics::new(figure, settings);
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
