//! Adams' method: what the last steps have learnt spares half of the next one's solves.
//!
//! Where accelerations have gone smoothly for three steps, their backward differences say how they go on (Hairer, Nørsett,
//! Wanner, *Solving Ordinary Differential Equations I*, III.1 and III.10). With a = a(y_n), and ∇, ∇², ∇³ its differences:
//!
//! ```text
//! predict    v* = v + h (a + ∇/2 + 5∇²/12 + 3∇³/8)            x* = x + h v + h² (a/2 + ∇/6 + ∇²/8 + 19∇³/180)
//! evaluate   a* = a(y*),   ∇* = a* − a,   ∇*² = ∇* − ∇, …
//! correct    v' = v + h (a* − ∇*/2 − ∇*²/12 − ∇*³/24)         x' = x + h (v + v')/2 − h² ∇*/12
//! error      e  = 19/720 h ∇*⁴,   as a share of the velocities like that of `integrate.rs`
//! ```
//!
//! Then the joints are closed, and the next step finds the rate there, under its own forces: two evaluations where Runge–Kutta
//! takes four. Of fourth order as well; a pendulum of phase φ = ω h a step errs by φ⁵/80 in phase and by φ⁶/98 in amplitude (Runge–Kutta: φ⁵/120,
//! φ⁶/144). A rotation's vector σ, q' = exp(σ) q, is found like x from ω and α, and because turns do not commute less h²/12 ω×ω',
//! which is all that Magnus' series has to fourth order.
//!
//! Wind, resting contacts and friction push evenly for a step and change from one to the next. So a difference is taken within
//! its step, under the forces of that step, from its beginning to where it was predicted to end, ∇*: what a changed force does at
//! once is in `a`, and no difference knows of it. Whatever changes the joints, a hit, and a step of another length end the smooth
//! run; Runge–Kutta begins the next. What else may happen to bodies the error tells.

use super::equations::Equations;
use super::lane_kernels::{LaneKernel, accelerations, put, quad, run_kernel};
use super::substep_state::{ENOUGH, KEPT, SLOWEST, SubstepState, less, norm};
use crate::articulation::System;
use crate::articulation::ball::Twist;
use crate::articulation::quads::State;
use soffio_geometry::bodies::RigidBody;
use soffio_math::lanes::{Lanes, Quat, Real, V3};

/// Largest error of a step that this method may do, as a share of the velocities: beyond, Runge–Kutta with its own bounds.
const SMOOTH: f64 = 1e-7;
/// ∇⁴'s share in the corrector's error.
const ERROR: f64 = 19.0 / 720.0;

/// How long the run of steps that differ by little has lasted.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MultistepHistory {
    /// Length of its steps, s.
    h: f64,
    /// Differences that belong to it, and where the present step's goes.
    count: usize,
    head: usize,
    /// The last step has left one.
    left: bool,
}

impl MultistepHistory {
    /// A substep begins where the last one ended.
    pub fn begin(&mut self) {
        if self.left {
            self.head = (self.head + 1) % KEPT;
            self.count = (self.count + 1).min(ENOUGH);
            self.left = false;
        }
    }

    /// Something has happened: what was learnt before says nothing of what comes.
    pub fn end(&mut self) {
        (self.count, self.left) = (0, false);
    }

    /// A step of `h` seconds is done; answers where its difference goes.
    pub fn goes_by(&mut self, h: f64) -> usize {
        if self.h != h {
            self.end();
            self.h = h;
        }
        self.left = true;
        self.head
    }

    /// Has motion been smooth for as long as a step of `h` seconds asks?
    pub fn serves(&self, h: f64) -> bool {
        self.count >= ENOUGH && self.h == h
    }

    /// The step has been this method's own.
    pub fn go_on(&mut self) {
        self.left = true;
    }

    /// Predicts the state after `h` seconds and finds the accelerations there, at the time `t + h`. Those of the present state
    /// are known.
    pub fn predict(
        &self,
        equations: &mut Equations,
        bodies: &mut [RigidBody],
        states: &mut [SubstepState],
        (t, h): (f64, f64),
    ) {
        run_kernel(&mut equations.system, Predict { states, h, slots: self.slots() });
        equations.accelerate(bodies, t + h);
    }

    /// Corrects the predicted state by the accelerations found there. Was the motion smooth enough for it?
    pub fn correct(&self, system: &mut System, states: &mut [SubstepState], norms: &mut [[f64; 2]], h: f64) -> bool {
        run_kernel(system, Correct { states, norms: &mut *norms, h, slots: self.slots(), slot: self.head });
        let [error, scale] = norms.iter().fold([0.0, 0.0], |sum, norm| [sum[0] + norm[0], sum[1] + norm[1]]);
        // What is no number is not small.
        error <= SMOOTH * SMOOTH * scale
    }

    /// The slots of the last differences, the newest first.
    fn slots(&self) -> [usize; ENOUGH] {
        [1, 2, 3].map(|ago| (self.head + KEPT - ago) % KEPT)
    }
}

/// ∇, ∇² and ∇³ of the last steps.
#[inline(always)]
fn differences<L: Lanes>(lanes: L, substep: &SubstepState, slots: [usize; ENOUGH]) -> [Twist<L::T>; ENOUGH] {
    let at = |ago: usize| substep.differences[slots[ago]].get(lanes);
    let (first, second, third) = (at(0), at(1), at(2));
    let (last, before) = (less(first, second), less(second, third));
    [first, last, less(last, before)]
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

/// The state that velocities `v`, ω and ways (m, rad) lead to.
#[inline(always)]
fn arrived<T: Real, L: Lanes<T = T>>(lanes: L, from: &State<T>, h: f64, to: Twist<T>, mut way: Twist<T>) -> State<T> {
    way.angular -= from.spin.cross(to.angular) * from.rotation.w.all(h * h / 12.0);
    State {
        position: from.position + way.linear,
        rotation: Quat::of_turn(lanes, way.angular).times(from.rotation).renormalized(),
        velocity: to.linear,
        spin: to.angular,
    }
}

struct Predict<'a> {
    states: &'a mut [SubstepState],
    h: f64,
    slots: [usize; ENOUGH],
}

impl LaneKernel for Predict<'_> {
    #[inline(always)]
    fn go<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (members, _) = quad(system, index);
        let a = accelerations(lanes, system, &members);
        let substep = &mut self.states[index];
        substep.begun.put(lanes, &a);
        let (start, h) = (substep.start.get(lanes), self.h);
        let [d, dd, ddd] = differences(lanes, substep, self.slots);
        let h2 = h * h;
        let speed = [1.0, h, h / 2.0, h * 5.0 / 12.0, h * 3.0 / 8.0];
        let way = [h, h2 / 2.0, h2 / 6.0, h2 / 8.0, h2 * 19.0 / 180.0];
        let linear = [start.velocity, a.linear, d.linear, dd.linear, ddd.linear];
        let angular = [start.spin, a.angular, d.angular, dd.angular, ddd.angular];
        let to = Twist { linear: sum(linear, speed), angular: sum(angular, speed) };
        let way = Twist { linear: sum(linear, way), angular: sum(angular, way) };
        let state = arrived(lanes, &start, h, to, way);
        put(lanes, system, index, &state);
    }
}

struct Correct<'a> {
    states: &'a mut [SubstepState],
    norms: &'a mut [[f64; 2]],
    h: f64,
    slots: [usize; ENOUGH],
    /// Where the step's own difference goes.
    slot: usize,
}

impl LaneKernel for Correct<'_> {
    #[inline(always)]
    fn go<L: Lanes>(&mut self, lanes: L, system: &mut System, index: usize) {
        let (members, quad) = quad(system, index);
        let (mass, inertia) = (lanes.get(&quad.mass), quad.inertia.get(lanes));
        let a = accelerations(lanes, system, &members);
        let substep = &self.states[index];
        let (start, h) = (substep.start.get(lanes), self.h);
        let [d, dd, ddd] = differences(lanes, substep, self.slots);
        let first = less(a, substep.begun.get(lanes));
        let second = less(first, d);
        let third = less(second, dd);
        let fourth = less(third, ddd);
        let speed = [1.0, h, -h / 2.0, -h / 12.0, -h / 24.0];
        let way = [h / 2.0, h / 2.0, -h * h / 12.0];
        let to = Twist {
            linear: sum([start.velocity, a.linear, first.linear, second.linear, third.linear], speed),
            angular: sum([start.spin, a.angular, first.angular, second.angular, third.angular], speed),
        };
        let way = Twist {
            linear: sum([start.velocity, to.linear, first.linear], way),
            angular: sum([start.spin, to.angular, first.angular], way),
        };
        let state = arrived(lanes, &start, h, to, way);
        let share = mass.all(ERROR * h);
        let error = norm(mass, &inertia, &Twist { linear: fourth.linear * share, angular: fourth.angular * share });
        let slowest = mass.all(SLOWEST);
        let scale = norm(mass, &inertia, &to) + mass * slowest * slowest;
        self.states[index].differences[self.slot].put(lanes, &first);
        put(lanes, system, index, &state);
        let norms = &mut *self.norms;
        lanes.scatter(members.count, &[error, scale], |lane, norm| norms[members.bodies[lane]] = *norm);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::articulation::{Anchor, Constraint, ConstraintKind};
    use crate::collision::{Collider, Reach, Shape, pairs};
    use crate::dynamics::forces::Damping;
    use crate::dynamics::{Articulation, Dynamics, Integrator, RollingResistance, Settings, Solver, SurfacePair};
    use soffio_geometry::bodies::MassProperties;
    use soffio_math::noise::Random;
    use soffio_math::{DMat3, DVec3, Pose, rotation};

    const G: f64 = 9.81;
    const DT: f64 = 1.0 / 240.0;

    /// One body, far above a floor.
    fn figure(body: RigidBody, constraints: &[Constraint], gravity: f64, integrator: Integrator) -> Dynamics {
        let far = Shape::plane(DVec3::Y * -100.0, DVec3::Y);
        let collider = |body, shape| Collider { body, shape, material: 0, node: String::new() };
        let colliders = [collider(Some(0), Shape::sphere(DVec3::ZERO, 1e-3)), collider(None, far)];
        let surface =
            |pair| SurfacePair { pair, restitution: 0.0, friction: 0.0, resistance: RollingResistance::default() };
        let settings = Settings {
            gravity: DVec3::Y * -gravity,
            friction: false,
            stabilization_time: 0.04,
            integrator,
            solver: Solver::Sparse,
        };
        let figure = Articulation {
            bodies: vec![body],
            damping: vec![Damping::default()],
            constraints,
            limits: &[],
            springs: &[],
            kinematic_bodies: &[],
            pairs: pairs(&colliders, &[], &Reach::default()).meet.into_iter().map(surface).collect(),
            colliders: &colliders,
        };
        Dynamics::new(figure, settings)
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
            own += usize::from(dynamics.integration.fourth_step.is_none());
        }
        own
    }

    #[test]
    fn a_pendulum_errs_in_phase_and_swing_as_the_formula_says() {
        /// What is left of the formulas: the next order; in the swing also that joints are closed after each step.
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
            figure(rod, &constraints, G, integrator)
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
            let mut dynamics = figure(top, &[], 0.0, integrator);
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
        let mut dynamics = figure(body(DVec3::splat(1e-5), DVec3::ZERO), &[], 0.0, Integrator::Auto);
        let mut random = Random::new(3);
        let (mut speed, mut place, mut own) = (0.0, 0.0, 0);
        for _ in 0..100 {
            let push = random.signed();
            dynamics.step(DT, &[[push, 0.0, 0.0, 0.0, 0.0, 0.0]], &mut Vec::new());
            own += usize::from(dynamics.integration.fourth_step.is_none());
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
