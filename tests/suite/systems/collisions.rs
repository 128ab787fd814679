//! Collisions: what may not pass through what.

use super::run::{Moment, Visit, greatest, least};
use super::{Cut, Row, at_least, prove};

const BLOW_BALLS: &str = r#"{"t": 0, "aim": [0.5, 0.55]}
{"t": 0.5, "blow": {"strength": 0.6, "hold": 1.2, "release": 0.3}}"#;
const BREAK_CHAIN: &str = r#"{"t": 0, "aim": [0.5, 0.62]}
{"t": 0.5, "blow": {"strength": 0.8, "hold": 1.6, "release": 0.3}}"#;

pub const ROWS: &[Row] = &[
    Row {
        system: "sphere",
        exhibit: "billiards",
        visit: Visit::new(4.0, BLOW_BALLS),
        without: &[Cut::Row("collider", "Ball4"), Cut::Row("sound", "click-4"), Cut::Row("sound", "roll-4")],
        shows: |run| {
            let nearest = |now: Moment| {
                let balls = now.bodies();
                let pairs = balls.iter().enumerate().flat_map(|(i, a)| balls[..i].iter().map(move |b| (a, b)));
                least(pairs.map(|(a, b)| a.position.distance(b.position)))
            };
            vec![
                at_least(0.04 - 1e-4, "nearest centres, m", least(run.moments().map(nearest))),
                at_least(
                    0.08,
                    "lowest centre, m",
                    least(run.moments().map(|now| least(now.bodies().iter().map(|b| b.position.y)))),
                ),
            ]
        },
    },
    Row {
        system: "several points of two bodies",
        exhibit: "breaking-chain",
        visit: Visit::new(4.0, BREAK_CHAIN),
        without: &[Cut::Row("collider", "Tray")],
        shows: |run| {
            let most = greatest(run.moments().map(|now| now.contacts("Link5", None)));
            vec![
                at_least(2.0, "points between link and tray", most),
                at_least(0.0, "lowest, m", least(run.moments().map(|now| now.body("Link5").position.y))),
            ]
        },
    },
];

#[test]
fn bodies_do_not_pass_through_each_other() {
    prove(ROWS);
}
