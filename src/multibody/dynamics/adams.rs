//! Adams–Bashforth–Moulton predictor–corrector: reuses past accelerations, so that a smooth step needs two evaluations.
//!
//! Where accelerations were smooth for three steps, their backward differences extrapolate them (Hairer, Nørsett, Wanner,
//! *Solving Ordinary Differential Equations I*, III.1 and III.10). With a = a(y_n), and ∇, ∇², ∇³ its differences:
//!
//! ```text
//! predict    v* = v + h (a + ∇/2 + 5∇²/12 + 3∇³/8)            x* = x + h v + h² (a/2 + ∇/6 + ∇²/8 + 19∇³/180)
//! evaluate   a* = a(y*),   ∇* = a* − a,   ∇*² = ∇* − ∇, …
//! correct    v' = v + h (a* − ∇*/2 − ∇*²/12 − ∇*³/24)         x' = x + h (v + v')/2 − h² ∇*/12
//! error      e  = 19/720 h ∇*⁴,   relative to the velocities as in `integrate.rs`
//! ```
//!
//! Then the joints are closed, and the next step evaluates the rate there under its own forces. Runge–Kutta needs four
//! evaluations. The order is four as well. A pendulum of phase φ = ω h a step errs by φ⁵/80 in phase and by φ⁶/98 in amplitude
//! (Runge–Kutta: φ⁵/120, φ⁶/144). A rotation vector σ, q' = exp(σ) q, is found like x from ω and α, less h²/12 ω×ω' because
//! rotations do not commute. That is the whole Magnus series to fourth order.
//!
//! Wind, resting contacts and friction are constant within a step and jump between steps. So a difference is taken within its step,
//! under the forces of that step, from its beginning to its predicted end, ∇*. A jump of the forces is in `a` and in no difference.
//! A change of the joints, an impact, or a step of another length ends the history, and Runge–Kutta starts a new one. The error
//! estimate finds all other disturbances.

use super::equations::Equations;
use super::lane_kernels::{LaneKernel, accelerations, lane_block, put, run_kernel};
use super::substep_state::{DIFFERENCES, ORDER, SLOWEST, SubstepState, difference, norm};
use crate::articulation::System;
use crate::articulation::lane_blocks::State;
use soffio_geometry::bodies::RigidBody;
use soffio_math::lanes::{Lanes, Quat, Real, V3};
use soffio_math::spatial::SpatialVector;

/// Largest relative error of a step; beyond it Runge–Kutta repeats the step.
const TOLERANCE: f64 = 1e-7;
/// Coefficient of ∇⁴ in the corrector's error.
const ERROR: f64 = 19.0 / 720.0;

/// Whether motion was smooth enough for a multistep method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Smoothness {
    Smooth,
    NotSmooth,
}

/// The past steps that a multistep method extrapolates: a ring of differences, which each [`SubstepState`] holds.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MultistepHistory {
    /// Length of its steps, s.
    h: f64,
    /// Number of differences.
    count: usize,
    /// Index of the present step's difference.
    head: usize,
    /// The present step has stored its difference.
    is_stored: bool,
}

impl MultistepHistory {
    /// Begins a substep where the last one ended.
    pub fn begin_substep(&mut self) {
        if self.is_stored {
            self.head = (self.head + 1) % DIFFERENCES;
            self.count = (self.count + 1).min(ORDER);
            self.is_stored = false;
        }
    }

    /// Discards the history: past differences say nothing about the next step.
    pub fn end(&mut self) {
        (self.count, self.is_stored) = (0, false);
    }

    /// Records a step of `h` seconds by another method. Returns the index of its difference.
    pub fn record_step(&mut self, h: f64) -> usize {
        if self.h != h {
            self.end();
            self.h = h;
        }
        self.is_stored = true;
        self.head
    }

    /// Whether there are enough differences for a step of `h` seconds.
    pub fn is_sufficient(&self, h: f64) -> bool {
        self.count >= ORDER && self.h == h
    }

    /// Records a step by this method.
    pub fn extend(&mut self) {
        self.is_stored = true;
    }

    /// Predicts the state after `h` seconds and finds the accelerations there, at the time `t + h`. Those of the present state
    /// must be known.
    pub fn predict(
        &self,
        equations: &mut Equations,
        bodies: &mut [RigidBody],
        states: &mut [SubstepState],
        t: f64,
        h: f64,
    ) {
        run_kernel(&mut equations.system, Predict { states, h, indices: self.indices() });
        equations.accelerate(bodies, t + h);
    }

    /// Corrects the predicted state by the accelerations found there.
    pub fn correct(
        &self,
        system: &mut System,
        states: &mut [SubstepState],
        norms: &mut [[f64; 2]],
        h: f64,
    ) -> Smoothness {
        run_kernel(system, Correct { states, norms: &mut *norms, h, indices: self.indices(), index: self.head });
        let [error, scale] = norms.iter().fold([0.0, 0.0], |sum, norm| [sum[0] + norm[0], sum[1] + norm[1]]);
        // NaN is not smooth.
        if error <= TOLERANCE * TOLERANCE * scale { Smoothness::Smooth } else { Smoothness::NotSmooth }
    }

    /// Indices of the last differences, the newest first.
    fn indices(&self) -> [usize; ORDER] {
        [1, 2, 3].map(|ago| (self.head + DIFFERENCES - ago) % DIFFERENCES)
    }
}

/// ∇, ∇² and ∇³ of the last steps.
#[inline(always)]
fn differences<L: Lanes>(lanes: L, substep: &SubstepState, indices: [usize; ORDER]) -> [SpatialVector<L::T>; ORDER] {
    let at = |ago: usize| substep.differences[indices[ago]].get(lanes);
    let (first, second, third) = (at(0), at(1), at(2));
    let (last, before) = (difference(first, second), difference(second, third));
    [first, last, difference(last, before)]
}

/// Σ w_i of some vectors.
#[inline(always)]
fn sum<T: Real, const N: usize>(vectors: [V3<T>; N], weights: [f64; N]) -> V3<T> {
    let mut sum = vectors[0] * vectors[0].x.all(weights[0]);
    for i in 1..N {
        sum += vectors[i] * vectors[i].x.all(weights[i]);
    }
    sum
}

/// The state with the velocities `to`, displaced and rotated by `displacement` (m, rad).
#[inline(always)]
fn displaced<T: Real, L: Lanes<T = T>>(
    lanes: L,
    from: &State<T>,
    h: f64,
    to: SpatialVector<T>,
    mut displacement: SpatialVector<T>,
) -> State<T> {
    displacement.angular -= from.spin.cross(to.angular) * from.rotation.w.all(h * h / 12.0);
    State {
        position: from.position + displacement.linear,
        rotation: Quat::of_turn(lanes, displacement.angular).times(from.rotation).renormalized(),
        velocity: to.linear,
        spin: to.angular,
    }
}

struct Predict<'a> {
    states: &'a mut [SubstepState],
    h: f64,
    indices: [usize; ORDER],
}

impl LaneKernel for Predict<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (block_bodies, _) = lane_block(system, index);
        let a = accelerations(lanes, system, &block_bodies);
        let substep = &mut self.states[index];
        substep.start_acceleration.put(lanes, &a);
        let (start, h) = (substep.start.get(lanes), self.h);
        let [d, dd, ddd] = differences(lanes, substep, self.indices);
        let h2 = h * h;
        let velocity = [1.0, h, h / 2.0, h * 5.0 / 12.0, h * 3.0 / 8.0];
        let displacement = [h, h2 / 2.0, h2 / 6.0, h2 / 8.0, h2 * 19.0 / 180.0];
        let linear = [start.velocity, a.linear, d.linear, dd.linear, ddd.linear];
        let angular = [start.spin, a.angular, d.angular, dd.angular, ddd.angular];
        let to = SpatialVector { linear: sum(linear, velocity), angular: sum(angular, velocity) };
        let displacement = SpatialVector { linear: sum(linear, displacement), angular: sum(angular, displacement) };
        let state = displaced(lanes, &start, h, to, displacement);
        put(lanes, system, index, &state);
    }
}

struct Correct<'a> {
    states: &'a mut [SubstepState],
    norms: &'a mut [[f64; 2]],
    h: f64,
    indices: [usize; ORDER],
    /// Index of the step's own difference.
    index: usize,
}

impl LaneKernel for Correct<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (block_bodies, block) = lane_block(system, index);
        let (mass, inertia) = (lanes.get(&block.mass), block.inertia.get(lanes));
        let a = accelerations(lanes, system, &block_bodies);
        let substep = &self.states[index];
        let (start, h) = (substep.start.get(lanes), self.h);
        let [d, dd, ddd] = differences(lanes, substep, self.indices);
        let first = difference(a, substep.start_acceleration.get(lanes));
        let second = difference(first, d);
        let third = difference(second, dd);
        let fourth = difference(third, ddd);
        let velocity = [1.0, h, -h / 2.0, -h / 12.0, -h / 24.0];
        let displacement = [h / 2.0, h / 2.0, -h * h / 12.0];
        let to = SpatialVector {
            linear: sum([start.velocity, a.linear, first.linear, second.linear, third.linear], velocity),
            angular: sum([start.spin, a.angular, first.angular, second.angular, third.angular], velocity),
        };
        let displacement = SpatialVector {
            linear: sum([start.velocity, to.linear, first.linear], displacement),
            angular: sum([start.spin, to.angular, first.angular], displacement),
        };
        let state = displaced(lanes, &start, h, to, displacement);
        let weight = mass.all(ERROR * h);
        let error =
            norm(mass, &inertia, &SpatialVector { linear: fourth.linear * weight, angular: fourth.angular * weight });
        let slowest = mass.all(SLOWEST);
        let scale = norm(mass, &inertia, &to) + mass * slowest * slowest;
        self.states[index].differences[self.index].put(lanes, &first);
        put(lanes, system, index, &state);
        let norms = &mut *self.norms;
        lanes.scatter(block_bodies.count, &[error, scale], |lane, norm| norms[block_bodies.bodies[lane]] = *norm);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::articulation::{Anchor, Constraint, ConstraintKind};
    use crate::collision::{Collider, ReachableVolumes, Shape, pairs};
    use crate::dynamics::forces::Damping;
    use crate::dynamics::{Articulation, Dynamics, Integrator, RollingResistance, Settings, Solver, SurfacePair};
    use soffio_geometry::bodies::MassProperties;
    use soffio_math::noise::Random;
    use soffio_math::{DMat3, DVec3, Pose, rotation};

    const G: f64 = 9.81;
    const DT: f64 = 1.0 / 240.0;

    /// One body, far above a floor.
    fn articulation(body: RigidBody, constraints: &[Constraint], gravity: f64, integrator: Integrator) -> Dynamics {
        let far = Shape::plane(DVec3::Y * -100.0, DVec3::Y);
        let collider = |body, shape| Collider { body, shape, material: 0, node: String::new() };
        let colliders = [collider(Some(0), Shape::sphere(DVec3::ZERO, 1e-3)), collider(None, far)];
        let surface = |pair| SurfacePair {
            pair,
            restitution: 0.0,
            friction: 0.0,
            full_slip: 0.0,
            resistance: RollingResistance::default(),
        };
        let settings = Settings {
            gravity: DVec3::Y * -gravity,
            friction: false,
            stabilization_time: 0.04,
            integrator,
            solver: Solver::Sparse,
        };
        let articulation = Articulation {
            bodies: vec![body],
            damping: vec![Damping::default()],
            constraints,
            limits: &[],
            springs: &[],
            kinematic_bodies: &[],
            pairs: pairs(&colliders, &[], &ReachableVolumes::default()).meet.into_iter().map(surface).collect(),
            colliders: &colliders,
        };
        Dynamics::new(articulation, settings)
    }

    fn body(inertia: DVec3, position: DVec3) -> RigidBody {
        let properties = MassProperties { mass: 0.1, center: DVec3::ZERO, inertia: DMat3::from_diagonal(inertia) };
        RigidBody::at_rest(properties, Pose { position, ..Pose::IDENTITY })
    }

    /// So many steps; answers how many of them this method did.
    fn run(dynamics: &mut Dynamics, dt: f64, steps: usize) -> usize {
        let mut own = 0;
        for _ in 0..steps {
            dynamics.step(dt, &[[0.0; 6]], &mut Vec::new());
            own += usize::from(dynamics.integration.last_runge_kutta_substep.is_none());
        }
        own
    }

    #[test]
    fn a_pendulum_errs_in_phase_and_swing_as_the_formula_says() {
        /// What is is_stored of the formulas: the next order; in the swing also that joints are closed after each step.
        const SPREAD: [f64; 2] = [0.05, 0.15];
        const PHI: f64 = 0.07;
        let omega = PHI / DT;
        // ω² = m g r/(I + m r²) with I = 3 m r².
        let arm = G / (4.0 * omega * omega);
        let nail = |body, point| Anchor { body, point };
        let kind = ConstraintKind::PointToPoint { a: nail(Some(0), DVec3::Y * arm), b: nail(None, DVec3::ZERO) };
        let constraints = [Constraint::new("nail", kind)];
        let [mut own, mut precise] = [Integrator::Auto, Integrator::Precise].map(|integrator| {
            // Swings so small that they are nothing but sine.
            let mut rod = body(DVec3::splat(0.3 * arm * arm), DVec3::Y * -arm);
            rod.velocity = DVec3::X * 4e-4;
            rod.angular_velocity = DVec3::Z * (4e-4 / arm);
            articulation(rod, &constraints, G, integrator)
        });
        let steps = 2000;
        let done = run(&mut own, DT, steps);
        assert!(done > steps - 10, "{done} of {steps}");
        run(&mut precise, DT, steps);
        let state = |dynamics: &Dynamics| {
            let (x, v) = (dynamics.bodies[0].position.x * omega, dynamics.bodies[0].velocity.x);
            (x.atan2(v), x.hypot(v))
        };
        let ((phase, swing), (true_phase, true_swing)) = (state(&own), state(&precise));
        let late = (phase - true_phase) / steps as f64 / soffio_math::pow(PHI, 5.0);
        let more = (swing / true_swing - 1.0) / steps as f64 / soffio_math::pow(PHI, 6.0);
        assert!((late.abs() * 80.0 - 1.0).abs() < SPREAD[0], "{late} of φ⁵ a step");
        assert!((more * 98.0 - 1.0).abs() < SPREAD[1], "{more} of φ⁶ a step");
    }

    #[test]
    fn a_spinning_body_is_followed_to_fourth_order() {
        let lands = |dt: f64, integrator| {
            let mut top = body(DVec3::new(1e-5, 2e-5, 2.6e-5), DVec3::ZERO);
            top.rotation = rotation(DVec3::new(0.3, -0.4, 0.5));
            top.angular_velocity = DVec3::new(1.5, 2.0, -1.2);
            let mut dynamics = articulation(top, &[], 0.0, integrator);
            let steps = (2.0 / dt).round() as usize;
            let own = run(&mut dynamics, dt, steps);
            assert!(integrator != Integrator::Auto || own > steps - 10, "{own} of {steps}");
            dynamics.bodies[0].rotation
        };
        let reference = lands(DT / 4.0, Integrator::Precise);
        let error = |dt: f64| 2.0 * (reference.conjugate() * lands(dt, Integrator::Auto)).xyz().length();
        let (coarse, fine) = (error(2.0 * DT), error(DT));
        // 2⁴, and its own start by Runge–Kutta, which is better.
        assert!((12.0..22.0).contains(&(coarse / fine)) && fine < 1e-8, "{coarse} and {fine} rad");
    }

    #[test]
    fn pushes_that_change_from_step_to_step_do_not_end_the_run_and_a_step_of_another_length_does() {
        let mut dynamics = articulation(body(DVec3::splat(1e-5), DVec3::ZERO), &[], 0.0, Integrator::Auto);
        let mut random = Random::new(3);
        let (mut speed, mut place, mut own) = (0.0, 0.0, 0);
        for _ in 0..100 {
            let push = random.signed();
            dynamics.step(DT, &[[push, 0.0, 0.0, 0.0, 0.0, 0.0]], &mut Vec::new());
            own += usize::from(dynamics.integration.last_runge_kutta_substep.is_none());
            place += DT * speed + 0.5 * DT * DT * push / 0.1;
            speed += DT * push / 0.1;
        }
        assert!(own >= 97, "{own}");
        // Rounding of a hundred steps.
        assert!(
            (dynamics.bodies[0].position.x - place).abs() < 1e-13
                && (dynamics.bodies[0].velocity.x - speed).abs() < 1e-13
        );
        assert_eq!(run(&mut dynamics, 0.5 * DT, 4), 1);
    }
}
