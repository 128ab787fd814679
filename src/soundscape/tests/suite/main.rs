//! The sounds against measured jets, wind noise, microphones and breaths.

mod draughts;
mod jets;
mod microphones;
mod recordings;

use soffio_math::{log10, pow};
use soffio_soundscape::breath::Breath;
use soffio_soundscape::eddies::Port;
use soffio_soundscape::filters::power;

/// Sample rate, Hz.
pub const RATE: u32 = 16_000;
/// The same.
pub const R: f64 = RATE as f64;

/// Power in dB.
pub fn db(power: f64) -> f64 {
    10.0 * log10(power.max(1e-30))
}

/// A long breath without hiss, straight at a small port.
pub fn bare(distance: f64) -> Breath {
    Breath {
        distance,
        hold: 4.0,
        hiss_db: -90.0,
        grille_db: -90.0,
        wander_deg: 0.0,
        port: Port { size: 0.0005, steepness: 1.0 },
        ..Breath::default()
    }
}

/// Fluctuation of a signal about its mean between two times, s.
pub fn part(samples: &[f64], from: f64, until: f64) -> Vec<f64> {
    let part = &samples[(from * R) as usize..((until * R) as usize).min(samples.len())];
    let mean = part.iter().sum::<f64>() / part.len() as f64;
    part.iter().map(|x| x - mean).collect()
}

/// Mean power of the steady part of some breaths at a capsule.
pub fn steady_power(breath: &Breath) -> f64 {
    const SEEDS: u64 = 6;
    let one = |seed: u64| power(&part(&breath.air(RATE, seed).pressure[0], 2.3, 5.0));
    (0..SEEDS).map(one).sum::<f64>() / SEEDS as f64
}

/// Limits of bands, six in an octave, Hz.
pub fn fine_limits() -> Vec<f64> {
    (0..64).map(|i| 4.0 * pow(2.0, f64::from(i) / 6.0)).collect()
}
