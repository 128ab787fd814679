//! The format "exhibit/1" as Rust types: what a curator can write in `exhibit.toml`. The JSON Schema is made from
//! these types (`soffio schema exhibit`), so the doc comments here are the help that an editor shows.
//!
//! Points are a child node's name or `[x, y, z]` in node space; glTF axes: metres, right-handed, +Y up. All objects
//! are closed; keys that begin with `x_` are ignored.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::quantity::*;

/// A name: lower-case letters, digits and hyphens.
type Name = String;

/// An exhibit: what a glTF model is made of, how it hangs together, sounds, and what is said about it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sidecar {
    /// Format version: "exhibit/1".
    pub schema: String,
    /// The glTF or GLB file, a path inside the exhibit folder.
    pub model: String,
    /// Id of the exhibit; by default the folder's name.
    pub id: Option<Name>,
    /// The world around the sculpture.
    #[serde(default)]
    pub scene: Scene,
    /// Physical materials by name. A built-in name (steel, aluminium, lead, brass, copper, glass, beech, cherry, oak …)
    /// changes only the keys that stand here.
    #[serde(default)]
    pub material: BTreeMap<String, Material>,
    /// What a pair of materials does that the combine rule does not say.
    #[serde(default)]
    pub material_pair: Vec<MaterialPair>,
    /// Nodes that move as one, with what hangs below them.
    #[serde(default)]
    pub body: Vec<Body>,
    /// Wires and cords.
    #[serde(default)]
    pub wire: Vec<Wire>,
    /// Joints, one array per kind.
    #[serde(default)]
    pub constraint: Constraints,
    /// Collision shapes.
    #[serde(default)]
    pub collider: Vec<Collider>,
    /// What collides with what.
    #[serde(default)]
    pub collision: Collision,
    /// What feels the wind.
    #[serde(default)]
    pub wind_surface: Vec<WindSurface>,
    /// Which motion of which body plays which sound.
    #[serde(default)]
    pub sound: Vec<Sound>,
    /// What happens when nobody is there.
    #[serde(default)]
    pub attract: Attract,
    /// Words by language.
    #[serde(default)]
    pub label: Label,
    /// Who made it, and whose rights it carries.
    #[serde(default)]
    pub credit: Credit,
}

/// The world around the sculpture.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Acceleration of gravity; by default [0, -9.81, 0] m/s².
    pub gravity: Option<[Acceleration; 3]>,
    /// A glTF camera node; without it the bounds are framed.
    pub camera: Option<String>,
}

/// A physical material.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Mass per volume.
    pub density: Option<Density>,
    /// Coulomb coefficient while sticking.
    #[schemars(range(min = 0.0))]
    pub static_friction: Option<f64>,
    /// Coulomb coefficient while sliding.
    #[schemars(range(min = 0.0))]
    pub dynamic_friction: Option<f64>,
    /// Coefficient of restitution, 0 … 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: Option<f64>,
    /// Young's modulus.
    pub youngs_modulus: Option<Pressure>,
    /// Poisson's ratio, 0 … 0.5.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub poisson: Option<f64>,
    /// Loss factor η of the hung part: T60 = 2.2/(η f).
    #[schemars(range(min = 0.0, max = 1.0))]
    pub loss_factor: Option<f64>,
}

/// Override of the combine rule (geometric mean) for one pair of materials.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaterialPair {
    /// The two materials.
    pub pair: [String; 2],
    /// Coefficient of restitution, 0 … 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: Option<f64>,
    /// Coulomb coefficient while sliding.
    #[schemars(range(min = 0.0))]
    pub dynamic_friction: Option<f64>,
    /// Coulomb coefficient while sticking.
    #[schemars(range(min = 0.0))]
    pub static_friction: Option<f64>,
}

/// A node that moves as one rigid body with all nodes below it that are not bodies themselves.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// glTF node: a name, a path "Frame/Arm", or "#12".
    pub node: String,
    /// Material: density for the mass, friction, restitution, sound.
    pub material: Option<String>,
    /// Mass; wins over density.
    pub mass: Option<Mass>,
    /// Centre of mass in node space.
    pub center_of_mass: Option<[Length; 3]>,
    /// Moments of inertia about the centre of mass.
    pub inertia: Option<PrincipalInertia>,
    /// Thickness of the sheet, where the mesh is an open surface.
    pub thickness: Option<Length>,
    /// Rate at which linear motion fades besides the air on the wind surfaces.
    pub linear_damping: Option<Rate>,
    /// Rate at which rotation fades.
    pub angular_damping: Option<Rate>,
    /// Motion at the start.
    #[serde(default)]
    pub initial: Initial,
    /// Does it move?
    #[serde(default)]
    pub motion: Motion,
    /// Nodes below it that are made of something else.
    #[serde(default)]
    pub part: Vec<Part>,
}

/// Principal moments of inertia.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PrincipalInertia {
    /// Moments about the principal axes.
    pub diagonal: [Inertia; 3],
    /// Principal axes to node axes, quaternion [x, y, z, w].
    pub orientation: Option<[f64; 4]>,
}

/// Motion at the start.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Initial {
    /// Velocity of the centre of mass, world axes.
    pub velocity: Option<[Speed; 3]>,
    /// Angular velocity, world axes.
    pub angular_velocity: Option<[Rotation; 3]>,
}

/// Does a body move?
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Motion {
    /// Moved by forces.
    #[default]
    Dynamic,
    /// Stands still.
    Static,
}

/// A node below a body, with what is below it, of another material.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// glTF node below the body.
    pub node: String,
    /// Its material.
    pub material: String,
    /// Thickness of the sheet, where the mesh is an open surface.
    pub thickness: Option<Length>,
}

/// A point: the name of a node, or coordinates.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Point {
    /// A node's origin.
    Node(String),
    /// In node space.
    Position([Length; 3]),
}

/// A point of a node.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Attachment {
    /// glTF node; a node of no body stands still.
    pub node: String,
    /// A node below it, or [x, y, z] in node space; by default its origin.
    pub at: Option<Point>,
}

/// Where a nail is driven in.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum NailTarget {
    /// A fixed point of the world.
    World([Length; 3]),
    /// A node, or a point of it.
    Node(Attachment),
}

/// A wire or cord: drawn as a round rod, has mass, feels the wind.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wire {
    /// Unique name.
    pub name: Name,
    /// Node of the body that carries it; without it the wire stands still.
    pub body: Option<String>,
    /// The line: nodes, or [x, y, z] in the body's node space.
    #[schemars(length(min = 2, max = 4096))]
    pub points: Vec<Point>,
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
    /// 0 dielectric … 1 metal.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub metallic: Option<f32>,
    /// Perceptual roughness 0 … 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub roughness: Option<f32>,
    /// Does it collide?
    #[serde(default)]
    pub collide: bool,
    /// Does it feel the wind?
    #[serde(default = "yes")]
    pub wind: bool,
}

fn yes() -> bool {
    true
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

/// Joints, one array per kind.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct Constraints {
    /// Two points coincide.
    pub point_to_point: Vec<PointToPoint>,
    /// A point of a body stays at a point of the world or of a node.
    pub nail: Vec<Nail>,
    /// An axis of a body stays perpendicular to another.
    pub orientation: Vec<Orientation>,
    /// A spring and damper between two points.
    pub spring: Vec<Spring>,
}

/// Friction of a pivot: a torque up to coefficient · load · radius.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Coulomb coefficient.
    #[schemars(range(min = 0.0))]
    pub coefficient: f64,
    /// Effective lever arm: 0.2–0.5 mm for a hook in a loop.
    pub radius: Length,
}

/// Largest tilt of an axis of the first body away from an axis of the other, or of the world.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Limit {
    /// Axis of the first body, node space.
    pub axis: [f64; 3],
    /// Axis of the world; the default is `axis` where it points at rest.
    pub world_axis: Option<[f64; 3]>,
    /// Axis of another body.
    pub other: Option<BodyAxis>,
    /// Largest angle between the two.
    pub max: Angle,
    /// Coefficient of restitution at the rim, 0 … 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: f64,
}

/// An axis of a body.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodyAxis {
    /// Node of the body.
    pub body: String,
    /// Node space.
    pub axis: [f64; 3],
}

/// Two points coincide (3 rows).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointToPoint {
    /// Unique name.
    pub name: Name,
    /// One point.
    pub a: Attachment,
    /// The other.
    pub b: Attachment,
    /// Friction of the pivot.
    pub friction: Option<Friction>,
    /// Tilt limit.
    pub limit: Option<Limit>,
}

/// A point of a body stays at a point of the world or of a node (3 rows).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Nail {
    /// Unique name.
    pub name: Name,
    /// Node of the body.
    pub body: String,
    /// A node below it, or [x, y, z] in node space; by default its origin.
    pub at: Option<Point>,
    /// [x, y, z] in the world, or { node, at }.
    pub to: NailTarget,
    /// Friction of the pivot.
    pub friction: Option<Friction>,
    /// Tilt limit.
    pub limit: Option<Limit>,
}

/// Two axes stay perpendicular (1 row). Give `world_axis` or `other`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Orientation {
    /// Unique name.
    pub name: Name,
    /// Node of the body.
    pub body: String,
    /// Axis in its node space.
    pub body_axis: [f64; 3],
    /// Axis of the world.
    pub world_axis: Option<[f64; 3]>,
    /// Axis of another body.
    pub other: Option<BodyAxis>,
    /// Friction of the pivot.
    pub friction: Option<Friction>,
    /// Tilt limit.
    pub limit: Option<Limit>,
}

/// A spring and damper between two points.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spring {
    /// Unique name.
    pub name: Name,
    /// One end.
    pub a: Attachment,
    /// The other end.
    pub b: Attachment,
    /// Length without force; by default the length at rest.
    pub rest_length: Option<Length>,
    /// Force per length.
    pub stiffness: Stiffness,
    /// Force per speed.
    pub damping: Option<Damping>,
}

/// A collision shape.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Collider {
    /// glTF node: it moves with the body the node belongs to, and the shape is centred in its frame.
    pub node: String,
    /// Material; by default the body's.
    pub material: Option<String>,
    /// The shape.
    pub shape: Shape,
}

/// A collision shape: one of the kinds. Axes as in glTF: capsules and cylinders stand along Y.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Shape {
    /// A ball.
    Sphere(Sphere),
    /// A cylinder with round ends.
    Capsule(Capsule),
    /// A box.
    Box(BoxShape),
    /// A cylinder.
    Cylinder(Cylinder),
    /// Taken from the mesh of the node and of the nodes below it.
    Fit(Fit),
}

/// A ball.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Radius.
    pub radius: Length,
}

/// A cylinder with round ends along Y.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Capsule {
    /// Distance between the centres of the ends.
    pub height: Length,
    /// Radius.
    pub radius: Length,
}

/// A box along the axes.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxShape {
    /// Full lengths of the edges.
    pub size: [Length; 3],
}

/// A cylinder along Y.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    /// Height.
    pub height: Length,
    /// Radius.
    pub radius: Length,
}

/// What is fitted to a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Fit {
    /// The ball around it.
    Sphere,
    /// The capsule along its longest axis.
    Capsule,
    /// The box along its principal axes.
    Box,
    /// Sheet metal: its outline, cut into convex pieces, half its thickness around.
    Plate,
    /// Its convex hull.
    Convex,
}

/// What collides with what.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Collision {
    /// Names for several nodes, used as "group:NAME".
    pub groups: BTreeMap<String, Vec<String>>,
    /// Pairs of nodes or groups that never collide.
    pub exclude: Vec<[String; 2]>,
    /// Do bodies that are joined collide?
    pub constrained_pairs: ConstrainedPairs,
}

/// Do bodies that are joined collide?
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ConstrainedPairs {
    /// No.
    #[default]
    Exclude,
    /// Yes.
    Collide,
}

/// A surface that feels the wind: the mesh of a node and of the nodes below it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WindSurface {
    /// glTF node that is a body or belongs to one.
    pub node: String,
    /// How densely it is sampled.
    #[serde(default)]
    pub sampling: Sampling,
    /// Which side of the triangles feels the wind.
    pub faces: Option<Faces>,
    /// Coefficients.
    #[serde(default)]
    pub drag: Drag,
}

/// How densely a wind surface is sampled.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Sampling {
    /// Sample points per area.
    pub per_area: PerArea,
    /// Fewest points.
    #[schemars(range(min = 1, max = 4096))]
    pub min: usize,
    /// Most points.
    #[schemars(range(min = 1, max = 4096))]
    pub max: usize,
    /// Seed of the points.
    pub seed: u64,
}

impl Default for Sampling {
    fn default() -> Self {
        Self { per_area: PerArea(4000.0), min: 16, max: 400, seed: 1 }
    }
}

/// Which side of the triangles feels the wind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Faces {
    /// A thin sheet: either side.
    Both,
    /// A solid: the outside.
    Front,
}

/// Drag coefficients.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Drag {
    /// For flow along the normal: 1.17 for a plate.
    #[schemars(range(min = 0.0))]
    pub normal: f64,
    /// Skin friction for flow along the face.
    #[schemars(range(min = 0.0))]
    pub tangential: f64,
    /// Multiplies the force.
    #[schemars(range(min = 0.0))]
    pub gain: f64,
}

impl Default for Drag {
    fn default() -> Self {
        Self { normal: 1.17, tangential: 0.02, gain: 1.0 }
    }
}

/// Which motion of which body plays which sound.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sound {
    /// Unique name.
    pub name: Name,
    /// Node of the body.
    pub body: String,
    /// The part that sounds, where it is not all of the body.
    pub node: Option<String>,
    /// What sets it off.
    pub on: Trigger,
    /// Name of the timbre.
    pub timbre: String,
    /// Level.
    #[serde(default)]
    pub gain: Decibel,
    /// Key of a caption in the labels.
    pub caption: Option<String>,
    /// Most simultaneous hits.
    #[schemars(range(min = 1, max = 64))]
    pub max_voices: Option<usize>,
    /// Dimensions that the mesh does not tell.
    #[serde(default)]
    pub params: SoundParams,
}

/// Dimensions of a sounding body that the mesh does not tell.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SoundParams {
    /// Longest half extent.
    pub half_length: Option<Length>,
    /// Second half extent.
    pub half_width: Option<Length>,
    /// Thickness of the sheet.
    pub thickness: Option<Length>,
}

/// What sets a sound off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Trigger {
    /// A hit on the body.
    Impact,
    /// The wind at the body.
    Wind,
}

/// What happens when nobody is there.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Attract {
    /// Steps in time order; the script repeats after the last.
    pub step: Vec<AttractStep>,
    /// Length of one round; by default 10 s after the last step.
    pub duration: Option<Time>,
}

/// One step of the attract script: one of show, blow, reset.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AttractStep {
    /// Since the script began.
    pub at: Time,
    /// Key of a label text to show.
    pub show: Option<String>,
    /// A recorded breath.
    pub blow: Option<Blow>,
    /// Puts everything back to where it started.
    #[serde(default)]
    pub reset: bool,
}

/// A recorded breath.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Blow {
    /// WAV file inside the exhibit folder.
    pub wav: String,
    /// Picture coordinates, (0,0) top left, (1,1) bottom right; by default the centre.
    pub aim: Option<[f64; 2]>,
}

/// Words by language code.
#[derive(Debug, Default, Deserialize, JsonSchema)]
pub struct Label {
    /// Language shown first.
    pub default_language: Option<String>,
    /// One table per language.
    #[serde(flatten)]
    pub languages: BTreeMap<String, Words>,
}

/// Words of one language.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Words {
    /// Title of the work.
    pub title: String,
    /// Maker.
    pub maker: String,
    /// Wall text.
    pub body: String,
    /// What is to be seen, for those who cannot.
    pub alt: String,
    /// Texts by key.
    pub text: BTreeMap<String, String>,
    /// Captions of sounds by key.
    pub caption: BTreeMap<String, String>,
}

/// Who made it, and whose rights it carries.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Credit {
    /// SPDX id of the model's licence.
    pub model_license: String,
    /// Who made the model.
    pub model_author: String,
    /// Rights notice shown with the label.
    pub notice: String,
    /// Sources of facts on the label.
    pub sources: Vec<String>,
}
