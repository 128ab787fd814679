//! What is scraped where: the place of a contact moves along a body while it sounds.

use soffio_math::amplitude_to_db;
use soffio_sound::{InstrumentSpec, Preset, Slide, SoundBody, SoundCommand, SoundMaterial, Synth};

use super::{RATE, render, rms, spec, steel};

/// Samples between two updates, as many as a simulation step has.
const BLOCK: u64 = 200;

#[test]
fn the_place_of_a_contact_moves_on() {
    // The first mode of a free bar stands still at 0.224 of its length: what is scraped there does not ring in it.
    let text = "timbre = 1\nname = \"x\"\ndescription = \"\"\n[node.needle]\ntype = \"texture\"\nkind = \"rough\"\n\
                gain = { input = \"normal_force\", scale = 0.1 }\n[node.out]\ntype = \"modal\"\nin = \"needle\"\nfrom = \"bar\"\n\
                partials = 1\ncontact_radius = 0.002\n";
    let preset = Preset::parse("x", text).unwrap_or_else(|e| panic!("{e}"));
    let spec = InstrumentSpec {
        body: SoundBody { half_extents: [0.2, 0.01], thickness: 0.01, area: 0.008, mass: 0.6 },
        // 80 1/s at its 320 Hz: what rang elsewhere is over soon.
        material: SoundMaterial { loss_factor: 0.08, ..steel() },
        ..spec("x")
    };
    let play = |block: usize| {
        let mut synth = Synth::with_preset(RATE, &preset, &spec, 1).expect("compiles");
        synth.set_dry(true);
        for step in 0..480u64 {
            // A second at the middle, then within a quarter of one to the node.
            let x = (0.552 * (step as f32 - 240.0) / 60.0).clamp(0.0, 0.552);
            let slide = Slide {
                sample: step * BLOCK,
                instrument: 0,
                speed: 0.4,
                force: 1.0,
                position: [x, 0.0],
                pan: -1.0,
                distance: 1.0,
            };
            synth.command(SoundCommand::Slide(slide));
        }
        let mut out = Vec::new();
        while out.len() < 4 * RATE as usize {
            out.extend(render(&mut synth, block.min(2 * RATE as usize - out.len() / 2)));
        }
        out.chunks(2).map(|frame| frame[0]).collect::<Vec<_>>()
    };
    let out = play(RATE as usize);
    let (middle, node) = (rms(&out[24_000..48_000]), rms(&out[78_000..96_000]));
    println!("at the node {:.1} dB below the middle", amplitude_to_db(middle / node));
    assert!(amplitude_to_db(middle / node) > 20.0, "{middle} and {node}");
    // On the way there is no step: a click would be where the signal changes fastest.
    let fastest = |part: &[f32]| part.windows(3).map(|w| (w[2] - 2.0 * w[1] + w[0]).abs()).fold(0.0, f32::max);
    assert!(fastest(&out[48_000..61_000]) < 1.5 * fastest(&out[12_000..48_000]));
    assert!(play(77) == out, "cut into blocks");
}
