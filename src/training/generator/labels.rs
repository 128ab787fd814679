//! Level of a breath's air over everything else, as a target of the training.
//!
//! Both parts of the first capsule's signal, after the linear filters of the microphone, are transformed in windows of
//! 128 ms every 32 ms (Hann; their effective length is 85 ms, so levels are means over about 100 ms). In each octave
//! between 27 and 3400 Hz the ratio of the powers is taken, and the best octave counts. Between windows the level is
//! straight in dB.

use soffio_math::{PI, cos, log10};

use super::noise::{RATE, Workshop};

/// Window, samples.
const WINDOW: usize = 2048;
/// Windows follow each other by this, samples.
const HOP: usize = 512;
/// Upper end of the highest octave, Hz.
const TOP: f64 = 3400.0;
/// Octaves.
const OCTAVES: usize = 7;
/// Without a breath, dB.
const NOTHING: f32 = -100.0;
/// Power of the last rounding to 16 bits and its dither, full scale 1: two uniform errors of one step.
const ROUNDING: f64 = 2.0 / 12.0 / (32_768.0 * 32_768.0);
/// Mean square of the window.
const WINDOW_POWER: f64 = 0.375;

/// Level over everything else, dB, at each of `count` milliseconds.
pub(super) fn over_db(workshop: &mut Workshop, breath: &[f32], other: &[f32], count: usize) -> Vec<f32> {
    let forward = workshop.plan(WINDOW).0;
    let window: Vec<f64> = (0..WINDOW).map(|i| 0.5 - 0.5 * cos(2.0 * PI * i as f64 / WINDOW as f64)).collect();
    let (mut time, mut bins) = (vec![0.0; WINDOW], forward.make_output_vec());
    let mut octaves = |samples: &[f32], centre: usize| {
        let start = centre as isize - (WINDOW / 2) as isize;
        for (i, t) in time.iter_mut().enumerate() {
            let at = start + i as isize;
            let x = if at < 0 { 0.0 } else { samples.get(at as usize).map_or(0.0, |x| f64::from(*x)) };
            *t = x * window[i];
        }
        forward.process(&mut time, &mut bins).expect("both lengths are the plan's");
        let bin = RATE / WINDOW as f64;
        let mut top = TOP / bin;
        let mut powers = [0.0; OCTAVES];
        for power in &mut powers {
            let (from, to) = ((0.5 * top).ceil() as usize, top.ceil() as usize);
            *power = bins[from..to].iter().map(|b| b.norm_sqr()).sum::<f64>() / (WINDOW * WINDOW) as f64;
            top *= 0.5;
        }
        powers
    };
    let centres = breath.len() / HOP + 1;
    let levels: Vec<f32> = (0..centres)
        .map(|i| {
            let centre = i * HOP;
            let near = centre.saturating_sub(WINDOW / 2)..(centre + WINDOW / 2).min(breath.len());
            if breath[near].iter().all(|x| x.abs() < 1e-7) {
                return NOTHING;
            }
            let (ours, rest) = (octaves(breath, centre), octaves(other, centre));
            // The rounding is white: an octave has the share of its bins.
            let mut rounding = ROUNDING * WINDOW_POWER * 0.5 * TOP / RATE;
            let mut best = 0.0_f64;
            for (a, b) in ours.iter().zip(&rest) {
                best = best.max(a / (b + rounding));
                rounding *= 0.5;
            }
            (10.0 * log10(best + 1e-10)) as f32
        })
        .collect();
    (0..count)
        .map(|ms| {
            let x = ms as f64 * RATE / 1000.0 / HOP as f64;
            let (i, t) = (x as usize, (x - x.floor()) as f32);
            let (a, b) = (levels[i.min(centres - 1)], levels[(i + 1).min(centres - 1)]);
            a + t * (b - a)
        })
        .collect()
}
