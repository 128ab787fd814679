//! Rooms that sound: impulse responses of shoeboxes by image sources (Allen and Berkley, JASA 65, 1979).
//!
//! ```text
//! h(t) = Σ_images  β^(reflections) / (4π r) · δ(t − r / c),     β = √(1 − α)
//! ```
//!
//! with α the mean absorption of the walls, r the way from the image to the microphone, c the speed of sound. Beyond the
//! images an exponential tail of noise goes on, of Sabine's reverberation time T = 0.161 V / (α S). A wall takes more of
//! the high notes: one pole per response, the lower the longer the room rings.

use soffio_fourier::Complex;

use soffio_detector::generate::filter;
use soffio_math::noise::Random;
use soffio_math::{DVec3, PI, exp};

use super::RATE;

/// Speed of sound, m/s.
const SOUND_M_S: f64 = 343.0;
/// Images are taken up to this way, s.
const IMAGES_S: f64 = 0.12;
/// Longest response, s.
const LONGEST_S: f64 = 0.6;
/// Below this, sound from everywhere is the same at both capsules: sin(k d)/(k d) is a half at 2.1 kHz where they are 5 cm
/// apart, Hz.
pub const ALIKE_HZ: f64 = 2000.0;
/// Between two capsules, m.
pub const SPACING_M: (f64, f64) = (0.02, 0.06);
/// Length of the transform of a convolution.
const BLOCK: usize = 1 << 15;

/// A shoebox with a microphone in it.
#[derive(Clone, Debug)]
pub struct Room {
    size: DVec3,
    absorption: f64,
    microphone: DVec3,
    /// From the first capsule to the second, m.
    second: DVec3,
    /// Reverberation time, s.
    pub t60: f64,
}

impl Room {
    /// A room between a cabinet and a hall.
    pub fn random(random: &mut Random) -> Self {
        let size = DVec3::new(random.range(5.0, 25.0), random.range(4.0, 18.0), random.range(2.8, 6.0));
        let absorption = random.range(0.1, 0.45);
        Self::new(size, absorption, random)
    }

    /// A room of this size (m) and mean absorption, with a kiosk somewhere near one of its walls.
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

    /// Between the two capsules, m.
    pub fn spacing(&self) -> f64 {
        self.second.length()
    }

    /// A place where a source may be, at least half a metre from the walls.
    pub fn place(&self, random: &mut Random) -> DVec3 {
        let along = |from: f64, random: &mut Random| random.range(0.5, from - 0.5);
        DVec3::new(along(self.size.x, random), along(self.size.y, random), random.range(0.1, 2.0))
    }

    /// A place this far from the microphone (as far as the room allows), somewhere about it.
    pub fn near(&self, distance: f64, random: &mut Random) -> DVec3 {
        let turn = random.range(0.0, 2.0 * PI);
        let at = self.microphone
            + distance * DVec3::new(soffio_math::cos(turn), soffio_math::sin(turn), random.range(-0.4, 0.6));
        at.clamp(DVec3::splat(0.1), self.size - 0.1)
    }

    /// The response from a place to one of the capsules (0 or 1), of unit energy at the first.
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

    /// Goes on where the images end, as loud as they are there. What comes late comes from everywhere: its low end is of the
    /// first seed, the same at both capsules, its high end of the other.
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

/// `sound` as it arrives through `response`, of the same length (overlap and add).
pub fn convolved(sound: &[f64], response: &[f64]) -> Vec<f64> {
    let (forward, back) = (soffio_fourier::forward(BLOCK), soffio_fourier::inverse(BLOCK));
    let response = &response[..response.len().min(BLOCK / 2)];
    let mut filter = vec![Complex::ZERO; BLOCK];
    filter.iter_mut().zip(response).for_each(|(z, h)| z.re = h / BLOCK as f64);
    forward.process(&mut filter);
    let step = BLOCK - response.len() + 1;
    let mut out = vec![0.0; sound.len()];
    let mut buffer = vec![Complex::ZERO; BLOCK];
    // Two pieces a transform: one in the real, one in the imaginary part.
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
