//! Limits: what must not go further goes as far as it may, and no further.

use soffio_math::{DVec3, PI};

use super::run::{Moment, Visit, greatest};
use super::{Cut, Row, at_least, at_most, prove};

/// A bound yields by what one step of 1/240 s overshoots at the speeds here, rad or m.
const YIELDS: f64 = 1e-3;

const LIFT_MALLET: &str = r#"{"t": 0.2, "grab": {"body": "MalletDrum"}}
{"t": 0.4, "drag": [0.4, 0.4]}
{"t": 0.8, "drag": [0.4, 0.1]}"#;
const PULL_BEAD: &str = r#"{"t": 0.2, "grab": {"body": "Bead5"}}
{"t": 0.4, "drag": [0.95, 0.3]}"#;
const PULL_BOOM: &str = r#"{"t": 0.2, "grab": {"body": "Boom"}}
{"t": 0.4, "drag": [0.5, 0.95]}"#;
const WIND_UP: &str = r#"{"t": 0, "aim": [0.5, 0.5]}
{"t": 2.0, "blow": {"strength": 0.8, "hold": 1.0, "release": 0.3}}"#;

pub const ROWS: &[Row] = &[
    Row {
        system: "stops of a turn or way",
        exhibit: "strikers",
        visit: Visit::new(2.0, LIFT_MALLET),
        without: &[Cut::Key("constraint.hinge", "drum-mallet", "limit")],
        shows: |run| {
            let lift = greatest(run.turning("MalletDrum", DVec3::X).iter().map(|angle| angle.abs()));
            let stop = 80.0_f64.to_radians();
            vec![at_most(stop + YIELDS, "is lifted, rad", lift), at_least(stop - YIELDS, "is lifted, rad", lift)]
        },
    },
    Row {
        system: "ratchet",
        exhibit: "breath-clock",
        visit: Visit::new(4.0, WIND_UP),
        without: &[Cut::Row("constraint.ratchet", "pawl")],
        shows: |run| {
            let turn = run.turning("WindingThird", DVec3::Z);
            let mut most = f64::NEG_INFINITY;
            let back = turn.iter().map(|&angle| {
                most = angle.max(most);
                most - angle
            });
            let back = greatest(back);
            vec![at_most(YIELDS, "turns back, rad", back), at_least(PI / 6.0, "is wound, rad", most)]
        },
    },
    Row {
        system: "slack cord",
        exhibit: "blown-together",
        visit: Visit::new(2.0, PULL_BEAD),
        without: &[Cut::Row("constraint.limit", "thread-5")],
        shows: |run| {
            let far = |now: Moment| now.distance("thread-5");
            vec![
                at_most(0.388 + YIELDS, "length, m", greatest(run.moments().map(far))),
                at_least(0.388 - YIELDS, "length, m", greatest(run.moments().map(far))),
            ]
        },
    },
    Row {
        system: "tilt on a point",
        exhibit: "steel-fish",
        visit: Visit::new(2.0, PULL_BOOM),
        without: &[Cut::Key("constraint.nail", "cup-on-point", "limit")],
        shows: |run| {
            let tilt = |now: Moment| (now.body("Boom").rotation * DVec3::Y).angle_between(DVec3::Y);
            vec![
                at_most(12.0_f64.to_radians() + YIELDS, "tilts, rad", greatest(run.moments().map(tilt))),
                at_least(11.5_f64.to_radians(), "tilts, rad", greatest(run.moments().map(tilt))),
            ]
        },
    },
];

#[test]
fn limits_are_reached_and_not_passed() {
    prove(ROWS);
}
