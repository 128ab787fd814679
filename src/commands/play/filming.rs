//! Pictures of a run: a folder of frames, a video, or both.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::outputs::Outputs;
use crate::commands::failure::Failure;
use soffio_exhibit::Exhibit;
use soffio_offline::pictures::{Pictures, write_png};
use soffio_offline::video::{Plan, Video};
use soffio_simulation::Snapshot;

/// Pictures that are being written.
pub(super) struct Filming {
    pictures: Pictures,
    folder: Option<PathBuf>,
    video: Option<Video>,
}

impl Filming {
    /// The requested pictures of a run of so many seconds; `None` where none are requested.
    ///
    /// # Errors
    /// There is no graphics device, or a file cannot be created.
    pub fn new(wanted: &Outputs, exhibit: &Arc<Exhibit>, seconds: f64) -> Result<Option<Self>, Failure> {
        if wanted.frames.is_none() && wanted.video.is_none() {
            return Ok(None);
        }
        let plan = wanted.video.as_deref().map(|path| Plan::new(path, wanted.size)).transpose();
        let plan = plan.map_err(|message| Failure { code: 2, message })?;
        let pictures = Pictures::new(exhibit, wanted.size).map_err(Failure::of_picture)?;
        if let Some(folder) = &wanted.frames {
            std::fs::create_dir_all(folder)
                .map_err(|e| Failure::input(format!("cannot make the folder {}: {e}", folder.display())))?;
        }
        let video = plan.map(|plan| {
            if let Some(note) = &plan.note {
                eprintln!("soffio: {note}");
            }
            // The frame at the very end would be shown when the sound is over.
            let frames = (seconds * f64::from(wanted.fps)).round() as u32;
            Video::create(&plan, wanted.size, wanted.fps, frames)
        });
        let video = video.transpose().map_err(Failure::input)?;
        Ok(Some(Self { pictures, folder: wanted.frames.clone(), video }))
    }

    /// Where the video wants the run's sound.
    pub fn sound(&self) -> Option<PathBuf> {
        self.video.as_ref().and_then(Video::sound)
    }

    /// Draws a frame.
    ///
    /// # Errors
    /// The picture cannot be drawn or written.
    pub fn frame(&mut self, number: u64, now: &Snapshot) -> Result<(), String> {
        let picture = self.pictures.draw(now).map_err(|e| e.to_string())?;
        if let Some(folder) = &self.folder {
            write_png(&picture, &folder.join(format!("{number:06}.png"))).map_err(|e| e.to_string())?;
        }
        self.video.as_mut().map_or(Ok(()), |video| video.push(&picture))
    }

    /// Ends the video with the run's sound.
    ///
    /// # Errors
    /// The video cannot be completed.
    pub fn finish(self, sound: Option<&Path>) -> Result<(), String> {
        self.video.map_or(Ok(()), |video| video.finish(sound))
    }
}
