//! The small exhibits: what their labels and sidecars say of them follows from what the loader weighs and measures.

use soffio_exhibit::{self as exhibit, Exhibit, SoundTrigger};
use soffio_math::{DVec3, PI};
use soffio_multibody::articulation::{ConstraintKind, Measure};
use soffio_multibody::collision::ColliderPair;

fn shipped(id: &str) -> Exhibit {
    let folder = exhibit::resolve(id).unwrap_or_else(|report| panic!("{report}"));
    exhibit::load(&folder).unwrap_or_else(|report| panic!("{id}: {}", report.to_text()))
}

fn body(exhibit: &Exhibit, name: &str) -> usize {
    exhibit.bodies.iter().position(|body| body.name == name).unwrap_or_else(|| panic!("no body {name}"))
}

#[test]
fn the_pendulum_beats_6720_times_an_hour() {
    /// Corners are stored as 32-bit floats: micrometres on 285 mm.
    const FILE: f64 = 1e-5;
    let exhibit = shipped("pendulum");
    let properties = exhibit.bodies[0].properties;
    let about_pivot = properties.inertia_about(DVec3::ZERO).z_axis.z;
    let period = 2.0 * PI * (about_pivot / (properties.mass * 9.81 * -properties.center.y)).sqrt();
    assert!((period - 2.0 * 3600.0 / 6720.0).abs() < 10.0 * FILE, "{period} s");
    assert!((properties.mass - 0.1).abs() < 0.03, "a bob of some 100 g: {} kg", properties.mass);
    // Quality ω/c, c the rate at which the energy fades.
    let quality = 2.0 * PI / period / exhibit.bodies[0].linear_damping;
    assert!((quality - 150.0).abs() < 1.0, "Q = {quality}");
    let tilt = 2.0 * soffio_math::asin(exhibit.bodies[0].pose.rotation.z);
    assert!((tilt - 4.0 * PI / 180.0).abs() < FILE, "drawn aside by {tilt} rad");
}

#[test]
fn the_wheel_is_held_about_one_axis_at_a_time() {
    let exhibit = shipped("axis-wheel");
    for (t, held) in [(1.0, "facing"), (3.0, "upright"), (6.0, "facing"), (9.9, "upright")] {
        let active: Vec<&str> = exhibit
            .constraints
            .iter()
            .filter(|c| matches!(c.kind, ConstraintKind::Orientation { .. }) && c.schedule.activation(t, None) > 0.0)
            .map(|c| c.name.as_str())
            .collect();
        assert!(active.len() == 2 && active.iter().all(|name| name.starts_with(held)), "{active:?} at {t} s");
    }
}

#[test]
fn the_gears_stand_where_their_teeth_mesh_and_the_last_makes_five_turns() {
    const MODULE: f64 = 2e-3;
    let exhibit = shipped("gear-train");
    let mut ratio = 1.0;
    for constraint in exhibit.constraints.iter().filter(|c| c.name.starts_with("mesh")) {
        let ConstraintKind::Coupling { terms } = &constraint.kind else { panic!("not a gear") };
        let [Measure::Angle { axis: a, .. }, Measure::Angle { axis: b, .. }] = [terms[0].measure, terms[1].measure]
        else {
            panic!("not two turns")
        };
        let place = |body: Option<usize>| exhibit.bodies[body.expect("a wheel")].pose.position;
        let apart = place(a.body).distance(place(b.body));
        let teeth = terms[0].coefficient + terms[1].coefficient;
        assert!((apart - 0.5 * MODULE * teeth).abs() < 1e-6, "{}: {apart} m apart", constraint.name);
        ratio *= -terms[0].coefficient / terms[1].coefficient;
    }
    assert!((ratio + 5.0).abs() < 1e-12, "{ratio} turns");
    // The cord leaves the drum on the side that goes down: its line is under the drum's left rim.
    let (wheel, weight) = (body(&exhibit, "Wheel1"), body(&exhibit, "Weight"));
    let side = exhibit.bodies[weight].pose.position.x - exhibit.bodies[wheel].pose.position.x;
    assert!((side + 6e-3).abs() < 1e-6, "{side} m");
}

#[test]
fn the_weak_joint_bears_the_weight_below_it_and_little_more() {
    let exhibit = shipped("breaking-chain");
    let below = ["Link4", "Link5", "Link6", "Disc"];
    let mass: f64 = below.iter().map(|name| exhibit.bodies[body(&exhibit, name)].properties.mass).sum();
    let weak = exhibit.constraints.iter().find(|c| c.name == "weak").and_then(|c| c.breaking).expect("a weak joint");
    let share = weak.force / (9.81 * mass);
    assert!((1.03..1.1).contains(&share), "it bears {share} of the weight of {mass} kg");
    assert_eq!(weak.restore, 6.0);
    // At rest nothing else can break.
    assert!(exhibit.constraints.iter().filter(|c| c.breaking.is_some()).count() == 1);
}

#[test]
fn the_windmill_turns_about_its_shaft_and_the_shaft_about_the_mast() {
    let exhibit = shipped("windmill");
    let (head, rotor) = (body(&exhibit, "Head"), body(&exhibit, "Rotor"));
    let of = |body: usize| exhibit.constraints.iter().filter(|c| c.kind.acts_on(body)).count();
    assert_eq!((of(head), of(rotor)), (6, 3), "point and two orientations each");
    assert_eq!(exhibit.wind_surfaces.iter().filter(|s| s.body == rotor).count(), 4);
    // Balanced on its mast to within the radius of the bearing, or it would tip.
    let bodies = [head, rotor].map(|b| &exhibit.bodies[b]);
    let mass: f64 = bodies.iter().map(|b| b.properties.mass).sum();
    let moment: f64 = bodies.iter().map(|b| b.properties.mass * b.pose.point(b.properties.center).z).sum();
    assert!((moment / mass).abs() < 20e-3, "{} m off the mast", moment / mass);
}

#[test]
fn the_plates_hang_apart_and_where_they_meet_when_the_branch_turns() {
    let exhibit = shipped("plates");
    let discs = ["LargeDisc", "MiddleDisc", "SmallDisc"].map(|name| body(&exhibit, name));
    let ring = |body: usize| exhibit.sounds.iter().any(|s| s.body == body && s.on == SoundTrigger::Impact);
    assert!(discs.iter().all(|&body| ring(body)));
    let circle =
        |body: usize, radius: f64| (exhibit.bodies[body].pose.point(exhibit.bodies[body].properties.center), radius);
    let [large, middle, small] = [circle(discs[0], 31e-3), circle(discs[1], 23e-3), circle(discs[2], 18e-3)];
    for (a, b) in [(large, middle), (middle, small), (large, small)] {
        // Apart as discs that may turn about their stems.
        let between = a.0.distance(b.0);
        assert!(between > 15e-3, "{between} m apart");
    }
    // The lower branch turns about its loop: the middle disc's way crosses the large disc's.
    let loop_at = exhibit.bodies[body(&exhibit, "Lower")].pose.position;
    let level = |p: DVec3| DVec3::new(p.x - loop_at.x, 0.0, p.z - loop_at.z).length();
    let overlap = level(middle.0) + middle.1 - (level(large.0) - large.1);
    assert!(overlap > 5e-3, "they miss each other by {} m", -overlap);
}

#[test]
fn the_balls_lie_apart_on_a_bed_that_is_steeper_than_the_cloth_holds() {
    const RADIUS: f64 = 20e-3;
    let exhibit = shipped("billiards");
    assert_eq!(exhibit.bodies.len(), 7);
    // A thin shell: I = 2/3 m r², and the weight of 0.4 mm of celluloid.
    for ball in &exhibit.bodies {
        let (mass, inertia) = (ball.properties.mass, ball.properties.inertia.x_axis.x);
        assert!((inertia / (2.0 / 3.0 * mass * RADIUS * RADIUS) - 1.0).abs() < 1e-3, "{inertia} kg m²");
        let shell = 4.0 * PI * RADIUS * RADIUS * 0.4e-3 * 1400.0;
        assert!((mass / shell - 1.0).abs() < 0.05, "{mass} kg for a shell of {shell} kg");
    }
    let balls: Vec<_> = exhibit.colliders.iter().enumerate().filter(|(_, c)| c.body.is_some()).collect();
    let planes: Vec<_> = exhibit.colliders.iter().enumerate().filter(|(_, c)| c.shape.is_plane()).collect();
    assert_eq!((balls.len(), planes.len()), (7, 8));
    for (i, &(a, ball)) in balls.iter().enumerate() {
        let at = exhibit.bodies[ball.body.expect("a ball")].pose.position;
        let mut nearest = f64::INFINITY;
        for &(b, plane) in &planes {
            let place = plane.shape.place;
            let normal = place.rotation * DVec3::Y;
            let gap = (at - place.position).dot(normal) - RADIUS;
            nearest = nearest.min(gap);
            let resistance = exhibit.surface_pair(ColliderPair { a, b }).resistance;
            if plane.node.starts_with("Bed") {
                // tan α against b/r: it rolls back by itself.
                let slope = (1.0 - normal.y * normal.y).sqrt() / normal.y;
                assert!(slope > 3.0 * resistance.rolling / RADIUS, "{} holds balls: {slope}", plane.node);
                assert!(resistance.spinning > 0.0);
            } else {
                assert!(normal.y.abs() < 1e-6 && gap > 0.02, "{}: {gap} m to {}", ball.node, plane.node);
                assert!(resistance.is_none());
            }
        }
        // Places are kept to a tenth of a micrometre.
        assert!(nearest.abs() < 1e-6, "{} is {nearest} m off the bed", ball.node);
        for &(_, other) in &balls[..i] {
            let there = exhibit.bodies[other.body.expect("a ball")].pose.position;
            assert!(at.distance(there) > 2.2 * RADIUS, "{} and {}", ball.node, other.node);
        }
    }
}
