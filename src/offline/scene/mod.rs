//! Physics scenes as files: the same bodies, joints and contacts for this engine and for others, with the same
//! measures.
//!
//! A scene consists of bodies, joints, couplings and shapes, in SI units ([`format`](mod@format)). It is converted to a
//! mechanism (`mechanism.rs`), simulated ([`run`]), and measured ([`measure`], [`contact`]) from the file and the poses
//! alone. Scenes can also be generated ([`make`]), so that mechanisms are tested for which nothing was tuned.

pub mod contact;
pub mod format;
pub mod linear;
pub mod make;
pub mod measure;
mod mechanism;
mod pendulum;
mod record;
pub mod run;
pub mod shape;
pub mod times;
mod validate;

pub use format::{FORMAT, JointKind, Meta, OLD_FORMAT, PhysicsScene, SceneBody, SceneCoupling, SceneError, SceneJoint};
pub use measure::{BodyState, Observer, Report};
pub use record::BenchRecord;
pub use run::{Engine, Limits, Soffio};
pub use shape::{ContactSurface, SceneShape, ShapeAxis, StaticShape};
