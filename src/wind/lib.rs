//! Breath and wind: from microphone samples to forces on plates.

use soffio_geometry::TriangleMesh;

pub mod breath;
mod drag;
mod feeler;
pub mod force;
pub mod front;
pub mod patches;
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
