//! What the integrators do to every body, four at a time.
//!
//! Each pass goes through the quads in the tree's order and names the parts of a figure that it reads and writes. What it reads
//! of the bodies is gathered into lanes, what it changes goes back body by body; sums over bodies are made afterwards in the
//! bodies' own order (`norms`, by bodies), so that they do not depend on who stands beside whom.

use fearless_simd::{Simd, dispatch};

use super::forces;
use super::substep_state::{Rate, SLOWEST, SubstepState, advance, less, norm};
use crate::articulation::System;
use crate::articulation::ball::Twist;
use crate::articulation::quads::{Members, Quad, State};
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::lanes::{All, Four, Lanes, Real, V3};
use soffio_math::spatial::Vec6;

/// Something that is done to every quad in which somebody is awake.
pub(super) trait LaneKernel {
    /// Does it to the `index`th.
    fn go<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize);
}

/// Does it to all quads of a system.
pub(super) fn run_kernel(system: &mut System, mut pass: impl LaneKernel) {
    dispatch!(system.quads().level(), simd => run_kernel_in(simd, system, &mut pass));
}

#[inline(always)]
fn run_kernel_in<S: Simd>(simd: S, system: &mut System, pass: &mut impl LaneKernel) {
    for k in 0..system.quads().moving().len() {
        let index = system.quads().moving()[k];
        pass.go(All(simd), system, index);
    }
}

/// A quad, and who it is.
#[inline(always)]
pub(super) fn quad(system: &System, index: usize) -> (Members, &Quad) {
    let quads = system.quads();
    (quads.members()[index], &quads.all()[index])
}

/// The accelerations found last.
#[inline(always)]
pub(super) fn accelerations<L: Lanes>(lanes: L, system: &System, members: &Members) -> Twist<L::T> {
    Twist::gather(lanes, |k| &system.a[members.bodies[k]])
}

/// Puts bodies into this state.
#[inline(always)]
pub(super) fn put<L: Lanes>(lanes: L, system: &mut System, index: usize, state: &State<L::T>) {
    system.quads_mut().all_mut()[index].put(lanes, state);
}

/// Notes where the bodies are: a substep begins.
pub(super) struct Save<'a> {
    pub bodies: &'a [RigidBody],
    pub states: &'a mut [SubstepState],
}

impl LaneKernel for Save<'_> {
    #[inline(always)]
    fn go<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (members, _) = quad(system, index);
        let state = State::of(lanes, |k| &self.bodies[members.bodies[k]]);
        self.states[index].start.set(lanes, &state);
    }
}

/// Puts the bodies back to where the substep began.
pub(super) struct Restore<'a> {
    pub bodies: &'a mut [RigidBody],
    pub states: &'a [SubstepState],
}

impl LaneKernel for Restore<'_> {
    #[inline(always)]
    fn go<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (members, _) = quad(system, index);
        let state = self.states[index].start.get(lanes);
        state.put(lanes, &members, self.bodies);
    }
}

/// Lets the bodies be where the quads are.
pub(super) struct WriteBack<'a> {
    pub bodies: &'a mut [RigidBody],
}

impl LaneKernel for WriteBack<'_> {
    #[inline(always)]
    fn go<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (members, quad) = quad(system, index);
        let state = quad.state.get(lanes);
        state.put(lanes, &members, self.bodies);
    }
}

/// Adds the change of velocities found last; the bodies follow.
pub(super) struct AddVelocityChange<'a> {
    pub bodies: &'a mut [RigidBody],
}

impl LaneKernel for AddVelocityChange<'_> {
    #[inline(always)]
    fn go<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (members, quad) = quad(system, index);
        let by = accelerations(lanes, system, &members);
        let mut state = quad.state.get(lanes);
        state.velocity += by.linear;
        state.spin += by.angular;
        state.put(lanes, &members, self.bodies);
        let quad = &mut system.quads_mut().all_mut()[index].state;
        quad.velocity.put(lanes, state.velocity);
        quad.spin.put(lanes, state.spin);
    }
}

/// From one Runge–Kutta stage to the next: takes the rate at this one, of this weight, and goes on with it from the
/// start over `h`.
pub(super) struct Stage<'a> {
    pub states: &'a mut [SubstepState],
    pub first: bool,
    pub weight: f64,
    pub h: f64,
}

impl LaneKernel for Stage<'_> {
    #[inline(always)]
    fn go<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (members, quad) = quad(system, index);
        let a = accelerations(lanes, system, &members);
        let substep = &self.states[index];
        let start = substep.start.get(lanes);
        let (rate, mut mean) = if self.first {
            let zero = start.velocity.x.all(0.0);
            let none = V3 { x: zero, y: zero, z: zero };
            let mean = Rate { velocity: none, turn: none, acceleration: Twist { linear: none, angular: none } };
            (Rate::of(start.velocity, start.spin, none, a), mean)
        } else {
            let (velocity, spin) = (quad.state.velocity.get(lanes), quad.state.spin.get(lanes));
            (Rate::of(velocity, spin, substep.turned.get(lanes), a), substep.mean.get(lanes))
        };
        mean.add(self.weight, &rate);
        let (state, turned) = advance(lanes, &start, self.h, &rate);
        let substep = &mut self.states[index];
        if self.first {
            substep.begun.put(lanes, &a);
        }
        substep.mean.set(lanes, &mean);
        substep.turned.put(lanes, turned);
        put(lanes, system, index, &state);
    }
}

/// From the last Runge–Kutta stage to the end of the substep of `h`.
pub(super) struct Last<'a> {
    pub states: &'a mut [SubstepState],
    pub h: f64,
    /// Of the last rate.
    pub weight: f64,
}

impl LaneKernel for Last<'_> {
    #[inline(always)]
    fn go<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (members, quad) = quad(system, index);
        let a = accelerations(lanes, system, &members);
        let substep = &self.states[index];
        let rate = Rate::of(quad.state.velocity.get(lanes), quad.state.spin.get(lanes), substep.turned.get(lanes), a);
        let mut mean = substep.mean.get(lanes);
        mean.add(self.weight, &rate);
        let (state, _) = advance(lanes, &substep.start.get(lanes), self.h, &mean);
        self.states[index].last.put(lanes, &a);
        put(lanes, system, index, &state);
    }
}

/// What the new rate says of the error (`integrate.rs`): each body's share of the two sums.
pub(super) struct Estimate<'a> {
    pub states: &'a mut [SubstepState],
    pub norms: &'a mut [[f64; 2]],
    pub per_cube: f64,
    pub spread: f64,
    /// Was there a substep before?
    pub before: bool,
    /// Where the change since the substep began goes.
    pub slot: usize,
}

impl LaneKernel for Estimate<'_> {
    #[inline(always)]
    fn go<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (members, quad) = quad(system, index);
        let (mass, inertia) = (lanes.get(&quad.mass), quad.inertia.get(lanes));
        let a = accelerations(lanes, system, &members);
        let substep = &self.states[index];
        let (last, before) = (substep.last.get(lanes), substep.fourth.get(lanes));
        let (per_cube, spread) = (mass.all(self.per_cube), mass.all(self.spread));
        let fourth =
            Twist { linear: (a.linear - last.linear) * per_cube, angular: (a.angular - last.angular) * per_cube };
        let mut change = fourth;
        if self.before {
            change.linear -= before.linear;
            change.angular -= before.angular;
        }
        change = Twist { linear: change.linear * spread, angular: change.angular * spread };
        let now = Twist { linear: quad.state.velocity.get(lanes), angular: quad.state.spin.get(lanes) };
        let error = norm(mass, &inertia, &change);
        let slowest = mass.all(SLOWEST);
        let scale = norm(mass, &inertia, &now) + mass * slowest * slowest;
        let changed = less(a, substep.begun.get(lanes));
        let substep = &mut self.states[index];
        substep.differences[self.slot].put(lanes, &changed);
        substep.fourth.put(lanes, &fourth);
        let norms = &mut *self.norms;
        lanes.scatter(members.count, &[error, scale], |lane, norm| norms[members.bodies[lane]] = *norm);
    }
}

/// Gravity, damping, the gyroscopic torque and what comes from outside.
pub(super) struct ApplyForces<'a> {
    pub external: &'a [Vec6],
    pub damping: &'a [[Four; 2]],
    pub gravity: DVec3,
}

impl LaneKernel for ApplyForces<'_> {
    #[inline(always)]
    fn go<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (members, quad) = quad(system, index);
        let external = Twist::gather(lanes, |k| &self.external[members.bodies[k]]);
        let [linear, angular] = self.damping[index].each_ref().map(|rate| lanes.get(rate));
        let motion = (quad.state.velocity.get(lanes), quad.state.spin.get(lanes));
        let (mass, inertia) = (lanes.get(&quad.mass), quad.inertia.get(lanes));
        let own = forces::on_body((mass, &inertia), motion, self.gravity, (linear, angular));
        let push = Twist { linear: own.linear + external.linear, angular: own.angular + external.angular };
        let b = &mut system.b;
        lanes.scatter(members.count, &push.numbers(), |lane, push| b[members.bodies[lane]] = *push);
    }
}

/// Rates of the Gauss–Legendre stages, by quads.
pub(super) type Stages = [Vec<Rate<Four>>; 3];

/// The first guess of the three Gauss rates of a substep of `h`.
pub(super) struct Guess<'a> {
    pub states: &'a [SubstepState],
    pub stages: &'a mut Stages,
    pub h: f64,
    /// Shares of the substep at which the rates are taken.
    pub nodes: [f64; 3],
}

impl LaneKernel for Guess<'_> {
    #[inline(always)]
    fn go<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (members, _) = quad(system, index);
        let a = accelerations(lanes, system, &members);
        let start = self.states[index].start.get(lanes);
        let zero = start.velocity.x.all(0.0);
        let rate = Rate::of(start.velocity, start.spin, V3 { x: zero, y: zero, z: zero }, a);
        // A body's velocity changes as its acceleration says, which is the better first guess.
        for (rates, node) in self.stages.iter_mut().zip(self.nodes) {
            let ahead = zero.all(node * self.h);
            let mut guess = rate;
            guess.velocity += a.linear * ahead;
            guess.turn += a.angular * ahead;
            rates[index].set(lanes, &guess);
        }
    }
}

/// From the start over `h` by these shares of the three Gauss rates.
pub(super) struct Mean<'a> {
    pub states: &'a mut [SubstepState],
    pub stages: &'a Stages,
    pub weights: [f64; 3],
    pub h: f64,
}

impl LaneKernel for Mean<'_> {
    #[inline(always)]
    fn go<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let start = self.states[index].start.get(lanes);
        let zero = start.velocity.x.all(0.0);
        let none = V3 { x: zero, y: zero, z: zero };
        let mut mean = Rate { velocity: none, turn: none, acceleration: Twist { linear: none, angular: none } };
        for (rates, weight) in self.stages.iter().zip(self.weights) {
            mean.add(weight, &rates[index].get(lanes));
        }
        let (state, turned) = advance(lanes, &start, self.h, &mean);
        self.states[index].turned.put(lanes, turned);
        put(lanes, system, index, &state);
    }
}

/// Takes over the rate of a Gauss stage: by how much it changed and how large it is, in squares.
pub(super) struct Compare<'a> {
    pub states: &'a [SubstepState],
    pub stages: &'a mut Stages,
    pub norms: &'a mut [[f64; 2]],
    pub stage: usize,
}

impl LaneKernel for Compare<'_> {
    #[inline(always)]
    fn go<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (members, quad) = quad(system, index);
        let a = accelerations(lanes, system, &members);
        let turned = self.states[index].turned.get(lanes);
        let rate = Rate::of(quad.state.velocity.get(lanes), quad.state.spin.get(lanes), turned, a);
        let old = self.stages[self.stage][index].get(lanes);
        let (linear, angular) = (a.linear - old.acceleration.linear, a.angular - old.acceleration.angular);
        let turn = rate.turn - old.turn;
        let change = linear.dot(linear) + angular.dot(angular) + turn.dot(turn);
        let size = a.linear.dot(a.linear) + a.angular.dot(a.angular) + rate.turn.dot(rate.turn);
        self.stages[self.stage][index].set(lanes, &rate);
        let norms = &mut *self.norms;
        lanes.scatter(members.count, &[change, size], |lane, norm| norms[members.bodies[lane]] = *norm);
    }
}
