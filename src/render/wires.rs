//! Wires as capsule segments, cut at their joints by the bisecting planes.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

use soffio_exhibit::Wire;
use soffio_math::Pose;

/// A straight segment of a wire, in the world, in the layout of `wires.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Segment {
    /// One end, m, and the radius.
    a: Vec4,
    /// Other end, m, and the metalness.
    b: Vec4,
    /// Linear colour and roughness.
    color: Vec4,
    /// Normal, into the segment, of the plane that cuts it at `a`; w is 1 where the wire ends there.
    cut_a: Vec4,
    /// The same at `b`.
    cut_b: Vec4,
}

/// Number of segments of all wires.
pub(super) fn count(wires: &[Wire]) -> usize {
    wires.iter().map(|wire| wire.points.len().saturating_sub(1)).sum()
}

/// Fills `segments` with all wires at these poses, the farthest from the camera first. Bodies without a pose are at
/// `rest`.
pub(super) fn fill(wires: &[Wire], rest: &[Pose], poses: &[Pose], eye: Vec3, segments: &mut Vec<Segment>) {
    segments.clear();
    for wire in wires {
        let pose = match wire.body {
            None => Pose::IDENTITY,
            Some(body) => *poses.get(body).unwrap_or(&rest[body]),
        };
        let point = |i: usize| pose.point(wire.points[i]).as_vec3();
        let color = Vec3::from_array(wire.color).extend(wire.roughness);
        let count = wire.points.len();
        for i in 1..count {
            let (a, b) = (point(i - 1), point(i));
            let along = (b - a).normalize_or_zero();
            // The bisecting plane of a joint has the sum of both directions as its normal.
            let cut = |neighbour: Option<Vec3>| match neighbour {
                Some(direction) => (along + direction).normalize_or(along).extend(0.0),
                None => along.extend(1.0),
            };
            let before = (i >= 2).then(|| (a - point(i - 2)).normalize_or_zero());
            let after = (i + 1 < count).then(|| (point(i + 1) - b).normalize_or_zero());
            segments.push(Segment {
                a: a.extend(wire.radius as f32),
                b: b.extend(wire.metallic),
                color,
                cut_a: cut(before),
                cut_b: cut(after),
            });
        }
    }
    let distance = |s: &Segment| (0.5 * (s.a + s.b).truncate() - eye).length_squared();
    segments.sort_unstable_by(|x, y| distance(y).total_cmp(&distance(x)));
}
