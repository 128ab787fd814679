//! The sound of a run: the kiosk's own synth, called by a loop instead of a callback; levels and loudness on the way.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use hound::{SampleFormat, WavSpec, WavWriter};

use super::whole_file::WholeFile;
use soffio_exhibit::Exhibit;
use soffio_math::decibels;
use soffio_simulation::{SAMPLE_RATE, SAMPLES_PER_STEP};
use soffio_sound::{LoudnessMeter, MAX_COMMANDS, ReverbSpec, SoundCommand, Synth, peak};

const _: () = assert!(SAMPLE_RATE == LoudnessMeter::SAMPLE_RATE);
/// Stereo.
const CHANNELS: u16 = 2;
/// Steps whose sound is made at once: how it is cut does not matter to it, and there is less to begin and to end.
const TOGETHER: usize = 24;
/// Samples of a step, of both channels.
const STEP: usize = SAMPLES_PER_STEP as usize * CHANNELS as usize;

/// The sound of a run, measured, and written where asked.
pub struct Soundtrack {
    synth: Synth,
    /// Room for the sound of some steps; how many wait for theirs, and how many sounds do.
    block: Vec<f32>,
    steps: usize,
    sounds: usize,
    /// Samples of the limiter's look-ahead still to be left out at the beginning, so that a hit sounds on its sample.
    early: usize,
    peak: f32,
    loudness: LoudnessMeter,
    file: Option<WholeWav>,
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
    /// The exhibit's instruments in a room (`None` is the open air); `dry` bypasses room and limiter. Errors name the timbre
    /// or the file.
    pub fn new(
        exhibit: &Exhibit,
        seed: u64,
        room: Option<&ReverbSpec>,
        dry: bool,
        path: Option<&Path>,
    ) -> Result<Self, String> {
        let mut synth = Synth::new(SAMPLE_RATE, &exhibit.instruments, seed).map_err(|e| e.to_string())?;
        synth.set_dry(dry);
        synth.set_reverb(room);
        let file = path.map(WholeWav::create).transpose()?;
        Ok(Self {
            early: synth.latency() * usize::from(CHANNELS),
            synth,
            block: vec![0.0; TOGETHER * STEP],
            steps: 0,
            sounds: 0,
            peak: 0.0,
            loudness: LoudnessMeter::new(),
            file,
        })
    }

    /// Goes on by one step's 200 samples with the sounds that fall into it.
    pub fn step(&mut self, sounds: &[SoundCommand]) -> Result<(), String> {
        if self.sounds + sounds.len() > MAX_COMMANDS {
            self.render()?;
        }
        for &sound in sounds {
            self.synth.command(sound);
        }
        self.steps += 1;
        self.sounds += sounds.len();
        if self.steps == TOGETHER { self.render() } else { Ok(()) }
    }

    /// Renders the steps that wait.
    fn render(&mut self) -> Result<(), String> {
        self.sounds = 0;
        let samples = std::mem::take(&mut self.steps) * STEP;
        self.keep(samples)
    }

    /// Renders so many samples, measures and writes them.
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

    /// Puts the file in its place and says how loud it was.
    pub fn finish(mut self) -> Result<Levels, String> {
        self.render()?;
        // What the limiter still holds: as much as was left out at the beginning.
        let held = self.synth.latency() * usize::from(CHANNELS) - self.early;
        self.keep(held)?;
        self.file.map_or(Ok(()), WholeWav::finish)?;
        Ok(Levels { peak_dbfs: decibels(f64::from(self.peak)), lufs: self.loudness.loudness() })
    }
}

/// A WAV on its way: written through a second handle of its file.
struct WholeWav {
    writer: WavWriter<BufWriter<File>>,
    file: WholeFile,
}

impl WholeWav {
    fn create(path: &Path) -> Result<Self, String> {
        let file = WholeFile::create(path).map_err(|e| e.to_string())?;
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
