//! One joint of `KHR_physics_rigid_bodies` as constraints of the sidecar.
//!
//! Limits name axes of the joint's node, and the range of the connected node along or about them. A limit without range
//! locks its axes; the locked axes (linear, angular) determine the kind:
//!
//! ```text
//! xyz, –        point-to-point          xyz, two    hinge about the third       two, xyz    slider along the third
//! xyz, one      universal               xyz, xyz    weld                        two, –      line
//! any other: a plane for each linear axis, an orientation for each angular one
//! ```
//!
//! In the extension the connected node moves relative to the joint's node; in the sidecar a hinge counts the rotation
//! of its own body. Where that is the joint's node, the sign changes.

use std::fmt::Write;

use serde_json::Value;

use super::khr::{Reader, rotation_of};
use super::nodes::toml_vector;
use super::texts::quoted;
use soffio_math::{DVec3, PI, acos};

/// Tolerance of frames that coincide in the model, m and rad: seven digits of a file.
const SAME_POINT: f64 = 1e-6;
/// Width of a range that counts as locked, m or rad.
const ZERO_LIMIT: f64 = 1e-9;

/// The limits of a joint.
#[derive(Default)]
struct Limits {
    /// Limits of the displacements.
    linear: AxisLimits,
    /// Limits of the rotations.
    angular: AxisLimits,
}

/// The limits along, or about, the three axes.
#[derive(Default)]
struct AxisLimits {
    /// Is the axis locked?
    locked: [bool; 3],
    /// Ranges of axes that are not locked.
    ranges: Vec<AxisRange>,
}

/// The range of one axis; `None` where it has no bound.
struct AxisRange {
    axis: usize,
    min: Option<f64>,
    max: Option<f64>,
}

impl AxisLimits {
    fn locked_axes(&self) -> Vec<usize> {
        (0..3).filter(|&axis| self.locked[axis]).collect()
    }

    fn free_axes(&self) -> Vec<usize> {
        (0..3).filter(|&axis| !self.locked[axis]).collect()
    }
}

fn axes(limit: &Value, key: &str) -> Vec<usize> {
    let list = limit[key].as_array().into_iter().flatten().filter_map(Value::as_u64);
    list.map(|axis| axis as usize).filter(|&axis| axis < 3).collect()
}

/// Converts a joint; reports what is lost.
pub(super) fn convert_joint(reader: &mut Reader, node: usize, joint: &Value) {
    let count = reader.model.nodes.len();
    let Some(other) = joint["connectedNode"].as_u64().map(|n| n as usize).filter(|&n| n < count) else {
        return reader.remark(node, "its joint connects nothing: skipped");
    };
    let description = joint["joint"].as_u64().and_then(|i| reader.list("physicsJoints").get(i as usize)).cloned();
    let Some(description) = description else {
        return reader.remark(node, "its joint has no description: skipped");
    };
    let (extension, theirs) = (reader.moving_ancestor(node), reader.moving_ancestor(other));
    if extension == theirs {
        return reader.remark(node, "its joint joins no moving body: skipped");
    }
    if joint["enableCollision"].as_bool() == Some(true) {
        reader.remark(node, "joined bodies do not collide here, unless [collision] constrained_pairs = \"collide\"");
    }
    let limits = read(reader, node, &description);
    // The first body of a constraint must move.
    let (a, b, sign) = if extension.is_some() { (node, other, -1.0) } else { (other, node, 1.0) };
    let place = |n: usize| reader.model.nodes[n].world.w_axis.truncate();
    let gap = place(a).distance(place(b));
    let turn = 2.0 * acos(rotation_of(reader.model, a).dot(rotation_of(reader.model, b)).abs().min(1.0));
    if gap > SAME_POINT {
        reader.remark(node, format_args!("its two frames are {gap:.6} m apart: they are closed at the start"));
        reader.out.joints_open = true;
    }
    if turn > 1e3 * SAME_POINT && limits.angular.locked.iter().any(|locked| *locked) {
        let degrees = turn * 180.0 / PI;
        reader.remark(node, format_args!("its two frames differ by {degrees:.3}°: this angle is kept"));
    }
    let name = slug(&reader.model.nodes[node].name, node);
    let text = constraint(reader, &name, [a, b], &limits, sign);
    reader.out.text.push_str(&text);
    drives(reader, node, &name, &description, &limits, sign);
}

fn read(reader: &mut Reader, node: usize, description: &Value) -> Limits {
    let mut limits = Limits::default();
    for limit in description["limits"].as_array().into_iter().flatten() {
        let (min, max) = (limit["min"].as_f64(), limit["max"].as_f64());
        if limit["stiffness"].as_f64().is_some() {
            reader.remark(node, "a soft limit becomes a hard one");
        }
        for (key, angular) in [("linearAxes", false), ("angularAxes", true)] {
            let on = axes(limit, key);
            if on.is_empty() || (min.is_none() && max.is_none()) {
                continue;
            }
            // A distance in a plane or in space has no sign: its least value is zero.
            let least = if on.len() > 1 { min.unwrap_or(0.0) } else { min.unwrap_or(f64::NEG_INFINITY) };
            let greatest = max.unwrap_or(f64::INFINITY);
            let axis_limits = if angular { &mut limits.angular } else { &mut limits.linear };
            if least.abs() < ZERO_LIMIT && greatest.abs() < ZERO_LIMIT {
                on.iter().for_each(|&axis| axis_limits.locked[axis] = true);
            } else if on.len() == 1 {
                axis_limits.ranges.push(AxisRange { axis: on[0], min, max });
            } else {
                let what = if angular { "a cone" } else { "a distance" };
                reader
                    .remark(node, format_args!("{what} within {least} to {greatest} is skipped; see constraint.limit"));
            }
        }
    }
    limits
}

fn constraint(reader: &mut Reader, name: &str, [a, b]: [usize; 2], limits: &Limits, sign: f64) -> String {
    let [first, second] = [a, b].map(|node| quoted(&reader.names.of(node)));
    let pivot = format!("name = \"{name}\"\nbody = {first}\nto = {{ node = {second} }}\n");
    let unit = |i: usize| toml_vector(DVec3::AXES[i]);
    let (linear, angular) = (limits.linear.locked_axes(), limits.angular.locked_axes());
    let (free_linear, free_angular) = (limits.linear.free_axes(), limits.angular.free_axes());
    let stops = |limits: &AxisLimits, axis: usize| {
        let AxisRange { min, max, .. } = limits.ranges.iter().find(|range| range.axis == axis)?;
        let (min, max) = if sign < 0.0 { (max.map(|x| -x), min.map(|x| -x)) } else { (*min, *max) };
        let bound = |key: &str, value: Option<f64>| value.map(|value| format!("{key} = {value:?}"));
        let both: Vec<String> = [bound("min", min), bound("max", max)].into_iter().flatten().collect();
        Some(format!("limit = {{ {} }}\n", both.join(", ")))
    };
    let mut used = 0;
    let mut with = |stops: Option<String>| {
        used += usize::from(stops.is_some());
        stops.unwrap_or_default()
    };
    let text = match (linear.len(), angular.len()) {
        (3, 0) => format!(
            "[[constraint.point-to-point]]\nname = \"{name}\"\na = {{ node = {first} }}\nb = {{ node = {second} }}\n\n"
        ),
        (3, 2) => {
            let axis = free_angular[0];
            let stops = with(stops(&limits.angular, axis));
            format!("[[constraint.hinge]]\n{pivot}axis = {}\n{stops}\n", unit(axis))
        }
        (3, 1) => {
            let (extension, other) = (unit(free_angular[0]), unit(free_angular[1]));
            format!("[[constraint.universal]]\n{pivot}axis = {extension}\nother_axis = {other}\n\n")
        }
        (3, 3) => format!("[[constraint.weld]]\n{pivot}\n"),
        (2, 3) => {
            let axis = free_linear[0];
            let stops = with(stops(&limits.linear, axis));
            format!("[[constraint.slider]]\n{pivot}axis = {}\n{stops}\n", unit(axis))
        }
        (2, 0) => format!("[[constraint.line]]\n{pivot}direction = {}\n\n", unit(free_linear[0])),
        _ => {
            let mut text = String::new();
            for &i in &linear {
                let _ = write!(
                    text,
                    "[[constraint.point-on-plane]]\nname = \"{name}-t{i}\"\nbody = {first}\nplane = {{ node = {second}, normal = {}, offset = 0 }}\n\n",
                    unit(i)
                );
            }
            // A locked rotation about i keeps the next axis perpendicular to the one after it. With two locked
            // rotations, the third axis stays perpendicular to both.
            let pairs: Vec<(usize, usize)> = match (angular.len(), free_angular.first()) {
                (2, Some(&axis)) => angular.iter().map(|&i| (axis, i)).collect(),
                _ => angular.iter().map(|&i| ((i + 1) % 3, (i + 2) % 3)).collect(),
            };
            for (extension, other) in pairs {
                let _ = write!(
                    text,
                    "[[constraint.orientation]]\nname = \"{name}-r{extension}{other}\"\nbody = {first}\nbody_axis = {}\nother = {{ body = {second}, axis = {} }}\n\n",
                    unit(extension),
                    unit(other)
                );
            }
            text
        }
    };
    if used < limits.linear.ranges.len() + limits.angular.ranges.len() {
        reader.remark(
            a,
            "bounds other than a hinge's rotation and a slider's displacement are skipped; see constraint.limit",
        );
    }
    if text.is_empty() {
        reader.remark(a, "its joint constrains nothing: skipped");
    }
    text
}

/// Drives: springs about a hinge's axis are converted, others are reported.
fn drives(reader: &mut Reader, node: usize, name: &str, description: &Value, limits: &Limits, sign: f64) {
    let free = limits.angular.free_axes();
    let hinge = limits.linear.locked_axes().len() == 3 && free.len() == 1;
    for drive in description["drives"].as_array().into_iter().flatten() {
        let number = |key: &str| drive[key].as_f64();
        let about = drive["axis"].as_u64().map(|axis| axis as usize);
        let spring = drive["type"] == "angular" && hinge && about == free.first().copied();
        let moved = number("velocityTarget").is_some_and(|v| v != 0.0);
        if !spring || drive["mode"] == "acceleration" || moved {
            reader.remark(node, "a drive other than a spring about a hinge is skipped; see constraint.spring");
            continue;
        }
        if number("maxForce").is_some() {
            reader.remark(node, "the largest force of its spring is skipped");
        }
        let (target, stiffness) = (sign * number("positionTarget").unwrap_or(0.0), number("stiffness").unwrap_or(0.0));
        let damping = number("damping").unwrap_or(0.0);
        let _ = write!(
            reader.out.text,
            "[[constraint.torsion-spring]]\nname = \"{name}-drive\"\nof = \"{name}\"\nrest_angle = {target:?}\nstiffness = {stiffness:?}\ndamping = {damping:?}\n\n"
        );
    }
}

/// A unique sidecar name from a node's name.
fn slug(name: &str, node: usize) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let text: String = name.chars().map(plain).take(40).collect();
    let text = text.trim_matches('-');
    if text.is_empty() { format!("joint-{node}") } else { format!("{text}-{node}") }
}
