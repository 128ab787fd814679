//! Collision shapes of scenes, static shapes, and contact surfaces.

use serde::{Deserialize, Serialize};

use soffio_math::{DQuat, DVec3, Pose};
use soffio_multibody::collision::{Collider, Shape};
use soffio_multibody::dynamics::RollingResistance;

use super::validate::{Problem, finite, positive, unit};

/// A coordinate axis of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ShapeAxis {
    /// (1, 0, 0).
    X,
    /// (0, 1, 0).
    #[default]
    Y,
    /// (0, 0, 1).
    Z,
}

impl ShapeAxis {
    /// Unit vector of the axis.
    pub fn direction(self) -> DVec3 {
        match self {
            Self::X => DVec3::X,
            Self::Y => DVec3::Y,
            Self::Z => DVec3::Z,
        }
    }
}

/// A collision shape about the origin of its own frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "lowercase", deny_unknown_fields)]
pub enum SceneShape {
    /// A box.
    Box {
        /// Half edges, m.
        half: [f64; 3],
        /// Edge radius, within the stated size, m.
        #[serde(default)]
        rounding: f64,
    },
    /// A sphere.
    Sphere {
        /// Radius, m.
        radius: f64,
    },
    /// A cylinder.
    Cylinder {
        /// Radius, m.
        radius: f64,
        /// Half its height, m.
        half_height: f64,
        /// Its axis.
        #[serde(default)]
        axis: ShapeAxis,
        /// Edge radius, within the stated size, m.
        #[serde(default)]
        rounding: f64,
    },
    /// All points within `radius` of a segment.
    Capsule {
        /// Radius, m.
        radius: f64,
        /// Half the segment's length, without the caps, m.
        half_height: f64,
        /// Its axis.
        #[serde(default)]
        axis: ShapeAxis,
    },
    /// The half-space below the plane with this normal; only static.
    Plane {
        /// Normal, unit.
        normal: [f64; 3],
    },
}

impl SceneShape {
    /// The shape as a collision shape at a pose.
    pub fn shape(&self, place: Pose) -> Shape {
        let ends = |axis: ShapeAxis, half: f64| [-half, half].map(|end| place.point(end * axis.direction()));
        match *self {
            Self::Box { half, rounding } => Shape::cuboid(place, DVec3::from_array(half), rounding),
            Self::Sphere { radius } => Shape::sphere(place.position, radius),
            Self::Cylinder { radius, half_height, axis, rounding } => {
                let [from, to] = ends(axis, half_height);
                Shape::cylinder(from, to, radius, rounding)
            }
            Self::Capsule { radius, half_height, axis } => {
                let [from, to] = ends(axis, half_height);
                Shape::capsule(from, to, radius)
            }
            Self::Plane { normal } => {
                let normal = place.rotation * DVec3::from_array(normal).normalize();
                Shape::plane(place.position, normal)
            }
        }
    }

    /// The first problem of the shape.
    pub(super) fn problem(&self, key: &str) -> Problem {
        let sizes: &[(&str, f64)] = match self {
            Self::Box { half: [x, y, z], .. } => &[("half[0]", *x), ("half[1]", *y), ("half[2]", *z)],
            Self::Sphere { radius } => &[("radius", *radius)],
            Self::Cylinder { radius, half_height, .. } | Self::Capsule { radius, half_height, .. } => {
                &[("radius", *radius), ("half_height", *half_height)]
            }
            Self::Plane { normal } => {
                let what = format!("{normal:?} is not of length 1");
                return (!unit(normal)).then(|| (format!("{key}.normal"), what));
            }
        };
        if let Some((own, size)) = sizes.iter().find(|(_, size)| !positive(*size)) {
            return Some((format!("{key}.{own}"), format!("{size} is not a finite number above zero")));
        }
        let (Self::Box { rounding, .. } | Self::Cylinder { rounding, .. }) = *self else { return None };
        let most = sizes.iter().map(|(_, size)| *size).fold(f64::INFINITY, f64::min);
        let fits = (0.0..=most).contains(&rounding);
        (!fits).then(|| (format!("{key}.rounding"), format!("{rounding} is not within 0 and {most}")))
    }
}

/// Contact properties of a surface. Frictions and restitutions of two surfaces combine by the geometric mean,
/// resistances by the sum, as materials of exhibits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactSurface {
    /// Coulomb coefficient.
    pub friction: f64,
    /// Energetic coefficient of restitution, 0 … 1.
    pub restitution: f64,
    /// Its part of the rolling resistance: torque over normal force, m.
    #[serde(default)]
    pub rolling_resistance: f64,
}

/// Contact properties of a pair of surfaces.
#[derive(Clone, Copy, Debug)]
pub struct PairProperties {
    /// Energetic coefficient of restitution, 0 … 1.
    pub restitution: f64,
    /// Coulomb coefficient.
    pub friction: f64,
    /// Rolling and drilling resistance, m.
    pub resistance: RollingResistance,
}

impl ContactSurface {
    /// Properties of the contact of two surfaces: restitution and friction by the geometric mean, rolling resistance by the
    /// sum.
    pub fn with(&self, other: &Self) -> PairProperties {
        let rolling = self.rolling_resistance + other.rolling_resistance;
        let mean = |a: f64, b: f64| if a == b { a } else { (a * b).sqrt() };
        let resistance = RollingResistance { rolling, ..RollingResistance::default() };
        PairProperties {
            restitution: mean(self.restitution, other.restitution),
            friction: mean(self.friction, other.friction),
            resistance,
        }
    }

    pub(super) fn problem(&self, key: &str) -> Problem {
        for (own, value) in [("friction", self.friction), ("rolling_resistance", self.rolling_resistance)] {
            if !(value.is_finite() && value >= 0.0) {
                return Some((format!("{key}.{own}"), format!("{value} is not a finite number of zero or more")));
            }
        }
        let bounces = (0.0..=1.0).contains(&self.restitution);
        (!bounces).then(|| (format!("{key}.restitution"), format!("{} is not within 0 and 1", self.restitution)))
    }
}

/// A static shape.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StaticShape {
    /// Its shape.
    pub shape: SceneShape,
    /// Origin of the shape, or a point of the plane, m.
    #[serde(default)]
    pub pos: [f64; 3],
    /// Rotation from shape axes to world axes, (x, y, z, w).
    #[serde(default = "unturned")]
    pub quat: [f64; 4],
    /// Contact surface, where it differs from the scene's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surface: Option<ContactSurface>,
}

fn unturned() -> [f64; 4] {
    DQuat::IDENTITY.to_array()
}

impl StaticShape {
    /// A static shape with the scene's surface.
    pub fn new(shape: SceneShape, position: DVec3, rotation: DQuat) -> Self {
        Self { shape, pos: position.to_array(), quat: rotation.to_array(), surface: None }
    }

    /// The shape as a collider with this material.
    pub(super) fn collider(&self, index: usize, material: usize) -> Collider {
        let place = Pose { rotation: DQuat::from_array(self.quat).normalize(), position: DVec3::from_array(self.pos) };
        Collider { body: None, shape: self.shape.shape(place), material, node: format!("static-{index}") }
    }

    pub(super) fn problem(&self, key: &str) -> Problem {
        if !finite(&self.pos) {
            return Some((format!("{key}.pos"), format!("{:?} is not finite", self.pos)));
        }
        if !unit(&self.quat) {
            return Some((format!("{key}.quat"), format!("{:?} is not of length 1", self.quat)));
        }
        let surface = || self.surface.as_ref().and_then(|surface| surface.problem(&format!("{key}.surface")));
        self.shape.problem(&format!("{key}.shape")).or_else(surface)
    }
}
