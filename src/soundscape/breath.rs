//! One breath in front of one or two capsules: from the speed at the lips to the pressure at each capsule.
//!
//! ```text
//! lips u₀(t) ─┬→ jet: U(t), u'(t) at each capsule → eddies → stagnation pressure ─┐
//!             │                                  └→ noise of the grille ──────────┼→ pressure at the capsule, Pa
//!             └→ hiss, voice, whistle, 1 / distance ──────────────────────────────┘
//! ```
//!
//! With the lips at the origin and the middle of the capsules at D on z, their spacing s along x, their middle beside the mouth by b, and the axis a of
//! the jet:
//!
//! ```text
//! c = (b ± s/2, 0, D)     a = (sin θ cos φ, sin θ sin φ, cos θ)     x = a · c     r = |c − x a − x w(t)|
//! ```
//!
//! w is the wandering of the aim, in radians. The noise of the grille is that of the edges of its holes, far above the eddies'
//! frequencies. It grows with the cube of the local speed, as a dipole does (Curle, Proc. R. Soc. A 231, 1955).
//!
//! People blow 0.2 to 1.5 litres a second through lips 4 to 14 mm wide: 3 to 20 m/s. The air of a gentle breath needs 0.8 s to
//! 50 cm, that of a hard one 0.2 s.

use soffio_math::noise::{Random, hash_words, perlin1};
use soffio_math::{DVec2, DVec3, cos, sin};

use crate::BreathLabel;
use crate::eddies::{self, Eddies, LocalAir, Port};
use crate::filters::{high_passed, low_passed, normalised, white};
use crate::jet::{Jet, STEPS_A_SECOND, fluctuation_profile, mean_profile, turbulent_share};
use crate::lips;
use crate::microphone::{Microphone, pascals};
pub use crate::people::{HARDEST_M_S, Manner, Person};

/// Von Kármán's length over the distance. With the large structures the integral scale is 0.04 x (Wygnanski and Fiedler 1969).
const LENGTH: f64 = 0.038;
/// Share of structures 0.05 to 0.1 x long, as wide as the jet (Citriniti and George, J. Fluid Mech. 418, 2000: its first modes hold
/// much of the energy).
const LARGE: f64 = 0.15;
/// Least von Kármán's length over the opening, near the lips.
const LENGTH_AT_LIPS: f64 = 0.25;
/// Length of turbulent and of still pieces at the edge, over von Kármán's length.
const BULGE: f64 = 4.0;
/// Fluctuation of still air between bulges over that of turbulent air.
const STILL_PIECE: f64 = 0.3;
/// Noise of the grille at 5 m/s, dB of sound.
const GRILLE_DB: f64 = 67.0;
/// Speed of that level, m/s.
const GRILLE_M_S: f64 = 5.0;
/// Least distance along the axis, m.
const NEAREST_M: f64 = 0.01;
/// Speed on the axis below which there is no air, m/s: what rounding leaves of a mean.
const FORGOTTEN_M_S: f64 = 1e-6;
/// Local speed from which air counts as arrived, m/s; half of the peak for a weaker breath.
pub const ARRIVED_M_S: f64 = 0.35;
/// Fall of the speed that makes a dip of 10 dB in pressure.
const DIP: f64 = 0.562;
/// Length of a dip and the pause between two of them, s.
const DIP_S: ((f64, f64), (f64, f64)) = ((0.05, 0.15), (0.5, 1.2));

/// One breath.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Breath {
    /// Manner.
    pub manner: Manner,
    /// Peak speed at the lips, m/s.
    pub speed: f64,
    /// Diameter of a round opening of the lips' area, m.
    pub opening: f64,
    /// Quiet before, s.
    pub lead_in: f64,
    /// Time to the peak at the lips, s.
    pub attack: f64,
    /// Time near the peak, in which the speed falls by a quarter, s.
    pub hold: f64,
    /// Time from there to zero, s.
    pub release: f64,
    /// Time after, in which the last air arrives, s.
    pub lead_out: f64,
    /// D, from the lips to the middle of the capsules, m.
    pub distance: f64,
    /// θ, mean angle of the aim, degrees.
    pub angle_deg: f64,
    /// φ, azimuth of the aim: 0 along the line of the capsules, degrees.
    pub azimuth_deg: f64,
    /// Wandering of the aim, about its largest angle, degrees.
    pub wander_deg: f64,
    /// Ununsteady of the flow at the lips, 1 for that of most people.
    pub unsteady: f64,
    /// Half-width of the jet over distance.
    pub spread: f64,
    /// s, spacing of two capsules, m; 0 for one capsule.
    pub spacing: f64,
    /// b, of the capsules' middle along their line from where the mouth is straight in front, m: half the spacing for a mouth in front
    /// of one of them.
    pub beside: f64,
    /// Port of the capsules.
    pub port: Port,
    /// Share of the speed that passes foam.
    pub foam: f64,
    /// Deviation of the lips' hiss, dB.
    pub hiss_db: f64,
    /// Deviation of the grille's noise, dB.
    pub grille_db: f64,
    /// Dips of 10 dB for up to 150 ms.
    pub dips: bool,
    /// Level of the room in [`Breath::recorded`], dB of sound.
    pub room_db: f64,
    /// Microphone of [`Breath::recorded`].
    pub microphone: Microphone,
}

impl Default for Breath {
    fn default() -> Self {
        Self {
            manner: Manner::Plain,
            speed: 9.0,
            opening: 0.009,
            lead_in: 1.0,
            attack: 0.12,
            hold: 1.2,
            release: 0.3,
            lead_out: 1.0,
            distance: 0.12,
            angle_deg: 0.0,
            azimuth_deg: 0.0,
            wander_deg: 1.0,
            unsteady: 1.0,
            spread: 0.09,
            spacing: 0.0,
            beside: 0.0,
            port: Port { size: 0.004, steepness: 1.8 },
            foam: 1.0,
            hiss_db: 0.0,
            grille_db: 0.0,
            dips: false,
            room_db: 45.0,
            microphone: Microphone::default(),
        }
    }
}

/// Air and sound of a breath at each capsule.
#[derive(Clone, Debug)]
pub struct Air {
    /// Pressure at each capsule, Pa.
    pub pressure: Vec<Vec<f64>>,
    /// Mean speed at each capsule, m/s, one value a millisecond.
    pub speeds: Vec<Vec<f64>>,
}

impl Breath {
    /// Length, s.
    pub fn duration(&self) -> f64 {
        self.lead_in + self.attack + self.hold + self.release + self.lead_out
    }

    /// u₀(t), m/s, one value a millisecond.
    fn lips(&self, seed: u64) -> Vec<f64> {
        let at = |step: usize| {
            let time = step as f64 / STEPS_A_SECOND - self.lead_in;
            let held = time - self.attack;
            let released = held - self.hold;
            if time <= 0.0 || released >= self.release {
                return 0.0;
            }
            // Lungs empty, and no breath is quite steady.
            let tired = 1.0 - 0.25 * (held / self.hold.max(0.1)).clamp(0.0, 1.0);
            let steady =
                1.0 + self.unsteady * (0.07 * perlin1(3.0 * time, seed) + 0.04 * perlin1(9.0 * time, seed ^ 1));
            let shape = |s: f64| s * s * (3.0 - 2.0 * s);
            let rise = shape((time / self.attack).min(1.0));
            let fall = shape(1.0 - (released / self.release).max(0.0));
            self.speed * rise * fall * tired * steady
        };
        (0..(self.duration() * STEPS_A_SECOND).round() as usize).map(at).collect()
    }

    /// Places of the capsules from the lips, m.
    fn capsules(&self) -> Vec<DVec3> {
        let sides: &[f64] = if self.spacing > 0.0 { &[-0.5, 0.5] } else { &[0.0] };
        sides.iter().map(|side| DVec3::new(self.beside + side * self.spacing, 0.0, self.distance)).collect()
    }

    /// Places of the capsules: along the jet's mean axis, and across it in two directions, m.
    fn places(&self) -> Vec<DVec3> {
        let [angle, azimuth] = [self.angle_deg, self.azimuth_deg].map(f64::to_radians);
        let axis = DVec3::new(sin(angle) * cos(azimuth), sin(angle) * sin(azimuth), cos(angle));
        let (first, second) = axis.any_orthonormal_pair();
        let place = |at: DVec3| DVec3::new(axis.dot(at), first.dot(at), second.dot(at));
        self.capsules().into_iter().map(place).collect()
    }

    /// Mean speed and fluctuation at each capsule.
    fn local_air(&self, lips: &[f64], places: &[DVec3], seed: u64) -> Vec<LocalAir> {
        let jet = Jet { opening: self.opening, spread: self.spread };
        let release = ((self.lead_in + self.attack + self.hold) * STEPS_A_SECOND) as usize;
        let dips = self.dips_over(lips.len(), seed);
        let wander = self.wander_deg.to_radians();
        let air = places.iter().map(|place| {
            let distance = place.x.max(NEAREST_M);
            let axis = jet.arriving(lips, release, distance);
            let axis: Vec<f64> = axis.iter().zip(&dips).map(|(speed, dip)| self.foam * speed * dip).collect();
            let axis = jet.blurred(&axis, distance);
            let mut pieces = Random::new(hash_words(&[seed, 3]));
            let (mut level, mut left) = (0.5, 0.0);
            let mut air = LocalAir::default();
            for (step, &speed) in axis.iter().enumerate() {
                if speed < FORGOTTEN_M_S {
                    air.speed.push(0.0);
                    air.fluctuation.push(0.0);
                    continue;
                }
                let time = step as f64 / STEPS_A_SECOND;
                let aim = [7, 8]
                    .map(|way| wander * perlin1(1.1 * time, seed ^ way) + 0.01 * perlin1(6.0 * time, seed ^ (way + 2)));
                let beside = DVec2::new(place.y - distance * aim[0], place.z - distance * aim[1]).length();
                let offset = jet.offset(beside, distance);
                let (mean, share) = (speed * mean_profile(offset), turbulent_share(offset));
                left -= speed / STEPS_A_SECOND;
                if left < 0.0 {
                    level = pieces.unit();
                    left = 2.0 * pieces.unit() * BULGE * LENGTH * distance;
                }
                let piece = if level < share { 1.0 / share.sqrt() } else { STILL_PIECE };
                air.speed.push(mean);
                air.fluctuation.push(speed * fluctuation_profile(offset) * piece);
            }
            air
        });
        air.collect()
    }

    /// Factor of the speed over time with dips.
    fn dips_over(&self, steps: usize, seed: u64) -> Vec<f64> {
        let mut out = vec![1.0; steps];
        if self.dips {
            let mut random = Random::new(hash_words(&[seed, 4]));
            let mut at = self.lead_in + self.attack + random.range(DIP_S.1.0, DIP_S.1.1);
            while at < self.lead_in + self.attack + self.hold {
                let until = at + random.range(DIP_S.0.0, DIP_S.0.1);
                let [from, end] = [at, until].map(|t| ((t * STEPS_A_SECOND) as usize).min(steps));
                out[from..end].fill(DIP);
                at = until + random.range(DIP_S.1.0, DIP_S.1.1);
            }
        }
        out
    }

    /// Pressure and speed at each capsule at a sample rate (Hz).
    pub fn air(&self, rate: u32, seed: u64) -> Air {
        let r = f64::from(rate);
        let stream = |name: u64| Random::new(hash_words(&[seed, name]));
        let (lips, places) = (self.lips(seed), self.places());
        let air = self.local_air(&lips, &places, seed);
        let length = (LENGTH * places[0].x).max(LENGTH_AT_LIPS * self.opening);
        let eddies = Eddies { length, large: LARGE, port: self.port, places: &places, air: &air };
        let velocities = eddies.velocities(r, &mut stream(1));
        let sound = lips::sound(&lips, self.manner, self.hiss_db, rate, &mut stream(2));
        let (mut pressure, capsules) = (Vec::new(), self.capsules());
        for (capsule, (air, velocity)) in air.iter().zip(&velocities).enumerate() {
            let mut felt = eddies::pressure(&air.speed, velocity, r);
            let edges = white(felt.len(), &mut stream(10 + capsule as u64));
            let edges = normalised(low_passed(high_passed(edges, r, 300.0, 1), r, 4000.0_f64.min(0.4 * r), 1));
            let away = capsules[capsule].length();
            let grille = pascals(GRILLE_DB + self.grille_db) / (GRILLE_M_S * GRILLE_M_S * GRILLE_M_S);
            for (i, p) in felt.iter_mut().enumerate() {
                let speed = air.speed[((i as f64 * STEPS_A_SECOND / r) as usize).min(air.speed.len() - 1)];
                let local = (speed + velocity[i]).abs();
                *p += grille * local * local * local * edges[i] + sound[i] / away;
            }
            pressure.push(felt);
        }
        Air { pressure, speeds: air.into_iter().map(|air| air.speed).collect() }
    }

    /// A recording of the breath in a quiet room by its own microphone: the first capsule, full scale ±1.
    pub fn recorded(&self, rate: u32, seed: u64) -> Vec<f32> {
        self.recorded_by_both(rate, seed).swap_remove(0)
    }

    /// A recording by each capsule.
    pub fn recorded_by_both(&self, rate: u32, seed: u64) -> Vec<Vec<f32>> {
        let r = f64::from(rate);
        let air = self.air(rate, seed);
        let room = white(air.pressure[0].len(), &mut Random::new(hash_words(&[seed, 5])));
        let room = normalised(low_passed(room, r, 1500.0_f64.min(0.4 * r), 1));
        let loud = pascals(self.room_db);
        let record = |(capsule, pressure): (usize, &Vec<f64>)| {
            let microphone = if capsule == 0 { self.microphone } else { self.microphone.second(seed) };
            let sum: Vec<f64> = pressure.iter().zip(&room).map(|(p, n)| p + loud * n).collect();
            microphone.record(&sum, r, hash_words(&[seed, 6, capsule as u64]))
        };
        air.pressure.iter().enumerate().map(record).collect()
    }

    /// Mean speed at each capsule, m/s, one value a millisecond: those of [`Breath::air`], without its sound.
    pub fn speeds(&self, seed: u64) -> Vec<Vec<f64>> {
        let air = self.local_air(&self.lips(seed), &self.places(), seed);
        air.into_iter().map(|air| air.speed).collect()
    }

    /// Label of the breath that begins (with its lead-in) at a time, s, with these speeds at the capsules; its level is unknown yet.
    pub fn label(&self, at: f64, speeds: &[Vec<f64>]) -> BreathLabel {
        let speeds: Vec<f64> =
            (0..speeds[0].len()).map(|step| speeds.iter().map(|speeds| speeds[step]).fold(0.0, f64::max)).collect();
        let peak_speed = speeds.iter().copied().fold(0.0, f64::max);
        let least = ARRIVED_M_S.min(0.5 * peak_speed).max(1e-9);
        let arrived = |step: usize| at + step as f64 / STEPS_A_SECOND;
        let arrival = speeds.iter().position(|u| *u >= least).map_or(at + self.lead_in, arrived);
        let end = speeds.iter().rposition(|u| *u >= least).map_or(arrival, arrived);
        BreathLabel {
            manner: self.manner,
            lips: at + self.lead_in,
            arrival,
            end,
            distance: self.distance,
            peak_speed,
            level_db: 0.0,
            speeds,
            speeds_from: at,
        }
    }
}
