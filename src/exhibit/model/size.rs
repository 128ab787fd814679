//! Sizes that a museum can hold. Models come in millimetres or inches, and exporters write infinite scales; both would make
//! a picture of nothing, and numbers that later products cannot hold.
//!
//! Bounds: a point of the world is at most 1 km from the origin. No hall of a museum is longer, and single precision still
//! resolves 0.06 mm there. A unit of a mesh is from a nanometre (positions as 16-bit integers of a jewel) to 10⁹ m, or
//! exactly 0, which hides a mesh (glTF 2.0, section 3.5.2). Areas of a mesh, products of two coordinates, stay finite.

use super::accessor::ModelError;
use super::animation::Track;
use super::fault::{Cause, Fault, Faults};
use super::mesh::Mesh;
use super::scene::Node;
use soffio_math::{DMat4, DVec3};

/// Greatest distance of a point from the origin along an axis of the world, m.
pub const MAX_DISTANCE: f64 = 1000.0;
/// Least and greatest world length of a unit of a mesh, m.
pub const UNIT: [f64; 2] = [1e-9, 1e9];
/// Greatest coordinate of a mesh in its own units, and greatest value or tangent of an animation.
pub const MAX_COORDINATE: f64 = 1e9;
/// Longest animation, s: 11 days, longer than any exhibit runs without a reset.
pub const MAX_TIME: f64 = 1e6;

/// Are all positions of an accessor's mesh within the bound?
///
/// # Errors
/// The first that is not.
pub fn positions(positions: &[[f32; 3]], accessor: usize) -> Result<(), ModelError> {
    let beyond = |p: &[f32; 3]| p.iter().any(|x| !x.is_finite() || f64::from(x.abs()) > MAX_COORDINATE);
    match positions.iter().position(beyond) {
        Some(vertex) => {
            let what =
                format_args!("vertex {vertex} is at {:?}; coordinates go to {MAX_COORDINATE:e}", positions[vertex]);
            Err(Fault::at(Cause::Size, format_args!("accessors[{accessor}]"), what))
        }
        None => Ok(()),
    }
}

/// Are the keys of a channel within the bounds?
///
/// # Errors
/// The first time or value that is not.
pub fn keys(times: &[f64], track: &Track, cubic: bool) -> Result<(), ModelError> {
    if let Some(last) = times.last().filter(|last| **last > MAX_TIME) {
        return Err(Fault::new(
            Cause::Size,
            format_args!("its last key is at {last:e} s; animations go to {MAX_TIME:e} s"),
        ));
    }
    // Cubic channels hold tangents beside their values.
    let reach = |value: DVec3, index: usize, bound: f64| {
        value.abs().max_element() > if cubic && index % 3 != 1 { MAX_COORDINATE } else { bound }
    };
    let beyond = match track {
        Track::Translation(values) => values.iter().enumerate().position(|(i, v)| reach(*v, i, MAX_DISTANCE)),
        Track::Scale(values, ..) => values.iter().enumerate().position(|(i, v)| reach(*v, i, UNIT[1])),
        Track::Rotation(values) => values.iter().position(|q| q.length() > MAX_COORDINATE),
        Track::Weights(keys) => keys.iter().position(|key| key.iter().any(|w| w.abs() > MAX_COORDINATE)),
    };
    match beyond {
        Some(index) => Err(Fault::new(
            Cause::Size,
            format_args!(
                "value {index} is too large; translations go to {MAX_DISTANCE} m, other values to {MAX_COORDINATE:e}"
            ),
        )),
        None => Ok(()),
    }
}

/// World lengths of a node's units.
fn units(world: &DMat4) -> [f64; 3] {
    [world.x_axis, world.y_axis, world.z_axis].map(|axis| axis.truncate().length())
}

/// Reports nodes whose place, scale or mesh is beyond the bounds.
pub fn check(nodes: &[Node], meshes: &[Mesh], faults: &mut Faults) {
    let bounds: Vec<Option<(DVec3, DVec3)>> = meshes.iter().map(extents).collect();
    for (index, node) in nodes.iter().enumerate() {
        let place = format!("nodes[{index}]");
        let name = &node.name;
        let at = node.world.w_axis.truncate();
        if !node.world.is_finite() || at.abs().max_element() > MAX_DISTANCE {
            let what = format_args!(
                "node \"{name}\" is at {:.3e} m along an axis of the world; positions go to {MAX_DISTANCE} m",
                at.abs().max_element()
            );
            faults.add(Cause::Size, place, what);
            continue;
        }
        if let Some(unit) =
            units(&node.world).into_iter().find(|&unit| unit != 0.0 && !(UNIT[0]..=UNIT[1]).contains(&unit))
        {
            let what = format_args!(
                "node \"{name}\" has the scale {unit:.3e} in the world; scales go from {:e} to {:e}",
                UNIT[0], UNIT[1]
            );
            faults.add(Cause::Size, place, what);
            continue;
        }
        let Some((low, high)) = node.mesh.and_then(|mesh| bounds[mesh]) else { continue };
        let far = (0..8_u32)
            .map(|i| DVec3::select(glam_mask(i), low, high))
            .map(|corner| node.world.transform_point3(corner).abs().max_element())
            .fold(0.0, f64::max);
        if far > MAX_DISTANCE {
            let what = format_args!(
                "the mesh of node \"{name}\" reaches {far:.3e} m from the origin; it may reach {MAX_DISTANCE} m"
            );
            faults.add(Cause::Size, place, what);
        }
    }
}

/// Picks the low or the high side along each axis.
fn glam_mask(corner: u32) -> glam::BVec3 {
    glam::BVec3::new(corner & 1 == 0, corner & 2 == 0, corner & 4 == 0)
}

/// Box around a mesh; `None` where it is empty.
fn extents(mesh: &Mesh) -> Option<(DVec3, DVec3)> {
    let points =
        mesh.primitives.iter().flat_map(|primitive| &primitive.positions).map(|p| DVec3::from(p.map(f64::from)));
    points.fold(None, |found, p| match found {
        Some((low, high)) => Some((low.min(p), high.max(p))),
        None => Some((p, p)),
    })
}
