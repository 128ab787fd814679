//! The bank of partials against closed forms: at every level of instructions, in any blocks, struck, driven, touched.

use fearless_simd::{Level, Simd};
use soffio_math::noise::Random;
use soffio_math::{PI, amplitude_to_db, atan2, cos, exp, ln, sincos};
use soffio_sound::modal::{BLOCK, Bank, GROUP, Partial, fuses};

const RATE: f64 = 48_000.0;
/// The kernel's own error against f64, relative to the sound's root mean square.
const KERNEL_DB: f64 = -90.0;

/// Every set of instructions that this processor has, the best first.
fn levels() -> Vec<Level> {
    let best = Level::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        let mut levels = vec![];
        levels.extend(best.as_avx512().map(Simd::level));
        levels.extend(best.as_avx2().map(Simd::level));
        levels.extend(best.as_sse4_2().map(Simd::level));
        levels.extend(best.as_sse2().map(Simd::level));
        levels
    }
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    vec![best]
}

/// Sounds of the levels so far, one for each class of rounding.
#[derive(Default)]
struct Classes(Vec<(bool, Level, Vec<f32>)>);

impl Classes {
    /// Takes a level's sound. `false`: another level of its class has sounded, with the same bits.
    fn is_new(&mut self, level: Level, out: &[f32], what: &str) -> bool {
        let fused = fuses(level);
        if let Some((_, first, sound)) = self.0.iter().find(|class| class.0 == fused) {
            assert!(sound == out, "{what}: {level:?} has other bits than {first:?}");
            return false;
        }
        self.0.push((fused, level, out.to_vec()));
        true
    }
}

fn table(random: &mut Random, most: usize) -> Vec<Partial> {
    let count = 1 + (random.word() % most as u64) as usize;
    let mut partials: Vec<Partial> = (0..count)
        .map(|_| Partial {
            frequency: 20.0 * exp(random.unit() * ln(900.0)),
            decay: 6.908 / (0.05 * exp(random.unit() * ln(600.0))),
        })
        .collect();
    partials.sort_by(|a, b| a.decay.total_cmp(&b.decay));
    partials
}

/// Bank, samples that are ready, and how far it has come: what the synth does around a bank.
struct Player {
    bank: Bank,
    look_ahead: Vec<f32>,
    at: usize,
}

impl Player {
    fn new(partials: &[Partial], level: Level) -> Self {
        let bank = Bank::new(partials, RATE, level);
        Self { bank, look_ahead: vec![0.0; Bank::look_ahead_len(0.02, RATE)], at: BLOCK }
    }

    fn strike(&mut self, amplitudes: &[f64], duration: f64) {
        assert!(self.bank.strike(|i| amplitudes[i], duration, self.at, &mut self.look_ahead).is_some());
    }

    fn skip(&mut self, blocks: usize) {
        for _ in 0..blocks * BLOCK {
            self.sample();
        }
    }

    fn sample(&mut self) -> f32 {
        if self.at == BLOCK {
            self.look_ahead.copy_within(BLOCK.., 0);
            let end = self.look_ahead.len() - BLOCK;
            self.look_ahead[end..].fill(0.0);
            let block = self.look_ahead.first_chunk_mut().expect("room for a block");
            self.bank.render(None, block);
            self.at = 0;
        }
        self.at += 1;
        self.look_ahead[self.at - 1]
    }
}

/// What a partial gives after a half sine of unit area and `duration` s that begins at 0: exact, in f64, from the
/// variation of constants in its real form.
fn exact(partial: &Partial, duration: f64, t: f64) -> f64 {
    if t <= 0.0 {
        return 0.0;
    }
    let (c, w) = (partial.decay, 2.0 * PI * partial.frequency);
    let omega = PI / duration;
    // ∫0^end (Ω/2) sin Ωs · e^(−c (t − s)) sin w (t − s) ds with the product of sines as a difference of cosines.
    let end = t.min(duration);
    let integral = |a: f64, phase: f64| {
        // ∫ e^(c s) cos(a s + phase) ds.
        let primitive = |s: f64| {
            let (sin, cos) = sincos(a * s + phase);
            exp(c * (s - t)) * (c * cos + a * sin) / (c * c + a * a)
        };
        primitive(end) - primitive(0.0)
    };
    0.25 * omega * (integral(omega + w, -w * t) - integral(omega - w, w * t))
}

fn rms(x: &[f64]) -> f64 {
    (x.iter().map(|x| x * x).sum::<f64>() / x.len() as f64).sqrt()
}

#[test]
fn every_level_plays_random_tables_to_minus_ninety_decibels_with_the_bits_of_its_class() {
    const SEEDS: u64 = 12;
    for seed in 0..SEEDS {
        let mut random = Random::new(seed);
        let partials = table(&mut random, 60);
        // Three hits at odd times, one of them while another lasts.
        let hits: Vec<(usize, f64, Vec<f64>)> = [0, 37, 5000 + (random.word() % 100) as usize]
            .into_iter()
            .map(|at| {
                let amplitudes = partials.iter().map(|_| random.signed() * 0.1).collect();
                (at, 2e-5 * exp(random.unit() * ln(500.0)), amplitudes)
            })
            .collect();
        let count = RATE as usize;
        let mut classes = Classes::default();
        for level in levels() {
            let mut player = Player::new(&partials, level);
            let out: Vec<f32> = (0..count)
                .map(|t| {
                    hits.iter().filter(|hit| hit.0 == t).for_each(|hit| player.strike(&hit.2, hit.1));
                    player.sample()
                })
                .collect();
            if !classes.is_new(level, &out, &format!("seed {seed}")) {
                continue;
            }
            // Every 7th sample, and all of the first thousand.
            let looked: Vec<usize> = (0..1000).chain((1000..count).step_by(7)).collect();
            let reference: Vec<f64> = looked
                .iter()
                .map(|&t| {
                    let mut y = 0.0;
                    for (at, duration, amplitudes) in hits.iter().filter(|hit| hit.0 <= t) {
                        let since = (t - at) as f64 / RATE;
                        y += partials.iter().zip(amplitudes).map(|(p, a)| a * exact(p, *duration, since)).sum::<f64>();
                    }
                    y
                })
                .collect();
            let wrong: Vec<f64> = looked.iter().zip(&reference).map(|(&t, y)| f64::from(out[t]) - y).collect();
            let error = amplitude_to_db(rms(&wrong) / rms(&reference));
            let attack = amplitude_to_db(rms(&wrong[..1000]) / rms(&reference[..1000]));
            println!("seed {seed}: {} partials, {level:?}: {error:.1} dB, first 20 ms {attack:.1} dB", partials.len());
            assert!(error < KERNEL_DB && attack < KERNEL_DB, "seed {seed}, {level:?}: {error} dB, attack {attack} dB");
        }
    }
}

#[test]
fn levels_without_fused_multiply_adds_say_so() {
    for level in levels() {
        // Builds may leave levels out, and one that is left out runs as the next below; SSE2 always fuses nothing.
        let name = format!("{level:?}");
        assert!(!(name.starts_with("Sse") && fuses(level)), "{name}");
    }
    #[cfg(target_arch = "aarch64")]
    assert!(fuses(Level::new()));
}

#[test]
fn a_single_partial_follows_its_closed_form_at_every_level() {
    // Of the amplitude at each moment: f32 rounds the row, the phasor and the sum, each by up to 6e-8; 16 times that.
    const TOLERANCE: f64 = 1e-6;
    // A pulse of unit area comes half of its length later than an impulse, s.
    const PULSE: f64 = 1e-9;
    let amplitude = 0.5;
    for level in levels() {
        for (frequency, t60) in [(20.0, 30.0), (440.0, 2.0), (5_000.0, 0.5), (18_000.0, 0.05)] {
            let partial = Partial { frequency, decay: ln(1000.0) / t60 };
            let mut player = Player::new(&[partial], level);
            player.strike(&[amplitude], PULSE);
            let wrong = (0..RATE as usize)
                .map(|t| {
                    let time = t as f64 / RATE;
                    let envelope = amplitude * exp(-partial.decay * time);
                    let y = envelope * sincos(2.0 * PI * frequency * (time - 0.5 * PULSE).max(0.0)).0;
                    (f64::from(player.sample()) - y).abs() / envelope.max(1e-6)
                })
                .fold(0.0, f64::max);
            println!("{level:?}, {frequency} Hz: {wrong:.1e} of the amplitude");
            assert!(wrong < TOLERANCE, "{level:?}, {frequency} Hz: {wrong}");
        }
    }
}

/// One partial struck by an impulse at 0, `seconds` long.
fn single(frequency: f64, t60: f64, seconds: f64) -> Vec<f64> {
    let mut player = Player::new(&[Partial { frequency, decay: ln(1000.0) / t60 }], Level::new());
    player.strike(&[0.5], 1e-9);
    (0..(seconds * RATE) as usize).map(|_| f64::from(player.sample())).collect()
}

/// Product of a part of a sound with e^(−iωt) under a Hann window: real part, imaginary part.
fn product(part: &[f64], start: usize, frequency: f64) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for (t, x) in part.iter().enumerate() {
        let window = 1.0 - cos(2.0 * PI * t as f64 / part.len() as f64);
        let (s, c) = sincos(2.0 * PI * frequency * (t + start) as f64 / RATE);
        sum = [sum[0] + window * x * c, sum[1] - window * x * s];
    }
    sum
}

#[test]
fn pitch_is_right_from_the_lowest_partial_to_the_highest() {
    // Slope of the phase over four seconds; f64 phasors leave the window's leakage.
    const CENTS: f64 = 1e-3;
    for frequency in [20.0, 27.5, 41.2, 440.0, 3000.0, 12_345.6, 18_000.0] {
        let out = single(frequency, 30.0, 4.0);
        let half = out.len() / 2;
        let [a, b] = [product(&out[..half], 0, frequency), product(&out[half..], half, frequency)];
        let drift = atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
        let cents = 1200.0 / std::f64::consts::LN_2 * drift / (2.0 * PI) / (half as f64 / RATE) / frequency;
        println!("{frequency} Hz: {cents:.2e} cents");
        assert!(cents.abs() < CENTS, "{frequency} Hz: {cents} cents");
    }
}

#[test]
fn decay_takes_the_time_asked_for() {
    // A line through the logarithm of the envelope, from six windows over the first 30 dB.
    const TOLERANCE: f64 = 1e-3;
    for t60 in [0.05, 0.3, 2.0, 10.0, 30.0] {
        for frequency in [1000.0, 9000.0] {
            let out = single(frequency, t60, 0.5 * t60 + 0.02);
            let window = (t60 * RATE / 24.0) as usize;
            let points = 6;
            let step = ((0.5 * t60 * RATE) as usize - window) / (points - 1);
            let levels: Vec<(f64, f64)> = (0..points)
                .map(|i| {
                    let [re, im] = product(&out[i * step..i * step + window], i * step, frequency);
                    ((i * step) as f64 / RATE, amplitude_to_db((re * re + im * im).sqrt()))
                })
                .collect();
            let n = points as f64;
            let mean = levels.iter().fold((0.0, 0.0), |m, l| (m.0 + l.0 / n, m.1 + l.1 / n));
            let slope = levels.iter().map(|l| (l.0 - mean.0) * (l.1 - mean.1)).sum::<f64>()
                / levels.iter().map(|l| (l.0 - mean.0) * (l.0 - mean.0)).sum::<f64>();
            let found = -60.0 / slope;
            assert!((found / t60 - 1.0).abs() < TOLERANCE, "{frequency} Hz: {found} s instead of {t60} s");
        }
    }
}

#[test]
fn a_force_at_audio_rate_drives_the_partials_exactly() {
    for seed in 0..6 {
        let mut random = Random::new(100 + seed);
        let partials = table(&mut random, 40);
        let gains: Vec<[f64; 2]> = partials.iter().map(|_| [random.signed(), random.signed()]).collect();
        // It acts at one place, then at another, and goes from one to the other over a block, frame by frame.
        let place = |block: usize| block / 7 % 2;
        let blocks = 400;
        let force: Vec<f32> = (0..blocks * BLOCK).map(|_| random.signed() as f32).collect();
        let mut classes = Classes::default();
        for level in levels() {
            let mut bank = Bank::new(&partials, RATE, level);
            bank.set_drive_point(|i| gains[i][0]);
            let mut out = vec![0.0f32; force.len()];
            let parts = out.as_chunks_mut::<BLOCK>().0.iter_mut().zip(force.as_chunks::<BLOCK>().0);
            for (i, (out, force)) in parts.enumerate() {
                if i > 0 && place(i) != place(i - 1) {
                    bank.glide_drive_point(|k| gains[k][place(i)]);
                }
                // Half of the time it is left to itself.
                bank.render((i % 40 < 20).then_some(force), out);
            }
            if !classes.is_new(level, &out, &format!("seed {}", 100 + seed)) {
                continue;
            }
            // z ← ρ (z + b f), y = Im z, sample by sample in f64.
            let rho: Vec<[f64; 2]> = partials
                .iter()
                .map(|p| {
                    let (s, c) = sincos(2.0 * PI * p.frequency / RATE);
                    let r = exp(-p.decay / RATE);
                    [r * c, r * s]
                })
                .collect();
            let mut z = vec![[0.0f64; 2]; partials.len()];
            let (mut wrong, mut right) = (Vec::new(), Vec::new());
            for (t, f) in force.iter().enumerate() {
                let f = if t / BLOCK % 40 < 20 { f64::from(*f) } else { 0.0 };
                let y: f64 = z.iter().map(|z| z[1]).sum();
                wrong.push(f64::from(out[t]) - y);
                right.push(y);
                let block = t / BLOCK;
                let (from, to) = (place(block.max(1) - 1), place(block));
                let way = (t % BLOCK / 16) as f64 / (BLOCK / 16) as f64;
                for ((z, rho), b) in z.iter_mut().zip(&rho).zip(&gains) {
                    let re = z[0] + (b[from] + way * (b[to] - b[from])) * f;
                    *z = [re * rho[0] - z[1] * rho[1], re * rho[1] + z[1] * rho[0]];
                }
            }
            let error = amplitude_to_db(rms(&wrong) / rms(&right));
            println!("seed {}: {} partials driven, {level:?}: {error:.1} dB", 100 + seed, partials.len());
            assert!(error < KERNEL_DB, "seed {}, {level:?}: {error} dB", 100 + seed);
        }
    }
}

#[test]
fn a_touch_damps_without_a_step() {
    // One partial at rest 1 s: 2/s alone, 2 + 40/s while touched.
    const TOLERANCE: f64 = 1e-3;
    let (frequency, decay, more) = (500.0, 2.0, 40.0);
    let mut player = Player::new(&[Partial { frequency, decay }], Level::new());
    player.strike(&[0.5], 1e-9);
    let third = 16_000 / BLOCK * BLOCK;
    let out: Vec<f64> = (0..3 * third)
        .map(|t| {
            match t / third {
                _ if t % third != 0 => {}
                1 => player.bank.damp(|_| more),
                2 => player.bank.damp(|_| 0.0),
                _ => {}
            }
            f64::from(player.sample())
        })
        .collect();
    let level = |from: usize| {
        let [re, im] = product(&out[from..from + 960], from, frequency);
        ln((re * re + im * im).sqrt())
    };
    for (part, c) in [(0, decay), (1, decay + more), (2, decay)] {
        let from = part * third;
        let span = 3 * third / 4;
        let found = (level(from) - level(from + span)) / (span as f64 / RATE);
        assert!((found / c - 1.0).abs() < TOLERANCE, "{found}/s instead of {c}/s");
    }
    // The second difference of a sine is its −(ω/fs)²: a step at the switch would stand out.
    let curvature = |range: std::ops::Range<usize>| {
        out[range].windows(3).fold(0.0f64, |m, w| m.max((w[0] - 2.0 * w[1] + w[2]).abs()))
    };
    assert!(curvature(third - 10..third + 10) < 1.1 * curvature(third - 200..third - 10));
}

/// The sound of so many hits a minute on a wooden body, and how far forgetting what is over changed it.
fn forgetting(hits_per_minute: f64, seconds: f64, threshold: f64, seed: u64) -> (f64, f64, usize) {
    let mut random = Random::new(seed);
    let mut partials: Vec<Partial> = (0..600)
        .map(|_| Partial { frequency: random.range(80.0, 9000.0), decay: 6.908 / random.range(0.05, 0.3) })
        .collect();
    partials.sort_by(|a, b| a.decay.total_cmp(&b.decay));
    let mut players = [threshold, 0.0].map(|threshold| {
        let mut player = Player::new(&partials, Level::new());
        player.bank.set_threshold(threshold);
        player
    });
    let (mut worst, mut loudest, mut fewest) = (0.0f64, 0.0f64, usize::MAX);
    let every = 60.0 * RATE / hits_per_minute;
    let mut next = 0.0;
    for t in 0..(seconds * RATE) as usize {
        if t as f64 >= next {
            next += every * 2.0 * random.unit();
            let level = 0.02 * exp(-7.0 * random.unit());
            let amplitudes: Vec<f64> = partials.iter().map(|_| level * random.signed()).collect();
            let duration = 1e-4 * exp(2.0 * random.unit());
            players.iter_mut().for_each(|player| player.strike(&amplitudes, duration));
        }
        let [a, b] = [0, 1].map(|i| f64::from(players[i].sample()));
        worst = worst.max((a - b).abs());
        loudest = loudest.max(b.abs());
        fewest = fewest.min(players[0].bank.ringing());
    }
    (amplitude_to_db(worst), amplitude_to_db(loudest), fewest)
}

#[test]
fn what_is_forgotten_is_not_heard() {
    const SEED: u64 = 3;
    for (hits, seconds) in [(60.0, 4.0), (10_000.0, 2.0), (100_000.0, 1.0)] {
        let (worst, loudest, fewest) = forgetting(hits, seconds, 1e-5, SEED);
        println!("{hits} hits a minute: peak {loudest:.1} dBFS, forgotten {worst:.1} dBFS, down to {fewest} partials");
        assert!(worst < -80.0, "seed {SEED}, {hits} hits a minute: {worst} dBFS");
    }
    // At leisure whole bodies fall silent.
    assert_eq!(forgetting(60.0, 4.0, 1e-5, SEED).2, 0);
}

#[test]
fn the_quietest_partials_leave_first_and_fade() {
    let partials: Vec<Partial> =
        (0..64).map(|i| Partial { frequency: 100.0 + 97.0 * f64::from(i), decay: 1.0 + f64::from(i) }).collect();
    let mut player = Player::new(&partials, Level::new());
    let amplitudes: Vec<f64> = (0..64).map(|i| if i / GROUP == 2 { 1e-3 } else { 0.05 }).collect();
    player.strike(&amplitudes, 1e-9);
    player.skip(1);
    let (group, amplitude) = player.bank.quietest().expect("all ring");
    assert_eq!(group, 2);
    assert!((amplitude / 4e-3 - 1.0).abs() < 0.1, "{amplitude}");
    assert_eq!(player.bank.release(2), GROUP);
    player.skip(2);
    assert_eq!(player.bank.ringing(), 64 - GROUP);
}

#[test]
fn hits_with_absurd_numbers_change_nothing() {
    let mut player = Player::new(&[Partial { frequency: 500.0, decay: 2.0 }], Level::new());
    for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e9] {
        assert_eq!(player.bank.strike(|_| bad, 1e-3, 5, &mut player.look_ahead), None);
    }
    assert!((0..1000).all(|_| player.sample() == 0.0));
}
