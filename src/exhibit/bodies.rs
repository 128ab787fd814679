//! What an exhibit is made of: materials, moving bodies, wires.

use soffio_geometry::bodies::MassProperties;
use soffio_math::{DVec3, Pose};
use soffio_multibody::dynamics::RollingResistance;

/// Physical material of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name in the sidecar.
    pub name: String,
    /// kg/m³.
    pub density: f64,
    /// Coulomb coefficient while sticking.
    pub static_friction: f64,
    /// Coulomb coefficient while sliding.
    pub dynamic_friction: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Installed loss factor η.
    pub loss_factor: f64,
    /// Its part in what resists rolling and spinning on it.
    pub resistance: RollingResistance,
}

/// Override of the combine rule for one pair of materials.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialPair {
    /// Indices of the two materials.
    pub pair: (usize, usize),
    /// Coefficient of restitution.
    pub restitution: Option<f64>,
    /// Coulomb coefficient while sliding.
    pub dynamic_friction: Option<f64>,
    /// Coulomb coefficient while sticking.
    pub static_friction: Option<f64>,
    /// Couple against rolling over the normal force, m.
    pub rolling_resistance: Option<f64>,
    /// Couple against spin about the normal over the normal force, m.
    pub spin_resistance: Option<f64>,
}

/// A moving rigid body.
#[derive(Clone, Debug)]
pub struct Body {
    /// Name of its glTF node.
    pub name: String,
    /// Index of its glTF node; descendants that are not bodies move with it.
    pub node: usize,
    /// Mass, centre, inertia in the node frame.
    pub properties: MassProperties,
    /// World pose of the node at reset.
    pub pose: Pose,
    /// Initial velocity of the centre of mass, m/s.
    pub velocity: DVec3,
    /// Initial angular velocity, world axes, rad/s.
    pub angular_velocity: DVec3,
    /// Linear damping rate, 1/s (air other than the wind surfaces' own).
    pub linear_damping: f64,
    /// Angular damping rate, 1/s.
    pub angular_damping: f64,
    /// Index of its material.
    pub material: usize,
}

/// A wire or cord that belongs to a body (or stands still).
#[derive(Clone, Debug)]
pub struct Wire {
    /// Unique in the exhibit.
    pub name: String,
    /// Index of the body that carries it; `None` stands still.
    pub body: Option<usize>,
    /// Polyline in the node frame of the body (world frame for `None`), m.
    pub points: Vec<DVec3>,
    /// m.
    pub radius: f64,
    /// Index of the physical material.
    pub material: usize,
    /// Linear RGB base colour.
    pub color: [f32; 3],
    /// 0 dielectric … 1 metal.
    pub metallic: f32,
    /// Perceptual roughness 0…1.
    pub roughness: f32,
}
