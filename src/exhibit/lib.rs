//! Exhibits: a glTF model and a sidecar, loaded, validated and resolved into one immutable value.
//!
//! Invariant: a value of type [`Exhibit`] is valid. Every index is in range, every mass is positive, and every joint
//! connects existing bodies. The simulation does not check again.
//!
//! The crate reads exhibit folders only. It reports all problems at once, each with file, line and remedy. An
//! [`Exhibit`] never changes: a changed folder is loaded as a new one.
//!
//! | module or type | holds |
//! |---|---|
//! | [`Exhibit`] | bodies, constraints, colliders, wind surfaces, instruments, labels, camera |
//! | [`load`], [`ids`], [`resolve()`] | read a folder; list the exhibits that can be found; find one |
//! | [`Report`], [`Diagnostic`], [`codes`] | problems: what is wrong, where, and what to do |
//! | [`files`], [`budget`], [`thumbnail`] | how files are opened, and what an exhibit may cost |
//! | [`sidecar`] | the tables of `exhibit.toml`, from which the JSON Schema is made |
//! | [`model`] | the glTF model: meshes, materials, nodes, animations, cameras |
//! | [`finish`] | wood, metal, paint: maps, and how they are laid on meshes |
//! | [`renamed`] | old names of keys, for reading, the schema and `soffio check --fix` |
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

pub mod animated_scale;
mod behavior;
mod bodies;
pub mod budget;
pub mod chart;
pub mod clock;
pub mod codes;
pub mod diagnostic;
mod exhibit;
pub mod files;
pub mod finish;
pub mod fit;
pub mod labels;
mod light;
pub mod materials;
pub mod model;
pub mod own_timbres;
mod pairs;
pub mod paths;
mod presentation;
pub mod printable;
pub mod quantity;
pub mod renamed;
mod resolve;
pub mod schema;
pub mod shape_tracks;
pub mod sidecar;
pub mod signal;
mod source;
pub mod thumbnail;
pub mod view;

pub use behavior::{
    AirAt, BreathTuning, Follows, ForceOf, IdleDampingSpec, ImpactFrame, Motion, SoundBinding, SoundTrigger,
    TouchPermission,
};
pub use bodies::{Body, Cord, Material, MaterialPair, Wire};
pub use budget::Budget;
pub use diagnostic::{Diagnostic, Location, Report, Severity};
pub use exhibit::{Exhibit, Origin};
pub use light::{LightRig, Side};
pub use model::Model;
pub use paths::{SIDECAR, exhibits_folder, ids, resolve};
pub use presentation::{Attract, AttractAction, AttractStep, Credit, Label, Labels};
pub use resolve::{load, load_model, load_within};
pub use view::{OrbitLimits, View};
