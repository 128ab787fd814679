//! Pointer grabs: pointers and fingers that pick a body, drag it and throw it.
//!
//! A grab picks the body under the pointer when it goes down, at the point p where the camera ray meets it. From then on p is
//! drawn to the ray (from the camera e, unit direction d), at any distance. The grab sets a desired velocity, not a position:
//!
//! ```text
//! v* = (goal − p)/τ,   |v*| ≤ v_max,   goal = e + d (d · (p − e))
//! ```
//!
//! v* is perpendicular to d. A point that joints keep on a path with tangent t stops where t · v* = 0, which is where the path
//! comes nearest to the ray. So the grabbed point ends under the finger however obliquely the camera looks.
//!
//! In position-based motion p moves by v* Δt. In constrained dynamics the grab is a force F that would give p that velocity
//! within the step. With W the inverse mass matrix of the grabbed points (`Dynamics::effective_inverse_mass`), joints included, and W_ii the
//! block of one grab, Gauss–Seidel iteration over the grabs adds
//!
//! ```text
//! ΔP = W_ii (W_ii² + ε² E)⁻¹ (v* − v),   |P| ≤ min(F_max, m a_max) Δt,   F = P/Δt
//! ```
//!
//! where m = 3/tr W_ii is the effective mass, so that a light limb is not torn off. ε (damped least squares: C. W. Wampler,
//! IEEE Trans. Systems, Man, and Cybernetics 16, 1986) keeps a grab from straining against a joint. There is no spring that
//! could be too stiff. A released body keeps its velocity, so it can be thrown.

use serde::{Deserialize, Serialize};

use super::aim::CameraRay;
use soffio_exhibit::{Exhibit, View};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, add_wrench};
use soffio_math::{DMat3, DVec3};
use soffio_multibody::dynamics::Dynamics;
use soffio_multibody::procedural::{GrabTarget, MAX_GRABS};
use soffio_wind::force::WindField;

/// A pointer or finger that is down on the sculpture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointerGrab {
    /// Number of the pointer, the same from press to release.
    pub id: u64,
    /// Picture coordinates.
    pub at: [f64; 2],
    /// The body to grab by its centre of mass; `None` picks the one under the pointer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<usize>,
}

/// How strongly a grab pulls.
struct Tuning {
    /// τ: time constant of the grabbed point, s.
    time_constant: f64,
    /// v_max, m/s: a brisk wave of the arm.
    most_speed: f64,
    /// a_max, m/s²: v_max is reached in a twentieth of a second.
    most_acceleration: f64,
    /// ε over the mean of the diagonal of W_ii.
    damping: f64,
    /// Gauss–Seidel sweeps over all grabs.
    sweeps: usize,
    /// Pick radius about a thin part, picture heights: half a fingertip on a 55-inch display.
    finger: f64,
}

const TUNING: Tuning =
    Tuning { time_constant: 0.05, most_speed: 2.5, most_acceleration: 50.0, damping: 0.02, sweeps: 12, finger: 0.012 };
/// Pick positions around a finger under which there is nothing, in pick radii.
const AROUND: [[f64; 2]; 8] =
    [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0], [0.7, 0.7], [-0.7, 0.7], [0.7, -0.7], [-0.7, -0.7]];

/// A point of a body.
#[derive(Clone, Copy, Debug)]
struct GrabbedPoint {
    body: usize,
    /// Node frame, m.
    point: DVec3,
}

/// A pointer that is down.
#[derive(Clone, Copy, Debug)]
struct Grab {
    id: u64,
    /// `None` if there was nothing to grab.
    grabbed: Option<GrabbedPoint>,
    /// Where the point is drawn to, world, m.
    goal: DVec3,
}

/// What pointers may pick, as the camera sees it.
pub struct PickScene<'a> {
    /// The camera.
    pub view: &'a View,
    /// Width over height of the picture.
    pub aspect: f64,
    /// The exhibit.
    pub exhibit: &'a Exhibit,
    /// Present state of all bodies.
    pub bodies: &'a [RigidBody],
    /// Of each body; kinematic bodies cannot be grabbed.
    pub is_kinematic: &'a [bool],
}

/// All pointer grabs of an exhibit.
#[derive(Clone, Debug)]
pub struct PointerGrabs {
    grabs: Vec<Grab>,
    targets: Vec<GrabTarget>,
    points: Vec<(usize, DVec3)>,
    /// W, blocks of one grab on another, row by row.
    inverse_mass: [DMat3; MAX_GRABS * MAX_GRABS],
    /// F_max, N.
    force: f64,
    permitted: bool,
    /// Bodies that each body is dragged together with, and where they start from it, m.
    together: Vec<Vec<(usize, DVec3)>>,
}

impl PointerGrabs {
    /// No grabs.
    pub fn new(exhibit: &Exhibit) -> Self {
        Self {
            grabs: Vec::with_capacity(MAX_GRABS),
            targets: Vec::with_capacity(MAX_GRABS),
            points: Vec::with_capacity(MAX_GRABS),
            inverse_mass: [DMat3::ZERO; MAX_GRABS * MAX_GRABS],
            force: exhibit.touch.force,
            permitted: exhibit.touch.permitted,
            together: (0..exhibit.bodies.len()).map(|body| together(exhibit, body)).collect(),
        }
    }

    /// Releases everything.
    pub fn clear(&mut self) {
        self.grabs.clear();
        self.targets.clear();
    }

    /// The point of the first grab that has a body, world, m.
    pub fn first(&self, bodies: &[RigidBody]) -> Option<DVec3> {
        let grabbed = self.grabs.iter().find_map(|grab| grab.grabbed)?;
        Some(bodies[grabbed.body].pose().point(grabbed.point))
    }

    /// Number of grabs that have a body.
    pub fn count(&self) -> usize {
        self.grabs.iter().filter(|grab| grab.grabbed.is_some()).count()
    }

    /// Whether a pointer at this place of the picture would grab a body.
    pub fn hit_test(&self, at: [f64; 2], wind: &mut WindField, scene: &PickScene) -> bool {
        self.permitted && pick(at, wind, scene).is_some_and(|(body, _)| !scene.is_kinematic[body])
    }

    /// Grabs, drags and releases, as the first [`MAX_GRABS`] of `pointers` say.
    pub fn update(&mut self, pointers: &[PointerGrab], wind: &mut WindField, scene: &PickScene) {
        let PickScene { view, aspect, bodies, is_kinematic, .. } = *scene;
        self.grabs.retain(|grab| pointers.iter().any(|pointer| pointer.id == grab.id));
        if !self.permitted {
            return;
        }
        for pointer in pointers.iter().filter(|pointer| pointer.at.iter().all(|x| x.is_finite())) {
            let known = self.grabs.iter().position(|grab| grab.id == pointer.id);
            if known.is_none() && self.grabs.len() < MAX_GRABS {
                let picked = match pointer.body {
                    Some(body) => bodies.get(body).map(|b| (body, b.position)),
                    None => pick(pointer.at, wind, scene),
                };
                let picked = picked.filter(|(body, _)| !is_kinematic[*body]);
                let local = |(body, point)| GrabbedPoint { body, point: bodies[body].pose().inverse_point(point) };
                self.grabs.push(Grab { id: pointer.id, grabbed: picked.map(local), goal: DVec3::ZERO });
            }
            if let Some(grab) = self.grabs.iter_mut().find(|grab| grab.id == pointer.id)
                && let Some(GrabbedPoint { body, point }) = grab.grabbed
            {
                let CameraRay { origin, direction } = CameraRay::through(view, pointer.at, aspect);
                grab.goal = origin + direction * (bodies[body].pose().point(point) - origin).dot(direction);
            }
        }
    }

    /// The first [`MAX_GRABS`] points of the bodies that are `own`, each with its goal (world, m): those of the grabs, and of bodies that are
    /// dragged with them.
    fn grabbed_points(&self, own: &[bool]) -> impl Iterator<Item = (GrabbedPoint, DVec3)> {
        let Self { grabs, together, .. } = self;
        let grabbed = grabs.iter().filter_map(|grab| Some((grab.grabbed?, grab.goal)));
        let all = grabbed.flat_map(|(GrabbedPoint { body, point }, goal)| {
            let others = together[body].iter();
            let others = others.map(move |&(body, from)| (GrabbedPoint { body, point }, goal + from));
            std::iter::once((GrabbedPoint { body, point }, goal)).chain(others)
        });
        all.filter(|(grabbed, _)| own[grabbed.body]).take(MAX_GRABS)
    }

    /// Target positions of the points of bodies that are `own` after `dt` seconds, for position-based motion.
    pub fn position_targets(&mut self, own: &[bool], bodies: &[RigidBody], dt: f64) -> &[GrabTarget] {
        let mut targets = std::mem::take(&mut self.targets);
        targets.clear();
        for (GrabbedPoint { body, point }, goal) in self.grabbed_points(own) {
            let now = bodies[body].pose().point(point);
            targets.push(GrabTarget { body, point, target: now + dt * desired_velocity(goal, now) });
        }
        self.targets = targets;
        &self.targets
    }

    /// Adds the forces of the grabs on bodies that are `own` (N, N m about each centre of mass) for a step of `dt` seconds of
    /// constrained dynamics.
    pub fn apply_forces(&mut self, own: &[bool], dynamics: &mut Dynamics, dt: f64, out: &mut [Vec6]) {
        let mut points = std::mem::take(&mut self.points);
        points.clear();
        // v* − v without impulses, m/s.
        let mut errors = [DVec3::ZERO; MAX_GRABS];
        for (GrabbedPoint { body, point }, goal) in self.grabbed_points(own) {
            let state = &dynamics.bodies[body];
            let now = state.pose().point(point);
            let arm = now - state.position;
            let velocity = state.velocity + state.angular_velocity.cross(arm);
            errors[points.len()] = desired_velocity(goal, now) - velocity;
            points.push((body, now));
        }
        self.points = points;
        let n = self.points.len();
        if n == 0 {
            return;
        }
        let w = &mut self.inverse_mass[..n * n];
        dynamics.effective_inverse_mass(&self.points, w);
        let mut impulses = [DVec3::ZERO; MAX_GRABS];
        for _ in 0..TUNING.sweeps {
            for i in 0..n {
                let error = errors[i] - (0..n).fold(DVec3::ZERO, |sum, j| sum + w[i * n + j] * impulses[j]);
                let impulse = impulses[i] + damped_inverse(&w[i * n + i]) * error;
                let most_force = self.force.min(TUNING.most_acceleration / mean_diagonal(&w[i * n + i]));
                impulses[i] = impulse.clamp_length_max(dt * most_force);
            }
        }
        for ((body, point), impulse) in self.points.iter().zip(impulses) {
            let force = impulse / dt;
            if force.is_finite() {
                add_wrench(&mut out[*body], *point - dynamics.bodies[*body].position, force);
            }
        }
    }
}

/// Bodies that are dragged together with a body, and where they start from it, m.
fn together(exhibit: &Exhibit, body: usize) -> Vec<(usize, DVec3)> {
    let lists = exhibit.touch.together.iter().filter(|list| list.contains(&body)).flatten();
    let from = |other: usize| exhibit.bodies[other].pose.position - exhibit.bodies[body].pose.position;
    lists.filter(|&&other| other != body).map(|&other| (other, from(other))).collect()
}

/// v* of a point (world, m) on its way to `goal`, m/s.
fn desired_velocity(goal: DVec3, point: DVec3) -> DVec3 {
    ((goal - point) / TUNING.time_constant).clamp_length_max(TUNING.most_speed)
}

/// Mean of the diagonal, 1/kg.
fn mean_diagonal(w: &DMat3) -> f64 {
    (w.x_axis.x + w.y_axis.y + w.z_axis.z) / 3.0
}

/// W (W² + ε² E)⁻¹ of a symmetric W; 0 where ε is not positive.
fn damped_inverse(w: &DMat3) -> DMat3 {
    let epsilon = TUNING.damping * mean_diagonal(w);
    if epsilon <= 0.0 || !epsilon.is_finite() {
        return DMat3::ZERO;
    }
    *w * (*w * *w + DMat3::from_diagonal(DVec3::splat(epsilon * epsilon))).inverse()
}

/// The body under a place of the picture, and its point there (world, m). If there is nothing, the nearest wire or body
/// within a finger's breadth. Fixed meshes hide bodies behind them.
fn pick(at: [f64; 2], wind: &mut WindField, scene: &PickScene) -> Option<(usize, DVec3)> {
    let PickScene { view, aspect, bodies, .. } = *scene;
    let occluders = wind.occluders_at(bodies);
    let first_hit = |at: [f64; 2]| {
        let CameraRay { origin, direction } = CameraRay::through(view, at, aspect);
        occluders.first(origin, direction).map(|(body, distance)| (body, origin + distance * direction))
    };
    if let Some((body, point)) = first_hit(at) {
        return body.map(|body| (body, point));
    }
    pick_wire(CameraRay::through(view, at, aspect), scene).or_else(|| {
        let beside =
            |offset: &[f64; 2]| [at[0] + TUNING.finger * offset[0] / aspect, at[1] + TUNING.finger * offset[1]];
        AROUND.iter().find_map(|offset| first_hit(beside(offset)).and_then(|(body, point)| Some((body?, point))))
    })
}

/// The moving wire nearest to a camera ray, within a finger's breadth, and its nearest point (world, m).
fn pick_wire(ray: CameraRay, scene: &PickScene) -> Option<(usize, DVec3)> {
    let CameraRay { origin, direction } = ray;
    let PickScene { view, exhibit, bodies, .. } = *scene;
    let forward = view.axes().2;
    let mut best: Option<(f64, usize, DVec3)> = None;
    for wire in &exhibit.wires {
        let Some(body) = wire.body else { continue };
        let pose = bodies[body].pose();
        for ends in wire.points.windows(2) {
            let (a, b) = (pose.point(ends[0]), pose.point(ends[1]));
            let point = nearest_on_segment(ray, a, b);
            let (depth, along) = ((point - origin).dot(forward), (point - origin).dot(direction));
            let off = (point - origin - along * direction).length() - wire.radius;
            let within = depth > 0.0 && off < TUNING.finger * view.height_at(depth);
            if within && best.is_none_or(|(least, ..)| off < least) {
                best = Some((off, body, point));
            }
        }
    }
    best.map(|(_, body, point)| (body, point))
}

/// The point of the segment from `a` to `b` that is nearest to the line of a ray.
fn nearest_on_segment(ray: CameraRay, a: DVec3, b: DVec3) -> DVec3 {
    let CameraRay { origin, direction } = ray;
    let across = |v: DVec3| v - v.dot(direction) * direction;
    let (from, edge) = (across(a - origin), across(b - a));
    let square = edge.length_squared();
    let s = if square > 0.0 { (-from.dot(edge) / square).clamp(0.0, 1.0) } else { 0.0 };
    a + s * (b - a)
}
