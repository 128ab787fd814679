//! Breath and wind: from microphone samples to forces on plates.
//!
//! A breath is a round turbulent jet from the lips; draughts, fans and turbulence are ambient winds. Surfaces are split
//! into patches (panels). Each patch that is visible from the origin of a wind takes quadratic drag from the relative wind.
//! The result is one force and torque per body.
//!
//! This crate does not detect breath (see `soffio-detector`), moves no body, and reads no clock, file or device: time is an
//! argument. The same input gives the same bits.
//!
//! | module or type | contents |
//! |---|---|
//! | [`breath`] | [`breath::Breath`]: lips, direction, speed, and spreading law |
//! | [`jet_front`] | travelling front of a starting jet |
//! | [`ambient`] | ambient winds: fans, draughts, turbulence |
//! | [`Surface`], [`Shelter`] | surfaces that take wind forces, and meshes that shelter them |
//! | [`patches`] | patches of a surface |
//! | [`force`] | [`force::WindField`]: forces of all winds on bodies |
//! | [`air_noise`] | how loud the air over a surface is |
//!
//! ```
//! use soffio_math::DVec3;
//! use soffio_wind::breath::{Breath, SpreadLaw};
//!
//! let mouth = Breath { mouth: DVec3::ZERO, direction: DVec3::X, lip_diameter: 0.01, speed: 10.0, law: SpreadLaw::Jet };
//! let at = |distance: f64| mouth.velocity(distance * DVec3::X).length();
//! // At the lips the jet has its full speed; far away its speed falls as 1/x.
//! assert!((at(0.01) - 10.0).abs() < 1e-9);
//! assert!(at(0.3) > at(0.6) && at(0.6) > 0.0);
//! assert_eq!(at(-0.1), 0.0, "there is no breath behind the lips");
//! ```
//!
//! `cargo run -p soffio-wind --example breath_on_a_plate` prints the force of a breath on a plate over the distance.

use std::ops::RangeInclusive;

use soffio_geometry::TriangleMesh;

pub mod air_noise;
pub mod ambient;
pub mod breath;
mod drag;
pub mod force;
pub mod jet_front;
mod patch_air;
pub mod patches;
mod visibility;
mod wind_surface;

/// A surface that takes wind forces.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Index of the body that carries it.
    pub body: usize,
    /// Name of the glTF node, for messages.
    pub node: String,
    /// Its geometry.
    pub shape: SurfaceShape,
    /// Drag coefficient for flow along the normal (plate 1.17, cylinder 1.2).
    pub drag_normal: f64,
    /// Skin-friction coefficient for flow along the face.
    pub drag_tangential: f64,
    /// Multiplies the force.
    pub gain: f64,
}

/// Geometry of a wind surface, in the node frame of its body.
#[derive(Clone, Debug)]
pub enum SurfaceShape {
    /// Sheet metal or a solid: patches are sampled on its triangles.
    Mesh {
        /// Node frame of the body, m.
        mesh: TriangleMesh,
        /// Sample points per square metre.
        per_area: f64,
        /// Allowed number of sample points.
        count: RangeInclusive<usize>,
        /// Whether the mesh is one face of a thin sheet, so that wind acts on both its sides.
        sheet: bool,
        /// Seed of the sampling.
        seed: u64,
    },
    /// A round wire: drag of a cylinder along a polyline.
    Wire {
        /// Node frame of the body, m.
        points: Vec<soffio_math::DVec3>,
        /// m.
        radius: f64,
    },
}

/// A mesh that blocks directed wind and breath.
#[derive(Clone, Debug)]
pub struct Shelter {
    /// Index of the body that carries it; `None` for a fixed mesh.
    pub body: Option<usize>,
    /// Node frame of the body, or the world's, m.
    pub mesh: TriangleMesh,
}

impl Shelter {
    /// The meshes of the surfaces as shelters. Wires are too thin to give any.
    pub fn of(surfaces: &[Surface]) -> Vec<Self> {
        let shelter = |surface: &Surface| match &surface.shape {
            SurfaceShape::Mesh { mesh, .. } => Some(Self { body: Some(surface.body), mesh: mesh.clone() }),
            SurfaceShape::Wire { .. } => None,
        };
        surfaces.iter().filter_map(shelter).collect()
    }
}
