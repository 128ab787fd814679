//! Constrained dynamics: Lagrange multipliers, integration, pivot friction, contact and impacts.
//!
//! A step integrates the constrained equations of motion by a method of fourth order: Adams–Bashforth–Moulton where motion is
//! smooth, else Runge–Kutta. Projection then closes the joints, substeps end at impacts, and pivot friction acts.
//!
//! Symbols as in `articulation`: C constraint value, J its Jacobian, λ multipliers. Accelerations solve
//!
//! ```text
//! M a − Jᵀ λ = F        J a = −J̇ẋ − ω₀² C − 2 ω₀ Ċ
//! ```
//!
//! The last two terms are Baumgarte's stabilisation (1972), critically damped. They close the joints of a scattered articulation
//! and vanish once it is closed; from then on projection keeps the joints closed to rounding.

mod adams;
mod build;
mod clutches;
mod contacts;
mod effective_inverse_mass;
mod equations;
pub mod forces;
pub mod impact_law;
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
