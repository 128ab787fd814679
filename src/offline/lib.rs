//! The same pipeline without a window: WAV in; WAV, pictures, traces and events out.
//!
//! It runs the simulation as fast as the machine allows, with a recorded breath or a script in place of a visitor, and writes
//! what comes of it. It also judges: loudness, comparison of solvers, and physics scenes against their formulas ([`scene`]).
//!
//! It never opens a device or a window. A file that it writes appears whole or not at all. With the feature `pictures` it
//! draws, which needs a GPU or software Vulkan.
//!
//! | module | holds |
//! |---|---|
//! | [`play`] | a run: inputs, outputs, and its summary |
//! | [`wav`], [`feed`] | recordings, and how they become a microphone |
//! | [`trace`], [`events`], [`soundtrack`] | poses as CSV, events as JSON lines, sound as WAV |
//! | [`export`] | baked glTF animation, MuJoCo models, RenderMan scenes |
//! | [`load`], [`budget`] | what must not slow an exhibit down: assembly, a hard breath, a fast hand; and whether it does |
//! | [`loudness`] | loudness and true peak of an exhibit |
//! | [`scene`] | physics scenes, their measures and their limits |
//!
//! ```
//! use std::path::Path;
//! use std::sync::Arc;
//! use std::sync::atomic::AtomicBool;
//!
//! use soffio_offline::feed::WavFeed;
//! use soffio_offline::play::{self, Play};
//! use soffio_offline::wav;
//!
//! let exhibits = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../exhibits");
//! let exhibit = Arc::new(soffio_exhibit::load(&exhibits.join("pendulum")).expect("a shipped exhibit"));
//! let breath = wav::read(exhibits.join("steel-fish/breaths/strong.wav")).expect("a shipped breath");
//! let breath = Some(WavFeed::from(&breath));
//! let run = Play { breath, seconds: 1.0, fps: 60, aspect: 16.0 / 9.0, ..Play::default() };
//! let summary = play::run(&exhibit, run, &AtomicBool::new(false), |_step| (), None).expect("a run");
//! assert_eq!((summary.steps, summary.faults), (240, 0));
//! assert!(summary.max_joint_error_m < 1e-6);
//! ```

pub mod audition;
pub mod budget;
pub mod compare;
pub mod demo;
pub mod events;
pub mod export;
pub mod feed;
pub mod frames;
pub mod load;
pub mod loudness;
#[cfg(feature = "pictures")]
pub mod pictures;
pub mod play;
pub mod scene;
pub mod sound_page;
pub mod soundtrack;
pub mod trace;
#[cfg(feature = "pictures")]
pub mod video;
pub mod wav;
pub mod whole_file;
pub mod whole_folder;
