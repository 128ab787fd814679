//! Seeded randomness: hashes, a small generator and gradient noise. The same seed gives the same bits for ever.

use std::cell::Cell;

/// Mixes a 64-bit word (the finaliser of SplitMix64, Steele et al. 2014): neighbouring inputs give unrelated outputs.
#[inline]
pub fn hash(mut x: u64) -> u64 {
    x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// A hash of several words.
#[inline]
pub fn hash_words(words: &[u64]) -> u64 {
    words.iter().fold(0x5bd1_e995, |h, &w| hash(h ^ w))
}

/// SplitMix64: a sequence of pseudo-random words from a seed.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The sequence of `seed`.
    #[inline]
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Next 64 random bits.
    #[inline]
    pub fn word(&mut self) -> u64 {
        let out = hash(self.0);
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        out
    }

    /// Uniform in [0, 1).
    #[inline]
    pub fn unit(&mut self) -> f64 {
        (self.word() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Uniform in [−1, 1).
    #[inline]
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// Uniform in [low, high).
    #[inline]
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// Perlin's gradient noise on the line: zero at the integers, about ±1 between, C² (quintic fade, Perlin 2002).
#[inline]
pub fn perlin1(x: f64, seed: u64) -> f64 {
    Perlin1::new(seed).at(x)
}

/// [`perlin1`] of one seed, to be asked at many places of which most share a cell with the one before: it remembers the
/// gradients at that cell's ends.
///
/// ```
/// use soffio_math::noise::{Perlin1, perlin1};
///
/// let noise = Perlin1::new(7);
/// for x in [0.3, 0.9, 1.1, 0.2, -3.5] {
///     assert_eq!(noise.at(x), perlin1(x, 7));
/// }
/// ```
#[derive(Clone, Debug)]
pub struct Perlin1 {
    seed: u64,
    /// The cell that was asked last, and the gradients.
    last: Cell<(f64, [f64; 2])>,
}

impl Perlin1 {
    /// The noise of `seed`.
    #[inline]
    pub fn new(seed: u64) -> Self {
        Self { seed, last: Cell::new((f64::NAN, [0.0; 2])) }
    }

    /// Its value at `x`.
    #[inline]
    pub fn at(&self, x: f64) -> f64 {
        let cell = x.floor();
        if self.last.get().0 != cell {
            self.last.set((cell, [cell, cell + 1.0].map(|end| self.gradient(end))));
        }
        let (t, [low, high]) = (x - cell, self.last.get().1);
        let (a, b) = (low * t, high * (t - 1.0));
        2.0 * (a + fade(t) * (b - a))
    }

    #[inline]
    fn gradient(&self, end: f64) -> f64 {
        (hash(self.seed ^ hash(end as i64 as u64)) >> 11) as f64 * (2.0 / (1u64 << 53) as f64) - 1.0
    }
}

/// Perlin's gradient noise in space, about ±1, C².
#[inline]
pub fn perlin3(p: glam::DVec3, seed: u64) -> f64 {
    let (cell, t) = split(p);
    let corners = corner_hashes(cell, seed);
    blend(t, |i, d| along_edge(corners[i], d))
}

/// Gradient noise of three components at once, each about ±1, C²: they share the lattice, and draw their gradients
/// from different bits of its hashes.
#[inline]
pub fn perlin3_vector(p: glam::DVec3, seed: u64) -> glam::DVec3 {
    let (cell, t) = split(p);
    let corners = corner_hashes(cell, seed);
    blend(t, |i, d| {
        let h = corners[i];
        glam::DVec3::new(along_edge(h, d), along_edge(h >> 16, d), along_edge(h >> 32, d))
    })
}

/// Cell of the lattice, and where in it.
#[inline]
fn split(p: glam::DVec3) -> (glam::DVec3, glam::DVec3) {
    let cell = p.floor();
    (cell, p - cell)
}

/// Hashes of a cell's corners, as [`hash_words`] of seed, x, y and z; corner i is off by the bits of i.
#[inline]
fn corner_hashes(cell: glam::DVec3, seed: u64) -> [u64; 8] {
    let word = |x: f64, i: usize| (x + i as f64) as i64 as u64;
    let start = hash_words(&[seed]);
    let x = [0, 1].map(|i| hash(start ^ word(cell.x, i)));
    let y = [0, 1, 2, 3].map(|i: usize| hash(x[i & 1] ^ word(cell.y, i >> 1)));
    [0, 1, 2, 3, 4, 5, 6, 7].map(|i: usize| hash(y[i & 3] ^ word(cell.z, i >> 2)))
}

/// Product of `d` with one of the twelve edge directions of a cube (Perlin 2002), picked by the four lowest bits.
#[inline]
fn along_edge(bits: u64, d: glam::DVec3) -> f64 {
    let glam::DVec3 { x, y, z } = d;
    match bits & 15 {
        0 | 12 => x + y,
        1 | 13 => y - x,
        2 => x - y,
        3 => -x - y,
        4 => x + z,
        5 => z - x,
        6 => x - z,
        7 => -x - z,
        8 => y + z,
        9 | 14 => z - y,
        10 => y - z,
        _ => -y - z,
    }
}

/// Blends what the eight corners of a cell say at `t` in it; they are asked with their number and the way from them.
#[inline]
fn blend<V>(t: glam::DVec3, corner: impl Fn(usize, glam::DVec3) -> V) -> V
where
    V: Copy + std::ops::Add<Output = V> + std::ops::Sub<Output = V>,
    f64: std::ops::Mul<V, Output = V>,
{
    let (u, v, w) = (fade(t.x), fade(t.y), fade(t.z));
    let at = |i: usize| corner(i, t - glam::DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64));
    let mix = |a: V, b: V, s: f64| a + s * (b - a);
    let (x00, x10) = (mix(at(0), at(1), u), mix(at(2), at(3), u));
    let (x01, x11) = (mix(at(4), at(5), u), mix(at(6), at(7), u));
    mix(mix(x00, x10, v), mix(x01, x11, v), w)
}

/// 6t⁵ − 15t⁴ + 10t³.
#[inline]
fn fade(t: f64) -> f64 {
    t * t * t * (t * (6.0 * t - 15.0) + 10.0)
}
