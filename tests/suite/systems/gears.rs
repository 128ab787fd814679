//! Gears, cords, clutches and teeth: the ratios that they hold.

use soffio_math::{DVec3, PI};

use super::run::{Run, Visit, greatest};
use super::{Cut, Row, at_least, at_most, prove};

/// What the product promises of gears: rad, and m.
const HOLDS: f64 = 1e-9;
/// Rotation that anyone sees, rad: 5°.
const VISIBLE: f64 = 5.0 * PI / 180.0;
/// A clock's visit: three beats.
const BEATS: Visit = Visit::new(3.3, "");

const WIND_UP: &str = r#"{"t": 0, "aim": [0.5, 0.5]}
{"t": 0.3, "blow": {"strength": 0.8, "hold": 1.0, "release": 0.3}}"#;

/// The greatest of a sum of rotations about z with these factors, rad.
fn slip(run: &Run, terms: &[(&str, f64)]) -> f64 {
    let turns: Vec<Vec<f64>> = terms.iter().map(|(body, _)| run.turning(body, DVec3::Z)).collect();
    let sum = |step: usize| terms.iter().zip(&turns).map(|((_, factor), turn)| factor * turn[step]).sum::<f64>().abs();
    greatest((0..turns[0].len()).map(sum))
}

pub const ROWS: &[Row] = &[
    Row {
        system: "gear to gear",
        exhibit: "gear-train",
        visit: Visit::new(2.0, ""),
        without: &[Cut::Row("constraint.gear", "mesh-1-2")],
        // 60 and 20 teeth: θ₂ = −3 θ₁.
        shows: |run| {
            vec![
                at_most(HOLDS, "|θ₂ + 3 θ₁|, rad", slip(run, &[("Wheel2", 1.0), ("Wheel1", 3.0)])),
                at_least(VISIBLE, "θ₁, rad", run.turned("Wheel1", DVec3::Z).abs()),
            ]
        },
    },
    Row {
        system: "gear to weight",
        exhibit: "gear-train",
        visit: Visit::new(2.0, ""),
        without: &[Cut::Row("constraint.gear-weight", "cord")],
        // A drum of 6 mm: the weight falls by r θ.
        shows: |run| {
            let start = run.at(0.0).body("Weight").position.y;
            let angles = run.turning("Wheel1", DVec3::Z);
            let slip = run
                .during(0.0, f64::MAX)
                .zip(angles)
                .map(|(now, angle)| (start - now.body("Weight").position.y - 6e-3 * angle).abs());
            vec![
                at_most(HOLDS, "slip of the cord, m", greatest(slip)),
                at_least(5e-3, "falls, m", run.end().way("Weight")),
            ]
        },
    },
    Row {
        system: "drawn cord",
        exhibit: "gear-train",
        visit: Visit::new(2.0, ""),
        without: &[Cut::All("cord")],
        // It lengthens as the weight falls, upright but for the offset of drum and weight.
        shows: |run| {
            let (start, end) = (run.at(0.0), run.end());
            let paid_out = end.cord("cord-line") - start.cord("cord-line");
            vec![
                at_most(1e-5, "unlike the weight's way, m", (paid_out - end.way("Weight")).abs()),
                at_least(5e-3, "lengthens, m", paid_out),
            ]
        },
    },
    Row {
        system: "differential",
        exhibit: "breath-clock",
        visit: Visit::new(2.0, WIND_UP),
        without: &[Cut::Row("constraint.gear", "differential")],
        // Both wheels have as many teeth: the drum turns by their mean.
        shows: |run| {
            let terms = [("GreatWheel", 1.0), ("WindingWheel", 1.0), ("Drum", -2.0)];
            vec![
                at_most(HOLDS, "|θ + θ′ − 2 θ of the drum|, rad", slip(run, &terms)),
                at_least(1e-3, "the drum turns, rad", run.turned("Drum", DVec3::Z).abs()),
            ]
        },
    },
    Row {
        system: "clutch",
        exhibit: "terry-clock",
        visit: BEATS,
        without: &[Cut::Row("constraint.clutch", "cannon-friction"), Cut::All("clock")],
        // The cannon with the hand goes with its arbor: a turn an hour.
        shows: |run| {
            vec![
                at_most(HOLDS, "slips, rad", slip(run, &[("Cannon", 1.0), ("MinuteArbor", -1.0)])),
                at_least(2.0 * PI / 3600.0, "turns, rad", run.turned("Cannon", DVec3::Z).abs()),
            ]
        },
    },
    Row {
        system: "teeth that touch",
        exhibit: "terry-clock",
        visit: BEATS,
        without: &[Cut::Row("collider", "EscapeTooth")],
        // A tooth of 42 escapes in each period of 1.0714 s.
        shows: |run| {
            let teeth = 42.0 / (2.0 * PI) * run.turned("EscapeWheel", DVec3::Z).abs();
            vec![
                at_least(2.0, "teeth that pass", teeth),
                at_most(4.0, "teeth that pass", teeth),
                at_least(4.0, "hits on the pallets", run.hits("EscapeWheel", Some("Anchor"))),
            ]
        },
    },
];

#[test]
fn gears_hold_their_ratios() {
    prove(ROWS);
}
