//! Snapshot: the state of one moment for pictures, traces and panels.

use super::charts::CurveView;
use super::dust_particles::DustParticle;
use super::input::MotionMode;
use super::step::Simulation;
use soffio_detector::BlowEstimate;
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DVec3, Pose};
use soffio_multibody::dynamics::Dynamics;

/// Diameter of the ring that marks a grab, picture heights.
const GRAB_RING: f64 = 0.04;
/// Source speed at which the breath meter is full, m/s: a strong breath.
const FULL_METER: f64 = 16.0;

/// The breath as it is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BreathView {
    /// Joint speed of all breath sources, m/s; exactly 0 without a breath.
    pub speed: f64,
    /// Estimate of the detector.
    pub estimate: BlowEstimate,
    /// Centre of the lips, world, m.
    pub mouth: DVec3,
    /// Direction of the breath, unit.
    pub direction: DVec3,
    /// Where it is aimed, world, m.
    pub target: DVec3,
    /// The ring that shows the aim.
    pub ring: AimRing,
    /// Level of the breath meter, 0 … 1; exactly 0 without a breath.
    pub meter: f64,
}

/// Ring that shows the width of the breath at its target, or the first grab.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AimRing {
    /// Centre, world, m.
    pub center: DVec3,
    /// Axis, unit, downstream.
    pub axis: DVec3,
    /// Radius, m.
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
    /// Estimated arithmetic operations of the motion in the last step, equal on every machine.
    pub operations: u64,
    /// Sum of the wind's forces, N.
    pub wind_force: DVec3,
    /// Solver of the last step.
    pub mode: MotionMode,
    /// Pointers that hold a body.
    pub grabs: usize,
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
    /// Dust particles.
    pub dust_particles: Vec<DustParticle>,
    /// Curves of the exhibit's charts, in their order.
    pub curves: Vec<CurveView>,
    /// Turn of the camera from the exhibit's own view: to the right and up, rad.
    pub turn: [f64; 2],
    /// Numbers for staff.
    pub diagnostics: Diagnostics,
}

/// A particle that moved farther than this in a step reappeared elsewhere, m.
const JUMP: f32 = 0.1;

impl Snapshot {
    /// Interpolates between two snapshots of the same exhibit; `alpha`: 0 first … 1 second.
    pub fn interpolate(&self, next: &Self, alpha: f64) -> Self {
        let mut out = Self::default();
        out.set_between(self, next, alpha);
        out
    }

    /// As [`Self::interpolate`], into existing storage.
    pub fn set_between(&mut self, first: &Self, next: &Self, alpha: f64) {
        let Self { step, time, poses, breath, dust_particles, curves, turn, diagnostics } = self;
        (*step, *breath, *diagnostics) = (next.step, next.breath, next.diagnostics);
        // No interpolation over a reset.
        *time = if next.time < first.time { next.time } else { first.time + (next.time - first.time) * alpha };
        *turn = std::array::from_fn(|i| first.turn[i] + (next.turn[i] - first.turn[i]) * alpha);
        poses.clone_from(&next.poses);
        curves.clone_from(&next.curves);
        dust_particles.clone_from(&next.dust_particles);
        for (pose, before) in poses.iter_mut().zip(&first.poses) {
            *pose = before.interpolate(pose, alpha);
        }
        for (particle, before) in dust_particles.iter_mut().zip(&first.dust_particles) {
            for (to, from) in particle.position.iter_mut().zip(before.position) {
                if (*to - from).abs() < JUMP {
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
                speed: self.breath.speed,
                estimate: self.breath.estimate,
                mouth: self.aim_assist.aim.mouth,
                direction: self.aim_assist.aim.direction,
                target: self.aim_assist.aim.target,
                ring: self.aim_ring(),
                meter: (self.breath.speed / FULL_METER).clamp(0.0, 1.0),
            },
            dust_particles: self.dust_particles.view().collect(),
            curves: self.charts.view().collect(),
            turn: self.camera.turn,
            diagnostics: Diagnostics {
                joint_error: self.motion.joint_error(),
                energy: self.motion.dynamics.energy(),
                impacts: self.emitter.impacts,
                faults: self.emitter.faults,
                substeps: self.motion.kinds().map(Dynamics::substeps).fold(0, u32::max),
                operations: self.motion.kinds().map(Dynamics::operations).sum(),
                wind_force: self.air.report.force,
                mode: self.motion.mode,
                grabs: self.motion.pointer_grabs.count(),
            },
        }
    }

    /// Ring of the breath at its target, or of the first grab.
    fn aim_ring(&self) -> AimRing {
        let view = &self.camera.view;
        if let Some(center) = self.motion.pointer_grabs.first(&self.motion.dynamics.bodies) {
            let forward = view.axes().2;
            let radius = 0.5 * GRAB_RING * view.height_at((center - view.eye).dot(forward));
            return AimRing { center, axis: forward, radius };
        }
        let breath = self.aimed_breath().breath();
        let radius = breath.half_width(self.aim_assist.aim.target.distance(self.aim_assist.aim.mouth));
        AimRing { center: self.aim_assist.aim.target, axis: self.aim_assist.aim.direction, radius }
    }
}
