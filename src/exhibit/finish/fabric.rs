//! Paper, felt, leather, cord and stone.
//!
//! - *Paper*: fibres of a millimetre or two, lying in clouds (the "formation" of papermakers), and a slight cockle.
//! - *Felt*: curls of wool. They are the ridges of a gradient noise, 1 − |n|, at two scales.
//! - *Leather*: pebbles between creases. The creases are the edges of random cells, where the second nearest point is as near as
//!   the nearest (Worley 1996).
//! - *Cord*: strands laid at an angle; the height is |sin| of the phase across them.
//! - *Stone*: a fine-grained limestone, with grains of one to two millimetres and darker specks.

use super::maps::Structure;
use super::noise::{Field, Marks, cellular, smooth_step};
use soffio_math::{PI, sin};

/// Follows its own hue.
const TINT: [f32; 3] = [1.0, 1.0, 1.0];
/// Yellow and brown fade first.
const WARM: [f32; 3] = [0.85, 1.0, 1.2];

/// Paper; its tile is about 0.2 m square.
pub fn paper(seed: u64) -> Structure {
    let formation = Field::fractal([36, 36], 3, seed);
    let tooth = Field::fractal([150, 150], 1, seed + 1);
    let cockle = Field::fractal([4, 4], 2, seed + 2);
    let fibre = Marks { count: 2600, length: [2.0, 7.0], width: [0.5, 0.9], depth: [0.1, 1.0] };
    let along = Field::marks(&fibre, seed + 3, |_, _, _| true);
    let across = Field::marks(&fibre, seed + 4, |_, _, _| true).transposed();
    Structure {
        brightness: Field::sum(&[(0.014, &formation), (0.010, &tooth), (-0.05, &along), (-0.05, &across)]),
        tint: WARM,
        roughness: Field::sum(&[(0.03, &formation), (0.02, &tooth)]),
        height: Field::sum(&[(4e-6, &tooth), (4e-6, &formation), (90e-6, &cockle)]),
    }
}

/// Felt; its tile is about 0.12 m square.
pub fn felt(seed: u64) -> Structure {
    let curls = |cells: usize, seed: u64| Field::gradient([cells, cells], seed).map(|n| -n.abs()).standardized();
    let wool = Field::sum(&[(0.6, &curls(70, seed)), (0.8, &curls(150, seed + 1))]).standardized();
    let clumps = Field::fractal([10, 10], 4, seed + 2);
    Structure {
        brightness: Field::sum(&[(0.075, &wool), (0.03, &clumps)]),
        tint: TINT,
        roughness: Field::sum(&[(0.02, &wool)]),
        height: Field::sum(&[(30e-6, &wool), (60e-6, &clumps)]),
    }
}

/// Leather; its tile is about 0.12 m square.
pub fn leather(seed: u64) -> Structure {
    let [nearest, second] = cellular([46, 46], seed);
    let pebbles = Field::sum(&[(1.0, &second), (-1.0, &nearest)]).map(|gap| smooth_step(0.0, 0.4, gap));
    let patches = Field::fractal([4, 4], 5, seed + 1);
    let grain = Field::fractal([120, 120], 2, seed + 2);
    let creases = pebbles.clone().map(|pebble| 1.0 - pebble);
    Structure {
        brightness: Field::sum(&[(-0.16, &creases), (0.06, &patches), (0.02, &grain)]),
        tint: WARM,
        roughness: Field::sum(&[(0.15, &creases), (0.08, &patches), (0.03, &grain)]),
        height: Field::sum(&[(70e-6, &pebbles), (80e-6, &patches), (2e-6, &grain)]),
    }
}

/// Laid cord; its tile is about 24 mm × 12 mm, u along the cord.
pub fn cord(seed: u64) -> Structure {
    /// Strands along a tile and across it.
    const STRANDS: [f64; 2] = [6.0, 3.0];
    let [along, across] = STRANDS;
    let strands = Field::of(|u, v| sin(PI * (along * f64::from(u) + across * f64::from(v))).abs() as f32);
    let grooves = strands.clone().map(|height| 1.0 - smooth_step(0.0, 0.6, height));
    let fibres = Field::streaks(40, seed);
    let patches = Field::fractal([3, 3], 4, seed + 1);
    Structure {
        brightness: Field::sum(&[(-0.35, &grooves), (0.07, &fibres), (0.05, &patches)]),
        tint: WARM,
        roughness: Field::sum(&[(0.04, &fibres)]),
        height: Field::sum(&[(250e-6, &strands), (6e-6, &fibres)]),
    }
}

/// Limestone; its tile is about 0.25 m square.
pub fn stone(seed: u64) -> Structure {
    let clouds = Field::fractal([5, 5], 6, seed);
    let [nearest, _] = cellular([150, 150], seed + 1);
    let grains = nearest.standardized();
    let dark = Field::marks(
        &Marks { count: 2400, length: [1.0, 4.0], width: [1.0, 4.0], depth: [0.1, 1.0] },
        seed + 2,
        |_, _, _| true,
    );
    Structure {
        brightness: Field::sum(&[(0.03, &clouds), (0.035, &grains), (-0.22, &dark)]),
        tint: WARM,
        roughness: Field::sum(&[(0.05, &clouds), (0.04, &grains)]),
        height: Field::sum(&[(12e-6, &grains), (120e-6, &clouds), (-60e-6, &dark)]),
    }
}
