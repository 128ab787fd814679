//! A glTF model as plain data: nodes, meshes, materials, textures, cameras, lights.

mod accessor;
mod animation;
mod appearance;
mod deform;
mod flat;
mod import;
mod material;
mod mesh;
mod primitive;
mod scene;

pub use animation::{Animation, Channel, Curve, Track};
pub use appearance::{AlphaMode, Appearance, Details, Levels, Sampler, ScaledTexture, TextureUse, Wrap};
pub use import::{EXPORT_AGAIN, Imported, MAX_FILE_BYTES, import, load};
pub use mesh::{Influences, Mesh, Morph, MorphTarget, Primitive, Skin};
pub use scene::{Camera, Image, Light, LightKind, Model, Node};
