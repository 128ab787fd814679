//! The scene format `soffio-scene/1`: JSON, SI units, `y` up, right-handed.
//!
//! Bodies without a joint are free. Joints beyond a body's first close loops; hinges and sliders can have limits. In a
//! scene with a `surface`, the shapes of bodies and the `static` ones collide, except between bodies that a joint
//! connects.
//!
//! The older `isaac-bench-scene/1` is the subset without collisions, limits, loops and free bodies: joint i attaches
//! body i to an earlier body or the world. Its shapes are for display only.
//!
//! Invariant: a [`PhysicsScene`] from [`PhysicsScene::parse`] is valid. Its numbers are finite, its masses positive,
//! its joints closed at the start and within their limits.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::measure;
use super::shape::{ContactSurface, SceneShape, StaticShape};
use soffio_math::{DQuat, DVec3};

/// Value of `format`.
pub const FORMAT: &str = "soffio-scene/1";
/// Value of `format` in older files: joints in tree order, without collisions.
pub const OLD_FORMAT: &str = "isaac-bench-scene/1";

/// A mechanism in its start state, and how long to simulate it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PhysicsScene {
    /// [`FORMAT`] or [`OLD_FORMAT`].
    pub format: String,
    /// Name of the scene, as reports show it.
    pub name: String,
    /// Description.
    #[serde(default)]
    pub about: String,
    /// Acceleration of gravity, m/s².
    pub gravity: [f64; 3],
    /// Step lengths to run, s.
    pub dts: Vec<f64>,
    /// Time to simulate, s.
    pub duration: f64,
    /// Divisor of energy errors, J.
    pub energy_scale: f64,
    /// The bodies.
    pub bodies: Vec<SceneBody>,
    /// The joints.
    pub joints: Vec<SceneJoint>,
    /// Gears and drums.
    #[serde(default)]
    pub couplings: Vec<SceneCoupling>,
    /// Default contact surface; without it nothing collides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surface: Option<ContactSurface>,
    /// Static shapes.
    #[serde(default, rename = "static", skip_serializing_if = "Vec::is_empty")]
    pub statics: Vec<StaticShape>,
    /// Known properties of the motion.
    #[serde(default)]
    pub meta: Meta,
}

/// A rigid body in its start state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneBody {
    /// Name of the body.
    pub name: String,
    /// Mass, kg.
    pub mass: f64,
    /// Principal moments about the centre of mass, body axes, kg m².
    pub inertia: [f64; 3],
    /// A [`SceneShape`] about the centre of mass, which collides where the scene has a surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<serde_json::Value>,
    /// Contact surface, where it differs from the scene's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surface: Option<ContactSurface>,
    /// Centre of mass, world, m.
    pub pos: [f64; 3],
    /// Rotation from body axes to world axes, (x, y, z, w).
    pub quat: [f64; 4],
    /// Velocity of the centre of mass, world axes, m/s.
    pub linvel: [f64; 3],
    /// Angular velocity, world axes, rad/s.
    pub angvel: [f64; 3],
}

/// Kind of a joint, by its degrees of freedom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum JointKind {
    /// All rotations.
    Spherical,
    /// Rotation about an axis.
    Hinge,
    /// Translation along an axis.
    Slider,
}

/// A joint between a body and its parent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneJoint {
    /// Degrees of freedom.
    #[serde(rename = "type")]
    pub kind: JointKind,
    /// Index of the parent; −1 is the world.
    pub a: i64,
    /// Index of the child.
    pub b: usize,
    /// The joint's point in the parent's frame (in the world for the world), m.
    pub anchor_a: [f64; 3],
    /// The joint's point in the child's frame, m.
    pub anchor_b: [f64; 3],
    /// Axis of a hinge or slider in the parent's frame, unit length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis_a: Option<[f64; 3]>,
    /// The same axis in the child's frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis_b: Option<[f64; 3]>,
    /// Least and greatest coordinate of a hinge (rad) or slider (m), counted from the start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limits: Option<[f64; 2]>,
}

/// Coupled joint coordinates (gears and drums): Σ coefficient · (q − q₀) = 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneCoupling {
    /// Joint and coefficient: m for a hinge's radians where the sum is in metres, 1 for a slider's metres.
    pub terms: Vec<(usize, f64)>,
}

/// Known properties of a scene's motion; unknown keys are ignored.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Meta {
    /// Exact period of a pendulum, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<f64>,
    /// Amplitude of the pendulum, rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub theta0: Option<f64>,
    /// Exact acceleration of a falling weight, m/s².
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accel: Option<f64>,
    /// Index of the weight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weight_body: Option<usize>,
    /// Height of the weight's centre at the start, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weight_y0: Option<f64>,
}

/// Errors of scenes.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file does not exist or is not readable.
    #[error("cannot read {path}: {source}. Check the path")]
    Read {
        /// Path of the file.
        path: String,
        /// The system's error.
        source: std::io::Error,
    },
    /// Not JSON, or not the keys and types of a scene.
    #[error("{path}:{line}:{column}: {what}")]
    Syntax {
        /// File.
        path: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What was found.
        what: String,
    },
    /// A value out of range.
    #[error("{path}: {key}: {what}")]
    Value {
        /// File.
        path: String,
        /// The key, as in `joints[3].a`.
        key: String,
        /// What is wrong and what would be right.
        what: String,
    },
}

impl PhysicsScene {
    /// Reads a scene from a file.
    ///
    /// # Errors
    /// As [`SceneError`] lists.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path).map_err(|source| SceneError::Read { path: name.clone(), source })?;
        Self::parse(&text, &name)
    }

    /// Reads a scene from text; `path` is its name in messages.
    ///
    /// # Errors
    /// As [`SceneError`] lists.
    pub fn parse(text: &str, path: &str) -> Result<Self, SceneError> {
        let scene: Self = serde_json::from_str(text).map_err(|error| {
            let what = error.to_string();
            let what = what.rsplit_once(" at line ").map_or(what.as_str(), |(what, _)| what).to_owned();
            SceneError::Syntax { path: path.to_owned(), line: error.line(), column: error.column(), what }
        })?;
        match scene.problem() {
            None => Ok(scene),
            Some((key, what)) => Err(SceneError::Value { path: path.to_owned(), key, what }),
        }
    }

    /// The scene as text that [`PhysicsScene::parse`] reads back.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("numbers and names are JSON")
    }
}

impl SceneBody {
    /// The collision shape; `None` where the body has none.
    pub fn solid(&self) -> Option<SceneShape> {
        SceneShape::deserialize(self.shape.as_ref()?).ok()
    }

    /// Pose and velocities at the start.
    pub fn state(&self) -> measure::BodyState {
        measure::BodyState {
            position: DVec3::from_array(self.pos),
            rotation: DQuat::from_array(self.quat).normalize(),
            velocity: DVec3::from_array(self.linvel),
            angular_velocity: DVec3::from_array(self.angvel),
        }
    }
}

impl SceneJoint {
    /// The parent body; `None` is the world.
    pub fn parent(&self) -> Option<usize> {
        usize::try_from(self.a).ok()
    }

    /// The axis of a hinge or slider in both frames, unit.
    pub fn axes(&self) -> Option<(DVec3, DVec3)> {
        let unit = |axis| DVec3::from_array(axis).normalize();
        (self.kind != JointKind::Spherical).then(|| Some((unit(self.axis_a?), unit(self.axis_b?))))?
    }
}
