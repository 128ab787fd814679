//! Sleep: what rests is left out, exactly as it is, until something can touch or push it.
//!
//! Bodies that constraints, limits, springs and resting contacts put together are an *island* (E. Catto, "Simulation
//! Islands", box2d.org, 2023). With ρ a body's radius of gyration, an island falls asleep when for all of it
//!
//! ```text
//! v² + ρ² ω² < SLOW²      |ΔF|² + |Δτ|²/ρ² < (m SLIGHT)²       for QUIET seconds on end
//! ```
//!
//! ΔF, Δτ being what the push from outside has changed by since then. A force that were not balanced would have left that
//! speed behind; so would a swing that turns back. Asleep its velocities are nothing, its places do not change by a bit, and no
//! row, contact, limit or spring of it is looked at. It wakes when
//!
//! - the push on one of its bodies changes by SLIGHT: wind, breath, hand;
//! - something that is awake hits it, or comes to lean on it;
//! - a window opens or closes anywhere, or something breaks;
//! - bodies are set from outside, or moved by places.
//!
//! Nobody falls asleep while a row is drawn together, acts in part or waits for its window, or while a clutch slips. What a
//! function of time acts on, or what is joined to a driven body or lies on one, never sleeps. Waking goes on to what leans on
//! what wakes. What it had left of energy is entered with the work of its contacts.

use crate::articulation::{Constraint, ConstraintKind, Groups, Limit, Spring};
use soffio_geometry::bodies::RigidBody;
use soffio_math::Function;
use soffio_math::spatial::{Vec6, angular, linear};

/// Slower than this is rest, m/s: less than a millimetre in a day, and more than what the contact solver leaves to the top of a tower of
/// twenty boxes.
const SLOW: f64 = 1e-8;
/// For so long, s: a swing of ω that is wider than 2 SLOW/(ω² QUIET), some nanometres, does not pause for as long.
const QUIET: f64 = 1.0;
/// Acceleration that a change of push may be worth, m/s²: it would make a body SLOW in the same time.
const SLIGHT: f64 = SLOW / QUIET;

/// Who sleeps. Nothing here allocates after [`Sleep::new`].
#[derive(Clone, Debug)]
pub(super) struct Sleep {
    /// Can anything ever sleep?
    possible: bool,
    /// What is joined, and with it what leans on each other.
    joined: Groups,
    islands: Groups,
    is_kinematic: Vec<bool>,
    /// ρ², m².
    gyration: Vec<f64>,
    /// Whether a body never sleeps, and whether its island cannot now, told by the first body.
    restless: Vec<bool>,
    stays: Vec<bool>,
    /// For how long each has been slow under the same push, s; that push.
    quiet: Vec<f64>,
    push: Vec<Vec6>,
    asleep: Vec<bool>,
    count: usize,
}

impl Sleep {
    /// Nobody sleeps yet, nor ever if it is not `possible`.
    pub fn new(
        bodies: &[RigidBody],
        is_kinematic: &[bool],
        (constraints, limits, springs): (&[Constraint], &[Limit], &[Spring]),
        possible: bool,
    ) -> Self {
        let n = bodies.len();
        let mut joined = Groups::new(n);
        let mut restless = vec![false; n];
        let mut tie = |touches: &dyn Fn(usize) -> bool, changes: bool| {
            let held = || (0..n).filter(|&body| !is_kinematic[body] && touches(body));
            joined.join_all(held());
            if changes || (0..n).any(|body| is_kinematic[body] && touches(body)) {
                held().for_each(|body| restless[body] = true);
            }
        };
        let changes = |function: &Function| !matches!(function, Function::Constant(_));
        for constraint in constraints {
            let moves = match &constraint.kind {
                ConstraintKind::PointOnPlane { offset, .. } => changes(offset),
                ConstraintKind::Orientation { angle, .. } => changes(angle),
                ConstraintKind::PointToPoint { .. } | ConstraintKind::Coupling { .. } => false,
            };
            tie(&|body| constraint.kind.touches(body), moves);
        }
        for limit in limits {
            tie(&|body| limit.kind.touches(body), false);
        }
        for spring in springs {
            let moves = [&spring.rest, &spring.stiffness, &spring.damping].into_iter().any(changes);
            tie(&|body| spring.kind.touches(body), moves);
        }
        let inertia = |body: &RigidBody| body.properties.inertia;
        let trace = |body: &RigidBody| inertia(body).x_axis.x + inertia(body).y_axis.y + inertia(body).z_axis.z;
        Self {
            possible,
            islands: joined.clone(),
            joined,
            gyration: bodies.iter().map(|body| trace(body) / (2.0 * body.properties.mass)).collect(),
            is_kinematic: is_kinematic.to_vec(),
            restless,
            stays: vec![false; n],
            quiet: vec![0.0; n],
            push: vec![[0.0; 6]; n],
            asleep: vec![false; n],
            count: 0,
        }
    }

    /// Does anybody sleep?
    pub fn any(&self) -> bool {
        self.count > 0
    }

    /// Who sleeps, by bodies.
    pub fn asleep(&self) -> &[bool] {
        &self.asleep
    }

    /// Notes for how long bodies have been quiet, `dt` seconds later under this push.
    pub fn watch(&mut self, dt: f64, bodies: &[RigidBody], push: &[Vec6]) {
        if !self.possible {
            return;
        }
        for (index, body) in bodies.iter().enumerate().filter(|(index, _)| !self.asleep[*index]) {
            let square = body.velocity.length_squared() + self.gyration[index] * body.angular_velocity.length_squared();
            if square < SLOW * SLOW && !self.pushed(index, body, &push[index]) {
                self.quiet[index] += dt;
            } else {
                (self.quiet[index], self.push[index]) = (0.0, push[index]);
            }
        }
    }

    /// Is a body pushed otherwise than when it came to rest?
    fn pushed(&self, index: usize, body: &RigidBody, push: &Vec6) -> bool {
        let change: Vec6 = std::array::from_fn(|k| push[k] - self.push[index][k]);
        let slight = body.properties.mass * SLIGHT;
        let square = linear(&change).length_squared() + angular(&change).length_squared() / self.gyration[index];
        // What is no number is a push.
        square.is_nan() || square > slight * slight
    }

    /// A body that sleeps and is pushed, or no longer where it fell asleep (`placed`).
    pub fn roused(&self, bodies: &[RigidBody], placed: &[RigidBody], push: &[Vec6]) -> Option<usize> {
        let roused = |&body: &usize| {
            self.asleep[body] && (self.pushed(body, &bodies[body], &push[body]) || bodies[body] != placed[body])
        };
        if self.any() { (0..bodies.len()).find(roused) } else { None }
    }

    /// Lets fall asleep what is quiet with all that leans on it. Did anything?
    pub fn fall(&mut self, resting_pairs_bodies: impl Iterator<Item = [Option<usize>; 2]>) -> bool {
        let n = self.asleep.len();
        let tired =
            |sleep: &Self, body: usize| sleep.quiet[body] >= QUIET && !sleep.asleep[body] && !sleep.is_kinematic[body];
        if !(0..n).any(|body| tired(self, body)) {
            return false;
        }
        self.look_for_islands(resting_pairs_bodies);
        for body in 0..n {
            if !self.is_kinematic[body] && (self.restless[body] || self.quiet[body] < QUIET || self.stays[body]) {
                self.stays[self.islands.first(body)] = true;
            }
        }
        let before = self.count;
        for body in 0..n {
            if tired(self, body) && !self.stays[self.islands.first(body)] {
                self.asleep[body] = true;
                self.count += 1;
            }
        }
        self.count > before
    }

    /// Wakes a body with its island. Did it sleep?
    pub fn wake(&mut self, body: usize, resting_pairs_bodies: impl Iterator<Item = [Option<usize>; 2]>) -> bool {
        if !self.asleep[body] {
            return false;
        }
        self.look_for_islands(resting_pairs_bodies);
        let island = self.islands.first(body);
        for body in 0..self.asleep.len() {
            if self.asleep[body] && self.islands.first(body) == island {
                (self.asleep[body], self.quiet[body]) = (false, 0.0);
                self.count -= 1;
            }
        }
        true
    }

    /// Wakes all. Did anybody sleep?
    pub fn wake_all(&mut self) -> bool {
        self.asleep.fill(false);
        self.quiet.fill(0.0);
        std::mem::take(&mut self.count) > 0
    }

    /// Puts back what sleeps to where it was before, to the bit: turning by nothing may round.
    pub fn keep(&self, bodies: &mut [RigidBody], before: &[RigidBody]) {
        if self.any() {
            let all = bodies.iter_mut().zip(before).zip(&self.asleep);
            all.filter(|(_, asleep)| **asleep).for_each(|((body, before), _)| *body = *before);
        }
    }

    /// Puts together what leans on each other; what lies on a driven body stays awake.
    fn look_for_islands(&mut self, resting_pairs_bodies: impl Iterator<Item = [Option<usize>; 2]>) {
        self.islands.copy(&self.joined);
        self.stays.fill(false);
        for pair in resting_pairs_bodies {
            let [Some(a), Some(b)] = pair else { continue };
            match (self.is_kinematic[a], self.is_kinematic[b]) {
                (false, false) => self.islands.join(a, b),
                (true, _) => self.stays[b] = true,
                (_, true) => self.stays[a] = true,
            }
        }
    }
}
