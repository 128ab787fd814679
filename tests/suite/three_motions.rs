//! Three motions side by side: each puppet moves by its own kind, one hand drags all, and the boards show what is measured.

use std::sync::Arc;

use soffio_exhibit::chart::Measured;
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DVec3, ln, sin};
use soffio_multibody::articulation::{Anchor, ConstraintKind};
use soffio_simulation::{
    Command, CurveView, EventKind, PointerGrab, STEPS_PER_SECOND, Settings, Simulation, StepInput,
};

const ASPECT: f64 = 16.0 / 9.0;
const PUPPETS: [&str; 3] = ["TorsoForces", "TorsoRule", "TorsoPlaces"];
/// Both numbers come from the same places by other sums: some roundings of positions of half a metre, m.
const ROUNDING: f64 = 1e-15;
/// Joint error of dynamics, m: the invariant of `ARCHITECTURE.md` is 1e-9, and a projected joint is closed to rounding.
const PROJECTED: f64 = 1e-13;
/// Joint error at which motion by positions stops closing, m (`POSITION_TOLERANCE` of `soffio_multibody::procedural`).
const CLOSED: f64 = 1e-7;

fn load() -> Arc<Exhibit> {
    let folder = exhibit::resolve("three-motions").unwrap_or_else(|report| panic!("{report}"));
    Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{}", report.to_text())))
}

fn index(exhibit: &Exhibit, name: &str) -> usize {
    exhibit.bodies.iter().position(|body| body.name == name).unwrap_or_else(|| panic!("no body {name}"))
}

/// A visitor who drags a puppet by its torso to and fro for `drags` seconds, and lets go.
struct Visit {
    simulation: Simulation,
    dragged: usize,
    start: [f64; 2],
    time: f64,
}

impl Visit {
    fn new(dragged: &str) -> Self {
        let exhibit = load();
        let dragged = index(&exhibit, dragged);
        let simulation = Simulation::new(exhibit, Settings::default());
        let start = simulation.view(ASPECT).project(simulation.bodies()[dragged].position, ASPECT).expect("in view");
        Self { simulation, dragged, start, time: 0.0 }
    }

    fn step(&mut self, drags: f64, blow: Option<f64>) {
        let way = 1.5 * self.time;
        let at = [self.start[0] + 0.05 * sin(way), self.start[1] - 0.05 * sin(0.5 * way) * sin(0.5 * way)];
        let hand = [PointerGrab { id: 1, at, body: Some(self.dragged) }];
        let commands = [Command::Blow(blow)];
        self.simulation.step(&StepInput {
            pointer_grabs: if self.time < drags { &hand } else { &[] },
            commands: &commands,
            pointer: Some([0.5, 0.42]),
            ..StepInput::default()
        });
        self.time += 1.0 / STEPS_PER_SECOND as f64;
        assert!(self.simulation.events().iter().all(|event| event.kind != EventKind::Fault), "at {} s", self.time);
    }

    fn moved(&self, name: &str) -> DVec3 {
        let exhibit = self.simulation.exhibit();
        let body = &exhibit.bodies[index(exhibit, name)];
        let now = self.simulation.bodies()[index(exhibit, name)];
        now.position - body.pose.point(body.properties.center)
    }

    fn curves(&self) -> Vec<CurveView> {
        self.simulation.snapshot().curves
    }
}

fn steps(seconds: f64) -> usize {
    (seconds * STEPS_PER_SECOND as f64).round() as usize
}

/// The greatest distance of the two points of a joint among these, from the bodies' poses alone.
fn gap(exhibit: &Exhibit, bodies: &[RigidBody], constraints: &[usize]) -> f64 {
    let place = |anchor: &Anchor| anchor.body.map_or(anchor.point, |body| bodies[body].pose().point(anchor.point));
    let gaps = constraints.iter().map(|&index| match &exhibit.constraints[index].kind {
        ConstraintKind::PointToPoint { a, b } => place(a).distance(place(b)),
        other => panic!("{other:?} is no ball joint"),
    });
    gaps.fold(0.0, f64::max)
}

#[test]
fn each_curve_shows_what_is_measured_and_the_kinds_differ_as_they_should() {
    let mut visit = Visit::new("TorsoRule");
    let exhibit = visit.simulation.exhibit().clone();
    let mut worst = [0.0_f64; 5];
    for step in 0..steps(12.0) {
        visit.step(8.0, (step > steps(9.0) && step < steps(10.0)).then_some(8.0));
        let curves = visit.curves();
        let boards = exhibit.charts.iter().flat_map(|chart| chart.curves.iter());
        for (k, (shown, curve)) in curves.iter().zip(boards).enumerate() {
            let measured = match &curve.measured {
                Measured::JointError { constraints, .. } => {
                    assert_eq!(constraints.len(), 8, "all joints of a puppet");
                    gap(&exhibit, visit.simulation.bodies(), constraints)
                }
                Measured::Departure { body, like } => {
                    let moved = |body: usize| visit.moved(&exhibit.bodies[body].name);
                    moved(*body).distance(moved(*like))
                }
            };
            assert!((shown.value - measured).abs() < ROUNDING, "curve {k}: {} for {measured}", shown.value);
            worst[k] = worst[k].max(shown.value);
        }
    }
    let [forces, rule, places, rule_departs, places_departs] = worst;
    assert!(forces > 0.0 && forces < PROJECTED, "dynamics: {forces} m");
    for (kind, error) in [("rule", rule), ("places", places)] {
        assert!(error > 100.0 * forces && error < CLOSED, "{kind}: {error} m");
    }
    assert!(rule_departs > 1e-3 && places_departs > 1e-3, "they move alike: {rule_departs}, {places_departs} m");
    let [a, b, c] = PUPPETS.map(|name| visit.moved(name));
    assert!(a != b && b != c && a != c, "three kinds of motion end in three places");
}

#[test]
fn whichever_puppet_is_dragged_one_hand_leads_all_three_alike() {
    /// Of a hand that moves by 0.1 m/s the force of dynamics lags by its time constant of 50 ms, m.
    const LAG: f64 = 5e-3;
    for dragged in PUPPETS {
        let mut visit = Visit::new(dragged);
        let mut farthest = 0.0_f64;
        for _ in 0..steps(4.0) {
            visit.step(f64::INFINITY, None);
            let [a, b, c] = PUPPETS.map(|name| visit.moved(name));
            assert!(a.distance(b) < LAG && a.distance(c) < LAG, "{dragged}: {a} {b} {c} at {} s", visit.time);
            farthest = farthest.max(a.length());
        }
        assert!(farthest > 0.02, "{dragged} was hardly dragged: {farthest} m");
    }
}

#[test]
fn the_same_hand_gives_the_same_motion_and_the_same_curves_to_the_bit() {
    let run = || {
        let mut visit = Visit::new("TorsoForces");
        (0..steps(6.0)).for_each(|_| visit.step(3.0, None));
        (visit.simulation.state_hash(), visit.curves())
    };
    assert_eq!(run(), run());
}

#[test]
fn a_curve_runs_over_its_board_in_its_time_on_a_logarithmic_scale() {
    let mut visit = Visit::new("TorsoForces");
    let chart = visit.simulation.exhibit().charts[0].clone();
    for (value, height) in [(1e-30, 0.0), (1e-18, 0.0), (1e-9, 0.5), (1.0, 1.0), (7.0, 1.0)] {
        assert!((chart.height(value) - height).abs() < 1e-12, "{value} m at {}", chart.height(value));
    }
    (0..steps(4.0)).for_each(|_| visit.step(8.0, None));
    let leftmost = |curve: &CurveView| curve.points.iter().map(|point| point[0]).fold(1.0, f32::min);
    let half = leftmost(&visit.curves()[0]);
    assert!((half - 0.5).abs() < 0.01, "after half of its time it begins at {half}");
    (0..steps(6.0)).for_each(|_| visit.step(8.0, None));
    let curves = visit.curves();
    assert!(curves.iter().all(|curve| leftmost(curve) < 0.01), "it fills its board");
    for curve in &curves {
        assert!(curve.points.windows(2).all(|pair| pair[0][0] >= pair[1][0]), "time runs to the right");
        let board = &visit.simulation.exhibit().charts[curve.chart];
        let [low, high] = board.range;
        let shown = (curve.value.clamp(low, high) / low, high / low);
        // The latest point is the greatest value of the last thirtieth of a second.
        assert!(f64::from(curve.points[0][1]) >= ln(shown.0) / ln(shown.1) - 1e-6, "{curve:?}");
    }
}

#[test]
fn a_reset_empties_the_boards_and_puts_each_kind_back() {
    let mut visit = Visit::new("TorsoPlaces");
    (0..steps(2.0)).for_each(|_| visit.step(8.0, None));
    let commands = [Command::Reset];
    visit.simulation.step(&StepInput { commands: &commands, ..StepInput::default() });
    assert!(visit.curves().iter().all(|curve| curve.points.len() == 1));
    for name in PUPPETS {
        // A step of free fall is 0.17 mm; the joints let none of it through.
        assert!(visit.moved(name).length() < 1e-5, "{name}: {}", visit.moved(name));
    }
}

#[test]
fn bodies_set_from_outside_are_where_their_kind_begins() {
    let mut visit = Visit::new("TorsoForces");
    let exhibit = visit.simulation.exhibit().clone();
    (0..steps(0.5)).for_each(|_| visit.step(0.0, None));
    let push = DVec3::new(0.2, 0.0, 0.0);
    for name in PUPPETS {
        visit.simulation.bodies_mut()[index(&exhibit, name)].velocity = push;
    }
    (0..steps(0.1)).for_each(|_| visit.step(0.0, None));
    for name in PUPPETS {
        assert!(visit.moved(name).x > 2e-3, "{name} did not take the push: {}", visit.moved(name));
    }
}
