//! Hands on the sculpture: pointers and fingers that take a body, drag it and throw it.
//!
//! A hand takes what lies under it when it comes, at the point p where the sight line meets it, and from then on wants p
//! on its sight line (from the eye e, unit direction d), no matter how far away. It asks for a speed, not for a place,
//!
//! ```text
//! v* = (goal − p)/τ,   |v*| ≤ v_max,   goal = e + d (d · (p − e))
//! ```
//!
//! v* is across d. A point that joints keep on a way with tangent t rests where t · v* = 0 as well, and that is where way
//! and sight line come nearest to each other: however obliquely the eye looks, what is held ends under the finger.
//!
//! Moved by places, p goes on by v* Δt. Moved by the laws, the hand is a force F that would give the point that speed
//! within the step. With W the answers of the points to impulses there, joints included (`Dynamics::answers`), and W_ii the
//! block of one hand, each hand in turn adds
//!
//! ```text
//! ΔP = W_ii (W_ii² + ε² E)⁻¹ (v* − v),   |P| ≤ min(F_max, m a_max) Δt,   F = P/Δt
//! ```
//!
//! until all have what they ask for; m = 3/tr W_ii is what the hand has in it, so that a light limb is not torn off. ε (damped least squares: C. W. Wampler, IEEE Trans. Systems, Man, and Cybernetics 16,
//! 1986) keeps a hand from straining where a joint gives no way. There is no spring that could be too stiff, so nothing
//! explodes whatever is taken; what is let go keeps its speed, so it can be thrown.

use serde::{Deserialize, Serialize};

use soffio_exhibit::{Exhibit, View};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, add_wrench};
use soffio_math::{DMat3, DVec3};
use soffio_multibody::dynamics::Dynamics;
use soffio_multibody::procedural::{Grip, MOST_GRIPS};
use soffio_wind::force::WindField;

/// A pointer or finger that is down on the sculpture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hand {
    /// Which; the same from coming to going.
    pub id: u64,
    /// Picture coordinates.
    pub at: [f64; 2],
    /// The body that it takes by its centre of mass; `None` takes what lies under it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<usize>,
}

/// τ: what is held follows with this time constant, s.
const FOLLOWS: f64 = 0.05;
/// v_max, m/s: a brisk wave of the arm.
const FASTEST: f64 = 2.5;
/// a_max, m/s²: what is held gets as fast as the hand in a twentieth of a second.
const BRISKEST: f64 = 50.0;
/// ε over the mean of the diagonal of W_ii.
const DAMPED: f64 = 0.02;
/// Rounds in which several hands agree.
const ROUNDS: usize = 12;
/// How far beside a thin part a finger still takes it, picture heights: half a fingertip on a 55-inch picture.
const FINGER: f64 = 0.012;
/// Places that are tried around a finger that points at nothing.
const AROUND: [[f64; 2]; 8] =
    [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0], [0.7, 0.7], [-0.7, 0.7], [0.7, -0.7], [-0.7, -0.7]];

/// A hand that has come.
#[derive(Clone, Copy, Debug)]
struct Held {
    id: u64,
    /// What it took: the body, and the point in its node frame.
    took: Option<(usize, DVec3)>,
    /// Where the point is to be, world, m.
    goal: DVec3,
}

/// All hands on an exhibit.
#[derive(Clone, Debug)]
pub struct Hands {
    held: Vec<Held>,
    grips: Vec<Grip>,
    points: Vec<(usize, DVec3)>,
    answers: [DMat3; MOST_GRIPS * MOST_GRIPS],
    /// F_max, N.
    force: f64,
    permitted: bool,
}

impl Hands {
    /// No hands yet.
    pub fn new(exhibit: &Exhibit) -> Self {
        Self {
            held: Vec::with_capacity(MOST_GRIPS),
            grips: Vec::with_capacity(MOST_GRIPS),
            points: Vec::with_capacity(MOST_GRIPS),
            answers: [DMat3::ZERO; MOST_GRIPS * MOST_GRIPS],
            force: exhibit.touch.force,
            permitted: exhibit.touch.permitted,
        }
    }

    /// Lets go of everything.
    pub fn clear(&mut self) {
        self.held.clear();
        self.grips.clear();
    }

    /// What is held: the first hand's point, world, m.
    pub fn first(&self, bodies: &[RigidBody]) -> Option<DVec3> {
        self.held.iter().find_map(|held| held.took.map(|(body, point)| bodies[body].pose().point(point)))
    }

    /// How many bodies are held, counted by hands.
    pub fn count(&self) -> usize {
        self.held.iter().filter(|held| held.took.is_some()).count()
    }

    /// Would a hand at this place take something?
    pub fn would_take(
        &self,
        at: [f64; 2],
        view: (&View, f64),
        wind: &mut WindField,
        (exhibit, bodies, driven): (&Exhibit, &[RigidBody], &[bool]),
    ) -> bool {
        self.permitted && take(at, view, wind, exhibit, bodies).is_some_and(|(body, _)| !driven[body])
    }

    /// Takes, drags and lets go, as the first [`MOST_GRIPS`] of `hands` say.
    pub fn follow(
        &mut self,
        hands: &[Hand],
        (view, aspect): (&View, f64),
        wind: &mut WindField,
        (exhibit, bodies, driven): (&Exhibit, &[RigidBody], &[bool]),
    ) {
        self.held.retain(|held| hands.iter().any(|hand| hand.id == held.id));
        if !self.permitted {
            return;
        }
        for hand in hands.iter().filter(|hand| hand.at.iter().all(|x| x.is_finite())) {
            let known = self.held.iter().position(|held| held.id == hand.id);
            if known.is_none() && self.held.len() < MOST_GRIPS {
                let taken = match hand.body {
                    Some(body) => bodies.get(body).map(|b| (body, b.position)),
                    None => take(hand.at, (view, aspect), wind, exhibit, bodies),
                };
                let taken = taken.filter(|(body, _)| !driven[*body]);
                let took = taken.map(|(body, point)| (body, bodies[body].pose().inverse_point(point)));
                self.held.push(Held { id: hand.id, took, goal: DVec3::ZERO });
            }
            if let Some(held) = self.held.iter_mut().find(|held| held.id == hand.id)
                && let Some((body, point)) = held.took
            {
                let (eye, ray) = view.ray(hand.at, aspect);
                held.goal = eye + ray * (bodies[body].pose().point(point) - eye).dot(ray);
            }
        }
    }

    /// v* of what is held, m/s.
    fn wish(held: &Held, point: DVec3) -> DVec3 {
        ((held.goal - point) / FOLLOWS).clamp_length_max(FASTEST)
    }

    /// Where the points are to be after `dt` seconds, for a figure that is moved by places.
    pub fn grips(&mut self, bodies: &[RigidBody], dt: f64) -> &[Grip] {
        self.grips.clear();
        for held in &self.held {
            if let Some((body, point)) = held.took {
                let now = bodies[body].pose().point(point);
                self.grips.push(Grip { body, point, place: now + dt * Self::wish(held, now) });
            }
        }
        &self.grips
    }

    /// Adds the hands' forces (N, N m about each centre of mass) for a step of `dt` seconds by the laws.
    pub fn pull(&mut self, dynamics: &mut Dynamics, dt: f64, out: &mut [Vec6]) {
        self.points.clear();
        let mut left = [DVec3::ZERO; MOST_GRIPS];
        for held in &self.held {
            if let Some((body, point)) = held.took {
                let state = &dynamics.bodies[body];
                let now = state.pose().point(point);
                let arm = now - state.position;
                let speed = state.velocity + state.angular_velocity.cross(arm);
                left[self.points.len()] = Self::wish(held, now) - speed;
                self.points.push((body, now));
            }
        }
        let n = self.points.len();
        if n == 0 {
            return;
        }
        let answers = &mut self.answers[..n * n];
        dynamics.effective_inverse_mass(&self.points, answers);
        let mut impulses = [DVec3::ZERO; MOST_GRIPS];
        for _ in 0..ROUNDS {
            for i in 0..n {
                let missing = left[i] - (0..n).fold(DVec3::ZERO, |sum, j| sum + answers[i * n + j] * impulses[j]);
                let wanted = impulses[i] + damped_inverse(&answers[i * n + i]) * missing;
                impulses[i] = wanted.clamp_length_max(dt * self.force.min(BRISKEST / mean(&answers[i * n + i])));
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

/// Mean of the diagonal, 1/kg.
fn mean(w: &DMat3) -> f64 {
    (w.x_axis.x + w.y_axis.y + w.z_axis.z) / 3.0
}

/// W (W² + ε² E)⁻¹ of a symmetric W.
fn damped_inverse(w: &DMat3) -> DMat3 {
    let epsilon = DAMPED * mean(w);
    if epsilon <= 0.0 || !epsilon.is_finite() {
        return DMat3::ZERO;
    }
    *w * (*w * *w + DMat3::from_diagonal(DVec3::splat(epsilon * epsilon))).inverse()
}

/// The body under a place of the picture, and the point of it that is seen there. Whoever points at nothing takes what is
/// a finger's breadth away.
fn take(
    at: [f64; 2],
    (view, aspect): (&View, f64),
    wind: &mut WindField,
    exhibit: &Exhibit,
    bodies: &[RigidBody],
) -> Option<(usize, DVec3)> {
    let occluders = wind.occluders_at(bodies);
    let meets = |at: [f64; 2]| {
        let (eye, ray) = view.ray(at, aspect);
        occluders.first(eye, ray).map(|(body, distance)| (body, eye + distance * ray))
    };
    // What stands still hides what is behind it.
    if let Some((body, point)) = meets(at) {
        return body.map(|body| (body, point));
    }
    wire(view.ray(at, aspect), view, exhibit, bodies).or_else(|| {
        let beside = |offset: &[f64; 2]| [at[0] + FINGER * offset[0] / aspect, at[1] + FINGER * offset[1]];
        AROUND.iter().find_map(|offset| meets(beside(offset)).and_then(|(body, point)| Some((body?, point))))
    })
}

/// The nearest moving wire within a finger's breadth of a sight line, and its point there.
fn wire((eye, ray): (DVec3, DVec3), view: &View, exhibit: &Exhibit, bodies: &[RigidBody]) -> Option<(usize, DVec3)> {
    let forward = view.axes().2;
    let mut best: Option<(f64, usize, DVec3)> = None;
    for wire in &exhibit.wires {
        let Some(body) = wire.body else { continue };
        let pose = bodies[body].pose();
        for ends in wire.points.windows(2) {
            let (a, b) = (pose.point(ends[0]), pose.point(ends[1]));
            let point = nearest_on_segment(eye, ray, a, b);
            let (depth, along) = ((point - eye).dot(forward), (point - eye).dot(ray));
            let off = (point - eye - along * ray).length() - wire.radius;
            if depth > 0.0 && off < FINGER * view.height_at(depth) && best.is_none_or(|(least, ..)| off < least) {
                best = Some((off, body, point));
            }
        }
    }
    best.map(|(_, body, point)| (body, point))
}

/// The point of the segment a b that is nearest to a line (unit direction).
fn nearest_on_segment(origin: DVec3, ray: DVec3, a: DVec3, b: DVec3) -> DVec3 {
    let across = |v: DVec3| v - v.dot(ray) * ray;
    let (from, way) = (across(a - origin), across(b - a));
    let square = way.length_squared();
    let s = if square > 0.0 { (-from.dot(way) / square).clamp(0.0, 1.0) } else { 0.0 };
    a + s * (b - a)
}
