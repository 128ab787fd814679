//! Periodic random fields, from which the maps of finishes are mixed.
//!
//! A field has one value per texel of a square tile and continues over its edges on the other side, so that the tile repeats
//! without a seam. Three kinds of randomness make all of them:
//!
//! - *Gradient noise* (Perlin 1985, with the quintic fade of 2002) on a lattice of m × n cells whose corners are taken modulo m
//!   and n. Unequal m and n stretch it. A sum of octaves, each twice as fine and half as strong, is *fractal* noise.
//! - *Streaks*: white noise, averaged along u by a window that wraps, twice. Its spectrum is flat across them, as that of
//!   fibres and of scratches is.
//! - *Marks*: short strokes at random places, such as pores.
//!
//! Fields are standardised: mean 0, variance 1. So a factor in front of one is its standard deviation.

use soffio_math::noise::{Random, hash_words};
use soffio_math::{cos, sin};

/// Texels along each side of a tile.
///
/// Why that many: a picture of 1080 lines shows an exhibit of 1 m with pixels of 0.9 mm. Tiles are 0.1 … 1 m long, so texels are
/// as small as pixels or smaller.
pub const SIDE: usize = 512;

/// One value per texel, row by row.
#[derive(Clone, Debug)]
pub struct Field(pub Vec<f32>);

impl Field {
    /// The same value everywhere.
    pub fn constant(value: f32) -> Self {
        Self(vec![value; SIDE * SIDE])
    }

    /// A function of (u, v), each in 0 … 1 at the texels' centres.
    pub fn of(mut value: impl FnMut(f32, f32) -> f32) -> Self {
        let mut out = Self::constant(0.0);
        for (row, y) in out.0.chunks_exact_mut(SIDE).zip(0..) {
            let v = centre(y);
            row.iter_mut().zip(0..).for_each(|(texel, x)| *texel = value(centre(x), v));
        }
        out
    }

    /// White noise, uniform in −1 … 1.
    pub fn white(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let mut out = Self::constant(0.0);
        out.0.iter_mut().for_each(|value| *value = random.signed() as f32);
        out
    }

    /// Gradient noise of so many cells along u and v, standardised.
    pub fn gradient(cells: [usize; 2], seed: u64) -> Self {
        let [m, n] = cells;
        let gradients: Vec<[f32; 2]> = (0..m * n)
            .map(|k| {
                let angle = hash_words(&[seed, k as u64]) as f64 * (core::f64::consts::TAU / u64::MAX as f64);
                [cos(angle) as f32, sin(angle) as f32]
            })
            .collect();
        let columns: Vec<Knot> = (0..SIDE).map(|x| Knot::at(x, m)).collect();
        let mut out = Self::constant(0.0);
        for (y, row) in out.0.chunks_exact_mut(SIDE).enumerate() {
            let v = Knot::at(y, n);
            let [above, below] = [v.low, v.high].map(|j| &gradients[j * m..(j + 1) * m]);
            for (texel, u) in row.iter_mut().zip(&columns) {
                let dot = |g: [f32; 2], x: f32, y: f32| g[0] * x + g[1] * y;
                let top = mix(dot(above[u.low], u.past, v.past), dot(above[u.high], u.past - 1.0, v.past), u.fade);
                let down = v.past - 1.0;
                let bottom = mix(dot(below[u.low], u.past, down), dot(below[u.high], u.past - 1.0, down), u.fade);
                *texel = mix(top, bottom, v.fade);
            }
        }
        out.standardized()
    }

    /// A sum of octaves of gradient noise, standardised; the first has so many cells.
    pub fn fractal(cells: [usize; 2], octaves: u32, seed: u64) -> Self {
        let mut out = Self::constant(0.0);
        let mut strength = 1.0;
        for octave in 0..octaves {
            let finer = cells.map(|count| (count << octave).min(SIDE / 2));
            out.add(strength, &Self::gradient(finer, hash_words(&[seed, u64::from(octave)])));
            strength *= 0.5;
        }
        out.standardized()
    }

    /// Streaks along u about `length` texels long, and one texel wide; standardised.
    pub fn streaks(length: usize, seed: u64) -> Self {
        Self::white(seed).averaged_along(length).averaged_along(length).standardized()
    }

    /// Strokes along u: `depth` where they are, and 0 elsewhere. They overlap without adding up.
    pub fn marks(marks: &Marks, seed: u64, mut here: impl FnMut(f32, f32, f64) -> bool) -> Self {
        let mut random = Random::new(seed);
        let mut out = Self::constant(0.0);
        for _ in 0..marks.count {
            let [x, y] = [0; 2].map(|_| random.unit() * SIDE as f64);
            let length = random.range(marks.length[0], marks.length[1]);
            let width = random.range(marks.width[0], marks.width[1]);
            let depth = random.range(marks.depth[0], marks.depth[1]) as f32;
            let chance = random.unit();
            if here((x / SIDE as f64) as f32, (y / SIDE as f64) as f32, chance) {
                out.stroke([x, y], [0.5 * length, 0.5 * width], depth);
            }
        }
        out
    }

    /// An ellipse with these half axes, texels, whose depth falls off to its edge.
    fn stroke(&mut self, [x, y]: [f64; 2], [a, b]: [f64; 2], depth: f32) {
        let (wide, high) = (a.ceil() as i64, b.ceil().max(1.0) as i64);
        let (column, row) = (x.floor() as i64, y.floor() as i64);
        for j in -high..=high {
            for i in -wide..=wide {
                let along = (((column + i) as f64 + 0.5 - x) / a.max(0.5)) as f32;
                let across = (((row + j) as f64 + 0.5 - y) / b.max(0.5)) as f32;
                // Narrower than a texel, it fills a part of it.
                let share = (2.0 * b).min(1.0) as f32;
                let value = depth * share * (1.0 - along * along - across * across).max(0.0);
                let texel = &mut self.0[wrapped(row + j) * SIDE + wrapped(column + i)];
                *texel = texel.max(value);
            }
        }
    }

    /// Averages over a window of `length` texels along u.
    pub fn averaged_along(&self, length: usize) -> Self {
        let length = length.clamp(1, SIDE);
        let mut out = Self::constant(0.0);
        for (from, to) in self.0.chunks_exact(SIDE).zip(out.0.chunks_exact_mut(SIDE)) {
            let mut sum: f32 = from[..length].iter().sum();
            for x in 0..SIDE {
                to[(x + length / 2) % SIDE] = sum / length as f32;
                sum += from[(x + length) % SIDE] - from[x];
            }
        }
        out
    }

    /// The field with u and v exchanged.
    pub fn transposed(&self) -> Self {
        let mut out = Self::constant(0.0);
        for (index, value) in self.0.iter().enumerate() {
            out.0[index % SIDE * SIDE + index / SIDE] = *value;
        }
        out
    }

    /// Adds a multiple of another field.
    pub fn add(&mut self, factor: f32, other: &Self) {
        self.0.iter_mut().zip(&other.0).for_each(|(value, more)| *value += factor * more);
    }

    /// A sum of multiples of fields.
    pub fn sum(terms: &[(f32, &Self)]) -> Self {
        let mut out = Self::constant(0.0);
        terms.iter().for_each(|(factor, field)| out.add(*factor, field));
        out
    }

    /// Each value through a function.
    pub fn map(mut self, mut value: impl FnMut(f32) -> f32) -> Self {
        self.0.iter_mut().for_each(|texel| *texel = value(*texel));
        self
    }

    /// Mean 0 and variance 1; a constant becomes 0.
    pub fn standardized(self) -> Self {
        let count = self.0.len() as f64;
        let mean = self.0.iter().map(|v| f64::from(*v)).sum::<f64>() / count;
        let square = self.0.iter().map(|v| (f64::from(*v) - mean) * (f64::from(*v) - mean)).sum::<f64>() / count;
        let factor = if square > 0.0 { 1.0 / square.sqrt() } else { 0.0 };
        self.map(|v| ((f64::from(v) - mean) * factor) as f32)
    }
}

/// How many strokes, and of which sizes, texels. Each is between the two values.
pub struct Marks {
    /// Number of places that are tried.
    pub count: usize,
    /// Length along u.
    pub length: [f64; 2],
    /// Width across.
    pub width: [f64; 2],
    /// Depth in the middle.
    pub depth: [f64; 2],
}

/// Distances to the nearest and second nearest of random points, one in each of m × n cells (Worley 1996), in cells.
pub fn cellular(cells: [usize; 2], seed: u64) -> [Field; 2] {
    let [m, n] = cells;
    let points: Vec<[f32; 2]> = (0..m * n)
        .map(|k| {
            let mut random = Random::new(hash_words(&[seed, k as u64]));
            [random.unit() as f32, random.unit() as f32]
        })
        .collect();
    let mut second = Field::constant(0.0);
    let first = Field::of(|u, v| {
        let (x, y) = (u * m as f32, v * n as f32);
        let (i, j) = (x as i64, y as i64);
        let (mut nearest, mut next) = (f32::INFINITY, f32::INFINITY);
        for dj in -1..=1 {
            for di in -1..=1 {
                let (ci, cj) = ((i + di).rem_euclid(m as i64) as usize, (j + dj).rem_euclid(n as i64) as usize);
                let [px, py] = points[cj * m + ci];
                let (dx, dy) = ((i + di) as f32 + px - x, (j + dj) as f32 + py - y);
                let square = dx * dx + dy * dy;
                if square < nearest {
                    (nearest, next) = (square, nearest);
                } else {
                    next = next.min(square);
                }
            }
        }
        let index = (v * SIDE as f32) as usize * SIDE + (u * SIDE as f32) as usize;
        second.0[index] = next.sqrt();
        nearest.sqrt()
    });
    [first, second]
}

/// The lattice around a texel: corners before and after, distance past the first, and its fade.
struct Knot {
    low: usize,
    high: usize,
    past: f32,
    fade: f32,
}

impl Knot {
    fn at(texel: usize, cells: usize) -> Self {
        let place = centre(texel) * cells as f32;
        let low = place as usize;
        let past = place - low as f32;
        let fade = past * past * past * (past * (past * 6.0 - 15.0) + 10.0);
        Self { low, high: (low + 1) % cells, past, fade }
    }
}

/// Between a at 0 and b at 1.
pub fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + t * (b - a)
}

/// 0 below `low`, 1 above `high`, a cubic between.
pub fn smooth_step(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn centre(texel: usize) -> f32 {
    (texel as f32 + 0.5) / SIDE as f32
}

fn wrapped(texel: i64) -> usize {
    texel.rem_euclid(SIDE as i64) as usize
}
