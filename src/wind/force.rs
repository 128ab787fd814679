//! The wind's force on moving patches.
//!
//! Per patch, with w the air's velocity and u the patch's own, v = w − u the relative wind, n the outward normal:
//!
//! ```text
//! side:   F = ½ ρ C_D A |v_n| v_n n             where v_n = v·n < 0 (the windward side carries the plate's whole C_D)
//!           + ½ ρ C_f A |v_t| v_t               skin friction along the face
//! sheet:  the same for either sign of v_n      (a mesh that is one face of a thin sheet)
//! wire:   F = ½ ρ C_D A |v_⊥| v_⊥               v_⊥ across the wire
//! ```
//!
//! This is quadratic drag at Reynolds numbers of 10³–10⁵ (the source calls it Stokes drag). Because v is relative,
//! still air damps; because plates have many patches, rotation is damped too.
//!
//! Breath reaches only patches that face the lips and see them: a ray from the patch to the lips must pass every
//! other body. Turbulence multiplies the breath by 1 + β n(x − U t), a seeded gradient noise carried downstream: the
//! same in two neighbouring patches and from run to run. The sum of the breath's forces never exceeds its momentum
//! flow ρ Q U₀.

use super::jet::{AIR_DENSITY, Front, Jet};
use super::patches::{Face, Patch, split};
use super::{Surface, SurfaceShape};
use crate::articulation::block::{Vec6, vec6};
use crate::bodies::RigidBody;
use crate::geometry::rays::RayMesh;
use crate::math::{DVec3, Pose};
use crate::noise::perlin3;

/// Relative strength of the gusts within a breath, rms about a quarter.
const TURBULENCE: f64 = 0.45;
/// Size of the eddies, m.
const EDDY: f64 = 0.06;
/// Wind below this needs no ray, m/s.
const STILL_AIR: f64 = 0.01;
/// Rays start this far off their own face, m.
const RAY_START: f64 = 1e-4;

/// A surface's patches and coefficients.
struct Feeler {
    body: usize,
    patches: Vec<Patch>,
    drag_normal: f64,
    drag_tangential: f64,
    gain: f64,
}

/// What the breath does in one step, ready for every patch.
pub struct Breath<'a> {
    /// The jet at the source's present speed.
    pub jet: Jet,
    /// Air in flight; `None`: the breath is everywhere at once.
    pub front: Option<&'a Front>,
    /// Multiplies the breath's force.
    pub gain: f64,
    /// Seconds, for the gusts.
    pub time: f64,
}

/// What the wind did in one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WindReport {
    /// Sum of all forces, N.
    pub force: DVec3,
    /// Relative gust at the target, about ±1.
    pub gust: f64,
}

/// All that feels the wind in an exhibit.
#[derive(Default)]
pub struct WindField {
    feelers: Vec<Feeler>,
    /// Per body: what casts wind shadow.
    shelters: Vec<Option<RayMesh>>,
    seed: u64,
    breath: Vec<Vec6>,
}

impl WindField {
    /// The surfaces of an exhibit with `bodies` bodies.
    pub fn new(surfaces: &[Surface], bodies: usize, seed: u64) -> Self {
        let mut shelters: Vec<Option<RayMesh>> = (0..bodies).map(|_| None).collect();
        let feelers = surfaces
            .iter()
            .map(|surface| {
                if let SurfaceShape::Mesh { mesh, .. } = &surface.shape {
                    shelters[surface.body] = RayMesh::new(mesh);
                }
                Feeler {
                    body: surface.body,
                    patches: split(surface),
                    drag_normal: surface.drag_normal,
                    drag_tangential: surface.drag_tangential,
                    gain: surface.gain,
                }
            })
            .collect();
        Self { feelers, shelters, seed, breath: vec![[0.0; 6]; bodies] }
    }

    /// Adds the wind's wrenches (N, N m about each centre of mass) to `out`.
    pub fn push(&mut self, bodies: &[RigidBody], breath: Option<&Breath>, out: &mut [Vec6]) -> WindReport {
        let mut report = WindReport::default();
        self.breath.fill([0.0; 6]);
        let mut breath_total = 0.0;
        let poses = |body: usize| bodies[body].pose();
        for feeler in &self.feelers {
            let body = &bodies[feeler.body];
            let pose = body.pose();
            for patch in &feeler.patches {
                let point = pose.point(patch.point);
                let own = body.velocity_at(point);
                let still = patch_force(patch, &pose, -own, feeler);
                add_wrench(&mut out[feeler.body], body, point, still);
                report.force += still;
                let Some(breath) = breath.filter(|b| faces(patch, &pose, b.jet.mouth - point)) else { continue };
                let air = self.air(breath, point);
                if air.length() < STILL_AIR {
                    continue;
                }
                if !self.sees(&poses, feeler.body, patch, &pose, point, breath.jet.mouth) {
                    continue;
                }
                // What the breath adds to still air's own drag.
                let blown = patch_force(patch, &pose, air - own, feeler) - still;
                breath_total += blown.length();
                add_wrench(&mut self.breath[feeler.body], body, point, blown);
            }
        }
        if let Some(breath) = breath {
            let cap = breath.jet.momentum_flow();
            let share = breath.gain * if breath_total > cap { cap / breath_total } else { 1.0 };
            for (out, blown) in out.iter_mut().zip(&self.breath) {
                for k in 0..6 {
                    out[k] += share * blown[k];
                }
                report.force += share * crate::articulation::block::linear(blown);
            }
            report.gust = self.gust(breath, breath.jet.mouth + 0.5 * breath.jet.direction);
        }
        report
    }

    /// Velocity of the breath's air at a point, gusts included, m/s.
    pub fn air(&self, breath: &Breath, point: DVec3) -> DVec3 {
        let Some((x, share)) = breath.jet.profile(point) else { return DVec3::ZERO };
        let source = match breath.front {
            Some(front) => front.speed_at(x, breath.jet.lip_diameter),
            None => breath.jet.speed,
        };
        let mean = share * breath.jet.center_speed(x, source);
        if mean < STILL_AIR {
            return DVec3::ZERO;
        }
        breath.jet.flow_direction(point) * (mean * (1.0 + TURBULENCE * self.gust(breath, point)))
    }

    /// Noise of the gusts at a point, about ±1: eddies carried downstream.
    fn gust(&self, breath: &Breath, point: DVec3) -> f64 {
        let carried = point - breath.jet.direction * (0.5 * breath.time);
        perlin3(carried / EDDY + DVec3::splat(0.37 * breath.time), self.seed)
    }

    /// Does a patch see the lips past every other body, and past its own?
    fn sees(
        &self,
        poses: &impl Fn(usize) -> Pose,
        own: usize,
        patch: &Patch,
        pose: &Pose,
        point: DVec3,
        mouth: DVec3,
    ) -> bool {
        let lift = match patch.face {
            Face::Side(normal) => pose.vector(normal) * RAY_START,
            Face::Sheet(normal) => {
                let n = pose.vector(normal);
                n * (RAY_START * n.dot(mouth - point).signum())
            }
            Face::Wire(_) => DVec3::ZERO,
        };
        let way = mouth - (point + lift);
        let far = way.length();
        let direction = way / far;
        self.shelters.iter().enumerate().all(|(body, shelter)| {
            let pose = if body == own { *pose } else { poses(body) };
            shelter.as_ref().is_none_or(|s| s.hit(&pose, point + lift, direction, 0.0, far).is_none())
        })
    }
}

/// Is the patch turned towards `to`?
fn faces(patch: &Patch, pose: &Pose, to: DVec3) -> bool {
    match patch.face {
        Face::Side(normal) => pose.vector(normal).dot(to) > 0.0,
        Face::Sheet(_) | Face::Wire(_) => true,
    }
}

/// Drag of a patch in the relative wind `v` (m/s), N.
fn patch_force(patch: &Patch, pose: &Pose, v: DVec3, feeler: &Feeler) -> DVec3 {
    let pressure = 0.5 * AIR_DENSITY * patch.area * feeler.gain;
    match patch.face {
        Face::Side(normal) | Face::Sheet(normal) => {
            let n = pose.vector(normal);
            let along = v.dot(n);
            let slip = v - along * n;
            let lee = along >= 0.0 && matches!(patch.face, Face::Side(_));
            let push = if lee { DVec3::ZERO } else { feeler.drag_normal * along.abs() * along * n };
            pressure * (push + feeler.drag_tangential * slip.length() * slip)
        }
        Face::Wire(axis) => {
            let axis = pose.vector(axis);
            let across = v - v.dot(axis) * axis;
            pressure * feeler.drag_normal * across.length() * across
        }
    }
}

fn add_wrench(out: &mut Vec6, body: &RigidBody, point: DVec3, force: DVec3) {
    let wrench = vec6(force, (point - body.position).cross(force));
    for k in 0..6 {
        out[k] += wrench[k];
    }
}
