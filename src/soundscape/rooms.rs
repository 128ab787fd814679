//! Room acoustics: impulse responses of shoebox rooms by image sources (Allen and Berkley, JASA 65, 1979).
//!
//! ```text
//! h(t) = Σ_images  β^(reflections) / (4π r) · δ(t − r / c),     β = √(1 − α)
//! ```
//!
//! α is the mean absorption of the walls, r the distance from the image to the microphone, and c the speed of sound. After the images
//! follows an exponential tail of noise with Sabine's reverberation time T = 0.161 V / (α S). Walls absorb more at high frequencies:
//! each response passes one pole, which is lower for a longer reverberation.

use soffio_fourier::Complex;

use crate::filters as filter;
use soffio_math::noise::Random;
use soffio_math::{DVec3, PI, exp};

use super::RATE;

/// Speed of sound, m/s.
const SOUND_M_S: f64 = 343.0;
/// Travel time up to which images are computed, s.
const IMAGES_S: f64 = 0.12;
/// Longest response, s.
const LONGEST_S: f64 = 0.6;
/// Frequency below which diffuse sound is the same at both capsules, Hz: sin(k d)/(k d) is 0.5 at 2.1 kHz for a spacing of 5 cm.
pub const ALIKE_HZ: f64 = 2000.0;
/// Range of the spacing of two capsules, m.
pub const SPACING_M: (f64, f64) = (0.02, 0.06);
/// Length of the transform of a convolution.
const BLOCK: usize = 1 << 15;

/// A shoebox room with a microphone.
#[derive(Clone, Debug)]
pub struct Room {
    size: DVec3,
    absorption: f64,
    microphone: DVec3,
    /// Vector from the first capsule to the second, m.
    second: DVec3,
    /// Reverberation time, s.
    pub t60: f64,
}

impl Room {
    /// A random room, between a cabinet and a hall.
    pub fn random(random: &mut Random) -> Self {
        let size = DVec3::new(random.range(5.0, 25.0), random.range(4.0, 18.0), random.range(2.8, 6.0));
        let absorption = random.range(0.1, 0.45);
        Self::new(size, absorption, random)
    }

    /// A room of a size (m) and mean absorption, with a kiosk near one of its walls.
    pub fn new(size: DVec3, absorption: f64, random: &mut Random) -> Self {
        let surface = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
        let microphone = size * DVec3::new(random.range(0.2, 0.8), random.range(0.1, 0.4), 0.0)
            + DVec3::new(0.0, 0.0, random.range(0.9, 1.4));
        let turn = random.range(0.0, PI);
        let spacing = random.range(SPACING_M.0, SPACING_M.1);
        let second = DVec3::new(soffio_math::cos(turn), soffio_math::sin(turn), 0.0) * spacing;
        let t60 = (0.161 * size.x * size.y * size.z / (absorption * surface)).clamp(0.2, 3.0);
        Self { size, absorption, microphone, second, t60 }
    }

    /// Spacing of the two capsules, m.
    pub fn spacing(&self) -> f64 {
        self.second.length()
    }

    /// A random place of a source, at least half a metre from the walls.
    pub fn place(&self, random: &mut Random) -> DVec3 {
        let along = |from: f64, random: &mut Random| random.range(0.5, from - 0.5);
        DVec3::new(along(self.size.x, random), along(self.size.y, random), random.range(0.1, 2.0))
    }

    /// A random place at a distance from the microphone, m, within the room.
    pub fn near(&self, distance: f64, random: &mut Random) -> DVec3 {
        let turn = random.range(0.0, 2.0 * PI);
        let at = self.microphone
            + distance * DVec3::new(soffio_math::cos(turn), soffio_math::sin(turn), random.range(-0.4, 0.6));
        at.clamp(DVec3::splat(0.1), self.size - 0.1)
    }

    /// Impulse response from a place to one of the capsules (0 or 1), with unit energy at the first.
    pub fn response(&self, source: DVec3, capsule: usize, seed: u64) -> Vec<f64> {
        let rate = f64::from(RATE);
        let first = self.images(source, self.microphone, [seed, seed]);
        let scale = 1.0 / (filter::power(&first) * first.len() as f64).sqrt().max(1e-12);
        let mut response =
            if capsule == 0 { first } else { self.images(source, self.microphone + self.second, [seed, seed + 1]) };
        response.iter_mut().for_each(|h| *h *= scale);
        filter::low_passed(response, rate, 7000.0 / (1.0 + self.t60), 1)
    }

    fn images(&self, source: DVec3, microphone: DVec3, seeds: [u64; 2]) -> Vec<f64> {
        let rate = f64::from(RATE);
        let length = ((0.7 * self.t60).clamp(IMAGES_S, LONGEST_S) * rate) as usize;
        let reach = IMAGES_S * SOUND_M_S;
        let kept = (1.0 - self.absorption).sqrt();
        let mut response = vec![0.0; length + 2];
        let count = |size: f64| (reach / (2.0 * size)).ceil() as i32;
        for nx in -count(self.size.x)..=count(self.size.x) {
            for ny in -count(self.size.y)..=count(self.size.y) {
                for nz in -count(self.size.z)..=count(self.size.z) {
                    for mirror in 0..8 {
                        let flip = [mirror & 1, mirror >> 1 & 1, mirror >> 2];
                        let n = [nx, ny, nz];
                        let at = |i: usize| {
                            2.0 * f64::from(n[i]) * self.size[i] + (1.0 - 2.0 * f64::from(flip[i])) * source[i]
                        };
                        let way = DVec3::new(at(0), at(1), at(2)).distance(microphone);
                        if way > reach {
                            continue;
                        }
                        let bounces: i32 = (0..3).map(|i| (2 * n[i] - flip[i]).abs()).sum();
                        let gain = (0..bounces).fold(1.0, |g, _| g * kept) / (4.0 * PI * way.max(0.05));
                        let t = way / SOUND_M_S * rate;
                        let (i, part) = (t as usize, t.fract());
                        response[i] += gain * (1.0 - part);
                        response[i + 1] += gain * part;
                    }
                }
            }
        }
        self.add_tail(&mut response, (IMAGES_S * rate) as usize, seeds);
        response
    }

    /// Continues a response after the images, at their level. The late sound is diffuse: its low frequencies come from the first seed and
    /// are the same at both capsules, its high ones from the second.
    fn add_tail(&self, response: &mut [f64], from: usize, [low, high]: [u64; 2]) {
        let rate = f64::from(RATE);
        let level = filter::power(&response[from - from / 4..from]).sqrt();
        let noise = |seed: u64| {
            let mut random = Random::new(seed);
            (from..response.len()).map(|_| random.signed()).collect::<Vec<f64>>()
        };
        let tail = if low == high { noise(low) } else { filter::parted(noise(low), noise(high), rate, ALIKE_HZ) };
        for (i, (h, x)) in response[from..].iter_mut().zip(tail).enumerate() {
            *h += level * 1.7 * x * exp(-6.9 * i as f64 / rate / self.t60);
        }
    }
}

/// Convolution of `sound` with `response`, cut to the length of the sound (overlap-add).
pub fn convolved(sound: &[f64], response: &[f64]) -> Vec<f64> {
    let (forward, back) = (soffio_fourier::forward(BLOCK), soffio_fourier::inverse(BLOCK));
    let response = &response[..response.len().min(BLOCK / 2)];
    let mut filter = vec![Complex::ZERO; BLOCK];
    filter.iter_mut().zip(response).for_each(|(z, h)| z.re = h / BLOCK as f64);
    forward.process(&mut filter);
    let step = BLOCK - response.len() + 1;
    let mut out = vec![0.0; sound.len()];
    let mut buffer = vec![Complex::ZERO; BLOCK];
    // Two pieces per transform: one in the real part, one in the imaginary part.
    for start in (0..sound.len()).step_by(2 * step) {
        let middle = (start + step).min(sound.len());
        let end = (middle + step).min(sound.len());
        buffer.fill(Complex::ZERO);
        buffer.iter_mut().zip(&sound[start..middle]).for_each(|(z, x)| z.re = *x);
        buffer.iter_mut().zip(&sound[middle..end]).for_each(|(z, x)| z.im = *x);
        forward.process(&mut buffer);
        buffer.iter_mut().zip(&filter).for_each(|(z, h)| *z *= h);
        back.process(&mut buffer);
        out[start..].iter_mut().zip(&buffer).for_each(|(y, z)| *y += z.re);
        out[middle..].iter_mut().zip(&buffer).for_each(|(y, z)| *y += z.im);
    }
    out
}
