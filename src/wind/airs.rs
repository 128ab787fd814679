//! What air arrives at the patches of a surface.
//!
//! A wind whose cone a ball around the surface does not touch is asked no further. Patches in the others' cones that face
//! them look where they come from, all of one surface together; what arrives at a patch is the sum of those that it sees.

use super::feeler::Standing;
use super::force::Blown;
use super::sight::Sight;
use super::weather::{Upwind, Weather};
use soffio_geometry::rays::Occluders;
use soffio_math::DVec3;
use soffio_math::lanes::WIDTH;

/// Wind below this needs no ray, m/s.
pub(crate) const STILL_AIR: f64 = 0.01;

/// Air at the patches of the surface in hand, world, m/s; nothing where a quad has no patch.
#[derive(Clone, Default)]
pub(crate) struct Airs {
    /// Of all winds but the breath.
    pub winds: Vec<DVec3>,
    /// The part of it that comes from all sides.
    pub stirred: Vec<DVec3>,
    /// Of the breath, and the speed at which it left the lips; nothing where it does not arrive.
    pub breath: Vec<(DVec3, f64)>,
    /// Of the wind in hand, whether it arrives or not; and of the breath the speed at which it left the lips.
    one: Vec<(DVec3, f64)>,
    /// Lines to the wind in hand.
    pub sight: Sight,
}

impl Airs {
    /// Room for as many patches.
    pub fn with_capacity(patches: usize) -> Self {
        let [winds, stirred] = [(); 2].map(|()| Vec::with_capacity(patches));
        let [breath, one] = [(); 2].map(|()| vec![(DVec3::ZERO, 0.0); patches]);
        Self { winds, stirred, breath, one, sight: Sight::with_capacity(patches) }
    }

    /// The air of all winds but the breath, and what of it comes from all sides.
    pub fn feel(&mut self, standing: &Standing, weather: &Weather, occluders: &Occluders) {
        let Standing { feeler, body, .. } = standing;
        let place = |point: DVec3| body.position + body.rotation * (point - body.properties.center);
        let Self { winds, stirred, one, sight, .. } = self;
        let count = feeler.quads.len() * WIDTH;
        winds.clear();
        winds.resize(count, DVec3::ZERO);
        let (center, radius) = (place(feeler.ball.0), feeler.ball.1);
        for wind in (0..weather.len()).filter(|&wind| weather.reaches(wind, center, radius)) {
            let Some(from) = weather.upwind(wind) else { continue };
            sight.take(feeler.patches.iter().enumerate().filter_map(|(index, patch)| {
                let facing = feeler.facing(index, standing.place(patch), from)?;
                let air = weather.air(wind, place(patch.point));
                one[index].0 = air;
                (air.length_squared() > STILL_AIR * STILL_AIR).then(|| (index, facing.line()))
            }));
            for index in sight.open(occluders, feeler.hints(Some(wind))) {
                winds[index] += one[index].0;
            }
        }
        stirred.clear();
        for (center, range) in &feeler.groups {
            let aimless = weather.stirs(place(*center));
            stirred.resize(range.end, aimless);
            winds[range.clone()].iter_mut().for_each(|air| *air = aimless + *air);
        }
        stirred.resize(count, DVec3::ZERO);
    }

    /// The breath's air, unless the surface is out of its reach; says whether it is within.
    pub fn feel_breath(&mut self, standing: &Standing, blown: &Blown, occluders: &Occluders) -> bool {
        let Standing { feeler, body, frame, .. } = standing;
        let center = body.position + *frame * (feeler.ball.0 - body.properties.center);
        if !blown.breath.reaches(center, feeler.ball.1) {
            return false;
        }
        let Self { breath, one, sight, .. } = self;
        breath[..feeler.quads.len() * WIDTH].fill((DVec3::ZERO, 0.0));
        sight.take(feeler.patches.iter().enumerate().filter_map(|(index, patch)| {
            let (point, axis) = standing.place(patch);
            let facing = feeler.facing(index, (point, axis), Upwind::Place(blown.breath.origin(point)))?;
            one[index] = blown.air(point);
            (one[index].1 > 0.0).then(|| (index, facing.line()))
        }));
        for index in sight.open(occluders, feeler.hints(None)) {
            breath[index] = one[index];
        }
        true
    }
}
