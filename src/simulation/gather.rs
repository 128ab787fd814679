//! How an exhibit gathers itself from scattered parts: self-assembly as a change of scene.
//!
//! All bodies are put somewhere about their places, and what is between them is left to the joints: each row that acts
//! from the start draws itself together as `articulation` says of what is open, −ω²C − 2ωĊ with ω = Ω below. Joints
//! say where parts belong to each other, not where the figure stands and how a hook is turned; so each body is called
//! home besides, in proportion to what it weighs. With M the masses and inertias, Δ the way (and turn) from home and v the
//! velocities,
//!
//! ```text
//! F = −M (Ω² Δ + 2 Ω v)        Δ(t) = Δ(0) (1 + Ω t) e^(−Ω t)        Ω = 2.5 1/s
//! ```
//!
//! which is critically damped in every coordinate that the joints leave free, as both sides of M q̈ = F are projected alike.
//! Position-based, each body goes home by itself, on that same Δ(t), and the joints close as it comes home: with b = v + Ω Δ
//! a step of T seconds is
//!
//! ```text
//! Δ' = (Δ + b T) e^(−Ω T)        v' = (v − Ω b T) e^(−Ω T)
//! ```
//!
//! which costs next to nothing, and either kind of step may follow the other.
//!
//! Nothing else acts meanwhile: no weight or wind, no springs, stops, gears or touches, and drives stand where they start.
//! After [`LASTS`] what is left of Δ is below a micrometre, and the exhibit begins.

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
const HOME: f64 = 2.5;
/// 1/ω of the joints, s: at the pace of the call, so that for small ways neither strains the other.
const DRAWN: f64 = 1.0 / HOME;
/// s.
pub const LASTS: f64 = 7.2;
/// How much farther from the middle of all a body begins, as a share, and how far beside that, as a share of the size.
const OUT: f64 = 0.5;
const BESIDE: f64 = 0.25;
/// Greatest turn of a body, rad: orientations are told up to a right angle.
const TURNED: f64 = 0.8;

/// A figure on its way home.
#[derive(Clone)]
pub struct Gathering {
    homes: Vec<(DVec3, DQuat)>,
    driven: Vec<bool>,
}

impl Gathering {
    /// The exhibit scattered, and what calls it together.
    pub fn new(exhibit: &Exhibit, settings: &Settings, seed: u64) -> (Self, Dynamics) {
        let mut bodies = start_bodies(exhibit, settings);
        let mut driven = vec![false; bodies.len()];
        exhibit.drives.iter().for_each(|drive| driven[drive.body] = true);
        let homes: Vec<(DVec3, DQuat)> = bodies.iter().map(|body| (body.position, body.rotation)).collect();
        scatter(&mut bodies, &driven, seed);
        let acts = |constraint: &&Constraint| {
            let gear = matches!(constraint.kind, ConstraintKind::Coupling { .. });
            !gear && constraint.schedule.share(0.0, None) > 0.0
        };
        let held = |constraint: &Constraint| Constraint {
            schedule: Schedule::default(),
            breaking: None,
            friction: None,
            slips: None,
            stabilization_time: None,
            ..constraint.clone()
        };
        let constraints: Vec<Constraint> = exhibit.constraints.iter().filter(acts).map(held).collect();
        let still = |drive: &KinematicBody| {
            let keys = drive.motion.keys.first().map(|&(_, pose): &(f64, Pose)| vec![(0.0, pose)]).unwrap_or_default();
            KinematicBody {
                body: drive.body,
                motion: KeyframeMotion { keys, interpolation: Interpolation::Step, repeat: false },
            }
        };
        let drives: Vec<KinematicBody> = exhibit.drives.iter().map(still).collect();
        let figure = Articulation {
            damping: vec![Damping::default(); bodies.len()],
            bodies,
            constraints: &constraints,
            limits: &[],
            springs: &[],
            kinematic_bodies: &drives,
            colliders: &[],
            pairs: Vec::new(),
        };
        let laws = dynamics::Settings {
            gravity: DVec3::ZERO,
            friction: false,
            stabilization_time: DRAWN,
            integrator: exhibit.integrator,
            solver: exhibit.solver,
        };
        (Self { homes, driven }, Dynamics::new(figure, laws))
    }

    /// Adds what calls each body home (N and N m about its centre of mass).
    pub fn call(&self, bodies: &[RigidBody], out: &mut [Vec6]) {
        for (k, (body, (place, attitude))) in bodies.iter().zip(&self.homes).enumerate() {
            if self.driven[k] {
                continue;
            }
            let way = body.position - *place;
            let force = -body.properties.mass * (HOME * HOME * way + 2.0 * HOME * body.velocity);
            let turn = HOME * HOME * turned_from(attitude, body) + 2.0 * HOME * body.angular_velocity;
            let torque = -(body.inertia_world() * turn);
            add_wrench(&mut out[k], DVec3::ZERO, force);
            for (sum, part) in out[k][3..].iter_mut().zip(torque.to_array()) {
                *sum += part;
            }
        }
    }

    /// Moves each body on its own way home for `dt` seconds.
    pub fn carry(&self, dt: f64, bodies: &mut [RigidBody]) {
        let left = exp(-HOME * dt);
        let step = |away: DVec3, velocity: DVec3| {
            let b = velocity + HOME * away;
            ((away + b * dt) * left, (velocity - HOME * dt * b) * left)
        };
        for ((body, (place, attitude)), driven) in bodies.iter_mut().zip(&self.homes).zip(&self.driven) {
            if *driven {
                continue;
            }
            let (way, velocity) = step(body.position - *place, body.velocity);
            let (turn, spin) = step(turned_from(attitude, body), body.angular_velocity);
            (body.position, body.velocity) = (*place + way, velocity);
            (body.rotation, body.angular_velocity) = (rotation(turn) * *attitude, spin);
        }
    }

    /// How far the farthest body is from home, m.
    pub fn way(&self, bodies: &[RigidBody]) -> f64 {
        bodies.iter().zip(&self.homes).map(|(body, (place, _))| body.position.distance(*place)).fold(0.0, f64::max)
    }
}

/// The turn of a body from its attitude at home, rad.
fn turned_from(attitude: &DQuat, body: &RigidBody) -> DVec3 {
    let from = body.rotation * attitude.conjugate();
    rotation_vector(if from.w < 0.0 { -from } else { from })
}

/// Puts bodies that move freely farther out from their middle, a little aside, and turned.
fn scatter(bodies: &mut [RigidBody], driven: &[bool], seed: u64) {
    let mut random = Random::new(seed);
    let mass: f64 = bodies.iter().map(|body| body.properties.mass).sum();
    let middle = bodies.iter().map(|body| body.properties.mass * body.position).sum::<DVec3>() / mass.max(1e-12);
    let size = bodies.iter().map(|body| body.position.distance(middle)).fold(0.15, f64::max);
    for (body, _) in bodies.iter_mut().zip(driven).filter(|(_, driven)| !**driven) {
        let mut aside = || DVec3::new(random.signed(), random.signed(), random.signed());
        let (way, about) = (aside(), aside());
        body.position += OUT * (body.position - middle) + BESIDE * size * way;
        body.rotation = rotation(TURNED * about.clamp_length_max(1.0)) * body.rotation;
        (body.velocity, body.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
    }
}
