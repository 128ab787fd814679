//! Velocity of the air that arrives at each patch of a surface.
//!
//! A wind whose cone misses the surface's bounding ball is skipped. For the other winds, each patch that faces the wind
//! casts one ray towards the wind's origin; the air at a patch is the sum over the winds that its rays reach.

use super::ambient::{AmbientWind, WindOrigin};
use super::force::BreathJet;
use super::visibility::VisibilityRays;
use super::wind_surface::PosedSurface;
use soffio_geometry::rays::Occluders;
use soffio_math::DVec3;
use soffio_math::lanes::WIDTH;

/// Speed below which a wind is taken for still air and casts no ray, m/s: its force is a millionth of that of a breath
/// of 10 m/s.
pub(crate) const STILL_AIR: f64 = 0.01;

/// The breath's air at one patch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BreathAir {
    /// Velocity of the air, world, m/s.
    pub velocity: DVec3,
    /// Speed at which it left the lips, m/s; 0 where no breath arrives.
    pub source_speed: f64,
}

/// Air velocities at the patches of the current surface, world, m/s; 0 in the lanes of a block that have no patch.
#[derive(Clone, Default)]
pub(crate) struct PatchAir {
    /// All ambient winds, undirected ones included.
    pub ambient: Vec<DVec3>,
    /// The undirected part of it.
    pub undirected: Vec<DVec3>,
    /// The breath.
    pub breath: Vec<BreathAir>,
    /// Of the current wind or breath, before visibility is known.
    unshaded: Vec<BreathAir>,
    /// Rays to the origin of the current wind.
    pub rays: VisibilityRays,
}

impl PatchAir {
    /// Storage for `patches` patches.
    pub fn with_capacity(patches: usize) -> Self {
        let [ambient, undirected] = [(); 2].map(|()| Vec::with_capacity(patches));
        let [breath, unshaded] = [(); 2].map(|()| vec![BreathAir::default(); patches]);
        Self { ambient, undirected, breath, unshaded, rays: VisibilityRays::with_capacity(patches) }
    }

    /// Samples the ambient winds at each patch: their sum, and the undirected part of it.
    pub fn sample_ambient(&mut self, posed: &PosedSurface, wind: &AmbientWind, occluders: &Occluders) {
        let PosedSurface { surface, body, .. } = posed;
        let to_world = |point: DVec3| body.position + body.rotation * (point - body.properties.center);
        let Self { ambient, undirected, unshaded, rays, .. } = self;
        let count = surface.blocks.len() * WIDTH;
        ambient.clear();
        ambient.resize(count, DVec3::ZERO);
        let (center, radius) = (to_world(surface.ball.center), surface.ball.radius);
        for index in (0..wind.len()).filter(|&index| wind.intersects_ball(index, center, radius)) {
            let Some(origin) = wind.wind_origin(index) else { continue };
            rays.set(surface.patches.iter().enumerate().filter_map(|(k, patch)| {
                let facing = surface.facing(k, posed.place(patch), origin)?;
                let velocity = wind.velocity(index, to_world(patch.point));
                unshaded[k].velocity = velocity;
                (velocity.length_squared() > STILL_AIR * STILL_AIR).then(|| (k, facing.line()))
            }));
            for k in rays.visible(occluders, surface.hints(Some(index))) {
                ambient[k] += unshaded[k].velocity;
            }
        }
        undirected.clear();
        for group in &surface.groups {
            let velocity = wind.undirected_velocity(to_world(group.center));
            undirected.resize(group.patches.end, velocity);
            ambient[group.patches.clone()].iter_mut().for_each(|air| *air = velocity + *air);
        }
        undirected.resize(count, DVec3::ZERO);
    }

    /// Samples the breath at each patch. False, and nothing sampled, where the surface lies outside the breath.
    pub fn sample_breath(&mut self, posed: &PosedSurface, jet: &BreathJet, occluders: &Occluders) -> bool {
        let PosedSurface { surface, body, to_world, .. } = posed;
        let center = body.position + *to_world * (surface.ball.center - body.properties.center);
        if !jet.breath.intersects_ball(center, surface.ball.radius) {
            return false;
        }
        let Self { breath, unshaded, rays, .. } = self;
        breath[..surface.blocks.len() * WIDTH].fill(BreathAir::default());
        rays.set(surface.patches.iter().enumerate().filter_map(|(k, patch)| {
            let placed = posed.place(patch);
            let facing = surface.facing(k, placed, WindOrigin::Point(jet.breath.origin(placed.point)))?;
            unshaded[k] = jet.air(placed.point);
            (unshaded[k].source_speed > 0.0).then(|| (k, facing.line()))
        }));
        for k in rays.visible(occluders, surface.hints(None)) {
            breath[k] = unshaded[k];
        }
        true
    }
}
