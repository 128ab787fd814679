//! Comparison of constrained dynamics with another motion mode: both run on the same input, and their differences are
//! measured.
//!
//! Over the n bodies that are not kinematic, with d the distance of the two positions of a node and θ the angle between
//! its two rotations,
//!
//! ```text
//! rms = √(Σ d²/n)      and likewise for θ
//! ```
//!
//! Events are compared in order by kind and bodies; the first difference is reported.

use std::io::{Cursor, Write};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::Serialize;

use super::atomic_file::AtomicFile;
use super::feed::WavFeed;
use super::play::{Play, PlayError};
use super::sound_page::canvas::{Align, Canvas, FIRST, INK, PALE, SECOND};
use super::sound_page::chart::{Axis, Chart};
use soffio_exhibit::Exhibit;
use soffio_geometry::bodies::RigidBody;
use soffio_math::atan2;
use soffio_simulation::{Event, MotionMode, STEPS_PER_SECOND, Script, Simulation, StepInput};

/// Distance from which on the runs count as different, m.
const SEPARATION: f64 = 1e-3;
/// Size of the picture, pixels.
const WIDTH: u32 = 1200;
const HEIGHT: u32 = 1180;
/// Smallest range of a chart, J, mm or degrees.
const MIN_CHART_RANGE: f64 = 1e-9;

/// Difference of the runs at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DifferenceSample {
    /// Time, s.
    pub t: f64,
    /// Position difference: rms and largest, m.
    pub position: [f64; 2],
    /// Rotation difference: rms and largest, degrees.
    pub rotation: [f64; 2],
    /// Energy of constrained dynamics and of the other mode, J.
    pub energy: [f64; 2],
    /// Number of events so far.
    pub events: [u64; 2],
}

/// An event of one of the runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EventSummary {
    /// Time, s.
    pub t: f64,
    /// Kind of the event.
    pub kind: &'static str,
    /// Names of the bodies.
    pub bodies: [Option<String>; 2],
}

/// The first difference of the events: the `index`th of each run; `None` where a run has no more.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FirstDifference {
    /// Index, from 0.
    pub index: usize,
    /// Event of constrained dynamics.
    pub dynamics: Option<EventSummary>,
    /// Event of the other mode.
    pub other: Option<EventSummary>,
}

/// Result of a comparison, in the fields of the command's output.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Name of the other motion mode.
    pub solver: &'static str,
    /// Number of steps.
    pub steps: u64,
    /// Number of bodies compared.
    pub bodies: usize,
    /// Rms position difference over all bodies and steps, m.
    pub rms_m: f64,
    /// Largest position difference, m.
    pub max_m: f64,
    /// Body of the largest position difference.
    pub max_m_body: String,
    /// Time of the largest position difference, s.
    pub max_m_at_s: f64,
    /// Rms rotation difference over all bodies and steps, degrees.
    pub rms_deg: f64,
    /// Largest rotation difference, degrees.
    pub max_deg: f64,
    /// Rms position difference at the end, m.
    pub end_rms_m: f64,
    /// Time at which a body first differs by more than 1 mm, s; `None` where none does.
    pub apart_1mm_s: Option<f64>,
    /// Mechanical energy at the end by constrained dynamics, J.
    pub energy_dynamics_j: f64,
    /// Mechanical energy at the end by the other motion mode, J.
    pub energy_other_j: f64,
    /// Rms difference of the mechanical energies over all steps, J.
    pub energy_rms_j: f64,
    /// Largest difference of the mechanical energies, J.
    pub energy_max_j: f64,
    /// Largest joint error of constrained dynamics and of the other mode, m.
    pub max_joint_error_m: [f64; 2],
    /// Number of events of constrained dynamics.
    pub events_dynamics: u64,
    /// Number of events of the other mode.
    pub events_other: u64,
    /// First difference of the events.
    pub first_difference: Option<FirstDifference>,
    /// Number of invalid states that were found and recovered, by constrained dynamics and by the other mode.
    pub faults: [u64; 2],
    /// Seed of both runs.
    pub seed: u64,
}

/// Two runs of an exhibit, and their differences in each frame.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Summary.
    pub summary: Summary,
    /// A sample for each frame.
    pub samples: Vec<DifferenceSample>,
}

/// Runs an exhibit by constrained dynamics and by `play.mode`. Motion modes in the script are ignored, and no files are
/// written.
///
/// # Errors
/// Where the run is interrupted.
pub fn run(
    exhibit: &Arc<Exhibit>,
    play: Play,
    stop: &AtomicBool,
    mut on_step: impl FnMut(u64),
) -> Result<Comparison, PlayError> {
    let Play { settings, mut breath, aim, mut script, mode, seconds, aspect, fps, .. } = play;
    let mut dynamics = Simulation::new(exhibit.clone(), settings);
    let mut other = Simulation::new(exhibit.clone(), settings);
    let steps = (seconds * STEPS_PER_SECOND as f64).round() as u64;
    let mut difference = DifferenceMeter::new(exhibit, steps);
    let (mut samples, mut commands, mut hands) = (Vec::new(), Vec::new(), Vec::new());
    let mut events = [Vec::new(), Vec::new()];
    let mut joints = [0.0_f64; 2];
    let mut frame = 0;
    let mut now = DifferenceSample::default();
    for step in 0..=steps {
        let t = step as f64 / STEPS_PER_SECOND as f64;
        now = difference.measure(t, [&dynamics, &other], [events[0].len() as u64, events[1].len() as u64]);
        while frame * STEPS_PER_SECOND <= step * u64::from(fps.max(1)) {
            samples.push(now);
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
        for (run, mode) in [(&mut dynamics, Some(MotionMode::Dynamic)), (&mut other, mode)] {
            if let Some(script) = &mut script {
                script.pointer_grabs(run, aspect, &mut hands);
            }
            run.step(&StepInput { mode, pointer_grabs: &hands, ..input });
        }
        for ((events, run), joint) in events.iter_mut().zip([&dynamics, &other]).zip(&mut joints) {
            events.extend(run.events().iter().map(|event| summarize_event(event, exhibit)));
            *joint = joint.max(run.joint_error());
        }
        on_step(step + 1);
        if stop.load(Ordering::Relaxed) {
            return Err(PlayError::Interrupted);
        }
    }
    let faults = [&dynamics, &other].map(|run| run.snapshot().diagnostics.faults);
    let [rms_m, rms_deg, energy_rms_j] = difference.sums.map(f64::sqrt);
    let summary = Summary {
        solver: mode.unwrap_or_default().name(),
        steps,
        bodies: difference.moving.len(),
        rms_m,
        max_m: difference.farthest.0,
        max_m_body: exhibit.bodies.get(difference.farthest.1).map(|body| body.name.clone()).unwrap_or_default(),
        max_m_at_s: difference.farthest.2,
        rms_deg,
        max_deg: difference.max_rotation,
        end_rms_m: now.position[0],
        apart_1mm_s: difference.first_apart,
        energy_dynamics_j: now.energy[0],
        energy_other_j: now.energy[1],
        energy_rms_j,
        energy_max_j: difference.energy_max,
        max_joint_error_m: joints,
        events_dynamics: events[0].len() as u64,
        events_other: events[1].len() as u64,
        first_difference: first_difference(&events),
        faults,
        seed: settings.seed,
    };
    Ok(Comparison { summary, samples })
}

/// Accumulates the differences of two runs.
struct DifferenceMeter {
    /// Indices of the bodies compared.
    moving: Vec<usize>,
    steps: u64,
    /// Mean squares over all steps: positions, rotations, energies.
    sums: [f64; 3],
    /// Largest position difference: distance, m, body, and time, s.
    farthest: (f64, usize, f64),
    /// Largest rotation difference, degrees.
    max_rotation: f64,
    /// Largest difference of the mechanical energies, J.
    energy_max: f64,
    /// Time at which a body first differed by more than [`SEPARATION`], s.
    first_apart: Option<f64>,
}

impl DifferenceMeter {
    fn new(exhibit: &Exhibit, steps: u64) -> Self {
        let moving =
            (0..exhibit.bodies.len()).filter(|body| exhibit.drives.iter().all(|drive| drive.body != *body)).collect();
        Self {
            moving,
            steps,
            sums: [0.0; 3],
            farthest: (0.0, 0, 0.0),
            max_rotation: 0.0,
            energy_max: 0.0,
            first_apart: None,
        }
    }

    /// Takes the runs at `t` seconds, with their numbers of events; returns the present difference.
    fn measure(&mut self, t: f64, [dynamics, other]: [&Simulation; 2], events: [u64; 2]) -> DifferenceSample {
        let energy = [dynamics.energy(), other.energy()];
        let mut now = DifferenceSample { t, energy, events, ..DifferenceSample::default() };
        for &body in &self.moving {
            let (d, turn) = difference(&dynamics.bodies()[body], &other.bodies()[body]);
            let n = self.moving.len() as f64;
            now.position = [now.position[0] + d * d / n, now.position[1].max(d)];
            now.rotation = [now.rotation[0] + turn * turn / n, now.rotation[1].max(turn)];
            if d > self.farthest.0 {
                self.farthest = (d, body, t);
            }
        }
        let gap = energy[0] - energy[1];
        for (sum, square) in self.sums.iter_mut().zip([now.position[0], now.rotation[0], gap * gap]) {
            *sum += square / (self.steps + 1) as f64;
        }
        (now.position[0], now.rotation[0]) = (now.position[0].sqrt(), now.rotation[0].sqrt());
        (self.max_rotation, self.energy_max) = (self.max_rotation.max(now.rotation[1]), self.energy_max.max(gap.abs()));
        self.first_apart = self.first_apart.or((now.position[1] > SEPARATION).then_some(t));
        now
    }
}

/// Distance of a body's node in two states, m, and the angle between its rotations, degrees.
fn difference(one: &RigidBody, other: &RigidBody) -> (f64, f64) {
    let turn = one.rotation.conjugate() * other.rotation;
    let angle = 2.0 * atan2(turn.xyz().length(), turn.w.abs());
    (one.pose().position.distance(other.pose().position), angle.to_degrees())
}

fn summarize_event(event: &Event, exhibit: &Exhibit) -> EventSummary {
    let name = |body: usize| exhibit.bodies[body].name.clone();
    EventSummary { t: event.t, kind: event.kind.name(), bodies: event.bodies.map(|body| body.map(name)) }
}

fn first_difference([dynamics, other]: &[Vec<EventSummary>; 2]) -> Option<FirstDifference> {
    let same = |index: usize| match (dynamics.get(index), other.get(index)) {
        (Some(a), Some(b)) => a.kind == b.kind && a.bodies == b.bodies,
        _ => false,
    };
    let index = (0..dynamics.len().max(other.len())).find(|&index| !same(index))?;
    Some(FirstDifference { index, dynamics: dynamics.get(index).cloned(), other: other.get(index).cloned() })
}

/// What one chart of the picture shows.
struct ChartQuantity<'a> {
    title: &'a str,
    unit: &'a str,
    /// Least range of the vertical axis.
    min_range: f64,
}

impl Comparison {
    /// Writes the samples as CSV.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_csv(&self, path: &Path) -> std::io::Result<()> {
        let mut file = AtomicFile::create(path)?;
        writeln!(file, "t,rms_m,max_m,rms_deg,max_deg,energy_dynamics_j,energy_other_j,events_dynamics,events_other")?;
        for DifferenceSample { t, position: place, rotation: turn, energy, events } in &self.samples {
            let ([a, b], [c, d], [e, f], [g, h]) = (place, turn, energy, events);
            writeln!(file, "{t},{a},{b},{c},{d},{e},{f},{g},{h}")?;
        }
        file.finish()
    }

    /// Draws the differences over time as a PNG.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_picture(&self, path: &Path, exhibit: &Exhibit) -> Result<(), PlayError> {
        let mut canvas = Canvas::new(WIDTH, HEIGHT);
        let Summary { solver, rms_m, rms_deg, .. } = &self.summary;
        canvas.words(80.0, 52.0, 32.0, Align::Left, INK, &format!("{}: dynamics and {solver}", exhibit.id));
        let about = format!("apart by {:.3} mm and {rms_deg:.3}° rms over {} bodies", 1e3 * rms_m, self.summary.bodies);
        canvas.words(80.0, 82.0, 18.0, Align::Left, PALE, &about);
        let millimetres = |row: &DifferenceSample| row.position.map(|d| 1e3 * d);
        let quantity = |title, unit, min_range| ChartQuantity { title, unit, min_range };
        let positions = quantity("Position difference", "mm", MIN_CHART_RANGE);
        self.chart(&mut canvas, 0, positions, ["rms", "largest"], millimetres);
        let rotations = quantity("Rotation difference", "degrees", MIN_CHART_RANGE);
        self.chart(&mut canvas, 1, rotations, ["rms", "largest"], |row| row.rotation);
        let energy = quantity("Energy", "J", MIN_CHART_RANGE);
        self.chart(&mut canvas, 2, energy, ["dynamics", solver], |row| row.energy);
        let events = quantity("Events so far", "", 1.0);
        self.chart(&mut canvas, 3, events, ["dynamics", solver], |row| row.events.map(|n| n as f64));
        let mut bytes = Vec::new();
        let packed = canvas.finish().write_to(&mut Cursor::new(&mut bytes), image::ImageFormat::Png);
        packed.map_err(|error| PlayError::Output(error.to_string()))?;
        let mut file = AtomicFile::create(path)?;
        file.write_all(&bytes)?;
        Ok(file.finish()?)
    }

    /// Two curves over time in the `index`th chart from the top.
    fn chart(
        &self,
        canvas: &mut Canvas,
        index: usize,
        quantity: ChartQuantity,
        names: [&str; 2],
        of: impl Fn(&DifferenceSample) -> [f64; 2],
    ) {
        let ChartQuantity { title, unit, min_range } = quantity;
        let values = || self.samples.iter().flat_map(&of);
        let high = values().fold(f64::MIN, f64::max);
        let low = values().fold(high, f64::min);
        // Magnitudes begin at zero, energies at their least value.
        let low = if low >= 0.0 && low < 0.5 * high { 0.0 } else { low };
        let margin = 0.05 * (high - low).max(MIN_CHART_RANGE);
        let last = self.samples.last().map_or(1.0, |row| row.t).max(MIN_CHART_RANGE);
        let top = 130.0 + 262.0 * index as f64;
        let chart = Chart {
            place: [80.0, top, 1080.0, 185.0],
            x: Axis::linear(0.0, last),
            y: Axis::linear(if low == 0.0 { 0.0 } else { low - margin }, (high + margin).max(low + min_range)),
        };
        chart.frame(canvas, title, "s", unit);
        let mut x = 260.0;
        for (k, (name, colour)) in names.into_iter().zip([FIRST, SECOND]).enumerate() {
            let points: Vec<[f64; 2]> = self.samples.iter().map(|row| chart.point(row.t, of(row)[k])).collect();
            canvas.path(&points, 1.5, colour);
            x += canvas.words(x, top - 12.0, 15.0, Align::Left, colour, name) + 20.0;
        }
    }
}
