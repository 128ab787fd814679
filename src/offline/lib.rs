//! Offline runs: the live pipeline without a window. WAV in; WAV, pictures, traces and events out.
//!
//! The simulation runs as fast as the machine allows, with a recorded breath or a script in place of a visitor. The
//! crate also evaluates: loudness, comparison of motion modes, and physics scenes against their formulas ([`scene`]).
//!
//! It never opens a device or a window, and it writes files atomically. With the feature `pictures` it renders, which
//! needs a GPU or software Vulkan.
//!
//! | module | holds |
//! |---|---|
//! | [`play`] | a run: inputs, outputs, and its summary |
//! | [`wav`], [`feed`] | recordings, and their use as microphone input |
//! | [`trace`], [`events`], [`soundtrack`] | poses as CSV, events as JSON lines, sound as WAV |
//! | [`export`] | glTF animation, MuJoCo models, RenderMan scenes |
//! | [`load`], [`budget`] | stress loads (assembly, hard breath, fast drag), and the check that steps meet the deadline
//! |
//! | [`loudness`] | loudness and true peak of an exhibit |
//! | [`scene`] | physics scenes and their measures |
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

pub mod atomic_file;
pub mod atomic_folder;
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
pub mod venue_recordings;
#[cfg(feature = "pictures")]
pub mod video;
pub mod wav;
