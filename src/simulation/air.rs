//! The breath as it is pointed and travels, and the wind that it becomes.

use super::aim::Aim;
use super::input::{Profile, Settings};
use super::onset::Onset;
use super::rate::DT;
use soffio_exhibit::Exhibit;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::Vec6;
use soffio_wind::breath::Breath;
use soffio_wind::force::{Blown, WindField, WindReport};
use soffio_wind::front::Front;

/// The breath as it is pointed now.
#[derive(Clone, Copy)]
pub(crate) struct Pointed<'a> {
    pub exhibit: &'a Exhibit,
    pub settings: &'a Settings,
    pub aim: &'a Aim,
    /// At the lips, m/s.
    pub speed: f64,
}

impl Pointed<'_> {
    /// Its cone of air.
    pub fn breath(&self) -> Breath {
        let tuning = &self.exhibit.breath;
        Breath {
            mouth: self.aim.mouth,
            direction: self.aim.direction,
            lip_diameter: tuning.lip_diameter.unwrap_or(self.settings.lip_diameter),
            speed: self.speed,
            law: tuning.law,
        }
    }

    /// What it does in this step; `None` where no air of one is anywhere, or wind is off.
    pub fn blown<'a>(&self, front: &'a Front) -> Option<Blown<'a>> {
        let Self { exhibit, settings, speed, .. } = *self;
        let front = match settings.profile {
            Profile::Gallery => None,
            Profile::True => Some(front),
        };
        let gain = exhibit.breath.gain * settings.breath_gain * settings.profile.gain(speed);
        let blows = speed > 0.0 || front.is_some_and(Front::in_flight);
        (blows && settings.wind).then(|| Blown { breath: self.breath(), front, gain })
    }
}

/// The air about the exhibit.
#[derive(Clone)]
pub(crate) struct Air {
    pub wind: WindField,
    /// Breath in flight.
    pub front: Front,
    /// What the wind did in the last step.
    pub report: WindReport,
}

impl Air {
    /// Still air about an exhibit that starts.
    pub fn new(exhibit: &Exhibit, seed: u64) -> Self {
        let (surfaces, bodies) = (&exhibit.wind_surfaces, exhibit.bodies.len());
        Self {
            wind: WindField::new(surfaces, &exhibit.shelters, &exhibit.winds, bodies, seed),
            front: Front::default(),
            report: WindReport::default(),
        }
    }

    /// Turns the breath, and all winds `time` seconds after the reset, into forces: sets the wrenches (N and N m about each
    /// centre of mass).
    pub fn blow(
        &mut self,
        pointed: Pointed,
        (onset, time): (&Onset, f64),
        bodies: &[RigidBody],
        wrenches: &mut [Vec6],
    ) {
        wrenches.fill([0.0; 6]);
        self.report = WindReport::default();
        if !pointed.settings.wind {
            return;
        }
        self.front.advance(pointed.speed, DT);
        let mut blown = pointed.blown(&self.front);
        if let Some(blown) = &mut blown
            && pointed.settings.profile == Profile::Gallery
        {
            blown.gain *= onset.gain();
        }
        self.report = self.wind.push(bodies, time, blown.as_ref(), wrenches);
    }
}
