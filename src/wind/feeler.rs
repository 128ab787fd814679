//! Surfaces that feel the wind: their patches, and how they stand on a moving body.

use std::cell::Cell;
use std::ops::Range;

use super::Surface;
use super::drag::{Coefficients, Quad};
use super::patches::{Patch, split};
use super::sight::overlooks;
use soffio_geometry::bodies::RigidBody;
use soffio_geometry::rays::{Hint, Occluders};
use soffio_math::lanes::WIDTH;
use soffio_math::spatial::matrix;
use soffio_math::{DMat3, DVec3};

/// Balls around patches are larger by this, in m and as a share: more than double precision rounds within kilometres.
const BALL_MARGIN: f64 = 1e-9;

/// A surface's patches and coefficients.
#[derive(Clone)]
pub(crate) struct Feeler {
    pub body: usize,
    pub patches: Vec<Patch>,
    /// The same by fours.
    pub quads: Vec<Quad>,
    /// A ball that holds all patches: its centre in the node frame, and its radius, m.
    pub ball: (DVec3, f64),
    /// Before which of its sides, front and back, each patch has nothing of its own body.
    pub overlooks: Vec<[bool; 2]>,
    /// What hid each patch the last time from the breath, and from each of the other winds.
    hints: Vec<Cell<Hint>>,
    /// Neighbours that move in the same air of the room: their middle in the node frame (m), and which.
    pub groups: Vec<(DVec3, Range<usize>)>,
    coefficients: Coefficients,
}

impl Feeler {
    /// Patches within `alike` metres of each other's middle are one group; `winds` blow on it, the breath not counted.
    pub fn new(surface: &Surface, alike: f64, winds: usize, occluders: &Occluders) -> Self {
        let mut patches = split(surface);
        let mut groups = Vec::new();
        gather(&mut patches, 0, alike, &mut groups);
        let middle = patches.iter().map(|patch| patch.point).sum::<DVec3>() / patches.len().max(1) as f64;
        let radius = patches.iter().map(|patch| patch.point.distance(middle)).fold(0.0, f64::max);
        let coefficients =
            Coefficients { normal: surface.drag_normal, tangential: surface.drag_tangential, gain: surface.gain };
        Self {
            body: surface.body,
            ball: (middle, (1.0 + BALL_MARGIN) * radius + BALL_MARGIN),
            overlooks: patches.iter().map(|patch| overlooks(occluders, surface.body, patch)).collect(),
            hints: vec![Cell::default(); (winds + 1) * patches.len()],
            groups,
            quads: patches.chunks(WIDTH).map(|four| Quad::new(four, &coefficients)).collect(),
            patches,
            coefficients,
        }
    }

    /// What hid each patch the last time from a wind (`None`: from the breath).
    #[inline(always)]
    pub fn hints(&self, wind: Option<usize>) -> &[Cell<Hint>] {
        let count = self.patches.len();
        &self.hints[wind.map_or(0, |wind| wind + 1) * count..][..count]
    }

    /// H g: what a patch takes of the turbulence `g` (in the body's frame), never more than all of it.
    pub fn shaken(&self, patch: &Patch, g: DVec3) -> DVec3 {
        let axis = patch.axis;
        let (c_along, c_across) = self.coefficients.of(patch.face);
        let most = c_along.max(c_across);
        if most <= 0.0 {
            return DVec3::ZERO;
        }
        let along = g.dot(axis) * axis;
        (c_along * along + c_across * (g - along)) / most
    }
}

/// Sorts patches, which begin at `start`, into groups of radius `alike` by halving them along their longest way.
fn gather(patches: &mut [Patch], start: usize, alike: f64, groups: &mut Vec<(DVec3, Range<usize>)>) {
    let Some(first) = patches.first().map(|patch| patch.point) else { return };
    let (low, high) = patches.iter().fold((first, first), |(l, h), p| (l.min(p.point), h.max(p.point)));
    if (high - low).length() <= 2.0 * alike || patches.len() == 1 {
        groups.push((0.5 * (low + high), start..start + patches.len()));
        return;
    }
    let longest = (high - low).max_position();
    patches.sort_by(|a, b| a.point[longest].total_cmp(&b.point[longest]));
    let (near, far) = patches.split_at_mut(patches.len() / 2);
    gather(near, start, alike, groups);
    gather(far, start + near.len(), alike, groups);
}

/// A surface on its body, seen in the body's own frame, in which its patches lie still.
pub(crate) struct Standing<'a> {
    pub feeler: &'a Feeler,
    pub body: &'a RigidBody,
    /// From the body's frame to the world, and back.
    pub frame: DMat3,
    pub inward: DMat3,
}

impl<'a> Standing<'a> {
    #[inline(always)]
    pub fn new(feeler: &'a Feeler, body: &'a RigidBody) -> Self {
        let frame = matrix(body.rotation);
        Self { feeler, body, frame, inward: frame.transpose() }
    }

    /// World point and axis of a patch, m.
    #[inline(always)]
    pub fn place(&self, patch: &Patch) -> (DVec3, DVec3) {
        let arm = patch.point - self.body.properties.center;
        (self.body.position + self.frame * arm, self.frame * patch.axis)
    }
}
