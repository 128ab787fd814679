//! Finishes: what a piece is made of, as it is seen. Wood has rings and pores, brass is brushed or cast, paint has dust.
//!
//! A finish is a tile of a few decimetres, as three small maps (colour, roughness, normals) that multiply a material's own values.
//! Its maps are computed when the first model needs them, and kept. [`lay`] gives meshes texture coordinates in metres, so that a
//! ring of wood has its true size on every piece. What draws a model then sees ordinary textured glTF materials.
//!
//! | file | holds |
//! |---|---|
//! | `noise.rs` | periodic random fields |
//! | `wood.rs`, `metal.rs`, `paint.rs`, `fabric.rs` | the structure of each family of materials |
//! | `maps.rs` | from structure to maps with a known mean |
//! | `projection.rs` | texture coordinates for a mesh |
//! | `dress.rs` | which node gets which finish; its material |
//!
//! A finish is named by the sidecar (`finish = "oak"` of a body, part or material), or else by a glTF material's extras,
//! `{"soffio_finish": "oak"}`. Glass has none.

mod dress;
mod fabric;
mod maps;
mod metal;
mod noise;
mod paint;
mod projection;
#[cfg(test)]
mod tests;
mod wood;

use std::sync::OnceLock;

pub use dress::{Choice, dress};
pub use maps::Maps;
pub use projection::{Laid, Laying, lay};

use maps::{Structure, to_linear};

/// A finish.
#[derive(Debug)]
pub struct Finish {
    /// Name in files.
    pub name: &'static str,
    /// What it is, in one line.
    pub about: &'static str,
    /// Lengths of its tile along the grain (u) and across it (v), m.
    pub tile: [f64; 2],
    /// Its usual colour, sRGB; `None` where it takes every colour, as paint does.
    pub usual_color: Option<[u8; 3]>,
    /// Metalness.
    pub metallic: f32,
    /// Usual perceptual roughness.
    pub roughness: f32,
    /// Its maps, once they are made.
    made: OnceLock<Maps>,
    structure: fn() -> Structure,
    /// End grain, where it has a grain that ends.
    pub end: Option<EndGrain>,
}

/// End grain of a wood.
#[derive(Debug)]
pub struct EndGrain {
    made: OnceLock<Maps>,
    structure: fn() -> Structure,
}

impl EndGrain {
    /// Side of its tile, m.
    pub const TILE: f64 = 0.1;
    /// Brightness over that of a face along the grain: open pores take up more oil.
    pub const DARKER: f32 = 0.85;
    /// Roughness over that of a face.
    pub const ROUGHER: f32 = 1.2;

    /// Its maps.
    pub fn maps(&self) -> &Maps {
        self.made.get_or_init(|| Maps::of(&(self.structure)(), [Self::TILE; 2]))
    }
}

impl Finish {
    /// Its maps.
    pub fn maps(&self) -> &Maps {
        self.made.get_or_init(|| Maps::of(&(self.structure)(), self.tile))
    }

    /// Its usual colour, linear RGB.
    pub fn linear_color(&self) -> Option<[f32; 3]> {
        self.usual_color.map(|rgb| rgb.map(|code| to_linear(f64::from(code) / 255.0) as f32))
    }
}

/// The finish of this name.
pub fn named(name: &str) -> Option<&'static Finish> {
    FINISHES.iter().find(|finish| finish.name == name)
}

/// Names of all finishes.
pub fn names() -> impl Iterator<Item = &'static str> {
    FINISHES.iter().map(|finish| finish.name)
}

/// Tile of woods, m. Across it lie some twenty rings; along it the pattern does not yet repeat on a usual board.
const BOARD: [f64; 2] = [0.8, 0.25];
/// Tile of brushed metals, m: texels of 0.4 mm by 0.2 mm.
const BRUSHED: [f64; 2] = [0.2, 0.1];

/// A finish without a grain that ends. Arguments: name, description, tile, usual colour, metalness and roughness, structure.
const fn plain(
    name: &'static str,
    about: &'static str,
    tile: [f64; 2],
    usual_color: Option<[u8; 3]>,
    [metallic, roughness]: [f32; 2],
    structure: fn() -> Structure,
) -> Finish {
    Finish { name, about, tile, usual_color, metallic, roughness, made: OnceLock::new(), structure, end: None }
}

/// A wood. Arguments: name, description, usual colour, roughness, structure of faces and of end grain.
const fn wooden(
    name: &'static str,
    about: &'static str,
    color: [u8; 3],
    roughness: f32,
    [structure, end]: [fn() -> Structure; 2],
) -> Finish {
    Finish {
        name,
        about,
        tile: BOARD,
        usual_color: Some(color),
        metallic: 0.0,
        roughness,
        made: OnceLock::new(),
        structure,
        end: Some(EndGrain { made: OnceLock::new(), structure: end }),
    }
}

/// Every finish. The colours are those of photographs in daylight; that of a metal is its reflectance at normal incidence.
pub static FINISHES: [Finish; 21] = [
    wooden(
        "oak",
        "oiled oak: rings, dashes of pores",
        [178, 136, 88],
        0.5,
        [|| wood::OAK.face(11), || wood::OAK.end(12)],
    ),
    wooden(
        "beech",
        "oiled beech: even, with small rays",
        [203, 160, 118],
        0.5,
        [|| wood::BEECH.face(21), || wood::BEECH.end(22)],
    ),
    wooden(
        "walnut",
        "varnished walnut: dark, streaked",
        [105, 72, 50],
        0.42,
        [|| wood::WALNUT.face(31), || wood::WALNUT.end(32)],
    ),
    wooden(
        "pine",
        "varnished pine: strong rings",
        [214, 168, 108],
        0.48,
        [|| wood::PINE.face(41), || wood::PINE.end(42)],
    ),
    plain("brass-brushed", "brass with fine parallel scratches", BRUSHED, Some([228, 196, 128]), [1.0, 0.34], || {
        metal::brushed(51, metal::COPPERY)
    }),
    plain("brass-cast", "brass as it leaves the mould", [0.15; 2], Some([214, 178, 108]), [1.0, 0.4], || {
        metal::cast(52, metal::COPPERY, 4e-6)
    }),
    plain("brass-polished", "polished brass", [0.25; 2], Some([233, 200, 128]), [1.0, 0.2], || {
        metal::polished(53, metal::COPPERY)
    }),
    plain("steel-brushed", "steel with fine parallel scratches", BRUSHED, Some([186, 186, 188]), [1.0, 0.36], || {
        metal::brushed(54, metal::GREY)
    }),
    plain("steel-polished", "polished steel", [0.25; 2], Some([196, 197, 200]), [1.0, 0.2], || {
        metal::polished(55, metal::GREY)
    }),
    plain("iron-cast", "cast iron, dark and grainy", [0.15; 2], Some([78, 78, 80]), [0.9, 0.55], || {
        metal::cast(56, metal::GREY, 22e-6)
    }),
    plain("copper", "copper, polished some time ago", [0.25; 2], Some([234, 166, 132]), [1.0, 0.28], || {
        metal::polished(57, metal::COPPERY)
    }),
    plain(
        "aluminium-brushed",
        "aluminium with fine parallel scratches",
        BRUSHED,
        Some([216, 217, 219]),
        [1.0, 0.32],
        || metal::brushed(58, metal::GREY),
    ),
    plain("lead", "lead: dull, dented, scratched", [0.2; 2], Some([146, 148, 152]), [1.0, 0.55], || metal::lead(59)),
    plain("paint", "gloss paint, sprayed", [0.3; 2], None, [0.0, 0.4], || paint::sprayed(61)),
    plain("paint-matt", "matt paint, rolled", [0.25; 2], None, [0.0, 0.75], || paint::matt(62)),
    plain("paper", "drawing paper", [0.2; 2], Some([238, 234, 224]), [0.0, 0.85], || fabric::paper(71)),
    plain("felt", "wool felt", [0.12; 2], None, [0.0, 0.95], || fabric::felt(72)),
    plain("leather", "grained leather", [0.12; 2], Some([104, 66, 42]), [0.0, 0.55], || fabric::leather(73)),
    plain("cord", "laid cord of hemp", [0.024, 0.012], Some([190, 164, 120]), [0.0, 0.85], || fabric::cord(74)),
    plain("stone", "limestone, honed", [0.25; 2], Some([196, 188, 172]), [0.0, 0.7], || fabric::stone(75)),
    plain("bamboo", "bamboo with its nodes", [0.3, 0.06], Some([200, 172, 112]), [0.0, 0.45], || wood::bamboo(81)),
];
