//! Video by the system's `ffmpeg`: raw frames go through a pipe, and the sound is added at the end.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use image::RgbaImage;
use tempfile::TempDir;

/// How to install `ffmpeg`.
const REMEDY: &str = "install it (Debian: apt-get install ffmpeg)";
/// H.264 rate factor, 0 … 51, lower is better: this one is visually lossless on a screen.
const RATE_FACTOR: &str = "18";

/// Checks that `ffmpeg` can write H.264 and AAC.
///
/// # Errors
/// The reason, and what to do.
pub(super) fn usable() -> Result<(), String> {
    let listed = Command::new("ffmpeg").args(["-hide_banner", "-loglevel", "error", "-encoders"]).output();
    let text = match listed {
        Ok(output) => String::from_utf8_lossy(&output.stdout).into_owned(),
        Err(_) => return Err(format!("there is no ffmpeg on this machine; {REMEDY}")),
    };
    match [" libx264 ", " aac "].iter().find(|name| !text.contains(**name)) {
        Some(name) => Err(format!("the ffmpeg of this machine has no encoder {}; {REMEDY}", name.trim())),
        None => Ok(()),
    }
}

/// A video being encoded; its temporary files are in a folder beside its destination.
pub(super) struct FfmpegEncoder {
    child: Child,
    folder: TempDir,
    path: PathBuf,
}

impl FfmpegEncoder {
    /// Starts ffmpeg; `size` is the width and height of all pictures, in pixels.
    ///
    /// # Errors
    /// ffmpeg cannot be started; the reason.
    pub fn create(path: &Path, size: (u32, u32), fps: u32) -> Result<Self, String> {
        let place = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let folder = tempfile::Builder::new()
            .prefix(".video-")
            .tempdir_in(place)
            .map_err(|e| format!("cannot write {}: {e}; check the folder", path.display()))?;
        let mut command = ffmpeg(folder.path())?;
        command.args(["-f", "rawvideo", "-pixel_format", "rgba", "-video_size", &format!("{}x{}", size.0, size.1)]);
        command.args(["-framerate", &fps.to_string(), "-i", "pipe:0", "-an"]);
        // BT.709 tags: without them players guess the colours by the picture's height.
        command.args(["-vf", "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p"]);
        command.args(["-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"]);
        command.args(["-c:v", "libx264", "-preset", "medium", "-crf", RATE_FACTOR]);
        command.args(["-flags:v", "+bitexact", "-fflags", "+bitexact"]);
        command.arg(folder.path().join("picture.mkv")).stdin(Stdio::piped());
        let child = command.spawn().map_err(|e| format!("ffmpeg cannot be started: {e}; {REMEDY}"))?;
        Ok(Self { child, folder, path: path.into() })
    }

    /// Path of the sound file until the end.
    pub fn sound(&self) -> PathBuf {
        self.folder.path().join("sound.wav")
    }

    /// Encodes the next picture.
    ///
    /// # Errors
    /// ffmpeg has ended; its last message.
    pub fn push(&mut self, picture: &RgbaImage) -> Result<(), String> {
        let written = self.child.stdin.as_mut().map(|pipe| pipe.write_all(picture.as_raw()));
        match written {
            Some(Ok(())) => Ok(()),
            _ => Err(self.ended()),
        }
    }

    /// Completes the film, with the sound of a WAV file if one is given.
    ///
    /// # Errors
    /// ffmpeg has failed, or the file cannot be renamed; the reason.
    pub fn finish(mut self, sound: Option<&Path>) -> Result<(), String> {
        // The end of the pipe ends the video.
        drop(self.child.stdin.take());
        if !self.child.wait().is_ok_and(|status| status.success()) {
            return Err(self.ended());
        }
        let name = self.path.file_name().unwrap_or_default();
        let whole = self.folder.path().join(name);
        let mut command = ffmpeg(self.folder.path())?;
        command.arg("-i").arg(self.folder.path().join("picture.mkv"));
        if let Some(sound) = sound {
            command.arg("-i").arg(sound).args(["-map", "0:v", "-map", "1:a", "-c:a", "aac", "-b:a", "160k"]);
        }
        // The index is at the start of the file, so that it plays while it is being downloaded.
        command.args(["-c:v", "copy", "-map_metadata", "-1", "-fflags", "+bitexact", "-movflags", "+faststart"]);
        let status = command.arg(&whole).stdin(Stdio::null()).status();
        if !status.is_ok_and(|status| status.success()) {
            return Err(self.ended());
        }
        std::fs::rename(&whole, &self.path).map_err(|e| format!("cannot write {}: {e}", self.path.display()))
    }

    /// Error output of `ffmpeg`.
    fn ended(&self) -> String {
        let said = std::fs::read_to_string(log(self.folder.path())).unwrap_or_default();
        let last = said.lines().rfind(|line| !line.trim().is_empty()).unwrap_or("it said nothing");
        format!("cannot write {}: ffmpeg gave up: {last}", self.path.display())
    }
}

impl Drop for FfmpegEncoder {
    fn drop(&mut self) {
        // The encoder of an aborted run is killed; a finished one has exited.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn log(folder: &Path) -> PathBuf {
    folder.join("ffmpeg.log")
}

/// The common arguments of `ffmpeg`; its log goes to a file in `folder`.
fn ffmpeg(folder: &Path) -> Result<Command, String> {
    let log = File::options().create(true).append(true).open(log(folder));
    let log = log.map_err(|e| format!("cannot write in {}: {e}", folder.display()))?;
    let mut command = Command::new("ffmpeg");
    command.args(["-hide_banner", "-loglevel", "error", "-y"]).stdout(Stdio::null()).stderr(log);
    // On Ctrl-C the run stops `ffmpeg` itself and removes its files.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    Ok(command)
}
