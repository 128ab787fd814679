//! Wires, cords, and curves of charts, as capsule segments, cut at their joints by the bisecting planes.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

use soffio_exhibit::chart::Chart;
use soffio_exhibit::{Cord, Exhibit, Wire};
use soffio_math::{DVec3, Pose};
use soffio_simulation::{CURVE_POINTS, CurveView};

/// A straight segment of a wire, in the world, in the layout of `wires.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Segment {
    /// One end, m, and the radius.
    pub a: Vec4,
    /// Other end, m, and the metalness.
    pub b: Vec4,
    /// Linear colour and roughness.
    pub color: Vec4,
    /// Normal, into the segment, of the plane that cuts it at `a`; w is 1 where the wire ends there.
    pub cut_a: Vec4,
    /// The same at `b`.
    pub cut_b: Vec4,
}

/// Perceptual roughness of a curve: ink on a board.
const CURVE_ROUGHNESS: f32 = 0.6;

/// The wires, cords and charts of an exhibit.
pub(super) struct Lines {
    wires: Vec<Wire>,
    cords: Vec<Cord>,
    charts: Vec<Chart>,
}

impl Lines {
    /// Those of an exhibit.
    pub(super) fn new(exhibit: &Exhibit) -> Self {
        Self { wires: exhibit.wires.clone(), cords: exhibit.cords.clone(), charts: exhibit.charts.clone() }
    }

    /// Most segments of all of them.
    pub(super) fn count(&self) -> usize {
        let points = self.wires.iter().map(|wire| wire.points.len()).chain(self.cords.iter().map(|c| c.points.len()));
        let curves: usize = self.charts.iter().map(|chart| chart.curves.len()).sum();
        points.map(|points| points.saturating_sub(1)).sum::<usize>() + curves * (CURVE_POINTS - 1)
    }

    /// Fills `segments` with all of them at these poses, the farthest from the camera first. Bodies without a pose are at
    /// `rest`.
    pub(super) fn fill(
        &self,
        rest: &[Pose],
        poses: &[Pose],
        curves: &[CurveView],
        eye: Vec3,
        segments: &mut Vec<Segment>,
    ) {
        segments.clear();
        let pose = |body: usize| *poses.get(body).unwrap_or(&rest[body]);
        for wire in &self.wires {
            let pose = wire.body.map_or(Pose::IDENTITY, pose);
            let look =
                Look { radius: wire.radius, color: wire.color, metallic: wire.metallic, roughness: wire.roughness };
            look.draw(wire.points.len(), |i| pose.point(wire.points[i]).as_vec3(), segments);
        }
        for cord in &self.cords {
            let look = Look { radius: cord.radius, color: cord.color, metallic: 0.0, roughness: cord.roughness };
            look.draw(cord.points.len(), |i| cord.point(i, pose).as_vec3(), segments);
        }
        for curve in curves {
            let Some(Chart { pose, size, radius, .. }) = self.charts.get(curve.chart) else { continue };
            let thickness = f64::from(*radius);
            let look = Look { radius: thickness, color: curve.color, metallic: 0.0, roughness: CURVE_ROUGHNESS };
            let point = |i: usize| {
                let [x, y] = curve.points[i].map(f64::from);
                // On the board, not in it.
                pose.point(DVec3::new(x * size[0], y * size[1], thickness)).as_vec3()
            };
            look.draw(curve.points.len().min(CURVE_POINTS), point, segments);
        }
        let distance = |s: &Segment| (0.5 * (s.a + s.b).truncate() - eye).length_squared();
        segments.sort_unstable_by(|x, y| distance(y).total_cmp(&distance(x)));
    }
}

/// How a line looks.
struct Look {
    /// m.
    radius: f64,
    /// Linear RGB.
    color: [f32; 3],
    metallic: f32,
    roughness: f32,
}

impl Look {
    /// Adds the segments of a line of `count` points (world, m).
    fn draw(&self, count: usize, point: impl Fn(usize) -> Vec3, segments: &mut Vec<Segment>) {
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
                a: a.extend(self.radius as f32),
                b: b.extend(self.metallic),
                color,
                cut_a: cut(before),
                cut_b: cut(after),
            });
        }
    }
}
