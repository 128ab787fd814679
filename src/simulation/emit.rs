//! Output of a step: events and sound commands.

use super::air::{AimedBreath, Air};
use super::air_sound::AirSounds;
use super::contact_sound::{ContactSound, SoundScene};
use super::event::{Event, EventKind, EventSource};
use super::motion::Motion;
use super::motion_sound::MotionSounds;
use super::rate::{DT, SAMPLES_PER_STEP};
use super::sonify::AudioListener;
use soffio_exhibit::{Exhibit, View};
use soffio_multibody::dynamics::{Dynamics, Impact};
use soffio_sound::SoundCommand;

/// Initial capacity of the lists of a step; they grow if more happens.
pub(crate) const LIST_CAPACITY: usize = 256;

/// Everything in a step that events and sounds follow from.
pub(crate) struct StepResult<'a> {
    /// The motion after the step.
    pub motion: &'a Motion,
    /// Impacts of the step.
    pub impacts: &'a [Impact],
    /// The first body with invalid numbers.
    pub fault: Option<usize>,
    /// The air after the step.
    pub air: &'a Air,
    /// The breath of the step.
    pub breath: AimedBreath<'a>,
}

/// Events and sounds of the last step, and counts over the run.
#[derive(Clone)]
pub(crate) struct Emitter {
    contact_sound: ContactSound,
    air_sounds: AirSounds,
    motion_sounds: MotionSounds,
    /// Events of the step.
    pub events: Vec<Event>,
    /// Sound commands of the step.
    pub sounds: Vec<SoundCommand>,
    /// Impacts so far.
    pub impacts: u64,
    /// Faults so far.
    pub faults: u64,
}

impl Emitter {
    /// For an exhibit at its start.
    pub fn new(exhibit: &Exhibit, air: &Air) -> Self {
        Self {
            contact_sound: ContactSound::new(exhibit),
            air_sounds: AirSounds::new(exhibit, air),
            motion_sounds: MotionSounds::new(exhibit),
            events: Vec::with_capacity(LIST_CAPACITY),
            sounds: Vec::with_capacity(LIST_CAPACITY),
            impacts: 0,
            faults: 0,
        }
    }

    /// Removes the events and sounds of the last step.
    pub fn clear(&mut self) {
        self.events.clear();
        self.sounds.clear();
    }

    /// Ends all sounds from this sample on.
    pub fn silence(&mut self, sample: u64) {
        self.contact_sound.reset(sample, &mut self.sounds);
        self.air_sounds.reset();
        self.motion_sounds.reset();
        self.sounds.push(SoundCommand::Silence { sample });
    }

    /// Adds the events and sounds of step number `step`, heard and seen from `view`.
    pub fn emit(&mut self, step: u64, view: &View, result: StepResult) {
        let StepResult { motion, impacts, fault, air, breath } = result;
        let listener = AudioListener::new(view);
        let start = step as f64 * DT;
        let (exhibit, bodies) = (breath.exhibit, &motion.dynamics.bodies);
        let scene = SoundScene { exhibit, bodies, listener: &listener };
        for impact in impacts {
            let event = Event::impact(start, impact);
            if event.kind == EventKind::Impact {
                self.impacts += 1;
            }
            self.contact_sound.add_impact(impact, event.sample, &scene, &mut self.sounds);
            insert(&mut self.events, event);
        }
        let sample = (step + 1) * SAMPLES_PER_STEP;
        let contacts = motion.kinds().flat_map(|dynamics| dynamics.contact_reports());
        self.contact_sound.advance(sample, contacts, &scene, &mut self.sounds);
        motion.kinds().for_each(|dynamics| self.emit_breaks_and_triggers(start, exhibit, dynamics));
        if let Some(body) = fault {
            self.faults += 1;
            insert(&mut self.events, Event::fault(start, body, bodies));
        }
        self.air_sounds.update(sample, air, &breath, bodies, &listener, &mut self.sounds);
        self.motion_sounds.update(sample, exhibit, motion, &listener, &mut self.sounds);
    }

    /// Adds the events of constraints and springs that broke or were triggered in the step from `start` (s).
    fn emit_breaks_and_triggers(&mut self, start: f64, exhibit: &Exhibit, dynamics: &Dynamics) {
        // The time of the dynamics restarts at a reset, and is rounded.
        let offset = start - (dynamics.time() - DT);
        let mut emit = |t: f64, kind, source| {
            insert(&mut self.events, Event::of_source(offset + t, kind, source, exhibit, &dynamics.bodies));
        };
        let (fired, springs_fired) = (dynamics.fired(), dynamics.springs_fired());
        fired.iter().for_each(|&(index, t)| emit(t, EventKind::Trigger, EventSource::Constraint(index)));
        springs_fired.iter().for_each(|&(index, t)| emit(t, EventKind::Trigger, EventSource::Spring(index)));
        let (breaks, spring_breaks) = (dynamics.breaks(), dynamics.spring_breaks());
        breaks.iter().for_each(|b| emit(b.time, EventKind::Break, EventSource::Constraint(b.index)));
        spring_breaks.iter().for_each(|b| emit(b.time, EventKind::Break, EventSource::Spring(b.index)));
    }
}

/// Inserts an event in time order.
fn insert(events: &mut Vec<Event>, event: Event) {
    let place = events.partition_point(|earlier| earlier.t <= event.t);
    events.insert(place, event);
}
