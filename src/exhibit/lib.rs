//! An exhibit: glTF model plus constraint sidecar, loaded, checked and resolved into one immutable value.
//!
//! Invariant: a value of type [`Exhibit`] is valid. Every index in it is in range, every mass is positive, every
//! joint connects what it names; the simulation checks nothing again.

mod behavior;
mod bodies;
pub mod clock;
pub mod codes;
pub mod diagnostic;
mod exhibit;
pub mod fit;
pub mod growth;
pub mod labels;
pub mod materials;
pub mod model;
mod pairs;
pub mod paths;
mod presentation;
pub mod quantity;
mod resolve;
pub mod shape;
pub mod shapes;
pub mod sidecar;
mod source;
pub mod view;

pub use behavior::{BreathTuning, Calm, Motion, SoundBinding, SoundTrigger, Touch};
pub use bodies::{Body, Material, MaterialPair, Wire};
pub use diagnostic::{Diagnostic, Location, Report, Severity};
pub use exhibit::{Exhibit, Origin};
pub use model::Model;
pub use paths::{SIDECAR, ids, resolve, shelf};
pub use presentation::{Attract, AttractAction, AttractStep, Credit, Label, Labels};
pub use resolve::{load, plain};
pub use view::{Leeway, View};
