//! A visit to an exhibit and everything that is measured of it.

use std::sync::Arc;

use soffio_exhibit::Exhibit;
use soffio_geometry::bodies::RigidBody;
#[cfg(feature = "kiosk")]
use soffio_kiosk::step::governor::Governor;
use soffio_math::{DVec3, asin, rotation_vector};
use soffio_multibody::articulation::{Anchor, Axis, Constraint, ConstraintKind, LimitKind, SpringKind};
use soffio_simulation::{
    BreathView, Event, EventKind, InspectionScope, SAMPLE_RATE, SAMPLES_PER_STEP, STEPS_PER_SECOND, Script, Settings,
    Simulation, StepInput, WindSample,
};
use soffio_sound::{SoundCommand, Synth};

use super::rendered::Sound;

/// A step, s.
pub const STEP: f64 = 1.0 / STEPS_PER_SECOND as f64;
/// Width over height of the picture that pointers lie in.
const ASPECT: f64 = 16.0 / 9.0;

/// What a visitor does, and for how long.
#[derive(Clone, Copy, Debug)]
pub struct Visit {
    /// Length, s.
    pub seconds: f64,
    /// A script: breaths, hands.
    pub script: &'static str,
    /// Does each step of dynamics take longer there than any budget allows?
    pub slow_machine: bool,
    /// Seed of the air's turbulence.
    pub seed: u64,
}

impl Visit {
    /// A visit on a machine that is fast enough.
    pub const fn new(seconds: f64, script: &'static str) -> Self {
        Self { seconds, script, slow_machine: false, seed: 1 }
    }
}

/// What a step costs on a slow machine, s: by dynamics, and by position-based motion.
#[cfg(feature = "kiosk")]
const SLOW: [f64; 2] = [20e-3, 1e-3];

/// The record of a visit.
pub struct Run {
    /// The exhibit as shipped, which names points, axes and bodies, of a twin too.
    shipped: Arc<Exhibit>,
    /// The exhibit that was visited.
    visited: Arc<Exhibit>,
    /// Bodies at the start and after each step.
    states: Vec<Vec<RigidBody>>,
    /// Largest distance between the two points of a joint after each step, m.
    pub joint_error: f64,
    /// Changes between dynamics and position-based motion that the kiosk chose.
    #[cfg(feature = "kiosk")]
    pub switches: f64,
    /// Everything that happened.
    pub events: Vec<Event>,
    /// Sounds of each step.
    sounds: Vec<Vec<SoundCommand>>,
    /// Bodies that are pressed together after each step, one entry for each point.
    contacts: Vec<Vec<[Option<usize>; 2]>>,
    /// Force of all air on the bodies in each step, N.
    pub wind: Vec<DVec3>,
    /// The air at the patches of the wind surfaces at the end.
    pub air: Vec<WindSample>,
    /// The breath at the end.
    pub breath: BreathView,
}

impl Run {
    /// Plays a visit to `visited`, which is the exhibit as shipped or its twin.
    pub fn new(shipped: &Arc<Exhibit>, visited: Arc<Exhibit>, visit: Visit) -> Self {
        let mut script = Script::parse(visit.script).unwrap_or_else(|error| panic!("{}: {error}", shipped.id));
        script.fits(&visited).unwrap_or_else(|error| panic!("{error}"));
        let mut simulation = Simulation::new(visited.clone(), Settings { seed: visit.seed, ..Settings::default() });
        simulation.disable_dust();
        let steps = (visit.seconds / STEP).round() as usize;
        let mut run = Self {
            shipped: shipped.clone(),
            visited,
            states: vec![simulation.bodies().to_vec()],
            joint_error: 0.0,
            #[cfg(feature = "kiosk")]
            switches: 0.0,
            events: Vec::new(),
            sounds: Vec::new(),
            contacts: vec![Vec::new()],
            wind: Vec::new(),
            air: Vec::new(),
            breath: simulation.snapshot().breath,
        };
        let mut grabs = Vec::new();
        #[cfg(feature = "kiosk")]
        let mut governor = Governor::new(run.visited.motion);
        for step in 0..steps {
            let mut commands = Vec::new();
            script.due(step as f64 * STEP, &mut commands);
            script.pointer_grabs(&simulation, ASPECT, &mut grabs);
            let (pointer, mode) = (script.aim(), script.mode());
            #[cfg(feature = "kiosk")]
            let mode = mode.or(governor.mode());
            simulation.step(&StepInput {
                pointer,
                mode,
                aspect: ASPECT,
                commands: &commands,
                pointer_grabs: &grabs,
                ..StepInput::default()
            });
            #[cfg(feature = "kiosk")]
            if visit.slow_machine && governor.record(SLOW[usize::from(mode.is_some())]) {
                run.switches += 1.0;
            }
            run.states.push(simulation.bodies().to_vec());
            run.joint_error = run.joint_error.max(simulation.joint_error());
            run.wind.push(simulation.snapshot().diagnostics.wind_force);
            run.events.extend_from_slice(simulation.events());
            run.sounds.push(simulation.sounds().to_vec());
            run.contacts.push(simulation.touching().map(|contact| contact.bodies).collect());
        }
        run.air = simulation.inspect(InspectionScope::Wind).wind;
        run.breath = simulation.snapshot().breath;
        run
    }

    /// The moments from `from` to `to`, s, both included.
    pub fn during(&self, from: f64, to: f64) -> impl Iterator<Item = Moment<'_>> {
        let [first, last] = [from, to].map(|t| ((t / STEP).round() as usize).min(self.states.len() - 1));
        (first..=last).map(|step| Moment { run: self, step })
    }

    /// All moments after the first step, which closes what the model's 32-bit points leave open.
    pub fn moments(&self) -> impl Iterator<Item = Moment<'_>> {
        self.during(STEP, f64::MAX)
    }

    /// The moment at `t`, s.
    pub fn at(&self, t: f64) -> Moment<'_> {
        Moment { run: self, step: ((t / STEP).round() as usize).min(self.states.len() - 1) }
    }

    /// The last moment.
    pub fn end(&self) -> Moment<'_> {
        self.at(f64::MAX)
    }

    /// Index of a body.
    pub fn index(&self, name: &str) -> usize {
        let bodies = &self.shipped.bodies;
        bodies.iter().position(|body| body.name == name).unwrap_or_else(|| panic!("no body {name}"))
    }

    /// Constraints of a joint.
    fn parts(&self, joint: &str) -> impl Iterator<Item = &Constraint> {
        let parts = || self.shipped.constraints.iter().filter(move |part| part.group() == joint);
        assert!(parts().next().is_some(), "no joint {joint}");
        parts()
    }

    /// Rotation of a body about a fixed axis of the world after each step, turns added up, rad.
    pub fn turning(&self, body: &str, axis: DVec3) -> Vec<f64> {
        let body = self.index(body);
        let mut angle = 0.0;
        let mut before = self.states[0][body].rotation;
        self.states
            .iter()
            .map(|bodies| {
                let now = bodies[body].rotation;
                angle += rotation_vector(now * before.conjugate()).dot(axis);
                before = now;
                angle
            })
            .collect()
    }

    /// Rotation of a body about a fixed axis in the whole visit, rad.
    pub fn turned(&self, body: &str, axis: DVec3) -> f64 {
        *self.turning(body, axis).last().expect("a start")
    }

    /// Events of a kind.
    pub fn count(&self, kind: EventKind) -> f64 {
        self.events.iter().filter(|event| event.kind == kind).count() as f64
    }

    /// Impacts between two bodies; `None` is the world.
    pub fn hits(&self, one: &str, other: Option<&str>) -> f64 {
        let pair = [Some(self.index(one)), other.map(|other| self.index(other))];
        let of = |event: &&Event| event.bodies == pair || event.bodies == [pair[1], pair[0]];
        self.events.iter().filter(|event| event.kind == EventKind::Impact).filter(of).count() as f64
    }

    /// The sound of the visit without reverb and limiter, mono.
    pub fn sound(&self) -> Sound {
        self.sound_of(|_| true)
    }

    /// The sound of the hits alone.
    pub fn hits_alone(&self) -> Sound {
        self.sound_of(|sound| !matches!(sound, SoundCommand::Wind(_) | SoundCommand::Motion(_)))
    }

    /// The sound of slides alone.
    pub fn slides_alone(&self) -> Sound {
        self.sound_of(|sound| matches!(sound, SoundCommand::Slide(_)))
    }

    /// The sound of the wind alone.
    pub fn wind_alone(&self) -> Sound {
        self.sound_of(|sound| matches!(sound, SoundCommand::Wind(_)))
    }

    fn sound_of(&self, plays: impl Fn(&SoundCommand) -> bool) -> Sound {
        let mut synth = Synth::new(SAMPLE_RATE, &self.visited.instruments, 1).expect("shipped timbres");
        synth.set_dry(true);
        let mut samples = Vec::new();
        let mut block = [0.0_f32; 2 * SAMPLES_PER_STEP as usize];
        for sounds in &self.sounds {
            sounds.iter().copied().filter(&plays).for_each(|sound| synth.command(sound));
            synth.render(&mut block);
            samples.extend(block.as_chunks::<2>().0.iter().map(|[left, right]| 0.5 * f64::from(left + right)));
        }
        Sound { samples }
    }
}

/// One moment of a visit.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    run: &'a Run,
    step: usize,
}

impl<'a> Moment<'a> {
    /// Since the start, s.
    pub fn t(&self) -> f64 {
        self.step as f64 * STEP
    }

    /// All bodies.
    pub fn bodies(&self) -> &'a [RigidBody] {
        &self.run.states[self.step]
    }

    /// A body.
    pub fn body(&self, name: &str) -> &'a RigidBody {
        &self.bodies()[self.run.index(name)]
    }

    /// Distance of a body's centre from where it was at the start, m.
    pub fn way(&self, name: &str) -> f64 {
        self.body(name).position.distance(self.run.at(0.0).body(name).position)
    }

    /// Angle by which a body is rotated from its start, rad.
    pub fn angle(&self, name: &str) -> f64 {
        rotation_vector(self.body(name).rotation * self.run.at(0.0).body(name).rotation.conjugate()).length()
    }

    /// World position of an anchor, m.
    fn point(&self, anchor: &Anchor) -> DVec3 {
        anchor.body.map_or(anchor.point, |body| self.bodies()[body].pose().point(anchor.point))
    }

    /// World direction of an axis.
    fn direction(&self, axis: &Axis) -> DVec3 {
        axis.body.map_or(axis.direction, |body| self.bodies()[body].rotation * axis.direction)
    }

    /// Distance between the two points of a joint, m.
    pub fn gap(&self, joint: &str) -> f64 {
        let gap = |part: &Constraint| match &part.kind {
            ConstraintKind::PointToPoint { a, b } => Some(self.point(a).distance(self.point(b))),
            _ => None,
        };
        greatest(self.run.parts(joint).filter_map(gap))
    }

    /// Greatest angle by which a direction of a joint leaves its right angle, rad.
    pub fn lean(&self, joint: &str) -> f64 {
        let lean = |part: &Constraint| match &part.kind {
            ConstraintKind::Orientation { a, b, .. } => Some(asin(self.direction(a).dot(self.direction(b))).abs()),
            _ => None,
        };
        greatest(self.run.parts(joint).filter_map(lean))
    }

    /// Greatest distance of a joint's point from the joint's planes, m.
    pub fn off_plane(&self, joint: &str) -> f64 {
        let off = |part: &Constraint| match &part.kind {
            ConstraintKind::PointOnPlane { point, plane, normal, .. } => {
                let normal = self.direction(&Axis { body: plane.body, direction: *normal });
                Some(normal.dot(self.point(point) - self.point(plane)).abs())
            }
            _ => None,
        };
        greatest(self.run.parts(joint).filter_map(off))
    }

    /// Length of a drawn cord of the visited exhibit, m; not a number where it has none.
    pub fn cord(&self, name: &str) -> f64 {
        let cord = self.run.visited.cords.iter().find(|cord| cord.name == name);
        cord.map_or(f64::NAN, |cord| cord.length(|body| self.bodies()[body].pose()))
    }

    /// Length of a spring, m.
    pub fn stretch(&self, spring: &str) -> f64 {
        let spring = self.run.shipped.springs.iter().find(|found| found.name == spring).expect("a spring");
        match &spring.kind {
            SpringKind::Linear { a, b } => self.point(a).distance(self.point(b)),
            SpringKind::Angular { .. } => panic!("{} is no linear spring", spring.name),
        }
    }

    /// Distance of the two points that a limit bounds, m.
    pub fn distance(&self, limit: &str) -> f64 {
        let limit = self.run.shipped.limits.iter().find(|found| found.name == limit).expect("a limit");
        match &limit.kind {
            LimitKind::Distance { a, b, .. } => self.point(a).distance(self.point(b)),
            _ => panic!("{} is no limit of a distance", limit.name),
        }
    }

    /// Points at which two bodies are pressed together; `None` is the world.
    pub fn contacts(&self, one: &str, other: Option<&str>) -> f64 {
        let pair = [Some(self.run.index(one)), other.map(|other| self.run.index(other))];
        let touching = &self.run.contacts[self.step];
        touching.iter().filter(|bodies| **bodies == pair || **bodies == [pair[1], pair[0]]).count() as f64
    }
}

/// The greatest of some numbers; of none −∞. A number that is none is the greatest.
pub fn greatest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(f64::NEG_INFINITY, |most, number| if number > most || number.is_nan() { number } else { most })
}

/// The least of some numbers; of none ∞.
pub fn least(numbers: impl Iterator<Item = f64>) -> f64 {
    -greatest(numbers.map(|number| -number))
}
