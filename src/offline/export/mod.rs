//! Export of a run or a model to other programs: glTF animation, RenderMan scenes, MuJoCo models.

pub mod export_model;
pub mod key_frames;
mod key_reduction;
pub mod mjcf;
#[cfg(feature = "pictures")]
pub mod rib;
mod tube;
