//! Time: joints that come and go, by the clock, by a breath, by a load.

use soffio_math::{DVec3, exp};
use soffio_simulation::EventKind;

use super::run::{Moment, Run, Visit, greatest};
use super::{Cut, Row, at_least, at_most, prove};

/// The model's points are 32-bit floats; joints that have closed hold to that, m.
const CLOSED: f64 = 1e-8;

const GATHER: &str = r#"{"t": 0.1, "gather": 7}"#;
const BREATH: &str = r#"{"t": 0, "aim": [0.5, 0.8]}
{"t": 1.0, "blow": {"strength": 0.4, "hold": 1.0, "release": 0.3}}"#;
const AT_CHAIN: &str = r#"{"t": 0, "aim": [0.5, 0.62]}
{"t": 0.5, "blow": {"strength": 0.8, "hold": 1.6, "release": 0.3}}"#;
const TWICE: &str = r#"{"t": 0, "aim": [0.44, 0.72]}
{"t": 6.2, "blow": {"strength": 0.8, "hold": 1.2, "release": 0.3}}
{"t": 18.2, "blow": {"strength": 0.8, "hold": 1.2, "release": 0.3}}"#;

/// Joints that a breath calls up.
const TRIGGERED: [&str; 5] = ["hook", "joint-2", "joint-3", "joint-4", "joint-5"];

/// Those joints without one of their keys.
const fn without(key: &'static str) -> [Cut; 5] {
    let [hook, second, third, fourth, fifth] = TRIGGERED;
    let ball = "constraint.point-to-point";
    [
        Cut::Key("constraint.nail", hook, key),
        Cut::Key(ball, second, key),
        Cut::Key(ball, third, key),
        Cut::Key(ball, fourth, key),
        Cut::Key(ball, fifth, key),
    ]
}

/// Those joints from the start on: the beads then assemble without a breath.
const ALWAYS: [Cut; 6] = {
    let [hook, second, third, fourth, fifth] = without("trigger");
    [Cut::Set("solver", "assemble", "true"), hook, second, third, fourth, fifth]
};

/// Widest gap of the beads' joints.
fn open(now: Moment) -> f64 {
    greatest(TRIGGERED.iter().map(|joint| now.gap(joint)))
}

fn along(run: &Run, now: Moment) -> f64 {
    (now.body("Pendulum").pose().position - run.at(0.0).body("Pendulum").pose().position).x.abs()
}

pub const ROWS: &[Row] = &[
    Row {
        system: "self-assembly when it comes on",
        exhibit: "plates",
        visit: Visit::new(6.0, GATHER),
        without: &[Cut::Set("scene", "assembly_animation", "false")],
        shows: |run| {
            let gap = |now: Moment| now.gap("large-on-upper");
            vec![
                at_least(0.02, "scattered, m", greatest(run.moments().map(gap))),
                at_most(CLOSED, "at the end, m", gap(run.end())),
            ]
        },
    },
    Row {
        system: "self-assembly in the course of it",
        exhibit: "blown-together",
        visit: Visit::new(11.0, BREATH),
        without: &[Cut::Row("constraint.point-to-point", "joint-3")],
        shows: |run| {
            vec![
                at_least(0.02, "gap at first, m", run.at(0.9).gap("joint-3")),
                at_most(1e-4, "gap after six seconds, m", run.at(7.0).gap("joint-3")),
            ]
        },
    },
    Row {
        system: "time window",
        exhibit: "blown-together",
        visit: Visit::new(11.0, BREATH),
        without: &without("window"),
        shows: |run| {
            vec![at_most(1e-4, "gap within, m", open(run.at(7.0))), at_least(0.02, "gap after, m", open(run.at(10.5)))]
        },
    },
    Row {
        system: "event trigger",
        exhibit: "blown-together",
        visit: Visit::new(11.0, BREATH),
        without: &ALWAYS,
        shows: |run| {
            vec![
                at_most(
                    1e-3,
                    "beads move before the breath, m",
                    greatest(
                        run.at(1.0)
                            .bodies()
                            .iter()
                            .zip(run.at(0.0).bodies())
                            .map(|(now, start)| now.position.distance(start.position)),
                    ),
                ),
                at_most(1e-4, "gap after it, m", open(run.at(7.0))),
            ]
        },
    },
    Row {
        system: "breaking at a limit",
        exhibit: "breaking-chain",
        visit: Visit::new(3.0, AT_CHAIN),
        without: &[Cut::Key("constraint.point-to-point", "weak", "break")],
        shows: |run| {
            vec![
                at_least(1.0, "breaks", run.count(EventKind::Break)),
                at_least(0.1, "opens, m", greatest(run.moments().map(|now| now.gap("weak")))),
            ]
        },
    },
    Row {
        system: "periodic window",
        exhibit: "loose-nail",
        visit: Visit::new(20.0, TWICE),
        without: &[Cut::Key("constraint.element", "loose", "period")],
        shows: |run| {
            vec![
                at_least(
                    0.01,
                    "along in the first window, m",
                    greatest(run.during(6.0, 12.0).map(|now| along(run, now))),
                ),
                at_most(1e-4, "along between, m", greatest(run.during(17.0, 18.0).map(|now| along(run, now)))),
                at_least(
                    0.01,
                    "along in the second window, m",
                    greatest(run.during(18.0, 20.0).map(|now| along(run, now))),
                ),
            ]
        },
    },
    Row {
        system: "transition between axes",
        exhibit: "axis-wheel",
        visit: Visit::new(5.0, ""),
        without: &[Cut::Row("constraint.orientation", "upright-1"), Cut::Row("constraint.orientation", "upright-2")],
        // After the change at 2.5 s each angle that opens closes as a critically damped spring with 1/ω = 120 ms.
        shows: |run| {
            const OMEGA: f64 = 1.0 / 0.12;
            let row = |now: Moment| soffio_math::asin((now.body("Wheel").rotation * DVec3::X).y);
            let (c, rate) = {
                let wheel = run.at(2.5).body("Wheel");
                let x = wheel.rotation * DVec3::X;
                (row(run.at(2.5)), wheel.angular_velocity.cross(x).y / (1.0 - x.y * x.y).sqrt())
            };
            let off = run.during(2.5, 4.9).map(|now| {
                let t = now.t() - 2.5;
                (row(now) - (c + (rate + OMEGA * c) * t) * exp(-OMEGA * t)).abs()
            });
            vec![
                at_least(0.5, "opens, rad", c.abs()),
                at_most(3e-4, "off the damped spring, rad", greatest(off)),
                at_most(
                    1e-6,
                    "off upright at the end, rad",
                    run.at(4.95).lean("upright-1").max(run.at(4.95).lean("upright-2")),
                ),
            ]
        },
    },
    Row {
        system: "ramp",
        exhibit: "blown-together",
        visit: Visit::new(11.0, BREATH),
        without: &without("window.ramp_in"),
        shows: |run| {
            let fastest = |t: f64| greatest(run.at(t).bodies().iter().map(|bead| bead.velocity.length()));
            let trigger =
                run.events.iter().find(|event| event.kind == EventKind::Trigger).map_or(f64::NAN, |event| event.t);
            vec![
                at_most(4e-3, "30 ms after the trigger, m/s", fastest(trigger + 0.03)),
                at_least(0.02, "150 ms after it, m/s", fastest(trigger + 0.15)),
            ]
        },
    },
];

#[test]
fn joints_come_and_go_when_they_should() {
    prove(ROWS);
}
