//! The built-in gallery: a grey room with ceiling softboxes, a window, pictures, a doorway, and two lamps on the exhibit.
//!
//! The gallery is a box in a frame of its own: `x` to the visitor's right along the wall, `y` up, `z` from the wall to
//! the visitor. Its light has three parts:
//!
//! - fields (softboxes, window): diffuse emitters;
//! - lamps: small bright discs with a cone, which cast the shadows;
//! - reflections between the walls, which `radiosity` computes.
//!
//! The same functions bake the gallery's light map and give the radiance that the exhibit reflects, so a mirror shows
//! the gallery. Radiances are relative: at exposure 1 the wall behind the exhibit has two fifths of white, unless `[light]` of its
//! sidecar says otherwise, so that white paint on the exhibit is the brightest thing in the picture.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use soffio_exhibit::{Exhibit, LightRig, Side};

/// Inner faces of the gallery, in the order of the light map's layers and of `gallery.wgsl`.
pub const FACES: [Face; 6] = [Face::Wall, Face::Floor, Face::Ceiling, Face::Left, Face::Right, Face::Back];
/// Reflectance of the walls, linear RGB: a light warm grey, half of what white paint has; chosen by eye.
pub const WALL_ALBEDO: Vec3 = Vec3::new(0.475, 0.468, 0.455);
/// Reflectance of the floor, linear RGB, 0 … 1: oiled oak, chosen by eye.
pub const FLOOR_ALBEDO: Vec3 = Vec3::new(0.37, 0.315, 0.25);
/// Radiance of the ceiling softboxes, linear RGB, relative to exposure 1: chosen by eye, slightly warm.
const SOFTBOX: Vec3 = Vec3::new(3.6, 3.5, 3.3);
/// Radiance of the window, linear RGB, relative to exposure 1: chosen by eye, cooler than the softboxes.
const WINDOW: Vec3 = Vec3::new(2.6, 2.9, 3.3);
/// Fraction of the wall's radiance behind the exhibit that fields and reflections make; the lamps add the rest. Chosen by eye:
/// with more the shadows fade, with less they are black.
const AMBIENT_SHARE: f32 = 0.25;
/// Colour of the key lamp, warm, and of the fill lamp, cool, linear RGB: as halogen beside daylight, chosen by eye.
const LAMP_COLORS: [Vec3; 2] = [Vec3::new(1.05, 1.0, 0.92), Vec3::new(0.94, 1.0, 1.08)];

/// An inner face of the gallery.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// Behind the exhibit.
    Wall,
    /// Below it.
    Floor,
    /// Above it.
    Ceiling,
    /// To the visitor's left.
    Left,
    /// To the visitor's right.
    Right,
    /// Behind the visitor.
    Back,
}

/// A luminous rectangle on a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Field {
    pub(super) face: Face,
    /// Centre and half size in the face's coordinates, −1 … 1.
    pub(super) center: Vec2,
    pub(super) half: Vec2,
    pub(super) radiance: Vec3,
}

/// A rectangle of another reflectance on a face.
#[derive(Clone, Copy, Debug)]
pub struct Panel {
    /// The face.
    pub face: Face,
    /// Centre in the face's coordinates, −1 … 1.
    pub center: Vec2,
    /// Half size in the face's coordinates.
    pub half: Vec2,
    /// Reflectance, linear RGB.
    pub albedo: Vec3,
}

impl Panel {
    /// Whether it covers a point of its face.
    fn covers(&self, at: Vec2) -> bool {
        (at - self.center).abs().cmple(self.half).all()
    }
}

/// Panels of the gallery: framed pictures on both sides, and behind the visitor a doorway to a dark room. What shines
/// mirrors them. Where two overlap, the later one covers the earlier.
pub const PANELS: [Panel; 9] = {
    const FRAME: Vec3 = Vec3::new(0.06, 0.05, 0.04);
    const CANVASES: [Vec3; 4] = [
        Vec3::new(0.30, 0.24, 0.17),
        Vec3::new(0.12, 0.17, 0.24),
        Vec3::new(0.33, 0.15, 0.10),
        Vec3::new(0.20, 0.22, 0.16),
    ];
    /// Width of a frame in the face's coordinates.
    const WIDTH: Vec2 = Vec2::new(0.03, 0.02);
    const fn framed(face: Face, center: Vec2, half: Vec2, canvas: Vec3) -> [Panel; 2] {
        let inner = Vec2::new(half.x - WIDTH.x, half.y - WIDTH.y);
        [Panel { face, center, half, albedo: FRAME }, Panel { face, center, half: inner, albedo: canvas }]
    }
    // Coordinates of the sides: up, then along; of the back: along, then up.
    let [a, b] = framed(Face::Right, Vec2::new(-0.05, -0.45), Vec2::new(0.34, 0.22), CANVASES[0]);
    let [c, d] = framed(Face::Right, Vec2::new(-0.10, 0.25), Vec2::new(0.26, 0.28), CANVASES[1]);
    let [e, f] = framed(Face::Left, Vec2::new(-0.55, -0.55), Vec2::new(0.24, 0.20), CANVASES[2]);
    let [g, h] = framed(Face::Back, Vec2::new(0.12, 0.0), Vec2::new(0.14, 0.26), CANVASES[3]);
    let door = Panel {
        face: Face::Back,
        center: Vec2::new(0.62, -0.35),
        half: Vec2::new(0.16, 0.65),
        albedo: Vec3::new(0.015, 0.015, 0.018),
    };
    [a, b, c, d, e, f, g, h, door]
};

/// Reflectance of a point of a face, −1 … 1 in its coordinates.
pub fn reflectance(face: Face, at: Vec2) -> Vec3 {
    let covering = PANELS.iter().rev().find(|panel| panel.face == face && panel.covers(at));
    covering.map_or(if face == Face::Floor { FLOOR_ALBEDO } else { WALL_ALBEDO }, |panel| panel.albedo)
}

/// A disc lamp that lights the exhibit.
#[derive(Clone, Copy, Debug)]
pub struct Lamp {
    /// Position, world, m.
    pub position: Vec3,
    /// Direction of its light, unit.
    pub axis: Vec3,
    /// Radius of the luminous disc, m.
    pub radius: f32,
    /// Intensity on the axis: irradiance × distance².
    pub intensity: Vec3,
    /// Cosine of the half-angle at which the cone begins to fade.
    pub cos_inner: f32,
    /// Cosine of the half-angle at which the cone ends.
    pub cos_outer: f32,
}

impl Lamp {
    /// Irradiance at a world point with this normal, without shadows.
    pub fn irradiance(&self, point: Vec3, normal: Vec3) -> Vec3 {
        let away = point - self.position;
        let d2 = away.length_squared().max(1e-6);
        let direction = away / d2.sqrt();
        let t = ((direction.dot(self.axis) - self.cos_outer) / (self.cos_inner - self.cos_outer)).clamp(0.0, 1.0);
        self.intensity * (t * t * (3.0 - 2.0 * t) * (-direction).dot(normal).max(0.0) / d2)
    }
}

/// The gallery around an exhibit.
#[derive(Clone, Debug)]
pub struct Gallery {
    /// Centre of the box, world, m.
    pub center: Vec3,
    /// Half sizes along the gallery's axes, m.
    pub half: Vec3,
    /// Unit axis along the wall, world; `y` is the world's.
    pub x: Vec3,
    /// Unit axis from the wall to the visitor, world.
    pub z: Vec3,
    /// Centre of the exhibit, world, m.
    pub exhibit_center: Vec3,
    /// Radius of the exhibit, m.
    pub radius: f32,
    /// The two lamps; the first is the key.
    pub lamps: [Lamp; 2],
    pub(super) fields: Vec<Field>,
    /// Radiance of the wall behind the exhibit by fields and reflections, relative to exposure 1.
    pub wall_ambient: f32,
    /// Irradiance of the faces without the direct light of the lamps, face by face, row by row.
    pub(super) lightmap: Vec<Vec3>,
}

impl Gallery {
    /// A gallery scaled to the exhibit: the wall a little behind it as the visitor sees it, the floor under standing
    /// exhibits.
    pub fn around(exhibit: &Exhibit) -> Self {
        let bounds = exhibit.bounds();
        let (min, max) = if bounds.is_empty() {
            (Vec3::splat(-0.5), Vec3::splat(0.5))
        } else {
            (bounds.min.as_vec3(), bounds.max.as_vec3())
        };
        let (work, radius) = (0.5 * (min + max), (0.5 * (max - min).length()).max(0.02));
        // The wall is perpendicular to the view, so that the picture has a level horizon.
        let view = exhibit.view(16.0 / 9.0);
        let z = (view.eye - view.target).as_vec3().with_y(0.0).normalize_or(Vec3::Z);
        let x = Vec3::Y.cross(z);
        let scale = radius / 0.5;
        let extent = (max - min) * 0.5;
        // Mobiles rotate: the wall must clear the volume that their bounds sweep about the vertical.
        let behind = extent.with_y(0.0).length() + 0.12 * scale;
        let below = work.y - min.y + if stands(exhibit, min.y) { 0.0 } else { 0.25 * scale };
        let distance = (view.eye.as_vec3() - work).length();
        let half = Vec3::new(3.2, 1.7, 3.0) * scale.max(0.3);
        let half =
            half.max(Vec3::new(0.9, 0.6, 0.0) * distance).max(Vec3::Z * (0.5 * (behind + distance) + 0.5 * scale));
        let center = work + Vec3::Y * (half.y - below) + z * (half.z - behind);
        let mut gallery = Self {
            center,
            half,
            x,
            z,
            exhibit_center: work,
            radius,
            lamps: [Lamp {
                position: work,
                axis: -z,
                radius: 0.1,
                intensity: Vec3::ZERO,
                cos_inner: 1.0,
                cos_outer: 0.0,
            }; 2],
            fields: fields(),
            wall_ambient: AMBIENT_SHARE * exhibit.light.wall as f32,
            lightmap: Vec::new(),
        };
        gallery.lamps = gallery.place_lamps(behind, &exhibit.light);
        gallery.solve_radiosity();
        gallery
    }

    /// Key lamp from one side above, fill lamp from the other; both light the exhibit and the wall around it.
    fn place_lamps(&self, behind: f32, rig: &LightRig) -> [Lamp; 2] {
        let r = self.radius;
        let side = if rig.side == Side::Left { 1.0 } else { -1.0 };
        let (lamps, ratio) = ((1.0 - AMBIENT_SHARE) * rig.wall as f32, rig.key_to_fill as f32);
        let (key, fill) = (lamps * ratio / (ratio + 1.0), lamps / (ratio + 1.0));
        let place = |offset: Vec3, disc: f32, color: Vec3, radiance: f32| {
            let position =
                self.exhibit_center + (self.x * (side * offset.x) + Vec3::Y * offset.y + self.z * offset.z) * r;
            let aim = self.exhibit_center - self.z * behind * 0.5;
            let axis = (aim - position).normalize();
            let foot = self.exhibit_center - self.z * behind;
            let to_foot = position - foot;
            let cosine = to_foot.normalize().dot(self.z);
            let irradiance = PI * radiance / WALL_ALBEDO.y;
            Lamp {
                position,
                axis,
                radius: disc * r,
                intensity: color * (irradiance * to_foot.length_squared() / cosine),
                cos_inner: 0.985,
                cos_outer: 0.89,
            }
        };
        [
            place(Vec3::new(-1.5, 2.0, 4.7), 0.085, LAMP_COLORS[0], key),
            place(Vec3::new(2.0, 2.1, 4.4), 0.16, LAMP_COLORS[1], fill),
        ]
    }

    /// Half-size vectors along a face's two coordinates, and its centre; gallery frame, m.
    pub fn face_axes(&self, face: Face) -> [Vec3; 3] {
        let h = self.half;
        let (x, y, z) = (Vec3::X * h.x, Vec3::Y * h.y, Vec3::Z * h.z);
        match face {
            Face::Wall => [x, y, -z],
            Face::Floor => [x, z, -y],
            Face::Ceiling => [x, z, y],
            Face::Left => [y, z, -x],
            Face::Right => [y, z, x],
            Face::Back => [x, y, z],
        }
    }

    /// World position of a vector of the gallery frame.
    pub fn to_world(&self, local: Vec3) -> Vec3 {
        self.center + self.x * local.x + Vec3::Y * local.y + self.z * local.z
    }
}

/// Two long softboxes in the ceiling, one wide over the visitor, a window on the left, and a tall one behind the
/// visitor, which gives dark paint its sheen.
fn fields() -> Vec<Field> {
    let ceiling = |x: f32, z: f32, hx: f32, hz: f32| Field {
        face: Face::Ceiling,
        center: Vec2::new(x, z),
        half: Vec2::new(hx, hz),
        radiance: SOFTBOX,
    };
    vec![
        ceiling(-0.42, -0.1, 0.09, 0.6),
        ceiling(0.42, -0.1, 0.09, 0.6),
        ceiling(0.0, 0.45, 0.22, 0.16),
        Field { face: Face::Back, center: Vec2::new(-0.35, 0.45), half: Vec2::new(0.22, 0.35), radiance: WINDOW },
        Field { face: Face::Left, center: Vec2::new(0.15, 0.35), half: Vec2::new(0.55, 0.38), radiance: WINDOW },
    ]
}

/// Does a static mesh reach the lowest point, so that the exhibit stands on it?
fn stands(exhibit: &Exhibit, lowest: f32) -> bool {
    let carriers = exhibit.carrying_bodies();
    exhibit.model.nodes.iter().zip(&carriers).filter(|(_, carrier)| carrier.is_none()).any(|(node, _)| {
        let Some(mesh) = node.mesh.and_then(|m| exhibit.model.meshes.get(m)) else { return false };
        let world = node.world.as_mat4();
        let points = mesh.primitives.iter().flat_map(|p| &p.positions);
        points.into_iter().any(|p| world.transform_point3(Vec3::from_array(*p)).y <= lowest + 1e-3)
    })
}
