//! What a step tells of itself: events, and sounds.

use super::air::{Air, Pointed};
use super::contact_sound::{ContactSound, Scene};
use super::event::{Event, EventKind, Part};
use super::rate::{DT, SAMPLES_PER_STEP};
use super::sonify::{self, Listener, Wires};
use soffio_exhibit::{Exhibit, View};
use soffio_math::DVec3;
use soffio_multibody::dynamics::{Dynamics, Impact};
use soffio_sound::SoundCommand;

/// Room for what happens in one step: more makes its list grow, once.
pub(crate) const LISTED: usize = 256;

/// Events and sounds of a step, and how many there have been.
#[derive(Clone)]
pub(crate) struct Emitter {
    contact_sound: ContactSound,
    wires: Wires,
    pub events: Vec<Event>,
    pub sounds: Vec<SoundCommand>,
    /// Impacts and faults so far.
    pub impacts: u64,
    pub faults: u64,
}

impl Emitter {
    /// Of an exhibit that has been silent so far.
    pub fn new(exhibit: &Exhibit) -> Self {
        Self {
            contact_sound: ContactSound::new(exhibit),
            wires: Wires::new(exhibit),
            events: Vec::with_capacity(LISTED),
            sounds: Vec::with_capacity(LISTED),
            impacts: 0,
            faults: 0,
        }
    }

    /// Forgets the last step.
    pub fn clear(&mut self) {
        self.events.clear();
        self.sounds.clear();
    }

    /// Silences all that sounds, from this sample on.
    pub fn silence(&mut self, sample: u64) {
        self.contact_sound.reset(sample, &mut self.sounds);
        self.sounds.push(SoundCommand::Silence { sample });
    }

    /// Turns what happened in a step into events and sounds: its impacts, and the body with bad numbers if there was a `fault`.
    pub fn emit(
        &mut self,
        (step, view): (u64, &View),
        (dynamics, impacts, fault): (&Dynamics, &[Impact], Option<usize>),
        (air, pointed): (&Air, Pointed),
    ) {
        let listener = Listener::new(view);
        let began = step as f64 * DT;
        let (exhibit, bodies) = (pointed.exhibit, &dynamics.bodies);
        let scene = Scene { exhibit, bodies, listener: &listener };
        for impact in impacts {
            let event = Event::hit(began, impact);
            if event.kind == EventKind::Impact {
                self.impacts += 1;
            }
            self.contact_sound.hit(impact, event.sample, &scene, &mut self.sounds);
            enter(&mut self.events, event);
        }
        let sample = (step + 1) * SAMPLES_PER_STEP;
        self.contact_sound.advance(sample, dynamics.contact_reports(), &scene, &mut self.sounds);
        self.emit_parts(began, exhibit, dynamics);
        if let Some(body) = fault {
            self.faults += 1;
            enter(&mut self.events, Event::fault(began, body, bodies));
        }
        // What is heard is the wind the sculpture feels: a gain on the force is its root on the speed.
        let target = pointed.aim.target;
        let felt = pointed.blown(&air.front);
        let felt = felt.map_or(DVec3::ZERO, |blown| blown.gain.sqrt() * air.wind.breath_at(&blown, target));
        self.wires.turn((sample, felt), exhibit, bodies, &mut self.sounds);
        self.sounds.push(sonify::wind(sample, felt, air.report.gust, target, &listener));
    }

    /// Events of parts that broke or were triggered in the step that `began` then, s.
    fn emit_parts(&mut self, began: f64, exhibit: &Exhibit, dynamics: &Dynamics) {
        // The figure's own clock starts anew with a reset, and rounds.
        let offset = began - (dynamics.time() - DT);
        let mut part = |t: f64, kind, part| {
            enter(&mut self.events, Event::of_part(offset + t, kind, part, exhibit, &dynamics.bodies));
        };
        let (fired, springs_fired) = (dynamics.fired(), dynamics.springs_fired());
        fired.iter().for_each(|&(index, t)| part(t, EventKind::Trigger, Part::Constraint(index)));
        springs_fired.iter().for_each(|&(index, t)| part(t, EventKind::Trigger, Part::Spring(index)));
        let (breaks, spring_breaks) = (dynamics.breaks(), dynamics.spring_breaks());
        breaks.iter().for_each(|b| part(b.time, EventKind::Break, Part::Constraint(b.index)));
        spring_breaks.iter().for_each(|b| part(b.time, EventKind::Break, Part::Spring(b.index)));
    }
}

/// Adds an event in its place in time.
fn enter(events: &mut Vec<Event>, event: Event) {
    let place = events.partition_point(|earlier| earlier.t <= event.t);
    events.insert(place, event);
}
