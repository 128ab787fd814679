//! Draughts: level over speed, corner over speed and length, coherence by direction.

use super::{R, RATE, db, part};
use soffio_soundscape::draught::Draught;
use soffio_soundscape::eddies::Port;
use soffio_soundscape::filters::power;
use soffio_soundscape::level::band_powers;

/// Length, s.
const SECONDS: f64 = 60.0;

fn draught(speed: f64, length: f64) -> Draught {
    let port = Port { size: 0.002, steepness: 1.0 };
    Draught { speed, length, intensity: 0.4, spacing: 0.0, direction_deg: 90.0, port }
}

fn heard(draught: &Draught) -> Vec<f64> {
    part(&draught.pressure(SECONDS, RATE, 5)[0], 1.0, SECONDS)
}

#[test]
fn pressure_grows_with_the_square_of_the_speed() {
    // 12 dB; slow eddies make a minute a short time, and the share of the gusts is that of the mean.
    const SCATTER_DB: f64 = 2.5;
    let rise = db(power(&heard(&draught(0.6, 0.05)))) - db(power(&heard(&draught(0.3, 0.05))));
    assert!((rise - 12.0).abs() < SCATTER_DB, "{rise} dB");
    // A draught of 0.3 m/s is far below a breath: ρ I U² = 0.04 Pa, 67 dB.
    let level = db(power(&heard(&draught(0.3, 0.05))) / 4e-10);
    assert!((60.0..72.0).contains(&level), "{level} dB of sound");
}

#[test]
fn long_eddies_are_low() {
    let audible = |length: f64| {
        let sound = heard(&draught(0.4, length));
        db(band_powers(&sound, R, &[31.0, 203.0])[0] / power(&sound))
    };
    let levels = [0.02, 0.1, 0.5].map(audible);
    // L^(−2/3) in the inertial range: 4.7 dB for a factor of five.
    assert!(levels.windows(2).all(|pair| (3.0..9.0).contains(&(pair[0] - pair[1]))), "{levels:?} dB");
}
