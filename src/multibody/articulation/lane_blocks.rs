//! Structure-of-arrays state of all bodies in SIMD lane blocks of four.
//!
//! A *lane block* holds the numbers of four bodies side by side (`soffio_math::lanes`). Ball-joint bodies of one
//! depth in the tree share blocks, so that four are eliminated at once. All others fill blocks of their own, where
//! work without an order (poses, inertias, arms) is still done for four. An unused lane repeats the block's first
//! body and is never read. The last block is the world's: at the origin, at rest.

use fearless_simd::{Level, Simd, dispatch};

use soffio_geometry::bodies::RigidBody;
use soffio_math::lanes::{All, Four, Lanes, One, Quat, Real, V3, WIDTH};
use soffio_math::spatial::SpatialVector;
use soffio_math::spatial::{M3, Sym3, Vec6};
use soffio_math::{DMat3, DQuat, DVec3};

/// Position of a body in the lane blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BodyLane {
    /// Index of its lane block.
    pub lane_block: usize,
    /// Its lane, 0 … 3.
    pub lane: usize,
}

/// Gather indices of one lane block.
#[derive(Clone, Copy, Debug)]
pub struct BlockBodies {
    /// Indices of the bodies; unused lanes repeat the first.
    pub bodies: [usize; WIDTH],
    /// Number of used lanes, from the first on.
    pub count: usize,
}

impl BlockBodies {
    /// A block of one body.
    pub fn first(body: usize) -> Self {
        Self { bodies: [body; WIDTH], count: 1 }
    }

    /// Bodies of the used lanes.
    pub fn all(&self) -> &[usize] {
        &self.bodies[..self.count]
    }

    /// Adds a body in the next lane.
    pub fn push(&mut self, body: usize) {
        self.bodies[self.count] = body;
        self.count += 1;
    }
}

/// Dynamic state of a body, or of four lanes.
#[derive(Clone, Copy, Debug, Default)]
pub struct State<T> {
    /// Centre of mass, m.
    pub position: V3<T>,
    /// Body axes to world axes.
    pub rotation: Quat<T>,
    /// Velocity of the centre of mass, m/s.
    pub velocity: V3<T>,
    /// Angular velocity, rad/s.
    pub spin: V3<T>,
}

impl<T: Real> State<T> {
    /// Gathers the state of bodies.
    #[inline(always)]
    pub fn of<'a, L: Lanes<T = T>>(lanes: L, body: impl Fn(usize) -> &'a RigidBody) -> Self {
        Self {
            position: gather(lanes, |k| &body(k).position),
            rotation: Quat::gather(lanes, |k| body(k).rotation),
            velocity: gather(lanes, |k| &body(k).velocity),
            spin: gather(lanes, |k| &body(k).angular_velocity),
        }
    }

    /// Scatters the state to the bodies of a block.
    #[inline(always)]
    pub fn put<L: Lanes<T = T>>(&self, lanes: L, block_bodies: &BlockBodies, bodies: &mut [RigidBody]) {
        let (x, q, v, s) = (&self.position, &self.rotation, &self.velocity, &self.spin);
        let numbers = [x.x, x.y, x.z, q.v.x, q.v.y, q.v.z, q.w, v.x, v.y, v.z, s.x, s.y, s.z];
        lanes.scatter(block_bodies.count, &numbers, |lane, n| {
            let body = &mut bodies[block_bodies.bodies[lane]];
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

/// Mass, pose and motion of four bodies, in world axes unless stated otherwise.
#[derive(Clone, Copy, Debug)]
pub struct LaneBlock {
    /// Mass of each body, kg.
    pub mass: Four,
    /// Inertia in body axes, kg m².
    own_inertia: Sym3<Four>,
    /// Pose and velocity.
    pub state: State<Four>,
    /// Body axes to world axes.
    pub frame: M3<Four>,
    /// World inertia of each body about its centre of mass, kg m².
    pub inertia: Sym3<Four>,
}

/// All bodies of an articulation.
#[derive(Clone, Debug)]
pub struct LaneBlocks {
    level: Level,
    block_bodies: Vec<BlockBodies>,
    body_lanes: Vec<BodyLane>,
    /// Indices of the blocks with an awake body.
    awake: Vec<usize>,
    /// The lane blocks; one more than `block_bodies`.
    lane_blocks: Vec<LaneBlock>,
}

impl LaneBlocks {
    /// Lane blocks for bodies in this state.
    pub fn new(level: Level, block_bodies: &[BlockBodies], bodies: &[RigidBody]) -> Self {
        let mut body_lanes = vec![BodyLane::default(); bodies.len()];
        let mut lane_blocks = vec![LaneBlock::world(); block_bodies.len() + 1];
        for (lane_block, bodies_of_block) in block_bodies.iter().enumerate() {
            for lane in (0..WIDTH).rev() {
                let properties = &bodies[bodies_of_block.bodies[lane]].properties;
                body_lanes[bodies_of_block.bodies[lane]] = BodyLane { lane_block, lane };
                lane_blocks[lane_block].mass.0[lane] = properties.mass;
                lane_blocks[lane_block].own_inertia.put(One(lane), &Sym3::lower(&properties.inertia));
            }
        }
        Self {
            level,
            block_bodies: block_bodies.to_vec(),
            body_lanes,
            awake: (0..block_bodies.len()).collect(),
            lane_blocks,
        }
    }

    /// SIMD level.
    pub fn level(&self) -> Level {
        self.level
    }

    /// All blocks; the last is the world's.
    pub fn all(&self) -> &[LaneBlock] {
        &self.lane_blocks
    }

    /// Skips blocks whose bodies are all asleep until the next call.
    pub fn let_sleep(&mut self, asleep: &[bool]) {
        let all_asleep = |block_bodies: &BlockBodies| block_bodies.all().iter().all(|&body| asleep[body]);
        self.awake.clear();
        self.awake
            .extend((0..self.block_bodies.len()).filter(|&lane_block| !all_asleep(&self.block_bodies[lane_block])));
    }

    /// Indices of the blocks with an awake body.
    pub fn awake(&self) -> &[usize] {
        &self.awake
    }

    /// Bodies of each block.
    pub fn block_bodies(&self) -> &[BlockBodies] {
        &self.block_bodies
    }

    /// Lane of a body.
    pub fn body_lane(&self, body: usize) -> BodyLane {
        self.body_lanes[body]
    }

    /// Mass of a body, kg.
    #[inline(always)]
    pub fn mass(&self, body: usize) -> f64 {
        let body_lane = self.body_lanes[body];
        self.lane_blocks[body_lane.lane_block].mass.0[body_lane.lane]
    }

    /// World inertia of a body, kg m².
    #[inline(always)]
    pub fn inertia(&self, body: usize) -> Sym3 {
        let body_lane = self.body_lanes[body];
        self.lane_blocks[body_lane.lane_block].inertia.get(One(body_lane.lane))
    }

    /// Centre of mass of a body, m.
    #[inline(always)]
    pub fn position(&self, body: usize) -> DVec3 {
        let body_lane = self.body_lanes[body];
        self.lane_blocks[body_lane.lane_block].state.position.get(One(body_lane.lane)).into()
    }

    /// Rotation of a body.
    #[inline(always)]
    pub fn rotation(&self, body: usize) -> DQuat {
        let body_lane = self.body_lanes[body];
        let q = self.lane_blocks[body_lane.lane_block].state.rotation.get(One(body_lane.lane));
        DQuat::from_xyzw(q.v.x, q.v.y, q.v.z, q.w)
    }

    /// Velocity of a body's centre of mass, m/s, and its angular velocity, rad/s.
    #[inline(always)]
    pub fn velocity(&self, body: usize) -> (DVec3, DVec3) {
        let body_lane = self.body_lanes[body];
        let state = &self.lane_blocks[body_lane.lane_block].state;
        (state.velocity.get(One(body_lane.lane)).into(), state.spin.get(One(body_lane.lane)).into())
    }

    /// Angular velocity of a body, rad/s.
    #[inline(always)]
    pub fn spin(&self, body: usize) -> DVec3 {
        let body_lane = self.body_lanes[body];
        self.lane_blocks[body_lane.lane_block].state.spin.get(One(body_lane.lane)).into()
    }

    /// Rotation matrix of a body.
    #[inline(always)]
    pub fn frame(&self, body: usize) -> DMat3 {
        let body_lane = self.body_lanes[body];
        let m = self.lane_blocks[body_lane.lane_block].frame.get(One(body_lane.lane));
        DMat3::from_cols(m.x.into(), m.y.into(), m.z.into())
    }

    /// All blocks, mutable; the last is the world's.
    pub fn all_mut(&mut self) -> &mut [LaneBlock] {
        &mut self.lane_blocks
    }

    /// Loads the state of all awake bodies.
    pub fn load(&mut self, bodies: &[RigidBody]) {
        let (awake, block_bodies, lane_blocks) = (&self.awake, &self.block_bodies, &mut self.lane_blocks);
        dispatch!(self.level, simd => load(simd, awake, block_bodies, lane_blocks, bodies));
    }

    /// Loads the state of one body.
    pub fn load_body(&mut self, index: usize, body: &RigidBody) {
        let BodyLane { lane_block, lane } = self.body_lanes[index];
        let lanes = One(lane);
        self.lane_blocks[lane_block].put(lanes, &State::of(lanes, |_| body));
    }

    /// Recomputes frames and world inertias after [`LaneBlocks::displace`].
    pub fn update_frames(&mut self) {
        let (awake, lane_blocks) = (&self.awake, &mut self.lane_blocks);
        dispatch!(self.level, simd => update_frames(simd, awake, lane_blocks));
    }

    /// Adds displacements of the centres of mass (m) and rotation vectors (rad, world axes). Frames and inertias stay
    /// as they were.
    pub fn displace(&mut self, by: &[Vec6]) {
        let (awake, block_bodies, lane_blocks) = (&self.awake, &self.block_bodies, &mut self.lane_blocks);
        dispatch!(self.level, simd => displace(simd, awake, block_bodies, lane_blocks, by));
    }
}

#[inline(always)]
fn load<S: Simd>(
    simd: S,
    awake: &[usize],
    block_bodies: &[BlockBodies],
    lane_blocks: &mut [LaneBlock],
    bodies: &[RigidBody],
) {
    for &index in awake {
        let (bodies_of_block, lane_block) = (&block_bodies[index], &mut lane_blocks[index]);
        lane_block.put(All(simd), &State::of(All(simd), |k| &bodies[bodies_of_block.bodies[k]]));
    }
}

#[inline(always)]
fn update_frames<S: Simd>(simd: S, awake: &[usize], lane_blocks: &mut [LaneBlock]) {
    for &index in awake {
        let lane_block = &mut lane_blocks[index];
        let state = lane_block.state.get(All(simd));
        lane_block.put(All(simd), &state);
    }
}

#[inline(always)]
fn displace<S: Simd>(
    simd: S,
    awake: &[usize],
    block_bodies: &[BlockBodies],
    lane_blocks: &mut [LaneBlock],
    by: &[Vec6],
) {
    let lanes = All(simd);
    for &index in awake {
        let (bodies_of_block, lane_block) = (&block_bodies[index], &mut lane_blocks[index]);
        let by = SpatialVector::gather(lanes, |k| &by[bodies_of_block.bodies[k]]);
        let state = &mut lane_block.state;
        let position = state.position.get(lanes) + by.linear;
        let rotation = Quat::of_turn(lanes, by.angular).times(state.rotation.get(lanes)).renormalized();
        state.position.put(lanes, position);
        state.rotation.put(lanes, &rotation);
    }
}

/// Gathers a vector of each body.
#[inline(always)]
pub fn gather<'a, L: Lanes>(lanes: L, vector: impl Fn(usize) -> &'a DVec3) -> V3<L::T> {
    V3 { x: lanes.gather(|k| vector(k).x), y: lanes.gather(|k| vector(k).y), z: lanes.gather(|k| vector(k).z) }
}

impl LaneBlock {
    /// Stores a state with its frames and world inertias.
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

/// Gathers numbers of four bodies from any lanes.
#[derive(Clone, Copy, Debug)]
pub struct LaneGather<'a, Q> {
    lane_blocks: [&'a Q; WIDTH],
    lanes: [usize; WIDTH],
}

impl<'a, Q> LaneGather<'a, Q> {
    /// A gather of these lanes.
    #[inline(always)]
    pub fn new(lane_blocks: &'a [Q], body_lanes: &[BodyLane; WIDTH]) -> Self {
        Self {
            lane_blocks: body_lanes.map(|body_lane| &lane_blocks[body_lane.lane_block]),
            lanes: body_lanes.map(|body_lane| body_lane.lane % WIDTH),
        }
    }

    /// Gathers a matrix of each body.
    #[inline(always)]
    pub fn matrix<L: Lanes>(&self, lanes: L, of: impl Fn(&Q) -> &M3<Four>) -> M3<L::T> {
        M3 {
            x: self.vector(lanes, |lane_block| &of(lane_block).x),
            y: self.vector(lanes, |lane_block| &of(lane_block).y),
            z: self.vector(lanes, |lane_block| &of(lane_block).z),
        }
    }

    /// Gathers a vector of each body.
    #[inline(always)]
    pub fn vector<L: Lanes>(&self, lanes: L, of: impl Fn(&Q) -> &V3<Four>) -> V3<L::T> {
        V3 {
            x: lanes.gather(|k| of(self.lane_blocks[k]).x.0[self.lanes[k]]),
            y: lanes.gather(|k| of(self.lane_blocks[k]).y.0[self.lanes[k]]),
            z: lanes.gather(|k| of(self.lane_blocks[k]).z.0[self.lanes[k]]),
        }
    }
}

/// J M⁻¹ Jᵀ of one row with its bodies uncoupled from all others; kinematic bodies have no inverse mass.
#[inline(always)]
pub fn effective_inverse_mass(parts: &[(usize, Vec6)], kinematic: &[bool], lane_blocks: &LaneBlocks) -> f64 {
    let free = parts.iter().filter(|(body, _)| !kinematic[*body]);
    let of_one = |(body, j): &(usize, Vec6)| {
        let (force, torque) = (V3::new(j[0], j[1], j[2]), V3::new(j[3], j[4], j[5]));
        force.dot(force) / lane_blocks.mass(*body) + torque.dot(lane_blocks.inertia(*body).inverse().mul(torque))
    };
    free.map(of_one).sum()
}
