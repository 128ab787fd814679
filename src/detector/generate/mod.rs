//! Synthesis of breaths and noises as a microphone receives them, for tests, training and the recordings of attract mode.
//! Deterministic: the same seed gives the same samples at a rate.
//!
//! A breath that strikes a capsule makes two noises (Wuttke, "Microphones and Wind", JAES 1992; Morgan and Raspet 1992; jet noise
//! after Lighthill):
//!
//! ```text
//! U(t)   = U₀ · e(t) · (1 + g(t))        speed at the lips: envelope e, gusts g (22 % rms, below 14 Hz)
//! p_turb ~ near · U² · n_low             turbulence at the port: flat below f₁, −12 dB/octave above
//! p_jet  ~ U^2.5 · n_hiss / (1 + d/25 cm)   hiss of the jet, 0.4–6 kHz
//! f₁     = 40 Hz + 100 Hz · U₀/17        near = 1 / (1 + (d / 14 cm)²): share of the stream that arrives
//! near  ×= exp(−(θ / 22°)²) · foam       off the stream's axis (a jet is about 12° wide) and behind foam
//! ```
//!
//! Off the axis the hiss remains without the rumble, since sound spreads everywhere and the stream does not. Two capsules receive
//! the same hiss, and each its own turbulence: eddies at the port are millimetres wide. Each capsule also has its own d and θ. With
//! the lips at the origin, the middle of the capsules at D on z, their spacing s along x, and the stream along a:
//!
//! ```text
//! x_c = (±s/2, 0, D)      a = (sin θ cos φ, sin θ sin φ, cos θ)      d_c = |x_c|      θ_c = ∠(a, x_c)
//! ```
//!
//! So a stream that passes one near capsule is nearer to the other: at 5 cm spacing and 15 cm distance by 9.5 degrees. Last comes
//! the microphone: its high-pass corner, its noise, and soft saturation at full scale.

pub mod filter;

use filter::{gaussian, high_passed, low_passed, normalised, resonance};
use soffio_math::noise::{Random, hash_words};
use soffio_math::{DVec3, PI, atan2, cos, db_to_amplitude, exp, pow, sin, tanh};

/// Speed of the hardest blow, m/s; `strength` is relative to it.
pub const HARDEST_M_S: f64 = 17.0;
/// Angle from the axis of the stream at which the rumble has fallen to e⁻¹, degrees.
const JET_ANGLE_DEG: f64 = 22.0;

/// One breath in front of a microphone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BreathShape {
    /// Quiet before the breath, s.
    pub lead_in: f64,
    /// Peak speed at the lips, m/s (gentle 3.8, normal 8.9, strong 13.3, hard 17).
    pub strength: f64,
    /// Time from zero to the peak, s.
    pub attack: f64,
    /// Time at the peak, s; the speed falls by a quarter, as lungs empty.
    pub hold: f64,
    /// Time from there to zero, s.
    pub release: f64,
    /// Quiet after the breath, s.
    pub lead_out: f64,
    /// D, distance from lips to microphone, m.
    pub distance: f64,
    /// θ, angle between the axis of the stream and the line to the microphone, degrees.
    pub angle_deg: f64,
    /// s, spacing of two capsules side by side, m; 0 for one capsule.
    pub spacing: f64,
    /// φ, azimuth of the stream, degrees: 0 along the line of the capsules, towards the second one; 90 across it.
    pub azimuth_deg: f64,
    /// Attenuation of the rumble by a foam shield, dB.
    pub foam_db: f64,
    /// Corner of the rumble relative to f₁: capsules, grilles and lips differ.
    pub colour: f64,
    /// High-pass corner of the microphone, Hz (20 a bare capsule, 60 a USB gooseneck, 100 a laptop).
    pub corner_hz: f64,
    /// Noise of room and microphone, dB of full scale (RMS).
    pub noise_dbfs: f64,
}

impl Default for BreathShape {
    fn default() -> Self {
        Self {
            lead_in: 1.0,
            strength: 8.9,
            attack: 0.12,
            hold: 1.2,
            release: 0.3,
            lead_out: 1.0,
            distance: 0.1,
            angle_deg: 0.0,
            spacing: 0.0,
            azimuth_deg: 0.0,
            foam_db: 0.0,
            colour: 1.0,
            corner_hz: 60.0,
            noise_dbfs: -62.0,
        }
    }
}

impl BreathShape {
    /// Length of the recording, s.
    pub fn duration(&self) -> f64 {
        self.lead_in + self.attack + self.hold + self.release + self.lead_out
    }

    /// Length of the recording, samples.
    fn samples(&self, sample_rate: u32) -> usize {
        (self.duration() * f64::from(sample_rate)).round().max(0.0) as usize
    }

    /// Beginning and end of the air, s.
    pub fn span(&self) -> (f64, f64) {
        (self.lead_in, self.lead_in + self.attack + self.hold + self.release)
    }

    /// Distance d_c (m) and angle θ_c (degrees) of a capsule from the lips; the first capsule is 0, the second 1.
    pub fn path_to(&self, capsule: u64) -> (f64, f64) {
        let [angle, azimuth] = [self.angle_deg, self.azimuth_deg].map(f64::to_radians);
        let axis = DVec3::new(sin(angle) * cos(azimuth), sin(angle) * sin(azimuth), cos(angle));
        let at = DVec3::new((capsule as f64 - 0.5) * self.spacing, 0.0, self.distance);
        (at.length(), atan2(axis.cross(at).length(), axis.dot(at)).to_degrees())
    }

    /// Envelope e(t), 0 … 1: sin² up, a slow fall to three quarters, exponential down.
    pub fn envelope(&self, time: f64) -> f64 {
        let t = time - self.lead_in;
        let (hold_end, end) = (self.attack + self.hold, self.attack + self.hold + self.release);
        if t < 0.0 || t >= end {
            0.0
        } else if t < self.attack {
            let s = sin(0.5 * PI * t / self.attack);
            s * s
        } else if t < hold_end {
            1.0 - 0.25 * (t - self.attack) / self.hold
        } else {
            0.75 * exp(-4.0 * (t - hold_end) / self.release) * (end - t) / self.release
        }
    }
}

/// A recording of one breath, mono, full scale ±1.
pub fn breath(sample_rate: u32, seed: u64, shape: &BreathShape) -> Vec<f32> {
    let ambient = gaussian(shape.samples(sample_rate), &mut Random::new(hash_words(&[seed, 5])));
    let ambient = normalised(low_passed(ambient, f64::from(sample_rate), 1500.0, 1));
    let noise = db_to_amplitude(shape.noise_dbfs);
    let pressure = stream(sample_rate, seed, shape, 0);
    pressure.iter().zip(&ambient).map(|(x, n)| tanh(x + noise * n) as f32).collect()
}

/// Sound of a breath at one of several capsules (the first is 0), before noise and saturation.
pub fn stream(sample_rate: u32, seed: u64, shape: &BreathShape, capsule: u64) -> Vec<f64> {
    let rate = f64::from(sample_rate);
    let count = shape.samples(sample_rate);
    let force = shape.strength / HARDEST_M_S;
    let stream = |name: u64| Random::new(hash_words(&[seed, name]));
    let own = |name: u64| stream(name + 100 * capsule);
    let gust = normalised(low_passed(gaussian(count, &mut stream(1)), rate, 5.0, 2));
    let turbulence =
        normalised(low_passed(gaussian(count, &mut own(2)), rate, shape.colour * (40.0 + 100.0 * force), 2));
    let patches = normalised(low_passed(gaussian(count, &mut own(3)), rate, 12.0, 1));
    let hiss = low_passed(high_passed(gaussian(count, &mut stream(4)), rate, 400.0, 2), rate, 1800.0, 1);
    let hiss = normalised(low_passed(hiss, rate, 6000.0_f64.min(0.45 * rate), 1));

    let (distance, angle_deg) = shape.path_to(capsule);
    let distance_cm = 100.0 * distance;
    let beside = (angle_deg / JET_ANGLE_DEG) * (angle_deg / JET_ANGLE_DEG);
    let near = exp(-beside) * db_to_amplitude(-shape.foam_db) / (1.0 + (distance_cm / 14.0) * (distance_cm / 14.0));
    let far = 1.0 / (1.0 + distance_cm / 25.0);
    let air = (0..count).map(|i| {
        let speed = (force * shape.envelope(i as f64 / rate) * (1.0 + 0.22 * gust[i])).max(0.0);
        let turbulent = 1.6 * near * speed * speed * (0.6 + 0.4 * patches[i].abs()) * turbulence[i];
        turbulent + 0.09 * far * pow(speed, 2.5) * hiss[i]
    });
    high_passed(air.collect(), rate, shape.corner_hz, 2)
}

/// White noise of the given level, dB of full scale (RMS).
pub fn white_noise(sample_rate: u32, seed: u64, seconds: f64, dbfs: f64) -> Vec<f32> {
    scaled(gaussian(length(sample_rate, seconds), &mut Random::new(seed)), dbfs)
}

/// Noise that falls by 3 dB an octave, of the given level, dB of full scale (RMS).
pub fn pink_noise(sample_rate: u32, seed: u64, seconds: f64, dbfs: f64) -> Vec<f32> {
    let (count, rate) = (length(sample_rate, seconds), f64::from(sample_rate));
    // Low-passed noises a factor of four apart; each is √4 stronger per hertz than the next.
    let mut sum = vec![0.0; count];
    for stage in 0..6_u32 {
        let corner = 10.0 * f64::from(1_u32 << (2 * stage));
        let layer = gaussian(count, &mut Random::new(hash_words(&[seed, u64::from(stage)])));
        for (s, x) in sum.iter_mut().zip(normalised(low_passed(layer, rate, corner.min(0.4 * rate), 1))) {
            *s += x;
        }
    }
    scaled(sum, dbfs)
}

/// Mains hum: a fundamental (Hz) and its odd harmonics, of the given level, dB of full scale (RMS).
pub fn hum(sample_rate: u32, seconds: f64, fundamental_hz: f64, dbfs: f64) -> Vec<f32> {
    let tone = |i: usize| {
        let angle = 2.0 * PI * fundamental_hz * i as f64 / f64::from(sample_rate);
        sin(angle) + 0.4 * sin(3.0 * angle) + 0.2 * sin(5.0 * angle)
    };
    scaled((0..length(sample_rate, seconds)).map(tone).collect(), dbfs)
}

/// A voice on vowels: a wandering pitch about `pitch_hz`, three formants, three syllables a second.
pub fn voice(sample_rate: u32, seed: u64, seconds: f64, pitch_hz: f64, dbfs: f64) -> Vec<f32> {
    let rate = f64::from(sample_rate);
    let mut angle = 0.0;
    let mut pulses = Vec::with_capacity(length(sample_rate, seconds));
    for i in 0..length(sample_rate, seconds) {
        let time = i as f64 / rate;
        let syllable = sin(PI * 3.0 * time);
        let pitch = pitch_hz * (1.0 + 0.12 * soffio_math::noise::perlin1(2.0 * time, seed));
        angle += 2.0 * PI * pitch / rate;
        // A band-limited glottal pulse train: exp(a (cos θ − 1)) has all harmonics, falling smoothly.
        pulses.push(syllable * syllable * (exp(12.0 * (cos(angle) - 1.0)) - 0.2));
    }
    let mut out = vec![0.0; pulses.len()];
    for (formant, gain) in [(650.0, 1.0), (1200.0, 0.5), (2600.0, 0.25)] {
        for (o, x) in out.iter_mut().zip(resonance(&pulses, rate, formant, 90.0)) {
            *o += gain * x;
        }
    }
    scaled(out, dbfs)
}

/// Knocks on the table that carries the microphone: damped 30–90 Hz, with a click, at the given times (s).
pub fn knocks(sample_rate: u32, seed: u64, seconds: f64, times: &[f64], peak: f64) -> Vec<f32> {
    let rate = f64::from(sample_rate);
    let mut random = Random::new(seed);
    let mut out = vec![0.0; length(sample_rate, seconds)];
    for &start in times {
        let (pitch, decay) = (random.range(30.0, 90.0), random.range(0.03, 0.12));
        for (i, o) in out.iter_mut().enumerate().skip((start * rate) as usize) {
            let t = i as f64 / rate - start;
            *o += peak * (sin(2.0 * PI * pitch * t) * exp(-t / decay) + 0.3 * random.signed() * exp(-t / 0.004));
        }
    }
    out.into_iter().map(|x: f64| x.clamp(-1.0, 1.0) as f32).collect()
}

/// Steps and falling objects: bursts of low noise that decay within 40–150 ms, at the given times (s).
pub fn thuds(sample_rate: u32, seed: u64, seconds: f64, times: &[f64], peak: f64) -> Vec<f32> {
    let rate = f64::from(sample_rate);
    let mut random = Random::new(seed);
    let mut out = vec![0.0; length(sample_rate, seconds)];
    for &start in times {
        let (corner, decay) = (random.range(60.0, 400.0), random.range(0.04, 0.15));
        let count = (8.0 * decay * rate) as usize;
        let body = normalised(low_passed(gaussian(count, &mut random), rate, corner, 2));
        for (i, (o, x)) in out.iter_mut().skip((start * rate) as usize).zip(body).enumerate() {
            let t = i as f64 / rate;
            *o += peak * 0.4 * x * (1.0 - exp(-t / 0.002)) * exp(-t / decay);
        }
    }
    out.into_iter().map(|x: f64| x.clamp(-1.0, 1.0) as f32).collect()
}

/// Plosive puffs (p and b): 25–70 ms of low noise at the given times (s).
pub fn plosives(sample_rate: u32, seed: u64, seconds: f64, times: &[f64], peak: f64) -> Vec<f32> {
    let rate = f64::from(sample_rate);
    let mut random = Random::new(seed);
    let mut out = vec![0.0; length(sample_rate, seconds)];
    for &start in times {
        let count = (random.range(0.025, 0.07) * rate) as usize;
        let puff = low_passed(gaussian(4 * count, &mut random), rate, 90.0, 2);
        let puff = &puff[3 * count..];
        let top = puff.iter().fold(1e-12, |m: f64, x| m.max(x.abs()));
        for (i, (o, x)) in out.iter_mut().skip((start * rate) as usize).zip(puff).enumerate() {
            let hann = 0.5 - 0.5 * cos(2.0 * PI * i as f64 / count as f64);
            *o += peak * hann * x / top;
        }
    }
    out.into_iter().map(|x: f64| x.clamp(-1.0, 1.0) as f32).collect()
}

/// Adds `other` to `samples`, sample by sample, up to the shorter length.
pub fn mix(samples: &mut [f32], other: &[f32]) {
    samples.iter_mut().zip(other).for_each(|(a, b)| *a += b);
}

fn length(sample_rate: u32, seconds: f64) -> usize {
    (f64::from(sample_rate) * seconds).round().max(0.0) as usize
}

/// Scaled to a level in dB of full scale (RMS), cut at full scale.
fn scaled(samples: Vec<f64>, dbfs: f64) -> Vec<f32> {
    let gain = db_to_amplitude(dbfs);
    normalised(samples).into_iter().map(|x| (gain * x).clamp(-1.0, 1.0) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_of_two_capsules_has_its_own_path_to_the_lips() {
        /// Rounding, m and degrees.
        const EXACT: f64 = 1e-9;
        let blown = |angle_deg, azimuth_deg, spacing| BreathShape {
            distance: 0.15,
            angle_deg,
            azimuth_deg,
            spacing,
            ..BreathShape::default()
        };
        let near = |a: (f64, f64), b: (f64, f64)| (a.0 - b.0).abs() < EXACT && (a.1 - b.1).abs() < EXACT;
        let aside = (0.025_f64 / 0.15).atan().to_degrees();
        let away = 0.15_f64.hypot(0.025);
        let one = blown(40.0, 70.0, 0.0);
        assert!(near(one.path_to(0), (0.15, 40.0)) && near(one.path_to(1), (0.15, 40.0)), "{:?}", one.path_to(0));
        let straight = blown(0.0, 0.0, 0.05);
        assert!(near(straight.path_to(0), (away, aside)) && near(straight.path_to(1), (away, aside)));
        let along = blown(40.0, 0.0, 0.05);
        assert!(near(along.path_to(0), (away, 40.0 + aside)) && near(along.path_to(1), (away, 40.0 - aside)));
        let across = blown(40.0, 90.0, 0.05);
        assert!(near(across.path_to(0), across.path_to(1)) && across.path_to(0).1 > 40.0);
        // e^(−(θ/22°)²) of 30.5 and 49.5 degrees: the second one's rumble is 27 dB louder, and its hiss equal.
        let [first, second] = [0, 1].map(|capsule| stream(16000, 3, &along, capsule));
        let of = |part: fn(Vec<f64>) -> Vec<f64>, x: &[f64]| filter::power(&part(x.to_vec())).sqrt();
        let rumble = |x: Vec<f64>| low_passed(x, 16000.0, 100.0, 2);
        let hiss = |x: Vec<f64>| high_passed(x, 16000.0, 1500.0, 2);
        assert!(of(rumble, &second) > 5.0 * of(rumble, &first));
        assert!((of(hiss, &second) / of(hiss, &first) - 1.0).abs() < 0.05);
    }
}
