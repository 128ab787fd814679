//! What the kiosk does in one simulation step, without a clock, a window or a device: who blows, visitor, recording
//! or attract script, and what becomes of the exhibit.
//!
//! Invariant: with a recording, no visitor and no attract mode the run is bit-identical to `soffio play` with the
//! same recording, exhibit, settings and picture shape; both feed the steps through [`WavFeed`].

use std::sync::Arc;

use soffio_exhibit::{Exhibit, OrbitLimits, View};
use soffio_geometry::bodies::RigidBody;
use soffio_offline::feed::WavFeed;
use soffio_simulation::{
    Command, Inspection, InspectionScope, Microphone, MotionMode, SAMPLES_PER_STEP, STEPS_PER_SECOND, Settings,
    Simulation, Snapshot, StepInput,
};
use soffio_sound::SoundCommand;

use crate::attract::script::Attract;
use crate::step::controls::Controls;
use crate::step::pointing::Pointing;
use crate::visitor::gesture::{Gestures, Lift, Touch};
use crate::visitor::orbit::{self, Orbit, Way};

/// What a step was told, but for breath and hands.
#[derive(Clone, Debug, Default)]
struct Told {
    pointer: Option<[f64; 2]>,
    aspect: f64,
    turn: [f64; 2],
    mode: Option<MotionMode>,
    commands: Vec<Command>,
}

/// How much slower the breaths of the attract script are where less motion is wanted.
const GENTLER: f64 = 0.5;

/// The exhibit on show. A clone goes on from the same moment by itself.
#[derive(Clone)]
pub struct Stage {
    simulation: Simulation,
    steps: u64,
    recording: Option<WavFeed>,
    attract: Option<Attract>,
    idle_s: f64,
    activity: u64,
    pointing: Pointing,
    gestures: Gestures,
    orbit: Orbit,
    /// How far it goes, for a picture of that shape; `None` until somebody asks.
    leeway: Option<(f64, OrbitLimits)>,
    holds: bool,
    /// What the last step was told beside breath and hands.
    told: Told,
    calm: bool,
    /// What the next step begins with: another exhibit gathers its parts.
    called: Option<Command>,
    /// Presses that have come up, and commands, that the next step takes: that step alone.
    lifts: Vec<Lift>,
    commands: Vec<Command>,
    snapshot: Snapshot,
}

impl Stage {
    /// The exhibit at rest. `recording` stands in for the microphone; `idle_s` is the time without a visitor until
    /// attract mode, `None` switches it off.
    pub fn new(exhibit: Arc<Exhibit>, settings: Settings, recording: Option<WavFeed>, idle_s: Option<f64>) -> Self {
        let attract = idle_s.map(|idle| Attract::new(exhibit.attract.clone(), idle));
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
            told: Told::default(),
            calm: false,
            called: None,
            lifts: Vec::new(),
            commands: Vec::new(),
            snapshot,
        }
    }

    /// A press has come up: the next step takes it in, once.
    pub fn lift(&mut self, lift: Lift) {
        self.lifts.push(lift);
    }

    /// A command that goes before the next step, once, after those of the attract script.
    pub fn command(&mut self, command: Command) {
        self.commands.push(command);
    }

    /// Advances by one step. `microphone` is what was heard since the last; a recording goes before it.
    pub fn step(&mut self, controls: &Controls, microphone: Option<Microphone>) {
        let nobody = controls.inert.then(|| controls.without_visitor());
        let controls = nobody.as_ref().unwrap_or(controls);
        let mut lifts = std::mem::take(&mut self.lifts);
        if controls.inert {
            lifts.clear();
        }
        // The detector's word of the step before: a breath is an input like any other.
        let breathing = self.snapshot.breath.estimate.speed > 0.0;
        let pressed = controls.hold || !controls.presses.is_empty() || !lifts.is_empty();
        self.calm = controls.calm;
        // Whoever cleans is here too, though not to play: attract mode waits.
        let visitor = breathing || pressed || controls.inert || controls.activity != self.activity;
        self.activity = controls.activity;
        let fastest = |fastest: f64, body: &RigidBody| fastest.max(body.velocity.length());
        let moves = self.simulation.bodies().iter().fold(0.0, fastest);
        let mut cue = self.attract.as_mut().map(|attract| attract.step(visitor, moves)).unwrap_or_default();
        if self.calm {
            cue.commands.iter_mut().for_each(gentler);
        }
        cue.commands.append(&mut self.commands);
        // Whoever blows or presses does not wait until the parts have gathered, and whoever wants less motion does not see it.
        let impatient = (breathing || pressed || self.calm) && self.simulation.assembly_distance().is_some();
        cue.commands.extend(self.called.take().or(impatient.then_some(Command::Reset)));
        let simulation = &mut self.simulation;
        let takeable = |at| simulation.hit_test(at, controls.aspect);
        let touch = Touch {
            presses: &controls.presses,
            lifts: &lifts,
            hold: controls.hold,
            keyed: controls.keyed,
            once: controls.press_once,
            round: controls.round,
            aspect: controls.aspect,
        };
        let blows = self.gestures.step(&touch, takeable);
        lifts.clear();
        self.lifts = lifts;
        // Whoever looks round turns with the stick; the aim stays.
        let stick = if controls.round { [0.0; 2] } else { controls.stick };
        let aim = self.pointing.step(controls, stick);
        if cue.active {
            self.pointing.forget();
            self.gestures.unlatch();
        }
        self.holds = controls.hold && !controls.press_once || blows.is_some() || self.gestures.latched();

        // Where less motion is wanted, the script does not lead the camera.
        let led = cue.look.filter(|_| !self.calm).map_or(Way::Home, Way::Led);
        let turn = self.turn(controls, if cue.active || !controls.round { led } else { self.pulled(controls) });
        self.told = Told {
            pointer: if cue.active { cue.aim } else { blows.or(aim) },
            aspect: controls.aspect,
            turn,
            mode: controls.mode,
            commands: cue.commands,
        };
        let Told { pointer, aspect, turn, mode, ref commands } = self.told;
        self.simulation.step(&StepInput {
            microphone: self.recording.as_mut().map(WavFeed::microphone).or(microphone),
            ignore_microphone: controls.inert,
            hold: self.holds,
            pointer_grabs: self.gestures.hands(),
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

    /// What the visitor's pulls and pushes turn the camera by.
    fn pulled(&self, controls: &Controls) -> Way {
        let [right, up] = self.gestures.pulled();
        // A stick to the right or down leads the eye there.
        let [x, y] = controls.stick.map(|speed| orbit::TURN * speed / STEPS_PER_SECOND as f64);
        Way::Pulled([right + x, up - y])
    }

    /// Goes on with the camera.
    fn turn(&mut self, controls: &Controls, way: Way) -> [f64; 2] {
        let leeway = match self.leeway {
            Some((aspect, leeway)) if aspect == controls.aspect => leeway,
            // It has never been away: there is nothing to measure.
            None if way == Way::Home => return [0.0; 2],
            _ => self.simulation.exhibit().orbit_limits(controls.aspect),
        };
        self.leeway = Some((controls.aspect, leeway));
        self.orbit.step(way, &leeway, self.calm)
    }

    /// Shows another exhibit, whose parts gather themselves, or the same one, reloaded, from its start. `clock` is the time of
    /// day now, s after midnight, to which it sets its hands where it has any.
    pub fn swap(&mut self, exhibit: Arc<Exhibit>, clock: Option<f64>) {
        let another = exhibit.id != self.exhibit().id;
        self.called = (another && !self.calm).then_some(Command::Assemble(self.steps));
        self.gestures.unlatch();
        (self.orbit, self.leeway) = (Orbit::default(), None);
        self.attract = self.attract.take().map(|before| {
            let next = Attract::new(exhibit.attract.clone(), self.idle_s);
            if before.is_active() { next.go_on() } else { next }
        });
        self.begin(exhibit, Settings { clock, ..*self.simulation.settings() });
    }

    /// Lets an exhibit begin, before the same room.
    fn begin(&mut self, exhibit: Arc<Exhibit>, settings: Settings) {
        self.simulation = Simulation::new(exhibit, settings).adopt_detector(&mut self.simulation);
        self.snapshot = self.simulation.snapshot();
    }

    /// Takes over changed settings, with which the exhibit begins anew, and another idle time.
    pub fn settle(&mut self, settings: Settings, idle_s: Option<f64>) {
        let before = Settings { clock: settings.clock, ..*self.simulation.settings() };
        if settings != before {
            self.begin(self.exhibit().clone(), settings);
        }
        if idle_s != self.attract.as_ref().map(|_| self.idle_s) {
            self.attract = idle_s.map(|idle| Attract::new(self.exhibit().attract.clone(), idle));
            self.idle_s = idle_s.unwrap_or_default();
        }
    }

    /// Looks closer at the present moment.
    pub fn inspect(&mut self, look: InspectionScope) -> Inspection {
        self.simulation.inspect(look)
    }

    /// Steps since the kiosk began, over all exhibits.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The present moment.
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

    /// What the last step was told; the breath is in the snapshot's speed.
    pub fn told(&self) -> StepInput<'_> {
        let Told { pointer, aspect, turn, mode, ref commands } = self.told;
        StepInput {
            pointer,
            aspect,
            turn,
            mode,
            commands,
            pointer_grabs: self.gestures.hands(),
            ..StepInput::default()
        }
    }

    /// Did a press, a key or a switch blow in the last step?
    pub fn holds(&self) -> bool {
        self.holds
    }

    /// Works that visitors have swiped on so far, less those that they have swiped back.
    pub fn turned(&self) -> i64 {
        self.gestures.turned()
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
        self.attract.as_ref().and_then(Attract::text)
    }

    /// Rounds of the attract script that have ended, and the seconds until attract mode begins, where they are few.
    pub fn attract_course(&self) -> (u32, Option<f64>) {
        self.attract.as_ref().map_or((0, None), |attract| (attract.rounds(), attract.begins_in()))
    }

    /// Is attract mode playing?
    pub fn attracts(&self) -> bool {
        self.attract.as_ref().is_some_and(Attract::is_active)
    }

    /// One word that says whether two runs are the same run.
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
