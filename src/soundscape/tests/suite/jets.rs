//! The jet of a breath: fall with distance, width, travel, spectrum, two capsules.

use super::{R, RATE, bare, db, fine_limits, part, steady_power};
use soffio_fourier::{Complex, real_forward};
use soffio_math::noise::Random;
use soffio_math::{PI, cos};
use soffio_soundscape::breath::{Breath, Manner, Person};
use soffio_soundscape::filters::power;
use soffio_soundscape::jet::{INTENSITY, Jet, fluctuation_profile, mean_profile, turbulent_share};
use soffio_soundscape::level::band_powers;
use soffio_soundscape::statistics::quantile;

#[test]
fn pressure_falls_with_the_square_of_the_distance() {
    // 40 lg 3.6 = 22.3 dB; scatter of six breaths of some seconds, whose slowest eddies last a tenth of a second.
    const SCATTER_DB: f64 = 2.0;
    let fall = db(steady_power(&bare(0.10))) - db(steady_power(&bare(0.36)));
    assert!((fall - 22.3).abs() < SCATTER_DB, "{fall} dB from 10 to 36 cm");
}

#[test]
fn the_speed_halves_five_degrees_off_the_axis() {
    const EXACT: f64 = 1e-9;
    assert!((mean_profile(1.0) - 0.5).abs() < EXACT);
    // Hussein et al. 1994 and Wygnanski and Fiedler 1969: 0.25 at the half-width, a third of the axis at r = 0.16 x.
    assert!((0.22..0.27).contains(&fluctuation_profile(1.0)) && (0.07..0.13).contains(&fluctuation_profile(1.8)));
    assert!(turbulent_share(0.8) > 0.95 && (0.4..0.6).contains(&turbulent_share(1.85)) && turbulent_share(2.6) < 0.1);
    let jet = Jet { opening: 0.008, spread: 0.09 };
    // 0.09 x is 5.1 degrees.
    let beside = soffio_math::sin(5.14_f64.to_radians()) / soffio_math::cos(5.14_f64.to_radians());
    assert!((jet.offset(beside * 0.3, 0.3) - 1.0).abs() < 0.01, "{}", jet.offset(beside * 0.3, 0.3));
    // Twice as far the speed is half; near the lips it is that of the lips.
    assert!((jet.axis_speed(9.0, 0.2) / jet.axis_speed(9.0, 0.4) - 2.0).abs() < EXACT);
    assert!((jet.axis_speed(9.0, 0.01) - 9.0).abs() < EXACT);
}

#[test]
fn eddies_have_the_fluctuation_of_the_jet() {
    // The pressure is ρ U u to first order; u²/2 adds 0.27²/2 of its power, and the wander of half a degree a little.
    const SCATTER: std::ops::Range<f64> = 0.85..1.25;
    let breath = Breath { unsteady: 0.0, ..bare(0.15) };
    let air = breath.air(RATE, 3);
    let speed = quantile(&air.speeds[0][2300..5000], 0.5);
    let rms = steady_power(&breath).sqrt();
    let ratio = rms / (1.2 * INTENSITY * speed * speed);
    assert!(SCATTER.contains(&ratio), "{ratio} of ρ U u' with U = {speed} m/s");
}

#[test]
fn the_air_needs_a_tenth_of_a_second_to_a_second() {
    // Sangras et al. 2002: x = 2.95 J^¼ √t, here with u₀ = 9 m/s and D = 9 mm, so √J = 0.0718 m²/s.
    let jet = Jet { opening: 0.009, spread: 0.09 };
    let front = |t: f64| 2.95 * 0.0718_f64.sqrt() * t.sqrt();
    for t in [0.05, 0.2, 0.5] {
        assert!((jet.travel(9.0, front(t)) / t - 1.0).abs() < 0.01, "{} s, not {t}", jet.travel(9.0, front(t)));
    }
    let mut random = Random::new(4);
    for (i, person) in
        [Person::Adult, Person::Child, Person::Adult, Person::Child, Person::Adult].into_iter().enumerate()
    {
        for (near, far, times) in [(0.30, 0.32, 0.08..0.9), (0.48, 0.50, 0.15..1.6)] {
            let breath = Breath { angle_deg: 0.0, ..Breath::random(Manner::Plain, person, (near, far), &mut random) };
            let label = breath.label(0.0, &breath.speeds(i as u64));
            let travel = label.arrival - label.lips;
            assert!(times.contains(&travel), "{travel} s to {near} m at {} m/s", breath.speed);
            // The last air arrives after the lips have closed.
            assert!(label.end > breath.attack + breath.hold, "{label:?}");
        }
    }
}

/// Frequency below which half of the power of the steady part lies, Hz; and the share below 60 Hz.
fn spectrum(breath: &Breath) -> (f64, f64) {
    let limits = fine_limits();
    let mut powers = vec![0.0; limits.len() - 1];
    for seed in 0..6 {
        let steady = part(&breath.air(RATE, seed).pressure[0], 2.3, 5.0);
        band_powers(&steady, R, &limits).iter().zip(&mut powers).for_each(|(p, sum)| *sum += p);
    }
    let whole: f64 = powers.iter().sum();
    let mut left = 0.5 * whole;
    let half = powers.iter().position(|p| {
        left -= p;
        left < 0.0
    });
    let low: f64 = limits.windows(2).zip(&powers).filter(|(pair, _)| pair[1] <= 60.0).map(|(_, p)| p).sum();
    (half.map_or(f64::NAN, |i| limits[i]), low / whole)
}

#[test]
fn the_corner_follows_the_local_speed() {
    // Bands of a sixth of an octave above a resolution of 8 Hz, which is coarse below 40 Hz.
    const COARSE: std::ops::Range<f64> = 0.7..1.4;
    let at = |distance: f64, speed: f64| spectrum(&Breath { speed, ..bare(distance) }).0;
    let (near, middle, fast) = (at(0.08, 9.0), at(0.16, 9.0), at(0.16, 18.0));
    // U / L falls with the square of the distance, and grows with the speed.
    assert!(COARSE.contains(&(near / middle / 4.0)), "{near} and {middle} Hz");
    assert!(COARSE.contains(&(fast / middle / 2.0)), "{fast} and {middle} Hz");
    let (_, low) = spectrum(&Breath { port: Breath::default().port, ..bare(0.5) });
    assert!(low > 0.85, "{low} of a breath at 50 cm lies below 60 Hz");
}

#[test]
fn the_spectrum_falls_faster_than_the_inertial_range_behind_a_port() {
    // Levels of octaves: −2 dB each in the inertial range (f^−5/3), and 6 n more above the port's corner.
    let fall = |breath: &Breath| {
        let (mut low, mut high) = (0.0, 0.0);
        for seed in 0..6 {
            let powers = band_powers(&part(&breath.air(RATE, seed).pressure[0], 2.3, 5.0), R, &[500.0, 1000.0, 2000.0]);
            low += powers[0];
            high += powers[1];
        }
        db(low) - db(high)
    };
    let open = fall(&bare(0.10));
    assert!((1.0..4.5).contains(&open), "{open} dB an octave");
    let screened = Breath { port: soffio_soundscape::eddies::Port { size: 0.01, steepness: 1.5 }, ..bare(0.10) };
    let screened = fall(&screened);
    assert!((9.0..13.0).contains(&screened), "{screened} dB an octave");
}

/// Coherence of two capsules in a band, Hz, over the steady part of some breaths.
fn coherence(breath: &Breath, (from, until): (f64, f64)) -> f64 {
    const SIZE: usize = 4096;
    let transform = real_forward(SIZE);
    let window: Vec<f64> = (0..SIZE).map(|i| 0.5 - 0.5 * cos(2.0 * PI * i as f64 / SIZE as f64)).collect();
    let bins = (from * SIZE as f64 / R) as usize..=(until * SIZE as f64 / R) as usize;
    let spectrum = |samples: &[f64]| {
        let mut frame: Vec<f64> = samples.iter().zip(&window).map(|(x, w)| x * w).collect();
        let mut out = transform.make_output_vec();
        transform.process(&mut frame, &mut out).expect("the plan's lengths");
        out
    };
    let mut sums: Vec<(f64, f64, Complex<f64>)> = vec![(0.0, 0.0, Complex::ZERO); SIZE];
    for seed in 0..10 {
        let air = breath.air(RATE, seed);
        let [a, b] = [0, 1].map(|capsule| part(&air.pressure[capsule], 1.8, 5.0));
        for start in (0..a.len() - SIZE).step_by(SIZE / 2) {
            let (x, y) = (spectrum(&a[start..start + SIZE]), spectrum(&b[start..start + SIZE]));
            for bin in bins.clone() {
                let sum = &mut sums[bin];
                *sum = (sum.0 + x[bin].norm_sqr(), sum.1 + y[bin].norm_sqr(), sum.2 + x[bin] * y[bin].conj());
            }
        }
    }
    let values: Vec<f64> = bins.map(|bin| sums[bin].2.norm_sqr() / (sums[bin].0 * sums[bin].1)).collect();
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn two_capsules_share_the_low_frequencies_of_near_eddies_only() {
    // Some hundred frames, of which half are independent, leave a coherence of a fiftieth.
    const NONE: f64 = 0.05;
    let at = |spacing: f64, band| coherence(&Breath { spacing, azimuth_deg: 90.0, ..bare(0.25) }, band);
    let low = |spacing: f64| at(spacing, (4.0, 12.0));
    let values = [0.005, 0.01, 0.02, 0.10].map(low);
    assert!(values.windows(2).all(|pair| pair[0] > pair[1]), "{values:?}");
    // Eddies are 5 to 25 mm wide there; 10 cm are more than the whole jet.
    assert!(values[0] > 0.6 && values[2] > 2.0 * NONE && values[3] < NONE, "{values:?}");
    // An eddy of the size l passes in l / U, so what is fast is small.
    let (near, fast) = (at(0.01, (16.0, 40.0)), at(0.01, (100.0, 200.0)));
    assert!(near < values[1] && fast < near && fast < NONE, "{} at 8 Hz, {near} at 30 Hz, {fast} at 150 Hz", values[1]);
}

#[test]
fn the_hiss_reaches_both_capsules_alike_and_falls_with_distance() {
    let hiss = |distance: f64| {
        let breath = Breath {
            hiss_db: 30.0,
            spacing: 0.04,
            port: soffio_soundscape::eddies::Port { size: 0.02, steepness: 2.0 },
            ..bare(distance)
        };
        let air = breath.air(RATE, 2);
        let steady = [0, 1].map(|capsule| part(&air.pressure[capsule], 2.3, 5.0));
        steady.map(|x| band_powers(&x, R, &[1500.0, 6000.0])[0])
    };
    let (near, far) = (hiss(0.25), hiss(0.5));
    assert!((db(near[0]) - db(near[1])).abs() < 0.5, "{near:?}");
    assert!((db(near[0]) - db(far[0]) - 6.0).abs() < 1.0, "{near:?} and {far:?}");
}

#[test]
fn the_same_seed_gives_the_same_samples() {
    let breath = Breath { spacing: 0.03, hold: 0.4, ..Breath::default() };
    let [one, two, other] = [7, 7, 8].map(|seed| breath.recorded_by_both(RATE, seed));
    assert!(one == two && one != other);
    assert!(power(&one[0].iter().map(|x| f64::from(*x)).collect::<Vec<_>>()) > 1e-6);
}
