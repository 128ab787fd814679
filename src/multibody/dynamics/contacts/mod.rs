//! Contacts of a figure in motion: hits at their own time, and rest without jitter, creep or sinking.
//!
//! A pair of colliders, or a bound of a limit, is *apart* until it is reached inside a substep; the substep is cut
//! there and the hit resolved with the joints' own factor, so that it travels through the whole figure (`hit`). What
//! meets slower than [`REST_SPEED`], or slowly and again within [`CHATTER_TIME`], *rests*: from then on it is held by
//! forces over the whole substep (`rest`) until it has opened by more than [`RELEASE_GAP`].

mod asleep;
mod grip;
mod hit;
mod leap;
mod met;
mod open;
mod problem;
mod rest;
mod row;
mod sweep;
mod touching;
mod twist;

use crate::articulation::{Constraint, Limit};
use crate::collision::{BroadPhase, Collider, Corners, Manifold, Pair, Sweep};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, vec6};
use soffio_math::{DVec3, Pose, tangents};

use super::clutches::Clutches;
use super::limits::Limits;
use problem::{Problem, Source, Touch};
use row::ROW_ENDS;

pub use hit::{Strike, Struck, strike};
pub use met::{ENDS, Met, couple_rows};
pub(super) use rest::Verdict;
pub(super) use row::Row;
pub(super) use sweep::Hit;
pub use touching::Touching;
pub use twist::Resistance;

/// Slower approaches do not bounce and make no sound, m/s (rad/s at a limit of an angle).
const REST_SPEED: f64 = 4e-3;
/// Bounces nearer in time than this, and slower than that, are one contact: no ear tells them apart, s and m/s.
const CHATTER_TIME: f64 = 5e-3;
const CHATTER_SPEED: f64 = 0.03;
/// What rests and opens farther than this is apart again, m or rad.
const RELEASE_GAP: f64 = 5e-5;
/// Room for forces of what sleeps, and of what wakes again: sixteen times as many as are solved for at once.
const MOST_KEPT: usize = 1024;
/// Hits resolved at their own time in one step; what is hit further rests.
const MOST_IMPACTS: usize = 64;

/// A pair of colliders and what their surfaces do to each other.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePair {
    /// The colliders.
    pub pair: Pair,
    /// Energetic coefficient of restitution.
    pub restitution: f64,
    /// Coulomb coefficient while sliding.
    pub friction: f64,
    /// Against rolling and spinning on each other.
    pub resistance: Resistance,
}

/// What a contact did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImpactKind {
    /// A hit that bounces.
    Impact,
    /// The beginning of rest.
    Rest,
    /// A limit reached its bound.
    Stop,
}

/// One hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Seconds after the beginning of the step.
    pub time: f64,
    /// What it did.
    pub kind: ImpactKind,
    /// The two bodies; `None` is the world.
    pub bodies: [Option<usize>; 2],
    /// Indices of the two colliders; `None` at a limit.
    pub colliders: Option<[usize; 2]>,
    /// World, m.
    pub point: DVec3,
    /// Unit, from the second collider to the first.
    pub normal: DVec3,
    /// N s (N m s at a limit of an angle).
    pub impulse: f64,
    /// Approach speed along the normal, m/s (rad/s at a limit of an angle).
    pub speed: f64,
    /// Effective mass along the normal, joints included, kg (kg m² at a limit of an angle); 0 without a push.
    pub mass: f64,
}

/// Force that holds a touch, from the last substep that it was needed in.
#[derive(Clone, Copy, Debug)]
struct Held {
    source: Source,
    /// Is it a couple, which has no lever?
    couple: bool,
    /// World point, m.
    point: DVec3,
    /// World force on the first body, N, or couple, N m; a bound's along its row in x.
    force: DVec3,
    /// Length of the substep that it was found in, s.
    span: f64,
    /// Normal where it acted so, and the rotation vector of its turn in a substep of that length, rad.
    normal: DVec3,
    turn: DVec3,
    /// How it acts on its bodies.
    ends: [Option<Lever>; ROW_ENDS],
}

/// One end of a held force.
#[derive(Clone, Copy, Debug)]
struct Lever {
    body: usize,
    /// Wrench of a bound per unit force, and its change in a substep of that length.
    block: Vec6,
    block_change: Vec6,
    /// From the body's centre to the point of a contact, m, and its way in a substep of that length.
    arm: DVec3,
    way: DVec3,
}

/// All that can touch in a figure, and its state.
#[derive(Clone, Debug)]
pub struct Contacts {
    colliders: Vec<Collider>,
    /// Farthest point of each collider's core from its body's centre of mass (none moves what stands still), and ball around it in the node frame.
    reach: Vec<f64>,
    balls: Vec<(DVec3, f64)>,
    pairs: Vec<SurfacePair>,
    broad: BroadPhase,
    /// Pairs whose boxes overlap, ascending: over the present substep, or where bodies are at a hit.
    near: Vec<usize>,
    /// How many pairs were measured in the present step.
    measured: usize,
    /// Whether each pair rests, the pairs that do, ascending, and how many bounds do.
    resting: Vec<bool>,
    at_rest: Vec<usize>,
    bounds_at_rest: usize,
    /// When the present step began, and each pair's last hit, s.
    clock: f64,
    last_hit: Vec<f64>,
    /// How deep each resting pair had sunk in at the last substep's end, m; not above 0.
    depth: Vec<f64>,
    sweeps: Vec<Sweep>,
    /// Looks at all pairs, near or not.
    #[cfg(test)]
    all: bool,
    corners: Corners,
    limits: Limits,
    clutches: Clutches,
    problem: Problem,
    held: Vec<Held>,
    /// Those that the present substep begins with, where a clutch holds that may yet give way.
    began: Vec<Held>,
    /// Those before them.
    former: Vec<Held>,
    /// Whether each body sleeps, how many of the pairs and bounds at rest are between such, and the forces there.
    asleep: Vec<bool>,
    asleep_at_rest: usize,
    kept: Vec<Held>,
    /// 1/ω₀ of the figure's stabiliser, s.
    gathering_time: f64,
    /// Length of the substep that they are laid out for, s.
    span: f64,
    /// Slip of the fastest touch that rests, m/s.
    slip: f64,
    /// Greatest ω² with which a body under the forces that hold it would tip out of its place, 1/s², and those of the bodies.
    tips: f64,
    tipping: Vec<f64>,
    /// Work of all hits and resting contacts so far, J; losses make it negative.
    work: f64,
    /// Work of resting contacts over the present substep, J: it may yet be cut by a hit.
    recent_work: f64,
    impacts_left: usize,
}

impl Contacts {
    /// The contacts of a figure with these colliders, limits and clutches among its constraints, whose joints have this many
    /// rows and are drawn together with this time constant (s).
    pub fn new(
        colliders: &[Collider],
        pairs: Vec<SurfacePair>,
        (limits, constraints): (&[Limit], &[Constraint]),
        bodies: &[RigidBody],
        joints: (usize, f64),
    ) -> Self {
        let balls: Vec<_> = colliders.iter().map(Collider::bounds).collect();
        let reach: Vec<f64> =
            colliders.iter().map(|c| c.body.map_or(0.0, |b| c.shape.reach(bodies[b].properties.center))).collect();
        let limits = Limits::new(limits, bodies);
        let clutches = Clutches::new(constraints);
        let turning = pairs.iter().filter(|surface| !surface.resistance.is_none()).count();
        let touches = crate::collision::MANIFOLD_POINTS * (pairs.len() + turning) + limits.count() + clutches.count();
        let problem = Problem::new(touches, joints);
        let bare: Vec<Pair> = pairs.iter().map(|surface| surface.pair).collect();
        Self {
            reach,
            broad: BroadPhase::new(colliders, &bare),
            near: Vec::with_capacity(pairs.len()),
            measured: 0,
            balls,
            resting: vec![false; pairs.len()],
            at_rest: Vec::with_capacity(pairs.len()),
            bounds_at_rest: 0,
            clock: 0.0,
            last_hit: vec![f64::NEG_INFINITY; pairs.len()],
            depth: vec![0.0; pairs.len()],
            sweeps: vec![Sweep::STILL; bodies.len()],
            #[cfg(test)]
            all: false,
            corners: Corners::new(colliders),
            colliders: colliders.to_vec(),
            pairs,
            limits,
            clutches,
            held: Vec::with_capacity(touches.min(MOST_KEPT)),
            began: Vec::with_capacity(touches.min(MOST_KEPT)),
            former: Vec::with_capacity(problem.touches.capacity()),
            asleep: vec![false; bodies.len()],
            asleep_at_rest: 0,
            kept: Vec::with_capacity(touches.min(MOST_KEPT)),
            gathering_time: joints.1,
            span: 0.0,
            problem,
            slip: 0.0,
            tips: 0.0,
            tipping: vec![0.0; bodies.len()],
            work: 0.0,
            recent_work: 0.0,
            impacts_left: MOST_IMPACTS,
        }
    }

    /// Begins a step at the time `now`, s.
    pub(super) fn begin_step(&mut self, now: f64) {
        self.impacts_left = MOST_IMPACTS;
        self.measured = 0;
        self.clock = now;
    }

    /// How many pairs of colliders have been measured in the present step: those whose boxes overlapped.
    pub(super) fn measured(&self) -> usize {
        self.measured
    }

    /// Ends a substep: turns are counted on from where the bodies are now.
    pub(super) fn end_substep(&mut self, bodies: &[RigidBody]) {
        self.limits.follow(bodies);
        self.work += std::mem::take(&mut self.recent_work);
    }

    /// The present substep has not been: it is cut by a hit.
    pub(super) fn cut_substep(&mut self) {
        self.recent_work = 0.0;
    }

    /// Is there nothing that could meet or reach a bound?
    pub(super) fn is_empty(&self) -> bool {
        self.pairs.is_empty() && self.limits.count() == 0
    }

    /// Work of all hits and resting contacts so far, J.
    pub(super) fn work(&self) -> f64 {
        self.work
    }

    /// Forgets all rest, for bodies that were put elsewhere.
    pub(super) fn forget(&mut self, bodies: &[RigidBody]) {
        self.resting.fill(false);
        self.depth.fill(0.0);
        self.held.clear();
        self.kept.clear();
        self.asleep_at_rest = 0;
        self.at_rest.clear();
        self.bounds_at_rest = 0;
        self.limits.forget(bodies);
    }

    /// Sets whether a pair rests.
    fn set_resting(&mut self, pair: usize, rests: bool) {
        if self.resting[pair] == rests {
            return;
        }
        self.resting[pair] = rests;
        self.depth[pair] = 0.0;
        match self.at_rest.binary_search(&pair) {
            Ok(at) => {
                self.at_rest.remove(at);
            }
            Err(at) => self.at_rest.insert(at, pair),
        }
    }

    /// Sets whether a bound rests.
    fn set_bound_resting(&mut self, bound: usize, rests: bool) {
        self.bounds_at_rest = self.bounds_at_rest + usize::from(rests) - usize::from(self.limits.resting(bound));
        self.limits.set_resting(bound, rests);
    }

    /// Sets whether a pair or a bound rests.
    fn set_rest(&mut self, source: Source, rests: bool) {
        match source {
            Source::Pair(pair) => self.set_resting(pair, rests),
            Source::Bound(bound) => self.set_bound_resting(bound, rests),
        }
    }

    /// Where a pair touches at the bodies' present poses.
    fn manifold(&mut self, pair: usize, bodies: &[RigidBody]) -> Manifold {
        let Pair { a, b } = self.pairs[pair].pair;
        let (pose_a, pose_b) = (self.pose(a, bodies), self.pose(b, bodies));
        self.corners.manifold(&self.colliders[a], &pose_a, &self.colliders[b], &pose_b)
    }

    fn pose(&self, collider: usize, bodies: &[RigidBody]) -> Pose {
        self.colliders[collider].body.map_or(Pose::IDENTITY, |body| bodies[body].pose())
    }

    /// The two bodies of a pair.
    fn bodies_of(&self, pair: usize) -> [Option<usize>; 2] {
        let Pair { a, b } = self.pairs[pair].pair;
        [self.colliders[a].body, self.colliders[b].body]
    }

    /// Adds a point of a pair to the problem.
    fn push_point(&mut self, pair: usize, point: DVec3, normal: DVec3, gap: f64, bodies: &[RigidBody]) {
        let [a, b] = self.bodies_of(pair);
        let touch = Touch::new(Source::Pair(pair), point, normal, gap, self.pairs[pair].friction);
        self.problem.push(touch, &point_rows(point, normal, [a, b], bodies));
    }

    /// Adds a bound of a limit to the problem, its value `gap` away.
    fn push_bound(&mut self, bound: usize, bodies: &[RigidBody]) {
        let (gap, row, point) = self.limits.row(bound, bodies);
        let touch = Touch::new(Source::Bound(bound), point, DVec3::ZERO, gap, 0.0);
        self.problem.push(touch, &[row]);
    }

    /// Relative velocity of a pair's bodies at a point, first minus second, m/s.
    fn velocity_at(&self, pair: usize, point: DVec3, bodies: &[RigidBody]) -> DVec3 {
        let at = |body: Option<usize>| body.map_or(DVec3::ZERO, |i| bodies[i].velocity_at(point));
        let [a, b] = self.bodies_of(pair);
        at(a) - at(b)
    }
}

/// Rows of a point contact: normal, then two tangents.
fn point_rows(point: DVec3, normal: DVec3, [a, b]: [Option<usize>; 2], bodies: &[RigidBody]) -> [Row; 3] {
    let (t, u) = tangents(normal);
    [normal, t, u].map(|axis| {
        let end = |body: Option<usize>, sign: f64| {
            let along = sign * axis;
            body.map(|i| (i, vec6(along, (point - bodies[i].position).cross(along))))
        };
        Row { ends: [end(a, 1.0), end(b, -1.0), None] }
    })
}
