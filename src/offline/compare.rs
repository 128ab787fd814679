//! The laws and motion by places side by side: both moved by the same input, step by step, and how far they come apart.
//!
//! Over the bodies that nothing drives, n of them, with d the distance of two places of a node and θ the shorter turn
//! between two rotations of it,
//!
//! ```text
//! rms = √(Σ d²/n)      and the same of θ
//! ```
//!
//! Events are told in order by kind and bodies; where the two runs first differ in that is told.

use std::io::{Cursor, Write};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::Serialize;

use super::feed::WavFeed;
use super::play::{Play, PlayError};
use super::sound_page::canvas::{Align, Canvas, FIRST, INK, PALE, SECOND};
use super::sound_page::chart::{Axis, Chart};
use super::whole_file::WholeFile;
use soffio_exhibit::Exhibit;
use soffio_geometry::bodies::RigidBody;
use soffio_math::atan2;
use soffio_simulation::{Event, MotionMode, STEPS_PER_SECOND, Script, Simulation, StepInput};

/// Farther than this the runs count as apart, m.
const APART: f64 = 1e-3;
/// Pixels of the picture.
const WIDTH: u32 = 1200;
const HEIGHT: u32 = 1180;
/// Energies and ways that fill a chart at least, J, mm and degrees.
const LEAST: f64 = 1e-9;

/// How far the runs are apart at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Row {
    /// s.
    pub t: f64,
    /// Places: rms and farthest body, m.
    pub place: [f64; 2],
    /// Turns, degrees.
    pub turn: [f64; 2],
    /// Energy under the laws, and by places, J.
    pub energy: [f64; 2],
    /// Events so far.
    pub events: [u64; 2],
}

/// An event of one of the runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Told {
    /// s.
    pub t: f64,
    /// What happened.
    pub kind: &'static str,
    /// To whom.
    pub bodies: [Option<String>; 2],
}

/// Where the events of the runs first differ: the `index`th of each; none where that run has no more.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FirstDifference {
    /// From 0.
    pub index: usize,
    /// Under the laws.
    pub dynamics: Option<Told>,
    /// By places.
    pub other: Option<Told>,
}

/// A comparison as numbers. It has 21 fields, because it is the command's output, field by field.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// What stands beside the laws.
    pub solver: &'static str,
    /// Steps done.
    pub steps: u64,
    /// Bodies that nothing drives.
    pub bodies: usize,
    /// Places apart, over all bodies and steps, m.
    pub rms_m: f64,
    /// Farthest body of any step, m.
    pub max_m: f64,
    /// Its name.
    pub max_m_body: String,
    /// When, s.
    pub max_m_at_s: f64,
    /// Turns apart, over all bodies and steps, degrees.
    pub rms_deg: f64,
    /// Largest turn apart, degrees.
    pub max_deg: f64,
    /// At the end, m.
    pub end_rms_m: f64,
    /// When a body was first farther apart than 1 mm, s; null where none was.
    pub apart_1mm_s: Option<f64>,
    /// Energy under the laws at the end, J.
    pub energy_dynamics_j: f64,
    /// Energy by places at the end, J.
    pub energy_other_j: f64,
    /// Their difference over all steps, J.
    pub energy_rms_j: f64,
    /// Its largest size, J.
    pub energy_max_j: f64,
    /// Worst joint of any step: under the laws, by places, m.
    pub max_joint_error_m: [f64; 2],
    /// Events under the laws.
    pub events_dynamics: u64,
    /// Events by places.
    pub events_other: u64,
    /// Where the events first differ.
    pub first_difference: Option<FirstDifference>,
    /// Faults found and mended: under the laws, by places.
    pub faults: [u64; 2],
    /// Seed of both.
    pub seed: u64,
}

/// Two runs of an exhibit, and how far they were apart in each frame.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// As numbers.
    pub summary: Summary,
    /// A row a frame.
    pub rows: Vec<Row>,
}

/// Runs an exhibit by the laws and by `play.mode`. What the input's script says of solvers does not count. Files that
/// `play` names are not written.
pub fn run(
    exhibit: &Arc<Exhibit>,
    play: Play,
    stop: &AtomicBool,
    mut on_step: impl FnMut(u64),
) -> Result<Comparison, PlayError> {
    let Play { settings, mut breath, aim, mut script, mode, seconds, aspect, fps, .. } = play;
    let mut laws = Simulation::new(exhibit.clone(), settings);
    let mut other = Simulation::new(exhibit.clone(), settings);
    let steps = (seconds * STEPS_PER_SECOND as f64).round() as u64;
    let mut apart = Apart::new(exhibit, steps);
    let (mut rows, mut commands, mut hands) = (Vec::new(), Vec::new(), Vec::new());
    let mut told = [Vec::new(), Vec::new()];
    let mut joints = [0.0_f64; 2];
    let mut frame = 0;
    let mut now = Row::default();
    for step in 0..=steps {
        let t = step as f64 / STEPS_PER_SECOND as f64;
        now = apart.measure(t, [&laws, &other], [told[0].len() as u64, told[1].len() as u64]);
        while frame * STEPS_PER_SECOND <= step * u64::from(fps.max(1)) {
            rows.push(now);
            frame += 1;
        }
        if step == steps {
            break;
        }
        commands.clear();
        if let Some(script) = &mut script {
            script.due(t, &mut commands);
        }
        let microphone = breath.as_mut().map(WavFeed::microphone);
        let pointer = script.as_ref().and_then(Script::aim).or(aim);
        let input = StepInput { microphone, pointer, aspect, commands: &commands, ..StepInput::default() };
        for (run, mode) in [(&mut laws, Some(MotionMode::Dynamic)), (&mut other, mode)] {
            if let Some(script) = &mut script {
                script.pointer_grabs(run, aspect, &mut hands);
            }
            run.step(&StepInput { mode, pointer_grabs: &hands, ..input });
        }
        for ((told, run), joint) in told.iter_mut().zip([&laws, &other]).zip(&mut joints) {
            told.extend(run.events().iter().map(|event| tell(event, exhibit)));
            *joint = joint.max(run.joint_error());
        }
        on_step(step + 1);
        if stop.load(Ordering::Relaxed) {
            return Err(PlayError::Interrupted);
        }
    }
    let faults = [&laws, &other].map(|run| run.snapshot().diagnostics.faults);
    let [rms_m, rms_deg, energy_rms_j] = apart.sums.map(f64::sqrt);
    let summary = Summary {
        solver: mode.unwrap_or_default().name(),
        steps,
        bodies: apart.moving.len(),
        rms_m,
        max_m: apart.farthest.0,
        max_m_body: exhibit.bodies.get(apart.farthest.1).map(|body| body.name.clone()).unwrap_or_default(),
        max_m_at_s: apart.farthest.2,
        rms_deg,
        max_deg: apart.turned,
        end_rms_m: now.place[0],
        apart_1mm_s: apart.since,
        energy_dynamics_j: now.energy[0],
        energy_other_j: now.energy[1],
        energy_rms_j,
        energy_max_j: apart.energy_max,
        max_joint_error_m: joints,
        events_dynamics: told[0].len() as u64,
        events_other: told[1].len() as u64,
        first_difference: first_difference(&told),
        faults,
        seed: settings.seed,
    };
    Ok(Comparison { summary, rows })
}

/// How far two runs have been apart so far.
struct Apart {
    /// Bodies that nothing drives.
    moving: Vec<usize>,
    steps: u64,
    /// Mean squares over all steps: places, turns, energies.
    sums: [f64; 3],
    /// Of the farthest body: distance, m, its index, and when, s.
    farthest: (f64, usize, f64),
    /// Largest turn, degrees.
    turned: f64,
    /// Largest difference of energies, J.
    energy_max: f64,
    /// When a body was first farther apart than [`APART`], s.
    since: Option<f64>,
}

impl Apart {
    fn new(exhibit: &Exhibit, steps: u64) -> Self {
        let moving =
            (0..exhibit.bodies.len()).filter(|body| exhibit.drives.iter().all(|drive| drive.body != *body)).collect();
        Self { moving, steps, sums: [0.0; 3], farthest: (0.0, 0, 0.0), turned: 0.0, energy_max: 0.0, since: None }
    }

    /// Takes in the runs at `t` seconds, which have had so many events; how far they are apart now.
    fn measure(&mut self, t: f64, [laws, other]: [&Simulation; 2], events: [u64; 2]) -> Row {
        let energy = [laws.energy(), other.energy()];
        let mut now = Row { t, energy, events, ..Row::default() };
        for &body in &self.moving {
            let (d, turn) = difference(&laws.bodies()[body], &other.bodies()[body]);
            let n = self.moving.len() as f64;
            now.place = [now.place[0] + d * d / n, now.place[1].max(d)];
            now.turn = [now.turn[0] + turn * turn / n, now.turn[1].max(turn)];
            if d > self.farthest.0 {
                self.farthest = (d, body, t);
            }
        }
        let gap = energy[0] - energy[1];
        for (sum, square) in self.sums.iter_mut().zip([now.place[0], now.turn[0], gap * gap]) {
            *sum += square / (self.steps + 1) as f64;
        }
        (now.place[0], now.turn[0]) = (now.place[0].sqrt(), now.turn[0].sqrt());
        (self.turned, self.energy_max) = (self.turned.max(now.turn[1]), self.energy_max.max(gap.abs()));
        self.since = self.since.or((now.place[1] > APART).then_some(t));
        now
    }
}

/// Distance of two states of a body (its node's), m, and the turn between them, degrees.
fn difference(one: &RigidBody, other: &RigidBody) -> (f64, f64) {
    let turn = one.rotation.conjugate() * other.rotation;
    let angle = 2.0 * atan2(turn.xyz().length(), turn.w.abs());
    (one.pose().position.distance(other.pose().position), angle.to_degrees())
}

fn tell(event: &Event, exhibit: &Exhibit) -> Told {
    let name = |body: usize| exhibit.bodies[body].name.clone();
    Told { t: event.t, kind: event.kind.name(), bodies: event.bodies.map(|body| body.map(name)) }
}

fn first_difference([laws, other]: &[Vec<Told>; 2]) -> Option<FirstDifference> {
    let same = |index: usize| match (laws.get(index), other.get(index)) {
        (Some(a), Some(b)) => a.kind == b.kind && a.bodies == b.bodies,
        _ => false,
    };
    let index = (0..laws.len().max(other.len())).find(|&index| !same(index))?;
    Some(FirstDifference { index, dynamics: laws.get(index).cloned(), other: other.get(index).cloned() })
}

impl Comparison {
    /// Writes the rows as CSV.
    pub fn write_rows(&self, path: &Path) -> std::io::Result<()> {
        let mut file = WholeFile::create(path)?;
        writeln!(file, "t,rms_m,max_m,rms_deg,max_deg,energy_dynamics_j,energy_other_j,events_dynamics,events_other")?;
        for Row { t, place, turn, energy, events } in &self.rows {
            let ([a, b], [c, d], [e, f], [g, h]) = (place, turn, energy, events);
            writeln!(file, "{t},{a},{b},{c},{d},{e},{f},{g},{h}")?;
        }
        file.finish()
    }

    /// Draws the differences over time as PNG.
    pub fn write_picture(&self, path: &Path, exhibit: &Exhibit) -> Result<(), PlayError> {
        let mut canvas = Canvas::new(WIDTH, HEIGHT);
        let Summary { solver, rms_m, rms_deg, .. } = &self.summary;
        canvas.words(80.0, 52.0, 32.0, Align::Left, INK, &format!("{}: the laws and {solver}", exhibit.id));
        let about = format!("apart by {:.3} mm and {rms_deg:.3}° rms over {} bodies", 1e3 * rms_m, self.summary.bodies);
        canvas.words(80.0, 82.0, 18.0, Align::Left, PALE, &about);
        let millimetres = |row: &Row| row.place.map(|d| 1e3 * d);
        self.chart(&mut canvas, 0, ("Places apart", "mm", LEAST), ["rms", "farthest"], millimetres);
        self.chart(&mut canvas, 1, ("Turns apart", "degrees", LEAST), ["rms", "largest"], |row| row.turn);
        self.chart(&mut canvas, 2, ("Energy", "J", LEAST), ["laws", solver], |row| row.energy);
        self.chart(&mut canvas, 3, ("Events so far", "", 1.0), ["laws", solver], |row| row.events.map(|n| n as f64));
        let mut bytes = Vec::new();
        let packed = canvas.finish().write_to(&mut Cursor::new(&mut bytes), image::ImageFormat::Png);
        packed.map_err(|error| PlayError::Output(error.to_string()))?;
        let mut file = WholeFile::create(path)?;
        file.write_all(&bytes)?;
        Ok(file.finish()?)
    }

    /// Two curves over time in the `index`th chart from the top, which is at least so high.
    fn chart(
        &self,
        canvas: &mut Canvas,
        index: usize,
        (title, unit, least): (&str, &str, f64),
        names: [&str; 2],
        of: impl Fn(&Row) -> [f64; 2],
    ) {
        let values = || self.rows.iter().flat_map(&of);
        let high = values().fold(f64::MIN, f64::max);
        let low = values().fold(high, f64::min);
        // What is a size begins at nothing; an energy where it is.
        let low = if low >= 0.0 && low < 0.5 * high { 0.0 } else { low };
        let room = 0.05 * (high - low).max(LEAST);
        let last = self.rows.last().map_or(1.0, |row| row.t).max(LEAST);
        let top = 130.0 + 262.0 * index as f64;
        let chart = Chart {
            place: [80.0, top, 1080.0, 185.0],
            x: Axis::linear(0.0, last),
            y: Axis::linear(if low == 0.0 { 0.0 } else { low - room }, (high + room).max(low + least)),
        };
        chart.frame(canvas, title, "s", unit);
        let mut x = 260.0;
        for (k, (name, colour)) in names.into_iter().zip([FIRST, SECOND]).enumerate() {
            let points: Vec<[f64; 2]> = self.rows.iter().map(|row| chart.point(row.t, of(row)[k])).collect();
            canvas.path(&points, 1.5, colour);
            x += canvas.words(x, top - 12.0, 15.0, Align::Left, colour, name) + 20.0;
        }
    }
}
