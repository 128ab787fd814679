//! The blow detector: scores on labelled recordings, and what must hold for any microphone.

mod dataset;
mod train;
