//! Validation of scenes: the first problem, with its key.

use serde::Deserialize;

use super::format::{FORMAT, JointKind, OLD_FORMAT, PhysicsScene, SceneBody, SceneJoint};
use super::measure;
use super::shape::SceneShape;

/// Tolerance of a unit vector's length, of a joint's anchors (m) and axes: files have at least seven digits.
const ROUNDED: f64 = 1e-6;

/// Key and message of a problem; `None` where there is none.
pub(super) type Problem = Option<(String, String)>;

pub(super) fn positive(value: f64) -> bool {
    value.is_finite() && value > 0.0
}

pub(super) fn finite(vector: &[f64]) -> bool {
    vector.iter().all(|x| x.is_finite())
}

pub(super) fn unit(vector: &[f64]) -> bool {
    let length: f64 = vector.iter().map(|x| x * x).sum();
    (length - 1.0).abs() < 2.0 * ROUNDED
}

fn problem(key: impl Into<String>, what: impl Into<String>) -> Problem {
    Some((key.into(), what.into()))
}

impl PhysicsScene {
    /// The first problem of the scene.
    pub(super) fn problem(&self) -> Problem {
        if self.format != FORMAT && self.format != OLD_FORMAT {
            let what = format!("\"{}\" is not \"{FORMAT}\", nor the older \"{OLD_FORMAT}\"", self.format);
            return problem("format", what);
        }
        if !finite(&self.gravity) {
            return problem("gravity", format!("{:?} is not finite", self.gravity));
        }
        let times = self.dts.iter().enumerate().map(|(i, &dt)| (format!("dts[{i}]"), dt));
        let single = [("duration".into(), self.duration), ("energy_scale".into(), self.energy_scale)];
        if let Some((key, value)) = times.chain(single).find(|(_, value)| !positive(*value)) {
            return problem(key, format!("{value} is not a finite number above zero"));
        }
        if self.dts.is_empty() || self.bodies.is_empty() {
            return problem(if self.dts.is_empty() { "dts" } else { "bodies" }, "is empty");
        }
        let typed = self.format == FORMAT;
        let old = || (!typed).then(|| self.old_format_problem()).flatten();
        let surface = || self.surface.as_ref().and_then(|surface| surface.problem("surface"));
        let statics = || self.statics.iter().enumerate().find_map(|(i, fixed)| fixed.problem(&format!("static[{i}]")));
        let bodies =
            || (self.bodies.iter().enumerate()).find_map(|(i, body)| body.problem(&format!("bodies[{i}]"), typed));
        let joints = || (0..self.joints.len()).find_map(|i| self.joint_problem(i));
        let couplings = || (0..self.couplings.len()).find_map(|i| self.coupling_problem(i));
        let weight = || {
            let weight = self.meta.weight_body.filter(|&body| body >= self.bodies.len())?;
            problem("meta.weight_body", self.no_body(weight as i64))
        };
        old().or_else(surface).or_else(statics).or_else(bodies).or_else(joints).or_else(couplings).or_else(weight)
    }

    /// Features that the older format lacks.
    fn old_format_problem(&self) -> Problem {
        let newer = |key: String| problem(key, format!("is of \"{FORMAT}\"; \"{OLD_FORMAT}\" does not have it"));
        if self.surface.is_some() {
            return newer("surface".into());
        }
        if !self.statics.is_empty() {
            return newer("static".into());
        }
        if let Some(i) = self.bodies.iter().position(|body| body.surface.is_some()) {
            return newer(format!("bodies[{i}].surface"));
        }
        if let Some(i) = self.joints.iter().position(|joint| joint.limits.is_some()) {
            return newer(format!("joints[{i}].limits"));
        }
        if self.joints.len() != self.bodies.len() {
            let (joints, bodies) = (self.joints.len(), self.bodies.len());
            return problem("joints", format!("{joints} joints for {bodies} bodies; every body has one"));
        }
        self.joints.iter().enumerate().find_map(|(i, joint)| {
            if joint.b != i && joint.b < self.bodies.len() {
                return problem(
                    format!("joints[{i}].b"),
                    format!("{} is out of order; joint {i} hangs body {i}", joint.b),
                );
            }
            if joint.a >= i as i64 && joint.a < self.bodies.len() as i64 {
                let what = format!("body {} does not come before body {i}; parents come first", joint.a);
                return problem(format!("joints[{i}].a"), what);
            }
            None
        })
    }

    fn no_body(&self, index: i64) -> String {
        format!("there is no body {index}; they are 0 to {}", self.bodies.len() - 1)
    }

    fn joint_problem(&self, index: usize) -> Problem {
        let joint = &self.joints[index];
        let problem = |key: &str, what: String| problem(format!("joints[{index}].{key}"), what);
        if joint.b >= self.bodies.len() {
            return problem("b", self.no_body(joint.b as i64));
        }
        if joint.a < -1 || joint.a >= self.bodies.len() as i64 {
            return problem("a", format!("{}, and -1 for the world", self.no_body(joint.a)));
        }
        if joint.parent() == Some(joint.b) {
            return problem("a", format!("joins body {} to itself", joint.b));
        }
        for (key, anchor) in [("anchor_a", &joint.anchor_a), ("anchor_b", &joint.anchor_b)] {
            if !finite(anchor) {
                return problem(key, format!("{anchor:?} is not finite"));
            }
        }
        if joint.kind != JointKind::Spherical {
            for (key, axis) in [("axis_a", joint.axis_a), ("axis_b", joint.axis_b)] {
                let Some(axis) = axis else { return problem(key, "a hinge or slider needs its axis".into()) };
                if !unit(&axis) {
                    return problem(key, format!("{axis:?} is not of length 1"));
                }
            }
        }
        let start = |body: Option<usize>| body.map_or(measure::BodyState::WORLD, |body| self.bodies[body].state());
        let (a, b) = (start(joint.parent()), start(Some(joint.b)));
        let gap = measure::gap(joint, &a, &b);
        if gap > ROUNDED {
            return problem("anchor_b", format!("lies {gap:.3e} m from anchor_a at the start; joints begin closed"));
        }
        if let Some((axis_a, axis_b)) = joint.axes() {
            let apart = (a.rotation * axis_a - b.rotation * axis_b).length();
            if apart > ROUNDED {
                let what = format!("points {apart:.3e} away from axis_a at the start; joints begin closed");
                return problem("axis_b", what);
            }
        }
        match joint.limits {
            Some(_) if joint.kind == JointKind::Spherical => {
                problem("limits", "a spherical joint has no coordinate; limit hinges and sliders".into())
            }
            Some(limits @ [min, max]) if !(finite(&limits) && min <= 0.0 && max >= 0.0) => {
                problem("limits", format!("{limits:?} do not enclose the start, which is 0"))
            }
            _ => None,
        }
    }

    fn coupling_problem(&self, index: usize) -> Problem {
        let terms = &self.couplings[index].terms;
        if terms.len() < 2 {
            return problem(format!("couplings[{index}].terms"), "couples two joints at least");
        }
        terms.iter().enumerate().find_map(|(k, &(joint, coefficient))| {
            let what = match self.joints.get(joint) {
                None if self.joints.is_empty() => "there is no joint".into(),
                None => format!("there is no joint {joint}; they are 0 to {}", self.joints.len() - 1),
                Some(SceneJoint { kind: JointKind::Spherical, .. }) => {
                    format!("joint {joint} is spherical and has no coordinate; couple hinges and sliders")
                }
                Some(_) if !coefficient.is_finite() || coefficient == 0.0 => {
                    format!("coefficient {coefficient} is not a finite number other than zero")
                }
                Some(_) => return None,
            };
            problem(format!("couplings[{index}].terms[{k}]"), what)
        })
    }
}

impl SceneBody {
    /// The first problem of the body; `typed`: its shape must be a [`SceneShape`].
    fn problem(&self, key: &str, typed: bool) -> Problem {
        let problem = |own: &str, what: String| problem(format!("{key}.{own}"), what);
        if !positive(self.mass) {
            return problem("mass", format!("{} is not a finite number above zero", self.mass));
        }
        if !self.inertia.iter().all(|&i| positive(i)) {
            return problem("inertia", format!("{:?} are not finite numbers above zero", self.inertia));
        }
        for (own, vector) in [("pos", &self.pos), ("linvel", &self.linvel), ("angvel", &self.angvel)] {
            if !finite(vector) {
                return problem(own, format!("{vector:?} is not finite"));
            }
        }
        if !unit(&self.quat) {
            return problem("quat", format!("{:?} is not of length 1", self.quat));
        }
        if let Some(shape) = self.shape.as_ref().filter(|_| typed) {
            match SceneShape::deserialize(shape) {
                Err(error) => return problem("shape", error.to_string()),
                Ok(SceneShape::Plane { .. }) => {
                    return problem("shape", "a plane has no mass; give it under \"static\"".into());
                }
                Ok(solid) => {
                    let bad = solid.problem(&format!("{key}.shape"));
                    if bad.is_some() {
                        return bad;
                    }
                }
            }
        }
        self.surface.as_ref().and_then(|surface| surface.problem(&format!("{key}.surface")))
    }
}
