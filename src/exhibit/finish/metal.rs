//! Metals: brushed, polished, cast, and lead.
//!
//! A metal shows its surroundings, so its structure is that of slopes and of roughness more than of colour:
//!
//! - *Brushed*: grooves along u, centimetres long. Across them slopes of some hundredths spread a reflection to a band.
//! - *Polished*: waves of some centimetres from forming and polishing, a few thousandths steep, which bend reflections; and traces
//!   of hands, which are duller.
//! - *Cast*: the skin of the sand, grains of one to three millimetres, and darker hollows.
//! - *Lead*: soft, so dented and scratched, under a patchy oxide.
//!
//! Slopes are stated as heights (m): a noise of wavelength λ and height h has slopes of about 2πh/λ. The amplitudes were set by eye
//! beside photographs.

use super::maps::Structure;
use super::noise::{Field, Marks};

/// Copper and its alloys darken to brown.
pub const COPPERY: [f32; 3] = [0.8, 1.0, 1.25];
/// Metals without a hue.
pub const GREY: [f32; 3] = [1.0; 3];

/// Brushed along u; its tile is about 0.2 m × 0.1 m.
pub fn brushed(seed: u64, tint: [f32; 3]) -> Structure {
    let long = Field::streaks(140, seed);
    let short = Field::streaks(36, seed + 1);
    let grooves = Field::sum(&[(0.75, &long), (0.65, &short)]).standardized();
    let patches = Field::fractal([3, 3], 4, seed + 2);
    let deep = Marks { count: 130, length: [20.0, 160.0], width: [0.6, 1.6], depth: [0.2, 1.0] };
    let scratches = Field::marks(&deep, seed + 3, |_, _, _| true);
    let waves = Field::fractal([2, 3], 2, seed + 4);
    Structure {
        brightness: Field::sum(&[(0.035, &grooves), (0.012, &patches), (0.05, &scratches)]),
        tint,
        roughness: Field::sum(&[(0.10, &grooves), (0.05, &patches), (-0.15, &scratches)]),
        height: Field::sum(&[(6e-6, &grooves), (-12e-6, &scratches), (7e-6, &waves)]),
    }
}

/// Polished; its tile is about 0.25 m square.
pub fn polished(seed: u64, tint: [f32; 3]) -> Structure {
    let waves = Field::fractal([4, 4], 2, seed);
    let patches = Field::fractal([5, 5], 5, seed + 1);
    let hairs = Field::sum(&[(1.0, &Field::streaks(90, seed + 2)), (0.7, &Field::streaks(70, seed + 3).transposed())])
        .standardized();
    let smudges = patches.clone().map(|patch| (patch - 0.6).max(0.0));
    Structure {
        brightness: Field::sum(&[(0.018, &patches), (0.010, &hairs), (-0.02, &smudges)]),
        tint,
        roughness: Field::sum(&[(0.05, &patches), (0.04, &hairs), (0.08, &smudges)]),
        height: Field::sum(&[(12e-6, &waves), (0.1e-6, &hairs)]),
    }
}

/// Cast in sand; its tile is about 0.15 m square. `grain` is the height of the sand's grains, standard deviation, m.
pub fn cast(seed: u64, tint: [f32; 3], grain: f32) -> Structure {
    let skin = Field::fractal([52, 52], 3, seed);
    let waves = Field::fractal([5, 5], 2, seed + 1);
    let patches = Field::fractal([6, 6], 5, seed + 2);
    let pits = Field::marks(
        &Marks { count: 700, length: [2.0, 5.0], width: [2.0, 5.0], depth: [0.2, 1.0] },
        seed + 3,
        |_, _, _| true,
    );
    Structure {
        brightness: Field::sum(&[(0.035, &skin), (0.025, &patches), (-0.12, &pits)]),
        tint,
        roughness: Field::sum(&[(0.06, &skin), (0.05, &patches), (0.25, &pits)]),
        height: Field::sum(&[(grain, &skin), (15e-6, &waves), (-6.0 * grain, &pits)]),
    }
}

/// Lead: soft and oxidised; its tile is about 0.2 m square.
pub fn lead(seed: u64) -> Structure {
    let dents = Field::fractal([9, 9], 3, seed);
    let oxide = Field::fractal([5, 5], 6, seed + 1);
    let marks = |count| Marks { count, length: [10.0, 90.0], width: [0.7, 2.0], depth: [0.1, 1.0] };
    let along = Field::marks(&marks(90), seed + 2, |_, _, _| true);
    let across = Field::marks(&marks(60), seed + 3, |_, _, _| true).transposed();
    let fine = Field::fractal([90, 90], 2, seed + 4);
    Structure {
        brightness: Field::sum(&[(0.065, &oxide), (0.02, &fine), (0.16, &along), (0.16, &across)]),
        tint: [1.0, 1.0, 0.95],
        roughness: Field::sum(&[(0.10, &oxide), (0.03, &fine), (-0.2, &along), (-0.2, &across)]),
        height: Field::sum(&[(45e-6, &dents), (1.5e-6, &fine), (-25e-6, &along), (-25e-6, &across)]),
    }
}
