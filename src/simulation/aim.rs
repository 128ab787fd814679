//! Aim of the breath: from the pointer's camera ray to the position of the lips and the direction of the jet.
//!
//! The lips lie on the camera ray of the pointer, `distance` before the plane through the view's target that faces the
//! camera. In the *physical* profile the breath follows the ray. In the *gallery* profile an aim assist turns it towards
//! the best surface near the ray, because a breath at the centre of the picture could pass between the plates and move
//! nothing. It also moves the lips, as a visitor would:
//!
//! - up or down to the height of the surface, so that they do not blow at a low one past others that hang before it;
//! - nearer by as much as the surface hangs behind the plane, because a distant small disc gets only the rim of a breath;
//! - back from a surface right before them;
//! - to the side of an upright flat surface that turns its edge to them when the breath begins: they then blow at 30° to it.
//!
//! Target selection minimises a cost, with hysteresis:
//!
//! ```text
//! cost = (e + e₀)/(f q)
//! e   distance of the ray from the inner half of the surface's bounding ball, m
//! f   √(s dᵀ⟨n nᵀ⟩d), √s |cos θ| for a plate: wind along d, from the lips to its centre, exerts a force in proportion to
//!     A f² (A: its area, n: its normals, s: visible share of what faces the lips); below a tenth of A it counts as an edge
//! q   mobility ⁴√(w A), over the largest of all: 1 N at its centre accelerates it by w m/s², joints included, so a facing
//!     wind accelerates it in proportion to w A
//! ```

use soffio_exhibit::View;
use soffio_geometry::TriangleMesh;
use soffio_math::{DMat3, DVec3, Pose, exp};
use soffio_multibody::dynamics::Dynamics;

/// A surface that the aim assist may select.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AimTarget {
    /// Centre of its bounding ball, m.
    pub center: DVec3,
    /// Radius of its bounding ball, m.
    pub radius: f64,
    /// Orientation tensor ⟨n nᵀ⟩: mean over the area, of trace 1.
    pub faces: DMat3,
    /// Unit normal of a flat surface, the tensor's first eigenvector; 0 for one that is not flat.
    pub normal: DVec3,
    /// q, 0 … 1.
    pub mobility: f64,
    /// s: share of it that is visible from the lips, 0 … 1.
    pub visible: f64,
}

impl AimTarget {
    /// A mesh on a body of a mechanism, in the body's frame; its mobility is not normalised yet.
    pub fn of(mesh: &TriangleMesh, body: usize, dynamics: &mut Dynamics) -> Self {
        let (center, radius) = mesh.ball();
        let at = dynamics.bodies[body].pose().point(center);
        let mut inverse_mass = [DMat3::ZERO];
        dynamics.effective_inverse_mass(&[(body, at)], &mut inverse_mass);
        let [w] = inverse_mass.map(|w| (w.x_axis.x + w.y_axis.y + w.z_axis.z) / 3.0);
        let (faces, mobility) = (mesh.orientation(), (w * mesh.area()).max(0.0).sqrt().sqrt());
        let normal = first_eigenvector(faces);
        let normal = if normal.dot(faces * normal) > SIDESTEP.flat { normal } else { DVec3::ZERO };
        Self { center, radius, faces, normal, mobility, visible: 1.0 }
    }

    /// The target at the pose of its body.
    pub fn at(&self, pose: Pose) -> Self {
        let rotation = DMat3::from_quat(pose.rotation);
        Self {
            center: pose.point(self.center),
            faces: rotation * self.faces * rotation.transpose(),
            normal: rotation * self.normal,
            ..*self
        }
    }
}

/// Unit eigenvector of the largest eigenvalue of a positive semi-definite tensor, by repeated squaring (power iteration).
fn first_eigenvector(tensor: DMat3) -> DVec3 {
    let power = (0..10).fold(tensor, |m, _| {
        let m = m * m;
        m * (1.0 / (m.x_axis.x + m.y_axis.y + m.z_axis.z).max(f64::MIN_POSITIVE))
    });
    let columns = [power.x_axis, power.y_axis, power.z_axis];
    let longest =
        columns.into_iter().fold(DVec3::ZERO, |a, b| if b.length_squared() > a.length_squared() { b } else { a });
    longest.try_normalize().unwrap_or(DVec3::X)
}

/// Constants of the cost of a target.
struct CostTuning {
    /// e₀, m: half-width of the middle of a breath, within which distances from the ray do not matter.
    offset: f64,
    /// Least f² of a face; surfaces below are edges.
    edge: f64,
    /// Least f q, that of an edge or of a target that cannot move: the breath turns to it if nothing else is near.
    least_quality: f64,
    /// Least cosine between the ray and the direction to a target: no visitor blows at objects beside or behind their lips.
    least_cosine: f64,
    /// Another target must cost less than this share of the selected one's cost before the aim changes.
    hysteresis: f64,
    /// Inner part of a target's ball, as a share of its radius, within which the ray itself is followed. Farther out a long
    /// plate leaves most of its ball empty, so the aim returns towards the centre.
    inner: f64,
    /// Share of the radius at which a ray outside the ball is aimed: on the surface in any orientation.
    core: f64,
}

const COST: CostTuning = CostTuning {
    offset: 0.03,
    edge: 0.1,
    least_quality: 0.05,
    least_cosine: 0.5,
    hysteresis: 0.7,
    inner: 0.5,
    core: 0.2,
};

/// Constants of the step to the side of a plate that turns its edge to the lips.
struct SidestepTuning {
    /// Least first eigenvalue of ⟨n nᵀ⟩ of a flat surface.
    flat: f64,
    /// Greatest sine of the tilt of an upright surface, 30°: no visitor blows from above or below at one that lies.
    tilt_sine: f64,
    /// Sine of the angle between jet and plate after the step, and greatest before it, 30°.
    angle_sine: f64,
}

const SIDESTEP: SidestepTuning = SidestepTuning { flat: 0.7, tilt_sine: 0.5, angle_sine: 0.5 };

/// Least distance of the lips from a target, as a share of their distance from the plane: nearer, a breath is a thread.
const LEAST_DISTANCE: f64 = 0.5;
/// Time constant of the aim, s: no jumps while blowing.
const SMOOTHING_TIME: f64 = 0.08;

/// The camera ray of the pointer, with the lips on it before they move to a target.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct AimRay {
    /// Camera, world, m.
    origin: DVec3,
    /// Unit.
    direction: DVec3,
    /// Intersection with the plane through the view's target that faces the camera, m.
    on_plane: DVec3,
    /// m.
    lips: DVec3,
    /// Unit, across the ray and upright in the picture.
    up: DVec3,
}

impl AimRay {
    /// Displacement of the lips to blow at a point, m: up or down, nearer if it lies behind the plane, and back if it is nearer
    /// than half of the plane's distance.
    fn lip_displacement(&self, point: DVec3) -> DVec3 {
        let [before, usual] = [point, self.on_plane].map(|point| (point - self.lips).dot(self.direction));
        let back = if before > 0.0 { (before - LEAST_DISTANCE * usual).min(0.0) } else { 0.0 };
        let nearer = (before - usual).max(0.0) + back;
        self.rise(point) + nearer * self.direction
    }

    /// Displacement of the lips to the height of a point, m.
    fn rise(&self, point: DVec3) -> DVec3 {
        (point - self.lips).dot(self.up) * self.up
    }

    /// The lips as they blow at a point, m.
    fn lips_facing(&self, point: DVec3) -> DVec3 {
        self.lips + self.lip_displacement(point)
    }

    /// Perpendicular from the ray to a target's centre, m.
    fn offset(&self, target: &AimTarget) -> DVec3 {
        let from = target.center - self.origin;
        from - from.dot(self.direction) * self.direction
    }

    /// Cost of a target, m.
    fn cost(&self, target: &AimTarget) -> f64 {
        let from = |lips: DVec3| (target.center - lips).try_normalize().unwrap_or(self.direction);
        let ahead = from(self.lips + self.rise(target.center)).dot(self.direction) > COST.least_cosine;
        let jet = from(self.lips_facing(target.center));
        let pressed = if ahead { target.visible * jet.dot(target.faces * jet) } else { 0.0 };
        let face = if pressed > COST.edge { pressed.sqrt() } else { 0.0 };
        let distance = (self.offset(target).length() - COST.inner * target.radius).max(0.0);
        (distance + COST.offset) / (face * target.mobility).max(COST.least_quality)
    }

    /// The point of a target's ball that the breath is aimed at, m.
    fn aim_point(&self, target: &AimTarget) -> DVec3 {
        let offset = self.offset(target);
        let miss = offset.length() / target.radius;
        let back = COST.inner - (COST.inner - COST.core) * (miss - COST.inner) / (1.0 - COST.inner);
        let share = miss.min(back.max(COST.core));
        target.center - offset.normalize_or_zero() * (share * target.radius)
    }
}

/// Position of the lips and direction of the jet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Aim {
    /// Centre of the lips, world, m.
    pub mouth: DVec3,
    /// Direction, unit.
    pub direction: DVec3,
    /// Point of the axis nearest to the aim point, world, m.
    pub target: DVec3,
    selected: Option<usize>,
    /// Side of the target to which the lips have stepped, −1 or 1; 0: none.
    side: f64,
    ray: AimRay,
    /// Smoothed displacement of the lips from the ray, m.
    displacement: DVec3,
}

impl Aim {
    /// Sets the camera ray of the pointer, and the distance of the lips before the plane, m.
    pub fn set_ray(&mut self, view: &View, ray: CameraRay, distance: f64) {
        let CameraRay { origin, direction } = ray;
        let facing = (view.eye - view.target).normalize();
        let depth = (view.target - origin).dot(facing) / direction.dot(facing);
        let on_plane = origin + depth * direction;
        let up = (view.up - view.up.dot(direction) * direction).try_normalize().unwrap_or_default();
        self.ray = AimRay { origin, direction, on_plane, lips: on_plane - distance * direction, up };
    }

    /// The lips as they would blow at a point (world, m).
    pub fn lips_facing(&self, point: DVec3) -> DVec3 {
        self.ray.lips_facing(point)
    }

    /// Index of the selected target.
    pub fn selected(&self) -> Option<usize> {
        self.selected
    }

    /// Selects the target of least cost, with hysteresis. The order of the targets must not change between calls.
    pub fn select_target(&mut self, targets: &[AimTarget]) {
        let cost = |&index: &usize| self.ray.cost(&targets[index]);
        let best = (0..targets.len()).min_by(|a, b| cost(a).total_cmp(&cost(b)));
        let keeps = |old: &usize| best.is_some_and(|best| cost(old) * COST.hysteresis < cost(&best));
        let selected = self.selected.filter(keeps).or(best);
        if selected != std::mem::replace(&mut self.selected, selected) {
            self.side = 0.0;
        }
    }

    /// Turns towards the selected target, as it is now, for `dt` seconds; all the way if `dt` is infinite. Without a target
    /// the aim follows the ray.
    pub fn track(&mut self, target: Option<&AimTarget>, dt: f64) {
        let aim_point = target.map(|target| self.ray.aim_point(target));
        let (goal, mut displacement) =
            aim_point.map_or((self.ray.on_plane, DVec3::ZERO), |goal| (goal, self.ray.lip_displacement(goal)));
        let first = self.direction == DVec3::ZERO;
        if let Some(target) = target {
            let to_goal = goal - self.ray.lips - displacement;
            // The side does not change during a breath.
            if first || dt == f64::INFINITY {
                self.side = self.side_of(target, to_goal.normalize_or_zero());
            }
            displacement += self.sidestep(target, to_goal);
        }
        let share = if first { 1.0 } else { 1.0 - exp(-dt / SMOOTHING_TIME) };
        self.displacement += share * (displacement - self.displacement);
        self.mouth = self.ray.lips + self.displacement;
        let direction = (goal - self.mouth).try_normalize().unwrap_or(self.ray.direction);
        self.direction = self.direction.lerp(direction, share).try_normalize().unwrap_or(direction);
        self.target = self.mouth + self.direction * (goal - self.mouth).dot(self.direction);
    }

    /// Side to which the lips step when a breath begins; 0 unless the target is flat, upright and on edge. `ahead`: unit
    /// direction from the lips to it.
    fn side_of(&self, target: &AimTarget, ahead: DVec3) -> f64 {
        let upright = target.normal != DVec3::ZERO && target.normal.dot(self.ray.up).abs() < SIDESTEP.tilt_sine;
        let edge = ahead.dot(target.faces * ahead) < SIDESTEP.angle_sine * SIDESTEP.angle_sine;
        let side = if ahead.dot(target.normal) < 0.0 { -1.0 } else { 1.0 };
        if upright && edge { side } else { 0.0 }
    }

    /// Displacement of the lips to the side of a target's edge, m: at the same distance, in the plane of `to_goal` (from the
    /// lips to the aim point, m) and the target's normal.
    fn sidestep(&self, target: &AimTarget, to_goal: DVec3) -> DVec3 {
        let (distance, ahead) = (to_goal.length(), to_goal.normalize_or_zero());
        let across = ahead.dot(target.normal);
        let along = (ahead - across * target.normal).normalize_or_zero();
        let sine = SIDESTEP.angle_sine;
        if self.side == 0.0 || across * self.side > sine || along == DVec3::ZERO {
            return DVec3::ZERO;
        }
        to_goal - distance * ((1.0 - sine * sine).sqrt() * along + sine * self.side * target.normal)
    }
}

/// A ray from the camera through a point of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRay {
    /// Start of the ray, world, m.
    pub origin: DVec3,
    /// Direction of the ray, unit.
    pub direction: DVec3,
}

impl CameraRay {
    /// Through a point of the picture (picture coordinates) of this width over height.
    pub fn through(view: &View, at: [f64; 2], aspect: f64) -> Self {
        let (origin, direction) = view.ray(at, aspect);
        Self { origin, direction }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VIEW: View = View { eye: DVec3::new(0.0, 0.0, 2.0), target: DVec3::ZERO, up: DVec3::Y, fovy: 0.6 };

    /// A disc of radius 5 cm at x of the target plane, with this normal.
    fn disc(x: f64, normal: DVec3) -> AimTarget {
        let n = normal.normalize();
        let faces = DMat3::from_cols(n * n.x, n * n.y, n * n.z);
        AimTarget { center: DVec3::X * x, radius: 0.05, faces, normal: n, mobility: 1.0, visible: 1.0 }
    }

    /// Target of a breath that is pointed at the middle of the plane.
    fn aim_point(targets: &[AimTarget]) -> DVec3 {
        aim_at(targets, Assist::On).target
    }

    #[derive(Clone, Copy, Debug, PartialEq)]
    enum Assist {
        On,
        Off,
    }

    /// The aim of such a breath with and without aim assist.
    fn aim_at(targets: &[AimTarget], assist: Assist) -> Aim {
        let mut aim = Aim::default();
        let ray = CameraRay { origin: VIEW.eye, direction: (VIEW.target - VIEW.eye).normalize() };
        aim.set_ray(&VIEW, ray, 0.5);
        aim.select_target(targets);
        aim.track(aim.selected().filter(|_| assist == Assist::On).map(|index| &targets[index]), 1.0);
        aim
    }

    #[test]
    fn a_pointed_at_face_is_selected() {
        let target = aim_point(&[disc(0.0, DVec3::Z), disc(0.11, DVec3::Z)]);
        assert!(target.length() < 0.01, "{target}");
        // A face 30° off the ray still counts as a face.
        let target = aim_point(&[disc(0.0, DVec3::new(0.5, 0.0, 0.866)), disc(0.11, DVec3::Z)]);
        assert!(target.length() < 0.01, "{target}");
    }

    #[test]
    fn a_face_is_preferred_to_an_edge_beside_it() {
        let target = aim_point(&[disc(0.0, DVec3::X), disc(0.11, DVec3::Z)]);
        assert!((target.x - 0.11).abs() < 0.05, "{target}");
    }

    #[test]
    fn a_mobile_target_is_preferred_to_a_heavy_one() {
        let heavy = AimTarget { mobility: 0.2, ..disc(0.0, DVec3::Z) };
        let target = aim_point(&[heavy, disc(0.11, DVec3::Z)]);
        assert!((target.x - 0.11).abs() < 0.05, "{target}");
        // But not a distant one.
        let target = aim_point(&[heavy, disc(0.4, DVec3::Z)]);
        assert!(target.length() < 0.01, "{target}");
    }

    #[test]
    fn the_lips_move_to_the_height_of_the_target() {
        const ROUNDING: f64 = 1e-12;
        let low = AimTarget { center: DVec3::new(0.05, -0.3, 0.0), ..disc(0.0, DVec3::Z) };
        for (assist, height) in [(Assist::On, -0.3), (Assist::Off, 0.0)] {
            let aim = aim_at(&[low], assist);
            assert!((aim.mouth.y - height).abs() < 0.05, "assist {assist:?}: {}", aim.mouth);
            assert!((aim.mouth.z - 0.5).abs() < ROUNDING && aim.mouth.x.abs() < ROUNDING, "no nearer: {}", aim.mouth);
            assert!(aim.direction.y.abs() < 0.1, "they blow level: {}", aim.direction);
        }
    }

    #[test]
    fn the_lips_approach_distant_targets_and_step_back_from_close_ones() {
        const ROUNDING: f64 = 1e-12;
        for (behind, nearer) in [(0.2, 0.2), (-0.2, 0.0), (-0.4, -0.15)] {
            let disc = AimTarget { center: DVec3::new(0.0, 0.0, -behind), ..disc(0.0, DVec3::Z) };
            let mouth = aim_at(&[disc], Assist::On).mouth;
            assert!((mouth - DVec3::Z * (0.5 - nearer)).length() < ROUNDING, "{behind} m behind: {mouth}");
        }
    }

    #[test]
    fn the_lips_step_to_the_side_of_an_edge() {
        const ROUNDING: f64 = 1e-12;
        for off in [-0.4_f64, -0.1, 0.0, 0.1, 0.4] {
            let edge = disc(0.0, DVec3::new(1.0, 0.0, off));
            let aim = aim_at(&[edge], Assist::On);
            let (faces, far) = (aim.direction.dot(edge.normal), (edge.center - aim.mouth).length());
            assert!((faces.abs() - SIDESTEP.angle_sine).abs() < ROUNDING && faces * off <= 0.0, "{off}: {faces}");
            assert!((far - 0.5).abs() < ROUNDING, "at the same distance: {far}");
        }
        let face = aim_at(&[disc(0.0, DVec3::new(0.6, 0.0, 0.8))], Assist::On);
        assert!((face.mouth - 0.5 * DVec3::Z).length() < ROUNDING, "{}", face.mouth);
    }

    #[test]
    fn the_first_eigenvector_is_the_normal_of_a_plate() {
        const ROUNDING: f64 = 1e-9;
        let n = DVec3::new(1.0, -2.0, 3.0).normalize();
        let rim = DMat3::from_diagonal(DVec3::splat(0.1 / 3.0));
        let plate = DMat3::from_cols(n * n.x, n * n.y, n * n.z) * 0.9 + rim;
        assert!((first_eigenvector(plate).dot(n).abs() - 1.0).abs() < ROUNDING);
        assert!((first_eigenvector(rim).length() - 1.0).abs() < ROUNDING, "any direction for a ball");
    }

    #[test]
    fn targets_behind_the_lips_are_not_selected() {
        let near = AimTarget { center: DVec3::new(0.0, 0.0, 0.6), ..disc(0.0, DVec3::Z) };
        let target = aim_point(&[near, disc(0.11, DVec3::Z)]);
        assert!((target.x - 0.11).abs() < 0.05 && target.z < 0.1, "{target}");
    }

    #[test]
    fn a_visible_target_is_preferred_to_a_hidden_one() {
        let hidden = AimTarget { visible: 0.0, ..disc(0.0, DVec3::Z) };
        let target = aim_point(&[hidden, disc(0.11, DVec3::Z)]);
        assert!((target.x - 0.11).abs() < 0.05, "{target}");
    }

    #[test]
    fn a_target_is_judged_from_the_lips_that_blow_at_it() {
        // Both are equally far from the ray and turned by 60°; the lips see the edge of one.
        let (away, towards) = (DVec3::new(0.866, 0.0, 0.5), DVec3::new(-0.866, 0.0, 0.5));
        let target = aim_point(&[disc(0.2, away), disc(-0.2, away)]);
        assert!(target.x < 0.0, "{target}");
        let target = aim_point(&[disc(0.2, towards), disc(-0.2, towards)]);
        assert!(target.x > 0.0, "{target}");
    }

    #[test]
    fn an_edge_is_selected_if_there_is_nothing_else() {
        let target = aim_point(&[disc(0.03, DVec3::X)]);
        assert!((target.x - 0.03).abs() < 0.05, "{target}");
        // A distant face is not selected either.
        let target = aim_point(&[disc(0.0, DVec3::X), disc(0.8, DVec3::Z)]);
        assert!(target.length() < 0.01, "{target}");
    }
}
