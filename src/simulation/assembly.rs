//! Assembly animation: an exhibit assembles itself from scattered parts when it is shown.
//!
//! All bodies start at random poses about their own. Each constraint that acts from the start is closed by Baumgarte
//! stabilisation, −ω²C − 2ωĊ with ω = Ω below. Constraints define relative poses only, so each body is also pulled to its own
//! pose by a force in proportion to its mass. With M the masses and inertias, Δ the displacement (and rotation) from that
//! pose and v the velocities,
//!
//! ```text
//! F = −M (Ω² Δ + 2 Ω v)        Δ(t) = Δ(0) (1 + Ω t) e^(−Ω t)        Ω = 2.5 1/s
//! ```
//!
//! which is critically damped in every coordinate that the joints leave free, as both sides of M q̈ = F are projected alike.
//! In position-based motion each body follows the same Δ(t) by itself. With b = v + Ω Δ a step of T seconds is
//!
//! ```text
//! Δ' = (Δ + b T) e^(−Ω T)        v' = (v − Ω b T) e^(−Ω T)
//! ```
//!
//! Both kinds of steps may alternate.
//!
//! Nothing else acts meanwhile: no gravity, wind, springs, stops, gears or contacts; kinematic bodies stay at their start.
//! After [`DURATION`] Δ is below a micrometre, and the exhibit starts.

use super::input::Settings;
use super::start::start_bodies;
use soffio_exhibit::Exhibit;
use soffio_geometry::bodies::RigidBody;
use soffio_math::Interpolation;
use soffio_math::noise::Random;
use soffio_math::spatial::{Vec6, add_wrench};
use soffio_math::{DQuat, DVec3, Pose, exp, rotation, rotation_vector};
use soffio_multibody::articulation::{Constraint, ConstraintKind, Schedule};
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{self, Articulation, Dynamics, KeyframeMotion, KinematicBody};

/// Ω, 1/s.
const RATE: f64 = 2.5;
/// 1/ω of the constraints, s: the same rate, so that constraints and pull do not work against each other near the end.
const STABILIZATION_TIME: f64 = 1.0 / RATE;
/// Duration of the animation, s.
pub const DURATION: f64 = 7.2;

/// How far bodies are scattered.
struct Scatter {
    /// Outward displacement, as a share of the distance from the common centre of mass.
    outward: f64,
    /// Greatest random displacement, as a share of the exhibit's size.
    random: f64,
    /// Greatest rotation, rad: orientation errors are defined up to a right angle.
    rotation: f64,
    /// Least size of an exhibit, m.
    least_size: f64,
}

const SCATTER: Scatter = Scatter { outward: 0.5, random: 0.25, rotation: 0.8, least_size: 0.15 };

/// An exhibit that is assembling itself.
#[derive(Clone)]
pub struct Assembly {
    /// Final poses of the centres of mass.
    final_poses: Vec<FinalPose>,
    is_kinematic: Vec<bool>,
}

/// Where a body belongs.
#[derive(Clone, Copy)]
struct FinalPose {
    /// Of the centre of mass, world, m.
    position: DVec3,
    rotation: DQuat,
}

impl FinalPose {
    /// Rotation vector of a body from its final orientation, rad.
    fn rotation_to(&self, body: &RigidBody) -> DVec3 {
        let from = body.rotation * self.rotation.conjugate();
        rotation_vector(if from.w < 0.0 { -from } else { from })
    }
}

impl Assembly {
    /// The assembly of an exhibit, and the dynamics of its scattered bodies.
    pub fn new(exhibit: &Exhibit, settings: &Settings, seed: u64) -> (Self, Dynamics) {
        let mut bodies = start_bodies(exhibit, settings);
        let mut is_kinematic = vec![false; bodies.len()];
        exhibit.drives.iter().for_each(|drive| is_kinematic[drive.body] = true);
        let final_poses = bodies.iter().map(|body| FinalPose { position: body.position, rotation: body.rotation });
        let final_poses: Vec<FinalPose> = final_poses.collect();
        scatter(&mut bodies, &is_kinematic, seed);
        let acts = |constraint: &&Constraint| {
            let gear = matches!(constraint.kind, ConstraintKind::Coupling { .. });
            !gear && constraint.schedule.activation(0.0, None) > 0.0
        };
        let permanent = |constraint: &Constraint| Constraint {
            schedule: Schedule::default(),
            breaking: None,
            friction: None,
            slips: None,
            stabilization_time: None,
            ..constraint.clone()
        };
        let constraints: Vec<Constraint> = exhibit.constraints.iter().filter(acts).map(permanent).collect();
        let at_start = |drive: &KinematicBody| {
            let keys = drive.motion.keys.first().map(|&(_, pose): &(f64, Pose)| vec![(0.0, pose)]).unwrap_or_default();
            KinematicBody {
                body: drive.body,
                motion: KeyframeMotion { keys, interpolation: Interpolation::Step, repeat: false },
            }
        };
        let drives: Vec<KinematicBody> = exhibit.drives.iter().map(at_start).collect();
        let articulation = Articulation {
            damping: vec![Damping::default(); bodies.len()],
            bodies,
            constraints: &constraints,
            limits: &[],
            springs: &[],
            kinematic_bodies: &drives,
            colliders: &[],
            pairs: Vec::new(),
        };
        let settings = dynamics::Settings {
            gravity: DVec3::ZERO,
            friction: false,
            stabilization_time: STABILIZATION_TIME,
            integrator: exhibit.integrator,
            solver: exhibit.solver,
        };
        (Self { final_poses, is_kinematic }, Dynamics::new(articulation, settings))
    }

    /// Adds the pull on each body to its wrench (N and N m about its centre of mass).
    pub fn apply_forces(&self, bodies: &[RigidBody], out: &mut [Vec6]) {
        for (k, (body, pose)) in bodies.iter().zip(&self.final_poses).enumerate() {
            if self.is_kinematic[k] {
                continue;
            }
            let displacement = body.position - pose.position;
            let force = -body.properties.mass * (RATE * RATE * displacement + 2.0 * RATE * body.velocity);
            let angular = RATE * RATE * pose.rotation_to(body) + 2.0 * RATE * body.angular_velocity;
            let torque = -(body.inertia_world() * angular);
            add_wrench(&mut out[k], DVec3::ZERO, force);
            for (sum, part) in out[k][3..].iter_mut().zip(torque.to_array()) {
                *sum += part;
            }
        }
    }

    /// Moves each body along its own Δ(t) for `dt` seconds.
    pub fn advance_positions(&self, dt: f64, bodies: &mut [RigidBody]) {
        let decay = exp(-RATE * dt);
        let step = |displacement: DVec3, velocity: DVec3| {
            let b = velocity + RATE * displacement;
            ((displacement + b * dt) * decay, (velocity - RATE * dt * b) * decay)
        };
        for ((body, pose), is_kinematic) in bodies.iter_mut().zip(&self.final_poses).zip(&self.is_kinematic) {
            if *is_kinematic {
                continue;
            }
            let (displacement, velocity) = step(body.position - pose.position, body.velocity);
            let (turn, spin) = step(pose.rotation_to(body), body.angular_velocity);
            (body.position, body.velocity) = (pose.position + displacement, velocity);
            (body.rotation, body.angular_velocity) = (rotation(turn) * pose.rotation, spin);
        }
    }

    /// Greatest distance of a body from its final position, m.
    pub fn max_distance(&self, bodies: &[RigidBody]) -> f64 {
        bodies
            .iter()
            .zip(&self.final_poses)
            .map(|(body, pose)| body.position.distance(pose.position))
            .fold(0.0, f64::max)
    }
}

/// Displaces and rotates the bodies that are not kinematic.
fn scatter(bodies: &mut [RigidBody], is_kinematic: &[bool], seed: u64) {
    let mut random = Random::new(seed);
    let mass: f64 = bodies.iter().map(|body| body.properties.mass).sum();
    let center = bodies.iter().map(|body| body.properties.mass * body.position).sum::<DVec3>() / mass.max(1e-12);
    let size = bodies.iter().map(|body| body.position.distance(center)).fold(SCATTER.least_size, f64::max);
    for (body, _) in bodies.iter_mut().zip(is_kinematic).filter(|(_, is_kinematic)| !**is_kinematic) {
        let mut random_vector = || DVec3::new(random.signed(), random.signed(), random.signed());
        let (displacement, axis) = (random_vector(), random_vector());
        body.position += SCATTER.outward * (body.position - center) + SCATTER.random * size * displacement;
        body.rotation = rotation(SCATTER.rotation * axis.clamp_length_max(1.0)) * body.rotation;
        (body.velocity, body.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
    }
}
