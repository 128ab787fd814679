//! Sound charts for curators: for each timbre its waveform, spectrogram, spectrum and decay times as a picture, its
//! sound as a WAV, and a page that shows them all.

pub(super) mod canvas;
pub(super) mod chart;
mod measure;

use std::io::{Cursor, Write};
use std::path::Path;

use image::RgbImage;

use super::atomic_file::AtomicFile;
use super::audition::{AuditionError, TestSound};
use super::wav;
use canvas::{Align, Canvas, Colour, FIRST, INK, PALE, SECOND, THIRD};
use chart::{Axis, Chart, short};
use measure::Frames;
use soffio_simulation::SAMPLE_RATE;
use soffio_sound::modes::T60_DECAYS;
use soffio_sound::timbre::Specimen;
use soffio_sound::{Mode, Preset, partials};

/// Width of a picture, pixels.
const WIDTH: u32 = 1600;
const HEIGHT: u32 = 1080;
/// Length of sustained sounds (wind, slide), and shortest and longest length of struck ones, s.
const SUSTAINED_SECONDS: f64 = 6.0;
const MIN_SECONDS: f64 = 0.5;
const MAX_SECONDS: f64 = 8.0;
/// Range of the charts, dB below their maximum.
const RANGE: f64 = 90.0;

/// Errors of a sound page.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// A timbre cannot be rendered.
    #[error(transparent)]
    Sound(#[from] AuditionError),
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] std::io::Error),
    /// A sound could not be written.
    #[error(transparent)]
    Wav(#[from] wav::WavError),
    /// A picture could not be encoded.
    #[error("{0}")]
    Picture(#[from] image::ImageError),
}

/// A timbre with its specimen and its test sound.
pub type Subject = (Preset, Specimen, TestSound);

/// Writes `NAME.png` and `NAME.wav` for each timbre and an `index.html`; creates the folder if missing.
///
/// # Errors
/// A file cannot be written, or a timbre does not fit its specimen.
pub fn write(folder: &Path, subjects: &[Subject]) -> Result<(), PageError> {
    std::fs::create_dir_all(folder)?;
    let mut page = String::from(HEAD);
    for subject in subjects {
        let (preset, ..) = subject;
        let sheet = TimbreSheet::new(subject)?;
        wav::write_float(folder.join(format!("{}.wav", preset.name)), 1, SAMPLE_RATE, &sheet.sound)?;
        let mut bytes = Vec::new();
        sheet.draw()?.write_to(&mut Cursor::new(&mut bytes), image::ImageFormat::Png)?;
        whole(&folder.join(format!("{}.png", preset.name)), &bytes)?;
        let (name, about) = (escaped(&preset.name), escaped(&preset.description));
        page += &format!(
            "<h2 id=\"{name}\">{name}</h2>\n<p>{about}</p>\n<audio controls src=\"{name}.wav\"></audio>\n\
             <img src=\"{name}.png\" alt=\"Waveform, spectrum and decay of {name}: {}\">\n",
            escaped(&sheet.values_line())
        );
    }
    whole(&folder.join("index.html"), page.as_bytes())?;
    Ok(())
}

const HEAD: &str = "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>Soffio: the sounds</title>\n\
    <style>body{max-width:1100px;margin:2em auto;padding:0 1em;font:16px/1.5 sans-serif;color:#2a2c30;background:#fcfbf8}\
    img{width:100%}audio{display:block;margin:.5em 0}</style>\n<h1>The sounds</h1>\n";

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

fn whole(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut file = AtomicFile::create(path)?;
    file.write_all(bytes)?;
    file.finish()
}

/// A timbre, rendered and measured.
struct TimbreSheet<'a> {
    preset: &'a Preset,
    modes: Vec<Mode>,
    sound: Vec<f32>,
    /// Sustained sounds at half and at twice the speed; empty for struck ones.
    others: Vec<Vec<f32>>,
}

impl<'a> TimbreSheet<'a> {
    fn new((preset, specimen, audition): &'a Subject) -> Result<Self, PageError> {
        let modes = partials(preset, &specimen.spec(&preset.name)).map_err(AuditionError::from)?;
        let longest = modes.iter().map(|mode| T60_DECAYS / mode.decay).fold(0.0, f64::max);
        let seconds =
            if preset.continuous() { SUSTAINED_SECONDS } else { (0.8 * longest).clamp(MIN_SECONDS, MAX_SECONDS) };
        let mut others = Vec::new();
        if preset.continuous() {
            for factor in [0.5, 2.0] {
                let other = Specimen { wind: factor * specimen.wind, slip: factor * specimen.slip, ..*specimen };
                others.push(audition.render(preset, &other, seconds)?);
            }
        }
        Ok(Self { preset, modes, sound: audition.render(preset, specimen, seconds)?, others })
    }

    /// The measured values of the sound in one line.
    fn values_line(&self) -> String {
        let rate = f64::from(SAMPLE_RATE);
        let mut parts = vec![
            format!("peak {:.1} dBFS at 1 m", measure::peak(&self.sound)).replace('-', "−"),
            format!("loudest 50 ms {:.1} dBFS", measure::loudest(&self.sound, rate)).replace('-', "−"),
        ];
        if let (Some(first), Some(last)) = (self.modes.first(), self.modes.last()) {
            let mut t60: Vec<f64> = self.modes.iter().map(|mode| T60_DECAYS / mode.decay).collect();
            t60.sort_by(f64::total_cmp);
            let range = format!("{} to {} Hz", short(first.frequency.round()), short(last.frequency.round()));
            parts.push(format!("{} partials, {range}", self.modes.len()));
            parts.push(format!("T60 {:.2} to {:.2} s", t60[0], t60[t60.len() - 1]));
        }
        parts.join("  ·  ")
    }

    fn draw(&self) -> Result<RgbImage, PageError> {
        let mut canvas = Canvas::new(WIDTH, HEIGHT);
        canvas.words(70.0, 62.0, 40.0, Align::Left, INK, &self.preset.name);
        canvas.words(70.0, 94.0, 21.0, Align::Left, PALE, &self.preset.description);
        canvas.words(1540.0, 94.0, 18.0, Align::Right, INK, &self.values_line());
        let seconds = self.sound.len() as f64 / f64::from(SAMPLE_RATE);
        self.wave(&mut canvas, [70.0, 160.0, 960.0, 190.0], 0.0, seconds, "Waveform");
        let (from, length) = if self.preset.continuous() { (2.0, 0.06) } else { (0.0, 0.03) };
        let title = if self.preset.continuous() { "60 ms of it" } else { "The first 30 ms" };
        self.wave(&mut canvas, [1110.0, 160.0, 430.0, 190.0], from, length, title);
        self.spectrogram(&mut canvas, [70.0, 450.0, 670.0, 520.0], seconds);
        self.spectrum(&mut canvas, [820.0, 450.0, 720.0, if self.modes.is_empty() { 520.0 } else { 220.0 }]);
        if !self.modes.is_empty() {
            self.decay(&mut canvas, [820.0, 765.0, 720.0, 205.0]);
        }
        Ok(canvas.finish())
    }

    /// Waveform between two times.
    fn wave(&self, canvas: &mut Canvas, place: [f64; 4], from: f64, length: f64, title: &str) {
        let rate = f64::from(SAMPLE_RATE);
        let (start, count) = ((from * rate) as usize, (length * rate) as usize);
        let part = &self.sound[start.min(self.sound.len())..(start + count).min(self.sound.len())];
        let top = part.iter().fold(1e-6f32, |m, x| m.max(x.abs()));
        let scale = if length < 0.2 { 1000.0 } else { 1.0 };
        let chart = Chart {
            place,
            x: Axis::linear(0.0, length * scale),
            y: Axis::linear(-1.05 * f64::from(top), 1.05 * f64::from(top)),
        };
        chart.frame(canvas, title, if scale > 1.0 { "ms" } else { "s" }, "full scale = 1");
        if part.len() > 2 * place[2] as usize {
            // With more samples than pixels, draw the range within each column.
            let per = part.len() as f64 / place[2];
            for column in 0..place[2] as usize {
                let first = |column: usize| (column as f64 * per) as usize;
                let cell = &part[first(column)..(first(column + 1) + 1).min(part.len())];
                let low = cell.iter().copied().fold(f32::MAX, f32::min);
                let high = cell.iter().copied().fold(f32::MIN, f32::max);
                let t = chart.x.value((column as f64 + 0.5) / place[2]);
                canvas.line(chart.point(t, f64::from(low)), chart.point(t, f64::from(high)), 1.0, FIRST);
            }
        } else {
            let points: Vec<[f64; 2]> =
                part.iter().enumerate().map(|(i, x)| chart.point(scale * i as f64 / rate, f64::from(*x))).collect();
            canvas.path(&points, 1.4, FIRST);
        }
    }

    /// Spectrogram: power over time and frequency.
    fn spectrogram(&self, canvas: &mut Canvas, place: [f64; 4], seconds: f64) {
        let short_sound = seconds < 1.0;
        let frames = Frames::new(&self.sound, f64::from(SAMPLE_RATE), if short_sound { 1024 } else { 4096 });
        let chart = Chart {
            place,
            x: Axis::linear(0.0, seconds),
            y: Axis::logarithmic(if short_sound { 80.0 } else { 40.0 }, 20_000.0),
        };
        let top = frames.rows.iter().flatten().copied().fold(1e-20, f64::max);
        let [left, upper, width, height] = place;
        for row in 0..height as usize {
            let (low, high) =
                (chart.y.value(1.0 - (row as f64 + 1.0) / height), chart.y.value(1.0 - row as f64 / height));
            let first = (low / frames.bin).round() as usize;
            let last = ((high / frames.bin).round() as usize).max(first + 1);
            for column in 0..width as usize {
                let frame = (chart.x.value(column as f64 / width) / frames.hop) as usize;
                let bins = &frames.rows[frame.min(frames.rows.len() - 1)];
                let power = bins[first.min(bins.len() - 1)..last.min(bins.len())].iter().copied().fold(0.0, f64::max);
                let level = 1.0 + 10.0 * soffio_math::log10((power / top).max(1e-20)) / RANGE;
                canvas.dot((left + column as f64) as i64, (upper + row as f64) as i64, heat(level), 1.0);
            }
        }
        chart.frame_over(canvas, "Spectrogram", "s", &format!("Hz, {RANGE:.0} dB from dark to light"));
    }

    /// Power spectrum, also at the other speeds where there are any.
    fn spectrum(&self, canvas: &mut Canvas, place: [f64; 4]) {
        let rate = f64::from(SAMPLE_RATE);
        // The first half second of a struck sound, all of a sustained one.
        let part = |sound: &[f32]| {
            let end = if self.preset.continuous() { sound.len() } else { sound.len().min(rate as usize / 2) };
            let begin = if self.preset.continuous() { end / 8 } else { 0 };
            Frames::new(&sound[begin..end], rate, 8192)
        };
        let own = part(&self.sound);
        let others: Vec<Frames> = self.others.iter().map(|sound| part(sound)).collect();
        let top = own.mean().into_iter().chain(others.iter().flat_map(Frames::mean)).fold(1e-20, f64::max);
        let top = (10.0 * soffio_math::log10(top) / 10.0).ceil() * 10.0;
        let chart = Chart { place, x: Axis::logarithmic(40.0, 20_000.0), y: Axis::linear(top - RANGE, top) };
        let title = if self.preset.continuous() { "Spectrum" } else { "Spectrum of the first half second" };
        chart.frame(canvas, title, "Hz", "dBFS");
        for (frames, colour) in others.iter().zip([THIRD, SECOND]) {
            curve(canvas, &chart, frames, colour);
        }
        curve(canvas, &chart, &own, FIRST);
        if !others.is_empty() {
            let what = if self.preset.slides() { "slip" } else { "wind" };
            let mut x = place[0] + 14.0;
            for (words, colour) in [("half the ", THIRD), ("as said: ", FIRST), ("twice the ", SECOND)] {
                let words = format!("{words}{what}");
                x += canvas.words(x, place[1] + 24.0, 15.0, Align::Left, colour, &words) + 22.0;
            }
        }
    }

    /// Decay times: nominal for each partial, measured for each half octave.
    fn decay(&self, canvas: &mut Canvas, place: [f64; 4]) {
        let short_sound = self.sound.len() < SAMPLE_RATE as usize;
        let frames = Frames::new(&self.sound, f64::from(SAMPLE_RATE), if short_sound { 512 } else { 2048 });
        let heard = if self.preset.continuous() { Vec::new() } else { measure::decays(&frames) };
        let t60 = |mode: &Mode| T60_DECAYS / mode.decay;
        let all = || self.modes.iter().map(t60).chain(heard.iter().map(|(_, t)| *t));
        let (low, high) = (all().fold(f64::MAX, f64::min), all().fold(0.0, f64::max));
        let chart = Chart { place, x: Axis::logarithmic(40.0, 20_000.0), y: Axis::logarithmic(low / 1.6, high * 1.6) };
        chart.frame(canvas, "Decay", "Hz", "T60, s");
        let loudest = self.modes.iter().map(|m| m.amplitude.abs()).fold(1e-20, f64::max);
        for mode in &self.modes {
            let size = (1.0 + 0.25 * (soffio_math::amplitude_to_db(mode.amplitude.abs() / loudest) + 40.0) / 10.0)
                .clamp(0.3, 2.0);
            canvas.disc(chart.point(mode.frequency, t60(mode)), 2.2 * size, FIRST, 0.75);
        }
        for &(hz, seconds) in &heard {
            let [x, y] = chart.point(hz, seconds);
            canvas.line([x - 6.0, y - 6.0], [x + 6.0, y + 6.0], 2.0, SECOND);
            canvas.line([x - 6.0, y + 6.0], [x + 6.0, y - 6.0], 2.0, SECOND);
        }
        let x = place[0] + 8.0;
        let y = place[1] + place[3] + 38.0;
        canvas.disc([x + 4.0, y - 4.0], 4.0, FIRST, 1.0);
        let first = 16.0 + canvas.words(x + 16.0, y, 14.0, Align::Left, FIRST, "partials");
        if !heard.is_empty() {
            canvas.words(x + first + 20.0, y, 14.0, Align::Left, SECOND, "× half octaves, as heard");
        }
    }
}

fn curve(canvas: &mut Canvas, chart: &Chart, frames: &Frames, colour: Colour) {
    let mean = frames.mean();
    let columns = chart.place[2] as usize;
    let points: Vec<[f64; 2]> = (0..columns)
        .map(|column| {
            let (low, high) =
                (chart.x.value(column as f64 / columns as f64), chart.x.value((column + 1) as f64 / columns as f64));
            let first = (low / frames.bin).round() as usize;
            let last = ((high / frames.bin).round() as usize).clamp(first + 1, mean.len().max(first + 1));
            let power = mean[first.min(mean.len() - 1)..last.min(mean.len())].iter().copied().fold(0.0, f64::max);
            chart.point(low, 10.0 * soffio_math::log10(power.max(1e-30)))
        })
        .collect();
    canvas.path(&points, 1.5, colour);
}

/// Colour of a level 0…1, dark to light.
fn heat(level: f64) -> Colour {
    const COLOURS: [[f64; 3]; 6] = [
        [16.0, 18.0, 30.0],
        [44.0, 36.0, 92.0],
        [120.0, 44.0, 110.0],
        [204.0, 74.0, 76.0],
        [246.0, 158.0, 70.0],
        [252.0, 246.0, 196.0],
    ];
    let x = level.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    let i = (x as usize).min(COLOURS.len() - 2);
    let t = x - i as f64;
    std::array::from_fn(|k| (COLOURS[i][k] + t * (COLOURS[i + 1][k] - COLOURS[i][k])).round() as u8)
}
