//! Cache of nearby collider pairs of two bodies, valid while the bodies stay near where they were.
//!
//! A wheel's teeth and two pallets are some hundred pairs, of which the same few are near for many steps. Where all of them
//! were last looked at, each collider in a cube about its box, a pair was left out if its cubes were farther apart than M
//! along one of the world's axes. It cannot meet for as long as
//!
//! ```text
//! d_a + d_b + s_a + s_b ≤ M        d ≤ |Δx| + 2 |Δq| ρ
//! ```
//!
//! d bounds how far any point of a body's colliders is from where it was then, and s how far it moves in the present
//! interval. ρ is the farthest of these points from the centre of mass: a rotation by θ moves it by 2 ρ sin ½θ, and
//! |Δq| is 2 sin ¼θ.

use super::conservative_advancement::{BoxSize, CONTACT_MARGIN, Sweep};
use soffio_math::{DQuat, DVec3};

/// Fewer pairs than this are looked at each time.
pub(super) const MIN_CACHED_PAIRS: usize = 8;
/// M, as a share of the smaller body's ρ: a larger one leaves more pairs in, a smaller one is sooner used up.
const MARGIN_RATIO: f64 = 0.04;

/// Left out is only what is farther than M by so much, m: two touching layers and rounding.
const ROUNDING_MARGIN: f64 = 4.0 * CONTACT_MARGIN;

/// A collider as it is looked at: the middle of its cube, m, and its size.
pub(super) type Cube = (DVec3, BoxSize);

/// The pairs of two bodies' colliders that can meet.
#[derive(Clone, Debug)]
pub(super) struct PairCache {
    /// Indices of the pairs.
    pub pairs: Vec<usize>,
    /// Where the bodies' centres of mass were when all pairs were looked at, m, and how they were turned.
    start_poses: [(DVec3, DQuat); 2],
    /// ρ of either, m.
    bounding_radii: [f64; 2],
    /// M, m; nothing before anybody has looked.
    margin: f64,
}

impl PairCache {
    /// Room for so many pairs; nobody has looked at them.
    pub fn new(pairs: usize) -> Self {
        let nowhere = (DVec3::ZERO, DQuat::IDENTITY);
        Self { pairs: Vec::with_capacity(pairs), start_poses: [nowhere; 2], bounding_radii: [0.0; 2], margin: -1.0 }
    }

    /// Do `pairs` still hold all pairs that can meet during these motions of the two bodies? Otherwise [`Self::refresh`] is
    /// needed.
    pub fn contains(&self, sweeps: [&Sweep; 2]) -> bool {
        let gone = |k: usize| sweeps[k].max_departure(&self.start_poses[k], self.bounding_radii[k]);
        gone(0) + gone(1) <= self.margin
    }

    /// Tests all pairs at the beginning of these sweeps; `cubes` gives the two cubes of a pair.
    pub fn refresh(&mut self, sweeps: [&Sweep; 2], all: &[usize], cubes: impl Fn(usize) -> [Cube; 2]) {
        self.start_poses = sweeps.map(Sweep::start_pose);
        self.bounding_radii = [0.0; 2];
        for &pair in all {
            for (bounding_radii, (_, size)) in self.bounding_radii.iter_mut().zip(cubes(pair)) {
                *bounding_radii = bounding_radii.max(size.bounding_radius);
            }
        }
        self.margin = MARGIN_RATIO * self.bounding_radii[0].min(self.bounding_radii[1]);
        self.pairs.clear();
        self.pairs.extend(all.iter().filter(|&&pair| {
            let [(one, a), (other, b)] = cubes(pair);
            (one - other).abs().max_element() <= a.half + b.half + self.margin + ROUNDING_MARGIN
        }));
    }
}
