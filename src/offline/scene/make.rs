//! Generated scenes: mechanisms of any size from a seed, for which nothing was tuned.
//!
//! Bodies are attached one by one below their parents, with the velocity that follows from the parent's motion and
//! their own spin. So joints start closed in position and velocity.

use super::format::{FORMAT, JointKind, Meta, PhysicsScene, SceneBody, SceneJoint};
use super::measure::{BodyState, energy};
use soffio_math::noise::Random;
use soffio_math::{DQuat, DVec3, PI, rotation};

const G: f64 = 9.81;
const TIMES: [f64; 2] = [1.0 / 240.0, 1e-3];
/// Thickness and width of rods, m.
const THICKNESS: f64 = 0.01;

/// A chain of `n` rods of random lengths and masses, nailed at the origin and released stretched out sideways, each
/// with a small spin.
pub fn chain(n: usize, seed: u64) -> PhysicsScene {
    let mut random = Random::new(seed);
    let mut maker = Maker::new(format!("chain_{n}_seed_{seed}"), "a whip of rods");
    let mut end = [0.0; 3];
    for i in 0..n {
        let half = random.range(0.025, 0.075);
        let mass = random.range(0.02, 0.1);
        let turn = rotation(DVec3::new(0.0, random.signed(), 0.5 * random.signed()));
        let spin = 0.3 * vector(&mut random);
        maker.hang(i.checked_sub(1), end, LinkShape::rod(mass, half), [-half, 0.0, 0.0], turn, spin);
        end = [half, 0.0, 0.0];
    }
    maker.falling()
}

/// A hanging mobile of `n` bodies in binary-heap order: beams hang on beams, plates on the lowest, all level. It spins,
/// and each body has a small random velocity.
pub fn mobile(n: usize, seed: u64) -> PhysicsScene {
    let mut random = Random::new(seed);
    let children = |i: usize| [2 * i + 1, 2 * i + 2].into_iter().filter(move |&c| c < n);
    let parts: Vec<_> = (0..n)
        .map(|i| {
            // Beams of a level are shorter than those above.
            let level = (i + 1).ilog2();
            let half = 0.5 / (1.0 + 0.3 * f64::from(level)) * random.range(0.8, 1.2);
            if children(i).next().is_some() {
                LinkShape::beam(random.range(0.03, 0.08), half)
            } else {
                LinkShape::plate(random.range(0.03, 0.08))
            }
        })
        .collect();
    // Mass that hangs on each body, itself included.
    let mut load: Vec<f64> = parts.iter().map(|part| part.mass).collect();
    for i in (1..n).rev() {
        load[(i - 1) / 2] += load[i];
    }
    let mut maker = Maker::new(format!("mobile_{n}_seed_{seed}"), "a mobile of beams and plates, hanging level");
    for i in 0..n {
        let parent = i.checked_sub(1).map(|below| below / 2);
        let side = if i % 2 == 1 { -1.0 } else { 1.0 };
        let anchor_a = parent.map_or([0.0; 3], |parent| [side * parts[parent].half[0], 0.0, 0.0]);
        // Level: the pivot is above the centre of mass of all that hangs here.
        let lean: f64 = children(i).zip([-1.0, 1.0]).map(|(child, side)| side * load[child]).sum();
        let anchor_b = if children(i).next().is_some() {
            [parts[i].half[0] * lean / load[i], 0.05, 0.0]
        } else {
            [0.0, parts[i].half[1] + 0.06, 0.0]
        };
        let turn = rotation(DVec3::Y * random.range(0.0, 2.0 * PI));
        let spin = DVec3::Y * 0.8 + 0.15 * vector(&mut random);
        maker.hang(parent, anchor_a, parts[i], anchor_b, turn, spin);
    }
    maker.moving()
}

/// A chain of `n` light rods that carries a block `ratio` times as heavy as a rod, released off the vertical.
pub fn mass_ratio(n: usize, ratio: f64, seed: u64) -> PhysicsScene {
    let mut random = Random::new(seed);
    let mut maker = Maker::new(format!("massratio_{n}_{ratio}_seed_{seed}"), "a heavy block on light rods");
    let off = random.range(0.3, 0.7);
    let turn = rotation(DVec3::Y * random.range(0.0, 2.0 * PI)) * rotation(DVec3::Z * (off - 0.5 * PI));
    let mass = random.range(0.005, 0.02);
    let half = random.range(0.03, 0.07);
    let mut end = [0.0; 3];
    for i in 0..n {
        maker.hang(i.checked_sub(1), end, LinkShape::rod(mass, half), [-half, 0.0, 0.0], turn, DVec3::ZERO);
        end = [half, 0.0, 0.0];
    }
    let block = LinkShape::cuboid(ratio * mass, DVec3::splat(half));
    maker.hang(n.checked_sub(1), end, block, [-half, 0.0, 0.0], turn, DVec3::ZERO);
    maker.falling()
}

fn vector(random: &mut Random) -> DVec3 {
    DVec3::new(random.signed(), random.signed(), random.signed())
}

/// A homogeneous box.
#[derive(Clone, Copy)]
struct LinkShape {
    mass: f64,
    half: DVec3,
}

impl LinkShape {
    fn cuboid(mass: f64, half: DVec3) -> Self {
        Self { mass, half }
    }

    fn rod(mass: f64, half: f64) -> Self {
        Self::cuboid(mass, DVec3::new(half, 0.5 * THICKNESS, 0.5 * THICKNESS))
    }

    fn beam(mass: f64, half: f64) -> Self {
        Self::cuboid(mass, DVec3::new(half, 0.003, 0.003))
    }

    fn plate(mass: f64) -> Self {
        Self::cuboid(mass, DVec3::new(0.06, 0.1, 0.001))
    }

    /// Moments of inertia: m/3 times the squares of the other two half sides, kg m².
    fn inertia(&self) -> [f64; 3] {
        let s = self.half * self.half;
        [s.y + s.z, s.z + s.x, s.x + s.y].map(|sum| sum * self.mass / 3.0)
    }
}

struct Maker {
    scene: PhysicsScene,
    states: Vec<BodyState>,
}

impl Maker {
    fn new(name: String, about: &str) -> Self {
        let scene = PhysicsScene {
            format: FORMAT.into(),
            name,
            about: about.into(),
            gravity: [0.0, -G, 0.0],
            dts: TIMES.to_vec(),
            duration: 10.0,
            energy_scale: 0.0,
            bodies: Vec::new(),
            joints: Vec::new(),
            couplings: Vec::new(),
            surface: None,
            statics: Vec::new(),
            meta: Meta::default(),
        };
        Self { scene, states: Vec::new() }
    }

    /// Attaches a body with its `anchor_b` to the `anchor_a` of an earlier one or of the world; it spins by `spin`.
    fn hang(
        &mut self,
        a: Option<usize>,
        anchor_a: [f64; 3],
        part: LinkShape,
        anchor_b: [f64; 3],
        turn: DQuat,
        spin: DVec3,
    ) {
        let parent = a.map_or(BodyState::WORLD, |a| self.states[a]);
        let arm = turn * DVec3::from_array(anchor_b);
        let pivot = parent.point(anchor_a);
        let pivot_velocity = parent.velocity + parent.angular_velocity.cross(pivot - parent.position);
        let state = BodyState {
            position: pivot - arm,
            rotation: turn,
            velocity: pivot_velocity - spin.cross(arm),
            angular_velocity: spin,
        };
        let b = self.states.len();
        self.states.push(state);
        self.scene.bodies.push(SceneBody {
            name: format!("body{b}"),
            mass: part.mass,
            inertia: part.inertia(),
            shape: Some(serde_json::json!({ "type": "box", "half": part.half.to_array() })),
            surface: None,
            pos: state.position.to_array(),
            quat: state.rotation.to_array(),
            linvel: state.velocity.to_array(),
            angvel: state.angular_velocity.to_array(),
        });
        let a = a.map_or(-1, |a| a as i64);
        let kind = JointKind::Spherical;
        self.scene.joints.push(SceneJoint { kind, a, b, anchor_a, anchor_b, axis_a: None, axis_b: None, limits: None });
    }

    /// The scene, its energy scale the potential energy above hanging straight down plus the initial kinetic energy.
    fn falling(mut self) -> PhysicsScene {
        let mut low: Vec<DVec3> = Vec::new();
        let straight = |half: f64, above: DVec3| above - DVec3::Y * half;
        let mut end = DVec3::ZERO;
        for joint in &self.scene.joints {
            let half = DVec3::from_array(joint.anchor_b).length();
            low.push(straight(half, end));
            end = straight(2.0 * half, end);
        }
        let hanging: Vec<_> = low.into_iter().map(|position| BodyState { position, ..BodyState::WORLD }).collect();
        self.scene.energy_scale = energy(&self.scene, &self.states) - energy(&self.scene, &hanging);
        self.scene
    }

    /// The scene, its energy scale the initial kinetic energy.
    fn moving(mut self) -> PhysicsScene {
        let at_rest = |state: &BodyState| BodyState { velocity: DVec3::ZERO, angular_velocity: DVec3::ZERO, ..*state };
        let still: Vec<_> = self.states.iter().map(at_rest).collect();
        self.scene.energy_scale = energy(&self.scene, &self.states) - energy(&self.scene, &still);
        self.scene
    }
}
