//! Common parts of Eli Terry's clock: layers, position of the dial, wheels, and placement of parts.

use soffio_math::{DQuat, DVec2, DVec3, PI, atan2, cos, sin};

use soffio_authoring::outline::{Polygon, ellipse};
use soffio_authoring::piece::{Part, Piece};
use soffio_authoring::solid::Solid;
use soffio_authoring::stock_parts::{MM, part, rod, spur_gear, y_to_z};

/// Module: pitch diameter over number of teeth, m.
pub const MODULE: f64 = 1.0 * MM;
/// Radius of the drum to the middle of the cord, m.
pub const DRUM: f64 = 20.0 * MM;

/// Layer of the great wheels: centre along z, m.
pub const BACK: f64 = -36.0 * MM;
/// Layer of the minute arbor's wheel, m.
pub(crate) const MIDDLE: f64 = -26.0 * MM;
/// Layer of the third wheel, m.
pub(crate) const FRONT: f64 = -16.0 * MM;
/// Layer of the motion work, m.
pub(crate) const MOTION: f64 = 4.0 * MM;
/// Layer of the escapement, m.
pub(crate) const ESCAPING: f64 = 8.0 * MM;
/// Layer of the pendulum, m: in front of the dial and the hands.
pub const SWING: f64 = 30.0 * MM;
/// Thickness of a wheel, m.
pub(crate) const WHEEL: f64 = 4.0 * MM;

/// Centre of the dial, m.
pub const CENTER: DVec3 = DVec3::new(0.0, 0.36, 0.0);

/// Direction from one point to another, rad.
pub fn toward(from: DVec3, to: DVec3) -> f64 {
    atan2(to.y - from.y, to.x - from.x)
}

/// A wooden wheel with spokes.
pub fn wheel(teeth: usize, phase: f64) -> Solid {
    let radius = 0.5 * MODULE * teeth as f64;
    let holes: Vec<Polygon> = (0..if teeth > 30 { 5 } else { 0 })
        .map(|k| {
            let angle = phase + 0.4 * PI * f64::from(k);
            ellipse(0.58 * radius * DVec2::new(cos(angle), sin(angle)), DVec2::splat(0.22 * radius), 0.0, 24)
        })
        .collect();
    spur_gear(teeth, MODULE, WHEEL, phase, &holes)
}

/// A round bar along z, from `low` to `high`.
pub(crate) fn along_z(name: &'static str, radius: f64, (low, high): (f64, f64), density: f64, finish: usize) -> Part {
    part(name, rod(radius, low, high), DVec3::ZERO, y_to_z(), density, finish)
}

/// Teeth of a wheel and of the pinion that it drives or that drives it.
#[derive(Clone, Copy)]
pub struct ToothCounts {
    /// Teeth of the wheel.
    pub wheel: usize,
    /// Teeth of the pinion.
    pub pinion: usize,
}

impl ToothCounts {
    /// Distance of the two arbors, m: half the module times all teeth.
    pub(crate) fn center_distance(self, module: f64) -> f64 {
        0.5 * module * (self.wheel + self.pinion) as f64
    }
}

/// A piece whose first part is its own node's mesh.
pub fn piece(name: &'static str, parts: Vec<Part>) -> Piece {
    Piece { name, parts, wires: Vec::new(), markers: Vec::new() }
}

/// A flat part at the height `z` of the piece.
pub(crate) fn flat(name: &'static str, solid: Solid, z: f64, density: f64, finish: usize) -> Part {
    part(name, solid, DVec3::Z * z, DQuat::IDENTITY, density, finish)
}
