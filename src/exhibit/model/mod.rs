//! A glTF model as plain data: nodes, meshes, materials, textures, cameras, lights.

mod accessor;
mod animation;
mod appearance;
mod check;
mod data;
mod deform;
mod fault;
mod flat;
mod glb;
mod import;
mod material;
mod mesh;
mod nodes;
mod primitive;
mod scene;
mod size;
mod sources;
#[cfg(test)]
mod tests;

pub use animation::{Animation, Channel, Curve, Track};
pub use appearance::{AlphaMode, Appearance, Details, Levels, Sampler, ScaledTexture, TextureUse, Wrap};
pub use import::{Imported, import, import_within, load};
pub use material::FINISH;
pub use mesh::{Influences, Mesh, Morph, MorphTarget, Primitive, Skin};
pub use scene::{Camera, Image, Light, LightKind, Model, Node};
pub use sources::MAX_FILE_BYTES;
