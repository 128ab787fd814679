//! Breath and wind: from microphone samples to forces on plates.
//!
//! A breath is a round turbulent jet from the lips; draughts, fans and the room's own air are ambient winds. Surfaces are
//! sampled by patches, and each patch that the lips see takes drag from the air that passes it. The result is one force and
//! torque per body.
//!
//! It never detects a breath (that is `soffio-detector`), moves no body, and reads no clock, file or device: the time is an
//! argument. The same input gives the same bits.
//!
//! | module or type | holds |
//! |---|---|
//! | [`breath`] | [`breath::Breath`]: lips, direction, speed, and the law by which the jet spreads |
//! | [`front`] | the travelling front of the jet: air that has left the lips and not yet arrived |
//! | [`weather`] | ambient winds: fans, draughts, turbulence |
//! | [`Surface`], [`Shelter`] | what the wind meets, and what shelters from it |
//! | [`patches`] | sample points of a surface |
//! | [`force`] | [`force::WindField`]: from air to forces on bodies |
//!
//! ```
//! use soffio_math::DVec3;
//! use soffio_wind::breath::{Breath, Law};
//!
//! let mouth = Breath { mouth: DVec3::ZERO, direction: DVec3::X, lip_diameter: 0.01, speed: 10.0, law: Law::Jet };
//! let at = |distance: f64| mouth.velocity(distance * DVec3::X).length();
//! // At the lips the jet has its full speed; far away its speed falls as 1/x.
//! assert!((at(0.01) - 10.0).abs() < 1e-9);
//! assert!(at(0.3) > at(0.6) && at(0.6) > 0.0);
//! assert_eq!(at(-0.1), 0.0, "there is no breath behind the lips");
//! ```
//!
//! `cargo run -p soffio-wind --example breath_on_a_plate` prints the force of a breath on a plate over the distance.

use soffio_geometry::TriangleMesh;

mod airs;
pub mod breath;
mod drag;
mod feeler;
pub mod force;
pub mod front;
pub mod patches;
mod sight;
pub mod weather;

/// A surface that feels the wind.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Index of the body that carries it.
    pub body: usize,
    /// Name of the glTF node, for messages.
    pub node: String,
    /// What the wind meets.
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
        /// Fewest and most sample points.
        count: (usize, usize),
        /// Thin sheet: feel the front faces only once, not front and back twice.
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

/// A mesh in the wind's way: what lies behind it feels none.
#[derive(Clone, Debug)]
pub struct Shelter {
    /// Index of the body that carries it; `None` stands still.
    pub body: Option<usize>,
    /// Node frame of the body, or the world's, m.
    pub mesh: TriangleMesh,
}

impl Shelter {
    /// The shelters that the surfaces themselves are. Wires are too thin to give any.
    pub fn of(surfaces: &[Surface]) -> Vec<Self> {
        let shelter = |surface: &Surface| match &surface.shape {
            SurfaceShape::Mesh { mesh, .. } => Some(Self { body: Some(surface.body), mesh: mesh.clone() }),
            SurfaceShape::Wire { .. } => None,
        };
        surfaces.iter().filter_map(shelter).collect()
    }
}
