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
mod answers;
mod build;
mod clutches;
mod contacts;
mod course;
mod drive;
mod effort;
mod equations;
mod faults;
pub mod forces;
pub mod impulse;
mod integrate;
mod limits;
mod loads;
mod moved;
mod pace;
mod passes;
mod settings;
mod sleep;
mod step;
mod told;
mod waking;

pub use contacts::{
    Contacts, ENDS, Impact, ImpactKind, Met, Resistance, Strike, Struck, SurfacePair, Touching, couple_rows, strike,
};
pub use drive::{Drive, Instant, Motion};
pub use moved::Moved;
pub use settings::{Figure, Integrator, Settings, Solver};
pub use step::Dynamics;
