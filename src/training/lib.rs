//! Training and scoring of the breath detector.
//!
//! This is a developer's tool, `soffio-training`, and not part of the kiosk. It takes synthetic scenes (`soffio-soundscape`) or
//! labelled recordings, trains the two small networks of `soffio-detector`, and writes their weights as Rust source. It scores
//! detectors with 95 % bounds.
//!
//! It never replaces a shipped table: a developer does so by hand, after scoring the new one. It opens no device. The same seed
//! trains the same table, bit for bit, on any number of threads.
//!
//! | module | holds |
//! |---|---|
//! | [`recordings`] | a folder of labelled WAVs: `labels.csv` and its columns |
//! | [`pipeline`] | training, cross-validation and the validation set; groups never lie in both |
//! | [`descent`] | stochastic gradient descent with a fixed order of operations |
//! | [`score`] | score of the detector on a take; shares, rates and latencies |
//! | [`tables`] | networks as Rust source, and back |
//! | [`commands`] | the command line |
//!
//! ```
//! use soffio_detector::BlowSettings;
//! use soffio_soundscape::FIRST_VALIDATION_SEED;
//! use soffio_soundscape::scenes::{Condition, Hearing, Scenario};
//! use soffio_training::score::{Scores, score_take};
//!
//! let hearing = Hearing { gain_db: 0.0, stereo: false };
//! let take = Scenario::new(FIRST_VALIDATION_SEED + 1).take(Condition::Cell(0.1, 0.0, false), 0, hearing);
//! let score = score_take(&BlowSettings::default(), &take);
//! assert_eq!(score.breaths.len(), take.breaths.len());
//! let mut scores = Scores::default();
//! scores.add(&take, &score);
//! assert_eq!(scores.detected.1, take.breaths.len());
//! ```

pub mod commands;
pub mod descent;
pub mod pipeline;
pub mod recordings;
pub mod score;
pub mod tables;
