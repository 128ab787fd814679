//! Control signals of sustained voices: wind and sliding contacts, smoothed from their commands.

use super::graph::CONTROL_PERIOD;
use super::timbre::{Inputs, Player};
use super::{Slide, SoundCommand, WindExposure, WindSound};
use soffio_math::{PI, exp};

/// Time constant of the smoothed wind, s: several simulation steps, so that none is heard, and far below the time of a
/// gust.
const WIND_GLIDE: f64 = 0.05;
/// Time constant of a smoothed slide, s: one simulation step.
const SLIDE_GLIDE: f64 = 0.004;
/// Force below which a fading slide ends, N: 100 dB below 1 N, inaudible.
const LEAST_FORCE: f64 = 1e-5;
/// Speed below which a fading wind ends, m/s: inaudible, as sound grows with a power of the speed.
const LEAST_WIND: f64 = 1e-3;
/// Least distance of a listener, m: bounds the gain 1/r to 20 dB above that at 1 m.
pub(super) const MIN_DISTANCE: f32 = 0.1;

/// Wind and slides of one exhibit.
pub(super) struct SustainedControls {
    /// One-pole coefficients of wind and slides per grid point.
    shares: [f64; 2],
    wind: WindState,
    /// Whether the air was still before the last grid point.
    calm_before: bool,
    /// One for each instrument.
    slides: Vec<SlideState>,
    /// Wind exposure of each instrument: target and present.
    exposures: Vec<[f64; 2]>,
}

/// Control signals of one instrument.
pub(super) struct ControlValues {
    /// Smoothed inputs of the voice.
    pub inputs: Inputs,
    /// −1 left … 1 right.
    pub pan: f64,
    /// From the listener, m.
    pub distance: f32,
    /// Did nothing move before this grid point?
    pub still_before: bool,
    /// Does nothing move at this grid point?
    pub still: bool,
}

/// Commanded and smoothed wind.
#[derive(Default)]
struct WindState {
    target: WindSound,
    speed: f64,
    gust: f64,
    direction: f64,
    pan: f64,
}

/// Commanded and smoothed sliding contact of one instrument.
#[derive(Clone, Copy, Default)]
struct SlideState {
    target: Slide,
    speed: f64,
    force: f64,
    position: [f64; 2],
}

impl SustainedControls {
    /// Still air and no slides, for this number of instruments.
    pub fn new(instruments: usize, sample_rate: f64) -> Self {
        Self {
            shares: [WIND_GLIDE, SLIDE_GLIDE].map(|glide| 1.0 - exp(-(CONTROL_PERIOD as f64) / (glide * sample_rate))),
            wind: WindState::default(),
            calm_before: true,
            slides: vec![SlideState::default(); instruments],
            exposures: vec![[1.0; 2]; instruments],
        }
    }

    /// Sets the target of a command. False if there is no such instrument.
    pub fn command(&mut self, command: &SoundCommand) -> bool {
        match *command {
            SoundCommand::Slide(slide) => {
                let slider = self.slides.get_mut(usize::from(slide.instrument));
                slider.map(|slider| slider.target = slide).is_some()
            }
            SoundCommand::WindExposure(WindExposure { instrument, share, .. }) => {
                let exposures = self.exposures.get_mut(usize::from(instrument));
                exposures.map(|exposures| exposures[0] = f64::from(share).clamp(0.0, 1.0)).is_some()
            }
            SoundCommand::Wind(wind) => {
                self.wind.target = wind;
                true
            }
            _ => true,
        }
    }

    /// Sets all targets to 0.
    pub fn silence(&mut self) {
        self.wind.target.speed = 0.0;
        self.slides.iter_mut().for_each(|slider| slider.target.force = 0.0);
    }

    /// Advances the wind to the next grid point; slides advance in [`Self::values`].
    pub fn glide(&mut self) {
        let share = self.shares[0];
        self.calm_before = self.wind.speed == 0.0;
        self.exposures.iter_mut().for_each(|[target, now]| *now += (*target - *now) * share);
        self.wind.glide(share);
    }

    /// Control signals of an instrument with this player at this grid point. To be called once a grid point.
    pub fn values(&mut self, instrument: usize, player: Player) -> ControlValues {
        let air = Inputs {
            wind_speed: self.wind.speed,
            wind_direction: self.wind.direction,
            gust: self.wind.gust,
            ..Inputs::default()
        };
        if player == Player::Slide {
            let slider = &mut self.slides[instrument];
            let parted = slider.force == 0.0;
            slider.glide(self.shares[1]);
            let slide = slider.target;
            return ControlValues {
                inputs: Inputs {
                    slip_speed: slider.speed,
                    normal_force: slider.force,
                    position: slider.position,
                    ..air
                },
                pan: f64::from(slide.pan),
                distance: slide.distance.max(MIN_DISTANCE),
                still_before: parted,
                still: slider.force == 0.0,
            };
        }
        ControlValues {
            inputs: Inputs { wind_speed: self.wind.speed * self.exposures[instrument][1], ..air },
            pan: self.wind.pan,
            distance: 1.0,
            still_before: self.calm_before,
            still: self.wind.speed == 0.0,
        }
    }
}

impl WindState {
    /// One step of a one-pole glide towards the commanded wind.
    fn glide(&mut self, share: f64) {
        let target = f64::from(self.target.speed).max(0.0);
        self.speed += (target - self.speed) * share;
        self.gust += (f64::from(self.target.gust) - self.gust) * share;
        self.pan += (f64::from(self.target.pan) - self.pan) * share;
        if target > 0.0 {
            // The shorter way round; a fading wind keeps its direction.
            let turn = f64::from(self.target.direction) - self.direction;
            self.direction += (turn - 2.0 * PI * (turn / (2.0 * PI)).round()) * share;
        }
        if target == 0.0 && self.speed < LEAST_WIND {
            self.speed = 0.0;
        }
    }
}

impl SlideState {
    /// One step of a one-pole glide towards the commanded slide.
    fn glide(&mut self, share: f64) {
        let target = f64::from(self.target.force).max(0.0);
        let position = self.target.position.map(|p| f64::from(p).clamp(-1.0, 1.0));
        if self.force == 0.0 {
            // A new slide starts at its position.
            self.position = position;
        }
        (0..2).for_each(|k| self.position[k] += (position[k] - self.position[k]) * share);
        self.speed += (f64::from(self.target.speed).abs() - self.speed) * share;
        self.force += (target - self.force) * share;
        if target == 0.0 && self.force < LEAST_FORCE {
            self.force = 0.0;
        }
    }
}
