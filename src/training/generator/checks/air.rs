//! The jet and its turbulence.

use soffio_fourier::Complex;
use soffio_math::exp;
use soffio_math::noise::Random;

use super::super::breath::{Aim, at_capsules};
use super::super::jet::{STEP, centre_line, half_radius, steady};
use super::super::noise::{RATE, Workshop};
use super::super::turbulence::{Air, Port, pressure};
use super::{Spectra, WINDOW, band, db, fluctuation, spectra};

/// A bare port of 2 mm, of the slope 2 that lies between both laws.
const PORT: Port =
    Port { coefficient: 0.8, slope: 2.0, size: 0.002, wake: (0.003, 0.0), foam: 0.0, spacing: 0.03, decay: 10.0 };
/// A mouth of 8 mm.
const MOUTH: f64 = 0.008;
/// Steps until a jet to 50 cm is steady, 2 s.
const SETTLED: usize = 1000;

fn straight(distance: f64, off: f64) -> Aim {
    Aim { distance, off: (off, 0.0), wander: (0.0, 0.5), lag: 0.0, scale: 0.085 }
}

/// Air and pressure of a steady breath of `seconds` s on the first capsule, after the front.
fn steady_breath(lips: f64, aim: &Aim, seconds: f64) -> (Air, Vec<f32>) {
    let mut random = Random::new(17);
    let speeds = vec![lips; SETTLED + (seconds / STEP) as usize];
    let (mut air, _) = at_capsules(&mut random, &speeds, MOUTH, aim, PORT.spacing);
    for envelope in air.speed.iter_mut().chain(&mut air.eddies).chain([&mut air.carrier]) {
        envelope.truncate(speeds.len());
        envelope.drain(..SETTLED);
    }
    let [first, _] = pressure(&mut Workshop::default(), &mut random, &air, &PORT);
    (air, first)
}

#[test]
fn the_steady_jet_decays_as_one_over_x() {
    for (lips, x) in [(4.0, 0.2), (10.0, 0.3), (20.0, 0.5)] {
        let expected = 6.0 * MOUTH * lips / x;
        // The joint with the core costs a percent at ten diameters' distance.
        assert!((steady(lips, MOUTH, x) / expected - 1.0).abs() < 0.02);
        let late = centre_line(&vec![lips; 4 * SETTLED], MOUTH, x)[3 * SETTLED];
        assert!((late / expected - 1.0).abs() < 0.03, "{late} m/s is not {expected}");
    }
    // At the lips it is as fast as there.
    assert!((steady(9.0, MOUTH, 0.01) - 9.0).abs() < 0.1);
}

#[test]
fn the_front_needs_its_time() {
    for (lips, x) in [(6.0, 0.15), (10.0, 0.3), (10.0, 0.5), (25.0, 0.6)] {
        let speeds = centre_line(&vec![lips; 3 * SETTLED], MOUTH, x);
        let half = 0.5 * steady(lips, MOUTH, x);
        let arrived = speeds.iter().position(|u| *u > half).expect("it arrives") as f64 * STEP;
        // Hill and Ouellette (1999). The smearing delays the half by about two times 0.2 x/u.
        let front = x * x / (7.98 * lips * MOUTH);
        println!("{lips} m/s need {arrived:.2} s to {x} m, the front {front:.2} s");
        let smearing = (0.4 * x / (2.0 * half)).min(0.3);
        assert!(arrived > 0.9 * front && arrived < front + smearing + 0.02, "{arrived} s, the front {front} s");
    }
}

#[test]
fn the_end_arrives_later_and_fades() {
    let (lips, x) = (10.0, 0.3);
    let mut envelope = vec![lips; 2 * SETTLED];
    let end = envelope.len();
    envelope.extend([0.0; 10]);
    let speeds = centre_line(&envelope, MOUTH, x);
    // The fan u = x/(4 β t) after the end; smearing keeps it up to a quarter higher.
    let t = 0.5;
    let fan = x / (4.0 * 0.66 * t);
    let there = speeds[end + (t / STEP) as usize];
    assert!(there > 0.95 * fan && there < 1.4 * fan, "{there} m/s is not {fan}");
    let last = speeds.last().expect("speeds");
    assert!(*last < 0.15, "still {last} m/s");
}

#[test]
fn the_mean_profile_keeps_its_width_although_it_meanders() {
    let x = 0.3;
    let mean = |r: f64| {
        let (air, _) = steady_breath(12.0, &straight(x, r / x), 30.0);
        air.speed[0].iter().sum::<f64>() / air.speed[0].len() as f64
    };
    let (axis, half) = (mean(0.0), mean(half_radius(x, MOUTH)));
    // 30 s hold some 50 of the large eddies.
    assert!((half / axis - 0.5).abs() < 0.06, "at the half radius it has {}", half / axis);
}

#[test]
fn turbulence_is_a_quarter_on_the_axis_and_more_at_the_edge() {
    let x = 0.2;
    let intensity = |r: f64| {
        let (air, _) = steady_breath(12.0, &straight(x, r / x), 20.0);
        let mean = air.speed[0].iter().sum::<f64>() / air.speed[0].len() as f64;
        let large = fluctuation(air.speed[0].iter().copied());
        let small = air.eddies[0].iter().sum::<f64>() / air.eddies[0].len() as f64;
        (large * large + small * small).sqrt() / mean
    };
    let (axis, edge) = (intensity(0.0), intensity(1.5 * half_radius(x, MOUTH)));
    println!("intensity {axis:.2} on the axis, {edge:.2} at the edge");
    assert!((0.24..0.31).contains(&axis), "{axis}");
    assert!(edge > 2.0 * axis, "{edge}");
}

#[test]
fn pressure_falls_by_22_db_from_10_to_36_cm() {
    let level = |x: f64| {
        let (_, p) = steady_breath(10.0, &straight(x, 0.0), 20.0);
        20.0 * soffio_math::log10(fluctuation(p.iter().map(|p| f64::from(*p))))
    };
    let fall = level(0.10) - level(0.36);
    println!("from 10 to 36 cm the pressure falls by {fall:.1} dB");
    assert!((fall - 22.0).abs() < 2.0, "{fall} dB");
}

#[test]
fn the_spectrum_follows_the_local_speed() {
    // 90 % of the power lies below this, Hz; from 30 s on.
    let edge = |x: f64| {
        let (_, p) = steady_breath(10.0, &straight(x, 0.0), 30.0);
        let (power, _, _) = spectra(&p, &p);
        let all = band(&power, 4.0, 8000.0);
        let bin = RATE / WINDOW as f64;
        (1..WINDOW).map(|k| k as f64 * bin).find(|f| band(&power, 4.0, *f) > 0.9 * all).expect("an edge")
    };
    let (near, far) = (edge(0.1), edge(0.5));
    println!("90 % of the power lies below {near:.0} Hz at 10 cm, {far:.0} Hz at 50 cm");
    assert!(far < 60.0, "{far} Hz at 50 cm");
    // U/L falls by 25. Windows of 128 ms do not resolve the lowest frequencies at 50 cm, so the ratio looks smaller.
    assert!(near > 8.0 * far, "{near} and {far} Hz");
}

#[test]
fn two_capsules_share_large_eddies_only() {
    // Steady air, so only the eddies are compared; eight tables of 8 s.
    let (u, l, n) = (3.0, 0.03, 4000);
    let air = Air {
        speed: [vec![u; n], vec![u; n]],
        eddies: [vec![0.05 * u; n], vec![0.05 * u; n]],
        carrier: vec![u; n],
        scale: l,
        lag: 0.0,
    };
    let port = Port { spacing: 0.012, ..PORT };
    let runs: Vec<_> = (0..8)
        .map(|seed| {
            let [a, b] = pressure(&mut Workshop::default(), &mut Random::new(seed), &air, &port);
            spectra(&a, &b)
        })
        .collect();
    for k in [2, 5, 10, 20] {
        let power = |of: fn(&Spectra) -> &Vec<f64>| runs.iter().map(|run| of(run)[k]).sum::<f64>();
        let common: Complex<f64> = runs.iter().map(|run| run.2[k]).sum();
        let gamma = common.norm() / (power(|run| &run.0) * power(|run| &run.1)).sqrt();
        let f = k as f64 * RATE / WINDOW as f64;
        let (along, across) = (f / u * port.spacing, 0.12 * port.spacing / l);
        let expected = exp(-port.decay * (along * along + across * across).sqrt());
        println!("coherence {gamma:.2} at {f:.0} Hz, expected {expected:.2}");
        // 500 independent windows: the estimate errs by about 0.05.
        assert!((gamma - expected).abs() < 0.1, "{gamma} at {f} Hz, not {expected}");
    }
}

#[test]
fn a_foam_takes_most_of_the_pressure() {
    let air = |_| vec![2.0; 2000];
    let air = Air {
        speed: [0, 1].map(air),
        eddies: [vec![0.5; 2000], vec![0.5; 2000]],
        carrier: vec![2.0; 2000],
        scale: 0.02,
        lag: 0.0,
    };
    let level = |port: &Port| {
        let [p, _] = pressure(&mut Workshop::default(), &mut Random::new(5), &air, port);
        let (power, _, _) = spectra(&p, &p);
        [db(band(&power, 5.0, 30.0)), db(band(&power, 200.0, 400.0))]
    };
    let (bare, foam) = (level(&PORT), level(&Port { foam: 0.03, ..PORT }));
    assert!(bare[0] - foam[0] > 8.0 && bare[1] - foam[1] > bare[0] - foam[0] + 3.0, "{bare:?} {foam:?}");
}
