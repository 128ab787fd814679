//! Flat normals where a file has none.

use super::mesh::Primitive;
use soffio_math::DVec3;

/// Gives a primitive without normals flat ones, as glTF 2.0 requires (3.7.2.1): no two triangles share a vertex.
pub fn flatten(primitive: &mut Primitive) {
    let positions = std::mem::take(&mut primitive.positions);
    let pick = |list: &mut Vec<[f32; 2]>, indices: &[u32]| {
        *list = if list.is_empty() { Vec::new() } else { indices.iter().map(|&i| list[i as usize]).collect() };
    };
    let indices = std::mem::take(&mut primitive.indices);
    pick(&mut primitive.uvs, &indices);
    pick(&mut primitive.second_uvs, &indices);
    let colors = std::mem::take(&mut primitive.colors);
    if !colors.is_empty() {
        primitive.colors = indices.iter().map(|&i| colors[i as usize]).collect();
    }
    let influences = std::mem::take(&mut primitive.influences);
    if !influences.is_empty() {
        primitive.influences = indices.iter().map(|&i| influences[i as usize]).collect();
    }
    for target in &mut primitive.targets {
        (target.normals, target.tangents) = (Vec::new(), Vec::new());
        target.positions = match target.positions.as_slice() {
            [] => Vec::new(),
            shared => indices.iter().map(|&i| shared[i as usize]).collect(),
        };
    }
    primitive.flat = true;
    // Tangents without normals are meaningless (3.7.2.1).
    primitive.tangents.clear();
    primitive.positions = indices.iter().map(|&i| positions[i as usize]).collect();
    primitive.normals = Vec::with_capacity(primitive.positions.len());
    for corner in primitive.positions.chunks_exact(3) {
        let [a, b, c] = [corner[0], corner[1], corner[2]].map(|p| DVec3::from(p.map(f64::from)));
        let normal = (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Y).as_vec3().to_array();
        primitive.normals.extend([normal; 3]);
    }
    primitive.indices = (0..primitive.positions.len() as u32).collect();
}
