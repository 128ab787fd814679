//! Lane kernels: the integrators' operations on all bodies, four at a time (SIMD).
//!
//! Each kernel visits the lane blocks in the tree's order and names what it reads and writes. It gathers bodies into lanes and
//! scatters results body by body. Sums over bodies are taken afterwards in the bodies' own order (`norms`, by bodies), so that they
//! do not depend on which bodies share a block.

use fearless_simd::{Simd, dispatch};

use super::forces::{self, BodyLanes};
use super::substep_state::{Rate, SLOWEST, SubstepState, advance, difference, norm};
use crate::articulation::System;
use crate::articulation::lane_blocks::{BlockBodies, LaneBlock, State};
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::lanes::{All, Four, Lanes, Real, V3};
use soffio_math::spatial::SpatialVector;
use soffio_math::spatial::Vec6;

/// An operation on every lane block with a body that is awake.
pub(super) trait LaneKernel {
    /// Runs it on the block of this index.
    fn run<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize);
}

/// Runs a kernel on all lane blocks of a system.
pub(super) fn run_kernel(system: &mut System, mut kernel: impl LaneKernel) {
    dispatch!(system.lane_blocks().level(), simd => run_kernel_in(simd, system, &mut kernel));
}

#[inline(always)]
fn run_kernel_in<S: Simd>(simd: S, system: &mut System, kernel: &mut impl LaneKernel) {
    for k in 0..system.lane_blocks().awake().len() {
        let index = system.lane_blocks().awake()[k];
        kernel.run(All(simd), system, index);
    }
}

/// A lane block, and which bodies it holds.
#[inline(always)]
pub(super) fn lane_block(system: &System, index: usize) -> (BlockBodies, &LaneBlock) {
    let lane_blocks = system.lane_blocks();
    (lane_blocks.block_bodies()[index], &lane_blocks.all()[index])
}

/// The last accelerations of a block.
#[inline(always)]
pub(super) fn accelerations<L: Lanes>(lanes: L, system: &System, block_bodies: &BlockBodies) -> SpatialVector<L::T> {
    SpatialVector::gather(lanes, |k| &system.a[block_bodies.bodies[k]])
}

/// Sets the state of a block.
#[inline(always)]
pub(super) fn put<L: Lanes>(lanes: L, system: &mut System, index: usize, state: &State<L::T>) {
    system.lane_blocks_mut().all_mut()[index].put(lanes, state);
}

/// Saves the bodies' state at the start of a substep.
pub(super) struct Save<'a> {
    /// All bodies.
    pub bodies: &'a [RigidBody],
    /// Written: the state of each lane block.
    pub states: &'a mut [SubstepState],
}

impl LaneKernel for Save<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (block_bodies, _) = lane_block(system, index);
        let state = State::of(lanes, |k| &self.bodies[block_bodies.bodies[k]]);
        self.states[index].start.set(lanes, &state);
    }
}

/// Restores the bodies' state at the start of the substep.
pub(super) struct Restore<'a> {
    /// All bodies; those of awake lane blocks are written.
    pub bodies: &'a mut [RigidBody],
    /// Saved state of each lane block ([`Save`]).
    pub states: &'a [SubstepState],
}

impl LaneKernel for Restore<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (block_bodies, _) = lane_block(system, index);
        let state = self.states[index].start.get(lanes);
        state.put(lanes, &block_bodies, self.bodies);
    }
}

/// Writes the blocks' state back to the bodies.
pub(super) struct WriteBack<'a> {
    /// All bodies; those of awake lane blocks are written.
    pub bodies: &'a mut [RigidBody],
}

impl LaneKernel for WriteBack<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (block_bodies, block) = lane_block(system, index);
        let state = block.state.get(lanes);
        state.put(lanes, &block_bodies, self.bodies);
    }
}

/// Adds the last change of velocities to blocks and bodies.
pub(super) struct AddVelocityChange<'a> {
    /// All bodies; those of awake lane blocks are written.
    pub bodies: &'a mut [RigidBody],
}

impl LaneKernel for AddVelocityChange<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (block_bodies, block) = lane_block(system, index);
        let by = accelerations(lanes, system, &block_bodies);
        let mut state = block.state.get(lanes);
        state.velocity += by.linear;
        state.spin += by.angular;
        state.put(lanes, &block_bodies, self.bodies);
        let block = &mut system.lane_blocks_mut().all_mut()[index].state;
        block.velocity.put(lanes, state.velocity);
        block.spin.put(lanes, state.spin);
    }
}

/// From one Runge–Kutta stage to the next: adds the rate of this one with its weight, and advances from the start by it over
/// `h`.
pub(super) struct Stage<'a> {
    /// Start and weighted mean rate of each lane block.
    pub states: &'a mut [SubstepState],
    /// Is this the first stage, which starts the mean?
    pub first: bool,
    /// Weight of this stage's rate in the mean.
    pub weight: f64,
    /// Time from the start to the next stage, s.
    pub h: f64,
}

impl LaneKernel for Stage<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (block_bodies, block) = lane_block(system, index);
        let a = accelerations(lanes, system, &block_bodies);
        let substep = &self.states[index];
        let start = substep.start.get(lanes);
        let (rate, mut mean) = if self.first {
            let zero = start.velocity.x.all(0.0);
            let none = V3 { x: zero, y: zero, z: zero };
            let mean =
                Rate { velocity: none, sigma: none, acceleration: SpatialVector { linear: none, angular: none } };
            (Rate::of(start.velocity, start.spin, none, a), mean)
        } else {
            let (velocity, spin) = (block.state.velocity.get(lanes), block.state.spin.get(lanes));
            (Rate::of(velocity, spin, substep.sigma.get(lanes), a), substep.mean.get(lanes))
        };
        mean.add(self.weight, &rate);
        let (state, sigma) = advance(lanes, &start, self.h, &rate);
        let substep = &mut self.states[index];
        if self.first {
            substep.start_acceleration.put(lanes, &a);
        }
        substep.mean.set(lanes, &mean);
        substep.sigma.put(lanes, sigma);
        put(lanes, system, index, &state);
    }
}

/// From the last Runge–Kutta stage to the end of the substep.
pub(super) struct Last<'a> {
    /// Start and mean rate of each lane block.
    pub states: &'a mut [SubstepState],
    /// Length of the substep, s.
    pub h: f64,
    /// Weight of the last rate.
    pub weight: f64,
}

impl LaneKernel for Last<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (block_bodies, block) = lane_block(system, index);
        let a = accelerations(lanes, system, &block_bodies);
        let substep = &self.states[index];
        let rate = Rate::of(block.state.velocity.get(lanes), block.state.spin.get(lanes), substep.sigma.get(lanes), a);
        let mut mean = substep.mean.get(lanes);
        mean.add(self.weight, &rate);
        let (state, _) = advance(lanes, &substep.start.get(lanes), self.h, &mean);
        self.states[index].last_acceleration.put(lanes, &a);
        put(lanes, system, index, &state);
    }
}

/// Error estimate by the new rate (`integrate.rs`): each body's terms of the two sums.
pub(super) struct Estimate<'a> {
    /// Start and rates of each lane block.
    pub states: &'a mut [SubstepState],
    /// Written for each body: its terms of the sums of error and scale.
    pub norms: &'a mut [[f64; 2]],
    /// 1/h³.
    pub per_cube: f64,
    /// h⁵/(6 h').
    pub scale: f64,
    /// There was a substep before.
    pub has_previous: bool,
    /// Index of the substep's difference.
    pub index: usize,
}

impl LaneKernel for Estimate<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (block_bodies, block) = lane_block(system, index);
        let (mass, inertia) = (lanes.get(&block.mass), block.inertia.get(lanes));
        let a = accelerations(lanes, system, &block_bodies);
        let substep = &self.states[index];
        let (last, previous) = (substep.last_acceleration.get(lanes), substep.previous_estimate.get(lanes));
        let (per_cube, factor) = (mass.all(self.per_cube), mass.all(self.scale));
        let estimate = SpatialVector {
            linear: (a.linear - last.linear) * per_cube,
            angular: (a.angular - last.angular) * per_cube,
        };
        let mut change = estimate;
        if self.has_previous {
            change.linear -= previous.linear;
            change.angular -= previous.angular;
        }
        change = SpatialVector { linear: change.linear * factor, angular: change.angular * factor };
        let now = SpatialVector { linear: block.state.velocity.get(lanes), angular: block.state.spin.get(lanes) };
        let error = norm(mass, &inertia, &change);
        let slowest = mass.all(SLOWEST);
        let scale = norm(mass, &inertia, &now) + mass * slowest * slowest;
        let changed = difference(a, substep.start_acceleration.get(lanes));
        let substep = &mut self.states[index];
        substep.differences[self.index].put(lanes, &changed);
        substep.previous_estimate.put(lanes, &estimate);
        let norms = &mut *self.norms;
        lanes.scatter(block_bodies.count, &[error, scale], |lane, norm| norms[block_bodies.bodies[lane]] = *norm);
    }
}

/// Sets the right-hand side: gravity, damping, the gyroscopic torque and external wrenches.
pub(super) struct ApplyForces<'a> {
    /// External wrench on each body: N and N m about its centre of mass.
    pub external: &'a [Vec6],
    /// Linear and angular damping rates by lane blocks, 1/s.
    pub damping: &'a [[Four; 2]],
    /// World acceleration by gravity, m/s².
    pub gravity: DVec3,
}

impl LaneKernel for ApplyForces<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (block_bodies, block) = lane_block(system, index);
        let external = SpatialVector::gather(lanes, |k| &self.external[block_bodies.bodies[k]]);
        let [linear, angular] = self.damping[index].each_ref().map(|rate| lanes.get(rate));
        let bodies = BodyLanes {
            mass: lanes.get(&block.mass),
            inertia: block.inertia.get(lanes),
            velocity: SpatialVector { linear: block.state.velocity.get(lanes), angular: block.state.spin.get(lanes) },
            linear_damping: linear,
            angular_damping: angular,
        };
        let own = forces::body_wrench(&bodies, self.gravity);
        let total = SpatialVector { linear: own.linear + external.linear, angular: own.angular + external.angular };
        let b = &mut system.b;
        lanes.scatter(block_bodies.count, &total.numbers(), |lane, wrench| b[block_bodies.bodies[lane]] = *wrench);
    }
}

/// Rates of the three Gauss–Legendre stages, by lane blocks.
pub(super) type Stages = [Vec<Rate<Four>>; 3];

/// The initial guess of the three Gauss–Legendre rates.
pub(super) struct Guess<'a> {
    /// Start and past rates of each lane block.
    pub states: &'a [SubstepState],
    /// Written: rates of the stages.
    pub stages: &'a mut Stages,
    /// Length of the substep, s.
    pub h: f64,
    /// Fractions of the substep at which the rates are taken.
    pub nodes: [f64; 3],
}

impl LaneKernel for Guess<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (block_bodies, _) = lane_block(system, index);
        let a = accelerations(lanes, system, &block_bodies);
        let start = self.states[index].start.get(lanes);
        let zero = start.velocity.x.all(0.0);
        let rate = Rate::of(start.velocity, start.spin, V3 { x: zero, y: zero, z: zero }, a);
        // The velocity is extrapolated by the acceleration, which is a better guess than a constant.
        for (rates, node) in self.stages.iter_mut().zip(self.nodes) {
            let ahead = zero.all(node * self.h);
            let mut guess = rate;
            guess.velocity += a.linear * ahead;
            guess.sigma += a.angular * ahead;
            rates[index].set(lanes, &guess);
        }
    }
}

/// From the start over `h` by a weighted sum of the three Gauss–Legendre rates.
pub(super) struct Mean<'a> {
    /// Start of each lane block.
    pub states: &'a mut [SubstepState],
    /// Rates of the stages.
    pub stages: &'a Stages,
    /// Weights of the three rates.
    pub weights: [f64; 3],
    /// Time over which it advances, s.
    pub h: f64,
}

impl LaneKernel for Mean<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let start = self.states[index].start.get(lanes);
        let zero = start.velocity.x.all(0.0);
        let none = V3 { x: zero, y: zero, z: zero };
        let mut mean =
            Rate { velocity: none, sigma: none, acceleration: SpatialVector { linear: none, angular: none } };
        for (rates, weight) in self.stages.iter().zip(self.weights) {
            mean.add(weight, &rates[index].get(lanes));
        }
        let (state, sigma) = advance(lanes, &start, self.h, &mean);
        self.states[index].sigma.put(lanes, sigma);
        put(lanes, system, index, &state);
    }
}

/// Takes over the rate of a Gauss–Legendre stage, with the squares of its change and of its size.
pub(super) struct Compare<'a> {
    /// Start of each lane block.
    pub states: &'a [SubstepState],
    /// Rates of the stages; the one of `stage` is written.
    pub stages: &'a mut Stages,
    /// Written for each body: squares of the rate's change and of its size.
    pub norms: &'a mut [[f64; 2]],
    /// Index of the stage, 0 to 2.
    pub stage: usize,
}

impl LaneKernel for Compare<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (block_bodies, block) = lane_block(system, index);
        let a = accelerations(lanes, system, &block_bodies);
        let sigma = self.states[index].sigma.get(lanes);
        let rate = Rate::of(block.state.velocity.get(lanes), block.state.spin.get(lanes), sigma, a);
        let old = self.stages[self.stage][index].get(lanes);
        let (linear, angular) = (a.linear - old.acceleration.linear, a.angular - old.acceleration.angular);
        let sigma_change = rate.sigma - old.sigma;
        let change = linear.dot(linear) + angular.dot(angular) + sigma_change.dot(sigma_change);
        let size = a.linear.dot(a.linear) + a.angular.dot(a.angular) + rate.sigma.dot(rate.sigma);
        self.stages[self.stage][index].set(lanes, &rate);
        let norms = &mut *self.norms;
        lanes.scatter(block_bodies.count, &[change, size], |lane, norm| norms[block_bodies.bodies[lane]] = *norm);
    }
}
