//! Articulated scenes as files: the same figure for this engine and for any other, and one way to measure both.
//!
//! A scene is bodies, joints in tree order and couplings, in SI units ([`format`](mod@format)). It becomes a figure
//! (`figure.rs`), is run ([`run`]), and is judged by numbers that come from the file and the poses alone
//! ([`measure`]), never from the engine. Scenes can be made as well as read ([`make`]), so that figures nobody tuned
//! for go the same way.

mod figure;
pub mod format;
pub mod linear;
pub mod make;
pub mod measure;
pub mod run;

pub use format::{Body, Coupling, FORMAT, Joint, JointKind, Meta, Scene, SceneError};
pub use measure::{Observer, Report, State};
pub use run::{Engine, Limits, Row, Soffio};
