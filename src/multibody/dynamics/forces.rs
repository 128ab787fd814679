//! Forces on the bodies: gravity, springs, damping, the gyroscopic torque, and external wrenches.
//!
//! ```text
//! body     f = m g − c m v            τ = −ω × I ω − c' I ω
//! spring   F = k (l − l₀) + c l̇       along the line of its two points, or as a torque about an axis
//! ```

use crate::articulation::rows::BodyStates;
use crate::articulation::rows::coupling::Gauge;
use crate::articulation::{Activity, Anchor, Load, LoadKind, Spring, SpringKind};
use soffio_geometry::bodies::RigidBody;
use soffio_math::lanes::{Real, V3};
use soffio_math::spatial::SpatialVector;
use soffio_math::spatial::{Sym3, matrix};
use soffio_math::spatial::{Vec6, add_scaled, vec6};
use soffio_math::{DMat3, DVec3, Function};

/// Damping rates of a body, 1/s: force −c m v, torque −c I ω.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Damping {
    /// Of the velocity of the centre of mass.
    pub linear: f64,
    /// Of the angular velocity.
    pub angular: f64,
}

/// Bodies in lanes, for [`body_wrench`].
#[derive(Clone, Copy, Debug)]
pub struct BodyLanes<T> {
    /// Mass, kg.
    pub mass: T,
    /// World inertia, kg m².
    pub inertia: Sym3<T>,
    /// Velocities, m/s and rad/s.
    pub velocity: SpatialVector<T>,
    /// Linear damping rate, 1/s.
    pub linear_damping: T,
    /// Angular damping rate, 1/s.
    pub angular_damping: T,
}

/// Wrench of gravity (m/s²), damping and the gyroscopic torque on bodies, N and N m.
#[inline(always)]
pub fn body_wrench<T: Real>(bodies: &BodyLanes<T>, gravity: DVec3) -> SpatialVector<T> {
    let BodyLanes { mass, inertia, velocity: SpatialVector { linear: velocity, angular: spin }, .. } = *bodies;
    let gravity = V3 { x: mass.all(gravity.x), y: mass.all(gravity.y), z: mass.all(gravity.z) };
    let momentum = inertia.mul(spin);
    SpatialVector {
        linear: (gravity - velocity * bodies.linear_damping) * mass,
        angular: -spin.cross(momentum) - momentum * bodies.angular_damping,
    }
}

/// Wrenches on the bodies, N and N m about each centre of mass. Nothing here allocates after [`Wrenches::new`].
#[derive(Clone, Debug)]
pub(super) struct Wrenches {
    /// External ones, constant over a step.
    pub given: Vec<Vec6>,
    /// The same and those of resting contacts or, in position-based steps, of springs.
    pub total: Vec<Vec6>,
    scratch: Vec<Vec6>,
}

impl Wrenches {
    /// No wrenches on so many bodies.
    pub fn new(bodies: usize) -> Self {
        let none = vec![[0.0; 6]; bodies];
        Self { given: none.clone(), total: none.clone(), scratch: none }
    }

    /// Sets the total to the external wrenches and those that `add` adds. Returns whether the total changed.
    pub fn sum_up(&mut self, add: impl FnOnce(&mut [Vec6])) -> bool {
        self.scratch.copy_from_slice(&self.given);
        add(&mut self.scratch);
        let changed = self.scratch != self.total;
        if changed {
            std::mem::swap(&mut self.scratch, &mut self.total);
        }
        changed
    }
}

/// The springs of an articulation.
#[derive(Clone, Debug)]
pub struct Springs {
    springs: Vec<Spring>,
    /// Gauge of each angular spring.
    gauges: Vec<Option<Gauge>>,
    /// Which springs act, and how much.
    pub activity: Activity,
    /// Springs of bodies that are awake.
    acting: Vec<usize>,
    /// Rotation matrices of the bodies.
    frames: Vec<DMat3>,
}

/// State of a spring: its length or angle, the rate of it, and the wrenches of a unit force on its bodies.
struct SpringState {
    /// m or rad.
    value: f64,
    /// m/s or rad/s.
    rate: f64,
    ends: [(Option<usize>, Vec6); 2],
}

impl Springs {
    /// The springs of bodies in their start state.
    pub fn new(springs: &[Spring], bodies: &[RigidBody]) -> Self {
        let gauge = |spring: &Spring| match &spring.kind {
            SpringKind::Linear { .. } => None,
            SpringKind::Angular { measure } => Some(Gauge::new(*measure, bodies)),
        };
        Self {
            gauges: springs.iter().map(gauge).collect(),
            activity: Activity::of_springs(springs),
            acting: (0..springs.len()).collect(),
            springs: springs.to_vec(),
            frames: vec![DMat3::IDENTITY; if springs.is_empty() { 0 } else { bodies.len() }],
        }
    }

    /// Whether there are no springs.
    pub fn is_empty(&self) -> bool {
        self.springs.is_empty()
    }

    /// Gives the rest length (m) or rest angle (rad) of a spring, and its rate, from now on. It acts where the spring was made with
    /// [`Function::Given`]; others do not change.
    pub fn give_rest(&mut self, spring: usize, value: f64, rate: f64) {
        if let Some(Spring { rest_length: length @ Function::Given { .. }, .. }) = self.springs.get_mut(spring) {
            *length = Function::Given { value, rate };
        }
    }

    /// Sets which bodies sleep; their springs are left out.
    pub fn set_asleep(&mut self, asleep: &[bool]) {
        let Self { springs, acting, .. } = self;
        let sleeps =
            |spring: &Spring| asleep.iter().enumerate().any(|(body, asleep)| *asleep && spring.kind.acts_on(body));
        acting.clear();
        acting.extend((0..springs.len()).filter(|&spring| !sleeps(&springs[spring])));
    }

    /// Adds the springs' wrenches at the time `t` to `b`, N and N m.
    pub fn add_forces(&mut self, bodies: &[RigidBody], t: f64, b: &mut [Vec6]) {
        if self.acting.is_empty() {
            return;
        }
        self.update_frames(bodies);
        for &index in &self.acting {
            let (force, state) = self.force(index, bodies, t);
            for (body, wrench) in &state.ends {
                if let Some(body) = body {
                    add_scaled(&mut b[*body], force, wrench);
                }
            }
        }
    }

    /// Breaks overloaded springs at the time `t`.
    pub fn break_overloaded(&mut self, bodies: &[RigidBody], t: f64) {
        if self.activity.fragile().is_empty() {
            return;
        }
        self.update_frames(bodies);
        for k in 0..self.activity.fragile().len() {
            let index = self.activity.fragile()[k];
            let (force, _) = self.force(index, bodies, t);
            self.activity.set_reclosed(index, true);
            let load = match self.springs[index].kind {
                SpringKind::Linear { .. } => Load { force: force.abs(), torque: 0.0 },
                SpringKind::Angular { .. } => Load { force: 0.0, torque: force.abs() },
            };
            if self.activity.overloaded(index, load, LoadKind::Continuous) {
                self.activity.break_at(index, t);
            }
        }
    }

    /// Counts full turns up to this state; to be called once a step.
    pub fn count_revolutions(&mut self, bodies: &[RigidBody]) {
        self.gauges.iter_mut().flatten().for_each(|gauge| gauge.count(bodies));
    }

    /// Energy stored at the time `t`, J.
    pub fn energy(&self, bodies: &[RigidBody], t: f64) -> f64 {
        let frames: Vec<DMat3> = bodies.iter().map(|body| matrix(body.rotation)).collect();
        (0..self.springs.len())
            .map(|index| {
                let spring = &self.springs[index];
                let stretch = self.state(index, bodies, &frames).value - spring.rest_length.at(t).value;
                0.5 * self.activity.activation(index) * spring.stiffness.at(t).value * stretch * stretch
            })
            .sum()
    }

    /// Force (N) or torque (N m) that shortens a spring, in the attitudes of the last evaluation; 0 while it is open.
    pub fn pull(&self, index: usize, bodies: &[RigidBody], t: f64) -> f64 {
        self.force(index, bodies, t).0
    }

    fn update_frames(&mut self, bodies: &[RigidBody]) {
        for (frame, body) in self.frames.iter_mut().zip(bodies) {
            *frame = matrix(body.rotation);
        }
    }

    /// Force (N) or torque (N m) that shortens a spring, and its state.
    fn force(&self, index: usize, bodies: &[RigidBody], t: f64) -> (f64, SpringState) {
        let (spring, state) = (&self.springs[index], self.state(index, bodies, &self.frames));
        let rest_length = spring.rest_length.at(t);
        let pull = spring.stiffness.at(t).value * (state.value - rest_length.value)
            + spring.damping.at(t).value * (state.rate - rest_length.rate);
        (self.activity.activation(index) * pull, state)
    }

    fn state(&self, index: usize, bodies: &[RigidBody], frames: &[DMat3]) -> SpringState {
        let scene = BodyStates { bodies, frames, time: 0.0 };
        match (&self.springs[index].kind, &self.gauges[index]) {
            (SpringKind::Linear { a, b }, _) => {
                let (p, q) = (scene.point(a), scene.point(b));
                let separation = q.position - p.position;
                let along = separation.try_normalize().unwrap_or(DVec3::ZERO);
                let wrench = |anchor: &Anchor, arm: DVec3, e: DVec3| (anchor.body, vec6(e, arm.cross(e)));
                SpringState {
                    value: separation.length(),
                    rate: (q.velocity - p.velocity).dot(along),
                    ends: [wrench(a, p.arm, along), wrench(b, q.arm, -along)],
                }
            }
            (SpringKind::Angular { .. }, Some(gauge)) => {
                let reading = gauge.read(&scene);
                let (on, against) = gauge.bodies();
                let rate = |body: Option<usize>, block: &Vec6| {
                    body.map_or(0.0, |i| {
                        soffio_math::spatial::dot(block, &vec6(bodies[i].velocity, bodies[i].angular_velocity))
                    })
                };
                SpringState {
                    value: reading.total(),
                    rate: rate(on, &reading.on) + rate(against, &reading.against),
                    ends: [(on, reading.on.map(|x| -x)), (against, reading.against.map(|x| -x))],
                }
            }
            (SpringKind::Angular { .. }, None) => SpringState { value: 0.0, rate: 0.0, ends: [(None, [0.0; 6]); 2] },
        }
    }
}

/// Kinetic energy, and potential energy in gravity (m/s²; zero at the world's origin), J.
pub fn mechanical_energy(bodies: &[RigidBody], gravity: DVec3) -> f64 {
    bodies.iter().map(|b| b.kinetic_energy() - b.properties.mass * gravity.dot(b.position)).sum()
}
