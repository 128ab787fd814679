//! Breaths for attract mode, synthesised instead of recorded: they are reproducible and contain no person's voice.
//!
//! 16 kHz, mono, 16 bit: the blow detector uses only frequencies below 6 kHz.

use std::io::Cursor;

use soffio_soundscape::breath::Breath;
use soffio_soundscape::microphone::Microphone;

/// Sample rate, Hz.
const SAMPLE_RATE: u32 = 16_000;
/// Peak pressure of full scale, Pa: a strong breath from 12 cm stays below it.
const FULL_SCALE_PA: f64 = 40.0;

/// A WAV file of a breath of `strength` m/s at the lips, `hold` s at full speed.
pub fn wav(strength: f64, hold: f64, seed: u64) -> Result<Vec<u8>, hound::Error> {
    let microphone = Microphone { full_scale_pa: FULL_SCALE_PA, overload_pa: FULL_SCALE_PA, ..Microphone::default() };
    let breath = Breath { lead_in: 0.4, speed: strength, hold, lead_out: 0.4, microphone, ..Breath::default() };
    let format = hound::WavSpec {
        channels: 1,
        sample_rate: SAMPLE_RATE,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    let mut file = Cursor::new(Vec::new());
    let mut writer = hound::WavWriter::new(&mut file, format)?;
    for sample in breath.recorded(SAMPLE_RATE, seed) {
        writer.write_sample((f32::from(i16::MAX) * sample.clamp(-1.0, 1.0)).round() as i16)?;
    }
    writer.finalize()?;
    Ok(file.into_inner())
}
