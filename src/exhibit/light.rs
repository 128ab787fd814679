//! The gallery's light on an exhibit: which side the key lamp is on, how bright the wall is, how strong the fill lamp.

/// The lamps of the gallery, as a curator sets them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightRig {
    /// Side of the key lamp as the visitor sees it.
    pub side: Side,
    /// Radiance of the wall behind the exhibit, where white is 1.
    pub wall: f64,
    /// Intensity of the key lamp by that of the fill lamp.
    pub key_to_fill: f64,
}

/// A side, as the visitor sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// On the left: light from there looks natural to those who write from left to right.
    #[default]
    Left,
    /// On the right.
    Right,
}

impl LightRig {
    /// A wall of two fifths of white, on which white paint is the brightest thing in the picture, and a ratio of 4 : 1, usual for
    /// sculpture: forms are modelled, and shadows stay readable.
    pub const DEFAULT: Self = Self { side: Side::Left, wall: 0.435, key_to_fill: 4.0 };
    /// Allowed radiance of the wall: darker, black wires vanish; brighter, white paint does.
    pub const WALL: [f64; 2] = [0.1, 0.8];
    /// Allowed ratio of the lamps.
    pub const KEY_TO_FILL: [f64; 2] = [1.0, 20.0];
}
