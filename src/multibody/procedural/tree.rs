//! All joints closed at once: Newton's method on the places, with the tree's factor (`articulation::tree`), O(n).
//!
//! The update leaves the bodies at x* with the joints open by C. A pass moves them by the displacement that closes the
//! joints to first order and is least in kinetic energy,
//!
//! ```text
//! min ½ δ·M δ      J δ = C* − C(x)        x ← x ⊕ δ
//! ```
//!
//! so that two or three passes leave nothing: each squares the turn that is left. A factor serves while no body has turned
//! by more than [`SERVES`] since: the passes after it shrink what is left by about that turn, for half the price. Hands
//! are rows of their own beside the tree. With H the tree's system, δ₀ what closes the joints alone and G the rows of all
//! grips (grip point = place),
//!
//! ```text
//! (G H⁻¹ Gᵀ + γ diag(G H⁻¹ Gᵀ)) μ = w − G δ₀        H δ = b₀ + Gᵀ μ
//! ```
//!
//! G H⁻¹ Gᵀ asks only the bodies on the ways from the hands to their roots, three walks a grip.
//!
//! γ is small and not zero: where a chain is stretched towards what it cannot reach, there is no answer along it. Limits
//! that are passed are such rows too, which only push: one whose μ would pull is taken out and the others solved again.
//! A step turns no body by more than [`LONGEST_TURN`]; the last passes close joints and limits alone, so that they hold
//! and the grip misses.

use super::compulsive::farthest;
use super::fours::Fours;
use super::grip::{Grip, MOST_GRIPS, REACHED, Reach};
use crate::articulation::{Cholesky, System};
use crate::dynamics::{Contacts, MAX_ROW_BODIES, PositionStep};
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::spatial::{Vec6, dot, vec6};

/// Passes that grips lead at most.
pub const MOST_LED: u32 = 24;
/// Passes after them, of joints and limits alone.
pub const MOST_PASSES: usize = 6;
/// Passes after which the farthest grip must have come nearer by [`LEAST_GAIN`].
const PATIENCE: u32 = 3;
const LEAST_GAIN: f64 = 0.9;
/// A factor serves up to this turn of a body since it was made, rad, and while what is open shrinks to [`SHRUNK`] a pass.
const SERVES: f64 = 0.01;
const SHRUNK: f64 = 0.1;
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
    /// G H⁻¹ Gᵀ, lower triangle.
    answers: Box<[[f64; MOST_ROWS]; MOST_ROWS]>,
    /// w − G δ₀.
    short: [f64; MOST_ROWS],
    hands: Cholesky,
    /// Bodies on the ways from hands and limits to their roots, and a flag a body.
    ways: Vec<usize>,
    on_way: Vec<bool>,
    /// Rows beside the tree: their blocks, how far they are to go, whether they only push.
    rows: Vec<Beside>,
}

/// A row beside the tree.
#[derive(Clone, Copy, Debug)]
struct Beside {
    ends: [Option<(usize, Vec6)>; MAX_ROW_BODIES],
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
            answers: Box::new([[0.0; MOST_ROWS]; MOST_ROWS]),
            short: [0.0; MOST_ROWS],
            hands: Cholesky::with_room(MOST_ROWS, 0.0),
            ways: Vec::with_capacity(bodies),
            on_way: vec![false; bodies],
            rows: Vec::with_capacity(MOST_ROWS),
        }
    }

    /// Closes the joints of bodies where the quads have them. What is still open after that leapt too far for tangents.
    pub fn adjust(&mut self, moved: &mut PositionStep, grips: &[Grip], fours: &Fours) -> Reach {
        let (bodies, system, contacts) = (&mut *moved.bodies, &mut *moved.system, &*moved.contacts);
        let mut reach = Reach::default();
        let mut before = f64::INFINITY;
        let mut led = !grips.is_empty();
        let mut alone = 0;
        // Turned since the factor was made, and how far things were open then.
        let (mut turned, mut open) = (f64::INFINITY, f64::INFINITY);
        system.evaluate_quads(bodies);
        system.take_up();
        loop {
            reach.residual = system.open_by(&self.left);
            reach.missed = farthest(grips, bodies);
            // What does not come nearer is out of reach: from then on the joints go before it.
            if led && reach.passes % PATIENCE == 0 {
                led = reach.missed > REACHED && reach.missed <= LEAST_GAIN * before && reach.passes < MOST_LED;
                before = reach.missed;
            }
            let passed = (0..contacts.bound_count()).fold(0.0, |most: f64, b| most.max(-contacts.bound_gap(b, bodies)));
            let worst = reach.residual.max(passed).max(if led { reach.missed } else { 0.0 });
            if worst <= REACHED || alone == MOST_PASSES {
                return reach;
            }
            alone += usize::from(!led);
            reach.passes += 1;
            if turned > SERVES || worst > SHRUNK * open {
                system.factor();
                turned = 0.0;
            }
            open = worst;
            system.solve_closing(&self.left);
            self.lay_out(contacts, bodies, if led { grips } else { &[] });
            if !self.rows.is_empty() {
                self.lead(system);
            }
            let turn = longest_turn(&system.a);
            let share = if turn > LONGEST_TURN { LONGEST_TURN / turn } else { 1.0 };
            turned += share * turn;
            fours.displace(system, bodies, share);
            system.evaluate_quads(bodies);
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
        for bound in 0..contacts.bound_count() {
            if self.rows.len() < MOST_ROWS && contacts.bound_gap(bound, bodies) < LEVEL {
                let (gap, ends) = contacts.bound(bound, bodies);
                self.rows.push(Beside { ends, way: -gap, limit: true, on: true });
            }
        }
    }

    /// Solves again with what the rows beside the tree ask.
    fn lead(&mut self, system: &mut System) {
        let touched = self.rows.iter().flat_map(|row| row.ends.iter().flatten().map(|(body, _)| *body));
        system.ways(touched, &mut self.on_way, &mut self.ways);
        for (short, row) in self.short.iter_mut().zip(&self.rows) {
            *short = row.way - row.along(&system.a);
        }
        for (l, row) in self.rows.iter().enumerate() {
            system.respond(&self.ways, row.ends.iter().flatten().copied());
            for (k, other) in self.rows.iter().enumerate().skip(l) {
                self.answers[k][l] = other.along(&system.a);
            }
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
        system.b.fill([0.0; 6]);
        for (row, mu) in self.rows.iter().zip(mu).filter(|(row, _)| row.on) {
            for (body, block) in row.ends.iter().flatten() {
                system.push_impulse(*body, block, mu);
            }
        }
        system.solve_closing_under(&self.left);
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
                *self.hands.entry(k, l) = self.answers[row][column];
            }
            let own = self.own_answer(row);
            *self.hands.entry(k, k) += SOFTNESS * own;
            self.hands.measure(k, own);
            right[k] = self.short[row];
        }
        self.hands.factor();
        self.hands.solve(&mut right[..n]);
        mu.fill(0.0);
        for (&row, answer) in on.iter().zip(right) {
            mu[row] = answer;
        }
    }

    /// What softens a row. The three of a grip are softened alike, or the place that comes nearest would depend on the axes.
    fn own_answer(&self, row: usize) -> f64 {
        if self.rows[row].limit {
            return self.answers[row][row];
        }
        let first = row - row % ROWS;
        (first..first + ROWS).map(|row| self.answers[row][row]).sum::<f64>() / ROWS as f64
    }
}

/// The longest turn of a displacement, rad.
fn longest_turn(a: &[Vec6]) -> f64 {
    let square = |delta: &Vec6| delta[3] * delta[3] + delta[4] * delta[4] + delta[5] * delta[5];
    a.iter().fold(0.0, |most: f64, delta| most.max(square(delta))).sqrt()
}
