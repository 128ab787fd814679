//! Bodies by fours: who stands beside whom, and where they all are.
//!
//! A *quad* is four bodies whose numbers lie side by side (`lanes.rs`). Bodies of one depth in the tree that each hang by
//! one point are put together, so that a quad of them is eliminated at once; all others fill quads of their own, where
//! what needs no order (poses, inertias, arms) is still done by fours. A lane that is left over repeats the quad's first
//! body and is never read. The last quad is the world's: at the origin, at rest.

use fearless_simd::{Level, Simd, dispatch};

use super::ball::Twist;
use soffio_geometry::bodies::RigidBody;
use soffio_math::lanes::{All, Four, Lanes, One, Quat, Real, V3, WIDTH};
use soffio_math::spatial::{M3, Sym3, Vec6};
use soffio_math::{DMat3, DQuat, DVec3};

/// Where a body's numbers are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Slot {
    /// Index of its quad.
    pub quad: usize,
    /// Which of the four it is.
    pub lane: usize,
}

/// Who is in a quad.
#[derive(Clone, Copy, Debug)]
pub struct Members {
    /// Their indices.
    pub bodies: [usize; WIDTH],
    /// How many there are: the first ones.
    pub count: usize,
}

impl Members {
    /// One body.
    pub fn first(body: usize) -> Self {
        Self { bodies: [body; WIDTH], count: 1 }
    }

    /// All of them.
    pub fn all(&self) -> &[usize] {
        &self.bodies[..self.count]
    }

    /// One more.
    pub fn push(&mut self, body: usize) {
        self.bodies[self.count] = body;
        self.count += 1;
    }
}

/// A body's changing numbers.
#[derive(Clone, Copy, Debug, Default)]
pub struct State<T> {
    /// Centre of mass, m.
    pub position: V3<T>,
    /// Body axes to world axes.
    pub rotation: Quat<T>,
    /// m/s.
    pub velocity: V3<T>,
    /// rad/s.
    pub spin: V3<T>,
}

impl<T: Real> State<T> {
    /// Of these bodies.
    #[inline(always)]
    pub fn of<'a, L: Lanes<T = T>>(lanes: L, body: impl Fn(usize) -> &'a RigidBody) -> Self {
        Self {
            position: gather(lanes, |k| &body(k).position),
            rotation: Quat::gather(lanes, |k| body(k).rotation),
            velocity: gather(lanes, |k| &body(k).velocity),
            spin: gather(lanes, |k| &body(k).angular_velocity),
        }
    }

    /// Puts these of the bodies into it.
    #[inline(always)]
    pub fn put<L: Lanes<T = T>>(&self, lanes: L, members: &Members, bodies: &mut [RigidBody]) {
        let (x, q, v, s) = (&self.position, &self.rotation, &self.velocity, &self.spin);
        let numbers = [x.x, x.y, x.z, q.v.x, q.v.y, q.v.z, q.w, v.x, v.y, v.z, s.x, s.y, s.z];
        lanes.scatter(members.count, &numbers, |lane, n| {
            let body = &mut bodies[members.bodies[lane]];
            body.position = DVec3::new(n[0], n[1], n[2]);
            body.rotation = DQuat::from_xyzw(n[3], n[4], n[5], n[6]);
            body.velocity = DVec3::new(n[7], n[8], n[9]);
            body.angular_velocity = DVec3::new(n[10], n[11], n[12]);
        });
    }
}

impl State<Four> {
    /// Reads.
    #[inline(always)]
    pub fn get<L: Lanes>(&self, lanes: L) -> State<L::T> {
        State {
            position: self.position.get(lanes),
            rotation: self.rotation.get(lanes),
            velocity: self.velocity.get(lanes),
            spin: self.spin.get(lanes),
        }
    }

    /// Writes.
    #[inline(always)]
    pub fn set<L: Lanes>(&mut self, lanes: L, state: &State<L::T>) {
        self.position.put(lanes, state.position);
        self.rotation.put(lanes, &state.rotation);
        self.velocity.put(lanes, state.velocity);
        self.spin.put(lanes, state.spin);
    }
}

/// Mass, place and motion of four bodies, world axes but where said.
#[derive(Clone, Copy, Debug)]
pub struct Quad {
    /// kg.
    pub mass: Four,
    /// Body axes, kg m².
    own_inertia: Sym3<Four>,
    /// Where they are and how they move.
    pub state: State<Four>,
    /// Body axes to world axes.
    pub frame: M3<Four>,
    /// kg m².
    pub inertia: Sym3<Four>,
}

/// All bodies of a figure.
#[derive(Clone, Debug)]
pub struct Quads {
    level: Level,
    members: Vec<Members>,
    slots: Vec<Slot>,
    /// Indices of the quads in which somebody is awake.
    moving: Vec<usize>,
    /// One more than `members`.
    quads: Vec<Quad>,
}

impl Quads {
    /// Bodies that stand like this.
    pub fn new(level: Level, members: &[Members], bodies: &[RigidBody]) -> Self {
        let mut slots = vec![Slot::default(); bodies.len()];
        let mut quads = vec![Quad::world(); members.len() + 1];
        for (quad, four) in members.iter().enumerate() {
            for lane in (0..WIDTH).rev() {
                let properties = &bodies[four.bodies[lane]].properties;
                slots[four.bodies[lane]] = Slot { quad, lane };
                quads[quad].mass.0[lane] = properties.mass;
                quads[quad].own_inertia.put(One(lane), &Sym3::lower(&properties.inertia));
            }
        }
        Self { level, members: members.to_vec(), slots, moving: (0..members.len()).collect(), quads }
    }

    /// Which instructions there are.
    pub fn level(&self) -> Level {
        self.level
    }

    /// The quads, the world's last.
    pub fn all(&self) -> &[Quad] {
        &self.quads
    }

    /// Leaves quads whose bodies all sleep as they are.
    pub fn let_sleep(&mut self, asleep: &[bool]) {
        let idle = |members: &Members| members.all().iter().all(|&body| asleep[body]);
        self.moving.clear();
        self.moving.extend((0..self.members.len()).filter(|&quad| !idle(&self.members[quad])));
    }

    /// Indices of the quads in which somebody is awake.
    pub fn moving(&self) -> &[usize] {
        &self.moving
    }

    /// Who is in which quad.
    pub fn members(&self) -> &[Members] {
        &self.members
    }

    /// Where a body is.
    pub fn slot(&self, body: usize) -> Slot {
        self.slots[body]
    }

    /// Mass of a body, kg.
    #[inline(always)]
    pub fn mass(&self, body: usize) -> f64 {
        let slot = self.slots[body];
        self.quads[slot.quad].mass.0[slot.lane]
    }

    /// World inertia of a body, kg m².
    #[inline(always)]
    pub fn inertia(&self, body: usize) -> Sym3 {
        let slot = self.slots[body];
        self.quads[slot.quad].inertia.get(One(slot.lane))
    }

    /// Centre of mass of a body, m.
    #[inline(always)]
    pub fn position(&self, body: usize) -> DVec3 {
        let slot = self.slots[body];
        self.quads[slot.quad].state.position.get(One(slot.lane)).into()
    }

    /// Rotation of a body.
    #[inline(always)]
    pub fn rotation(&self, body: usize) -> DQuat {
        let slot = self.slots[body];
        let q = self.quads[slot.quad].state.rotation.get(One(slot.lane));
        DQuat::from_xyzw(q.v.x, q.v.y, q.v.z, q.w)
    }

    /// Velocity of a body's centre of mass, m/s, and its angular velocity, rad/s.
    #[inline(always)]
    pub fn velocity(&self, body: usize) -> (DVec3, DVec3) {
        let slot = self.slots[body];
        let state = &self.quads[slot.quad].state;
        (state.velocity.get(One(slot.lane)).into(), state.spin.get(One(slot.lane)).into())
    }

    /// Angular velocity of a body, rad/s.
    #[inline(always)]
    pub fn spin(&self, body: usize) -> DVec3 {
        let slot = self.slots[body];
        self.quads[slot.quad].state.spin.get(One(slot.lane)).into()
    }

    /// Rotation matrix of a body.
    #[inline(always)]
    pub fn frame(&self, body: usize) -> DMat3 {
        let slot = self.slots[body];
        let m = self.quads[slot.quad].frame.get(One(slot.lane));
        DMat3::from_cols(m.x.into(), m.y.into(), m.z.into())
    }

    /// The quads, to be moved.
    pub fn all_mut(&mut self) -> &mut [Quad] {
        &mut self.quads
    }

    /// Takes over where the bodies are.
    pub fn look(&mut self, bodies: &[RigidBody]) {
        let (moving, members, quads) = (&self.moving, &self.members, &mut self.quads);
        dispatch!(self.level, simd => look(simd, moving, members, quads, bodies));
    }

    /// Takes over where one body is.
    pub fn look_at(&mut self, index: usize, body: &RigidBody) {
        let Slot { quad, lane } = self.slots[index];
        let lanes = One(lane);
        self.quads[quad].put(lanes, &State::of(lanes, |_| body));
    }

    /// Turns frames and inertias to where the bodies are, after [`Quads::displace`].
    pub fn turn(&mut self) {
        let (moving, quads) = (&self.moving, &mut self.quads);
        dispatch!(self.level, simd => turn(simd, moving, quads));
    }

    /// Adds displacements: of the centres (m) and rotation vectors (rad, world axes). Frames and inertias stay.
    pub fn displace(&mut self, by: &[Vec6]) {
        let (moving, members, quads) = (&self.moving, &self.members, &mut self.quads);
        dispatch!(self.level, simd => displace(simd, moving, members, quads, by));
    }
}

#[inline(always)]
fn look<S: Simd>(simd: S, moving: &[usize], members: &[Members], quads: &mut [Quad], bodies: &[RigidBody]) {
    for &index in moving {
        let (four, quad) = (&members[index], &mut quads[index]);
        quad.put(All(simd), &State::of(All(simd), |k| &bodies[four.bodies[k]]));
    }
}

#[inline(always)]
fn turn<S: Simd>(simd: S, moving: &[usize], quads: &mut [Quad]) {
    for &index in moving {
        let quad = &mut quads[index];
        let state = quad.state.get(All(simd));
        quad.put(All(simd), &state);
    }
}

#[inline(always)]
fn displace<S: Simd>(simd: S, moving: &[usize], members: &[Members], quads: &mut [Quad], by: &[Vec6]) {
    let lanes = All(simd);
    for &index in moving {
        let (four, quad) = (&members[index], &mut quads[index]);
        let by = Twist::gather(lanes, |k| &by[four.bodies[k]]);
        let state = &mut quad.state;
        let position = state.position.get(lanes) + by.linear;
        let rotation = Quat::of_turn(lanes, by.angular).times(state.rotation.get(lanes)).renormalized();
        state.position.put(lanes, position);
        state.rotation.put(lanes, &rotation);
    }
}

/// A vector of each body.
#[inline(always)]
pub fn gather<'a, L: Lanes>(lanes: L, vector: impl Fn(usize) -> &'a DVec3) -> V3<L::T> {
    V3 { x: lanes.gather(|k| vector(k).x), y: lanes.gather(|k| vector(k).y), z: lanes.gather(|k| vector(k).z) }
}

impl Quad {
    /// Puts bodies into this state.
    #[inline(always)]
    pub fn put<L: Lanes>(&mut self, lanes: L, state: &State<L::T>) {
        let frame = M3::of_rotation(state.rotation.v, state.rotation.w);
        self.state.set(lanes, state);
        self.frame.put(lanes, &frame);
        self.inertia.put(lanes, &self.own_inertia.get(lanes).rotated(&frame));
    }

    fn world() -> Self {
        let (zero, one) = (Four::splat(0.0), Four::splat(1.0));
        let none = V3 { x: zero, y: zero, z: zero };
        Self {
            mass: one,
            own_inertia: Sym3 { d: V3 { x: one, y: one, z: one }, o: none },
            state: State { position: none, rotation: Quat { v: none, w: one }, velocity: none, spin: none },
            frame: M3 {
                x: V3 { x: one, y: zero, z: zero },
                y: V3 { x: zero, y: one, z: zero },
                z: V3 { x: zero, y: zero, z: one },
            },
            inertia: Sym3 { d: V3 { x: one, y: one, z: one }, o: none },
        }
    }
}

/// What other quads' bodies are read through: four slots, each anywhere.
#[derive(Clone, Copy, Debug)]
pub struct Homes<'a, Q> {
    quads: [&'a Q; WIDTH],
    lanes: [usize; WIDTH],
}

impl<'a, Q> Homes<'a, Q> {
    /// These slots of these quads.
    #[inline(always)]
    pub fn new(quads: &'a [Q], slots: &[Slot; WIDTH]) -> Self {
        Self { quads: slots.map(|slot| &quads[slot.quad]), lanes: slots.map(|slot| slot.lane % WIDTH) }
    }

    /// A matrix of each.
    #[inline(always)]
    pub fn matrix<L: Lanes>(&self, lanes: L, of: impl Fn(&Q) -> &M3<Four>) -> M3<L::T> {
        M3 {
            x: self.vector(lanes, |quad| &of(quad).x),
            y: self.vector(lanes, |quad| &of(quad).y),
            z: self.vector(lanes, |quad| &of(quad).z),
        }
    }

    /// A vector of each.
    #[inline(always)]
    pub fn vector<L: Lanes>(&self, lanes: L, of: impl Fn(&Q) -> &V3<Four>) -> V3<L::T> {
        V3 {
            x: lanes.gather(|k| of(self.quads[k]).x.0[self.lanes[k]]),
            y: lanes.gather(|k| of(self.quads[k]).y.0[self.lanes[k]]),
            z: lanes.gather(|k| of(self.quads[k]).z.0[self.lanes[k]]),
        }
    }
}

/// J M⁻¹ Jᵀ: what the bodies of one row answer to it, each alone; driven ones do not give way.
#[inline(always)]
pub fn response(parts: &[(usize, Vec6)], driven: &[bool], quads: &Quads) -> f64 {
    let free = parts.iter().filter(|(body, _)| !driven[*body]);
    let of_one = |(body, j): &(usize, Vec6)| {
        let (force, torque) = (V3::new(j[0], j[1], j[2]), V3::new(j[3], j[4], j[5]));
        force.dot(force) / quads.mass(*body) + torque.dot(quads.inertia(*body).inverse().mul(torque))
    };
    free.map(of_one).sum()
}
