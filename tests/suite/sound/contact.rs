//! Contact sound: small scenes in which bodies strike, scrape, roll, rest or chatter, and their sounds.

use std::sync::Arc;

use assert_no_alloc::assert_no_alloc;
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_math::{PI, StateHash, amplitude_to_db, sin, sqrt};
use soffio_simulation::{
    Command, Event, EventKind, SAMPLES_PER_STEP, STEPS_PER_SECOND, Settings, Simulation, StepInput,
};
use soffio_sound::{Damp, Preset, Slide, SoundCommand, SoundSurface, Strike, Synth, WindSound};

use super::{RATE, render, rms, spec, spectrum};
use crate::exhibit::glb::{Folder, Scene, cuboid, sheet};

const G: f64 = 9.81;
/// Hits of one pair within this are one, s.
const WINDOW: f64 = 0.015;

/// A material of its own for all: restitution and friction.
fn hard(restitution: f64, friction: f64) -> String {
    format!(
        "[material.hard]\ndensity = \"2700 kg/m3\"\nyoungs_modulus = \"70 GPa\"\nrestitution = {restitution}\n\
         static_friction = {friction}\ndynamic_friction = {friction}\n"
    )
}

/// A body, and a collider on it.
fn body(name: &str, shape: &str, more: &str) -> String {
    format!(
        "[[body]]\nnode = \"{name}\"\nmaterial = \"hard\"\n{more}\n[[collider]]\nnode = \"{name}\"\nshape = {shape}\n"
    )
}

fn sound(of: &str, on: &str, timbre: &str) -> String {
    format!("[[sound]]\nname = \"{of}-{on}\"\nbody = \"{of}\"\non = \"{on}\"\ntimbre = \"{timbre}\"\n")
}

/// A thing that stands still.
fn still(name: &str, shape: &str) -> String {
    format!("[[collider]]\nnode = \"{name}\"\nmaterial = \"hard\"\nshape = {shape}\n")
}

fn load(scene: &Scene, sidecar: &str) -> Arc<Exhibit> {
    let folder = Folder::exhibit(&scene.glb(), sidecar);
    Arc::new(exhibit::load(folder.path()).unwrap_or_else(|report| panic!("{sidecar}\n{}", report.to_text())))
}

/// Sounds of a scene.
#[derive(Default)]
struct Heard {
    strikes: Vec<Strike>,
    slides: Vec<Slide>,
    touches: Vec<Damp>,
    events: Vec<Event>,
    /// Commands of each step, the wind's left out.
    counts: Vec<usize>,
    /// Mono.
    sound: Vec<f32>,
    hash: u64,
}

impl Heard {
    fn of(&self, instrument: u16) -> impl Iterator<Item = &Strike> {
        self.strikes.iter().filter(move |strike| strike.instrument == instrument)
    }

    /// Σ J² of what one instrument is struck with, (N s)².
    fn energy(&self, instrument: u16) -> f64 {
        self.of(instrument).map(|strike| f64::from(strike.impulse) * f64::from(strike.impulse)).sum()
    }

    /// Level of a span of time, dBFS.
    fn level(&self, from: f64, to: f64) -> f64 {
        let at = |t: f64| (t * f64::from(RATE)) as usize;
        amplitude_to_db(rms(&self.sound[at(from)..at(to)]))
    }
}

fn play(exhibit: &Arc<Exhibit>, seconds: f64) -> Heard {
    let mut simulation = Simulation::new(exhibit.clone(), Settings { wind: false, ..Settings::default() });
    let mut synth = Synth::new(RATE, &exhibit.instruments, 1).expect("shipped timbres compile");
    synth.set_dry(true);
    let (mut heard, mut hash) = (Heard::default(), StateHash::default());
    for _ in 0..(seconds * STEPS_PER_SECOND as f64) as usize {
        simulation.step(&StepInput::default());
        let mut count = 0;
        for command in simulation.sounds() {
            synth.command(*command);
            match *command {
                SoundCommand::Strike(strike) => heard.strikes.push(strike),
                SoundCommand::Slide(slide) => heard.slides.push(slide),
                SoundCommand::Damp(touch) => heard.touches.push(touch),
                _ => continue,
            }
            let due = (simulation.steps() - 1) * SAMPLES_PER_STEP..=simulation.steps() * SAMPLES_PER_STEP;
            assert!(due.contains(&command.sample()), "{command:?} in step {}", simulation.steps());
            count += 1;
            hash.add(command.sample() as f64);
        }
        heard.counts.push(count);
        heard.events.extend_from_slice(simulation.events());
        let out = render(&mut synth, SAMPLES_PER_STEP as usize);
        heard.sound.extend(out.chunks(2).map(|frame| frame[0] + frame[1]));
    }
    assert_eq!((synth.faults(), synth.lost()), (0, 0));
    heard.sound.iter().for_each(|x| hash.add(f64::from(*x)));
    heard.hash = hash.0;
    heard
}

/// A ball of 2 cm and 0.1 kg that falls on a plate of its own, which is welded to the world, at `speed`.
fn dropped(speed: f64, restitution: f64) -> Arc<Exhibit> {
    let mut scene = Scene::default();
    let height = 0.02 + 0.005 + speed * speed / (2.0 * G);
    scene.node("Ball", [0.0, height as f32, 0.0], Some(&cuboid([0.02; 3])), &[]);
    scene.node("Plate", [0.0; 3], Some(&cuboid([0.3, 0.01, 0.2])), &[]);
    let sidecar = hard(restitution, 0.3)
        + &body("Ball", "{ sphere = { radius = 0.02 } }", "mass = \"0.1 kg\"")
        + &body("Plate", "{ box = { size = [0.3, 0.01, 0.2] } }", "")
        + "[[constraint.weld]]\nname = \"held\"\nbody = \"Plate\"\n"
        + &sound("Ball", "impact", "wood")
        + &sound("Plate", "impact", "plate");
    load(&scene, &sidecar)
}

#[test]
fn a_dropped_ball_strikes_as_often_as_it_bounces() {
    // Hits of 2, 0.8, 0.32, 0.128 m/s and two more: those stand less than 15 ms apart, so they are one with each other.
    const SPEED: f64 = 0.01;
    const ENERGY: f64 = 1e-5;
    let (first, e) = (2.0, 0.4);
    let heard = play(&dropped(first, e), 2.0);
    let bounces: Vec<f64> = (0..20)
        .map(|k| first * soffio_math::pow(e, f64::from(k)))
        .take_while(|v| 2.0 * v / G > WINDOW || *v > 0.1)
        .collect();
    for instrument in [0, 1] {
        let strikes: Vec<&Strike> = heard.of(instrument).collect();
        let speeds: Vec<f32> = strikes.iter().map(|strike| strike.speed).collect();
        assert_eq!(strikes.len(), bounces.len() + 1, "{speeds:?} for bounces of {bounces:?} m/s");
        for (strike, bounce) in strikes.iter().zip(&bounces) {
            assert!((f64::from(strike.speed) / bounce - 1.0).abs() < SPEED, "{speeds:?} for {bounces:?} m/s");
        }
        // Nothing of what the ball gave is lost.
        let detected_of = |event: &&Event| {
            matches!(event.kind, EventKind::Impact) || (event.kind == EventKind::Rest && event.speed > 4e-3)
        };
        let given: f64 = heard.events.iter().filter(detected_of).map(|event| event.impulse * event.impulse).sum();
        assert!((heard.energy(instrument) / given - 1.0).abs() < ENERGY, "{} of {given}", heard.energy(instrument));
        // The merged one stands where its window ends, and is stronger than the strongest of its hits.
        let (tail, strongest) = (strikes[bounces.len()], 0.1 * bounces[bounces.len() - 1] * e * (1.0 + e));
        assert!((f64::from(tail.speed) / (bounces[bounces.len() - 1] * e) - 1.0).abs() < SPEED, "{speeds:?}");
        assert!(f64::from(tail.impulse) > strongest, "{} N s, of {strongest}", tail.impulse);
        let apart = (tail.sample - strikes[bounces.len() - 1].sample) as f64 / f64::from(RATE);
        assert!((apart - WINDOW).abs() < 1e-4, "{apart} s after the last");
    }
}

#[test]
fn what_lies_still_is_silent_and_says_nothing() {
    /// Far below the noise of any room.
    const SILENT: f64 = -90.0;
    /// Resistance per newton, s/m, within a change that is not sent.
    const RUBS: (f64, f64) = (1.0, 0.34);
    let heard = play(&dropped(0.5, 0.4), 4.0);
    let after = |seconds: f64| (seconds * STEPS_PER_SECOND as f64) as usize;
    assert_eq!(heard.counts[after(2.0)..].iter().sum::<usize>(), 0, "commands while it lies");
    assert!(heard.level(0.0, 0.3) > -50.0, "{} dBFS as it falls", heard.level(0.0, 0.3));
    assert!(heard.level(3.5, 4.0) < SILENT, "{} dBFS", heard.level(3.5, 4.0));
    assert!(heard.slides.is_empty(), "{:?}", heard.slides);
    // Both bodies are damped by the resting contact, in proportion to its force.
    for instrument in [0, 1] {
        let last = heard.touches.iter().rfind(|touch| touch.instrument == instrument).expect("it lies");
        assert!((f64::from(last.resistance) / (RUBS.0 * 0.1 * G) - 1.0).abs() < RUBS.1, "{last:?}");
    }
}

/// A block of 0.1 × 0.04 × 0.08 m and 0.5 kg that is thrown along a floor which falls by `angle`.
fn thrown(speed: f64, angle: f64, friction: f64) -> Arc<Exhibit> {
    let mut scene = Scene::default();
    scene.node("Block", [0.0, 0.02002, 0.0], Some(&cuboid([0.1, 0.04, 0.08])), &[]);
    scene.node("Floor", [0.0, -0.05, 0.0], Some(&cuboid([8.0, 0.1, 2.0])), &[]);
    let sidecar = format!("[scene]\ngravity = [{}, {}, 0]\n", G * sin(angle), -G * sqrt(1.0 - sin(angle) * sin(angle)))
        + &hard(0.0, friction)
        + &body(
            "Block",
            "{ box = { size = [0.1, 0.04, 0.08] } }",
            &format!("mass = \"0.5 kg\"\ninitial = {{ velocity = [{speed}, 0, 0] }}"),
        )
        + &still("Floor", "{ box = { size = [8, 0.1, 2] } }")
        + &sound("Block", "impact", "wood")
        + &sound("Block", "slide", "scrape-wood");
    load(&scene, &sidecar)
}

const SCRAPED: u16 = 1;

#[test]
fn a_thrown_block_scrapes_once_from_begin_to_end() {
    const SHARE: f64 = 0.05;
    let (v, mu) = (1.2, 0.3);
    let heard = play(&thrown(v, 0.0, mu), 1.5);
    let ends: Vec<usize> = (0..heard.slides.len()).filter(|&i| heard.slides[i].force == 0.0).collect();
    assert_eq!(ends, [heard.slides.len() - 1], "one end, the last: {:?}", heard.slides);
    assert!(heard.slides.len() > 20, "{} updates", heard.slides.len());
    let settled = |slide: &&Slide| slide.sample > u64::from(RATE) / 20;
    for slide in heard.slides[..ends[0]].iter().filter(settled) {
        let t = slide.sample as f64 / f64::from(RATE);
        assert!((f64::from(slide.force) / (0.5 * G) - 1.0).abs() < SHARE, "{slide:?}");
        assert!((f64::from(slide.speed) - (v - mu * G * t)).abs() < 0.03, "{slide:?} at {t} s");
    }
    let stopped = v / (mu * G);
    let end = heard.slides[ends[0]].sample as f64 / f64::from(RATE);
    assert!((end - stopped).abs() < 0.02, "over at {end} s, stops at {stopped} s");
    // What was scraped is held by what it lies on then; while it scrapes its timbre knows.
    let held: Vec<f32> = heard.touches.iter().filter(|t| t.instrument == SCRAPED).map(|t| t.resistance).collect();
    assert!(held.last().is_some_and(|r| *r > 1.0), "{held:?}");
    assert!(heard.level(stopped + 0.5, 1.4) < heard.level(0.1, 0.3) - 40.0);
    assert!(heard.counts[heard.counts.len() - 100..].iter().all(|count| *count == 0));
}

#[test]
fn the_faster_it_slides_the_louder_it_scrapes() {
    let heard = play(&thrown(0.0, 0.5, 0.3), 1.4);
    // Level ∝ √v at the least, and v grows evenly: from 0.1 … 0.4 s to 1.0 … 1.3 s by a factor of 4.6, 6.6 dB.
    let levels = [heard.level(0.1, 0.4), heard.level(0.5, 0.8), heard.level(1.0, 1.3)];
    println!("scraped at about 0.5, 1.4, 2.4 m/s: {levels:.1?} dBFS");
    assert!(levels[1] > levels[0] + 1.0 && levels[2] > levels[0] + 3.0, "{levels:?} dBFS");
    assert!(heard.slides.iter().all(|slide| slide.force > 0.0), "it never stops");
    let speeds: Vec<f32> = heard.slides.iter().map(|slide| slide.speed).collect();
    assert!(speeds.is_sorted(), "{speeds:?}");
}

#[test]
fn a_cylinder_rolls_and_does_not_scrape() {
    const SHARE: f64 = 0.05;
    let (v, r) = (0.6, 0.03);
    let mut scene = Scene::default();
    let roller = scene.node("Roller", [-1.0, 0.03001, 0.0], Some(&cuboid([0.04, 0.1, 0.04])), &[]);
    let turned = (0.5f64).sqrt();
    scene.set(roller, "rotation", serde_json::json!([turned, 0.0, 0.0, turned]));
    scene.node("Floor", [0.0, -0.05, 0.0], Some(&cuboid([8.0, 0.1, 2.0])), &[]);
    let sidecar = hard(0.0, 0.4)
        + &body(
            "Roller",
            "{ cylinder = { height = 0.1, radius = 0.03 } }",
            &format!(
                "mass = \"0.5 kg\"\ninitial = {{ velocity = [{v}, 0, 0], angular_velocity = [0, 0, {}] }}",
                -v / r
            ),
        )
        + &still("Floor", "{ box = { size = [8, 0.1, 2] } }")
        + &sound("Roller", "slide", "scrape-wood");
    let heard = play(&load(&scene, &sidecar), 1.5);
    assert!(!heard.slides.is_empty(), "it rolls");
    for slide in &heard.slides {
        assert!(f64::from(slide.force) < 0.1 * 0.5 * G, "{slide:?}: that is scraping");
    }
    let last = heard.slides.last().expect("it rolls");
    assert!((f64::from(last.speed) / v - 1.0).abs() < SHARE, "{last:?}");
    let (rolls, scrapes) = (heard.level(0.5, 1.4), play(&thrown(3.0, 0.0, 0.3), 0.8).level(0.5, 0.75));
    println!("rolls at {rolls:.1} dBFS, scrapes at {scrapes:.1} dBFS");
    assert!(rolls < scrapes - 6.0 && rolls > -90.0, "rolls at {rolls} dBFS, scrapes at {scrapes} dBFS");
}

/// A ball between two walls that it hits `per_minute` times a minute altogether.
fn chattering(per_minute: f64) -> Arc<Exhibit> {
    let (r, v) = (0.02, 1.0);
    let free = v * 60.0 / per_minute;
    let mut scene = Scene::default();
    scene.node("Ball", [0.0; 3], Some(&cuboid([0.02; 3])), &[]);
    let wall = (r + 0.5 * free + 0.05) as f32;
    scene.node("Left", [-wall, 0.0, 0.0], Some(&cuboid([0.1, 0.2, 0.2])), &[]);
    scene.node("Right", [wall, 0.0, 0.0], Some(&cuboid([0.1, 0.2, 0.2])), &[]);
    let sidecar = "[scene]\ngravity = [0, 0, 0]\n".to_owned()
        + &hard(1.0, 0.0)
        + &body(
            "Ball",
            "{ sphere = { radius = 0.02 } }",
            &format!("mass = \"0.01 kg\"\ninitial = {{ velocity = [{v}, 0, 0] }}"),
        )
        + &still("Left", "{ box = { size = [0.1, 0.2, 0.2] } }")
        + &still("Right", "{ box = { size = [0.1, 0.2, 0.2] } }")
        + &sound("Ball", "impact", "wood");
    load(&scene, &sidecar)
}

#[test]
fn a_hundred_thousand_touches_a_minute_are_few_commands_and_as_loud() {
    // Energy but for what still waits at the end: one window of each wall.
    const ENERGY: f64 = 0.02;
    let seconds = 3.0;
    let heard = play(&chattering(1e5), seconds);
    let hits: Vec<f64> =
        heard.events.iter().filter(|e| e.kind == EventKind::Impact).map(|e| e.impulse * e.impulse).collect();
    let given: f64 = hits.iter().sum();
    println!(
        "{} hits, {} strikes, {} commands a step at most",
        hits.len(),
        heard.strikes.len(),
        heard.counts.iter().max().expect("steps")
    );
    assert!(hits.len() as f64 > 0.9 * seconds * 1e5 / 60.0, "{} hits", hits.len());
    let most = 2.0 * (seconds / WINDOW + 2.0);
    assert!((heard.strikes.len() as f64) < most, "{} strikes", heard.strikes.len());
    assert!(heard.counts.iter().all(|count| *count <= 4), "{:?}", heard.counts.iter().max());
    assert!((heard.energy(0) / given - 1.0).abs() < ENERGY, "{} of {given}", heard.energy(0));
}

#[test]
fn contacts_sound_the_same_again_and_ask_for_no_memory() {
    for exhibit in [dropped(1.0, 0.5), thrown(1.0, 0.2, 0.25), chattering(2e4)] {
        assert_eq!(play(&exhibit, 0.7).hash, play(&exhibit, 0.7).hash);
        let mut simulation = Simulation::new(exhibit, Settings::default());
        // What is asked for once, at the start.
        (0..20).for_each(|_| simulation.step(&StepInput::default()));
        let mut sounds = 0;
        assert_no_alloc(|| {
            for _ in 0..400 {
                simulation.step(&StepInput::default());
                sounds += simulation.sounds().len();
            }
        });
        assert!(sounds > 0);
    }
}

#[test]
fn a_reset_takes_away_what_lay_and_what_slid() {
    let mut simulation = Simulation::new(thrown(1.5, 0.0, 0.2), Settings { wind: false, ..Settings::default() });
    let mut synth = Synth::new(RATE, &simulation.exhibit().instruments, 1).expect("compiles");
    let mut touched = [0.0f32; 2];
    for step in 0..480 {
        let commands: &[Command] = if step == 30 { &[Command::Reset] } else { &[] };
        simulation.step(&StepInput { commands, ..StepInput::default() });
        for command in simulation.sounds() {
            synth.command(*command);
            if let SoundCommand::Damp(touch) = command {
                touched[usize::from(touch.instrument)] = touch.resistance;
                assert!(step != 30 || touch.resistance == 0.0 || touch.sample > 30 * SAMPLES_PER_STEP, "{touch:?}");
            }
        }
        render(&mut synth, SAMPLES_PER_STEP as usize);
    }
    assert!(touched.iter().all(|r| *r > 1.0), "it lies at the end: {touched:?}");
}

/// A board with a picture of stripes, 8 pixels each, on its 0.24 m.
fn striped(texture: &str) -> Result<Arc<Exhibit>, String> {
    let mut scene = Scene::default();
    let board = sheet(0.24, 0.1);
    let mesh = scene.textured(&board, &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    let node = scene.node("Board", [0.0; 3], None, &[]);
    scene.set(node, "mesh", serde_json::json!(mesh));
    let look = match texture {
        "normal" => serde_json::json!([{ "normalTexture": { "index": 0 } }]),
        _ => serde_json::json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]),
    };
    if texture != "none" {
        scene.extra.push(("materials", look));
        scene.extra.push(("images", serde_json::json!([{ "uri": "stripes.png" }])));
        scene.extra.push(("textures", serde_json::json!([{ "source": 0 }])));
    } else {
        scene.extra.push(("materials", serde_json::json!([{}])));
    }
    let sidecar = hard(0.3, 0.3)
        + &body("Board", "{ box = { size = [0.24, 0.1, 0.002] } }", "thickness = \"2 mm\"")
        + &sound("Board", "slide", "scrape-wood");
    let folder = Folder::exhibit(&scene.glb(), &sidecar);
    let pixels = image::RgbImage::from_fn(64, 16, |x, _| {
        let wave = sin(2.0 * PI * f64::from(x) / 8.0);
        if texture == "normal" {
            let n = (wave * 100.0 + 127.5) as u8;
            image::Rgb([n, 127, 255])
        } else {
            image::Rgb([(127.5 + 120.0 * wave) as u8; 3])
        }
    });
    let mut png = std::io::Cursor::new(Vec::new());
    pixels.write_to(&mut png, image::ImageFormat::Png).expect("in memory");
    folder.write("stripes.png", &png.into_inner());
    exhibit::load(folder.path()).map(Arc::new).map_err(|report| report.to_text())
}

#[test]
fn what_is_drawn_on_a_body_is_read_as_its_surface() {
    for texture in ["color", "normal"] {
        let exhibit = striped(texture).unwrap_or_else(|e| panic!("{e}"));
        let Some(SoundSurface::Relief(relief)) = &exhibit.instruments[0].surface else { panic!("a picture") };
        // 64 pixels over 0.24 m, so 27 over 0.1 m.
        assert_eq!((relief.width, relief.values.len() / relief.width), (64, 27));
        let mean = relief.values.iter().sum::<f32>() / relief.values.len() as f32;
        // 8 stripes a row, two crossings each but at its ends.
        for row in relief.values.chunks(relief.width) {
            let crossings = row.windows(2).filter(|w| (w[0] < mean) != (w[1] < mean)).count();
            assert!((14..=16).contains(&crossings), "{texture}: {crossings} crossings");
        }
    }
    let plain = striped("none").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(plain.instruments[0].surface, None);
    // With a picture it sounds otherwise than without, and both sound.
    let play = |exhibit: &Exhibit| {
        let mut synth = Synth::new(RATE, &exhibit.instruments, 1).expect("compiles");
        let slide = Slide { force: 2.0, speed: 0.3, distance: 1.0, ..Slide::default() };
        synth.command(SoundCommand::Slide(slide));
        render(&mut synth, RATE as usize)
    };
    let (drawn, smooth) = (play(&striped("color").expect("loads")), play(&plain));
    assert!(drawn != smooth && rms(&drawn) > 1e-4 && rms(&smooth) > 1e-4, "{} and {}", rms(&drawn), rms(&smooth));
}

#[test]
fn a_timbre_that_the_motion_does_not_play_is_refused() {
    let mut scene = Scene::default();
    scene.node("Ball", [0.0; 3], Some(&cuboid([0.02; 3])), &[]);
    for (on, timbre, fine) in [
        ("impact", "plate", true),
        ("slide", "plate", false),
        ("slide", "scrape-metal", true),
        ("impact", "scrape-metal", false),
        ("wind", "scrape-wood", false),
        ("wind", "wind-room", true),
    ] {
        let sidecar = hard(0.5, 0.5) + &body("Ball", "{ sphere = { radius = 0.02 } }", "") + &sound("Ball", on, timbre);
        let loaded = exhibit::load(Folder::exhibit(&scene.glb(), &sidecar).path());
        match loaded {
            Ok(_) => assert!(fine, "{on} {timbre}"),
            Err(report) => assert!(!fine && report.to_text().contains("E0264"), "{}", report.to_text()),
        }
    }
}

#[test]
fn wires_hear_what_blows_across_them() {
    // Three wires at right angles in an even draught: the squares of what crosses them are twice its own square together. A command
    // is sent from a change of 0.01 m/s on, and f32 has seven digits.
    const TOLD: f64 = 0.02;
    let mut scene = Scene::default();
    scene.node("Post", [0.0; 3], Some(&cuboid([0.1; 3])), &[]);
    for direction in [[1.0, 0.0, 0.0], [0.3, -0.5, 0.8], [1.0, 1.0, -1.0]] {
        let mut sidecar = hard(0.5, 0.5) + &body("Post", "{ box = { size = [0.1, 0.1, 0.1] } }", "");
        sidecar += "[[constraint.weld]]\nname = \"held\"\nbody = \"Post\"\n";
        sidecar += &format!("[[wind.draught]]\nname = \"door\"\ndirection = {direction:?}\nspeed = 3\n");
        for (name, end) in [("x", "[0.2, 0, 0]"), ("y", "[0, 0.2, 0]"), ("z", "[0, 0, 0.2]")] {
            sidecar += &format!(
                "[[wire]]\nname = \"{name}\"\nbody = \"Post\"\npoints = [[0, 0, 0], {end}]\nradius = \"0.4 mm\"\nmaterial = \"steel\"\n\
                 [[sound]]\nname = \"sings-{name}\"\nbody = \"Post\"\non = \"wind\"\nwire = \"{name}\"\ntimbre = \"wind-wire\"\n"
            );
        }
        let mut simulation = Simulation::new(load(&scene, &sidecar), Settings::default());
        let mut winds = [WindSound::default(); 3];
        for _ in 0..24 {
            simulation.step(&StepInput::default());
            for command in simulation.sounds() {
                if let SoundCommand::Wind(wind) = *command {
                    winds[usize::from(wind.instrument)] = wind;
                }
            }
        }
        let length = direction.iter().map(|x: &f64| x * x).sum::<f64>().sqrt();
        for (wind, along) in winds.iter().zip(direction) {
            let across = 3.0 * (1.0 - (along / length) * (along / length)).max(0.0).sqrt();
            assert!((f64::from(wind.speed) - across).abs() < TOLD, "{direction:?}: {} instead of {across}", wind.speed);
        }
    }
    // The tone of a wire follows what crosses it: half of the wind, half of the pitch.
    let tone = |speed: f32| {
        let preset = Preset::shipped("wind-wire").expect("valid");
        let mut synth = Synth::with_preset(RATE, &preset, &spec("x"), 1).expect("compiles");
        synth.set_dry(true);
        synth.command(SoundCommand::Wind(WindSound { sample: 0, speed, ..WindSound::default() }));
        render(&mut synth, RATE as usize / 2);
        let out: Vec<f64> = render(&mut synth, 10 * RATE as usize).chunks(2).map(|f| f64::from(f[0])).collect();
        let power = spectrum(&out, 1 << 14);
        (0..power.len()).max_by(|a, b| power[*a].total_cmp(&power[*b])).expect("bins") as f64
    };
    let ratio = tone(3.0) / tone(6.0);
    assert!((ratio - 0.5).abs() < 0.04, "{ratio}");
}

#[test]
fn sound_of_the_breath_comes_from_where_it_is_aimed() {
    let mut scene = Scene::default();
    for (name, x) in [("Left", -0.3), ("Middle", 0.0), ("Right", 0.3)] {
        scene.node(name, [x, 0.0, 0.0], Some(&cuboid([0.1; 3])), &[]);
    }
    let mut sidecar = hard(0.5, 0.5);
    for name in ["Left", "Middle", "Right"] {
        sidecar += &body(name, "{ box = { size = [0.1, 0.1, 0.1] } }", "");
        sidecar += &format!(
            "[[constraint.weld]]\nname = \"held-{name}\"\nbody = \"{name}\"\n[[wind_surface]]\nnode = \"{name}\"\n"
        );
    }
    sidecar += &sound("Middle", "wind", "wind-room");
    let mut simulation = Simulation::new(load(&scene, &sidecar), Settings::default());
    let blow = [Command::Blow(Some(6.0))];
    for pointer in [[0.5, 0.5], [0.9, 0.5], [0.1, 0.5]] {
        let mut last = WindSound::default();
        for _ in 0..120 {
            simulation.step(&StepInput { commands: &blow, pointer: Some(pointer), ..StepInput::default() });
            for command in simulation.sounds() {
                if let SoundCommand::Wind(wind) = *command {
                    last = wind;
                }
            }
        }
        // It goes away from the visitor, and sounds on the side that it is aimed at.
        let side = pointer[0] - 0.5;
        println!("aimed at {pointer:?}: {last:?}");
        assert!(last.speed > 0.1 && f64::from(last.direction).abs() < 0.5 * PI, "{last:?}");
        assert!(side == 0.0 || f64::from(last.pan) * side > 0.0, "{last:?}");
    }
}
