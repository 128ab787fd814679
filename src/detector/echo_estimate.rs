//! Acoustic echo estimation: predicts the loudspeaker's power at the microphone, band by band, so that it can be subtracted.
//!
//! The path from loudspeaker to microphone is unknown: a delay of up to half a second (sound card, room), a gain per band, and
//! reverberation. It is learnt from power envelopes alone, which phase and clock drift do not disturb. For band b and lag d, over
//! an exponential average of a few seconds, with x the played and y the received power:
//!
//! ```text
//! c(b, d) = cov(x_d, y) / var(x_d)       regression: noise in y that is independent of x does not bias it
//! ρ(d)    = Σ_b cov(x_d, y) / √(Σ_b var x_d · var y), bands scaled alike     the lag is where ρ̄ is greatest
//! ŷ_k(t)  = margin · c(b) · max_{|δ| ≤ 32 ms} x_k(t − d − δ), decaying no faster than the room's reverberation
//! ```
//!
//! Noise in x would bias the slope: single frames of played noise scatter by 5 dB, the room blurs them, and the slope of the narrow
//! lowest band would be 2 dB too low. So both sides first pass the same low-pass of 40 ms.
//!
//! ρ̄ is the mean of ρ over 15 s, so that a slowly swelling sound, which has no clear lag, does not outvote earlier impacts. The
//! maximum is taken over all lags of nearly the highest correlation.
//!
//! The reverberation is measured: where a band falls steadily, by its average over 30 ms against that over 120 ms, the prediction
//! falls with it, at reverberation times of 0.6 to 2.5 s.
//!
//! During the first second of sound the coupling is unknown, and the loudspeaker may be far louder than assumed. No breath begins
//! then.
//!
//! Three rules keep a breath from being taken for the kiosk's response, which follows it and resembles it:
//!
//! - nothing is learnt during a breath;
//! - the coupling below 200 Hz is never higher than that above;
//! - sustained output that does *not* arrive lowers the coupling: c ≤ 1.5 · received power / least played power over all lags. The
//!   received power is averaged over 120 ms, since dips of noise prove nothing.

use super::bands::blend;
use super::spectrum::{BINS, FRAME_S, Power, band};

/// Longest lag, frames (0.6 s).
const LAGS: usize = 75;
/// Band limits, bins of 15.6 Hz: 31, 203, 406, 812, 1625, 3400 Hz.
const EDGES: [usize; BANDS + 1] = [2, 13, 26, 52, 104, 218];
const BANDS: usize = 5;
/// Half width of the window about the lag, frames.
const SLACK: usize = 4;
/// Margin over the predicted power, for the scatter of smoothed noise (5 dB).
const MARGIN: f64 = 3.0;
/// Smoothing of the played spectra, s.
const SMOOTHING_S: f64 = 0.02;
/// Range of the decay of power from frame to frame: reverberation times of 0.6 to 2.5 s.
const RING_DECAY: (f64, f64) = (0.83, 0.957);
/// Low-pass of both sides of the regression, s: longer than a room's first reflections, shorter than a struck body sounds.
const ENVELOPE_S: f64 = 0.04;
/// Time constants τ₁ and τ₂ of the averages of the received power, s.
const AVERAGES_S: [f64; 2] = [0.03, 0.12];
/// Ratio of the shorter average to the longer one below which a band decays. For a reverberation time of up to 4 s it is
/// (1 − a τ₂)/(1 − a τ₁) with a = 6 ln 10/T60.
const FALLING: f64 = 0.7;
/// Time constant of the regression, s.
const MEMORY_S: f64 = 3.0;
/// Correlation of envelopes from which a lag is used.
const MIN_CORRELATION: f64 = 0.5;
/// Time constant of the correlations, s.
const LAG_MEMORY_S: f64 = 15.0;
/// Share of the greatest correlation from which another lag is nearly as likely.
const LIKELY: f64 = 0.93;
/// Power of an output that counts as sound (−70 dBFS).
const AUDIBLE: f64 = 1e-7;
/// Largest ratio of the predicted power to the received one before the coupling is lowered.
const MAX_OVERPREDICTION: f64 = 1.5;
/// Length of sound before the coupling is known, s: twice its time constant.
const LEARNING_S: f64 = 1.0;
/// Largest coupling: the microphone may be this much more sensitive than full scale of the output suggests (12 dB).
const MAX_COUPLING: f64 = 16.0;

/// Averaged first and second moments of one band at one lag.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    x: f64,
    xx: f64,
    xy: f64,
}

/// Estimator of the loudspeaker's echo at the microphone.
#[derive(Clone, Debug)]
pub struct EchoEstimate {
    /// Played spectrum, smoothed: single frames of noise scatter by 5 dB and more.
    smooth: Power,
    /// Smoothed played spectra, a ring over the last `LAGS` frames.
    played: Vec<[f32; BINS]>,
    /// Band powers that are played and received, smoothed alike for the regression.
    envelopes: [[f64; BANDS]; 2],
    /// Band powers that were played, a ring like the spectra.
    played_bands: [[f64; BANDS]; LAGS],
    next: usize,
    moments: [[Moments; BANDS]; LAGS],
    /// Mean of the received band powers.
    mic_mean: [f64; BANDS],
    /// Mean square of the received band powers.
    mic_mean_square: [f64; BANDS],
    /// Averages of the received band powers, the shorter one first.
    averages: [[f64; BANDS]; 2],
    /// Power gain of each band; 1 until it is learnt.
    coupling: [f64; BANDS],
    lag: Option<usize>,
    /// ρ̄ of each lag.
    correlation: [f64; LAGS],
    /// Number of frames in ρ̄.
    correlated: f64,
    /// Predicted power of the echo at the microphone, margin included.
    pub predicted: Power,
    /// Frames until the last output has left the window; 0 in long silence.
    audible: usize,
    /// Frames with sound since the beginning.
    sounded: usize,
}

impl EchoEstimate {
    /// An estimator that knows no path yet.
    pub fn new() -> Self {
        Self {
            smooth: [0.0; BINS],
            played: vec![[0.0; BINS]; LAGS],
            envelopes: [[0.0; BANDS]; 2],
            played_bands: [[0.0; BANDS]; LAGS],
            next: 0,
            moments: [[Moments::default(); BANDS]; LAGS],
            mic_mean: [0.0; BANDS],
            mic_mean_square: [0.0; BANDS],
            averages: [[0.0; BANDS]; 2],
            coupling: [1.0; BANDS],
            lag: None,
            correlation: [0.0; LAGS],
            correlated: 0.0,
            predicted: [0.0; BINS],
            audible: 0,
            sounded: 0,
        }
    }

    /// Takes one frame of both spectra and updates [`Self::predicted`]; `learn` is false during a breath.
    pub fn push(&mut self, microphone: &Power, reference: &Power, learn: bool) {
        self.audible =
            if band(reference, EDGES[0], EDGES[BANDS]) > AUDIBLE { 4 * LAGS } else { self.audible.saturating_sub(1) };
        if self.audible == 0 {
            self.predicted = [0.0; BINS];
            return;
        }
        self.sounded = self.sounded.saturating_add(1);
        self.next = (self.next + 1) % LAGS;
        for (s, x) in self.smooth.iter_mut().zip(reference) {
            *s += blend(SMOOTHING_S) * (x - *s);
        }
        self.played[self.next] = std::array::from_fn(|k| self.smooth[k] as f32);
        let microphone_bands = bands(microphone);
        for (envelope, now) in self.envelopes.iter_mut().zip([&bands(reference), &microphone_bands]) {
            smooth_into(envelope, now, ENVELOPE_S);
        }
        for (averages, seconds) in self.averages.iter_mut().zip(AVERAGES_S) {
            smooth_into(averages, &microphone_bands, seconds);
        }
        self.played_bands[self.next] = self.envelopes[0];
        if learn {
            self.learn();
        }
        self.decay_prediction();
        self.predict();
    }

    /// True during the first second of sound, while the coupling is unknown.
    pub fn is_learning(&self) -> bool {
        self.audible > 0 && (self.sounded as f64) * FRAME_S < LEARNING_S
    }

    /// Index into the rings of played spectra, `lag` frames ago.
    fn at(&self, lag: usize) -> usize {
        (self.next + LAGS - lag) % LAGS
    }

    fn learn(&mut self) {
        let received = self.envelopes[1];
        let blend = FRAME_S / MEMORY_S;
        for ((mean, square), y) in self.mic_mean.iter_mut().zip(&mut self.mic_mean_square).zip(&received) {
            *mean += blend * (y - *mean);
            *square += blend * (y * y - *square);
        }
        let mut correlation = [0.0; LAGS];
        for lag in 0..LAGS {
            let played = self.played_bands[self.at(lag)];
            let (mut covariance, mut scale) = (0.0, 0.0);
            for b in 0..BANDS {
                let (m, x) = (&mut self.moments[lag][b], played[b]);
                m.x += blend * (x - m.x);
                m.xx += blend * (x * x - m.xx);
                m.xy += blend * (x * received[b] - m.xy);
                let variance_x = m.xx - m.x * m.x;
                let variance_y = self.mic_mean_square[b] - self.mic_mean[b] * self.mic_mean[b];
                // Bands are weighted by their power at both ends, so that an unused band does not count.
                let deviation = (variance_x * variance_y).max(0.0).sqrt();
                covariance += m.xy - m.x * self.mic_mean[b];
                scale += deviation;
            }
            correlation[lag] = covariance / scale.max(AUDIBLE * AUDIBLE);
        }
        if correlation.iter().any(|rho| *rho > MIN_CORRELATION) {
            self.correlated += 1.0;
            let blend = (FRAME_S / LAG_MEMORY_S).max(1.0 / self.correlated);
            self.correlation.iter_mut().zip(correlation).for_each(|(mean, rho)| *mean += blend * (rho - *mean));
            let best = (0..LAGS).max_by(|a, b| self.correlation[*a].total_cmp(&self.correlation[*b])).unwrap_or(0);
            self.lag = Some(best);
            for b in 0..BANDS {
                let m = self.moments[best][b];
                let variance = m.xx - m.x * m.x;
                if variance > AUDIBLE * AUDIBLE {
                    let slope = ((m.xy - m.x * self.mic_mean[b]) / variance).clamp(0.0, MAX_COUPLING);
                    self.coupling[b] += FRAME_S / 0.5 * (slope - self.coupling[b]);
                }
            }
        }
        for b in 0..BANDS {
            let minimum = self.played_bands.iter().map(|p| p[b]).fold(f64::INFINITY, f64::min);
            let bound = MAX_OVERPREDICTION * self.averages[1][b] / minimum.max(AUDIBLE);
            if minimum > AUDIBLE && bound < self.coupling[b] {
                self.coupling[b] += FRAME_S / 0.2 * (bound - self.coupling[b]);
            }
        }
    }

    /// Lets the prediction decay with the room's reverberation.
    fn decay_prediction(&mut self) {
        let [now, before] = self.averages;
        for b in 0..BANDS {
            let predicted = band(&self.predicted, EDGES[b], EDGES[b + 1]).max(f64::MIN_POSITIVE);
            let is_decaying = now[b] < FALLING * before[b];
            let decay = if is_decaying {
                (MARGIN * now[b] / predicted).clamp(RING_DECAY.0, RING_DECAY.1)
            } else {
                RING_DECAY.0
            };
            self.predicted[band_bins(b)].iter_mut().for_each(|p| *p *= decay);
        }
    }

    fn predict(&mut self) {
        let minimum = self.lag.map_or(f64::NEG_INFINITY, |lag| LIKELY * self.correlation[lag]);
        let likely = |lag: usize| self.correlation[lag] >= minimum;
        let above = self.coupling[1..].iter().fold(0.0, |m: f64, c| m.max(*c));
        for lag in 0..LAGS {
            if !(lag.saturating_sub(SLACK)..(lag + SLACK + 1).min(LAGS)).any(likely) {
                continue;
            }
            let played = &self.played[self.at(lag)];
            for b in 0..BANDS {
                let coupling = if b == 0 { self.coupling[0].min(above) } else { self.coupling[b] };
                for (p, x) in self.predicted[band_bins(b)].iter_mut().zip(&played[band_bins(b)]) {
                    *p = p.max(MARGIN * coupling * f64::from(*x));
                }
            }
        }
    }
}

/// Bins of a band; the outermost bands extend to the ends of the spectrum.
fn band_bins(b: usize) -> std::ops::Range<usize> {
    let low = if b == 0 { 0 } else { EDGES[b] };
    low..if b + 1 == BANDS { BINS } else { EDGES[b + 1] }
}

/// One-pole low-pass of band powers.
fn smooth_into(smooth: &mut [f64; BANDS], now: &[f64; BANDS], seconds: f64) {
    smooth.iter_mut().zip(now).for_each(|(mean, y)| *mean += blend(seconds) * (y - *mean));
}

fn bands(power: &Power) -> [f64; BANDS] {
    std::array::from_fn(|b| band(power, EDGES[b], EDGES[b + 1]))
}
