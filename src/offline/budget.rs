//! Step-time check: does an exhibit meet the deadline of 4.17 ms for a step of 1/240 s, whatever visitors do
//! ([`load`](super::load))?
//!
//! It measures processor time. A count of operations would be the same on every machine, but its weights would be wrong
//! after every change of the engine. Time depends on the machine, so the kiosk itself decides in the end. A late step
//! is run again from the start of its load, and the lesser time counts, so that other work on the machine does not
//! matter. Each kind of load ends with its first late step, and the whole check after [`MAX_CHECK_SECONDS`] seconds.

use std::sync::Arc;

use super::load::{LoadRun, StressLoad, loads};
use super::scene::times::timed;
use soffio_exhibit::{Diagnostic, Exhibit, codes};
use soffio_multibody::articulation::ConstraintKind;
use soffio_simulation::STEPS_PER_SECOND;

/// Deadline of a step, s.
const BUDGET: f64 = 1.0 / STEPS_PER_SECOND as f64;
/// Number of random assemblies, and duration of breath, s.
pub const SEEDS: u64 = 20;
const BREATH_SECONDS: f64 = 10.0;
/// Approximate processor time of the whole check, s.
pub const MAX_CHECK_SECONDS: f64 = 10.0;
/// Number of contact points that explains a late step.
const MANY_CONTACTS: usize = 8;
/// Number of substeps that explains a late step.
const MANY_SUBSTEPS: u32 = 4;

/// A step that misses the deadline.
#[derive(Clone, Debug, PartialEq)]
pub struct LateStep {
    /// The load.
    pub load: StressLoad,
    /// Index of the step.
    pub step: usize,
    /// Its processor time, s.
    pub seconds: f64,
    /// Explanation for curators.
    pub cause: String,
}

/// Result of the check.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// The first late step of each kind of load.
    pub late: Vec<LateStep>,
    /// Number of loads that were run to their end or to a late step.
    pub tried: usize,
    /// Number of all loads.
    pub of: usize,
}

/// Runs an exhibit under all stress loads and finds the steps that a kiosk could not compute in time.
pub fn check(exhibit: &Arc<Exhibit>) -> Findings {
    check_within(exhibit, BUDGET, MAX_CHECK_SECONDS)
}

/// As [`check`], with another deadline (s) and another limit of the whole check (s).
pub fn check_within(exhibit: &Arc<Exhibit>, bound: f64, most: f64) -> Findings {
    let loads = loads(exhibit, SEEDS, BREATH_SECONDS);
    let mut findings = Findings { of: loads.len(), ..Findings::default() };
    let mut left = most;
    let kind = |load: &StressLoad| std::mem::discriminant(load);
    for load in loads {
        if findings.late.iter().any(|late| kind(&late.load) == kind(&load)) {
            findings.of -= 1;
            continue;
        }
        if left <= 0.0 {
            continue;
        }
        findings.tried += 1;
        let (late, took) = first_late(exhibit, load, bound, left);
        findings.late.extend(late);
        left -= took;
    }
    findings
}

/// The first step of a load that takes longer than `bound` in both runs, and the time used, which is limited to `most`,
/// s.
fn first_late(exhibit: &Arc<Exhibit>, load: StressLoad, bound: f64, most: f64) -> (Option<LateStep>, f64) {
    let mut run = LoadRun::new(exhibit, load);
    let mut took = 0.0;
    for step in 0..run.steps() {
        let (seconds, ()) = timed(|| run.step());
        took += seconds;
        if seconds > bound {
            let mut again = LoadRun::new(exhibit, load);
            let (before, ()) = timed(|| (0..step).for_each(|_| again.step()));
            let (second, ()) = timed(|| again.step());
            took += before + second;
            let seconds = seconds.min(second);
            if seconds > bound {
                return (Some(LateStep { load, step, seconds, cause: cause(&again) }), took);
            }
        }
        if took > most {
            break;
        }
    }
    (None, took)
}

/// Explanation of the last step's cost.
fn cause(run: &LoadRun) -> String {
    let exhibit = run.simulation.exhibit();
    let mut causes = Vec::new();
    let name = |body: usize| exhibit.bodies[body].name.as_str();
    let mut touches = vec![0; exhibit.bodies.len()];
    let mut points = 0;
    for touching in run.simulation.touching() {
        points += 1;
        touching.bodies.iter().flatten().for_each(|&body| touches[body] += 1);
    }
    let most = (0..touches.len()).max_by_key(|&body| (touches[body], std::cmp::Reverse(body)));
    if let Some(most) = most.filter(|_| points >= MANY_CONTACTS) {
        causes.push(format!("parts touch at {points} points, {} of them on \"{}\"", touches[most], name(most)));
    }
    let loops = closing_joints(exhibit);
    if loops > 0 {
        causes.push(format!("closed loops: {loops} joint{}", if loops == 1 { "" } else { "s" }));
    }
    let substeps = run.simulation.snapshot().diagnostics.substeps;
    if substeps >= MANY_SUBSTEPS {
        causes.push(format!("something light or fast asks for {substeps} substeps"));
    }
    if causes.is_empty() {
        causes.push(format!("{} bodies and {} shapes that collide", exhibit.bodies.len(), exhibit.colliders.len()));
    }
    causes.join("; ")
}

/// Number of loop-closing joints: joints between bodies that other joints already connect.
fn closing_joints(exhibit: &Exhibit) -> usize {
    // The world is one more body; a body's group is the least body that joints connect it to.
    let world = exhibit.bodies.len();
    let mut group: Vec<usize> = (0..=world).collect();
    let mut joined: Vec<[usize; 2]> = Vec::new();
    for constraint in &exhibit.constraints {
        let bodies = match &constraint.kind {
            ConstraintKind::PointToPoint { a, b } => [a.body, b.body],
            ConstraintKind::PointOnPlane { point, plane, .. } => [point.body, plane.body],
            ConstraintKind::Orientation { a, b, .. } => [a.body, b.body],
            ConstraintKind::Coupling { .. } => continue,
        };
        let mut bodies = bodies.map(|body| body.unwrap_or(world));
        bodies.sort_unstable();
        if !joined.contains(&bodies) {
            joined.push(bodies);
        }
    }
    let closes = |[a, b]: [usize; 2]| {
        let (first, second) = (group[a], group[b]);
        group.iter_mut().filter(|group| **group == second).for_each(|group| *group = first);
        first == second
    };
    joined.into_iter().map(closes).filter(|closes| *closes).count()
}

impl LateStep {
    /// The result as a warning about the exhibit of this name.
    pub fn warning(&self, exhibit: &str) -> Diagnostic {
        let Self { load, step, seconds, cause } = self;
        let at = *step as f64 / STEPS_PER_SECOND as f64;
        let message = format!(
            "{exhibit}: a step takes {:.1} ms here, {at:.2} s after the beginning of: {load}; a kiosk has {:.2} ms for it \
             ({cause})",
            1e3 * seconds,
            1e3 * BUDGET
        );
        let fewer = match load {
            StressLoad::Assembly(_) => "fewer joints that close loops, or `assembly_animation = false` under [scene]",
            StressLoad::Breath(_) | StressLoad::Drag => {
                "fewer parts that touch at once, simpler shapes, fewer joints that close loops"
            }
        };
        let help = format!("{fewer}; `soffio bench {exhibit}` reports its longest steps, on the kiosk too");
        Diagnostic::new(codes::LATE, message).help(help)
    }
}
