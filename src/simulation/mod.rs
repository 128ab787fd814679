//! The simulation: everything that moves, and the only way time advances.

use std::sync::Arc;

use crate::exhibit::{Exhibit, View};
use crate::math::{DVec3, Pose};
use crate::sound::SoundCommand;
use crate::wind::blow::BlowEstimate;

/// Simulation steps per second.
pub const STEPS_PER_SECOND: u64 = 240;
/// Audio samples per second of the simulation's sample clock.
pub const SAMPLE_RATE: u32 = 48_000;
/// Audio samples per step.
pub const SAMPLES_PER_STEP: u64 = SAMPLE_RATE as u64 / STEPS_PER_SECOND;

/// How a breath becomes wind (design.md, two breath profiles).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Profile {
    /// No travelling front; gain such that a child's gentle breath visibly moves a sculpture within a second.
    #[default]
    Gallery,
    /// Gain 1, the front travels as a real jet's does.
    True,
}

/// What is constant over a run, besides the exhibit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How a breath becomes wind.
    pub profile: Profile,
    /// Multiplies the force of the breath on top of the profile's own gain.
    pub breath_gain: f64,
    /// Distance of the lips before the target, m.
    pub distance: f64,
    /// Lip diameter d = 2 r₀, m.
    pub lip_diameter: f64,
    /// Seed of all that is random.
    pub seed: u64,
    /// false: no wind of any kind (tests, `--no-wind`).
    pub wind: bool,
    /// false: pivots without friction and bodies without damping (tests of conservation).
    pub friction: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            profile: Profile::Gallery,
            breath_gain: 1.0,
            distance: 0.5,
            lip_diameter: 0.01,
            seed: 1,
            wind: true,
            friction: true,
        }
    }
}

/// Microphone samples of one step.
#[derive(Clone, Copy, Debug)]
pub struct Microphone<'a> {
    /// Mono, full scale ±1.
    pub samples: &'a [f32],
    /// Hz.
    pub sample_rate: u32,
    /// What the loudspeaker played meanwhile (mono, same rate and length); empty where it cannot be heard.
    pub reference: &'a [f32],
}

/// A command of a visitor, a script, or staff.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// Puts everything back to where it started.
    Reset,
    /// Sets the source speed of the breath directly, m/s (scripts, replay); `None` gives it back.
    Blow(Option<f64>),
}

/// Everything that varies: the whole input of one step.
#[derive(Clone, Copy, Debug, Default)]
pub struct StepInput<'a> {
    /// `None`: no microphone, wind from it is exactly 0.
    pub microphone: Option<Microphone<'a>>,
    /// Hold-to-blow (pointer, touch, key, switch).
    pub hold: bool,
    /// Pointer in picture coordinates, (0,0) top left, (1,1) bottom right; `None` is the centre.
    pub pointer: Option<[f64; 2]>,
    /// Width over height of the picture; 0 is 16:9.
    pub aspect: f64,
    /// Commands, carried out in order before the step.
    pub commands: &'a [Command],
}

/// A collision event (design.md section 3, Events).
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Seconds since reset of the run.
    pub t: f64,
    /// round(48000 t).
    pub sample: u64,
    /// Kind.
    pub kind: EventKind,
    /// Bodies by index; `None` is the world.
    pub bodies: [Option<usize>; 2],
    /// World, m.
    pub point: DVec3,
    /// Unit, from the second body to the first.
    pub normal: DVec3,
    /// N s.
    pub impulse: f64,
    /// Approach speed, m/s.
    pub speed: f64,
}

/// Kind of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// Two bodies hit.
    Impact,
    /// Two bodies lie against each other.
    Rest,
    /// Bad numbers were found and the body restored.
    Fault,
}

/// A speck of dust that shows the wind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mote {
    /// World, m.
    pub position: [f32; 3],
    /// World, m/s.
    pub velocity: [f32; 3],
    /// 0 invisible … 1 bright.
    pub brightness: f32,
}

/// The breath as it is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BreathView {
    /// Source speed after all sources are joined, m/s; exactly 0 when nobody blows.
    pub speed: f64,
    /// What the detector says.
    pub estimate: BlowEstimate,
    /// Centre of the lips, world, m.
    pub mouth: DVec3,
    /// Unit, where the breath goes.
    pub direction: DVec3,
    /// Where it is aimed, world, m.
    pub target: DVec3,
}

/// What a picture, a trace and a panel need to know of one moment.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// Steps done.
    pub step: u64,
    /// World pose of each moving body's glTF node, in the order of [`Exhibit::bodies`].
    pub poses: Vec<Pose>,
    /// The breath.
    pub breath: BreathView,
    /// Dust.
    pub motes: Vec<Mote>,
    /// Numbers for staff.
    pub diagnostics: Diagnostics,
}

/// Numbers for staff and for the summary of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Diagnostics {
    /// Largest distance or angle error of any joint now, m.
    pub joint_error: f64,
    /// Kinetic plus potential energy, J.
    pub energy: f64,
    /// Impacts so far.
    pub impacts: u64,
    /// Faults so far.
    pub faults: u64,
    /// Integration substeps of the last step.
    pub substeps: u32,
    /// Sum of the wind's forces, N.
    pub wind_force: DVec3,
}

impl Snapshot {
    /// The moment between two snapshots of the same exhibit, `alpha` in 0…1.
    pub fn interpolate(&self, next: &Self, alpha: f64) -> Self {
        let mut out = next.clone();
        for (pose, before) in out.poses.iter_mut().zip(&self.poses) {
            *pose = before.interpolate(pose, alpha);
        }
        for (mote, before) in out.motes.iter_mut().zip(&self.motes) {
            for axis in 0..3 {
                let (a, b) = (before.position[axis], mote.position[axis]);
                // A mote that was born again elsewhere jumps; it does not fly.
                mote.position[axis] = if (b - a).abs() < 0.1 { a + (b - a) * alpha as f32 } else { b };
            }
        }
        out
    }
}

/// An exhibit in motion.
pub struct Simulation {
    exhibit: Arc<Exhibit>,
    settings: Settings,
    step: u64,
    events: Vec<Event>,
    sounds: Vec<SoundCommand>,
}

impl Simulation {
    /// The exhibit at rest in its start pose.
    pub fn new(exhibit: Arc<Exhibit>, settings: Settings) -> Self {
        Self { exhibit, settings, step: 0, events: Vec::new(), sounds: Vec::new() }
    }

    /// Advances by 1/240 s. The only way time moves.
    pub fn step(&mut self, _input: &StepInput) {
        self.step += 1;
    }

    /// Events of the last step.
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

    /// The present moment.
    pub fn snapshot(&self) -> Snapshot {
        let poses = self.exhibit.bodies.iter().map(|body| body.pose).collect();
        Snapshot { step: self.step, poses, ..Snapshot::default() }
    }

    /// The camera of the exhibit for a picture of this aspect (width / height).
    pub fn view(&self, aspect: f64) -> View {
        self.exhibit.view(aspect)
    }

    /// One word that says whether two runs are the same run.
    pub fn state_hash(&self) -> u64 {
        self.step
    }
}
