//! Records: what a run was told, step by step, so that it can be run again to the bit.
//!
//! A record is JSON lines. It never holds sound: of the microphone only the speed of the breath that was heard is kept,
//! joined with that of fingers and controllers, as the simulation takes it. A line says what changed since the last:
//!
//! ```text
//! {"record": {"version": 1, "program": "0.1.0"}}
//! {"begin": {"exhibit": "steel-fish", "settings": {"profile": "gallery", …}}}     steps count from here
//! {"told": {"step": 0, "aspect": 1.7777777777777777}}
//! {"told": {"step": 812, "speed": 3.25, "pointer": [0.4, 0.5]}}                    m/s; picture coordinates
//! {"told": {"step": 850, "turn": [0.2, -0.1]}}                                     rad, of the camera
//! {"told": {"step": 900, "commands": ["reset"]}}                                   this step's alone
//! {"end": {"steps": 4800, "state": "00f3…"}}                                       what it came to
//! ```
//!
//! An exhibit that is shown anew, or another one, begins another part. A record that was cut off has no last `end`.
//! Numbers are written as the shortest text that reads back to the same bits.

use serde::{Deserialize, Serialize};

use super::hands::Hand;
use super::input::{CENTRE, Command, MotionMode, Settings, StepInput};

/// Version of the format.
const VERSION: u32 = 1;
/// What is wrong with a record, and where.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("line {line}: {problem}")]
pub struct RecordError {
    /// Counted from 1.
    pub line: usize,
    /// What, and what to do.
    pub problem: String,
}

/// A line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
enum Line {
    Record(Head),
    Begin(Begin),
    Told(Change),
    End(End),
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Head {
    version: u32,
    /// The program's version; another one may move otherwise.
    program: String,
}

/// What a part is a run of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Begin {
    /// Its id.
    pub exhibit: String,
    /// Constants of the run.
    pub settings: Settings,
}

/// What a part came to.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct End {
    /// Steps done.
    pub steps: u64,
    /// The state's hash, hexadecimal.
    pub state: String,
}

/// What is new in a step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Change {
    step: u64,
    /// Of the breath, m/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    speed: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pointer: Option<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    aspect: Option<f64>,
    /// Of the camera, rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    turn: Option<[f64; 2]>,
    /// A solver's name, or "auto": the exhibit's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    solver: Option<String>,
    /// All that are down.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    hands: Option<Vec<Hand>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    commands: Vec<Command>,
}

/// All that a step was told, but for its commands.
#[derive(Clone, Debug, PartialEq)]
struct Told {
    speed: f64,
    pointer: [f64; 2],
    aspect: f64,
    turn: [f64; 2],
    mode: Option<MotionMode>,
    hands: Vec<Hand>,
}

impl Default for Told {
    fn default() -> Self {
        Self { speed: 0.0, pointer: CENTRE, aspect: 0.0, turn: [0.0; 2], mode: None, hands: Vec::new() }
    }
}

/// Turns steps into lines.
#[derive(Clone, Debug, Default)]
pub struct Recorder {
    told: Told,
}

impl Recorder {
    /// The first line of every record.
    pub fn head() -> String {
        text(&Line::Record(Head { version: VERSION, program: env!("CARGO_PKG_VERSION").into() }))
    }

    /// The line with which a part begins; what was told before is forgotten.
    pub fn begin(&mut self, exhibit: &str, settings: Settings) -> String {
        self.told = Told::default();
        text(&Line::Begin(Begin { exhibit: exhibit.into(), settings }))
    }

    /// The line of a step with this number that was told this and blew with this speed (m/s); `None` where nothing is new.
    pub fn step(&mut self, step: u64, input: &StepInput, speed: f64) -> Option<String> {
        let pointer = input.pointer.unwrap_or(CENTRE);
        let told = &mut self.told;
        // Commanded breaths are in the speed.
        let lasting = input.commands.iter().filter(|command| !matches!(command, Command::Blow(_)));
        let change = Change {
            step,
            speed: (speed != told.speed).then_some(speed),
            pointer: (pointer != told.pointer).then_some(pointer),
            aspect: (input.aspect != told.aspect).then_some(input.aspect),
            turn: (input.turn != told.turn).then_some(input.turn),
            solver: (input.mode != told.mode).then(|| input.mode.map_or("auto", MotionMode::name).into()),
            hands: (input.hands != told.hands).then(|| input.hands.to_vec()),
            commands: lasting.copied().collect(),
        };
        if change == (Change { step, ..Change::default() }) {
            return None;
        }
        (told.speed, told.pointer, told.mode) = (speed, pointer, input.mode);
        (told.aspect, told.turn) = (input.aspect, input.turn);
        told.hands.clear();
        told.hands.extend_from_slice(input.hands);
        Some(text(&Line::Told(change)))
    }

    /// The line with which a part ends.
    pub fn end(steps: u64, state: u64) -> String {
        text(&Line::End(End { steps, state: format!("{state:016x}") }))
    }
}

/// A line as text. Not finite numbers have no form in JSON and become null; the simulation takes none.
fn text(line: &Line) -> String {
    serde_json::to_string(line).unwrap_or_default()
}

/// A run of one exhibit, as it was told.
#[derive(Clone, Debug)]
pub struct Part {
    /// What it is a run of.
    pub begin: Begin,
    /// What it came to; `None` where the record was cut off.
    pub end: Option<End>,
    changes: Vec<Change>,
    /// Of each change, what moves the figure from then on, where that is new.
    modes: Vec<Option<Option<MotionMode>>>,
    next: usize,
    told: Told,
    commands: Vec<Command>,
}

impl Part {
    fn new(begin: Begin) -> Self {
        let (changes, modes, commands) = (Vec::new(), Vec::new(), Vec::new());
        Self { begin, end: None, changes, modes, next: 0, told: Told::default(), commands }
    }

    /// Steps that it lasted; of a record that was cut off, until the last that is known.
    pub fn steps(&self) -> u64 {
        self.end.as_ref().map_or(self.changes.last().map_or(0, |change| change.step + 1), |end| end.steps)
    }

    /// What the step with this number is told; steps are asked for in order.
    pub fn input(&mut self, step: u64) -> StepInput<'_> {
        self.commands.clear();
        while let Some(change) = self.changes.get(self.next).filter(|change| change.step <= step) {
            let told = &mut self.told;
            if let Some(speed) = change.speed {
                told.speed = speed;
                self.commands.push(Command::Blow(Some(speed).filter(|speed| *speed > 0.0)));
            }
            told.pointer = change.pointer.unwrap_or(told.pointer);
            told.aspect = change.aspect.unwrap_or(told.aspect);
            told.turn = change.turn.unwrap_or(told.turn);
            told.mode = self.modes[self.next].unwrap_or(told.mode);
            if let Some(hands) = &change.hands {
                told.hands.clone_from(hands);
            }
            self.commands.extend_from_slice(&change.commands);
            self.next += 1;
        }
        let Told { pointer, aspect, turn, mode, ref hands, .. } = self.told;
        let commands = &self.commands;
        StepInput { pointer: Some(pointer), aspect, turn, mode, hands, commands, ..StepInput::default() }
    }

    /// Takes in a line of the part.
    fn push(&mut self, change: Change) -> Result<(), String> {
        if self.end.is_some() {
            return Err("the part above has ended; begin another".into());
        }
        if self.changes.last().is_some_and(|last| last.step >= change.step) {
            return Err(format!("step {} does not come after the line above", change.step));
        }
        let mode = change.solver.as_deref().map(|name| if name == "auto" { Ok(None) } else { name.parse().map(Some) });
        self.modes.push(mode.transpose()?);
        self.changes.push(change);
        Ok(())
    }
}

/// Reads a record: its parts in order. A last line that was cut off is left out.
pub fn parse(text: &str) -> Result<Vec<Part>, RecordError> {
    let mut parts: Vec<Part> = Vec::new();
    let whole = text.rfind('\n').map_or(0, |end| end + 1);
    let mut lines = text[..whole].lines().enumerate();
    let fail = |line: usize, problem: String| RecordError { line: line + 1, problem };
    let read = |(index, line): (usize, &str)| -> Result<Line, RecordError> {
        serde_json::from_str(line).map_err(|error| fail(index, super::script::reason(&error)))
    };
    match lines.next().map(read).transpose()? {
        Some(Line::Record(Head { version: VERSION, .. })) => {}
        Some(Line::Record(Head { version, .. })) => {
            return Err(fail(0, format!("version {version} of the format is not known here, only {VERSION}")));
        }
        _ => return Err(fail(0, "this is no record; `soffio kiosk --record FILE` makes one".into())),
    }
    for (index, line) in lines {
        let begun = || "nothing has begun; a part starts with a line {\"begin\": …}".to_string();
        let done = match read((index, line))? {
            Line::Record(_) => Err("a record within a record".into()),
            Line::Begin(begin) => {
                parts.push(Part::new(begin));
                Ok(())
            }
            Line::Told(change) => parts.last_mut().ok_or_else(begun).and_then(|part| part.push(change)),
            Line::End(end) => parts.last_mut().ok_or_else(begun).map(|part| part.end = Some(end)),
        };
        done.map_err(|problem| fail(index, problem))?;
    }
    Ok(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_told_comes_back_to_the_bit() {
        let hands = [Hand { id: 7, at: [-0.1, 1.0 / 3.0], body: None }];
        let odd = [0.1 + 0.2, 1.0 / 3.0];
        let inputs = [
            (0.0, StepInput { aspect: 16.0 / 9.0, ..StepInput::default() }),
            (5e-324, StepInput { aspect: 16.0 / 9.0, pointer: Some(odd), ..StepInput::default() }),
            (5e-324, StepInput { aspect: 16.0 / 9.0, pointer: Some(odd), ..StepInput::default() }),
            (
                5e-324,
                StepInput {
                    aspect: 16.0 / 9.0,
                    pointer: Some(odd),
                    turn: [-1.0 / 3.0, 5e-324],
                    ..StepInput::default()
                },
            ),
            (7.3, StepInput { hands: &hands, mode: Some(MotionMode::PositionBased), ..StepInput::default() }),
            (0.0, StepInput { commands: &[Command::Gather(u64::MAX), Command::Reset], ..StepInput::default() }),
            (0.0, StepInput::default()),
        ];
        let mut recorder = Recorder::default();
        let settings = Settings { seed: u64::MAX, breath_gain: 0.1 + 0.7, ..Settings::default() };
        let mut lines = vec![Recorder::head(), recorder.begin("chains", settings)];
        lines.extend(inputs.iter().zip(0..).filter_map(|((speed, input), step)| recorder.step(step, input, *speed)));
        assert_eq!(lines.len(), 2 + 5, "two steps have nothing new");
        lines.push(Recorder::end(7, 0xf3));
        let mut parts = parse(&(lines.join("\n") + "\n")).expect("a good record");
        let [part] = &mut parts[..] else { panic!("{} parts", parts.len()) };
        assert_eq!((&*part.begin.exhibit, part.begin.settings, part.steps()), ("chains", settings, 7));
        let mut speed = 0.0;
        for ((blown, told), step) in inputs.iter().zip(0..) {
            let again = part.input(step);
            for command in again.commands {
                if let Command::Blow(blow) = command {
                    speed = blow.unwrap_or(0.0);
                }
            }
            assert_eq!(speed, *blown, "step {step}");
            assert_eq!(again.pointer, Some(told.pointer.unwrap_or(CENTRE)));
            assert_eq!((again.aspect, again.mode, again.hands), (told.aspect, told.mode, told.hands));
            assert_eq!(again.turn, told.turn);
            let lasting = again.commands.iter().filter(|command| !matches!(command, Command::Blow(_)));
            assert!(lasting.eq(told.commands), "step {step}");
        }
    }

    #[test]
    fn what_was_cut_off_goes_as_far_as_it_goes_and_mistakes_have_their_line() {
        let head = Recorder::head();
        let begin = Recorder::default().begin("chains", Settings::default());
        let cut = format!("{head}\n{begin}\n{{\"told\":{{\"step\":3,\"speed\":2.0}}}}\n{{\"told\":{{\"st");
        let parts = parse(&cut).expect("as far as it goes");
        assert_eq!((parts.len(), parts[0].steps()), (1, 4));
        for (text, line) in [
            ("{\"t\": 1}\n".to_string(), 1),
            ("\n".into(), 1),
            (format!("{head}\n{{\"told\":{{\"step\":3}}}}\n"), 2),
            (format!("{head}\n{begin}\n{{\"told\":{{\"step\":3,\"speeed\":1}}}}\n"), 3),
            (format!("{head}\n{begin}\n{{\"told\":{{\"step\":3}}}}\n{{\"told\":{{\"step\":3}}}}\n"), 4),
            (format!("{head}\n{begin}\n{{\"told\":{{\"step\":3,\"solver\":\"magic\"}}}}\n"), 3),
            (head.replace("1,", "9,") + "\n", 1),
        ] {
            assert_eq!(parse(&text).expect_err("a mistake").line, line, "{text}");
        }
    }
}
