//! The first hit of a substep: bodies' balls, colliders' balls, then conservative advancement.
//!
//! What touches at the beginning and opens there is not hit; if it has sunk in by the end it was thrown and came back
//! within the substep, and the time at which it did is found by bisection.

use super::problem::Source;
use super::{Contacts, SurfacePair};
use crate::bodies::RigidBody;
use crate::collision::{Collider, Pair, Sweep, TOUCH, TimeOfImpact, time_of_impact};
use crate::math::DVec3;

/// Halvings that find when a thrown body comes back: to a thousandth of a millisecond.
const HALVINGS: usize = 12;

/// The first hit of a substep.
#[derive(Clone, Copy, Debug)]
pub(in crate::dynamics) struct Hit {
    /// Share of the substep.
    pub s: f64,
    pub(super) source: Source,
}

/// Pairs of the same two bodies: `first` up to `end`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    pub a: usize,
    pub b: Option<usize>,
    pub first: usize,
    pub end: usize,
}

impl Contacts {
    /// The first hit of anything that is apart, between two states of the bodies.
    pub(in crate::dynamics) fn first_impact(&mut self, before: &[RigidBody], after: &[RigidBody]) -> Option<Hit> {
        for ((sweep, b), a) in self.sweeps.iter_mut().zip(before).zip(after) {
            *sweep = Sweep::new(b, a);
        }
        for index in 0..self.colliders.len() {
            let (sweep, pose) = (self.sweep(index), self.pose(index, before));
            let (center, radius) = self.balls[index];
            let grown = radius + self.colliders[index].shape.radius + sweep.travel(self.reach[index]) + TOUCH;
            self.swept[index] = (pose.point(center), grown);
        }
        let mut first: Option<Hit> = None;
        for run in 0..self.runs.len() {
            let run = self.runs[run];
            if self.bodies_may_meet(&run) {
                for pair in run.first..run.end {
                    self.meet(pair, before, after, &mut first);
                }
            }
        }
        for bound in 0..self.limits.count() {
            if self.limits.resting(bound) {
                continue;
            }
            if let Some(s) = self.limits.crossing(bound, before, after, &self.sweeps) {
                if self.impacts_left == 0 {
                    self.set_bound_resting(bound, true);
                } else if first.is_none_or(|f| s < f.s) {
                    first = Some(Hit { s, source: Source::Bound(bound) });
                }
            }
        }
        first
    }

    /// The earliest hit so far, or an earlier one of this pair.
    fn meet(&mut self, pair: usize, before: &[RigidBody], after: &[RigidBody], first: &mut Option<Hit>) {
        if self.resting[pair] {
            return;
        }
        let Pair { a, b } = self.pairs[pair].pair;
        if !self.may_meet(a, b) {
            return;
        }
        let (sweep_a, sweep_b) = (self.sweep(a), self.sweep(b));
        let toi = time_of_impact(
            &mut self.corners,
            (&self.colliders[a], &sweep_a, self.reach[a]),
            (&self.colliders[b], &sweep_b, self.reach[b]),
        );
        let Some(TimeOfImpact { mut s, proximity }) = toi else { return };
        let states = if s > 0.0 { after } else { before };
        if self.velocity_at(pair, proximity.point, states).dot(proximity.normal) >= 0.0 {
            let Some(back) = self.comes_back(a, b, &sweep_a, &sweep_b) else { return };
            s = back;
        }
        if self.impacts_left == 0 {
            self.set_resting(pair, true);
        } else if first.is_none_or(|f| s < f.s) {
            *first = Some(Hit { s, source: Source::Pair(pair) });
        }
    }

    /// When a pair that opens at the beginning has closed again, if it has sunk in by the end.
    fn comes_back(&mut self, a: usize, b: usize, sweep_a: &Sweep, sweep_b: &Sweep) -> Option<f64> {
        let (collider_a, collider_b) = (&self.colliders[a], &self.colliders[b]);
        let corners = &self.corners;
        let gap = |s: f64| corners.proximity(collider_a, &sweep_a.pose(s), collider_b, &sweep_b.pose(s)).gap;
        let end = gap(1.0);
        if end >= 0.0 || end >= gap(0.0) {
            return None;
        }
        let (mut open, mut closed) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (open + closed);
            if gap(middle) > 0.0 { open = middle } else { closed = middle }
        }
        Some(open)
    }

    fn sweep(&self, collider: usize) -> Sweep {
        self.colliders[collider].body.map_or(Sweep::STILL, |body| self.sweeps[body])
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
    fn may_meet(&self, a: usize, b: usize) -> bool {
        let ((center_a, far_a), (center_b, far_b)) = (self.swept[a], self.swept[b]);
        center_a.distance_squared(center_b) <= (far_a + far_b) * (far_a + far_b)
    }

    /// Can the balls around two colliders touch where their bodies are?
    pub(super) fn may_touch(&self, pair: usize, bodies: &[RigidBody]) -> bool {
        let Pair { a, b } = self.pairs[pair].pair;
        let place = |c: usize| self.pose(c, bodies).point(self.balls[c].0);
        let far =
            self.balls[a].1 + self.balls[b].1 + self.colliders[a].shape.radius + self.colliders[b].shape.radius + TOUCH;
        place(a).distance_squared(place(b)) <= far * far
    }
}

/// Runs of pairs of the same two bodies.
pub(super) fn runs(colliders: &[Collider], pairs: &[SurfacePair]) -> Vec<Run> {
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
pub(super) fn ball_around(colliders: &[Collider], balls: &[(DVec3, f64)], body: usize) -> (DVec3, f64) {
    let own = || colliders.iter().zip(balls).filter(|(c, _)| c.body == Some(body));
    let count = own().count().max(1) as f64;
    let center = own().map(|(_, ball)| ball.0).sum::<DVec3>() / count;
    let radius = own().fold(0.0, |r: f64, (c, ball)| r.max(ball.0.distance(center) + ball.1 + c.shape.radius));
    (center, radius)
}
