//! Of many pairs of the same two bodies those that can meet while these stay near where they are.
//!
//! A wheel's teeth and two pallets are some hundred pairs, of which the same few are near for many steps. Where all of them
//! were last looked at, each collider in a cube about its box, a pair was left out if its cubes were farther apart than M
//! along one of the world's axes. It cannot meet for as long as
//!
//! ```text
//! d_a + d_b + s_a + s_b ≤ M        d ≤ |Δx| + 2 |Δq| ρ
//! ```
//!
//! with d how far any point of a body's colliders can be from where it was then, s how far it strays in the interval that is
//! looked at, and ρ the farthest of these points from the centre of mass (a turn by θ takes it 2 ρ sin ½θ, and |Δq| is
//! 2 sin ¼θ).

use super::advance::{Size, Sweep, TOUCH};
use soffio_math::{DQuat, DVec3};

/// Fewer pairs than this are looked at each time.
pub(super) const MANY: usize = 8;
/// M, as a share of the smaller body's ρ: a larger one leaves more pairs in, a smaller one is sooner used up.
const SHARE: f64 = 0.04;

/// Left out is only what is farther than M by so much, m: two touching layers and rounding.
const CARE: f64 = 4.0 * TOUCH;

/// A collider as it is looked at: the middle of its cube, m, and its size.
pub(super) type Cube = (DVec3, Size);

/// The pairs of two bodies' colliders that can meet.
#[derive(Clone, Debug)]
pub(super) struct Nearby {
    /// Which they are.
    pub pairs: Vec<usize>,
    /// Where the bodies' centres of mass were when all pairs were looked at, m, and how they were turned.
    places: [(DVec3, DQuat); 2],
    /// ρ of either, m.
    reach: [f64; 2],
    /// M, m; nothing before anybody has looked.
    margin: f64,
}

impl Nearby {
    /// Room for so many pairs; nobody has looked at them.
    pub fn new(pairs: usize) -> Self {
        let nowhere = (DVec3::ZERO, DQuat::IDENTITY);
        Self { pairs: Vec::with_capacity(pairs), places: [nowhere; 2], reach: [0.0; 2], margin: -1.0 }
    }

    /// Are those that were left out still too far apart, on these ways of the two bodies?
    pub fn holds(&self, ways: [&Sweep; 2]) -> bool {
        let gone = |k: usize| ways[k].gone_since(&self.places[k], self.reach[k]);
        gone(0) + gone(1) <= self.margin
    }

    /// Looks at all pairs, `cubes` telling those of one, at the beginning of these ways.
    pub fn look(&mut self, ways: [&Sweep; 2], all: &[usize], cubes: impl Fn(usize) -> [Cube; 2]) {
        self.places = ways.map(Sweep::place);
        self.reach = [0.0; 2];
        for &pair in all {
            for (reach, (_, size)) in self.reach.iter_mut().zip(cubes(pair)) {
                *reach = reach.max(size.reach);
            }
        }
        self.margin = SHARE * self.reach[0].min(self.reach[1]);
        self.pairs.clear();
        self.pairs.extend(all.iter().filter(|&&pair| {
            let [(one, a), (other, b)] = cubes(pair);
            (one - other).abs().max_element() <= a.half + b.half + self.margin + CARE
        }));
    }
}
