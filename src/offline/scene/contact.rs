//! Contact quality: penetration, energy rise and drift, from the file's shapes and the bodies' states alone.
//!
//! ```text
//! penetration = largest −gap of two shapes that can touch, m
//! rise        = largest E(t) − E(s), s ≤ t: contacts, friction and joints only lose energy, J
//! displacement = farthest distance of a body from its start, m
//! drift       = the same within the last second of the run: resting bodies do not move, m
//! ```
//!
//! Gaps are computed where the bounding spheres of two shapes overlap.

use serde::Serialize;

use super::format::PhysicsScene;
use super::measure::{BodyState, larger};
use soffio_math::{DVec3, Pose};
use soffio_multibody::collision::{Collider, proximity};
use soffio_multibody::dynamics::SurfacePair;

/// Span at the end of a run in which bodies should be at rest, s.
const REST_SPAN: f64 = 1.0;

/// Contact quality of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ContactReport {
    /// Deepest overlap of two shapes over the run, m; 0 where none overlap.
    pub max_penetration_m: f64,
    /// Deepest overlap at the end, m.
    pub rest_penetration_m: f64,
    /// Largest rise of the energy above its least value so far, J.
    pub max_energy_rise_j: f64,
    /// The energy rise over the scene's energy scale, without a unit.
    pub max_energy_rise_rel: f64,
    /// Farthest distance of a body from its start, m.
    pub max_way_m: f64,
    /// Farthest distance of a body from its position a second before the end, m; `None` if the run ended earlier.
    pub rest_drift_m: Option<f64>,
}

/// Observes the contacts of a run step by step.
#[derive(Clone, Debug)]
pub(super) struct ContactObserver {
    colliders: Vec<Collider>,
    pairs: Vec<SurfacePair>,
    start: Vec<DVec3>,
    /// Start of the last second, s, and the positions of the bodies then.
    rest: (f64, Option<Vec<DVec3>>),
    least_energy: f64,
    report: ContactReport,
}

impl ContactObserver {
    /// `None` for a scene without collisions. `energy` is that of the start, J.
    pub fn new(scene: &PhysicsScene, energy: f64) -> Option<Self> {
        scene.surface?;
        let colliders = scene.colliders();
        Some(Self {
            pairs: scene.surface_pairs(&colliders),
            colliders,
            start: scene.bodies.iter().map(|body| DVec3::from_array(body.pos)).collect(),
            rest: (scene.duration - REST_SPAN, None),
            least_energy: energy,
            report: ContactReport::default(),
        })
    }

    /// Sets the time at which the run ends, s. A time after the scene's own end changes nothing.
    pub fn set_end_time(&mut self, seconds: f64) {
        self.rest.0 = self.rest.0.min(seconds - REST_SPAN);
    }

    /// Observes the states at time `t`, s, and their mechanical energy, J. `scale` is the scene's energy scale, J.
    pub fn observe(&mut self, t: f64, states: &[BodyState], energy: f64, scale: f64) {
        let penetration = self.penetration(states);
        let report = &mut self.report;
        report.max_penetration_m = larger(report.max_penetration_m, penetration);
        report.rest_penetration_m = penetration;
        report.max_energy_rise_j = larger(report.max_energy_rise_j, energy - self.least_energy);
        report.max_energy_rise_rel = report.max_energy_rise_j / scale;
        self.least_energy = self.least_energy.min(energy);
        let farthest = |from: &[DVec3]| {
            states.iter().zip(from).map(|(state, from)| state.position.distance(*from)).fold(0.0, larger)
        };
        report.max_way_m = larger(report.max_way_m, farthest(&self.start));
        match &self.rest {
            (_, Some(from)) => {
                report.rest_drift_m = Some(larger(report.rest_drift_m.unwrap_or_default(), farthest(from)));
            }
            (begins, None) if t >= *begins => {
                self.rest.1 = Some(states.iter().map(|state| state.position).collect());
            }
            _ => {}
        }
    }

    /// The measurements so far.
    pub fn report(&self) -> ContactReport {
        self.report
    }

    fn penetration(&self, states: &[BodyState]) -> f64 {
        let pose = |collider: &Collider| {
            let state = collider.body.map_or(&BodyState::WORLD, |body| &states[body]);
            Pose { rotation: state.rotation, position: state.position }
        };
        let placed: Vec<(Pose, DVec3, f64)> = self
            .colliders
            .iter()
            .map(|collider| {
                let (pose, (middle, radius)) = (pose(collider), collider.bounds());
                (pose, pose.point(middle), radius + collider.shape.radius)
            })
            .collect();
        let mut deepest = 0.0;
        for SurfacePair { pair, .. } in &self.pairs {
            let ((pose_a, a, radius_a), (pose_b, b, radius_b)) = (&placed[pair.a], &placed[pair.b]);
            let reach = radius_a + radius_b;
            if a.distance_squared(*b) < reach * reach {
                let (first, second) = (&self.colliders[pair.a].shape, &self.colliders[pair.b].shape);
                deepest = larger(deepest, -proximity(first, pose_a, second, pose_b).gap);
            }
        }
        deepest
    }
}
