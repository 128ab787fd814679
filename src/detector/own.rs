//! What the microphone hears of the kiosk itself: predicted from what the loudspeaker played, then taken away.
//!
//! The path from loudspeaker to microphone is unknown: a delay of up to half a second (sound card, room), a gain per
//! band, reverberation. It is learnt from power envelopes alone, which no phase or clock drift can upset. For band b
//! and lag d, over a leaky memory of a few seconds, with x the played and y the heard power:
//!
//! ```text
//! c(b, d) = cov(x_d, y) / var(x_d)       regression: noise in y that is independent of x does not bias it
//! ρ(d)    = Σ_b cov(x_d, y) / √(Σ_b var x_d · var y), bands scaled alike     the lag is where ρ̄ is greatest
//! ŷ_k(t)  = margin · c(b) · max_{|δ| ≤ 32 ms} x_k(t − d − δ), falling no faster than the room rings
//! ```
//!
//! Noise in x does: single frames of played noise scatter by 5 dB, a room blurs that, and a slope taken over them is 2 dB
//! too low in the narrow lowest band. So both sides go through the same low-pass of 40 ms first.
//!
//! ρ̄ is the mean of ρ over a quarter of a minute: a sound that swells slowly says little of when it was played, and must
//! not outvote the hits before it. The greatest is taken over all lags that are about as likely.
//!
//! How the room rings is heard: where a band falls steadily, by its mean over 30 ms beside that over 120 ms, what was
//! predicted falls as the band does, and rings for 0.6 to 2.5 s.
//!
//! Until the first second of sound has been heard nothing is known, and a loudspeaker may be far louder than is guessed: no
//! breath begins in it.
//!
//! Three rules keep a breath from being mistaken for the kiosk's answer to it, which follows it and looks like it:
//! nothing is learnt while somebody blows; a loudspeaker is never credited with coupling better below 200 Hz than
//! above; and sustained output that is *not* heard lowers the gain (c ≤ 1.5 heard / least played over all lags, heard over
//! 120 ms: the dips of noise are no proof).

use super::features::blend;
use super::spectrum::{BINS, FRAME_S, Power, band};

/// Longest lag, frames (0.6 s).
const LAGS: usize = 75;
/// Band limits, bins of 15.6 Hz: 31, 203, 406, 812, 1625, 3400 Hz.
const EDGES: [usize; BANDS + 1] = [2, 13, 26, 52, 104, 218];
const BANDS: usize = 5;
/// Half width of the window about the lag, frames.
const SLACK: usize = 4;
/// Power above the prediction that still counts as own: smoothed noise scatters by this much (5 dB).
const MARGIN: f64 = 3.0;
/// Smoothing of the played spectra, s.
const SMOOTHING_S: f64 = 0.02;
/// The room keeps this part of the power from frame to frame, by reverberation times of 0.6 s at least and 2.5 s at most.
const RING: (f64, f64) = (0.83, 0.957);
/// Low-pass of both sides of the regression, s: longer than a room's first reflections, shorter than a hit rings.
const ENVELOPE_S: f64 = 0.04;
/// Means of what is heard, s, and the part of the longer one below which the shorter one is when a room rings for up to
/// 4 s: (1 − a τ₂)/(1 − a τ₁) with a = 6 ln 10/T60.
const MEANS_S: [f64; 2] = [0.03, 0.12];
const FALLING: f64 = 0.7;
/// Memory of the regression, s.
const MEMORY_S: f64 = 3.0;
/// Correlation of envelopes from which a lag is believed, memory of the correlations, s, and what share of the greatest
/// another lag must have to be about as likely.
const BELIEVED: f64 = 0.5;
const LAG_MEMORY_S: f64 = 15.0;
const LIKELY: f64 = 0.93;
/// Output below this power (−70 dBFS) cannot be told from silence.
const AUDIBLE: f64 = 1e-7;
/// What is heard may be this much less than is predicted before the gain is lowered.
const UNHEARD: f64 = 1.5;
/// The kiosk's first sound, s: twice the time in which the coupling is learnt.
const FIRST_S: f64 = 1.0;
/// Highest coupling: the microphone may be this much more sensitive than full scale out suggests (12 dB).
const LOUDEST: f64 = 16.0;

/// Leaky first and second moments of one band at one lag.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    x: f64,
    xx: f64,
    xy: f64,
}

/// Learns the path from loudspeaker to microphone and predicts what comes back.
#[derive(Clone, Debug)]
pub struct OwnVoice {
    /// Spectrum that is being played, smoothed: single frames of noise scatter by 5 dB and more.
    smooth: Power,
    /// Smoothed spectra that were played, a ring over the last `LAGS` frames.
    played: Vec<[f32; BINS]>,
    /// Band powers of what is played and of what is heard, as the regression sees them: both smoothed alike.
    envelopes: [[f64; BANDS]; 2],
    /// Those of what was played, a ring like the spectra.
    played_bands: [[f64; BANDS]; LAGS],
    next: usize,
    moments: [[Moments; BANDS]; LAGS],
    heard: [f64; BANDS],
    heard_square: [f64; BANDS],
    /// Means of what is heard per band, the shorter one first.
    means: [[f64; BANDS]; 2],
    /// Learnt power gain per band; 1 until something is learnt.
    coupling: [f64; BANDS],
    lag: Option<usize>,
    /// ρ̄ of each lag, and over how many frames it has been taken.
    correlation: [f64; LAGS],
    correlated: f64,
    /// Power of the kiosk's own sound at the microphone, margin included.
    pub predicted: Power,
    /// Frames until the last output has left the window: 0 means that the kiosk has long been silent.
    audible: usize,
    /// Frames in which there was output to be heard, since the beginning.
    sounded: usize,
}

impl OwnVoice {
    /// Nothing learnt.
    pub fn new() -> Self {
        Self {
            smooth: [0.0; BINS],
            played: vec![[0.0; BINS]; LAGS],
            envelopes: [[0.0; BANDS]; 2],
            played_bands: [[0.0; BANDS]; LAGS],
            next: 0,
            moments: [[Moments::default(); BANDS]; LAGS],
            heard: [0.0; BANDS],
            heard_square: [0.0; BANDS],
            means: [[0.0; BANDS]; 2],
            coupling: [1.0; BANDS],
            lag: None,
            correlation: [0.0; LAGS],
            correlated: 0.0,
            predicted: [0.0; BINS],
            audible: 0,
            sounded: 0,
        }
    }

    /// Takes one frame of both spectra; `learn` is false while somebody blows. Updates [`Self::predicted`].
    pub fn push(&mut self, microphone: &Power, own: &Power, learn: bool) {
        self.audible =
            if band(own, EDGES[0], EDGES[BANDS]) > AUDIBLE { 4 * LAGS } else { self.audible.saturating_sub(1) };
        if self.audible == 0 {
            self.predicted = [0.0; BINS];
            return;
        }
        self.sounded = self.sounded.saturating_add(1);
        self.next = (self.next + 1) % LAGS;
        for (s, x) in self.smooth.iter_mut().zip(own) {
            *s += blend(SMOOTHING_S) * (x - *s);
        }
        self.played[self.next] = std::array::from_fn(|k| self.smooth[k] as f32);
        let heard = bands(microphone);
        for (envelope, now) in self.envelopes.iter_mut().zip([&bands(own), &heard]) {
            follow(envelope, now, ENVELOPE_S);
        }
        for (means, seconds) in self.means.iter_mut().zip(MEANS_S) {
            follow(means, &heard, seconds);
        }
        self.played_bands[self.next] = self.envelopes[0];
        if learn {
            self.learn();
        }
        self.ring();
        self.predict();
    }

    /// Is this the kiosk's first sound, of which nobody can know yet how loud it comes back?
    pub fn is_first(&self) -> bool {
        self.audible > 0 && (self.sounded as f64) * FRAME_S < FIRST_S
    }

    /// Does the prediction cover a part of the low band that would spoil the picture of the room?
    pub fn masks(&self, microphone: &Power) -> bool {
        band(&self.predicted, EDGES[0], EDGES[1]) > 0.1 * band(microphone, EDGES[0], EDGES[1])
    }

    /// Index into the rings of what was played `lag` frames ago.
    fn at(&self, lag: usize) -> usize {
        (self.next + LAGS - lag) % LAGS
    }

    fn learn(&mut self) {
        let heard = self.envelopes[1];
        let blend = FRAME_S / MEMORY_S;
        for ((mean, square), y) in self.heard.iter_mut().zip(&mut self.heard_square).zip(&heard) {
            *mean += blend * (y - *mean);
            *square += blend * (y * y - *square);
        }
        let mut correlation = [0.0; LAGS];
        for lag in 0..LAGS {
            let played = self.played_bands[self.at(lag)];
            let (mut together, mut loudness) = (0.0, 0.0);
            for b in 0..BANDS {
                let (m, x) = (&mut self.moments[lag][b], played[b]);
                m.x += blend * (x - m.x);
                m.xx += blend * (x * x - m.xx);
                m.xy += blend * (x * heard[b] - m.xy);
                let variance_x = m.xx - m.x * m.x;
                let variance_y = self.heard_square[b] - self.heard[b] * self.heard[b];
                // Bands weigh by what they carry at both ends, so that an unused band says nothing.
                let scale = (variance_x * variance_y).max(0.0).sqrt();
                together += m.xy - m.x * self.heard[b];
                loudness += scale;
            }
            correlation[lag] = together / loudness.max(AUDIBLE * AUDIBLE);
        }
        if correlation.iter().any(|rho| *rho > BELIEVED) {
            self.correlated += 1.0;
            let blend = (FRAME_S / LAG_MEMORY_S).max(1.0 / self.correlated);
            self.correlation.iter_mut().zip(correlation).for_each(|(mean, rho)| *mean += blend * (rho - *mean));
            let best = (0..LAGS).max_by(|a, b| self.correlation[*a].total_cmp(&self.correlation[*b])).unwrap_or(0);
            self.lag = Some(best);
            for b in 0..BANDS {
                let m = self.moments[best][b];
                let variance = m.xx - m.x * m.x;
                if variance > AUDIBLE * AUDIBLE {
                    let slope = ((m.xy - m.x * self.heard[b]) / variance).clamp(0.0, LOUDEST);
                    self.coupling[b] += FRAME_S / 0.5 * (slope - self.coupling[b]);
                }
            }
        }
        for b in 0..BANDS {
            let least = self.played_bands.iter().map(|p| p[b]).fold(f64::INFINITY, f64::min);
            let bound = UNHEARD * self.means[1][b] / least.max(AUDIBLE);
            if least > AUDIBLE && bound < self.coupling[b] {
                self.coupling[b] += FRAME_S / 0.2 * (bound - self.coupling[b]);
            }
        }
    }

    /// Lets the prediction fall as the room does.
    fn ring(&mut self) {
        let [now, before] = self.means;
        for b in 0..BANDS {
            let predicted = band(&self.predicted, EDGES[b], EDGES[b + 1]).max(f64::MIN_POSITIVE);
            let falls = now[b] < FALLING * before[b];
            let keeps = if falls { (MARGIN * now[b] / predicted).clamp(RING.0, RING.1) } else { RING.0 };
            self.predicted[extent(b)].iter_mut().for_each(|p| *p *= keeps);
        }
    }

    fn predict(&mut self) {
        let least = self.lag.map_or(f64::NEG_INFINITY, |lag| LIKELY * self.correlation[lag]);
        let likely = |lag: usize| self.correlation[lag] >= least;
        let above = self.coupling[1..].iter().fold(0.0, |m: f64, c| m.max(*c));
        for lag in 0..LAGS {
            if !(lag.saturating_sub(SLACK)..(lag + SLACK + 1).min(LAGS)).any(likely) {
                continue;
            }
            let played = &self.played[self.at(lag)];
            for b in 0..BANDS {
                let coupling = if b == 0 { self.coupling[0].min(above) } else { self.coupling[b] };
                for (p, x) in self.predicted[extent(b)].iter_mut().zip(&played[extent(b)]) {
                    *p = p.max(MARGIN * coupling * f64::from(*x));
                }
            }
        }
    }
}

/// Bins of a band; the outermost ones reach to the ends of the spectrum.
fn extent(b: usize) -> std::ops::Range<usize> {
    let low = if b == 0 { 0 } else { EDGES[b] };
    low..if b + 1 == BANDS { BINS } else { EDGES[b + 1] }
}

/// One-pole low-pass of band powers.
fn follow(smooth: &mut [f64; BANDS], now: &[f64; BANDS], seconds: f64) {
    smooth.iter_mut().zip(now).for_each(|(mean, y)| *mean += blend(seconds) * (y - *mean));
}

fn bands(power: &Power) -> [f64; BANDS] {
    std::array::from_fn(|b| band(power, EDGES[b], EDGES[b + 1]))
}
