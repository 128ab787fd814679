//! Offline run: the live pipeline in a loop, as fast as the machine allows.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use cpu_time::ProcessTime;
use serde::Serialize;

use super::events::EventWriter;
use super::feed::WavFeed;
use super::frames::Frames;
use super::soundtrack::Soundtrack;
use super::trace::TraceWriter;
use soffio_exhibit::Exhibit;
use soffio_simulation::record::RecordSection;
use soffio_simulation::{
    Command, MotionMode, PointerGrab, STEPS_PER_SECOND, Script, Settings, Simulation, Snapshot, StepInput,
};
use soffio_sound::ReverbSpec;

/// Steps between two measurements of the joint error, which costs a thirtieth of a clock's step.
const JOINT_ERROR_STEPS: u64 = STEPS_PER_SECOND / 30;

/// What to run, and which outputs to write.
#[derive(Default)]
pub struct Play {
    /// Constants of the run.
    pub settings: Settings,
    /// A recorded breath as the microphone.
    pub breath: Option<WavFeed>,
    /// Pointer position in picture coordinates.
    pub aim: Option<[f64; 2]>,
    /// Script of a visitor's actions.
    pub script: Option<Script>,
    /// Input of a recorded run, in place of breath, aim, script and picture shape.
    pub recorded: Option<RecordSection>,
    /// Motion mode where the script sets none.
    pub mode: Option<MotionMode>,
    /// Duration, s.
    pub seconds: f64,
    /// Aspect (width / height) of the picture that the pointer lies in.
    pub aspect: f64,
    /// Path of the sound file, stereo 48 kHz float.
    pub audio: Option<PathBuf>,
    /// Reverb; `None` is the open air.
    pub reverb: Option<ReverbSpec>,
    /// Is the sound rendered without reverb and limiter?
    pub dry: bool,
    /// Path of the trace, CSV.
    pub trace: Option<PathBuf>,
    /// Path of the event log, JSON lines.
    pub events: Option<PathBuf>,
    /// Frames per second of trace and pictures.
    pub fps: u32,
}

/// Result of a run (the last line of `soffio play`).
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Number of steps.
    pub steps: u64,
    /// Wall time of the run, s.
    pub wall_s: f64,
    /// Processor time of the run, all threads together, s.
    pub cpu_s: f64,
    /// Simulated time over wall time.
    pub real_time_factor: f64,
    /// Largest joint error, sampled 30 times a second, m.
    pub max_joint_error_m: f64,
    /// Energy at the end, J.
    pub energy_j: f64,
    /// Number of impacts.
    pub impacts: u64,
    /// Number of changes between motion modes.
    pub solver_switches: u64,
    /// Sample peak, dB of full scale; null for silence.
    pub peak_dbfs: Option<f64>,
    /// Integrated loudness; null for silence.
    pub lufs: Option<f64>,
    /// Breath profile.
    pub profile: &'static str,
    /// Seed.
    pub seed: u64,
    /// Number of invalid states found and recovered.
    pub faults: u64,
    /// Hash of the final state, hexadecimal: equal runs have equal hashes.
    pub state_hash: String,
}

/// Reasons why a run failed.
#[derive(Debug, thiserror::Error)]
pub enum PlayError {
    /// A file could not be written, or a timbre is invalid.
    #[error("{0}")]
    Output(String),
    /// Interrupted; no partial file is left.
    #[error("interrupted")]
    Interrupted,
}

impl From<std::io::Error> for PlayError {
    fn from(error: std::io::Error) -> Self {
        Self::Output(error.to_string())
    }
}

/// Called for every frame that is due, with its number and its snapshot.
pub type OnFrame<'a> = dyn FnMut(u64, &Snapshot) -> Result<(), String> + 'a;

/// Runs an exhibit. `on_step` receives the number of each completed step (progress); `on_frame` receives each frame.
///
/// # Errors
/// As [`PlayError`] lists.
pub fn run(
    exhibit: &Arc<Exhibit>,
    mut play: Play,
    stop: &AtomicBool,
    mut on_step: impl FnMut(u64),
    mut on_frame: Option<&mut OnFrame>,
) -> Result<Summary, PlayError> {
    let (wall, cpu) = (Instant::now(), ProcessTime::now());
    let (settings, seconds) = (play.settings, play.seconds);
    let mut simulation = Simulation::new(exhibit.clone(), settings);
    if on_frame.is_none() {
        simulation.disable_dust();
    }
    let mut soundtrack = Soundtrack::new(exhibit, settings.seed, play.reverb.as_ref(), play.dry, play.audio.as_deref())
        .map_err(PlayError::Output)?;
    let mut trace = play.trace.as_ref().map(|path| TraceWriter::create(path, exhibit, play.fps)).transpose()?;
    let mut events = play.events.as_ref().map(|path| EventWriter::create(path, exhibit)).transpose()?;
    let steps = play.recorded.as_ref().map_or((seconds * STEPS_PER_SECOND as f64).round() as u64, RecordSection::steps);
    let mut worst: f64 = 0.0;
    let mut frames = Frames::new(play.fps);
    let mut inputs = Inputs::new(&mut play);
    for step in 0..=steps {
        if let Some(trace) = &mut trace {
            trace.push_simulation(&simulation)?;
        }
        if let Some(on_frame) = &mut on_frame {
            frames
                .push(step, || simulation.snapshot(), |frame, now| on_frame(frame, now))
                .map_err(PlayError::Output)?;
        }
        if step == steps {
            break;
        }
        let input = inputs.next(step, &simulation);
        simulation.step(&input);
        soundtrack.step(simulation.sounds()).map_err(PlayError::Output)?;
        if let Some(events) = &mut events {
            events.push(simulation.events())?;
        }
        if (step + 1).is_multiple_of(JOINT_ERROR_STEPS) || step + 1 == steps {
            worst = worst.max(simulation.joint_error());
        }
        on_step(step + 1);
        if stop.load(Ordering::Relaxed) {
            return Err(PlayError::Interrupted);
        }
    }
    let levels = soundtrack.finish().map_err(PlayError::Output)?;
    trace.map_or(Ok(()), TraceWriter::finish)?;
    events.map_or(Ok(()), EventWriter::finish)?;
    let wall_s = wall.elapsed().as_secs_f64();
    let diagnostics = simulation.snapshot().diagnostics;
    let finite = |x: f64| x.is_finite().then_some(x);
    Ok(Summary {
        steps,
        wall_s,
        cpu_s: cpu.elapsed().as_secs_f64(),
        real_time_factor: seconds / wall_s,
        max_joint_error_m: worst,
        energy_j: diagnostics.energy,
        impacts: diagnostics.impacts,
        solver_switches: inputs.switches,
        peak_dbfs: finite(levels.peak_dbfs),
        lufs: finite(levels.lufs),
        profile: settings.profile.name(),
        seed: settings.seed,
        faults: diagnostics.faults,
        state_hash: format!("{:016x}", simulation.state_hash()),
    })
}

/// The simulation's input from step to step.
struct Inputs {
    breath: Option<WavFeed>,
    aim: Option<[f64; 2]>,
    script: Option<Script>,
    recorded: Option<RecordSection>,
    mode: Option<MotionMode>,
    aspect: f64,
    commands: Vec<Command>,
    hands: Vec<PointerGrab>,
    /// Motion mode of the last step, and the number of changes.
    before: Option<MotionMode>,
    switches: u64,
}

impl Inputs {
    /// Takes breath, script and record from `play`.
    fn new(play: &mut Play) -> Self {
        Self {
            breath: play.breath.take(),
            aim: play.aim,
            script: play.script.take(),
            recorded: play.recorded.take(),
            mode: play.mode,
            aspect: play.aspect,
            commands: Vec::new(),
            hands: Vec::new(),
            before: play.mode,
            switches: 0,
        }
    }

    /// The input of a step.
    fn next(&mut self, step: u64, simulation: &Simulation) -> StepInput<'_> {
        self.commands.clear();
        if let Some(script) = &mut self.script {
            script.due(step as f64 / STEPS_PER_SECOND as f64, &mut self.commands);
            script.pointer_grabs(simulation, self.aspect, &mut self.hands);
        }
        let input = match &mut self.recorded {
            Some(recorded) => recorded.input(step),
            None => StepInput {
                mode: self.script.as_ref().and_then(Script::mode).or(self.mode),
                pointer_grabs: &self.hands,
                microphone: self.breath.as_mut().map(WavFeed::microphone),
                pointer: self.script.as_ref().and_then(Script::aim).or(self.aim),
                aspect: self.aspect,
                commands: &self.commands,
                ..StepInput::default()
            },
        };
        self.switches += u64::from(step > 0 && input.mode != self.before);
        self.before = input.mode;
        input
    }
}
