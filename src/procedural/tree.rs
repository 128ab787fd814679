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
//! (G R + γ diag(G R)) μ = w − G δ₀        δ = δ₀ + R μ
//! ```
//!
//! γ is small and not zero: where a chain is stretched towards what it cannot reach, G R has no answer along it. Limits
//! that are passed are such rows too, which only push: one whose μ would pull is taken out and the others solved again.
//! A step turns no body by more than [`LONGEST_TURN`]; the last passes close joints and limits alone, so that they hold
//! and the grip misses.

use super::compulsive::farthest;
use super::{Grip, MOST_GRIPS, REACHED, Reach};
use crate::articulation::block::{Vec6, add_scaled, angular, dot, linear, vec6};
use crate::articulation::{Cholesky, System};
use crate::bodies::RigidBody;
use crate::dynamics::{Contacts, ENDS, Moved};
use crate::math::DVec3;

/// Passes that grips lead at most.
pub const MOST_LED: u32 = 24;
/// Passes after them, of joints and limits alone.
pub const MOST_PASSES: usize = 6;
/// Passes after which the farthest grip must have come nearer by [`LEAST_GAIN`].
const PATIENCE: u32 = 3;
const LEAST_GAIN: f64 = 0.9;
/// Largest turn of a body in one pass, rad.
const LONGEST_TURN: f64 = 0.7;
/// Limits nearer than this take part, m or rad.
const LEVEL: f64 = 1e-9;
/// γ.
const SOFTNESS: f64 = 1e-4;
/// Rows of a grip, and rows beside the tree at most.
const ROWS: usize = 3;
const MOST_ROWS: usize = ROWS * MOST_GRIPS + 12;

/// Newton's method on the places.
#[derive(Clone, Debug)]
pub(super) struct TreeSolve {
    /// What each row may keep open.
    pub left: Vec<f64>,
    /// R, a column a row, and δ₀.
    columns: Vec<Vec<Vec6>>,
    least: Vec<Vec6>,
    hands: Cholesky,
    /// Rows beside the tree: their blocks, how far they are to go, whether they only push.
    rows: Vec<Beside>,
}

/// A row beside the tree.
#[derive(Clone, Copy, Debug)]
struct Beside {
    ends: [Option<(usize, Vec6)>; ENDS],
    way: f64,
    limit: bool,
    on: bool,
}

impl Beside {
    fn along(&self, a: &[Vec6]) -> f64 {
        self.ends.iter().flatten().map(|(body, block)| dot(block, &a[*body])).sum()
    }
}

impl TreeSolve {
    pub fn new(system: &System, bodies: usize) -> Self {
        Self {
            left: vec![0.0; system.states().len()],
            columns: vec![vec![[0.0; 6]; bodies]; MOST_ROWS],
            least: vec![[0.0; 6]; bodies],
            hands: Cholesky::with_room(MOST_ROWS, 0.0),
            rows: Vec::with_capacity(MOST_ROWS),
        }
    }

    /// Closes the joints of bodies where an update left them. What is still open after that leapt too far for tangents.
    pub fn adjust(&mut self, moved: &mut Moved, grips: &[Grip]) -> Reach {
        let (bodies, system, contacts) = (&mut *moved.bodies, &mut *moved.system, &*moved.contacts);
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
            let passed = (0..contacts.bounds()).fold(0.0, |most: f64, b| most.max(-contacts.bound_gap(b, bodies)));
            let closed = reach.residual.max(passed) <= REACHED && (!led || reach.missed <= REACHED);
            if closed || alone == MOST_PASSES {
                return reach;
            }
            alone += usize::from(!led);
            reach.passes += 1;
            system.factor();
            system.solve_closing(&self.left);
            self.lay_out(contacts, bodies, if led { grips } else { &[] });
            if !self.rows.is_empty() {
                self.lead(system);
            }
            shorten(&mut system.a);
            for (body, delta) in bodies.iter_mut().zip(&system.a) {
                body.displace(linear(delta), angular(delta));
            }
            system.evaluate(bodies);
        }
    }

    /// Lays out the rows beside the tree: of these grips, and of limits that are passed.
    fn lay_out(&mut self, contacts: &Contacts, bodies: &[RigidBody], grips: &[Grip]) {
        self.rows.clear();
        for grip in grips {
            let at = grip.point_of(bodies);
            let (arm, way) = (at - bodies[grip.body].position, grip.place - at);
            for (axis, way) in DVec3::AXES.into_iter().zip(way.to_array()) {
                let ends = [Some((grip.body, vec6(axis, arm.cross(axis)))), None, None];
                self.rows.push(Beside { ends, way, limit: false, on: true });
            }
        }
        for bound in 0..contacts.bounds() {
            if self.rows.len() < MOST_ROWS && contacts.bound_gap(bound, bodies) < LEVEL {
                let (gap, ends) = contacts.bound(bound, bodies);
                self.rows.push(Beside { ends, way: -gap, limit: true, on: true });
            }
        }
    }

    /// Adds what the rows beside the tree ask to the displacement in `system.a`.
    fn lead(&mut self, system: &mut System) {
        self.least.copy_from_slice(&system.a);
        for (row, column) in self.rows.iter().zip(&mut self.columns) {
            system.b.fill([0.0; 6]);
            for (body, block) in row.ends.iter().flatten() {
                system.push_impulse(*body, block, 1.0);
            }
            system.solve_impulse();
            column.copy_from_slice(&system.a);
        }
        let mut mu = [0.0; MOST_ROWS];
        // Each round takes a limit out at least.
        for _ in 0..=self.rows.len() {
            self.balance(&mut mu);
            let mut pulls = false;
            for (row, mu) in self.rows.iter_mut().zip(&mut mu) {
                if row.on && row.limit && *mu < 0.0 {
                    (row.on, pulls) = (false, true);
                }
            }
            if !pulls {
                break;
            }
        }
        system.a.copy_from_slice(&self.least);
        for ((column, mu), row) in self.columns.iter().zip(&mu).zip(&self.rows) {
            if row.on {
                for (a, r) in system.a.iter_mut().zip(column) {
                    add_scaled(a, *mu, r);
                }
            }
        }
    }

    /// μ of the rows that are on.
    fn balance(&mut self, mu: &mut [f64; MOST_ROWS]) {
        let mut on = [0; MOST_ROWS];
        let mut n = 0;
        for (index, _) in self.rows.iter().enumerate().filter(|(_, row)| row.on) {
            on[n] = index;
            n += 1;
        }
        let on = &on[..n];
        self.hands.begin(n);
        let mut right = [0.0; MOST_ROWS];
        for (k, &row) in on.iter().enumerate() {
            for (l, &column) in on[..=k].iter().enumerate() {
                *self.hands.entry(k, l) = self.rows[row].along(&self.columns[column]);
            }
            let own = self.rows[row].along(&self.columns[row]);
            *self.hands.entry(k, k) += SOFTNESS * own;
            self.hands.measure(k, own);
            right[k] = self.rows[row].way - self.rows[row].along(&self.least);
        }
        self.hands.factor();
        self.hands.solve(&mut right[..n]);
        mu.fill(0.0);
        for (&row, answer) in on.iter().zip(right) {
            mu[row] = answer;
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
