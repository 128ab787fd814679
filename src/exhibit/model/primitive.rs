//! Mesh primitives: vertex attributes as lists of equal length, and separate triangles from any topology.

use gltf::Semantic;
use gltf::accessor::Dimensions::{Vec2, Vec3, Vec4};
use gltf::mesh::Mode;

use super::fault::{Cause, Fault};
use super::mesh::Primitive;
use super::{accessor, flat, size};

/// Most morph targets of one primitive.
pub const MAX_TARGETS: usize = 256;

/// Does it consist of triangles?
pub fn is_drawn(primitive: &gltf::Primitive) -> bool {
    !matches!(primitive.mode(), Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip)
}

/// Number of morph targets of a node's mesh: that of its first primitive, as all have the same.
pub fn targets(node: &gltf::Node) -> usize {
    let first = node.mesh().and_then(|mesh| mesh.primitives().next());
    first.map_or(0, |primitive| primitive.morph_targets().take(MAX_TARGETS).count())
}

/// Bytes of a primitive when decoded, by the stated counts of its accessors. Twice: the dressed model is a copy of the loaded one.
pub fn decoded_bytes(primitive: &gltf::Primitive) -> u64 {
    /// Models that exist at once.
    const MODELS: u64 = 2;
    /// Bytes of a vertex at most, without morph targets: all lists of [`Primitive`] but the indices.
    const VERTEX: u64 = 12 + 12 + 16 + 8 + 8 + 16 + 32;
    let Some(positions) = primitive.get(&Semantic::Positions) else { return 0 };
    let lists = primitive.attributes().map(|(_, list)| accessor::decoded_bytes(&list)).fold(0, u64::saturating_add);
    let targets = primitive
        .morph_targets()
        .take(MAX_TARGETS)
        .flat_map(|target| [target.positions(), target.normals(), target.tangents()].into_iter().flatten());
    let targets = targets.map(|list| accessor::decoded_bytes(&list)).fold(0, u64::saturating_add);
    let listed = primitive.indices().map_or(positions.count(), |indices| indices.count()) as u64;
    // A strip has nearly as many triangles as indices.
    let corners = if primitive.mode() == Mode::Triangles { listed } else { listed.saturating_mul(3) };
    // Without normals every corner becomes a vertex of its own.
    let flat = primitive.get(&Semantic::Normals).is_none();
    let own = if flat { corners.saturating_mul(VERTEX) } else { 0 };
    let indices = corners.saturating_mul(size_of::<u32>() as u64);
    MODELS.saturating_mul(lists.saturating_add(targets).saturating_add(own).saturating_add(indices))
}

/// Decodes a primitive; `deform` can change it before flat normals are made. Without positions it is empty (glTF 2.0, section
/// 3.7.2.1: it is not drawn).
///
/// # Errors
/// An accessor is invalid, or `deform` fails.
pub fn decode(
    primitive: &gltf::Primitive,
    buffers: &[Vec<u8>],
    deform: impl FnOnce(&mut Primitive) -> Result<(), accessor::ModelError>,
) -> Result<Primitive, accessor::ModelError> {
    let Some(source) = primitive.get(&Semantic::Positions) else { return Ok(Primitive::default()) };
    let positions: Vec<[f32; 3]> = accessor::vectors(&source, buffers, &[Vec3], 0.0)?;
    size::positions(&positions, source.index())?;
    let list = match primitive.indices() {
        Some(indices) => accessor::indices(&indices, buffers, positions.len())?,
        None => (0..positions.len() as u32).collect(),
    };
    let count = positions.len();
    let same = |length: usize, what: &str| {
        if length == count {
            Ok(())
        } else {
            Err(Fault::new(Cause::Count, format_args!("{what} and positions differ in number")))
        }
    };
    let mut out = Primitive { indices: triangles(primitive.mode(), &list), ..Primitive::default() };
    out.material = primitive.material().index();
    let coordinates = |set: u32| match primitive.get(&Semantic::TexCoords(set)) {
        Some(source) => {
            let uvs = accessor::vectors(&source, buffers, &[Vec2], 0.0)?;
            same(uvs.len(), "texture coordinates").map(|()| uvs)
        }
        None => Ok(Vec::new()),
    };
    out.uvs = coordinates(0)?;
    out.second_uvs = coordinates(1)?;
    if let Some(source) = primitive.get(&Semantic::Colors(0)) {
        out.colors = accessor::vectors(&source, buffers, &[Vec3, Vec4], 1.0)?;
        same(out.colors.len(), "colours")?;
    }
    if let Some(source) = primitive.get(&Semantic::Tangents) {
        out.tangents = accessor::vectors(&source, buffers, &[Vec4], 1.0)?;
        same(out.tangents.len(), "tangents")?;
    }
    if let Some(source) = primitive.get(&Semantic::Normals) {
        out.normals = accessor::vectors(&source, buffers, &[Vec3], 0.0)?;
        same(out.normals.len(), "normals")?;
    }
    out.positions = positions;
    deform(&mut out)?;
    size::positions(&out.positions, source.index())?;
    if out.normals.is_empty() {
        flat::flatten(&mut out);
    }
    Ok(out)
}

/// Separate triangles of a strip or fan, all with the same winding.
fn triangles(mode: Mode, list: &[u32]) -> Vec<u32> {
    match mode {
        Mode::TriangleStrip => {
            let turned = |(i, t): (usize, &[u32])| if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] };
            list.windows(3).enumerate().flat_map(turned).collect()
        }
        Mode::TriangleFan => match list.split_first() {
            Some((&hub, rim)) => rim.windows(2).flat_map(|t| [hub, t[0], t[1]]).collect(),
            None => Vec::new(),
        },
        _ => list[..list.len() - list.len() % 3].to_vec(),
    }
}
