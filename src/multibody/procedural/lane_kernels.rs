//! Lane kernels of position-based motion: update, displacement and velocity derivation of all bodies, four at a time.
//! They keep lane blocks and bodies equal.
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
use crate::articulation::lane_blocks::{BlockBodies, State, gather};
use crate::dynamics::{Dynamics, PositionStep};
use soffio_geometry::bodies::RigidBody;
use soffio_math::lanes::{All, Four, Lanes, Quat, Real, V3, WIDTH};
use soffio_math::spatial::SpatialVector;
use soffio_math::spatial::{M3, Sym3};
use soffio_math::{DQuat, DVec3, atan2};

/// Speed limit of a body, m/s: a grab can throw it across the room in one step.
pub const MAX_SPEED: f64 = 50.0;
/// Limit of its angular speed, rad/s.
pub const MAX_SPIN: f64 = 200.0;
/// Square of the half-angle's sine below which its series is used: the omitted terms are under 10⁻¹⁴ of it.
const SMALL_SINE_SQUARED: f64 = 0.01;

/// Per-body constants of the kernels.
#[derive(Clone, Debug)]
pub(super) struct LaneKernels {
    /// Damping rates of each lane block's bodies: of the velocity and of the spin, 1/s.
    damping: Vec<[Four; 2]>,
    kinematic: Vec<bool>,
}

impl LaneKernels {
    /// The constants of these dynamics' bodies.
    pub fn new(dynamics: &Dynamics) -> Self {
        let rates = |block_bodies: &BlockBodies| {
            let damping = block_bodies.bodies.map(|body| dynamics.damping(body));
            [Four(damping.map(|d| d.linear)), Four(damping.map(|d| d.angular))]
        };
        let system = dynamics.system_without_trains();
        Self {
            damping: system.lane_blocks().block_bodies().iter().map(rates).collect(),
            kinematic: system.kinematic().to_vec(),
        }
    }

    /// The update: each free body for `dt` s, its velocity scaled by `retention`; kinematic ones stay. `gyroscopic`
    /// includes the gyroscopic torque.
    pub fn update(&self, step: &mut PositionStep, dt: f64, retention: f64, gyroscopic: bool) {
        step.system.lane_blocks_mut().load(step.bodies);
        dispatch!(step.system.lane_blocks().level(), simd => self.update_in(simd, step, (dt, retention), gyroscopic));
    }

    #[inline(always)]
    fn update_in<S: Simd>(&self, simd: S, step: &mut PositionStep, (dt, retention): (f64, f64), gyroscopic: bool) {
        let lanes = All(simd);
        for (index, damping) in self.damping.iter().enumerate() {
            let lane_blocks = step.system.lane_blocks_mut();
            let block_bodies = lane_blocks.block_bodies()[index];
            let lane_block = &mut lane_blocks.all_mut()[index];
            let (mut state, inertia) = (lane_block.state.get(lanes), lane_block.inertia.get(lanes));
            let mass = lanes.get(&lane_block.mass);
            let (one, h) = (mass.all(1.0), mass.all(dt));
            if gyroscopic {
                state.spin = gyroscopic_step(&inertia, state.spin, h);
            }
            let keep = |rate: &Four| mass.all(retention) / (one + lanes.get(rate) * h);
            let wrench = SpatialVector::gather(lanes, |k| &step.wrenches[block_bodies.bodies[k]]);
            let gravity = step.gravity.to_array().map(|g| mass.all(g));
            let gravity = V3 { x: gravity[0], y: gravity[1], z: gravity[2] };
            let (push, twist) = (gravity + wrench.linear * (one / mass), inertia.inverse().mul(wrench.angular));
            state.velocity = clamped_length(lanes, state.velocity * keep(&damping[0]) + push * h, MAX_SPEED);
            state.spin = clamped_length(lanes, state.spin * keep(&damping[1]) + twist * h, MAX_SPIN);
            let (displacement, rotation_vector) = (state.velocity * h, state.spin * h);
            displace_state(lanes, &mut state, displacement, rotation_vector);
            lane_block.put(lanes, &state);
            self.write_back(lanes, &block_bodies, &state, step.bodies);
        }
    }

    /// Moves the bodies by this fraction of the solution in `system.a`.
    pub fn displace(&self, system: &mut System, bodies: &mut [RigidBody], fraction: f64) {
        dispatch!(system.lane_blocks().level(), simd => self.displace_in(simd, system, bodies, fraction));
    }

    #[inline(always)]
    fn displace_in<S: Simd>(&self, simd: S, system: &mut System, bodies: &mut [RigidBody], fraction: f64) {
        let lanes = All(simd);
        for index in 0..self.damping.len() {
            let block_bodies = system.lane_blocks().block_bodies()[index];
            let by = SpatialVector::gather(lanes, |k| &system.a[block_bodies.bodies[k]]);
            let lane_block = &mut system.lane_blocks_mut().all_mut()[index];
            let mut state = lane_block.state.get(lanes);
            let fraction = state.rotation.w.all(fraction);
            displace_state(lanes, &mut state, by.linear * fraction, by.angular * fraction);
            lane_block.put(lanes, &state);
            self.write_back(lanes, &block_bodies, &state, bodies);
        }
    }

    /// Derives the velocities from the displacement since `before` in `dt` s.
    pub fn derive_velocities(&self, system: &System, bodies: &mut [RigidBody], before: &[RigidBody], dt: f64) {
        dispatch!(system.lane_blocks().level(), simd => self.derive_velocities_in(simd, system, bodies, before, dt));
    }

    #[inline(always)]
    fn derive_velocities_in<S: Simd>(
        &self,
        simd: S,
        system: &System,
        bodies: &mut [RigidBody],
        before: &[RigidBody],
        dt: f64,
    ) {
        let lanes = All(simd);
        for block_bodies in system.lane_blocks().block_bodies() {
            let place = |of: &[RigidBody]| gather(lanes, |k| &of[block_bodies.bodies[k]].position);
            let rotation = |of: &[RigidBody]| Quat::gather(lanes, |k| of[block_bodies.bodies[k]].rotation);
            let displacement = place(bodies) - place(before);
            let rotation_vector = rotation_between(lanes, rotation(before), rotation(bodies));
            let rate = displacement.x.all(1.0) / displacement.x.all(dt);
            let (v, w) = (displacement * rate, rotation_vector * rate);
            lanes.scatter(block_bodies.count, &[v.x, v.y, v.z, w.x, w.y, w.z], |lane, n| {
                let index = block_bodies.bodies[lane];
                if !self.kinematic[index] {
                    let body = &mut bodies[index];
                    body.velocity = DVec3::new(n[0], n[1], n[2]).clamp_length_max(MAX_SPEED);
                    body.angular_velocity = DVec3::new(n[3], n[4], n[5]).clamp_length_max(MAX_SPIN);
                }
            });
        }
    }

    /// Clamps the velocities to [`MAX_SPEED`] and [`MAX_SPIN`].
    pub fn clamp_velocities(&self, bodies: &mut [RigidBody]) {
        for (body, kinematic) in bodies.iter_mut().zip(&self.kinematic) {
            if !kinematic {
                body.velocity = body.velocity.clamp_length_max(MAX_SPEED);
                body.angular_velocity = body.angular_velocity.clamp_length_max(MAX_SPIN);
            }
        }
    }

    /// Writes a state back to its free bodies.
    #[inline(always)]
    fn write_back<L: Lanes>(
        &self,
        lanes: L,
        block_bodies: &BlockBodies,
        state: &State<L::T>,
        bodies: &mut [RigidBody],
    ) {
        let (x, q, v, s) = (&state.position, &state.rotation, &state.velocity, &state.spin);
        let numbers = [x.x, x.y, x.z, q.v.x, q.v.y, q.v.z, q.w, v.x, v.y, v.z, s.x, s.y, s.z];
        lanes.scatter(block_bodies.count, &numbers, |lane, n| {
            let index = block_bodies.bodies[lane];
            if !self.kinematic[index] {
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
fn displace_state<L: Lanes>(lanes: L, state: &mut State<L::T>, displacement: V3<L::T>, rotation_vector: V3<L::T>) {
    state.position += displacement;
    state.rotation = Quat::of_turn(lanes, rotation_vector).times(state.rotation).renormalized();
}

/// Vector of length `most` at most. A taut spring would otherwise throw a light body farther in one free step than
/// its joints can bring it back.
#[inline(always)]
fn clamped_length<L: Lanes>(lanes: L, v: V3<L::T>, most: f64) -> V3<L::T> {
    let square = v.dot(v);
    let within = |k: usize| lanes.lane(&square, k) <= most * most;
    if (0..WIDTH).all(within) {
        return v;
    }
    v * lanes.gather(|k| if within(k) { 1.0 } else { most / lanes.lane(&square, k).sqrt() })
}

/// ω of a free body after `h`.
#[inline(always)]
fn gyroscopic_step<T: Real>(inertia: &Sym3<T>, w: V3<T>, h: T) -> V3<T> {
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

/// Rotation vector between two rotations, the shorter way, rad: 2 asin|v| v/|v|.
#[inline(always)]
fn rotation_between<L: Lanes>(lanes: L, from: Quat<L::T>, to: Quat<L::T>) -> V3<L::T> {
    let rotation_vector = to.times(Quat { v: -from.v, w: from.w });
    let sign = lanes.gather(|k| if lanes.lane(&rotation_vector.w, k) < 0.0 { -1.0 } else { 1.0 });
    let (v, w) = (rotation_vector.v * sign, rotation_vector.w * sign);
    let x = v.dot(v);
    if (0..WIDTH).all(|k| lanes.lane(&x, k) < SMALL_SINE_SQUARED) {
        return v * series(x);
    }
    let longer = lanes.gather(|k| {
        let x = lanes.lane(&x, k);
        if x < SMALL_SINE_SQUARED { series(x) } else { 2.0 * atan2(x.sqrt(), lanes.lane(&w, k)) / x.sqrt() }
    });
    v * longer
}

/// 2 asin(√x)/√x.
#[inline(always)]
fn series<T: Real>(x: T) -> T {
    const TERMS: [f64; 6] = [63.0 / 1408.0, 35.0 / 576.0, 5.0 / 56.0, 3.0 / 20.0, 1.0 / 3.0, 2.0];
    TERMS[1..].iter().fold(x.all(TERMS[0]), |sum, &term| x.all(term) + x * sum)
}
