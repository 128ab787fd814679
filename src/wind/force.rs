//! Quadratic aerodynamic drag of all winds on moving patches.
//!
//! Per patch, with w the air's velocity and u the patch's own, v = w − u the relative wind, n the outward normal, t the
//! direction of a wire:
//!
//! ```text
//! one-sided   F = ½ ρ A (C_D |v_n| v_n n + C_f |v_t| v_t)     v_n = v·n < 0 (the windward side carries the plate's whole C_D)
//! two-sided   the same for either sign of v_n                 (a mesh that is one face of a thin sheet)
//! wire        F = ½ ρ A (C_D |v_⊥| v_⊥ + π C_f |v_∥| v_∥)     across and along a cylinder of A = length · diameter
//! ```
//!
//! This is quadratic drag at Reynolds numbers of 10³–10⁵ (the source calls it Stokes drag). Because v is relative, still air
//! damps translation; because plates have many patches, it damps rotation too.
//!
//! The air velocity w is the sum of the winds of `ambient.rs` and the breath. Breath, fans and draughts act only on patches
//! that face their origin and are visible from it; the origin of the breath is the lips. Five further rules apply to the
//! force that the breath adds:
//!
//! ```text
//! superposition  F_i = F(b + w/√G − u) − F(w/√G − u)   on a solid; b: the breath's air, w: the undirected wind, G ≥ 1: the
//!                                                      gain. A gain acts as √G times the breath's speed would, so the
//!                                                      undirected wind beside it counts less by as much. The breath
//!                                                      reaches windward faces only, where opposing air would hide it; a
//!                                                      two-sided patch takes the whole w
//! turbulence     F_i += β |F_i| H g(x_i − U_e t, t)    |g| < 1: seeded vector noise, carried downstream, nearly the same
//!                                                      at neighbours. H: response of the patch, 1 to the normal part and
//!                                                      C_f/C_D to the tangential part. So |F_random| < β |F|
//! light bodies   |F_i| G ≤ m A_i |v| / (A Δt)          a patch's share of the mass loses at most its relative wind in a
//!                                                      step Δt; only thin cloth in fast air comes near
//! bound          Σ |F_i| ≤ ρ Q v₀                      v₀: source speed of the fastest air that arrives; a breath cannot
//!                                                      push harder than its own momentum flow
//! gain           F_i ← G F_i                           after the bound
//! ```

use fearless_simd::{Level, Simd, SimdBase, dispatch, f64x4};

use super::air_noise::AirNoise;
use super::ambient::{AmbientWind, Wind, WindOrigin};
use super::breath::{Breath, JetPoint};
use super::drag::{PatchBlock, all, by_lane, lane, sum};
use super::jet_front::JetFront;
use super::patch_air::{BreathAir, PatchAir, STILL_AIR};
use super::patches::{Patch, PatchKind};
use super::wind_surface::{PlacedPatch, PosedSurface, WindSurface};
use super::{Shelter, Surface};
use soffio_geometry::bodies::RigidBody;
use soffio_geometry::rays::Occluders;
use soffio_math::DVec3;
use soffio_math::lanes::WIDTH;
use soffio_math::noise::perlin3_vector;
use soffio_math::spatial::{Vec6, add_wrench, angular, linear, vec6};

/// β where nothing else is set: upper bound of the random part of a breath's force on a patch, as a share of it. With the noise
/// below, the force on a face fluctuates by a fifth, as that of a jet whose speed fluctuates by a tenth.
pub const TURBULENCE: f64 = 0.6;

/// Time for which the force of one call acts, s: the step of the simulation.
const STEP: f64 = 1.0 / 240.0;

/// Noise g of a breath's turbulence.
struct Eddies {
    /// Size, m.
    size: f64,
    /// U_e: speed at which they are carried downstream, m/s.
    speed: f64,
    /// Rate of change, 1/s.
    rate: f64,
    /// Gain before the noise is compressed below 1, which it would otherwise hardly ever approach.
    gain: f64,
}

/// Noise of the breath's turbulence: chosen so that the force on a face fluctuates by a fifth (see [`TURBULENCE`]).
const EDDIES: Eddies = Eddies { size: 0.06, speed: 0.5, rate: 0.37, gain: 2.0 };
/// Distance before the lips at which [`WindReport::gust`] is sampled, m.
const GUST_DISTANCE: f64 = 0.5;
/// Most patches of a surface that [`WindField::visible_fraction`] tests: steps of 6 %, finer than an eye sees in the
/// aim.
const VISIBILITY_SAMPLES: usize = 16;

/// The breath in one step, as it acts on surfaces.
pub struct BreathJet<'a> {
    /// At the source's present speed.
    pub breath: Breath,
    /// Air in flight; `None`: the breath arrives everywhere without delay.
    pub jet_front: Option<&'a JetFront>,
    /// G: multiplies the breath's force.
    pub gain: f64,
    /// β: upper bound of the random part of its force on a patch, as a share of it, 0 … 1.
    pub turbulence: f64,
}

impl BreathJet<'_> {
    /// The breath's air at a point (world, m), without gusts.
    #[inline]
    pub(crate) fn air(&self, point: DVec3) -> BreathAir {
        let Some(JetPoint { distance, speed_ratio }) = self.breath.relative_speed(point) else {
            return BreathAir::default();
        };
        let source_speed = match self.jet_front {
            Some(jet_front) => jet_front.speed_at(distance, self.breath.lip_diameter),
            None => self.breath.speed,
        };
        let speed = speed_ratio * source_speed;
        if speed < STILL_AIR {
            return BreathAir::default();
        }
        BreathAir { velocity: self.breath.flow_direction(point) * speed, source_speed }
    }
}

/// Result of the wind in one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WindReport {
    /// Sum of all forces, drag in still air included, N.
    pub force: DVec3,
    /// The part of it that the breath adds, N.
    pub breath: DVec3,
    /// Upper bound of the breath's part, N: momentum flow times gain.
    pub bound: f64,
    /// Relative gust of the breath half a metre before the lips, within ±1 at the usual β, and in proportion to β.
    pub gust: f64,
}

/// A patch in the world, and its visibility from the lips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchSample {
    /// Index of its surface.
    pub surface: usize,
    /// Index of the patch on it.
    pub patch: usize,
    /// World point, m.
    pub point: DVec3,
    /// Outward normal or direction of the wire, world, unit.
    pub axis: DVec3,
    /// Area, m².
    pub area: f64,
    /// Whether it faces the lips and nothing hides it from them.
    pub visible: bool,
}

/// All wind surfaces, shelters and winds of an exhibit.
#[derive(Clone)]
pub struct WindField {
    surfaces: Vec<WindSurface>,
    ambient: AmbientWind,
    occluders: Occluders,
    seed: u64,
    /// The breath's wrench on each body, without bound and gain.
    breath_wrenches: Vec<Vec6>,
    patch_air: PatchAir,
    /// Of each surface in the last step.
    noise: Vec<AirNoise>,
    /// SIMD instruction set.
    level: Level,
}

impl WindField {
    /// Surfaces, shelters and winds of an exhibit with `bodies` bodies.
    pub fn new(surfaces: &[Surface], shelters: &[Shelter], winds: &[Wind], bodies: usize, seed: u64) -> Self {
        let ambient = AmbientWind::new(winds);
        let occluders = Occluders::new(shelters.iter().map(|shelter| (shelter.body, &shelter.mesh)));
        let sampled = |surface| WindSurface::new(surface, ambient.uniform_radius(), ambient.len(), &occluders);
        let surfaces: Vec<_> = surfaces.iter().map(sampled).collect();
        let most = surfaces.iter().map(|surface| surface.blocks.len() * WIDTH).max().unwrap_or(0);
        Self {
            ambient,
            occluders,
            seed,
            breath_wrenches: vec![[0.0; 6]; bodies],
            patch_air: PatchAir::with_capacity(most),
            noise: vec![AirNoise::default(); surfaces.len()],
            surfaces,
            level: Level::new(),
        }
    }

    /// Adds the wrenches (N, N m about each centre of mass) of all winds at `time` (s since the reset) to `out`.
    pub fn apply_forces(
        &mut self,
        bodies: &[RigidBody],
        time: f64,
        jet: Option<&BreathJet>,
        out: &mut [Vec6],
    ) -> WindReport {
        self.ambient.set_time(time);
        if jet.is_some() || !self.ambient.is_empty() {
            self.occluders.refit(|body| bodies[body].pose());
        }
        self.breath_wrenches.fill([0.0; 6]);
        dispatch!(self.level, simd => self.apply_forces_in(simd, bodies, jet, out))
    }

    #[inline(always)]
    fn apply_forces_in<S: Simd>(
        &mut self,
        simd: S,
        bodies: &[RigidBody],
        jet: Option<&BreathJet>,
        out: &mut [Vec6],
    ) -> WindReport {
        let still_air = jet.is_none() && self.ambient.is_empty();
        let mut report = WindReport::default();
        let mut load = BreathLoad::default();
        let mut patch_air = std::mem::take(&mut self.patch_air);
        let mut noise = std::mem::take(&mut self.noise);
        noise.fill(AirNoise::default());
        for (surface, noise) in self.surfaces.iter().zip(&mut noise) {
            let body = &bodies[surface.body];
            let at_rest = body.velocity == DVec3::ZERO && body.angular_velocity == DVec3::ZERO;
            if at_rest && still_air {
                continue;
            }
            let posed = PosedSurface::new(surface, body);
            if !still_air {
                patch_air.sample_ambient(&posed, &self.ambient, &self.occluders);
            }
            let jet = jet.filter(|jet| patch_air.sample_breath(&posed, jet, &self.occluders));
            let air = (!still_air).then_some(&patch_air);
            let wrenches = self.surface_wrenches(simd, &posed, air, jet, &mut load, noise);
            for k in 0..6 {
                out[surface.body][k] += wrenches.ambient[k];
                self.breath_wrenches[surface.body][k] += wrenches.breath[k];
            }
            report.force += linear(&wrenches.ambient);
        }
        (self.patch_air, self.noise) = (patch_air, noise);
        if let Some(jet) = jet {
            self.apply_breath(jet, &load, out, &mut report);
        }
        report
    }

    /// Wrenches on one surface, and its noise. `air`: sampled air at its patches, `None` in still air.
    #[inline(always)]
    fn surface_wrenches<S: Simd>(
        &self,
        simd: S,
        posed: &PosedSurface,
        air: Option<&PatchAir>,
        jet: Option<&BreathJet>,
        load: &mut BreathLoad,
        noise: &mut AirNoise,
    ) -> SurfaceWrenches {
        let PosedSurface { surface, body, to_world, to_body } = *posed;
        let center = body.properties.center;
        let spin = to_body * body.angular_velocity;
        let origin = to_body * body.velocity - spin.cross(center);
        let solid = surface.patches.first().is_some_and(|patch| patch.kind == PatchKind::OneSided);
        // 1/√G on a solid.
        let undirected_share = jet.filter(|_| solid).map_or(1.0, |jet| 1.0 / jet.gain.max(1.0).sqrt());
        // A force that acts for a whole step must not turn the relative wind round: a light body would gain energy.
        let gain = jet.map_or(1.0, |jet| jet.gain.max(1.0));
        let most = body.properties.mass / (surface.area * STEP * gain);
        let (mut force, mut moment) = (all(simd, DVec3::ZERO), all(simd, DVec3::ZERO));
        let mut breath_sum = [0.0; 6];
        let mut power = f64x4::splat(simd, 0.0);
        let (mut loud_points, mut loud_flow) = (all(simd, DVec3::ZERO), all(simd, DVec3::ZERO));
        let mut add_noise = |block: &PatchBlock, wind| {
            let (loud, point) = block.noise(simd, wind);
            power += loud;
            loud_points += point;
            loud_flow += wind * loud;
        };
        for (first, block) in (0..).step_by(WIDTH).zip(&surface.blocks) {
            let still = -block.velocities(simd, origin, spin);
            let ambient = match air {
                None => still,
                Some(air) => still + by_lane(simd, |k| to_body * air.ambient[first + k]),
            };
            let drag = block.drag(simd, ambient, most);
            force += drag;
            moment += block.moments(simd, drag);
            let arrives = jet.zip(air).map(|(jet, air)| (jet, air, &air.breath[first..first + WIDTH]));
            let arrives = arrives.filter(|(.., breath)| breath.iter().any(|air| air.source_speed != 0.0));
            let Some((jet, air, breath)) = arrives else {
                add_noise(block, ambient);
                continue;
            };
            let arriving = by_lane(simd, |k| to_body * breath[k].velocity);
            // A gain acts as √G times the breath's speed would.
            add_noise(block, ambient + arriving * f64x4::splat(simd, jet.gain.sqrt()));
            let (mut wind, mut drag_before) = (ambient, drag);
            if undirected_share < 1.0 {
                wind -= by_lane(simd, |k| (1.0 - undirected_share) * (to_body * air.undirected[first + k]));
                drag_before = block.drag(simd, wind, most);
            }
            let added = block.drag(simd, wind + arriving, most) - drag_before;
            for (k, air) in breath.iter().enumerate().filter(|(_, air)| air.source_speed > 0.0) {
                let patch = &surface.patches[first + k];
                let added = lane(&added, k);
                let gust = self.gust(&jet.breath, posed.place(patch).point);
                let response = surface.gust_response(patch, to_body * gust);
                let added = added + jet.turbulence * added.length() * response;
                load.force_sum += added.length();
                load.source_speed = air.source_speed.max(load.source_speed);
                add_wrench(&mut breath_sum, patch.point - center, added);
            }
        }
        let force = sum(&force);
        noise.power = (power[0] + power[1]) + (power[2] + power[3]);
        noise.moment = noise.power * (body.position - to_world * center) + to_world * sum(&loud_points);
        noise.flow = to_world * sum(&loud_flow);
        SurfaceWrenches {
            ambient: vec6(to_world * force, to_world * (sum(&moment) - center.cross(force))),
            breath: vec6(to_world * linear(&breath_sum), to_world * angular(&breath_sum)),
        }
    }

    /// Adds the breath's wrenches, bounded by its momentum flow, times its gain.
    fn apply_breath(&self, jet: &BreathJet, load: &BreathLoad, out: &mut [Vec6], report: &mut WindReport) {
        let most = jet.breath.momentum_flow(load.source_speed);
        let share = jet.gain * if load.force_sum > most { most / load.force_sum } else { 1.0 };
        for (out, wrench) in out.iter_mut().zip(&self.breath_wrenches) {
            for k in 0..6 {
                out[k] += share * wrench[k];
            }
            report.breath += share * linear(wrench);
        }
        report.force += report.breath;
        report.bound = jet.gain * most;
        let ahead = jet.breath.mouth + GUST_DISTANCE * jet.breath.direction;
        report.gust = jet.turbulence / TURBULENCE * self.gust(&jet.breath, ahead).dot(jet.breath.direction);
    }

    /// How loud the air over each surface was in the last step, in the order of the surfaces.
    pub fn noise(&self) -> &[AirNoise] {
        &self.noise
    }

    /// Sum of the patches' areas of a surface, m².
    pub fn area(&self, surface: usize) -> f64 {
        self.surfaces[surface].area
    }

    /// Sum of the undirected winds at a point (world, m), m/s.
    pub fn undirected_velocity(&self, point: DVec3) -> DVec3 {
        self.ambient.undirected_velocity(point)
    }

    /// Sum of the breath and all directed winds at a point (world, m), without shelter, m/s.
    pub fn directed_velocity(&self, jet: Option<&BreathJet>, point: DVec3) -> DVec3 {
        let winds = (0..self.ambient.len()).filter(|&wind| self.ambient.wind_origin(wind).is_some());
        let velocities = winds.map(|wind| self.ambient.velocity(wind, point));
        let directed: DVec3 = velocities.filter(|air| air.length_squared() > STILL_AIR * STILL_AIR).sum();
        directed + jet.map_or(DVec3::ZERO, |jet| self.breath_velocity(jet, point))
    }

    /// Velocity of the breath's air at a point (world, m), gusts included, m/s. Force grows with the square of the speed, so
    /// the relative gust of the air is half of the force's.
    pub fn breath_velocity(&self, jet: &BreathJet, point: DVec3) -> DVec3 {
        let BreathAir { velocity, source_speed } = jet.air(point);
        if source_speed <= 0.0 {
            return DVec3::ZERO;
        }
        velocity + 0.5 * jet.turbulence * velocity.length() * self.gust(&jet.breath, point)
    }

    /// g: turbulence of the breath at a point (world, m), of length below 1, carried downstream.
    fn gust(&self, breath: &Breath, point: DVec3) -> DVec3 {
        let time = self.ambient.time();
        let carried = point - breath.direction * (EDDIES.speed * time);
        let noise = EDDIES.gain * perlin3_vector(carried / EDDIES.size + DVec3::splat(EDDIES.rate * time), self.seed);
        noise / (1.0 + noise.length_squared()).sqrt()
    }

    /// Every patch, and whether it is visible from the lips.
    pub fn sample_patches(&mut self, bodies: &[RigidBody], breath: &Breath) -> Vec<PatchSample> {
        self.occluders.refit(|body| bodies[body].pose());
        let mut samples: Vec<PatchSample> = Vec::new();
        for (index, surface) in self.surfaces.iter().enumerate() {
            let pose = bodies[surface.body].pose();
            let first = samples.len();
            let sample = |(patch, Patch { point, axis, area, .. }): (usize, &Patch)| PatchSample {
                surface: index,
                patch,
                point: pose.point(*point),
                axis: pose.vector(*axis),
                area: *area,
                visible: false,
            };
            samples.extend(surface.patches.iter().enumerate().map(sample));
            let rays = samples[first..].iter().enumerate().filter_map(|(k, sample)| {
                let origin = WindOrigin::Point(breath.origin(sample.point));
                let placed = PlacedPatch { point: sample.point, axis: sample.axis };
                Some((k, surface.facing(k, placed, origin)?.line()))
            });
            self.patch_air.rays.set(rays);
            for k in self.patch_air.rays.visible(&self.occluders, surface.hints(None)) {
                samples[first + k].visible = true;
            }
        }
        samples
    }

    /// Visible share of the patches of a surface that face a point (world, m), 0 … 1, from at most 16 of its patches.
    pub fn visible_fraction(&mut self, surface: usize, bodies: &[RigidBody], from: DVec3) -> f64 {
        self.occluders.refit(|body| bodies[body].pose());
        let surface = &self.surfaces[surface];
        let pose = bodies[surface.body].pose();
        let mut facing = 0;
        let tested = (0..surface.patches.len()).step_by(surface.patches.len().div_ceil(VISIBILITY_SAMPLES));
        let rays = tested.filter_map(|k| {
            let patch = &surface.patches[k];
            let placed = PlacedPatch { point: pose.point(patch.point), axis: pose.vector(patch.axis) };
            let ray = surface.facing(k, placed, WindOrigin::Point(from))?.line();
            facing += 1;
            Some((k, ray))
        });
        self.patch_air.rays.set(rays);
        let visible = self.patch_air.rays.visible(&self.occluders, surface.hints(None)).count();
        if facing > 0 { visible as f64 / f64::from(facing) } else { 0.0 }
    }

    /// Number of patches of all surfaces.
    pub fn patch_count(&self) -> usize {
        self.surfaces.iter().map(|surface| surface.patches.len()).sum()
    }

    /// The shelters, refitted to these bodies.
    pub fn occluders_at(&mut self, bodies: &[RigidBody]) -> &Occluders {
        self.occluders.refit(|body| bodies[body].pose());
        &self.occluders
    }

    /// The shelters as last refitted.
    pub fn occluders(&self) -> &Occluders {
        &self.occluders
    }
}

/// Wrenches on one surface about its body's centre of mass, world, N and N m.
struct SurfaceWrenches {
    /// Of still air and ambient winds.
    ambient: Vec6,
    /// Of the breath, without bound and gain.
    breath: Vec6,
}

/// Load of the breath on all surfaces, without bound and gain.
#[derive(Clone, Copy, Debug, Default)]
struct BreathLoad {
    /// Σ |F_i|, N.
    force_sum: f64,
    /// v₀: source speed of the fastest air that arrives, m/s.
    source_speed: f64,
}
