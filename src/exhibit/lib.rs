//! An exhibit: glTF model plus constraint sidecar, loaded, checked and resolved into one immutable value.
//!
//! Invariant: a value of type [`Exhibit`] is valid. Every index in it is in range, every mass is positive, every
//! joint connects what it names; the simulation checks nothing again.
//!
//! It reads files (an exhibit folder is all it reads), and reports everything that is wrong with them at once, each with file,
//! line and remedy. It never moves, draws or plays anything, and what it has built never changes: a changed folder becomes a
//! new [`Exhibit`].
//!
//! | module or type | holds |
//! |---|---|
//! | [`Exhibit`] | bodies, constraints, colliders, wind surfaces, instruments, labels, camera |
//! | [`load`], [`ids`], [`resolve()`] | reads a folder; lists the exhibits that can be found; finds one |
//! | [`Report`], [`Diagnostic`], [`codes`] | what is wrong, where, and what to do |
//! | [`sidecar`] | the tables of `exhibit.toml`, from which the JSON Schema is made |
//! | [`model`] | the glTF model: meshes, materials, nodes, animations, cameras |
//! | [`labels`] | label texts by language, and as a table for translators |
//!
//! ```
//! use std::path::Path;
//!
//! let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../exhibits/pendulum");
//! let pendulum = soffio_exhibit::load(&folder).expect("a shipped exhibit");
//! assert!(pendulum.bodies.iter().any(|body| body.name == "Pendulum"));
//! assert!(pendulum.warnings.is_empty());
//!
//! let report = soffio_exhibit::load(Path::new("no/such/folder")).expect_err("there is nothing");
//! assert!(!report.to_string().is_empty(), "it says what was looked for");
//! ```

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
