//! `soffio export`.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::arguments::{parse_seconds, parse_size};
use super::failure::{Failure, Outcome};
use super::setup;
use soffio_offline::export::{key_frames::AnimationBake, mjcf};
use soffio_offline::feed::WavFeed;
use soffio_offline::play::{self, OnFrame, Play, PlayError};
use soffio_offline::wav;
use soffio_simulation::{STEPS_PER_SECOND, Snapshot};

/// Length of a run without a recording, and after the end of one, s.
const TAIL: f64 = 5.0;
/// Longest run: the poses of all its steps are kept until it is over, and glTF's times are single precision, s.
const LONGEST: f64 = 600.0;
/// Frames a second of a film.
#[cfg(feature = "kiosk")]
const FILM: u32 = 24;

/// Writes an exhibit in motion for other programs: glTF with key frames, RenderMan scenes, or a MuJoCo model.
#[derive(clap::Args, Debug)]
#[command(
    group = clap::ArgGroup::new("format").required(true).multiple(false),
    after_help = "Examples:\n  soffio export steel-fish --gltf fish.glb --breath blow.wav --seconds 8\n  \
                  soffio export wind-chimes --rib scenes --fps 24 --seconds 4\n  \
                  soffio export pendulum --mjcf pendulum.xml\n\n\
                  Parts that a format cannot express are left out and listed."
)]
pub struct Args {
    /// Id under `exhibits/`, or a folder.
    exhibit: String,
    /// Binary glTF 2.0 with the run's key frames.
    #[arg(long, value_name = "OUT.glb", group = "format")]
    gltf: Option<PathBuf>,
    /// Folder of RenderMan scenes (RIB), one a frame, with motion blur.
    #[cfg(feature = "kiosk")]
    #[arg(long, value_name = "DIR", group = "format")]
    rib: Option<PathBuf>,
    /// MuJoCo model of the exhibit as it starts.
    #[arg(long, value_name = "OUT.xml", group = "format")]
    mjcf: Option<PathBuf>,
    /// Length of the run; default is the recording's length and 5 s.
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds, allow_negative_numbers = true, conflicts_with = "mjcf")]
    seconds: Option<f64>,
    /// Recorded breath in place of the microphone.
    #[arg(long, value_name = "WAV", conflicts_with = "mjcf")]
    breath: Option<PathBuf>,
    /// Frames per second: of glTF each step (240) where left out, of scenes 24; at most 120 of those.
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=240), conflicts_with = "mjcf")]
    fps: Option<u32>,
    /// Size of the scenes' pictures.
    #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "1280x720")]
    size: (u32, u32),
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    let exhibit = setup::open(&args.exhibit)?;
    if !exhibit.shapes.is_empty() {
        eprintln!(
            "left out: key frames of scales and morph weights ({}): shapes stay as they are at rest",
            exhibit.shapes.len()
        );
    }
    if let Some(path) = &args.mjcf {
        let left_out = mjcf::write(&exhibit, path).map_err(Failure::input)?;
        left_out.iter().for_each(|what| eprintln!("left out: {what}"));
        return Ok(());
    }
    let recording = args.breath.as_ref().map(wav::read).transpose().map_err(Failure::input)?;
    let seconds = args.seconds.unwrap_or(recording.as_ref().map_or(0.0, wav::Recording::duration) + TAIL);
    if seconds > LONGEST {
        return Err(Failure { code: 2, message: format!("--seconds {seconds}: at most {LONGEST} can be exported") });
    }
    let play = Play {
        settings: setup::settings()?,
        breath: recording.as_ref().map(WavFeed::from),
        seconds,
        aspect: f64::from(args.size.0) / f64::from(args.size.1),
        ..Play::default()
    };
    if let Some(path) = &args.gltf {
        let fps = args.fps.unwrap_or(STEPS_PER_SECOND as u32);
        let mut bake = AnimationBake::new(&exhibit, fps);
        perform(&exhibit, Play { fps, ..play }, &mut |_, now: &Snapshot| {
            bake.push(&now.poses);
            Ok(())
        })?;
        return bake.write(&exhibit, path).map_err(Failure::input);
    }
    #[cfg(feature = "kiosk")]
    if let Some(folder) = &args.rib {
        let fps = args.fps.unwrap_or(FILM);
        if fps > 120 {
            return Err(Failure { code: 2, message: format!("--fps {fps}: scenes can have 120 a second at most") });
        }
        let writer = soffio_offline::export::rib::RibWriter::create(&exhibit, folder, args.size, fps);
        let mut writer = writer.map_err(Failure::input)?;
        let play = Play { fps: writer.samples_per_second(), ..play };
        perform(&exhibit, play, &mut |number, now: &Snapshot| {
            writer.push(number, &now.poses).map_err(|e| e.to_string())
        })?;
    }
    Ok(())
}

/// Runs the exhibit for its frames.
fn perform(exhibit: &Arc<soffio_exhibit::Exhibit>, play: Play, on_frame: &mut OnFrame) -> Outcome {
    let stop = Arc::new(AtomicBool::new(false));
    setup::stop_on_ctrl_c(&stop);
    let progress = setup::progress_bar((play.seconds * STEPS_PER_SECOND as f64).round() as u64);
    let done = play::run(exhibit, play, &stop, |step| progress.set_position(step), Some(on_frame));
    progress.finish_and_clear();
    match done {
        Ok(_) => Ok(()),
        Err(PlayError::Interrupted) => {
            Err(Failure { code: 130, message: "interrupted; nothing half-written is left".into() })
        }
        Err(error) => Err(Failure::input(error)),
    }
}
