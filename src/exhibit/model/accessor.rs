//! glTF accessors as plain numbers. Every view, stride and count is checked before a byte is read.
//!
//! The decoder reads integer and normalised positions (KHR_mesh_quantization), sparse accessors, and those without a view,
//! which are zeros (glTF 2.0, section 3.6.2). A file with wrong lengths gives a message instead of a panic.

use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::View;

use super::fault::{Cause, Fault};

/// Most elements of one accessor.
const MAX_COUNT: usize = 16_000_000;
/// Most elements of one accessor without a view: a short file can claim any number of zeros.
const MAX_ZEROS: usize = 2_000_000;
/// Most bytes of one accessor when decoded.
const MAX_BYTES: usize = 256 << 20;

/// A fault of an accessor, or of what reads it.
pub type ModelError = Fault;

/// The JSON path of an accessor.
fn place(accessor: &gltf::Accessor) -> String {
    format!("accessors[{}]", accessor.index())
}

/// What a buffer without data is read as.
const ZEROS: [u8; 64] = [0; 64];

/// Bytes of the view's element `index`, `size` bytes long; zeros where its buffer has no data at all.
fn element<'b>(buffers: &'b [Vec<u8>], view: &View, offset: usize, index: usize, size: usize) -> Option<&'b [u8]> {
    let stride = view.stride().unwrap_or(size);
    let inside = index.checked_mul(stride)?.checked_add(offset)?;
    if inside.checked_add(size)? > view.length() {
        return None;
    }
    let start = view.offset().checked_add(inside)?;
    match buffers.get(view.buffer().index())?.as_slice() {
        [] => ZEROS.get(..size),
        buffer => buffer.get(start..start.checked_add(size)?),
    }
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

/// Bytes of an accessor when decoded, by its stated count.
pub fn decoded_bytes(accessor: &gltf::Accessor) -> u64 {
    let element = accessor.dimensions().multiplicity() * size_of::<f32>();
    (accessor.count() as u64).saturating_mul(element as u64)
}

/// The number of elements, within the limits.
fn count_of(accessor: &gltf::Accessor, lane_bytes: usize) -> Result<usize, ModelError> {
    let count = accessor.count();
    let most = if accessor.view().is_some() { MAX_COUNT } else { MAX_ZEROS }.min(MAX_BYTES / lane_bytes.max(1));
    if count > most {
        return Err(Fault::at(
            Cause::Limit,
            format_args!("{}.count", place(accessor)),
            format_args!("is {count}; the limit is {most}"),
        ));
    }
    Ok(count)
}

/// Has the accessor no data, so that it is all zeros?
pub fn is_empty(accessor: &gltf::Accessor, buffers: &[Vec<u8>]) -> bool {
    let missing = |view: View| buffers.get(view.buffer().index()).is_none_or(Vec::is_empty);
    accessor.sparse().is_none() && accessor.view().is_none_or(missing)
}

/// The view's data is not in the file, although its lengths agree.
fn no_data(accessor: &gltf::Accessor, view: &View) -> ModelError {
    let buffer = view.buffer().index();
    Fault::at(Cause::ShortBuffer, place(accessor), format_args!("reads buffers[{buffer}], whose data is not there"))
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
    if !allowed.contains(&accessor.dimensions()) {
        let what = format_args!("is {:?}, which does not fit its use", accessor.dimensions());
        return Err(Fault::at(Cause::Format, format_args!("{}.type", place(accessor)), what));
    }
    let count = count_of(accessor, size_of::<[f32; LANES]>())?;
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
    let mut out = match accessor.view() {
        Some(view) => (0..count)
            .map(|i| {
                let bytes = element(buffers, &view, accessor.offset(), i, size);
                bytes.map(decode).ok_or_else(|| no_data(accessor, &view))
            })
            .collect::<Result<Vec<_>, _>>()?,
        None => vec![decode(&ZEROS[..size.min(64)]); count],
    };
    replace(accessor, buffers, size, |index, bytes| match out.get_mut(index) {
        Some(slot) => {
            *slot = decode(bytes);
            true
        }
        None => false,
    })?;
    match out.iter().position(|element| element.iter().any(|x| !x.is_finite())) {
        Some(index) => {
            let what = format_args!("holds a number that is not finite, in element {index}");
            Err(Fault::at(Cause::NotFinite, place(accessor), what))
        }
        None => Ok(out),
    }
}

/// Reports each entry of a sparse accessor: the index of an element and its bytes. `put` returns whether it exists.
fn replace(
    accessor: &gltf::Accessor,
    buffers: &[Vec<u8>],
    size: usize,
    mut put: impl FnMut(usize, &[u8]) -> bool,
) -> Result<(), ModelError> {
    let Some(sparse) = accessor.sparse() else { return Ok(()) };
    let (indices, values) = (sparse.indices(), sparse.values());
    let index_size = match indices.index_type() {
        gltf::accessor::sparse::IndexType::U8 => 1,
        gltf::accessor::sparse::IndexType::U16 => 2,
        gltf::accessor::sparse::IndexType::U32 => 4,
    };
    for i in 0..sparse.count().min(accessor.count()) {
        let at = element(buffers, &indices.view(), indices.offset(), i, index_size)
            .ok_or_else(|| no_data(accessor, &indices.view()))?;
        let value = element(buffers, &values.view(), values.offset(), i, size)
            .ok_or_else(|| no_data(accessor, &values.view()))?;
        let index = unsigned(at);
        if !put(index as usize, value) {
            let what = format_args!("replaces element {index}, but the accessor has {}", accessor.count());
            return Err(Fault::at(Cause::Index, format_args!("{}.sparse.indices", place(accessor)), what));
        }
    }
    Ok(())
}

fn unsigned(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |word, &byte| (word << 8) | u32::from(byte))
}

/// Indices of triangles, points or lines, each below `vertices`.
///
/// # Errors
/// An index is not below `vertices`, or the accessor does not lie within its buffer.
pub fn indices(accessor: &gltf::Accessor, buffers: &[Vec<u8>], vertices: usize) -> Result<Vec<u32>, ModelError> {
    let size = accessor.data_type().size();
    let unsigned_kind = matches!(accessor.data_type(), DataType::U8 | DataType::U16 | DataType::U32);
    if accessor.dimensions() != Dimensions::Scalar || !unsigned_kind {
        return Err(Fault::at(
            Cause::Format,
            place(accessor),
            "is used as indices and does not hold unsigned integers",
        ));
    }
    let count = count_of(accessor, size_of::<u32>())?;
    let mut out: Vec<u32> = match accessor.view() {
        Some(view) => (0..count)
            .map(|i| {
                element(buffers, &view, accessor.offset(), i, size)
                    .map(unsigned)
                    .ok_or_else(|| no_data(accessor, &view))
            })
            .collect::<Result<_, _>>()?,
        None => vec![0; count],
    };
    replace(accessor, buffers, size, |index, bytes| match out.get_mut(index) {
        Some(slot) => {
            *slot = unsigned(bytes);
            true
        }
        None => false,
    })?;
    let restart = u32::MAX >> (32 - 8 * size as u32);
    match out.iter().position(|&index| index as usize >= vertices || index == restart) {
        Some(at) if out[at] == restart => {
            let what = format_args!("is {restart} at entry {at}: glTF has no restarting of strips");
            Err(Fault::at(Cause::Vertex, place(accessor), what))
        }
        Some(at) => {
            let what = format_args!("names vertex {} at entry {at}; there are {vertices}", out[at]);
            Err(Fault::at(Cause::Vertex, place(accessor), what))
        }
        None => Ok(out),
    }
}
