//! The scene format `isaac-bench-scene/1`: JSON, SI units, `y` up, right-handed.
//!
//! Invariant: a [`Scene`] that [`Scene::parse`] returns is sound. Its numbers are finite, its masses positive, its
//! joints in tree order (joint i hangs body i on an earlier body or the world) and closed at the start.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::measure;
use soffio_math::{DQuat, DVec3};

/// What `format` says.
pub const FORMAT: &str = "isaac-bench-scene/1";
/// How far a unit vector's length, a joint's anchors (m) or its axes may be off: files have at least seven digits.
const ROUNDED: f64 = 1e-6;

/// An articulated figure at its start, and how long to run it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// [`FORMAT`].
    pub format: String,
    /// Name of the scene.
    pub name: String,
    /// What it shows.
    #[serde(default)]
    pub about: String,
    /// m/s².
    pub gravity: [f64; 3],
    /// Step lengths to run, s.
    pub dts: Vec<f64>,
    /// Time to simulate, s.
    pub duration: f64,
    /// What energy errors are divided by, J.
    pub energy_scale: f64,
    /// The bodies, parents before children.
    pub bodies: Vec<Body>,
    /// One per body: joint i hangs body i.
    pub joints: Vec<Joint>,
    /// Gears and drums.
    #[serde(default)]
    pub couplings: Vec<Coupling>,
    /// What is known of the motion.
    #[serde(default)]
    pub meta: Meta,
}

/// A rigid body at its start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Name of the body.
    pub name: String,
    /// kg.
    pub mass: f64,
    /// Principal moments about the centre of mass, body axes, kg m².
    pub inertia: [f64; 3],
    /// What to draw; nothing here uses it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<serde_json::Value>,
    /// Centre of mass in the world, m.
    pub pos: [f64; 3],
    /// Body axes to world axes, (x, y, z, w).
    pub quat: [f64; 4],
    /// Velocity of the centre of mass, world axes, m/s.
    pub linvel: [f64; 3],
    /// World axes, rad/s.
    pub angvel: [f64; 3],
}

/// What a joint leaves free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum JointKind {
    /// All rotation.
    Spherical,
    /// Rotation about an axis.
    Hinge,
    /// A way along an axis.
    Slider,
}

/// A joint between a body and its parent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// What it leaves free.
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
}

/// Coordinates of joints that keep a proportion: Σ coefficient · (q − q₀) = 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Coupling {
    /// Joint and coefficient: m for a hinge's radians where the sum is in metres, 1 for a slider's metres.
    pub terms: Vec<(usize, f64)>,
}

/// What is known of a scene's motion; keys that are not known here are passed over.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Meta {
    /// Exact period of a pendulum, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<f64>,
    /// Its amplitude, rad.
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

/// Why a scene cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file is not there or not readable.
    #[error("cannot read {path}: {source}. Check the path")]
    Read {
        /// Where it was looked for.
        path: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// Not JSON, or not the keys and types of a scene.
    #[error("{path}:{line}:{column}: {what}")]
    Syntax {
        /// File.
        path: String,
        /// From 1.
        line: usize,
        /// From 1.
        column: usize,
        /// What was found there.
        what: String,
    },
    /// A value that makes no figure.
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

impl Scene {
    /// Reads a scene from a file.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path).map_err(|source| SceneError::Read { path: name.clone(), source })?;
        Self::parse(&text, &name)
    }

    /// Reads a scene from text; `path` is what messages call it.
    pub fn parse(text: &str, path: &str) -> Result<Self, SceneError> {
        let scene: Self = serde_json::from_str(text).map_err(|error| {
            let what = error.to_string();
            let what = what.rsplit_once(" at line ").map_or(what.as_str(), |(what, _)| what).to_owned();
            SceneError::Syntax { path: path.to_owned(), line: error.line(), column: error.column(), what }
        })?;
        match scene.fault() {
            None => Ok(scene),
            Some((key, what)) => Err(SceneError::Value { path: path.to_owned(), key, what }),
        }
    }

    /// The scene as text that [`Scene::parse`] reads back.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("numbers and names are JSON")
    }

    /// The first thing that makes it no figure: where, and what.
    fn fault(&self) -> Option<(String, String)> {
        let fault = |key: String, what: String| Some((key, what));
        if self.format != FORMAT {
            return fault("format".into(), format!("\"{}\" is not \"{FORMAT}\"", self.format));
        }
        if !self.gravity.iter().all(|g| g.is_finite()) {
            return fault("gravity".into(), format!("{:?} is not finite", self.gravity));
        }
        let times = self.dts.iter().enumerate().map(|(i, &dt)| (format!("dts[{i}]"), dt));
        let single = [("duration".into(), self.duration), ("energy_scale".into(), self.energy_scale)];
        if let Some((key, value)) = times.chain(single).find(|(_, value)| !positive(*value)) {
            return fault(key, format!("{value} is not a finite number above zero"));
        }
        if self.dts.is_empty() || self.bodies.is_empty() {
            return fault(if self.dts.is_empty() { "dts" } else { "bodies" }.into(), "is empty".into());
        }
        if self.joints.len() != self.bodies.len() {
            let (joints, bodies) = (self.joints.len(), self.bodies.len());
            return fault("joints".into(), format!("{joints} joints for {bodies} bodies; every body has one"));
        }
        let bodies = self.bodies.iter().enumerate().find_map(|(i, body)| body.fault(&format!("bodies[{i}]")));
        let joints = || (0..self.joints.len()).find_map(|i| self.joint_fault(i));
        let couplings = || (0..self.couplings.len()).find_map(|i| self.coupling_fault(i));
        bodies.or_else(joints).or_else(couplings).or_else(|| {
            let weight = self.meta.weight_body.filter(|&body| body >= self.bodies.len())?;
            fault("meta.weight_body".into(), self.no_body(weight as i64))
        })
    }

    fn no_body(&self, index: i64) -> String {
        format!("there is no body {index}; they are 0 to {}", self.bodies.len() - 1)
    }

    fn joint_fault(&self, index: usize) -> Option<(String, String)> {
        let joint = &self.joints[index];
        let fault = |key: &str, what: String| Some((format!("joints[{index}].{key}"), what));
        if joint.b != index {
            let what = if joint.b >= self.bodies.len() {
                self.no_body(joint.b as i64)
            } else {
                format!("{} is out of order; joint {index} hangs body {index}", joint.b)
            };
            return fault("b", what);
        }
        if joint.a < -1 || joint.a >= self.bodies.len() as i64 {
            return fault("a", format!("{}, and -1 for the world", self.no_body(joint.a)));
        }
        if joint.a >= index as i64 {
            return fault("a", format!("body {} does not come before body {index}; parents come first", joint.a));
        }
        for (key, anchor) in [("anchor_a", &joint.anchor_a), ("anchor_b", &joint.anchor_b)] {
            if !anchor.iter().all(|x| x.is_finite()) {
                return fault(key, format!("{anchor:?} is not finite"));
            }
        }
        if joint.kind != JointKind::Spherical {
            for (key, axis) in [("axis_a", joint.axis_a), ("axis_b", joint.axis_b)] {
                let Some(axis) = axis else { return fault(key, "a hinge or slider needs its axis".into()) };
                if !unit(&axis) {
                    return fault(key, format!("{axis:?} is not of length 1"));
                }
            }
        }
        let states: Vec<_> = [joint.parent(), Some(joint.b)]
            .into_iter()
            .map(|body| body.map_or(measure::State::WORLD, |body| self.bodies[body].state()))
            .collect();
        let gap = measure::gap(joint, &states[0], &states[1]);
        if gap > ROUNDED {
            return fault("anchor_b", format!("lies {gap:.3e} m from anchor_a at the start; joints begin closed"));
        }
        if let Some((a, b)) = joint.axes() {
            let apart = (states[0].rotation * a - states[1].rotation * b).length();
            if apart > ROUNDED {
                return fault(
                    "axis_b",
                    format!("points {apart:.3e} away from axis_a at the start; joints begin closed"),
                );
            }
        }
        None
    }

    fn coupling_fault(&self, index: usize) -> Option<(String, String)> {
        let terms = &self.couplings[index].terms;
        if terms.len() < 2 {
            return Some((format!("couplings[{index}].terms"), "couples two joints at least".into()));
        }
        terms.iter().enumerate().find_map(|(k, &(joint, coefficient))| {
            let what = match self.joints.get(joint) {
                None => format!("there is no joint {joint}; they are 0 to {}", self.joints.len() - 1),
                Some(Joint { kind: JointKind::Spherical, .. }) => {
                    format!("joint {joint} is spherical and has no coordinate; couple hinges and sliders")
                }
                Some(_) if !coefficient.is_finite() || coefficient == 0.0 => {
                    format!("coefficient {coefficient} is not a finite number other than zero")
                }
                Some(_) => return None,
            };
            Some((format!("couplings[{index}].terms[{k}]"), what))
        })
    }
}

impl Body {
    fn fault(&self, key: &str) -> Option<(String, String)> {
        let fault = |own: &str, what: String| Some((format!("{key}.{own}"), what));
        if !positive(self.mass) {
            return fault("mass", format!("{} is not a finite number above zero", self.mass));
        }
        if !self.inertia.iter().all(|&i| positive(i)) {
            return fault("inertia", format!("{:?} are not finite numbers above zero", self.inertia));
        }
        for (own, vector) in [("pos", &self.pos), ("linvel", &self.linvel), ("angvel", &self.angvel)] {
            if !vector.iter().all(|x| x.is_finite()) {
                return fault(own, format!("{vector:?} is not finite"));
            }
        }
        (!unit(&self.quat)).then(|| fault("quat", format!("{:?} is not of length 1", self.quat)))?
    }

    /// Pose and velocities at the start.
    pub fn state(&self) -> measure::State {
        measure::State {
            position: DVec3::from_array(self.pos),
            rotation: DQuat::from_array(self.quat).normalize(),
            velocity: DVec3::from_array(self.linvel),
            angular_velocity: DVec3::from_array(self.angvel),
        }
    }
}

impl Joint {
    /// The parent body; `None` is the world.
    pub fn parent(&self) -> Option<usize> {
        usize::try_from(self.a).ok()
    }

    /// The axis in both frames, of a hinge or slider.
    pub fn axes(&self) -> Option<(DVec3, DVec3)> {
        let unit = |axis| DVec3::from_array(axis).normalize();
        (self.kind != JointKind::Spherical).then(|| Some((unit(self.axis_a?), unit(self.axis_b?))))?
    }
}

fn positive(value: f64) -> bool {
    value.is_finite() && value > 0.0
}

fn unit(vector: &[f64]) -> bool {
    let length: f64 = vector.iter().map(|x| x * x).sum();
    (length - 1.0).abs() < 2.0 * ROUNDED
}
