//! What the kiosk says that it keeps, and that it says it of the configuration it is asked about; and that a crash leaves no
//! memory of it in a file.

use serde_json::Value;
use soffio::commands::privacy::report;
use soffio_config::Config;

use crate::cli::Desk;

#[test]
fn the_report_names_what_is_kept_where_and_until_when_and_what_is_not() {
    let desk = Desk::new();
    let run = desk.soffio(&["privacy"]);
    assert_eq!(run.code, Some(0), "{}", run.err);
    for word in ["Kept:", "Not kept", "Over the network:\n  nothing", "microphone", "memory", "until:"] {
        assert!(run.out.contains(word), "{word}: {}", run.out);
    }
    let run = desk.soffio(&["privacy", "--json"]);
    let said: Value = serde_json::from_str(&run.out).expect("one JSON object");
    let kept = said["kept"].as_array().expect("a list");
    assert!(
        kept.iter()
            .all(|kept| ["what", "place", "until"].iter().all(|key| kept[key].as_str().is_some_and(|s| !s.is_empty())))
    );
    assert!(said["not_kept"].as_array().is_some_and(|list| list.len() >= 5));
    assert_eq!(said["sent"], Value::Array(Vec::new()));
}

#[test]
fn it_follows_the_configuration() {
    let desk = Desk::new();
    desk.write("site.toml", "[visit]\nbreath = false\n[staff]\nmetrics = \"/srv/soffio.prom\"\n");
    let run = desk.soffio(&["privacy", "--config", "site.toml", "--json"]);
    let said: Value = serde_json::from_str(&run.out).expect("one JSON object");
    let text = said["kept"].to_string();
    assert!(!text.contains("microphone samples"), "nobody blows there: {text}");
    assert!(text.contains("/srv/soffio.prom"), "{text}");
    let usual = report(&Config::default());
    assert!(usual.kept.iter().any(|kept| kept.what.contains("microphone samples")));
    assert!(usual.kept.iter().any(|kept| kept.place.contains("--record")), "the engineers' recording option is listed");
    assert!(!usual.kept.iter().any(|kept| kept.place.contains(".prom")));
    let bad = desk.soffio(&["privacy", "--config", "nowhere.toml"]);
    assert!(bad.code == Some(1) && bad.err.contains("nowhere.toml"), "{:?} {}", bad.code, bad.err);
}

#[cfg(feature = "kiosk")]
#[test]
fn what_is_counted_and_what_a_broker_is_told_is_named() {
    let text = "[staff]\nmetrics = \"/srv/soffio.prom\"\nstate = \"/srv/state\"\n[mqtt]\nbroker = \"broker.museum\"\n";
    let config = Config::parse(text, std::path::Path::new("kiosk.toml")).expect("a good configuration");
    let report = report(&config);
    for place in ["/srv/soffio.prom", "/srv/state"] {
        let kept = report.kept.iter().find(|kept| kept.place == place).expect("it is kept");
        assert!(kept.what.contains("breaths by their source"), "{}", kept.what);
    }
    assert!(matches!(&report.sent[..], [entry] if entry.contains("broker.museum")), "{:?}", report.sent);
}

/// A crash must not leave a file with the memory of the kiosk, even where the system and the shell ask for one.
#[cfg(all(feature = "kiosk", target_os = "linux"))]
#[test]
fn a_crash_leaves_no_core_dump() {
    use std::os::unix::process::ExitStatusExt;
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    /// Until the kiosk has set its limits.
    const START: Duration = Duration::from_secs(20);
    let soffio = env!("CARGO_BIN_EXE_soffio");
    for signal in ["SEGV", "ABRT"] {
        let desk = Desk::new();
        let exhibits = concat!(env!("CARGO_MANIFEST_DIR"), "/exhibits");
        desk.write("site.toml", format!("[exhibits]\nfolder = {exhibits:?}\n"));
        let mut command = Command::new("sh");
        command.args(["-c", &format!("ulimit -c unlimited; exec {soffio} kiosk --config site.toml")]);
        command.current_dir(desk.path(""));
        for variable in ["DISPLAY", "WAYLAND_DISPLAY", "STATE_DIRECTORY"] {
            command.env_remove(variable);
        }
        command.env("XDG_STATE_HOME", "/dev/null").stdout(Stdio::null()).stderr(Stdio::null());
        let mut kiosk = command.spawn().expect("it starts");
        let id = kiosk.id().to_string();
        let limits = || std::fs::read_to_string(format!("/proc/{id}/limits")).unwrap_or_default();
        let no_core = |limits: &str| {
            let line = limits.lines().find(|line| line.starts_with("Max core file size")).unwrap_or_default();
            line.split_whitespace().filter(|word| *word == "0").count() == 2
        };
        let began = Instant::now();
        while !no_core(&limits()) {
            assert!(began.elapsed() < START, "a core dump is possible: {}", limits());
            std::thread::sleep(Duration::from_millis(5));
        }
        // Where the test may raise the limit again, the process must still not be dumpable.
        let _ = Command::new("prlimit").args(["--pid", &id, "--core=unlimited"]).stderr(Stdio::null()).status();
        // The standard library's handler of stack overflows ignores the first signal that is no fault.
        let status = loop {
            let _ = Command::new("kill").args([&format!("-{signal}"), &id]).stderr(Stdio::null()).status();
            std::thread::sleep(Duration::from_millis(50));
            if let Some(status) = kiosk.try_wait().expect("a child") {
                break status;
            }
        };
        assert!(status.signal().is_some() && !status.core_dumped(), "{signal}: {status}");
        assert!(!desk.files().iter().any(|name| name.starts_with("core")), "{:?}", desk.files());
    }
}
