//! Colliders and wires as MuJoCo geoms.

use std::fmt::Write;

use super::{named, numbers, quaternion};
use soffio_exhibit::{Exhibit, Wire};
use soffio_geometry::support::Core;
use soffio_math::{DQuat, DVec3, Pose, tangents};
use soffio_multibody::collision::Shape;

/// Ends of a wire segment nearer than this are one point, m.
const SAME_POINT: f64 = 1e-6;

/// The geoms of a body (`None` is the world), one line each; adds the meshes that they use.
pub(super) fn geoms(exhibit: &Exhibit, body: Option<usize>, indent: &str, meshes: &mut String) -> String {
    let mut out = String::new();
    for (index, collider) in exhibit.colliders.iter().enumerate().filter(|(_, c)| c.body == body) {
        let name = format!("geom {index} {}", collider.node);
        let shape = shape(&collider.shape, &name, meshes);
        let _ = writeln!(out, "{indent}<geom {} {shape} class=\"collider\"/>", named(&name));
    }
    for wire in exhibit.wires.iter().filter(|wire| wire.body == body) {
        for (a, b) in wire.points.iter().zip(wire.points.iter().skip(1)).filter(|(a, b)| a.distance(**b) > SAME_POINT) {
            let _ = writeln!(out, "{indent}<geom {} class=\"wire\"/>", segment(wire, *a, *b));
        }
    }
    out
}

fn segment(wire: &Wire, a: DVec3, b: DVec3) -> String {
    let [r, g, b_] = wire.color;
    format!(
        "type=\"capsule\" fromto=\"{} {}\" size=\"{}\" rgba=\"{r} {g} {b_} 1\"",
        numbers(&a.to_array()),
        numbers(&b.to_array()),
        wire.radius
    )
}

/// Type, size and pose attributes of a geom.
fn shape(shape: &Shape, name: &str, meshes: &mut String) -> String {
    let r = shape.radius;
    // MuJoCo's cylinder axis is z, ours y.
    let upright = DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2);
    let turned = Pose { rotation: shape.place.rotation * upright, position: shape.place.position };
    let placed = |kind: &str, size: &[f64], at: &Pose| {
        let (pos, quat) = (numbers(&at.position.to_array()), quaternion(at.rotation));
        format!("type=\"{kind}\" size=\"{}\" pos=\"{pos}\" quat=\"{quat}\"", numbers(size))
    };
    match &shape.core {
        Core::Point => placed("sphere", &[r], &shape.place),
        Core::Segment { half } => placed("capsule", &[r, *half], &turned),
        Core::Box { half } => placed("box", &(*half + r).to_array(), &shape.place),
        Core::Cylinder { half, radius } => placed("cylinder", &[radius + r, half + r], &turned),
        // Half sizes 0 mean infinite; the third number is the spacing of the grid in the viewer.
        Core::HalfSpace => placed("plane", &[0.0, 0.0, 0.1], &turned),
        Core::Hull(hull) => {
            let corners = padded(hull.corners(), r, &shape.place);
            let list: Vec<f64> = corners.iter().flat_map(|p| p.to_array()).collect();
            let _ = writeln!(meshes, "    <mesh {} vertex=\"{}\"/>", named(name), numbers(&list));
            format!("type=\"mesh\" mesh=\"{}\"", super::escaped(name))
        }
    }
}

/// Vertices of the hull with its sphere radius: both faces of a plate, or the corners of a body pushed outwards.
fn padded(corners: &[DVec3], radius: f64, place: &Pose) -> Vec<DVec3> {
    let points: Vec<DVec3> = corners.iter().map(|p| place.point(*p)).collect();
    if radius == 0.0 && normal(&points).is_none() {
        return points;
    }
    let along = match normal(&points) {
        Some(normal) => vec![normal],
        None => vec![DVec3::X, DVec3::Y, DVec3::Z],
    };
    points.iter().flat_map(|p| along.iter().flat_map(|n| [*p + *n * radius, *p - *n * radius])).collect()
}

/// Normal of points that lie in one plane.
fn normal(points: &[DVec3]) -> Option<DVec3> {
    /// Relative thickness below which points count as coplanar.
    const FLAT: f64 = 1e-6;
    let first = *points.first()?;
    let far = points.iter().copied().max_by(|a, b| a.distance(first).total_cmp(&b.distance(first)))?;
    let along = (far - first).try_normalize()?;
    let across = |p: &DVec3| along.cross(*p - first);
    let wide = points.iter().map(across).max_by(|a, b| a.length().total_cmp(&b.length()))?;
    let normal = wide.try_normalize().unwrap_or_else(|| tangents(along).0);
    let size = far.distance(first);
    points.iter().all(|p| (*p - first).dot(normal).abs() <= FLAT * size).then_some(normal)
}
