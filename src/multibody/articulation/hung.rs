//! Bodies that hang by one point always: where that point is, and how it moves, four joints at a time.
//!
//! The same formulas as `rows/point.rs`, seen from the body that hangs: with its parent's s and ω_p,
//!
//! ```text
//! C = (x + r) − (x_p + s)        J̇ẋ = ω×(ω×r) − ω_p×(ω_p×s)
//! ```
//!
//! The world is a parent like any other: it stands at the origin, at rest.

use fearless_simd::{Simd, dispatch};

use super::ball::Arms;
use super::quads::{Homes, Quad, Slot};
use super::system::RowState;
use super::tree::Tree;
use soffio_math::DVec3;
use soffio_math::lanes::{All, Four, Lanes, One, V3, WIDTH};

/// The points by which the bodies of each quad hang.
#[derive(Clone, Debug)]
pub struct Hung {
    ends: Vec<Ends>,
}

/// Those of one quad, from the centres of mass, body axes, m; the world's from its origin.
#[derive(Clone, Copy, Debug, Default)]
struct Ends {
    own: V3<Four>,
    parent: V3<Four>,
    /// Which of the bodies hang like this.
    hang: [bool; WIDTH],
    /// C and J̇ẋ at the last evaluation, as seen from the joints' first bodies.
    value: V3<Four>,
    bias: V3<Four>,
}

impl Hung {
    /// `points` gives both ends of a body's joint where it is one point always: the body's and its parent's.
    pub fn new(tree: &Tree, points: impl Fn(usize) -> Option<(DVec3, DVec3)>) -> Self {
        let mut ends = vec![Ends::default(); tree.members().len()];
        for &body in tree.order() {
            let Slot { quad, lane } = tree.slot(body);
            let Some((own, parent)) = points(body) else { continue };
            let lanes = One(lane);
            ends[quad].own.put(lanes, own.into());
            ends[quad].parent.put(lanes, parent.into());
            ends[quad].hang[lane] = true;
        }
        Self { ends }
    }

    /// C into the rows' numbers.
    pub fn tell_values(&self, tree: &Tree, states: &mut [RowState]) {
        self.each(tree, |at, lane, ends| {
            for (state, value) in states[at..at + 3].iter_mut().zip([&ends.value.x, &ends.value.y, &ends.value.z]) {
                state.value = value.0[lane];
            }
        });
    }

    /// J̇ẋ into the rows' numbers.
    pub fn tell_biases(&self, tree: &Tree, states: &mut [RowState]) {
        self.each(tree, |at, lane, ends| {
            for (state, bias) in states[at..at + 3].iter_mut().zip([&ends.bias.x, &ends.bias.y, &ends.bias.z]) {
                state.bias = bias.0[lane];
            }
        });
    }

    /// −J̇ẋ into `g`.
    pub fn want_still(&self, tree: &Tree, g: &mut [f64]) {
        self.each(tree, |at, lane, ends| {
            for (g, bias) in g[at..at + 3].iter_mut().zip([&ends.bias.x, &ends.bias.y, &ends.bias.z]) {
                *g = -bias.0[lane];
            }
        });
    }

    /// Goes through the joints: where the numbers of each begin, its lane, its quad.
    #[inline(always)]
    fn each(&self, tree: &Tree, mut joint: impl FnMut(usize, usize, &Ends)) {
        for (ends, hooks) in self.ends.iter().zip(&tree.hooks) {
            for lane in (0..WIDTH).filter(|&lane| ends.hang[lane]) {
                joint(hooks.at[lane], lane, ends);
            }
        }
    }

    /// Arms (into the tree), C and J̇ẋ for bodies that stand like this.
    #[inline(always)]
    pub fn evaluate<S: Simd>(&mut self, simd: S, quads: &[Quad], tree: &mut Tree) {
        let lanes = All(simd);
        for (quad, ends) in self.ends.iter_mut().enumerate() {
            if ends.hang == [false; WIDTH] {
                continue;
            }
            let hooks = &tree.hooks[quad];
            let (own, parent) = (&quads[quad], Homes::new(quads, &hooks.slots));
            let r = own.frame.get(lanes).mul(ends.own.get(lanes));
            let frame = parent.matrix(lanes, |quad| &quad.frame);
            let s = frame.mul(ends.parent.get(lanes));
            tree.balls[quad].arms.put(lanes, &Arms { own: r, parent: s });
            let value = own.state.position.get(lanes) + r - (parent.vector(lanes, |quad| &quad.state.position) + s);
            let (spin, other) = (own.state.spin.get(lanes), parent.vector(lanes, |quad| &quad.state.spin));
            let bias = spin.cross(spin.cross(r)) - other.cross(other.cross(s));
            let sign = lanes.get(&hooks.signs);
            ends.value.put(lanes, value * sign);
            ends.bias.put(lanes, bias * sign);
        }
    }

    /// Ċ of the rows into `g`.
    pub fn rates(&self, quads: &[Quad], tree: &Tree, g: &mut [f64]) {
        dispatch!(tree.level, simd => self.rates_in(simd, quads, tree, g));
    }

    #[inline(always)]
    fn rates_in<S: Simd>(&self, simd: S, quads: &[Quad], tree: &Tree, g: &mut [f64]) {
        let lanes = All(simd);
        for (quad, ends) in self.ends.iter().enumerate() {
            if ends.hang == [false; WIDTH] {
                continue;
            }
            let hooks = &tree.hooks[quad];
            let (own, parent) = (&quads[quad].state, Homes::new(quads, &hooks.slots));
            let arms = tree.balls[quad].arms.get(lanes);
            let own = own.velocity.get(lanes) + own.spin.get(lanes).cross(arms.own);
            let spin = parent.vector(lanes, |quad| &quad.state.spin);
            let rate = own - (parent.vector(lanes, |quad| &quad.state.velocity) + spin.cross(arms.parent));
            let rate = rate * lanes.get(&hooks.signs);
            lanes.scatter(WIDTH, &[rate.x, rate.y, rate.z], |lane, rate| {
                if ends.hang[lane] {
                    g[hooks.at[lane]..hooks.at[lane] + 3].copy_from_slice(rate);
                }
            });
        }
    }
}
