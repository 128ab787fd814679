//! Sound of a run: the kiosk's synthesiser in a loop instead of a callback, with level and loudness meters.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use hound::{SampleFormat, WavSpec, WavWriter};

use super::atomic_file::AtomicFile;
use soffio_exhibit::Exhibit;
use soffio_math::amplitude_to_db;
use soffio_simulation::{SAMPLE_RATE, SAMPLES_PER_STEP};
use soffio_sound::{LoudnessMeter, MAX_COMMANDS, ReverbSpec, SoundCommand, Synth, peak};

const _: () = assert!(SAMPLE_RATE == LoudnessMeter::SAMPLE_RATE);
/// Number of channels.
const CHANNELS: u16 = 2;
/// Steps rendered as one block; the block size does not change the sound.
const STEPS_PER_BLOCK: usize = 24;
/// Samples of a step, both channels.
const STEP: usize = SAMPLES_PER_STEP as usize * CHANNELS as usize;

/// The sound of a run: measured, and optionally written to a file.
pub struct Soundtrack {
    synth: Synth,
    /// Buffer of some steps, with the numbers of pending steps and sound commands.
    block: Vec<f32>,
    steps: usize,
    sounds: usize,
    /// Samples of the limiter's look-ahead still to be dropped at the start, so that an impact sounds on its own
    /// sample.
    early: usize,
    peak: f32,
    loudness: LoudnessMeter,
    file: Option<AtomicWav>,
}

/// Levels of a whole run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Levels {
    /// Sample peak, dB of full scale; −∞ for silence.
    pub peak_dbfs: f64,
    /// Integrated loudness, LUFS (EBU R 128); −∞ for silence.
    pub lufs: f64,
}

impl Soundtrack {
    /// The exhibit's instruments with a reverb (`None` is the open air); `dry` bypasses reverb and limiter.
    ///
    /// # Errors
    /// Names the timbre or the file.
    pub fn new(
        exhibit: &Exhibit,
        seed: u64,
        reverb: Option<&ReverbSpec>,
        dry: bool,
        path: Option<&Path>,
    ) -> Result<Self, String> {
        let mut synth = Synth::new(SAMPLE_RATE, &exhibit.instruments, seed).map_err(|e| e.to_string())?;
        synth.set_dry(dry);
        synth.set_reverb(reverb);
        let file = path.map(AtomicWav::create).transpose()?;
        Ok(Self {
            early: synth.latency() * usize::from(CHANNELS),
            synth,
            block: vec![0.0; STEPS_PER_BLOCK * STEP],
            steps: 0,
            sounds: 0,
            peak: 0.0,
            loudness: LoudnessMeter::new(),
            file,
        })
    }

    /// Advances by one step of 200 samples with its sound commands.
    ///
    /// # Errors
    /// The file cannot be written; the reason.
    pub fn step(&mut self, sounds: &[SoundCommand]) -> Result<(), String> {
        if self.sounds + sounds.len() > MAX_COMMANDS {
            self.render()?;
        }
        for &sound in sounds {
            self.synth.command(sound);
        }
        self.steps += 1;
        self.sounds += sounds.len();
        if self.steps == STEPS_PER_BLOCK { self.render() } else { Ok(()) }
    }

    /// Renders the pending steps.
    fn render(&mut self) -> Result<(), String> {
        self.sounds = 0;
        let samples = std::mem::take(&mut self.steps) * STEP;
        self.keep(samples)
    }

    /// Renders, measures and writes so many samples.
    fn keep(&mut self, samples: usize) -> Result<(), String> {
        let block = &mut self.block[..samples];
        self.synth.render(block);
        let early = self.early.min(samples);
        self.early -= early;
        let block = &block[early..];
        self.peak = self.peak.max(peak(block));
        self.loudness.push(block.as_chunks().0);
        self.file.as_mut().map_or(Ok(()), |file| file.write(block))
    }

    /// Completes the file and returns the levels.
    ///
    /// # Errors
    /// The file cannot be written or renamed; the reason.
    pub fn finish(mut self) -> Result<Levels, String> {
        self.render()?;
        // The limiter's look-ahead is as long as the part dropped at the start.
        let held = self.synth.latency() * usize::from(CHANNELS) - self.early;
        self.keep(held)?;
        self.file.map_or(Ok(()), AtomicWav::finish)?;
        Ok(Levels { peak_dbfs: amplitude_to_db(f64::from(self.peak)), lufs: self.loudness.loudness() })
    }
}

/// A WAV written atomically, through a second handle of its file.
struct AtomicWav {
    writer: WavWriter<BufWriter<File>>,
    file: AtomicFile,
}

impl AtomicWav {
    fn create(path: &Path) -> Result<Self, String> {
        let file = AtomicFile::create(path).map_err(|e| e.to_string())?;
        let spec = WavSpec {
            channels: CHANNELS,
            sample_rate: SAMPLE_RATE,
            bits_per_sample: 32,
            sample_format: SampleFormat::Float,
        };
        let says = |e: &dyn std::fmt::Display| format!("cannot write {}: {e}", path.display());
        let handle = file.reopen().map_err(|e| says(&e))?;
        let writer = WavWriter::new(BufWriter::new(handle), spec).map_err(|e| says(&e))?;
        Ok(Self { writer, file })
    }

    fn write(&mut self, block: &[f32]) -> Result<(), String> {
        let written = block.iter().try_for_each(|&sample| self.writer.write_sample(sample));
        written.map_err(|e| format!("cannot write {}: {e}", self.file.path().display()))
    }

    fn finish(self) -> Result<(), String> {
        let path = self.file.path().to_path_buf();
        let says = |e: &dyn std::fmt::Display| format!("cannot write {}: {e}", path.display());
        self.writer.finalize().map_err(|e| says(&e))?;
        self.file.finish().map_err(|e| says(&e))
    }
}
