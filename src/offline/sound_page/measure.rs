//! Sound analysis for the charts: spectra, spectrograms, and the decay time of each band.

use soffio_fourier::real_forward;

use soffio_math::{PI, amplitude_to_db, cos, log10};

/// Power spectra of the frames of a sound.
pub struct Frames {
    /// Power of each bin of each frame, full-scale sine = 1.
    pub rows: Vec<Vec<f64>>,
    /// Distance of the bins, Hz.
    pub bin: f64,
    /// Distance of the frames, s.
    pub hop: f64,
}

impl Frames {
    /// Frames of `n` samples under a Hann window, each a quarter of `n` after the last.
    pub fn new(sound: &[f32], rate: f64, n: usize) -> Self {
        let transform = real_forward(n);
        let window: Vec<f64> = (0..n).map(|i| 0.5 - 0.5 * cos(2.0 * PI * i as f64 / n as f64)).collect();
        let mut bins = transform.make_output_vec();
        let mut rows = Vec::new();
        let hop = n / 4;
        // The first frame is centred on the first sample, so that the window keeps the attack.
        let mut start = -(n as i64) / 2;
        while start + (n as i64) / 2 < sound.len() as i64 {
            let at = |i: usize| {
                usize::try_from(start + i as i64).ok().and_then(|i| sound.get(i)).map_or(0.0, |x| f64::from(*x))
            };
            let mut part: Vec<f64> = window.iter().enumerate().map(|(i, w)| w * at(i)).collect();
            if transform.process(&mut part, &mut bins).is_ok() {
                let scale = 16.0 / (n * n) as f64;
                rows.push(bins.iter().map(|b| scale * b.norm_sqr()).collect());
            }
            start += hop as i64;
        }
        Self { rows, bin: rate / n as f64, hop: hop as f64 / rate }
    }

    /// Mean power of each bin over all frames.
    pub fn mean(&self) -> Vec<f64> {
        let mut sum = vec![0.0; self.rows.first().map_or(0, Vec::len)];
        for row in &self.rows {
            sum.iter_mut().zip(row).for_each(|(s, p)| *s += p / self.rows.len() as f64);
        }
        sum
    }

    /// Power between two frequencies in each frame.
    fn band(&self, low: f64, high: f64) -> Vec<f64> {
        let (first, last) = ((low / self.bin) as usize, (high / self.bin).ceil() as usize);
        self.rows.iter().map(|row| row[first.min(row.len() - 1)..last.min(row.len())].iter().sum()).collect()
    }
}

/// Audible T60 of half octaves: (Hz, s) of each band whose decay is long enough to measure.
pub fn decays(frames: &Frames) -> Vec<(f64, f64)> {
    /// Level at which the fit of the slope begins, dB relative to the band's maximum.
    const FIT_START: f64 = -3.0;
    /// Level at which it ends, dB relative to the band's maximum.
    const FIT_END: f64 = -23.0;
    /// Bands this far below the loudest are inaudible.
    const INAUDIBLE_RATIO: f64 = 1e-6;
    let mut out = Vec::new();
    let bands: Vec<(f64, Vec<f64>)> = (0..19)
        .map(|i| {
            let centre = 40.0 * soffio_math::pow(2.0, 0.5 * f64::from(i));
            (centre, frames.band(centre / 1.19, centre * 1.19))
        })
        .filter(|(centre, _)| *centre > 3.0 * frames.bin && *centre < 19_000.0)
        .collect();
    let top_of = |levels: &[f64]| levels.iter().copied().fold(0.0, f64::max);
    let loudest = bands.iter().map(|(_, levels)| top_of(levels)).fold(0.0, f64::max);
    for (centre, levels) in bands {
        let top = top_of(&levels);
        let start = levels.iter().position(|p| *p == top).unwrap_or(0);
        if top <= INAUDIBLE_RATIO * loudest {
            continue;
        }
        let fallen = |db: f64| levels[start..].iter().position(|p| 10.0 * log10(p / top) < db).map(|i| start + i);
        let (Some(from), Some(to)) = (fallen(FIT_START), fallen(FIT_END)) else { continue };
        if to < from + 3 {
            continue;
        }
        let points: Vec<(f64, f64)> =
            (from..to).map(|i| (i as f64 * frames.hop, 10.0 * log10(levels[i].max(1e-30)))).collect();
        let n = points.len() as f64;
        let (mx, my) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
        let slope = points.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum::<f64>()
            / points.iter().map(|p| (p.0 - mx) * (p.0 - mx)).sum::<f64>();
        if slope < 0.0 {
            out.push((centre, -60.0 / slope));
        }
    }
    out
}

/// Peak level, dBFS.
pub fn peak(sound: &[f32]) -> f64 {
    amplitude_to_db(f64::from(sound.iter().fold(0.0f32, |m, x| m.max(x.abs()))))
}

/// Level of the loudest 50 ms, root mean square, dBFS.
pub fn loudest(sound: &[f32], rate: f64) -> f64 {
    let n = (0.05 * rate) as usize;
    let power = |part: &[f32]| part.iter().map(|x| f64::from(*x) * f64::from(*x)).sum::<f64>() / part.len() as f64;
    amplitude_to_db(sound.chunks(n).map(power).fold(0.0, f64::max).sqrt())
}
