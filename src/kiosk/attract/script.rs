//! Attract mode: detects whether a visitor is here, and plays the exhibit's script if not.
//!
//! Any input counts as a visitor, a detected breath included; noise in the room does not. After the idle time without an
//! input the exhibit's own script plays, round after round, until the step of the next input.
//!
//! A detector of its own measures the script's recorded breaths, which reach the wind as a speed. The simulation's detector
//! keeps tracking the noise of the room meanwhile, so the first breath of a visitor ends the script and moves the exhibit in
//! the same step. To make that visible, the exhibit is damped soon after each breath of the script, and at once when a
//! visitor comes.

use soffio_detector::BlowDetector;
use soffio_exhibit::{self as exhibit, AttractAction};
use soffio_math::exp;
use soffio_offline::feed::WavFeed;
use soffio_simulation::{Command, STEPS_PER_SECOND};

/// Length of the countdown before attract mode, s.
pub const COUNTDOWN_S: f64 = 10.0;

/// Factor on the speed of the script's breaths, and the time in which they rise, s. They show that breath moves the exhibit;
/// a gentle breath of a visitor must still move it more.
const SOFTLY: f64 = 0.13;
const SWELLS_S: f64 = 0.3;
/// Increase of the exhibit's fastest motion, m/s, that halves the script's breath; and the time constant with which the fastest
/// motion is remembered, s.
const SWAYS_M_S: f64 = 0.03;
const MOVED_S: f64 = 1.0;
/// Time after a breath of the script until the exhibit is damped, s.
const SWINGS_S: f64 = 1.0;

/// Output of attract mode for one step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cue {
    /// Is the script playing?
    pub active: bool,
    /// Commands to apply before the step, in order.
    pub commands: Vec<Command>,
    /// Aim of the script's breath; `None` is the centre.
    pub aim: Option<[f64; 2]>,
    /// Camera angles of the script, to the right and up, rad; `None` where it does not move the camera.
    pub look: Option<[f64; 2]>,
}

/// State of attract mode.
#[derive(Clone, Debug)]
pub struct AttractMode {
    script: exhibit::Attract,
    idle_limit: u64,
    idle: u64,
    /// Was a visitor here since the last round?
    met: bool,
    round: Option<Round>,
    /// Rounds that have ended.
    rounds: u32,
    /// Recent speed of the fastest body, m/s.
    moved: f64,
}

/// One round of the script.
#[derive(Clone, Debug, Default)]
struct Round {
    step: u64,
    next: usize,
    text: Option<String>,
    breath: Option<(WavFeed, BlowDetector)>,
    /// Rise of the breath, 0 … 1.
    swollen: f64,
    /// Speed of the fastest body before the breath, m/s.
    before: f64,
    /// Steps until the exhibit is damped.
    swings: Option<u64>,
    aim: Option<[f64; 2]>,
    look: Option<[f64; 2]>,
}

impl AttractMode {
    /// Attract mode with the exhibit's `script` after `idle_s` seconds without a visitor.
    pub fn new(script: exhibit::Attract, idle_s: f64) -> Self {
        Self { script, idle_limit: steps(idle_s).max(1), idle: 0, met: false, round: None, rounds: 0, moved: 0.0 }
    }

    /// Plays from the next step on, without the idle time.
    pub fn starting_now(mut self) -> Self {
        self.idle = self.idle_limit;
        self
    }

    /// Advances by one simulation step. `visitor`: there was an input since the last step. `moves` is the speed of the fastest
    /// body, m/s.
    pub fn step(&mut self, visitor: bool, moves: f64) -> Cue {
        self.moved = moves.max(self.moved * exp(-1.0 / (MOVED_S * STEPS_PER_SECOND as f64)));
        if visitor {
            (self.idle, self.met) = (0, true);
            let over = self.round.take().is_some();
            let commands = if over { vec![Command::Blow(None), Command::Settle] } else { Vec::new() };
            return Cue { commands, ..Cue::default() };
        }
        self.idle += 1;
        if self.idle < self.idle_limit {
            return Cue::default();
        }
        self.met = false;
        self.play(moves)
    }

    /// Rounds of the script that have ended.
    pub fn rounds(&self) -> u32 {
        self.rounds
    }

    /// Time until attract mode begins, s, during the countdown; `None` before it, and where no visitor was here.
    pub fn begins_in(&self) -> Option<f64> {
        let left = self.idle_limit.saturating_sub(self.idle) as f64 / STEPS_PER_SECOND as f64;
        (self.met && self.round.is_none() && left <= COUNTDOWN_S).then_some(left)
    }

    /// Is the script playing?
    pub fn is_active(&self) -> bool {
        self.round.is_some()
    }

    /// Key of the text to show now.
    pub fn text(&self) -> Option<&str> {
        self.round.as_ref().and_then(|round| round.text.as_deref())
    }

    /// One step of the script. Not inlined: it needs stack for a new detector, which no other step does.
    #[inline(never)]
    fn play(&mut self, moves: f64) -> Cue {
        let mut commands = Vec::new();
        // A last breath may outlast the round: the next round waits for it.
        let over = |round: &Round| round.step >= steps(self.script.duration) && round.breath.is_none();
        if self.round.as_ref().is_none_or(over) {
            self.rounds += u32::from(self.round.is_some());
            // A new round moves the camera back if the last one has moved it.
            let look = self.round.take().and_then(|round| round.look).map(|_| [0.0; 2]);
            self.round = Some(Round { look, ..Round::default() });
        }
        let round = self.round.get_or_insert_default();
        while let Some(step) = self.script.steps.get(round.next).filter(|step| steps(step.at) <= round.step) {
            match &step.action {
                AttractAction::Show(key) => round.text = Some(key.clone()),
                AttractAction::Look(turn) => round.look = Some(*turn),
                AttractAction::Reset => commands.push(Command::Reset),
                AttractAction::Blow { samples, sample_rate, aim } => {
                    let feed = WavFeed::new(samples.clone(), *sample_rate);
                    round.breath = Some((feed, BlowDetector::new(*sample_rate)));
                    (round.aim, round.before) = (*aim, self.moved);
                }
            }
            round.next += 1;
        }
        if let Some((feed, detector)) = &mut round.breath {
            let over = feed.is_over();
            feed.microphone().feed(detector);
            let speed = if over { 0.0 } else { detector.estimate().speed };
            let more = 1.0 / (SWELLS_S * STEPS_PER_SECOND as f64);
            round.swollen = if speed > 0.0 { (round.swollen + more).min(1.0) } else { 0.0 };
            let faster = (moves - round.before).max(0.0) / SWAYS_M_S;
            commands.push(Command::Blow(Some(SOFTLY * round.swollen * speed / (1.0 + faster))));
            if over {
                (round.breath, round.swings) = (None, Some(steps(SWINGS_S)));
            }
        } else if round.step == 0 {
            commands.push(Command::Blow(Some(0.0)));
        }
        round.swings = match round.swings {
            Some(0) => {
                commands.push(Command::Settle);
                None
            }
            left => left.map(|left| left - 1),
        };
        round.step += 1;
        Cue { active: true, commands, aim: round.aim, look: round.look }
    }
}

/// Steps of a time, s.
fn steps(seconds: f64) -> u64 {
    (seconds * STEPS_PER_SECOND as f64).round() as u64
}
