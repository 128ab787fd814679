//! The cabinet of motion as visitors find it: what each small exhibit shows, against formulas; the mobile that is balanced
//! by hand; the clock that breath winds.

use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_geometry::bodies::RigidBody;
use soffio_math::noise::Random;
use soffio_math::spatial::{Vec6, angular, linear};
use soffio_math::{DVec3, PI, acos, atan2, cos, exp, sin};
use soffio_simulation::{
    Command, Event, EventKind, PointerGrab, STEPS_PER_SECOND, Settings, Simulation, StepInput, start_dynamics,
};
use soffio_sound::SoundCommand;
use soffio_wind::SurfaceShape;
use soffio_wind::breath::{Breath, SpreadLaw};
use soffio_wind::force::{BreathJet, TURBULENCE, WindField};

const ASPECT: f64 = 16.0 / 9.0;
const G: f64 = 9.81;
/// A child's breath at the lips: 0.3 L/s through 10 mm, m/s.
const CHILD: f64 = 3.82;
const NEW: [&str; 10] = [
    "strikers",
    "scratch-board",
    "blown-together",
    "loose-nail",
    "universal-joint",
    "moving-path",
    "hang-it",
    "breath-clock",
    "cart",
    "pennant",
];

fn load(id: &str) -> Arc<Exhibit> {
    let folder = exhibit::resolve(id).unwrap_or_else(|report| panic!("{report}"));
    Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{id}: {}", report.to_text())))
}

fn steps(seconds: f64) -> usize {
    (seconds * STEPS_PER_SECOND as f64).round() as usize
}

/// Somebody before an exhibit.
struct Visit {
    simulation: Simulation,
    hands: Vec<PointerGrab>,
    pointer: Option<[f64; 2]>,
    blow: Option<f64>,
    events: Vec<Event>,
    slides: usize,
}

impl Visit {
    fn new(id: &str, settings: Settings) -> Self {
        let simulation = Simulation::new(load(id), settings);
        Self { simulation, hands: Vec::new(), pointer: None, blow: None, events: Vec::new(), slides: 0 }
    }

    fn step(&mut self) {
        let commands = [Command::Blow(self.blow)];
        let hands = std::mem::take(&mut self.hands);
        self.simulation.step(&StepInput {
            commands: &commands,
            pointer: self.pointer,
            pointer_grabs: &hands,
            ..StepInput::default()
        });
        self.hands = hands;
        self.events.extend_from_slice(self.simulation.events());
        let slid = |sound: &&SoundCommand| matches!(sound, SoundCommand::Slide(_));
        self.slides += self.simulation.sounds().iter().filter(slid).count();
        let fault = self.simulation.events().iter().find(|e| e.kind == EventKind::Fault);
        assert!(fault.is_none(), "{fault:?}");
    }

    fn run(&mut self, seconds: f64) {
        for _ in 0..steps(seconds) {
            self.step();
        }
    }

    fn index(&self, name: &str) -> usize {
        let bodies = &self.simulation.exhibit().bodies;
        bodies.iter().position(|body| body.name == name).unwrap_or_else(|| panic!("no body {name}"))
    }

    fn body(&self, name: &str) -> RigidBody {
        self.simulation.bodies()[self.index(name)]
    }

    /// Where a point of the world is seen.
    fn seen(&self, point: DVec3) -> [f64; 2] {
        self.simulation.view(ASPECT).project(point, ASPECT).expect("before the eye")
    }

    /// Points at the middle of a surface in the wind.
    fn aim(&mut self, node: &str) {
        let exhibit = self.simulation.exhibit().clone();
        let surface = exhibit.wind_surfaces.iter().find(|s| s.node == node).unwrap_or_else(|| panic!("no {node}"));
        let SurfaceShape::Mesh { mesh, .. } = &surface.shape else { panic!("a mesh") };
        let middle = self.simulation.bodies()[surface.body].pose().point(mesh.ball().0);
        self.pointer = Some(self.seen(middle));
    }

    /// Hits between two bodies so far.
    fn hits(&self, one: &str, other: &str) -> usize {
        let pair = [Some(self.index(one)), Some(self.index(other))];
        let met = |e: &&Event| e.kind == EventKind::Impact && (e.bodies == pair || e.bodies == [pair[1], pair[0]]);
        self.events.iter().filter(met).count()
    }
}

#[test]
fn a_childs_breath_moves_what_it_is_aimed_at_by_fifteen_millimetres_within_a_second() {
    /// Of a 55-inch picture, mm.
    const PICTURE: [f64; 2] = [1210.0, 680.0];
    const SEEN: f64 = 15.0;
    for (id, node) in [
        ("strikers", "SailBell"),
        ("strikers", "SailDrum"),
        ("strikers", "SailMetal"),
        ("strikers", "SailWood"),
        ("scratch-board", "Feather"),
        ("loose-nail", "Plate"),
        ("universal-joint", "Vane3"),
        ("moving-path", "Wings"),
        ("hang-it", "PlateLeft"),
        ("hang-it", "PlateRight"),
        ("breath-clock", "Sail1"),
        ("blown-together", "Bead5Ball"),
        ("cart", "Sail"),
        ("pennant", "Silk.6.2"),
    ] {
        let [mut blown, mut left] = [(); 2].map(|()| Visit::new(id, Settings::default()));
        [&mut blown, &mut left].into_iter().for_each(|visit| visit.run(1.0));
        blown.aim(node);
        left.pointer = blown.pointer;
        blown.blow = Some(CHILD);
        let mut most: f64 = 0.0;
        // The vertices of the surface in the breath: a rotor rotates in place.
        let exhibit = blown.simulation.exhibit().clone();
        let surface = exhibit.wind_surfaces.iter().find(|s| s.node == node).expect("a surface");
        let SurfaceShape::Mesh { mesh, .. } = &surface.shape else { panic!("a mesh") };
        let (middle, radius) = mesh.ball();
        for _ in 0..steps(1.0) {
            blown.step();
            left.step();
            for corner in DVec3::AXES.into_iter().flat_map(|e| [middle + radius * e, middle - radius * e]) {
                let at = |visit: &Visit| visit.seen(visit.simulation.bodies()[surface.body].pose().point(corner));
                let (a, b) = (at(&blown), at(&left));
                let (x, y) = (PICTURE[0] * (a[0] - b[0]), PICTURE[1] * (a[1] - b[1]));
                most = most.max((x * x + y * y).sqrt());
            }
        }
        println!("{id}: a child's breath on {node} is seen by {most:.0} mm");
        assert!(most >= SEEN, "{id}, {node}: {most} mm");
    }
}

/// Hard breaths at random places for so long: nothing fails, and joints that hold stay closed.
fn blown_hard(id: &str, seconds: f64, seed: u64) {
    const JOINT_ERROR: f64 = 1e-6;
    // Visitors can open and close joints of these exhibits.
    let opens = ["blown-together", "loose-nail"].contains(&id);
    let mut visit = Visit::new(id, Settings { seed, ..Settings::default() });
    let mut random = Random::new(seed);
    let (mut worst, mut until) = (0.0_f64, 0);
    for step in 0..steps(seconds) {
        if step >= until {
            visit.blow = if visit.blow.is_some() { None } else { Some(random.range(8.0, 17.0)) };
            visit.pointer = Some([random.range(0.05, 0.95), random.range(0.1, 0.9)]);
            until = step + steps(if visit.blow.is_some() { random.range(0.5, 3.0) } else { random.range(0.2, 1.5) });
        }
        visit.step();
        worst = worst.max(visit.simulation.joint_error());
        assert!(visit.simulation.bodies().iter().all(RigidBody::is_finite), "{id}, seed {seed}: step {step}");
    }
    println!("{id}: joints within {worst:.1e} m");
    assert!(opens || worst < JOINT_ERROR, "{id}, seed {seed}: joints {worst} m apart");
}

#[test]
fn ten_seconds_of_hard_breath_break_nothing_in_the_cabinet() {
    NEW.into_iter().for_each(|id| blown_hard(id, 10.0, 5));
}

#[test]
#[ignore = "ten minutes of each: part `cabinet` of tests/check.sh --long"]
fn ten_minutes_of_hard_breath_break_nothing_in_the_cabinet() {
    NEW.into_iter().for_each(|id| blown_hard(id, 600.0, 6));
}

#[test]
fn each_mallet_strikes_its_own_sounding_body_in_a_breath() {
    for thing in ["Bell", "Drum", "Metal", "Wood"] {
        let mut visit = Visit::new("strikers", Settings::default());
        visit.aim(&format!("Sail{thing}"));
        visit.blow = Some(8.0);
        visit.run(1.0);
        visit.blow = None;
        visit.run(2.0);
        let hits = visit.hits(&format!("Mallet{thing}"), thing);
        assert!(hits > 0, "the mallet does not meet the {thing}");
        let others = ["Bell", "Drum", "Metal", "Wood"].into_iter().filter(|other| *other != thing);
        let beside: usize = others.map(|other| visit.hits(&format!("Mallet{thing}"), other)).sum();
        assert_eq!(beside, 0, "the mallet of the {thing} meets another");
    }
}

#[test]
fn a_dragged_quill_scratches_and_a_resting_one_is_silent() {
    let mut visit = Visit::new("scratch-board", Settings { wind: false, ..Settings::default() });
    visit.run(1.0);
    assert_eq!(visit.slides, 0, "it scratches at rest");
    let quill = visit.index("Quill");
    let start = visit.body("Quill").position;
    let from = visit.seen(start);
    for step in 0..steps(1.0) {
        let way = 0.12 * step as f64 / steps(1.0) as f64;
        visit.hands = vec![PointerGrab { id: 1, at: [from[0] + way, from[1]], body: Some(quill) }];
        visit.step();
    }
    let way = visit.body("Quill").position.distance(start);
    assert!(way > 0.05, "dragged by {way} m");
    assert!(visit.slides > 10, "{} commands to scratch", visit.slides);
    visit.hands.clear();
    visit.run(1.0);
    let quiet = visit.slides;
    visit.run(1.0);
    assert_eq!(visit.slides, quiet, "it goes on scratching");
}

#[test]
fn a_breath_gathers_the_beads_into_a_chain_and_lets_them_fall() {
    /// Between a hook and its eye, m: the model's points are 32-bit floats.
    const CLOSED: f64 = 1e-7;
    let mut visit = Visit::new("blown-together", Settings::default());
    visit.run(2.0);
    let floor = visit.body("Bead1").position.y;
    visit.pointer = Some([0.5, 0.8]);
    visit.blow = Some(4.0);
    visit.run(0.8);
    visit.blow = None;
    visit.run(6.2);
    for (name, high) in [("Bead1", 0.378), ("Bead2", 0.334), ("Bead3", 0.290), ("Bead4", 0.246), ("Bead5", 0.202)] {
        let y = visit.body(name).position.y;
        assert!((y - high).abs() < 3e-3, "{name} hangs at {y} m");
    }
    assert!(visit.simulation.joint_error() < CLOSED, "{} m", visit.simulation.joint_error());
    let fired = visit.events.iter().filter(|e| e.kind == EventKind::Trigger).count();
    assert_eq!(fired, 5, "one breath starts each joint once");
    visit.run(6.0);
    for name in ["Bead1", "Bead2", "Bead3", "Bead4", "Bead5"] {
        let place = visit.body(name).position;
        assert!(place.y < floor + 0.04 && place.x.hypot(place.z) < 0.13, "{name} lies at {place}");
    }
}

#[test]
fn the_nail_holds_the_bead_comes_loose_along_the_rail_and_draws_it_home() {
    /// Of the drawn way: 1/ω = 0.18 s, three seconds.
    const HOME: f64 = 1e-5;
    let mut visit = Visit::new("loose-nail", Settings::default());
    let bead = |visit: &Visit| visit.body("Pendulum").pose().position;
    let start = bead(&visit);
    visit.aim("Plate");
    visit.run(4.0);
    visit.blow = Some(8.0);
    visit.run(1.0);
    visit.blow = None;
    visit.run(0.9);
    assert!(bead(&visit).distance(start) < 1e-9, "the nail gives way by {}", bead(&visit).distance(start));
    visit.run(0.2);
    let mut way: f64 = 0.0;
    while visit.simulation.steps() < steps(11.9) as u64 {
        visit.step();
        let at = bead(&visit) - start;
        way = way.max(at.x.abs());
        assert!(at.y.abs() + at.z.abs() < 1e-9, "it leaves the rail by {at}");
        assert!(at.x.abs() < 0.1651, "it leaves the rail's end, {at}");
    }
    println!("the bead slides {:.0} mm", 1e3 * way);
    assert!(way > 0.02, "it slides {way} m");
    visit.run(3.1);
    assert!(bead(&visit).distance(start) < HOME, "{} m from its mark", bead(&visit).distance(start));
}

#[test]
fn crossed_axes_turn_as_their_formula_says() {
    /// 32-bit points of the model.
    const FORMULA: f64 = 1e-6;
    const BEND: f64 = 0.61;
    let mut visit = Visit::new("universal-joint", Settings::default());
    visit.aim("Vane3");
    visit.blow = Some(8.0);
    let (mut fastest, mut slowest) = (0.0_f64, f64::INFINITY);
    for _ in 0..steps(3.0) {
        visit.step();
        let (rotor, dial) = (visit.body("Rotor"), visit.body("Dial"));
        let shaft = DVec3::new(-sin(BEND), 0.0, cos(BEND));
        assert!((dial.rotation * DVec3::Z).distance(shaft) < FORMULA, "the dial's shaft leaves its bearing");
        // The driving pin stands across the plane of both shafts at first: tan φ_out = tan φ_in cos β.
        let pin = rotor.rotation * DVec3::Y;
        let angle = atan2(-pin.x, pin.y);
        let out = dial.rotation * DVec3::X;
        let across = shaft.cross(DVec3::Y) * -1.0;
        let turned = atan2(out.y, out.dot(across));
        let expected = atan2(sin(angle) * cos(BEND), cos(angle));
        let off = turned.abs() - expected.abs();
        assert!(off.abs() < 1e-5 || (off.abs() - PI).abs() < 1e-5, "{turned} rad for {angle}, not {expected}");
        let (one, other) = (rotor.angular_velocity.z, dial.angular_velocity.dot(shaft));
        if one.abs() > 1.0 {
            (fastest, slowest) = (fastest.max(other / one), slowest.min(other / one));
        }
    }
    println!("the dial turns {slowest:.3} to {fastest:.3} times as fast");
    assert!((slowest / cos(BEND) - 1.0).abs() < 0.02 && (fastest * cos(BEND) - 1.0).abs() < 0.02);
}

#[test]
fn a_body_on_the_moving_nail_never_leaves_it() {
    const CLOSED: f64 = 1e-9;
    let mut visit = Visit::new("moving-path", Settings::default());
    visit.aim("Wings");
    visit.blow = Some(12.0);
    let mut wide: f64 = 0.0;
    for _ in 0..steps(16.0) {
        visit.step();
        let swallow = visit.body("Swallow");
        let nail = visit.simulation.bodies()[visit.index("way/path")].position;
        assert!(swallow.pose().position.distance(nail) < CLOSED);
        wide = wide.max(nail.x);
        // An eight: z = 0.06 sin 2φ where x = 0.15 sin φ.
        let s = (nail.x / 0.15).clamp(-1.0, 1.0);
        let z = 0.12 * s.abs() * (1.0 - s * s).sqrt();
        assert!((nail.z.abs() - z).abs() < 2e-3, "the nail is at {nail}");
    }
    assert!((wide - 0.15).abs() < 1e-3, "the eight is {wide} m wide");
}

/// How the arm of *Hang it* leans, degrees.
fn lean(visit: &Visit) -> f64 {
    90.0 - acos((visit.body("Arm").rotation * DVec3::X).y.clamp(-1.0, 1.0)).to_degrees()
}

/// Slides the arm through its loop by `way` of the picture's width, to the left, and lets go.
fn slid(way: f64) -> Visit {
    let mut visit = Visit::new("hang-it", Settings::default());
    let arm = visit.body("Arm");
    let eye = visit.simulation.exhibit().bodies[visit.index("Loop")].pose.position - 16e-3 * DVec3::Y;
    let held = eye + arm.rotation * DVec3::new(-0.04, 0.003, 0.0);
    let from = visit.seen(held);
    for step in 0..steps(3.0) {
        let s = (step as f64 / steps(2.0) as f64).min(1.0);
        visit.hands = vec![PointerGrab { id: 1, at: [from[0] - way * s, from[1] + 0.018 * s], body: None }];
        visit.step();
        assert_eq!(visit.simulation.snapshot().diagnostics.grabs, 1, "the hand has the arm");
    }
    visit.hands.clear();
    visit.run(9.0);
    visit
}

#[test]
fn the_arm_stays_where_it_is_put_and_hangs_level_where_it_balances() {
    let mut still = Visit::new("hang-it", Settings { wind: false, ..Settings::default() });
    let start = lean(&still);
    still.run(30.0);
    assert!((lean(&still) - start).abs() < 0.01, "friction does not hold it: {}° to {}°", start, lean(&still));
    let leans: Vec<f64> = [0.008, 0.0165, 0.024].into_iter().map(|way| lean(&slid(way))).collect();
    println!("it leans {start:.2}°, and slid by three ways {leans:.2?}°");
    assert!(start < -8.0 && leans[0] > start + 2.0 && leans[1] > leans[0] && leans[2] > leans[1], "{start}, {leans:?}");
    assert!(leans[0] < -3.0 && leans[2] > 0.0, "{leans:?}");
}

#[test]
fn level_it_rings_the_cymbal_and_askew_it_does_not() {
    let rings = |visit: &mut Visit| {
        for node in ["PlateRight", "PlateLeft"] {
            visit.aim(node);
            visit.blow = Some(8.5);
            visit.run(2.0);
            visit.blow = None;
            visit.run(10.0);
        }
        visit.hits("Arm", "CymbalBack") + visit.hits("Arm", "CymbalFront")
    };
    // As a visitor would, bisect the position until the arm is level.
    let (mut low, mut high) = (0.010, 0.026);
    let mut level = slid(0.018);
    for _ in 0..6 {
        let way = 0.5 * (low + high);
        level = slid(way);
        if lean(&level).abs() < 0.7 {
            break;
        }
        if lean(&level) < 0.0 { low = way } else { high = way }
    }
    let at = lean(&level);
    let hits = rings(&mut level);
    println!("leaning {at:.2}° it rings {hits} times");
    assert!(at.abs() < 1.0, "no way leaves it level: {at}°");
    assert!(hits > 0, "it hangs level, {at}°, and does not ring");
    let mut askew = Visit::new("hang-it", Settings::default());
    let hits = rings(&mut askew);
    assert_eq!(hits, 0, "askew it rings");
}

/// The clock that breath winds, under a breath whose forces are known: work in, work out.
struct Wound {
    exhibit: Arc<Exhibit>,
    dynamics: soffio_multibody::dynamics::Dynamics,
    air: WindField,
    wrenches: Vec<Vec6>,
    step: usize,
    /// J since the start: of the air on the sails, lost by damping.
    given: f64,
    damped: f64,
    /// Turn of the winding wheel and of the minute arbor, rad.
    turns: [f64; 2],
}

impl Wound {
    fn new() -> Self {
        let exhibit = load("breath-clock");
        let dynamics = start_dynamics(&exhibit, &Settings::default());
        let air = WindField::new(&exhibit.wind_surfaces, &exhibit.shelters, &[], exhibit.bodies.len(), 1);
        let wrenches = vec![[0.0; 6]; exhibit.bodies.len()];
        Self { exhibit, dynamics, air, wrenches, step: 0, given: 0.0, damped: 0.0, turns: [0.0; 2] }
    }

    fn body(&self, name: &str) -> usize {
        self.exhibit.bodies.iter().position(|body| body.name == name).unwrap_or_else(|| panic!("no body {name}"))
    }

    fn losses(&self) -> f64 {
        let of = |k: usize| {
            let (rate, body) = (self.dynamics.damping(k), &self.dynamics.bodies[k]);
            let spin = body.angular_velocity.dot(body.inertia_world() * body.angular_velocity);
            rate.linear * body.properties.mass * body.velocity.length_squared() + rate.angular * spin
        };
        (0..self.wrenches.len()).map(of).sum()
    }

    fn power(&self) -> f64 {
        let of = |(wrench, body): (&Vec6, &RigidBody)| {
            linear(wrench).dot(body.velocity) + angular(wrench).dot(body.angular_velocity)
        };
        self.wrenches.iter().zip(&self.dynamics.bodies).map(of).sum()
    }

    fn run(&mut self, seconds: f64, speed: f64) {
        let dt = 1.0 / STEPS_PER_SECOND as f64;
        let rotor = self.dynamics.bodies[self.body("Rotor")].position;
        let target = rotor + DVec3::new(0.03, 0.03, 0.0);
        let direction = DVec3::new(0.0, 0.0, -1.0);
        let breath =
            Breath { mouth: target - 0.5 * direction, direction, lip_diameter: 0.01, speed, law: SpreadLaw::Jet };
        let wheels = ["WindingWheel", "MinuteArbor"].map(|name| self.body(name));
        let angle = |body: &RigidBody| 2.0 * atan2(body.rotation.z, body.rotation.w);
        let mut hits = Vec::new();
        for _ in 0..steps(seconds) {
            self.wrenches.fill([0.0; 6]);
            if speed > 0.0 {
                let blown = BreathJet { breath, jet_front: None, gain: 10.0, turbulence: TURBULENCE };
                self.air.apply_forces(&self.dynamics.bodies, self.step as f64 * dt, Some(&blown), &mut self.wrenches);
            }
            let before = wheels.map(|wheel| angle(&self.dynamics.bodies[wheel]));
            let (power, loss) = (self.power(), self.losses());
            hits.clear();
            assert_eq!(self.dynamics.step(dt, &self.wrenches, &mut hits), None, "bad numbers");
            // The force is the same throughout a step, so its work is that of the mean speed to second order.
            self.given += 0.5 * dt * (power + self.power());
            self.damped += 0.5 * dt * (loss + self.losses());
            for ((turn, wheel), before) in self.turns.iter_mut().zip(wheels).zip(before) {
                let way = angle(&self.dynamics.bodies[wheel]) - before;
                *turn += way - 2.0 * PI * (way / (2.0 * PI)).round();
            }
            self.step += 1;
        }
    }

    fn height(&self) -> f64 {
        self.dynamics.bodies[self.body("TimeWeight")].position.y
    }
}

#[test]
fn breath_lifts_the_clocks_weight_and_every_microjoule_is_accounted_for() {
    /// Of the breath's work: the trapezoid rule where the pawl catches and teeth drop; 1e-9 is found.
    const LEDGER: f64 = 1e-6;
    let mut clock = Wound::new();
    let weight = clock.body("TimeWeight");
    let mass = clock.exhibit.bodies[weight].properties.mass;
    clock.run(2.0, 0.0);
    let (energy, contact, damped, height) =
        (clock.dynamics.energy(), clock.dynamics.contact_work(), clock.damped, clock.height());
    let turns = clock.turns;
    clock.run(4.0, 8.9);
    clock.run(4.0, 0.0);
    let lost = contact - clock.dynamics.contact_work();
    let stored = clock.dynamics.energy() - energy;
    let damped = clock.damped - damped;
    let missing = (clock.given - stored - damped - lost).abs() / clock.given;
    let lifted = mass * G * (clock.height() - height);
    println!(
        "breath {:.3e} J = stored {stored:.3e} (weight {lifted:.3e}) + damped {damped:.3e} + contact {lost:.3e}; {missing:.1e} missing",
        clock.given
    );
    assert!(missing < LEDGER, "{missing} of the breath's work is missing");
    assert!(lifted > 0.2 * clock.given, "{lifted} J of {} J lift the weight", clock.given);
    // The differential: the weight's way is half of what both wheels turn, on a drum of 20 mm; A turns −1/8 of the minute
    // arbor, 64 to 8.
    let [wound, minute] = [clock.turns[0] - turns[0], clock.turns[1] - turns[1]];
    let drum = 0.5 * (wound - minute * 8.0 / 64.0);
    let way = height - clock.height();
    assert!((way - 20e-3 * drum).abs() < 1e-9, "the weight goes by {way} m, the drum by {} m", 20e-3 * drum);
    // With nobody there the sails run down, and then the pawl holds, but for a tooth of it.
    clock.run(30.0, 0.0);
    let held = clock.turns[0];
    clock.run(10.0, 0.0);
    assert!(
        (clock.turns[0] - held).abs() < 2.0 * PI / 64.0 / 640.0 * 1.01,
        "it runs back by {}",
        clock.turns[0] - held
    );
}

#[test]
fn the_weight_drives_the_clock_with_its_53_microwatts() {
    /// Of the power: where in its slide the escape wheel is at the ends of two minutes, one tooth in 112.
    const POWER: f64 = 0.02;
    let mut clock = Wound::new();
    clock.run(20.0, 0.0);
    let mass = clock.exhibit.bodies[clock.body("TimeWeight")].properties.mass;
    let height = clock.height();
    clock.run(120.0, 0.0);
    let power = mass * G * (height - clock.height()) / 120.0;
    println!("{:.2} µW, {:.2} mm an hour", 1e6 * power, 30e3 * (height - clock.height()));
    // m g r ω/2 with the great wheel's turn in eight hours.
    let expected = mass * G * 20e-3 * 0.5 * 2.0 * PI / (8.0 * 3600.0);
    assert!((power / expected - 1.0).abs() < POWER, "{power} W, not {expected} W");
    assert!((53e-6..54e-6).contains(&expected), "the label says 53 µW: {expected}");
}

#[test]
fn the_clock_stops_when_its_weight_is_down() {
    let mut clock = Wound::new();
    // Three tenths of a millimetre above its stop: two minutes.
    let weight = clock.body("TimeWeight");
    let way = 29.7e-3;
    let exhibit = Arc::make_mut(&mut clock.exhibit);
    for limit in &mut exhibit.limits {
        if let soffio_multibody::articulation::LimitKind::Range { min, .. } = &mut limit.kind
            && limit.name == "time-guide"
        {
            *min += way;
        }
    }
    clock.dynamics = start_dynamics(&clock.exhibit, &Settings::default());
    let start = clock.height();
    clock.run(160.0, 0.0);
    let down = start - clock.height();
    assert!((down - 0.3e-3).abs() < 1e-6, "the weight is {down} m lower");
    // The pendulum swings on, e^(−0.0391 t/2) of its way, and no wheel turns.
    let minute = clock.turns[1];
    clock.run(240.0, 0.0);
    assert!((clock.turns[1] - minute).abs() < 2e-3, "the hands go on by {} rad", clock.turns[1] - minute);
    let pendulum = &clock.dynamics.bodies[clock.body("Pendulum")];
    let swing = pendulum.angular_velocity.length();
    let free = 0.0747 * 5.87 * exp(-0.5 * 0.0391 * 240.0);
    println!("after four minutes the pendulum has {swing:.4} rad/s, free at most {free:.4}");
    assert!(swing < 2.0 * free, "{swing} rad/s");
    let _ = weight;
}
