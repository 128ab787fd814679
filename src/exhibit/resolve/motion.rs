//! Resolves kinematic bodies, and start poses that differ from the model.

use super::super::codes;
use super::super::diagnostic::Diagnostic;
use super::super::model::{Animation, Channel, Curve};
use super::super::sidecar;
use super::context::Context;
use super::joints::interpolation;
use super::nodes::rigid;
use soffio_math::Interpolation;
use soffio_math::{DQuat, DVec3, Pose};
use soffio_multibody::dynamics::{KeyframeMotion, KinematicBody};

/// Sampling rate of the model's animation curves, 1/s.
const SAMPLES_PER_SECOND: f64 = 60.0;
/// Most poses of one motion.
const MAX_KEYS: usize = 100_000;
/// Duration of a step of a stepped channel beside smooth ones, s.
const STEP_TIME: f64 = 1e-3;

impl Context<'_> {
    /// Start pose of a body: that of the model or of the sidecar.
    pub(super) fn start(&mut self, body: &sidecar::Body, model: Pose, at: &str) -> Pose {
        let position = body.initial.position.map_or(model.position, |p| DVec3::from(p.map(|x| x.0)));
        let rotation = match body.initial.rotation.map(DQuat::from_array) {
            None => model.rotation,
            Some(q) if q.length() > 0.0 => q.normalize(),
            Some(_) => {
                let problem = Diagnostic::new(codes::NO_AXIS, "the quaternion has no length");
                self.report(&format!("{at}/rotation"), problem.help("leave it out, or write [0, 0, 0, 1]"));
                model.rotation
            }
        };
        Pose { rotation, position }
    }

    /// Makes the body that is being declared follow its path or its node's animation; returns its pose at 0 s.
    pub(super) fn drive(&mut self, body: &sidecar::Body, node: usize, at: &str) -> Pose {
        let rest = self.poses[self.body_nodes.len() - 1];
        let of = format!("body {}", body.node);
        if let Some(path) = &body.path {
            if body.animation.is_some() {
                let message = format!("body \"{}\" has a path and an animation", body.node);
                let problem = Diagnostic::new(codes::WRONG_SHAPE, message);
                self.report(&format!("{at}/animation"), problem.help("it can follow one of them"));
            }
            self.record_origin(
                &of,
                "motion",
                format!("a path of {} points", path.points.len()),
                &format!("{at}/path"),
                "",
            );
            return self.drive_along(path, rest, &format!("{at}/path"));
        }
        let model = self.model;
        let wanted = body.animation.as_ref().and_then(|a| a.name.as_deref());
        let found = model
            .animations
            .iter()
            .position(|a| wanted.is_none_or(|name| a.name == name) && !a.channels_of(model, node).is_empty());
        let Some(found) = found else {
            let message = match wanted {
                Some(name) => format!("no animation \"{name}\" of the model moves \"{}\"", body.node),
                None => format!("kinematic body \"{}\" has neither a path nor an animation", body.node),
            };
            let names: Vec<&str> = model.animations.iter().map(|a| a.name.as_str()).collect();
            let help = if names.is_empty() {
                "the model has no animations; add path = { points = [[t, x, y, z], …] }".to_owned()
            } else {
                format!("animations of the model: {}", names.join(", "))
            };
            self.report(at, Diagnostic::new(codes::NO_MOTION, message).help(help));
            return rest;
        };
        let animation = &model.animations[found];
        let (keys, interpolation) = self.sampled(animation, node, at);
        let shown = format!("animation {}, {} poses, {interpolation:?}", animation.name, keys.len());
        self.record_origin(&of, "motion", shown, &format!("{at}/motion"), "");
        let repeat = body.animation.as_ref().is_none_or(|a| a.repeat);
        self.followed.push((self.body_nodes.len() - 1, found, repeat));
        self.push_drive(KeyframeMotion { keys, interpolation, repeat })
    }

    /// World poses of a node that an animation moves.
    fn sampled(&mut self, animation: &Animation, node: usize, at: &str) -> (Vec<(f64, Pose)>, Interpolation) {
        let channels = animation.channels_of(self.model, node);
        let has = |curve: Curve| channels.iter().any(|channel| channel.curve == curve);
        let interpolation = match (has(Curve::Step), has(Curve::Linear), has(Curve::Cubic)) {
            (_, _, true) => Interpolation::Spline,
            (true, false, false) => Interpolation::Step,
            _ => Interpolation::Linear,
        };
        let times = times(&channels, interpolation);
        let mut keys = Vec::new();
        for t in times.into_iter().take(MAX_KEYS) {
            let Some(pose) = rigid(&animation.world(self.model, node, t)) else {
                let message = format!("animation \"{}\" shears the node of a body", animation.name);
                let problem = Diagnostic::new(codes::SCALED_BODY, message);
                self.report(at, problem.help("apply the scale of its parents in the modelling program"));
                break;
            };
            keys.push((t, pose));
        }
        (keys, interpolation)
    }

    /// Makes the body that is being declared follow a path with constant rotation; returns its pose at 0 s.
    pub(super) fn drive_along(&mut self, path: &sidecar::Path, rest: Pose, at: &str) -> Pose {
        self.rising(path.points.iter().map(|point| point[0]), &format!("{at}/points"));
        let key = |&[t, x, y, z]: &[f64; 4]| (t, Pose { position: DVec3::new(x, y, z), ..rest });
        let keys: Vec<(f64, Pose)> = path.points.iter().map(key).collect();
        let ends = keys.first().zip(keys.last());
        if path.repeat && ends.is_some_and(|(a, b)| a.1.position != b.1.position) {
            let problem = Diagnostic::new(codes::KEYS, "the path repeats and does not end where it begins");
            self.report(&format!("{at}/points"), problem.help("repeat the first point at the end"));
        }
        let interpolation = path.interpolation.map_or(Interpolation::Spline, interpolation);
        self.push_drive(KeyframeMotion { keys, interpolation, repeat: path.repeat })
    }

    fn push_drive(&mut self, motion: KeyframeMotion) -> Pose {
        let start = motion.at(0.0).pose;
        self.drives.push(KinematicBody { body: self.body_nodes.len() - 1, motion });
        start
    }
}

/// Times at which an animation is sampled.
fn times(channels: &[&Channel], interpolation: Interpolation) -> Vec<f64> {
    let keys = channels.iter().flat_map(|channel| channel.times.iter().copied());
    let mut times: Vec<f64> = keys.collect();
    let last = times.iter().copied().fold(0.0, f64::max);
    match interpolation {
        Interpolation::Spline => {
            let first = times.iter().copied().fold(last, f64::min);
            let count = ((last - first) * SAMPLES_PER_SECOND).ceil().clamp(1.0, MAX_KEYS as f64 - 1.0);
            return (0..=count as usize).map(|i| first + (last - first) * i as f64 / count).collect();
        }
        Interpolation::Linear => {
            let stepped = channels.iter().filter(|channel| channel.curve == Curve::Step);
            let before: Vec<f64> = stepped.flat_map(|channel| &channel.times).map(|t| t - STEP_TIME).collect();
            times.extend(before.into_iter().filter(|t| *t > 0.0));
        }
        Interpolation::Step | Interpolation::Smooth => {}
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}
