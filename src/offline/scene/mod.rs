//! Scenes as files: the same bodies, joints and contacts for this engine and for any other, and one way to measure both.
//!
//! A scene is bodies, joints, couplings and shapes, in SI units ([`format`](mod@format)). It becomes a figure
//! (`figure.rs`), is run ([`run`]), and is judged by numbers that come from the file and the poses alone
//! ([`measure`], [`contact`]), never from the engine. Scenes can be made as well as read ([`make`]), so that figures nobody tuned
//! for go the same way.

pub mod contact;
mod figure;
pub mod format;
pub mod linear;
pub mod make;
pub mod measure;
mod pendulum;
mod row;
pub mod run;
pub mod solid;
pub mod times;
mod valid;

pub use format::{Body, Coupling, FORMAT, Joint, JointKind, Meta, OLD_FORMAT, Scene, SceneError};
pub use measure::{Observer, Report, State};
pub use row::Row;
pub use run::{Engine, Limits, Soffio};
pub use solid::{Solid, SolidAxis, Static, Surface};
