//! Scripts: a visitor's actions over time, as JSON lines in time order.
//!
//! ```text
//! {"t": 0.5, "aim": [0.4, 0.5]}
//! {"t": 1.0, "blow": 8.0}                                              m/s at the lips, until the next blow
//! {"t": 4.0, "blow": {"strength": 0.6, "attack": 0.1, "hold": 0.8, "release": 0.3}}
//! {"t": 9.0, "reset": true}
//! {"t": 9.2, "gather": 7}                         a reset with assembly animation; the number is its seed
//! {"t": 9.4, "calm": true}                        idle damping at once, if the exhibit has any
//! {"t": 9.5, "solver": "procedural"}              or "dynamics", "position-based", "auto" (the run's own): from then on
//! {"t": 10.0, "grab": {"at": [0.4, 0.6]}}                              or {"body": "Fish"}, by its centre of mass
//! {"t": 10.5, "drag": [0.7, 0.5]}                                      at once; the body follows
//! {"t": 11.0, "release": true}
//! ```
//!
//! Several pointers have numbers: `"hand": 1` beside `grab`, `drag` and `release`; the default is 0. A script reads no file and
//! no clock: [`Script::due`] is called once a step.

use serde::Deserialize;

use super::input::{Command, MotionMode};
use super::pointer_grabs::PointerGrab;
use super::step::Simulation;
use soffio_exhibit::Exhibit;

/// Source speed of strength 1, m/s: a hard blow, 180 L/min through lips of 15 mm.
const FULL_SPEED: f64 = 17.0;

/// Error in a script, with its line.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("line {line}: {problem}")]
pub struct ScriptError {
    /// Counted from 1.
    pub line: usize,
    /// Problem and remedy.
    pub problem: String,
}

/// One line of a script.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScriptLine {
    t: f64,
    aim: Option<[f64; 2]>,
    blow: Option<BlowAction>,
    reset: Option<bool>,
    #[serde(rename = "gather")]
    assemble: Option<u64>,
    #[serde(rename = "calm")]
    settle: Option<bool>,
    solver: Option<String>,
    grab: Option<GrabTarget>,
    drag: Option<[f64; 2]>,
    release: Option<bool>,
    #[serde(default, rename = "hand")]
    pointer: u64,
    language: Option<String>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum BlowAction {
    Speed(f64),
    Envelope(Envelope),
}

/// What a pointer grabs.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, rename_all = "lowercase")]
enum GrabTarget {
    /// The body at this place of the picture.
    At([f64; 2]),
    /// A body by its name.
    Body(String),
}

/// A pointer that is down.
#[derive(Clone, Debug)]
struct PointerDown {
    pointer: u64,
    /// New for each grab.
    id: u64,
    /// `None` until the body's position is known.
    at: Option<[f64; 2]>,
    body: Option<String>,
}

/// Trapezoidal envelope of a blow; times in s.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct Envelope {
    strength: f64,
    #[serde(default = "tenth")]
    attack: f64,
    #[serde(default = "one")]
    hold: f64,
    #[serde(default = "tenth")]
    release: f64,
}

fn tenth() -> f64 {
    0.1
}

fn one() -> f64 {
    1.0
}

impl Envelope {
    /// Source speed `t` seconds after its beginning, m/s; `None` when it is over.
    fn speed(&self, t: f64) -> Option<f64> {
        let rise = if self.attack > 0.0 { (t / self.attack).min(1.0) } else { 1.0 };
        let falling = t - self.attack - self.hold;
        let fall = if falling <= 0.0 {
            1.0
        } else if falling < self.release {
            1.0 - falling / self.release
        } else {
            return None;
        };
        Some(FULL_SPEED * self.strength * rise * fall)
    }
}

#[derive(Clone, Debug, PartialEq)]
enum Action {
    Aim([f64; 2]),
    Speed(f64),
    Envelope(Envelope),
    Reset,
    Assemble(u64),
    Settle,
    Solver(Option<MotionMode>),
    Grab { pointer: u64, target: GrabTarget },
    Drag { pointer: u64, at: [f64; 2] },
    Release { pointer: u64 },
}

/// A script that is being played.
#[derive(Clone, Debug, Default)]
pub struct Script {
    /// Each with its time, s.
    actions: Vec<(f64, Action)>,
    /// Bodies that are grabbed by their names, each with its line.
    named: Vec<(usize, String)>,
    /// Index of the next action.
    next: usize,
    down: Vec<PointerDown>,
    /// Grabs so far.
    grabs: u64,
    aim: Option<[f64; 2]>,
    /// The present envelope and its start, s.
    envelope: Option<(f64, Envelope)>,
    mode: Option<MotionMode>,
}

impl Script {
    /// Reads a script.
    ///
    /// # Errors
    /// The first line that cannot be read.
    pub fn parse(text: &str) -> Result<Self, ScriptError> {
        let mut actions: Vec<(f64, Action)> = Vec::new();
        let mut named = Vec::new();
        for (index, text) in text.lines().enumerate().filter(|(_, text)| !text.trim().is_empty()) {
            let fail = |problem: String| ScriptError { line: index + 1, problem };
            let line: ScriptLine = serde_json::from_str(text).map_err(|error| fail(reason(&error)))?;
            if !(line.t >= 0.0 && line.t.is_finite()) {
                return Err(fail(format!("t = {} is not a time; give seconds from 0", line.t)));
            }
            if actions.last().is_some_and(|&(t, _)| t > line.t) {
                return Err(fail(format!("t = {} comes before the line above; keep the lines in time order", line.t)));
            }
            if let Some(solver) = line.solver {
                let mode = if solver == "auto" { Ok(None) } else { solver.parse().map(Some) };
                let mode = mode.map_err(|problem: String| fail(format!("{problem}, auto")))?;
                actions.push((line.t, Action::Solver(mode)));
            }
            let grabbed =
                line.grab.iter().find_map(|grab| if let GrabTarget::At(at) = grab { Some(*at) } else { None });
            for (what, place) in [("aim", line.aim), ("grab", grabbed), ("drag", line.drag)] {
                if let Some([x, y]) = place.filter(|at| !at.iter().all(|v| (0.0..=1.0).contains(v))) {
                    return Err(fail(format!(
                        "the {what} [{x}, {y}] is outside the picture; give two numbers from 0 to 1"
                    )));
                }
            }
            if let Some(GrabTarget::Body(name)) = &line.grab {
                named.push((index + 1, name.clone()));
            }
            let pointer = line.pointer;
            actions.extend(line.grab.map(|target| (line.t, Action::Grab { pointer, target })));
            actions.extend(line.drag.map(|at| (line.t, Action::Drag { pointer, at })));
            actions.extend((line.release == Some(true)).then_some((line.t, Action::Release { pointer })));
            // The language changes texts only, and an offline run shows none.
            let _ = line.language;
            actions.extend(line.aim.map(|at| (line.t, Action::Aim(at))));
            if let Some(blow) = line.blow {
                let strength = match &blow {
                    BlowAction::Speed(speed) => *speed,
                    BlowAction::Envelope(envelope) => envelope.strength,
                };
                if !(0.0..=100.0).contains(&strength) {
                    return Err(fail(format!("a blow of {strength} is out of range; speeds are m/s, strengths 0…1")));
                }
                let action = match blow {
                    BlowAction::Speed(speed) => Action::Speed(speed),
                    BlowAction::Envelope(envelope) => Action::Envelope(envelope),
                };
                actions.push((line.t, action));
            }
            if line.reset == Some(true) {
                actions.push((line.t, Action::Reset));
            }
            actions.extend(line.assemble.map(|seed| (line.t, Action::Assemble(seed))));
            actions.extend(line.settle.filter(|settle| *settle).map(|_| (line.t, Action::Settle)));
        }
        Ok(Self { actions, named, ..Self::default() })
    }

    /// Checks that the exhibit has all bodies that the script grabs.
    ///
    /// # Errors
    /// The first line that grabs a body that the exhibit does not have.
    pub fn fits(&self, exhibit: &Exhibit) -> Result<(), ScriptError> {
        let known = |name: &String| exhibit.bodies.iter().any(|body| body.name == *name);
        let Some((line, name)) = self.named.iter().find(|(_, name)| !known(name)) else { return Ok(()) };
        let all: Vec<&str> = exhibit.bodies.iter().map(|body| body.name.as_str()).collect();
        let problem = format!("{} has no body \"{name}\"; it has: {}", exhibit.id, all.join(", "));
        Err(ScriptError { line: *line, problem })
    }

    /// Sets `out` to the pointers that are down in the simulation's next step. Bodies that it does not have are skipped.
    pub fn pointer_grabs(&mut self, simulation: &Simulation, aspect: f64, out: &mut Vec<PointerGrab>) {
        out.clear();
        for down in &mut self.down {
            let exhibit = simulation.exhibit();
            let body = down.body.as_ref().map(|name| exhibit.bodies.iter().position(|body| body.name == *name));
            let Some(body) = body.map_or(Some(None), |body| body.map(Some)) else { continue };
            let centre =
                body.and_then(|body| simulation.view(aspect).project(simulation.bodies()[body].position, aspect));
            let at = *down.at.get_or_insert(centre.unwrap_or([0.5, 0.5]));
            out.push(PointerGrab { id: down.id, at, body });
        }
    }

    /// Time of the last action, s.
    pub fn duration(&self) -> f64 {
        self.actions.last().map_or(0.0, |&(t, _)| t)
    }

    /// Present position of the pointer, picture coordinates.
    pub fn aim(&self) -> Option<[f64; 2]> {
        self.aim
    }

    /// Present solver of the script; `None`: the run's own.
    pub fn mode(&self) -> Option<MotionMode> {
        self.mode
    }

    /// Appends the commands that are due at `t` seconds to `out`.
    pub fn due(&mut self, t: f64, out: &mut Vec<Command>) {
        while let Some((at, action)) = self.actions.get(self.next).filter(|(at, _)| *at <= t).cloned() {
            self.next += 1;
            match action {
                Action::Grab { pointer, target } => {
                    self.down.retain(|down| down.pointer != pointer);
                    self.grabs += 1;
                    let (at, body) = match target {
                        GrabTarget::At(at) => (Some(at), None),
                        GrabTarget::Body(name) => (None, Some(name)),
                    };
                    self.down.push(PointerDown { pointer, id: self.grabs, at, body });
                }
                Action::Drag { pointer, at } => {
                    self.down.iter_mut().filter(|down| down.pointer == pointer).for_each(|down| down.at = Some(at));
                }
                Action::Release { pointer } => self.down.retain(|down| down.pointer != pointer),
                Action::Aim(aim) => self.aim = Some(aim),
                Action::Reset => out.push(Command::Reset),
                Action::Assemble(seed) => out.push(Command::Assemble(seed)),
                Action::Settle => out.push(Command::Settle),
                Action::Solver(mode) => self.mode = mode,
                Action::Speed(speed) => {
                    self.envelope = None;
                    out.push(Command::Blow(Some(speed).filter(|s| *s > 0.0)));
                }
                Action::Envelope(envelope) => self.envelope = Some((at, envelope)),
            }
        }
        if let Some((began, envelope)) = self.envelope {
            let speed = envelope.speed(t - began);
            if speed.is_none() {
                self.envelope = None;
            }
            out.push(Command::Blow(speed));
        }
    }
}

/// Message of a serde error with its column; the line is added by the caller.
pub(super) fn reason(error: &serde_json::Error) -> String {
    let said = error.to_string();
    let what = said.rsplit_once(" at line ").map_or(said.as_str(), |(what, _)| what);
    format!("column {}: {what}", error.column())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_envelope_rises_holds_and_falls() {
        let text = r#"{"t": 1.0, "blow": {"strength": 0.5, "attack": 0.2, "hold": 1.0, "release": 0.4}}"#;
        let mut script = Script::parse(text).expect("a good script");
        let mut at = |t: f64| {
            let mut out = Vec::new();
            script.due(t, &mut out);
            out.last().copied()
        };
        assert_eq!(at(0.9), None);
        let close = |command: Option<Command>, speed: f64| matches!(command, Some(Command::Blow(Some(found))) if (found - speed).abs() < 1e-12);
        assert!(close(at(1.1), 0.25 * FULL_SPEED));
        assert!(close(at(2.0), 0.5 * FULL_SPEED));
        assert!(close(at(2.4), 0.25 * FULL_SPEED));
        assert_eq!(at(2.7), Some(Command::Blow(None)));
        assert_eq!(at(2.8), None);
    }

    #[test]
    fn errors_have_their_line() {
        let late = "{\"t\": 2, \"aim\": [0, 0]}\n{\"t\": 1, \"reset\": true}";
        assert_eq!(Script::parse(late).expect_err("out of order").line, 2);
        for bad in [
            "{\"t\": 1, \"blwo\": 3}",
            "{\"t\": 1, \"aim\": [0.5, 1.5]}",
            "{\"t\": -1}",
            "{\"t\": 0, \"blow\": 1e9}",
            "not json",
        ] {
            assert_eq!(Script::parse(bad).expect_err("a mistake").line, 1, "{bad}");
        }
    }
}
