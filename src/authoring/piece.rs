//! Rigid pieces of a mobile: meshes, wires and markers, with their mass.
//!
//! Invariant: the mass of a piece comes from the same meshes and wires that are written to the file.

use soffio_geometry::bodies::MassProperties;
use soffio_math::{DMat3, DQuat, DVec3, Pose, rotation};

use super::glb::Scene;
use super::solid::{Solid, wire_mass};

/// A mesh of a piece.
#[derive(Clone, Debug)]
pub struct Part {
    /// Name of its node; a part with the piece's own name is the mesh of the piece's node.
    pub name: &'static str,
    /// Mesh, in the frame of the part.
    pub solid: Solid,
    /// Pose of the part's frame in the piece.
    pub place: Pose,
    /// Density, kg/m³.
    pub density: f64,
    /// Index of the finish in the scene.
    pub finish: usize,
}

/// A bent wire of a piece. The sidecar names its markers and sets its colour.
#[derive(Clone, Debug)]
pub struct BentWire {
    /// Its points get the markers `<name>.00`, `<name>.01`, …
    pub name: &'static str,
    /// Points in the frame of the piece, m.
    pub points: Vec<DVec3>,
    /// Radius, m.
    pub radius: f64,
    /// Density, kg/m³.
    pub density: f64,
}

/// A rigid piece in its own frame; its origin is its hook or pivot.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Name of its node.
    pub name: &'static str,
    /// Meshes.
    pub parts: Vec<Part>,
    /// Wires.
    pub wires: Vec<BentWire>,
    /// Named points in the frame of the piece, m.
    pub markers: Vec<(&'static str, DVec3)>,
}

impl Piece {
    /// Mass, centre and inertia in the frame of the piece.
    pub fn mass(&self) -> MassProperties {
        let parts = self.parts.iter().map(|part| {
            let own = part.solid.mass(part.density);
            let turn = DMat3::from_quat(part.place.rotation);
            MassProperties {
                mass: own.mass,
                center: part.place.point(own.center),
                inertia: turn * own.inertia * turn.transpose(),
            }
        });
        let wires = self.wires.iter().map(|bend| wire_mass(&bend.points, bend.radius, bend.density));
        parts.chain(wires).reduce(|whole, part| whole.combine(&part)).unwrap_or(NO_MASS)
    }

    /// The point of the marker `name`, in the frame of the piece.
    ///
    /// # Panics
    /// If there is no such marker, which is a mistake in the drawing.
    pub fn marker(&self, name: &str) -> DVec3 {
        let found = self.markers.iter().find(|(marker, _)| *marker == name);
        found.unwrap_or_else(|| panic!("{} has no marker {name}", self.name)).1
    }

    /// Adds the piece to the scene with its frame at `pose`; returns the index of its node.
    pub fn write(&self, scene: &mut Scene, pose: Pose) -> usize {
        let node = scene.node(self.name, None, pose.position, pose.rotation);
        for part in &self.parts {
            let own = if part.name == self.name {
                node
            } else {
                scene.node(part.name, Some(node), part.place.position, part.place.rotation)
            };
            scene.mesh(own, &part.solid, part.finish);
        }
        for (name, point) in &self.markers {
            scene.marker(name, Some(node), *point);
        }
        for bend in &self.wires {
            for (i, point) in bend.points.iter().enumerate() {
                scene.marker(&format!("{}.{i:02}", bend.name), Some(node), *point);
            }
        }
        node
    }
}

/// No mass: the neutral element of [`MassProperties::combine`].
pub const NO_MASS: MassProperties = MassProperties { mass: 0.0, center: DVec3::ZERO, inertia: DMat3::ZERO };

/// A point load of `mass` kg at a joint: how a hanging piece acts on the piece above it, in equilibrium and in slow
/// motion.
pub fn load(mass: f64, at: DVec3) -> MassProperties {
    MassProperties { mass, center: at, inertia: DMat3::ZERO }
}

/// Rotation about the vertical by `angle`, rad.
pub fn yaw(angle: f64) -> DQuat {
    rotation(angle * DVec3::Y)
}

/// A name built at run time; it is leaked, since a program builds only some hundreds of them.
pub fn named(text: String) -> &'static str {
    text.leak()
}
