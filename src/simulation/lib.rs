//! The simulation: everything that moves, and the only way time advances.
//!
//! One step is 1/240 s and 200 audio samples: breath → aim → wind → motion with its impacts → events and sounds →
//! dust. Whatever varies is in [`StepInput`]; nothing here reads a clock, a file or a device, so a live run and an
//! offline one with the same inputs are the same run, bit for bit.
//!
//! It never draws, plays or records: it returns a [`Snapshot`] for pictures, sound commands for a synthesizer, and events.
//! After its first steps it allocates nothing.
//!
//! | type | is |
//! |---|---|
//! | [`Simulation`] | all that moves of one exhibit |
//! | [`StepInput`] | everything that may differ between two steps: microphone, pointer, hands, commands, mode |
//! | [`Settings`] | constants of a run: seed, breath profile, wind |
//! | [`Snapshot`], [`Event`] | what a step leaves to see, and what happened in it |
//! | [`Script`] | inputs over time, one JSON object a line |
//! | [`record`] | the inputs of a live day, and their replay |
//!
//! ```
//! use std::path::Path;
//! use std::sync::Arc;
//!
//! use soffio_simulation::{Command, STEPS_PER_SECOND, Settings, Simulation, StepInput};
//!
//! let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../exhibits/pendulum");
//! let exhibit = Arc::new(soffio_exhibit::load(&folder).expect("a shipped exhibit"));
//! let run = || {
//!     let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
//!     let blow = [Command::Blow(Some(6.0))]; // m/s at the lips, from now on
//!     simulation.step(&StepInput { commands: &blow, ..StepInput::default() });
//!     (1..STEPS_PER_SECOND).for_each(|_| simulation.step(&StepInput::default()));
//!     simulation.state_hash()
//! };
//! assert_eq!(run(), run(), "the same inputs are the same run, bit for bit");
//! ```

mod aim;
mod calm;
mod carrying;
mod contact_sound;
mod event;
mod eye;
mod gather;
mod hands;
mod input;
mod inspect;
mod leaning;
mod merge;
mod motes;
mod onset;
pub mod record;
mod script;
mod snapshot;
mod sonify;
mod source;
mod start;

use std::sync::Arc;

use soffio_detector::BlowEstimate;
use soffio_exhibit::{Exhibit, View};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::Vec6;
use soffio_math::{DVec3, StateHash};
use soffio_multibody::dynamics::{Dynamics, Impact};
use soffio_multibody::procedural::{self, Method, Procedural, Reach};
use soffio_sound::SoundCommand;
use soffio_wind::breath::Breath;
use soffio_wind::force::{Blown, WindField, WindReport};
use soffio_wind::front::Front;

use aim::{Aim, AimTarget};
use calm::Idle;
use carrying::Carrying;
use contact_sound::{ContactSound, Scene};
pub use event::{Event, EventKind, Part};
use eye::Eye;
use gather::Gathering;
pub use gather::LASTS as GATHERING_LASTS;
pub use hands::Hand;
use hands::Hands;
pub use input::{CENTRE, Command, Microphone, MotionMode, Profile, Settings, StepInput};
pub use inspect::{BodyState, Inspection, JointState, Look, WindSample};
use leaning::leant_to;
use motes::Motes;
use onset::Onset;
pub use script::{Script, ScriptError};
pub use snapshot::{AimRing, BreathView, Diagnostics, Mote, Snapshot};
use sonify::{Listener, Wires};
use source::BreathSource;
use start::start_carrying;
pub use start::start_dynamics;

/// Simulation steps per second.
pub const STEPS_PER_SECOND: u64 = 240;
/// Audio samples per second of the simulation's sample clock.
pub const SAMPLE_RATE: u32 = 48_000;
/// Audio samples per step.
pub const SAMPLES_PER_STEP: u64 = SAMPLE_RATE as u64 / STEPS_PER_SECOND;
/// Seconds per step.
const DT: f64 = 1.0 / STEPS_PER_SECOND as f64;
/// Width over height of a picture nobody described.
const DEFAULT_ASPECT: f64 = 16.0 / 9.0;

/// Room for what happens in one step: more makes its list grow, once.
const LISTED: usize = 256;

/// An exhibit in motion. A clone goes on from the same moment by itself.
#[derive(Clone)]
pub struct Simulation {
    exhibit: Arc<Exhibit>,
    settings: Settings,
    step: u64,
    /// Step at which the exhibit last started.
    start_step: u64,
    source: BreathSource,
    aim: Aim,
    /// Where the breath was pointed in the last step, picture coordinates.
    pointer: [f64; 2],
    /// Surfaces that breath leans to: which each is and how it is in its body's node frame; and where they are now.
    leant_to: Vec<(usize, AimTarget)>,
    aim_targets: Vec<AimTarget>,
    idle: Idle,
    onset: Onset,
    front: Front,
    wind: WindField,
    dynamics: Dynamics,
    procedural: Procedural,
    hands: Hands,
    mode: MotionMode,
    /// While the parts gather: what calls them, and the steps that are left.
    gathering: Option<(Gathering, u64)>,
    /// While the hands of a clock are carried to the time.
    carrying: Option<Carrying>,
    motes: Motes,
    wrenches: Vec<Vec6>,
    impacts: Vec<Impact>,
    contact_sound: ContactSound,
    wires: Wires,
    events: Vec<Event>,
    sounds: Vec<SoundCommand>,
    speed: f64,
    estimate: BlowEstimate,
    report: WindReport,
    eye: Eye,
    impact_count: u64,
    fault_count: u64,
}

impl Simulation {
    /// The exhibit at rest in its start pose.
    pub fn new(exhibit: Arc<Exhibit>, settings: Settings) -> Self {
        let eye = Eye::new(&exhibit);
        let dynamics = start_dynamics(&exhibit, &settings);
        Self {
            carrying: start_carrying(&exhibit, &settings, &dynamics.bodies),
            procedural: Procedural::new(&dynamics, procedural::Settings::default()),
            dynamics,
            wind: WindField::new(
                &exhibit.wind_surfaces,
                &exhibit.shelters,
                &exhibit.winds,
                exhibit.bodies.len(),
                settings.seed,
            ),
            hands: Hands::new(&exhibit),
            mode: MotionMode::of(&exhibit),
            gathering: None,
            motes: Motes::new(eye.view.target, settings.seed),
            wrenches: vec![[0.0; 6]; exhibit.bodies.len()],
            eye,
            aim_targets: Vec::with_capacity(exhibit.wind_surfaces.len()),
            // Asking a figure how it answers wakes it: one that is not shown is asked.
            leant_to: leant_to(&exhibit, &mut start_dynamics(&exhibit, &settings)),
            contact_sound: ContactSound::new(&exhibit),
            wires: Wires::new(&exhibit),
            exhibit,
            settings,
            step: 0,
            start_step: 0,
            source: BreathSource::new(settings.sensitivity_db),
            aim: Aim::default(),
            pointer: CENTRE,
            idle: Idle::default(),
            onset: Onset::default(),
            front: Front::default(),
            impacts: Vec::with_capacity(LISTED),
            events: Vec::with_capacity(LISTED),
            sounds: Vec::with_capacity(LISTED),
            speed: 0.0,
            estimate: BlowEstimate::default(),
            report: WindReport::default(),
            impact_count: 0,
            fault_count: 0,
        }
    }

    /// The same, with the ear that `before` has listened with so far.
    pub fn listening_on(mut self, before: &mut Self) -> Self {
        self.source.listen_on(&mut before.source);
        self
    }

    /// Leaves the dust out: nobody will look at the air. It is only seen, and changes nothing that moves or sounds.
    pub fn leave_dust_out(&mut self) {
        self.motes.leave();
    }

    /// Advances by 1/240 s. The only way time moves.
    pub fn step(&mut self, input: &StepInput) {
        self.events.clear();
        self.sounds.clear();
        if (self.step - self.start_step) as f64 * DT >= self.exhibit.duration {
            self.carry_out(&[Command::Reset]);
        }
        self.carry_out(input.commands);
        if matches!(self.gathering, Some((_, 0))) {
            self.begin_anew();
        }
        (self.speed, self.estimate) = self.source.advance(input, DT);
        self.onset.advance(self.speed, DT);
        let mended = self.dynamics.mend();
        self.take_aim(input);
        self.blow();
        self.come_to_rest();
        self.impacts.clear();
        self.dynamics.breathe(self.speed);
        self.advance(input);
        self.tell(mended.or(self.dynamics.fault()));
        self.drift();
        self.step += 1;
    }

    /// Moves the figure.
    fn advance(&mut self, input: &StepInput) {
        let view = (&self.eye.view, self.eye.aspect);
        let driven = self.dynamics.system().driven();
        self.hands.follow(input.hands, view, &mut self.wind, (&self.exhibit, &self.dynamics.bodies, driven));
        self.mode = input.mode.unwrap_or(MotionMode::of(&self.exhibit));
        if let Some((gathering, left)) = &mut self.gathering {
            *left -= 1;
            self.wrenches.fill([0.0; 6]);
            gathering.call(&self.dynamics.bodies, &mut self.wrenches);
            self.dynamics.step(DT, &self.wrenches, &mut self.impacts);
            return;
        }
        let method = match self.mode {
            MotionMode::Dynamic => {
                self.hands.pull(&mut self.dynamics, DT, &mut self.wrenches);
                self.carry();
                self.dynamics.step(DT, &self.wrenches, &mut self.impacts);
                return;
            }
            MotionMode::Procedural => Method::Compulsive,
            MotionMode::PositionBased => Method::TreeSolve,
        };
        self.procedural.settings_mut().method = method;
        let grips = self.hands.grips(&self.dynamics.bodies, DT);
        self.procedural.step(&mut self.dynamics, DT, &self.wrenches, grips, &mut self.impacts);
    }

    /// Carries the hands of a clock on.
    fn carry(&mut self) {
        let elapsed = (self.step - self.start_step) as f64 * DT;
        if let (Some(carrying), Some(clock)) = (&mut self.carrying, &self.exhibit.clock)
            && !carrying.carry(clock, (elapsed, DT), &mut self.dynamics, &mut self.wrenches)
        {
            self.carrying = None;
        }
    }

    /// Are the hands of a clock being carried to the time?
    pub fn is_set(&self) -> bool {
        self.carrying.is_none()
    }

    /// How the last step that moved the figure by places ended.
    pub fn reach(&self) -> Reach {
        self.procedural.reach()
    }

    fn carry_out(&mut self, commands: &[Command]) {
        for command in commands {
            match *command {
                Command::Reset => self.reset(),
                Command::Gather(seed) => self.gather(seed),
                Command::Calm => self.idle.hush(),
                Command::Blow(speed) => self.source.command(speed),
            }
        }
    }

    /// Turns the breath into forces.
    fn blow(&mut self) {
        self.wrenches.fill([0.0; 6]);
        self.report = WindReport::default();
        if !self.settings.wind {
            return;
        }
        self.front.advance(self.speed, DT);
        let time = (self.step - self.start_step) as f64 * DT;
        let mut blown = blown(&self.exhibit, &self.settings, &self.aim, &self.front, self.speed);
        if let Some(blown) = &mut blown
            && self.settings.profile == Profile::Gallery
        {
            blown.gain *= self.onset.gain();
        }
        self.report = self.wind.push(&self.dynamics.bodies, time, blown.as_ref(), &mut self.wrenches);
    }

    /// Calms what nobody blows at or holds, in the gallery.
    fn come_to_rest(&mut self) {
        self.idle.advance(self.speed > 0.0 || self.hands.count() > 0, DT);
        let Settings { profile, friction, .. } = self.settings;
        let calm = self.exhibit.calm.filter(|_| profile == Profile::Gallery && friction);
        if let Some(calm) = calm {
            self.idle.calm(calm, &self.dynamics.bodies, &mut self.wrenches);
        }
    }

    /// Turns what happened into events and sounds.
    fn tell(&mut self, fault: Option<usize>) {
        let listener = Listener::new(&self.eye.view);
        let began = self.step as f64 * DT;
        let (exhibit, bodies) = (&*self.exhibit, &self.dynamics.bodies);
        let scene = Scene { exhibit, bodies, listener: &listener };
        for impact in &self.impacts {
            let event = Event::hit(began, impact);
            if event.kind == EventKind::Impact {
                self.impact_count += 1;
            }
            self.contact_sound.hit(impact, event.sample, &scene, &mut self.sounds);
            enter(&mut self.events, event);
        }
        let sample = (self.step + 1) * SAMPLES_PER_STEP;
        self.contact_sound.advance(sample, self.dynamics.touching(), &scene, &mut self.sounds);
        // The figure's own clock starts anew with a reset, and rounds.
        let offset = began - (self.dynamics.time() - DT);
        let mut part =
            |t: f64, kind, part| enter(&mut self.events, Event::of_part(offset + t, kind, part, exhibit, bodies));
        let (fired, springs_fired) = (self.dynamics.fired(), self.dynamics.springs_fired());
        fired.iter().for_each(|&(index, t)| part(t, EventKind::Trigger, Part::Constraint(index)));
        springs_fired.iter().for_each(|&(index, t)| part(t, EventKind::Trigger, Part::Spring(index)));
        let (breaks, spring_breaks) = (self.dynamics.breaks(), self.dynamics.spring_breaks());
        breaks.iter().for_each(|b| part(b.time, EventKind::Break, Part::Constraint(b.index)));
        spring_breaks.iter().for_each(|b| part(b.time, EventKind::Break, Part::Spring(b.index)));
        if let Some(body) = fault {
            self.fault_count += 1;
            enter(&mut self.events, Event::fault(began, body, bodies));
        }
        let blown = blown(&self.exhibit, &self.settings, &self.aim, &self.front, self.speed);
        // What is heard is the wind the sculpture feels: a gain on the force is its root on the speed.
        let air = blown.map_or(DVec3::ZERO, |blown| blown.gain.sqrt() * self.wind.breath_at(&blown, self.aim.target));
        self.wires.turn((sample, air), exhibit, bodies, &mut self.sounds);
        self.sounds.push(sonify::wind(sample, air, self.report.gust, self.aim.target, &listener));
    }

    /// Lets the dust drift.
    fn drift(&mut self) {
        let blown = blown(&self.exhibit, &self.settings, &self.aim, &self.front, self.speed);
        let breath = blown.as_ref().map(|blown| &blown.breath).filter(|breath| breath.speed > 0.0);
        let streams = |point| self.wind.streams(blown.as_ref(), point);
        self.motes.advance(breath, streams, |point| self.wind.stirs(point), DT);
    }

    /// Events of the last step, in time order.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Sounds of the last step; sample times count from the start of the run at [`SAMPLE_RATE`].
    pub fn sounds(&self) -> &[SoundCommand] {
        &self.sounds
    }

    /// The exhibit.
    pub fn exhibit(&self) -> &Arc<Exhibit> {
        &self.exhibit
    }

    /// The settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Steps done.
    pub fn steps(&self) -> u64 {
        self.step
    }

    /// The bodies' present state, in the order of the exhibit's bodies.
    pub fn bodies(&self) -> &[RigidBody] {
        &self.dynamics.bodies
    }

    /// Would a hand at this place of the picture take something?
    pub fn can_be_taken(&mut self, at: [f64; 2], aspect: f64) -> bool {
        let aspect = if aspect > 0.0 { aspect } else { DEFAULT_ASPECT };
        let view = self.view(aspect);
        let driven = self.dynamics.system().driven();
        self.hands.would_take(at, (&view, aspect), &mut self.wind, (&self.exhibit, &self.dynamics.bodies, driven))
    }

    /// Does a body sleep: at rest, and left out until something touches or pushes it?
    pub fn sleeps(&self, body: usize) -> bool {
        self.dynamics.sleeps(body)
    }

    /// The bodies' state, for tests that push a sculpture by hand.
    pub fn bodies_mut(&mut self) -> &mut [RigidBody] {
        self.dynamics.disturb();
        &mut self.dynamics.bodies
    }

    /// Largest distance between the two points of any joint now, m.
    pub fn joint_error(&self) -> f64 {
        self.dynamics.joint_error()
    }

    /// Kinetic and potential energy, J.
    pub fn energy(&self) -> f64 {
        self.dynamics.energy()
    }

    /// The camera for a picture of this aspect (width / height), turned as the last step was told.
    pub fn view(&self, aspect: f64) -> View {
        self.exhibit.view(aspect).turned(self.eye.turn)
    }

    /// The camera of the last step.
    pub fn sight(&self) -> &View {
        &self.eye.view
    }

    /// One word that says whether two runs are the same run.
    pub fn state_hash(&self) -> u64 {
        let mut hash = StateHash::default();
        hash.add(self.step as f64);
        hash.add(self.speed);
        for body in &self.dynamics.bodies {
            body.add_to(&mut hash);
        }
        hash.0
    }
}

/// Adds an event in its place in time.
fn enter(events: &mut Vec<Event>, event: Event) {
    let place = events.partition_point(|earlier| earlier.t <= event.t);
    events.insert(place, event);
}

/// The breath as it is pointed now.
fn breath(exhibit: &Exhibit, settings: &Settings, aim: &Aim, speed: f64) -> Breath {
    let tuning = &exhibit.breath;
    Breath {
        mouth: aim.mouth,
        direction: aim.direction,
        lip_diameter: tuning.lip_diameter.unwrap_or(settings.lip_diameter),
        speed,
        law: tuning.law,
    }
}

/// What the breath does in this step; `None` where no air of one is anywhere, or wind is off.
fn blown<'a>(exhibit: &Exhibit, settings: &Settings, aim: &Aim, front: &'a Front, speed: f64) -> Option<Blown<'a>> {
    let front = match settings.profile {
        Profile::Gallery => None,
        Profile::True => Some(front),
    };
    let gain = exhibit.breath.gain * settings.breath_gain * settings.profile.gain(speed);
    let blows = speed > 0.0 || front.is_some_and(Front::in_flight);
    (blows && settings.wind).then(|| Blown { breath: breath(exhibit, settings, aim, speed), front, gain })
}
