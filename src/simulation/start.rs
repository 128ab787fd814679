//! How an exhibit starts, and starts anew: at once, or from parts that gather.

use super::calm::Idle;
use super::carrying::Carrying;
use super::gather::{self, Gathering};
use super::{DT, SAMPLES_PER_STEP, STEPS_PER_SECOND, Settings, Simulation};
use soffio_exhibit::Exhibit;
use soffio_geometry::bodies::RigidBody;
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{self, Dynamics, Figure};
use soffio_multibody::procedural::{self, Procedural};
use soffio_sound::SoundCommand;

impl Simulation {
    /// Starts the exhibit anew, in silence.
    pub(super) fn reset(&mut self) {
        self.begin_anew();
        self.front.clear();
        self.hands.clear();
        let sample = self.step * SAMPLES_PER_STEP;
        self.contact_sound.reset(sample, &mut self.sounds);
        self.sounds.push(SoundCommand::Silence { sample });
    }

    /// Starts the exhibit anew from scattered parts, if it gathers itself.
    #[inline(never)] // as `begin_anew`
    pub(super) fn gather(&mut self, seed: u64) {
        self.reset();
        if self.exhibit.gathers {
            let (gathering, scattered) = Gathering::new(&self.exhibit, &self.settings_now(), seed);
            self.dynamics = scattered;
            self.gathering = Some((gathering, (gather::LASTS * STEPS_PER_SECOND as f64) as u64));
        }
    }

    /// Puts the figure where it starts; its time begins. Kept apart from the step, which would else ask for the stack on which a
    /// new figure is made, 140 KB, every time.
    #[inline(never)]
    pub(super) fn begin_anew(&mut self) {
        self.gathering = None;
        let settings = self.settings_now();
        self.dynamics = start_dynamics(&self.exhibit, &settings);
        self.carrying = start_carrying(&self.exhibit, &settings, &self.dynamics.bodies);
        self.procedural = Procedural::new(&self.dynamics, procedural::Settings::default());
        self.start_step = self.step;
        self.idle = Idle::default();
    }

    /// The settings of a run that begins now: the day has gone on.
    fn settings_now(&self) -> Settings {
        let now = |midnight: f64| midnight + self.step as f64 * DT;
        Settings { clock: self.settings.clock.map(now), ..self.settings }
    }

    /// While its parts gather: how far the farthest is from its place, m.
    pub fn gathers_from(&self) -> Option<f64> {
        self.gathering.as_ref().map(|(gathering, _)| gathering.way(&self.dynamics.bodies))
    }
}

/// The exhibit's bodies as they start, a clock's at the hour.
pub(super) fn start_bodies(exhibit: &Exhibit, settings: &Settings) -> Vec<RigidBody> {
    let body = |body: &soffio_exhibit::Body| RigidBody {
        velocity: body.velocity,
        angular_velocity: body.angular_velocity,
        ..RigidBody::at_rest(body.properties, body.pose)
    };
    let mut bodies: Vec<RigidBody> = exhibit.bodies.iter().map(body).collect();
    if let (Some(clock), Some(time)) = (&exhibit.clock, settings.clock) {
        clock.set(time, &mut bodies);
    }
    bodies
}

/// Whoever carries the hands of a clock to the time, where there is one to be set.
pub(super) fn start_carrying(exhibit: &Exhibit, settings: &Settings, bodies: &[RigidBody]) -> Option<Carrying> {
    let (clock, time) = exhibit.clock.as_ref().zip(settings.clock)?;
    Some(Carrying::new(clock, bodies, time))
}

/// The exhibit's figure at its start, to be moved by itself: without air, hands and sound.
pub fn start_dynamics(exhibit: &Exhibit, settings: &Settings) -> Dynamics {
    let figure = Figure {
        bodies: start_bodies(exhibit, settings),
        damping: exhibit
            .bodies
            .iter()
            .map(|body| Damping { linear: body.linear_damping, angular: body.angular_damping })
            .collect(),
        constraints: &exhibit.constraints,
        limits: &exhibit.limits,
        springs: &exhibit.springs,
        drives: &exhibit.drives,
        colliders: &exhibit.colliders,
        pairs: exhibit.pairs().meet.into_iter().map(|pair| exhibit.surface_pair(pair)).collect(),
    };
    let dynamics = dynamics::Settings {
        gravity: exhibit.gravity,
        friction: settings.friction,
        stabilization_time: exhibit.stabilization_time,
        integrator: exhibit.integrator,
        solver: exhibit.solver,
    };
    Dynamics::new(figure, dynamics)
}
