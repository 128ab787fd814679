//! Wood: growth rings, pores, rays and fibres of sawn faces and of end grain; and bamboo.
//!
//! A saw cuts the cylinders of a trunk's rings at a low angle. On a face the rings are the contour lines of a phase
//!
//! ```text
//! φ(u, v) = N v + A n(u, v) + small waves        u along the grain, v across, n a slow noise, N rings in a tile
//! ```
//!
//! With A = 0 they are the straight lines of quarter-sawn wood. Where A ∂n/∂v exceeds N they close to the arches and islands of
//! plain-sawn wood. Since N is whole and n repeats, so does the tile. On end grain the phase is N v + A cos 2πu: arcs about a pith far
//! away.
//!
//! Within a ring, wood darkens from early to late wood and starts light again at its edge: t^p for t in 0 … 1. Pores are cut
//! lengthwise, so they are short dark dashes: of ring-porous oak in the early wood alone, of walnut everywhere. Beech has neither,
//! but rays, which are spindles of a millimetre or two. The sizes are those of "The Wood Database" and of Hoadley, "Identifying
//! Wood", 1990. The contrasts were set by eye beside photographs of oiled boards.

use super::maps::Structure;
use super::noise::{Field, Marks, SIDE, mix, smooth_step};
use soffio_math::noise::hash_words;
use soffio_math::{PI, cos};

/// What distinguishes one wood from another.
pub struct Species {
    /// Rings across a tile.
    rings: u32,
    /// Rings by which waves along the grain shift them: standard deviation.
    waviness: f32,
    /// Exponent p of the darkening.
    late: i32,
    /// Darkening from early to late wood.
    contrast: f32,
    /// Standard deviation of the fibres' brightness.
    fibres: f32,
    /// Standard deviation of slow changes of colour.
    patches: f32,
    /// Pores: how many are tried in a tile, and how dark they are.
    pores: Option<(usize, f64)>,
    /// Last place t in a ring that has pores.
    porous_until: f32,
    /// Rays: how many in a tile, and how dark they are.
    rays: Option<(usize, f64)>,
}

/// Oak: ring-porous.
pub const OAK: Species = Species {
    rings: 26,
    waviness: 2.6,
    late: 1,
    contrast: 0.16,
    fibres: 0.045,
    patches: 0.045,
    pores: Some((26_000, 0.34)),
    porous_until: 0.38,
    rays: Some((260, 0.10)),
};

/// Beech: even, with rays.
pub const BEECH: Species = Species {
    rings: 22,
    waviness: 2.2,
    late: 4,
    contrast: 0.13,
    fibres: 0.036,
    patches: 0.035,
    pores: None,
    porous_until: 0.0,
    rays: Some((9000, 0.26)),
};

/// Walnut: dark, with long pores everywhere.
pub const WALNUT: Species = Species {
    rings: 16,
    waviness: 2.4,
    late: 2,
    contrast: 0.30,
    fibres: 0.075,
    patches: 0.10,
    pores: Some((5200, 0.38)),
    porous_until: 1.0,
    rays: None,
};

/// Pine: no pores, strong late wood.
pub const PINE: Species = Species {
    rings: 17,
    waviness: 2.6,
    late: 4,
    contrast: 0.34,
    fibres: 0.03,
    patches: 0.03,
    pores: Some((160, 0.22)),
    porous_until: 1.0,
    rays: None,
};

/// How much more blue than red darkens: wood darkens to red.
const TINT: [f32; 3] = [0.78, 1.0, 1.22];
/// Depth of an open pore under oil or varnish, m.
const PORE_DEPTH: f32 = 30e-6;
/// Height of late over early wood after sanding, m.
const RIDGE: f32 = 4e-6;
/// Height of fibres, standard deviation, m.
const FIBRE_HEIGHT: f32 = 1.5e-6;
/// Roughness of a pore over that of the face, relative.
const PORE_ROUGHNESS: f32 = 0.35;

impl Species {
    /// Darkness at place t of a ring: 0 in early wood, 1 at the end of late wood.
    fn ring(&self, t: f32) -> f32 {
        let power = (0..self.late).fold(1.0, |product, _| product * t);
        power * (1.0 - smooth_step(0.93, 1.0, t))
    }

    /// Darkness of the rings of a phase; each ring is as dark as its number says.
    fn rings(&self, phase: &Field, seed: u64) -> Field {
        let strength = |number: u32| mix(0.55, 1.45, (hash_words(&[seed, number.into()]) >> 48) as f32 / 65535.0);
        let strengths: Vec<f32> = (0..self.rings).map(strength).collect();
        phase.clone().map(|phase| {
            let number = phase.floor() as i64;
            self.ring(phase - number as f32) * strengths[number.rem_euclid(i64::from(self.rings)) as usize]
        })
    }

    /// A sawn face; its tile is about 0.8 m × 0.25 m.
    pub fn face(&self, seed: u64) -> Structure {
        let slow = Field::fractal([1, 2], 2, seed);
        let waves = Field::fractal([3, 10], 3, seed + 1);
        let count = self.rings as f32;
        let mut phase = Field::of(|_, v| count * v);
        phase.add(self.waviness, &slow);
        phase.add(0.16, &waves);
        let rings = self.rings(&phase, seed);
        let fibres =
            Field::sum(&[(0.8, &Field::streaks(110, seed + 2)), (0.6, &Field::streaks(30, seed + 3))]).standardized();
        let patches = Field::fractal([1, 4], 4, seed + 4);
        let place = |u: f32, v: f32| {
            let phase = phase.0[(v * SIDE as f32) as usize % SIDE * SIDE + (u * SIDE as f32) as usize % SIDE];
            phase - phase.floor()
        };
        let (count, depth) = self.pores.unwrap_or((0, 0.0));
        // A texel is 1.6 mm long and half a millimetre wide: pores are 3 … 12 mm long and a third of a texel wide.
        let dashes = Marks { count, length: [2.0, 7.5], width: [0.4, 0.9], depth: [0.4 * depth, depth] };
        // Fewer, the later they are in the ring.
        let porous = |u: f32, v: f32, chance: f64| f64::from(self.porous_until - place(u, v)) > 0.5 * chance * chance;
        let pores = Field::marks(&dashes, seed + 5, porous);
        let (count, depth) = self.rays.unwrap_or((0, 0.0));
        let spindles = Marks { count, length: [1.0, 2.6], width: [0.5, 1.1], depth: [0.3 * depth, depth] };
        let rays = Field::marks(&spindles, seed + 6, |_, _, _| true);
        self.mixed(&rings, &fibres, &patches, &pores, &rays)
    }

    /// End grain; its tile is about 0.1 m square.
    pub fn end(&self, seed: u64) -> Structure {
        let count = self.rings as f32;
        let waves = Field::fractal([5, 5], 3, seed + 1);
        let mut phase = Field::of(|u, v| count * v + 0.12 * count * cos(2.0 * PI * f64::from(u)) as f32);
        phase.add(0.14, &waves);
        let rings = self.rings(&phase, seed);
        // Rays run from the pith outwards, across the rings.
        let fibres = Field::streaks(60, seed + 2).transposed();
        let patches = Field::fractal([2, 2], 4, seed + 4);
        let (count, depth) = self.pores.unwrap_or((0, 0.0));
        let holes = Marks { count, length: [0.8, 2.2], width: [0.8, 2.2], depth: [0.3 * depth, depth] };
        let place = |u: f32, v: f32| {
            let phase = phase.0[(v * SIDE as f32) as usize % SIDE * SIDE + (u * SIDE as f32) as usize % SIDE];
            phase - phase.floor()
        };
        let porous = |u: f32, v: f32, chance: f64| f64::from(self.porous_until - place(u, v)) > 0.5 * chance * chance;
        let pores = Field::marks(&holes, seed + 5, porous);
        self.mixed(&rings, &fibres, &patches, &pores, &Field::constant(0.0))
    }

    fn mixed(&self, rings: &Field, fibres: &Field, patches: &Field, pores: &Field, rays: &Field) -> Structure {
        let mean = rings.0.iter().sum::<f32>() / rings.0.len() as f32;
        let rings_alone = rings.clone().map(|ring| ring - mean);
        let open = pores.clone().map(|depth| depth.min(1.0));
        Structure {
            brightness: Field::sum(&[
                (-self.contrast, &rings_alone),
                (self.fibres, fibres),
                (self.patches, patches),
                (-1.0, pores),
                (-1.0, rays),
            ]),
            tint: TINT,
            roughness: Field::sum(&[(0.05, fibres), (0.04, patches), (PORE_ROUGHNESS, &open), (-0.08, &rings_alone)]),
            height: Field::sum(&[(-PORE_DEPTH, &open), (RIDGE, &rings_alone), (FIBRE_HEIGHT, fibres)]),
        }
    }
}

/// Bamboo: straight fibres, and one node in the middle of a tile, which is about 0.3 m × 0.06 m.
pub fn bamboo(seed: u64) -> Structure {
    let fibres = Field::sum(&[(0.8, &Field::streaks(220, seed)), (0.6, &Field::streaks(60, seed + 1))]).standardized();
    let patches = Field::fractal([2, 4], 4, seed + 2);
    let wave = Field::fractal([1, 4], 2, seed + 3);
    // Distance from the node along u, tiles, on a line that is not quite straight.
    let from_node = Field(
        (0..SIDE * SIDE).map(|i| (i % SIDE) as f32 / SIDE as f32 - 0.5 + 0.002 * wave.0[i]).collect::<Vec<f32>>(),
    );
    /// Half width of a node's groove: 1 mm of 0.3 m.
    const GROOVE: f32 = 0.004;
    let groove = from_node.clone().map(|x| 1.0 - smooth_step(0.0, GROOVE, x.abs()));
    // Above each node a pale ring of wax, a centimetre wide.
    let wax = from_node.map(|x| smooth_step(0.0, 0.006, x) * (1.0 - smooth_step(0.012, 0.05, x)));
    Structure {
        brightness: Field::sum(&[(0.05, &fibres), (0.035, &patches), (-0.5, &groove), (0.14, &wax)]),
        tint: [0.85, 1.0, 1.3],
        roughness: Field::sum(&[(0.08, &fibres), (0.08, &patches), (0.3, &groove), (0.15, &wax)]),
        height: Field::sum(&[(2e-6, &fibres), (-150e-6, &groove), (60e-6, &wax)]),
    }
}
