//! Headless demonstration: the exhibit reacts to its own recorded breath, and the run writes a picture, a sound file
//! and a trace.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::feed::WavFeed;
use super::play::{self, Play, Summary};
use super::trace::DEFAULT_FPS;
use soffio_exhibit::{AttractAction, Exhibit};
use soffio_simulation::{Settings, Snapshot};
use soffio_sound::ReverbSpec;

/// Time that the run continues after the breath, s.
const TAIL: f64 = 5.0;
/// Time of the picture after the start, s, when the sculpture has visibly turned.
const PICTURE_AT: f64 = 4.0;
/// Pixels of the picture.
#[cfg(feature = "pictures")]
const PICTURE_SIZE: (u32, u32) = (1280, 720);

/// Result of a headless run.
pub struct Demo {
    /// The run as numbers.
    pub summary: Summary,
    /// Files written.
    pub files: Vec<PathBuf>,
    /// Reason why there is no picture; `None` if there is one.
    pub no_picture: Option<String>,
}

/// Plays the exhibit's first recorded breath into `folder`, which is created if missing.
///
/// # Errors
/// Where a file cannot be written, or the run is interrupted.
pub fn run(exhibit: &Arc<Exhibit>, settings: Settings, folder: &Path, stop: &AtomicBool) -> Result<Demo, String> {
    std::fs::create_dir_all(folder).map_err(|e| format!("cannot make the folder {}: {e}", folder.display()))?;
    let file = |extension: &str| folder.join(format!("{}.{extension}", exhibit.id));
    let breath = exhibit.attract.steps.iter().find_map(|step| match &step.action {
        AttractAction::Blow { samples, sample_rate, .. } => Some(WavFeed::new(samples.clone(), *sample_rate)),
        _ => None,
    });
    let play = Play {
        settings,
        seconds: breath.as_ref().map_or(0.0, WavFeed::duration) + TAIL,
        breath,
        audio: Some(file("wav")),
        reverb: Some(ReverbSpec::GALLERY),
        trace: Some(file("csv")),
        fps: DEFAULT_FPS,
        ..Play::default()
    };
    let mut files = vec![file("wav"), file("csv")];
    let mut no_picture = None;
    let mut on_frame = |frame: u64, now: &Snapshot| {
        if frame == (PICTURE_AT * f64::from(DEFAULT_FPS)) as u64 {
            match picture(exhibit, now, &file("png")) {
                Ok(()) => files.push(file("png")),
                Err(why) => no_picture = Some(why),
            }
        }
        Ok(())
    };
    let summary = play::run(exhibit, play, stop, |_| (), Some(&mut on_frame)).map_err(|e| e.to_string())?;
    Ok(Demo { summary, files, no_picture })
}

#[cfg(not(feature = "pictures"))]
fn picture(_: &Arc<Exhibit>, _: &Snapshot, _: &Path) -> Result<(), String> {
    Err("this build has no renderer".into())
}

#[cfg(feature = "pictures")]
fn picture(exhibit: &Arc<Exhibit>, now: &Snapshot, path: &Path) -> Result<(), String> {
    use super::pictures::{Pictures, write_png};
    let drawn = Pictures::new(exhibit, PICTURE_SIZE).and_then(|mut pictures| pictures.draw(now));
    write_png(&drawn.map_err(|e| e.to_string())?, path).map_err(|e| e.to_string())
}
