//! Builds a scene body by body. Masses and inertias follow from shapes and densities.
//!
//! ```text
//! box        m = 8 ρ a b c      Ix = m (b² + c²)/3
//! sphere     m = 4/3 π ρ r³     I = 2/5 m r²
//! cylinder   m = 2 π ρ r² h     along m r²/2, across m (r²/4 + h²/3)
//! capsule    cylinder and two half balls m₂ = 4/3 π ρ r³: along m₁ r²/2 + 2/5 m₂ r²,
//!            across m₁ (r²/4 + h²/3) + m₂ (2/5 r² + h² + 3/4 h r)
//! ```
//!
//! h is half the height of a cylinder, or of the straight part of a capsule.

use serde_json::to_value;
use soffio_math::{DQuat, DVec3, PI};
use soffio_offline::scene::{
    BodyState, ContactSurface, FORMAT, JointKind, Meta, PhysicsScene, SceneBody, SceneJoint, SceneShape, ShapeAxis,
    StaticShape,
};

/// m/s².
const G: f64 = 9.81;
/// Step lengths to run, s.
const TIMES: [f64; 2] = [1.0 / 240.0, 1e-3];
/// kg/m³.
pub const WOOD: f64 = 500.0;
pub const STEEL: f64 = 7_800.0;
/// Part of the smallest half extent that rounds edges, as shapes fitted to an exhibit's meshes have.
const ROUNDING: f64 = 0.02;

/// A box with rounded edges.
pub fn cuboid(half: DVec3) -> SceneShape {
    SceneShape::Box { half: half.to_array(), rounding: ROUNDING * half.min_element() }
}

/// A ball.
pub fn ball(radius: f64) -> SceneShape {
    SceneShape::Sphere { radius }
}

/// A cylinder along y with rounded edges.
pub fn cylinder(radius: f64, half_height: f64) -> SceneShape {
    let rounding = ROUNDING * radius.min(half_height);
    SceneShape::Cylinder { radius, half_height, axis: ShapeAxis::Y, rounding }
}

/// A capsule.
pub fn capsule(radius: f64, half_height: f64, axis: ShapeAxis) -> SceneShape {
    SceneShape::Capsule { radius, half_height, axis }
}

/// A body at rest at a place.
pub fn at(position: DVec3) -> BodyState {
    BodyState { position, ..BodyState::WORLD }
}

pub struct Builder {
    scene: PhysicsScene,
    states: Vec<BodyState>,
}

impl Builder {
    pub fn new(name: &str, about: &str, duration: f64) -> Self {
        let scene = PhysicsScene {
            format: FORMAT.into(),
            name: name.into(),
            about: about.into(),
            gravity: [0.0, -G, 0.0],
            dts: TIMES.to_vec(),
            duration,
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

    /// Shapes collide with this friction and restitution.
    pub fn colliding(mut self, friction: f64, restitution: f64) -> Self {
        self.scene.surface = Some(ContactSurface { friction, restitution, ..ContactSurface::default() });
        self
    }

    /// A floor at height 0.
    pub fn floor(mut self) -> Self {
        self.fixed(SceneShape::Plane { normal: [0.0, 1.0, 0.0] }, DVec3::ZERO, DQuat::IDENTITY);
        self
    }

    /// A shape of the world.
    pub fn fixed(&mut self, shape: SceneShape, position: DVec3, rotation: DQuat) {
        self.scene.statics.push(StaticShape::new(shape, position, rotation));
    }

    /// A homogeneous body; returns its index.
    pub fn body(&mut self, solid: SceneShape, density: f64, state: BodyState) -> usize {
        let (mass, inertia) = weigh(&solid, density);
        let index = self.states.len();
        self.states.push(state);
        self.scene.bodies.push(SceneBody {
            name: format!("body{index}"),
            mass,
            inertia,
            shape: Some(to_value(solid).expect("numbers are JSON")),
            surface: None,
            pos: state.position.to_array(),
            quat: state.rotation.to_array(),
            linvel: state.velocity.to_array(),
            angvel: state.angular_velocity.to_array(),
        });
        index
    }

    /// A joint between two bodies (no `a` is the world) at a point of the world.
    fn joint(
        &mut self,
        kind: JointKind,
        a: Option<usize>,
        b: usize,
        point: DVec3,
        axis: Option<DVec3>,
    ) -> &mut SceneJoint {
        let state = |body: Option<usize>| body.map_or(BodyState::WORLD, |body| self.states[body]);
        let (first, second) = (state(a), state(Some(b)));
        let local = |state: &BodyState, v: DVec3| (state.rotation.conjugate() * v).to_array();
        let joint = SceneJoint {
            kind,
            a: a.map_or(-1, |a| a as i64),
            b,
            anchor_a: local(&first, point - first.position),
            anchor_b: local(&second, point - second.position),
            axis_a: axis.map(|axis| local(&first, axis)),
            axis_b: axis.map(|axis| local(&second, axis)),
            limits: None,
        };
        self.scene.joints.push(joint);
        self.scene.joints.last_mut().expect("just pushed")
    }

    /// A ball joint at a point of the world.
    pub fn spherical(&mut self, a: Option<usize>, b: usize, point: DVec3) {
        self.joint(JointKind::Spherical, a, b, point, None);
    }

    /// A hinge about z at a point of the world.
    pub fn hinge(&mut self, a: Option<usize>, b: usize, point: DVec3, limits: Option<[f64; 2]>) {
        self.joint(JointKind::Hinge, a, b, point, Some(DVec3::Z)).limits = limits;
    }

    /// The scene; its energy is the kinetic energy at the start plus the potential energy above a height of `ground`.
    pub fn finish(mut self, ground: f64) -> PhysicsScene {
        let energy = |(body, state): (&SceneBody, &BodyState)| {
            let spin = state.rotation.conjugate() * state.angular_velocity;
            let turning = 0.5 * spin.dot(DVec3::from_array(body.inertia) * spin);
            0.5 * body.mass * state.velocity.length_squared() + turning + body.mass * G * (state.position.y - ground)
        };
        self.scene.energy_scale = self.scene.bodies.iter().zip(&self.states).map(energy).sum();
        self.scene
    }
}

/// Mass and principal moments of a homogeneous solid.
fn weigh(solid: &SceneShape, density: f64) -> (f64, [f64; 3]) {
    let round = |axis: ShapeAxis, along: f64, across: f64| match axis {
        ShapeAxis::X => [along, across, across],
        ShapeAxis::Y => [across, along, across],
        ShapeAxis::Z => [across, across, along],
    };
    match *solid {
        SceneShape::Box { half: [a, b, c], .. } => {
            let mass = 8.0 * density * a * b * c;
            let moment = |p: f64, q: f64| mass * (p * p + q * q) / 3.0;
            (mass, [moment(b, c), moment(c, a), moment(a, b)])
        }
        SceneShape::Sphere { radius: r } => {
            let mass = 4.0 / 3.0 * PI * density * r * r * r;
            (mass, [0.4 * mass * r * r; 3])
        }
        SceneShape::Cylinder { radius: r, half_height: h, axis, .. } => {
            let mass = 2.0 * PI * density * r * r * h;
            (mass, round(axis, 0.5 * mass * r * r, mass * (0.25 * r * r + h * h / 3.0)))
        }
        SceneShape::Capsule { radius: r, half_height: h, axis } => {
            let (tube, caps) = (2.0 * PI * density * r * r * h, 4.0 / 3.0 * PI * density * r * r * r);
            let along = (0.5 * tube + 0.4 * caps) * r * r;
            let across = tube * (0.25 * r * r + h * h / 3.0) + caps * (0.4 * r * r + h * h + 0.75 * h * r);
            (tube + caps, round(axis, along, across))
        }
        SceneShape::Plane { .. } => unreachable!("a plane is no body"),
    }
}
