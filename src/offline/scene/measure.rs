//! Measures of a simulation, from the scene file and the bodies' states alone.
//!
//! ```text
//! E   = Σ ½ m v² + ½ ω·(R I Rᵀ ω) − m g·x                        energy, J
//! gap = |xₐ + Rₐ pₐ − x_b − R_b p_b|                              joint error, m; of a slider without its component
//! along the axis
//! q   = right-handed angle of b relative to a about the axis      hinge, not wrapped, rad
//! q   = (x_b + R_b p_b − xₐ − Rₐ pₐ) · axis                       slider, m
//! ```

use super::contact::{ContactObserver, ContactReport};
use super::format::{JointKind, PhysicsScene, SceneCoupling, SceneJoint};
use super::pendulum::Pendulum;
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DQuat, DVec3, PI, StateHash, atan2, tangents};

/// Relative energy error from which on a run counts as diverged.
const DIVERGED: f64 = 10.0;

/// Pose and velocities of a body, in any engine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Centre of mass, world, m.
    pub position: DVec3,
    /// Rotation from body axes to world axes.
    pub rotation: DQuat,
    /// Velocity of the centre of mass, m/s.
    pub velocity: DVec3,
    /// Angular velocity, world axes, rad/s.
    pub angular_velocity: DVec3,
}

impl BodyState {
    /// The world itself.
    pub const WORLD: Self =
        Self { position: DVec3::ZERO, rotation: DQuat::IDENTITY, velocity: DVec3::ZERO, angular_velocity: DVec3::ZERO };

    /// World position of a point of the body.
    pub fn point(&self, local: [f64; 3]) -> DVec3 {
        self.position + self.rotation * DVec3::from_array(local)
    }
}

impl From<&RigidBody> for BodyState {
    fn from(body: &RigidBody) -> Self {
        Self {
            position: body.pose().point(body.properties.center),
            rotation: body.rotation,
            velocity: body.velocity,
            angular_velocity: body.angular_velocity,
        }
    }
}

/// Kinetic and potential energy with the masses of the file, J; zero height is the world's origin.
pub fn energy(scene: &PhysicsScene, states: &[BodyState]) -> f64 {
    let gravity = DVec3::from_array(scene.gravity);
    let one = |(body, state): (&super::SceneBody, &BodyState)| {
        let spin = state.rotation.conjugate() * state.angular_velocity;
        let turning = 0.5 * spin.dot(DVec3::from_array(body.inertia) * spin);
        0.5 * body.mass * state.velocity.length_squared() + turning - body.mass * gravity.dot(state.position)
    };
    scene.bodies.iter().zip(states).map(one).sum()
}

/// Distance between the two anchors of a joint, m; of a slider without its displacement.
pub fn gap(joint: &SceneJoint, a: &BodyState, b: &BodyState) -> f64 {
    let apart = b.point(joint.anchor_b) - a.point(joint.anchor_a);
    match joint.axes() {
        Some((axis, _)) if joint.kind == JointKind::Slider => apart.reject_from_normalized(a.rotation * axis).length(),
        _ => apart.length(),
    }
}

/// Largest [`gap`] of any joint, m.
pub fn joint_error(scene: &PhysicsScene, states: &[BodyState]) -> f64 {
    scene.joints.iter().map(|joint| gap(joint, parent(joint, states), &states[joint.b])).fold(0.0, larger)
}

/// The larger of two numbers; NaN if either is NaN.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if b.is_nan() || b > a { b } else { a }
}

fn parent<'a>(joint: &SceneJoint, states: &'a [BodyState]) -> &'a BodyState {
    joint.parent().map_or(&BodyState::WORLD, |body| &states[body])
}

/// The coordinate of a hinge or slider, from the start.
#[derive(Clone, Debug)]
pub struct Coordinate {
    joint: SceneJoint,
    /// A direction perpendicular to the axis in the parent, and in the child at the start.
    across: (DVec3, DVec3),
    start: f64,
    value: f64,
}

impl Coordinate {
    /// The coordinate of a joint that has one, at zero.
    pub fn new(scene: &PhysicsScene, joint: usize) -> Option<Self> {
        let joint = scene.joints[joint].clone();
        let (axis, _) = joint.axes()?;
        let states: Vec<_> = scene.bodies.iter().map(super::SceneBody::state).collect();
        let (a, b) = (parent(&joint, &states), &states[joint.b]);
        let (t, _) = tangents(axis);
        let across = (t, b.rotation.conjugate() * (a.rotation * t));
        let mut coordinate = Self { joint, across, start: 0.0, value: 0.0 };
        coordinate.start = coordinate.raw(&states);
        Some(coordinate)
    }

    /// Angle within ±π, or displacement.
    fn raw(&self, states: &[BodyState]) -> f64 {
        let (a, b) = (parent(&self.joint, states), &states[self.joint.b]);
        let axis = a.rotation * self.joint.axes().expect("checked in `new`").0;
        if self.joint.kind == JointKind::Slider {
            return (b.point(self.joint.anchor_b) - a.point(self.joint.anchor_a)).dot(axis);
        }
        let (t, u) = (a.rotation * self.across.0, b.rotation * self.across.1);
        atan2(axis.dot(t.cross(u)), t.dot(u))
    }

    /// Updates the coordinate and returns it, from the start. Between two calls a hinge must rotate by less than π.
    pub fn unwrap_angle(&mut self, states: &[BodyState]) -> f64 {
        let moved = self.raw(states) - self.start - self.value;
        let turns = if self.joint.kind == JointKind::Hinge { (moved / (2.0 * PI)).round() } else { 0.0 };
        self.value += moved - 2.0 * PI * turns;
        self.value
    }
}

/// Hash of the bits of all states.
pub fn hash(states: &[BodyState]) -> u64 {
    let mut hash = StateHash::default();
    for state in states {
        hash.add_vector(state.position);
        state.rotation.to_array().into_iter().for_each(|q| hash.add(q));
        hash.add_vector(state.velocity);
        hash.add_vector(state.angular_velocity);
    }
    hash.0
}

/// Observes a run step by step.
#[derive(Clone, Debug)]
pub struct Observer<'a> {
    scene: &'a PhysicsScene,
    start: f64,
    couplings: Vec<(&'a SceneCoupling, Vec<Coordinate>)>,
    pendulum: Option<Pendulum>,
    contacts: Option<ContactObserver>,
    coupling_error: f64,
    report: Report,
    time: f64,
}

/// Result of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Largest gap of any joint, m.
    pub max_joint_err_m: f64,
    /// Largest |E − E₀| over the scene's energy.
    pub max_energy_drift_rel: f64,
    /// The last E − E₀ over the scene's energy.
    pub final_energy_drift_rel: f64,
    /// Time at which the energy error passed 10 or the engine failed, s.
    pub diverged_at_s: Option<f64>,
    /// Falling weight, where the scene gives its acceleration.
    pub weight: Option<WeightReport>,
    /// Pendulum, where the scene gives its period.
    pub pendulum: Option<PendulumReport>,
    /// Contacts, where the scene collides.
    pub contacts: Option<ContactReport>,
}

/// Errors of a weight that falls on gears.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WeightReport {
    /// Relative error of its speed at the end against a t.
    pub speed_rel_err: f64,
    /// Relative error of its displacement at the end against a t²/2.
    pub drop_rel_err: f64,
    /// Largest |Σ coefficient · (q − q₀)| of any coupling, m.
    pub max_coupling_err_m: f64,
}

/// Errors of a pendulum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PendulumReport {
    /// Relative error of the period by linear interpolation, 10⁻⁶.
    pub period_err_ppm: f64,
    /// Relative error of the period by cubic interpolation, 10⁻⁶.
    pub period_err_hermite_ppm: f64,
    /// Largest sampled angle of the last four seconds over the initial one.
    pub amplitude_ratio: f64,
}

impl<'a> Observer<'a> {
    /// An observer of `scene` at its start.
    pub fn new(scene: &'a PhysicsScene) -> Self {
        let states: Vec<_> = scene.bodies.iter().map(super::SceneBody::state).collect();
        let coordinates = |coupling: &'a SceneCoupling| {
            (coupling, coupling.terms.iter().filter_map(|&(joint, _)| Coordinate::new(scene, joint)).collect())
        };
        let start = energy(scene, &states);
        Self {
            start,
            contacts: ContactObserver::new(scene, start),
            couplings: scene.couplings.iter().map(coordinates).collect(),
            pendulum: scene.meta.period.and_then(|_| Pendulum::new(scene)),
            coupling_error: 0.0,
            report: Report { max_joint_err_m: joint_error(scene, &states), ..Report::default() },
            time: 0.0,
            scene,
        }
    }

    /// Sets the end of the run, s.
    pub fn set_end_time(&mut self, seconds: f64) {
        if let Some(contacts) = &mut self.contacts {
            contacts.set_end_time(seconds);
        }
    }

    /// Takes the states at `t` seconds; returns false once the run has diverged.
    pub fn observe(&mut self, t: f64, states: &[BodyState]) -> bool {
        self.time = t;
        let energy = energy(self.scene, states);
        let drift = (energy - self.start) / self.scene.energy_scale;
        let report = &mut self.report;
        report.final_energy_drift_rel = drift;
        report.max_energy_drift_rel = larger(report.max_energy_drift_rel, drift.abs());
        report.max_joint_err_m = larger(report.max_joint_err_m, joint_error(self.scene, states));
        for (coupling, coordinates) in &mut self.couplings {
            let terms = coupling.terms.iter().zip(coordinates);
            let error: f64 = terms.map(|(&(_, coefficient), q)| coefficient * q.unwrap_angle(states)).sum();
            self.coupling_error = larger(self.coupling_error, error.abs());
        }
        if let Some(pendulum) = &mut self.pendulum {
            pendulum.follow(t, &states[pendulum.body]);
        }
        if let Some(contacts) = &mut self.contacts {
            contacts.observe(t, states, energy, self.scene.energy_scale);
        }
        if drift.is_nan() || drift.abs() > DIVERGED {
            self.set_diverged(t);
        }
        self.report.diverged_at_s.is_none()
    }

    /// Records that the engine failed at `t` seconds.
    pub fn set_diverged(&mut self, t: f64) {
        self.report.diverged_at_s.get_or_insert(t);
    }

    /// Report of the whole run; `states` are those at its end.
    pub fn report(&self, states: &[BodyState]) -> Report {
        let meta = &self.scene.meta;
        let weight = meta.accel.zip(meta.weight_body).map(|(a, body)| {
            let (state, t) = (&states[body], self.time);
            let start = meta.weight_y0.unwrap_or(self.scene.bodies[body].pos[1]);
            WeightReport {
                speed_rel_err: (-state.velocity.y / (a * t) - 1.0).abs(),
                drop_rel_err: ((start - state.position.y) / (0.5 * a * t * t) - 1.0).abs(),
                max_coupling_err_m: self.coupling_error,
            }
        });
        let pendulum = meta.period.zip(self.pendulum.as_ref()).and_then(|(period, pendulum)| {
            let [line, cubic] = pendulum.periods()?.map(|found| 1e6 * (found / period - 1.0));
            let start = self.scene.meta.theta0.unwrap_or(f64::NAN);
            let amplitude_ratio = pendulum.amplitude() / start;
            Some(PendulumReport { period_err_ppm: line, period_err_hermite_ppm: cubic, amplitude_ratio })
        });
        let contacts = self.contacts.as_ref().map(ContactObserver::report);
        Report { weight, pendulum, contacts, ..self.report.clone() }
    }
}
