//! Sleep of islands at rest: their bodies are left out of all computations until something disturbs them.
//!
//! An *island* is all bodies that constraints, limits, springs and resting contacts connect (E. Catto, "Simulation Islands",
//! box2d.org, 2023). With ρ a body's radius of gyration, an island falls asleep when all its bodies satisfy
//!
//! ```text
//! v² + ρ² ω² < SLOW²      |ΔF|² + |Δτ|²/ρ² < (m SLIGHT)²       for QUIET seconds in a row
//! ```
//!
//! ΔF and Δτ are the changes of the external wrench since then. An unbalanced force, or a swing at its turning point, would exceed
//! that speed within this time. Asleep, velocities are zero, poses are constant to the bit, and no row, contact, limit or
//! spring of the island is evaluated. It wakes when
//!
//! - the external wrench on one of its bodies changes by SLIGHT: wind, breath, a pointer;
//! - an awake body hits it or comes to rest on it;
//! - the activation of any constraint changes, or one breaks;
//! - bodies are set from outside.
//!
//! In position-based motion all islands fall asleep together ([`Extent::All`]) and wake together.
//!
//! No island falls asleep while a row is being stabilised, is partly active or waits for its window, or while a clutch slips.
//! Bodies under a function of time never sleep, nor those connected to a kinematic body or resting on one. Waking spreads through
//! resting contacts. The remaining energy counts as work of the contacts.

use crate::articulation::{Constraint, ConstraintKind, DisjointSets, Limit, Spring};
use soffio_geometry::bodies::RigidBody;
use soffio_math::Function;
use soffio_math::spatial::{Vec6, angular, linear};

/// Slower than this is at rest, m/s: less than a millimetre a day, and more than the contact solver's error at the top of a tower
/// of twenty boxes.
const SLOW: f64 = 1e-8;
/// For so long, s. A swing of the frequency ω and an amplitude above 2 SLOW/(ω² QUIET), some nanometres, never pauses so long.
const QUIET: f64 = 1.0;
/// Largest acceleration by a change of the external wrench, m/s²: it gives a body the speed SLOW in that time.
const SLIGHT: f64 = SLOW / QUIET;

/// Which bodies sleep. Nothing here allocates after [`Sleep::new`].
#[derive(Clone, Debug)]
pub(super) struct Sleep {
    /// Some body may ever sleep.
    possible: bool,
    /// Bodies that constraints, limits and springs connect.
    connected: DisjointSets,
    /// The same and resting contacts.
    islands: DisjointSets,
    is_kinematic: Vec<bool>,
    /// ρ², m².
    gyration: Vec<f64>,
    /// Whether each body never sleeps.
    never_sleeps: Vec<bool>,
    /// Whether an island cannot sleep now, by its first body.
    stays_awake: Vec<bool>,
    /// For how long each body has been slow under the same wrench, s.
    quiet: Vec<f64>,
    /// That wrench, N and N m.
    wrench: Vec<Vec6>,
    asleep: Vec<bool>,
    count: usize,
}

/// Which bodies fall asleep together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Extent {
    /// Those of an island.
    Island,
    /// All.
    All,
}

/// What connects the bodies of an articulation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Connections<'a> {
    /// All constraints.
    pub constraints: &'a [Constraint],
    /// All joint limits.
    pub limits: &'a [Limit],
    /// All springs.
    pub springs: &'a [Spring],
}

impl Sleep {
    /// All bodies are awake, and stay so if sleep is not `possible`.
    pub fn new(
        bodies: &[RigidBody],
        is_kinematic: &[bool],
        Connections { constraints, limits, springs }: Connections,
        possible: bool,
    ) -> Self {
        let n = bodies.len();
        let mut connected = DisjointSets::new(n);
        let mut never_sleeps = vec![false; n];
        let mut connect = |acts_on: &dyn Fn(usize) -> bool, changes: bool| {
            let bodies = || (0..n).filter(|&body| !is_kinematic[body] && acts_on(body));
            connected.join_all(bodies());
            if changes || (0..n).any(|body| is_kinematic[body] && acts_on(body)) {
                bodies().for_each(|body| never_sleeps[body] = true);
            }
        };
        let changes = |function: &Function| !matches!(function, Function::Constant(_));
        for constraint in constraints {
            let moves = match &constraint.kind {
                ConstraintKind::PointOnPlane { offset, .. } => changes(offset),
                ConstraintKind::Orientation { angle, .. } => changes(angle),
                ConstraintKind::PointToPoint { .. } | ConstraintKind::Coupling { .. } => false,
            };
            connect(&|body| constraint.kind.acts_on(body), moves);
        }
        for limit in limits {
            connect(&|body| limit.kind.acts_on(body), false);
        }
        for spring in springs {
            let moves = [&spring.rest_length, &spring.stiffness, &spring.damping].into_iter().any(changes);
            connect(&|body| spring.kind.acts_on(body), moves);
        }
        let inertia = |body: &RigidBody| body.properties.inertia;
        let trace = |body: &RigidBody| inertia(body).x_axis.x + inertia(body).y_axis.y + inertia(body).z_axis.z;
        Self {
            possible,
            islands: connected.clone(),
            connected,
            gyration: bodies.iter().map(|body| trace(body) / (2.0 * body.properties.mass)).collect(),
            is_kinematic: is_kinematic.to_vec(),
            never_sleeps,
            stays_awake: vec![false; n],
            quiet: vec![0.0; n],
            wrench: vec![[0.0; 6]; n],
            asleep: vec![false; n],
            count: 0,
        }
    }

    /// Whether any body sleeps.
    pub fn any(&self) -> bool {
        self.count > 0
    }

    /// Whether all bodies sleep. A kinematic one never does.
    pub fn all(&self) -> bool {
        self.count == self.asleep.len()
    }

    /// Whether each body sleeps.
    pub fn asleep(&self) -> &[bool] {
        &self.asleep
    }

    /// Records for how long bodies have been quiet, after `dt` seconds under these external wrenches.
    pub fn record(&mut self, dt: f64, bodies: &[RigidBody], wrenches: &[Vec6]) {
        if !self.possible {
            return;
        }
        for (index, body) in bodies.iter().enumerate().filter(|(index, _)| !self.asleep[*index]) {
            let square = body.velocity.length_squared() + self.gyration[index] * body.angular_velocity.length_squared();
            if square < SLOW * SLOW && !self.wrench_changed(index, body, &wrenches[index]) {
                self.quiet[index] += dt;
            } else {
                (self.quiet[index], self.wrench[index]) = (0.0, wrenches[index]);
            }
        }
    }

    /// Whether the external wrench on a body differs from that under which it came to rest.
    fn wrench_changed(&self, index: usize, body: &RigidBody, wrench: &Vec6) -> bool {
        let change: Vec6 = std::array::from_fn(|k| wrench[k] - self.wrench[index][k]);
        let slight = body.properties.mass * SLIGHT;
        let square = linear(&change).length_squared() + angular(&change).length_squared() / self.gyration[index];
        // NaN is a change.
        square.is_nan() || square > slight * slight
    }

    /// A sleeping body whose wrench changed, or whose state is no longer the one in which it fell asleep (`placed`).
    pub fn disturbed(&self, bodies: &[RigidBody], placed: &[RigidBody], wrenches: &[Vec6]) -> Option<usize> {
        let is_disturbed = |&body: &usize| {
            self.asleep[body]
                && (self.wrench_changed(body, &bodies[body], &wrenches[body]) || bodies[body] != placed[body])
        };
        if self.any() { (0..bodies.len()).find(is_disturbed) } else { None }
    }

    /// Puts quiet islands to sleep, or all if all are quiet. `resting` are the two bodies of every resting contact. Returns whether
    /// any fell asleep.
    pub fn fall_asleep(&mut self, extent: Extent, resting: impl Iterator<Item = [Option<usize>; 2]>) -> bool {
        let n = self.asleep.len();
        let is_ready =
            |sleep: &Self, body: usize| sleep.quiet[body] >= QUIET && !sleep.asleep[body] && !sleep.is_kinematic[body];
        if !(0..n).any(|body| is_ready(self, body)) {
            return false;
        }
        self.find_islands(resting);
        for body in 0..n {
            if !self.is_kinematic[body]
                && (self.never_sleeps[body] || self.quiet[body] < QUIET || self.stays_awake[body])
            {
                self.stays_awake[self.islands.first(body)] = true;
            }
        }
        let first = |body: usize| self.islands.first(body);
        if extent == Extent::All && (0..n).any(|body| self.is_kinematic[body] || self.stays_awake[first(body)]) {
            return false;
        }
        let before = self.count;
        for body in 0..n {
            if is_ready(self, body) && !self.stays_awake[self.islands.first(body)] {
                self.asleep[body] = true;
                self.count += 1;
            }
        }
        self.count > before
    }

    /// Wakes a body with its island. Returns whether it slept.
    pub fn wake(&mut self, body: usize, resting: impl Iterator<Item = [Option<usize>; 2]>) -> bool {
        if !self.asleep[body] {
            return false;
        }
        self.find_islands(resting);
        let island = self.islands.first(body);
        for body in 0..self.asleep.len() {
            if self.asleep[body] && self.islands.first(body) == island {
                (self.asleep[body], self.quiet[body]) = (false, 0.0);
                self.count -= 1;
            }
        }
        true
    }

    /// Wakes all bodies. Returns whether any slept.
    pub fn wake_all(&mut self) -> bool {
        self.asleep.fill(false);
        self.quiet.fill(0.0);
        std::mem::take(&mut self.count) > 0
    }

    /// Restores the state of sleeping bodies to the bit, because a rotation by zero may round.
    pub fn restore_sleeping(&self, bodies: &mut [RigidBody], before: &[RigidBody]) {
        if self.any() {
            let all = bodies.iter_mut().zip(before).zip(&self.asleep);
            all.filter(|(_, asleep)| **asleep).for_each(|((body, before), _)| *body = *before);
        }
    }

    /// Finds islands with these resting contacts; islands on a kinematic body stay awake.
    fn find_islands(&mut self, resting: impl Iterator<Item = [Option<usize>; 2]>) {
        self.islands.copy(&self.connected);
        self.stays_awake.fill(false);
        for pair in resting {
            let [Some(a), Some(b)] = pair else { continue };
            match (self.is_kinematic[a], self.is_kinematic[b]) {
                (false, false) => self.islands.join(a, b),
                (true, _) => self.stays_awake[b] = true,
                (_, true) => self.stays_awake[a] = true,
            }
        }
    }
}
