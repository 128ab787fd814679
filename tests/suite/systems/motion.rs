//! Motion that is given, taken in hand, or computed in another way.

use soffio_math::{PI, cos};

use super::run::{Moment, Visit, greatest};
use super::{Cut, Row, at_least, at_most, prove};

const DRAG_ARM: &str = r#"{"t": 0.2, "grab": {"body": "ForearmLeft"}}
{"t": 0.4, "drag": [0.25, 0.4]}
{"t": 1.0, "drag": [0.3, 0.8]}"#;
const AT_FISH: &str = r#"{"t": 0, "aim": [0.4, 0.25]}
{"t": 0.5, "blow": {"strength": 0.5, "hold": 1.0, "release": 0.3}}"#;
/// The rack is blown apart and left to itself.
const BLOW_BALLS: &str = r#"{"t": 0, "aim": [0.5, 0.55]}
{"t": 1.0, "blow": {"strength": 0.6, "hold": 1.2, "release": 0.3}}"#;

/// Joint error that the collection allows position-based motion, m (`procedural/collection.rs`).
#[cfg(feature = "kiosk")]
const BY_POSITIONS: f64 = 1e-3;

pub const ROWS: &[Row] = &[
    Row {
        system: "body that follows a path",
        exhibit: "chains",
        visit: Visit::new(2.0, ""),
        without: &[Cut::Key("body", "Carriage", "path"), Cut::Key("body", "Carriage", "motion")],
        // A sine of 13 cm and 4 s through eight points.
        shows: |run| {
            const SPLINE: f64 = 2e-3;
            let off = |now: Moment| (now.body("Carriage").pose().position.x + 0.13 * cos(0.5 * PI * now.t())).abs();
            vec![
                at_most(SPLINE, "off the sine, m", greatest(run.moments().map(off))),
                at_least(0.2, "way, m", run.end().way("Carriage")),
            ]
        },
    },
    Row {
        system: "body that follows an animation of the model",
        exhibit: "chain-light",
        visit: Visit::new(6.0, ""),
        without: &[Cut::Key("body", "Carriage", "animation"), Cut::Key("body", "Carriage", "motion")],
        // A sine of 13 cm and 4 s in cubic pieces of T = 0.5 s: off by at most A ω⁴ T⁴/384.
        shows: |run| {
            const PIECES: f64 = 2e-4;
            let off = |now: Moment| (now.body("Carriage").pose().position.x + 0.13 * cos(0.5 * PI * now.t())).abs();
            vec![
                at_most(PIECES, "off the sine, m", greatest(run.moments().map(off))),
                at_most(1e-9, "joint error, m", greatest(run.moments().map(|now| now.gap("light-1")))),
            ]
        },
    },
    Row {
        system: "taken by the hand",
        exhibit: "marionette",
        visit: Visit::new(2.0, DRAG_ARM),
        without: &[Cut::Set("touch", "permitted", "false")],
        shows: |run| {
            vec![
                at_least(0.05, "the hand moves the arm, m", greatest(run.moments().map(|now| now.way("ForearmLeft")))),
                at_most(1e-9, "joint error, m", run.joint_error),
            ]
        },
    },
    Row {
        system: "rolling and sliding balls",
        exhibit: "billiards",
        visit: Visit::new(10.0, BLOW_BALLS),
        without: &[Cut::Plain("material.cloth", "rolling_resistance")],
        shows: |run| {
            let fastest = |now: Moment| greatest(now.bodies().iter().map(|ball| ball.velocity.length()));
            vec![
                at_least(0.05, "blown, m/s", greatest(run.during(1.0, 3.0).map(fastest))),
                at_most(0.01, "at the end, m/s", fastest(run.end())),
            ]
        },
    },
    #[cfg(feature = "kiosk")]
    Row {
        system: "choice of the solver while it runs",
        exhibit: "chains",
        visit: Visit { slow_machine: true, ..Visit::new(2.0, "") },
        without: &[Cut::Set("solver", "motion", "\"dynamics\"")],
        shows: |run| {
            vec![
                at_least(1.0, "changes of the solver", run.switches),
                at_most(BY_POSITIONS, "joint error, m", run.joint_error),
                at_least(0.2, "the carriage goes on, m", run.end().way("Carriage")),
            ]
        },
    },
    Row {
        system: "idle damping",
        exhibit: "steel-fish",
        visit: Visit::new(10.0, AT_FISH),
        without: &[Cut::All("wind.idle_damping")],
        shows: |run| {
            let spin = |t: f64| run.at(t).body("Boom").angular_velocity.length();
            vec![at_least(0.1, "blown, rad/s", spin(2.0)), at_most(0.02, "five seconds after it, rad/s", spin(10.0))]
        },
    },
];

#[test]
fn bodies_move_as_they_are_led() {
    prove(ROWS);
}
