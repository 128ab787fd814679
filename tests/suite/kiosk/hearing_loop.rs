//! The second output: the same sound at another clock, and a first one that does not notice.

use std::sync::Arc;

use assert_no_alloc::assert_no_alloc;
use soffio_devices::audio::hearing_loop::{self, HearingLoop};
use soffio_devices::audio::output::{self, Player, SynthInstaller};
use soffio_devices::audio::{Knobs, Utterance};
use soffio_math::{PI, cos, sin};

const RATE: u32 = 48_000;
const BLOCK: usize = 480;
/// A tone that both outputs play, Hz.
const TONE: f64 = 440.0;
/// Greatest sample of what is said.
const LOUD: f64 = 0.5;

/// A loudspeaker that says a tone for so long, at this volume.
fn speaking(volume: f32, seconds: f64) -> (Player, SynthInstaller, Arc<Knobs>) {
    let knobs = Arc::new(Knobs::new(volume));
    let (player, mut voice, workshop) = output::open(RATE, 2, knobs.clone());
    let sample = |i: usize| (LOUD * sin(2.0 * PI * TONE * i as f64 / f64::from(RATE))) as f32;
    let samples = (0..(seconds * f64::from(RATE)) as usize).map(sample).collect();
    voice.say(&Utterance { samples, sample_rate: RATE });
    (player, workshop, knobs)
}

/// Runs both devices side by side for some seconds; the second one's crystal is so much faster. What both played: the first
/// one's stereo, the second one's mono.
fn side_by_side(
    player: &mut Player,
    hearing_loop: &mut HearingLoop,
    rate: u32,
    drift: f64,
    seconds: f64,
) -> [Vec<f32>; 2] {
    let (mut first, mut second, mut due) = (Vec::new(), Vec::new(), 0.0);
    for _ in 0..(seconds * f64::from(RATE)) as usize / BLOCK {
        let mut stereo = [0.0f32; 2 * BLOCK];
        assert_no_alloc(|| player.play(&mut stereo));
        first.extend(stereo);
        due += BLOCK as f64 / f64::from(RATE) * f64::from(rate) * (1.0 + drift);
        // Blocks of a length of its own.
        while due >= 512.0 {
            due -= 512.0;
            let mut mono = [0.0f32; 512];
            assert_no_alloc(|| hearing_loop.play(&mut mono));
            second.extend(mono);
        }
    }
    [first, second]
}

/// Amplitude of a tone in a window of samples, and root mean square of the rest.
fn tone(samples: &[f32], frequency: f64, rate: u32) -> (f64, f64) {
    let n = samples.len() as f64;
    let turn = |i: usize| 2.0 * PI * frequency * i as f64 / f64::from(rate);
    let part =
        |f: fn(f64) -> f64| 2.0 / n * samples.iter().enumerate().map(|(i, x)| f64::from(*x) * f(turn(i))).sum::<f64>();
    let (a, b) = (part(sin), part(cos));
    let rest = |(i, x): (usize, &f32)| f64::from(*x) - a * sin(turn(i)) - b * cos(turn(i));
    let beside = samples.iter().enumerate().map(|sample| rest(sample) * rest(sample)).sum::<f64>() / n;
    (a.hypot(b), beside.sqrt())
}

#[test]
fn it_plays_the_same_at_a_clock_of_its_own_without_a_gap() {
    /// Of the amplitude: a resampler of straight lines, and the phase that the pull of the clocks turns within a window.
    const CLEAN: f64 = 0.05;
    for (rate, drift) in [(48_000, 0.0), (44_100, 1e-4), (48_000, -3e-4)] {
        let (mut player, mut workshop, _) = speaking(0.25, 21.0);
        let (tail, mut hearing_loop) = hearing_loop::open(RATE, rate, 1, 0.5);
        workshop.lead(tail);
        let [_, second] = side_by_side(&mut player, &mut hearing_loop, rate, drift, 20.0);
        let mut worst = 0.0f64;
        for window in second[rate as usize..].chunks_exact(rate as usize / 10) {
            // Within a tenth of a second a drifting clock turns the phase by less than the bound.
            let (amplitude, beside) = tone(window, TONE / (1.0 + drift), rate);
            assert!((amplitude - 0.5 * LOUD).abs() < CLEAN * LOUD, "{rate} Hz, drift {drift}: {amplitude}");
            worst = worst.max(beside / amplitude);
        }
        println!("{rate} Hz, drift {drift}: beside the tone {worst:.4} at most");
        assert!(worst < CLEAN, "{rate} Hz, drift {drift}: {worst}");
    }
}

#[test]
fn the_visitors_volume_is_not_its_own_but_a_mute_is() {
    let (mut player, mut workshop, knobs) = speaking(0.01, 9.0);
    let (tail, mut hearing_loop) = hearing_loop::open(RATE, RATE, 1, 1.0);
    workshop.lead(tail);
    let [first, second] = side_by_side(&mut player, &mut hearing_loop, RATE, 0.0, 2.0);
    let loudest = |samples: &[f32]| samples.iter().fold(0.0f32, |most, x| most.max(x.abs()));
    assert!(loudest(&first) < 0.01 && loudest(&second) > 0.45, "{} {}", loudest(&first), loudest(&second));
    knobs.set_volume(0.0);
    side_by_side(&mut player, &mut hearing_loop, RATE, 0.0, 1.0);
    let [_, muted] = side_by_side(&mut player, &mut hearing_loop, RATE, 0.0, 1.0);
    assert!(loudest(&muted) < 1e-4, "{}", loudest(&muted));
}

#[test]
fn whatever_becomes_of_it_the_loudspeaker_plays_the_same_bits() {
    let play = |second: &mut dyn FnMut(&mut SynthInstaller, usize)| {
        let (mut player, mut workshop, _) = speaking(0.5, 4.0);
        let mut heard = Vec::new();
        for block in 0..300 {
            second(&mut workshop, block);
            let mut stereo = [0.0f32; 2 * BLOCK];
            assert_no_alloc(|| player.play(&mut stereo));
            heard.extend(stereo);
        }
        heard
    };
    let alone = play(&mut |_, _| ());
    // It stands still and its ring runs full; it is pulled out; it comes back, again and again.
    let mut still = None;
    let stands = play(&mut |workshop, block| {
        if block == 5 {
            let (tail, hearing_loop) = hearing_loop::open(RATE, RATE, 2, 1.0);
            workshop.lead(tail);
            still = Some(hearing_loop);
        }
    });
    let comes = play(&mut |workshop, block| {
        if block % 3 == 0 {
            workshop.lead(hearing_loop::open(RATE, 44_100, 2, 1.0).0);
        }
    });
    assert!(alone == stands && alone == comes);
}

#[test]
fn where_nothing_comes_it_is_silent_and_nothing_clicks() {
    /// Between two samples of a tone of 440 Hz at half of full scale, and of what fades within 5 ms.
    const STEEPEST: f32 = 0.04;
    let (mut player, mut workshop, _) = speaking(0.5, 9.0);
    let (tail, mut hearing_loop) = hearing_loop::open(RATE, RATE, 1, 1.0);
    workshop.lead(tail);
    let mut heard = side_by_side(&mut player, &mut hearing_loop, RATE, 0.0, 1.0)[1].clone();
    for _ in 0..100 {
        let mut mono = [0.0f32; BLOCK];
        hearing_loop.play(&mut mono);
        heard.extend(mono);
    }
    assert!(heard[heard.len() - BLOCK..].iter().all(|x| x.abs() < 1e-4), "the loudspeaker stands still");
    heard.extend(&side_by_side(&mut player, &mut hearing_loop, RATE, 0.0, 1.0)[1]);
    assert!(heard[heard.len() - BLOCK..].iter().any(|x| x.abs() > 0.4), "it comes back");
    let steepest = heard.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
    assert!(steepest < STEEPEST, "{steepest}");
}
