//! Bodies, their parts, and the wires and cords between their points.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::quantity::*;
use super::{Attachment, Name, Path, Point};

/// A node that moves as one rigid body with all nodes below it that are not bodies themselves.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// glTF node: a name, a path "Frame/Arm", or "#12".
    pub node: String,
    /// Material: gives density, friction, restitution and sound.
    pub material: Option<String>,
    /// Mass; overrides the density.
    pub mass: Option<Mass>,
    /// Centre of mass in node space.
    pub center_of_mass: Option<[Length; 3]>,
    /// Moments of inertia about the centre of mass.
    pub inertia: Option<PrincipalInertia>,
    /// Thickness of the sheet, where the mesh is an open surface.
    pub thickness: Option<Length>,
    /// Linear damping rate, in addition to the air drag of the wind surfaces.
    pub linear_damping: Option<Rate>,
    /// Angular damping rate.
    pub angular_damping: Option<Rate>,
    /// Motion at the start.
    #[serde(default)]
    pub initial: Initial,
    /// Does it move?
    #[serde(default)]
    pub motion: Motion,
    /// How its motion is computed; by default as the exhibit's. Bodies that are joined move by one kind, and bodies of
    /// different kinds do not collide.
    pub moved_by: Option<OwnMotion>,
    /// Of a kinematic body: path of the node's origin in the world.
    pub path: Option<Path>,
    /// Of a kinematic body: how it follows the model's animation of its node.
    pub animation: Option<Animation>,
    /// Finish of its meshes, which is how they look: grain, brushing, dust. oak, beech, walnut, pine; brass-brushed, brass-cast,
    /// brass-polished, steel-brushed, steel-polished, iron-cast, copper, aluminium-brushed, lead; paint, paint-matt; paper, felt,
    /// leather, cord, stone, bamboo. By default that of its material, or else of the model. Meshes with textures keep them.
    pub finish: Option<String>,
    /// Colour of its paint, stain or metal: linear [r, g, b], or sRGB "#rrggbb"; by default that of the finish or the model.
    pub color: Option<Color>,
    /// Nodes below it of another material.
    #[serde(default)]
    pub part: Vec<Part>,
}

/// Principal moments of inertia.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PrincipalInertia {
    /// Moments about the principal axes.
    pub diagonal: [Inertia; 3],
    /// Rotation from principal axes to node axes, quaternion [x, y, z, w].
    pub orientation: Option<[f64; 4]>,
}

/// Pose and velocity at the start.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Initial {
    /// World position of the node at the start; by default that of the model. Needs `[solver] assemble = true` where it
    /// opens a constraint.
    pub position: Option<[Length; 3]>,
    /// World rotation of the node at the start, quaternion [x, y, z, w]; by default as in the model.
    pub rotation: Option<[f64; 4]>,
    /// Velocity of the centre of mass, world axes.
    pub velocity: Option<[Speed; 3]>,
    /// Angular velocity, world axes.
    pub angular_velocity: Option<[Rotation; 3]>,
}

/// How a body moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Motion {
    /// By forces.
    #[default]
    Dynamic,
    /// By the animation of its node or by its path, whatever forces act on it.
    Kinematic,
    /// Not at all.
    Static,
}

/// How the motion of a body is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OwnMotion {
    /// Constrained dynamics.
    Dynamics,
    /// Positions first, joint by joint: the classical procedural motion. Not for gears and breakable constraints.
    Procedural,
    /// Positions first, all joints at once. Not for gears and breakable constraints.
    PositionBased,
}

/// How a kinematic body follows the model's animation. Morph weights and scales of the same animation play with it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Animation {
    /// Name of the animation; by default the first that moves the node.
    pub name: Option<String>,
    /// Starts again after its last key.
    #[serde(rename = "loop")]
    pub repeat: bool,
}

impl Default for Animation {
    fn default() -> Self {
        Self { name: None, repeat: true }
    }
}

/// A node below a body, with the nodes below it, of another material.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// glTF node below the body.
    pub node: String,
    /// Its material.
    pub material: String,
    /// Thickness of the sheet, where the mesh is an open surface.
    pub thickness: Option<Length>,
    /// Its finish; by default that of its material, or else of the body.
    pub finish: Option<String>,
    /// Its colour: linear [r, g, b], or sRGB "#rrggbb"; by default that of the body.
    pub color: Option<Color>,
}

/// A wire or cord: drawn as a round rod, has mass, feels the wind.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wire {
    /// Unique name.
    pub name: Name,
    /// Node of the body that carries it; without it the wire is fixed.
    pub body: Option<String>,
    /// The line.
    pub points: Points,
    /// Rounds the line through its points (Catmull–Rom).
    #[serde(default)]
    pub smooth: bool,
    /// Radius; or give the diameter.
    pub radius: Option<Length>,
    /// Diameter; or give the radius.
    pub diameter: Option<Length>,
    /// Physical material.
    pub material: String,
    /// Colour: linear [r, g, b], or sRGB "#rrggbb".
    pub color: Option<Color>,
    /// Metalness: 0 dielectric … 1 metal.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub metallic: Option<f32>,
    /// Perceptual roughness 0 … 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub roughness: Option<f32>,
    /// Does it collide?
    #[serde(default)]
    pub collide: bool,
    /// Does the wind act on it?
    #[serde(default = "yes")]
    pub wind: bool,
}

fn yes() -> bool {
    true
}

/// A cord that is only drawn: straight from point to point, each on a body of its own or fixed, so that its length follows
/// them. Joints, limits and couplings do its work.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cord {
    /// Unique name.
    pub name: Name,
    /// Its points in order: where it leaves a drum, passes a pulley, holds a weight.
    #[schemars(length(min = 2))]
    pub points: Vec<Attachment>,
    /// Radius; by default 0.6 mm.
    pub radius: Option<Length>,
    /// Colour: linear [r, g, b], or sRGB "#rrggbb"; by default that of hemp.
    pub color: Option<Color>,
    /// Perceptual roughness 0 … 1; by default 0.8.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub roughness: Option<f32>,
}

/// The points of a wire.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Points {
    /// "Rod.*": all nodes below the body's whose names begin with "Rod.", in natural order (Rod.9 before Rod.10). For a
    /// fixed wire, all such nodes that belong to no body.
    Named(String),
    /// A list of nodes or of [x, y, z] in the body's node space.
    Listed(#[schemars(length(min = 2, max = 4096))] Vec<Point>),
}

/// A colour.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Color {
    /// Linear RGB, 0 … 1.
    Linear([f32; 3]),
    /// sRGB, "#rrggbb".
    Hex(#[schemars(regex(pattern = "^#[0-9a-fA-F]{6}$"))] String),
}
