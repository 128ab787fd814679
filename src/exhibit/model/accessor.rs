//! glTF accessors as plain numbers. Every view, stride and count is checked before a byte is read.
//!
//! The decoder reads integer and normalised positions (KHR_mesh_quantization) and sparse accessors. A file with wrong
//! lengths gives a message instead of a panic.

use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::View;

/// Most elements of one accessor.
const MAX_COUNT: usize = 16_000_000;

/// A message that says what is wrong with an accessor.
pub type ModelError = String;

/// Bytes of the view's element `index`, `size` bytes long.
fn element<'b>(buffers: &'b [Vec<u8>], view: &View, offset: usize, index: usize, size: usize) -> Option<&'b [u8]> {
    let stride = view.stride().unwrap_or(size);
    let inside = index.checked_mul(stride)?.checked_add(offset)?;
    if inside.checked_add(size)? > view.length() {
        return None;
    }
    let start = view.offset().checked_add(inside)?;
    buffers.get(view.buffer().index())?.get(start..start.checked_add(size)?)
}

fn number(kind: DataType, bytes: &[u8], normalized: bool) -> f32 {
    // The slices come from `element` with the size of the kind, so each pattern matches.
    match (kind, bytes) {
        (DataType::F32, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]),
        (DataType::U32, &[a, b, c, d]) => u32::from_le_bytes([a, b, c, d]) as f32,
        (DataType::U16, &[a, b]) => f32::from(u16::from_le_bytes([a, b])) / if normalized { 65535.0 } else { 1.0 },
        (DataType::U8, &[a]) => f32::from(a) / if normalized { 255.0 } else { 1.0 },
        (DataType::I16, &[a, b]) => signed(f32::from(i16::from_le_bytes([a, b])), 32767.0, normalized),
        (DataType::I8, &[a]) => signed(f32::from(a as i8), 127.0, normalized),
        _ => 0.0,
    }
}

fn signed(value: f32, full: f32, normalized: bool) -> f32 {
    if normalized { (value / full).max(-1.0) } else { value }
}

fn count_of(accessor: &gltf::Accessor, broken: &impl Fn(&str) -> ModelError) -> Result<usize, ModelError> {
    let count = accessor.count();
    if count > MAX_COUNT {
        return Err(broken(&format!("has {count} elements; the limit is {MAX_COUNT}")));
    }
    Ok(count)
}

/// Elements of `LANES` finite numbers each. Missing lanes are filled with `fill`.
///
/// # Errors
/// The accessor has another type, does not lie within its buffer, or holds a number that is not finite.
pub fn vectors<const LANES: usize>(
    accessor: &gltf::Accessor,
    buffers: &[Vec<u8>],
    allowed: &[Dimensions],
    fill: f32,
) -> Result<Vec<[f32; LANES]>, ModelError> {
    let broken = |what: &str| format!("accessor {} {what}", accessor.index());
    if !allowed.contains(&accessor.dimensions()) {
        return Err(broken(&format!("is {:?}, which does not fit its use", accessor.dimensions())));
    }
    let count = count_of(accessor, &broken)?;
    let (kind, normalized) = (accessor.data_type(), accessor.normalized());
    let lanes = accessor.dimensions().multiplicity().min(LANES);
    let lane_size = kind.size();
    let size = lane_size * accessor.dimensions().multiplicity();
    let decode = |bytes: &[u8]| {
        let mut out = [fill; LANES];
        for (lane, chunk) in out.iter_mut().zip(bytes.chunks_exact(lane_size)).take(lanes) {
            *lane = number(kind, chunk, normalized);
        }
        out
    };
    let past_end = || broken("reads past the end of its buffer");
    let mut out = match accessor.view() {
        Some(view) => (0..count)
            .map(|i| element(buffers, &view, accessor.offset(), i, size).map(decode).ok_or_else(past_end))
            .collect::<Result<Vec<_>, _>>()?,
        None => vec![[0.0; LANES]; count],
    };
    if let Some(sparse) = accessor.sparse() {
        let (indices, values) = (sparse.indices(), sparse.values());
        let index_kind = match indices.index_type() {
            gltf::accessor::sparse::IndexType::U8 => DataType::U8,
            gltf::accessor::sparse::IndexType::U16 => DataType::U16,
            gltf::accessor::sparse::IndexType::U32 => DataType::U32,
        };
        if sparse.count() > count {
            return Err(broken("replaces more elements than it has"));
        }
        for i in 0..sparse.count() {
            let at = element(buffers, &indices.view(), indices.offset(), i, index_kind.size()).ok_or_else(past_end)?;
            let value = element(buffers, &values.view(), values.offset(), i, size).ok_or_else(past_end)?;
            let slot =
                out.get_mut(unsigned(at) as usize).ok_or_else(|| broken("replaces an element it does not have"))?;
            *slot = decode(value);
        }
    }
    if out.iter().flatten().any(|x| !x.is_finite()) {
        return Err(broken("contains numbers that are not finite"));
    }
    Ok(out)
}

fn unsigned(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |word, &byte| (word << 8) | u32::from(byte))
}

/// Indices of triangles, points or lines, each below `vertices`.
///
/// # Errors
/// An index is not below `vertices`, or the accessor does not lie within its buffer.
pub fn indices(accessor: &gltf::Accessor, buffers: &[Vec<u8>], vertices: usize) -> Result<Vec<u32>, ModelError> {
    let broken = |what: &str| format!("accessor {} {what}", accessor.index());
    let unsigned_kind = matches!(accessor.data_type(), DataType::U8 | DataType::U16 | DataType::U32);
    if accessor.dimensions() != Dimensions::Scalar || !unsigned_kind {
        return Err(broken("is used as indices and does not hold unsigned integers"));
    }
    let count = count_of(accessor, &broken)?;
    let Some(view) = accessor.view() else { return Ok(vec![0; if vertices > 0 { count } else { 0 }]) };
    let size = accessor.data_type().size();
    (0..count)
        .map(|i| {
            let bytes = element(buffers, &view, accessor.offset(), i, size)
                .ok_or_else(|| broken("reads past the end of its buffer"))?;
            let index = unsigned(bytes);
            if (index as usize) < vertices { Ok(index) } else { Err(broken("names a vertex that does not exist")) }
        })
        .collect()
}
