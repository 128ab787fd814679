//! Records: the inputs of a run, step by step, for an exact replay.
//!
//! A record is JSON lines. It never holds sound: of the microphone it keeps only the detected speed, joined with that of
//! fingers and controllers, as the simulation takes it. Each line holds the changes since the last:
//!
//! ```text
//! {"record": {"version": 1, "program": "0.1.0"}}
//! {"begin": {"exhibit": "steel-fish", "settings": {"profile": "gallery", …}}}     steps count from here
//! {"told": {"step": 0, "aspect": 1.7777777777777777}}
//! {"told": {"step": 812, "speed": 3.25, "pointer": [0.4, 0.5]}}                    m/s; picture coordinates
//! {"told": {"step": 850, "turn": [0.2, -0.1]}}                                     rad, of the camera
//! {"told": {"step": 900, "commands": ["reset"]}}                                   of this step alone
//! {"end": {"steps": 4800, "state": "00f3…"}}                                       hash of the final state
//! ```
//!
//! Another exhibit, or the same one shown again, begins another section. A truncated record lacks its last `end`.
//! Numbers are written as the shortest text that reads back to the same bits.

use serde::{Deserialize, Serialize};

use super::input::{CENTRE, Command, MotionMode, Settings, StepInput};
use super::pointer_grabs::PointerGrab;

/// Version of the format.
const VERSION: u32 = 1;
/// Error in a record, with its line.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("line {line}: {problem}")]
pub struct RecordError {
    /// Counted from 1.
    pub line: usize,
    /// Problem and remedy.
    pub problem: String,
}

/// One line of a record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
enum RecordLine {
    Record(Head),
    Begin(Begin),
    #[serde(rename = "told")]
    Change(Change),
    End(End),
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Head {
    version: u32,
    /// Version of the program; another one may compute other motion.
    program: String,
}

/// Exhibit and settings of a section.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Begin {
    /// Id of the exhibit: the name of its folder.
    pub exhibit: String,
    /// Constants of the run, which a replay needs.
    pub settings: Settings,
}

/// End of a section.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct End {
    /// Steps done.
    pub steps: u64,
    /// Hash of the state, hexadecimal.
    pub state: String,
}

/// Changes of the inputs in a step.
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
    /// All pointers that are down.
    #[serde(rename = "hands", default, skip_serializing_if = "Option::is_none")]
    pointer_grabs: Option<Vec<PointerGrab>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    commands: Vec<Command>,
}

/// All inputs of a step but its commands.
#[derive(Clone, Debug, PartialEq)]
struct InputState {
    speed: f64,
    pointer: [f64; 2],
    aspect: f64,
    turn: [f64; 2],
    mode: Option<MotionMode>,
    pointer_grabs: Vec<PointerGrab>,
}

impl Default for InputState {
    fn default() -> Self {
        Self { speed: 0.0, pointer: CENTRE, aspect: 0.0, turn: [0.0; 2], mode: None, pointer_grabs: Vec::new() }
    }
}

/// Writes steps as lines.
#[derive(Clone, Debug, Default)]
pub struct Recorder {
    last: InputState,
}

impl Recorder {
    /// The first line of every record.
    pub fn head() -> String {
        text(&RecordLine::Record(Head { version: VERSION, program: env!("CARGO_PKG_VERSION").into() }))
    }

    /// The first line of a section. The state of the inputs starts again from zero.
    pub fn begin(&mut self, exhibit: &str, settings: Settings) -> String {
        self.last = InputState::default();
        text(&RecordLine::Begin(Begin { exhibit: exhibit.into(), settings }))
    }

    /// The line of a step with this number, input and source speed (m/s); `None` without changes.
    pub fn step(&mut self, step: u64, input: &StepInput, speed: f64) -> Option<String> {
        let pointer = input.pointer.unwrap_or(CENTRE);
        let last = &mut self.last;
        // Commanded breaths are part of the speed.
        let commands = input.commands.iter().filter(|command| !matches!(command, Command::Blow(_)));
        let change = Change {
            step,
            speed: (speed != last.speed).then_some(speed),
            pointer: (pointer != last.pointer).then_some(pointer),
            aspect: (input.aspect != last.aspect).then_some(input.aspect),
            turn: (input.turn != last.turn).then_some(input.turn),
            solver: (input.mode != last.mode).then(|| input.mode.map_or("auto", MotionMode::name).into()),
            pointer_grabs: (input.pointer_grabs != last.pointer_grabs).then(|| input.pointer_grabs.to_vec()),
            commands: commands.copied().collect(),
        };
        if change == (Change { step, ..Change::default() }) {
            return None;
        }
        (last.speed, last.pointer, last.mode) = (speed, pointer, input.mode);
        (last.aspect, last.turn) = (input.aspect, input.turn);
        last.pointer_grabs.clear();
        last.pointer_grabs.extend_from_slice(input.pointer_grabs);
        Some(text(&RecordLine::Change(change)))
    }

    /// The last line of a section.
    pub fn end(steps: u64, state: u64) -> String {
        text(&RecordLine::End(End { steps, state: format!("{state:016x}") }))
    }
}

/// A line as text. Numbers that are not finite become null, as JSON has no form for them; the simulation accepts none.
fn text(line: &RecordLine) -> String {
    serde_json::to_string(line).unwrap_or_default()
}

/// One section of a record: the inputs of a run of one exhibit.
#[derive(Clone, Debug)]
pub struct RecordSection {
    /// Exhibit and settings.
    pub begin: Begin,
    /// `None` in a truncated record.
    pub end: Option<End>,
    changes: Vec<Change>,
    /// The parsed solver of each change.
    modes: Vec<Option<Option<MotionMode>>>,
    /// Index of the next change.
    next: usize,
    state: InputState,
    commands: Vec<Command>,
}

impl RecordSection {
    fn new(begin: Begin) -> Self {
        let (changes, modes, commands) = (Vec::new(), Vec::new(), Vec::new());
        Self { begin, end: None, changes, modes, next: 0, state: InputState::default(), commands }
    }

    /// Number of steps; of a truncated record, up to its last line.
    pub fn steps(&self) -> u64 {
        self.end.as_ref().map_or(self.changes.last().map_or(0, |change| change.step + 1), |end| end.steps)
    }

    /// The input of the step with this number. Steps must be requested in order.
    pub fn input(&mut self, step: u64) -> StepInput<'_> {
        self.commands.clear();
        while let Some(change) = self.changes.get(self.next).filter(|change| change.step <= step) {
            let state = &mut self.state;
            if let Some(speed) = change.speed {
                state.speed = speed;
                self.commands.push(Command::Blow(Some(speed).filter(|speed| *speed > 0.0)));
            }
            state.pointer = change.pointer.unwrap_or(state.pointer);
            state.aspect = change.aspect.unwrap_or(state.aspect);
            state.turn = change.turn.unwrap_or(state.turn);
            state.mode = self.modes[self.next].unwrap_or(state.mode);
            if let Some(grabs) = &change.pointer_grabs {
                state.pointer_grabs.clone_from(grabs);
            }
            self.commands.extend_from_slice(&change.commands);
            self.next += 1;
        }
        let InputState { pointer, aspect, turn, mode, ref pointer_grabs, .. } = self.state;
        let commands = &self.commands;
        StepInput { pointer: Some(pointer), aspect, turn, mode, pointer_grabs, commands, ..StepInput::default() }
    }

    /// Adds a line.
    fn push(&mut self, change: Change) -> Result<(), String> {
        if self.end.is_some() {
            return Err("the section above has ended; begin another".into());
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

/// Reads a record: its sections in order. A truncated last line is ignored.
///
/// # Errors
/// The first line that cannot be read.
pub fn parse(text: &str) -> Result<Vec<RecordSection>, RecordError> {
    let mut sections: Vec<RecordSection> = Vec::new();
    let complete = text.rfind('\n').map_or(0, |end| end + 1);
    let mut lines = text[..complete].lines().enumerate();
    let fail = |line: usize, problem: String| RecordError { line: line + 1, problem };
    let read = |(index, line): (usize, &str)| -> Result<RecordLine, RecordError> {
        serde_json::from_str(line).map_err(|error| fail(index, super::script::reason(&error)))
    };
    match lines.next().map(read).transpose()? {
        Some(RecordLine::Record(Head { version: VERSION, .. })) => {}
        Some(RecordLine::Record(Head { version, .. })) => {
            return Err(fail(0, format!("version {version} of the format is not known here, only {VERSION}")));
        }
        _ => return Err(fail(0, "this is not a record; `soffio kiosk --record FILE` makes one".into())),
    }
    for (index, line) in lines {
        let not_begun = || "no section has begun; a section starts with a line {\"begin\": …}".to_string();
        let done = match read((index, line))? {
            RecordLine::Record(_) => Err("a record within a record".into()),
            RecordLine::Begin(begin) => {
                sections.push(RecordSection::new(begin));
                Ok(())
            }
            RecordLine::Change(change) => {
                sections.last_mut().ok_or_else(not_begun).and_then(|section| section.push(change))
            }
            RecordLine::End(end) => sections.last_mut().ok_or_else(not_begun).map(|section| section.end = Some(end)),
        };
        done.map_err(|problem| fail(index, problem))?;
    }
    Ok(sections)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_replay_to_the_bit() {
        let grabs = [PointerGrab { id: 7, at: [-0.1, 1.0 / 3.0], body: None }];
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
            (7.3, StepInput { pointer_grabs: &grabs, mode: Some(MotionMode::PositionBased), ..StepInput::default() }),
            (0.0, StepInput { commands: &[Command::Assemble(u64::MAX), Command::Reset], ..StepInput::default() }),
            (0.0, StepInput::default()),
        ];
        let mut recorder = Recorder::default();
        let settings = Settings { seed: u64::MAX, breath_gain: 0.1 + 0.7, ..Settings::default() };
        let mut lines = vec![Recorder::head(), recorder.begin("chains", settings)];
        lines.extend(inputs.iter().zip(0..).filter_map(|((speed, input), step)| recorder.step(step, input, *speed)));
        assert_eq!(lines.len(), 2 + 5, "two steps have nothing new");
        lines.push(Recorder::end(7, 0xf3));
        let mut sections = parse(&(lines.join("\n") + "\n")).expect("a good record");
        let [section] = &mut sections[..] else { panic!("{} sections", sections.len()) };
        assert_eq!((&*section.begin.exhibit, section.begin.settings, section.steps()), ("chains", settings, 7));
        let mut speed = 0.0;
        for ((expected_speed, input), step) in inputs.iter().zip(0..) {
            let again = section.input(step);
            for command in again.commands {
                if let Command::Blow(blow) = command {
                    speed = blow.unwrap_or(0.0);
                }
            }
            assert_eq!(speed, *expected_speed, "step {step}");
            assert_eq!(again.pointer, Some(input.pointer.unwrap_or(CENTRE)));
            assert_eq!(
                (again.aspect, again.mode, again.pointer_grabs),
                (input.aspect, input.mode, input.pointer_grabs)
            );
            assert_eq!(again.turn, input.turn);
            let commands = again.commands.iter().filter(|command| !matches!(command, Command::Blow(_)));
            assert!(commands.eq(input.commands), "step {step}");
        }
    }

    #[test]
    fn truncated_records_are_read_and_errors_have_their_line() {
        let head = Recorder::head();
        let begin = Recorder::default().begin("chains", Settings::default());
        let cut = format!("{head}\n{begin}\n{{\"told\":{{\"step\":3,\"speed\":2.0}}}}\n{{\"told\":{{\"st");
        let sections = parse(&cut).expect("a truncated record");
        assert_eq!((sections.len(), sections[0].steps()), (1, 4));
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
