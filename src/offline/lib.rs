//! The same pipeline without a window: WAV in; WAV, pictures, traces and events out.

pub mod audition;
pub mod compare;
pub mod demo;
pub mod events;
pub mod export;
pub mod feed;
pub mod frames;
pub mod loudness;
#[cfg(feature = "pictures")]
pub mod pictures;
pub mod play;
pub mod programme;
pub mod scene;
pub mod sound_page;
pub mod soundtrack;
pub mod trace;
#[cfg(feature = "pictures")]
pub mod video;
pub mod wav;
pub mod whole_file;
pub mod whole_folder;
