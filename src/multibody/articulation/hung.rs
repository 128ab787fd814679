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

use super::ball::{Arms, Points};
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
    /// Which of the bodies hang like this, and each one's joint.
    hang: [bool; WIDTH],
    joints: [usize; WIDTH],
    /// 1 for those that do, 0 for others.
    counts: Four,
}

/// One joint of those of a quad.
struct OnePoint<'a> {
    /// Where its numbers begin.
    at: usize,
    /// Sign of its rows as seen from the body that hangs.
    sign: f64,
    lane: usize,
    points: &'a Points,
}

impl OnePoint<'_> {
    /// A vector of it, as its rows have it.
    #[inline(always)]
    fn seen(&self, of: &V3<Four>) -> [f64; 3] {
        [&of.x, &of.y, &of.z].map(|part| part.0[self.lane] * self.sign)
    }
}

impl Hung {
    /// `points` gives a body's joint where it is one point always, and both ends of it: the body's and its parent's.
    pub fn new(tree: &Tree, points: impl Fn(usize) -> Option<(usize, (DVec3, DVec3))>) -> Self {
        let mut ends = vec![Ends::default(); tree.members().len()];
        for &body in tree.order() {
            let Slot { quad, lane } = tree.slot(body);
            let Some((joint, (own, parent))) = points(body) else { continue };
            let lanes = One(lane);
            ends[quad].own.put(lanes, own.into());
            ends[quad].parent.put(lanes, parent.into());
            (ends[quad].hang[lane], ends[quad].joints[lane], ends[quad].counts.0[lane]) = (true, joint, 1.0);
        }
        Self { ends }
    }

    /// C into the rows' numbers.
    pub fn tell_values(&self, tree: &Tree, states: &mut [RowState]) {
        self.each(tree, |joint| {
            for (state, value) in states[joint.at..].iter_mut().zip(joint.seen(&joint.points.value)) {
                state.value = value;
            }
        });
    }

    /// J̇ẋ into the rows' numbers.
    pub fn tell_biases(&self, tree: &Tree, states: &mut [RowState]) {
        self.each(tree, |joint| {
            for (state, bias) in states[joint.at..].iter_mut().zip(joint.seen(&joint.points.bias)) {
                state.bias = bias;
            }
        });
    }

    /// Ċ into `g`, where the points are told to come to rest.
    pub fn tell_rates(&self, tree: &Tree, g: &mut [f64]) {
        self.each(tree, |joint| {
            let rates = joint.seen(&joint.points.wanted).map(|wanted| -wanted);
            g[joint.at..joint.at + 3].copy_from_slice(&rates);
        });
    }

    /// The answers into `lambda`.
    pub fn tell_forces(&self, tree: &Tree, lambda: &mut [f64]) {
        self.each(tree, |joint| lambda[joint.at..joint.at + 3].copy_from_slice(&joint.seen(&joint.points.force)));
    }

    /// Sets what the points must do, from the right-hand side `g`.
    pub fn want(&self, tree: &mut Tree, g: &[f64]) {
        for ((ends, hooks), points) in self.ends.iter().zip(&tree.hooks).zip(&mut tree.points) {
            for lane in (0..WIDTH).filter(|&lane| ends.hang[lane]) {
                let g = DVec3::from_slice(&g[hooks.at[lane]..]) * hooks.signs.0[lane];
                points.wanted.put(One(lane), g.into());
            }
        }
    }

    /// Largest |C| of any point, m.
    pub fn largest(&self, tree: &Tree) -> f64 {
        let mut largest = [0.0; WIDTH];
        for Points { value, .. } in &tree.points {
            for part in [&value.x, &value.y, &value.z] {
                for (largest, value) in largest.iter_mut().zip(part.0) {
                    let size = value.abs();
                    *largest = if size > *largest { size } else { *largest };
                }
            }
        }
        largest.into_iter().fold(0.0, f64::max)
    }

    /// What the joints of bodies that are awake carry, into `loads`, N.
    pub fn weigh(&self, tree: &Tree, asleep: &[bool], loads: &mut [f64]) {
        for ((ends, members), Points { force, .. }) in self.ends.iter().zip(&tree.members).zip(&tree.points) {
            let (x, y, z) = (&force.x.0, &force.y.0, &force.z.0);
            let all: [f64; WIDTH] = std::array::from_fn(|k| (x[k] * x[k] + y[k] * y[k] + z[k] * z[k]).sqrt());
            for lane in (0..WIDTH).filter(|&lane| ends.hang[lane] && !asleep[members.bodies[lane]]) {
                loads[ends.joints[lane]] = all[lane];
            }
        }
    }

    /// The points are closed; where some are being drawn together, all but these.
    pub fn close(&self, tree: &mut Tree, gathering: Option<&[RowState]>) {
        let Some(states) = gathering else {
            tree.points.iter_mut().for_each(|points| points.value = V3::default());
            return;
        };
        for ((ends, hooks), Points { value, .. }) in self.ends.iter().zip(&tree.hooks).zip(&mut tree.points) {
            for lane in (0..WIDTH).filter(|&lane| ends.hang[lane]) {
                let rows = states[hooks.at[lane]..].iter().zip([&mut value.x, &mut value.y, &mut value.z]);
                rows.filter(|(state, _)| !state.gathers).for_each(|(_, value)| value.0[lane] = 0.0);
            }
        }
    }

    /// Goes through the joints.
    #[inline(always)]
    fn each<'a>(&self, tree: &'a Tree, mut joint: impl FnMut(OnePoint<'a>)) {
        for ((ends, hooks), points) in self.ends.iter().zip(&tree.hooks).zip(&tree.points) {
            for lane in (0..WIDTH).filter(|&lane| ends.hang[lane]) {
                joint(OnePoint { at: hooks.at[lane], sign: hooks.signs.0[lane], lane, points });
            }
        }
    }

    /// Arms (into the tree), C and J̇ẋ for bodies that stand like this.
    #[inline(always)]
    pub fn evaluate<S: Simd>(&self, simd: S, quads: &[Quad], tree: &mut Tree) {
        let lanes = All(simd);
        for (quad, ends) in self.ends.iter().enumerate() {
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
            let points = &mut tree.points[quad];
            points.value.put(lanes, value * lanes.get(&ends.counts));
            points.bias.put(lanes, bias);
        }
    }

    /// Sets the points' required velocity changes so that their errors stop growing: g = −Ċ.
    pub fn want_rest(&self, quads: &[Quad], tree: &mut Tree) {
        dispatch!(tree.level, simd => self.want_rest_in(simd, quads, tree));
    }

    #[inline(always)]
    fn want_rest_in<S: Simd>(&self, simd: S, quads: &[Quad], tree: &mut Tree) {
        let lanes = All(simd);
        for (quad, ends) in self.ends.iter().enumerate() {
            if ends.hang == [false; WIDTH] {
                continue;
            }
            let (own, parent) = (&quads[quad].state, Homes::new(quads, &tree.hooks[quad].slots));
            let arms = tree.balls[quad].arms.get(lanes);
            let own = own.velocity.get(lanes) + own.spin.get(lanes).cross(arms.own);
            let spin = parent.vector(lanes, |quad| &quad.state.spin);
            let rate = own - (parent.vector(lanes, |quad| &quad.state.velocity) + spin.cross(arms.parent));
            tree.points[quad].wanted.put(lanes, -rate);
        }
    }
}
