//! Frames and videos by the real program. Without a Vulkan driver these tests say so and pass.

use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;

use crate::require::require;

/// The program in a folder of its own.
fn soffio(folder: &TempDir, args: &[&str], path: Option<&str>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_soffio"));
    command.args(args).current_dir(folder.path());
    if let Some(path) = path {
        command.env("PATH", path);
    }
    command.output().expect("the program starts")
}

fn pendulum() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits/pendulum").display().to_string()
}

fn names(folder: &TempDir) -> Vec<String> {
    let entries = std::fs::read_dir(folder.path()).expect("readable").flatten();
    let mut names: Vec<_> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// The exit code where there is no graphics driver.
const NO_DRIVER: i32 = 3;

/// Did it end well? `None` where there is no driver.
#[track_caller]
fn done(output: &Output) -> Option<()> {
    let errors = String::from_utf8_lossy(&output.stderr);
    let found = if output.status.code() == Some(NO_DRIVER) { Err(&errors) } else { Ok(()) };
    require("Vulkan driver", found)?;
    assert_eq!(output.status.code(), Some(0), "{errors}");
    Some(())
}

#[test]
fn frames_are_the_pictures_that_render_makes_at_their_times_and_between_steps_too() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let exhibit = pendulum();
    let small = ["--size", "160x90"];
    let play = ["play", &exhibit, "--seconds", "0.3", "--fps", "50", "--frames", "frames"];
    let Some(()) = done(&soffio(&folder, &[&play[..], &small].concat(), None)) else { return };
    let frames = std::fs::read_dir(folder.path().join("frames")).expect("a folder").count();
    assert_eq!(frames, 16, "0.3 s of 50 frames a second, and the start");
    // 0.2 s is step 48, 0.26 s lies between steps 62 and 63.
    for (time, frame) in [("0.2", "000010"), ("0.26", "000013")] {
        let render = ["render", &exhibit, "--time", time, "-o", "a.png"];
        done(&soffio(&folder, &[&render[..], &small].concat(), None)).expect("there is a driver");
        let read = |name: &str| std::fs::read(folder.path().join(name)).expect("written");
        assert!(read("a.png") == read(&format!("frames/{frame}.png")), "{time} s");
    }
}

#[test]
fn without_ffmpeg_a_video_is_an_animated_png_of_the_same_frames() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let exhibit = pendulum();
    let args = ["play", &exhibit, "--seconds", "0.2", "--fps", "25", "--size", "160x90"];
    let run = soffio(&folder, &[&args[..], &["--video", "a.mp4", "--frames", "frames"]].concat(), Some("/nonexistent"));
    let Some(()) = done(&run) else { return };
    let output = String::from_utf8_lossy(&run.stderr);
    assert!(["ffmpeg", "a.apng"].iter().all(|word| output.contains(word)), "{output}");
    assert_eq!(names(&folder), ["a.apng", "frames"]);
    let file = std::fs::File::open(folder.path().join("a.apng")).expect("written");
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("a PNG");
    assert_eq!(reader.info().animation_control().map(|control| control.num_frames), Some(5));
    let mut shown = vec![0; reader.output_buffer_size().expect("a size")];
    for frame in 0..5 {
        reader.next_frame(&mut shown).expect("a frame");
        let alone = image::open(folder.path().join(format!("frames/{frame:06}.png"))).expect("a picture");
        assert!(alone.into_rgb8().into_raw() == shown, "frame {frame}");
    }
    let run = soffio(&folder, &[&args[..], &["--video", "a.y4m"]].concat(), Some("/nonexistent"));
    done(&run).expect("there is a driver");
    let bytes = std::fs::read(folder.path().join("a.y4m")).expect("written");
    let head = bytes.split(|byte| *byte == b'\n').next().expect("a line");
    assert!(head.starts_with(b"YUV4MPEG2 W160 H90 F25:1"));
    assert_eq!(bytes.len(), head.len() + 1 + 5 * (6 + 3 * 160 * 90), "five frames of three planes");
}

#[test]
fn a_film_has_all_frames_and_the_runs_sound() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let exhibit = pendulum();
    let args = ["play", &exhibit, "--seconds", "0.4", "--fps", "25", "--size", "160x90", "--video", "a.mp4"];
    let run = soffio(&folder, &args, None);
    let Some(()) = done(&run) else { return };
    let found = if names(&folder) == ["a.mp4"] { Ok(()) } else { Err(String::from_utf8_lossy(&run.stderr)) };
    if require("ffmpeg", found).is_none() {
        return;
    }
    let probe = ["-v", "error", "-show_entries", "stream=codec_name,nb_frames,width", "-of", "csv=p=0", "a.mp4"];
    let probed = Command::new("ffprobe").args(probe).current_dir(folder.path()).output().expect("it comes with ffmpeg");
    let output = String::from_utf8_lossy(&probed.stdout);
    assert!(output.contains("h264,160,10"), "{output}");
    assert!(output.contains("aac,"), "{output}");
}

#[test]
fn a_film_that_cannot_be_is_refused_before_the_run() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let exhibit = pendulum();
    for (video, word) in [("a.gif", ".apng"), ("a", ".mp4")] {
        let run = soffio(&folder, &["play", &exhibit, "--seconds", "1", "--video", video], None);
        assert_eq!(run.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&run.stderr).contains(word));
    }
    assert!(names(&folder).is_empty());
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_neither_a_video_nor_its_makings() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut child = Command::new(env!("CARGO_BIN_EXE_soffio"))
        .args(["play", &pendulum(), "--seconds", "600", "--size", "160x90", "--video", "a.apng"])
        .current_dir(folder.path())
        .stderr(std::process::Stdio::null())
        .stdout(std::process::Stdio::null())
        .spawn()
        .expect("the program starts");
    // The file on its way is there once the run has begun.
    while names(&folder).is_empty() && child.try_wait().expect("a child").is_none() {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(sent.is_ok_and(|status| status.success()) || child.try_wait().expect("a child").is_some());
    let code = child.wait().expect("it ends").code();
    let found = if code == Some(NO_DRIVER) { Err("exit code 3") } else { Ok(()) };
    if require("Vulkan driver", found).is_none() {
        return;
    }
    assert_eq!(code, Some(130));
    assert!(names(&folder).is_empty(), "{:?}", names(&folder));
}
