//! Sounds: what a hit, a scratch or a wind plays, as rendered. Hands make the hits, so that no breath covers them.

use super::rendered::Sound;
use super::run::{Run, Visit};
use super::{Bar, Cut, Row, at_least, at_most, prove};

const PULL_BELL: &str = r#"{"t": 0.1, "grab": {"body": "MalletBell"}}
{"t": 0.2, "drag": [0.33, 0.15]}
{"t": 0.5, "release": true}"#;
const PULL_DRUM: &str = r#"{"t": 0.1, "grab": {"body": "MalletDrum"}}
{"t": 0.2, "drag": [0.42, 0.15]}
{"t": 0.5, "release": true}"#;
const PULL_METAL: &str = r#"{"t": 0.1, "grab": {"body": "MalletMetal"}}
{"t": 0.2, "drag": [0.54, 0.15]}
{"t": 0.5, "release": true}"#;
const PUSH_WOOD: &str = r#"{"t": 0.1, "grab": {"body": "MalletWood"}}
{"t": 0.2, "drag": [0.8, 0.3]}
{"t": 0.5, "release": true}"#;
const PULL_STRIKER: &str = r#"{"t": 0.1, "grab": {"body": "Striker"}}
{"t": 0.2, "drag": [0.6, 0.5]}
{"t": 0.5, "release": true}"#;
const THROW_PLATE: &str = r#"{"t": 0.1, "grab": {"body": "RedPlate"}}
{"t": 0.2, "drag": [0.60, 0.4]}
{"t": 1.0, "release": true}"#;
const SCRATCH: &str = r#"{"t": 0.3, "grab": {"body": "Quill"}}
{"t": 0.5, "drag": [0.35, 0.5]}
{"t": 1.0, "drag": [0.65, 0.6]}"#;
const BREATH: &str = r#"{"t": 0, "aim": [0.5, 0.7]}
{"t": 1.0, "blow": {"strength": 0.6, "hold": 1.0, "release": 0.3}}"#;

/// Audible in a quiet room from an output that plays full scale at 90 dB(A), dB of full scale.
const AUDIBLE: f64 = -60.0;
/// Beats of a struck body are over after this time, s.
const ATTACK: f64 = 0.05;

/// The sound of a run, the time of its loudest hit (s) and the level there, dB.
fn hit(run: &Run) -> (Sound, f64, f64) {
    let sound = run.sound();
    let t = sound.loudest();
    let level = sound.level(t, t + ATTACK);
    (sound, t, level)
}

/// By how much a hit has faded after some time, s: dB.
fn fading((sound, t, level): &(Sound, f64, f64), after: f64) -> f64 {
    level - sound.level(t + after, t + after + ATTACK)
}

/// Bars of a body that rings.
fn rings(run: &Run) -> Vec<Bar> {
    let hit = hit(run);
    vec![at_least(AUDIBLE, "level, dB", hit.2), at_most(12.0, "fades in 0.3 s, dB", fading(&hit, 0.3))]
}

/// Bars of a body that does not ring.
fn knocks(run: &Run) -> Vec<Bar> {
    let hit = hit(run);
    vec![at_least(AUDIBLE, "level, dB", hit.2), at_least(20.0, "fades in 0.1 s, dB", fading(&hit, 0.1))]
}

pub const ROWS: &[Row] = &[
    Row {
        system: "bell",
        exhibit: "strikers",
        visit: Visit::new(1.5, PULL_BELL),
        without: &[Cut::Row("sound", "bell")],
        shows: rings,
    },
    Row {
        system: "metal",
        exhibit: "strikers",
        visit: Visit::new(1.5, PULL_METAL),
        without: &[Cut::Row("sound", "metal")],
        shows: rings,
    },
    Row {
        system: "drum",
        exhibit: "strikers",
        visit: Visit::new(1.5, PULL_DRUM),
        without: &[Cut::Row("sound", "drum")],
        // Lower than wood.
        shows: |run| {
            let (sound, t, _) = hit(run);
            let mut bars = knocks(run);
            bars.push(at_most(500.0, "rate, Hz", sound.rate(t, t + 2.0 * ATTACK)));
            bars
        },
    },
    Row {
        system: "wood",
        exhibit: "strikers",
        visit: Visit::new(1.0, PUSH_WOOD),
        without: &[Cut::Row("sound", "wood")],
        shows: |run| {
            let (sound, t, _) = hit(run);
            let mut bars = knocks(run);
            bars.push(at_least(500.0, "rate, Hz", sound.rate(t, t + 0.5 * ATTACK)));
            bars
        },
    },
    Row {
        system: "a tube that rings",
        exhibit: "wind-chimes",
        visit: Visit::new(2.0, PULL_STRIKER),
        without: &[
            Cut::Row("sound", "tube-1"),
            Cut::Row("sound", "tube-2"),
            Cut::Row("sound", "tube-3"),
            Cut::Row("sound", "tube-4"),
            Cut::Row("sound", "tube-5"),
            Cut::Row("sound", "tube-6"),
        ],
        // The strongest partial is a note of the scale that the tubes are cut for: C, D, E, G, A, C of equal temperament.
        shows: |run| {
            const SCALE: [f64; 6] = [523.25, 587.33, 659.26, 783.99, 880.0, 1046.5];
            let hit = hit(run);
            let found = hit.0.strongest((450, 1150), hit.1, hit.1 + 0.5);
            let off = SCALE.iter().map(|note| (found / note - 1.0).abs()).fold(f64::INFINITY, f64::min);
            vec![
                at_least(AUDIBLE, "level, dB", hit.2),
                at_most(0.01, "off the scale", off),
                at_most(20.0, "fades in 0.7 s, dB", fading(&hit, 0.7)),
            ]
        },
    },
    Row {
        system: "plates that ring",
        exhibit: "steel-fish",
        visit: Visit::new(2.5, THROW_PLATE),
        without: &[
            Cut::Row("sound", "fish-hit"),
            Cut::Row("sound", "red-hit"),
            Cut::Row("sound", "orange-hit"),
            Cut::Row("sound", "white-hit"),
        ],
        // Thin sheet: its partials lie high.
        shows: |run| {
            let (sound, t, level) = hit(run);
            vec![
                at_least(AUDIBLE, "level, dB", level),
                at_least(2000.0, "rate, Hz", sound.rate(t, t + ATTACK)),
                at_least(-80.0, "level 0.3 s later, dB", sound.level(t + 0.3, t + 0.3 + ATTACK)),
            ]
        },
    },
    Row {
        system: "scratching wood",
        exhibit: "scratch-board",
        visit: Visit::new(1.3, SCRATCH),
        without: &[Cut::Row("sound", "scratch")],
        shows: |run| {
            let sound = run.slides_alone();
            vec![
                at_most(-90.0, "level at rest, dB", sound.level(0.0, 0.29)),
                at_least(AUDIBLE, "level while it slides, dB", sound.level(0.5, 1.2)),
            ]
        },
    },
    Row {
        system: "wind that is heard",
        exhibit: "pendulum",
        visit: Visit::new(2.0, BREATH),
        without: &[Cut::Row("sound", "air")],
        shows: |run| {
            let sound = run.wind_alone();
            vec![
                at_most(-90.0, "level before the breath, dB", sound.level(0.0, 0.99)),
                at_least(AUDIBLE, "level in it, dB", sound.level(1.2, 1.9)),
            ]
        },
    },
];

#[test]
fn what_happens_is_heard() {
    prove(ROWS);
}
