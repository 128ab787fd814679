//! WAV files: in (PCM 8–32 bit or float, 8–192 kHz, any channel count, down-mixed), out (32-bit float).
//!
//! Invariant: a file appears whole or not at all.

use std::path::{Path, PathBuf};

use super::atomic_file::AtomicFile;

/// Accepted sample rates, Hz.
pub const RATES_HZ: std::ops::RangeInclusive<u32> = 8_000..=192_000;
/// Accepted bits per sample.
const BITS: std::ops::RangeInclusive<u16> = 8..=32;

/// A recording, mixed down to mono.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Samples, full scale ±1; the mean of the channels.
    pub samples: Vec<f32>,
    /// Both channels of a stereo file, which may be two microphones.
    pub capsules: Option<[Vec<f32>; 2]>,
    /// Sample rate, Hz.
    pub sample_rate: u32,
}

impl Recording {
    /// Length, s.
    pub fn duration(&self) -> f64 {
        self.samples.len() as f64 / f64::from(self.sample_rate)
    }
}

/// Errors of WAV files: which file, what is wrong, what to do.
#[derive(Debug, thiserror::Error)]
pub enum WavError {
    /// The file does not exist or is not readable.
    #[error("{path}: cannot be opened ({source}). Check the path and its permissions.")]
    Open {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// Not a WAV, or a WAV that is neither PCM nor float.
    #[error(
        "{path}: not a WAV that Soffio reads ({reason}). Convert it to PCM or float, for example: sox INPUT -b 16 OUT.wav"
    )]
    Format {
        /// The file.
        path: PathBuf,
        /// The reader's error.
        reason: String,
    },
    /// The file ends before the number of samples in its header.
    #[error(
        "{path}: truncated: the header promises {promised} samples, the file ends after {found}. Copy or record it again."
    )]
    Truncated {
        /// The file.
        path: PathBuf,
        /// Samples of all channels according to the header.
        promised: usize,
        /// Samples found.
        found: usize,
    },
    /// The file has no samples.
    #[error("{path}: holds no samples. Record it again.")]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// A rate outside [`RATES_HZ`].
    #[error("{path}: {rate} Hz is outside 8000–192000 Hz. Resample it, for example: sox INPUT -r 48000 OUT.wav")]
    Rate {
        /// The file.
        path: PathBuf,
        /// Its rate, Hz.
        rate: u32,
    },
    /// The file could not be written.
    #[error("{0}")]
    Write(String),
}

/// Reads a WAV as mono.
///
/// # Errors
/// As [`WavError`] lists.
pub fn read(path: impl AsRef<Path>) -> Result<Recording, WavError> {
    let path = path.as_ref();
    let open = |source| WavError::Open { path: path.into(), source };
    let format = |reason: String| WavError::Format { path: path.into(), reason };
    let file = std::fs::File::open(path).map_err(open)?;
    if file.metadata().map_err(open)?.is_dir() {
        return Err(format("it is a folder".into()));
    }
    let mut reader = hound::WavReader::new(std::io::BufReader::new(file)).map_err(|error| format(error.to_string()))?;
    let spec = reader.spec();
    if !RATES_HZ.contains(&spec.sample_rate) {
        return Err(WavError::Rate { path: path.into(), rate: spec.sample_rate });
    }
    // The bit depth of an extended header can be any number.
    if !BITS.contains(&spec.bits_per_sample) {
        return Err(format(format!("says {} bits a sample, where 8 to 32 are read", spec.bits_per_sample)));
    }
    let promised = reader.len() as usize;
    // Samples are read until the first error; their number decides which error it is.
    let interleaved: Vec<f32> = match spec.sample_format {
        hound::SampleFormat::Float => reader.samples::<f32>().map_while(Result::ok).collect(),
        hound::SampleFormat::Int => {
            let full_scale = (1_i64 << (spec.bits_per_sample - 1)) as f64;
            let scaled = |sample: i32| (f64::from(sample) / full_scale) as f32;
            reader.samples::<i32>().map_while(Result::ok).map(scaled).collect()
        }
    };
    if interleaved.len() < promised {
        return Err(WavError::Truncated { path: path.into(), promised, found: interleaved.len() });
    }
    let channels = usize::from(spec.channels.max(1));
    let samples: Vec<f32> =
        interleaved.chunks_exact(channels).map(|frame| frame.iter().sum::<f32>() / channels as f32).collect();
    if samples.is_empty() {
        return Err(WavError::Empty { path: path.into() });
    }
    let channel = |c: usize| interleaved.iter().skip(c).step_by(2).copied().collect();
    let capsules = (channels == 2).then(|| [channel(0), channel(1)]);
    Ok(Recording { samples, capsules, sample_rate: spec.sample_rate })
}

/// Writes interleaved samples (full scale ±1) as 32-bit float, atomically.
///
/// # Errors
/// The file cannot be written.
pub fn write_float(path: impl AsRef<Path>, channels: u16, sample_rate: u32, samples: &[f32]) -> Result<(), WavError> {
    let path = path.as_ref();
    let fail = |error: std::io::Error| WavError::Write(error.to_string());
    let spec = hound::WavSpec { channels, sample_rate, bits_per_sample: 32, sample_format: hound::SampleFormat::Float };
    let file = AtomicFile::create(path).map_err(fail)?;
    let write = || -> hound::Result<()> {
        let mut writer = hound::WavWriter::new(std::io::BufWriter::new(file.reopen()?), spec)?;
        samples.iter().try_for_each(|&sample| writer.write_sample(sample))?;
        writer.finalize()
    };
    write().map_err(|error| WavError::Write(format!("cannot write {}: {error}", path.display())))?;
    file.finish().map_err(fail)
}
