//! Motion by the laws: Lagrange multipliers, integration, friction of pivots, impacts.
//!
//! One step is: integrate the constrained equations of motion by a method of fourth order (Adams' where motion is smooth, else
//! Runge–Kutta's), close what the joints drifted apart (projection), stop at each impact on the way, and let pivot friction act.
//!
//! Symbols as in `articulation`: C constraint value, J its Jacobian, λ multipliers. Accelerations solve
//!
//! ```text
//! M a − Jᵀ λ = F        J a = −J̇ẋ − ω₀² C − 2 ω₀ Ċ
//! ```
//!
//! The last two terms (Baumgarte 1972, critically damped) draw a scattered figure together and vanish once it is;
//! from then on projection keeps the joints closed to rounding.

mod adams;
mod build;
mod clutches;
mod contacts;
mod effective_inverse_mass;
mod equations;
pub mod forces;
pub mod impulse;
mod integrate;
mod joint_loads;
mod kinematic;
mod lane_kernels;
mod limits;
mod position_step;
mod queries;
mod recovery;
mod settings;
mod sleep;
mod step;
mod step_size_controller;
mod substep_state;
mod waking;
mod work_budget;

pub use contacts::{
    ContactReport, Contacts, Impact, ImpactKind, MAX_ROW_BODIES, PointImpact, PointImpactResult, RollingResistance,
    SurfacePair, SweptContact, resolve_point_impact, rolling_rows,
};
pub use kinematic::{KeyframeMotion, KinematicBody, KinematicState};
pub use position_step::PositionStep;
pub use settings::{Articulation, Integrator, Settings, Solver};
pub use step::Dynamics;
