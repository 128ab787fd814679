//! What plays the voices that go on: the wind and what slides, as commanded and as they sound now.

use super::graph::CONTROL;
use super::timbre::{Inputs, Player};
use super::{Slide, SoundCommand, WindExposure, WindSound};
use soffio_math::{PI, exp};

/// Time constant with which the sound of the wind follows its commands, s.
const WIND_GLIDE: f64 = 0.05;
/// Time constant with which the sound of a slide follows its commands, s: one simulation step.
const SLIDE_GLIDE: f64 = 0.004;
/// Surfaces have parted below this, N.
const PARTED: f64 = 1e-5;
/// A wind that dies away is over below this, m/s.
const CALM: f64 = 1e-3;
/// Nobody's ear comes nearer than this, m.
pub(super) const NEAREST: f32 = 0.1;

/// Wind and slides of one exhibit.
pub(super) struct Motion {
    /// Of the way to what they glide to, wind and what slides go so much from one point of the control grid to the next.
    shares: [f64; 2],
    wind: Wind,
    /// Whether there was no wind before the last point of the grid.
    calm_before: bool,
    /// One for each instrument.
    sliders: Vec<Slider>,
    /// Part of the wind that each instrument hears: commanded, and now.
    across: Vec<[f64; 2]>,
}

/// The motion as one instrument hears it.
pub(super) struct Heard {
    pub inputs: Inputs,
    /// −1 left … 1 right.
    pub pan: f64,
    /// From the listener, m.
    pub distance: f32,
    /// Whether nothing moved before this point of the grid, and at it.
    pub still_before: bool,
    pub still: bool,
}

/// The wind as commanded, and as it sounds now.
#[derive(Default)]
struct Wind {
    target: WindSound,
    speed: f64,
    gust: f64,
    direction: f64,
    pan: f64,
}

/// What slides over one instrument, as commanded and as it sounds now.
#[derive(Clone, Copy, Default)]
struct Slider {
    target: Slide,
    speed: f64,
    force: f64,
    position: [f64; 2],
}

impl Motion {
    /// Still air, and nothing that slides, for so many instruments.
    pub fn new(instruments: usize, sample_rate: f64) -> Self {
        Self {
            shares: [WIND_GLIDE, SLIDE_GLIDE].map(|glide| 1.0 - exp(-(CONTROL as f64) / (glide * sample_rate))),
            wind: Wind::default(),
            calm_before: true,
            sliders: vec![Slider::default(); instruments],
            across: vec![[1.0; 2]; instruments],
        }
    }

    /// What wind and slides glide to from now on. False where there is no such instrument.
    pub fn command(&mut self, command: &SoundCommand) -> bool {
        match *command {
            SoundCommand::Slide(slide) => {
                let slider = self.sliders.get_mut(usize::from(slide.instrument));
                slider.map(|slider| slider.target = slide).is_some()
            }
            SoundCommand::WindExposure(WindExposure { instrument, share, .. }) => {
                let across = self.across.get_mut(usize::from(instrument));
                across.map(|across| across[0] = f64::from(share).clamp(0.0, 1.0)).is_some()
            }
            SoundCommand::Wind(wind) => {
                self.wind.target = wind;
                true
            }
            _ => true,
        }
    }

    /// Lets wind and slides die away.
    pub fn silence(&mut self) {
        self.wind.target.speed = 0.0;
        self.sliders.iter_mut().for_each(|slider| slider.target.force = 0.0);
    }

    /// A point of the control grid: the wind goes on; what slides does so as its instrument hears it.
    pub fn glide(&mut self) {
        let share = self.shares[0];
        self.calm_before = self.wind.speed == 0.0;
        self.across.iter_mut().for_each(|[target, now]| *now += (*target - *now) * share);
        self.wind.glide(share);
    }

    /// The motion as an instrument that `player` plays hears it at this point of the grid. To be asked once a point.
    pub fn heard(&mut self, instrument: usize, player: Player) -> Heard {
        let air = Inputs {
            wind_speed: self.wind.speed,
            wind_direction: self.wind.direction,
            gust: self.wind.gust,
            ..Inputs::default()
        };
        if player == Player::Slide {
            let slider = &mut self.sliders[instrument];
            let parted = slider.force == 0.0;
            slider.glide(self.shares[1]);
            let slide = slider.target;
            return Heard {
                inputs: Inputs {
                    slip_speed: slider.speed,
                    normal_force: slider.force,
                    position: slider.position,
                    ..air
                },
                pan: f64::from(slide.pan),
                distance: slide.distance.max(NEAREST),
                still_before: parted,
                still: slider.force == 0.0,
            };
        }
        Heard {
            inputs: Inputs { wind_speed: self.wind.speed * self.across[instrument][1], ..air },
            pan: self.wind.pan,
            distance: 1.0,
            still_before: self.calm_before,
            still: self.wind.speed == 0.0,
        }
    }
}

impl Wind {
    /// One step of a one-pole glide towards the commanded wind.
    fn glide(&mut self, share: f64) {
        let target = f64::from(self.target.speed).max(0.0);
        self.speed += (target - self.speed) * share;
        self.gust += (f64::from(self.target.gust) - self.gust) * share;
        self.pan += (f64::from(self.target.pan) - self.pan) * share;
        if target > 0.0 {
            // The shorter way round; what dies away keeps its direction.
            let turn = f64::from(self.target.direction) - self.direction;
            self.direction += (turn - 2.0 * PI * (turn / (2.0 * PI)).round()) * share;
        }
        if target == 0.0 && self.speed < CALM {
            self.speed = 0.0;
        }
    }
}

impl Slider {
    /// One step of a one-pole glide towards the commanded slide.
    fn glide(&mut self, share: f64) {
        let target = f64::from(self.target.force).max(0.0);
        let position = self.target.position.map(|p| f64::from(p).clamp(-1.0, 1.0));
        if self.force == 0.0 {
            // What begins to slide begins where it is.
            self.position = position;
        }
        (0..2).for_each(|k| self.position[k] += (position[k] - self.position[k]) * share);
        self.speed += (f64::from(self.target.speed).abs() - self.speed) * share;
        self.force += (target - self.force) * share;
        if target == 0.0 && self.force < PARTED {
            self.force = 0.0;
        }
    }
}
