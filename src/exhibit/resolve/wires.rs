//! Resolves wires and cords: polylines in the frame of the body that carries them.

use super::super::diagnostic::Diagnostic;
use super::super::sidecar::{self, Color, Point, Points};
use super::super::{Wire, codes};
use super::context::Context;
use soffio_math::{DVec3, pow};

/// Segments of a smooth wire between two of its points.
const SUBDIVISIONS: usize = 8;

/// Memory of a point of a wire, bytes: of the wire, its wind surface and its colliders (a capsule with its material and name).
const POINT_BYTES: u64 = 512;

impl Context<'_> {
    /// All wires that could be resolved.
    pub(super) fn wires(&mut self) -> Vec<Wire> {
        let sidecar = self.sidecar;
        let mut wires: Vec<Wire> = Vec::new();
        for (i, given) in sidecar.wire.iter().enumerate() {
            let at = format!("/wire/{i}");
            self.unique(
                &given.name,
                wires.iter().map(|w| w.name.as_str()).any(|n| n == given.name),
                &format!("{at}/name"),
            );
            if let Some(wire) = self.wire(given, &at) {
                wires.push(wire);
            }
        }
        wires
    }

    /// Reports a duplicate name.
    pub(super) fn unique(&mut self, name: &str, taken: bool, at: &str) {
        if taken {
            let problem = Diagnostic::new(codes::DUPLICATE_NAME, format!("the name \"{name}\" is taken"));
            self.report(at, problem.help("choose another: names must be unique within a kind"));
        }
    }

    fn wire(&mut self, given: &sidecar::Wire, at: &str) -> Option<Wire> {
        let used_for = format!("wire \"{}\"", given.name);
        let material = self.material(&given.material, &format!("{at}/material"));
        let node = match &given.body {
            Some(name) => Some(self.node(name, &format!("{at}/body"), &used_for)?),
            None => None,
        };
        let body = node.and_then(|n| self.owner[n]);
        if let (Some(node), None) = (node, body) {
            // A fixed node carries the wire in its own space, which is allowed.
            let name = &self.model.nodes[node].name;
            let source = format!("glTF node {name}, which is fixed");
            self.record_origin(&format!("wire {}", given.name), "body", "the world".into(), "/-", &source);
        }
        let mut points = self.wire_points(node, &given.points, &format!("{at}/points"), &used_for)?;
        let stored = points.len() * if given.smooth { SUBDIVISIONS } else { 1 };
        if !self.afford(stored as u64 * POINT_BYTES, &used_for, &format!("{at}/points")) {
            return None;
        }
        points.dedup();
        if points.len() < 2 {
            let problem = Diagnostic::new(codes::WRONG_SHAPE, format!("{used_for} has no length"));
            self.report(&format!("{at}/points"), problem.help("give at least two different points"));
            return None;
        }
        if given.smooth {
            points = catmull_rom(&points);
        }
        let radius = match (given.radius, given.diameter) {
            (Some(radius), None) => self.positive(radius.0, &format!("{at}/radius")),
            (None, Some(diameter)) => 0.5 * self.positive(diameter.0, &format!("{at}/diameter")),
            _ => {
                let problem =
                    Diagnostic::new(codes::MISSING_KEY, format!("{used_for} needs either a radius or a diameter"));
                self.report(at, problem.help("add radius = \"1 mm\""));
                return None;
            }
        };
        Some(Wire {
            name: given.name.clone(),
            body,
            points,
            radius,
            material: material?,
            color: given.color.as_ref().map_or([0.3, 0.3, 0.31], linear),
            metallic: given.metallic.unwrap_or(1.0),
            roughness: given.roughness.unwrap_or(0.35),
        })
    }

    /// The line through all points, in the frame of the body of `node`; `None` where one of them is wrong.
    fn wire_points(&mut self, node: Option<usize>, points: &Points, at: &str, used_for: &str) -> Option<Vec<DVec3>> {
        match points {
            Points::Named(pattern) => {
                let marker_nodes = self.marker_nodes(node, pattern, at, used_for)?;
                Some(marker_nodes.into_iter().map(|mark| self.anchor(mark, DVec3::ZERO).point).collect())
            }
            Points::Listed(points) => {
                let resolved: Vec<Option<DVec3>> = (points.iter().enumerate())
                    .map(|(i, point)| self.wire_point(node, point, &format!("{at}/{i}"), used_for))
                    .collect();
                resolved.into_iter().collect()
            }
        }
    }

    fn wire_point(&mut self, node: Option<usize>, point: &Point, at: &str, used_for: &str) -> Option<DVec3> {
        match (node, point) {
            (Some(node), point) => self.point(node, Some(point), at, used_for).map(|anchor| anchor.point),
            (None, point) => self.fixed_point(point, at, used_for),
        }
    }

    /// A point of the world, or the position of a fixed node.
    pub(super) fn fixed_point(&mut self, point: &Point, at: &str, used_for: &str) -> Option<DVec3> {
        match point {
            Point::Position(p) => Some(DVec3::from(p.map(|x| x.0))),
            Point::Node(name) => {
                let mark = self.node(name, at, used_for)?;
                if self.owner[mark].is_some() {
                    let body = self.body_name(self.owner[mark]);
                    let message = format!("node \"{name}\" moves with {body}, but {used_for} must be fixed");
                    let help = "name a fixed node, or give [x, y, z]; a wire takes body = \"…\"";
                    self.report(at, Diagnostic::new(codes::NOT_DESCENDANT, message).help(help));
                    return None;
                }
                Some(self.model.nodes[mark].world.transform_point3(DVec3::ZERO))
            }
        }
    }
}

/// A uniform Catmull–Rom spline through the points (Catmull and Rom, 1974), its ends mirrored.
fn catmull_rom(points: &[DVec3]) -> Vec<DVec3> {
    let last = points.len() - 1;
    let at = |i: isize| match usize::try_from(i) {
        Ok(i) if i <= last => points[i],
        Ok(_) => 2.0 * points[last] - points[last - 1],
        Err(_) => 2.0 * points[0] - points[1],
    };
    let mut out = vec![points[0]];
    for segment in 0..last {
        let i = segment as isize;
        let [p0, p1, p2, p3] = [at(i - 1), at(i), at(i + 1), at(i + 2)];
        for step in 1..=SUBDIVISIONS {
            let t = step as f64 / SUBDIVISIONS as f64;
            let cubic = 3.0 * (p1 - p2) + p3 - p0;
            let square = 2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3;
            out.push(p1 + 0.5 * t * ((p2 - p0) + t * (square + t * cubic)));
        }
    }
    out
}

/// Linear RGB of a colour; the transfer function of sRGB (IEC 61966-2-1).
pub(super) fn linear(color: &Color) -> [f32; 3] {
    match color {
        Color::Linear(rgb) => *rgb,
        Color::Hex(text) => {
            let byte = |i: usize| u8::from_str_radix(text.get(i..i + 2).unwrap_or("00"), 16).unwrap_or(0);
            [byte(1), byte(3), byte(5)].map(|b| {
                let v = f64::from(b) / 255.0;
                (if v <= 0.04045 { v / 12.92 } else { pow((v + 0.055) / 1.055, 2.4) }) as f32
            })
        }
    }
}
