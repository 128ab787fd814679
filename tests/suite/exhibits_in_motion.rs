//! The small exhibits as a visitor finds them: at rest, under a breath, and afterwards; against formulas.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DVec3, PI, asin, exp};
use soffio_offline::feed::WavFeed;
use soffio_offline::wav;
use soffio_simulation::{
    Command, Event, EventKind, MotionMode, STEPS_PER_SECOND, Script, Settings, Simulation, StepInput,
};
use soffio_sound::SoundCommand;

/// What the product promises of joints, m.
const JOINT_ERROR: f64 = 1e-9;
const G: f64 = 9.81;

fn shipped(id: &str) -> Arc<Exhibit> {
    let folder = exhibit::resolve(id).unwrap_or_else(|report| panic!("{report}"));
    Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{id}: {}", report.to_text())))
}

fn still() -> Settings {
    Settings { wind: false, ..Settings::default() }
}

/// An exhibit, what a visitor does with it, and what came of it.
struct Visit {
    simulation: Simulation,
    script: Script,
    events: Vec<Event>,
    strikes: usize,
}

impl Visit {
    fn new(id: &str, settings: Settings, script: &str) -> Self {
        let script = Script::parse(script).expect("a good script");
        Self { simulation: Simulation::new(shipped(id), settings), script, events: Vec::new(), strikes: 0 }
    }

    /// One breath from `t` on, of a strength for so many seconds, with the pointer there.
    fn breath(id: &str, aim: [f64; 2], t: f64, strength: f64, hold: f64) -> Self {
        let aim = format!("{{\"t\": 0, \"aim\": [{}, {}]}}\n", aim[0], aim[1]);
        let blow =
            format!("{{\"t\": {t}, \"blow\": {{\"strength\": {strength}, \"hold\": {hold}, \"release\": 0.3}}}}");
        Self::new(id, Settings::default(), &(aim + &blow))
    }

    fn time(&self) -> f64 {
        self.simulation.steps() as f64 / STEPS_PER_SECOND as f64
    }

    fn step(&mut self) {
        let mut commands = Vec::new();
        self.script.due(self.time(), &mut commands);
        let pointer = self.script.aim();
        let samples = self.simulation.steps() * 200..=(self.simulation.steps() + 1) * 200;
        self.simulation.step(&StepInput { pointer, commands: &commands, ..StepInput::default() });
        for event in self.simulation.events() {
            assert!(event.kind != EventKind::Fault, "a fault at {} s", event.t);
            assert!(samples.contains(&event.sample), "{event:?} is not of the step of samples {samples:?}");
        }
        self.events.extend_from_slice(self.simulation.events());
        let struck = |sound: &&SoundCommand| matches!(sound, SoundCommand::Strike(_));
        self.strikes += self.simulation.sounds().iter().filter(struck).count();
        assert!(self.simulation.joint_error() < JOINT_ERROR, "joints apart at {} s", self.time());
    }

    fn until(&mut self, t: f64) {
        while self.time() < t - 1e-9 {
            self.step();
        }
    }

    fn index(&self, name: &str) -> usize {
        let bodies = &self.simulation.exhibit().bodies;
        bodies.iter().position(|body| body.name == name).unwrap_or_else(|| panic!("no body {name}"))
    }

    fn body(&self, name: &str) -> &RigidBody {
        &self.simulation.bodies()[self.index(name)]
    }

    fn all(&self, kind: EventKind) -> Vec<&Event> {
        self.events.iter().filter(|event| event.kind == kind).collect()
    }
}

/// Angle of a body about the z axis, rad, −π … π.
fn turn(body: &RigidBody) -> f64 {
    let x = body.rotation * DVec3::X;
    soffio_math::atan2(x.y, x.x)
}

/// An angle followed over turns.
#[derive(Default)]
struct Turns {
    before: Option<f64>,
    total: f64,
}

impl Turns {
    fn follow(&mut self, angle: f64) {
        let step = angle - self.before.replace(angle).unwrap_or(angle);
        self.total += step - 2.0 * PI * (step / (2.0 * PI)).round();
    }
}

#[test]
fn the_pendulum_swings_at_its_period_and_loses_what_its_quality_says() {
    /// Straight lines between steps find a crossing to 10⁻⁶ s; seven digits of the model give as much.
    const PERIOD: f64 = 1e-5;
    const SWING: f64 = 2e-3;
    const RATE: f64 = 0.0391;
    let mut visit = Visit::new("pendulum", still(), "");
    let (mut crossings, mut peaks): (Vec<f64>, Vec<(f64, f64)>) = (Vec::new(), Vec::new());
    let (mut earlier, mut before) = (0.0, turn(visit.body("Pendulum")));
    let start = before;
    while visit.time() < 30.0 {
        let t = visit.time();
        visit.step();
        let now = turn(visit.body("Pendulum"));
        if before < 0.0 && now >= 0.0 {
            crossings.push(t + before / (before - now) / STEPS_PER_SECOND as f64);
        }
        if before > earlier && before > now {
            peaks.push((t, before));
        }
        (earlier, before) = (before, now);
    }
    // T = T₀ (1 + θ²/16), θ² = θ₀² e^(−c t) in the mean between the first and the last crossing.
    let (first, last) = (crossings[0], crossings[crossings.len() - 1]);
    let found = (last - first) / (crossings.len() - 1) as f64;
    let square = start * start * (exp(-RATE * first) - exp(-RATE * last)) / (RATE * (last - first));
    let expected = 2.0 * 3600.0 / 6720.0 * (1.0 + square / 16.0);
    println!("period {found:.6} s, expected {expected:.6} s");
    assert!((found / expected - 1.0).abs() < PERIOD, "{found} s, not {expected} s");
    for (t, peak) in peaks {
        let expected = start * exp(-0.5 * RATE * t);
        assert!((peak / expected - 1.0).abs() < SWING, "swings by {peak} rad at {t} s, not {expected}");
    }
}

#[test]
fn a_childs_gentle_breath_moves_it_within_a_second() {
    // 3.8 m/s at the lips, the pointer left alone; 5 mm or 2° off where it is without a breath.
    for id in ["axis-wheel", "billiards", "breaking-chain", "plates", "windmill", "windy-corner"] {
        let after = |speed: f64| {
            let mut simulation = Simulation::new(shipped(id), Settings::default());
            for step in 0..2 * STEPS_PER_SECOND {
                let blow = [Command::Blow(Some(speed))];
                let commands = if step == STEPS_PER_SECOND { &blow[..] } else { &[] };
                simulation.step(&StepInput { commands, ..StepInput::default() });
            }
            simulation.bodies().to_vec()
        };
        let (mut way, mut angle): (f64, f64) = (0.0, 0.0);
        for (still, blown) in after(0.0).iter().zip(after(3.8)) {
            way = way.max(blown.position.distance(still.position));
            angle = angle.max(2.0 * blown.rotation.dot(still.rotation).abs().min(1.0).acos());
        }
        println!("{id}: {:.1} mm, {:.1}°", 1e3 * way, angle.to_degrees());
        assert!(way > 5e-3 || angle.to_degrees() > 2.0, "{id}: {way} m, {angle} rad");
    }
}

#[test]
fn the_pendulum_goes_further_when_it_is_blown_in_its_own_time() {
    // A short breath each time it swings away from the visitor.
    let mut visit = Visit::new("pendulum", Settings::default(), "{\"t\": 0, \"aim\": [0.5, 0.75]}");
    let away = |visit: &Visit| visit.body("Pendulum").velocity.dot(visit.simulation.snapshot().breath.direction) > 0.0;
    let mut largest: f64 = 0.0;
    while visit.time() < 12.0 {
        let speed = Some(6.0).filter(|_| away(&visit));
        let commands = [Command::Blow(speed)];
        visit.simulation.step(&StepInput { pointer: Some([0.5, 0.75]), commands: &commands, ..StepInput::default() });
        largest = largest.max(turn(visit.body("Pendulum")).abs());
    }
    println!("from 4° to {:.2}° in twelve seconds", largest.to_degrees());
    assert!(largest.to_degrees() > 5.0, "only {:.2}°", largest.to_degrees());
}

#[test]
fn the_wheel_changes_its_axis_as_a_critically_damped_spring_does() {
    /// Where projection takes over from the stabiliser, and a few digits besides.
    const DRAWN: f64 = 3e-4;
    const OMEGA: f64 = 1.0 / 0.12;
    let mut visit = Visit::new("axis-wheel", still(), "");
    visit.until(2.5);
    let spin = visit.body("Wheel").angular_velocity;
    let expected = 120.0_f64.to_radians() * exp(-0.05 * 2.5);
    assert!(spin.distance(expected * DVec3::Z) < 1e-6, "{spin} rad/s after 2.5 s");
    // The row asks the wheel's own x for a right angle with the world's y: C = asin(x·Y).
    let row = |visit: &Visit| {
        let x = visit.body("Wheel").rotation * DVec3::X;
        let rate = visit.body("Wheel").angular_velocity.cross(x).y;
        (asin(x.y), rate / (1.0 - x.y * x.y).sqrt())
    };
    let (c, rate) = row(&visit);
    assert!(c.abs() > 0.5, "the change has something to do: {c} rad");
    while visit.time() < 5.0 {
        let t = visit.time() - 2.5;
        let expected = (c + (rate + OMEGA * c) * t) * exp(-OMEGA * t);
        let found = row(&visit).0;
        assert!((found - expected).abs() < DRAWN, "{found} rad at {t} s after the change, not {expected}");
        visit.step();
    }
}

#[test]
fn a_breath_beside_its_middle_turns_the_upright_wheel_about_the_upright_axis() {
    let mut visit = Visit::breath("axis-wheel", [0.6, 0.4], 3.2, 0.5, 1.4);
    visit.until(4.9);
    let spin = visit.body("Wheel").angular_velocity;
    println!("the upright wheel turns at {:.1}°/s", spin.y.to_degrees());
    assert!(spin.y.abs() > 0.5, "{spin} rad/s");
    // Rows that are closed hold to rounding; the stabiliser's last pull fades with e^(−20).
    assert!(spin.x.abs() + spin.z.abs() < 1e-6 * spin.y.abs(), "{spin} rad/s about another axis");
    assert!((visit.body("Wheel").rotation * DVec3::Y).y.abs() > 1.0 - 1e-9);
    visit.until(7.0);
    let axle = visit.body("Wheel").rotation * DVec3::Z;
    assert!(axle.z.abs() > 1.0 - 1e-9, "it faces along {axle} again");
}

/// Turns of the rotor about its shaft, and the head's own turn (rad), after this recording or script.
fn windmill(mut visit: Visit, seconds: f64, mut breath: Option<WavFeed>) -> (f64, f64) {
    let mut turns = Turns::default();
    let mut head = 0.0;
    while visit.time() < seconds {
        match &mut breath {
            Some(feed) => {
                let microphone = Some(feed.microphone());
                visit.simulation.step(&StepInput { microphone, pointer: Some([0.5, 0.35]), ..StepInput::default() });
            }
            None => visit.step(),
        }
        let (mast, shaft) = (visit.body("Head").rotation, visit.body("Rotor").rotation);
        assert!((mast * DVec3::Y).distance(DVec3::Y) < 1e-9, "the head leans at {} s", visit.time());
        assert!((mast * DVec3::Z).distance(shaft * DVec3::Z) < 1e-9, "the rotor leaves its shaft");
        let x = mast.conjugate() * (shaft * DVec3::X);
        turns.follow(soffio_math::atan2(x.y, x.x));
        let z = mast * DVec3::Z;
        head = soffio_math::atan2(z.x, z.z);
    }
    (turns.total / (2.0 * PI), head)
}

#[test]
fn the_windmill_turns_under_a_breath_and_not_without() {
    let (turns, _) = windmill(Visit::new("windmill", Settings::default(), ""), 5.0, None);
    assert!(turns.abs() < 1e-9, "it turns by itself, {turns} times");
    let (turns, head) = windmill(Visit::breath("windmill", [0.5, 0.35], 1.0, 0.5, 2.5), 10.0, None);
    println!("a breath turns the rotor {turns:.2} times and the head by {:.0}°", head.to_degrees());
    assert!(turns.abs() > 1.5, "{turns} turns");
    assert!(head.abs() < 0.5 * PI, "the head is blown away: {} rad", head);
    let (recorded, _) = windmill(Visit::new("windmill", Settings::default(), ""), 8.0, Some(strong()));
    println!("a recorded breath turns it {recorded:.2} times");
    assert!(recorded * turns > 0.0 && recorded.abs() > 0.5, "{recorded} turns by a recorded breath");
}

fn strong() -> WavFeed {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits/steel-fish/breaths/strong.wav");
    let recording = wav::read(path).expect("a shipped breath");
    WavFeed::new(recording.samples, recording.sample_rate)
}

/// Teeth of the first wheel over those of each wheel, signed.
const RATIOS: [f64; 4] = [1.0, -3.0, 60.0 / 36.0, -5.0];
const WHEELS: [&str; 4] = ["Wheel1", "Wheel2", "Wheel3", "Wheel4"];
/// Radius of the drum, m.
const DRUM: f64 = 6e-3;

#[test]
fn the_gears_weight_falls_as_inertia_and_losses_say_and_the_teeth_stay_in_step() {
    /// Rounding of the model's corners, as 32-bit floats, does not enter: both sides use the loader's masses.
    const FALL: f64 = 1e-6;
    const PHASE: f64 = 1e-9;
    let mut visit = Visit::new("gear-train", still(), "");
    let exhibit = visit.simulation.exhibit().clone();
    // (m r² + Σ I n²) θ̈ = m g r − Σ c I n² θ̇, so v = v∞ (1 − e^(−t/τ)) with v∞ = m g r²/Σ c I n².
    let weight = exhibit.bodies[visit.index("Weight")].properties.mass;
    let (mut inertia, mut loss) = (weight * DRUM * DRUM, 0.0);
    for (name, n) in WHEELS.iter().zip(RATIOS) {
        let wheel = &exhibit.bodies[visit.index(name)];
        let i = wheel.properties.inertia.z_axis.z * n * n;
        inertia += i;
        loss += wheel.angular_damping * i;
    }
    let (tau, last) = (inertia / loss, weight * G * DRUM * DRUM / loss);
    println!("{:.2} mm/s after {tau:.3} s; 175 mm in {:.0} s", 1e3 * last, 0.175 / last);
    assert!((20.0..40.0).contains(&(0.175 / last)), "down after half a minute");
    let start = visit.body("Weight").position.y;
    let mut turns = WHEELS.map(|_| Turns::default());
    while visit.time() < 20.0 {
        for (turns, name) in turns.iter_mut().zip(WHEELS) {
            turns.follow(turn(visit.body(name)));
        }
        let t = visit.time();
        let fallen = start - visit.body("Weight").position.y;
        let expected = last * (t - tau * (1.0 - exp(-t / tau)));
        assert!((fallen - expected).abs() < FALL * 0.175, "fell {fallen} m in {t} s, not {expected}");
        for (turns, n) in turns.iter().zip(RATIOS) {
            assert!((turns.total * DRUM - n * fallen).abs() < PHASE * DRUM, "a wheel slips at {t} s");
        }
        visit.step();
    }
}

#[test]
fn a_breath_on_the_fan_holds_the_weight_back() {
    let fallen = |strength: f64| {
        let mut visit = Visit::breath("gear-train", [0.59, 0.3], 2.0, strength, 2.0);
        visit.until(2.0);
        let start = visit.body("Weight").position.y;
        visit.until(4.5);
        start - visit.body("Weight").position.y
    };
    let (alone, blown) = (fallen(0.0), fallen(0.5));
    println!("{:.1} mm alone, {:.1} mm under a breath", 1e3 * alone, 1e3 * blown);
    assert!(blown < 0.9 * alone, "{blown} m, {alone} m alone");
}

#[test]
fn after_its_time_the_gear_train_starts_again() {
    let mut visit = Visit::new("gear-train", still(), "");
    let duration = visit.simulation.exhibit().duration;
    let start = *visit.body("Weight");
    visit.until(duration);
    assert!(visit.body("Weight").position.distance(start.position) > 0.05);
    let one_step = {
        let mut fresh = Visit::new("gear-train", still(), "");
        fresh.step();
        *fresh.body("Weight")
    };
    visit.step();
    assert_eq!(*visit.body("Weight"), one_step, "the first step of the second round is that of the first");
}

/// How far the weak joint of the chain stands open, m.
fn gap(visit: &Visit) -> f64 {
    let end = visit.body("Link3").pose().point(DVec3::new(0.0, -44e-3, 0.0));
    end.distance(visit.body("Link4").pose().position)
}

#[test]
fn the_chain_breaks_once_when_it_is_blown_falls_and_mends() {
    /// The model's points are 32-bit floats.
    const CLOSED: f64 = 1e-8;
    let mut visit = Visit::breath("breaking-chain", [0.5, 0.62], 1.0, 0.8, 1.6);
    visit.until(1.0);
    assert!(gap(&visit) < CLOSED && visit.events.is_empty());
    let mut widest: f64 = 0.0;
    while visit.time() < 40.0 {
        visit.step();
        widest = widest.max(gap(&visit));
    }
    let breaks = visit.all(EventKind::Break);
    assert_eq!(breaks.len(), 1, "it breaks once: {breaks:#?}");
    let exhibit = visit.simulation.exhibit();
    let broken = breaks[0];
    println!("breaks at {:.3} s, opens by {:.0} mm", broken.t, 1e3 * widest);
    assert_eq!(broken.source.expect("a part").name(exhibit), "weak");
    assert_eq!(broken.bodies.map(|b| b.expect("a body")), ["Link4", "Link3"].map(|name| visit.index(name)));
    assert!((1.0..4.0).contains(&broken.t), "at {} s", broken.t);
    assert!((broken.point.y - (0.47 - 3.0 * 44e-3)).abs() < 20e-3, "it breaks where the joint is: {}", broken.point);
    assert!(widest > 0.1, "what fell lies {widest} m below");
    assert!(visit.all(EventKind::Impact).len() > 1, "it rattles on the tray");
    assert!(gap(&visit) < CLOSED, "{} m apart", gap(&visit));
    let spread = visit.simulation.bodies().iter().map(|b| b.position.x.hypot(b.position.z)).fold(0.0, f64::max);
    assert!(spread < 50e-3, "it hangs again: {spread} m aside");
}

#[test]
fn the_chain_gathers_past_what_lies_in_its_way() {
    for strength in [0.7, 0.9, 1.0] {
        let mut visit = Visit::breath("breaking-chain", [0.5, 0.62], 1.0, strength, 1.6);
        visit.until(30.0);
        assert!(visit.all(EventKind::Break).len() == 1, "a breath of {strength}: it breaks once");
        assert!(visit.all(EventKind::Fault).is_empty(), "a breath of {strength}: {:?}", visit.all(EventKind::Fault));
        assert!(gap(&visit) < 1e-8, "a breath of {strength}: {} m apart", gap(&visit));
    }
}

#[test]
fn the_chain_bears_its_weight_and_a_gentle_breath() {
    let mut visit = Visit::breath("breaking-chain", [0.5, 0.62], 5.0, 0.3, 1.6);
    visit.until(15.0);
    assert!(visit.all(EventKind::Break).is_empty(), "{:?}", visit.events);
}

#[test]
fn the_windy_corner_moves_by_its_own_winds_and_a_breath_turns_the_pinwheel_back() {
    let mut calm = Visit::new("windy-corner", still(), "");
    calm.until(3.0);
    for (body, start) in calm.simulation.bodies().iter().zip(&shipped("windy-corner").bodies) {
        let moved = (body.rotation * DVec3::X).distance(start.pose.rotation * DVec3::X);
        // What the branches turn by until friction holds them: their balance is stored in 32 bits.
        assert!(moved < 1e-3, "without wind {} turns by {moved}", start.name);
    }
    let spin = |visit: &Visit| -visit.body("Pinwheel").angular_velocity.z;
    let mut visit = Visit::new("windy-corner", Settings::default(), "");
    visit.until(4.0);
    let hung = visit.body("MiddleStrip").position;
    let (mut slowest, mut fastest, mut way) = (f64::INFINITY, 0.0_f64, 0.0_f64);
    while visit.time() < 40.0 {
        visit.step();
        (slowest, fastest) = (slowest.min(spin(&visit)), fastest.max(spin(&visit)));
        way = way.max(visit.body("MiddleStrip").position.distance(hung));
    }
    println!("the vent turns the pinwheel by {slowest:.1} to {fastest:.1} rad/s, a strip drifts {:.0} mm", 1e3 * way);
    assert!(slowest > 1.0 && fastest > 1.3 * slowest, "{slowest} to {fastest} rad/s");
    assert!(way > 10e-3, "the draught moves a strip by {way} m");
    let mut visit = Visit::breath("windy-corner", [0.33, 0.4], 5.0, 0.5, 2.5);
    visit.until(5.0);
    let before = spin(&visit);
    visit.until(7.5);
    let blown = spin(&visit);
    visit.until(15.0);
    println!("a breath turns the pinwheel from {before:.1} to {blown:.1} rad/s, then {:.1}", spin(&visit));
    assert!(before > 1.0 && blown < -1.0 && spin(&visit) > 1.0, "{before}, {blown}, {} rad/s", spin(&visit));
}

#[test]
fn the_plates_meet_under_a_breath_and_ring() {
    for (aim, strength) in [([0.5, 0.55], 0.4), ([0.5, 0.55], 0.6), ([0.55, 0.6], 0.8)] {
        let mut visit = Visit::breath("plates", aim, 1.0, strength, 1.5);
        visit.until(1.0);
        assert!(visit.events.is_empty(), "they touch at rest: {:?}", visit.events);
        visit.until(12.0);
        let hits = visit.all(EventKind::Impact);
        let loudest = hits.iter().map(|hit| hit.impulse).fold(0.0, f64::max);
        println!(
            "breath {strength} at {aim:?}: {} hits, the hardest {:.2e} N s, {} strikes",
            hits.len(),
            loudest,
            visit.strikes
        );
        assert!(!hits.is_empty(), "no hit under a breath of {strength} at {aim:?}");
        // Both bodies of a hit ring.
        assert!(visit.strikes >= hits.len(), "{} strikes", visit.strikes);
    }
}

/// A ball of *Billiards* lies between the cushions, on the bed or little above it.
fn assert_on_the_table(ball: &RigidBody) {
    let (x, y, z) = (ball.position.x.abs(), ball.position.y, ball.position.z.abs());
    assert!(x < 0.2201 && z < 0.1301 && (0.083..0.13).contains(&y), "off the table at {}", ball.position);
}

#[test]
fn the_balls_stay_on_the_table_and_click_when_moved_by_places() {
    for mode in [MotionMode::Procedural, MotionMode::PositionBased] {
        let mut simulation = Simulation::new(shipped("billiards"), Settings::default());
        // All balls rest at one time at least: one may still leave a saddle between two hollows.
        let (mut strikes, mut fastest, mut rest) = (0, 0.0_f64, f64::INFINITY);
        for step in 0..20 * STEPS_PER_SECOND {
            let blows = (6 * STEPS_PER_SECOND..8 * STEPS_PER_SECOND).contains(&step);
            let commands = &[Command::Blow(blows.then_some(12.0))];
            simulation.step(&StepInput {
                commands,
                mode: Some(mode),
                pointer: Some([0.5, 0.55]),
                ..StepInput::default()
            });
            simulation.bodies().iter().for_each(assert_on_the_table);
            if step > 6 * STEPS_PER_SECOND {
                strikes += simulation.sounds().iter().filter(|s| matches!(s, SoundCommand::Strike(_))).count();
                let now = simulation.bodies().iter().fold(0.0, |most: f64, ball| most.max(ball.velocity.length()));
                fastest = fastest.max(now);
                if step > 16 * STEPS_PER_SECOND {
                    rest = rest.min(now);
                }
            }
        }
        println!("{mode:?}: {strikes} strikes, up to {fastest:.2} m/s, then {rest:.1e} m/s");
        assert!(strikes > 2 && fastest > 0.05 && rest < 0.01, "{mode:?}: {strikes} strikes, {fastest}, {rest} m/s");
    }
}

#[test]
fn the_balls_part_under_a_breath_click_and_come_together_on_the_table() {
    for strength in [0.25, 0.6, 1.0] {
        let mut visit = Visit::breath("billiards", [0.5, 0.55], 4.0, strength, 1.5);
        visit.until(4.0);
        let (before, start) = (visit.strikes, visit.simulation.bodies().to_vec());
        let mut way: f64 = 0.0;
        while visit.time() < 24.0 {
            visit.step();
            for (ball, start) in visit.simulation.bodies().iter().zip(&start) {
                way = way.max(ball.position.distance(start.position));
                assert_on_the_table(ball);
            }
        }
        let clicks = visit.strikes - before;
        let fastest = visit.simulation.bodies().iter().fold(0.0, |most: f64, b| most.max(b.velocity.length()));
        println!("breath {strength}: up to {:.0} mm, {clicks} strikes, then {fastest:.1e} m/s", 1e3 * way);
        assert!(way > 0.03 && clicks > 2, "strength {strength}: {way} m, {clicks} strikes");
        assert!(fastest < 0.01, "strength {strength}: still {fastest} m/s");
    }
}
