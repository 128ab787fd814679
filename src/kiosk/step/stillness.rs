//! Whether an exhibit stands still, step by step: then the window may draw fewer pictures (`window::rest`).
//!
//! [`Stillness`] sees every step: nobody blows, no hand holds, no key frames change a shape, no bright dust is in the air,
//! the camera stands, and neither a body nor the ring of the aim has gone a quarter of a pixel of a large picture within a
//! tenth of a second, for half a second.
//!
//! A point of a body at r from its node has gone at most |Δp| + r |Δφ|, and is seen to have gone that over the height of the
//! picture at its distance.

use std::sync::Arc;

use soffio_exhibit::{Exhibit, View};
use soffio_math::{DVec3, Pose};
use soffio_simulation::{AimRing, STEPS_PER_SECOND, Snapshot};

/// From picture to picture at rest, s.
pub const PICTURE_S: f64 = 0.1;
/// All must have been quiet for so long, s.
pub const QUIET_S: f64 = 0.5;
/// What nobody sees to have moved, picture heights: a quarter of a pixel of 2160.
pub const UNSEEN: f64 = 0.25 / 2160.0;
/// Dust that is brighter is seen to fly. What floats in still air is fainter, a twelfth of white, and goes a pixel or two from
/// picture to picture.
pub const BRIGHT: f32 = 0.08;
/// Nearer to the eye than this nothing is taken for, m.
const NEAREST: f64 = 0.05;

/// Steps between two pictures at rest, and steps of quiet.
const LOOK: u64 = (PICTURE_S * STEPS_PER_SECOND as f64) as u64;
const QUIET: u64 = (QUIET_S * STEPS_PER_SECOND as f64) as u64;

/// Whether an exhibit stands still, step by step.
#[derive(Clone, Debug, Default)]
pub struct Stillness {
    exhibit: Option<Arc<Exhibit>>,
    /// How far each body reaches from its node, m.
    reaches: Vec<f64>,
    /// What is compared with: poses, ring and turn some steps ago.
    poses: Vec<Pose>,
    ring: AimRing,
    turn: [f64; 2],
    age: u64,
    quiet: u64,
}

impl Stillness {
    /// Takes notice of a step, seen from `view`.
    pub fn note(&mut self, exhibit: &Arc<Exhibit>, now: &Snapshot, view: &View) {
        if self.exhibit.as_ref().is_none_or(|known| !Arc::ptr_eq(known, exhibit)) {
            *self = Self { exhibit: Some(exhibit.clone()), reaches: exhibit.body_radii(), ..Self::default() };
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

    /// Has nothing moved for a while?
    pub fn is_still(&self) -> bool {
        self.quiet >= QUIET
    }

    fn remember(&mut self, now: &Snapshot) {
        self.poses.clone_from(&now.poses);
        (self.ring, self.turn, self.age) = (now.breath.ring, now.turn, 0);
    }

    /// The farthest that anything has gone since, picture heights.
    fn moved(&self, now: &Snapshot, view: &View) -> f64 {
        let forward = view.axes().2;
        let seen = |at: DVec3, reach: f64, way: f64| {
            let depth = ((at - view.eye).dot(forward) - reach).max(NEAREST);
            way / view.height_at(depth)
        };
        let body = |((before, pose), reach): ((&Pose, &Pose), &f64)| {
            // The chord of the half-angle: |Δφ| = 2 asin of it, at most π/2 times as much as twice the chord.
            let turned = (before.rotation.conjugate() * pose.rotation).xyz().length();
            let way = before.position.distance(pose.position) + reach * std::f64::consts::PI * turned;
            seen(pose.position, *reach, way)
        };
        let bodies = self.poses.iter().zip(&now.poses).zip(&self.reaches).map(body);
        let (before, ring) = (&self.ring, &now.breath.ring);
        let tilt = ring.radius * before.axis.distance(ring.axis);
        let ring_way = before.center.distance(ring.center) + (before.radius - ring.radius).abs() + tilt;
        bodies.fold(seen(ring.center, ring.radius, ring_way), f64::max)
    }
}
