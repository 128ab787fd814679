//! Draughts on the capsule: air that drifts through the room, for minutes.
//!
//! ```text
//! U(t) = U₀ max(0, 1 + G n(t / T)),   u' = I U       n: smooth noise of about ±1; eddies of von Kármán's length L
//! ```
//!
//! Air in rooms drifts with 0.05 to 0.6 m/s and fluctuates by 20 to 60 % (Melikov, Krüger, Zhou, Madsen and Langkilde, Indoor Air 7,
//! 1997; ISO 7730). Its integral scale is 0.05 to 0.5 m; behind grilles and door cracks it is centimetres.

use soffio_math::noise::{Random, hash_words, perlin1};
use soffio_math::{DVec3, cos, sin};

use crate::eddies::{self, Eddies, LocalAir, Port};
use crate::jet::STEPS_A_SECOND;

/// Slow changes of the speed: their share, and their periods, s.
const GUSTS: (f64, (f64, f64)) = (0.35, (4.0, 20.0));

/// A draught.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Draught {
    /// U₀, mean speed, m/s.
    pub speed: f64,
    /// L, von Kármán's length of its eddies, m.
    pub length: f64,
    /// I, fluctuation over mean speed.
    pub intensity: f64,
    /// Spacing of two capsules, m; 0 for one capsule.
    pub spacing: f64,
    /// Direction against the line of the capsules, degrees.
    pub direction_deg: f64,
    /// Port of the capsules.
    pub port: Port,
}

impl Draught {
    /// A draught of a speed (m/s) and a length (m) with random other properties.
    pub fn random(speed: f64, length: f64, spacing: f64, random: &mut Random) -> Self {
        Self {
            speed,
            length,
            intensity: random.range(0.2, 0.6),
            spacing,
            direction_deg: random.range(0.0, 180.0),
            port: Port { size: random.range(0.004, 0.02), steepness: random.range(1.1, 2.0) },
        }
    }

    /// Pressure at each capsule over some seconds, Pa, at a sample rate (Hz).
    pub fn pressure(&self, seconds: f64, rate: u32, seed: u64) -> Vec<Vec<f64>> {
        let mut random = Random::new(hash_words(&[seed, 0x6472_6166]));
        let (period, gusts) = (random.range(GUSTS.1.0, GUSTS.1.1), random.word());
        let at = |step: usize| {
            let time = step as f64 / STEPS_A_SECOND;
            self.speed * (1.0 + GUSTS.0 * 1.5 * perlin1(time / period, gusts)).max(0.0)
        };
        let speed: Vec<f64> = (0..(seconds * STEPS_A_SECOND) as usize).map(at).collect();
        let fluctuation = speed.iter().map(|u| self.intensity * u).collect();
        let turn = self.direction_deg.to_radians();
        let sides: &[f64] = if self.spacing > 0.0 { &[-0.5, 0.5] } else { &[0.0] };
        let place = |side: &f64| self.spacing * side * DVec3::new(cos(turn), sin(turn), 0.0);
        let places: Vec<DVec3> = sides.iter().map(place).collect();
        let air = vec![LocalAir { speed, fluctuation }; places.len()];
        let eddies = Eddies { length: self.length, large: 0.0, port: self.port, places: &places, air: &air };
        let velocities = eddies.velocities(f64::from(rate), &mut random);
        velocities.iter().map(|velocity| eddies::pressure(&air[0].speed, velocity, f64::from(rate))).collect()
    }
}
