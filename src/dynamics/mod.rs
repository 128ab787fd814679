//! Motion by the laws: Lagrange multipliers, integration, friction of pivots, impacts.
//!
//! One step is: integrate the constrained equations of motion by the classical fourth-order Runge–Kutta method,
//! close what the joints drifted apart (projection), stop at each impact on the way, and let pivot friction act.
//!
//! Symbols as in `articulation`: C constraint value, J its Jacobian, λ multipliers. Accelerations solve
//!
//! ```text
//! M a − Jᵀ λ = F        J a = −J̇ẋ − ω₀² C − 2 ω₀ Ċ
//! ```
//!
//! The last two terms (Baumgarte 1972, critically damped) draw a scattered figure together and vanish once it is;
//! from then on projection keeps the joints closed to rounding.

mod contacts;
mod drive;
pub mod forces;
pub mod impulse;
mod integrate;
mod limits;

use crate::articulation::block::Vec6;
use crate::articulation::{Constraint, Limit, Spring, System};
use crate::bodies::RigidBody;
use crate::collision::Collider;
use crate::math::{DMat3, DVec3};

pub use contacts::{Contacts, Impact, ImpactKind, Strike, Struck, SurfacePair, strike};
pub use drive::{Drive, Instant, Motion};
use forces::Damping;
use integrate::Rate;

/// Largest phase φ of the stiffest tension mode in one substep, rad. The fourth-order method loses the share φ⁶/72 of
/// such a mode's energy a substep, 10⁻⁶ here; slower motion, which holds nearly all of it, loses next to nothing.
const MODE_PHASE: f64 = 0.2;
/// Most substeps of one step: beyond it a mode is followed less finely, not at all less stably.
const MOST_SUBSTEPS: u32 = 32;
/// Faster than this is not a sculpture but a fault, m/s and rad/s.
const SPEED_LIMIT: f64 = 100.0;
const SPIN_LIMIT: f64 = 5_000.0;

/// How time is advanced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// Precise where that costs next to nothing (few bodies, no contact), else Runge–Kutta.
    #[default]
    Auto,
    /// Semi-implicit Euler with projection: one solve a step, first order.
    Fast,
    /// The classical fourth-order Runge–Kutta method with projection.
    RungeKutta,
    /// The Gauss–Legendre method of sixth order: energy stays bounded over days.
    Precise,
}

/// Which linear solver finds the multipliers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Solver {
    /// The tree factor, linear in the number of bodies.
    #[default]
    Sparse,
    /// One dense matrix of all rows: the reference.
    Dense,
}

/// What is constant over a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// World acceleration, m/s².
    pub gravity: DVec3,
    /// Pivot friction, damping and losses at impacts; off for tests of conservation.
    pub friction: bool,
    /// 1/ω₀ of the stabiliser, s.
    pub stabilization_time: f64,
    /// How time is advanced.
    pub integrator: Integrator,
    /// Which linear solver finds the multipliers.
    pub solver: Solver,
}

/// Everything a figure needs to move.
pub struct Figure<'a> {
    /// Bodies in their start state.
    pub bodies: Vec<RigidBody>,
    /// Damping per body.
    pub damping: Vec<Damping>,
    /// Joints.
    pub constraints: &'a [Constraint],
    /// What stays within bounds.
    pub limits: &'a [Limit],
    /// Springs.
    pub springs: &'a [Spring],
    /// Bodies that follow a given motion.
    pub drives: &'a [Drive],
    /// Collision shapes, materials resolved per pair.
    pub colliders: &'a [Collider],
    /// Pairs that can meet and what their surfaces do.
    pub pairs: Vec<SurfacePair>,
}

/// A figure in motion. Nothing here allocates after [`Dynamics::new`].
pub struct Dynamics {
    /// The bodies' present state.
    pub bodies: Vec<RigidBody>,
    settings: Settings,
    damping: Vec<Damping>,
    springs: Vec<Spring>,
    system: System,
    contacts: Contacts,
    /// Wrenches from outside, and with those of resting contacts.
    given: Vec<Vec6>,
    external: Vec<Vec6>,
    /// Force that each joint carried at the last solve, N.
    loads: Vec<f64>,
    stages: [Vec<Rate>; 4],
    start: Vec<RigidBody>,
    before_step: Vec<RigidBody>,
    substeps: u32,
}

impl Dynamics {
    /// A figure at its start.
    pub fn new(figure: Figure, settings: Settings) -> Self {
        let n = figure.bodies.len();
        let system = System::new(n, figure.constraints);
        let rates = vec![Rate::default(); n];
        Self {
            loads: vec![0.0; system.joints().len()],
            contacts: Contacts::new(figure.colliders, figure.pairs, figure.limits, &figure.bodies),
            start: figure.bodies.clone(),
            before_step: figure.bodies.clone(),
            bodies: figure.bodies,
            settings,
            damping: if settings.friction { figure.damping } else { vec![Damping::default(); n] },
            springs: figure.springs.to_vec(),
            system,
            given: vec![[0.0; 6]; n],
            external: vec![[0.0; 6]; n],
            stages: [rates.clone(), rates.clone(), rates.clone(), rates],
            substeps: 1,
        }
    }

    /// Advances by `dt` seconds under constant external wrenches (N and N m about each centre of mass). Impacts on
    /// the way are appended to `impacts`. Returns the bodies that had to be restored from bad numbers.
    pub fn step(&mut self, dt: f64, external: &[Vec6], impacts: &mut Vec<Impact>) -> usize {
        self.before_step.copy_from_slice(&self.bodies);
        self.given.copy_from_slice(external);
        self.contacts.begin_step(dt);
        self.substeps = 0;
        let mut done = 0.0;
        while done < dt * (1.0 - 1e-12) {
            // Asked anew each time: a hit changes what there is to follow.
            let finest = dt / f64::from(2 * MOST_SUBSTEPS);
            let slides = self.contacts.longest_substep().max(finest);
            let h = (dt / f64::from(self.substep_count(dt))).min(slides).min(dt - done);
            done += self.substep(h, done, impacts);
            self.substeps += 1;
        }
        if self.settings.friction {
            self.rub(dt);
        }
        self.restore_bad_bodies()
    }

    /// Integrates `h` or up to the first impact, resolves it, and returns the time used.
    fn substep(&mut self, h: f64, now: f64, impacts: &mut Vec<Impact>) -> f64 {
        self.start.copy_from_slice(&self.bodies);
        self.hold(h);
        let mut used = h;
        if let Some(hit) = self.contacts.first_impact(&self.start, &self.bodies) {
            used = hit.s * h;
            self.bodies.copy_from_slice(&self.start);
            self.hold(used);
            self.prepare_impulses();
            self.contacts.resolve_hit(&hit, (now + used, h), &mut self.system, &mut self.bodies, impacts);
        }
        self.contacts.end_substep(&self.bodies);
        used
    }

    /// Integrates `h` under the forces that hold what rests, again where they prove wrong.
    fn hold(&mut self, h: f64) {
        if h <= 0.0 {
            return;
        }
        for pass in 1.. {
            self.external.copy_from_slice(&self.given);
            self.contacts.press(&mut self.external);
            self.integrate(h);
            if !self.contacts.anything_rests() {
                return;
            }
            self.prepare_impulses();
            if self.contacts.settle((h, pass), &self.start, &mut self.system, &mut self.bodies) {
                break;
            }
            self.bodies.copy_from_slice(&self.start);
        }
        // Contacts move bodies by first-order steps through the joints; what is left of second order goes here.
        self.project();
    }

    /// Factors the joints at the present poses, for impulses.
    fn prepare_impulses(&mut self) {
        self.system.evaluate(&self.bodies);
        self.system.factor();
    }

    /// Substeps that follow the fastest motion: of the tension modes (a body that hangs by the arm r under the load λ
    /// swings about it with ω² = |λ| |r| / I⊥), or of the free spin.
    fn substep_count(&self, dt: f64) -> u32 {
        let spins = self.bodies.iter().map(|body| body.angular_velocity.length_squared());
        let mut stiffest = spins.fold(0.0, f64::max);
        for (joint, &load) in self.loads.iter().enumerate() {
            let link = self.system.joints()[joint].link;
            let (arm_a, arm_b) = self.system.arms(joint, &self.bodies);
            for (body, arm) in [(Some(link.a), arm_a), (link.b, arm_b)] {
                let Some(body) = body else { continue };
                let inertia = least_inertia_across(&self.bodies[body].inertia_world(), arm);
                stiffest = stiffest.max(load * arm.length() / inertia);
            }
        }
        let wanted = (dt * stiffest.sqrt() / MODE_PHASE).ceil();
        if wanted.is_finite() { (wanted as u32).clamp(1, MOST_SUBSTEPS) } else { MOST_SUBSTEPS }
    }

    /// Puts bodies with bad numbers back to where the step began, at rest. Returns how many.
    fn restore_bad_bodies(&mut self) -> usize {
        let sane = |body: &RigidBody| {
            body.is_finite()
                && body.velocity.length_squared() < SPEED_LIMIT * SPEED_LIMIT
                && body.angular_velocity.length_squared() < SPIN_LIMIT * SPIN_LIMIT
        };
        let bad = self.bodies.iter().filter(|body| !sane(body)).count();
        if bad > 0 {
            // One bad body has already pulled at its neighbours: the whole figure goes back.
            for (body, before) in self.bodies.iter_mut().zip(&self.before_step) {
                *body = RigidBody { velocity: DVec3::ZERO, angular_velocity: DVec3::ZERO, ..*before };
            }
            self.loads.fill(0.0);
            self.contacts.forget(&self.bodies);
        }
        bad
    }

    /// Largest distance between the two points of any joint now, m.
    pub fn joint_error(&self) -> f64 {
        self.system.largest_gap(&self.bodies)
    }

    /// Kinetic and potential energy, J.
    pub fn energy(&self) -> f64 {
        forces::energy(&self.bodies, self.settings.gravity, &self.springs)
    }

    /// Work of all hits, resting contacts and limits since the start, J: what friction and bounce lost, negative.
    pub fn contact_work(&self) -> f64 {
        self.contacts.work()
    }

    /// Substeps of the last step.
    pub fn substeps(&self) -> u32 {
        self.substeps
    }
}

/// Smallest moment of inertia about an axis across `arm`, kg m².
fn least_inertia_across(inertia: &DMat3, arm: DVec3) -> f64 {
    let Some(n) = arm.try_normalize() else { return f64::INFINITY };
    let (t, b) = crate::math::tangents(n);
    let (tt, bb, tb) = (t.dot(*inertia * t), b.dot(*inertia * b), t.dot(*inertia * b));
    0.5 * (tt + bb) - (0.25 * (tt - bb) * (tt - bb) + tb * tb).sqrt()
}
