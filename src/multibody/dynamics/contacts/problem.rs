//! The contact problem: impulses of all touching points and bounds at once, joints held.
//!
//! Symbols: J_c the rows of all touches (per point: normal n, then two tangents; per bound of a limit: one), H the
//! joints' system, u = J_c v the velocities of the touches, P their impulses, t the least normal velocities allowed:
//!
//! ```text
//! u = u₀ + W (P − P₀)        W = J_c H⁻¹ J_cᵀ       (one tree solve per row; P₀ has already acted)
//! 0 ≤ P_n ⟂ u_n − t ≥ 0      no pull, no approach, no push where it opens          (Signorini)
//! |P_T| ≤ μ P_n              u_T = 0 inside the cone, P_T = −μ P_n u_T/|u_T| on it  (Coulomb)
//! ```
//!
//! Solved by block Gauss–Seidel (M. Jean, The non-smooth contact dynamics method, 1999): touch after touch, each exact
//! for itself. Rounds find out which touches press, stick and slide long before they find the impulses, above all in
//! stacks and where heavy bodies lie on light ones; so every few rounds a *leap* (`leap`) solves the linear system of the
//! touches that press, as they stick or slide now. W is only positive semi-definite (four feet of a box, bodies on hinges); each block's step is therefore
//! a proximal one, (K + ε tr K) ΔP = −u, whose fixed points are the same and which adds nothing where K has nothing
//! to give. The velocities that come out are unique where friction is; the split among redundant feet is the one
//! nearest to where the rounds began.

use super::open::Open;
use super::row::{ROW_ENDS, Row};
use super::touch::{Active, LOCKED, PROXIMAL, ROUNDING, Source, Touch};
use crate::articulation::{Geared, System};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{angular, linear, vec6};
use soffio_math::{DMat3, DVec2, DVec3};

/// Most touches of one problem; deeper ones come first where there are more.
pub(super) const MOST_TOUCHES: usize = 64;
/// Rounds over all touches between two leaps, and leaps. A warm start needs one round; the bound is for heaps that
/// fall.
const ROUNDS: usize = 5;
const LEAPS: usize = 40;
/// Leaps do not heed the bounds of couples, so that balls which roll against each other may go round in circles: after so
/// many leaps that have not halved what rounds change, no more is to be had.
const CIRCLES: usize = 6;
/// Where the rounds run out or go in circles, they were good enough if none changed a velocity by more than this, m/s, or
/// than this share of the velocities that the impulses make alone: heavy bodies on light ones leave no finer.
const NEARLY: f64 = 1e-4;
const NEARLY_SHARE: f64 = 1e-7;
/// Rounds end when none changes a velocity by more than this, m/s: a resting body creeps by less than a hundredth of
/// a micrometre a minute.
const SETTLED: f64 = 1e-11;
/// All touches of one moment.
#[derive(Clone, Debug)]
pub(super) struct Problem {
    pub touches: Vec<Touch>,
    pub rows: Vec<Row>,
    /// What each row pushes of trains, where it touches nothing else.
    geared: Vec<Option<Geared<ROW_ENDS>>>,
    /// W, row by row.
    pub(super) w: Vec<f64>,
    /// Velocities of the rows under the present impulses, m/s.
    pub u: Vec<f64>,
    /// Scratch per row.
    pub(super) other: Vec<f64>,
    /// Unknowns and matrix of a leap.
    pub(super) active: Vec<Active>,
    pub(super) matrix: Vec<f64>,
    /// Rows of the joints that give way.
    open: Open,
}

impl Problem {
    /// Room for this many touches at a time, of a figure whose joints have this many rows and are drawn
    /// together with this time constant (s).
    pub fn new(touches: usize, (joint_rows, time): (usize, f64)) -> Self {
        let touches = touches.min(MOST_TOUCHES);
        let rows = 3 * touches;
        Self {
            touches: Vec::with_capacity(touches),
            rows: Vec::with_capacity(rows),
            geared: Vec::with_capacity(rows),
            w: vec![0.0; rows * rows],
            u: Vec::with_capacity(rows),
            other: vec![0.0; rows],
            active: Vec::with_capacity(rows),
            matrix: vec![0.0; rows * rows],
            open: Open::new(joint_rows, time, rows),
        }
    }

    /// Empties it.
    pub fn clear(&mut self) {
        self.touches.clear();
        self.rows.clear();
    }

    /// Is there room for another touch?
    pub fn has_room(&self) -> bool {
        self.touches.len() < self.touches.capacity()
    }

    /// Adds a touch with its rows.
    pub fn push(&mut self, mut touch: Touch, rows: &[Row]) {
        if self.has_room() {
            (touch.first, touch.rows) = (self.rows.len(), rows.len());
            self.rows.extend_from_slice(rows);
            self.touches.push(touch);
        }
    }

    /// Finds W and the velocities at the bodies' present state; the joints must be factored there.
    pub fn assemble(&mut self, system: &mut System, bodies: &[RigidBody]) {
        let n = self.rows.len();
        self.open.find(system);
        // Of joints that give way the multipliers are asked too.
        let lean = self.open.is_empty();
        self.geared.clear();
        self.geared.extend(self.rows.iter().map(|row| if lean { system.geared(&row.ends) } else { None }));
        for column in 0..n {
            if let Some(geared) = &self.geared[column] {
                system.answer_geared(geared);
                for row in column..n {
                    if let Some(other) = &self.geared[row] {
                        let value = system.geared_rate(other);
                        self.w[row * n + column] = value;
                        self.w[column * n + row] = value;
                    }
                }
                continue;
            }
            system.b.fill([0.0; 6]);
            for (body, block) in self.rows[column].ends.iter().flatten() {
                system.push_impulse(*body, block, 1.0);
            }
            system.solve_impulse();
            for row in (0..n).filter(|&row| row >= column || self.geared[row].is_some()) {
                let value = self.rows[row].along(&system.a);
                self.w[row * n + column] = value;
                self.w[column * n + row] = value;
            }
            self.open.take(column, system);
        }
        if !self.open.is_empty() {
            for row in 0..n {
                for column in 0..n {
                    self.w[row * n + column] += self.open.adds(row, column);
                }
            }
        }
        self.u.clear();
        self.u.extend(self.rows.iter().map(|row| row.rate(bodies)));
        self.take_blocks();
    }

    /// Takes each touch's own block out of W.
    pub(super) fn take_blocks(&mut self) {
        let n = self.rows.len();
        for touch in &mut self.touches {
            let at = |i: usize, j: usize| {
                let inside = i < touch.rows && j < touch.rows;
                if inside { self.w[(touch.first + i) * n + touch.first + j] } else { 0.0 }
            };
            let column = |j| DVec3::new(at(0, j), at(1, j), at(2, j));
            touch.k = DMat3::from_cols(column(0), column(1), column(2));
            let trace = touch.k.x_axis.x + touch.k.y_axis.y + touch.k.z_axis.z;
            let proximal = touch.k + DMat3::from_diagonal(DVec3::splat(PROXIMAL * trace.max(LOCKED)));
            touch.step = proximal.inverse();
            let (a, d, b) = (touch.k.y_axis.y, touch.k.z_axis.z, touch.k.y_axis.z);
            touch.tangential = 0.5 * (a + d) + (0.25 * (a - d) * (a - d) + b * b).sqrt();
        }
    }

    /// Lets every touch begin from its own `begin` where that is not what acted before.
    pub fn begin(&mut self) {
        for index in 0..self.touches.len() {
            let Touch { begin, before, .. } = self.touches[index];
            if begin != before {
                self.set(index, begin);
            }
        }
    }

    /// Velocity of a touch (n, t, b), m/s.
    pub fn velocity(&self, touch: &Touch) -> DVec3 {
        let at = |i| if i < touch.rows { self.u[touch.first + i] } else { 0.0 };
        DVec3::new(at(0), at(1), at(2))
    }

    /// Sets the impulse of a touch and lets all velocities follow. Answers the largest change of its own.
    pub fn set(&mut self, index: usize, impulse: DVec3) -> f64 {
        let touch = &mut self.touches[index];
        let change = impulse - touch.impulse;
        touch.impulse = impulse;
        let n = self.rows.len();
        for i in 0..touch.rows {
            if change[i] != 0.0 {
                let line = &self.w[(touch.first + i) * n..][..n];
                for (u, w) in self.u.iter_mut().zip(line) {
                    *u += w * change[i];
                }
            }
        }
        (touch.k * change).abs().max_element()
    }

    /// Solves for all impulses from where they stand. Answers whether they are good enough to begin from next time.
    pub fn solve(&mut self) -> bool {
        let (mut rest, mut scale) = (f64::INFINITY, 0.0);
        let mut earlier = rest;
        let couples = self.touches.iter().any(|touch| touch.twist.is_some());
        for leap in 0..LEAPS {
            if leap > 0 {
                self.leap();
            }
            if couples && leap % CIRCLES == 0 {
                if rest > 0.5 * earlier && rest <= NEARLY + NEARLY_SHARE * scale {
                    return true;
                }
                earlier = rest;
            }
            for _ in 0..ROUNDS {
                (rest, scale) = self.round();
                if rest <= SETTLED + ROUNDING * scale {
                    return true;
                }
            }
        }
        rest <= NEARLY + NEARLY_SHARE * scale
    }

    /// Solves like [`Problem::solve`], and where the rounds do not settle begins anew: without friction, then from nothing.
    /// Friction among redundant feet may have wandered to its cone, whence no round finds back.
    pub fn solve_anew(&mut self) -> bool {
        self.solve()
            || [1.0, 0.0].into_iter().any(|share| {
                for index in 0..self.touches.len() {
                    let Touch { begin, grip, .. } = self.touches[index];
                    if grip.is_none() {
                        self.set(index, DVec3::X * (share * begin.x));
                    }
                }
                self.solve()
            })
    }

    /// One round over all touches. Answers the largest velocity that it changed, and the largest that any impulse alone
    /// would make, m/s.
    fn round(&mut self) -> (f64, f64) {
        let (mut largest, mut scale): (f64, f64) = (0.0, 0.0);
        for index in 0..self.touches.len() {
            let touch = &self.touches[index];
            if let Some(twist) = touch.twist {
                largest = largest.max(self.turn(index, &twist));
            } else if touch.grip.is_none() && touch.k.x_axis.x > LOCKED {
                let impulse = step(touch, self.velocity(touch));
                scale = scale.max(touch.k.x_axis.x * impulse.x);
                largest = largest.max(self.set(index, impulse));
            }
        }
        (largest, scale)
    }

    /// Solves for friction alone, the normal impulses given.
    pub fn solve_friction(&mut self) -> bool {
        for _ in 0..LEAPS * ROUNDS {
            let mut largest: f64 = 0.0;
            for index in 0..self.touches.len() {
                let touch = &self.touches[index];
                if touch.rows == 3 && touch.tangential > LOCKED {
                    let rub = rub(touch, self.velocity(touch), touch.impulse.x);
                    let impulse = DVec3::new(touch.impulse.x, rub.x, rub.y);
                    largest = largest.max(self.set(index, impulse));
                }
            }
            if largest <= SETTLED {
                return true;
            }
        }
        false
    }

    /// Change of kinetic energy by the impulses so far, of which `before` acted earlier, J: P·(u₀ + u)/2.
    pub fn work(&self) -> f64 {
        let n = self.rows.len();
        let mut work = 0.0;
        for touch in &self.touches {
            for i in 0..touch.rows {
                let row = touch.first + i;
                let gained = self.change(n, row);
                work += (touch.impulse[i] - touch.before[i]) * (self.u[row] - 0.5 * gained);
            }
        }
        work
    }

    /// Row of W (P − P₀).
    fn change(&self, n: usize, row: usize) -> f64 {
        let line = &self.w[row * n..][..n];
        let mut sum = 0.0;
        for touch in &self.touches {
            for i in 0..touch.rows {
                sum += line[touch.first + i] * (touch.impulse[i] - touch.before[i]);
            }
        }
        sum
    }

    /// Largest velocity that the impulses give any touch beyond what acted before, m/s.
    pub fn largest_change(&self) -> f64 {
        let n = self.rows.len();
        let points = self.touches.iter().filter(|touch| touch.twist.is_none());
        let rows = points.flat_map(|touch| touch.first..touch.first + touch.rows);
        rows.fold(0.0, |most: f64, row| most.max(self.change(n, row).abs()))
    }

    /// Slip of the fastest touch, m/s.
    pub fn largest_slip(&self) -> f64 {
        let points = self.touches.iter().filter(|touch| touch.twist.is_none());
        points.fold(0.0, |most: f64, touch| most.max(self.velocity(touch).with_x(0.0).length()))
    }

    /// Applies P − P₀ to the bodies' velocities.
    pub fn apply(&mut self, system: &mut System, bodies: &mut [RigidBody]) {
        self.take_changes();
        self.answer(system);
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

    /// P − P₀ of each row into `other`.
    fn take_changes(&mut self) {
        for touch in &self.touches {
            for i in 0..touch.rows {
                self.other[touch.first + i] = touch.impulse[i] - touch.before[i];
            }
        }
    }

    /// The bodies' answer to the impulses of the rows that stand in `other`.
    fn answer(&self, system: &mut System) {
        self.push_all(system);
        self.open.solve(&self.other[..self.rows.len()], system);
    }

    /// Lays these impulses on the bodies.
    fn push_all(&self, system: &mut System) {
        system.b.fill([0.0; 6]);
        for (row, impulse) in self.rows.iter().zip(&self.other) {
            for (body, block) in row.ends.iter().flatten() {
                system.push_impulse(*body, block, *impulse);
            }
        }
    }

    /// Are there joints that give way, at the last assembly?
    pub fn has_open_joints(&self) -> bool {
        !self.open.is_empty()
    }

    /// Least displacement, in kinetic energy, that brings every gap below `depth` up to it: pushes only, no friction.
    /// Momentum and angular momentum are kept.
    pub fn push_out(&mut self, depth: f64, most: f64, system: &mut System, bodies: &mut [RigidBody]) {
        let n = self.rows.len();
        // `other` holds the opening of each row, `before.x` the push of each touch.
        self.other[..n].fill(0.0);
        for touch in &mut self.touches {
            touch.before = DVec3::ZERO;
        }
        for _ in 0..LEAPS * ROUNDS {
            let mut largest: f64 = 0.0;
            for touch in &mut self.touches {
                if touch.k.x_axis.x <= LOCKED {
                    continue;
                }
                let goal = (depth - touch.gap).min(most);
                let push = (touch.before.x + (goal - self.other[touch.first]) / touch.k.x_axis.x).max(0.0);
                let change = push - touch.before.x;
                touch.before.x = push;
                let line = &self.w[touch.first * n..][..n];
                for (opening, w) in self.other.iter_mut().zip(line) {
                    *opening += w * change;
                }
                largest = largest.max((change * touch.k.x_axis.x).abs());
            }
            if largest < 0.01 * depth.abs() {
                break;
            }
        }
        for touch in &self.touches {
            for i in 0..touch.rows {
                self.other[touch.first + i] = if i == 0 { touch.before.x } else { 0.0 };
            }
        }
        self.answer(system);
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
                let back = vec6(DVec3::ZERO, (-0.5 * touch.before.x * linear(&along)).cross(passes));
                system.push_impulse(a, &back, 1.0);
                system.push_impulse(b, &back, 1.0);
            }
        }
        system.solve_impulse();
        system.apply_velocity(bodies);
    }
}

/// The impulse that satisfies a touch's own laws, the others' impulses as they are.
fn step(touch: &Touch, u: DVec3) -> DVec3 {
    let (p, k) = (touch.impulse, &touch.k);
    let u = DVec3::new(u.x - touch.least, u.y, u.z);
    if touch.rows == 1 || touch.friction == 0.0 {
        return DVec3::new((p.x - u.x / k.x_axis.x).max(0.0), 0.0, 0.0);
    }
    let stuck = p - touch.step * u;
    if stuck.x >= 0.0
        && DVec2::new(stuck.y, stuck.z).length_squared() <= (touch.friction * stuck.x) * (touch.friction * stuck.x)
    {
        return stuck;
    }
    // Slides: the direction that the slip asks for, then the normal impulse that goes with it.
    let pull = if touch.tangential > LOCKED {
        DVec2::new(p.y - u.y / touch.tangential, p.z - u.z / touch.tangential)
    } else {
        DVec2::new(-u.y, -u.z)
    };
    let along = touch.friction * pull.normalize_or_zero();
    let column = DVec3::new(1.0, along.x, along.y);
    let stiffness = (*k * column).x;
    let normal = if stiffness > 0.1 * k.x_axis.x {
        // u_n − K_n P is what the others do.
        ((*k * p).x - u.x) / stiffness
    } else {
        p.x - u.x / k.x_axis.x
    };
    normal.max(0.0) * column
}

/// Friction of a touch under a given normal impulse.
fn rub(touch: &Touch, u: DVec3, normal: f64) -> DVec2 {
    let p = touch.impulse;
    let pull = DVec2::new(p.y - u.y / touch.tangential, p.z - u.z / touch.tangential);
    pull.clamp_length_max(touch.friction * normal.max(0.0))
}
