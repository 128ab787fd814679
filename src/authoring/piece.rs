//! A rigid piece of a mobile: what it is cut, turned and bent from, what it weighs, and how it is written down.
//!
//! Invariant: the mass a piece balances with comes from the very meshes and wires that are written to the file.

use soffio_geometry::bodies::MassProperties;
use soffio_math::{DMat3, DQuat, DVec3, Pose, rotation};

use super::glb::Scene;
use super::solid::{Solid, wire_mass};

/// A mesh that a piece carries.
#[derive(Clone, Debug)]
pub struct Part {
    /// Name of its node; the piece's own name puts the mesh on the piece's node.
    pub name: &'static str,
    /// In the frame of the part.
    pub solid: Solid,
    /// Place of the part's frame in the piece, m and rad.
    pub place: Pose,
    /// kg/m³.
    pub density: f64,
    /// Index of the finish in the scene.
    pub finish: usize,
}

/// A bent wire that a piece carries. The sidecar names its marks and says how it looks.
#[derive(Clone, Debug)]
pub struct BentWire {
    /// Its points are marked `<name>.00`, `<name>.01`, …
    pub name: &'static str,
    /// In the frame of the piece, m.
    pub points: Vec<DVec3>,
    /// m.
    pub radius: f64,
    /// kg/m³.
    pub density: f64,
}

/// A rigid piece in its own frame; its origin is the point it hangs or turns on.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Name of its node.
    pub name: &'static str,
    /// Meshes.
    pub parts: Vec<Part>,
    /// Wires.
    pub wires: Vec<BentWire>,
    /// Named points, m.
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

    /// The point marked `name`, in the frame of the piece.
    ///
    /// # Panics
    /// If the drawing has no such mark: a slip in the drawing, not in its input.
    pub fn marker(&self, name: &str) -> DVec3 {
        let found = self.markers.iter().find(|(marker, _)| *marker == name);
        found.unwrap_or_else(|| panic!("{} has no mark {name}", self.name)).1
    }

    /// Writes the piece with its frame at `pose`.
    pub fn write(&self, scene: &mut Scene, pose: Pose) {
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
    }
}

/// Nothing: the neutral element of [`MassProperties::combine`].
pub const NO_MASS: MassProperties = MassProperties { mass: 0.0, center: DVec3::ZERO, inertia: DMat3::ZERO };

/// A load of `mass` kg at a joint: what a hanging piece is to the one that carries it, at rest and in slow motion.
pub fn load(mass: f64, at: DVec3) -> MassProperties {
    MassProperties { mass, center: at, inertia: DMat3::ZERO }
}

/// Turn about the vertical, rad.
pub fn yaw(angle: f64) -> DQuat {
    rotation(angle * DVec3::Y)
}

/// A name made from parts. It lasts as long as the program: a model has some hundreds of them, and a program makes few.
pub fn named(text: String) -> &'static str {
    text.leak()
}
