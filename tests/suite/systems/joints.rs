//! Joints: what each holds, to the bounds that the product promises, while the rest moves.

use soffio_math::{DVec3, PI};

use super::run::{Moment, STEP, Visit, greatest, least};
use super::{Cut, Row, at_least, at_most, prove};

/// What the product promises of joints: m, and rad.
const HOLDS: f64 = 1e-9;
/// Rotation that anyone sees, rad: 5°.
const VISIBLE: f64 = 5.0 * PI / 180.0;

const STRONG: &str = r#"{"t": 0, "aim": [0.5, 0.55]}
{"t": 0.3, "blow": {"strength": 0.6, "hold": 1.2, "release": 0.3}}"#;
const BESIDE: &str = r#"{"t": 0, "aim": [0.56, 0.72]}
{"t": 0.3, "blow": {"strength": 0.8, "hold": 1.2, "release": 0.3}}"#;
const ROTOR: &str = r#"{"t": 0, "aim": [0.5, 0.35]}
{"t": 0.3, "blow": {"strength": 0.5, "hold": 2.0, "release": 0.3}}"#;

const DRAG_QUILL: &str = r#"{"t": 0.3, "grab": {"body": "Quill"}}
{"t": 0.5, "drag": [0.35, 0.5]}
{"t": 1.0, "drag": [0.65, 0.6]}"#;
const PULL_WEIGHT: &str = r#"{"t": 0.2, "grab": {"body": "Weight"}}
{"t": 0.4, "drag": [0.8, 0.6]}"#;
const PULL_BELL: &str = r#"{"t": 0.2, "grab": {"body": "Bell"}}
{"t": 0.4, "drag": [0.3, 0.2]}"#;

pub const ROWS: &[Row] = &[
    Row {
        system: "point to point",
        exhibit: "moving-path",
        visit: Visit::new(3.0, STRONG),
        without: &[Cut::Row("constraint.point-to-point", "tail-1")],
        shows: |run| {
            let between = |now: Moment| {
                let across = |body| now.body(body).rotation * DVec3::X;
                across("Tail1").angle_between(across("Swallow"))
            };
            vec![
                at_most(HOLDS, "gap, m", greatest(run.moments().map(|now| now.gap("tail-1")))),
                at_least(
                    VISIBLE,
                    "bends, rad",
                    greatest(run.moments().map(between)) - least(run.moments().map(between)),
                ),
            ]
        },
    },
    Row {
        system: "point to nail",
        exhibit: "plates",
        visit: Visit::new(3.0, STRONG),
        without: &[Cut::Row("constraint.nail", "hook")],
        shows: |run| {
            vec![
                at_most(HOLDS, "gap, m", greatest(run.moments().map(|now| now.gap("hook")))),
                at_least(VISIBLE, "turns, rad", greatest(run.moments().map(|now| now.angle("Upper")))),
            ]
        },
    },
    Row {
        system: "point on a moving path",
        exhibit: "moving-path",
        visit: Visit::new(3.0, ""),
        without: &[Cut::Row("constraint.nail", "way")],
        // The figure of eight: x = 150 mm sin 2πt/8 s, z = 60 mm sin 4πt/8 s, through sixteen points of it.
        shows: |run| {
            const SPLINE: f64 = 1e-3;
            let off = |now: Moment| {
                let phase = 2.0 * PI * now.t() / 8.0;
                let eight = DVec3::new(0.15 * soffio_math::sin(phase), 0.33, 0.06 * soffio_math::sin(2.0 * phase));
                now.body("Swallow").pose().position.distance(eight)
            };
            vec![
                at_most(SPLINE, "off the eight, m", greatest(run.moments().map(off))),
                at_least(0.1, "way, m", greatest(run.moments().map(|now| now.way("Swallow")))),
            ]
        },
    },
    Row {
        system: "orientation",
        exhibit: "scratch-board",
        visit: Visit::new(2.0, DRAG_QUILL),
        without: &[Cut::Row("constraint.orientation", "upright-x")],
        shows: |run| {
            vec![
                at_most(HOLDS, "leans, rad", greatest(run.moments().map(|now| now.lean("upright-x")))),
                at_least(0.02, "dragged, m", greatest(run.moments().map(|now| now.way("Quill")))),
            ]
        },
    },
    Row {
        system: "point on plane",
        exhibit: "hang-it",
        visit: Visit::new(2.5, STRONG),
        without: &[Cut::Row("constraint.point-on-plane", "in-the-loop")],
        shows: |run| {
            vec![
                at_most(HOLDS, "off the plane, m", greatest(run.moments().map(|now| now.off_plane("in-the-loop")))),
                at_least(0.01, "arm turns, rad", greatest(run.moments().map(|now| now.angle("Arm")))),
            ]
        },
    },
    Row {
        system: "ball joint minus an element",
        exhibit: "loose-nail",
        visit: Visit::new(8.0, LOOSE),
        without: &[Cut::Row("constraint.element", "loose")],
        shows: |run| {
            let off = |now: Moment| now.body("Pendulum").pose().position - run.at(0.0).body("Pendulum").pose().position;
            let other = |now: Moment| off(now).y.hypot(off(now).z);
            vec![
                at_most(HOLDS, "off up and forth, m", greatest(run.moments().map(other))),
                at_most(HOLDS, "along while nailed, m", greatest(run.during(0.0, 5.9).map(|now| off(now).x.abs()))),
                at_least(0.01, "along while loose, m", greatest(run.during(6.0, 8.0).map(|now| off(now).x.abs()))),
            ]
        },
    },
    Row {
        system: "spring and damper, linear",
        exhibit: "marionette",
        visit: Visit::new(2.0, ""),
        without: &[Cut::Row("constraint.spring", "left-hand")],
        // A zero-length spring of 15 N/m that bears less than 0.6 N.
        shows: |run| vec![at_most(0.04, "stretched, m", greatest(run.moments().map(|now| now.stretch("left-hand"))))],
    },
    Row {
        system: "spring and damper, angular",
        exhibit: "strikers",
        visit: Visit::new(4.0, TAP),
        without: &[Cut::Row("constraint.torsion-spring", "wood-return")],
        // T = 2π √(I/(m g l + k)) with k = 4 mN m/rad; damping hardly changes it.
        shows: |run| {
            const SPRING: f64 = 4e-3;
            let mallet = run.at(0.0).body("MalletWood").properties;
            let inertia = mallet.inertia_about(DVec3::ZERO).x_axis.x;
            let period = 2.0 * PI * (inertia / (mallet.mass * 9.81 * mallet.center.length() + SPRING)).sqrt();
            let swing = run.turning("MalletWood", DVec3::X);
            let downward: Vec<usize> = (240..swing.len()).filter(|&i| swing[i - 1] > 0.0 && swing[i] <= 0.0).collect();
            let found = (downward.last().copied().unwrap_or(0) as f64 - downward.first().copied().unwrap_or(0) as f64)
                * STEP
                / (downward.len() as f64 - 1.0);
            vec![at_most(0.02, "off its period", (found / period - 1.0).abs())]
        },
    },
    Row {
        system: "hinge",
        exhibit: "pendulum",
        visit: Visit::new(2.5, BESIDE),
        without: &[Cut::Nail("constraint.hinge", "suspension")],
        shows: |run| {
            let swing = run.turning("Pendulum", DVec3::Z);
            vec![
                at_most(HOLDS, "gap, m", greatest(run.moments().map(|now| now.gap("suspension")))),
                at_most(HOLDS, "axis leans, rad", greatest(run.moments().map(|now| now.lean("suspension")))),
                at_least(VISIBLE, "swings, rad", greatest(swing.iter().copied()) - least(swing.iter().copied())),
            ]
        },
    },
    Row {
        system: "windmill joint",
        exhibit: "windmill",
        visit: Visit::new(3.0, ROTOR),
        without: &[Cut::Nail("constraint.windmill", "shaft")],
        shows: |run| {
            vec![
                at_most(HOLDS, "gap, m", greatest(run.moments().map(|now| now.gap("shaft")))),
                at_most(HOLDS, "shaft leans, rad", greatest(run.moments().map(|now| now.lean("shaft")))),
                at_least(2.0 * PI, "turns, rad", run.turned("Rotor", DVec3::Z).abs()),
            ]
        },
    },
    Row {
        system: "universal joint",
        exhibit: "universal-joint",
        visit: Visit::new(3.0, ROTOR),
        without: &[Cut::Nail("constraint.universal", "cross")],
        shows: |run| {
            vec![
                at_most(
                    HOLDS,
                    "cross leaves its right angle, rad",
                    greatest(run.moments().map(|now| now.lean("cross"))),
                ),
                at_most(HOLDS, "gap, m", greatest(run.moments().map(|now| now.gap("cross")))),
                at_least(PI, "dial turns, rad", run.turned("Dial", OUT).abs()),
            ]
        },
    },
    Row {
        system: "slider",
        exhibit: "gear-train",
        visit: Visit::new(2.0, PULL_WEIGHT),
        without: &[Cut::Row("constraint.slider", "guide")],
        shows: |run| {
            let start = run.at(0.0).body("Weight").position;
            let aside = |now: Moment| (now.body("Weight").position - start).with_y(0.0).length();
            vec![
                at_most(HOLDS, "aside, m", greatest(run.moments().map(aside))),
                at_most(HOLDS, "rotates, rad", greatest(run.moments().map(|now| now.lean("guide")))),
                at_least(5e-3, "slides, m", greatest(run.moments().map(|now| now.way("Weight")))),
            ]
        },
    },
    Row {
        system: "line",
        exhibit: "terry-clock",
        visit: Visit::new(1.5, ""),
        without: &[Cut::Row("constraint.line", "crutch")],
        shows: |run| {
            vec![
                at_most(HOLDS, "eye off the rod, m", greatest(run.moments().map(|now| now.off_plane("crutch")))),
                at_least(VISIBLE, "anchor swings, rad", greatest(run.moments().map(|now| now.angle("Anchor")))),
            ]
        },
    },
    Row {
        system: "weld",
        exhibit: "strikers",
        visit: Visit::new(1.5, PULL_BELL),
        without: &[Cut::Row("constraint.weld", "bell-stand")],
        shows: |run| {
            vec![
                at_most(HOLDS, "moves, m", greatest(run.moments().map(|now| now.way("Bell")))),
                at_most(HOLDS, "rotates, rad", greatest(run.moments().map(|now| now.lean("bell-stand")))),
            ]
        },
    },
    Row {
        system: "friction of a pivot",
        exhibit: "windmill",
        visit: Visit::new(12.0, ROTOR),
        without: &[Cut::Key("constraint.windmill", "shaft", "friction")],
        // Of dry friction a wheel loses ω̇ = μ m g r/I, whatever its speed.
        shows: |run| {
            let spin = |t: f64| run.at(t).body("Rotor").angular_velocity.length();
            let rotor = run.at(0.0).body("Rotor").properties;
            let dry = 0.1 * 0.3e-3 * 9.81 * rotor.mass / rotor.inertia.z_axis.z;
            let loss = 0.5 * (spin(10.0) - spin(12.0)) / dry;
            // The air takes some more.
            vec![at_least(1.0, "loses, as a share of that", loss), at_most(2.0, "loses, as a share of that", loss)]
        },
    },
];

const LOOSE: &str = r#"{"t": 0, "aim": [0.44, 0.72]}
{"t": 6.2, "blow": {"strength": 0.8, "hold": 1.2, "release": 0.3}}"#;
const TAP: &str = r#"{"t": 0, "aim": [0.8, 0.7]}
{"t": 0.3, "blow": {"strength": 0.2, "attack": 0.05, "hold": 0.1, "release": 0.05}}"#;
/// Axis of the dial's shaft.
const OUT: DVec3 = DVec3::new(-0.572_867_460_1, 0.0, -0.819_648_018);

#[test]
fn joints_hold_what_they_say() {
    prove(ROWS);
}
