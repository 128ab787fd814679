//! Procedural motion: places first, forces never (method 3.1 to 3.6). A figure can be dragged anywhere without a spring
//! that could be too stiff, and a step costs the same whatever happens.
//!
//! Each step has two stages. The **update** moves each body as if it were alone,
//!
//! ```text
//! x_{k+1} = x_k + κ (x_k − x_{k−1}) + a Δt²        κ ∈ [0, 1],   (x_k − x_{k−1})/Δt kept as the velocity
//! ```
//!
//! and turns it likewise; driven bodies go where they are driven. The **adjustment** brings the bodies back to where the
//! joints hold, by one of two methods:
//!
//! * [`Method::Compulsive`], the source's: a rule for two objects (`rule.rs`), one joint (`pair.rs`), grouping and
//!   relaxation along the figure (`walk.rs`, `compulsive.rs`). Visibly plausible, the more so the farther it is dragged;
//!   under gravity alone it swings too little, as small ways turn nothing.
//! * [`Method::TreeSolve`]: all joints at once, least in kinetic energy (`tree.rs`): each displacement of the update
//!   counts with its mass and inertia, as in the laws. Of first order in Δt.
//!
//! Then what met is moved out and thrown back (`touch.rs`), and what rests slides, rolls and spins on it (`sphere.rs`): balls
//! by the source's slip ratio where the method is the source's, else by Coulomb's law. Where the way is from is where the velocity comes from:
//! v = (x_{k+1} − x_k)/Δt, so that the laws can go on from any step, and this from the laws.
//!
//! κ is 1/(1 + c Δt) with the body's damping rate c, times the figure's own [`Settings::retention`]. Breaking by load and
//! the friction of pivots ask for forces and are not there; windows, triggers, breaths and springs act as always.

mod compulsive;
mod pair;
pub mod rule;
mod sphere;
mod touch;
mod tree;
pub mod walk;

use crate::articulation::block::{Vec6, angular, linear};
use crate::bodies::RigidBody;
use crate::dynamics::forces::Damping;
use crate::dynamics::{Dynamics, Impact, Moved};
use crate::math::{DMat3, DQuat, DVec3, atan2};

use compulsive::Compulsive;
pub use compulsive::MOST_ROUNDS;
use touch::Touches;
use tree::TreeSolve;
pub use tree::{MOST_LED, MOST_PASSES};

/// Grips at one time at most.
pub const MOST_GRIPS: usize = 4;
/// Joints and grips nearer than this are where they belong, m or rad.
pub const REACHED: f64 = 1e-7;
/// Passes that bring grips this near have done what tangents could not, m.
const NEAR: f64 = 0.02;
/// Rounds of moving out in one step at most.
const MOST_PUSHES: usize = 6;
/// What a body may keep of the speed of its way, m/s: a hand can throw it across the room in one step.
pub const SPEED_KEPT: f64 = 50.0;
/// The same of its turn, rad/s.
pub const SPIN_KEPT: f64 = 200.0;

/// How joints are closed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The source's compulsive motion, joint by joint.
    Compulsive,
    /// All joints at once.
    #[default]
    TreeSolve,
}

/// What a user chooses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How joints are closed.
    pub method: Method,
    /// c of the compulsive rotation: the greater, the less bodies turn when pulled (no unit, from 0).
    pub control: f64,
    /// Share of the velocity kept from step to step beside the bodies' own damping, 0 … 1.
    pub retention: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { method: Method::default(), control: 1.0, retention: 1.0 }
    }
}

/// A hand on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// Index of the body.
    pub body: usize,
    /// Point that is held, node frame, m.
    pub point: DVec3,
    /// Where it is to be at the step's end, world, m.
    pub place: DVec3,
}

impl Grip {
    /// World place of the point that is held, m.
    pub fn point_of(&self, bodies: &[RigidBody]) -> DVec3 {
        bodies[self.body].pose().point(self.point)
    }

    /// How far it is from its place, m.
    pub fn missed(&self, bodies: &[RigidBody]) -> f64 {
        self.point_of(bodies).distance(self.place)
    }
}

/// How an adjustment ended.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reach {
    /// Passes (rounds of passes by the source's method).
    pub passes: u32,
    /// How far the worst joint is open, m or rad.
    pub residual: f64,
    /// How far the farthest grip is from its place, m.
    pub missed: f64,
}

impl Reach {
    /// Was everything met that was asked?
    pub fn reached(&self) -> bool {
        self.residual <= REACHED && self.missed <= REACHED
    }
}

/// Moves a figure by places. Nothing here allocates once the largest number of grips has been used.
#[derive(Clone, Debug)]
pub struct Procedural {
    settings: Settings,
    damping: Vec<Damping>,
    /// Inverse inertia in body axes, 1/(kg m²).
    inverse: Vec<DMat3>,
    before: Vec<RigidBody>,
    kept: Vec<RigidBody>,
    compulsive: Compulsive,
    tree: TreeSolve,
    touches: Touches,
    reach: Reach,
    /// When the last step ended, s.
    ended: f64,
}

impl Procedural {
    /// A mover for the figure of `dynamics`.
    pub fn new(dynamics: &Dynamics, settings: Settings) -> Self {
        let bodies = &dynamics.bodies;
        Self {
            settings,
            damping: (0..bodies.len()).map(|body| dynamics.damping(body)).collect(),
            inverse: bodies.iter().map(|body| body.properties.inertia.inverse()).collect(),
            before: bodies.clone(),
            kept: bodies.clone(),
            compulsive: Compulsive::new(dynamics),
            tree: TreeSolve::new(dynamics.system(), bodies.len()),
            touches: Touches::new(dynamics),
            reach: Reach::default(),
            ended: f64::NAN,
        }
    }

    /// The settings, to be changed between steps.
    pub fn settings_mut(&mut self) -> &mut Settings {
        &mut self.settings
    }

    /// How the last step's adjustment ended.
    pub fn reach(&self) -> Reach {
        self.reach
    }

    /// Moves the figure for `dt` seconds under wrenches from outside (N and N m about each centre of mass), the first
    /// [`MOST_GRIPS`] grips held. Hits are appended to `impacts`; returns the bodies that had to be restored from bad
    /// numbers.
    pub fn step(
        &mut self,
        dynamics: &mut Dynamics,
        dt: f64,
        external: &[Vec6],
        grips: &[Grip],
        impacts: &mut Vec<Impact>,
    ) -> usize {
        let grips = &grips[..grips.len().min(MOST_GRIPS)];
        let follows = dynamics.time() == self.ended;
        let restored = dynamics.step_by(dt, external, impacts, |moved| self.carry_out(moved, dt, grips, follows));
        self.ended = dynamics.time();
        restored
    }

    fn carry_out(&mut self, mut moved: Moved, dt: f64, grips: &[Grip], follows: bool) {
        self.before.copy_from_slice(moved.bodies);
        self.leave_open(&mut moved, dt, follows);
        moved.system.activity.set_time(moved.until);
        self.update(&mut moved, dt);
        self.reach = self.adjust(&mut moved, grips);
        self.keep_speed(&mut moved, dt);
        if self.touches.is_empty() {
            return;
        }
        let mut first = true;
        for _ in 0..MOST_PUSHES {
            if !self.touches.look(moved.contacts, &self.before, moved.bodies, first) {
                break;
            }
            match self.settings.method {
                Method::Compulsive => {
                    self.touches.back_up(&mut self.compulsive, moved.system, moved.contacts, moved.bodies, first);
                }
                Method::TreeSolve => self.touches.move_out(moved.system, moved.bodies, first),
            }
            first = false;
            self.reach = self.adjust(&mut moved, grips);
        }
        let motion = (dt, moved.gravity.length());
        let by_ratio = self.settings.method == Method::Compulsive;
        let shifted = self.touches.bounce(moved.system, moved.bodies, &self.before, (motion, by_ratio), moved.impacts);
        if shifted && !moved.system.joints().is_empty() {
            self.reach = self.adjust(&mut moved, grips);
        }
    }

    /// Says what the joints may keep open: what is open at a step's start is drawn together over time, not in one step.
    fn leave_open(&mut self, moved: &mut Moved, dt: f64, follows: bool) {
        let closed = follows && !moved.changed && self.reach.residual <= REACHED;
        if closed {
            self.tree.left.fill(0.0);
            return;
        }
        moved.system.evaluate(moved.bodies);
        moved.system.leave_open(dt, moved.stabilization_time, &mut self.tree.left);
    }

    /// The update: each body alone.
    fn update(&self, moved: &mut Moved, dt: f64) {
        let Settings { method, retention, .. } = self.settings;
        let driven = moved.system.driven();
        for (index, body) in moved.bodies.iter_mut().enumerate() {
            if driven[index] {
                continue;
            }
            let (damping, wrench) = (&self.damping[index], &moved.wrenches[index]);
            if method == Method::TreeSolve {
                body.angular_velocity = gyrated(body, dt);
            }
            body.velocity *= retention / (1.0 + damping.linear * dt);
            body.angular_velocity *= retention / (1.0 + damping.angular * dt);
            body.velocity += dt * (moved.gravity + linear(wrench) / body.properties.mass);
            let torque = angular(wrench);
            if torque != DVec3::ZERO {
                let own = body.rotation.conjugate() * torque;
                body.angular_velocity += dt * (body.rotation * (self.inverse[index] * own));
            }
            body.displace(dt * body.velocity, dt * body.angular_velocity);
        }
        for drive in moved.drives {
            drive.motion.at(moved.until).carry(&mut moved.bodies[drive.body]);
        }
    }

    fn adjust(&mut self, moved: &mut Moved, grips: &[Grip]) -> Reach {
        if self.settings.method == Method::Compulsive {
            return self.compulsive.adjust(moved, grips, &self.tree.left, Some(self.settings.control));
        }
        let reach = self.tree.adjust(moved, grips);
        if reach.reached() {
            return reach;
        }
        // It leapt too far for tangents, or is asked too much: passes close a tree from anywhere.
        let passed = self.compulsive.adjust(moved, grips, &self.tree.left, None);
        let mut last = passed;
        if !passed.reached() && passed.missed <= NEAR {
            self.kept.copy_from_slice(moved.bodies);
            last = self.tree.adjust(moved, grips);
            if !last.reached() {
                moved.bodies.copy_from_slice(&self.kept);
                last = passed;
            }
        }
        last.passes += reach.passes;
        last
    }

    /// The velocities that the step's way stands for.
    fn keep_speed(&self, moved: &mut Moved, dt: f64) {
        for ((body, before), driven) in moved.bodies.iter_mut().zip(&self.before).zip(moved.system.driven()) {
            if *driven {
                continue;
            }
            let (way, turn) = ((body.position - before.position) / dt, turned(before.rotation, body.rotation) / dt);
            body.velocity = way.clamp_length_max(SPEED_KEPT);
            body.angular_velocity = turn.clamp_length_max(SPIN_KEPT);
        }
    }
}

/// ω of a body that turns freely for `dt`: one Newton step of the implicit I (ω' − ω) + Δt ω'×I ω' = 0 in body axes, which
/// never gains energy (E. Catto, Numerical methods, Game Developers Conference 2015).
fn gyrated(body: &RigidBody, dt: f64) -> DVec3 {
    let inertia = &body.properties.inertia;
    let w = body.rotation.conjugate() * body.angular_velocity;
    let momentum = *inertia * w;
    let torque = w.cross(momentum);
    if torque == DVec3::ZERO {
        return body.angular_velocity;
    }
    let slope = *inertia + (crate::math::skew(w) * *inertia - crate::math::skew(momentum)) * dt;
    body.rotation * (w - slope.inverse() * (dt * torque))
}

/// Rotation vector of the shorter way between two rotations, rad: 2 asin|v| v/|v| by its series where that is short.
fn turned(from: DQuat, to: DQuat) -> DVec3 {
    let turn = crate::math::product(to, from.conjugate());
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let v = DVec3::new(turn.x, turn.y, turn.z);
    let x = v.length_squared();
    // Below a fifth of a radian the terms left out are under 10⁻¹⁴ of it.
    if x < 0.01 {
        return v
            * (2.0 + x * (1.0 / 3.0 + x * (3.0 / 20.0 + x * (5.0 / 56.0 + x * (35.0 / 576.0 + x * (63.0 / 1408.0))))));
    }
    let s = x.sqrt();
    v * (2.0 * atan2(s, turn.w) / s)
}
