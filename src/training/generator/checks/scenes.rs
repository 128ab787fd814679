//! Whole scenes: their labels, and the spread of what they hold.

use soffio_math::StateHash;

use super::super::filter::{highpass, lowpass};
use super::super::noise::RATE;
use super::super::{Scene, scene};
use super::{band, db, quantile, spectra};

/// Seed of the scenes here.
const SEED: u64 = 77;
/// Scenes for the statistics.
const MANY: u64 = 128;
/// Bands of the measured facts, Hz.
const BANDS: [(f64, f64); 7] =
    [(31.0, 94.0), (94.0, 203.0), (203.0, 406.0), (406.0, 812.0), (812.0, 1625.0), (1625.0, 3400.0), (3400.0, 7000.0)];

#[test]
fn the_same_seed_gives_the_same_scene() {
    let hash = |scene: &Scene| {
        let mut hash = StateHash::default();
        let all = scene.capsules.iter().flatten().chain(&scene.air).chain(&scene.over_db).chain(&scene.played);
        all.for_each(|x| hash.add(f64::from(*x)));
        hash
    };
    assert_eq!(hash(&scene(SEED, 3)), hash(&scene(SEED, 3)));
    assert_ne!(hash(&scene(SEED, 3)), hash(&scene(SEED, 4)));
}

#[test]
fn labels_belong_to_the_samples() {
    let mut breaths = 0;
    for index in 0..16 {
        let scene = scene(SEED, index);
        let (samples, ms) = (scene.capsules[0].len(), scene.air.len());
        assert_eq!((scene.capsules.len(), scene.capsules[1].len(), scene.over_db.len()), (2, samples, ms));
        assert_eq!(samples, ms * 16);
        assert!((40_000..=120_000).contains(&ms));
        assert!(scene.played.is_empty() || scene.played.len() == samples);
        assert!(scene.capsules.iter().flatten().chain(&scene.played).all(|x| x.abs() <= 1.0));
        assert!(scene.air.iter().chain(&scene.over_db).all(|x| x.is_finite()));
        // Air belongs to a breath, and a breath's air is where its label says.
        for (i, air) in scene.air.iter().enumerate().filter(|(_, air)| **air >= 0.21) {
            let t = i as f64 * 1e-3;
            let known = scene.breaths.iter().any(|b| t >= b.capsule.0 - 0.01 && t <= b.capsule.1 + 0.01);
            assert!(known, "scene {index}: {air} m/s at {t} s without a label");
        }
        for b in &scene.breaths {
            breaths += 1;
            assert!(b.peak_air < 0.2 || b.capsule.0 >= b.lips.0 && b.capsule.1 > b.capsule.0, "{b:?}");
            // Air never outruns the front of Hill and Ouellette's jet by a wide mouth.
            assert!(b.peak_air <= 1.05 * b.lips_speed);
        }
        if scene.breaths.is_empty() {
            assert!(scene.air.iter().all(|x| *x == 0.0) && scene.over_db.iter().all(|x| *x == -100.0));
        }
    }
    assert!(breaths > 20);
}

/// Falls of the envelope (20 to 200 Hz, 20 ms) below its peak of the last 0.24 s, dB, while the lips blow.
fn falls(scene: &Scene, first: f64, last: f64, out: &mut Vec<f64>) {
    let mut x = scene.capsules[0][(first * RATE) as usize..(last * RATE) as usize].to_vec();
    highpass(20.0, 2).into_iter().chain(lowpass(200.0, 2)).for_each(|filter| filter.run(&mut x));
    let square = |x: &f32| f64::from(*x) * f64::from(*x);
    let parts: Vec<f64> = x.chunks_exact(160).map(|part| part.iter().map(square).sum()).collect();
    let envelope: Vec<f64> = parts.windows(2).map(|two| db(two[0] + two[1] + 1e-12)).collect();
    out.extend(envelope.windows(24).map(|w| w.iter().copied().fold(f64::MIN, f64::max) - w[23]));
}

/// Level over everything else from which an envelope is that of the air alone, dB.
const ALONE_DB: f32 = 20.0;

#[test]
fn breaths_cover_the_spread_of_real_ones() {
    let (mut bands, mut crest) = (vec![Vec::new(); BANDS.len()], Vec::new());
    let (mut without, mut labelled, mut all) = (0, 0.0, 0.0);
    for index in 0..MANY {
        let scene = scene(SEED, index);
        without += u64::from(scene.breaths.is_empty());
        all += scene.air.len() as f64;
        let positive = |(air, over): (&f32, &f32)| *air >= 0.35 && *over >= 3.0;
        labelled += scene.air.iter().zip(&scene.over_db).filter(|x| positive(*x)).count() as f64;
        for b in &scene.breaths {
            // While the lips blow and the air has come, clearly above the rest.
            let (first, last) = (b.capsule.0 + 0.1, b.capsule.1.min(b.lips.1));
            let clear = |ms: usize| scene.over_db[ms] >= 12.0 && scene.air[ms] >= 0.35;
            let times = (first * 1e3) as usize..(last * 1e3) as usize;
            if last - first < 0.4 || times.clone().filter(|ms| clear(*ms)).count() < times.len() * 9 / 10 {
                continue;
            }
            let part = &scene.capsules[0][(first * RATE) as usize..(last * RATE) as usize];
            let (power, _, _) = spectra(part, part);
            let low = band(&power, 31.0, 203.0) + 1e-12;
            for (values, (from, to)) in bands.iter_mut().zip(BANDS) {
                values.push(db(band(&power, from, to) / low + 1e-9));
            }
            // Falls of the air's own envelope: nothing else is near it.
            if times.clone().all(|ms| scene.over_db[ms] >= ALONE_DB) {
                falls(&scene, first, last, &mut crest);
            }
        }
    }
    let share = |values: &mut Vec<f64>, at: f64| quantile(values, at);
    let table: Vec<[f64; 3]> = bands.iter_mut().map(|v| [0.03, 0.5, 0.97].map(|at| share(v, at))).collect();
    let (middle, high) = (quantile(&mut crest, 0.5), quantile(&mut crest, 0.9));
    println!("{} breaths, bands {table:.0?}, fall {middle:.1} and {high:.1} dB", bands[0].len());
    println!("{without} of {MANY} without breath, {:.1} % labelled", 100.0 * labelled / all);
    // Phones of 17 people have −17, 0, −5, −18, −25, −25, −24 dB; a console −3, −3, −6, −8, −12, −19, −29; a microphone
    // at the nose −9, −1, −6, −17, −27, −31, −35. All lie within the scenes' spread.
    let facts = [
        [-17.0, 0.0, -5.0, -18.0, -25.0, -25.0, -24.0],
        [-3.0, -3.0, -6.0, -8.0, -12.0, -19.0, -29.0],
        [-9.0, -1.0, -6.0, -17.0, -27.0, -31.0, -35.0],
    ];
    for fact in facts {
        for (level, [low, _, high]) in fact.iter().zip(&table) {
            assert!(*level >= low - 1.0 && *level <= high + 1.0, "{level} dB is not within {low} … {high}");
        }
    }
    // Recordings have 4.6 dB in the median, and 9 to 12 dB at 90 %.
    assert!((middle - 4.6).abs() < 1.0, "{middle} dB");
    assert!((8.0..14.0).contains(&high), "{high} dB");
    // 45 % are meant; three standard deviations of so few scenes are 19 %.
    assert!((0.26..0.64).contains(&(without as f64 / MANY as f64)), "{without} without breath");
}
