//! Outputs of a run for `soffio play` and `soffio replay`: sound, traces, events, pictures.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use indicatif::ProgressBar;

use crate::commands::arguments::parse_size;
use crate::commands::failure::Failure;
use soffio_exhibit::Exhibit;
use soffio_offline::play::{self, Play, Summary};
use soffio_offline::trace::DEFAULT_FPS;

/// Files and pictures of a run.
#[derive(clap::Args, Debug)]
pub struct Outputs {
    /// Sound of the run, stereo 48 kHz float.
    #[arg(long, value_name = "OUT.wav")]
    pub audio: Option<PathBuf>,
    /// Sound without reverberation and limiter.
    #[arg(long)]
    pub dry: bool,
    /// Poses of the moving bodies.
    #[arg(long, value_name = "OUT.csv")]
    pub trace: Option<PathBuf>,
    /// Events.
    #[arg(long, value_name = "OUT.jsonl")]
    pub events: Option<PathBuf>,
    /// Pictures, one PNG a frame, of the poses at its time.
    #[cfg(feature = "kiosk")]
    #[arg(long, value_name = "DIR")]
    pub frames: Option<PathBuf>,
    /// Video: .mp4, .mov or .mkv with the sound, by ffmpeg; .apng or .y4m without, by this program alone.
    #[cfg(feature = "kiosk")]
    #[arg(long, value_name = "OUT.mp4")]
    pub video: Option<PathBuf>,
    /// Size of the picture.
    #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "1280x720")]
    pub size: (u32, u32),
    /// Frames per second of trace, comparison and pictures.
    #[arg(long, default_value_t = DEFAULT_FPS, value_parser = clap::value_parser!(u32).range(1..=240))]
    pub fps: u32,
}

impl Outputs {
    /// Is an output requested that holds one run only?
    pub fn wants_files(&self) -> bool {
        let files = [&self.audio, &self.trace, &self.events];
        #[cfg(feature = "kiosk")]
        let pictures = self.frames.is_some() || self.video.is_some();
        #[cfg(not(feature = "kiosk"))]
        let pictures = false;
        pictures || files.iter().any(|file| file.is_some())
    }

    /// The run with these outputs.
    pub fn of(&self, play: Play) -> Play {
        let Self { audio, dry, trace, events, fps, .. } = self;
        Play { audio: audio.clone(), dry: *dry, trace: trace.clone(), events: events.clone(), fps: *fps, ..play }
    }

    /// Width over height of the picture.
    pub fn aspect(&self) -> f64 {
        f64::from(self.size.0) / f64::from(self.size.1)
    }

    /// Runs the exhibit without pictures.
    ///
    /// # Errors
    /// A file cannot be written, or the run fails.
    #[cfg(not(feature = "kiosk"))]
    pub fn perform(
        &self,
        exhibit: &Arc<Exhibit>,
        play: Play,
        stop: &AtomicBool,
        progress: &ProgressBar,
    ) -> Result<Summary, Failure> {
        play::run(exhibit, self.of(play), stop, |step| progress.set_position(step), None).map_err(Failure::of_run)
    }

    /// Runs the exhibit, and renders frames where requested.
    ///
    /// # Errors
    /// A file cannot be written, a picture cannot be drawn, or the run fails.
    #[cfg(feature = "kiosk")]
    pub fn perform(
        &self,
        exhibit: &Arc<Exhibit>,
        play: Play,
        stop: &AtomicBool,
        progress: &ProgressBar,
    ) -> Result<Summary, Failure> {
        let mut play = self.of(play);
        let on_step = |step| progress.set_position(step);
        let Some(mut filming) = super::filming::Filming::new(self, exhibit, play.seconds)? else {
            return play::run(exhibit, play, stop, on_step, None).map_err(Failure::of_run);
        };
        play.audio = play.audio.or_else(|| filming.sound());
        let sound = play.audio.clone();
        let mut on_frame = |number: u64, now: &_| filming.frame(number, now);
        let run = play::run(exhibit, play, stop, on_step, Some(&mut on_frame));
        let summary = run.map_err(|error| match &self.frames {
            Some(folder) if matches!(error, play::PlayError::Interrupted) => {
                let message = format!("interrupted; the frames so far are in {}, nothing else is", folder.display());
                Failure { code: 130, message }
            }
            _ => Failure::of_run(error),
        })?;
        filming.finish(sound.as_deref()).map_err(Failure::input)?;
        Ok(summary)
    }
}
