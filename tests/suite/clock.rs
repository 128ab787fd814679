//! Eli Terry's clock keeps time by its own mechanics: beats, rate, ratios, energy, and what it does when it is stopped.

use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_math::Function;
use soffio_math::{DVec3, PI, atan2, rotation};
use soffio_multibody::articulation::LimitKind;
use soffio_multibody::dynamics::Dynamics;
use soffio_simulation::{
    Command, EventKind, PointerGrab, STEPS_PER_SECOND, Settings, Simulation, StepInput, start_dynamics,
};

const DT: f64 = 1.0 / 240.0;
/// Beats an hour that its train is cut for.
const RATE: f64 = 6720.0;
/// Teeth of the escape wheel.
const TEETH: f64 = 42.0;

fn shipped() -> Arc<Exhibit> {
    let folder = exhibit::resolve("terry-clock").unwrap_or_else(|report| panic!("{report}"));
    Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{}", report.to_text())))
}

/// The clock without air.
struct Clock {
    dynamics: Dynamics,
    exhibit: Arc<Exhibit>,
    still: Vec<[f64; 6]>,
    time: f64,
    /// Times at which the pendulum passed the vertical, s.
    beats: Vec<f64>,
    /// Largest swing between them, rad.
    swings: Vec<f64>,
    largest: f64,
    /// Turns of wheels since the start, rad: escape wheel, minute hand, hour wheel.
    turns: [f64; 3],
    /// What damping took, J.
    damped: f64,
}

const WHEELS: [&str; 3] = ["EscapeWheel", "Cannon", "HourWheel"];

impl Clock {
    fn new() -> Self {
        let exhibit = shipped();
        let dynamics = start_dynamics(&exhibit, &Settings::default());
        let still = vec![[0.0; 6]; dynamics.bodies.len()];
        Self {
            dynamics,
            exhibit,
            still,
            time: 0.0,
            beats: Vec::new(),
            swings: Vec::new(),
            largest: 0.0,
            turns: [0.0; 3],
            damped: 0.0,
        }
    }

    fn body(&self, name: &str) -> usize {
        let found = self.exhibit.bodies.iter().position(|body| body.name == name);
        found.unwrap_or_else(|| panic!("no body {name}"))
    }

    /// Turn about z since the model's pose, rad, and its rate.
    fn angle(&self, body: usize) -> (f64, f64) {
        let body = &self.dynamics.bodies[body];
        (2.0 * atan2(body.rotation.z, body.rotation.w), body.angular_velocity.z)
    }

    /// What the pendulum loses to its damping, W.
    fn loss(&self, pendulum: usize) -> f64 {
        let rate = self.dynamics.damping(pendulum);
        let body = &self.dynamics.bodies[pendulum];
        let spin = body.angular_velocity.dot(body.inertia_world() * body.angular_velocity);
        rate.linear * body.properties.mass * body.velocity.length_squared() + rate.angular * spin
    }

    /// Runs for a time in steps of `dt`.
    fn run(&mut self, seconds: f64, dt: f64) {
        let pendulum = self.body("Pendulum");
        let wheels = WHEELS.map(|name| self.body(name));
        let mut hits = Vec::new();
        for _ in 0..(seconds / dt).round() as usize {
            let (from, rate) = self.angle(pendulum);
            let before = wheels.map(|wheel| self.angle(wheel).0);
            let loss = self.loss(pendulum);
            hits.clear();
            assert_eq!(self.dynamics.step(dt, &self.still, &mut hits), None, "bad numbers");
            self.damped += 0.5 * dt * (loss + self.loss(pendulum));
            let after = wheels.map(|wheel| self.angle(wheel).0);
            for ((turn, before), after) in self.turns.iter_mut().zip(before).zip(after) {
                let way = after - before;
                *turn += way - 2.0 * PI * (way / (2.0 * PI)).round();
            }
            let (to, end) = self.angle(pendulum);
            self.largest = self.largest.max(to.abs());
            if from * to < 0.0 {
                self.beats.push(self.time + dt * crossing((from, rate * dt), (to, end * dt)));
                self.swings.push(self.largest);
                self.largest = 0.0;
            }
            self.time += dt;
        }
    }
}

/// Beats an hour over whole swings.
fn rate(beats: &[f64]) -> f64 {
    let whole = (beats.len() - 1) / 2 * 2;
    3600.0 * whole as f64 / (beats[whole] - beats[0])
}

/// Where a cubic with these values and slopes at 0 and 1 passes 0.
fn crossing((from, slope): (f64, f64), (to, end): (f64, f64)) -> f64 {
    let value = |s: f64| {
        let (a, b) = (1.0 - s, s);
        from * a * a * (1.0 + 2.0 * s) + to * b * b * (3.0 - 2.0 * s) + slope * s * a * a - end * b * b * a
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if value(middle) * from > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// `cargo test --no-default-features --release --test suite an_hour -- --ignored --nocapture`
#[test]
#[ignore = "an hour: a minute of the machine; part `beats` of tests/check.sh --long"]
fn it_beats_6720_times_an_hour() {
    /// Beats an hour.
    const OFF: f64 = 1.0;
    // It is rated where it hangs, as what the air takes from its swing is a part of its rate, and over an hour with its strike:
    // what the strike's release takes from the train is one too.
    let Kept { beats, .. } = in_ambient_air(3600.0, 0.0, false);
    let rate = rate(&beats);
    println!("{} beats in an hour, {rate} by its swings", beats.len());
    assert!((beats.len() as f64 - RATE).abs() <= OFF && (rate - RATE).abs() < OFF, "{rate} beats an hour");
}

#[test]
fn it_beats_tooth_by_tooth() {
    /// After this it swings as it will for ever: six times 2 Q/ω would be minutes; it starts near its own swing.
    const SETTLES: usize = 120;
    /// Of a swing to the next on the same side.
    const STEADY: f64 = 2e-3;
    let mut clock = Clock::new();
    clock.run(150.0, DT);
    for pair in clock.swings[SETTLES..].windows(3) {
        assert!((pair[2] / pair[0] - 1.0).abs() < STEADY, "swings of {pair:?} rad");
    }
    // Two beats a tooth, clockwise; where in its slide the wheel is at the ends says the rest.
    let teeth = -clock.turns[0] * TEETH / (2.0 * PI);
    assert!((teeth - 0.5 * clock.beats.len() as f64).abs() < 1.0, "{teeth} teeth in {} beats", clock.beats.len());
}

#[test]
fn the_hands_turn_as_twelve_to_one() {
    /// rad: whole turns of the escape wheel over 160 times the hour hand's way, rounded.
    const EXACT: f64 = 1e-12;
    let mut clock = Clock::new();
    clock.run(60.0, DT);
    let [escape, minute, hour] = clock.turns;
    assert!(minute < -0.1, "the minute hand has gone by {minute} rad");
    assert!((minute - 12.0 * hour).abs() < EXACT, "{minute} and {hour} rad");
    assert!((escape - 80.0 * minute).abs() < 80.0 * EXACT, "{escape} and {minute} rad");
}

#[test]
fn its_energy_is_accounted_for() {
    /// Relative to the work of the weights: energy of the penetration recovery of teeth, and the trapezoid rule at
    /// impacts.
    const LEDGER: f64 = 1e-5;
    let mut clock = Clock::new();
    clock.run(10.0, DT);
    let (energy, contact, damped) = (clock.dynamics.energy(), clock.dynamics.contact_work(), clock.damped);
    let weight = clock.body("TimeWeight");
    let height = clock.dynamics.bodies[weight].position.y;
    clock.run(60.0, DT);
    let drop = height - clock.dynamics.bodies[weight].position.y;
    let work = 9.81 * drop * clock.dynamics.bodies[weight].properties.mass;
    let lost = contact - clock.dynamics.contact_work();
    let missing = (clock.dynamics.energy() - energy + clock.damped - damped + lost).abs() / work;
    println!("work {work:.4e} J = air {:.4e} + contact {lost:.4e}, missing {missing:.1e}", clock.damped - damped);
    assert!(missing < LEDGER, "{missing} of the weight's work is missing");
}

#[test]
fn a_stopped_pendulum_stops_the_train_and_a_push_starts_it() {
    let mut clock = Clock::new();
    let parts = ["Pendulum", "Anchor"].map(|name| clock.body(name));
    for part in parts {
        let body = &mut clock.dynamics.bodies[part];
        let pivot = body.pose();
        body.rotation = soffio_math::DQuat::IDENTITY;
        body.position = pivot.position + body.properties.center;
        (body.velocity, body.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
    }
    clock.dynamics.disturb();
    clock.run(60.0, DT);
    let (stopped, beats) = (clock.turns[0], clock.beats.len());
    clock.run(60.0, DT);
    assert_eq!(clock.beats.len(), beats, "it beats by itself");
    assert!((clock.turns[0] - stopped).abs() < 0.01, "the wheel goes on by {} rad", clock.turns[0] - stopped);
    // A push of the body that carries the pendulum, by some degrees.
    let pendulum = parts[0];
    let push = 0.45;
    for part in parts {
        let body = &mut clock.dynamics.bodies[part];
        let pivot = body.pose().position;
        body.angular_velocity = DVec3::Z * push;
        body.velocity = body.angular_velocity.cross(body.position - pivot);
    }
    clock.dynamics.disturb();
    let before = clock.beats.len();
    clock.run(60.0, DT);
    assert!(
        clock.beats.len() - before > 100,
        "{} beats, swing {:?}",
        clock.beats.len() - before,
        clock.angle(pendulum)
    );
}

/// Bodies that are at rest between two strikes.
const STRIKING: [&str; 7] = ["StrikeWheel", "StrikeDrum", "StrikeWeight", "PinWheel", "LockWheel", "Fly", "CountWheel"];

/// s, of any of eleven blows; reached: 15 ms. The minute hand's pin lets the flirt fall so much sooner or later.
const BLOWS_APART: f64 = 5e-2;
/// s, of any of 1120 beats. The bodies left out touch no moving body, but fewer contact forces round differently. From
/// then on the two runs differ by the effect of a step on a beat: 2.1 ms in ten seconds
/// (`beats_fall_where_a_finer_step_has_them`).
/// Over 615 s such differences add up as a random walk: 2.1 ms · √61.5 = 16.5 ms.
const BEATS_APART: f64 = 16.5e-3;

/// How far the beats of two runs are apart at most, s: of one whose strike sleeps, and of the same awake.
fn apart_from_awake(asleep: &Kept, push: f64) -> f64 {
    /// Of the time: all but the strike itself, and what it takes the hammer to come to rest.
    const SLEEPS: f64 = 0.95;
    let steps = TO_ELEVEN * STEPS_PER_SECOND as f64;
    let awake = in_ambient_air(TO_ELEVEN, push, true);
    let slept = asleep.slept;
    assert!(awake.slept == 0 && slept as f64 > SLEEPS * steps, "slept in {slept} steps of {steps}");
    assert_eq!((asleep.blows.len(), asleep.beats.len()), (awake.blows.len(), awake.beats.len()));
    let apart = |one: &[f64], other: &[f64]| one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let (blow, beat) = (apart(&asleep.blows, &awake.blows), apart(&asleep.beats, &awake.beats));
    println!("{push:.0e} rad/s: slept in {slept} of {steps} steps; blows {blow:.1e} s apart, beats {beat:.1e} s");
    assert!(blow < BLOWS_APART && beat < BEATS_APART, "blows {blow} s apart, beats {beat} s");
    beat
}

/// `cargo test --no-default-features --release --test suite never_slept -- --ignored --nocapture`
#[test]
#[ignore = "eight runs over the hour: a minute of the machine; part `beats` of tests/check.sh --long"]
fn it_beats_and_strikes_as_if_its_strike_never_slept() {
    /// s, the median of the pairs. Of seven pairs whose pendulums began a rounding apart, beats came 0.2 to 6.3 ms
    /// apart, five within 4 ms; a strike that moved the beats would move those of all pairs.
    const MEDIAN_BEAT: f64 = 5e-3;
    /// rad/s that the pendulum begins with, of each pair: roundings of its speed.
    const ROUNDINGS: [f64; 4] = [0.0, 1e-12, 2e-12, 3e-12];
    let mut beats: Vec<f64> = std::thread::scope(|scope| {
        let runs =
            ROUNDINGS.map(|push| scope.spawn(move || apart_from_awake(&in_ambient_air(TO_ELEVEN, push, false), push)));
        runs.into_iter().map(|run| run.join().expect("a pair that is alike")).collect()
    });
    beats.sort_by(f64::total_cmp);
    let median = 0.5 * (beats[1] + beats[2]);
    assert!(median < MEDIAN_BEAT, "its strike moves the beats: {beats:?} s");
}

/// s: from where the model's hands stand, ten to eleven, until it has struck eleven.
const TO_ELEVEN: f64 = 615.0;

/// What was kept of a run.
struct Kept {
    /// When the hammer met the bell, and when the pendulum passed the vertical, s.
    blows: Vec<f64>,
    beats: Vec<f64>,
    /// In how many of the steps the strike slept.
    slept: usize,
    /// How far joints were open at the end, m.
    open: f64,
}

/// The clock in the air of the gallery, which its fly needs: left to itself, or (`awake`) disturbed before each step, so
/// that nothing of it sleeps. Its pendulum begins with a push (rad/s).
fn in_ambient_air(seconds: f64, push: f64, awake: bool) -> Kept {
    let exhibit = shipped();
    let index = |name: &str| exhibit.bodies.iter().position(|body| body.name == name).expect("a body");
    let (hammer, pendulum) = (index("Hammer"), index("Pendulum"));
    let strike = STRIKING.map(index);
    let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
    simulation.bodies_mut()[pendulum].angular_velocity.z += push;
    let (mut blows, mut beats, mut slept) = (Vec::new(), Vec::new(), 0);
    let angle = |simulation: &Simulation| {
        let body = &simulation.bodies()[pendulum];
        (2.0 * atan2(body.rotation.z, body.rotation.w), body.angular_velocity.z)
    };
    for step in 0..(seconds * STEPS_PER_SECOND as f64) as u64 {
        if awake {
            simulation.bodies_mut();
        }
        let (from, rate) = angle(&simulation);
        simulation.step(&StepInput::default());
        let bell =
            simulation.events().iter().filter(|e| e.kind == EventKind::Impact && e.bodies == [Some(hammer), None]);
        blows.extend(bell.map(|event| event.t));
        let (to, end) = angle(&simulation);
        if from * to < 0.0 {
            beats.push(DT * (step as f64 + crossing((from, rate * DT), (to, end * DT))));
        }
        let sleeps = strike.map(|body| simulation.sleeps(body));
        assert!(sleeps == [true; 7] || sleeps == [false; 7], "{sleeps:?}");
        slept += usize::from(sleeps[0]);
    }
    Kept { blows, beats, slept, open: simulation.joint_error() }
}

/// Blows of the bell by the hours that they belong to, each with its first blow's time after the hour, s. The hands of the
/// model stand at ten to eleven.
fn struck(blows: &[f64]) -> Vec<(usize, usize, f64)> {
    let mut hours: Vec<(usize, usize, f64)> = Vec::new();
    for time in blows.iter().map(|time| time + 3000.0) {
        let hour = (time / 3600.0).round();
        let name = (10 + hour as usize - 1) % 12 + 1;
        match hours.last_mut() {
            Some((last, blows, _)) if *last == name => *blows += 1,
            _ => hours.push((name, 1, time - 3600.0 * hour)),
        }
    }
    hours
}

/// The clock as a visitor meets it, the ring at the leaf: a puff is blown in these steps, and a hand is where it says.
struct Visited {
    simulation: Simulation,
    pendulum: usize,
    step: u64,
}

/// Where the leaf on the pendulum is seen.
const LEAF: [f64; 2] = [0.5, 0.55];
/// A strong breath at the lips, m/s, and how long a puff lasts, s: about half a swing to and fro.
const PUFF: f64 = 14.0;
const PUFFS: f64 = 0.5;

impl Visited {
    fn new(exhibit: Exhibit) -> Self {
        let simulation = Simulation::new(Arc::new(exhibit), Settings::default());
        let pendulum = simulation.exhibit().bodies.iter().position(|body| body.name == "Pendulum").expect("a pendulum");
        Self { simulation, pendulum, step: 0 }
    }

    fn angle(&self) -> f64 {
        let rotation = self.simulation.bodies()[self.pendulum].rotation;
        2.0 * atan2(rotation.z, rotation.w)
    }

    /// Goes on for a time under a breath (m/s) and hands; the widest swing, degrees, and how many teeth were let go.
    fn go_on(&mut self, seconds: f64, breath: f64, hands: &[PointerGrab]) -> (f64, usize) {
        let commands = [Command::Blow((breath > 0.0).then_some(breath))];
        let (mut widest, mut teeth): (f64, usize) = (0.0, 0);
        let input =
            StepInput { commands: &commands, pointer_grabs: hands, pointer: Some(LEAF), ..StepInput::default() };
        for _ in 0..(seconds * STEPS_PER_SECOND as f64) as u64 {
            self.simulation.step(&input);
            self.step += 1;
            widest = widest.max(self.angle().abs());
            let drops = self.simulation.events().iter().filter(|e| e.kind == EventKind::Impact);
            teeth += drops.filter(|e| e.bodies.contains(&Some(self.anchor()))).count();
        }
        (widest.to_degrees(), teeth)
    }

    fn anchor(&self) -> usize {
        self.simulation.exhibit().bodies.iter().position(|body| body.name == "Anchor").expect("an anchor")
    }

    /// Waits until the pendulum turns back at its right (or left) end.
    fn wait_for(&mut self, right: bool) {
        let rate = |clock: &Self| clock.simulation.bodies()[clock.pendulum].angular_velocity.z;
        loop {
            let before = rate(self);
            self.go_on(1.5 / STEPS_PER_SECOND as f64, 0.0, &[]);
            if before * rate(self) <= 0.0 && (before > 0.0) == right {
                return;
            }
        }
    }
}

/// Wider than the escapement needs to let teeth go, and so narrow that it lets none go, degrees.
const GOES: f64 = 2.6;
const STANDS: f64 = 1.0;

#[test]
fn a_puff_widens_its_swing_or_stops_it_and_starts_it_again() {
    let mut clock = Visited::new(shipped().as_ref().clone());
    let (own, _) = clock.go_on(20.0, 0.0, &[]);
    // The leaf takes the pendulum to the left. Blown while it comes from there, it takes the swing away.
    clock.wait_for(true);
    clock.go_on(PUFFS, PUFF, &[]);
    let (with, _) = clock.go_on(2.0, 0.0, &[]);
    assert!(with > 1.2 * own, "{own} degrees, and {with} after a puff with it");
    clock.go_on(60.0, 0.0, &[]);
    clock.wait_for(false);
    clock.go_on(PUFFS, PUFF, &[]);
    clock.go_on(60.0, 0.0, &[]);
    let (still, teeth) = clock.go_on(10.0, 0.0, &[]);
    assert!(still < STANDS && teeth == 0, "still {still} degrees, {teeth} teeth");
    clock.go_on(PUFFS, PUFF, &[]);
    clock.go_on(10.0, 0.0, &[]);
    let (again, teeth) = clock.go_on(10.0, 0.0, &[]);
    assert!(again > GOES && teeth >= 18, "again {again} degrees, {teeth} teeth in ten seconds");
}

#[test]
fn it_runs_down_when_its_weight_stands_and_whoever_lifts_the_weight_winds_it() {
    /// The click falls back to its last tooth: one of 32 on the drum, less than that of the weight's way, m.
    const CLICK: f64 = 2.5e-3;
    // The same clock, its weight almost down: a millimetre lasts for eight minutes.
    let mut exhibit = shipped().as_ref().clone();
    let guide = exhibit.limits.iter_mut().find(|limit| limit.name.starts_with("time-guide")).expect("a guide");
    let LimitKind::Range { min, .. } = &mut guide.kind else { panic!("{guide:?}") };
    *min = -1e-4;
    let mut clock = Visited::new(exhibit);
    let weight = clock.simulation.exhibit().bodies.iter().position(|body| body.name == "TimeWeight").expect("a weight");
    let height = |clock: &Visited| clock.simulation.bodies()[weight].position.y;
    let (_, teeth) = clock.go_on(20.0, 0.0, &[]);
    assert!(teeth > 30, "{teeth} teeth");
    clock.go_on(200.0, 0.0, &[]);
    let (swing, teeth) = clock.go_on(10.0, 0.0, &[]);
    assert!(swing < STANDS && teeth == 0, "run down: {swing} degrees, {teeth} teeth");
    // A visitor takes the weight and lifts it by as much as a hand's breadth of the picture.
    let aspect = 16.0 / 9.0;
    let low = clock.simulation.view(aspect).project(clock.simulation.bodies()[weight].position, aspect).expect("seen");
    let (before, grab) = (height(&clock), |y: f64| [PointerGrab { id: 1, at: [low[0], y], body: Some(weight) }]);
    clock.go_on(0.5, 0.0, &grab(low[1]));
    clock.go_on(1.0, 0.0, &grab(low[1] - 0.006));
    let lifted = height(&clock);
    clock.go_on(1.0, 0.0, &[]);
    let held = height(&clock);
    assert!(lifted > before + 2.0e-3, "lifted by {} m", lifted - before);
    assert!(held > lifted - CLICK && held > before + 5e-4, "fell back from {lifted} to {held} m");
    clock.go_on(PUFFS, PUFF, &[]);
    clock.go_on(10.0, 0.0, &[]);
    let (swing, teeth) = clock.go_on(10.0, 0.0, &[]);
    assert!(swing > GOES && teeth >= 18, "wound: {swing} degrees, {teeth} teeth in ten seconds");
}

/// From the flirt's fall to the first blow, s: the lever drops, the train runs up, the hammer is lifted and falls.
const TO_THE_BLOW: f64 = 0.6;
/// How far from the hour the flirt falls, s: a hundredth of a degree of the minute hand.
const PUNCTUAL: f64 = 0.1;

#[test]
fn it_strikes_eleven_at_eleven_as_if_its_strike_never_slept() {
    /// Whatever hits what, m.
    const CLOSED: f64 = 1e-9;
    let kept = in_ambient_air(TO_ELEVEN, 0.0, false);
    apart_from_awake(&kept, 0.0);
    let Kept { blows, open, .. } = kept;
    assert_eq!(blows.len(), 11, "{blows:?}");
    let first = blows[0] - 600.0;
    assert!((first - TO_THE_BLOW).abs() < PUNCTUAL, "the first blow falls {first} s after the hour");
    // The fly keeps the blows apart as evenly as the train runs.
    let gaps: Vec<f64> = blows.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let (least, most) = gaps.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), gap| (a.min(*gap), b.max(*gap)));
    assert!(least > 1.0 && most < 1.05, "blows {gaps:?} s apart");
    assert!(open < CLOSED, "joints open by {open} m");
}

/// `cargo test --no-default-features --release --test suite half_a_day -- --ignored --nocapture`
#[test]
#[ignore = "twelve hours: a quarter of an hour of the machine"]
fn in_half_a_day_it_strikes_seventy_eight_blows() {
    /// s a day.
    const DAILY: f64 = 1.0;
    let Kept { blows, beats, .. } = in_ambient_air(12.0 * 3600.0, 0.0, false);
    let hours = struck(&blows);
    println!("{hours:?}");
    assert_eq!(blows.len(), 78, "{hours:?}");
    for (hour, blows, late) in &hours {
        assert_eq!(hour, blows, "{hours:?}");
        assert!((late - TO_THE_BLOW).abs() < PUNCTUAL, "{hour} o'clock begins {late} s after the hour");
    }
    // After the first hour it swings as it will for ever.
    let whole = (beats.len() - 1 - RATE as usize) / 2 * 2;
    let rate = 3600.0 * whole as f64 / (beats[RATE as usize + whole] - beats[RATE as usize]);
    let gains = (rate / RATE - 1.0) * 86_400.0;
    println!("{rate} beats an hour: {gains:+.3} s a day");
    assert!(gains.abs() < DAILY, "{rate} beats an hour: {gains:+.2} s a day");
}

/// How far the minute hand has slipped on its arbor when the flirt has fallen, s: twenty seconds before the hour to ten after
/// it, the hand put forward by a share of a swing to and fro.
fn slip_at_the_hour(share: f64) -> f64 {
    const HOUR: f64 = 3600.0;
    /// The flirt is let down on to the pin, rad.
    const LIFTED: f64 = 0.14;
    let mut exhibit = shipped().as_ref().clone();
    let forward = -2.0 * PI * (580.0 / HOUR + share * 2.0 / RATE);
    let turns =
        [("Cannon", forward), ("MinuteWheel", -forward / 3.0), ("HourWheel", forward / 12.0), ("Flirt", LIFTED)];
    for (name, turn) in turns {
        let body = exhibit.bodies.iter_mut().find(|body| body.name == name).expect(name);
        body.pose.rotation = (rotation(DVec3::Z * turn) * body.pose.rotation).normalize();
    }
    let wire = exhibit.springs.iter_mut().find(|spring| spring.name.starts_with("flirt-wire")).expect("a wire");
    let Function::Constant(rest) = &mut wire.rest_length else { panic!("{wire:?}") };
    *rest -= LIFTED;
    let mut clock = Clock { exhibit: Arc::new(exhibit), ..Clock::new() };
    clock.dynamics = start_dynamics(&clock.exhibit, &Settings::default());
    let parts = ["Cannon", "MinuteArbor", "Flirt"].map(|name| clock.body(name));
    let slipped = |clock: &Clock| clock.angle(parts[0]).0 - clock.angle(parts[1]).0;
    let before = slipped(&clock);
    clock.run(30.0, DT);
    assert!(clock.angle(parts[2]).0.abs() < 0.1 * LIFTED, "the flirt is up");
    let way = before - slipped(&clock);
    (way / (2.0 * PI) - (way / (2.0 * PI)).round()) * HOUR
}

#[test]
fn in_whatever_beat_the_flirt_falls_the_minute_hand_keeps_its_place() {
    /// s. Where the wheel recoils just then, flirt and pin hold each other and the hand stays while its arbor goes back: by no
    /// more than the recoil.
    const RECOIL: f64 = 0.25;
    /// Of the beats in which it does not.
    const MOST: f64 = 0.6;
    let count = 16;
    let slips: Vec<f64> = (0..count).map(|k| slip_at_the_hour(f64::from(k) / f64::from(count))).collect();
    println!("{slips:.4?} s");
    assert!(slips.iter().all(|slip| slip.abs() < RECOIL), "{slips:?}");
    let still = slips.iter().filter(|slip| slip.abs() < 1e-2).count();
    assert!(still as f64 > MOST * f64::from(count), "{slips:?}");
}

/// Beats of both runs against each other, s.
fn against_fine_steps(seconds: f64, finer: f64) -> f64 {
    let (mut coarse, mut fine) = (Clock::new(), Clock::new());
    coarse.run(seconds, DT);
    fine.run(seconds, DT / finer);
    assert_eq!(coarse.beats.len(), fine.beats.len());
    let apart = coarse.beats.iter().zip(&fine.beats).map(|(one, other)| (one - other).abs());
    let worst = apart.clone().fold(0.0, f64::max);
    println!("beats {:.2e} s apart at the end, {worst:.2e} s at most", apart.clone().next_back().unwrap_or(0.0));
    worst
}

#[test]
fn beats_fall_where_a_finer_step_has_them() {
    /// s, over ten seconds: one step of 1/240 s. The forces that hold teeth stand still for a substep, so
    /// a tooth is let go a part of a substep too early or too late. Measured: 2.1 ms. The bar that is not met is
    /// `beats_fall_within_50_microseconds_of_a_finer_step`.
    const APART: f64 = DT;
    let worst = against_fine_steps(10.0, 8.0);
    assert!(worst < APART, "{worst} s apart");
}

#[test]
#[ignore = "not met: measured 2.1 ms over ten seconds, bar 0.05 ms"]
fn beats_fall_within_50_microseconds_of_a_finer_step() {
    /// s: the bar of the clock without its strike; with teeth that are held by forces it is missed.
    const APART: f64 = 5e-5;
    let worst = against_fine_steps(10.0, 8.0);
    assert!(worst < APART, "{worst} s apart");
}

/// `cargo test --no-default-features --release --test suite two_minutes_of_beats -- --ignored --nocapture`
#[test]
#[ignore = "two minutes at a sixteenth of the step: a minute of the machine"]
fn two_minutes_of_beats_fall_where_a_finer_step_has_them() {
    /// s: a step for each ten seconds, which add up at worst.
    const APART: f64 = 12.0 * DT;
    let worst = against_fine_steps(120.0, 16.0);
    assert!(worst < APART, "{worst} s apart");
}

#[test]
#[ignore = "not met: tens of milliseconds over two minutes, bar 1 ms"]
fn two_minutes_of_beats_fall_within_a_millisecond_of_a_finer_step() {
    /// s: the bar of the clock without its strike.
    const APART: f64 = 1e-3;
    let worst = against_fine_steps(120.0, 16.0);
    assert!(worst < APART, "{worst} s apart");
}

/// Where the hands point, s after twelve: the minute hand's part of an hour, and the hour hand's of its round.
fn shown(simulation: &Simulation, hand: &str, round: f64, turns_at_start: f64) -> f64 {
    let index = simulation.exhibit().bodies.iter().position(|body| body.name == hand).expect("a hand");
    let turned = simulation.bodies()[index].rotation;
    // The model's own turn is that at the start; with the sun is against z.
    (turns_at_start - atan2(turned.z, turned.w) / PI).rem_euclid(1.0) * round
}

#[test]
fn its_hands_are_carried_to_the_time_and_it_strikes_the_hour_that_is_passed() {
    /// s: the hand is let go within a second, and the escapement has its tooth.
    const ON_TIME: f64 = 3.0;
    const CLOSED: f64 = 1e-9;
    // From, to, and the blows on the way: the hands start at ten minutes to the hour.
    for (time, blows) in [("14:35", 2), ("14:52", 0), ("0:20", 12)] {
        let clock = soffio_exhibit::clock::time_of_day(time).expect("a time");
        let settings = Settings { clock: Some(clock), ..Settings::default() };
        let mut simulation = Simulation::new(shipped(), settings);
        let hammer = simulation.exhibit().bodies.iter().position(|body| body.name == "Hammer").expect("a hammer");
        let (mut struck, mut beats) = (0, 0);
        let anchor = simulation.exhibit().bodies.iter().position(|body| body.name == "Anchor").expect("an anchor");
        let mut set = None;
        for step in 0..45 * STEPS_PER_SECOND {
            simulation.step(&StepInput::default());
            let hits = || simulation.events().iter().filter(|e| e.kind == EventKind::Impact);
            struck += hits().filter(|e| e.bodies == [Some(hammer), None]).count();
            beats += hits().filter(|e| e.bodies.contains(&Some(anchor))).count();
            if simulation.is_clock_set() && set.is_none() {
                set = Some(step as f64 * DT);
            }
        }
        let now = clock + 45.0;
        let minute = shown(&simulation, "Cannon", 3600.0, 50.0 / 60.0);
        let hour = shown(&simulation, "HourWheel", 43_200.0, (10.0 + 50.0 / 60.0) / 12.0);
        let off = |shown: f64, round: f64| (shown - now + 0.5 * round).rem_euclid(round) - 0.5 * round;
        println!(
            "{time}: set after {set:?} s, {struck} blows, {beats} beats, off by {:.2} and {:.1} s",
            off(minute, 3600.0),
            off(hour, 43_200.0)
        );
        assert!(set.is_some_and(|t| t < 40.0), "{time}: set after {set:?} s");
        assert_eq!(struck, blows, "{time}");
        assert!(off(minute, 3600.0).abs() < ON_TIME, "{time}: {minute} s after the hour");
        assert!(off(hour, 43_200.0).abs() < 2.0 * ON_TIME, "{time}: {hour} s after twelve");
        assert!(beats > 70, "{time}: {beats} beats in 45 s");
        assert!(simulation.joint_error() < CLOSED, "{time}: {} m", simulation.joint_error());
    }
}
