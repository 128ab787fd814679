//! Perspective camera: view rays, projection, framing and orbiting.
//!
//! Picture coordinates run from (0, 0) top left to (1, 1) bottom right, whatever the size in pixels. With the unit axes
//! f (forward), r (right), u (up), half-height t = tan(fovy/2) and aspect a, the point (x, y) lies on the ray
//!
//! ```text
//! d = f + (2x − 1) a t r + (1 − 2y) t u
//! ```
//!
//! [`View::project`] is the inverse. Invariant: a picture narrower than the camera's own aspect shows the whole exhibit, since the
//! vertical angle is widened until it does, or until the horizontal one is the camera's own.

use super::exhibit::Exhibit;
use soffio_math::{DMat4, DVec3, PI, asin, atan2, rotation, sin, sincos};

/// A perspective (pinhole) camera in the world frame, whose y axis points up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Position of the camera, m.
    pub eye: DVec3,
    /// Point looked at, m. The breath is aimed in the plane through it that faces the camera.
    pub target: DVec3,
    /// Up vector of the picture, unit, world frame.
    pub up: DVec3,
    /// Vertical field of view, rad.
    pub fovy: f64,
}

/// Vertical field of view where the exhibit has no camera, rad: a short telephoto lens, as in catalogues.
const FRAMING_FOVY: f64 = 0.5;
/// Margin around the exhibit where it has no camera, as a multiple of its radius.
const FRAMING_MARGIN: f64 = 1.12;
/// Widest vertical field of view of a narrow picture, rad.
const MAX_FOVY: f64 = 2.6;

impl View {
    /// Unit right, up and forward axes of the camera.
    pub fn axes(&self) -> (DVec3, DVec3, DVec3) {
        let forward = (self.target - self.eye).try_normalize().unwrap_or(DVec3::NEG_Z);
        let right = forward.cross(self.up).try_normalize().unwrap_or_else(|| soffio_math::tangents(forward).0);
        (right, right.cross(forward), forward)
    }

    /// Origin (m) and unit direction of the view ray through `at` in picture coordinates; `aspect` is width / height.
    pub fn ray(&self, at: [f64; 2], aspect: f64) -> (DVec3, DVec3) {
        let (right, up, forward) = self.axes();
        let t = half_height(self.fovy);
        let across = (2.0 * at[0] - 1.0) * t * aspect;
        let along = (1.0 - 2.0 * at[1]) * t;
        (self.eye, (forward + right * across + up * along).normalize())
    }

    /// The view after an orbit about the target: `yaw` moves the camera to the right about the vertical, `pitch` moves
    /// it up, rad. With both zero it is bit-identical.
    pub fn orbited(self, [yaw, pitch]: [f64; 2]) -> Self {
        if [yaw, pitch] == [0.0; 2] {
            return self;
        }
        let (right, ..) = self.axes();
        let turn = rotation(DVec3::Y * yaw) * rotation(right * -pitch);
        Self { eye: self.target + turn * (self.eye - self.target), up: turn * self.up, ..self }
    }

    /// Height of the picture at a distance along the view, m.
    pub fn height_at(&self, depth: f64) -> f64 {
        2.0 * depth * half_height(self.fovy)
    }

    /// Picture coordinates of a world point; `None` for points behind the camera.
    pub fn project(&self, point: DVec3, aspect: f64) -> Option<[f64; 2]> {
        let (right, up, forward) = self.axes();
        let offset = point - self.eye;
        let depth = offset.dot(forward);
        if depth <= 0.0 {
            return None;
        }
        let t = half_height(self.fovy) * depth;
        Some([0.5 + 0.5 * offset.dot(right) / (t * aspect), 0.5 - 0.5 * offset.dot(up) / t])
    }
}

/// How far visitors may orbit the camera from its own position, rad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OrbitLimits {
    /// Yaw to the left and to the right.
    pub yaw: f64,
    /// Pitch down: the camera stays above the lowest point of the exhibit.
    pub down: f64,
    /// Pitch up: the camera stays below the vertical.
    pub up: f64,
}

/// Largest yaw to either side, rad: a third of a circle in all.
pub const MAX_YAW: f64 = PI / 3.0;
/// Largest pitch down, rad.
pub const MAX_PITCH_DOWN: f64 = PI / 18.0;
/// Largest pitch up, rad.
pub const MAX_PITCH_UP: f64 = 5.0 * PI / 18.0;
/// Steepest elevation of the camera over the target, rad: straight above, the up vector is undefined.
const MAX_PITCH: f64 = 4.0 * PI / 9.0;

/// Part of the picture that an exhibit may fill in a narrow picture: a margin of a sixteenth on each side, so that nothing is
/// cut off when it swings.
const SAFE_MARGIN: f64 = 1.125;

/// tan(fovy / 2).
fn half_height(fovy: f64) -> f64 {
    let (s, c) = sincos(0.5 * fovy);
    s / c
}

/// An axis-aligned box in the world, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub min: DVec3,
    /// Largest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// The empty box.
    pub const EMPTY: Self = Self { min: DVec3::splat(f64::INFINITY), max: DVec3::splat(f64::NEG_INFINITY) };

    /// Extends the box to contain a point.
    pub fn add(&mut self, point: DVec3) {
        self.min = self.min.min(point);
        self.max = self.max.max(point);
    }

    /// Does it contain no point?
    pub fn is_empty(&self) -> bool {
        self.min.x > self.max.x
    }

    /// Centre, m.
    pub fn center(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// Half the diagonal, m.
    pub fn radius(&self) -> f64 {
        0.5 * (self.max - self.min).length()
    }
}

impl Exhibit {
    /// The camera for a picture of this aspect (width / height): that of the camera node, or one that frames the bounds. Where
    /// the picture is narrower than the camera's own aspect, it is widened until the exhibit fits.
    pub fn view(&self, aspect: f64) -> View {
        let aspect = if aspect > 0.0 { aspect } else { 16.0 / 9.0 };
        let camera = self.camera_node.and_then(|index| {
            let node = self.model.nodes.get(index)?;
            Some((node.world, *self.model.cameras.get(node.camera?)?))
        });
        match camera {
            Some((world, camera)) => self.camera_view(world, camera, aspect),
            None => self.framing_view(aspect),
        }
    }

    /// How far visitors may orbit from the view in a picture of this aspect.
    pub fn orbit_limits(&self, aspect: f64) -> OrbitLimits {
        let View { eye, target, .. } = self.view(aspect);
        let from = eye - target;
        let elevation = |height: f64| asin((height / from.length()).clamp(-1.0, 1.0));
        let bounds = self.bounds();
        let lowest = if bounds.is_empty() { target.y } else { bounds.min.y };
        OrbitLimits {
            yaw: MAX_YAW,
            down: (elevation(from.y) - elevation(lowest - target.y)).clamp(0.0, MAX_PITCH_DOWN),
            up: (MAX_PITCH - elevation(from.y)).clamp(0.0, MAX_PITCH_UP),
        }
    }

    /// The view of a camera node.
    fn camera_view(&self, world: DMat4, camera: super::model::Camera, aspect: f64) -> View {
        let eye = world.w_axis.truncate();
        let forward = -world.z_axis.truncate().try_normalize().unwrap_or(DVec3::Z);
        let up = world.y_axis.truncate().try_normalize().unwrap_or(DVec3::Y);
        let moving = self.moving_bounds();
        let bounds = if moving.is_empty() { self.bounds() } else { moving };
        let depth = if bounds.is_empty() { 1.0 } else { (bounds.center() - eye).dot(forward) };
        // A camera that looks away from the exhibit still needs a target.
        let depth = if depth > 1e-3 { depth } else { 1.0 };
        let fovy = match camera.aspect {
            Some(own) if aspect < own => {
                let whole = (2.0 * atan2(half_height(camera.fovy) * own, aspect)).min(MAX_FOVY);
                let view = View { eye, target: eye + forward * depth, up, fovy: whole };
                whole.min(self.fitting_fovy(&view, aspect)).max(camera.fovy)
            }
            _ => camera.fovy,
        };
        View { eye, target: eye + forward * depth, up, fovy }
    }

    /// Vertical field of view, rad, in which the exhibit just fits with [`SAFE_MARGIN`], wherever it turns about the vertical
    /// through its middle: a picture upright shows the exhibit, not the whole width of the gallery that a wide one has.
    fn fitting_fovy(&self, view: &View, aspect: f64) -> f64 {
        let bounds = self.bounds();
        if bounds.is_empty() {
            return view.fovy;
        }
        let half = 0.5 * (bounds.max - bounds.min);
        let swept = half.with_y(0.0).length();
        let (right, up, forward) = view.axes();
        let mut needed: f64 = 0.0;
        for corner in 0..8 {
            let side = |bit: u32| if corner & bit == 0 { -1.0 } else { 1.0 };
            let point = bounds.center() + DVec3::new(side(1) * swept, side(2) * half.y, side(4) * swept) - view.eye;
            // A corner beside or behind the camera cannot be fitted.
            let depth = point.dot(forward).max(1e-6);
            needed = needed.max((point.dot(right) / depth).abs() / aspect).max((point.dot(up) / depth).abs());
        }
        2.0 * atan2(SAFE_MARGIN * needed, 1.0)
    }

    /// A view from the front that shows the whole bounds in any aspect.
    fn framing_view(&self, aspect: f64) -> View {
        let bounds = self.bounds();
        let (center, radius) =
            if bounds.is_empty() { (DVec3::ZERO, 0.5) } else { (bounds.center(), bounds.radius().max(1e-3)) };
        // The sphere around the bounds touches the narrower pair of picture edges.
        let half = atan2(half_height(FRAMING_FOVY) * aspect.min(1.0), 1.0).min(0.5 * PI);
        let distance = FRAMING_MARGIN * radius / sin(half);
        View { eye: center + DVec3::Z * distance, target: center, up: DVec3::Y, fovy: FRAMING_FOVY }
    }

    /// Box around all meshes and wires at rest.
    pub fn bounds(&self) -> Bounds {
        self.bounds_where(|_| true)
    }

    /// Box around the meshes and wires of bodies at rest; static ones are left out.
    pub fn moving_bounds(&self) -> Bounds {
        self.bounds_where(|body| body.is_some())
    }

    /// Box around the meshes and wires at rest whose body, `None` for static ones, passes `included`.
    fn bounds_where(&self, included: impl Fn(Option<usize>) -> bool) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        let carrying_bodies = self.carrying_bodies();
        for (node, carrier) in self.model.nodes.iter().zip(&carrying_bodies) {
            if !included(*carrier) {
                continue;
            }
            let Some(mesh) = node.mesh.and_then(|m| self.model.meshes.get(m)) else { continue };
            for position in mesh.primitives.iter().flat_map(|p| &p.positions) {
                bounds.add(node.world.transform_point3(glam::Vec3::from_array(*position).as_dvec3()));
            }
        }
        for wire in &self.wires {
            let pose = wire.body.and_then(|b| self.bodies.get(b)).map(|b| b.pose);
            if !included(wire.body) {
                continue;
            }
            for &point in &wire.points {
                bounds.add(pose.map_or(point, |pose| pose.point(point)));
            }
        }
        bounds
    }

    /// Bounding radius of each body: the farthest distance of its meshes and wires from its node, m.
    pub fn body_radii(&self) -> Vec<f64> {
        let mut reaches = vec![0.0_f64; self.bodies.len()];
        for (node, carrier) in self.model.nodes.iter().zip(self.carrying_bodies()) {
            let (Some(body), Some(mesh)) = (carrier, node.mesh.and_then(|m| self.model.meshes.get(m))) else {
                continue;
            };
            let at = self.model.nodes[self.bodies[body].node].world.w_axis.truncate();
            for position in mesh.primitives.iter().flat_map(|p| &p.positions) {
                let point = node.world.transform_point3(glam::Vec3::from_array(*position).as_dvec3());
                reaches[body] = reaches[body].max(point.distance(at));
            }
        }
        // A skinned mesh counts as far as all of it lies from each of its joints.
        let carrying_bodies = self.carrying_bodies();
        for skin in &self.model.skins {
            let shown = &self.model.nodes[skin.node];
            let Some(mesh) = shown.mesh.and_then(|m| self.model.meshes.get(m)) else { continue };
            for body in skin.joints.iter().filter_map(|&joint| carrying_bodies[joint]) {
                let at = self.model.nodes[self.bodies[body].node].world.w_axis.truncate();
                for position in mesh.primitives.iter().flat_map(|p| &p.positions) {
                    let point = shown.world.transform_point3(glam::Vec3::from_array(*position).as_dvec3());
                    reaches[body] = reaches[body].max(point.distance(at));
                }
            }
        }
        for wire in &self.wires {
            if let Some(reach) = wire.body.and_then(|body| reaches.get_mut(body)) {
                *reach = wire.points.iter().map(|point| point.length() + wire.radius).fold(*reach, f64::max);
            }
        }
        reaches
    }

    /// For each node of the model, the body that carries it: its own, or its nearest ancestor's.
    pub fn carrying_bodies(&self) -> Vec<Option<usize>> {
        let mut own = vec![None; self.model.nodes.len()];
        for (index, body) in self.bodies.iter().enumerate() {
            if let Some(slot) = own.get_mut(body.node) {
                *slot = Some(index);
            }
        }
        let mut carrying_bodies = vec![None; own.len()];
        let mut open: Vec<(usize, Option<usize>)> = self.model.roots.iter().map(|&root| (root, None)).collect();
        while let Some((node, inherited)) = open.pop() {
            let carrier = own[node].or(inherited);
            carrying_bodies[node] = carrier;
            open.extend(self.model.nodes[node].children.iter().map(|&child| (child, carrier)));
        }
        carrying_bodies
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of a dozen double-precision operations on numbers near 1.
    const ROUNDING: f64 = 1e-12;

    fn view() -> View {
        View {
            eye: DVec3::new(0.3, 0.5, 2.0),
            target: DVec3::new(-0.1, 0.2, -0.4),
            up: DVec3::new(0.1, 1.0, 0.0).normalize(),
            fovy: 0.7,
        }
    }

    #[test]
    fn a_point_on_the_ray_projects_back_to_where_the_ray_went_through() {
        for (at, aspect) in [([0.5, 0.5], 1.5), ([0.0, 0.0], 1.0), ([0.9, 0.2], 16.0 / 9.0), ([0.1, 1.0], 0.5)] {
            let (origin, direction) = view().ray(at, aspect);
            let back = view().project(origin + direction * 3.7, aspect).expect("in front");
            assert!((back[0] - at[0]).abs() < ROUNDING && (back[1] - at[1]).abs() < ROUNDING, "{at:?} {back:?}");
        }
    }

    #[test]
    fn a_turned_view_keeps_its_distance_and_its_target_and_goes_the_way_it_is_told() {
        let own = View { eye: DVec3::new(0.0, 0.0, 2.0), target: DVec3::ZERO, up: DVec3::Y, fovy: 0.5 };
        let (s, c) = sincos(0.7);
        let right = own.orbited([0.7, 0.0]);
        assert!((right.eye - 2.0 * DVec3::new(s, 0.0, c)).length() < ROUNDING, "{right:?}");
        let above = own.orbited([0.0, 0.7]);
        assert!((above.eye - 2.0 * DVec3::new(0.0, s, c)).length() < ROUNDING, "{above:?}");
        for turn in [[0.3, -0.1], [-1.0, 0.8]] {
            let turned = view().orbited(turn);
            let distance = |view: &View| (view.eye - view.target).length();
            assert!((distance(&turned) - distance(&view())).abs() < ROUNDING && turned.target == view().target);
            assert_eq!(
                turned.project(turned.target, 1.5).map(|at| at.map(|x| (x - 0.5).abs() < ROUNDING)),
                Some([true; 2])
            );
        }
        assert_eq!(view().orbited([0.0; 2]), view());
    }

    #[test]
    fn the_top_left_corner_is_up_and_left_at_half_the_angles() {
        let straight = View { eye: DVec3::ZERO, target: DVec3::NEG_Z, up: DVec3::Y, fovy: PI / 2.0 };
        let (_, d) = straight.ray([0.0, 0.0], 2.0);
        // tan 45° = 1 up, twice that to the left.
        assert!((d - DVec3::new(-2.0, 1.0, -1.0).normalize()).length() < ROUNDING, "{d}");
        assert_eq!(straight.project(DVec3::Z, 2.0), None, "behind the eye");
    }
}
