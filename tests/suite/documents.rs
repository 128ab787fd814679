//! README and manual: every command in them runs as it is written.
//!
//! All commands of a document run in one shell, in a folder that has the exhibits and the files that the commands name. A command
//! succeeds, or says by its exit code 3 that a device is missing: there is no display, microphone or graphics driver here.
//! What changes the machine, builds, or waits for a network is not run; [`LEFT_OUT`] says why.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

use super::cli::Desk;

/// First words of commands that are not run, and why.
const LEFT_OUT: &[(&str, &str)] = &[
    ("./check", "runs this test"),
    ("./kiosk", "builds"),
    ("arecord", "records"),
    ("cargo", "builds"),
    ("kiosk-config/debian/notices.py", "asks for the licences of all packages; tests/package.sh runs it"),
    ("mosquitto_pub", "needs a broker; tests/live has one"),
    ("mosquitto_sub", "needs a broker; tests/live has one"),
    ("sudo", "changes the machine"),
];

/// Arguments that would take hours, and what is run instead.
const SHORTER: &[(&str, &str)] =
    &[("--hours 0.5", "--hours 0.05"), ("--hours 8", "--hours 0.05"), ("--hours 2", "--hours 0.05")];

/// Commands in a document's `sh` blocks, in order. A line that begins with a space belongs to what the command above shows.
fn commands(document: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut inside = None;
    for line in document.lines() {
        let indent = line.len() - line.trim_start().len();
        match (line.trim(), inside) {
            ("```sh", _) => inside = Some(indent),
            ("```", _) => inside = None,
            (command, Some(block)) if indent == block && !command.is_empty() => found.push(command.to_string()),
            _ => {}
        }
    }
    found
}

/// A folder with what the documents name.
fn desk() -> Desk {
    let desk = Desk::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    std::fs::create_dir_all(desk.path("exhibits")).expect("a writable folder");
    for exhibit in std::fs::read_dir(root.join("exhibits")).expect("shipped exhibits").flatten() {
        let place = desk.path("exhibits").join(exhibit.file_name());
        std::os::unix::fs::symlink(exhibit.path(), place).expect("a link");
    }
    std::os::unix::fs::symlink(root.join("kiosk-config"), desk.path("kiosk-config")).expect("a link");
    let breath = root.join("exhibits/steel-fish/breaths/gentle.wav");
    for copy in ["blow.wav", "speech.wav"] {
        std::fs::copy(&breath, desk.path(copy)).expect("a copy");
    }
    std::fs::copy(root.join("exhibits/pendulum/pendulum.glb"), desk.path("bird.glb")).expect("a copy");
    desk.write("visit.jsonl", "{\"t\": 0.1, \"blow\": 8}\n{\"t\": 0.3, \"blow\": 0}\n");
    desk
}

/// Runs a document's commands in one shell; panics with the first that fails.
fn run(name: &str) {
    let document = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).expect("a document");
    let all = commands(&document);
    let mut script = String::from("set -o pipefail\n");
    let mut count = 0;
    for command in &all {
        let first = command.split_whitespace().next().expect("a word");
        if LEFT_OUT.iter().any(|(word, _)| *word == first) {
            continue;
        }
        let short = SHORTER.iter().fold(command.clone(), |line, (long, short)| line.replace(long, short));
        let quoted = command.replace('\'', "'\\''");
        writeln!(script, "{short}\ncode=$?; case $code in 0|3) ;; *) echo \"exit code $code\" >&2; echo 'of: {quoted}' >&2; exit 1 ;; esac")
            .expect("text");
        count += 1;
    }
    assert!(count > 3, "{name}: {} commands, {count} that can be run", all.len());
    let desk = desk();
    let program = Path::new(env!("CARGO_BIN_EXE_soffio")).parent().expect("a folder");
    let path = format!("{}:{}", program.display(), std::env::var("PATH").expect("a path"));
    let output = Command::new("bash")
        .args(["-c", &script])
        .current_dir(desk.path("."))
        .env("PATH", path)
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .env("VK_DRIVER_FILES", "/nonexistent")
        .env("XDG_STATE_HOME", "/dev/null")
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .stdin(std::process::Stdio::null())
        .output()
        .expect("bash");
    let said = String::from_utf8_lossy(&output.stderr);
    let end: Vec<&str> = said.lines().rev().take(12).collect();
    assert!(output.status.success(), "{name}: {}", end.into_iter().rev().collect::<Vec<_>>().join("\n"));
}

#[test]
fn the_commands_of_the_readme_run_as_written() {
    run("README.md");
}

#[test]
fn the_commands_of_the_manual_run_as_written() {
    run("kiosk-config/README.md");
}

#[test]
fn the_two_commands_explain_themselves() {
    for script in ["kiosk", "check"] {
        let output =
            Command::new(Path::new(env!("CARGO_MANIFEST_DIR")).join(script)).arg("--help").output().expect(script);
        assert!(output.status.success() && output.stdout.len() > 100, "{script} --help");
    }
}
