//! Two kiosks with one state folder: the second one is refused, and says which process has it.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use soffio_kiosk::fleet::instance::InstanceLock;

use crate::cli::Desk;

/// Until a kiosk has taken its folder.
const START: Duration = Duration::from_secs(20);

#[test]
fn a_second_kiosk_with_the_same_state_is_refused_and_counts_no_crash() {
    let desk = Desk::new();
    let state = desk.path("state");
    let exhibits = concat!(env!("CARGO_MANIFEST_DIR"), "/exhibits");
    desk.write(
        "site.toml",
        format!("[exhibits]\nfolder = {exhibits:?}\n[staff]\nstate = {:?}\n", state.to_string_lossy()),
    );
    let arguments = ["kiosk", "--config", "site.toml"];
    std::fs::create_dir(&state).expect("writable");
    let lock = InstanceLock::take(&state).expect("nobody else").expect("a lock");
    let mine = format!("process {}", std::process::id());
    desk.soffio(&arguments).refused(3, &["another kiosk", &mine, "staff.state"]);
    assert!(!state.join("state.json").exists(), "the refused start is not counted");
    drop(lock);

    let mut first = Command::new(env!("CARGO_BIN_EXE_soffio"))
        .args(arguments)
        .current_dir(desk.path(""))
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("it starts");
    let id = first.id().to_string();
    let began = Instant::now();
    while std::fs::read_to_string(state.join("kiosk.lock")).unwrap_or_default() != id {
        assert!(began.elapsed() < START, "the first kiosk takes no lock");
        std::thread::sleep(Duration::from_millis(5));
    }
    let second = desk.soffio(&arguments);
    second.refused(3, &["another kiosk", &format!("process {id}")]);
    assert!(!second.err.contains("crashed"), "{}", second.err);
    first.kill().expect("it is running");
    first.wait().expect("it ended");
    assert!(InstanceLock::take(&state).expect("a kiosk that was killed has no folder").is_some());
}
