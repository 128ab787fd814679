//! The preset format: what it refuses and how it says so, and that nothing makes it panic.

use proptest::prelude::*;
use soffio_sound::{Preset, SoundBody, Synth, timbre};

use super::{RATE, disc, render, spec};

/// The error of a shipped preset with one thing replaced.
fn wrong(name: &str, from: &str, to: &str) -> soffio_sound::TimbreError {
    let text = timbre::source(name).expect("shipped");
    assert!(text.contains(from), "{name} has no {from}");
    Preset::parse(name, &text.replace(from, to)).expect_err(to)
}

#[test]
fn errors_know_file_line_key_and_what_would_be_right() {
    let line = |name: &str, part: &str| {
        let text = timbre::source(name).expect("shipped");
        text.lines().position(|l| l.starts_with(part)).expect("a line") + 1
    };
    let check = |name: &str, from: &str, to: &str, key: &str, part: &str| {
        let error = wrong(name, from, to);
        assert_eq!(error.file, format!("audio/timbres/{name}.toml"));
        assert_eq!(error.key, key, "{error}");
        assert!(error.problem.contains(part), "{error}");
        error
    };
    let error = check("plate", "partials = 60", "partial = 60", "node.body.partial", "did you mean \"partials\"");
    assert_eq!(error.line, Some(line("plate", "partials")), "{error}");
    check("plate", "partials = 60", "partials = 6000", "node.body.partials", "1024");
    let error = check("plate", "in = \"dull\"", "in = \"dul\"", "node.click.in", "did you mean \"dull\"");
    assert_eq!(error.line, Some(line("plate", "in = \"dull\"")), "{error}");
    check("plate", "in = \"hiss\"", "in = \"click\"", "node", "ring");
    check("plate", "node.out", "node.sum", "node.out", "missing");
    check("plate", "timbre = 1", "timbre = 2", "timbre", "version 2");
    let error = check("plate", "name = \"plate\"", "name = plate", "syntax", "");
    assert_eq!(error.line, Some(line("plate", "name")), "{error}");
    check("plate", "description", "descriptoin", "descriptoin", "did you mean \"description\"");
    check("plate", "type = \"modal\"", "type = \"modl\"", "node.body.type", "did you mean \"modal\"");
    check("plate", "from = \"plate\"", "from = \"plat\"", "node.body.from", "did you mean \"plate\"");
    check("plate", "kind = \"low-pass\"", "kind = \"lowpass\"", "node.dull.kind", "did you mean \"low-pass\"");
    check("plate", "input = \"rigid_pressure\"", "input = \"pressure\"", "node.hiss.gain.input", "rigid_pressure");
    check("plate", "scale = 0.35", "scal = 0.35", "node.hiss.gain.scal", "did you mean \"scale\"");
    check("plate", "scale = 0.35", "scale = \"loud\"", "node.hiss.gain.scale", "loud");
    check("plate", "scale = 0.35", "scale = nan", "node.hiss.gain", "scale");
    check("plate", "min = 500", "min = 50000", "node.dull.cutoff", "above its max");
    check("plate", "cutoff = {", "# {", "node.dull", "needs a key \"cutoff\"");
    check("plate", "detune = 1.5", "detune = true", "node.body.detune", "");
    check(
        "bell",
        "gain = 0.60, t60 = 20.0",
        "gian = 0.60, t60 = 20.0",
        "node.body.table.0.gian",
        "did you mean \"gain\"",
    );
    check("bell", "t60 = 20.0", "t60 = 0.0", "node.body.table", "above 0");
    check("chime-brass", "length = 0.3859", "length = -1", "specimen.length", "above 0");
    check("chime-brass", "model = \"timoshenko\"", "model = \"exact\"", "node.body.model", "timoshenko");
    check("scrape-wood", "octaves = 8", "octaves = 80", "node.needle.octaves", "1 to 12");
    check("wood", "t60 = [0.3, 0.05]", "t60 = [0.05, 0.3]", "node.body.t60", "falling");
    check("clock-tick", "time = 0.009", "time = 9", "node.again.time", "0.1 s");
    let error = Preset::shipped("plat").expect_err("no such timbre");
    assert!(error.problem.contains("did you mean \"plate\""), "{error}");
}

#[test]
fn a_body_that_cannot_ring_is_said() {
    let flat = soffio_sound::InstrumentSpec { body: SoundBody { thickness: 0.0, ..disc(0.1, 1e-3) }, ..spec("plate") };
    assert!(Synth::new(RATE, &[flat], 1).is_err());
    let plate = timbre::source("scrape-metal").expect("shipped");
    let picture = Preset::parse("scrape-metal", &plate.replace("kind = \"rough\"", "kind = \"image\"")).expect("valid");
    let Err(error) = Synth::with_preset(RATE, &picture, &spec("scrape-metal"), 1) else { panic!("it has no picture") };
    assert!(error.key == "node.needle" && error.problem.contains("picture"), "{error}");
}

#[test]
fn hostile_files_give_errors() {
    for text in [
        "",
        "\u{0}",
        "timbre",
        "[[node]]",
        "node = 1",
        "timbre = 1\nname = \"x\"\ndescription = \"\"\n[node]\nout = 3",
        "timbre = 1\nname = \"x\"\ndescription = \"\"\n[node.out]",
        "timbre = 1\nname = \"x\"\ndescription = \"\"\n[node.out]\ntype = 7",
        "timbre = 1\nname = \"x\"\ndescription = \"\"\n[node.out]\ntype = \"sum\"\nin = [\"out\"]",
        "timbre = 1\nname = \"x\"\ndescription = \"\"\n[node.out]\ntype = \"sum\"\nin = []",
        "timbre = -1e400",
        "timbre = 99999999999999999999",
    ] {
        assert!(Preset::parse("x", text).is_err(), "{text}");
    }
    // Nested without end, and without end in length.
    assert!(Preset::parse("x", &format!("a = {}", "[".repeat(100_000))).is_err());
    assert!(Preset::parse("x", &"# long\n".repeat(1_000_000)).is_err());
    let many: String = (0..40).map(|i| format!("[node.n{i}]\ntype = \"noise\"\n")).collect();
    let error =
        Preset::parse("x", &format!("timbre = 1\nname = \"x\"\ndescription = \"\"\n{many}")).expect_err("40 nodes");
    assert!(error.problem.contains("limit"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    /// Any shipped preset with bytes cut out, doubled or replaced is read or refused, and plays finite numbers.
    #[test]
    fn damaged_presets_never_panic(which in 0usize..19, from in 0usize..3000, length in 0usize..40, with in "[-0-9a-z.=\"\\[\\]{}\n]{0,6}") {
        let name = timbre::names().nth(which).expect("nineteen");
        let text = timbre::source(name).expect("shipped");
        let at = |i: usize| (i.min(text.len())..=text.len()).find(|&i| text.is_char_boundary(i)).unwrap_or(text.len());
        let (start, end) = (at(from % text.len()), at(from % text.len() + length));
        let damaged = format!("{}{with}{}", &text[..start], &text[end..]);
        if let Ok(preset) = Preset::parse(name, &damaged) {
            let mut synth = match Synth::with_preset(RATE, &preset, &preset.specimen.spec(name), 1) {
                Ok(synth) => synth,
                Err(_) => return Ok(()),
            };
            synth.command(preset.specimen.command(&preset, 0, 0));
            let out = render(&mut synth, 600);
            prop_assert!(out.iter().all(|s| s.is_finite() && s.abs() <= 1.0));
        }
    }
}
