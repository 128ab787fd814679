//! Where the breath goes: from the pointer to lips before the sculpture.
//!
//! The lips lie on the camera ray of the pointer, `distance` before the plane through the view's target that faces
//! the eye. In the *true* profile the breath follows the ray. In the *gallery* profile it leans towards the nearest
//! surface when the ray passes it by, as a visitor leans to blow at a thing: without it, a breath at the centre of
//! the picture could pass between the plates and move nothing. The lips too come to the height of that surface, as a visitor
//! stoops: what hangs low would else be blown at from above, past all that hangs before it. And where it hangs behind the
//! plane they come nearer by as much, as a visitor steps up: from afar a small disc would get a breath's rim only; and a step
//! back from what hangs right before them. What hangs flat and turns its edge to them as they begin they blow at from the side, as a
//! visitor steps aside, at 30° to it.
//!
//! A visitor blows at what will move: not at the edge of a plate when another shows its face, nor at the heavy end of a
//! rod when a light disc hangs beside it. Yet what is pointed at is left only for what answers far better:
//!
//! ```text
//! the breath goes to the surface with the least (e + e₀)/(f q)
//! e   how far the ray passes by the inner half of the ball around it, m
//! f   √(s dᵀ⟨n nᵀ⟩d), √s |cos θ| for a plate: wind along d, from the lips to its middle, presses on a surface by A f²
//!     (A: its area, n: its normals, s: how much of what faces the lips nothing hides from them); what takes less than a
//!     tenth of it so is an edge
//! q   ⁴√(w A), over the largest of all: where the joints let 1 N move its middle by w m/s², wind that it faces sets off
//!     an acceleration in proportion to w A
//! ```

use soffio_exhibit::View;
use soffio_geometry::TriangleMesh;
use soffio_math::{DMat3, DVec3, Pose, exp};
use soffio_multibody::dynamics::Dynamics;

/// A surface that breath leans to: the ball around it, how it faces, and how readily it moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AimTarget {
    /// m.
    pub center: DVec3,
    /// m.
    pub radius: f64,
    /// Mean of n nᵀ over the area: the orientation tensor, of trace 1.
    pub faces: DMat3,
    /// The way that what is flat faces, unit: the tensor's first eigenvector; 0 of what is not.
    pub normal: DVec3,
    /// q: how readily it answers a wind that it faces, 0 … 1.
    pub answers: f64,
    /// s: how much of it the lips see, 0 … 1.
    pub seen: f64,
}

impl AimTarget {
    /// A mesh that hangs in a figure, in the frame of its body.
    pub fn of(mesh: &TriangleMesh, body: usize, dynamics: &mut Dynamics) -> Self {
        let (center, radius) = mesh.ball();
        let at = dynamics.bodies[body].pose().point(center);
        let mut answer = [DMat3::ZERO];
        dynamics.effective_inverse_mass(&[(body, at)], &mut answer);
        let [w] = answer.map(|w| (w.x_axis.x + w.y_axis.y + w.z_axis.z) / 3.0);
        let (faces, answers) = (mesh.orientation(), (w * mesh.area()).max(0.0).sqrt().sqrt());
        let normal = first_eigenvector(faces);
        let normal = if normal.dot(faces * normal) > FLAT { normal } else { DVec3::ZERO };
        Self { center, radius, faces, normal, answers, seen: 1.0 }
    }

    /// Carried to where a body stands.
    pub fn at(&self, pose: Pose) -> Self {
        let turn = DMat3::from_quat(pose.rotation);
        Self {
            center: pose.point(self.center),
            faces: turn * self.faces * turn.transpose(),
            normal: turn * self.normal,
            ..*self
        }
    }
}

/// Of a tensor with no negative eigenvalue, by squaring it, unit.
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

/// e₀: what lies so near the ray is in the middle of the breath, m.
const NEAR: f64 = 0.03;
/// A surface on which wind presses by less than this share of its area is an edge.
const EDGE: f64 = 0.1;
/// What faces one way and the other with more of itself than this is flat.
const FLAT: f64 = 0.7;
/// And stands upright up to this sine of its tilt, 30°: nobody blows from above or from below at what lies.
const UPRIGHT: f64 = 0.5;
/// Sine of the angle between lips and edge from which nobody steps aside, 30°.
const ASIDE: f64 = 0.5;
/// What an edge counts for, or what cannot move: with nothing else before it, the breath leans to it all the same.
const LEAST: f64 = 0.05;
/// Lips are never nearer to what they blow at than this share of their distance from the plane: a breath is a thread there.
const CLOSEST: f64 = 0.5;
/// Nobody blows at what hangs beside or behind their lips: the least cosine between the way there and the ray.
const AHEAD: f64 = 0.5;
/// Another surface must be better by this share before the breath leaves the one it leans to.
const LOYALTY: f64 = 0.7;
/// The ray itself is followed within this share of a surface's ball. Farther out a long plate leaves most of its ball
/// to the air, so there the breath slides back towards the middle.
const INNER: f64 = 0.5;
/// A ray that misses the ball altogether is drawn this near to the middle: on the surface, wherever it has turned.
const MIDDLE: f64 = 0.2;
/// The lean follows its goal with this time constant, s: no jumps while blowing.
const LEAN_TIME: f64 = 0.08;

/// A sight line, and lips on it that come to something: to its height, across the ray and upright in the picture, and as near to
/// it as to the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sight {
    origin: DVec3,
    ray: DVec3,
    /// Where it meets the plane through the view's target that faces the eye.
    on_plane: DVec3,
    lips: DVec3,
    upright: DVec3,
}

impl Sight {
    /// How the lips come to a place, m: they rise, go nearer where it lies behind the plane, and step back where it is before
    /// them by less than half of what the plane is.
    fn coming(&self, place: DVec3) -> DVec3 {
        let [before, usual] = [place, self.on_plane].map(|place| (place - self.lips).dot(self.ray));
        let nearer = (before - usual).max(0.0) + if before > 0.0 { (before - CLOSEST * usual).min(0.0) } else { 0.0 };
        self.rising(place) + nearer * self.ray
    }

    /// How the lips rise to the height of a place, m.
    fn rising(&self, place: DVec3) -> DVec3 {
        (place - self.lips).dot(self.upright) * self.upright
    }

    /// The lips that have come to a place.
    fn lips_before(&self, place: DVec3) -> DVec3 {
        self.lips + self.coming(place)
    }

    /// From the ray to a target's middle, m.
    fn off(&self, target: &AimTarget) -> DVec3 {
        let from = target.center - self.origin;
        from - from.dot(self.ray) * self.ray
    }

    /// How little is to be had of a target.
    fn lacks(&self, target: &AimTarget) -> f64 {
        let from = |lips: DVec3| (target.center - lips).try_normalize().unwrap_or(self.ray);
        let ahead = from(self.lips + self.rising(target.center)).dot(self.ray) > AHEAD;
        let way = from(self.lips_before(target.center));
        let pressed = if ahead { target.seen * way.dot(target.faces * way) } else { 0.0 };
        let face = if pressed > EDGE { pressed.sqrt() } else { 0.0 };
        let past = (self.off(target).length() - INNER * target.radius).max(0.0);
        (past + NEAR) / (face * target.answers).max(LEAST)
    }

    /// The point of a target's ball that the breath goes to.
    fn goal(&self, target: &AimTarget) -> DVec3 {
        let off = self.off(target);
        let miss = off.length() / target.radius;
        let back = INNER - (INNER - MIDDLE) * (miss - INNER) / (1.0 - INNER);
        let kept = miss.min(back.max(MIDDLE));
        target.center - off.normalize_or_zero() * (kept * target.radius)
    }
}

/// The breath's axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Aim {
    /// Centre of the lips, world, m.
    pub mouth: DVec3,
    /// Unit.
    pub direction: DVec3,
    /// Where the axis comes nearest to what it is aimed at, world, m.
    pub target: DVec3,
    chosen: Option<usize>,
    /// To which side of it the lips have stepped, −1 or 1; 0 where they have not.
    side: f64,
    sight: Sight,
    /// How the lips have come to it, m.
    come: DVec3,
}

impl Aim {
    /// Points along the sight line through the pointer (origin and unit direction), lips `distance` (m) before the plane.
    pub fn point(&mut self, view: &View, (origin, ray): (DVec3, DVec3), distance: f64) {
        let facing = (view.eye - view.target).normalize();
        let depth = (view.target - origin).dot(facing) / ray.dot(facing);
        let on_plane = origin + depth * ray;
        let upright = (view.up - view.up.dot(ray) * ray).try_normalize().unwrap_or_default();
        self.sight = Sight { origin, ray, on_plane, lips: on_plane - distance * ray, upright };
    }

    /// Where the lips would be to blow at a place.
    pub fn lips_before(&self, place: DVec3) -> DVec3 {
        self.sight.lips_before(place)
    }

    /// Which of these the breath leans to.
    pub fn chosen(&self) -> Option<usize> {
        self.chosen
    }

    /// Chooses again among all of them, of which there are ever the same.
    pub fn choose(&mut self, targets: &[AimTarget]) {
        let lacks = |&index: &usize| self.sight.lacks(&targets[index]);
        let best = (0..targets.len()).min_by(|a, b| lacks(a).total_cmp(&lacks(b)));
        let keeps = |old: &usize| best.is_some_and(|best| lacks(old) * LOYALTY < lacks(&best));
        let chosen = self.chosen.filter(keeps).or(best);
        if chosen != std::mem::replace(&mut self.chosen, chosen) {
            self.side = 0.0;
        }
    }

    /// Leans to what is chosen, as it stands now, for `dt` seconds, all the way in infinite ones; with nothing to lean to it follows
    /// the sight line.
    pub fn lean(&mut self, target: Option<&AimTarget>, dt: f64) {
        let leant = target.map(|target| self.sight.goal(target));
        let (goal, mut coming) =
            leant.map_or((self.sight.on_plane, DVec3::ZERO), |goal| (goal, self.sight.coming(goal)));
        let first = self.direction == DVec3::ZERO;
        if let Some(target) = target {
            let way = goal - self.sight.lips - coming;
            // Whoever blows stays where they stand.
            if first || dt == f64::INFINITY {
                self.side = self.side_of(target, way.normalize_or_zero());
            }
            coming += self.aside(target, way);
        }
        let share = if first { 1.0 } else { 1.0 - exp(-dt / LEAN_TIME) };
        self.come += share * (coming - self.come);
        self.mouth = self.sight.lips + self.come;
        let direction = (goal - self.mouth).try_normalize().unwrap_or(self.sight.ray);
        self.direction = self.direction.lerp(direction, share).try_normalize().unwrap_or(direction);
        self.target = self.mouth + self.direction * (goal - self.mouth).dot(self.direction);
    }

    /// To which side the lips step of what lies so before them as they begin: 0 unless that is flat, upright and on edge.
    fn side_of(&self, target: &AimTarget, ahead: DVec3) -> f64 {
        let upright = target.normal != DVec3::ZERO && target.normal.dot(self.sight.upright).abs() < UPRIGHT;
        let edge = ahead.dot(target.faces * ahead) < ASIDE * ASIDE;
        let side = if ahead.dot(target.normal) < 0.0 { -1.0 } else { 1.0 };
        if upright && edge { side } else { 0.0 }
    }

    /// How the lips step aside of a target's edge that lies so before them, m: as far from it, in the plane of the way to it and of
    /// its normal.
    fn aside(&self, target: &AimTarget, way: DVec3) -> DVec3 {
        let (distance, ahead) = (way.length(), way.normalize_or_zero());
        let across = ahead.dot(target.normal);
        let along = (ahead - across * target.normal).normalize_or_zero();
        if self.side == 0.0 || across * self.side > ASIDE || along == DVec3::ZERO {
            return DVec3::ZERO;
        }
        way - distance * ((1.0 - ASIDE * ASIDE).sqrt() * along + ASIDE * self.side * target.normal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EYE: View = View { eye: DVec3::new(0.0, 0.0, 2.0), target: DVec3::ZERO, up: DVec3::Y, fovy: 0.6 };

    /// A disc of 5 cm at a place of the plane that is looked at, facing so.
    fn disc(x: f64, normal: DVec3) -> AimTarget {
        let n = normal.normalize();
        let faces = DMat3::from_cols(n * n.x, n * n.y, n * n.z);
        AimTarget { center: DVec3::X * x, radius: 0.05, faces, normal: n, answers: 1.0, seen: 1.0 }
    }

    /// Where a breath goes that is pointed at the plane's middle for a while.
    fn goes(targets: &[AimTarget]) -> DVec3 {
        aimed(targets, true).target
    }

    /// A breath that is pointed there, and leans or does not.
    fn aimed(targets: &[AimTarget], leans: bool) -> Aim {
        let mut aim = Aim::default();
        aim.point(&EYE, (EYE.eye, (EYE.target - EYE.eye).normalize()), 0.5);
        aim.choose(targets);
        aim.lean(aim.chosen().filter(|_| leans).map(|chosen| &targets[chosen]), 1.0);
        aim
    }

    #[test]
    fn it_goes_to_what_is_pointed_at_when_that_shows_its_face() {
        let target = goes(&[disc(0.0, DVec3::Z), disc(0.11, DVec3::Z)]);
        assert!(target.length() < 0.01, "{target}");
        // A third of a right angle off is a face still.
        let target = goes(&[disc(0.0, DVec3::new(0.5, 0.0, 0.866)), disc(0.11, DVec3::Z)]);
        assert!(target.length() < 0.01, "{target}");
    }

    #[test]
    fn it_leaves_an_edge_for_a_face_beside_it() {
        let target = goes(&[disc(0.0, DVec3::X), disc(0.11, DVec3::Z)]);
        assert!((target.x - 0.11).abs() < 0.05, "{target}");
    }

    #[test]
    fn it_leaves_what_hardly_moves_for_what_does() {
        let heavy = AimTarget { answers: 0.2, ..disc(0.0, DVec3::Z) };
        let target = goes(&[heavy, disc(0.11, DVec3::Z)]);
        assert!((target.x - 0.11).abs() < 0.05, "{target}");
        // Not from far.
        let target = goes(&[heavy, disc(0.4, DVec3::Z)]);
        assert!(target.length() < 0.01, "{target}");
    }

    #[test]
    fn the_lips_come_to_the_height_of_what_they_blow_at() {
        const ROUNDING: f64 = 1e-12;
        let low = AimTarget { center: DVec3::new(0.05, -0.3, 0.0), ..disc(0.0, DVec3::Z) };
        for (leans, height) in [(true, -0.3), (false, 0.0)] {
            let aim = aimed(&[low], leans);
            assert!((aim.mouth.y - height).abs() < 0.05, "leans: {leans}, {}", aim.mouth);
            assert!((aim.mouth.z - 0.5).abs() < ROUNDING && aim.mouth.x.abs() < ROUNDING, "no nearer: {}", aim.mouth);
            assert!(aim.direction.y.abs() < 0.1, "they blow level: {}", aim.direction);
        }
    }

    #[test]
    fn the_lips_come_as_near_to_what_hangs_behind_as_to_the_plane_and_step_back_from_what_hangs_close() {
        const ROUNDING: f64 = 1e-12;
        for (behind, nearer) in [(0.2, 0.2), (-0.2, 0.0), (-0.4, -0.15)] {
            let disc = AimTarget { center: DVec3::new(0.0, 0.0, -behind), ..disc(0.0, DVec3::Z) };
            let mouth = aimed(&[disc], true).mouth;
            assert!((mouth - DVec3::Z * (0.5 - nearer)).length() < ROUNDING, "{behind} m behind: {mouth}");
        }
    }

    #[test]
    fn the_lips_step_aside_of_an_edge() {
        const ROUNDING: f64 = 1e-12;
        for off in [-0.4_f64, -0.1, 0.0, 0.1, 0.4] {
            let edge = disc(0.0, DVec3::new(1.0, 0.0, off));
            let aim = aimed(&[edge], true);
            let (faces, far) = (aim.direction.dot(edge.normal), (edge.center - aim.mouth).length());
            assert!((faces.abs() - ASIDE).abs() < ROUNDING && faces * off <= 0.0, "{off}: {faces}");
            assert!((far - 0.5).abs() < ROUNDING, "as far from it: {far}");
        }
        let face = aimed(&[disc(0.0, DVec3::new(0.6, 0.0, 0.8))], true);
        assert!((face.mouth - 0.5 * DVec3::Z).length() < ROUNDING, "{}", face.mouth);
    }

    #[test]
    fn a_tensors_first_eigenvector_is_the_way_most_of_it_faces() {
        const ROUNDING: f64 = 1e-9;
        let n = DVec3::new(1.0, -2.0, 3.0).normalize();
        let rim = DMat3::from_diagonal(DVec3::splat(0.1 / 3.0));
        let plate = DMat3::from_cols(n * n.x, n * n.y, n * n.z) * 0.9 + rim;
        assert!((first_eigenvector(plate).dot(n).abs() - 1.0).abs() < ROUNDING);
        assert!((first_eigenvector(rim).length() - 1.0).abs() < ROUNDING, "of a ball any");
    }

    #[test]
    fn it_does_not_turn_round_to_what_hangs_behind_the_lips() {
        let near = AimTarget { center: DVec3::new(0.0, 0.0, 0.6), ..disc(0.0, DVec3::Z) };
        let target = goes(&[near, disc(0.11, DVec3::Z)]);
        assert!((target.x - 0.11).abs() < 0.05 && target.z < 0.1, "{target}");
    }

    #[test]
    fn it_leaves_what_is_hidden_for_what_the_lips_see() {
        let hidden = AimTarget { seen: 0.0, ..disc(0.0, DVec3::Z) };
        let target = goes(&[hidden, disc(0.11, DVec3::Z)]);
        assert!((target.x - 0.11).abs() < 0.05, "{target}");
    }

    #[test]
    fn what_counts_is_how_a_surface_faces_the_lips_that_lean_to_it() {
        // Both as far to the side, both a third of a right angle off the ray; the lips see the one's edge.
        let (away, towards) = (DVec3::new(0.866, 0.0, 0.5), DVec3::new(-0.866, 0.0, 0.5));
        let target = goes(&[disc(0.2, away), disc(-0.2, away)]);
        assert!(target.x < 0.0, "{target}");
        let target = goes(&[disc(0.2, towards), disc(-0.2, towards)]);
        assert!(target.x > 0.0, "{target}");
    }

    #[test]
    fn it_goes_to_an_edge_when_there_is_nothing_else() {
        let target = goes(&[disc(0.03, DVec3::X)]);
        assert!((target.x - 0.03).abs() < 0.05, "{target}");
        // Nor does it look for a face at the other end of the room.
        let target = goes(&[disc(0.0, DVec3::X), disc(0.8, DVec3::Z)]);
        assert!(target.length() < 0.01, "{target}");
    }
}
