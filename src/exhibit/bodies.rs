//! Materials, moving bodies, wires and cords of an exhibit.

use super::behavior::Motion;
use soffio_geometry::bodies::MassProperties;
use soffio_math::{DVec3, Pose};
use soffio_multibody::articulation::Anchor;
use soffio_multibody::dynamics::RollingResistance;

/// Physical material of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name in the sidecar.
    pub name: String,
    /// Density, kg/m³.
    pub density: f64,
    /// Coulomb coefficient of static friction.
    pub static_friction: f64,
    /// Coulomb coefficient of sliding friction.
    pub dynamic_friction: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Loss factor η of the mounted part, dimensionless.
    pub loss_factor: f64,
    /// Of a tyre: slip over rolling speed from which it slides entirely; 0 of all else.
    pub full_slip: f64,
    /// The surface's contribution to rolling and spinning resistance of a contact.
    pub resistance: RollingResistance,
}

/// Override of the combine rule for one pair of materials.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialPair {
    /// Indices of the two materials.
    pub pair: (usize, usize),
    /// Coefficient of restitution.
    pub restitution: Option<f64>,
    /// Coulomb coefficient of sliding friction.
    pub dynamic_friction: Option<f64>,
    /// Coulomb coefficient of static friction.
    pub static_friction: Option<f64>,
    /// Rolling resistance: torque against rolling over the normal force, m.
    pub rolling_resistance: Option<f64>,
    /// Spinning resistance: torque about the normal over the normal force, m.
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
    /// Linear damping rate, 1/s, in addition to the air drag of the wind surfaces.
    pub linear_damping: f64,
    /// Angular damping rate, 1/s.
    pub angular_damping: f64,
    /// Index of its material.
    pub material: usize,
    /// Its own kind of motion, never [`Motion::Auto`]; `None` moves as the exhibit does.
    pub moved_by: Option<Motion>,
}

/// A drawn cord: straight from point to point of several bodies. It has no mass, and nothing acts on it.
#[derive(Clone, Debug)]
pub struct Cord {
    /// Name, unique in the exhibit.
    pub name: String,
    /// Its points in order, at least two.
    pub points: Vec<Anchor>,
    /// Radius, m.
    pub radius: f64,
    /// Base colour, linear RGB, 0 … 1.
    pub color: [f32; 3],
    /// Perceptual roughness, 0…1.
    pub roughness: f32,
}

impl Cord {
    /// A point of it, world, m, with the bodies at these poses.
    pub fn point(&self, index: usize, pose: impl Fn(usize) -> Pose) -> DVec3 {
        let Anchor { body, point } = self.points[index];
        body.map_or(point, |body| pose(body).point(point))
    }

    /// Its length with the bodies at these poses, m.
    pub fn length(&self, pose: impl Fn(usize) -> Pose) -> f64 {
        (1..self.points.len()).map(|i| self.point(i - 1, &pose).distance(self.point(i, &pose))).sum()
    }
}

/// A wire or cord: part of a body, or fixed in the world.
#[derive(Clone, Debug)]
pub struct Wire {
    /// Name, unique in the exhibit.
    pub name: String,
    /// Index of the body that carries it; `None` for a wire fixed in the world.
    pub body: Option<usize>,
    /// Polyline in the node frame of the body (world frame for `None`), m.
    pub points: Vec<DVec3>,
    /// Radius, m.
    pub radius: f64,
    /// Index of the physical material.
    pub material: usize,
    /// Base colour, linear RGB, 0 … 1.
    pub color: [f32; 3],
    /// Metalness: 0 dielectric … 1 metal.
    pub metallic: f32,
    /// Perceptual roughness, 0…1.
    pub roughness: f32,
}
