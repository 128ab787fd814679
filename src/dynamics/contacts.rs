//! Contacts of a figure in motion: impacts at their own time, resting contact without jitter, tilt limits.
//!
//! A pair is *apart* until its time of impact inside a substep; the substep is cut there and the hit resolved with
//! the joints' own factor, so that it travels through the whole figure:
//!
//! ```text
//! u' = u + K P        K = J_c H⁻¹ J_cᵀ        (three tree solves; J_c the contact's rows, joints held)
//! ```
//!
//! A pair that meets slower than [`REST_SPEED`], or slowly and again within [`CHATTER_TIME`], *rests*: from then on its approach is taken out without bounce at the
//! end of each substep, and penetration beyond the touching layer is pushed back through the same factor. It is apart
//! again when it has opened by more than [`RELEASE_GAP`].

use crate::articulation::block::{Vec6, dot, vec6};
use crate::articulation::{Limit, LimitKind, System};
use crate::bodies::RigidBody;
use crate::collision::{Collider, Corners, Pair, Proximity, Sweep, TOUCH, TimeOfImpact, time_of_impact};
use crate::math::{DMat3, DVec3, Pose, cos, tangents};

use super::impulse::impulse;

/// Slower approaches do not bounce and make no sound, m/s.
const REST_SPEED: f64 = 4e-3;
/// Bounces nearer in time than this, and slower than that, are one contact: no ear tells them apart, s and m/s.
const CHATTER_TIME: f64 = 5e-3;
const CHATTER_SPEED: f64 = 0.03;
/// A resting pair that opens farther than this is apart again, m.
const RELEASE_GAP: f64 = 5e-5;
/// Impacts resolved at their own time in one step; further ones are resolved as resting.
const MOST_IMPACTS: usize = 24;
/// Rounds over all resting contacts, each seeing the others' last impulses.
const REST_ROUNDS: usize = 4;
/// A contact whose effective inverse mass is below this (1/kg) is held by joints and cannot move.
const LOCKED: f64 = 1e-9;

/// A pair of colliders and what their surfaces do to each other.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePair {
    /// The colliders.
    pub pair: Pair,
    /// Energetic coefficient of restitution.
    pub restitution: f64,
    /// Coulomb coefficient while sliding.
    pub friction: f64,
}

/// What a contact did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImpactKind {
    /// A hit that bounces.
    Impact,
    /// The beginning of rest.
    Rest,
}

/// One hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Seconds after the beginning of the step.
    pub time: f64,
    /// What it did.
    pub kind: ImpactKind,
    /// Indices of the two colliders.
    pub colliders: [usize; 2],
    /// World, m.
    pub point: DVec3,
    /// Unit, from the second collider to the first.
    pub normal: DVec3,
    /// N s.
    pub impulse: f64,
    /// Approach speed along the normal, m/s.
    pub speed: f64,
    /// Effective mass along the normal, joints included, kg.
    pub mass: f64,
}

/// The first hit of a substep.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    /// Share of the substep.
    pub s: f64,
    pair: usize,
    proximity: Proximity,
}

/// Pairs of the same two bodies: `first` up to `end`.
#[derive(Clone, Copy, Debug)]
struct Run {
    a: usize,
    b: Option<usize>,
    first: usize,
    end: usize,
}

/// All pairs of a figure that can meet, and their state.
#[derive(Clone, Debug)]
pub struct Contacts {
    colliders: Vec<Collider>,
    /// Farthest point of each collider's core from its body's centre of mass, and ball around it in the node frame.
    reach: Vec<f64>,
    balls: Vec<(DVec3, f64)>,
    pairs: Vec<SurfacePair>,
    /// Runs of pairs that belong to the same two bodies, a ball around each body's colliders (node
    /// frame), and their farthest point from the centre of mass.
    runs: Vec<Run>,
    body_balls: Vec<(DVec3, f64)>,
    body_reach: Vec<f64>,
    resting: Vec<bool>,
    /// Seconds since each pair's last hit.
    since_hit: Vec<f64>,
    sweeps: Vec<Sweep>,
    corners: Corners,
    response: [Vec<Vec6>; 3],
    impacts_left: usize,
}

impl Contacts {
    /// The contacts of a figure with these colliders.
    pub fn new(colliders: &[Collider], pairs: Vec<SurfacePair>, bodies: &[RigidBody]) -> Self {
        let balls: Vec<_> = colliders.iter().map(Collider::bounds).collect();
        let reach: Vec<f64> = colliders
            .iter()
            .map(|c| c.shape.reach(c.body.map_or(DVec3::ZERO, |b| bodies[b].properties.center)))
            .collect();
        let blank = vec![[0.0; 6]; bodies.len()];
        let own_reach = |body| {
            let own = colliders.iter().zip(&reach).filter(|(c, _)| c.body == Some(body));
            own.fold(0.0, |most: f64, (_, r)| most.max(*r))
        };
        let body_reach = (0..bodies.len()).map(own_reach).collect();
        let body_balls = (0..bodies.len()).map(|body| ball_around(colliders, &balls, body)).collect();
        Self {
            reach,
            runs: runs(colliders, &pairs),
            body_balls,
            body_reach,
            balls,
            resting: vec![false; pairs.len()],
            since_hit: vec![f64::INFINITY; pairs.len()],
            sweeps: vec![Sweep::STILL; bodies.len()],
            corners: Corners::new(colliders),
            colliders: colliders.to_vec(),
            pairs,
            response: [blank.clone(), blank.clone(), blank],
            impacts_left: MOST_IMPACTS,
        }
    }

    /// Begins a step of `dt` seconds.
    pub(super) fn begin_step(&mut self, dt: f64) {
        self.impacts_left = MOST_IMPACTS;
        for since in &mut self.since_hit {
            *since += dt;
        }
    }

    /// Is any pair resting?
    pub(super) fn has_resting(&self) -> bool {
        self.resting.iter().any(|&r| r)
    }

    /// The first hit of a pair that is apart, between two states of the bodies.
    pub(super) fn first_impact(&mut self, before: &[RigidBody], after: &[RigidBody]) -> Option<Hit> {
        for ((sweep, b), a) in self.sweeps.iter_mut().zip(before).zip(after) {
            *sweep = Sweep::new(b, a);
        }
        let mut first: Option<Hit> = None;
        for run in 0..self.runs.len() {
            let run = self.runs[run];
            if self.bodies_may_meet(&run) {
                self.first_of_run(run, before, after, &mut first);
            }
        }
        first
    }

    /// The earliest hit so far, or an earlier one among the pairs of a run.
    fn first_of_run(&mut self, run: Run, before: &[RigidBody], after: &[RigidBody], first: &mut Option<Hit>) {
        for index in run.first..run.end {
            if self.resting[index] {
                continue;
            }
            let Pair { a, b } = self.pairs[index].pair;
            let (sweep_a, sweep_b) = (self.sweep(a), self.sweep(b));
            if !self.may_meet((a, &sweep_a), (b, &sweep_b)) {
                continue;
            }
            let toi = time_of_impact(
                &mut self.corners,
                (&self.colliders[a], &sweep_a, self.reach[a]),
                (&self.colliders[b], &sweep_b, self.reach[b]),
            );
            let Some(TimeOfImpact { s, proximity }) = toi else { continue };
            // A pair that still touches from its last hit but opens is not hit again.
            let states = if s > 0.0 { after } else { before };
            if self.approach(index, &proximity, states).dot(proximity.normal) >= 0.0 {
                continue;
            }
            if self.impacts_left == 0 {
                self.resting[index] = true;
            } else if first.is_none_or(|f| s < f.s) {
                *first = Some(Hit { s, pair: index, proximity });
            }
        }
    }

    /// Resolves a hit at the bodies' present state; the joints must be factored there.
    pub(super) fn resolve_impact(
        &mut self,
        hit: &Hit,
        time: f64,
        system: &mut System,
        bodies: &mut [RigidBody],
        impacts: &mut Vec<Impact>,
    ) {
        self.impacts_left = self.impacts_left.saturating_sub(1);
        let SurfacePair { pair, restitution, .. } = self.pairs[hit.pair];
        let speed = -self.approach(hit.pair, &hit.proximity, bodies).dot(hit.proximity.normal);
        let chatters = self.since_hit[hit.pair] + time < CHATTER_TIME && speed < CHATTER_SPEED;
        self.since_hit[hit.pair] = -time;
        let rests = speed < REST_SPEED || chatters;
        let e = if rests { 0.0 } else { restitution };
        let Some((impulse, mass)) = self.push_apart(hit.pair, &hit.proximity, e, system, bodies) else { return };
        self.resting[hit.pair] = rests;
        impacts.push(Impact {
            time,
            kind: if rests { ImpactKind::Rest } else { ImpactKind::Impact },
            colliders: [pair.a, pair.b],
            point: hit.proximity.point,
            normal: hit.proximity.normal,
            impulse,
            speed,
            mass,
        });
    }

    /// Takes the approach out of resting pairs, pushes back what has sunk in, releases what has opened.
    pub(super) fn resolve_resting(&mut self, system: &mut System, bodies: &mut [RigidBody]) {
        for round in 0..REST_ROUNDS {
            for index in 0..self.pairs.len() {
                if !self.resting[index] {
                    continue;
                }
                let Pair { a, b } = self.pairs[index].pair;
                let (pose_a, pose_b) = (self.pose(a, bodies), self.pose(b, bodies));
                let proximity = self.corners.proximity(&self.colliders[a], &pose_a, &self.colliders[b], &pose_b);
                if proximity.gap > RELEASE_GAP {
                    self.resting[index] = false;
                    continue;
                }
                if self.approach(index, &proximity, bodies).dot(proximity.normal) < 0.0 {
                    let _ = self.push_apart(index, &proximity, 0.0, system, bodies);
                }
                if round == 0 && proximity.gap < 0.0 {
                    self.lift(index, &proximity, system, bodies);
                }
            }
        }
    }

    /// Relative velocity of the contact points, first minus second, m/s.
    fn approach(&self, pair: usize, proximity: &Proximity, bodies: &[RigidBody]) -> DVec3 {
        let Pair { a, b } = self.pairs[pair].pair;
        let at = |c: usize| self.colliders[c].body.map_or(DVec3::ZERO, |i| bodies[i].velocity_at(proximity.point));
        at(a) - at(b)
    }

    /// Applies the impulse of a contact; returns its size (N s) and the effective mass along the normal (kg).
    fn push_apart(
        &mut self,
        pair: usize,
        proximity: &Proximity,
        e: f64,
        system: &mut System,
        bodies: &mut [RigidBody],
    ) -> Option<(f64, f64)> {
        let (t, b) = tangents(proximity.normal);
        let axes = [t, b, proximity.normal];
        let ends = self.pairs[pair].pair;
        let ends = [(self.colliders[ends.a].body, 1.0), (self.colliders[ends.b].body, -1.0)];
        let block = |body: usize, axis: DVec3, bodies: &[RigidBody]| {
            vec6(axis, (proximity.point - bodies[body].position).cross(axis))
        };
        let mut k = [[0.0; 3]; 3];
        for (column, &axis) in axes.iter().enumerate() {
            system.b.fill([0.0; 6]);
            for (body, sign) in ends {
                let Some(body) = body else { continue };
                system.push_impulse(body, &block(body, axis, bodies), sign);
            }
            system.solve_impulse();
            self.response[column].copy_from_slice(&system.a);
            for (row, &along) in axes.iter().enumerate() {
                for (body, sign) in ends {
                    let Some(body) = body else { continue };
                    k[row][column] += sign * dot(&block(body, along, bodies), &system.a[body]);
                }
            }
        }
        if k[2][2] < LOCKED {
            return None;
        }
        let u = self.approach(pair, proximity, bodies);
        let u = DVec3::new(u.dot(t), u.dot(b), u.dot(proximity.normal));
        let k = DMat3::from_cols_array_2d(&k);
        let k = 0.5 * (k + k.transpose());
        let p = impulse(&k, u, self.pairs[pair].friction, e);
        for (index, body) in bodies.iter_mut().enumerate() {
            for (response, share) in self.response.iter().zip(p.to_array()) {
                body.velocity += share * crate::articulation::block::linear(&response[index]);
                body.angular_velocity += share * crate::articulation::block::angular(&response[index]);
            }
        }
        Some((p.length(), 1.0 / k.z_axis.z))
    }

    /// Moves a pair that has sunk into each other apart along the normal, through the joints.
    fn lift(&mut self, pair: usize, proximity: &Proximity, system: &mut System, bodies: &mut [RigidBody]) {
        let n = proximity.normal;
        let ends = self.pairs[pair].pair;
        system.b.fill([0.0; 6]);
        let mut blocks = [None; 2];
        for (slot, (collider, sign)) in [(ends.a, 1.0), (ends.b, -1.0)].into_iter().enumerate() {
            let Some(body) = self.colliders[collider].body else { continue };
            let block = vec6(sign * n, sign * (proximity.point - bodies[body].position).cross(n));
            system.push_impulse(body, &block, 1.0);
            blocks[slot] = Some((body, block));
        }
        system.solve_impulse();
        let stiffness: f64 = blocks.iter().flatten().map(|(body, block)| dot(block, &system.a[*body])).sum();
        if stiffness > LOCKED {
            // Half of it now: several contacts share the work without pushing each other about.
            let share = 0.5 * (TOUCH - proximity.gap) / stiffness;
            for (body, a) in bodies.iter_mut().zip(&system.a) {
                let step = a.map(|x| x * share);
                body.displace(crate::articulation::block::linear(&step), crate::articulation::block::angular(&step));
            }
        }
    }

    fn sweep(&self, collider: usize) -> Sweep {
        self.colliders[collider].body.map_or(Sweep::STILL, |body| self.sweeps[body])
    }

    fn pose(&self, collider: usize, bodies: &[RigidBody]) -> Pose {
        self.colliders[collider].body.map_or(Pose::IDENTITY, |body| bodies[body].pose())
    }

    /// Can the balls around two bodies meet during the interval? What stands still may be anywhere.
    fn bodies_may_meet(&self, run: &Run) -> bool {
        let Some(b) = run.b else { return true };
        let place = |body: usize| {
            let (center, radius) = self.body_balls[body];
            let sweep = &self.sweeps[body];
            (sweep.pose(0.0).point(center), radius + sweep.travel(self.body_reach[body]))
        };
        let ((at_a, far_a), (at_b, far_b)) = (place(run.a), place(b));
        at_a.distance_squared(at_b) <= (far_a + far_b + TOUCH) * (far_a + far_b + TOUCH)
    }

    /// Can the balls around two colliders meet during the interval?
    fn may_meet(&self, (a, sweep_a): (usize, &Sweep), (b, sweep_b): (usize, &Sweep)) -> bool {
        let ((center_a, radius_a), (center_b, radius_b)) = (self.balls[a], self.balls[b]);
        let apart = sweep_a.pose(0.0).point(center_a).distance(sweep_b.pose(0.0).point(center_b));
        let skins = self.colliders[a].shape.radius + self.colliders[b].shape.radius + TOUCH;
        apart <= radius_a + radius_b + skins + sweep_a.travel(self.reach[a]) + sweep_b.travel(self.reach[b])
    }
}

/// Runs of pairs of the same two bodies.
fn runs(colliders: &[Collider], pairs: &[SurfacePair]) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (index, SurfacePair { pair, .. }) in pairs.iter().enumerate() {
        let Some(a) = colliders[pair.a].body else { continue };
        let b = colliders[pair.b].body;
        match runs.last_mut() {
            Some(run) if run.a == a && run.b == b => run.end = index + 1,
            _ => runs.push(Run { a, b, first: index, end: index + 1 }),
        }
    }
    runs
}

/// A ball around all colliders of a body, node frame, m.
fn ball_around(colliders: &[Collider], balls: &[(DVec3, f64)], body: usize) -> (DVec3, f64) {
    let own = || colliders.iter().zip(balls).filter(|(c, _)| c.body == Some(body));
    let count = own().count().max(1) as f64;
    let center = own().map(|(_, ball)| ball.0).sum::<DVec3>() / count;
    let radius = own().fold(0.0, |r: f64, (c, ball)| r.max(ball.0.distance(center) + ball.1 + c.shape.radius));
    (center, radius)
}

/// How far a tilt is beyond its limit (rad, to first order) and the axis about which it grows; `None` within it.
pub(super) fn excess(limit: &Limit, bodies: &[RigidBody]) -> Option<(f64, DVec3)> {
    let LimitKind::Tilt { a, b, max } = &limit.kind else { return None };
    let axis = |a: &crate::articulation::Axis| a.body.map_or(a.direction, |i| bodies[i].rotation * a.direction);
    let (t, n) = (axis(a), axis(b));
    let past = cos(*max) - t.dot(n);
    if past <= 0.0 {
        return None;
    }
    // sin θ turns the excess of the cosine into an angle.
    let across = n.cross(t);
    Some((past / across.length(), across.try_normalize()?))
}

/// Stops bodies at the rims of their tilt limits: a one-row contact on the angle between two axes. With T the tilting
/// axis and N the one it tilts from, cos θ = T·N falls at the rate (N×T)·(ω_T − ω_N).
pub(super) fn resolve_limits(limits: &[Limit], system: &mut System, bodies: &mut [RigidBody]) {
    for limit in limits {
        let Some((excess, out)) = excess(limit, bodies) else { continue };
        // Positive along `out` tilts farther.
        let row = vec6(DVec3::ZERO, out);
        system.b.fill([0.0; 6]);
        let LimitKind::Tilt { a, b, .. } = &limit.kind else { continue };
        let ends = [(a.body, 1.0), (b.body, -1.0)];
        for (body, sign) in ends {
            if let Some(body) = body {
                system.push_impulse(body, &row, sign);
            }
        }
        system.solve_impulse();
        let along =
            |a: &[Vec6]| -> f64 { ends.iter().filter_map(|(body, sign)| body.map(|b| sign * dot(&row, &a[b]))).sum() };
        let k = along(&system.a);
        if k <= LOCKED {
            continue;
        }
        let rate: f64 =
            ends.iter().filter_map(|(body, sign)| body.map(|b| sign * out.dot(bodies[b].angular_velocity))).sum();
        let (push, turn) = (-(1.0 + limit.restitution) * rate.max(0.0) / k, -excess / k);
        for (body, a) in bodies.iter_mut().zip(&system.a) {
            body.velocity += push * crate::articulation::block::linear(a);
            body.angular_velocity += push * crate::articulation::block::angular(a);
            let step = a.map(|x| x * turn);
            body.displace(crate::articulation::block::linear(&step), crate::articulation::block::angular(&step));
        }
    }
}
