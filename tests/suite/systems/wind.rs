//! Wind: of a breath by its law, and of the exhibit's own air.

use std::sync::Arc;

use soffio_math::exp;
use soffio_simulation::{STEPS_PER_SECOND, WindSample};

use super::run::{Run, Visit, greatest};
use super::{Bar, Cut, Row, at_least, at_most, prove, twin};

/// The lips of a visitor, m: the default of a site.
const LIPS: f64 = 0.01;
/// Half of the force's β: the most by which eddies change the speed of a breath, as a share of it.
const EDDIES: f64 = 0.3;

/// l₀ of a cone where the curator sets none, m: r₀/tan 11.8°.
const USUAL_VERTEX: f64 = 0.5 * LIPS / 0.208_916;

const AT_ROTOR: &str = r#"{"t": 0, "aim": [0.5, 0.35]}
{"t": 0.3, "blow": {"strength": 0.5, "hold": 2.0}}"#;
const AT_BEADS: &str = r#"{"t": 0, "aim": [0.5, 0.8]}
{"t": 0.1, "blow": {"strength": 0.5, "hold": 2.0}}"#;

/// The greatest departure of the air's speed at the patches in the breath from a law of distance and radius, as a share of
/// the law; and the number of those patches.
fn law(run: &Run, eddies: f64, law: impl Fn(f64, f64) -> f64) -> Vec<Bar> {
    /// Below this share of the speed on the axis the air counts as still.
    const FELT: f64 = 0.1;
    let breath = &run.breath;
    let expected = |patch: &WindSample| {
        let from = patch.point - breath.mouth;
        let x = from.dot(breath.direction);
        let r = (from - x * breath.direction).length();
        Some(law(x, r)).filter(|ratio| *ratio > FELT * law(x, 0.0)).map(|ratio| breath.speed * ratio)
    };
    let inside = run.air.iter().filter(|patch| patch.in_breath);
    let off: Vec<f64> = inside.filter_map(|patch| Some((patch.speed / expected(patch)? - 1.0).abs())).collect();
    vec![
        at_least(4.0, "patches in the breath", off.len() as f64),
        at_most(eddies, "off the law", greatest(off.into_iter())),
    ]
}

/// v/U₀ of a jet, 6 d/x exp(−ln 2 (r/0.094 x)²).
fn jet(x: f64, r: f64) -> f64 {
    let width = r / (0.094 * x);
    6.0 * LIPS / x * exp(-std::f64::consts::LN_2 * width * width)
}

/// v/U₀ of a cone, (l₀/(l₀ + x))².
fn cone(x: f64, vertex: f64) -> f64 {
    (vertex / (vertex + x)) * (vertex / (vertex + x))
}

pub const ROWS: &[Row] = &[
    Row {
        system: "breath as a jet",
        exhibit: "windmill",
        visit: Visit::new(1.0, AT_ROTOR),
        without: &[Cut::Set("wind.breath", "law", "\"cone\"")],
        shows: |run| law(run, EDDIES, jet),
    },
    Row {
        system: "breath as a cone",
        exhibit: "blown-together",
        visit: Visit::new(0.3, AT_BEADS),
        without: &[Cut::Plain("wind.breath", "law")],
        shows: |run| law(run, EDDIES, |x, _| cone(x, USUAL_VERTEX)),
    },
    Row {
        system: "fan",
        exhibit: "windy-corner",
        visit: Visit::new(6.0, ""),
        without: &[Cut::All("wind.fan")],
        shows: |run| {
            vec![at_least(1.0, "pinwheel unblown, rad/s", run.end().body("Pinwheel").angular_velocity.z.abs())]
        },
    },
    Row {
        system: "parameter as a function of time",
        exhibit: "windy-corner",
        visit: Visit::new(12.0, ""),
        without: &[Cut::Set("wind.fan.0", "speed", "1.2")],
        // The vent blows fastest after 3 s and slowest after 9 s; the pinwheel follows a second later.
        shows: |run| {
            let spin = |t: f64| run.at(t).body("Pinwheel").angular_velocity.z.abs();
            vec![
                at_least(1.5, "spin after 4 s, as a multiple of that after 10 s", spin(4.0) / spin(10.0)),
                at_least(1.0, "spin after 10 s, rad/s", spin(10.0)),
            ]
        },
    },
    Row {
        system: "draught",
        exhibit: "windy-corner",
        visit: Visit::new(6.0, ""),
        without: &[Cut::All("wind.draught")],
        shows: |run| {
            vec![at_least(5e-3, "strip unblown, m", greatest(run.moments().map(|now| now.way("MiddleStrip"))))]
        },
    },
    Row {
        system: "gust",
        exhibit: "windy-corner",
        visit: Visit::new(17.5, ""),
        without: &[Cut::All("wind.gust")],
        // From the door to the left, against the draught.
        shows: |run| {
            let second = STEPS_PER_SECOND as usize;
            let push = run.wind.chunks(second).map(|forces| -forces.iter().map(|f| f.x).sum::<f64>() / second as f64);
            vec![at_least(1e-4, "push to the left in a second, N", greatest(push))]
        },
    },
    Row {
        system: "the room's own air",
        exhibit: "steel-fish",
        visit: Visit::new(8.0, ""),
        without: &[Cut::All("wind.ambient")],
        shows: |run| vec![at_least(1e-3, "a plate unblown, m", greatest(run.moments().map(|now| now.way("RedPlate"))))],
    },
];

#[test]
fn air_moves_what_it_should() {
    prove(ROWS);
}

/// The bars of a visit to an exhibit with another value of a key of its breath.
fn with(exhibit: &str, key: &'static str, value: &'static str, visit: Visit, bars: fn(&Run) -> Vec<Bar>) -> [bool; 2] {
    let shipped = Arc::new(twin::shipped(exhibit));
    let other = Arc::new(twin::twin(exhibit, &[Cut::Set("wind.breath", key, value)]));
    [shipped.clone(), other].map(|visited| {
        let bars = bars(&Run::new(&shipped, visited, visit));
        println!("{exhibit}, {key} = {value}: {}", super::listed(&bars));
        bars.iter().all(Bar::passed)
    })
}

#[test]
fn a_curator_sets_the_spread_of_the_cone() {
    // A vertex 80 mm behind the lips: half a metre away the air of the cone is 9 times as fast as of the usual one.
    let bars = |run: &Run| law(run, EDDIES, |x, _| cone(x, 0.08));
    let passed = with("blown-together", "vertex_distance", "\"80 mm\"", Visit::new(0.3, AT_BEADS), bars);
    assert_eq!(passed, [false, true]);
}

#[test]
fn a_curator_sets_the_turbulence_of_the_breath() {
    /// Rounding of exp and of products.
    const SAME: f64 = 1e-9;
    let steady = |run: &Run| law(run, SAME, jet);
    assert_eq!(with("windmill", "turbulence", "0.0", Visit::new(1.0, AT_ROTOR), steady), [false, true]);
    // And the strongest eddies go further than the usual ones.
    let usual = |run: &Run| law(run, EDDIES, jet);
    assert_eq!(with("windmill", "turbulence", "1.0", Visit::new(1.0, AT_ROTOR), usual), [true, false]);
}
