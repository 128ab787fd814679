//! All joints closed at once: Newton's method on the places, with the tree's factor (`articulation::tree`), O(n).
//!
//! The update leaves the bodies at x* with the joints open by C. A pass moves them by the displacement that closes the
//! joints to first order and is least in kinetic energy,
//!
//! ```text
//! min ½ δ·M δ      J δ = C* − C(x)        x ← x ⊕ δ
//! ```
//!
//! so that two or three passes leave nothing: each squares the turn that is left. Hands are rows of their own beside the
//! tree. With H the tree's system, G the rows of all grips (grip point = place) and R = H⁻¹ Gᵀ, three solves a grip,
//!
//! ```text
//! (G R + γ tr(G R)/3k E) μ = w − G δ₀        δ = δ₀ + R μ
//! ```
//!
//! γ is small and not zero: where a chain is stretched towards what it cannot reach, G R has no answer along it. A step
//! turns no body by more than [`LONGEST_TURN`]; the last pass closes the joints alone, so that they hold and the grip
//! misses. What is closed by passes may keep limits waiting: those are taken by `touch.rs`, through the same factor.

use super::compulsive::farthest;
use super::{Grip, MOST_GRIPS, REACHED, Reach};
use crate::articulation::block::{Vec6, add_scaled, angular, dot, linear, vec6};
use crate::articulation::{Cholesky, System};
use crate::bodies::RigidBody;
use crate::dynamics::Moved;
use crate::math::DVec3;

/// Passes that grips lead at most, and passes without them.
pub const MOST_LED: u32 = 24;
pub const MOST_PASSES: usize = 6;
/// Passes after which the farthest grip must have come nearer by [`LEAST_GAIN`].
const PATIENCE: u32 = 3;
const LEAST_GAIN: f64 = 0.9;
/// Largest turn of a body in one pass, rad.
const LONGEST_TURN: f64 = 0.7;
/// γ.
const SOFTNESS: f64 = 1e-4;
/// Rows of a grip.
const ROWS: usize = 3;

/// Newton's method on the places.
#[derive(Clone, Debug)]
pub(super) struct TreeSolve {
    /// What each row may keep open.
    pub left: Vec<f64>,
    /// R, a column a row, and δ₀.
    columns: Vec<Vec<Vec6>>,
    least: Vec<Vec6>,
    hands: Cholesky,
}

impl TreeSolve {
    pub fn new(system: &System, bodies: usize) -> Self {
        Self {
            left: vec![0.0; system.states().len()],
            columns: vec![vec![[0.0; 6]; bodies]; ROWS * MOST_GRIPS],
            least: vec![[0.0; 6]; bodies],
            hands: Cholesky::with_room(ROWS * MOST_GRIPS, 0.0),
        }
    }

    /// Closes the joints of bodies where an update left them. What is still open after that leapt too far for tangents.
    pub fn adjust(&mut self, moved: &mut Moved, grips: &[Grip]) -> Reach {
        let (bodies, system) = (&mut *moved.bodies, &mut *moved.system);
        let mut reach = Reach::default();
        let mut before = f64::INFINITY;
        let mut led = !grips.is_empty();
        let mut alone = 0;
        system.evaluate(bodies);
        system.take_up();
        loop {
            reach.residual = system.open_by(&self.left);
            reach.missed = farthest(grips, bodies);
            // What does not come nearer is out of reach: from then on the joints go before it.
            if led && reach.passes % PATIENCE == 0 {
                led = reach.missed > REACHED && reach.missed <= LEAST_GAIN * before && reach.passes < MOST_LED;
                before = reach.missed;
            }
            let closed = reach.residual <= REACHED && (!led || reach.missed <= REACHED);
            if closed || alone == MOST_PASSES {
                return reach;
            }
            alone += usize::from(!led);
            reach.passes += 1;
            system.factor();
            system.solve_closing(&self.left);
            if led {
                self.lead(system, bodies, grips);
            }
            shorten(&mut system.a);
            for (body, delta) in bodies.iter_mut().zip(&system.a) {
                body.displace(linear(delta), angular(delta));
            }
            system.evaluate(bodies);
        }
    }

    /// Adds what the grips ask to the displacement in `system.a`.
    fn lead(&mut self, system: &mut System, bodies: &[RigidBody], grips: &[Grip]) {
        self.least.copy_from_slice(&system.a);
        let n = ROWS * grips.len();
        let row = |index: usize| {
            let (grip, axis) = (&grips[index / ROWS], DVec3::AXES[index % ROWS]);
            let arm = grip.point_of(bodies) - bodies[grip.body].position;
            (grip.body, vec6(axis, arm.cross(axis)))
        };
        for index in 0..n {
            let (body, block) = row(index);
            system.b.fill([0.0; 6]);
            system.push_impulse(body, &block, 1.0);
            system.solve_impulse();
            self.columns[index].copy_from_slice(&system.a);
        }
        self.hands.begin(n);
        let mut trace = 0.0;
        for k in 0..n {
            let (body, block) = row(k);
            for l in 0..=k {
                *self.hands.entry(k, l) = dot(&block, &self.columns[l][body]);
            }
            let own = dot(&block, &self.columns[k][body]);
            self.hands.measure(k, own);
            trace += own;
        }
        let soft = SOFTNESS * trace / n as f64;
        let mut mu = [0.0; ROWS * MOST_GRIPS];
        for (k, mu) in mu[..n].iter_mut().enumerate() {
            *self.hands.entry(k, k) += soft;
            let (body, block) = row(k);
            let grip = &grips[k / ROWS];
            *mu = (grip.place - grip.point_of(bodies))[k % ROWS] - dot(&block, &self.least[body]);
        }
        self.hands.factor();
        self.hands.solve(&mut mu[..n]);
        system.a.copy_from_slice(&self.least);
        for (column, mu) in self.columns.iter().zip(&mu[..n]) {
            for (a, r) in system.a.iter_mut().zip(column) {
                add_scaled(a, *mu, r);
            }
        }
    }
}

/// Shortens a displacement so that no body turns too far.
fn shorten(a: &mut [Vec6]) {
    let square = |delta: &Vec6| delta[3] * delta[3] + delta[4] * delta[4] + delta[5] * delta[5];
    let most = a.iter().fold(0.0, |most: f64, delta| most.max(square(delta)));
    if most <= LONGEST_TURN * LONGEST_TURN {
        return;
    }
    let shorter = LONGEST_TURN / most.sqrt();
    for delta in a {
        delta.iter_mut().for_each(|x| *x *= shorter);
    }
}
