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
mod fours;
mod grip;
mod pair;
pub mod rule;
mod settings;
mod sphere;
mod touch;
mod tree;
pub mod walk;

use crate::dynamics::{Dynamics, Impact, PositionStep};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::Vec6;

use compulsive::Compulsive;
pub use compulsive::MOST_ROUNDS;
use fours::Fours;
pub use fours::{SPEED_KEPT, SPIN_KEPT};
pub use grip::{Grip, MOST_GRIPS, REACHED, Reach};
pub use settings::{CONTROL, Method, Settings};
use touch::Touches;
use tree::TreeSolve;
pub use tree::{MOST_LED, MOST_PASSES};

/// Passes that bring grips this near have done what tangents could not, m.
const NEAR: f64 = 0.02;
/// Rounds of moving out in one step at most.
const MOST_PUSHES: usize = 6;
/// Moves a figure by places. Nothing here allocates once the largest number of grips has been used.
#[derive(Clone, Debug)]
pub struct Procedural {
    settings: Settings,
    fours: Fours,
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
            fours: Fours::new(dynamics),
            before: bodies.clone(),
            kept: bodies.clone(),
            compulsive: Compulsive::new(dynamics),
            tree: TreeSolve::new(dynamics.system_without_trains(), bodies.len()),
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
    /// [`MOST_GRIPS`] grips held. Hits are appended to `impacts`; returns the first body with bad numbers, because of
    /// which the figure was put back.
    pub fn step(
        &mut self,
        dynamics: &mut Dynamics,
        dt: f64,
        external: &[Vec6],
        grips: &[Grip],
        impacts: &mut Vec<Impact>,
    ) -> Option<usize> {
        let grips = &grips[..grips.len().min(MOST_GRIPS)];
        let follows = dynamics.time() == self.ended;
        let restored = dynamics.position_step(dt, external, impacts, |moved| self.carry_out(moved, dt, grips, follows));
        self.ended = dynamics.time();
        restored
    }

    fn carry_out(&mut self, mut moved: PositionStep, dt: f64, grips: &[Grip], follows: bool) {
        self.before.copy_from_slice(moved.bodies);
        self.leave_open(&mut moved, dt, follows);
        moved.system.activity.set_time(moved.end_time);
        self.update(&mut moved, dt);
        self.reach = self.adjust(&mut moved, grips);
        self.fours.keep_speed(moved.system, moved.bodies, &self.before, dt);
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
            moved.system.quads_mut().look(moved.bodies);
            self.reach = self.adjust(&mut moved, grips);
        }
        let motion = (dt, moved.gravity.length());
        let by_ratio = self.settings.method == Method::Compulsive;
        let shifted = self.touches.bounce(moved.system, moved.bodies, &self.before, (motion, by_ratio), moved.impacts);
        self.fours.bound_speed(moved.bodies);
        if shifted && !moved.system.joints().is_empty() {
            self.reach = self.adjust(&mut moved, grips);
        }
    }

    /// Says what the joints may keep open: what is open at a step's start is drawn together over time, not in one step.
    fn leave_open(&mut self, moved: &mut PositionStep, dt: f64, follows: bool) {
        let closed = follows && !moved.activation_changed && self.reach.residual <= REACHED;
        if closed {
            self.tree.left.fill(0.0);
            return;
        }
        moved.system.evaluate(moved.bodies);
        moved.system.leave_open(dt, moved.stabilization_time, &mut self.tree.left);
    }

    /// The update: each body alone.
    fn update(&self, moved: &mut PositionStep, dt: f64) {
        let Settings { method, retention, .. } = self.settings;
        self.fours.update(moved, dt, retention, method == Method::TreeSolve);
        for drive in moved.kinematic_bodies {
            drive.motion.at(moved.end_time).place(&mut moved.bodies[drive.body]);
            moved.system.quads_mut().look_at(drive.body, &moved.bodies[drive.body]);
        }
    }

    /// Brings the bodies, where the quads have them, back to where the joints hold.
    fn adjust(&mut self, moved: &mut PositionStep, grips: &[Grip]) -> Reach {
        if self.settings.method == Method::Compulsive {
            return self.adjust_by_rule(moved, grips);
        }
        let reach = self.tree.adjust(moved, grips, &self.fours);
        if reach.reached() {
            return reach;
        }
        // It leapt too far for tangents, or is asked too much: passes close a tree from anywhere.
        self.kept.copy_from_slice(moved.bodies);
        let mut last = self.compulsive.adjust(moved, grips, &self.tree.left, None);
        let no_nearer = reach.residual <= REACHED && last.missed >= reach.missed;
        if last.residual > REACHED.max(reach.residual) || no_nearer {
            // Not so a figure that is held in many places, or a hand that is out of reach.
            moved.bodies.copy_from_slice(&self.kept);
            last = reach;
        } else if !last.reached() && last.missed <= NEAR {
            last = self.again(moved, grips, last, Reach::reached);
        }
        if last.residual > REACHED {
            // Whatever is asked, the joints hold.
            let before = last.residual;
            last = self.again(moved, &[], last, |reach| reach.residual < before);
            last.missed = compulsive::farthest(grips, moved.bodies);
        }
        if last.residual > REACHED {
            self.stay(moved);
            last = self.again(moved, &[], last, |_| true);
            last.missed = compulsive::farthest(grips, moved.bodies);
        }
        last.passes += reach.passes;
        last
    }

    /// By the source's rule. What hands ask in vain is given up, as the joints go before them.
    fn adjust_by_rule(&mut self, moved: &mut PositionStep, grips: &[Grip]) -> Reach {
        let mut reach = self.compulsive.adjust(moved, grips, &self.tree.left, Some(self.settings.control));
        for stays in [false, true] {
            // What is open by little without hands is drawn together in the next steps.
            if reach.residual <= REACHED || (grips.is_empty() && reach.residual <= NEAR) {
                break;
            }
            if stays {
                self.stay(moved);
                moved.system.evaluate(moved.bodies);
                reach.residual = moved.system.open_by(&self.tree.left);
                reach.missed = compulsive::farthest(grips, moved.bodies);
                if reach.residual <= REACHED {
                    break;
                }
            }
            let alone = self.compulsive.adjust(moved, &[], &self.tree.left, None);
            reach = Reach {
                passes: reach.passes + alone.passes,
                missed: compulsive::farthest(grips, moved.bodies),
                ..alone
            };
        }
        reach
    }

    /// What cannot be done is not done: the figure stays where it stood.
    fn stay(&self, moved: &mut PositionStep) {
        let free = moved.system.driven().iter().map(|driven| !driven);
        for ((body, before), free) in moved.bodies.iter_mut().zip(&self.before).zip(free) {
            if free {
                *body = *before;
            }
        }
    }

    /// All joints at once another time, from where passes left them; back to there unless the outcome is good.
    fn again(
        &mut self,
        moved: &mut PositionStep,
        grips: &[Grip],
        passed: Reach,
        good: impl Fn(&Reach) -> bool,
    ) -> Reach {
        self.kept.copy_from_slice(moved.bodies);
        moved.system.quads_mut().look(moved.bodies);
        let reach = self.tree.adjust(moved, grips, &self.fours);
        if good(&reach) {
            return reach;
        }
        moved.bodies.copy_from_slice(&self.kept);
        passed
    }
}
