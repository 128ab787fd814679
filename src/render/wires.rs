//! Wires, and curves of charts, as capsule segments, cut at their joints by the bisecting planes.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

use soffio_exhibit::Wire;
use soffio_exhibit::chart::Chart;
use soffio_math::{DVec3, Pose};
use soffio_simulation::{CURVE_POINTS, CurveView};

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

/// Perceptual roughness of a curve: ink on a board.
const CURVE_ROUGHNESS: f32 = 0.6;

/// Most segments of all wires and curves.
pub(super) fn count(wires: &[Wire], charts: &[Chart]) -> usize {
    let of_wires: usize = wires.iter().map(|wire| wire.points.len().saturating_sub(1)).sum();
    let curves: usize = charts.iter().map(|chart| chart.curves.len()).sum();
    of_wires + curves * (CURVE_POINTS - 1)
}

/// Adds all wires at these poses. Bodies without a pose are at `rest`.
pub(super) fn add(wires: &[Wire], rest: &[Pose], poses: &[Pose], segments: &mut Vec<Segment>) {
    for wire in wires {
        let pose = match wire.body {
            None => Pose::IDENTITY,
            Some(body) => *poses.get(body).unwrap_or(&rest[body]),
        };
        let line =
            Line { radius: wire.radius as f32, metallic: wire.metallic, color: wire.color, roughness: wire.roughness };
        line.add(wire.points.len(), |i| pose.point(wire.points[i]).as_vec3(), segments);
    }
}

/// Adds the curves on the boards of these charts.
pub(super) fn add_curves(charts: &[Chart], curves: &[CurveView], segments: &mut Vec<Segment>) {
    for curve in curves {
        let Some(Chart { pose, size, radius, .. }) = charts.get(curve.chart) else { continue };
        let line = Line { radius: *radius, metallic: 0.0, color: curve.color, roughness: CURVE_ROUGHNESS };
        let point = |i: usize| {
            let [x, y] = curve.points[i].map(f64::from);
            // On the board, not in it.
            pose.point(DVec3::new(x * size[0], y * size[1], f64::from(*radius))).as_vec3()
        };
        line.add(curve.points.len().min(CURVE_POINTS), point, segments);
    }
}

/// Sorts segments, the farthest from the camera first.
pub(super) fn sort(segments: &mut [Segment], eye: Vec3) {
    let distance = |s: &Segment| (0.5 * (s.a + s.b).truncate() - eye).length_squared();
    segments.sort_unstable_by(|x, y| distance(y).total_cmp(&distance(x)));
}

/// Look of a line through points.
struct Line {
    radius: f32,
    metallic: f32,
    color: [f32; 3],
    roughness: f32,
}

impl Line {
    /// Adds the line through `count` points.
    fn add(&self, count: usize, point: impl Fn(usize) -> Vec3, segments: &mut Vec<Segment>) {
        let color = Vec3::from_array(self.color).extend(self.roughness);
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
                a: a.extend(self.radius),
                b: b.extend(self.metallic),
                color,
                cut_a: cut(before),
                cut_b: cut(after),
            });
        }
    }
}
