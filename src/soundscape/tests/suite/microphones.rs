//! Microphones: corner and slope of the high-pass, clipping, gain control, noise suppression, sample rates.

use super::{R, RATE, db};
use soffio_math::noise::Random;
use soffio_math::{PI, sin};
use soffio_soundscape::filters::{power, white};
use soffio_soundscape::microphone::{Microphone, pascals, resampled};

fn tone(hz: f64, peak: f64) -> Vec<f64> {
    (0..2 * RATE).map(|i| peak * sin(2.0 * PI * hz * f64::from(i) / R)).collect()
}

/// Gain of the high-pass at a frequency, dB.
fn gain(order: usize, corner: f64, hz: f64) -> f64 {
    let microphone = Microphone { high_pass_hz: corner, order, ..Microphone::default() };
    let (sound, from) = (tone(hz, 1.0), RATE as usize);
    db(power(&microphone.high_passed(&sound, R)[from..])) - db(power(&sound[from..]))
}

#[test]
fn the_high_pass_has_its_corner_and_its_slope() {
    // A tone that does not end with a whole period.
    const EDGE_DB: f64 = 0.3;
    for order in 1..=4 {
        for corner in [60.0, 200.0] {
            let (at, octave) =
                (gain(order, corner, corner), gain(order, corner, 0.25 * corner) - gain(order, corner, 0.125 * corner));
            assert!((at + 3.01).abs() < EDGE_DB, "order {order}: {at} dB at {corner} Hz");
            // 1/(1 + x^2n) at a quarter and an eighth: nearly 6 dB an order.
            assert!((octave - 6.02 * order as f64).abs() < 0.5, "order {order}: {octave} dB an octave");
        }
    }
    assert!(gain(0, 100.0, 30.0).abs() < EDGE_DB);
}

#[test]
fn levels_are_in_pascals_and_full_scale_clips() {
    assert!((pascals(94.0) - 1.0).abs() < 0.003, "{} Pa", pascals(94.0));
    let open = Microphone { order: 0, noise_db: 0.0, full_scale_pa: 10.0, overload_pa: 40.0, ..Microphone::default() };
    let peak = |peak: f64| open.record(&tone(500.0, peak), R, 1).iter().fold(0.0_f32, |top, x| top.max(x.abs()));
    assert!((peak(5.0) - 0.5).abs() < 0.01 && (peak(25.0) - 1.0).abs() < 1e-6);
    // The capsule clips before its high-pass, and louder sound gives no more.
    let quiet = Microphone { full_scale_pa: 1000.0, ..open };
    assert!(quiet.record(&tone(500.0, 400.0), R, 1).iter().all(|x| x.abs() <= 0.0401));
}

#[test]
fn gain_control_levels_and_suppression_takes_steady_noise() {
    let noise: Vec<f64> = white(4 * RATE as usize, &mut Random::new(3)).iter().map(|x| 0.05 * x).collect();
    let rms = |microphone: Microphone, sound: &[f64]| {
        let out = microphone.record(sound, R, 1);
        db(power(&out[2 * RATE as usize..3 * RATE as usize].iter().map(|x| f64::from(*x)).collect::<Vec<_>>()))
    };
    let plain = Microphone { order: 1, full_scale_pa: 1.0, noise_db: 0.0, ..Microphone::default() };
    let controlled = Microphone { gain_control: true, ..plain };
    let louder: Vec<f64> = noise.iter().map(|x| 4.0 * x).collect();
    let (before, after) =
        (rms(plain, &louder) - rms(plain, &noise), rms(controlled, &louder) - rms(controlled, &noise));
    assert!((before - 12.0).abs() < 0.5 && after < 3.0, "{before} dB, and {after} dB with gain control");
    let suppressed = rms(Microphone { suppression: true, ..plain }, &noise) - rms(plain, &noise);
    assert!(suppressed < -6.0, "{suppressed} dB of steady noise");
}

#[test]
fn other_sample_rates_keep_tones_below_their_corner() {
    let samples: Vec<f32> = tone(1000.0, 0.5).iter().map(|x| *x as f32).collect();
    for rate in [8_000_u32, 44_100, 48_000] {
        let out = resampled(&samples, RATE, rate);
        assert!((out.len() as f64 / f64::from(rate) - 2.0).abs() < 1e-3);
        let error = out.iter().enumerate().skip(200).take(out.len() - 400);
        let furthest = error
            .map(|(i, x)| (f64::from(*x) - 0.5 * sin(2.0 * PI * 1000.0 * i as f64 / f64::from(rate))).abs())
            .fold(0.0, f64::max);
        // 64 phases of a filter: an error of half a phase at 1 kHz is 0.3 % of full scale.
        assert!(furthest < 0.01, "{rate} Hz: {furthest}");
    }
    let high: Vec<f32> = tone(6000.0, 0.5).iter().map(|x| *x as f32).collect();
    let aliased = resampled(&high, RATE, 8_000);
    assert!(aliased.iter().skip(200).take(10_000).all(|x| x.abs() < 0.01));
}
