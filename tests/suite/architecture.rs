//! The architecture, read off the source: who may import whom, and what the core must never call.

use std::path::{Path, PathBuf};

/// Crates from left to right; a crate depends only on crates of an earlier group. Cargo refuses circles, this list says which
/// way round.
const LAYERS: &[&[&str]] = &[
    &["math", "fourier"],
    &["geometry"],
    &["multibody", "wind", "detector", "sound", "soundscape"],
    &["exhibit"],
    &["authoring", "simulation"],
    &["config"],
    &["devices", "render"],
    &["offline"],
    &["kiosk"],
    &["rehearsal"],
    &["examination", "training", "recorder", "commands"],
];

/// Everything left of here is the core: pure and deterministic.
const CORE_END: &str = "config";

/// What the core must never say, and why.
const FORBIDDEN: &[(&str, &str)] = &[
    ("Instant::", "a clock"),
    ("SystemTime", "a clock"),
    ("HashMap", "hash order"),
    ("HashSet", "hash order"),
    ("std::env", "the environment"),
    ("std::thread", "threads"),
    ("thread_rng", "unseeded randomness"),
    (".sin()", "platform transcendental"),
    (".cos()", "platform transcendental"),
    (".tan()", "platform transcendental"),
    (".sin_cos()", "platform transcendental"),
    (".asin()", "platform transcendental"),
    (".acos()", "platform transcendental"),
    (".atan()", "platform transcendental"),
    (".atan2(", "platform transcendental"),
    (".sinh()", "platform transcendental"),
    (".cosh()", "platform transcendental"),
    (".tanh()", "platform transcendental"),
    (".exp()", "platform transcendental"),
    (".exp2()", "platform transcendental"),
    (".ln()", "platform transcendental"),
    (".log10()", "platform transcendental"),
    (".log2()", "platform transcendental"),
    (".powf(", "platform transcendental"),
    (".powi(", "its rounding differs between optimisation levels"),
    (".cbrt()", "platform transcendental"),
    (".hypot(", "platform transcendental"),
];

/// Crates that are no part of the program.
const TOOLS: &[&str] = &["training", "examination", "forge", "record-breaths", "recorder"];

/// Files are read by the exhibit's loader alone.
const FILES: &[&str] = &["std::fs", "File::open", "std::net"];

/// Packages that only these crates may depend on. `kiosk` and `commands` report which graphics driver there is.
const KEPT_APART: &[(&str, &[&str])] = &[
    // Its planners are generic: every crate that calls one compiles all of it for itself.
    ("rustfft", &["fourier"]),
    ("realfft", &["fourier"]),
    ("cpal", &["devices"]),
    ("alsa", &["devices"]),
    ("gilrs", &["devices"]),
    ("midir", &["devices"]),
    ("rosc", &["devices"]),
    ("serialport", &["devices"]),
    ("wgpu", &["render", "kiosk", "commands"]),
    ("winit", &["kiosk"]),
    ("egui", &["kiosk"]),
    ("rumqttc", &["kiosk"]),
    ("gltf", &["exhibit", "authoring"]),
];

fn source_files() -> Vec<PathBuf> {
    fn walk(folder: &Path, out: &mut Vec<PathBuf>) {
        let mut entries: Vec<_> =
            std::fs::read_dir(folder).expect("src is readable").map(|e| e.expect("an entry").path()).collect();
        entries.sort();
        for path in entries {
            if path.is_dir() {
                walk(&path, out);
            } else if path.extension().is_some_and(|e| e == "rs") {
                out.push(path);
            }
        }
    }
    let mut out = Vec::new();
    walk(&root().join("src"), &mut out);
    out
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The crate of a file, by its folder; the program's own is `commands`.
fn module(path: &Path) -> Option<String> {
    let inside = path.strip_prefix(root().join("src")).expect("a file under src");
    let mut parts = inside.components().map(|part| part.as_os_str().to_string_lossy().into_owned());
    let own = parts.next()?;
    // What a crate's tests and examples call is their own affair.
    let aside = parts.next().is_some_and(|part| part == "tests" || part == "examples");
    (!aside && !own.ends_with(".rs")).then_some(own)
}

/// The packages that a crate depends on, but for its tests.
fn dependencies(own: &str) -> Vec<String> {
    let file =
        if own == "commands" { root().join("Cargo.toml") } else { root().join("src").join(own).join("Cargo.toml") };
    let text = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    let manifest: toml::Table = text.parse().expect("a manifest");
    let of = |table: &toml::Table| -> Vec<String> {
        let names = table.get("dependencies").and_then(toml::Value::as_table);
        names.into_iter().flat_map(|names| names.keys().cloned()).collect()
    };
    let targets = manifest.get("target").and_then(toml::Value::as_table);
    let by_target = targets.into_iter().flat_map(|t| t.values()).filter_map(toml::Value::as_table).flat_map(of);
    of(&manifest).into_iter().chain(by_target).collect()
}

/// Numbered lines of code without comments and without the tests at the end.
fn code(path: &Path) -> Vec<(usize, String)> {
    let text = std::fs::read_to_string(path).expect("a readable file");
    text.lines()
        .enumerate()
        .take_while(|(_, line)| !line.starts_with("#[cfg(test)]"))
        .map(|(index, line)| (index + 1, line.split("//").next().unwrap_or_default().to_string()))
        .collect()
}

fn layer(module: &str) -> usize {
    LAYERS
        .iter()
        .position(|group| group.contains(&module))
        .unwrap_or_else(|| panic!("crate {module} has no place in the architecture; give it one in this test"))
}

#[test]
fn crates_depend_only_on_what_stands_to_their_left() {
    let mut wrong = Vec::new();
    for own in LAYERS.iter().copied().flatten() {
        for dependency in dependencies(own) {
            if let Some(other) = dependency.strip_prefix("soffio-")
                && layer(other) >= layer(own)
            {
                wrong.push(format!("{own} depends on {other}"));
            }
        }
    }
    assert!(wrong.is_empty(), "dependencies against the architecture:\n{}", wrong.join("\n"));
}

#[test]
fn developer_tools_are_no_part_of_the_program() {
    for own in LAYERS.iter().copied().flatten().filter(|own| !TOOLS.contains(own)) {
        let tools =
            dependencies(own).into_iter().filter(|d| d.strip_prefix("soffio-").is_some_and(|d| TOOLS.contains(&d)));
        assert_eq!(tools.collect::<Vec<_>>(), Vec::<String>::new(), "{own}");
    }
}

#[test]
fn the_core_calls_no_clock_device_or_platform_function() {
    let mut wrong = Vec::new();
    for path in source_files() {
        let Some(own) = module(&path) else { continue };
        if layer(&own) >= layer(CORE_END) {
            continue;
        }
        // The loader is the one door to the disk.
        let loader = own == "exhibit";
        let files = if loader { &[] } else { FILES };
        for (number, line) in code(&path) {
            for (call, why) in FORBIDDEN.iter().copied().chain(files.iter().map(|call| (*call, "a file or a socket"))) {
                // Takes are made in threads; what comes out does not depend on their number.
                let threads = path.ends_with("soundscape/parallel.rs") && call == "std::thread";
                if line.contains(call) && !threads && !(loader && call == "std::env") {
                    wrong.push(format!("{}:{number}: {call} ({why})", path.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "the core must not:\n{}", wrong.join("\n"));
}

#[test]
fn device_packages_are_named_in_their_own_place() {
    for own in LAYERS.iter().copied().flatten() {
        for dependency in dependencies(own) {
            let places = KEPT_APART.iter().find(|(package, _)| *package == dependency).map(|(_, places)| places);
            assert!(places.is_none_or(|places| places.contains(own)), "{own} depends on {dependency}");
        }
    }
}

#[test]
fn microphone_samples_have_no_way_to_a_file_or_socket() {
    // Only offline tools that a developer starts write sound, and they write the synth's.
    for path in source_files() {
        let Some(own) = module(&path) else { continue };
        if own != "devices" && own != "kiosk" {
            continue;
        }
        // The drivers of controllers listen to the network, and know nothing of sound.
        if path.starts_with(root().join("src/devices/controllers")) {
            for (number, line) in code(&path) {
                assert!(!line.contains("crate::audio"), "{}:{number}: sound", path.display());
            }
            continue;
        }
        for (number, line) in code(&path) {
            for call in ["WavWriter", "write_float", "std::net", "UdpSocket", "TcpStream"] {
                assert!(!line.contains(call), "{}:{number}: {call}", path.display());
            }
            // The line to a broker is one file, which knows text alone.
            let line_to_broker = path.ends_with("kiosk/fleet/mqtt.rs");
            assert!(line_to_broker || !line.contains("rumqttc"), "{}:{number}: rumqttc", path.display());
            assert!(!(line_to_broker && line.contains("f32")), "{}:{number}: samples", path.display());
        }
    }
}
