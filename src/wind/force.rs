//! The wind's force on moving patches.
//!
//! Per patch, with w the air's velocity and u the patch's own, v = w − u the relative wind, n the outward normal, t the
//! direction of a wire:
//!
//! ```text
//! side    F = ½ ρ A (C_D |v_n| v_n n + C_f |v_t| v_t)     v_n = v·n < 0 (the windward side carries the plate's whole C_D)
//! sheet   the same for either sign of v_n                 (a mesh that is one face of a thin sheet)
//! wire    F = ½ ρ A (C_D |v_⊥| v_⊥ + π C_f |v_∥| v_∥)     across and along a cylinder of A = length · diameter
//! ```
//!
//! This is quadratic drag at Reynolds numbers of 10³–10⁵ (the source calls it Stokes drag). Because v is relative,
//! still air damps; because plates have many patches, rotation is damped too.
//!
//! The air w is the sum of the winds of `weather.rs`, or of those and the breath. Breath, fans and draughts reach only patches
//! that face them and see where they come from, past every shelter: for the breath that is the lips. What the breath adds
//! to the force of all else has four further rules:
//!
//! ```text
//! beside       F_i = F(b + w/√G − u) − F(w/√G − u)  on a solid, b the breath's air, w the room's own, which comes from all
//!                                                   sides, G ≥ 1 the gain: it makes a breath stronger as √G times its
//!                                                   speed would, and what stirs beside it as much weaker. The breath only
//!                                                   reaches windward faces, where air against it would else hide it; a
//!                                                   sheet feels both
//! turbulence   F_i += β |F_i| H g(x_i − U_e t, t)   |g| < 1 seeded vector noise of any direction, carried downstream:
//!                                                   nearly the same in neighbours, and the same from run to run; H is
//!                                                   what a patch takes of it, as of the wind: of what presses on a face
//!                                                   all and of what slips along it C_f/C_D. So |F_random| < β |F|
//! bound        Σ |F_i| ≤ ρ Q v₀                     v₀ of the fastest air that arrives: a breath cannot push harder than
//!                                                   its own momentum, whatever it meets
//! gain         F_i ← gain · F_i                     the profile's, after the bound
//! ```

use fearless_simd::{Level, Simd, dispatch};

use super::airs::{Airs, STILL_AIR};
use super::breath::Breath;
use super::drag::{all, by_lane, lane, sum};
use super::feeler::{Feeler, Standing};
use super::front::Front;
use super::patches::{Face, Patch};
use super::weather::{Upwind, Weather, Wind};
use super::{Shelter, Surface};
use soffio_geometry::bodies::RigidBody;
use soffio_geometry::rays::Occluders;
use soffio_math::DVec3;
use soffio_math::lanes::WIDTH;
use soffio_math::noise::perlin3_vector;
use soffio_math::spatial::{Vec6, add_wrench, angular, linear, vec6};

/// β: the random part of a breath's force on a patch is smaller than this share of it. With the noise below the force
/// on a face fluctuates by a fifth, as that of a jet whose speed fluctuates by a tenth.
pub const TURBULENCE: f64 = 0.6;
/// Size of the eddies in a breath, m.
const EDDY: f64 = 0.06;
/// How fast they are carried downstream, m/s, and how fast they change, 1/s.
const EDDY_SPEED: f64 = 0.5;
const EDDY_CHANGE: f64 = 0.37;
/// The noise is drawn out by this before it is bent below 1: else it would hardly ever come near.
const EDDY_STRENGTH: f64 = 2.0;
/// Patches that say how much of a surface is seen, at most.
const LOOKED_AT: usize = 16;
/// The breath of one step.
pub struct Blown<'a> {
    /// At the source's present speed.
    pub breath: Breath,
    /// Air in flight; `None`: the breath is everywhere at once.
    pub front: Option<&'a Front>,
    /// Multiplies the breath's force.
    pub gain: f64,
}

impl Blown<'_> {
    /// Velocity of the breath's air at a point without gusts, and the speed at which it left the lips, m/s.
    #[inline]
    pub(crate) fn air(&self, point: DVec3) -> (DVec3, f64) {
        let Some((x, share)) = self.breath.share(point) else { return (DVec3::ZERO, 0.0) };
        let source = match self.front {
            Some(front) => front.speed_at(x, self.breath.lip_diameter),
            None => self.breath.speed,
        };
        let speed = share * source;
        if speed < STILL_AIR {
            return (DVec3::ZERO, 0.0);
        }
        (self.breath.flow_direction(point) * speed, source)
    }
}

/// What the wind did in one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WindReport {
    /// Sum of all forces, still air's among them, N.
    pub force: DVec3,
    /// The breath's part of it, N.
    pub breath: DVec3,
    /// What the breath's part cannot exceed, N: momentum flow times gain.
    pub bound: f64,
    /// Relative gust in the breath half a metre before the lips, within ±1.
    pub gust: f64,
}

/// A patch as it stands in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Index of its surface.
    pub surface: usize,
    /// Index of the patch on it.
    pub patch: usize,
    /// World, m.
    pub point: DVec3,
    /// Outward normal or direction of the wire, world, unit.
    pub axis: DVec3,
    /// m².
    pub area: f64,
    /// Does it face the lips, and see them?
    pub seen: bool,
}

/// All that feels the wind in an exhibit, and all winds of it.
#[derive(Clone)]
pub struct WindField {
    feelers: Vec<Feeler>,
    weather: Weather,
    occluders: Occluders,
    seed: u64,
    blown: Vec<Vec6>,
    airs: Airs,
    /// Which instructions there are.
    level: Level,
}

impl WindField {
    /// Surfaces, shelters and winds of an exhibit with `bodies` bodies.
    pub fn new(surfaces: &[Surface], shelters: &[Shelter], winds: &[Wind], bodies: usize, seed: u64) -> Self {
        let weather = Weather::new(winds);
        let occluders = Occluders::new(shelters.iter().map(|shelter| (shelter.body, &shelter.mesh)));
        let feeler = |surface| Feeler::new(surface, weather.alike(), weather.len(), &occluders);
        let feelers: Vec<_> = surfaces.iter().map(feeler).collect();
        let most = feelers.iter().map(|feeler| feeler.quads.len() * WIDTH).max().unwrap_or(0);
        Self {
            weather,
            occluders,
            seed,
            blown: vec![[0.0; 6]; bodies],
            airs: Airs::with_capacity(most),
            feelers,
            level: Level::new(),
        }
    }

    /// Adds the wrenches (N, N m about each centre of mass) of all winds at `time` (s since the reset) to `out`.
    pub fn push(&mut self, bodies: &[RigidBody], time: f64, blown: Option<&Blown>, out: &mut [Vec6]) -> WindReport {
        self.weather.turn_to(time);
        if blown.is_some() || !self.weather.is_empty() {
            self.occluders.refit(|body| bodies[body].pose());
        }
        self.blown.fill([0.0; 6]);
        dispatch!(self.level, simd => self.push_in(simd, bodies, blown, out))
    }

    #[inline(always)]
    fn push_in<S: Simd>(
        &mut self,
        simd: S,
        bodies: &[RigidBody],
        blown: Option<&Blown>,
        out: &mut [Vec6],
    ) -> WindReport {
        let still = blown.is_none() && self.weather.is_empty();
        let mut report = WindReport::default();
        let mut pushed = Pushed::default();
        let mut airs = std::mem::take(&mut self.airs);
        for feeler in &self.feelers {
            let body = &bodies[feeler.body];
            // What stands still in still air feels nothing.
            let stands = body.velocity == DVec3::ZERO && body.angular_velocity == DVec3::ZERO;
            if stands && still {
                continue;
            }
            let standing = Standing::new(feeler, body);
            if !still {
                airs.feel(&standing, &self.weather, &self.occluders);
            }
            let blown = blown.filter(|blown| airs.feel_breath(&standing, blown, &self.occluders));
            let air = (!still).then_some(&airs);
            let (own, sum_blown) = self.push_on(simd, &standing, air, blown, &mut pushed);
            for k in 0..6 {
                out[feeler.body][k] += own[k];
                self.blown[feeler.body][k] += sum_blown[k];
            }
            report.force += linear(&own);
        }
        self.airs = airs;
        if let Some(blown) = blown {
            self.push_breath(blown, &pushed, out, &mut report);
        }
        report
    }

    /// Wrenches about its body's centre of mass on the surface that stands like this: of all air but the breath (`None`: it is
    /// still; else of each patch and the part from all sides), and of the breath without bound and gain.
    #[inline(always)]
    fn push_on<S: Simd>(
        &self,
        simd: S,
        standing: &Standing,
        air: Option<&Airs>,
        blown: Option<&Blown>,
        pushed: &mut Pushed,
    ) -> (Vec6, Vec6) {
        let Standing { feeler, body, frame, inward, .. } = *standing;
        let center = body.properties.center;
        let spin = inward * body.angular_velocity;
        let origin = inward * body.velocity - spin.cross(center);
        let solid = feeler.patches.first().is_some_and(|patch| patch.face == Face::Side);
        let beside = blown.filter(|_| solid).map_or(1.0, |blown| 1.0 / blown.gain.max(1.0).sqrt());
        let (mut force, mut moment) = (all(simd, DVec3::ZERO), all(simd, DVec3::ZERO));
        let mut sum_blown = [0.0; 6];
        for (first, quad) in (0..).step_by(WIDTH).zip(&feeler.quads) {
            let calm = -quad.velocities(simd, origin, spin);
            let room = match air {
                None => calm,
                Some(air) => calm + by_lane(simd, |k| inward * air.winds[first + k]),
            };
            let dragged = quad.drag(simd, room);
            force += dragged;
            moment += quad.moments(simd, dragged);
            let (Some(blown), Some(air)) = (blown, air) else { continue };
            let airs = &air.breath[first..first + WIDTH];
            if airs.iter().all(|(_, source)| *source == 0.0) {
                continue;
            }
            let (mut wind, mut before) = (room, dragged);
            if beside < 1.0 {
                wind -= by_lane(simd, |k| (1.0 - beside) * (inward * air.stirred[first + k]));
                before = quad.drag(simd, wind);
            }
            let added = quad.drag(simd, wind + by_lane(simd, |k| inward * airs[k].0)) - before;
            for (k, (_, source)) in airs.iter().enumerate().filter(|(_, (_, source))| *source > 0.0) {
                let patch = &feeler.patches[first + k];
                let added = lane(&added, k);
                let shaken = feeler.shaken(patch, inward * self.eddy(&blown.breath, standing.place(patch).0));
                let added = added + TURBULENCE * added.length() * shaken;
                pushed.total += added.length();
                pushed.fastest = source.max(pushed.fastest);
                add_wrench(&mut sum_blown, patch.point - center, added);
            }
        }
        let force = sum(&force);
        let own = vec6(frame * force, frame * (sum(&moment) - center.cross(force)));
        (own, vec6(frame * linear(&sum_blown), frame * angular(&sum_blown)))
    }

    /// Adds the breath's wrenches, bounded by its momentum.
    fn push_breath(&self, blown: &Blown, pushed: &Pushed, out: &mut [Vec6], report: &mut WindReport) {
        let most = blown.breath.momentum_flow(pushed.fastest);
        let share = blown.gain * if pushed.total > most { most / pushed.total } else { 1.0 };
        for (out, wrench) in out.iter_mut().zip(&self.blown) {
            for k in 0..6 {
                out[k] += share * wrench[k];
            }
            report.breath += share * linear(wrench);
        }
        report.force += report.breath;
        report.bound = blown.gain * most;
        let ahead = blown.breath.mouth + 0.5 * blown.breath.direction;
        report.gust = self.eddy(&blown.breath, ahead).dot(blown.breath.direction);
    }

    /// Velocity at a point of the winds that come from all sides, m/s.
    pub fn stirs(&self, point: DVec3) -> DVec3 {
        self.weather.stirs(point)
    }

    /// Velocity at a point of the breath and of all winds that go somewhere, m/s.
    pub fn streams(&self, blown: Option<&Blown>, point: DVec3) -> DVec3 {
        let winds = (0..self.weather.len()).filter(|&wind| self.weather.upwind(wind).is_some());
        let airs = winds.map(|wind| self.weather.air(wind, point));
        let aimed: DVec3 = airs.filter(|air| air.length_squared() > STILL_AIR * STILL_AIR).sum();
        aimed + blown.map_or(DVec3::ZERO, |blown| self.breath_at(blown, point))
    }

    /// Velocity of the breath's air at a point, gusts included, m/s. Force goes with its square, so half of the force's
    /// turbulence is the air's.
    pub fn breath_at(&self, blown: &Blown, point: DVec3) -> DVec3 {
        let (air, source) = blown.air(point);
        if source <= 0.0 {
            return DVec3::ZERO;
        }
        air + 0.5 * TURBULENCE * air.length() * self.eddy(&blown.breath, point)
    }

    /// Noise of the breath's gusts at a point, shorter than 1: eddies carried downstream.
    fn eddy(&self, breath: &Breath, point: DVec3) -> DVec3 {
        let time = self.weather.time();
        let carried = point - breath.direction * (EDDY_SPEED * time);
        let noise = EDDY_STRENGTH * perlin3_vector(carried / EDDY + DVec3::splat(EDDY_CHANGE * time), self.seed);
        noise / (1.0 + noise.length_squared()).sqrt()
    }

    /// Every patch, and whether it sees the breath.
    pub fn samples(&mut self, bodies: &[RigidBody], breath: &Breath) -> Vec<Sample> {
        self.occluders.refit(|body| bodies[body].pose());
        let mut samples: Vec<Sample> = Vec::new();
        for (surface, feeler) in self.feelers.iter().enumerate() {
            let pose = bodies[feeler.body].pose();
            let first = samples.len();
            samples.extend(feeler.patches.iter().enumerate().map(|(patch, Patch { point, axis, area, .. })| Sample {
                surface,
                patch,
                point: pose.point(*point),
                axis: pose.vector(*axis),
                area: *area,
                seen: false,
            }));
            let own = &samples[first..];
            let lines = own.iter().enumerate().filter_map(|(index, sample)| {
                let from = Upwind::Place(breath.origin(sample.point));
                Some((index, feeler.facing(index, (sample.point, sample.axis), from)?.line()))
            });
            self.airs.sight.take(lines);
            for index in self.airs.sight.open(&self.occluders, feeler.hints(None)) {
                samples[first + index].seen = true;
            }
        }
        samples
    }

    /// How much of what a surface shows towards a place that place sees, 0 … 1, by some of its patches.
    pub fn shown(&mut self, surface: usize, bodies: &[RigidBody], from: DVec3) -> f64 {
        self.occluders.refit(|body| bodies[body].pose());
        let feeler = &self.feelers[surface];
        let pose = bodies[feeler.body].pose();
        let mut faced = 0;
        let some = (0..feeler.patches.len()).step_by(feeler.patches.len().div_ceil(LOOKED_AT));
        let lines = some.filter_map(|index| {
            let patch = &feeler.patches[index];
            let place = (pose.point(patch.point), pose.vector(patch.axis));
            let line = feeler.facing(index, place, Upwind::Place(from))?.line();
            faced += 1;
            Some((index, line))
        });
        self.airs.sight.take(lines);
        let seen = self.airs.sight.open(&self.occluders, feeler.hints(None)).count();
        if faced > 0 { seen as f64 / f64::from(faced) } else { 0.0 }
    }

    /// Patches of all surfaces.
    pub fn patches(&self) -> usize {
        self.feelers.iter().map(|feeler| feeler.patches.len()).sum()
    }

    /// What shelters them, where the bodies are.
    pub fn occluders_at(&mut self, bodies: &[RigidBody]) -> &Occluders {
        self.occluders.refit(|body| bodies[body].pose());
        &self.occluders
    }

    /// What shelters them, as it stood in the last step.
    pub fn occluders(&self) -> &Occluders {
        &self.occluders
    }
}

/// How hard the breath pushes without bound and gain: Σ |F_i|, N, and the fastest air that arrives, m/s.
#[derive(Clone, Copy, Debug, Default)]
struct Pushed {
    total: f64,
    fastest: f64,
}
