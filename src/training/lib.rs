//! Trains the breath detector and scores it.

pub mod commands;
pub mod course;
pub mod descent;
pub mod recordings;
pub mod score;
pub mod tables;
