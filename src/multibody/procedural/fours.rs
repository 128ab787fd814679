//! What motion by places does to every body, four at a time (`articulation::quads`): the update, a displacement, the
//! velocity that a way stands for. The quads and the bodies say the same after each.
//!
//! The implicit gyroscopic step is one Newton step of I (ω' − ω) + Δt ω'×I ω' = 0 (E. Catto, Numerical methods, Game
//! Developers Conference 2015), here in world axes,
//!
//! ```text
//! S = I + Δt ([ω]× I − [Iω]×)        ω' = ω − S⁻¹ Δt ω×Iω
//! ```
//!
//! which never gains energy.

use fearless_simd::{Simd, dispatch};

use crate::articulation::System;
use crate::articulation::ball::Twist;
use crate::articulation::quads::{Members, State, gather};
use crate::dynamics::{Dynamics, PositionStep};
use soffio_geometry::bodies::RigidBody;
use soffio_math::lanes::{All, Four, Lanes, Quat, Real, V3, WIDTH};
use soffio_math::spatial::{M3, Sym3};
use soffio_math::{DQuat, DVec3, atan2};

/// What a body may keep of the speed of its way, m/s: a hand can throw it across the room in one step.
pub const SPEED_KEPT: f64 = 50.0;
/// The same of its turn, rad/s.
pub const SPIN_KEPT: f64 = 200.0;
/// Squares of the sine of half a turn below which its series is used: the terms left out are under 10⁻¹⁴ of it.
const SHORT: f64 = 0.01;

/// What the passes over quads need to know of the bodies.
#[derive(Clone, Debug)]
pub(super) struct Fours {
    /// Damping rates of each quad's bodies: of the velocity and of the spin, 1/s.
    damping: Vec<[Four; 2]>,
    driven: Vec<bool>,
}

impl Fours {
    pub fn new(dynamics: &Dynamics) -> Self {
        let rates = |members: &Members| {
            let damping = members.bodies.map(|body| dynamics.damping(body));
            [Four(damping.map(|d| d.linear)), Four(damping.map(|d| d.angular))]
        };
        let system = dynamics.system_without_trains();
        Self { damping: system.quads().members().iter().map(rates).collect(), driven: system.driven().to_vec() }
    }

    /// The update: each body alone for `dt` s; driven ones stay.
    pub fn update(&self, moved: &mut PositionStep, dt: f64, retention: f64, gyrates: bool) {
        moved.system.quads_mut().look(moved.bodies);
        dispatch!(moved.system.quads().level(), simd => self.update_in(simd, moved, (dt, retention), gyrates));
    }

    #[inline(always)]
    fn update_in<S: Simd>(&self, simd: S, moved: &mut PositionStep, (dt, retention): (f64, f64), gyrates: bool) {
        let lanes = All(simd);
        for (index, damping) in self.damping.iter().enumerate() {
            let quads = moved.system.quads_mut();
            let members = quads.members()[index];
            let quad = &mut quads.all_mut()[index];
            let (mut state, inertia) = (quad.state.get(lanes), quad.inertia.get(lanes));
            let mass = lanes.get(&quad.mass);
            let (one, h) = (mass.all(1.0), mass.all(dt));
            if gyrates {
                state.spin = gyrated(&inertia, state.spin, h);
            }
            let keep = |rate: &Four| mass.all(retention) / (one + lanes.get(rate) * h);
            let wrench = Twist::gather(lanes, |k| &moved.wrenches[members.bodies[k]]);
            let gravity = moved.gravity.to_array().map(|g| mass.all(g));
            let gravity = V3 { x: gravity[0], y: gravity[1], z: gravity[2] };
            let (push, twist) = (gravity + wrench.linear * (one / mass), inertia.inverse().mul(wrench.angular));
            state.velocity = bounded(lanes, state.velocity * keep(&damping[0]) + push * h, SPEED_KEPT);
            state.spin = bounded(lanes, state.spin * keep(&damping[1]) + twist * h, SPIN_KEPT);
            let (way, turn) = (state.velocity * h, state.spin * h);
            move_by(lanes, &mut state, way, turn);
            quad.put(lanes, &state);
            self.show(lanes, &members, &state, moved.bodies);
        }
    }

    /// Moves the bodies by this share of the answer in `system.a`.
    pub fn displace(&self, system: &mut System, bodies: &mut [RigidBody], share: f64) {
        dispatch!(system.quads().level(), simd => self.displace_in(simd, system, bodies, share));
    }

    #[inline(always)]
    fn displace_in<S: Simd>(&self, simd: S, system: &mut System, bodies: &mut [RigidBody], share: f64) {
        let lanes = All(simd);
        for index in 0..self.damping.len() {
            let members = system.quads().members()[index];
            let by = Twist::gather(lanes, |k| &system.a[members.bodies[k]]);
            let quad = &mut system.quads_mut().all_mut()[index];
            let mut state = quad.state.get(lanes);
            let share = state.rotation.w.all(share);
            move_by(lanes, &mut state, by.linear * share, by.angular * share);
            quad.put(lanes, &state);
            self.show(lanes, &members, &state, bodies);
        }
    }

    /// The velocities that a way from `before` in `dt` s stands for.
    pub fn keep_speed(&self, system: &System, bodies: &mut [RigidBody], before: &[RigidBody], dt: f64) {
        dispatch!(system.quads().level(), simd => self.keep_speed_in(simd, system, bodies, before, dt));
    }

    #[inline(always)]
    fn keep_speed_in<S: Simd>(
        &self,
        simd: S,
        system: &System,
        bodies: &mut [RigidBody],
        before: &[RigidBody],
        dt: f64,
    ) {
        let lanes = All(simd);
        for members in system.quads().members() {
            let place = |of: &[RigidBody]| gather(lanes, |k| &of[members.bodies[k]].position);
            let rotation = |of: &[RigidBody]| Quat::gather(lanes, |k| of[members.bodies[k]].rotation);
            let way = place(bodies) - place(before);
            let turn = turned(lanes, rotation(before), rotation(bodies));
            let rate = way.x.all(1.0) / way.x.all(dt);
            let (v, w) = (way * rate, turn * rate);
            lanes.scatter(members.count, &[v.x, v.y, v.z, w.x, w.y, w.z], |lane, n| {
                let index = members.bodies[lane];
                if !self.driven[index] {
                    let body = &mut bodies[index];
                    body.velocity = DVec3::new(n[0], n[1], n[2]).clamp_length_max(SPEED_KEPT);
                    body.angular_velocity = DVec3::new(n[3], n[4], n[5]).clamp_length_max(SPIN_KEPT);
                }
            });
        }
    }

    /// No body goes on faster than it may, whatever threw it.
    pub fn bound_speed(&self, bodies: &mut [RigidBody]) {
        for (body, driven) in bodies.iter_mut().zip(&self.driven) {
            if !driven {
                body.velocity = body.velocity.clamp_length_max(SPEED_KEPT);
                body.angular_velocity = body.angular_velocity.clamp_length_max(SPIN_KEPT);
            }
        }
    }

    /// Lets the bodies be where their quad is, but for driven ones.
    #[inline(always)]
    fn show<L: Lanes>(&self, lanes: L, members: &Members, state: &State<L::T>, bodies: &mut [RigidBody]) {
        let (x, q, v, s) = (&state.position, &state.rotation, &state.velocity, &state.spin);
        let numbers = [x.x, x.y, x.z, q.v.x, q.v.y, q.v.z, q.w, v.x, v.y, v.z, s.x, s.y, s.z];
        lanes.scatter(members.count, &numbers, |lane, n| {
            let index = members.bodies[lane];
            if !self.driven[index] {
                let body = &mut bodies[index];
                body.position = DVec3::new(n[0], n[1], n[2]);
                body.rotation = DQuat::from_xyzw(n[3], n[4], n[5], n[6]);
                body.velocity = DVec3::new(n[7], n[8], n[9]);
                body.angular_velocity = DVec3::new(n[10], n[11], n[12]);
            }
        });
    }
}

/// As [`RigidBody::displace`].
#[inline(always)]
fn move_by<L: Lanes>(lanes: L, state: &mut State<L::T>, way: V3<L::T>, turn: V3<L::T>) {
    state.position += way;
    state.rotation = Quat::of_turn(lanes, turn).times(state.rotation).renormalized();
}

/// No longer than `most`: a taut spring would otherwise throw a light body, alone for the step, farther than its joints
/// can bring it back.
#[inline(always)]
fn bounded<L: Lanes>(lanes: L, v: V3<L::T>, most: f64) -> V3<L::T> {
    let square = v.dot(v);
    let within = |k: usize| lanes.lane(&square, k) <= most * most;
    if (0..WIDTH).all(within) {
        return v;
    }
    v * lanes.gather(|k| if within(k) { 1.0 } else { most / lanes.lane(&square, k).sqrt() })
}

/// ω of a body that turns freely for `h`.
#[inline(always)]
fn gyrated<T: Real>(inertia: &Sym3<T>, w: V3<T>, h: T) -> V3<T> {
    let l = inertia.mul(w);
    let zero = h.all(0.0);
    // Columns of S.
    let (ix, iy, iz) = (inertia.x(), inertia.y(), inertia.z());
    let s = M3 {
        x: ix + (w.cross(ix) - V3::new(zero, l.z, -l.y)) * h,
        y: iy + (w.cross(iy) - V3::new(-l.z, zero, l.x)) * h,
        z: iz + (w.cross(iz) - V3::new(l.y, -l.x, zero)) * h,
    };
    let torque = w.cross(l) * h;
    let (yz, zx, xy) = (s.y.cross(s.z), s.z.cross(s.x), s.x.cross(s.y));
    let change = V3::new(torque.dot(yz), torque.dot(zx), torque.dot(xy));
    w - change * (h.all(1.0) / s.x.dot(yz))
}

/// Rotation vector of the shorter way between two rotations, rad: 2 asin|v| v/|v|.
#[inline(always)]
fn turned<L: Lanes>(lanes: L, from: Quat<L::T>, to: Quat<L::T>) -> V3<L::T> {
    let turn = to.times(Quat { v: -from.v, w: from.w });
    let sign = lanes.gather(|k| if lanes.lane(&turn.w, k) < 0.0 { -1.0 } else { 1.0 });
    let (v, w) = (turn.v * sign, turn.w * sign);
    let x = v.dot(v);
    if (0..WIDTH).all(|k| lanes.lane(&x, k) < SHORT) {
        return v * series(x);
    }
    let longer = lanes.gather(|k| {
        let x = lanes.lane(&x, k);
        if x < SHORT { series(x) } else { 2.0 * atan2(x.sqrt(), lanes.lane(&w, k)) / x.sqrt() }
    });
    v * longer
}

/// 2 asin(√x)/√x.
#[inline(always)]
fn series<T: Real>(x: T) -> T {
    const TERMS: [f64; 6] = [63.0 / 1408.0, 35.0 / 576.0, 5.0 / 56.0, 3.0 / 20.0, 1.0 / 3.0, 2.0];
    TERMS[1..].iter().fold(x.all(TERMS[0]), |sum, &term| x.all(term) + x * sum)
}
