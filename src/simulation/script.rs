//! Scripts: what a visitor does over time, as JSON lines in time order.
//!
//! ```text
//! {"t": 0.5, "aim": [0.4, 0.5]}
//! {"t": 1.0, "blow": 8.0}                                              m/s at the lips, until the next blow
//! {"t": 4.0, "blow": {"strength": 0.6, "attack": 0.1, "hold": 0.8, "release": 0.3}}
//! {"t": 9.0, "reset": true}
//! {"t": 9.2, "gather": 7}                       a reset from scattered parts, which gather; the number says where they are
//! {"t": 9.4, "calm": true}                        what still moves comes to rest at once, where the exhibit asks for calm
//! {"t": 9.5, "solver": "procedural"}              or "dynamics", "position-based", "auto" (the run's own): from then on
//! {"t": 10.0, "grab": {"at": [0.4, 0.6]}}                              or {"body": "Fish"}, by its centre of mass
//! {"t": 10.5, "drag": [0.7, 0.5]}                                      at once; the body follows as a hand lets it
//! {"t": 11.0, "release": true}
//! ```
//!
//! Several hands have numbers: `"hand": 1` beside `grab`, `drag` and `release`; without, it is hand 0. A script knows no
//! file and no clock: it is asked once per step for what is due.

use serde::Deserialize;

use super::hands::Hand;
use super::input::{Command, MotionMode};
use super::step::Simulation;
use soffio_exhibit::Exhibit;

/// Source speed of strength 1, m/s: a hard blow, 180 L/min through lips of 15 mm.
const FULL_SPEED: f64 = 17.0;

/// What is wrong with a script, and where.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("line {line}: {problem}")]
pub struct ScriptError {
    /// Counted from 1.
    pub line: usize,
    /// What, and what to do.
    pub problem: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    t: f64,
    aim: Option<[f64; 2]>,
    blow: Option<Blow>,
    reset: Option<bool>,
    gather: Option<u64>,
    calm: Option<bool>,
    solver: Option<String>,
    grab: Option<Grab>,
    drag: Option<[f64; 2]>,
    release: Option<bool>,
    #[serde(default)]
    hand: u64,
    language: Option<String>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Blow {
    Speed(f64),
    Envelope(Envelope),
}

/// What a hand takes.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, rename_all = "lowercase")]
enum Grab {
    /// What lies under this place of the picture.
    At([f64; 2]),
    /// A body by its name.
    Body(String),
}

/// A hand that is down.
#[derive(Clone, Debug)]
struct Down {
    hand: u64,
    /// Whoever takes again is somebody else.
    id: u64,
    /// `None` until the body's place is known.
    at: Option<[f64; 2]>,
    body: Option<String>,
}

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
    Gather(u64),
    Calm,
    Solver(Option<MotionMode>),
    Grab(u64, Grab),
    Drag(u64, [f64; 2]),
    Release(u64),
}

/// A visitor's doings over time.
#[derive(Clone, Debug, Default)]
pub struct Script {
    actions: Vec<(f64, Action)>,
    /// Line of each body that is taken by its name.
    named: Vec<(usize, String)>,
    next: usize,
    down: Vec<Down>,
    /// Grabs so far.
    taken: u64,
    aim: Option<[f64; 2]>,
    envelope: Option<(f64, Envelope)>,
    mode: Option<MotionMode>,
}

impl Script {
    /// Reads a script.
    pub fn parse(text: &str) -> Result<Self, ScriptError> {
        let mut actions: Vec<(f64, Action)> = Vec::new();
        let mut named = Vec::new();
        for (index, text) in text.lines().enumerate().filter(|(_, text)| !text.trim().is_empty()) {
            let fail = |problem: String| ScriptError { line: index + 1, problem };
            let line: Line = serde_json::from_str(text).map_err(|error| fail(reason(&error)))?;
            if !(line.t >= 0.0 && line.t.is_finite()) {
                return Err(fail(format!("t = {} is no time; give seconds from 0", line.t)));
            }
            if actions.last().is_some_and(|&(t, _)| t > line.t) {
                return Err(fail(format!("t = {} comes before the line above; keep the lines in time order", line.t)));
            }
            if let Some(solver) = line.solver {
                let mode = if solver == "auto" { Ok(None) } else { solver.parse().map(Some) };
                let mode = mode.map_err(|problem: String| fail(format!("{problem}, auto")))?;
                actions.push((line.t, Action::Solver(mode)));
            }
            let grabbed = line.grab.iter().find_map(|grab| if let Grab::At(at) = grab { Some(*at) } else { None });
            for (what, place) in [("aim", line.aim), ("grab", grabbed), ("drag", line.drag)] {
                if let Some([x, y]) = place.filter(|at| !at.iter().all(|v| (0.0..=1.0).contains(v))) {
                    return Err(fail(format!(
                        "the {what} [{x}, {y}] is outside the picture; give two numbers from 0 to 1"
                    )));
                }
            }
            if let Some(Grab::Body(name)) = &line.grab {
                named.push((index + 1, name.clone()));
            }
            actions.extend(line.grab.map(|grab| (line.t, Action::Grab(line.hand, grab))));
            actions.extend(line.drag.map(|at| (line.t, Action::Drag(line.hand, at))));
            actions.extend((line.release == Some(true)).then_some((line.t, Action::Release(line.hand))));
            // The language changes words only, and an offline run shows none.
            let _ = line.language;
            actions.extend(line.aim.map(|at| (line.t, Action::Aim(at))));
            if let Some(blow) = line.blow {
                let strength = match &blow {
                    Blow::Speed(speed) => *speed,
                    Blow::Envelope(envelope) => envelope.strength,
                };
                if !(0.0..=100.0).contains(&strength) {
                    return Err(fail(format!("a blow of {strength} is out of range; speeds are m/s, strengths 0…1")));
                }
                let action = match blow {
                    Blow::Speed(speed) => Action::Speed(speed),
                    Blow::Envelope(envelope) => Action::Envelope(envelope),
                };
                actions.push((line.t, action));
            }
            if line.reset == Some(true) {
                actions.push((line.t, Action::Reset));
            }
            actions.extend(line.gather.map(|seed| (line.t, Action::Gather(seed))));
            actions.extend(line.calm.filter(|calm| *calm).map(|_| (line.t, Action::Calm)));
        }
        Ok(Self { actions, named, ..Self::default() })
    }

    /// Says which line takes a body that the exhibit has not.
    pub fn fits(&self, exhibit: &Exhibit) -> Result<(), ScriptError> {
        let known = |name: &String| exhibit.bodies.iter().any(|body| body.name == *name);
        let Some((line, name)) = self.named.iter().find(|(_, name)| !known(name)) else { return Ok(()) };
        let all: Vec<&str> = exhibit.bodies.iter().map(|body| body.name.as_str()).collect();
        let problem = format!("{} has no body \"{name}\"; it has: {}", exhibit.id, all.join(", "));
        Err(ScriptError { line: *line, problem })
    }

    /// The hands that are down, for the simulation's next step. Bodies that it does not have are not taken.
    pub fn hands(&mut self, simulation: &Simulation, aspect: f64, out: &mut Vec<Hand>) {
        out.clear();
        for down in &mut self.down {
            let exhibit = simulation.exhibit();
            let body = down.body.as_ref().map(|name| exhibit.bodies.iter().position(|body| body.name == *name));
            let Some(body) = body.map_or(Some(None), |body| body.map(Some)) else { continue };
            let centre =
                body.and_then(|body| simulation.view(aspect).project(simulation.bodies()[body].position, aspect));
            let at = *down.at.get_or_insert(centre.unwrap_or([0.5, 0.5]));
            out.push(Hand { id: down.id, at, body });
        }
    }

    /// When the last action begins, s.
    pub fn duration(&self) -> f64 {
        self.actions.last().map_or(0.0, |&(t, _)| t)
    }

    /// Where the visitor points now, picture coordinates.
    pub fn aim(&self) -> Option<[f64; 2]> {
        self.aim
    }

    /// What the script says is to move the figure now; `None` leaves it to the run.
    pub fn mode(&self) -> Option<MotionMode> {
        self.mode
    }

    /// Puts the commands due at `t` seconds into `out`.
    pub fn due(&mut self, t: f64, out: &mut Vec<Command>) {
        while let Some((at, action)) = self.actions.get(self.next).filter(|(at, _)| *at <= t).cloned() {
            self.next += 1;
            match action {
                Action::Grab(hand, grab) => {
                    self.down.retain(|down| down.hand != hand);
                    self.taken += 1;
                    let (at, body) = match grab {
                        Grab::At(at) => (Some(at), None),
                        Grab::Body(name) => (None, Some(name)),
                    };
                    self.down.push(Down { hand, id: self.taken, at, body });
                }
                Action::Drag(hand, at) => {
                    self.down.iter_mut().filter(|down| down.hand == hand).for_each(|down| down.at = Some(at));
                }
                Action::Release(hand) => self.down.retain(|down| down.hand != hand),
                Action::Aim(aim) => self.aim = Some(aim),
                Action::Reset => out.push(Command::Reset),
                Action::Gather(seed) => out.push(Command::Gather(seed)),
                Action::Calm => out.push(Command::Calm),
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

/// What serde has to say, with the column alone: the line is that of the script.
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
    fn mistakes_are_told_with_their_line() {
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
