//! Rigid bodies: what they weigh, where they are, how they move.
//!
//! The *node frame* of a body is the frame of its glTF node: model geometry, anchors and sample points are given in
//! it. The state is kept at the centre of mass, where the equations of motion are simplest.

use soffio_math::{DMat3, DQuat, DVec3, Pose, StateHash, product, renormalized, rotation};

/// Mass, centre and inertia of a rigid body, constant for its life.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the node frame, m.
    pub center: DVec3,
    /// Inertia tensor about the centre of mass, node axes, kg m².
    pub inertia: DMat3,
}

impl MassProperties {
    /// Two bodies held rigidly together (parallel-axis theorem).
    #[inline]
    pub fn combine(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        if mass <= 0.0 {
            return *self;
        }
        let center = (self.center * self.mass + other.center * other.mass) / mass;
        Self { mass, center, inertia: self.inertia_about(center) + other.inertia_about(center) }
    }

    /// Inertia tensor about another point of the node frame, kg m².
    #[inline]
    pub fn inertia_about(&self, point: DVec3) -> DMat3 {
        let d = self.center - point;
        self.inertia + self.mass * (DMat3::from_diagonal(DVec3::splat(d.length_squared())) - soffio_math::outer(d, d))
    }
}

/// A moving rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidBody {
    /// Mass properties in the node frame.
    pub properties: MassProperties,
    /// Centre of mass in the world, m.
    pub position: DVec3,
    /// Node axes to world axes.
    pub rotation: DQuat,
    /// Velocity of the centre of mass, m/s.
    pub velocity: DVec3,
    /// Angular velocity in world axes, rad/s.
    pub angular_velocity: DVec3,
}

impl RigidBody {
    /// A body at rest with its node frame at `pose`.
    #[inline]
    pub fn at_rest(properties: MassProperties, pose: Pose) -> Self {
        Self {
            properties,
            position: pose.point(properties.center),
            rotation: pose.rotation,
            velocity: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
        }
    }

    /// Pose of the node frame.
    #[inline]
    pub fn pose(&self) -> Pose {
        Pose { rotation: self.rotation, position: self.position - self.rotation * self.properties.center }
    }

    /// World vector from the centre of mass to a point of the node frame, m.
    #[inline]
    pub fn arm(&self, local: DVec3) -> DVec3 {
        self.rotation * (local - self.properties.center)
    }

    /// World velocity of the material point at world position `p`, m/s.
    #[inline]
    pub fn velocity_at(&self, p: DVec3) -> DVec3 {
        self.velocity + self.angular_velocity.cross(p - self.position)
    }

    /// Inertia tensor in world axes, kg m².
    #[inline]
    pub fn inertia_world(&self) -> DMat3 {
        let r = DMat3::from_quat(self.rotation);
        r * self.properties.inertia * r.transpose()
    }

    /// Kinetic energy, J.
    #[inline]
    pub fn kinetic_energy(&self) -> f64 {
        0.5 * self.properties.mass * self.velocity.length_squared()
            + 0.5 * self.angular_velocity.dot(self.inertia_world() * self.angular_velocity)
    }

    /// Moves by a displacement of the centre (m) and a rotation vector (rad, world axes).
    #[inline]
    pub fn displace(&mut self, translation: DVec3, turn: DVec3) {
        self.position += translation;
        self.rotation = renormalized(product(rotation(turn), self.rotation));
    }

    /// Mixes the state into a hash.
    #[inline]
    pub fn add_to(&self, hash: &mut StateHash) {
        hash.add_vector(self.position);
        for q in self.rotation.to_array() {
            hash.add(q);
        }
        hash.add_vector(self.velocity);
        hash.add_vector(self.angular_velocity);
    }

    /// Are all numbers of the state finite? One that is not makes their sum so.
    #[inline]
    pub fn is_finite(&self) -> bool {
        let vectors = self.position + self.velocity + self.angular_velocity;
        let [x, y, z, w] = self.rotation.to_array();
        (vectors.element_sum() + (x + y + z + w)).is_finite()
    }
}
