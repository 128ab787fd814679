//! Swept contacts: contacts that bodies passed on a prescribed displacement, with the depth to move them out again.
//!
//! Where two surfaces overlap at the end on the side of their first contact, every point of their manifold has its own depth.
//! Where one surface has passed through the other (a thin sheet, a long displacement), the depth is how far their first points
//! of contact have passed each other along the normal at first contact.

use super::contact::RollingResistance;
use super::impact::SurfacePair;
use super::jacobian_row::{JacobianRow, MAX_ROW_BODIES, point_rows, rolling_resistance_rows};
use super::nearby_pairs::SweptPair;
use super::state::Contacts;
use crate::collision::{CONTACT_MARGIN, Collider, ColliderPair, Shape};
use crate::dynamics::limits::BoundRow;
use soffio_geometry::bodies::RigidBody;
use soffio_geometry::support::Core;
use soffio_math::DVec3;
use soffio_math::spatial::Vec6;

/// Surfaces overlap on the side of their first contact where the cosine of both normals is larger.
const SAME_SIDE: f64 = 0.5;

/// One contact point, or one bound of a limit, that a displacement passed.
#[derive(Clone, Copy, Debug)]
pub struct SweptContact {
    /// Index of the pair, or of the bound plus the number of pairs.
    pub source: usize,
    /// Fraction of the displacement at the first contact, 0 … 1.
    pub s: f64,
    /// The two bodies; `None` is the world.
    pub bodies: [Option<usize>; 2],
    /// Indices of the two colliders; `None` at a limit.
    pub colliders: Option<[usize; 2]>,
    /// World point at the end, m.
    pub point: DVec3,
    /// Unit, from the second collider to the first; zero at a limit.
    pub normal: DVec3,
    /// Penetration at the end, m (rad at a limit of an angle); not below 0.
    pub depth: f64,
    /// Coulomb coefficient.
    pub friction: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Resistance to rolling and spinning.
    pub resistance: RollingResistance,
    /// Centre (node frame, m) and radius (m) of each of the two colliders that is a ball.
    pub balls: [Option<(DVec3, f64)>; 2],
    /// Jacobian row J of the gap: J v is the separation speed.
    pub ends: [Option<(usize, Vec6)>; MAX_ROW_BODIES],
}

impl SweptContact {
    /// J v: the separation speed, m/s (rad/s at a limit of an angle).
    pub fn rate(&self, bodies: &[RigidBody]) -> f64 {
        JacobianRow { ends: self.ends }.rate(bodies)
    }
}

/// Jacobian rows of the relative rotation of a contact's bodies: about the normal, then about two tangents.
pub fn rolling_rows(contact: &SweptContact) -> [[Option<(usize, Vec6)>; MAX_ROW_BODIES]; 3] {
    rolling_resistance_rows(contact.normal, contact.bodies).map(|row| row.ends)
}

impl Contacts {
    /// Number of pairs and bounds together; [`SweptContact::source`] is below it.
    pub fn source_count(&self) -> usize {
        self.surfaces.pairs.len() + self.limits.count()
    }

    /// Writes all contacts that were passed between two states of the bodies and are closed at the second into `out`, by their
    /// sources, up to its capacity.
    pub fn find_swept_contacts(&mut self, before: &[RigidBody], after: &[RigidBody], out: &mut Vec<SweptContact>) {
        out.clear();
        if !self.surfaces.pairs.is_empty() {
            self.nearby.find(before, after, &self.sleeping.bodies);
            for index in 0..self.nearby.list.len() {
                self.find_swept_pair(self.nearby.list[index], after, out);
            }
        }
        for bound in 0..self.limits.count() {
            let gap = self.limits.gap(bound, after);
            if gap > CONTACT_MARGIN || out.len() == out.capacity() {
                continue;
            }
            let BoundRow { row, point, .. } = self.limits.row(bound, after);
            out.push(SweptContact {
                source: self.surfaces.pairs.len() + bound,
                s: 1.0,
                bodies: self.limits.bodies(bound),
                colliders: None,
                point,
                normal: DVec3::ZERO,
                depth: (-gap).max(0.0),
                friction: 0.0,
                restitution: self.limits.restitution(bound),
                resistance: RollingResistance::default(),
                balls: [None; 2],
                ends: row.ends,
            });
        }
    }

    fn find_swept_pair(&mut self, pair: usize, after: &[RigidBody], out: &mut Vec<SweptContact>) {
        let ColliderPair { a, b } = self.surfaces.pairs[pair].pair;
        let SweptPair { sweeps: [sweep_a, sweep_b], impact } = self.nearby.sweep_pair(&mut self.surfaces, pair);
        let Some(impact) = impact else { return };
        let (s, normal) = (impact.s, impact.proximity.normal);
        let mut add = |point: DVec3, normal: DVec3, gap: f64| {
            let bodies = [self.surfaces.colliders[a].body, self.surfaces.colliders[b].body];
            if gap > CONTACT_MARGIN || out.len() == out.capacity() {
                return;
            }
            let surface = &self.surfaces.pairs[pair];
            let [row, ..] = point_rows(point, normal, bodies, after);
            let SurfacePair { friction, restitution, resistance, .. } = *surface;
            let ball = |collider: usize| {
                let Shape { core, radius, place } = &self.surfaces.colliders[collider].shape;
                (*core == Core::Point).then_some((place.position, *radius))
            };
            let balls = [ball(a), ball(b)];
            let colliders = Some([a, b]);
            let depth = (-gap).max(0.0);
            out.push(SweptContact {
                source: pair,
                s,
                bodies,
                colliders,
                point,
                normal,
                depth,
                friction,
                restitution,
                resistance,
                balls,
                ends: row.ends,
            });
        };
        let pose = |collider: &Collider| collider.body.map_or(soffio_math::Pose::IDENTITY, |body| after[body].pose());
        let (collider_a, collider_b) = (&self.surfaces.colliders[a], &self.surfaces.colliders[b]);
        let manifold = self.surfaces.corners.manifold(collider_a, &pose(collider_a), collider_b, &pose(collider_b));
        if manifold.normal.dot(normal) > SAME_SIDE {
            manifold.points().iter().for_each(|at| add(at.point, manifold.normal, at.gap));
        } else {
            let at = impact.proximity.point;
            let [p, q] = [(collider_a, &sweep_a), (collider_b, &sweep_b)]
                .map(|(collider, sweep)| pose(collider).point(sweep.pose(s).inverse_point(at)));
            add(0.5 * (p + q), normal, impact.proximity.gap + (p - q).dot(normal));
        }
    }

    /// Number of bounds of all limits.
    pub fn bound_count(&self) -> usize {
        self.limits.count()
    }

    /// The two bodies of a bound; `None` is the world.
    pub fn bound_bodies(&self, bound: usize) -> [Option<usize>; 2] {
        self.limits.bodies(bound)
    }

    /// Distance from a bound, rad or m; negative beyond it.
    pub fn bound_gap(&self, bound: usize, bodies: &[RigidBody]) -> f64 {
        self.limits.gap(bound, bodies)
    }

    /// Largest distance beyond a bound, rad or m; 0 where all limits are kept.
    pub fn largest_violation(&self, bodies: &[RigidBody]) -> f64 {
        (0..self.bound_count()).fold(0.0, |most, bound| -self.bound_gap(bound, bodies).min(-most))
    }

    /// Distance from a bound, rad or m, and its Jacobian row.
    pub fn bound(&self, bound: usize, bodies: &[RigidBody]) -> (f64, [Option<(usize, Vec6)>; MAX_ROW_BODIES]) {
        let BoundRow { gap, row, .. } = self.limits.row(bound, bodies);
        (gap, row.ends)
    }
}
