//! Files that would take the kiosk down: too much memory, no end, links out of the folder, escape sequences. The real binary refuses
//! each with a located message, soon and within its memory.

use std::path::Path;
use std::process::Command;

use super::cli::Desk;

/// Address space that the program may take, KB: an exhibit's budget of 512 MB, and as much as the program itself maps (250 MB).
const ADDRESS_SPACE_KB: u32 = (512 + 256) << 10;
/// Time after which the program counts as stuck, s. A refusal takes well below 1 s; the machine of the tests is busy.
const STUCK_S: u32 = 60;
/// Exit status of `timeout` when it ends a program.
const TIMED_OUT: i32 = 124;

/// The program in a folder, with a limit of its address space and of its time. Exit status and stderr.
fn soffio(folder: &Path, args: &str) -> (i32, String) {
    let script = format!("ulimit -v {ADDRESS_SPACE_KB}; exec timeout {STUCK_S} \"$0\" {args}");
    let output = Command::new("sh")
        .args(["-c", &script, env!("CARGO_BIN_EXE_soffio")])
        .current_dir(folder)
        .output()
        .expect("a shell");
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    let code = output.status.code().unwrap_or_else(|| panic!("ended by a signal: {err}"));
    assert_ne!(code, TIMED_OUT, "soffio {args} is stuck: {err}");
    assert!(!err.contains("panicked"), "soffio {args}: {err}");
    (code, format!("{out}{err}"))
}

/// `soffio check exhibit` refuses with all these words; its output.
#[track_caller]
fn refused(desk: &Desk, words: &[&str]) -> String {
    let (code, shown) = soffio(&desk.path(""), "check exhibit");
    assert_eq!(code, 1, "{shown}");
    for word in words {
        assert!(shown.contains(word), "no \"{word}\" in\n{shown}");
    }
    shown
}

/// An exhibit of a model of one node, with more of its glTF and of its sidecar.
fn exhibit(gltf: &str, sidecar: &str) -> Desk {
    let desk = Desk::new();
    std::fs::create_dir_all(desk.path("exhibit")).expect("a writable folder");
    let nodes = r#""asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"A"}]"#;
    desk.write("exhibit/model.gltf", format!("{{{nodes}{gltf}}}"));
    desk.write("exhibit/exhibit.toml", format!("schema = \"exhibit/1\"\nmodel = \"model.gltf\"\n{sidecar}"));
    desk
}

/// A file of so many zeros that takes no room on the disk.
fn sparse(desk: &Desk, name: &str, bytes: u64) {
    let file = std::fs::File::create(desk.path(name)).expect("a writable folder");
    file.set_len(bytes).expect("a sparse file");
}

/// A grey PNG of a size, which is small as a file.
fn grey(desk: &Desk, name: &str, side: u32) {
    use std::io::Write;
    let file = std::fs::File::create(desk.path(name)).expect("a writable folder");
    let mut encoder = png::Encoder::new(std::io::BufWriter::new(file), side, side);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().expect("a header");
    let mut rows = writer.stream_writer().expect("a stream");
    let row = vec![0x80; side as usize];
    (0..side).for_each(|_| rows.write_all(&row).expect("a row"));
    rows.finish().expect("a whole picture");
}

fn fifo(desk: &Desk, name: &str) {
    let _ = std::fs::remove_file(desk.path(name));
    let made = Command::new("mkfifo").arg(desk.path(name)).status().expect("mkfifo");
    assert!(made.success());
}

fn link(desk: &Desk, name: &str, to: &str) {
    let _ = std::fs::remove_file(desk.path(name));
    std::os::unix::fs::symlink(to, desk.path(name)).expect("a link");
}

#[test]
fn buffers_that_are_too_much_together_are_refused_by_their_stated_lengths() {
    const BYTES: u64 = 250_000_000;
    let buffer = format!("{{\"uri\":\"big.bin\",\"byteLength\":{BYTES}}}");
    let desk = exhibit(&format!(",\"buffers\":[{}]", vec![buffer; 30].join(",")), "");
    sparse(&desk, "exhibit/big.bin", BYTES);
    refused(&desk, &["E0005", "exhibit.toml:2", "buffers[2].byteLength", "the limit is 512 MB"]);
}

#[test]
fn of_a_long_file_only_the_stated_length_is_read() {
    let desk = exhibit(",\"buffers\":[{\"uri\":\"big.bin\",\"byteLength\":8}]", "");
    sparse(&desk, "exhibit/big.bin", 250_000_000);
    let (code, shown) = soffio(&desk.path(""), "check --quick exhibit");
    assert_eq!(code, 0, "{shown}");
    sparse(&desk, "exhibit/big.bin", 1 << 40);
    refused(&desk, &["E0004", "big.bin", "exhibit.toml:2"]);
}

#[test]
fn images_that_are_too_much_together_are_refused_by_their_headers() {
    let image = "{\"uri\":\"grey.png\"}";
    let desk = exhibit(&format!(",\"images\":[{}]", [image; 9].join(",")), "");
    grey(&desk, "exhibit/grey.png", 4096);
    // 64 MB each when decoded, and 80 MB more for a moment: the eighth is too much.
    refused(&desk, &["E0005", "exhibit.toml:2", "images[7]", "4096 × 4096", "the exhibit needs 529 MB"]);
}

#[test]
fn a_large_thumbnail_is_refused_by_its_header() {
    let desk = exhibit("", "");
    grey(&desk, "exhibit/thumbnail.png", 11_000);
    refused(&desk, &["E0005", "thumbnail.png", "11000 × 11000", "4096 × 4096"]);
}

#[test]
fn a_document_of_many_small_objects_is_refused_before_it_is_read() {
    let desk = exhibit(&format!(",\"extras\":[{}]", vec!["{\"a\":0}"; 2_000_000].join(",")), "");
    refused(&desk, &["E0005", "the JSON", "the limit is 512 MB"]);
}

#[test]
fn vertices_that_many_primitives_share_count_for_each() {
    let primitive = "{\"attributes\":{\"POSITION\":0},\"indices\":1}";
    let gltf = format!(
        ",\"buffers\":[{{\"uri\":\"b.bin\",\"byteLength\":12000000}}],\
         \"bufferViews\":[{{\"buffer\":0,\"byteLength\":12000000}}],\
         \"accessors\":[{{\"bufferView\":0,\"componentType\":5126,\"count\":1000000,\"type\":\"VEC3\",\
         \"min\":[0,0,0],\"max\":[0,0,0]}},{{\"componentType\":5125,\"count\":3,\"type\":\"SCALAR\"}}],\
         \"meshes\":[{{\"primitives\":[{}]}}]",
        vec![primitive; 30].join(",")
    );
    let desk = exhibit(&gltf, "");
    sparse(&desk, "exhibit/b.bin", 12_000_000);
    refused(&desk, &["E0005", "meshes[0].primitives[", "the limit is 512 MB"]);
}

#[test]
fn a_fifo_is_refused_at_once_whatever_it_stands_for() {
    let blow = "[[attract.step]]\nat = 0\nblow = { wav = \"breath.wav\" }\n";
    let cases = [
        ("exhibit/model.gltf", "", ""),
        ("exhibit/b.bin", ",\"buffers\":[{\"uri\":\"b.bin\",\"byteLength\":4}]", ""),
        ("exhibit/i.png", ",\"images\":[{\"uri\":\"i.png\"}]", ""),
        ("exhibit/thumbnail.png", "", ""),
        ("exhibit/timbres/own.toml", "", ""),
        ("exhibit/breath.wav", "", blow),
    ];
    for (name, gltf, sidecar) in cases {
        let desk = exhibit(gltf, sidecar);
        std::fs::create_dir_all(desk.path("exhibit/timbres")).expect("a writable folder");
        fifo(&desk, name);
        refused(&desk, &["E0006", "a FIFO", name.rsplit('/').next().unwrap_or_default()]);
    }
    let desk = exhibit("", "");
    fifo(&desk, "exhibit/exhibit.toml");
    let (code, shown) = soffio(&desk.path(""), "check exhibit/exhibit.toml");
    assert!(code == 1 && shown.contains("E0006"), "{shown}");
    let (code, shown) = soffio(&desk.path(""), "check exhibit");
    assert!(code == 1 && shown.contains("E0001"), "{shown}");
}

#[test]
fn links_out_of_the_folder_are_refused_and_links_inside_are_followed() {
    let secret = "a line that nobody may read";
    let desk = exhibit("", "");
    desk.write("secret.toml", secret);
    link(&desk, "exhibit/exhibit.toml", "../secret.toml");
    let shown = refused(&desk, &["E0003", "leads out of the exhibit folder"]);
    assert!(!shown.contains(secret), "{shown}");

    for name in ["model.gltf", "thumbnail.png"] {
        let desk = exhibit("", "");
        desk.write("other", "x");
        link(&desk, &format!("exhibit/{name}"), "../other");
        refused(&desk, &["E0003", name]);
    }
    let desk = exhibit("", "");
    std::fs::rename(desk.path("exhibit/model.gltf"), desk.path("exhibit/real.gltf")).expect("movable");
    link(&desk, "exhibit/model.gltf", "real.gltf");
    let (code, shown) = soffio(&desk.path(""), "check --quick exhibit");
    assert_eq!(code, 0, "{shown}");
}

#[test]
fn escape_sequences_of_names_are_shown_and_not_sent_to_the_terminal() {
    let gltf = r#","meshes":[{"name":"\u001b[2Jm\u009b31m\u202e","primitives":[{"attributes":{},"mode":0}]}]"#;
    let desk = exhibit(gltf, "[[body]]\nnode = \"\\u001B]0;title\\u0007\"\n");
    let shown = refused(&desk, &[r"\u{1b}[2Jm\u{9b}31m\u{202e}", r"\u{1b}]0;title\u{7}"]);
    assert!(shown.chars().all(|c| !c.is_control() || c == '\n'), "{shown:?}");
    let json = desk.soffio(&["check", "--json", "exhibit"]);
    assert!(json.out.trim_end().chars().all(|c| !c.is_control()), "{:?}", json.out);
}

#[test]
fn a_number_that_no_museum_holds_is_refused_where_it_stands() {
    let desk = exhibit("", "[[body]]\nnode = \"A\"\nmass = 1\ninitial.position = [0, \"1e12 mm\", 0]\n");
    refused(&desk, &["E0226", "exhibit.toml:6", "body[0].initial.position[1]", "1000 m"]);
}

#[test]
fn a_sidecar_of_many_mistakes_is_answered_soon() {
    let desk = exhibit("", &"[[body]]\n".repeat(100_000));
    refused(&desk, &["E0103", "and 900 more problems"]);
    let fan = "[[wind.fan]]\nname=\"a\"\nat=[\"1 m\",\"1 m\",\"1 m\"]\ndirection=[1,0,0]\ndiameter=\"1 m\"\nspeed=\"1 m/s\"\n";
    let desk = exhibit("", &fan.repeat(9000));
    refused(&desk, &["E0201", "more problems"]);
    let desk = exhibit("", &format!("{} = 1\n", vec!["a"; 400_000].join(".")));
    refused(&desk, &["E0101"]);
    let desk = exhibit("", &format!("x_own = {}\n", "[".repeat(100_000)));
    refused(&desk, &["E0101"]);
}

#[test]
fn a_trial_says_by_its_status_whether_an_exhibit_loads() {
    let desk = exhibit("", "");
    let (code, shown) = soffio(&desk.path(""), "check --trial exhibit");
    assert_eq!(code, 0, "{shown}");
    let desk = exhibit("", "[[body]]\nnode = \"B\"\n");
    let (code, shown) = soffio(&desk.path(""), "check --trial exhibit");
    assert_eq!(code, 1, "{shown}");
}

/// `soffio new` refuses a drawing with all these words.
#[track_caller]
fn drawing_refused(svg: &str, words: &[&str]) {
    let desk = Desk::new();
    desk.write("d.svg", svg);
    let (code, shown) = soffio(&desk.path(""), "new made --from mobile --outlines d.svg");
    assert_eq!(code, 1, "{shown}");
    for word in words {
        assert!(shown.contains(word), "no \"{word}\" in\n{shown}");
    }
    assert_eq!(desk.files(), ["d.svg"]);
}

#[test]
fn drawings_of_any_size_and_depth_are_refused_with_their_line() {
    let svg = |inner: &str| {
        format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"200mm\" viewBox=\"0 0 200 200\">\n{inner}\n</svg>")
    };
    let nested = |tag: &str| format!("{}{}", format!("<{tag}>").repeat(10_000), format!("</{tag}>").repeat(10_000));
    let uses = (0..40)
        .map(|i| format!("<g id=\"u{i}\"><use href=\"#u{0}\"/><use href=\"#u{0}\"/></g>", i + 1))
        .collect::<String>();
    for (inner, words) in [
        ("<path d=\"M0 0 A1e30 1e30 0 0 1 50 50 L0 50Z\"/>", ["E0601", "d.svg:2", "numbers beyond"]),
        ("<path d=\"M0 0 L1e30 0 L0 1e30Z\"/>", ["E0601", "d.svg:2", "numbers beyond"]),
        ("<circle r=\"1e30\"/>", ["E0601", "d.svg:2", "numbers go to"]),
        ("<polygon points=\"0,0 1e300,0 0,9\"/>", ["E0601", "d.svg:2", "numbers beyond"]),
        ("<g transform=\"scale(1e308)\"><rect width=\"9\" height=\"9\"/></g>", ["E0601", "d.svg:2", "beyond 10 m"]),
        (nested("g").as_str(), ["E0601", "d.svg:2", "more than 64 elements"]),
        (nested("pattern").as_str(), ["E0601", "d.svg:2", "more than 64 elements"]),
        (&format!("<defs>{}</defs>", nested("mask")), ["E0601", "d.svg:2", "more than 64 elements"]),
        (uses.as_str(), ["E0601", "d.svg:2", "is a copy of another element"]),
        (&"<a/>".repeat(200_000), ["E0601", "d.svg", "more than 100000 elements"]),
        (&"<circle r=\"5\"/>".repeat(300), ["E0601", "d.svg:2", "more than 256 plates"]),
        (&format!("<path d=\"M0 0{}Z\"/>", "c9 9 -9 9 0 1".repeat(50_000)), ["E0601", "d.svg:2", "segments"]),
    ] {
        drawing_refused(&svg(inner), &words);
    }
    let huge = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1e300mm\" viewBox=\"0 0 1e-300 1\">\n<rect width=\"9\" height=\"9\"/>\n</svg>";
    drawing_refused(huge, &["E0601", "d.svg:2", "beyond 10 m"]);
    let laughs = "<!DOCTYPE svg [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">]>\n<svg>&b;</svg>";
    drawing_refused(laughs, &["E0601", "d.svg"]);
    drawing_refused(&"<".repeat(3 << 20), &["E0601", "d.svg"]);
}

#[test]
fn a_fifo_is_no_drawing() {
    let desk = Desk::new();
    fifo(&desk, "d.svg");
    let (code, shown) = soffio(&desk.path(""), "new made --from mobile --outlines d.svg");
    assert!(code == 1 && shown.contains("E0006"), "{shown}");
}
