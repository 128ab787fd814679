//! Mesh deformation at rest: morph targets at their weights (glTF 2.0, 3.7.2.2) and linear blend skinning at the pose
//! of the joints (3.7.3.3).
//!
//! Bodies are rigid, so deformed meshes are computed once: `p = Σ wⱼ Jⱼ Iⱼ (p₀ + Σ ωₜ dₜ)`, with J the transform from
//! joint node to world and I its inverse bind matrix. The result is stored in the frame of the node that shows it.
//! Where bodies carry the joints, or key frames change a scale or the weights ω, the renderer applies the same formula
//! in each frame. For this, [`bind`] keeps p₀ + Σ ωₜ dₜ (or p₀ and the d where the ω change), and the four largest
//! weights w.

use gltf::Semantic;
use gltf::accessor::Dimensions::{Mat4, Vec3, Vec4};

use super::accessor::{self, ModelError};
use super::fault::{Cause, Fault};
use super::mesh::{Influences, MorphTarget, Primitive};
use super::primitive::MAX_TARGETS;
use super::scene::Node;
use soffio_math::{DMat3, DMat4, DVec3};

/// Is the node's mesh deformed by a skin or by morph targets?
pub fn deforms(node: &gltf::Node) -> bool {
    let weights = weights(node);
    let morphs = node.mesh().is_some_and(|m| m.primitives().any(|p| p.morph_targets().next().is_some()));
    node.skin().is_some() || (morphs && weights.iter().any(|w| *w != 0.0))
}

fn weights(node: &gltf::Node) -> Vec<f32> {
    let own = node.weights().filter(|w| !w.is_empty());
    own.or_else(|| node.mesh().and_then(|m| m.weights())).unwrap_or_default().to_vec()
}

/// Deforms `out` for `node`; `out` is the primitive as stored, before flat normals.
///
/// # Errors
/// Joints, weights or morph targets are invalid.
pub fn deform(
    node: &gltf::Node,
    source: &gltf::Primitive,
    nodes: &[Node],
    buffers: &[Vec<u8>],
    out: &mut Primitive,
) -> Result<(), ModelError> {
    morph(node, source, buffers, out)?;
    if let Some(skin) = node.skin() {
        pose(&skin, source, nodes[node.index()].world, nodes, buffers, out)?;
    }
    for normal in &mut out.normals {
        *normal = DVec3::from(normal.map(f64::from)).try_normalize().unwrap_or(DVec3::Y).as_vec3().to_array();
    }
    Ok(())
}

/// The undeformed primitive of a skin or of animated morph targets (`morphs`), from `out`, the primitive as stored,
/// before flat normals.
///
/// # Errors
/// Joints, weights or morph targets are invalid.
pub fn bind(
    node: &gltf::Node,
    morphs: bool,
    source: &gltf::Primitive,
    buffers: &[Vec<u8>],
    out: &mut Primitive,
) -> Result<(), ModelError> {
    if morphs {
        out.targets = source
            .morph_targets()
            .take(MAX_TARGETS)
            .map(|target| {
                Ok(MorphTarget {
                    positions: differences(target.positions(), out.positions.len(), buffers, POSITIONS)?,
                    normals: differences(target.normals(), out.normals.len(), buffers, NORMALS)?,
                    tangents: differences(target.tangents(), out.tangents.len(), buffers, TANGENTS)?,
                })
            })
            .collect::<Result<_, ModelError>>()?;
    } else {
        morph(node, source, buffers, out)?;
    }
    let Some(skin) = node.skin() else { return Ok(()) };
    let joints = skin.joints().count();
    let mut all: Vec<Vec<(u16, f32)>> = vec![Vec::new(); out.positions.len()];
    skin_weights(source, all.len(), buffers, |corner, joint, share| {
        let index =
            u16::try_from(joint).ok().filter(|_| joint < joints).ok_or_else(|| Fault::new(Cause::Joint, NO_JOINT))?;
        all[corner].push((index, share));
        Ok(())
    })?;
    out.influences = all.into_iter().map(strongest_influences).collect();
    Ok(())
}

/// The four strongest influences, normalised to the sum 1.
fn strongest_influences(mut all: Vec<(u16, f32)>) -> Influences {
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    all.truncate(4);
    let total: f32 = all.iter().map(|(_, share)| share).sum();
    std::array::from_fn(|i| {
        all.get(i).filter(|_| total > 0.0).map_or((0, 0.0), |(joint, share)| (*joint, share / total))
    })
}

/// Adds the morph targets at their weights.
fn morph(
    node: &gltf::Node,
    source: &gltf::Primitive,
    buffers: &[Vec<u8>],
    out: &mut Primitive,
) -> Result<(), ModelError> {
    let weights = weights(node);
    for (target, weight) in source.morph_targets().take(MAX_TARGETS).zip(&weights) {
        if !weight.is_finite() {
            return Err(Fault::new(Cause::NotFinite, "a morph weight is not finite"));
        }
        let positions = differences(target.positions(), out.positions.len(), buffers, POSITIONS)?;
        add(*weight, &positions, &mut out.positions);
        let normals = differences(target.normals(), out.normals.len(), buffers, NORMALS)?;
        add(*weight, &normals, &mut out.normals);
        let tangents = differences(target.tangents(), out.tangents.len(), buffers, TANGENTS)?;
        add(*weight, &tangents, &mut out.tangents);
    }
    Ok(())
}

const POSITIONS: &str = "morphed positions";
const NORMALS: &str = "morphed normals";
const TANGENTS: &str = "morphed tangents";

/// The differences of a target for a list of `count` vectors; `None` where there is no such list. A primitive without
/// normals gets flat ones afterwards.
fn differences(
    source: Option<gltf::Accessor>,
    count: usize,
    buffers: &[Vec<u8>],
    what: &str,
) -> Result<Vec<[f32; 3]>, ModelError> {
    let Some(source) = source.filter(|_| count > 0) else { return Ok(Vec::new()) };
    let differences = accessor::vectors::<3>(&source, buffers, &[Vec3], 0.0)?;
    if differences.len() == count {
        Ok(differences)
    } else {
        Err(Fault::new(Cause::Count, format_args!("{what} differ in number")))
    }
}

/// Adds weighted differences; the sign of a tangent stays.
fn add<const LANES: usize>(weight: f32, differences: &[[f32; 3]], to: &mut [[f32; LANES]]) {
    for (to, difference) in to.iter_mut().zip(differences) {
        for (to, difference) in to.iter_mut().zip(difference) {
            *to += weight * difference;
        }
    }
}

const NO_JOINT: &str = "a vertex names a joint that the skin does not have";

/// The inverse bind matrix of each joint of a skin.
///
/// # Errors
/// The accessor is invalid, or has fewer matrices than the skin has joints.
pub fn inverse_bind(skin: &gltf::Skin, buffers: &[Vec<u8>]) -> Result<Vec<DMat4>, ModelError> {
    let joints = skin.joints().count();
    let Some(inverse) = skin.inverse_bind_matrices() else { return Ok(vec![DMat4::IDENTITY; joints]) };
    let inverse = accessor::vectors::<16>(&inverse, buffers, &[Mat4], 0.0)?;
    if inverse.len() < joints {
        return Err(Fault::new(Cause::Count, "a skin has fewer inverse bind matrices than joints"));
    }
    Ok(inverse.iter().take(joints).map(|matrix| DMat4::from_cols_array(&matrix.map(f64::from))).collect())
}

/// Reports each non-zero skin weight: vertex, joint and weight.
fn skin_weights(
    source: &gltf::Primitive,
    corners: usize,
    buffers: &[Vec<u8>],
    mut report: impl FnMut(usize, usize, f32) -> Result<(), ModelError>,
) -> Result<(), ModelError> {
    for set in 0.. {
        let (Some(joints), Some(skin_weights)) =
            (source.get(&Semantic::Joints(set)), source.get(&Semantic::Weights(set)))
        else {
            break;
        };
        let joints = accessor::vectors::<4>(&joints, buffers, &[Vec4], 0.0)?;
        let skin_weights = accessor::vectors::<4>(&skin_weights, buffers, &[Vec4], 0.0)?;
        if joints.len() != corners || skin_weights.len() != corners {
            return Err(Fault::new(Cause::Count, "joints, weights and positions differ in number"));
        }
        for (corner, (joints, skin_weights)) in joints.iter().zip(&skin_weights).enumerate() {
            for (joint, share) in joints.iter().zip(skin_weights).filter(|(_, share)| **share != 0.0) {
                report(corner, *joint as usize, *share)?;
            }
        }
    }
    Ok(())
}

fn pose(
    skin: &gltf::Skin,
    source: &gltf::Primitive,
    world_from_node: DMat4,
    nodes: &[Node],
    buffers: &[Vec<u8>],
    out: &mut Primitive,
) -> Result<(), ModelError> {
    let node_from_world = world_from_node.inverse();
    if !node_from_world.is_finite() {
        return Err(Fault::new(Cause::Size, "a skinned node has a scale of zero"));
    }
    let mut matrices: Vec<DMat4> = skin.joints().map(|joint| node_from_world * nodes[joint.index()].world).collect();
    for (matrix, inverse) in matrices.iter_mut().zip(inverse_bind(skin, buffers)?) {
        *matrix *= inverse;
    }
    let mut blended = vec![DMat4::ZERO; out.positions.len()];
    let mut total = vec![0.0; blended.len()];
    skin_weights(source, total.len(), buffers, |corner, joint, share| {
        blended[corner] += *matrices.get(joint).ok_or_else(|| Fault::new(Cause::Joint, NO_JOINT))? * f64::from(share);
        total[corner] += f64::from(share);
        Ok(())
    })?;
    for (i, matrix) in blended.iter().enumerate().filter(|(i, _)| total[*i] > 0.0) {
        // Rounded weights do not sum to one.
        let matrix = *matrix * (1.0 / total[i]);
        out.positions[i] = matrix.transform_point3(DVec3::from(out.positions[i].map(f64::from))).as_vec3().to_array();
        let turn = DMat3::from_mat4(matrix);
        let cofactor = DMat3::from_cols(
            turn.y_axis.cross(turn.z_axis),
            turn.z_axis.cross(turn.x_axis),
            turn.x_axis.cross(turn.y_axis),
        );
        if let Some(normal) = out.normals.get_mut(i) {
            *normal = (cofactor * DVec3::from(normal.map(f64::from))).as_vec3().to_array();
        }
        if let Some(tangent) = out.tangents.get_mut(i) {
            let along =
                (turn * DVec3::new(tangent[0].into(), tangent[1].into(), tangent[2].into())).normalize_or_zero();
            *tangent = [along.x as f32, along.y as f32, along.z as f32, tangent[3]];
        }
    }
    Ok(())
}
