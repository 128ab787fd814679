//! What moves the figure: the laws, places, or the gathering of its parts, and whoever's hands are on it.

use super::calm::Idle;
use super::carrying::Carrying;
use super::emit::LISTED;
use super::eye::Eye;
use super::gather::{self, Gathering};
use super::hands::Hands;
use super::input::{MotionMode, Profile, Settings, StepInput};
use super::rate::{DT, STEPS_PER_SECOND};
use super::start::{start_carrying, start_dynamics};
use soffio_exhibit::Exhibit;
use soffio_math::spatial::Vec6;
use soffio_multibody::dynamics::{Dynamics, Impact};
use soffio_multibody::procedural::{self, Method, Procedural};
use soffio_wind::force::WindField;

/// The figure in motion, and what moves it.
#[derive(Clone)]
pub(crate) struct Motion {
    pub dynamics: Dynamics,
    pub procedural: Procedural,
    pub hands: Hands,
    pub mode: MotionMode,
    /// While the parts gather: what calls them, and the steps that are left.
    gathering: Option<(Gathering, u64)>,
    /// While the hands of a clock are carried to the time.
    pub carrying: Option<Carrying>,
    pub idle: Idle,
    /// From wind, calm and hands in the present step, N and N m about each centre of mass.
    pub wrenches: Vec<Vec6>,
    /// Of the last step.
    pub impacts: Vec<Impact>,
}

impl Motion {
    /// The exhibit's figure at its start.
    pub fn new(exhibit: &Exhibit, settings: &Settings) -> Self {
        let dynamics = start_dynamics(exhibit, settings);
        Self {
            carrying: start_carrying(exhibit, settings, &dynamics.bodies),
            procedural: Procedural::new(&dynamics, procedural::Settings::default()),
            dynamics,
            hands: Hands::new(exhibit),
            mode: MotionMode::of(exhibit),
            gathering: None,
            idle: Idle::default(),
            wrenches: vec![[0.0; 6]; exhibit.bodies.len()],
            impacts: Vec::with_capacity(LISTED),
        }
    }

    /// Puts the figure where it starts; its time begins. Kept apart from the step, which would else ask for the stack on which a
    /// new figure is made, 140 KB, every time.
    #[inline(never)]
    pub fn begin_anew(&mut self, exhibit: &Exhibit, settings: &Settings) {
        self.gathering = None;
        self.dynamics = start_dynamics(exhibit, settings);
        self.carrying = start_carrying(exhibit, settings, &self.dynamics.bodies);
        self.procedural = Procedural::new(&self.dynamics, procedural::Settings::default());
        self.idle = Idle::default();
    }

    /// Scatters the figure's parts, and calls them together.
    #[inline(never)] // as `begin_anew`
    pub fn gather(&mut self, exhibit: &Exhibit, settings: &Settings, seed: u64) {
        let (gathering, scattered) = Gathering::new(exhibit, settings, seed);
        self.dynamics = scattered;
        self.gathering = Some((gathering, (gather::LASTS * STEPS_PER_SECOND as f64) as u64));
    }

    /// Have the parts come together?
    pub fn has_gathered(&self) -> bool {
        matches!(self.gathering, Some((_, 0)))
    }

    /// While its parts gather: how far the farthest is from its place, m.
    pub fn gathers_from(&self) -> Option<f64> {
        self.gathering.as_ref().map(|(gathering, _)| gathering.way(&self.dynamics.bodies))
    }

    /// Calms what nobody blows at or holds, in the gallery.
    pub fn come_to_rest(&mut self, exhibit: &Exhibit, settings: &Settings, blows: bool) {
        self.idle.advance(blows || self.hands.count() > 0, DT);
        let Settings { profile, friction, .. } = *settings;
        let calm = exhibit.calm.filter(|_| profile == Profile::Gallery && friction);
        if let Some(calm) = calm {
            self.idle.calm(calm, &self.dynamics.bodies, &mut self.wrenches);
        }
    }

    /// Moves the figure for a step, `elapsed` seconds after the reset. Returns the first body with bad numbers, because of which
    /// the figure was put back.
    pub fn advance(
        &mut self,
        input: &StepInput,
        (exhibit, elapsed): (&Exhibit, f64),
        eye: &Eye,
        wind: &mut WindField,
    ) -> Option<usize> {
        self.impacts.clear();
        let driven = self.dynamics.system().driven();
        self.hands.follow(input.hands, (&eye.view, eye.aspect), wind, (exhibit, &self.dynamics.bodies, driven));
        self.mode = input.mode.unwrap_or(MotionMode::of(exhibit));
        if let Some((gathering, left)) = &mut self.gathering {
            *left -= 1;
            self.wrenches.fill([0.0; 6]);
            if self.mode != MotionMode::Dynamic {
                let (dynamics, impacts) = (&mut self.dynamics, &mut self.impacts);
                return dynamics.position_step(DT, &self.wrenches, impacts, |moved| gathering.carry(DT, moved.bodies));
            }
            gathering.call(&self.dynamics.bodies, &mut self.wrenches);
            return self.dynamics.step(DT, &self.wrenches, &mut self.impacts);
        }
        let method = match self.mode {
            MotionMode::Dynamic => {
                self.hands.pull(&mut self.dynamics, DT, &mut self.wrenches);
                self.carry(exhibit, elapsed);
                return self.dynamics.step(DT, &self.wrenches, &mut self.impacts);
            }
            MotionMode::Procedural => Method::Compulsive,
            MotionMode::PositionBased => Method::TreeSolve,
        };
        self.procedural.settings_mut().method = method;
        let grips = self.hands.grips(&self.dynamics.bodies, DT);
        self.procedural.step(&mut self.dynamics, DT, &self.wrenches, grips, &mut self.impacts)
    }

    /// Carries the hands of a clock on.
    fn carry(&mut self, exhibit: &Exhibit, elapsed: f64) {
        if let (Some(carrying), Some(clock)) = (&mut self.carrying, &exhibit.clock)
            && !carrying.carry(clock, (elapsed, DT), &mut self.dynamics, &mut self.wrenches)
        {
            self.carrying = None;
        }
    }
}
