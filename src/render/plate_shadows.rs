//! Analytic soft shadows of flat plates on wall and floor.
//!
//! A flat plate is its outline, with holes, between two heights over its middle plane. Seen from a lamp it is bounded
//! by the rim of its far side where the rim faces the lamp, and by that of its near side elsewhere. Each frame finds
//! that line for each lamp, and the rectangle of wall and floor that its shadow can reach. In each texel
//! `plate_shadows.wgsl` computes the fraction of the lamp's disc that the plate covers.
//!
//! Approximations: the outline has at most [`MAX_EDGES`] edges and differs from the plate's by at most
//! [`OUTLINE_TOLERANCE`], with the same area. The line is that of the lamp's centre; its error is the plate's thickness
//! times the lamp's angular size. Two plates that cover parts of a lamp count as independent, 1 − (1 − a)(1 − b); the
//! true value lies between max(a, b) and min(a + b, 1), at most ¼ away.

use std::collections::BTreeMap;
use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3, Vec4};

use super::gallery::Lamp;
use super::outlines::{Edge, Plate};
use super::shadows::ReceivingPlane;

/// Texels along a row of the texture with the rims: a whole number of 256-byte rows, which copies to textures need.
pub(super) const RIM_ROW: u32 = 256;
/// Most edges of a plate, its holes' included: each texel of a shadow tests all of them.
const MAX_EDGES: usize = 96;
/// Largest deviation of the outline from the plate's, and of a rim from a plane, m. Chosen by eye: no difference shows
/// in a penumbra.
const OUTLINE_TOLERANCE: f32 = 0.0005;
/// Tolerances of outline simplification, m, the coarsest first; the first whose result is within [`OUTLINE_TOLERANCE`]
/// is used.
const SIMPLIFY_TOLERANCES: [f32; 4] = [0.0008, 0.0006, 0.0004, 0.0002];
/// Sine of the slope from which a face counts as facing up or down: 3°.
const MIN_FACING_SINE: f32 = 0.05;
/// Largest relative difference of the areas within both rims; beyond it the piece is no flat plate.
const AREA_TOLERANCE: f32 = 0.02;

/// A flat plate prepared for shadows, in the frame of its body.
pub(super) struct ShadowPlate {
    frame: usize,
    /// Unit axes; the outlines lie in the plane of the first two.
    axes: [Vec3; 3],
    /// Outlines, m: counter-clockwise about the third axis around the plate, clockwise around its holes.
    loops: Vec<Vec<Vec2>>,
    /// Heights of the two rims along the third axis, m.
    heights: [f32; 2],
}

/// The part of a wall or floor that one plate and one lamp can shade, in the layout of `plate_shadows.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct ShadowInstance {
    /// Lowest and highest texture coordinates.
    bounds: [f32; 4],
    /// First point of the rim, number of points, index of the lamp, 0.
    rim: [u32; 4],
}

/// The plate shadows of a frame.
pub(super) struct PlateShadows {
    plates: Vec<ShadowPlate>,
    lamps: [Lamp; 2],
    planes: [ReceivingPlane; 2],
    /// Points along the rims, world, m; w is 1 at the first point of a line. Each line ends at its first point.
    pub points: Vec<Vec4>,
    /// Instances on the wall, then on the floor.
    pub instances: Vec<ShadowInstance>,
    /// Number of instances on the wall.
    on_wall: u32,
    /// Range of the points of each plate and lamp.
    rims: Vec<Range<usize>>,
}

impl ShadowPlate {
    /// The shadow plate of a plate; `None` where it is not flat or has too many edges.
    pub fn of(plate: &Plate) -> Option<Self> {
        let normal = plate.normal;
        let (x, y) = normal.any_orthonormal_pair();
        let axes = [x, y, normal];
        let slope = |face: u16| plate.normals[usize::from(face)].dot(normal);
        let upper = chains(&plate.edges, |face| slope(face) > MIN_FACING_SINE)?;
        let lower = chains(&plate.edges, |face| slope(face) < -MIN_FACING_SINE)?;
        let height = |chains: &[Vec<u16>]| {
            let heights = chains.iter().flatten().map(|&i| plate.corners[usize::from(i)].dot(normal));
            let (low, high) = heights.fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
            (high - low <= OUTLINE_TOLERANCE).then_some(0.5 * (low + high))
        };
        let heights = [height(&lower)?, height(&upper)?];
        let flat = |chain: &Vec<u16>| -> Vec<Vec2> {
            chain.iter().map(|&i| plate.corners[usize::from(i)]).map(|p| Vec2::new(p.dot(x), p.dot(y))).collect()
        };
        let [lower, upper] = [lower, upper].map(|chains| chains.iter().map(flat).collect::<Vec<_>>());
        let [below, above] = [&lower, &upper].map(|loops| loops.iter().map(|points| area(points)).sum::<f32>());
        if above <= 0.0 || (above + below).abs() > AREA_TOLERANCE * above {
            return None;
        }
        let loops = SIMPLIFY_TOLERANCES.iter().find_map(|&reach| {
            let fewer: Vec<_> = upper.iter().map(|points| simplified(points, reach)).collect();
            let near = upper
                .iter()
                .zip(&fewer)
                .all(|(points, fewer)| points.iter().all(|&p| distance_to_outline(p, fewer) <= OUTLINE_TOLERANCE));
            near.then_some(fewer)
        })?;
        if loops.iter().map(Vec::len).sum::<usize>() > MAX_EDGES {
            return None;
        }
        Some(Self { frame: plate.frame, axes, loops, heights })
    }

    /// Number of its edges.
    fn edges(&self) -> usize {
        self.loops.iter().map(Vec::len).sum()
    }

    /// Adds the line that bounds it as seen from a light at `eye`, world, m.
    fn rim(&self, frame: &[Vec4; 3], eye: Vec3, points: &mut Vec<Vec4>) {
        let moved = frame.map(|row| row.truncate());
        let off = eye - Vec3::from_array(frame.map(|row| row.w));
        let eye = moved[0] * off.x + moved[1] * off.y + moved[2] * off.z;
        let [x, y, z] = self.axes;
        let [low, high] = self.heights;
        let above = eye.dot(z) > 0.5 * (low + high);
        let eye = Vec2::new(eye.dot(x), eye.dot(y));
        let mut point = |at: Vec2, height: f32, begins: bool| {
            let place = (x * at.x + y * at.y + z * height).extend(1.0);
            points.push(Vec3::from_array(frame.map(|row| row.dot(place))).extend(if begins { 1.0 } else { 0.0 }));
        };
        for corners in &self.loops {
            let count = corners.len();
            // The height of the line at the edge from corner k on.
            let height = |k: usize| {
                let (a, b) = (corners[k % count], corners[(k + 1) % count]);
                let towards = (b - a).perp_dot(eye - a) < 0.0;
                if towards == above { low } else { high }
            };
            let mut now = height(0);
            point(corners[0], now, true);
            for k in 1..=count {
                point(corners[k % count], now, false);
                let next = height(k);
                if next != now {
                    point(corners[k % count], next, false);
                    now = next;
                }
            }
        }
    }
}

impl PlateShadows {
    /// The plates of a scene under the lamps of its gallery, without shadows yet.
    pub fn new(shadow_plates: Vec<ShadowPlate>, lamps: [Lamp; 2], planes: [ReceivingPlane; 2]) -> Self {
        // The line can change between rims at each corner, and its first point is repeated.
        let most = |shadow_plate: &ShadowPlate| 2 * shadow_plate.edges() + 2 * shadow_plate.loops.len();
        let points = lamps.len() * shadow_plates.iter().map(most).sum::<usize>();
        Self {
            points: Vec::with_capacity(points.next_multiple_of(RIM_ROW as usize).max(RIM_ROW as usize)),
            instances: Vec::with_capacity(lamps.len() * planes.len() * shadow_plates.len()),
            on_wall: 0,
            rims: Vec::with_capacity(lamps.len() * shadow_plates.len()),
            plates: shadow_plates,
            lamps,
            planes,
        }
    }

    /// Has the exhibit no plate that is shadowed analytically?
    pub fn is_empty(&self) -> bool {
        self.plates.is_empty()
    }

    /// Rows of the texture with the rims.
    pub fn rows(&self) -> u32 {
        self.points.capacity() as u32 / RIM_ROW
    }

    /// Largest number of instances.
    pub fn max_instances(&self) -> usize {
        self.instances.capacity()
    }

    /// The instances on a plane: 0 the wall, 1 the floor.
    pub fn instances_on(&self, plane: usize) -> Range<u32> {
        if plane == 0 { 0..self.on_wall } else { self.on_wall..self.instances.len() as u32 }
    }

    /// Finds the shadows for the poses of a frame.
    pub fn update(&mut self, frames: &[[Vec4; 3]]) {
        self.points.clear();
        self.rims.clear();
        for shadow_plate in &self.plates {
            for lamp in &self.lamps {
                let first = self.points.len();
                shadow_plate.rim(&frames[shadow_plate.frame], lamp.position, &mut self.points);
                self.rims.push(first..self.points.len());
            }
        }
        self.instances.clear();
        for (index, plane) in self.planes.iter().enumerate() {
            for (k, rim) in self.rims.iter().enumerate() {
                let lamp = k % self.lamps.len();
                if let Some(bounds) = bounds(plane, &self.lamps[lamp], &self.points[rim.clone()]) {
                    self.instances
                        .push(ShadowInstance { bounds, rim: [rim.start as u32, rim.len() as u32, lamp as u32, 0] });
                }
            }
            if index == 0 {
                self.on_wall = self.instances.len() as u32;
            }
        }
        // Whole rows are uploaded.
        self.points.resize(self.points.len().next_multiple_of(RIM_ROW as usize), Vec4::ZERO);
    }
}

/// The rectangle of a plane, in texture coordinates, that these points can shade from a lamp; `None` where they shade
/// none of it.
fn bounds(plane: &ReceivingPlane, lamp: &Lamp, points: &[Vec4]) -> Option<[f32; 4]> {
    let light = lamp.position - plane.origin;
    let d = light.dot(plane.normal);
    let height = |point: &Vec4| (point.truncate() - plane.origin).dot(plane.normal);
    if points.iter().all(|point| height(point) <= 0.0) {
        return None;
    }
    let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    for point in points {
        let p = point.truncate() - plane.origin;
        // Points behind the plane cast their shadow at their own foot, points beside the lamp beyond the gallery.
        let h = height(point).max(0.0);
        let rest = (d - h - lamp.radius).max(0.05 * d);
        let foot = light + (p - light) * (d / (d - h).max(0.05 * d));
        let slope = (p - light) / rest;
        let along = |axis: Vec3| Vec2::new(slope.dot(axis), 1.0).length();
        let reach = Vec2::new(along(plane.u), along(plane.v)) * (lamp.radius * h / rest);
        let at = Vec2::new(foot.dot(plane.u), foot.dot(plane.v));
        low = low.min(at - reach);
        high = high.max(at + reach);
    }
    let (low, high) = ((low / plane.size).max(Vec2::ZERO), (high / plane.size).min(Vec2::ONE));
    (low.x < high.x && low.y < high.y).then_some([low.x, low.y, high.x, high.y])
}

/// The closed lines around the faces for which `inside` holds; `None` where two of them meet at a corner.
fn chains(edges: &[Edge], inside: impl Fn(u16) -> bool) -> Option<Vec<Vec<u16>>> {
    let mut next = BTreeMap::new();
    for edge in edges {
        let [f, g] = edge.faces.map(&inside);
        if f != g {
            let (a, b) = if f { (edge.a, edge.b) } else { (edge.b, edge.a) };
            if next.insert(a, b).is_some() {
                return None;
            }
        }
    }
    let mut chains = Vec::new();
    while let Some((first, mut at)) = next.pop_first() {
        let mut chain = vec![first];
        while at != first {
            chain.push(at);
            at = next.remove(&at)?;
        }
        chains.push(chain);
    }
    Some(chains)
}

/// Signed area within a closed line.
fn area(points: &[Vec2]) -> f32 {
    0.5 * sides(points).map(|(a, b)| (a - points[0]).perp_dot(b - points[0])).sum::<f32>()
}

fn sides(points: &[Vec2]) -> impl Iterator<Item = (Vec2, Vec2)> {
    (0..points.len()).map(|k| (points[k], points[(k + 1) % points.len()]))
}

/// Distance of a point from a closed line.
fn distance_to_outline(p: Vec2, line: &[Vec2]) -> f32 {
    sides(line).map(|(a, b)| distance_to_segment(p, a, b)).fold(f32::INFINITY, f32::min)
}

fn distance_to_segment(p: Vec2, a: Vec2, b: Vec2) -> f32 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
    p.distance(a + t * along)
}

/// A closed line without the corners that lie within `reach` of the rest (Douglas and Peucker 1973), offset so that its
/// area stays the same.
fn simplified(points: &[Vec2], reach: f32) -> Vec<Vec2> {
    let far = (0..points.len())
        .max_by(|&i, &j| points[i].distance_squared(points[0]).total_cmp(&points[j].distance_squared(points[0])));
    let Some(far) = far.filter(|&far| far > 0) else { return points.to_vec() };
    let mut keep = vec![false; points.len() + 1];
    let at = |k: usize| points[k % points.len()];
    let mut open = vec![(0, far), (far, points.len())];
    while let Some((from, to)) = open.pop() {
        keep[from] = true;
        let off = |k: usize| distance_to_segment(at(k), at(from), at(to));
        let worst = (from + 1..to).max_by(|&i, &j| off(i).total_cmp(&off(j)));
        if let Some(worst) = worst.filter(|&k| off(k) > reach) {
            open.extend([(from, worst), (worst, to)]);
        }
    }
    let fewer: Vec<Vec2> = points.iter().zip(&keep).filter(|(_, keep)| **keep).map(|(p, _)| *p).collect();
    let around: f32 = sides(&fewer).map(|(a, b)| a.distance(b)).sum();
    let lost = (area(points) - area(&fewer)) / around.max(f32::MIN_POSITIVE);
    (0..fewer.len()).map(|k| fewer[k] + lost * corner_normal(&fewer, k)).collect()
}

/// Offset of a corner when both its sides move outwards by one, at most two.
fn corner_normal(line: &[Vec2], k: usize) -> Vec2 {
    let count = line.len();
    let outwards = |a: Vec2, b: Vec2| -(b - a).normalize_or_zero().perp();
    let before = outwards(line[(k + count - 1) % count], line[k]);
    let after = outwards(line[k], line[(k + 1) % count]);
    let middle = (before + after).normalize_or_zero();
    middle / middle.dot(before).max(0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outline_with_fewer_corners_keeps_its_area_and_its_place() {
        // Second-order error of the mitres, largest for an octagon.
        const SAME: f32 = 5e-3;
        let circle = |radius: f32| -> Vec<Vec2> {
            (0..96).map(|k| radius * Vec2::from_angle(k as f32 / 96.0 * std::f32::consts::TAU)).collect()
        };
        for radius in [0.01, 0.05, 0.15] {
            let points = circle(radius);
            for reach in SIMPLIFY_TOLERANCES {
                let fewer = simplified(&points, reach);
                assert!((area(&fewer) / area(&points) - 1.0).abs() < SAME, "{radius} m, {reach} m");
                assert!(points.iter().all(|&p| distance_to_outline(p, &fewer) <= reach), "{radius} m, {reach} m");
                assert!(reach < SIMPLIFY_TOLERANCES[0] || fewer.len() <= 32, "{radius} m: {} corners", fewer.len());
            }
        }
        let square = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
        assert_eq!(simplified(&square, 0.01), square);
    }

    #[test]
    fn lines_around_faces_run_with_them_and_end_where_they_begin() {
        // Two triangles of a square face up, its other side has one that faces down.
        let edge = |a, b, f, g| Edge { a, b, faces: [f, g] };
        let edges = [edge(0, 1, 0, 2), edge(1, 2, 0, 2), edge(2, 0, 0, 1), edge(2, 3, 1, 2), edge(3, 0, 1, 2)];
        assert_eq!(chains(&edges, |face| face < 2), Some(vec![vec![0, 1, 2, 3]]));
        assert_eq!(chains(&edges, |face| face == 2), Some(vec![vec![0, 3, 2, 1]]));
    }
}
