//! Forces on the bodies: gravity, springs, damping, the gyroscopic torque, and what is handed in from outside.
//!
//! ```text
//! body     f = m g − c m v            τ = −ω × I ω − c' I ω
//! spring   F = k (l − l₀) + c l̇       along the line of its two points, or as a torque about the axis of a turn
//! ```

use crate::articulation::ball::Twist;
use crate::articulation::rows::Scene;
use crate::articulation::rows::coupling::Gauge;
use crate::articulation::{Activity, Anchor, Spring, SpringKind};
use soffio_geometry::bodies::RigidBody;
use soffio_math::lanes::{Real, V3};
use soffio_math::spatial::{Sym3, matrix};
use soffio_math::spatial::{Vec6, add_scaled, vec6};
use soffio_math::{DMat3, DVec3};

/// Damping rates of a body, 1/s: force −c m v, torque −c I ω.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Damping {
    /// Of the centre's velocity.
    pub linear: f64,
    /// Of the angular velocity.
    pub angular: f64,
}

/// Gravity, damping and the gyroscopic torque on bodies of this mass and world inertia, at these velocities.
#[inline(always)]
pub fn on_body<T: Real>(
    (mass, inertia): (T, &Sym3<T>),
    (velocity, spin): (V3<T>, V3<T>),
    gravity: DVec3,
    (linear, angular): (T, T),
) -> Twist<T> {
    let gravity = V3 { x: mass.all(gravity.x), y: mass.all(gravity.y), z: mass.all(gravity.z) };
    let momentum = inertia.mul(spin);
    Twist { linear: (gravity - velocity * linear) * mass, angular: -spin.cross(momentum) - momentum * angular }
}

/// Wrenches on the bodies of a figure, N and N m about each centre of mass. Nothing here allocates after [`Wrenches::new`].
#[derive(Clone, Debug)]
pub(super) struct Wrenches {
    /// From outside, for the whole of a step.
    pub given: Vec<Vec6>,
    /// The same with those of resting contacts, or of springs where something else moves the figure.
    pub total: Vec<Vec6>,
    scratch: Vec<Vec6>,
}

impl Wrenches {
    /// None on any of `bodies` bodies.
    pub fn new(bodies: usize) -> Self {
        let none = vec![[0.0; 6]; bodies];
        Self { given: none.clone(), total: none.clone(), scratch: none }
    }

    /// Sums up those from outside and what `add` adds to them. Is the total another one now?
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

/// All springs of a figure.
#[derive(Clone, Debug)]
pub struct Springs {
    springs: Vec<Spring>,
    /// What each measures, for the angular ones.
    gauges: Vec<Option<Gauge>>,
    /// Which act now.
    pub activity: Activity,
    /// Springs of bodies that are awake.
    acting: Vec<usize>,
    frames: Vec<DMat3>,
}

/// Where a spring is now: its length or angle, the rate of that, and the wrenches of a unit of force on its ends.
struct Stretch {
    value: f64,
    rate: f64,
    ends: [(Option<usize>, Vec6); 2],
}

impl Springs {
    /// Springs of bodies at their start.
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

    /// Is there none?
    pub fn is_empty(&self) -> bool {
        self.springs.is_empty()
    }

    /// Leaves out springs of bodies that sleep.
    pub fn let_sleep(&mut self, asleep: &[bool]) {
        let Self { springs, acting, .. } = self;
        let idle =
            |spring: &Spring| asleep.iter().enumerate().any(|(body, asleep)| *asleep && spring.kind.touches(body));
        acting.clear();
        acting.extend((0..springs.len()).filter(|&spring| !idle(&springs[spring])));
    }

    /// Adds their forces at the time `t` to `b`.
    pub fn push(&mut self, bodies: &[RigidBody], t: f64, b: &mut [Vec6]) {
        if self.acting.is_empty() {
            return;
        }
        self.look(bodies);
        for &index in &self.acting {
            let (force, stretch) = self.force(index, bodies, t);
            for (body, wrench) in &stretch.ends {
                if let Some(body) = body {
                    add_scaled(&mut b[*body], force, wrench);
                }
            }
        }
    }

    /// Breaks what is overloaded at the time `t`.
    pub fn break_overloaded(&mut self, bodies: &[RigidBody], t: f64) {
        if self.activity.fragile().is_empty() {
            return;
        }
        self.look(bodies);
        for k in 0..self.activity.fragile().len() {
            let index = self.activity.fragile()[k];
            let (force, _) = self.force(index, bodies, t);
            self.activity.mended(index, true);
            let load = match self.springs[index].kind {
                SpringKind::Linear { .. } => (force.abs(), 0.0),
                SpringKind::Angular { .. } => (0.0, force.abs()),
            };
            if self.activity.overloaded(index, load, false) {
                self.activity.break_at(index, t);
            }
        }
    }

    /// Counts turns up to this state; once a step.
    pub fn count_turns(&mut self, bodies: &[RigidBody]) {
        self.gauges.iter_mut().flatten().for_each(|gauge| gauge.count(bodies));
    }

    /// Energy stored at the time `t`, J.
    pub fn energy(&self, bodies: &[RigidBody], t: f64) -> f64 {
        let frames: Vec<DMat3> = bodies.iter().map(|body| matrix(body.rotation)).collect();
        (0..self.springs.len())
            .map(|index| {
                let spring = &self.springs[index];
                let stretch = self.stretch(index, bodies, &frames).value - spring.rest.at(t).value;
                0.5 * self.activity.share(index) * spring.stiffness.at(t).value * stretch * stretch
            })
            .sum()
    }

    fn look(&mut self, bodies: &[RigidBody]) {
        for (frame, body) in self.frames.iter_mut().zip(bodies) {
            *frame = matrix(body.rotation);
        }
    }

    /// Force (N) or torque (N m) that shortens the spring.
    fn force(&self, index: usize, bodies: &[RigidBody], t: f64) -> (f64, Stretch) {
        let (spring, stretch) = (&self.springs[index], self.stretch(index, bodies, &self.frames));
        let rest = spring.rest.at(t);
        let pull = spring.stiffness.at(t).value * (stretch.value - rest.value)
            + spring.damping.at(t).value * (stretch.rate - rest.rate);
        (self.activity.share(index) * pull, stretch)
    }

    fn stretch(&self, index: usize, bodies: &[RigidBody], frames: &[DMat3]) -> Stretch {
        let scene = Scene { bodies, frames, time: 0.0 };
        match (&self.springs[index].kind, &self.gauges[index]) {
            (SpringKind::Linear { a, b }, _) => {
                let (p, q) = (scene.point(a), scene.point(b));
                let way = q.position - p.position;
                let along = way.try_normalize().unwrap_or(DVec3::ZERO);
                let wrench = |anchor: &Anchor, arm: DVec3, e: DVec3| (anchor.body, vec6(e, arm.cross(e)));
                Stretch {
                    value: way.length(),
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
                Stretch {
                    value: reading.total(),
                    rate: rate(on, &reading.on) + rate(against, &reading.against),
                    ends: [(on, reading.on.map(|x| -x)), (against, reading.against.map(|x| -x))],
                }
            }
            (SpringKind::Angular { .. }, None) => Stretch { value: 0.0, rate: 0.0, ends: [(None, [0.0; 6]); 2] },
        }
    }
}

/// Kinetic energy, and potential energy in gravity (zero at the world's origin), J.
pub fn energy(bodies: &[RigidBody], gravity: DVec3) -> f64 {
    bodies.iter().map(|b| b.kinetic_energy() - b.properties.mass * gravity.dot(b.position)).sum()
}
