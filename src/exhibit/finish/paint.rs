//! Paint: sprayed gloss with orange peel, and matt paint from a roller.
//!
//! A sprayed film dries with waves of 2 to 5 mm ("orange peel"). Their slopes, some thousandths, break the edges of reflections and no
//! more. Its pigment is even to about a hundredth. A dent of the sheet below is a centimetre wide. Dust, finer than a pixel, lies on
//! it as paler points. Matt paint has the stipple of its roller, 1 to 2 mm.

use super::maps::Structure;
use super::noise::{Field, Marks};

/// Paint follows its own hue.
const TINT: [f32; 3] = [1.0, 1.0, 1.0];

/// Sprayed paint; its tile is about 0.3 m square.
pub fn sprayed(seed: u64) -> Structure {
    let peel = Field::fractal([80, 80], 2, seed);
    let clouds = Field::fractal([6, 6], 5, seed + 1);
    let fine = Field::fractal([110, 110], 2, seed + 2);
    let round = Marks { count: 7, length: [14.0, 34.0], width: [14.0, 34.0], depth: [0.2, 1.0] };
    let dents = Field::marks(&round, seed + 3, |_, _, _| true);
    let dust = Field::marks(
        &Marks { count: 900, length: [0.8, 2.4], width: [0.8, 2.0], depth: [0.1, 1.0] },
        seed + 4,
        |_, _, _| true,
    );
    Structure {
        brightness: Field::sum(&[(0.018, &clouds), (0.014, &fine), (0.07, &dust)]),
        tint: TINT,
        roughness: Field::sum(&[(0.05, &clouds), (0.05, &fine), (0.25, &dust)]),
        height: Field::sum(&[(3e-6, &peel), (-45e-6, &dents), (4e-6, &clouds)]),
    }
}

/// Matt paint; its tile is about 0.25 m square.
pub fn matt(seed: u64) -> Structure {
    let stipple = Field::fractal([110, 110], 2, seed);
    let clouds = Field::fractal([4, 6], 5, seed + 1);
    Structure {
        brightness: Field::sum(&[(0.02, &clouds), (0.018, &stipple)]),
        tint: TINT,
        roughness: Field::sum(&[(0.05, &clouds), (0.03, &stipple)]),
        height: Field::sum(&[(9e-6, &stipple), (8e-6, &clouds)]),
    }
}
