//! The same pipeline without a window: WAV in; WAV, pictures, traces and events out.

pub mod feed;
pub mod wav;
