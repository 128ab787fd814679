//! The first exhibit, end to end: balance, period, conservation, a hard breath, a gentle one, and the same bits twice.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::systems::run::{Run, Visit};
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_math::{DVec3, PI, rotation};
use soffio_offline::feed::WavFeed;
use soffio_offline::play::{self, Play, Summary};
use soffio_offline::wav;
use soffio_simulation::{Command, EventKind, Profile, STEPS_PER_SECOND, Settings, Simulation, StepInput};

/// Strong breaths of a visitor who aims at the discs, at the red plate, and not at all.
const STRONG: [(&str, &str); 3] = [
    (
        "at the discs",
        r#"{"t": 0, "aim": [0.68, 0.40]}
{"t": 0.5, "blow": {"strength": 0.8, "hold": 1.5, "release": 0.3}}"#,
    ),
    (
        "at the red plate",
        r#"{"t": 0, "aim": [0.76, 0.39]}
{"t": 0.5, "blow": {"strength": 0.8, "hold": 1.5, "release": 0.3}}"#,
    ),
    ("not aimed", r#"{"t": 0.5, "blow": {"strength": 0.8, "hold": 1.5, "release": 0.3}}"#),
];
const BOOM: usize = 0;
/// Where a strong breath makes the hanging plates meet, between the red one and the discs, with this seed.
const PLATES: [f64; 2] = [0.70, 0.41];
const MEETING: u64 = 6;
/// What the product promises of joints, m.
const JOINT_ERROR: f64 = 1e-9;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits/steel-fish")
}

fn steel_fish() -> Arc<Exhibit> {
    let exhibit = exhibit::load(&folder()).unwrap_or_else(|report| panic!("{report}"));
    assert_eq!(exhibit.bodies[BOOM].name, "Boom");
    Arc::new(exhibit)
}

fn steps(seconds: f64) -> usize {
    (seconds * STEPS_PER_SECOND as f64).round() as usize
}

fn run(simulation: &mut Simulation, seconds: f64) {
    for _ in 0..steps(seconds) {
        simulation.step(&StepInput::default());
    }
}

/// Angle between the boom's own up and the world's, rad.
fn tilt(simulation: &Simulation) -> f64 {
    (simulation.bodies()[BOOM].rotation * DVec3::Y).dot(DVec3::Y).clamp(-1.0, 1.0).acos()
}

/// Signed pitch of the boom: how far its long arm dips, rad.
fn pitch(simulation: &Simulation) -> f64 {
    (simulation.bodies()[BOOM].rotation * DVec3::X).y.asin()
}

#[test]
fn it_hangs_level_when_no_wind_blows() {
    let mut simulation = Simulation::new(steel_fish(), Settings { wind: false, ..Settings::default() });
    let mut worst: f64 = 0.0;
    for _ in 0..steps(20.0) {
        simulation.step(&StepInput::default());
        worst = worst.max(tilt(&simulation));
    }
    assert!(worst.to_degrees() < 1.0, "tilted by {:.3}°", worst.to_degrees());
    let speed = simulation.bodies().iter().map(|b| b.velocity.length()).fold(0.0, f64::max);
    assert!(speed < 1e-3, "something still moves at {speed} m/s");
}

#[test]
fn a_push_swings_it_at_the_tilt_period() {
    // 2π √(I / M g h) of the drawing: I = 0.00243 kg m² with the loads as points, M = 60.7 g, h = 30 mm.
    const PERIOD: f64 = 2.3;
    const SPREAD: f64 = 0.05;
    let mut simulation =
        Simulation::new(steel_fish(), Settings { wind: false, friction: false, ..Settings::default() });
    // The whole mobile pitched by 5° about the pivot; hanging parts keep their attitude and follow their hooks.
    let push = 5.0_f64.to_radians() * 2.0 * PI / PERIOD;
    let pivot = simulation.bodies()[BOOM].pose().position;
    for body in simulation.bodies_mut() {
        let r = body.position - pivot;
        body.velocity = (DVec3::Z * push).cross(DVec3::new(r.x, 0.0, 0.0));
    }
    let boom = &mut simulation.bodies_mut()[BOOM];
    boom.angular_velocity = DVec3::Z * push;
    let center = boom.position - pivot;
    boom.velocity = boom.angular_velocity.cross(center);
    let mut crossings = Vec::new();
    let mut largest: f64 = 0.0;
    let mut before = pitch(&simulation);
    for step in 0..steps(24.0) {
        simulation.step(&StepInput::default());
        let now = pitch(&simulation);
        largest = largest.max(now);
        if before < 0.0 && now >= 0.0 {
            crossings.push(step as f64 / STEPS_PER_SECOND as f64);
        }
        before = now;
    }
    let period = (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64;
    println!("tilt period {period:.4} s, swing {:.2}°", largest.to_degrees());
    assert!((period / PERIOD - 1.0).abs() < SPREAD, "{period} s");
    assert!((3.0..7.0).contains(&largest.to_degrees()), "swings by {:.2}°", largest.to_degrees());
}

#[test]
fn energy_is_kept_for_a_minute_without_wind_and_friction() {
    const DRIFT: f64 = 1e-6;
    // Its sheets pass through each other, since hits lose energy.
    let exhibit = Arc::new(Exhibit { colliders: Vec::new(), ..(*steel_fish()).clone() });
    let mut simulation = Simulation::new(exhibit, Settings { wind: false, friction: false, ..Settings::default() });
    // A slow turn of the whole figure about the post: every joint works.
    let spin = DVec3::Y * 0.6;
    let pivot = simulation.bodies()[BOOM].pose().position;
    for body in simulation.bodies_mut() {
        body.velocity = spin.cross(body.position - pivot);
        body.angular_velocity = spin;
    }
    run(&mut simulation, 0.1);
    let start = simulation.energy();
    let scale: f64 = simulation.bodies().iter().map(|b| b.kinetic_energy()).sum();
    let mut worst: f64 = 0.0;
    let mut hits = 0;
    for _ in 0..steps(60.0) {
        simulation.step(&StepInput::default());
        worst = worst.max((simulation.energy() - start).abs() / scale);
        hits += simulation.events().iter().filter(|e| e.kind != EventKind::Fault).count();
        assert!(simulation.joint_error() < JOINT_ERROR);
    }
    println!("energy drift {worst:.2e} of {scale:.2e} J, {hits} hits");
    assert_eq!(hits, 0, "hits lose energy; the test wants motion without");
    assert!(worst < DRIFT, "energy drifted by {worst:e}");
}

#[test]
fn a_minute_of_hard_breath_neither_breaks_nor_blows_it_apart() {
    const HARD: f64 = 17.0;
    let exhibit = steel_fish();
    for profile in [Profile::Gallery, Profile::Physical] {
        let mut simulation = Simulation::new(exhibit.clone(), Settings { profile, ..Settings::default() });
        let blow = [Command::Blow(Some(HARD))];
        let mut worst: f64 = 0.0;
        let mut hits = 0;
        for step in 0..steps(60.0) {
            // Wandering over the whole work, corner to corner.
            let phase = step as f64 / steps(60.0) as f64;
            let pointer = Some([phase, 0.3 + 0.2 * (40.0 * phase).sin()]);
            let commands = if step == 0 { &blow[..] } else { &[] };
            simulation.step(&StepInput { commands, pointer, ..StepInput::default() });
            worst = worst.max(simulation.joint_error());
            hits += simulation.events().iter().filter(|e| e.kind == EventKind::Impact).count();
            assert!(simulation.events().iter().all(|e| e.kind != EventKind::Fault), "a fault at step {step}");
            assert!(simulation.bodies().iter().all(|b| b.is_finite()));
        }
        println!("{profile:?}: joint error {worst:.1e} m, {hits} hits");
        assert!(worst < JOINT_ERROR, "{profile:?}: joints {worst} m apart");
        if profile == Profile::Gallery {
            assert!(hits > 0, "a hard breath makes the plates ring");
        }
        assert!(tilt(&simulation).to_degrees() < 13.0, "the cup holds its needle");
    }
}

#[test]
fn a_childs_gentle_breath_visibly_moves_it_within_a_second() {
    // Gentle: 3.8 m/s at the lips, 18 L/min through 10 mm. Pointer left alone. Visible: some body moves 5 mm or turns 2°.
    let mut simulation = Simulation::new(steel_fish(), Settings::default());
    run(&mut simulation, 1.0);
    let before: Vec<_> = simulation.bodies().to_vec();
    let blow = [Command::Blow(Some(3.8))];
    for step in 0..steps(1.0) {
        let commands = if step == 0 { &blow[..] } else { &[] };
        simulation.step(&StepInput { commands, ..StepInput::default() });
    }
    let (mut way, mut turn): (f64, f64) = (0.0, 0.0);
    for (b, a) in before.iter().zip(simulation.bodies()) {
        way = way.max(a.position.distance(b.position));
        turn = turn.max(2.0 * a.rotation.dot(b.rotation).abs().min(1.0).acos());
    }
    println!("a gentle breath moves it {:.1} mm and {:.1}° in a second", 1000.0 * way, turn.to_degrees());
    assert!(way > 5e-3 || turn.to_degrees() > 2.0, "{way} m, {turn} rad");
}

#[test]
fn who_blows_into_a_demonstration_is_aimed_at_once() {
    /// What the breath's way still turns by in the next twentieth of a second, while plates begin to move, degrees.
    const TURNS: f64 = 1.0;
    let mut simulation = Simulation::new(steel_fish(), Settings::default());
    let mut blow = |speed, pointer, steps: usize| {
        let commands = [Command::Blow(Some(speed))];
        let input = StepInput { pointer: Some(pointer), commands: &commands, ..StepInput::default() };
        (0..steps).for_each(|_| simulation.step(&input));
        simulation.snapshot().breath.direction
    };
    let demonstration = blow(0.6, [0.27, 0.21], steps(2.0));
    let first = blow(5.0, PLATES, 1);
    let next = blow(5.0, PLATES, steps(0.05));
    assert!(demonstration.angle_between(first).to_degrees() > 5.0, "it goes elsewhere");
    let turned = first.angle_between(next).to_degrees();
    assert!(turned < TURNS, "{turned} degrees");
}

#[test]
fn half_of_the_strong_breaths_make_its_sheets_clash() {
    /// Of the hits alone, dB of full scale: 15 dB over the hiss of the breath after it.
    const AUDIBLE: f64 = -60.0;
    const BREATHS: u64 = 15;
    let exhibit = steel_fish();
    for (name, script) in STRONG {
        let loudest = |seed: u64| {
            let run = Run::new(&exhibit, exhibit.clone(), Visit { seed, ..Visit::new(6.0, script) });
            let sound = run.hits_alone();
            let t = sound.loudest();
            sound.level(t, t + 0.05)
        };
        let levels: Vec<f64> = (1..=BREATHS).map(loudest).collect();
        let clashes = levels.iter().filter(|level| **level > AUDIBLE).count() as u64;
        println!("{name}: {clashes} of {BREATHS} breaths; {levels:.0?} dB");
        assert!(2 * clashes >= BREATHS, "{name}: {clashes} of {BREATHS} breaths make a sheet ring");
    }
}

fn play_into(folder: &Path, breath: &str) -> (Summary, Vec<Vec<u8>>) {
    let exhibit = steel_fish();
    let recording = wav::read(self::folder().join("breaths").join(breath)).expect("a shipped breath");
    let files = ["audio.wav", "trace.csv", "events.jsonl"].map(|name| folder.join(name));
    let play = Play {
        settings: Settings { seed: MEETING, ..Settings::default() },
        seconds: 6.0,
        aim: Some(PLATES),
        breath: Some(WavFeed::new(recording.samples, recording.sample_rate)),
        audio: Some(files[0].clone()),
        trace: Some(files[1].clone()),
        events: Some(files[2].clone()),
        fps: 60,
        ..Play::default()
    };
    let summary = play::run(&exhibit, play, &AtomicBool::new(false), |_| (), None).expect("a run");
    (summary, files.iter().map(|file| std::fs::read(file).expect("a file of the run")).collect())
}

#[test]
fn the_same_run_twice_is_the_same_to_the_byte() {
    let (one, two) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    let (first, files) = play_into(one.path(), "strong.wav");
    let (second, again) = play_into(two.path(), "strong.wav");
    assert_eq!(first.state_hash, second.state_hash);
    assert!(files == again, "the files differ");
    assert!(first.impacts > 0, "a strong breath makes the plates meet");
    assert!(first.peak_dbfs.is_some_and(|peak| (-60.0..=-1.0).contains(&peak)), "{:?}", first.peak_dbfs);
    // 6 s at 60 frames, the last included, six bodies, and the head line.
    assert_eq!(String::from_utf8_lossy(&files[1]).lines().count(), 361 * 6 + 1);
}

#[test]
fn the_sound_follows_the_breath() {
    let folder = tempfile::tempdir().expect("a folder");
    play_into(folder.path(), "strong.wav");
    let sound = wav::read(folder.path().join("audio.wav")).expect("the sound of the run");
    let level = |from: f64, to: f64| {
        let rate = f64::from(sound.sample_rate);
        let part = &sound.samples[(from * rate) as usize..(to * rate) as usize];
        let power: f64 = part.iter().map(|s| f64::from(*s) * f64::from(*s)).sum::<f64>() / part.len() as f64;
        10.0 * power.max(1e-20).log10()
    };
    // The recording's breath lies between 0.5 and 2.2 s. Before it the air of the gallery is 30 dB below it, and not heard.
    let (before, during, after) = (level(0.0, 0.4), level(1.0, 1.8), level(5.5, 6.0));
    println!("before {before:.0}, during {during:.0}, after {after:.0} dBFS");
    assert!(before < during - 30.0 && before < -70.0, "sound before any breath: {before} dBFS");
    assert!(during > -45.0, "the breath is hardly heard: {during} dBFS");
    assert!(after < during - 20.0, "the sound does not end: {after} dBFS");
}

#[test]
fn a_hit_sounds_on_its_own_sample() {
    // Two plates brought together by hand, dry sound: the first sample that is not silent is the event's own.
    let exhibit = steel_fish();
    let folder = tempfile::tempdir().expect("a folder");
    let breath = wav::read(self::folder().join("breaths/strong.wav")).expect("a shipped breath");
    let files = ["dry.wav", "events.jsonl"].map(|name| folder.path().join(name));
    let mut quiet = (*exhibit).clone();
    // Without the wind's own sound only hits are left.
    quiet.sounds.retain(|s| s.on == exhibit::SoundTrigger::Impact);
    for instrument in &mut quiet.instruments {
        if instrument.timbre.starts_with("wind") {
            instrument.gain = 0.0;
        }
    }
    let play = Play {
        settings: Settings { seed: MEETING, ..Settings::default() },
        seconds: 4.0,
        aim: Some(PLATES),
        breath: Some(WavFeed::new(breath.samples, breath.sample_rate)),
        audio: Some(files[0].clone()),
        events: Some(files[1].clone()),
        dry: true,
        fps: 60,
        ..Play::default()
    };
    play::run(&Arc::new(quiet), play, &AtomicBool::new(false), |_| (), None).expect("a run");
    let events = std::fs::read_to_string(&files[1]).expect("events");
    let first = events.lines().map(|line| serde_json::from_str::<serde_json::Value>(line).expect("a JSON line"));
    let hit = first.filter(|e| e["kind"] == "impact").map(|e| e["sample"].as_u64().expect("a sample")).next();
    let sound = wav::read(&files[0]).expect("the sound");
    let heard = sound.samples.iter().position(|s| *s != 0.0).expect("a sound") as u64;
    // A struck mode begins as a sine: its first sample may be zero.
    const ONSET: u64 = 2;
    let hit = hit.expect("a hit");
    assert!((hit..=hit + ONSET).contains(&heard), "hit at {hit}, heard at {heard}");
}

#[test]
fn a_pushed_mechanism_keeps_its_joints_closed() {
    let mut simulation = Simulation::new(steel_fish(), Settings::default());
    let turn = rotation(DVec3::Y * 0.3);
    let pivot = simulation.bodies()[BOOM].pose().position;
    for body in simulation.bodies_mut() {
        body.position = pivot + turn * (body.position - pivot);
        body.rotation = turn * body.rotation;
    }
    run(&mut simulation, 2.0);
    assert!(simulation.joint_error() < JOINT_ERROR, "turning the whole figure opens no joint");
}
