//! One step of the simulation, stage by stage.

use std::sync::Arc;

use super::air::{Air, Pointed};
use super::emit::Emitter;
use super::event::Event;
use super::eye::{DEFAULT_ASPECT, Eye};
use super::input::{Command, Settings, StepInput};
use super::leaning::{Aiming, Scene};
use super::motes::Motes;
use super::motion::Motion;
use super::rate::{DT, SAMPLES_PER_STEP};
use super::source::Breathing;
use super::start::start_dynamics;
use soffio_exhibit::{Exhibit, View};
use soffio_geometry::bodies::RigidBody;
use soffio_math::StateHash;
use soffio_multibody::dynamics::ContactReport;
use soffio_multibody::procedural::Reach;
use soffio_sound::SoundCommand;

/// Steps of a run.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Clock {
    /// Steps done.
    pub step: u64,
    /// Step at which the exhibit last started.
    start: u64,
}

impl Clock {
    /// Since the exhibit started, s.
    fn elapsed(&self) -> f64 {
        (self.step - self.start) as f64 * DT
    }
}

/// An exhibit in motion. A clone goes on from the same moment by itself.
#[derive(Clone)]
pub struct Simulation {
    pub(crate) exhibit: Arc<Exhibit>,
    pub(crate) settings: Settings,
    pub(crate) clock: Clock,
    pub(crate) eye: Eye,
    pub(crate) breathing: Breathing,
    pub(crate) aiming: Aiming,
    pub(crate) air: Air,
    pub(crate) motion: Motion,
    pub(crate) emitter: Emitter,
    pub(crate) motes: Motes,
}

impl Simulation {
    /// The exhibit at rest in its start pose.
    pub fn new(exhibit: Arc<Exhibit>, settings: Settings) -> Self {
        let eye = Eye::new(&exhibit);
        Self {
            clock: Clock::default(),
            breathing: Breathing::new(settings.sensitivity_db),
            aiming: Aiming::new(&exhibit, &mut start_dynamics(&exhibit, &settings)),
            air: Air::new(&exhibit, settings.seed),
            motion: Motion::new(&exhibit, &settings),
            emitter: Emitter::new(&exhibit),
            motes: Motes::new(eye.view.target, settings.seed),
            eye,
            exhibit,
            settings,
        }
    }

    /// The same, with the ear that `before` has listened with so far.
    pub fn listening_on(mut self, before: &mut Self) -> Self {
        self.breathing.listen_on(&mut before.breathing);
        self
    }

    /// Leaves the dust out: nobody will look at the air. It is only seen, and changes nothing that moves or sounds.
    pub fn leave_dust_out(&mut self) {
        self.motes.leave();
    }

    /// Advances by 1/240 s. The only way time moves.
    ///
    /// A step allocates nothing, but for three kinds of steps:
    ///
    /// - Those in which the exhibit starts anew: at [`Command::Reset`] and [`Command::Gather`], when the exhibit's duration is
    ///   over, and when gathering parts have come together. The figure is then built again in new memory, and the old one freed.
    /// - Those that bring a microphone after a step without, or one of another sample rate: the breath detector is built.
    /// - Those in which more happens than ever before in the run: lists of events, sounds and impacts grow.
    pub fn step(&mut self, input: &StepInput) {
        self.emitter.clear();
        if self.clock.elapsed() >= self.exhibit.duration {
            self.reset();
        }
        self.carry_out(input.commands);
        if self.motion.has_gathered() {
            self.begin_anew();
        }
        self.breathing.advance(input);
        // Whoever set bodies may have set them wrong; air and hands are not to see that.
        let set_wrong = self.motion.dynamics.recover();
        self.take_aim(input);
        self.blow();
        self.motion.come_to_rest(&self.exhibit, &self.settings, self.breathing.speed > 0.0);
        self.motion.dynamics.set_breath_speed(self.breathing.speed);
        let elapsed = self.clock.elapsed();
        let gone_wrong = self.motion.advance(input, (&self.exhibit, elapsed), &self.eye, &mut self.air.wind);
        self.tell(set_wrong.or(gone_wrong));
        self.drift();
        self.clock.step += 1;
    }

    fn carry_out(&mut self, commands: &[Command]) {
        for command in commands {
            match *command {
                Command::Reset => self.reset(),
                Command::Gather(seed) => self.gather(seed),
                Command::Calm => self.motion.idle.hush(),
                Command::Blow(speed) => self.breathing.command(speed),
            }
        }
    }

    /// Starts the exhibit anew, in silence.
    fn reset(&mut self) {
        self.begin_anew();
        self.air.front.clear();
        self.motion.hands.clear();
        self.emitter.silence(self.clock.step * SAMPLES_PER_STEP);
    }

    /// Starts the exhibit anew from scattered parts, if it gathers itself.
    fn gather(&mut self, seed: u64) {
        self.reset();
        if self.exhibit.gathers {
            self.motion.gather(&self.exhibit, &self.settings_now(), seed);
        }
    }

    /// Puts the figure where it starts; its time begins.
    fn begin_anew(&mut self) {
        self.motion.begin_anew(&self.exhibit, &self.settings_now());
        self.clock.start = self.clock.step;
    }

    /// The settings of a run that begins now: the day has gone on.
    fn settings_now(&self) -> Settings {
        let now = |midnight: f64| midnight + self.clock.step as f64 * DT;
        Settings { clock: self.settings.clock.map(now), ..self.settings }
    }

    /// Points the breath.
    fn take_aim(&mut self, input: &StepInput) {
        let Self { exhibit, settings, clock, eye, breathing, aiming, air, motion, .. } = self;
        eye.look(exhibit, input.aspect, input.turn);
        let bodies = &motion.dynamics.bodies;
        aiming.point(input, &Scene { exhibit, settings, eye, breathing, bodies, step: clock.step }, &mut air.wind);
    }

    /// Turns the breath into forces.
    fn blow(&mut self) {
        let Self { exhibit, settings, clock, breathing, aiming, air, motion, .. } = self;
        let pointed = Pointed { exhibit, settings, aim: &aiming.aim, speed: breathing.speed };
        let now = (&breathing.onset, clock.elapsed());
        air.blow(pointed, now, &motion.dynamics.bodies, &mut motion.wrenches);
    }

    /// Turns what happened into events and sounds.
    fn tell(&mut self, fault: Option<usize>) {
        let Self { exhibit, settings, clock, eye, breathing, aiming, air, motion, emitter, .. } = self;
        let pointed = Pointed { exhibit, settings, aim: &aiming.aim, speed: breathing.speed };
        emitter.emit((clock.step, &eye.view), (&motion.dynamics, &motion.impacts, fault), (air, pointed));
    }

    /// Lets the dust drift.
    fn drift(&mut self) {
        let Self { exhibit, settings, breathing, aiming, air, motes, .. } = self;
        let blown = Pointed { exhibit, settings, aim: &aiming.aim, speed: breathing.speed }.blown(&air.front);
        let breath = blown.as_ref().map(|blown| &blown.breath).filter(|breath| breath.speed > 0.0);
        let streams = |point| air.wind.streams(blown.as_ref(), point);
        motes.advance(breath, streams, |point| air.wind.stirs(point), DT);
    }

    /// The breath as it is pointed now.
    pub(crate) fn pointed(&self) -> Pointed<'_> {
        let Self { exhibit, settings, breathing, aiming, .. } = self;
        Pointed { exhibit, settings, aim: &aiming.aim, speed: breathing.speed }
    }

    /// While its parts gather: how far the farthest is from its place, m.
    pub fn gathers_from(&self) -> Option<f64> {
        self.motion.gathers_from()
    }

    /// Are the hands of a clock being carried to the time?
    pub fn is_set(&self) -> bool {
        self.motion.carrying.is_none()
    }

    /// How the last step that moved the figure by places ended.
    pub fn reach(&self) -> Reach {
        self.motion.procedural.reach()
    }

    /// Events of the last step, in time order.
    pub fn events(&self) -> &[Event] {
        &self.emitter.events
    }

    /// Sounds of the last step; sample times count from the start of the run at [`SAMPLE_RATE`](crate::SAMPLE_RATE).
    pub fn sounds(&self) -> &[SoundCommand] {
        &self.emitter.sounds
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
        self.clock.step
    }

    /// The bodies' present state, in the order of the exhibit's bodies.
    pub fn bodies(&self) -> &[RigidBody] {
        &self.motion.dynamics.bodies
    }

    /// Would a hand at this place of the picture take something?
    pub fn can_be_taken(&mut self, at: [f64; 2], aspect: f64) -> bool {
        let aspect = if aspect > 0.0 { aspect } else { DEFAULT_ASPECT };
        let view = self.view(aspect);
        let driven = self.motion.dynamics.system().driven();
        self.motion.hands.would_take(
            at,
            (&view, aspect),
            &mut self.air.wind,
            (&self.exhibit, &self.motion.dynamics.bodies, driven),
        )
    }

    /// Does a body sleep: at rest, and left out until something touches or pushes it?
    pub fn sleeps(&self, body: usize) -> bool {
        self.motion.dynamics.is_asleep(body)
    }

    /// The bodies' state, for tests that push a sculpture by hand.
    pub fn bodies_mut(&mut self) -> &mut [RigidBody] {
        self.motion.dynamics.disturb();
        &mut self.motion.dynamics.bodies
    }

    /// Surfaces that press on each other at the end of the last step.
    pub fn touching(&self) -> impl Iterator<Item = ContactReport> + '_ {
        self.motion.dynamics.contact_reports()
    }

    /// Largest distance between the two points of any joint now, m.
    pub fn joint_error(&self) -> f64 {
        self.motion.dynamics.joint_error()
    }

    /// Kinetic and potential energy, J.
    pub fn energy(&self) -> f64 {
        self.motion.dynamics.energy()
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
        hash.add(self.clock.step as f64);
        hash.add(self.breathing.speed);
        for body in &self.motion.dynamics.bodies {
            body.add_to(&mut hash);
        }
        hash.0
    }
}
