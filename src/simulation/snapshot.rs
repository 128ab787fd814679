//! What a picture, a trace and a panel need to know of one moment.

use super::input::MotionMode;
use super::motes::Mote;
use super::step::Simulation;
use soffio_detector::BlowEstimate;
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DVec3, Pose};

/// Width of the ring that shows a hand, picture heights.
const HAND_RING: f64 = 0.04;
/// Source speed that fills the breath meter, m/s: a strong breath.
const FULL_METER: f64 = 16.0;

/// The breath as it is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BreathView {
    /// Source speed after all sources are joined, m/s; exactly 0 when nobody blows.
    pub speed: f64,
    /// What the detector says.
    pub estimate: BlowEstimate,
    /// Centre of the lips, world, m.
    pub mouth: DVec3,
    /// Unit, where the breath goes.
    pub direction: DVec3,
    /// Where it is aimed, world, m.
    pub target: DVec3,
    /// The ring that shows the aim.
    pub ring: AimRing,
    /// How full the breath meter is, 0 … 1: exactly 0 when nobody blows.
    pub meter: f64,
}

/// A circle of air, as wide as the breath is where it meets the sculpture; a small one where a hand holds it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AimRing {
    /// World, m.
    pub center: DVec3,
    /// Unit, downstream.
    pub axis: DVec3,
    /// m.
    pub radius: f64,
}

/// Numbers for staff and for the summary of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Diagnostics {
    /// Largest distance between the two points of any joint now, m.
    pub joint_error: f64,
    /// Kinetic plus potential energy, J.
    pub energy: f64,
    /// Impacts so far.
    pub impacts: u64,
    /// Faults so far.
    pub faults: u64,
    /// Integration substeps of the last step.
    pub substeps: u32,
    /// Operations of motion in the last step, about: the same on every machine.
    pub operations: u64,
    /// Sum of the wind's forces, N.
    pub wind_force: DVec3,
    /// What moved the figure in the last step.
    pub mode: MotionMode,
    /// Hands that hold something.
    pub hands: usize,
}

/// One moment of a simulation.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// Steps done.
    pub step: u64,
    /// Since the reset, s.
    pub time: f64,
    /// World pose of each moving body's glTF node, in the order of the exhibit's bodies.
    pub poses: Vec<Pose>,
    /// The breath.
    pub breath: BreathView,
    /// Dust.
    pub motes: Vec<Mote>,
    /// How far the camera is turned from the exhibit's own view: to the right and up, rad.
    pub turn: [f64; 2],
    /// Numbers for staff.
    pub diagnostics: Diagnostics,
}

/// A mote that moved farther than this in a step was born again elsewhere, m.
const REBORN: f32 = 0.1;

impl Snapshot {
    /// The moment between two snapshots of the same exhibit, `alpha` in 0…1.
    pub fn interpolate(&self, next: &Self, alpha: f64) -> Self {
        let mut out = Self::default();
        out.set_between(self, next, alpha);
        out
    }

    /// Becomes the moment between two snapshots, in the memory that it has.
    pub fn set_between(&mut self, first: &Self, next: &Self, alpha: f64) {
        let Self { step, time, poses, breath, motes, turn, diagnostics } = self;
        (*step, *breath, *diagnostics) = (next.step, next.breath, next.diagnostics);
        // After a reset there is nothing between.
        *time = if next.time < first.time { next.time } else { first.time + (next.time - first.time) * alpha };
        *turn = std::array::from_fn(|i| first.turn[i] + (next.turn[i] - first.turn[i]) * alpha);
        poses.clone_from(&next.poses);
        motes.clone_from(&next.motes);
        for (pose, before) in poses.iter_mut().zip(&first.poses) {
            *pose = before.interpolate(pose, alpha);
        }
        for (mote, before) in motes.iter_mut().zip(&first.motes) {
            for (to, from) in mote.position.iter_mut().zip(before.position) {
                if (*to - from).abs() < REBORN {
                    *to = from + (*to - from) * alpha as f32;
                }
            }
        }
    }
}

impl Simulation {
    /// The present moment.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            step: self.clock.step,
            time: self.motion.dynamics.time(),
            poses: self.motion.dynamics.bodies.iter().map(RigidBody::pose).collect(),
            breath: BreathView {
                speed: self.breathing.speed,
                estimate: self.breathing.estimate,
                mouth: self.aiming.aim.mouth,
                direction: self.aiming.aim.direction,
                target: self.aiming.aim.target,
                ring: self.aim_ring(),
                meter: (self.breathing.speed / FULL_METER).clamp(0.0, 1.0),
            },
            motes: self.motes.view().collect(),
            turn: self.eye.turn,
            diagnostics: Diagnostics {
                joint_error: self.motion.dynamics.joint_error(),
                energy: self.motion.dynamics.energy(),
                impacts: self.emitter.impacts,
                faults: self.emitter.faults,
                substeps: self.motion.dynamics.substeps(),
                operations: self.motion.dynamics.operations(),
                wind_force: self.air.report.force,
                mode: self.motion.mode,
                hands: self.motion.hands.count(),
            },
        }
    }

    /// The breath's own width where it is aimed, or a fingertip where a hand holds.
    fn aim_ring(&self) -> AimRing {
        let view = &self.eye.view;
        if let Some(center) = self.motion.hands.first(&self.motion.dynamics.bodies) {
            let forward = view.axes().2;
            let radius = 0.5 * HAND_RING * view.height_at((center - view.eye).dot(forward));
            return AimRing { center, axis: forward, radius };
        }
        let breath = self.pointed().breath();
        let radius = breath.half_width(self.aiming.aim.target.distance(self.aiming.aim.mouth));
        AimRing { center: self.aiming.aim.target, axis: self.aiming.aim.direction, radius }
    }
}
