//! Surfaces that feel the wind: their patches, how they stand on a moving body, and which of them see where a wind comes from.

use std::cell::Cell;
use std::ops::Range;

use super::Surface;
use super::drag::{Coefficients, Quad};
use super::patches::{Face, Patch, split};
use super::weather::Upwind;
use soffio_geometry::bodies::RigidBody;
use soffio_geometry::rays::{Hint, Occluders};
use soffio_math::lanes::WIDTH;
use soffio_math::spatial::matrix;
use soffio_math::{DMat3, DVec3};

/// Rays start this far off their own face, m.
const RAY_START: f64 = 1e-4;
/// What stands farther off than this shelters from no wind, m.
const FAR: f64 = 50.0;

/// A surface's patches and coefficients.
#[derive(Clone)]
pub(crate) struct Feeler {
    pub body: usize,
    pub patches: Vec<Patch>,
    /// The same by fours.
    pub quads: Vec<Quad>,
    /// What hid each patch the last time.
    pub hints: Vec<Cell<Hint>>,
    /// Neighbours that move in the same air of the room: their middle in the node frame (m), and which.
    pub groups: Vec<(DVec3, Range<usize>)>,
    coefficients: Coefficients,
}

impl Feeler {
    /// Patches within `alike` metres of each other's middle are one group.
    pub fn new(surface: &Surface, alike: f64) -> Self {
        let mut patches = split(surface);
        let mut groups = Vec::new();
        gather(&mut patches, 0, alike, &mut groups);
        let coefficients =
            Coefficients { normal: surface.drag_normal, tangential: surface.drag_tangential, gain: surface.gain };
        Self {
            body: surface.body,
            hints: vec![Cell::default(); patches.len()],
            groups,
            quads: patches.chunks(WIDTH).map(|four| Quad::new(four, &coefficients)).collect(),
            patches,
            coefficients,
        }
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
    occluders: &'a Occluders,
    /// From the body's frame to the world, and back.
    pub frame: DMat3,
    pub inward: DMat3,
}

impl<'a> Standing<'a> {
    #[inline(always)]
    pub fn new(feeler: &'a Feeler, body: &'a RigidBody, occluders: &'a Occluders) -> Self {
        let frame = matrix(body.rotation);
        Self { feeler, body, occluders, frame, inward: frame.transpose() }
    }

    /// World point and axis of a patch, m.
    #[inline(always)]
    pub fn place(&self, patch: &Patch) -> (DVec3, DVec3) {
        let arm = patch.point - self.body.properties.center;
        (self.body.position + self.frame * arm, self.frame * patch.axis)
    }

    /// Does a patch face and see where a wind comes from?
    #[inline(always)]
    pub fn open(&self, index: usize, from: Upwind) -> bool {
        let patch = &self.feeler.patches[index];
        let (point, axis) = self.place(patch);
        open(self.occluders, &self.feeler.hints[index], patch.face, point, axis, from)
    }
}

/// Does a patch face and see where a wind comes from?
pub(crate) fn open(
    occluders: &Occluders,
    hint: &Cell<Hint>,
    face: Face,
    point: DVec3,
    axis: DVec3,
    from: Upwind,
) -> bool {
    let toward = match from {
        Upwind::Place(place) => place - point,
        Upwind::Afar(direction) => direction,
        Upwind::Everywhere => return true,
    };
    let facing = axis.dot(toward);
    let lift = match face {
        Face::Side if facing <= 0.0 => return false,
        Face::Side | Face::Sheet => axis * (RAY_START * facing.signum()),
        Face::Wire => DVec3::ZERO,
    };
    let start = point + lift;
    let (direction, far) = match from {
        Upwind::Place(place) => {
            let way = place - start;
            let far = way.length();
            (way / far, far)
        }
        _ => (toward, FAR),
    };
    !occluders.block(start, direction, far, hint)
}
