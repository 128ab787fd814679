//! Voices: a source-filter synthesis of speech, laughter, calls, song and humming.
//!
//! The glottis gives pulses of the flow's derivative (Rosenberg, J. Acoust. Soc. Am. 49, 1971): the flow rises as
//! 3 x² − 2 x³ in 40 % of a period and falls as 1 − x² in 16 %. Five resonators in parallel are the vocal tract, with
//! the formants of Peterson and Barney (J. Acoust. Soc. Am. 24, 1952), scaled for women and children. Consonants are
//! noise through one resonator. Controls change every 5 ms and follow their aims in about 15 to 40 ms.
//!
//! A plosive lets out a puff of air, and h, f and s a weaker stream (Stevens, Acoustic Phonetics, 1998, chapters 7 and
//! 8). They are returned as [`Puff`]s, for voices near a capsule.

use soffio_math::noise::Random;
use soffio_math::{PI, exp, sincos};

use super::noise::{Draw, RATE};

/// Samples between two settings of the controls: 5 ms.
const CONTROL: usize = 80;
/// F1, F2 and F3 of vowels of men, Hz (Peterson and Barney 1952).
const VOWELS: [[f64; 3]; 8] = [
    [270.0, 2290.0, 3010.0],
    [390.0, 1990.0, 2550.0],
    [530.0, 1840.0, 2480.0],
    [660.0, 1720.0, 2410.0],
    [730.0, 1090.0, 2440.0],
    [570.0, 840.0, 2410.0],
    [440.0, 1020.0, 2240.0],
    [300.0, 870.0, 2240.0],
];
/// A nasal's.
const NASAL: [f64; 3] = [250.0, 1100.0, 2200.0];

/// Air out of a mouth during a consonant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Puff {
    /// Onset, s after the voice's.
    pub(super) at: f64,
    /// Duration, s.
    pub(super) seconds: f64,
    /// Speed at the lips, m/s.
    pub(super) speed: f64,
    /// Diameter of the opening, m.
    pub(super) diameter: f64,
}

/// A person's voice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Speaker {
    /// Mean fundamental frequency, Hz.
    f0: f64,
    /// Formants over a man's.
    tract: f64,
    /// Syllables a second.
    rate: f64,
    /// Share of noise in the voice.
    breathy: f64,
    /// Low-pass of the glottis, Hz: low for a soft voice.
    tilt: f64,
}

/// Draws a man, a woman or a child.
pub(super) fn draw_speaker(random: &mut Random, child: bool) -> Speaker {
    let kind = if child { 2 } else { random.whole(0, 1) };
    let (f0, tract) = [((80.0, 160.0), 1.0), ((155.0, 260.0), 1.16), ((230.0, 380.0), 1.32)][kind];
    Speaker {
        f0: random.log_range(f0.0, f0.1),
        tract: tract * random.range(0.93, 1.07),
        rate: random.range(3.0, 6.0),
        breathy: random.log_range(0.02, 0.5),
        tilt: random.log_range(500.0, 2500.0),
    }
}

/// What one control interval aims at.
#[derive(Clone, Copy, Debug, Default)]
struct Aim {
    formants: [f64; 3],
    voice: f64,
    noise: f64,
    /// Centre and width of the noise, Hz.
    band: (f64, f64),
    f0: f64,
}

/// A voice as a row of aims, one every 5 ms.
#[derive(Clone, Debug, Default)]
pub(super) struct Score {
    aims: Vec<Aim>,
    /// Air let out.
    pub(super) puffs: Vec<Puff>,
}

impl Score {
    fn now(&self) -> f64 {
        self.aims.len() as f64 * CONTROL as f64 / RATE
    }

    fn hold(&mut self, seconds: f64, aim: Aim) {
        let count = (seconds * RATE / CONTROL as f64).max(1.0) as usize;
        self.aims.extend(std::iter::repeat_n(aim, count));
    }

    fn silence(&mut self, seconds: f64) {
        let last = self.aims.last().copied().unwrap_or_default();
        self.hold(seconds, Aim { voice: 0.0, noise: 0.0, ..last });
    }

    /// A consonant before a vowel of these formants.
    fn consonant(&mut self, random: &mut Random, vowel: Aim, effort: f64) {
        let at = self.now();
        let (noise, seconds) = (random.range(0.15, 0.6), random.range(0.06, 0.16));
        let quiet = Aim { voice: 0.0, noise: 0.0, ..vowel };
        let puff = |seconds, speed, diameter| Puff { at, seconds, speed: effort * speed, diameter };
        match random.whole(0, 9) {
            // p, t, k: closed, burst, breath.
            0..=2 => {
                self.hold(random.range(0.04, 0.09), quiet);
                let at = self.now();
                let band = (random.log_range(600.0, 4500.0), 1500.0);
                self.hold(0.01, Aim { noise: 1.2, band, ..quiet });
                self.hold(random.range(0.01, 0.06), Aim { noise: 0.25, band, ..quiet });
                if random.chance(0.6) {
                    let (seconds, speed) = (random.range(0.02, 0.07), random.range(4.0, 16.0));
                    self.puffs.push(Puff { at, ..puff(seconds, speed, random.range(0.004, 0.01)) });
                }
            }
            // s, sh.
            3 | 4 => {
                let band = (random.log_range(2500.0, 6500.0), 1800.0);
                self.hold(seconds, Aim { noise: 1.6 * noise, band, ..quiet });
                self.puffs.push(puff(seconds, random.range(1.0, 5.0), random.range(0.004, 0.008)));
            }
            // f, h.
            5 | 6 => {
                let band = (random.log_range(900.0, 5000.0), 4000.0);
                self.hold(seconds, Aim { noise: 0.5 * noise, band, ..quiet });
                self.puffs.push(puff(seconds, random.range(2.0, 8.0), random.range(0.004, 0.012)));
            }
            // m, n, l, and voiced plosives.
            7 | 8 => self.hold(seconds, Aim { formants: NASAL, voice: 0.4, ..vowel }),
            _ => self.hold(0.5 * seconds, Aim { voice: 0.1, ..vowel }),
        }
    }
}

fn vowel(random: &mut Random, speaker: &Speaker, f0: f64) -> Aim {
    Aim { formants: random.pick(&VOWELS), voice: 1.0, noise: speaker.breathy, band: (1500.0, 2500.0), f0 }
}

/// Speech of about `seconds` s: phrases of syllables, with pauses.
pub(super) fn speech(random: &mut Random, speaker: &Speaker, seconds: f64, effort: f64) -> Score {
    let mut score = Score::default();
    while score.now() < seconds {
        let syllables = random.whole(2, 14);
        let raised = random.range(0.9, 1.25);
        for i in 0..syllables {
            let fall = raised * (1.1 - 0.25 * i as f64 / syllables as f64);
            let f0 = speaker.f0 * fall * random.range(0.88, 1.14);
            let aim = vowel(random, speaker, f0);
            if random.chance(0.85) {
                score.consonant(random, aim, effort);
            }
            let length = random.range(0.4, 1.2) / speaker.rate;
            score.hold(length, Aim { voice: random.range(0.5, 1.0), ..aim });
        }
        score.silence(random.log_range(0.15, 1.5));
    }
    score
}

/// Laughter of `count` bursts: breath and vowel in turn, ever weaker.
pub(super) fn laughter(random: &mut Random, speaker: &Speaker, count: usize) -> Score {
    let mut score = Score::default();
    let (period, open) = (random.range(0.14, 0.26), random.range(0.4, 0.7));
    let (f0, shape) = (speaker.f0 * random.range(1.2, 2.4), random.pick(&VOWELS[1..6]));
    for i in 0..count {
        let weak = 1.0 - 0.7 * i as f64 / count as f64;
        let aim =
            Aim { formants: shape, voice: weak, noise: 0.15, band: (1500.0, 3000.0), f0: f0 * (0.7 + 0.3 * weak) };
        let seconds = period * (1.0 - open);
        score.puffs.push(Puff { at: score.now(), seconds, speed: random.range(1.0, 4.0), diameter: 0.012 });
        score.hold(seconds, Aim { voice: 0.0, noise: 0.35 * weak, ..aim });
        score.hold(period * open, aim);
    }
    score.silence(0.2);
    score
}

/// A shout or scream: one or two long vowels, high and strong.
pub(super) fn shout(random: &mut Random, speaker: &Speaker) -> Score {
    let mut score = Score::default();
    for _ in 0..random.whole(1, 3) {
        let f0 = speaker.f0 * random.range(1.5, 2.8);
        let aim = vowel(random, speaker, f0);
        score.consonant(random, aim, 1.5);
        score.hold(random.range(0.15, 1.2), Aim { noise: 0.05, ..aim });
        score.silence(random.range(0.05, 0.4));
    }
    score
}

/// Song (vowels and consonants) or humming (a nasal), on tones of a scale, with vibrato.
pub(super) fn song(random: &mut Random, speaker: &Speaker, seconds: f64, humming: bool) -> Score {
    const SCALE: [f64; 7] = [1.0, 9.0 / 8.0, 5.0 / 4.0, 4.0 / 3.0, 3.0 / 2.0, 5.0 / 3.0, 2.0];
    let mut score = Score::default();
    let (vibrato, depth) = (random.range(4.5, 6.5), random.range(0.0, 0.03));
    while score.now() < seconds {
        let f0 = speaker.f0 * random.pick(&SCALE);
        let mut aim = vowel(random, speaker, f0);
        if humming {
            aim = Aim { formants: NASAL, noise: 0.01, ..aim };
        } else if random.chance(0.6) {
            score.consonant(random, aim, 1.0);
        }
        let (length, tone) = (random.log_range(0.2, 1.6), aim.f0);
        for i in 0..(length / 0.025) as usize {
            let s = sincos(2.0 * PI * vibrato * 0.025 * i as f64).0;
            score.hold(0.025, Aim { f0: tone * (1.0 + depth * s), ..aim });
        }
        if random.chance(0.2) {
            score.silence(random.range(0.1, 0.8));
        }
    }
    score
}

/// A resonator of two poles with unit gain at its peak.
#[derive(Clone, Copy, Debug, Default)]
struct Resonator {
    gain: f64,
    a: [f64; 2],
    y: [f64; 2],
}

impl Resonator {
    fn tune(&mut self, hertz: f64, width: f64) {
        let r = exp(-PI * width / RATE);
        let (s, c) = sincos(2.0 * PI * hertz.min(7600.0) / RATE);
        self.a = [2.0 * r * c, -r * r];
        self.gain = (1.0 - r) * 2.0 * s.max(0.05);
    }

    #[inline]
    fn step(&mut self, x: f64) -> f64 {
        let y = self.gain * x + self.a[0] * self.y[0] + self.a[1] * self.y[1] + 1e-18;
        self.y = [y, self.y[0]];
        y
    }
}

/// Sings or says a score. Root mean square 1 over what is not silent.
pub(super) fn perform(random: &mut Random, speaker: &Speaker, score: &Score) -> Vec<f32> {
    /// Gains of the formants in parallel.
    const GAINS: [f64; 5] = [1.0, 0.6, 0.35, 0.2, 0.12];
    let Some(first) = score.aims.first() else { return Vec::new() };
    let mut state = *first;
    let mut tract = [Resonator::default(); 5];
    let mut hiss = Resonator::default();
    tract[3].tune(3500.0 * speaker.tract, 250.0);
    tract[4].tune(4500.0 * speaker.tract, 350.0);
    // Jitter and shimmer: each period is a little longer or weaker than the last.
    let (mut jitter, mut shimmer) = (1.0, 1.0);
    let (mut phase, mut tilted, mut out) = (0.0, 0.0, Vec::with_capacity(score.aims.len() * CONTROL));
    let tilt = 1.0 - exp(-2.0 * PI * speaker.tilt / RATE);
    for aim in &score.aims {
        let follow = |now: &mut f64, to: f64, share: f64| *now += share * (to - *now);
        for i in 0..3 {
            follow(&mut state.formants[i], aim.formants[i] * speaker.tract, 0.25);
            tract[i].tune(state.formants[i], [80.0, 100.0, 150.0][i]);
        }
        let from = (state.voice, state.noise);
        follow(&mut state.voice, aim.voice, 0.35);
        follow(&mut state.noise, aim.noise, 0.6);
        follow(&mut state.f0, aim.f0 * (1.0 + 0.01 * random.normal()), 0.2);
        if state.noise > 1e-4 {
            hiss.tune(aim.band.0, aim.band.1);
        }
        if state.voice < 1e-4 && state.noise < 1e-4 && from.0 < 1e-4 && from.1 < 1e-4 {
            out.extend(std::iter::repeat_n(0.0, CONTROL));
            continue;
        }
        let pace = state.f0 / RATE;
        for k in 0..CONTROL {
            let t = k as f64 / CONTROL as f64;
            let voice = from.0 + t * (state.voice - from.0);
            let noise = from.1 + t * (state.noise - from.1);
            phase += pace * jitter;
            if phase >= 1.0 {
                phase -= 1.0;
                jitter = 1.0 + 0.025 * random.signed();
                shimmer = 1.0 + 0.2 * random.signed();
            }
            // Derivative of Rosenberg's flow: area up and down is the same.
            let pulse = if phase < 0.4 {
                let x = phase / 0.4;
                6.0 * x * (1.0 - x) / 0.4
            } else if phase < 0.56 {
                -2.0 * (phase - 0.4) / (0.16 * 0.16)
            } else {
                0.0
            };
            tilted += tilt * (shimmer * voice * pulse - tilted);
            let white = random.signed();
            let source = tilted + 0.5 * speaker.breathy * voice * white;
            let mut y = 0.0;
            let mut sign = 1.0;
            for (resonator, gain) in tract.iter_mut().zip(GAINS) {
                y += sign * gain * resonator.step(source);
                sign = -sign;
            }
            y += 1.5 * hiss.step(noise * white);
            out.push(y as f32);
        }
    }
    normalise(&mut out);
    out
}

/// Scales to a root mean square of 1 over all samples above a thousandth of the peak.
pub(super) fn normalise(wave: &mut [f32]) {
    let peak = wave.iter().fold(0.0_f32, |p, x| p.max(x.abs()));
    let loud = wave.iter().filter(|x| x.abs() > 1e-3 * peak);
    let (sum, count) = loud.fold((0.0_f64, 0.0_f64), |(s, n), x| (s + f64::from(*x) * f64::from(*x), n + 1.0));
    if sum > 0.0 {
        let gain = (count / sum).sqrt() as f32;
        wave.iter_mut().for_each(|x| *x *= gain);
    }
}
