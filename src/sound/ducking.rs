//! Ducking: the wind makes way for bodies that ring.
//!
//! Wind and hits come from the same breath, and noise masks tones (Zwicker and Fastl, Psychoacoustics, chapter 4). With the
//! envelopes r of all that is not wind and w of the wind, and the headroom H that a hit needs over noise, q = r/(H w). The gain g
//! of the wind is
//!
//! ```text
//! q ≥ 1       g = G             a hit that stands out: the wind steps back all the same
//! L ≤ q < 1   g = G q           a hit that the wind would mask: just so far that it does not
//! q < L       g = G L (L/q)²    what has died away, or was never heard: the wind returns, up to 1
//! ```
//!
//! g falls and rises by a one-pole glide. All is computed sample by sample, so that it does not depend on blocks.

use soffio_math::exp;

/// G: gain of the wind under every audible hit, −7 dB: more than the 6 dB that are plainly heard as a step back.
const UNDER_A_HIT: f32 = 0.45;
/// H: level of a hit over the wind with which it stands out, 8 dB.
const HEADROOM: f32 = 2.5;
/// L: least q that the wind gives way to, −14 dB; with G, the wind falls by 21 dB at most.
const LEAST: f32 = 0.2;
/// Fall of the envelope of all but the wind, s: longer than the period of a beat, shorter than a chime rings.
const RINGING_FALL: f64 = 0.15;
/// Fall of the wind's envelope, s: it follows gusts.
const WIND_FALL: f64 = 0.05;
/// Time in which the wind steps back, s: shorter than the onset of a hit is heard.
const STEP_BACK: f64 = 0.001;
/// Time in which it returns, s: not heard as a pump.
const RETURN: f64 = 0.25;
/// Envelope below which nothing rings, or no wind blows: 16 bits.
const SILENT: f32 = 1.5e-5;

/// The ducking of one synth.
pub(super) struct Ducking {
    ringing: f32,
    wind: f32,
    gain: f32,
    falls: [f32; 2],
    glides: [f32; 2],
}

impl Ducking {
    /// At rest.
    pub fn new(sample_rate: f64) -> Self {
        let fall = |time: f64| exp(-1.0 / (time * sample_rate)) as f32;
        Self {
            ringing: 0.0,
            wind: 0.0,
            gain: 1.0,
            falls: [RINGING_FALL, WIND_FALL].map(fall),
            glides: [STEP_BACK, RETURN].map(|time| 1.0 - fall(time)),
        }
    }

    /// Adds the wind, both sides, to the rest of the mix.
    pub fn mix(&mut self, wind: [&[f32]; 2], mix: [&mut [f32]; 2]) {
        let ([wind_left, wind_right], [left, right]) = (wind, mix);
        for (((l, r), wl), wr) in left.iter_mut().zip(right).zip(wind_left).zip(wind_right) {
            self.ringing = l.abs().max(r.abs()).max(self.ringing * self.falls[0]);
            self.wind = wl.abs().max(wr.abs()).max(self.wind * self.falls[1]);
            let target = gain(self.ringing, self.wind);
            self.gain += (target - self.gain) * self.glides[usize::from(target > self.gain)];
            *l += wl * self.gain;
            *r += wr * self.gain;
        }
    }

    /// Lets the envelopes fall by so many samples without wind.
    pub fn skip(&mut self, mix: [&[f32]; 2]) {
        for (l, r) in mix[0].iter().zip(mix[1]) {
            self.ringing = l.abs().max(r.abs()).max(self.ringing * self.falls[0]);
            self.wind *= self.falls[1];
            let target = gain(self.ringing, self.wind);
            self.gain += (target - self.gain) * self.glides[usize::from(target > self.gain)];
        }
    }
}

/// g of both envelopes.
fn gain(ringing: f32, wind: f32) -> f32 {
    if ringing < SILENT || wind < SILENT {
        return 1.0;
    }
    let q = ringing / (HEADROOM * wind);
    if q >= LEAST {
        UNDER_A_HIT * q.min(1.0)
    } else {
        let fallen = LEAST / q;
        (UNDER_A_HIT * LEAST * fallen * fallen).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::amplitude_to_db;

    #[test]
    fn the_wind_steps_back_under_every_audible_hit_and_returns() {
        for (hit_db, least_step) in [(20.0, 6.0), (0.0, 12.0), (-6.0, 18.0)] {
            let (mut ducking, mut left, mut right) = (Ducking::new(48_000.0), [0.0f32; 48_000], [0.0f32; 48_000]);
            let hit = 0.01 * soffio_math::db_to_amplitude(hit_db);
            for i in 0..48_000 {
                let wind = if i % 2 == 0 { 0.01 } else { -0.01 };
                let ring = hit * exp(-(i as f64 - 9600.0) / 4800.0);
                let ringing = if i < 9600 { 0.0 } else { ring as f32 * if i % 3 == 0 { 1.0 } else { 0.0 } };
                let mut frame = ([0.0], [0.0]);
                let before = ringing;
                frame.0[0] = before;
                frame.1[0] = before;
                ducking.mix([&[wind], &[wind]], [&mut frame.0, &mut frame.1]);
                (left[i], right[i]) = (frame.0[0] - before, frame.1[0] - before);
            }
            let level =
                |at: usize| amplitude_to_db(f64::from(left[at..at + 480].iter().fold(0.0f32, |m, x| m.max(x.abs()))));
            let step = level(9000) - level(9600 + 480);
            assert!(step > least_step, "hit of {hit_db} dB: {step} dB");
            assert!((level(9000) - amplitude_to_db(0.01)).abs() < 0.1, "before the hit it is whole");
            // 20 dB below the wind after at most 4.6 time constants of 100 ms.
            assert!(hit_db > 10.0 || (level(47_000) - amplitude_to_db(0.01)).abs() < 1.0, "{}", level(47_000));
        }
        assert_eq!(gain(0.0, 0.1), 1.0);
        assert_eq!(gain(1e-4, 0.1), 1.0, "60 dB below the wind nothing is heard");
    }
}
