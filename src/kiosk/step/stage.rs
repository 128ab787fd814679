//! The kiosk's simulation step, without a clock, a window or a device: selects the source of the breath (visitor, recording or
//! attract script), and moves the exhibit.
//!
//! Invariant: with a recording, no visitor and no attract mode the run is bit-identical to `soffio play` with the
//! same recording, exhibit, settings and picture shape; both feed the steps through [`WavFeed`].

use std::sync::Arc;

use soffio_detector::AmbientSpread;
use soffio_exhibit::{Exhibit, OrbitLimits, View};
use soffio_geometry::bodies::RigidBody;
use soffio_offline::feed::WavFeed;
use soffio_simulation::{
    Command, Inspection, InspectionScope, Microphone, MotionMode, SAMPLES_PER_STEP, STEPS_PER_SECOND, Settings,
    Simulation, Snapshot, StepInput,
};
use soffio_sound::SoundCommand;

use crate::attract::script::AttractMode;
use crate::step::controls::Controls;
use crate::step::pointing::Pointing;
use crate::visitor::gesture::{Gestures, Lift, PressInput};
use crate::visitor::orbit::{self, Orbit, OrbitInput};

/// Inputs of a step for a record, except breath and grabs.
#[derive(Clone, Debug, Default)]
struct RecordedInput {
    pointer: Option<[f64; 2]>,
    aspect: f64,
    turn: [f64; 2],
    mode: Option<MotionMode>,
    commands: Vec<Command>,
}

/// Factor on the breaths of the attract script with reduced motion.
const GENTLER: f64 = 0.5;

/// The exhibit on show. A clone continues independently from the same state.
#[derive(Clone)]
pub struct Stage {
    simulation: Simulation,
    steps: u64,
    recording: Option<WavFeed>,
    attract: Option<AttractMode>,
    idle_s: f64,
    activity: u64,
    pointing: Pointing,
    gestures: Gestures,
    orbit: Orbit,
    /// Limits of the orbit camera for a picture of this shape; `None` until it is needed.
    leeway: Option<(f64, OrbitLimits)>,
    holds: bool,
    /// Inputs of the last step, except breath and grabs.
    recorded: RecordedInput,
    reduced_motion: bool,
    /// Command before the next step: the assembly animation of another exhibit.
    pending_command: Option<Command>,
    /// Presses that have come up, and commands, for the next step alone.
    lifts: Vec<Lift>,
    commands: Vec<Command>,
    snapshot: Snapshot,
}

impl Stage {
    /// The exhibit at rest. `recording` replaces the microphone. `idle_s` is the time without a visitor until attract mode, s;
    /// `None` switches it off.
    pub fn new(exhibit: Arc<Exhibit>, settings: Settings, recording: Option<WavFeed>, idle_s: Option<f64>) -> Self {
        let attract = idle_s.map(|idle| AttractMode::new(exhibit.attract.clone(), idle));
        let simulation = Simulation::new(exhibit, settings);
        let snapshot = simulation.snapshot();
        Self {
            simulation,
            steps: 0,
            recording,
            attract,
            idle_s: idle_s.unwrap_or_default(),
            activity: 0,
            pointing: Pointing::default(),
            gestures: Gestures::default(),
            orbit: Orbit::default(),
            leeway: None,
            holds: false,
            recorded: RecordedInput::default(),
            reduced_motion: false,
            pending_command: None,
            lifts: Vec::new(),
            commands: Vec::new(),
            snapshot,
        }
    }

    /// What the breath detector knows of the room; `None` where there was no microphone yet.
    pub fn ambient_spread(&self) -> Option<AmbientSpread> {
        self.simulation.ambient_spread()
    }

    /// Lets the breath detector begin with what an earlier run knew of the room.
    pub fn recall(&mut self, ambient_spread: AmbientSpread) {
        self.simulation.recall(ambient_spread);
    }

    /// Adds a press that has come up, for the next step.
    pub fn lift(&mut self, lift: Lift) {
        self.lifts.push(lift);
    }

    /// Adds a command for the next step; it is applied after those of the attract script.
    pub fn command(&mut self, command: Command) {
        self.commands.push(command);
    }

    /// Advances by one step. `microphone` holds the samples since the last step; a recording takes precedence.
    pub fn step(&mut self, controls: &Controls, microphone: Option<Microphone>) {
        let nobody = controls.inert.then(|| controls.without_visitor());
        let controls = nobody.as_ref().unwrap_or(controls);
        let mut lifts = std::mem::take(&mut self.lifts);
        if controls.inert {
            lifts.clear();
        }
        // The estimate of the step before: a breath is an input like any other.
        let breathing = self.snapshot.breath.estimate.speed > 0.0;
        let pressed = controls.hold || !controls.presses.is_empty() || !lifts.is_empty();
        self.reduced_motion = controls.reduced_motion;
        // Attract mode waits while the screen is cleaned.
        let visitor = breathing || pressed || controls.inert || controls.activity != self.activity;
        self.activity = controls.activity;
        let fastest = |fastest: f64, body: &RigidBody| fastest.max(body.velocity.length());
        let moves = self.simulation.bodies().iter().fold(0.0, fastest);
        let mut cue = self.attract.as_mut().map(|attract| attract.step(visitor, moves)).unwrap_or_default();
        if self.reduced_motion {
            cue.commands.iter_mut().for_each(gentler);
        }
        cue.commands.append(&mut self.commands);
        // A breath, a press, or reduced motion ends the assembly animation.
        let impatient = (breathing || pressed || self.reduced_motion) && self.simulation.assembly_distance().is_some();
        cue.commands.extend(self.pending_command.take().or(impatient.then_some(Command::Reset)));
        let simulation = &mut self.simulation;
        let takeable = |at| simulation.hit_test(at, controls.aspect);
        let press_input = PressInput {
            presses: &controls.presses,
            lifts: &lifts,
            hold: controls.hold,
            keyed: controls.keyed,
            press_once: controls.press_once,
            look_around: controls.look_around,
            aspect: controls.aspect,
        };
        let blows = self.gestures.step(&press_input, takeable);
        lifts.clear();
        self.lifts = lifts;
        // While looking around, the stick turns the camera and the aim stays.
        let stick = if controls.look_around { [0.0; 2] } else { controls.stick };
        let aim = self.pointing.step(controls, stick);
        if cue.active {
            self.pointing.forget();
            self.gestures.unlatch();
        }
        self.holds = controls.hold && !controls.press_once || blows.is_some() || self.gestures.latched();

        // With reduced motion the script does not move the camera.
        let led = cue.look.filter(|_| !self.reduced_motion).map_or(OrbitInput::Home, OrbitInput::Scripted);
        let turn =
            self.turn(controls, if cue.active || !controls.look_around { led } else { self.visitor_orbit(controls) });
        self.recorded = RecordedInput {
            pointer: if cue.active { cue.aim } else { blows.or(aim) },
            aspect: controls.aspect,
            turn,
            mode: controls.mode,
            commands: cue.commands,
        };
        let RecordedInput { pointer, aspect, turn, mode, ref commands } = self.recorded;
        self.simulation.step(&StepInput {
            microphone: self.recording.as_mut().map(WavFeed::microphone).or(microphone),
            ignore_microphone: controls.inert,
            hold: self.holds,
            pointer_grabs: self.gestures.grabs(),
            strength: controls.strength,
            pointer,
            aspect,
            turn,
            mode,
            commands,
        });
        self.steps += 1;
        self.snapshot = self.simulation.snapshot();
    }

    /// Camera turn by the visitor's pulls and stick.
    fn visitor_orbit(&self, controls: &Controls) -> OrbitInput {
        let [right, up] = self.gestures.camera_turn();
        // A stick to the right or down moves the camera there.
        let [x, y] = controls.stick.map(|speed| orbit::TURN * speed / STEPS_PER_SECOND as f64);
        OrbitInput::Pulled([right + x, up - y])
    }

    /// Advances the orbit camera.
    fn turn(&mut self, controls: &Controls, way: OrbitInput) -> [f64; 2] {
        let leeway = match self.leeway {
            Some((aspect, leeway)) if aspect == controls.aspect => leeway,
            // The camera never moved, so the leeway is not needed.
            None if way == OrbitInput::Home => return [0.0; 2],
            _ => self.simulation.exhibit().orbit_limits(controls.aspect),
        };
        self.leeway = Some((controls.aspect, leeway));
        self.orbit.step(way, &leeway, self.reduced_motion)
    }

    /// Shows another exhibit with its assembly animation, or the same one, reloaded, from its start. `clock` is the present time
    /// of day, s after midnight, to which an exhibit with hands sets them.
    pub fn swap(&mut self, exhibit: Arc<Exhibit>, clock: Option<f64>) {
        let another = exhibit.id != self.exhibit().id;
        self.pending_command = (another && !self.reduced_motion).then_some(Command::Assemble(self.steps));
        self.gestures.unlatch();
        (self.orbit, self.leeway) = (Orbit::default(), None);
        self.attract = self.attract.take().map(|before| {
            let next = AttractMode::new(exhibit.attract.clone(), self.idle_s);
            if before.is_active() { next.starting_now() } else { next }
        });
        self.begin(exhibit, Settings { clock, ..*self.simulation.settings() });
    }

    /// Starts an exhibit. The detector is kept, with its estimate of the noise floor.
    fn begin(&mut self, exhibit: Arc<Exhibit>, settings: Settings) {
        self.simulation = Simulation::new(exhibit, settings).adopt_detector(&mut self.simulation);
        self.snapshot = self.simulation.snapshot();
    }

    /// Takes over changed settings, which restart the exhibit, and another idle time.
    pub fn reconfigure(&mut self, settings: Settings, idle_s: Option<f64>) {
        let before = Settings { clock: settings.clock, ..*self.simulation.settings() };
        if settings != before {
            self.begin(self.exhibit().clone(), settings);
        }
        if idle_s != self.attract.as_ref().map(|_| self.idle_s) {
            self.attract = idle_s.map(|idle| AttractMode::new(self.exhibit().attract.clone(), idle));
            self.idle_s = idle_s.unwrap_or_default();
        }
    }

    /// Present values of the simulation for the staff panel, as far as `look` asks for them.
    pub fn inspect(&mut self, look: InspectionScope) -> Inspection {
        self.simulation.inspect(look)
    }

    /// Steps since the kiosk began, over all exhibits.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Snapshot of the last step.
    pub fn snapshot(&self) -> &Snapshot {
        &self.snapshot
    }

    /// The camera of the last step.
    pub fn sight(&self) -> &View {
        self.simulation.current_view()
    }

    /// Constants of the run.
    pub fn settings(&self) -> &Settings {
        self.simulation.settings()
    }

    /// The exhibit on show.
    pub fn exhibit(&self) -> &Arc<Exhibit> {
        self.simulation.exhibit()
    }

    /// Inputs of the last step, as a record stores them. Of the breath, a record stores the speed in the snapshot instead.
    pub fn recorded_input(&self) -> StepInput<'_> {
        let RecordedInput { pointer, aspect, turn, mode, ref commands } = self.recorded;
        StepInput {
            pointer,
            aspect,
            turn,
            mode,
            commands,
            pointer_grabs: self.gestures.grabs(),
            ..StepInput::default()
        }
    }

    /// Did a press, a key or a switch blow in the last step?
    pub fn holds(&self) -> bool {
        self.holds
    }

    /// Swipes forward so far, less those backward.
    pub fn swipes(&self) -> i64 {
        self.gestures.swipes()
    }

    /// Sounds of the last step.
    pub fn sounds(&self) -> &[SoundCommand] {
        self.simulation.sounds()
    }

    /// Now, on the sample clock of [`Self::sounds`].
    pub fn sample(&self) -> u64 {
        self.simulation.steps() * SAMPLES_PER_STEP
    }

    /// Text key that attract mode shows; `None` while visitors are here.
    pub fn attract_text(&self) -> Option<&str> {
        self.attract.as_ref().and_then(AttractMode::text)
    }

    /// Finished rounds of the attract script, and during the countdown the time until attract mode begins, s.
    pub fn attract_progress(&self) -> (u32, Option<f64>) {
        self.attract.as_ref().map_or((0, None), |attract| (attract.rounds(), attract.begins_in()))
    }

    /// Is attract mode playing?
    pub fn attracts(&self) -> bool {
        self.attract.as_ref().is_some_and(AttractMode::is_active)
    }

    /// Hash of the state: equal for identical runs.
    pub fn state_hash(&self) -> u64 {
        self.simulation.state_hash()
    }
}

/// A breath of the attract script, slower.
fn gentler(command: &mut Command) {
    if let Command::Blow(Some(speed)) = command {
        *speed *= GENTLER;
    }
}
