//! Breaths for attract mode, synthesised instead of recorded: they are reproducible and contain no person's voice.
//!
//! 16 kHz, mono, 16 bit: the blow detector uses only frequencies below 6 kHz.

use std::io::Cursor;

use soffio_detector::generate::{BreathShape, breath};

/// Sample rate, Hz.
const SAMPLE_RATE: u32 = 16_000;

/// A WAV file of a breath of `strength` m/s at the lips, `hold` s at full speed.
pub fn wav(strength: f64, hold: f64, seed: u64) -> Result<Vec<u8>, hound::Error> {
    let shape = BreathShape { lead_in: 0.4, strength, hold, lead_out: 0.4, ..BreathShape::default() };
    let format = hound::WavSpec {
        channels: 1,
        sample_rate: SAMPLE_RATE,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    let mut file = Cursor::new(Vec::new());
    let mut writer = hound::WavWriter::new(&mut file, format)?;
    for sample in breath(SAMPLE_RATE, seed, &shape) {
        writer.write_sample((f32::from(i16::MAX) * sample.clamp(-1.0, 1.0)).round() as i16)?;
    }
    writer.finalize()?;
    Ok(file.into_inner())
}
