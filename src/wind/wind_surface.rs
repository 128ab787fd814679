//! Wind surfaces: panel discretisation of a surface into patches, and its pose on a moving body.

use std::cell::Cell;
use std::ops::Range;

use super::Surface;
use super::drag::{DragCoefficients, PatchBlock};
use super::patches::{Patch, sample_surface};
use super::visibility::clear_of_own_body;
use soffio_geometry::bodies::RigidBody;
use soffio_geometry::rays::{Hint, Occluders};
use soffio_math::lanes::WIDTH;
use soffio_math::spatial::matrix;
use soffio_math::{DMat3, DVec3};

/// Bounding balls are larger than their patches need by this, in m and as a ratio: more than double precision rounds
/// within kilometres.
const BALL_MARGIN: f64 = 1e-9;

/// A ball in the node frame of a body that holds all patches of a surface.
#[derive(Clone, Copy)]
pub(crate) struct BoundingBall {
    /// Centre, m.
    pub center: DVec3,
    /// Radius, m.
    pub radius: f64,
}

/// Neighbouring patches for which the undirected wind is sampled once.
#[derive(Clone)]
pub(crate) struct PatchGroup {
    /// Sample point, node frame, m.
    pub center: DVec3,
    /// Indices of the patches.
    pub patches: Range<usize>,
}

/// The patches of a surface and its drag coefficients.
#[derive(Clone)]
pub(crate) struct WindSurface {
    /// Index of the body that carries it.
    pub body: usize,
    /// The patches.
    pub patches: Vec<Patch>,
    /// The same patches in blocks of [`WIDTH`].
    pub blocks: Vec<PatchBlock>,
    /// Ball that holds all patches.
    pub ball: BoundingBall,
    /// Of each patch, whether its own body leaves its front and its back clear.
    pub clear_sides: Vec<[bool; 2]>,
    /// The last occluder of each patch: of the breath's rays, then of each ambient wind's.
    hints: Vec<Cell<Hint>>,
    /// Sum of the patches' areas, m².
    pub area: f64,
    /// Groups of patches for the undirected wind.
    pub groups: Vec<PatchGroup>,
    coefficients: DragCoefficients,
}

impl WindSurface {
    /// Samples a surface. Patches within `uniform_radius` (m) of a common centre form one group; `winds` is the number of
    /// ambient winds.
    pub fn new(surface: &Surface, uniform_radius: f64, winds: usize, occluders: &Occluders) -> Self {
        let mut patches = sample_surface(surface);
        let mut groups = Vec::new();
        group_patches(&mut patches, 0, uniform_radius, &mut groups);
        let center = patches.iter().map(|patch| patch.point).sum::<DVec3>() / patches.len().max(1) as f64;
        let radius = patches.iter().map(|patch| patch.point.distance(center)).fold(0.0, f64::max);
        let coefficients =
            DragCoefficients { normal: surface.drag_normal, tangential: surface.drag_tangential, gain: surface.gain };
        Self {
            body: surface.body,
            ball: BoundingBall { center, radius: (1.0 + BALL_MARGIN) * radius + BALL_MARGIN },
            clear_sides: patches.iter().map(|patch| clear_of_own_body(occluders, surface.body, patch)).collect(),
            hints: vec![Cell::default(); (winds + 1) * patches.len()],
            groups,
            area: patches.iter().map(|patch| patch.area).sum(),
            blocks: patches.chunks(WIDTH).map(|block| PatchBlock::new(block, &coefficients)).collect(),
            patches,
            coefficients,
        }
    }

    /// The last occluder of each patch's ray to an ambient wind (`None`: to the breath).
    #[inline(always)]
    pub fn hints(&self, wind: Option<usize>) -> &[Cell<Hint>] {
        let count = self.patches.len();
        &self.hints[wind.map_or(0, |wind| wind + 1) * count..][..count]
    }

    /// H g: response of a patch to the turbulence vector `g` (node frame), never longer than `g`.
    pub fn gust_response(&self, patch: &Patch, g: DVec3) -> DVec3 {
        let axis = patch.axis;
        let drag = self.coefficients.of(patch.kind);
        let largest = drag.along.max(drag.across);
        if largest <= 0.0 {
            return DVec3::ZERO;
        }
        let along = g.dot(axis) * axis;
        (drag.along * along + drag.across * (g - along)) / largest
    }
}

/// Sorts patches, the first of index `start`, into groups of radius `uniform_radius` by halving them along their longest
/// extent.
fn group_patches(patches: &mut [Patch], start: usize, uniform_radius: f64, groups: &mut Vec<PatchGroup>) {
    let Some(first) = patches.first().map(|patch| patch.point) else { return };
    let (low, high) = patches.iter().fold((first, first), |(l, h), p| (l.min(p.point), h.max(p.point)));
    if (high - low).length() <= 2.0 * uniform_radius || patches.len() == 1 {
        groups.push(PatchGroup { center: 0.5 * (low + high), patches: start..start + patches.len() });
        return;
    }
    let longest = (high - low).max_position();
    patches.sort_by(|a, b| a.point[longest].total_cmp(&b.point[longest]));
    let (near, far) = patches.split_at_mut(patches.len() / 2);
    group_patches(near, start, uniform_radius, groups);
    group_patches(far, start + near.len(), uniform_radius, groups);
}

/// A patch in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlacedPatch {
    /// World point, m.
    pub point: DVec3,
    /// Outward unit normal, or the wire's unit direction.
    pub axis: DVec3,
}

/// A surface on its body. Forces are computed in the body's frame, in which the patches are fixed.
pub(crate) struct PosedSurface<'a> {
    /// The surface.
    pub surface: &'a WindSurface,
    /// The body that carries it.
    pub body: &'a RigidBody,
    /// Rotation from the body's frame to the world.
    pub to_world: DMat3,
    /// Rotation from the world to the body's frame.
    pub to_body: DMat3,
}

impl<'a> PosedSurface<'a> {
    /// The surface at the body's present pose.
    #[inline(always)]
    pub fn new(surface: &'a WindSurface, body: &'a RigidBody) -> Self {
        let to_world = matrix(body.rotation);
        Self { surface, body, to_world, to_body: to_world.transpose() }
    }

    /// A patch of the surface in the world.
    #[inline(always)]
    pub fn place(&self, patch: &Patch) -> PlacedPatch {
        let arm = patch.point - self.body.properties.center;
        PlacedPatch { point: self.body.position + self.to_world * arm, axis: self.to_world * patch.axis }
    }
}
