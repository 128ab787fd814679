//! Resolves drawn cords: points of several bodies.

use super::super::diagnostic::Diagnostic;
use super::super::sidecar;
use super::super::{Cord, Wire, codes};
use super::context::Context;
use super::wires::linear;
use soffio_multibody::articulation::Anchor;

/// Radius of a cord where none is given, m: a clock's line.
const RADIUS: f64 = 0.6e-3;
/// Colour of hemp, linear RGB.
const HEMP: [f32; 3] = [0.42, 0.33, 0.20];
/// Roughness of twisted fibre.
const ROUGHNESS: f32 = 0.8;

impl Context<'_> {
    /// All cords that could be resolved. Their names differ from those of the wires.
    pub(super) fn cords(&mut self, wires: &[Wire]) -> Vec<Cord> {
        let sidecar = self.sidecar;
        let mut cords: Vec<Cord> = Vec::new();
        for (i, given) in sidecar.cord.iter().enumerate() {
            let at = format!("/cord/{i}");
            let mut taken = wires.iter().map(|wire| &wire.name).chain(cords.iter().map(|cord| &cord.name));
            let taken = taken.any(|name| *name == given.name);
            self.unique(&given.name, taken, &format!("{at}/name"));
            cords.extend(self.cord(given, &at));
        }
        cords
    }

    fn cord(&mut self, given: &sidecar::Cord, at: &str) -> Option<Cord> {
        let used_for = format!("cord \"{}\"", given.name);
        let mut resolved = Vec::new();
        for (i, point) in given.points.iter().enumerate() {
            let place = format!("{at}/points/{i}");
            let node = self.node(&point.node, &format!("{place}/node"), &used_for);
            resolved.push(node.and_then(|node| self.point(node, point.at.as_ref(), &format!("{place}/at"), &used_for)));
        }
        let points = resolved.into_iter().collect::<Option<Vec<Anchor>>>()?;
        if points.iter().all(|point| point.body == points[0].body) {
            let message = format!("{used_for} moves as one with its body, so that its length never changes");
            let help = "write it as a [[wire]], which has mass and feels the wind, or name points of two bodies";
            self.report(&format!("{at}/points"), Diagnostic::new(codes::WRONG_SHAPE, message).help(help));
            return None;
        }
        let radius = given.radius.map_or(RADIUS, |radius| self.positive(radius.0, &format!("{at}/radius")));
        let carriers: Vec<&str> = points.iter().map(|point| self.body_name(point.body)).collect();
        self.record_origin(&used_for, "points", carriers.join(", "), &format!("{at}/points"), "");
        Some(Cord {
            name: given.name.clone(),
            points,
            radius,
            color: given.color.as_ref().map_or(HEMP, linear),
            roughness: given.roughness.unwrap_or(ROUGHNESS),
        })
    }
}
