//! Microphones: from the pressure at two ports to the samples of a device.
//!
//! 1. Self-noise of the capsule, as a pressure (8 to 45 dB; data sheets of studio, electret and MEMS capsules).
//! 2. Its high-pass, resonances of capsule and housing, the band limit of its sample rate. These are linear, so the
//!    breath's share of the signal is filtered apart and its level over the rest is known.
//! 3. Sensitivity: full scale lies at 110 to 130 dB, moved by a gain of −10 to 20 dB; what is beyond is cut off hard.
//! 4. What the device's software does: a noise gate, noise suppression by spectral gates (Boll, IEEE Trans. ASSP 27, 1979), automatic
//!    gain control with a fast attack and a slow release, a limiter. Both capsules share their gains.
//! 5. An offset, and rounding to 16 bits.

use soffio_fourier::Complex;
use soffio_math::noise::Random;
use soffio_math::{PI, db_to_amplitude, exp, pow, sin};

use super::filter::{Biquad, highpass, lowpass};
use super::noise::{Draw, RATE};
use super::stage::pascal;

/// A device.
#[derive(Clone, Debug)]
pub(super) struct Microphone {
    /// High-pass: corner of each capsule, Hz, and order.
    pub(super) highpass: ([f64; 2], usize),
    /// Resonances: frequency Hz, quality, dB.
    resonances: Vec<(f64, f64, f64)>,
    /// Upper end of its band, Hz.
    band: f64,
    /// Samples per Pa, of each capsule; full scale is 1.
    pub(super) sensitivity: [f64; 2],
    /// Level of the self-noise, dB.
    pub(super) noise: f64,
    offset: f64,
    gate: Option<Gate>,
    suppression: Option<Suppression>,
    gain_control: Option<GainControl>,
    limiter: Option<GainControl>,
}

/// A noise gate: what is quieter than the threshold is turned down after a while, often to exact silence.
#[derive(Clone, Copy, Debug)]
struct Gate {
    /// Root mean square from which it opens.
    threshold: f32,
    /// Gain while it is closed.
    closed: f32,
    /// Blocks for which it stays open.
    hold: usize,
}

/// Spectral gates.
#[derive(Clone, Copy, Debug)]
struct Suppression {
    /// Smallest gain.
    floor: f64,
    /// Noise is taken this many times its estimate.
    over: f64,
    /// Growth of the estimate per block.
    rise: f64,
}

/// Automatic gain: the level aimed at, the limits of the gain, and the shares per sample of attack and release.
#[derive(Clone, Copy, Debug)]
struct GainControl {
    aim: f64,
    least: f64,
    most: f64,
    attack: f64,
    release: f64,
}

/// Draws a device.
pub(super) fn draw(random: &mut Random) -> Microphone {
    // Four in ten are telephones, which cut off all below the voice.
    let phone = random.chance(0.4);
    let corner = match random.unit() {
        _ if phone => random.range(90.0, 250.0),
        u if u < 0.33 => random.range(10.0, 30.0),
        u if u < 0.78 => random.range(30.0, 80.0),
        _ => random.range(80.0, 200.0),
    };
    let order = if phone { random.pick(&[2, 3, 4, 4]) } else { random.pick(&[1, 1, 2, 2, 2, 3]) };
    let resonances = (0..random.whole(0, 4))
        .map(|_| (random.log_range(60.0, 7000.0), random.range(0.6, 5.0), random.range(-8.0, 12.0)))
        .collect();
    // Sample rates of 8, 11, 16 kHz and above: the devices' filters end a little below half.
    let band = random.pick(&[3400.0, 3700.0, 5000.0, 7000.0, 7500.0, 7500.0, 7500.0, 7500.0, 7500.0]);
    let full_scale = random.range(110.0, 130.0) - random.range(-10.0, 20.0);
    let sensitivity = 1.0 / (std::f64::consts::SQRT_2 * pascal(full_scale));
    let mismatch = db_to_amplitude(1.2 * random.normal().clamp(-2.5, 2.5));
    let per_sample = |seconds: f64| 1.0 - exp(-1.0 / (seconds * RATE));
    let gate = random.chance(0.15).then(|| Gate {
        threshold: db_to_amplitude(random.range(-66.0, -42.0)) as f32,
        closed: if random.chance(0.6) { 0.0 } else { db_to_amplitude(-random.range(10.0, 40.0)) as f32 },
        hold: random.whole(4, 80),
    });
    let suppression = random.chance(0.2).then(|| Suppression {
        floor: db_to_amplitude(-random.range(6.0, 22.0)),
        over: random.range(1.0, 3.0),
        rise: pow(10.0, 0.1 * random.range(1.0, 8.0) * BLOCK as f64 / RATE),
    });
    let gain_control = random.chance(0.25).then(|| {
        let range = random.range(10.0, 30.0);
        let share = random.range(0.3, 1.0);
        GainControl {
            aim: db_to_amplitude(-random.range(12.0, 30.0)),
            least: db_to_amplitude(-(1.0 - share) * range),
            most: db_to_amplitude(share * range),
            attack: per_sample(random.log_range(0.003, 0.08)),
            release: per_sample(random.log_range(0.3, 6.0)),
        }
    });
    let limiter = random.chance(0.15).then(|| GainControl {
        aim: db_to_amplitude(-random.range(6.0, 18.0)),
        least: 0.0,
        most: 1.0,
        attack: per_sample(random.log_range(0.0005, 0.005)),
        release: per_sample(random.log_range(0.05, 0.6)),
    });
    Microphone {
        highpass: ([corner, corner * random.range(0.8, 1.2)], order),
        resonances,
        band,
        sensitivity: [sensitivity, sensitivity * mismatch],
        noise: random.range(8.0, 45.0),
        gate,
        offset: if random.chance(0.2) { 0.02 * random.normal() } else { 0.0 },
        suppression,
        gain_control,
        limiter,
    }
}

impl Microphone {
    /// Has it spectral gates and nothing that turns their effect back?
    #[cfg(test)]
    pub(super) fn suppresses(&self) -> bool {
        self.suppression.is_some() && self.gate.is_none() && self.gain_control.is_none() && self.limiter.is_none()
    }

    /// The linear filters of one capsule, in place; from Pa to full scale 1.
    pub(super) fn filter(&self, capsule: usize, samples: &mut [f32]) {
        let gain = self.sensitivity[capsule] as f32;
        samples.iter_mut().for_each(|x| *x *= gain);
        let mut chain: Vec<Biquad> = highpass(self.highpass.0[capsule], self.highpass.1);
        chain.extend(self.resonances.iter().map(|r| Biquad::peak(r.0, r.1, r.2)));
        if self.band < 7000.0 {
            chain.extend(lowpass(self.band, 6));
        }
        chain.into_iter().for_each(|filter| filter.run(samples));
    }

    /// Cuts off, and does what the device's software does.
    pub(super) fn finish(&self, random: &mut Random, capsules: &mut [Vec<f32>]) {
        for capsule in capsules.iter_mut() {
            capsule.iter_mut().for_each(|x| *x = x.clamp(-1.0, 1.0));
            if let Some(suppression) = &self.suppression {
                suppression.run(capsule);
            }
            if let Some(gate) = &self.gate {
                gate.run(capsule);
            }
        }
        for control in [self.gain_control, self.limiter].into_iter().flatten() {
            control.run(capsules);
        }
        let offset = self.offset as f32;
        for x in capsules.iter_mut().flatten() {
            // Rounding with a dither of one step.
            let dither = if *x == 0.0 { 0.0 } else { random.unit() as f32 - 0.5 };
            *x = ((*x + offset).clamp(-1.0, 1.0) * 32_767.0 + dither).round() / 32_768.0;
        }
    }
}

impl Gate {
    /// Samples of a block: 5 ms.
    const EVERY: usize = 80;

    fn run(&self, samples: &mut [f32]) {
        let (mut open, mut gain) = (0, self.closed);
        for block in samples.chunks_mut(Self::EVERY) {
            let power = block.iter().map(|x| x * x).sum::<f32>() / block.len() as f32;
            open = if power.sqrt() > self.threshold { self.hold } else { open.saturating_sub(1) };
            let next = if open > 0 { 1.0 } else { self.closed };
            let slope = (next - gain) / Self::EVERY as f32;
            for x in block {
                gain += slope;
                *x *= gain;
            }
            gain = next;
        }
    }
}

impl GainControl {
    /// Samples between two settings of the gain.
    const EVERY: usize = 16;

    fn run(&self, capsules: &mut [Vec<f32>]) {
        let (mut level, mut gain) = (self.aim, 1.0_f32);
        let keep = |share: f64| 1.0 - pow(1.0 - share, Self::EVERY as f64);
        let (attack, release) = (keep(self.attack), keep(self.release));
        let (first, second) = capsules.split_at_mut(1);
        for (a, b) in first[0].chunks_mut(Self::EVERY).zip(second[0].chunks_mut(Self::EVERY)) {
            let peak = a.iter().chain(b.iter()).fold(0.0_f32, |p, x| p.max(x.abs()));
            let peak = f64::from(peak);
            level += if peak > level { attack } else { release } * (peak - level);
            let next = (self.aim / level.max(1e-9)).clamp(self.least, self.most) as f32;
            let slope = (next - gain) / Self::EVERY as f32;
            for (x, y) in a.iter_mut().zip(b) {
                gain += slope;
                *x = (*x * gain).clamp(-1.0, 1.0);
                *y = (*y * gain).clamp(-1.0, 1.0);
            }
        }
    }
}

/// Hop of the spectral gates: 16 ms; their windows are two hops long.
const BLOCK: usize = 256;

impl Suppression {
    fn run(&self, samples: &mut [f32]) {
        let n = 2 * BLOCK;
        let (forward, inverse) = (soffio_fourier::real_forward(n), soffio_fourier::real_inverse(n));
        let window: Vec<f64> = (0..n).map(|i| sin(PI * (i as f64 + 0.5) / n as f64)).collect();
        let (mut time, mut bins) = (vec![0.0; n], forward.make_output_vec());
        let mut scratch = vec![Complex::default(); forward.get_scratch_len().max(inverse.get_scratch_len())];
        let mut floor = vec![f64::INFINITY; BLOCK + 1];
        let mut gains = vec![1.0; BLOCK + 1];
        let mut smooth = vec![0.0; BLOCK + 1];
        let mut out = vec![0.0_f32; samples.len() + n];
        for start in (0..samples.len()).step_by(BLOCK) {
            for (i, t) in time.iter_mut().enumerate() {
                *t = window[i] * samples.get(start + i).map_or(0.0, |x| f64::from(*x));
            }
            forward.process_with_scratch(&mut time, &mut bins, &mut scratch).expect("the plan's lengths");
            for (k, bin) in bins.iter_mut().enumerate() {
                let power = bin.norm_sqr();
                smooth[k] += 0.3 * (power - smooth[k]);
                // The least of the recent power, which may grow slowly, and no faster than the signal does.
                floor[k] = (floor[k] * self.rise).min(smooth[k].max(1e-12));
                let aim = (1.0 - self.over * 2.0 * floor[k] / power.max(1e-20)).max(self.floor);
                gains[k] += 0.6 * (aim - gains[k]);
                *bin *= gains[k] / n as f64;
            }
            (bins[0].im, bins[BLOCK].im) = (0.0, 0.0);
            inverse.process_with_scratch(&mut bins, &mut time, &mut scratch).expect("the plan's lengths");
            for (i, t) in time.iter().enumerate() {
                out[start + i] += (window[i] * t) as f32;
            }
        }
        samples.copy_from_slice(&out[..samples.len()]);
    }
}
