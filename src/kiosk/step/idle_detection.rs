//! Idle detection: finds out whether the picture of an exhibit stands still, so that fewer frames are drawn
//! (`window::idle_rendering`).
//!
//! [`IdleDetector`] sees every step. The exhibit is idle after half a second without breath, grab, shape animation, bright dust
//! and camera motion. In that time no body and not the aim ring may move by a quarter of a pixel of a large picture within a
//! tenth of a second.
//!
//! A point of a body at r from its node moves by at most |Δp| + r |Δφ|. Its motion in the picture is that divided by the height
//! of the picture at its distance.

use std::sync::Arc;

use soffio_exhibit::{Exhibit, View};
use soffio_math::{DVec3, Pose};
use soffio_simulation::{AimRing, STEPS_PER_SECOND, Snapshot};

/// Time between two frames while idle, s.
pub const IDLE_FRAME_S: f64 = 0.1;
/// Time without motion after which the exhibit is idle, s.
pub const QUIET_S: f64 = 0.5;
/// Largest invisible motion, picture heights: a quarter of a pixel of 2160.
pub const UNSEEN: f64 = 0.25 / 2160.0;
/// Brightness from which the motion of dust is visible. Dust in still air is fainter, a twelfth of white, and moves by a pixel
/// or two between frames.
pub const BRIGHT: f32 = 0.08;
/// Least assumed distance from the camera, m.
const NEAREST: f64 = 0.05;

/// [`IDLE_FRAME_S`] and [`QUIET_S`] in steps.
const LOOK: u64 = (IDLE_FRAME_S * STEPS_PER_SECOND as f64) as u64;
const QUIET: u64 = (QUIET_S * STEPS_PER_SECOND as f64) as u64;

/// State of the idle detection.
#[derive(Clone, Debug, Default)]
pub struct IdleDetector {
    exhibit: Option<Arc<Exhibit>>,
    /// Bounding radius of each body about its node, m.
    radii: Vec<f64>,
    /// Reference for the comparison: poses, ring and camera some steps ago.
    poses: Vec<Pose>,
    ring: AimRing,
    turn: [f64; 2],
    age: u64,
    quiet: u64,
}

impl IdleDetector {
    /// Records a step, seen from `view`.
    pub fn update(&mut self, exhibit: &Arc<Exhibit>, now: &Snapshot, view: &View) {
        if self.exhibit.as_ref().is_none_or(|known| !Arc::ptr_eq(known, exhibit)) {
            *self = Self { exhibit: Some(exhibit.clone()), radii: exhibit.body_radii(), ..Self::default() };
            self.remember(now);
        }
        self.age += 1;
        self.quiet += 1;
        let breath = &now.breath;
        let shaped = exhibit.shapes.iter().any(|track| track.is_changing(now.time));
        let flies = now.dust_particles.iter().any(|mote| mote.brightness > BRIGHT);
        let blown = breath.speed > 0.0 || breath.estimate.speed > 0.0;
        if blown
            || shaped
            || flies
            || now.diagnostics.grabs > 0
            || now.turn != self.turn
            || self.moved(now, view) > UNSEEN
        {
            self.quiet = 0;
            self.remember(now);
        } else if self.age >= LOOK {
            self.remember(now);
        }
    }

    /// Is the exhibit idle?
    pub fn is_still(&self) -> bool {
        self.quiet >= QUIET
    }

    fn remember(&mut self, now: &Snapshot) {
        self.poses.clone_from(&now.poses);
        (self.ring, self.turn, self.age) = (now.breath.ring, now.turn, 0);
    }

    /// Largest motion since the reference, picture heights.
    fn moved(&self, now: &Snapshot, view: &View) -> f64 {
        let forward = view.axes().2;
        let seen = |at: DVec3, radius: f64, displacement: f64| {
            let depth = ((at - view.eye).dot(forward) - radius).max(NEAREST);
            displacement / view.height_at(depth)
        };
        let body = |((before, pose), radius): ((&Pose, &Pose), &f64)| {
            // The chord of the half-angle: |Δφ| = 2 asin of it, at most π/2 times as much as twice the chord.
            let turned = (before.rotation.conjugate() * pose.rotation).xyz().length();
            let displacement = before.position.distance(pose.position) + radius * std::f64::consts::PI * turned;
            seen(pose.position, *radius, displacement)
        };
        let bodies = self.poses.iter().zip(&now.poses).zip(&self.radii).map(body);
        let (before, ring) = (&self.ring, &now.breath.ring);
        let tilt = ring.radius * before.axis.distance(ring.axis);
        let ring_displacement = before.center.distance(ring.center) + (before.radius - ring.radius).abs() + tilt;
        bodies.fold(seen(ring.center, ring.radius, ring_displacement), f64::max)
    }
}
