//! One step of the simulation, stage by stage.

use std::sync::Arc;

use super::aim_assist::{AimAssist, AimContext};
use super::air::{AimedBreath, Air, BreathTiming};
use super::camera::{Camera, DEFAULT_ASPECT};
use super::charts::Charts;
use super::dust_particles::{AirVelocity, DustParticles};
use super::emit::{Emitter, StepResult};
use super::event::Event;
use super::input::{Command, Settings, StepInput};
use super::motion::Motion;
use super::pointer_grabs::PickScene;
use super::rate::{DT, SAMPLES_PER_STEP};
use super::signals::Signals;
use super::source::BreathState;
use super::start::start_dynamics;
use soffio_detector::AmbientSpread;
use soffio_exhibit::{Exhibit, View};
use soffio_geometry::bodies::RigidBody;
use soffio_math::StateHash;
use soffio_multibody::dynamics::ContactReport;
use soffio_multibody::procedural::SolveReport;
use soffio_sound::SoundCommand;

/// Step counters of a run.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StepClock {
    /// Steps done.
    pub step: u64,
    /// Step at which the exhibit last started.
    start: u64,
}

impl StepClock {
    /// Since the exhibit started, s.
    fn elapsed(&self) -> f64 {
        (self.step - self.start) as f64 * DT
    }
}

/// An exhibit in motion. A clone continues independently from the same moment.
#[derive(Clone)]
pub struct Simulation {
    pub(crate) exhibit: Arc<Exhibit>,
    pub(crate) settings: Settings,
    pub(crate) clock: StepClock,
    pub(crate) camera: Camera,
    pub(crate) breath: BreathState,
    pub(crate) aim_assist: AimAssist,
    pub(crate) air: Air,
    pub(crate) motion: Motion,
    pub(crate) signals: Signals,
    pub(crate) charts: Charts,
    pub(crate) emitter: Emitter,
    pub(crate) dust_particles: DustParticles,
}

impl Simulation {
    /// The exhibit at rest in its start pose.
    pub fn new(exhibit: Arc<Exhibit>, settings: Settings) -> Self {
        let camera = Camera::new(&exhibit);
        let air = Air::new(&exhibit, settings.seed);
        Self {
            clock: StepClock::default(),
            breath: BreathState::new(settings.detector()),
            aim_assist: AimAssist::new(&exhibit, &mut start_dynamics(&exhibit, &settings)),
            motion: Motion::new(&exhibit, &settings),
            emitter: Emitter::new(&exhibit, &air),
            air,
            signals: Signals::new(&exhibit),
            charts: Charts::new(&exhibit),
            dust_particles: DustParticles::new(camera.view.target, settings.seed),
            camera,
            exhibit,
            settings,
        }
    }

    /// This simulation with the detector of `before`, which has adapted to the noise floor.
    pub fn adopt_detector(mut self, before: &mut Self) -> Self {
        self.breath.adopt_detector(&mut before.breath);
        self
    }

    /// What the breath detector knows of the room; `None` where there was no microphone yet.
    pub fn ambient_spread(&self) -> Option<AmbientSpread> {
        self.breath.ambient_spread()
    }

    /// Lets the breath detector begin with what an earlier run knew of the room.
    pub fn recall(&mut self, ambient_spread: AmbientSpread) {
        self.breath.recall(ambient_spread);
    }

    /// Removes the dust particles where no picture is drawn. They change neither motion nor sound.
    pub fn disable_dust(&mut self) {
        self.dust_particles.clear();
    }

    /// Advances by 1/240 s. Time advances in no other way.
    ///
    /// A step does not allocate, with three exceptions:
    ///
    /// - The exhibit restarts: at [`Command::Reset`] and [`Command::Assemble`], at the end of the exhibit's duration, and at the
    ///   end of an assembly. The dynamics are then built again.
    /// - A microphone appears after a step without one, or its sample rate changes: the breath detector is built again.
    /// - More events, sounds or impacts happen than in any step of the run before: their lists grow.
    pub fn step(&mut self, input: &StepInput) {
        self.emitter.clear();
        if self.clock.elapsed() >= self.exhibit.duration {
            self.reset();
        }
        self.run_commands(input.commands);
        if self.motion.is_assembled() {
            self.restart();
        }
        self.breath.advance(input);
        // Bodies may have been set from outside ([`Self::bodies_mut`]); wind and grabs must not see invalid numbers.
        let set_invalid = self.motion.dynamics.recover();
        self.update_aim(input);
        self.apply_wind();
        self.motion.apply_idle_damping(&self.exhibit, &self.settings, self.breath.speed > 0.0);
        self.motion.set_breath_speed(self.breath.speed);
        self.compute_signals();
        let elapsed = self.clock.elapsed();
        let became_invalid = self.motion.advance(input, &self.exhibit, elapsed, &self.camera, &mut self.air.wind);
        self.charts.advance(&self.exhibit.charts, &self.motion);
        self.emit_events_and_sounds(set_invalid.or(became_invalid));
        self.advect_particles();
        self.clock.step += 1;
    }

    fn run_commands(&mut self, commands: &[Command]) {
        for command in commands {
            match *command {
                Command::Reset => self.reset(),
                Command::Assemble(seed) => self.assemble(seed),
                Command::Settle => self.motion.idle_damping.settle(),
                Command::Blow(speed) => self.breath.command(speed),
            }
        }
    }

    /// Restarts the exhibit, with silence and still air.
    fn reset(&mut self) {
        self.restart();
        self.air.jet_front.clear();
        self.motion.pointer_grabs.clear();
        self.emitter.silence(self.clock.step * SAMPLES_PER_STEP);
    }

    /// Resets the exhibit and starts its assembly animation, if it has one.
    fn assemble(&mut self, seed: u64) {
        self.reset();
        if self.exhibit.assembles {
            self.motion.assemble(&self.exhibit, &self.settings_now(), seed);
        }
    }

    /// Returns the motion to its start, at time 0.
    fn restart(&mut self) {
        self.motion.restart(&self.exhibit, &self.settings_now());
        self.signals = Signals::new(&self.exhibit);
        self.charts = Charts::new(&self.exhibit);
        self.clock.start = self.clock.step;
    }

    /// The settings with the present time of day.
    fn settings_now(&self) -> Settings {
        let now = |midnight: f64| midnight + self.clock.step as f64 * DT;
        Settings { clock: self.settings.clock.map(now), ..self.settings }
    }

    /// Updates the camera and aims the breath.
    fn update_aim(&mut self, input: &StepInput) {
        let Self { exhibit, settings, clock, camera, breath, aim_assist, air, motion, .. } = self;
        camera.update(exhibit, input.aspect, input.turn);
        let context =
            AimContext { exhibit, settings, camera, breath, bodies: &motion.dynamics.bodies, step: clock.step };
        aim_assist.update(input, &context, &mut air.wind);
    }

    /// Sets the wrenches on the bodies to those of breath and winds.
    fn apply_wind(&mut self) {
        let Self { exhibit, settings, clock, breath, aim_assist, air, motion, .. } = self;
        let aimed = AimedBreath { exhibit, settings, aim: &aim_assist.aim, speed: breath.speed };
        let timing = BreathTiming { onset: &breath.onset, time: clock.elapsed() };
        air.apply_wind(aimed, timing, &motion.dynamics.bodies, &mut motion.wrenches);
    }

    /// Computes the signals, and gives them to the springs that follow them.
    fn compute_signals(&mut self) {
        let Self { exhibit, settings, clock, breath, aim_assist, air, motion, signals, .. } = self;
        if exhibit.signals.is_empty() {
            return;
        }
        let aimed = AimedBreath { exhibit, settings, aim: &aim_assist.aim, speed: breath.speed };
        let jet = aimed.jet(&air.jet_front);
        let velocity = |point| air.wind.directed_velocity(jet.as_ref(), point) + air.wind.undirected_velocity(point);
        signals.advance(&exhibit.signals, (clock.elapsed(), breath.speed), velocity, motion);
    }

    /// Emits the events and sounds of the step; `fault`: the first body with invalid numbers.
    fn emit_events_and_sounds(&mut self, fault: Option<usize>) {
        let Self { exhibit, settings, clock, camera, breath, aim_assist, air, motion, emitter, .. } = self;
        let aimed = AimedBreath { exhibit, settings, aim: &aim_assist.aim, speed: breath.speed };
        let result = StepResult { motion, impacts: &motion.impacts, fault, air, breath: aimed };
        emitter.emit(clock.step, &camera.view, result);
    }

    /// Advects the dust particles.
    fn advect_particles(&mut self) {
        let Self { exhibit, settings, breath, aim_assist, air, dust_particles, .. } = self;
        let aimed = AimedBreath { exhibit, settings, aim: &aim_assist.aim, speed: breath.speed };
        let jet = aimed.jet(&air.jet_front);
        let breath = jet.as_ref().map(|jet| &jet.breath).filter(|breath| breath.speed > 0.0);
        let velocity = AirVelocity {
            directed: |point| air.wind.directed_velocity(jet.as_ref(), point),
            undirected: |point| air.wind.undirected_velocity(point),
        };
        dust_particles.advect(breath, velocity, DT);
    }

    /// The breath with its present aim.
    pub(crate) fn aimed_breath(&self) -> AimedBreath<'_> {
        let Self { exhibit, settings, breath, aim_assist, .. } = self;
        AimedBreath { exhibit, settings, aim: &aim_assist.aim, speed: breath.speed }
    }

    /// Greatest distance of a body from its final position, m, during the assembly animation; `None` otherwise.
    pub fn assembly_distance(&self) -> Option<f64> {
        self.motion.assembly_distance()
    }

    /// Whether the exhibit's clock, if any, has been set to the time of day.
    pub fn is_clock_set(&self) -> bool {
        self.motion.clock_setting.is_none()
    }

    /// Result of the last step of position-based motion.
    pub fn last_position_solve(&self) -> SolveReport {
        self.motion.procedural.report()
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

    /// Whether a pointer at this place of the picture (picture coordinates; `aspect`: width over height) would grab a body.
    pub fn hit_test(&mut self, at: [f64; 2], aspect: f64) -> bool {
        let aspect = if aspect > 0.0 { aspect } else { DEFAULT_ASPECT };
        let scene = PickScene {
            view: &self.view(aspect),
            aspect,
            exhibit: &self.exhibit,
            bodies: &self.motion.dynamics.bodies,
            is_kinematic: &self.motion.is_kinematic,
        };
        self.motion.pointer_grabs.hit_test(at, &mut self.air.wind, &scene)
    }

    /// Whether a body is asleep: at rest, and skipped until a contact or force wakes it.
    pub fn sleeps(&self, body: usize) -> bool {
        self.motion.of_body(body).is_asleep(body)
    }

    /// The bodies' state, for tests that change it from outside; wakes them.
    pub fn bodies_mut(&mut self) -> &mut [RigidBody] {
        self.motion.dynamics.disturb();
        &mut self.motion.dynamics.bodies
    }

    /// Contacts with a normal force at the end of the last step.
    pub fn touching(&self) -> impl Iterator<Item = ContactReport> + '_ {
        self.motion.kinds().flat_map(|dynamics| dynamics.contact_reports())
    }

    /// Largest distance between the two points of any joint now, m.
    pub fn joint_error(&self) -> f64 {
        self.motion.joint_error()
    }

    /// Kinetic and potential energy, J.
    pub fn energy(&self) -> f64 {
        self.motion.dynamics.energy()
    }

    /// Value of a signal in the last step; `None` where the exhibit has none of this name.
    pub fn signal(&self, name: &str) -> Option<f64> {
        let index = self.exhibit.signals.iter().position(|signal| signal.name == name)?;
        Some(self.signals.value(index))
    }

    /// The view for a picture of this aspect (width over height), turned as in the last step.
    pub fn view(&self, aspect: f64) -> View {
        self.exhibit.view(aspect).orbited(self.camera.turn)
    }

    /// The view of the last step.
    pub fn current_view(&self) -> &View {
        &self.camera.view
    }

    /// Hash of the state: equal for equal runs.
    pub fn state_hash(&self) -> u64 {
        let mut hash = StateHash::default();
        hash.add(self.clock.step as f64);
        hash.add(self.breath.speed);
        for body in &self.motion.dynamics.bodies {
            body.add_to(&mut hash);
        }
        hash.0
    }
}
