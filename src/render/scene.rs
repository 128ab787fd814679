//! The exhibit as one vertex buffer.
//!
//! Whatever moves is rigid, so each vertex is stored in the frame of the body that carries it, scales of the scene
//! graph applied, with the index of that frame (0 is the world). A pose is then one 3×4 matrix a body, and a whole
//! exhibit one draw for each material and state.

use glam::{Mat4, Vec3};

use super::RenderError;
use super::frames::{MAX_FRAMES, rigid_of};
use super::outlines::Plate;
use super::punctual::{MAX_PUNCTUAL, Punctual};
use super::sheets::Sheet;
use super::skins::{Bound, Skinned};
use super::vertex::Vertex;
use soffio_exhibit::Exhibit;
use soffio_exhibit::model::{AlphaMode, Appearance, Model, Primitive};

/// How triangles are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Surface {
    /// Hides what is behind.
    Opaque,
    /// Multiplies what is behind and adds its own gloss; order does not matter.
    Glass,
    /// Covers a part of what is behind; the farthest first.
    Blend,
}

/// What decides the pipeline of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct State {
    pub surface: Surface,
    pub double_sided: bool,
    /// A clear coat or a sheen.
    pub layers: bool,
    /// Textures of what extensions add.
    pub details: bool,
    /// Plates with a silhouette of their own.
    pub outlined: bool,
}

/// Triangles drawn alike.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// Range in the index buffer.
    pub indices: std::ops::Range<u32>,
    /// Index of the appearance; one past the last is the default.
    pub material: usize,
    pub state: State,
    /// Middle of the triangles in their frame, to sort what is blended.
    pub center: Vec3,
    pub frame: usize,
}

/// All meshes and lights of an exhibit.
#[derive(Default)]
pub(super) struct Scene {
    pub vertices: Vec<Vertex>,
    pub indices: Vec<u32>,
    /// Opaque parts first, of these the plates whose shadows have a closed form, then glass, then blended ones.
    pub parts: Vec<Part>,
    /// So many indices, from the first, throw shadows on the planes in closed form.
    pub flat: u32,
    /// So many indices, from the first, are opaque.
    pub opaque: u32,
    /// So many throw shadows on the planes, those from `flat` on as triangles.
    pub casters: u32,
    pub lights: Vec<Punctual>,
    /// Of the outlined parts.
    pub plates: Vec<Plate>,
    /// What the first indices are.
    pub sheets: Vec<Sheet>,
    /// Parts that follow joints, or key frames of their shape.
    pub skins: Vec<Skinned>,
}

impl Scene {
    pub fn new(exhibit: &Exhibit) -> Result<Self, RenderError> {
        if exhibit.bodies.len() >= MAX_FRAMES {
            return Err(RenderError::TooManyBodies { count: exhibit.bodies.len(), limit: MAX_FRAMES - 1 });
        }
        let model = &exhibit.model;
        let mut pieces = Vec::new();
        let mut lights = Vec::new();
        let shown = shown(model);
        let carriers = exhibit.carriers();
        for (index, (node, carrier)) in model.nodes.iter().zip(carriers.iter().copied()).enumerate() {
            if !shown[index] {
                continue;
            }
            // A skin is where its joints are, whatever carries the node that shows it.
            let bound = Bound::of(exhibit, index, &carriers).map(std::rc::Rc::new);
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
                    // What bends is no plate.
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
            (State { outlined, ..state_of(model, p) }, p.material.unwrap_or(model.materials.len()))
        };
        // By state, so that neighbours merge into one draw.
        pieces.sort_by_key(|(p, _, _, (plate, sheet), _)| (sheet.is_none(), state(p, plate)));
        let mut scene = Self { lights, ..Self::default() };
        for (primitive, frame, matrix, (plate, sheet), bound) in pieces {
            let (state, material) = state(primitive, &plate);
            let opacity = opacity(model, primitive, state.surface);
            let start = scene.indices.len() as u32;
            let base = scene.vertices.len() as u32;
            let center = scene.append(primitive, tag(frame, opacity), matrix);
            let end = scene.indices.len() as u32;
            if let Some(sheet) = sheet {
                scene.sheets.push(sheet);
                scene.flat = end;
            }
            if let Some((bound, number)) = bound {
                let place = (base, frame, matrix.determinant() < 0.0);
                scene.skins.push(Skinned::new(exhibit, &bound, number, place, &carriers));
            }
            match state.surface {
                Surface::Opaque => (scene.opaque, scene.casters) = (end, end),
                Surface::Glass => scene.casters = end,
                Surface::Blend => {}
            }
            match scene.parts.last_mut() {
                Some(last) if state.surface != Surface::Blend && (last.material, last.state) == (material, state) => {
                    last.indices.end = end;
                }
                _ => scene.parts.push(Part { indices: start..end, material, state, center, frame }),
            }
            if let Some(mut plate) = plate {
                plate.place(scene.parts.len() - 1, base);
                scene.vertices[base as usize..].iter_mut().for_each(|v| v.outline = scene.plates.len() as u32);
                scene.plates.push(plate);
            }
        }
        Ok(scene)
    }

    /// Adds a primitive's triangles and returns their middle.
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

impl State {
    const PLAIN: Self =
        Self { surface: Surface::Opaque, double_sided: false, layers: false, details: false, outlined: false };

    fn of(look: &Appearance) -> Self {
        let surface = match look.alpha {
            AlphaMode::Blend => Surface::Blend,
            _ if look.transmission > 0.0 && look.metallic < 1.0 && !look.unlit => Surface::Glass,
            _ => Surface::Opaque,
        };
        let layers = look.coat > 0.0 || look.sheen.iter().any(|c| *c > 0.0);
        let details = !look.details.is_empty();
        Self { surface, double_sided: look.double_sided, layers, details, outlined: false }
    }
}

/// How a primitive's triangles are drawn, unless they are a plate.
fn state_of(model: &Model, primitive: &Primitive) -> State {
    primitive.material.and_then(|m| model.materials.get(m)).map_or(State::PLAIN, State::of)
}

/// The tag of a frame's vertices, of this opacity to lamps; no corner is in shade yet.
fn tag(frame: usize, opacity: f32) -> u32 {
    frame as u32 | (255 << 16) | (((opacity * 255.0 + 0.5) as u32) << 24)
}

/// The plate that a primitive is, where it is one, hides what is behind all over and is drawn with a silhouette; and the sheet,
/// where it is flat.
fn plate(model: &Model, primitive: &Primitive, frame: usize, matrix: Mat4) -> (Option<Plate>, Option<Sheet>) {
    let holes = primitive.material.and_then(|m| model.materials.get(m)).is_some_and(|m| m.alpha != AlphaMode::Opaque);
    if holes || state_of(model, primitive).surface != Surface::Opaque {
        return (None, None);
    }
    let mut alone = Scene::default();
    alone.append(primitive, tag(frame, 1.0), matrix);
    let plate = Plate::of(&alone.vertices, &alone.indices);
    let sheet = plate.as_ref().and_then(Sheet::of);
    (plate.filter(Plate::is_simple), sheet)
}

/// Both sets of texture coordinates of a corner; a missing one repeats the other.
fn uv(primitive: &Primitive, i: usize) -> [f32; 4] {
    let first = primitive.uvs.get(i).or(primitive.second_uvs.get(i)).copied().unwrap_or_default();
    let second = primitive.second_uvs.get(i).copied().unwrap_or(first);
    [first[0], first[1], second[0], second[1]]
}

/// How dark the shadow of a primitive is, 0 … 1.
fn opacity(model: &Model, primitive: &Primitive, surface: Surface) -> f32 {
    match surface {
        Surface::Opaque => 1.0,
        Surface::Glass => primitive.material.map_or(1.0, |m| shade_of(&model.materials[m])),
        Surface::Blend => 0.0,
    }
}

/// How dark the shadow of a pane of glass is: what two crossings at normal incidence take of white light.
fn shade_of(look: &Appearance) -> f32 {
    let reflected = (look.ior - 1.0) / (look.ior + 1.0);
    let color = (look.base_color[0] + look.base_color[1] + look.base_color[2]) / 3.0;
    let through = look.transmission * color * (1.0 - 2.0 * reflected * reflected);
    (1.0 - through).clamp(0.0, 1.0)
}

/// Which nodes the scene shows: those below its roots that nothing hides.
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
        let exhibit = Exhibit::of_model(model);
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
