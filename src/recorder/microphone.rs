//! The kiosk's microphone.

use std::time::{Duration, Instant};

use soffio_config::Config;
use soffio_devices::audio::{AudioIo, MicrophoneSamples};
use soffio_sound::Synth;

use super::session::Recorded;

/// Time between two looks at the microphone.
const LOOK: Duration = Duration::from_millis(20);
/// Longest time without samples, at the beginning or when a device is unplugged.
const SILENT: Duration = Duration::from_secs(10);

/// An open microphone.
pub struct Microphone(AudioIo);

impl Microphone {
    /// Opens the microphone that the configuration names.
    pub fn open(config: &Config) -> Self {
        Self(AudioIo::start(&config.audio, Synth::silent))
    }

    /// Records from now on.
    ///
    /// # Errors
    /// No samples arrive, or no more.
    pub fn record(&mut self, seconds: f64) -> Result<Recorded, String> {
        let mut samples = MicrophoneSamples::default();
        // What waits was heard before.
        self.0.read_microphone(&mut samples);
        samples.clear();
        let (mut last, mut count) = (Instant::now(), 0);
        let mut rate = None;
        loop {
            std::thread::sleep(LOOK);
            rate = self.0.read_microphone(&mut samples).or(rate);
            let wanted = rate.map_or(usize::MAX, |rate| (seconds * f64::from(rate)) as usize);
            if samples.samples.len() >= wanted {
                break;
            }
            if samples.samples.len() > count {
                (last, count) = (Instant::now(), samples.samples.len());
            }
            if last.elapsed() > SILENT {
                return Err(format!(
                    "no samples arrive: {}. `soffio devices` lists microphones.",
                    self.0.status().input
                ));
            }
        }
        let mut channels = vec![std::mem::take(&mut *samples.samples)];
        channels.extend(Some(std::mem::take(&mut *samples.second)).filter(|second| !second.is_empty()));
        Ok(Recorded { channels, sample_rate: rate.unwrap_or(0) })
    }
}
