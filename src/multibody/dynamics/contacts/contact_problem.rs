//! The contact problem: impulses of all touching points and bounds at once, joints held.
//!
//! Symbols: J the rows of all touches (per point: normal n, then two tangents; per bound of a limit: one), H the
//! joints' system, u = J v the velocities of the touches, P their impulses, t the least normal velocities allowed:
//!
//! ```text
//! u = u₀ + W (P − P₀)        W = J H⁻¹ Jᵀ       (P₀ has already acted)
//! 0 ≤ P_n ⟂ u_n − t ≥ 0      no pull, no approach, no push where it opens          (Signorini)
//! |P_T| ≤ μ P_n              u_T = 0 inside the cone, P_T = −μ P_n u_T/|u_T| on it  (Coulomb)
//! ```
//!
//! W is never formed as a whole: `coordinates.rs` writes it as what few coordinates of each body or mechanism answer, `islands.rs`
//! finds what hangs together, `newton.rs` solves. W is only positive semi-definite (four feet of a box, bodies on hinges); the
//! velocities that come out are unique where friction is, and the split among redundant feet is the one nearest to where the
//! solver began.

use super::contact::{LOCKED, PROXIMAL, Source, Touch};
use super::contact_law::{Answer, Law};
use super::contact_solver::{Iterate, Newton, View};
use super::islands::{Island, Islands};
use super::jacobian_row::Row;
use super::reduced_coordinates::{Coordinates, Mechanisms};
use crate::articulation::System;
use crate::dynamics::work_budget::TOUCH;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{angular, linear, vec6};
use soffio_math::{DMat3, DVec3};

/// Room for so many touches at once; more make lists grow.
const ROOM: usize = 256;

/// Time in which bodies are moved out of each other, as far as the solver's bounds of velocities go, s: 10⁻⁵ m/s are 10 nm.
const PUSH_TIME: f64 = 1e-3;

/// All touches of one moment.
#[derive(Clone, Debug)]
pub(super) struct Problem {
    pub touches: Vec<Touch>,
    pub rows: Vec<Row>,
    coordinates: Coordinates,
    islands: Islands,
    newton: Newton,
    /// Impulse of each row.
    impulses: Vec<f64>,
    /// Operations so far (`dynamics/effort.rs`).
    pub effort: u64,
}

impl Problem {
    /// Room for about this many touches at a time, of a figure of these mechanisms whose joints have this many rows and are
    /// drawn together with this time constant (s).
    pub fn new(touches: usize, mechanisms: Mechanisms, joints: (usize, f64)) -> Self {
        let (touches, bodies) = (touches.min(ROOM), mechanisms.count());
        Self {
            touches: Vec::with_capacity(touches),
            rows: Vec::with_capacity(3 * touches),
            newton: Newton::with_room(touches, bodies),
            coordinates: Coordinates::new(mechanisms, touches, joints),
            islands: Islands::with_room(bodies, touches),
            impulses: Vec::with_capacity(3 * touches),
            effort: 0,
        }
    }

    /// Empties it.
    pub fn clear(&mut self) {
        self.touches.clear();
        self.rows.clear();
    }

    /// Adds a touch with its rows.
    pub fn push(&mut self, mut touch: Touch, rows: &[Row]) {
        (touch.first, touch.rows) = (self.rows.len(), rows.len());
        self.rows.extend_from_slice(rows);
        self.touches.push(touch);
    }

    /// Finds what moves how, at the bodies' present state; the joints must be factored there. All impulses are what acted before.
    pub fn assemble(&mut self, system: &mut System, bodies: &[RigidBody]) {
        let Self { touches, rows, coordinates, islands, newton, .. } = self;
        coordinates.assemble(touches, rows, system, bodies);
        islands.find(coordinates, touches);
        self.effort += TOUCH * touches.len() as u64;
        newton.begin(coordinates.nodes.iter().map(|node| node.size).sum());
        newton.iterates.clear();
        for index in 0..touches.len() {
            touches[index].weigh(coordinates);
            if let Some(twist) = touches[index].twist {
                let push = touches[twist.of].k().x_axis.x;
                touches[index].answer.arm = (push / touches[index].answer.most().max(LOCKED)).sqrt();
            }
            let touch = &touches[index];
            let rate = |k: usize| if k < touch.rows { rows[touch.first + k].rate(bodies) } else { 0.0 };
            let start = DVec3::new(rate(0), rate(1), rate(2));
            newton.iterates.push(Iterate::new(touch, start));
        }
    }

    /// Lets every touch begin from its own `begin`.
    pub fn begin(&mut self) {
        self.touches.iter_mut().for_each(|touch| touch.impulse = touch.begin);
    }

    /// Velocity of a touch (n, t, b) under the impulses last solved for or followed, m/s.
    pub fn velocity(&self, touch: usize) -> DVec3 {
        self.newton.iterates[touch].u
    }

    /// How fast a touch of what met at the share `s` of a substep that began so approached there, m/s; forces change that evenly.
    pub fn approach(&self, touch: usize, s: f64, start: &[RigidBody]) -> f64 {
        let (first, last) = (self.rows[self.touches[touch].first].rate(start), self.velocity(touch).x);
        -(first + s * (last - first))
    }

    /// Lets all velocities follow from the impulses as they are.
    pub fn follow(&mut self) {
        for (touch, iterate) in self.touches.iter().zip(&mut self.newton.iterates) {
            iterate.p = touch.impulse;
        }
        let view = View { touches: &self.touches, coordinates: &self.coordinates, islands: &self.islands };
        for island in &self.islands.islands {
            self.newton.follow(view, island);
        }
    }

    /// Solves for all impulses from where they stand: first as if all clutches took hold, then with those slipping that would carry
    /// too much. Where teeth jam, both may be possible; then they hold.
    pub fn solve(&mut self) {
        loop {
            self.solve_by(|touch, touches| touch.law(touch.twist.map_or(0.0, |twist| touches[twist.of].impulse.x)));
            let mut gives = false;
            for touch in &mut self.touches {
                let Some(grip) = &mut touch.grip else { continue };
                if !grip.slips && touch.impulse.x.abs() > grip.most {
                    (grip.slips, gives) = (true, true);
                }
            }
            if !gives {
                return;
            }
        }
    }

    /// Solves for friction alone, the normal impulses given.
    pub fn solve_friction(&mut self) {
        self.solve_by(|touch, _| {
            let free = touch.rows == 3 && touch.answer.across > LOCKED;
            if free { Law::Friction(touch.friction * touch.impulse.x) } else { Law::Still }
        })
    }

    fn solve_by(&mut self, law: impl Fn(&Touch, &[Touch]) -> Law) {
        let Self { touches, coordinates, islands, newton, .. } = self;
        for (touch, iterate) in touches.iter().zip(&mut newton.iterates) {
            iterate.begin(touch, law(touch, touches));
        }
        newton.solve(View { touches, coordinates, islands });
        self.effort += std::mem::take(&mut newton.effort);
        for (touch, iterate) in touches.iter_mut().zip(&newton.iterates) {
            touch.impulse = iterate.p;
        }
    }

    /// Change of kinetic energy by the impulses so far, of which P₀ acted earlier, J: (P − P₀)·(u₀ + u)/2.
    pub fn work(&self) -> f64 {
        let work = |touch: &Iterate| (touch.p - touch.before).dot(0.5 * (touch.start + touch.u));
        self.newton.iterates.iter().map(work).sum()
    }

    /// Is the impulse of a touch good enough to begin from next time?
    pub fn is_good(&self, touch: usize) -> bool {
        self.newton.iterates[touch].good
    }

    fn points(&self) -> impl Iterator<Item = &Iterate> {
        self.touches.iter().zip(&self.newton.iterates).filter(|(touch, _)| touch.twist.is_none()).map(|(_, own)| own)
    }

    /// Largest velocity that the impulses give any touch beyond what acted before, m/s.
    pub fn largest_change(&self) -> f64 {
        self.points().fold(0.0, |most: f64, touch| most.max((touch.u - touch.start).abs().max_element()))
    }

    /// Slip of the fastest touch, m/s.
    pub fn largest_slip(&self) -> f64 {
        self.points().fold(0.0, |most: f64, touch| most.max(touch.u.with_x(0.0).length()))
    }

    /// Applies P − P₀ to the bodies' velocities.
    pub fn apply(&mut self, system: &mut System, bodies: &mut [RigidBody]) {
        self.take_changes();
        self.push_all(system);
        self.coordinates.answer(&self.impulses, system);
        system.apply_velocity(bodies);
        // What rounding has left to the joints where much is taken up by little.
        system.solve_velocity(bodies);
        system.apply_velocity(bodies);
    }

    /// The same, and what joints lacked in speed before, by one solve; for joints that all hold.
    pub fn apply_closing(&mut self, system: &mut System, bodies: &mut [RigidBody]) {
        if self.has_open_joints() {
            return self.apply(system, bodies);
        }
        self.take_changes();
        self.push_all(system);
        system.solve_velocity_under(bodies);
        system.apply_velocity(bodies);
    }

    /// P − P₀ of each row.
    fn take_changes(&mut self) {
        self.impulses.clear();
        for touch in &self.touches {
            let change = touch.impulse - touch.before;
            self.impulses.extend((0..touch.rows).map(|k| change[k]));
        }
    }

    /// Lays the rows' impulses on the bodies.
    fn push_all(&self, system: &mut System) {
        system.b.fill([0.0; 6]);
        for (row, impulse) in self.rows.iter().zip(&self.impulses).filter(|(_, impulse)| **impulse != 0.0) {
            for (body, block) in row.ends.iter().flatten() {
                system.push_impulse(*body, block, *impulse);
            }
        }
    }

    /// Are there joints that give way, at the last assembly?
    pub fn has_open_joints(&self) -> bool {
        self.coordinates.has_open_joints()
    }

    /// Takes all impulses for nothing that goes on in the islands of these touches: impacts are not forces.
    pub fn hide_struck(&mut self, touches: impl Iterator<Item = usize>) {
        for struck in touches {
            let with = |island: &&Island| self.islands.touches[island.touches.clone()].binary_search(&struck).is_ok();
            if let Some(island) = self.islands.islands.iter().find(with) {
                for &touch in &self.islands.touches[island.touches.clone()] {
                    self.touches[touch].impulse = DVec3::ZERO;
                }
            }
        }
    }

    /// Least displacement, in kinetic energy, that brings every gap below `depth` up to it: pushes only, no friction.
    /// Momentum and angular momentum are kept. It is the same problem with the velocities of [`PUSH_TIME`] for ways.
    pub fn push_out(&mut self, depth: f64, most: f64, system: &mut System, bodies: &mut [RigidBody]) {
        let Self { touches, coordinates, islands, newton, impulses, .. } = self;
        for (touch, iterate) in touches.iter().zip(&mut newton.iterates) {
            let law = if touch.answer.k.x_axis.x > LOCKED { Law::Bound } else { Law::Still };
            *iterate = Iterate::pushed(touch, (depth - touch.gap).min(most) / PUSH_TIME, law);
        }
        newton.solve(View { touches, coordinates, islands });
        impulses.clear();
        for (touch, iterate) in touches.iter().zip(&newton.iterates) {
            impulses.extend((0..touch.rows).map(|k| if k == 0 { PUSH_TIME * iterate.p.x } else { 0.0 }));
        }
        self.push_all(system);
        self.coordinates.answer(&self.impulses, system);
        for (body, a) in bodies.iter_mut().zip(&system.a) {
            // Its spin's momentum stays where it points.
            let spin = body.inertia_world() * body.angular_velocity;
            body.displace(linear(a), angular(a));
            body.angular_velocity = body.inertia_world().inverse() * spin;
        }
        // Bodies that pass each other at v are moved by a push p: p × v of angular momentum goes back to them in halves.
        system.b.fill([0.0; 6]);
        for touch in self.touches.iter().filter(|touch| matches!(touch.source, Source::Pair(_))) {
            if let [Some((a, along)), Some((b, _)), _] = self.rows[touch.first].ends {
                let passes = bodies[a].velocity - bodies[b].velocity;
                let back = vec6(DVec3::ZERO, (-0.5 * self.impulses[touch.first] * linear(&along)).cross(passes));
                system.push_impulse(a, &back, 1.0);
                system.push_impulse(b, &back, 1.0);
            }
        }
        system.solve_impulse();
        system.apply_velocity(bodies);
    }
}

impl Touch {
    /// Takes the touch's own block of W, and what of it lies across the normal at most.
    fn weigh(&mut self, coordinates: &Coordinates) {
        let mut k = [[0.0; 3]; 3];
        for part in coordinates.parts_of(self) {
            let size = coordinates.nodes[part.node].size;
            let block = coordinates.block(part, self.rows);
            for i in 0..self.rows {
                for j in 0..self.rows {
                    let (row, column) = (&block[i * size..][..size], &block[j * size..][..size]);
                    k[i][j] += row.iter().zip(column).map(|(x, y)| x * y).sum::<f64>();
                }
            }
        }
        let (a, d, b) = (k[1][1], k[2][2], k[1][2]);
        let (k, trace) = (DMat3::from_cols_array_2d(&k), k[0][0] + a + d);
        let inverse = (k + DMat3::from_diagonal(DVec3::splat(PROXIMAL * trace.max(LOCKED)))).inverse();
        let across = 0.5 * (a + d) + (0.25 * (a - d) * (a - d) + b * b).sqrt();
        self.answer = Answer { k, inverse, across, arm: 1.0 };
    }
}
