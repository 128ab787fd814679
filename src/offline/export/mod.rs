//! A run, or a model of it, for other programs: glTF with key frames, RenderMan scenes, a MuJoCo model.

pub mod key_frames;
pub mod mjcf;
#[cfg(feature = "pictures")]
pub mod rib;
pub mod scenery;
mod thin;
mod tube;
