//! Bodies by fours: who stands beside whom, and where they all are.
//!
//! A *quad* is four bodies whose numbers lie side by side (`lanes.rs`). Bodies of one depth in the tree that each hang by
//! one point are put together, so that a quad of them is eliminated at once; all others fill quads of their own, where
//! what needs no order (poses, inertias, arms) is still done by fours. A lane that is left over repeats the quad's first
//! body and is never read. The last quad is the world's: at the origin, at rest.

use fearless_simd::{Level, Simd, dispatch};

use crate::math::lanes::{All, Four, Lanes, One, V3, WIDTH};
use super::spatial::{M3, Sym3};
use crate::bodies::RigidBody;
use crate::math::{DMat3, DVec3};

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

    /// One more.
    pub fn push(&mut self, body: usize) {
        self.bodies[self.count] = body;
        self.count += 1;
    }
}

/// Mass, place and motion of four bodies, world axes but where said.
#[derive(Clone, Copy, Debug)]
pub struct Quad {
    /// kg.
    pub mass: Four,
    /// Body axes, kg m².
    own_inertia: Sym3<Four>,
    /// Centres of mass, m.
    pub position: V3<Four>,
    /// m/s.
    pub velocity: V3<Four>,
    /// rad/s.
    pub spin: V3<Four>,
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
        Self { level, members: members.to_vec(), slots, quads }
    }

    /// Which instructions there are.
    pub fn level(&self) -> Level {
        self.level
    }

    /// The quads, the world's last.
    pub fn all(&self) -> &[Quad] {
        &self.quads
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
    pub fn mass(&self, body: usize) -> f64 {
        let slot = self.slots[body];
        self.quads[slot.quad].mass.0[slot.lane]
    }

    /// World inertia of a body, kg m².
    pub fn inertia(&self, body: usize) -> Sym3 {
        let slot = self.slots[body];
        self.quads[slot.quad].inertia.get(One(slot.lane))
    }

    /// Rotation matrix of a body.
    pub fn frame(&self, body: usize) -> DMat3 {
        let slot = self.slots[body];
        let m = self.quads[slot.quad].frame.get(One(slot.lane));
        DMat3::from_cols(m.x.into(), m.y.into(), m.z.into())
    }

    /// Takes over where the bodies are.
    pub fn look(&mut self, bodies: &[RigidBody]) {
        let (members, quads) = (&self.members, &mut self.quads);
        dispatch!(self.level, simd => look(simd, members, quads, bodies));
    }
}

#[inline(always)]
fn look<S: Simd>(simd: S, members: &[Members], quads: &mut [Quad], bodies: &[RigidBody]) {
    let lanes = All(simd);
    for (four, quad) in members.iter().zip(quads) {
        let own = four.bodies.map(|body| &bodies[body]);
        let vector = |of: fn(&RigidBody) -> &DVec3| gather(lanes, |k| of(own[k]));
        quad.position.put(lanes, vector(|body| &body.position));
        quad.velocity.put(lanes, vector(|body| &body.velocity));
        quad.spin.put(lanes, vector(|body| &body.angular_velocity));
        let q = V3 {
            x: lanes.gather(|k| own[k].rotation.x),
            y: lanes.gather(|k| own[k].rotation.y),
            z: lanes.gather(|k| own[k].rotation.z),
        };
        let frame = M3::of_rotation(q, lanes.gather(|k| own[k].rotation.w));
        quad.frame.put(lanes, &frame);
        quad.inertia.put(lanes, &quad.own_inertia.get(lanes).rotated(&frame));
    }
}

/// A vector of each body.
#[inline(always)]
pub fn gather<'a, L: Lanes>(lanes: L, vector: impl Fn(usize) -> &'a DVec3) -> V3<L::T> {
    V3 {
        x: lanes.gather(|k| vector(k).x),
        y: lanes.gather(|k| vector(k).y),
        z: lanes.gather(|k| vector(k).z),
    }
}

impl Quad {
    fn world() -> Self {
        let (zero, one) = (Four::splat(0.0), Four::splat(1.0));
        let none = V3 { x: zero, y: zero, z: zero };
        Self {
            mass: one,
            own_inertia: Sym3 { d: V3 { x: one, y: one, z: one }, o: none },
            position: none,
            velocity: none,
            spin: none,
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
