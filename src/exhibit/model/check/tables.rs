//! The objects of glTF 2.0 as tables: each field's name, type, range, and whether it is required (the JSON Schema of the
//! standard, appendix B), and the extensions that are read or commonly met.

use std::f64::consts::{FRAC_PI_2, PI};

/// A kind of object: its name for extensions, and its fields. Other fields are left alone.
#[derive(Debug)]
pub struct Table {
    /// Such as "material".
    pub name: &'static str,
    /// Its fields.
    pub fields: &'static [Field],
}

/// A field of an object.
#[derive(Debug)]
pub struct Field {
    /// Name in the JSON.
    pub key: &'static str,
    /// What it holds.
    pub kind: Kind,
    /// Must it be there?
    pub required: bool,
    /// May a word or number that is not known be read as if it were not there?
    pub hint: bool,
}

/// What a field holds.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// Index of an entry of a top-level list.
    Index(&'static str),
    /// Several such indices, each once.
    Indices(&'static str),
    /// Indices of accessors by name.
    Accessors,
    /// A list of such tables.
    AccessorSets,
    /// A whole number of at least this.
    Whole(u64),
    /// A number.
    Number(Range),
    /// From so many to so many numbers.
    Numbers(usize, usize, Range),
    /// true or false.
    Flag,
    /// A text.
    Text,
    /// Texts.
    Texts,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// One of these numbers.
    Code(&'static [u64]),
    /// An object.
    Object(&'static Table),
    /// A list of objects.
    Objects(&'static Table),
}

/// Allowed numbers.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// Least.
    pub low: f64,
    /// Greatest.
    pub high: f64,
    /// Is the least itself left out?
    pub above: bool,
}

const ANY: Range = Range { low: f64::NEG_INFINITY, high: f64::INFINITY, above: false };
const NOT_NEGATIVE: Range = Range { low: 0.0, ..ANY };
const POSITIVE: Range = Range { low: 0.0, above: true, ..ANY };
const SHARE: Range = Range { low: 0.0, high: 1.0, above: false };

const fn must(key: &'static str, kind: Kind) -> Field {
    Field { key, kind, required: true, hint: false }
}

const fn may(key: &'static str, kind: Kind) -> Field {
    Field { key, kind, required: false, hint: false }
}

/// A field whose unknown values change little.
const fn hint(key: &'static str, kind: Kind) -> Field {
    Field { key, kind, required: false, hint: true }
}

const fn table(name: &'static str, fields: &'static [Field]) -> Table {
    Table { name, fields }
}

const NAME: Field = may("name", Kind::Text);

/// The document.
pub static ROOT: Table = table(
    "root",
    &[
        must("asset", Kind::Object(&ASSET)),
        may("extensionsUsed", Kind::Texts),
        may("extensionsRequired", Kind::Texts),
        may("buffers", Kind::Objects(&BUFFER)),
        may("bufferViews", Kind::Objects(&VIEW)),
        may("accessors", Kind::Objects(&ACCESSOR)),
        may("images", Kind::Objects(&IMAGE)),
        may("samplers", Kind::Objects(&SAMPLER)),
        may("textures", Kind::Objects(&TEXTURE)),
        may("materials", Kind::Objects(&MATERIAL)),
        may("meshes", Kind::Objects(&MESH)),
        may("cameras", Kind::Objects(&CAMERA)),
        may("nodes", Kind::Objects(&NODE)),
        may("skins", Kind::Objects(&SKIN)),
        may("scenes", Kind::Objects(&SCENE)),
        may("scene", Kind::Index("scenes")),
        may("animations", Kind::Objects(&ANIMATION)),
    ],
);

static ASSET: Table = table(
    "asset",
    &[
        must("version", Kind::Text),
        may("minVersion", Kind::Text),
        may("generator", Kind::Text),
        may("copyright", Kind::Text),
    ],
);

static BUFFER: Table = table("buffer", &[NAME, must("byteLength", Kind::Whole(1)), may("uri", Kind::Text)]);

static VIEW: Table = table(
    "bufferView",
    &[
        NAME,
        must("buffer", Kind::Index("buffers")),
        may("byteOffset", Kind::Whole(0)),
        must("byteLength", Kind::Whole(1)),
        may("byteStride", Kind::Whole(1)),
        hint("target", Kind::Code(&[34962, 34963])),
    ],
);

/// Numbers of an accessor's component types: signed and unsigned bytes and shorts, unsigned words, floats.
pub const COMPONENTS: &[u64] = &[5120, 5121, 5122, 5123, 5125, 5126];
/// Types of an accessor's elements.
pub const TYPES: &[&str] = &["SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"];

static ACCESSOR: Table = table(
    "accessor",
    &[
        NAME,
        may("bufferView", Kind::Index("bufferViews")),
        may("byteOffset", Kind::Whole(0)),
        must("componentType", Kind::Code(COMPONENTS)),
        may("normalized", Kind::Flag),
        must("count", Kind::Whole(1)),
        must("type", Kind::Choice(TYPES)),
        may("min", Kind::Numbers(1, 16, ANY)),
        may("max", Kind::Numbers(1, 16, ANY)),
        may("sparse", Kind::Object(&SPARSE)),
    ],
);

static SPARSE: Table = table(
    "sparse",
    &[
        must("count", Kind::Whole(1)),
        must("indices", Kind::Object(&SPARSE_INDICES)),
        must("values", Kind::Object(&SPARSE_VALUES)),
    ],
);

static SPARSE_INDICES: Table = table(
    "sparseIndices",
    &[
        must("bufferView", Kind::Index("bufferViews")),
        may("byteOffset", Kind::Whole(0)),
        must("componentType", Kind::Code(&[5121, 5123, 5125])),
    ],
);

static SPARSE_VALUES: Table =
    table("sparseValues", &[must("bufferView", Kind::Index("bufferViews")), may("byteOffset", Kind::Whole(0))]);

static IMAGE: Table = table(
    "image",
    &[NAME, may("uri", Kind::Text), may("mimeType", Kind::Text), may("bufferView", Kind::Index("bufferViews"))],
);

static SAMPLER: Table = table(
    "sampler",
    &[
        NAME,
        hint("magFilter", Kind::Code(&[9728, 9729])),
        hint("minFilter", Kind::Code(&[9728, 9729, 9984, 9985, 9986, 9987])),
        hint("wrapS", Kind::Code(&[33071, 33648, 10497])),
        hint("wrapT", Kind::Code(&[33071, 33648, 10497])),
    ],
);

static TEXTURE: Table =
    table("texture", &[NAME, may("sampler", Kind::Index("samplers")), may("source", Kind::Index("images"))]);

/// Reference to a texture; normal maps have a scale, occlusion maps a strength.
static INFO: Table = table(
    "textureInfo",
    &[
        must("index", Kind::Index("textures")),
        may("texCoord", Kind::Whole(0)),
        may("scale", Kind::Number(ANY)),
        may("strength", Kind::Number(SHARE)),
    ],
);

static MATERIAL: Table = table(
    "material",
    &[
        NAME,
        may("pbrMetallicRoughness", Kind::Object(&METALLIC_ROUGHNESS)),
        may("normalTexture", Kind::Object(&INFO)),
        may("occlusionTexture", Kind::Object(&INFO)),
        may("emissiveTexture", Kind::Object(&INFO)),
        may("emissiveFactor", Kind::Numbers(3, 3, SHARE)),
        hint("alphaMode", Kind::Choice(&["OPAQUE", "MASK", "BLEND"])),
        may("alphaCutoff", Kind::Number(NOT_NEGATIVE)),
        may("doubleSided", Kind::Flag),
    ],
);

static METALLIC_ROUGHNESS: Table = table(
    "pbrMetallicRoughness",
    &[
        may("baseColorFactor", Kind::Numbers(4, 4, SHARE)),
        may("baseColorTexture", Kind::Object(&INFO)),
        may("metallicFactor", Kind::Number(SHARE)),
        may("roughnessFactor", Kind::Number(SHARE)),
        may("metallicRoughnessTexture", Kind::Object(&INFO)),
    ],
);

static MESH: Table = table(
    "mesh",
    &[NAME, must("primitives", Kind::Objects(&PRIMITIVE)), may("weights", Kind::Numbers(1, usize::MAX, ANY))],
);

static PRIMITIVE: Table = table(
    "primitive",
    &[
        must("attributes", Kind::Accessors),
        may("indices", Kind::Index("accessors")),
        may("material", Kind::Index("materials")),
        may("mode", Kind::Code(&[0, 1, 2, 3, 4, 5, 6])),
        may("targets", Kind::AccessorSets),
    ],
);

static CAMERA: Table = table(
    "camera",
    &[
        NAME,
        must("type", Kind::Choice(&["perspective", "orthographic"])),
        may("perspective", Kind::Object(&PERSPECTIVE)),
        may("orthographic", Kind::Object(&ORTHOGRAPHIC)),
    ],
);

static PERSPECTIVE: Table = table(
    "perspective",
    &[
        must("yfov", Kind::Number(POSITIVE)),
        must("znear", Kind::Number(POSITIVE)),
        may("zfar", Kind::Number(POSITIVE)),
        may("aspectRatio", Kind::Number(POSITIVE)),
    ],
);

static ORTHOGRAPHIC: Table = table(
    "orthographic",
    &[
        must("xmag", Kind::Number(ANY)),
        must("ymag", Kind::Number(ANY)),
        must("zfar", Kind::Number(POSITIVE)),
        must("znear", Kind::Number(NOT_NEGATIVE)),
    ],
);

static NODE: Table = table(
    "node",
    &[
        NAME,
        may("camera", Kind::Index("cameras")),
        may("children", Kind::Indices("nodes")),
        may("skin", Kind::Index("skins")),
        may("mesh", Kind::Index("meshes")),
        may("matrix", Kind::Numbers(16, 16, ANY)),
        may("rotation", Kind::Numbers(4, 4, ANY)),
        may("scale", Kind::Numbers(3, 3, ANY)),
        may("translation", Kind::Numbers(3, 3, ANY)),
        may("weights", Kind::Numbers(1, usize::MAX, ANY)),
    ],
);

static SKIN: Table = table(
    "skin",
    &[
        NAME,
        may("inverseBindMatrices", Kind::Index("accessors")),
        may("skeleton", Kind::Index("nodes")),
        must("joints", Kind::Indices("nodes")),
    ],
);

static SCENE: Table = table("scene", &[NAME, may("nodes", Kind::Indices("nodes"))]);

/// What a channel of an animation moves.
pub const PATHS: &[&str] = &["translation", "rotation", "scale", "weights"];

static ANIMATION: Table = table(
    "animation",
    &[NAME, must("samplers", Kind::Objects(&ANIMATION_SAMPLER)), must("channels", Kind::Objects(&CHANNEL))],
);

static ANIMATION_SAMPLER: Table = table(
    "animationSampler",
    &[
        must("input", Kind::Index("accessors")),
        must("output", Kind::Index("accessors")),
        may("interpolation", Kind::Choice(&["LINEAR", "STEP", "CUBICSPLINE"])),
    ],
);

static CHANNEL: Table = table("channel", &[must("sampler", Kind::Whole(0)), must("target", Kind::Object(&TARGET))]);

static TARGET: Table = table("target", &[may("node", Kind::Index("nodes")), hint("path", Kind::Choice(PATHS))]);

/// Top-level list of the lights, which an extension holds.
pub const LIGHTS: &str = "lights";
/// The extension that holds them.
pub const PUNCTUAL: &str = "KHR_lights_punctual";

static LIGHT: Table = table(
    "light",
    &[
        NAME,
        must("type", Kind::Choice(&["directional", "point", "spot"])),
        may("color", Kind::Numbers(3, 3, SHARE)),
        may("intensity", Kind::Number(NOT_NEGATIVE)),
        may("range", Kind::Number(POSITIVE)),
        may("spot", Kind::Object(&SPOT)),
    ],
);

static SPOT: Table = table(
    "spot",
    &[
        may("innerConeAngle", Kind::Number(Range { low: 0.0, high: FRAC_PI_2, above: false })),
        may("outerConeAngle", Kind::Number(Range { low: 0.0, high: FRAC_PI_2 + 1e-6, above: true })),
    ],
);

macro_rules! extensions {
    ($($extension:literal in $owner:literal { $($field:expr),* $(,)? })*) => {
        /// Extensions: name, the object that they extend, and their own fields.
        pub static EXTENSIONS: &[(&str, &str, Table)] =
            &[$(($extension, $owner, Table { name: $extension, fields: &[$($field),*] })),*];
    };
}

extensions! {
    "KHR_lights_punctual" in "root" { must("lights", Kind::Objects(&LIGHT)) }
    "KHR_lights_punctual" in "node" { must("light", Kind::Index(LIGHTS)) }
    "KHR_node_visibility" in "node" { may("visible", Kind::Flag) }
    "KHR_texture_transform" in "textureInfo" {
        may("offset", Kind::Numbers(2, 2, ANY)),
        may("rotation", Kind::Number(ANY)),
        may("scale", Kind::Numbers(2, 2, ANY)),
        may("texCoord", Kind::Whole(0)),
    }
    "EXT_texture_webp" in "texture" { may("source", Kind::Index("images")) }
    "EXT_texture_avif" in "texture" { may("source", Kind::Index("images")) }
    "KHR_texture_basisu" in "texture" { may("source", Kind::Index("images")) }
    "KHR_animation_pointer" in "target" { must("pointer", Kind::Text) }
    "KHR_mesh_quantization" in "none" {}
    "KHR_materials_variants" in "root" { must("variants", Kind::Objects(&VARIANT)) }
    "KHR_materials_variants" in "primitive" { must("mappings", Kind::Objects(&MAPPING)) }
    "KHR_materials_unlit" in "material" {}
    "KHR_materials_anisotropy" in "material" {
        may("anisotropyStrength", Kind::Number(SHARE)),
        may("anisotropyRotation", Kind::Number(ANY)),
        may("anisotropyTexture", Kind::Object(&INFO)),
    }
    "KHR_materials_clearcoat" in "material" {
        may("clearcoatFactor", Kind::Number(SHARE)),
        may("clearcoatTexture", Kind::Object(&INFO)),
        may("clearcoatRoughnessFactor", Kind::Number(SHARE)),
        may("clearcoatRoughnessTexture", Kind::Object(&INFO)),
        may("clearcoatNormalTexture", Kind::Object(&INFO)),
    }
    "KHR_materials_dispersion" in "material" { may("dispersion", Kind::Number(NOT_NEGATIVE)) }
    "KHR_materials_emissive_strength" in "material" { may("emissiveStrength", Kind::Number(NOT_NEGATIVE)) }
    // 0 stands for an infinite index of refraction; the gap below 1 is checked with the materials.
    "KHR_materials_ior" in "material" { may("ior", Kind::Number(NOT_NEGATIVE)) }
    "KHR_materials_iridescence" in "material" {
        may("iridescenceFactor", Kind::Number(SHARE)),
        may("iridescenceTexture", Kind::Object(&INFO)),
        may("iridescenceIor", Kind::Number(Range { low: 1.0, ..ANY })),
        may("iridescenceThicknessMinimum", Kind::Number(NOT_NEGATIVE)),
        may("iridescenceThicknessMaximum", Kind::Number(NOT_NEGATIVE)),
        may("iridescenceThicknessTexture", Kind::Object(&INFO)),
    }
    "KHR_materials_pbrSpecularGlossiness" in "material" {
        may("diffuseFactor", Kind::Numbers(4, 4, SHARE)),
        may("diffuseTexture", Kind::Object(&INFO)),
        may("specularFactor", Kind::Numbers(3, 3, SHARE)),
        may("glossinessFactor", Kind::Number(SHARE)),
        may("specularGlossinessTexture", Kind::Object(&INFO)),
    }
    "KHR_materials_sheen" in "material" {
        may("sheenColorFactor", Kind::Numbers(3, 3, SHARE)),
        may("sheenColorTexture", Kind::Object(&INFO)),
        may("sheenRoughnessFactor", Kind::Number(SHARE)),
        may("sheenRoughnessTexture", Kind::Object(&INFO)),
    }
    "KHR_materials_specular" in "material" {
        may("specularFactor", Kind::Number(SHARE)),
        may("specularTexture", Kind::Object(&INFO)),
        may("specularColorFactor", Kind::Numbers(3, 3, NOT_NEGATIVE)),
        may("specularColorTexture", Kind::Object(&INFO)),
    }
    "KHR_materials_transmission" in "material" {
        may("transmissionFactor", Kind::Number(SHARE)),
        may("transmissionTexture", Kind::Object(&INFO)),
    }
    "KHR_materials_volume" in "material" {
        may("thicknessFactor", Kind::Number(NOT_NEGATIVE)),
        may("thicknessTexture", Kind::Object(&INFO)),
        may("attenuationDistance", Kind::Number(POSITIVE)),
        may("attenuationColor", Kind::Numbers(3, 3, SHARE)),
    }
}

static VARIANT: Table = table("variant", &[must("name", Kind::Text)]);

static MAPPING: Table =
    table("mapping", &[must("variants", Kind::Indices("variants")), must("material", Kind::Index("materials"))]);

/// A camera's field of view below which, and above π minus which, no picture can be made, rad.
pub const LEAST_FOV: f64 = 1e-3;
/// Largest field of view, rad.
pub const GREATEST_FOV: f64 = PI - 0.1;
