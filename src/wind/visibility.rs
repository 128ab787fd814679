//! Visibility of a wind's origin from the patches of a surface: one ray a patch, by batches.
//!
//! A patch that faces away from the wind casts no ray. The rays of one surface to one wind are neighbours and are traced
//! together against all shelters. The occluder that blocked a patch's last ray is tested first the next time.

use std::cell::Cell;

use super::ambient::WindOrigin;
use super::patches::{Patch, PatchKind};
use super::wind_surface::{PlacedPatch, WindSurface};
use soffio_geometry::rays::{Hint, Occluders, SightLine};
use soffio_math::DVec3;

/// Distance off its own face at which a ray starts, m: more than single precision rounds, less than any gap.
const RAY_OFFSET: f64 = 1e-4;
/// Parts of its own body that rise less than this above a patch do not block it, m: the ray passes them by more than single
/// precision rounds.
const OBSTRUCTION_HEIGHT: f64 = 0.5 * RAY_OFFSET;
/// Distance beyond which occluders give no shelter from a directed wind, m: larger than any scene.
const MAX_DISTANCE: f64 = 50.0;

/// Whether no part of its own body rises above a patch's front, and above its back.
pub(crate) fn clear_of_own_body(occluders: &Occluders, body: usize, patch: &Patch) -> [bool; 2] {
    let height = patch.point.dot(patch.axis);
    let (low, high) = occluders.extent(body, patch.axis);
    [high - height, height - low].map(|rise| patch.kind != PatchKind::Wire && rise < OBSTRUCTION_HEIGHT)
}

/// A patch that faces the origin of a wind.
pub(crate) struct FacingPatch {
    /// Start of its ray, world, m.
    start: DVec3,
    origin: WindOrigin,
    /// The patch's body, if it cannot block the ray.
    skipped_body: Option<usize>,
}

impl WindSurface {
    /// Patch `index`, placed in the world; `None` if it faces away from the origin.
    #[inline(always)]
    pub fn facing(&self, index: usize, placed: PlacedPatch, origin: WindOrigin) -> Option<FacingPatch> {
        let PlacedPatch { point, axis } = placed;
        let toward = match origin {
            WindOrigin::Point(place) => place - point,
            WindOrigin::Direction(direction) => direction,
        };
        let facing = axis.dot(toward);
        let lift = match self.patches[index].kind {
            PatchKind::OneSided if facing <= 0.0 => return None,
            PatchKind::OneSided | PatchKind::TwoSided => axis * (RAY_OFFSET * facing.signum()),
            PatchKind::Wire => DVec3::ZERO,
        };
        // A ray that does not descend passes over everything lower than its start.
        let clear = facing.abs() >= RAY_OFFSET && self.clear_sides[index][usize::from(facing < 0.0)];
        Some(FacingPatch { start: point + lift, origin, skipped_body: clear.then_some(self.body) })
    }
}

impl FacingPatch {
    /// The ray from the patch to the wind's origin.
    #[inline(always)]
    pub fn line(self) -> SightLine {
        let Self { start, origin, skipped_body } = self;
        let (direction, far) = match origin {
            WindOrigin::Point(place) => {
                let offset = place - start;
                let far = offset.length();
                // A patch at the origin itself has a ray of length 0, which nothing blocks.
                (if far > 0.0 { offset / far } else { DVec3::ZERO }, far)
            }
            WindOrigin::Direction(direction) => (direction, MAX_DISTANCE),
        };
        SightLine { origin: start, direction, far, past: skipped_body, hint: Hint::default() }
    }
}

/// A batch of rays from the patches of one surface to the origin of one wind.
#[derive(Clone, Default)]
pub(crate) struct VisibilityRays {
    rays: Vec<SightLine>,
    /// Patch index of each ray.
    patches: Vec<usize>,
}

impl VisibilityRays {
    /// Storage for `patches` rays.
    pub fn with_capacity(patches: usize) -> Self {
        Self { rays: Vec::with_capacity(patches), patches: Vec::with_capacity(patches) }
    }

    /// Replaces the batch by these rays, each with the index of its patch.
    #[inline(always)]
    pub fn set(&mut self, rays: impl Iterator<Item = (usize, SightLine)>) {
        self.rays.clear();
        self.patches.clear();
        for (patch, ray) in rays {
            self.rays.push(ray);
            self.patches.push(patch);
        }
    }

    /// Traces the batch and yields the patches whose ray is not blocked. `hints` holds each patch's last occluder and is
    /// updated.
    #[inline(always)]
    pub fn visible(&mut self, occluders: &Occluders, hints: &[Cell<Hint>]) -> impl Iterator<Item = usize> {
        for (&patch, ray) in self.patches.iter().zip(&mut self.rays) {
            ray.hint = hints[patch].get();
        }
        occluders.look(&mut self.rays);
        self.patches.iter().zip(&self.rays).filter_map(|(&patch, ray)| {
            hints[patch].set(ray.hint);
            ray.hint.is_open().then_some(patch)
        })
    }
}
