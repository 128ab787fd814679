//! Attract mode: is somebody here, and what to show when not.
//!
//! "Somebody" is any input, a breath included; noise in the room is not a visitor, because only what the blow
//! detector takes for a breath counts. When nobody was there for the idle time, the exhibit's own script plays,
//! round after round, until the very step at which somebody is.
//!
//! The script's recorded breaths are heard by a detector of their own and reach the wind as a speed. So the
//! simulation's detector never stops listening to the room: it keeps its knowledge of the noise, and the first
//! visitor's breath ends the show and moves the sculpture in the same moment. So that it is seen to, what the script has
//! set swinging comes to rest soon after each of its breaths, and at once when somebody comes.

use soffio_detector::BlowDetector;
use soffio_exhibit::{self as exhibit, AttractAction};
use soffio_math::exp;
use soffio_offline::feed::WavFeed;
use soffio_simulation::{Command, STEPS_PER_SECOND};

/// Before attract mode begins it is shown for so long that it will, s.
pub const COUNTDOWN_S: f64 = 10.0;

/// Breaths of the script are blown so much more softly, and swell within so long, s. They show that breath moves the work; whoever
/// comes and blows meanwhile, though gently, shall see that theirs moves it more.
const SOFTLY: f64 = 0.13;
const SWELLS_S: f64 = 0.3;
/// And the more softly the faster the work moves than before them: half as fast where something does so by this much, m/s. The
/// fastest of what moved before is remembered over so long, s.
const SWAYS_M_S: f64 = 0.03;
const MOVED_S: f64 = 1.0;
/// A work swings for so long after a breath of the script before it is calmed, s.
const SWINGS_S: f64 = 1.0;

/// What attract mode wants at one step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cue {
    /// Is the script playing?
    pub active: bool,
    /// Before the step, in this order.
    pub commands: Vec<Command>,
    /// Where the script's breath is aimed; `None` is the centre.
    pub aim: Option<[f64; 2]>,
    /// Where the script leads the camera, to the right and up, rad; `None` where it leaves it.
    pub look: Option<[f64; 2]>,
}

/// Watches for visitors, and plays the script when there are none.
#[derive(Clone, Debug)]
pub struct Attract {
    script: exhibit::Attract,
    idle_limit: u64,
    idle: u64,
    /// Has anybody been here since the last round?
    met: bool,
    round: Option<Round>,
    /// Rounds that have ended.
    rounds: u32,
    /// How fast the fastest part of the work moved lately, m/s.
    moved: f64,
}

/// One round of the script.
#[derive(Clone, Debug, Default)]
struct Round {
    step: u64,
    next: usize,
    text: Option<String>,
    breath: Option<(WavFeed, BlowDetector)>,
    /// How far it has swollen, 0 … 1.
    swollen: f64,
    /// How fast something moved before it, m/s.
    before: f64,
    /// Steps until the work is calmed.
    swings: Option<u64>,
    aim: Option<[f64; 2]>,
    look: Option<[f64; 2]>,
}

impl Attract {
    /// Attract mode with the exhibit's `script` after `idle_s` seconds without a visitor.
    pub fn new(script: exhibit::Attract, idle_s: f64) -> Self {
        Self { script, idle_limit: steps(idle_s).max(1), idle: 0, met: false, round: None, rounds: 0, moved: 0.0 }
    }

    /// Plays from the next step on, for nobody has come.
    pub fn go_on(mut self) -> Self {
        self.idle = self.idle_limit;
        self
    }

    /// Advances by one simulation step; `visitor` says that somebody did something since the last, and the fastest part of the
    /// work `moves` so fast, m/s.
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

    /// What is left of the idle time, s, in its last seconds, where somebody was here.
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

    /// One step of the script. Kept apart: it makes room for a new ear on the stack, which no other step needs.
    #[inline(never)]
    fn play(&mut self, moves: f64) -> Cue {
        let mut commands = Vec::new();
        // A last breath may be longer than the round: the next round waits for it.
        let over = |round: &Round| round.step >= steps(self.script.duration) && round.breath.is_none();
        if self.round.as_ref().is_none_or(over) {
            self.rounds += u32::from(self.round.is_some());
            // A new round leads a camera back that the last one has led away.
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
