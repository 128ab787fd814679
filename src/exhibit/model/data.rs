//! The data of accessors, once buffers are there: finite numbers, stated bounds, and what attributes promise (unit normals,
//! weights that sum to 1).
//!
//! Numbers that are not finite are errors. Others are normalised or clamped when they are used, so they are warnings.

use std::collections::BTreeSet;

use gltf::accessor::Dimensions;
use gltf::json::Value;
use gltf::{Accessor, Semantic};

use super::accessor;
use super::fault::{Cause, Faults};

/// Largest difference of a length or a sum from 1 without a warning: the Khronos validator's tolerance for unit vectors
/// stored in bytes is of this size, and single precision is far below it.
const UNIT: f32 = 0.005;

/// Checks all accessors and what reads them.
pub fn check(document: &gltf::Document, buffers: &[Vec<u8>], faults: &mut Faults) {
    for accessor in document.accessors() {
        bounds(&accessor, buffers, faults);
    }
    let mut seen: BTreeSet<(usize, String)> = BTreeSet::new();
    for mesh in document.meshes() {
        for primitive in mesh.primitives() {
            let place = format!("meshes[{}].primitives[{}]", mesh.index(), primitive.index());
            for (semantic, accessor) in primitive.attributes() {
                let name = semantic.to_string();
                if seen.insert((accessor.index(), name.clone())) {
                    attribute(&semantic, &accessor, buffers, &format!("{place}.attributes.{name}"), faults);
                }
            }
            influences(&primitive, buffers, &place, faults);
            if let Some(indices) = primitive.indices() {
                let vertices = primitive.get(&Semantic::Positions).map_or(usize::MAX, |positions| positions.count());
                if let Err(fault) = accessor::indices(&indices, buffers, vertices) {
                    faults.push(fault.within(format_args!("{place}.indices")));
                }
            }
        }
    }
    for skin in document.skins() {
        let Some(matrices) = skin.inverse_bind_matrices() else { continue };
        let Ok(matrices) = accessor::vectors::<16>(&matrices, buffers, &[Dimensions::Mat4], 0.0) else { continue };
        let row = |m: &[f32; 16]| [m[3], m[7], m[11], m[15]] != [0.0, 0.0, 0.0, 1.0];
        if let Some(joint) = matrices.iter().position(row) {
            let what = format_args!("matrix {joint} has a last row other than 0, 0, 0, 1; it is not used");
            faults.add(Cause::Harmless, format_args!("skins[{}].inverseBindMatrices", skin.index()), what);
        }
    }
    for animation in document.animations() {
        for (index, channel) in animation.channels().enumerate() {
            let sampler = channel.sampler();
            if channel.target().property() != gltf::animation::Property::Rotation {
                continue;
            }
            let Ok(values) = accessor::vectors::<4>(&sampler.output(), buffers, &[Dimensions::Vec4], 0.0) else {
                continue;
            };
            let cubic = sampler.interpolation() == gltf::animation::Interpolation::CubicSpline;
            let value = |i: &usize| !cubic || i % 3 == 1;
            if let Some(key) = (0..values.len()).filter(value).find(|&i| !is_unit(&values[i])) {
                let place = format!("animations[{}].channels[{index}].sampler", animation.index());
                faults.add(
                    Cause::Harmless,
                    place,
                    format_args!("rotation {key} is not of length 1; it is scaled to it"),
                );
            }
        }
    }
}

fn is_unit(v: &[f32]) -> bool {
    (v.iter().map(|x| x * x).sum::<f32>().sqrt() - 1.0).abs() <= UNIT
}

/// Numbers are finite, and least and greatest are those stated.
fn bounds(accessor: &Accessor, buffers: &[Vec<u8>], faults: &mut Faults) {
    if accessor::is_empty(accessor, buffers) {
        return;
    }
    let any = [
        Dimensions::Scalar,
        Dimensions::Vec2,
        Dimensions::Vec3,
        Dimensions::Vec4,
        Dimensions::Mat2,
        Dimensions::Mat3,
        Dimensions::Mat4,
    ];
    let found = match accessor.dimensions() {
        Dimensions::Scalar => extremes(accessor::vectors::<1>(accessor, buffers, &any, 0.0)),
        Dimensions::Vec2 => extremes(accessor::vectors::<2>(accessor, buffers, &any, 0.0)),
        Dimensions::Vec3 => extremes(accessor::vectors::<3>(accessor, buffers, &any, 0.0)),
        Dimensions::Vec4 => extremes(accessor::vectors::<4>(accessor, buffers, &any, 0.0)),
        // Columns of small matrices are padded; nothing here reads them.
        _ => return,
    };
    match found {
        Err(fault) => faults.push(fault),
        Ok([low, high]) => {
            for (key, stated, real) in [("min", accessor.min(), low), ("max", accessor.max(), high)] {
                // Stated bounds are of the stored numbers, not of normalised ones.
                let stated = stated.filter(|_| !accessor.normalized());
                let numbers = stated.as_ref().and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
                let differs = |(stated, real): (&Value, &f32)| stated.as_f64().is_some_and(|x| x as f32 != *real);
                if let Some(lane) = numbers.iter().zip(&real).position(differs) {
                    let what = format_args!("is {}, and the data's is {}; the data counts", numbers[lane], real[lane]);
                    faults.add(Cause::Harmless, format_args!("accessors[{}].{key}[{lane}]", accessor.index()), what);
                }
            }
        }
    }
}

/// Least and greatest of each component.
fn extremes<const LANES: usize>(
    values: Result<Vec<[f32; LANES]>, accessor::ModelError>,
) -> Result<[Vec<f32>; 2], accessor::ModelError> {
    let start = ([f32::INFINITY; LANES], [f32::NEG_INFINITY; LANES]);
    let (low, high) = values?.iter().fold(start, |(mut low, mut high), value| {
        for lane in 0..LANES {
            (low[lane], high[lane]) = (low[lane].min(value[lane]), high[lane].max(value[lane]));
        }
        (low, high)
    });
    Ok([low.to_vec(), high.to_vec()])
}

fn attribute(semantic: &Semantic, accessor: &Accessor, buffers: &[Vec<u8>], place: &str, faults: &mut Faults) {
    let wrong = match semantic {
        Semantic::Normals => {
            let values = accessor::vectors::<3>(accessor, buffers, &[Dimensions::Vec3], 0.0).unwrap_or_default();
            values.iter().position(|v| !is_unit(v)).map(|i| (i, "is not of length 1; it is scaled to it"))
        }
        Semantic::Tangents => {
            let values = accessor::vectors::<4>(accessor, buffers, &[Dimensions::Vec4], 0.0).unwrap_or_default();
            let wrong = |v: &[f32; 4]| !is_unit(&v[..3]) || v[3].abs() != 1.0;
            values.iter().position(wrong).map(|i| (i, "is not of length 1 with a sign of 1 or −1"))
        }
        Semantic::Colors(_) => {
            let allowed = [Dimensions::Vec3, Dimensions::Vec4];
            let values = accessor::vectors::<4>(accessor, buffers, &allowed, 1.0).unwrap_or_default();
            let wrong = |v: &[f32; 4]| v.iter().any(|x| !(0.0..=1.0).contains(x));
            values.iter().position(wrong).map(|i| (i, "is not from 0 to 1"))
        }
        _ => None,
    };
    // Zeros without a view hold no data that could be wrong.
    if let Some((vertex, what)) = wrong.filter(|_| !accessor::is_empty(accessor, buffers)) {
        faults.add(Cause::Harmless, place, format_args!("that of vertex {vertex} {what}"));
    }
}

/// Weights are not negative and sum to 1; a vertex names a joint once.
fn influences(primitive: &gltf::Primitive, buffers: &[Vec<u8>], place: &str, faults: &mut Faults) {
    let vectors = |accessor: Option<Accessor>| {
        accessor::vectors::<4>(
            &accessor.filter(|a| !accessor::is_empty(a, buffers))?,
            buffers,
            &[Dimensions::Vec4],
            0.0,
        )
        .ok()
    };
    let (mut joints, mut weights) = (Vec::<Vec<[f32; 4]>>::new(), Vec::<Vec<[f32; 4]>>::new());
    for set in 0.. {
        let read = (vectors(primitive.get(&Semantic::Joints(set))), vectors(primitive.get(&Semantic::Weights(set))));
        let (Some(j), Some(w)) = read else { break };
        joints.push(j);
        weights.push(w);
    }
    let vertices = weights.iter().map(Vec::len).min().unwrap_or(0);
    for vertex in 0..vertices {
        let all: Vec<(f32, f32)> = joints
            .iter()
            .zip(&weights)
            .filter_map(|(j, w)| Some((j.get(vertex)?, w.get(vertex)?)))
            .flat_map(|(j, w)| j.iter().copied().zip(w.iter().copied()))
            .collect();
        let total: f32 = all.iter().map(|(_, weight)| weight).sum();
        let used: Vec<u32> = all.iter().filter(|(_, weight)| *weight != 0.0).map(|(joint, _)| *joint as u32).collect();
        let what = if all.iter().any(|(_, weight)| *weight < 0.0) {
            "is negative"
        } else if (total - 1.0).abs() > UNIT && total != 0.0 {
            "does not sum to 1; it is scaled to it"
        } else if used.iter().enumerate().any(|(i, joint)| used[..i].contains(joint)) {
            "names a joint twice; the sum counts"
        } else {
            continue;
        };
        faults.add(
            Cause::Harmless,
            format_args!("{place}.attributes.WEIGHTS_0"),
            format_args!("that of vertex {vertex} {what}"),
        );
        return;
    }
}
