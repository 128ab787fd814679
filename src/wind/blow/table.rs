//! The trained model: written by `soffio breath train`, not by hand.
use super::model::{Model, PARAMETERS};
use super::features::COUNT;

/// The trained model.
pub static TRAINED: Model = Model { scale: [[0.0, 1.0]; COUNT], weights: [0.0; PARAMETERS] };
