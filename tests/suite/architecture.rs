//! The architecture, read off the source: who may import whom, and what the core must never call.

use std::path::{Path, PathBuf};

/// Modules from left to right; a module may import what stands in an earlier group, and itself.
/// Members of one group do not import each other.
const LAYERS: &[&[&str]] = &[
    &["math"],
    &["noise"],
    &["geometry"],
    &["bodies"],
    &["collision", "articulation"],
    &["dynamics", "wind", "sound"],
    &["procedural"],
    &["exhibit"],
    &["simulation"],
    &["config"],
    &["audio_io", "controllers", "render"],
    &["offline"],
    &["kiosk"],
    &["rehearsal"],
    &["commands"],
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

/// Files are read by the exhibit's loader alone.
const FILES: &[&str] = &["std::fs", "File::open", "std::net"];

/// Crates that only one place may name.
const KEPT_APART: &[(&str, &[&str])] = &[
    ("cpal::", &["audio_io", "commands"]),
    ("alsa::", &["audio_io"]),
    ("wgpu::", &["render", "kiosk", "commands"]),
    ("winit::", &["kiosk", "commands"]),
    ("egui::", &["kiosk"]),
    ("gltf::", &["exhibit"]),
    ("gilrs::", &["controllers"]),
    ("midir::", &["controllers"]),
    ("rosc::", &["controllers"]),
    ("serialport::", &["controllers"]),
    ("rumqttc::", &["kiosk"]),
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

/// Top-level module of a file, if it is in one.
fn module(path: &Path) -> Option<String> {
    let inside = path.strip_prefix(root().join("src")).expect("a file under src");
    let first = inside.components().next()?.as_os_str().to_str()?.trim_end_matches(".rs").to_string();
    (first != "lib" && first != "main").then_some(first)
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
        .unwrap_or_else(|| panic!("module {module} has no place in the architecture; give it one in this test"))
}

#[test]
fn modules_import_only_what_stands_to_their_left() {
    let mut wrong = Vec::new();
    for path in source_files() {
        let Some(own) = module(&path) else { continue };
        for (number, line) in code(&path) {
            for (at, _) in line.match_indices("crate::") {
                let rest = &line[at + "crate::".len()..];
                let other: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                if other.is_empty() || other == own || !LAYERS.iter().any(|g| g.contains(&other.as_str())) {
                    continue;
                }
                if layer(&other) >= layer(&own) {
                    wrong.push(format!("{}:{number}: {own} imports {other}", path.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "imports against the architecture:\n{}", wrong.join("\n"));
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
                if line.contains(call) && !(loader && call == "std::env") {
                    wrong.push(format!("{}:{number}: {call} ({why})", path.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "the core must not:\n{}", wrong.join("\n"));
}

#[test]
fn device_crates_are_named_in_their_own_place() {
    let mut wrong = Vec::new();
    for path in source_files() {
        let Some(own) = module(&path) else { continue };
        for (number, line) in code(&path) {
            for (name, places) in KEPT_APART {
                let named = line.match_indices(name).any(|(at, _)| {
                    // `egui_wgpu::` is not `wgpu::`.
                    !line[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_')
                });
                if named && !places.contains(&own.as_str()) {
                    wrong.push(format!("{}:{number}: {name} outside {places:?}", path.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn microphone_samples_have_no_way_to_a_file_or_socket() {
    // Only offline tools that a developer starts write sound, and they write the synth's.
    for path in source_files() {
        let Some(own) = module(&path) else { continue };
        if own != "audio_io" && own != "kiosk" {
            continue;
        }
        for (number, line) in code(&path) {
            for call in ["WavWriter", "write_float", "std::net", "UdpSocket", "TcpStream"] {
                assert!(!line.contains(call), "{}:{number}: {call}", path.display());
            }
            // The line to a broker is one file, which knows text alone.
            let line_to_broker = path.ends_with("kiosk/mqtt.rs");
            assert!(line_to_broker || !line.contains("rumqttc"), "{}:{number}: rumqttc", path.display());
            assert!(!(line_to_broker && line.contains("f32")), "{}:{number}: samples", path.display());
        }
    }
}
