//! Surfaces of an exhibit: collision shapes, wind surfaces, sounds.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::quantity::*;
use super::{Function, Name};

/// A collision shape.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Collider {
    /// glTF node: the shape is centred in its frame and moves with its body.
    pub node: String,
    /// Material; by default the body's.
    pub material: Option<String>,
    /// The shape.
    pub shape: Shape,
    /// Copies of the shape evenly around an axis: the teeth of a wheel.
    pub ring: Option<Ring>,
}

/// Copies of a collision shape, evenly around an axis through the origin of the body's node.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ring {
    /// Number of shapes in all.
    #[schemars(range(min = 2, max = 512))]
    pub count: usize,
    /// The axis, in the node space of the body.
    pub axis: [f64; 3],
}

/// A collision shape. Axes as in glTF: capsules and cylinders stand along Y, a plane's normal is Y.
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
    /// Half-space below the plane through the node's origin, normal Y: an infinite floor or wall, which is fixed.
    Plane(HalfSpace),
    /// Fitted to the mesh of the node and of the nodes below it.
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

/// A half-space, without parameters.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HalfSpace {}

/// The shape that is fitted to a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Fit {
    /// The ball around it.
    Sphere,
    /// The capsule along its longest axis.
    Capsule,
    /// The box along its principal axes.
    Box,
    /// Sheet metal: its outline, cut into convex pieces, with half its thickness as radius.
    Plate,
    /// Its convex hull.
    Convex,
}

/// Exceptions from collision.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Collision {
    /// Names for several nodes, used as "group:NAME".
    pub groups: BTreeMap<String, Vec<String>>,
    /// Pairs of nodes or groups that never collide.
    pub exclude: Vec<[String; 2]>,
    /// Do bodies that are joined collide with each other?
    pub constrained_pairs: ConstrainedPairs,
}

/// Do bodies that are joined collide with each other?
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ConstrainedPairs {
    /// No.
    #[default]
    Exclude,
    /// Yes.
    Collide,
}

/// A surface on which wind acts: the mesh of a node and of the nodes below it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WindSurface {
    /// glTF node that is a body or belongs to one.
    pub node: String,
    /// How densely it is sampled.
    #[serde(default)]
    pub sampling: Sampling,
    /// Which side of the triangles the wind acts on.
    pub faces: Option<Faces>,
    /// Drag coefficients.
    #[serde(default)]
    pub drag: Drag,
    /// Does it shelter bodies behind it from the wind?
    #[serde(default = "yes")]
    pub shadow: bool,
}

fn yes() -> bool {
    true
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

/// Which side of the triangles the wind acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Faces {
    /// Both sides, as of a thin sheet.
    Both,
    /// The outside, as of a solid.
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
    /// Node that sounds, where it is not the whole body.
    pub node: Option<String>,
    /// What triggers it.
    pub on: Trigger,
    /// Of wind: the wire that sings; only wind across it sounds.
    pub wire: Option<String>,
    /// Of wind: whose air it is.
    #[serde(default)]
    pub air: AirOf,
    /// Name of the timbre: a file of the exhibit's own folder `timbres`, or a shipped one.
    pub timbre: String,
    /// The constraint or spring whose force the timbre follows.
    pub force_of: Option<Name>,
    /// A number that the timbre follows; it may change with time.
    pub parameter: Option<Function<f64>>,
    /// Level.
    #[serde(default)]
    pub gain: Decibel,
    /// Key of a caption in the labels.
    pub caption: Option<String>,
    /// Most simultaneous clicks of impacts; resonances add up without limit.
    #[schemars(range(min = 1, max = 64))]
    pub max_voices: Option<usize>,
    /// Dimensions that the mesh does not give.
    #[serde(default)]
    pub params: SoundParams,
}

/// Dimensions of a sounding body that the mesh does not give.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SoundParams {
    /// Half of the body's longest extent.
    pub half_length: Option<Length>,
    /// Half of the body's second longest extent.
    pub half_width: Option<Length>,
    /// Thickness of the sheet that the body is.
    pub thickness: Option<Length>,
}

/// Whose air a sound of wind follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum AirOf {
    /// The air at all wind surfaces.
    #[default]
    Exhibit,
    /// The air at the wind surfaces of the body.
    Body,
}

/// What triggers a sound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Trigger {
    /// An impact on the body.
    Impact,
    /// A contact that slides or rolls over the body.
    Slide,
    /// Wind.
    Wind,
    /// Motion of the body: what the timbre follows of it.
    Motion,
}
