//! Video of a run: frames are written one by one, so memory does not grow with the length.
//!
//! | file | made by | sound |
//! |---|---|---|
//! | `.mp4`, `.mov`, `.mkv` | the `ffmpeg` of the machine: H.264 and AAC | the run's |
//! | `.apng`, `.png` | here: animated PNG, lossless | none |
//! | `.y4m` | here: YUV4MPEG2, uncompressed | none |
//!
//! Where `ffmpeg` is missing or lacks the codecs, an animated PNG takes the place of the first kind. Invariant: videos
//! are written atomically.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use image::RgbaImage;

use super::atomic_file::AtomicFile;

mod ffmpeg;
mod y4m;

use ffmpeg::FfmpegEncoder;
use y4m::Y4m;

/// Format of a video.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// H.264 and AAC, by `ffmpeg`.
    FfmpegEncoder,
    /// Animated PNG.
    Apng,
    /// YUV4MPEG2.
    Y4m,
}

/// Destination and format of a video, decided before the run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Path of the file.
    pub path: PathBuf,
    /// Format.
    pub format: Format,
    /// What differs from the request, and why.
    pub note: Option<String>,
}

impl Plan {
    /// Chooses the format by the file's extension and by the codecs of the system, for pictures of `size` pixels.
    ///
    /// # Errors
    /// Where the extension is unknown, or a side is odd.
    pub fn new(path: &Path, size: (u32, u32)) -> Result<Self, String> {
        Self::choose(path, size, ffmpeg::usable)
    }

    /// As [`Self::new`], with `usable` as the check for `ffmpeg`.
    fn choose(path: &Path, size: (u32, u32), usable: impl FnOnce() -> Result<(), String>) -> Result<Self, String> {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
        let silent = |what: &str| Some(format!("{} is {what}, which has no sound; --audio writes it", path.display()));
        let plan = |format, note| Self { path: path.into(), format, note };
        match extension.as_str() {
            "apng" | "png" => Ok(plan(Format::Apng, silent("an animated PNG"))),
            "y4m" => Ok(plan(Format::Y4m, silent("YUV4MPEG2"))),
            "mp4" | "mov" | "mkv" => match usable() {
                Ok(()) if size.0.is_multiple_of(2) && size.1.is_multiple_of(2) => Ok(plan(Format::FfmpegEncoder, None)),
                Ok(()) => {
                    let [w, h] = [size.0, size.1].map(|side| side.next_multiple_of(2));
                    Err(format!("H.264 needs even sides: {}x{} pixels cannot be; --size {w}x{h} can", size.0, size.1))
                }
                Err(why) => {
                    let path = path.with_extension("apng");
                    let note = format!(
                        "{why}; the frames go to {} instead, an animated PNG without sound (--audio writes that)",
                        path.display()
                    );
                    Ok(Self { path, format: Format::Apng, note: Some(note) })
                }
            },
            _ => Err(format!(
                "{}: the extension says what to write; .mp4, .mov and .mkv (by ffmpeg), .apng, .png and .y4m are known",
                path.display()
            )),
        }
    }
}

/// A video being written.
pub struct Video {
    sink: Sink,
    left: u32,
}

enum Sink {
    FfmpegEncoder(FfmpegEncoder),
    Apng { writer: png::Writer<BufWriter<File>>, file: AtomicFile, rgb: Vec<u8> },
    Y4m(Y4m),
}

impl Video {
    /// Creates a video of `frames` pictures (at least one) of `size` pixels, `fps` a second.
    ///
    /// # Errors
    /// The file cannot be created, or ffmpeg cannot be started; the reason.
    pub fn create(plan: &Plan, size: (u32, u32), fps: u32, frames: u32) -> Result<Self, String> {
        let frames = frames.max(1);
        let sink = match plan.format {
            Format::FfmpegEncoder => Sink::FfmpegEncoder(FfmpegEncoder::create(&plan.path, size, fps)?),
            Format::Apng => apng(&plan.path, size, fps, frames)?,
            Format::Y4m => Sink::Y4m(Y4m::create(&plan.path, size, fps).map_err(|e| e.to_string())?),
        };
        Ok(Self { sink, left: frames })
    }

    /// Path to which the run's sound (WAV) must be written for this video; `None` where it has no sound.
    pub fn sound(&self) -> Option<PathBuf> {
        match &self.sink {
            Sink::FfmpegEncoder(film) => Some(film.sound()),
            _ => None,
        }
    }

    /// Adds the next picture; pictures after the last are ignored.
    ///
    /// # Errors
    /// The picture cannot be encoded or written; the reason.
    pub fn push(&mut self, picture: &RgbaImage) -> Result<(), String> {
        let Some(left) = self.left.checked_sub(1) else { return Ok(()) };
        self.left = left;
        match &mut self.sink {
            Sink::FfmpegEncoder(film) => film.push(picture),
            Sink::Apng { writer, rgb, file } => {
                rgb.clear();
                rgb.extend(picture.pixels().flat_map(|p| [p[0], p[1], p[2]]));
                writer.write_image_data(rgb).map_err(|e| unwritten(file.path(), &e))
            }
            Sink::Y4m(y4m) => y4m.push(picture).map_err(|e| e.to_string()),
        }
    }

    /// Adds the sound and completes the file.
    ///
    /// # Errors
    /// The file cannot be completed; the reason.
    pub fn finish(self, sound: Option<&Path>) -> Result<(), String> {
        match self.sink {
            Sink::FfmpegEncoder(film) => film.finish(sound),
            Sink::Apng { writer, file, .. } => {
                writer.finish().map_err(|e| unwritten(file.path(), &e))?;
                file.finish().map_err(|e| e.to_string())
            }
            Sink::Y4m(y4m) => y4m.finish().map_err(|e| e.to_string()),
        }
    }
}

fn apng(path: &Path, size: (u32, u32), fps: u32, frames: u32) -> Result<Sink, String> {
    let file = AtomicFile::create(path).map_err(|e| e.to_string())?;
    let handle = file.reopen().map_err(|e| unwritten(path, &e))?;
    let mut encoder = png::Encoder::new(BufWriter::new(handle), size.0, size.1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let animated = encoder.set_animated(frames, 0).and_then(|()| encoder.set_frame_delay(1, fps as u16));
    let writer = animated.and_then(|()| encoder.write_header()).map_err(|e| unwritten(path, &e))?;
    Ok(Sink::Apng { writer, file, rgb: Vec::with_capacity(3 * (size.0 * size.1) as usize) })
}

fn unwritten(path: &Path, why: &dyn std::fmt::Display) -> String {
    format!("cannot write {}: {why}", path.display())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(path: &str, size: (u32, u32), there: bool) -> Result<Plan, String> {
        let usable = || if there { Ok(()) } else { Err("there is no ffmpeg".to_owned()) };
        Plan::choose(Path::new(path), size, usable)
    }

    #[test]
    fn without_ffmpeg_an_animated_png_takes_its_place_and_the_note_says_why() {
        let plan = plan("out/a.mp4", (64, 36), false).expect("a plan");
        assert_eq!((plan.path.as_path(), plan.format), (Path::new("out/a.apng"), Format::Apng));
        let note = plan.note.expect("a note");
        assert!(["no ffmpeg", "out/a.apng", "--audio"].iter().all(|word| note.contains(word)), "{note}");
    }

    #[test]
    fn the_extension_chooses_and_odd_sides_are_refused_before_the_run() {
        let format = |path| plan(path, (64, 36), true).map(|plan| plan.format);
        assert_eq!(format("a.MP4"), Ok(Format::FfmpegEncoder));
        assert_eq!(format("a.y4m"), Ok(Format::Y4m));
        assert_eq!(format("a.png"), Ok(Format::Apng));
        assert!(format("a.gif").is_err_and(|e| e.contains(".apng")));
        assert!(plan("a.mp4", (63, 36), true).is_err_and(|e| e.contains("64x36")));
        assert!(plan("a.y4m", (63, 35), true).is_ok());
    }
}
