//! The exhibit's meshes as one vertex buffer in body frames.
//!
//! Moving parts are rigid, so each vertex is stored in the frame of the body that carries it, with scales of the scene
//! graph applied and with the index of that frame (0 is the world). A pose is then one 3×4 matrix for each body, and an
//! exhibit needs one draw for each material and pipeline.

use glam::{Mat4, Vec3};

use super::RenderError;
use super::frames::{MAX_FRAMES, rigid_of};
use super::outlines::Plate;
use super::plate_shadows::ShadowPlate;
use super::punctual::{MAX_PUNCTUAL, Punctual};
use super::skins::{BoundMesh, Skinned};
use super::vertex::Vertex;
use soffio_exhibit::Exhibit;
use soffio_exhibit::model::{AlphaMode, Appearance, Model, Primitive};

/// Blending of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum SurfaceKind {
    /// Opaque.
    Opaque,
    /// Glass: multiplies the background and adds gloss; order does not matter.
    Glass,
    /// Alpha-blended, the farthest first.
    Blend,
}

/// The properties that determine the pipeline of a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct PipelineKey {
    /// How the surface is drawn.
    pub kind: SurfaceKind,
    /// Are both sides drawn?
    pub double_sided: bool,
    /// Has it a clear coat or a sheen?
    pub layers: bool,
    /// Has it textures of material extensions?
    pub details: bool,
    /// Is it a plate with an analytic silhouette?
    pub outlined: bool,
}

/// Triangles that are drawn by one call.
#[derive(Clone, Debug)]
pub(super) struct Batch {
    /// Range in the index buffer.
    pub indices: std::ops::Range<u32>,
    /// Index of the material; one past the last is the default.
    pub material: usize,
    /// Properties that select its pipeline.
    pub pipeline: PipelineKey,
    /// Centre of the triangles in their frame, to sort blended batches.
    pub center: Vec3,
    /// Index of the frame that carries it: 0 for static batches, else one above that of the body.
    pub frame: usize,
}

/// All meshes and lights of an exhibit.
#[derive(Default)]
pub(super) struct Scene {
    /// Vertices of all meshes, each in the frame that carries it.
    pub vertices: Vec<Vertex>,
    /// Triangles, batch after batch.
    pub indices: Vec<u32>,
    /// Opaque batches first, of these the plates with analytic shadows, then glass, then blended ones.
    pub batches: Vec<Batch>,
    /// End of the indices whose plane shadows are analytic.
    pub plate_casters_end: u32,
    /// End of the opaque indices.
    pub opaque_end: u32,
    /// End of the indices that cast plane shadows; those from `plate_casters_end` on do so as triangles.
    pub casters_end: u32,
    /// Punctual lights of the model.
    pub lights: Vec<Punctual>,
    /// Plates with analytic silhouettes.
    pub plates: Vec<Plate>,
    /// Plates with analytic shadows.
    pub shadow_plates: Vec<ShadowPlate>,
    /// Skinned meshes and animated shapes.
    pub skins: Vec<Skinned>,
}

impl Scene {
    /// Collects the meshes and lights of an exhibit.
    ///
    /// # Errors
    /// The exhibit has more than the shaders can hold, such as bodies; the error says what.
    pub fn new(exhibit: &Exhibit) -> Result<Self, RenderError> {
        if exhibit.bodies.len() >= MAX_FRAMES {
            return Err(RenderError::TooManyBodies { count: exhibit.bodies.len(), limit: MAX_FRAMES - 1 });
        }
        let model = &exhibit.model;
        let mut pieces = Vec::new();
        let mut lights = Vec::new();
        let shown = shown(model);
        let carriers = exhibit.carrying_bodies();
        for (index, (node, carrier)) in model.nodes.iter().zip(carriers.iter().copied()).enumerate() {
            if !shown[index] {
                continue;
            }
            // A skin follows its joints, whichever body carries the node that shows it.
            let bound = BoundMesh::of(exhibit, index, &carriers).map(std::rc::Rc::new);
            let carrier = bound.as_ref().map_or(carrier, |bound| bound.leader(&carriers));
            let frame_from_node = match carrier {
                Some(body) => rigid_of(exhibit, body).inverse() * node.world,
                None => node.world,
            };
            let frame = carrier.map_or(0, |body| body + 1);
            if let Some(mesh) = node.mesh.and_then(|m| model.meshes.get(m)) {
                let matrix = frame_from_node.as_mat4();
                for (index, p) in mesh.primitives.iter().enumerate() {
                    let bound = bound.clone().filter(|b| index < b.primitives.len()).map(|b| (b, index));
                    // A deforming mesh is no plate.
                    let flat = if bound.is_none() { plate(model, p, frame, matrix) } else { (None, None) };
                    pieces.push((p, frame, matrix, flat, bound));
                }
            }
            if let Some(light) = node.light.and_then(|l| model.lights.get(l))
                && lights.len() < MAX_PUNCTUAL
            {
                lights.push(Punctual::new(light, frame, frame_from_node.as_mat4()));
            }
        }
        let state = |p: &Primitive, plate: &Option<Plate>| {
            let outlined = plate.is_some();
            (PipelineKey { outlined, ..state_of(model, p) }, p.material.unwrap_or(model.materials.len()))
        };
        // Sorted by key, so that neighbours merge into one draw.
        pieces.sort_by_key(|(p, _, _, (plate, shadow_plate), _)| (shadow_plate.is_none(), state(p, plate)));
        let mut scene = Self { lights, ..Self::default() };
        for (primitive, frame, matrix, (plate, shadow_plate), bound) in pieces {
            let (state, material) = state(primitive, &plate);
            let opacity = opacity(model, primitive, state.kind);
            let start = scene.indices.len() as u32;
            let base = scene.vertices.len() as u32;
            let center = scene.append(primitive, tag(frame, opacity), matrix);
            let end = scene.indices.len() as u32;
            if let Some(shadow_plate) = shadow_plate {
                scene.shadow_plates.push(shadow_plate);
                scene.plate_casters_end = end;
            }
            if let Some((bound, number)) = bound {
                let place = (base, frame, matrix.determinant() < 0.0);
                scene.skins.push(Skinned::new(exhibit, &bound, number, place, &carriers));
            }
            match state.kind {
                SurfaceKind::Opaque => (scene.opaque_end, scene.casters_end) = (end, end),
                SurfaceKind::Glass => scene.casters_end = end,
                SurfaceKind::Blend => {}
            }
            match scene.batches.last_mut() {
                Some(last)
                    if state.kind != SurfaceKind::Blend && (last.material, last.pipeline) == (material, state) =>
                {
                    last.indices.end = end;
                }
                _ => scene.batches.push(Batch { indices: start..end, material, pipeline: state, center, frame }),
            }
            if let Some(mut plate) = plate {
                plate.place(scene.batches.len() - 1, base);
                scene.vertices[base as usize..].iter_mut().for_each(|v| v.outline = scene.plates.len() as u32);
                scene.plates.push(plate);
            }
        }
        Ok(scene)
    }

    /// Adds a primitive's triangles and returns their centre.
    fn append(&mut self, primitive: &Primitive, tag: u32, matrix: Mat4) -> Vec3 {
        let base = self.vertices.len() as u32;
        let linear = glam::Mat3::from_mat4(matrix);
        let mirrored = linear.determinant() < 0.0;
        // Cofactors: the normal's transform even where a scale is zero.
        let cofactor = glam::Mat3::from_cols(
            linear.y_axis.cross(linear.z_axis),
            linear.z_axis.cross(linear.x_axis),
            linear.x_axis.cross(linear.y_axis),
        ) * if mirrored { -1.0 } else { 1.0 };
        let mut center = Vec3::ZERO;
        for (i, &position) in primitive.positions.iter().enumerate() {
            let position = matrix.transform_point3(position.into());
            center += position;
            let normal = primitive.normals.get(i).map_or(Vec3::Y, |&n| Vec3::from_array(n));
            let tangent = primitive.tangents.get(i).map_or([0.0; 4], |t| {
                let along = (linear * Vec3::new(t[0], t[1], t[2])).normalize_or_zero();
                let hand = if mirrored { -t[3] } else { t[3] };
                [along.x, along.y, along.z, hand]
            });
            self.vertices.push(Vertex {
                position,
                normal: (cofactor * normal).normalize_or(Vec3::Y),
                tangent,
                uv: uv(primitive, i),
                color: primitive.colors.get(i).copied().unwrap_or([1.0; 4]),
                tag,
                bounce: Vec3::ZERO,
                fill: 1.0,
                outline: 0,
            });
        }
        let count = primitive.positions.len() as u32;
        for corners in primitive.indices.chunks_exact(3) {
            if corners.iter().all(|&c| c < count) {
                let [a, b, c] = [corners[0], corners[1], corners[2]].map(|c| base + c);
                self.indices.extend(if mirrored { [a, c, b] } else { [a, b, c] });
            }
        }
        center / count.max(1) as f32
    }
}

impl PipelineKey {
    /// The plainest material: opaque, one-sided, without layers, details or outlines.
    const PLAIN: Self =
        Self { kind: SurfaceKind::Opaque, double_sided: false, layers: false, details: false, outlined: false };

    fn of(appearance: &Appearance) -> Self {
        let kind = match appearance.alpha {
            AlphaMode::Blend => SurfaceKind::Blend,
            _ if appearance.transmission > 0.0 && appearance.metallic < 1.0 && !appearance.unlit => SurfaceKind::Glass,
            _ => SurfaceKind::Opaque,
        };
        let layers = appearance.coat > 0.0 || appearance.sheen.iter().any(|c| *c > 0.0);
        let details = !appearance.details.is_empty();
        Self { kind, double_sided: appearance.double_sided, layers, details, outlined: false }
    }
}

/// The pipeline key of a primitive's triangles, unless they form a plate.
fn state_of(model: &Model, primitive: &Primitive) -> PipelineKey {
    primitive.material.and_then(|m| model.materials.get(m)).map_or(PipelineKey::PLAIN, PipelineKey::of)
}

/// The tag of a frame's vertices with this opacity to lamps and full ambient visibility.
fn tag(frame: usize, opacity: f32) -> u32 {
    frame as u32 | (255 << 16) | (((opacity * 255.0 + 0.5) as u32) << 24)
}

/// The plate that an opaque primitive forms, if its silhouette can be analytic, and its shadow plate, if it is flat.
fn plate(model: &Model, primitive: &Primitive, frame: usize, matrix: Mat4) -> (Option<Plate>, Option<ShadowPlate>) {
    let holes = primitive.material.and_then(|m| model.materials.get(m)).is_some_and(|m| m.alpha != AlphaMode::Opaque);
    if holes || state_of(model, primitive).kind != SurfaceKind::Opaque {
        return (None, None);
    }
    let mut alone = Scene::default();
    alone.append(primitive, tag(frame, 1.0), matrix);
    let plate = Plate::of(&alone.vertices, &alone.indices);
    let shadow_plate = plate.as_ref().and_then(ShadowPlate::of);
    (plate.filter(Plate::is_simple), shadow_plate)
}

/// Both sets of texture coordinates of a vertex; a missing set repeats the other.
fn uv(primitive: &Primitive, i: usize) -> [f32; 4] {
    let first = primitive.uvs.get(i).or(primitive.second_uvs.get(i)).copied().unwrap_or_default();
    let second = primitive.second_uvs.get(i).copied().unwrap_or(first);
    [first[0], first[1], second[0], second[1]]
}

/// Opacity of a primitive's shadow, 0 … 1.
fn opacity(model: &Model, primitive: &Primitive, kind: SurfaceKind) -> f32 {
    match kind {
        SurfaceKind::Opaque => 1.0,
        SurfaceKind::Glass => primitive.material.map_or(1.0, |m| shade_of(&model.materials[m])),
        SurfaceKind::Blend => 0.0,
    }
}

/// Opacity of the shadow of a glass pane: the loss of white light in two crossings at normal incidence.
fn shade_of(appearance: &Appearance) -> f32 {
    let reflected = (appearance.ior - 1.0) / (appearance.ior + 1.0);
    let color = (appearance.base_color[0] + appearance.base_color[1] + appearance.base_color[2]) / 3.0;
    let through = appearance.transmission * color * (1.0 - 2.0 * reflected * reflected);
    (1.0 - through).clamp(0.0, 1.0)
}

/// The visible nodes: those below the scene's roots that are not hidden.
fn shown(model: &Model) -> Vec<bool> {
    let mut shown = vec![false; model.nodes.len()];
    let mut open = model.roots.clone();
    while let Some(index) = open.pop() {
        shown[index] = model.hidden.binary_search(&index).is_err();
        open.extend(&model.nodes[index].children);
    }
    shown
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use glam::DMat4;
    use soffio_exhibit::model::{Mesh, Node};

    /// An exhibit of one mesh, and its scene.
    pub fn of_primitive(primitive: Primitive, materials: Vec<Appearance>) -> (Exhibit, Scene) {
        placed(primitive, materials, DMat4::IDENTITY)
    }

    fn placed(primitive: Primitive, materials: Vec<Appearance>, world: DMat4) -> (Exhibit, Scene) {
        let node = Node {
            name: "node".into(),
            parent: None,
            children: Vec::new(),
            local: world,
            world,
            mesh: Some(0),
            camera: None,
            light: None,
        };
        let model = Model {
            nodes: vec![node],
            roots: vec![0],
            meshes: vec![Mesh { name: String::new(), primitives: vec![primitive] }],
            materials,
            ..Default::default()
        };
        let exhibit = Exhibit::from_model(model);
        let scene = Scene::new(&exhibit).expect("few bodies");
        (exhibit, scene)
    }

    #[test]
    fn a_mirrored_node_keeps_its_outside_out() {
        let triangle = Primitive {
            positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            normals: vec![[0.0, 0.0, 1.0]; 3],
            indices: vec![0, 1, 2],
            ..Default::default()
        };
        let mirror = DMat4::from_scale(soffio_math::DVec3::new(-2.0, 1.0, 1.0));
        let (_, scene) = placed(triangle, Vec::new(), mirror);
        let corner = |i: usize| scene.vertices[scene.indices[i] as usize].position;
        let geometric = (corner(1) - corner(0)).cross(corner(2) - corner(0));
        assert!(geometric.z > 0.0 && scene.vertices[0].normal == Vec3::Z, "{geometric}");
    }
}
