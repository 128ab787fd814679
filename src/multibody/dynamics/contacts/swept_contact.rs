//! What met on a way that bodies were moved along without regard to it: where, how deep, and how to get out again.
//!
//! Where two surfaces overlap at the way's end on the side on which they met, every point of their manifold counts with
//! its own depth. Where one has gone through the other (thin sheet, a long way) the end says nothing: the depth is then
//! how far the points that met have gone past each other along the normal they met with.

use super::contact::RollingResistance;
use super::impact::SurfacePair;
use super::jacobian_row::{JacobianRow, MAX_ROW_BODIES, point_rows, rolling_resistance_rows};
use super::state::Contacts;
use crate::collision::{Collider, Pair, Shape, TOUCH};
use soffio_geometry::bodies::RigidBody;
use soffio_geometry::support::Core;
use soffio_math::DVec3;
use soffio_math::spatial::Vec6;

/// Cosine between the normals at the meeting and at the end above which the side is the same.
const SAME_SIDE: f64 = 0.5;

/// One point where two bodies met, or one bound that was passed.
#[derive(Clone, Copy, Debug)]
pub struct SweptContact {
    /// Which pair it is, or which bound (counted on from the pairs).
    pub source: usize,
    /// Share of the way after which they met, 0 … 1.
    pub s: f64,
    /// The two bodies; `None` is the world.
    pub bodies: [Option<usize>; 2],
    /// Indices of the two colliders; `None` at a limit.
    pub colliders: Option<[usize; 2]>,
    /// World, m, at the way's end.
    pub point: DVec3,
    /// Unit, from the second collider to the first; zero at a limit.
    pub normal: DVec3,
    /// How far to move out, m (rad at a limit of an angle); not below 0.
    pub depth: f64,
    /// Coulomb coefficient.
    pub friction: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Against rolling and spinning.
    pub resistance: RollingResistance,
    /// Which of the two colliders are balls: centre (node frame) and radius, m.
    pub balls: [Option<(DVec3, f64)>; 2],
    /// The row J whose J v is the rate at which they part.
    pub ends: [Option<(usize, Vec6)>; MAX_ROW_BODIES],
}

impl SweptContact {
    /// J v: the rate at which they part, m/s (rad/s).
    pub fn rate(&self, bodies: &[RigidBody]) -> f64 {
        JacobianRow { ends: self.ends }.rate(bodies)
    }
}

/// Rows of the couple between the bodies of what met: about the normal, then about two tangents.
pub fn rolling_rows(met: &SweptContact) -> [[Option<(usize, Vec6)>; MAX_ROW_BODIES]; 3] {
    rolling_resistance_rows(met.normal, met.bodies).map(|row| row.ends)
}

impl Contacts {
    /// How many pairs and bounds there are: sources of what meets.
    pub fn sources(&self) -> usize {
        self.surfaces.pairs.len() + self.limits.count()
    }

    /// Everything that met between two states of the bodies and still does at the second, by its source, into `out`, as
    /// far as that has room.
    pub fn find_swept_contacts(&mut self, before: &[RigidBody], after: &[RigidBody], out: &mut Vec<SweptContact>) {
        out.clear();
        if !self.surfaces.pairs.is_empty() {
            self.near.find(before, after, &self.sleeping.bodies);
            for near in 0..self.near.list.len() {
                self.look_at_pair(self.near.list[near], after, out);
            }
        }
        for bound in 0..self.limits.count() {
            let gap = self.limits.gap(bound, after);
            if gap > TOUCH || out.len() == out.capacity() {
                continue;
            }
            let (_, row, point) = self.limits.row(bound, after);
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

    fn look_at_pair(&mut self, pair: usize, after: &[RigidBody], out: &mut Vec<SweptContact>) {
        let Pair { a, b } = self.surfaces.pairs[pair].pair;
        let ((sweep_a, sweep_b), toi) = self.near.sweep_pair(&mut self.surfaces, pair);
        let Some(toi) = toi else { return };
        let (s, normal) = (toi.s, toi.proximity.normal);
        let mut add = |point: DVec3, normal: DVec3, gap: f64| {
            let bodies = [self.surfaces.colliders[a].body, self.surfaces.colliders[b].body];
            if gap > TOUCH || out.len() == out.capacity() {
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
            let at = toi.proximity.point;
            let [p, q] = [(collider_a, &sweep_a), (collider_b, &sweep_b)]
                .map(|(collider, sweep)| pose(collider).point(sweep.pose(s).inverse_point(at)));
            add(0.5 * (p + q), normal, toi.proximity.gap + (p - q).dot(normal));
        }
    }

    /// How many bounds there are.
    pub fn bounds(&self) -> usize {
        self.limits.count()
    }

    /// The bodies that a bound is between.
    pub fn bound_bodies(&self, bound: usize) -> [Option<usize>; 2] {
        self.limits.bodies(bound)
    }

    /// What is left to a bound, rad or m; negative beyond it.
    pub fn bound_gap(&self, bound: usize, bodies: &[RigidBody]) -> f64 {
        self.limits.gap(bound, bodies)
    }

    /// The same and its row.
    pub fn bound(&self, bound: usize, bodies: &[RigidBody]) -> (f64, [Option<(usize, Vec6)>; MAX_ROW_BODIES]) {
        let (gap, row, _) = self.limits.row(bound, bodies);
        (gap, row.ends)
    }
}
