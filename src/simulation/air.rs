//! The aimed breath, and the wind forces of a step.

use super::aim::Aim;
use super::input::{Profile, Settings};
use super::onset_compensation::OnsetCompensation;
use super::rate::DT;
use soffio_exhibit::Exhibit;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::Vec6;
use soffio_wind::breath::Breath;
use soffio_wind::force::{BreathJet, WindField, WindReport};
use soffio_wind::jet_front::JetFront;

/// The breath with its aim and the settings that shape it.
#[derive(Clone, Copy)]
pub(crate) struct AimedBreath<'a> {
    /// The exhibit.
    pub exhibit: &'a Exhibit,
    /// Constants of the run.
    pub settings: &'a Settings,
    /// Where the breath is aimed.
    pub aim: &'a Aim,
    /// At the lips, m/s.
    pub speed: f64,
}

impl AimedBreath<'_> {
    /// Its velocity field.
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

    /// The jet that acts on surfaces in this step; `None` if no air of a breath is in flight, or wind is off.
    pub fn jet<'a>(&self, jet_front: &'a JetFront) -> Option<BreathJet<'a>> {
        let Self { exhibit, settings, speed, .. } = *self;
        let jet_front = match settings.profile {
            Profile::Gallery => None,
            Profile::Physical => Some(jet_front),
        };
        let gain = exhibit.breath.gain * settings.breath_gain * settings.profile.gain(speed);
        let blows = speed > 0.0 || jet_front.is_some_and(JetFront::in_flight);
        (blows && settings.wind).then(|| BreathJet {
            breath: self.breath(),
            jet_front,
            gain,
            turbulence: exhibit.breath.turbulence,
        })
    }
}

/// When and how strongly the breath of a step acts.
pub(crate) struct BreathTiming<'a> {
    /// Compensation of the detector's latency.
    pub onset: &'a OnsetCompensation,
    /// Since the reset, s.
    pub time: f64,
}

/// The air about the exhibit.
#[derive(Clone)]
pub(crate) struct Air {
    /// All winds and the surfaces that they act on.
    pub wind: WindField,
    /// Breath in flight.
    pub jet_front: JetFront,
    /// Of the last step.
    pub report: WindReport,
}

impl Air {
    /// Still air about an exhibit at its start.
    pub fn new(exhibit: &Exhibit, seed: u64) -> Self {
        let (surfaces, bodies) = (&exhibit.wind_surfaces, exhibit.bodies.len());
        Self {
            wind: WindField::new(surfaces, &exhibit.shelters, &exhibit.winds, bodies, seed),
            jet_front: JetFront::default(),
            report: WindReport::default(),
        }
    }

    /// Sets the wrenches (N and N m about each centre of mass) to those of the breath and of all winds.
    pub fn apply_wind(
        &mut self,
        breath: AimedBreath,
        timing: BreathTiming,
        bodies: &[RigidBody],
        wrenches: &mut [Vec6],
    ) {
        wrenches.fill([0.0; 6]);
        self.report = WindReport::default();
        if !breath.settings.wind {
            return;
        }
        self.jet_front.advance(breath.speed, DT);
        let mut jet = breath.jet(&self.jet_front);
        if let Some(jet) = &mut jet
            && breath.settings.profile == Profile::Gallery
        {
            jet.gain *= timing.onset.gain();
        }
        self.report = self.wind.apply_forces(bodies, timing.time, jet.as_ref(), wrenches);
    }
}
