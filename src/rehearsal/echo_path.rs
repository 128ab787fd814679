//! Echo path from the kiosk's loudspeaker through its room to its microphone, as a real-time convolution.
//!
//! The impulse response is that of [`Room`] by image sources. It is applied block by block, as a uniformly partitioned convolution with
//! overlap-save (Stockham 1966; Gardner, JAES 43, 1995). The response is cut into parts of one block. Each part multiplies the spectrum
//! of the block that is as many blocks old.

use std::collections::VecDeque;
use std::sync::Arc;

use soffio_fourier::{Complex, ComplexToReal, RealToComplex, real_forward, real_inverse};

use super::blocks::BLOCK;
use super::rate::Decimator;
use soffio_math::noise::Random;
use soffio_math::{DVec3, PI, exp, tanh};
use soffio_soundscape::RATE;
use soffio_soundscape::microphone::pascals;
use soffio_soundscape::rooms::Room;

/// Rooms: name, size (m), mean absorption of the walls, speed of the draught at the kiosk (m/s).
pub const ROOMS: [(&str, [f64; 3], f64, f64); 4] = [
    ("cabinet", [6.0, 5.0, 3.0], 0.30, 0.0),
    ("gallery", [14.0, 9.0, 4.5], 0.20, 0.0),
    ("hall", [25.0, 16.0, 6.0], 0.12, 0.0),
    ("draughty-hall", [25.0, 16.0, 6.0], 0.12, 0.35),
];
/// Distance from loudspeaker to microphone, m: both stand at the kiosk.
const AWAY_M: f64 = 0.6;
/// Level of noise with an RMS of full scale at the microphone, dB of sound: the loudest that a site may set up.
const COUPLING_DB: f64 = 104.0;
/// Delay of sound card and system on the way out and in, blocks: 50 ms.
const LATENCY: usize = 5;
/// High-pass corner of a small loudspeaker, Hz.
const RESONANCE_HZ: f64 = 90.0;
/// Saturation of a small loudspeaker: output tanh(DRIVE · x) / DRIVE.
const DRIVE: f64 = 0.8;

/// The room of a name, with the kiosk in it; `None` for an unknown name.
pub fn room(name: &str, random: &mut Random) -> Option<Room> {
    let (_, size, absorption, _) = ROOMS.iter().find(|(known, ..)| *known == name)?;
    Some(Room::new(DVec3::from_array(*size), *absorption, random))
}

/// Echo of the loudspeaker at the microphone.
#[derive(Clone)]
pub struct EchoPath {
    decimator: Decimator,
    /// States of the loudspeaker's one-pole high passes.
    low: [f64; 2],
    /// Spectra of the response's parts, for each capsule.
    parts: Vec<Vec<Vec<Complex<f64>>>>,
    /// Spectra of the last blocks, the newest first.
    spectra: VecDeque<Vec<Complex<f64>>>,
    before: Vec<f64>,
    late: VecDeque<Vec<f64>>,
    forward: Arc<dyn RealToComplex<f64>>,
    back: Arc<dyn ComplexToReal<f64>>,
}

impl EchoPath {
    /// The path in a room, to 1 or 2 capsules.
    pub fn new(room: &Room, capsules: usize, random: &mut Random) -> Self {
        let (at, seed) = (room.near(AWAY_M, random), random.word());
        let (forward, back) = (real_forward(2 * BLOCK), real_inverse(2 * BLOCK));
        let gain = pascals(COUPLING_DB) / (2 * BLOCK) as f64;
        let part = |part: &[f64]| {
            let mut padded = vec![0.0; 2 * BLOCK];
            padded.iter_mut().zip(part).for_each(|(y, h)| *y = gain * h);
            spectrum(&*forward, &mut padded)
        };
        let parts = (0..capsules).map(|capsule| room.response(at, capsule, seed).chunks(BLOCK).map(part).collect());
        Self {
            decimator: Decimator::new(),
            low: [0.0; 2],
            parts: parts.collect(),
            spectra: VecDeque::new(),
            before: vec![0.0; BLOCK],
            late: vec![vec![0.0; BLOCK]; LATENCY].into(),
            forward,
            back,
        }
    }

    /// Echo at each capsule during a block of output (stereo at 48 kHz), Pa: a block at 16 kHz, of the output up to [`LATENCY`] blocks ago.
    pub fn process(&mut self, played: &[f32]) -> Vec<Vec<f64>> {
        let mono = played.as_chunks::<2>().0.iter().map(|[left, right]| 0.5 * f64::from(left + right));
        let mut sound = self.decimator.convert(mono);
        let keep = exp(-2.0 * PI * RESONANCE_HZ / f64::from(RATE));
        for x in &mut sound {
            for low in &mut self.low {
                *low = *x + keep * (*low - *x);
                *x -= *low;
            }
            *x = tanh(DRIVE * *x) / DRIVE;
        }
        self.late.push_back(sound);
        let sound = self.late.pop_front().unwrap_or_default();
        let mut both = std::mem::replace(&mut self.before, sound);
        both.extend_from_slice(&self.before);
        self.spectra.push_front(spectrum(&*self.forward, &mut both));
        self.spectra.truncate(self.parts.iter().map(Vec::len).max().unwrap_or_default());
        self.parts.iter().map(|parts| self.convolve(parts)).collect()
    }

    /// Current block of the convolution with one capsule's response.
    fn convolve(&self, parts: &[Vec<Complex<f64>>]) -> Vec<f64> {
        let mut sum = vec![Complex::ZERO; BLOCK + 1];
        for (part, spectrum) in parts.iter().zip(&self.spectra) {
            sum.iter_mut().zip(part.iter().zip(spectrum)).for_each(|(z, (h, x))| *z += h * x);
        }
        // The spectrum of a real signal is real at 0 Hz and at half the sample rate; rounding may leave an imaginary part.
        (sum[0].im, sum[BLOCK].im) = (0.0, 0.0);
        let mut out = vec![0.0; 2 * BLOCK];
        // Lengths agree by construction.
        if self.back.process(&mut sum, &mut out).is_err() {
            debug_assert!(false, "spectrum and block differ in length");
        }
        out.split_off(BLOCK)
    }
}

fn spectrum(forward: &dyn RealToComplex<f64>, samples: &mut [f64]) -> Vec<Complex<f64>> {
    let mut out = forward.make_output_vec();
    // Lengths agree by construction.
    if forward.process(samples, &mut out).is_err() {
        debug_assert!(false, "spectrum and block differ in length");
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_soundscape::rooms::convolved;

    #[test]
    fn blocks_equal_the_whole_convolution() {
        // Rounding of two transforms of different lengths.
        const ROUNDING: f64 = 1e-9;
        let mut random = Random::new(3);
        let hall = room("hall", &mut random).expect("a known room");
        let mut echo = EchoPath::new(&hall, 1, &mut random.clone());
        let response = hall.response(hall.near(AWAY_M, &mut random), 0, random.word());
        // A quiet sound does not saturate the loudspeaker. Its high pass is left out by comparing with its own output.
        let mut sounds = Vec::new();
        let mut received = Vec::new();
        for _ in 0..80 {
            let block: Vec<f32> = (0..BLOCK * super::super::rate::RATIO)
                .flat_map(|_| {
                    let x = (0.1 * random.signed()) as f32;
                    [x, x]
                })
                .collect();
            received.extend(echo.process(&block).remove(0));
            sounds.extend(echo.late.back().cloned().unwrap_or_default());
        }
        let whole = convolved(&sounds, &response);
        let delay = LATENCY * BLOCK;
        let furthest =
            received[delay..].iter().zip(&whole).map(|(a, b)| (a / pascals(COUPLING_DB) - b).abs()).fold(0.0, f64::max);
        assert!(furthest < ROUNDING, "{furthest}");
        assert!(whole.iter().any(|x| x.abs() > 0.01));
    }
}
