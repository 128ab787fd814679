//! Trains the breath detector and scores it.
//!
//! A developer's tool, `soffio-training`, which is not part of the kiosk. It makes scenes (`soffio-soundscape`) or reads
//! labelled recordings, trains the two small networks of `soffio-detector`, writes their tables as Rust source, and scores
//! them with 95 % bounds.
//!
//! It never changes a table by itself: a table that it wrote takes its place by hand, after it was scored. It reads no
//! device. The same seed trains the same table, bit for bit, on any number of threads.
//!
//! | module | holds |
//! |---|---|
//! | [`recordings`] | a folder of labelled WAVs: `labels.csv` and its columns |
//! | [`course`] | what is learnt from and what is scored; groups never lie in both |
//! | [`descent`] | stochastic gradient descent with a fixed order of operations |
//! | [`score`] | what the detector makes of a take; shares, rates and latencies |
//! | [`tables`] | networks as Rust source, and back |
//! | [`commands`] | the command line |
//!
//! ```
//! use soffio_detector::BlowSettings;
//! use soffio_soundscape::EXAM;
//! use soffio_soundscape::scenes::{Condition, Hearing, World};
//! use soffio_training::score::{Marks, judge};
//!
//! let hearing = Hearing { gain_db: 0.0, stereo: false };
//! let take = World::new(EXAM + 1).take(Condition::Cell(0.1, 0.0, false), 0, hearing);
//! let verdict = judge(&BlowSettings::default(), &take);
//! assert_eq!(verdict.answers.len(), take.breaths.len());
//! let mut marks = Marks::default();
//! marks.add(&take, &verdict);
//! assert_eq!(marks.heard.1, take.breaths.len());
//! ```

pub mod commands;
pub mod course;
pub mod descent;
pub mod recordings;
pub mod score;
pub mod tables;
