//! Control signals of sustained voices: wind, sliding contacts and motion, smoothed from their commands.

use super::graph::CONTROL_PERIOD;
use super::timbre::{Inputs, Player};
use super::{MotionSound, Slide, SoundCommand, WindSound};
use soffio_math::{PI, exp};

/// Time constant of the smoothed wind, s: several simulation steps, so that none is heard, and far below the time of a
/// gust.
const WIND_GLIDE: f64 = 0.05;
/// Time constant of a smoothed slide or motion, s: one simulation step.
const SLIDE_GLIDE: f64 = 0.004;
/// Longest time that a contact takes from one command's place to the next's, s: two simulation steps, and some jitter.
const LONGEST_WAY: f64 = 0.01;
/// Force below which a fading slide ends, N: 100 dB below 1 N, inaudible.
const LEAST_FORCE: f64 = 1e-5;
/// Speed below which a fading wind ends, m/s: inaudible, as sound grows with a power of the speed.
const LEAST_WIND: f64 = 1e-3;
/// Least distance of a listener, m: bounds the gain 1/r to 20 dB above that at 1 m.
pub(super) const MIN_DISTANCE: f32 = 0.1;

/// Wind, slides and motions of one exhibit.
pub(super) struct SustainedControls {
    /// One-pole coefficients of wind, and of slides and motion, per grid point.
    shares: [f64; 2],
    /// Longest straight way of a contact, samples.
    longest_way: u64,
    /// One of each for each instrument.
    winds: Vec<WindState>,
    slides: Vec<SlideState>,
    motions: Vec<MotionState>,
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

/// Commanded and smoothed wind of one instrument.
#[derive(Clone, Copy, Default)]
struct WindState {
    target: WindSound,
    speed: f64,
    gust: f64,
    direction: f64,
    pan: f64,
    distance: f64,
    /// Was the air calm before the last grid point?
    calm_before: bool,
}

/// Commanded and smoothed sliding contact of one instrument.
#[derive(Clone, Copy, Default)]
struct SlideState {
    target: Slide,
    speed: f64,
    force: f64,
    way: Way,
}

/// Way of a contact from one command to the next: a straight line that takes as long as the commands are apart, so that a
/// picture passes evenly.
#[derive(Clone, Copy, Default)]
struct Way {
    from: [f64; 2],
    to: [f64; 2],
    /// Sample at which it begins.
    began: u64,
    /// Samples that it takes.
    takes: u64,
}

impl Way {
    fn at(&self, now: u64) -> [f64; 2] {
        let share = (now.saturating_sub(self.began) as f64 / self.takes.max(1) as f64).min(1.0);
        std::array::from_fn(|k| self.from[k] + share * (self.to[k] - self.from[k]))
    }

    fn goes_to(&mut self, place: [f64; 2], now: u64, longest: u64) {
        let takes = now.saturating_sub(self.began).clamp(1, longest);
        *self = Self { from: self.at(now), to: place, began: now, takes };
    }
}

/// Commanded and smoothed motion of one instrument's body.
#[derive(Clone, Copy, Default)]
struct MotionState {
    /// `None` before the first command, and after all were silenced.
    target: Option<MotionSound>,
    /// Smoothed; `None` before the first grid point with a target.
    now: Option<MotionSound>,
    /// Was there no motion before the last grid point?
    absent_before: bool,
}

impl SustainedControls {
    /// Still air, no slides and no motion, for this number of instruments.
    pub fn new(instruments: usize, sample_rate: f64) -> Self {
        Self {
            shares: [WIND_GLIDE, SLIDE_GLIDE].map(|glide| 1.0 - exp(-(CONTROL_PERIOD as f64) / (glide * sample_rate))),
            longest_way: (LONGEST_WAY * sample_rate) as u64,
            winds: vec![WindState { calm_before: true, ..WindState::default() }; instruments],
            slides: vec![SlideState::default(); instruments],
            motions: vec![MotionState { absent_before: true, ..MotionState::default() }; instruments],
        }
    }

    /// Sets the target of a command at this sample. False if there is no such instrument.
    pub fn command(&mut self, command: &SoundCommand, now: u64) -> bool {
        let longest = self.longest_way;
        match *command {
            SoundCommand::Slide(slide) => {
                let slider = self.slides.get_mut(usize::from(slide.instrument));
                slider.map(|slider| slider.follow(slide, now, longest)).is_some()
            }
            SoundCommand::Wind(wind) => {
                self.winds.get_mut(usize::from(wind.instrument)).map(|state| state.target = wind).is_some()
            }
            SoundCommand::Motion(motion) => {
                let mover = self.motions.get_mut(usize::from(motion.instrument));
                mover.map(|mover| mover.target = Some(motion)).is_some()
            }
            _ => true,
        }
    }

    /// Sets all targets to 0.
    pub fn silence(&mut self) {
        self.winds.iter_mut().for_each(|wind| wind.target.speed = 0.0);
        self.slides.iter_mut().for_each(|slider| slider.target.force = 0.0);
        self.motions.iter_mut().for_each(|mover| mover.target = None);
    }

    /// Advances wind and motion to the next grid point; slides advance in [`Self::values`].
    pub fn glide(&mut self) {
        let [wind, motion] = self.shares;
        self.winds.iter_mut().for_each(|state| state.glide(wind));
        self.motions.iter_mut().for_each(|state| state.glide(motion));
    }

    /// Adds the motion of an instrument's body to the inputs of a hit.
    pub fn add_motion(&self, instrument: usize, inputs: &mut Inputs) {
        if let Some(now) = self.motions[instrument].now {
            (inputs.motion, inputs.distance) = (now.motion, f64::from(now.distance));
        }
    }

    /// Control signals of an instrument with this player at this grid point. To be called once a grid point.
    pub fn values(&mut self, instrument: usize, player: Player, now: u64) -> ControlValues {
        let (wind, mover) = (&self.winds[instrument], &self.motions[instrument]);
        let mut air = Inputs {
            wind_speed: wind.speed,
            wind_direction: wind.direction,
            gust: wind.gust,
            distance: wind.distance,
            ..Inputs::default()
        };
        self.add_motion(instrument, &mut air);
        match player {
            Player::Slide => {
                let slider = &mut self.slides[instrument];
                let parted = slider.force == 0.0;
                slider.glide(self.shares[1]);
                let slide = slider.target;
                ControlValues {
                    inputs: Inputs {
                        slip_speed: slider.speed,
                        normal_force: slider.force,
                        position: slider.way.at(now),
                        ..air
                    },
                    pan: f64::from(slide.pan),
                    distance: slide.distance.max(MIN_DISTANCE),
                    still_before: parted,
                    still: slider.force == 0.0,
                }
            }
            Player::Motion => ControlValues {
                inputs: air,
                pan: mover.now.map_or(0.0, |now| f64::from(now.pan)),
                distance: mover.now.map_or(1.0, |now| now.distance).max(MIN_DISTANCE),
                still_before: mover.absent_before,
                still: mover.now.is_none(),
            },
            Player::Wind | Player::Hit => ControlValues {
                inputs: air,
                pan: wind.pan,
                distance: (wind.distance as f32).max(MIN_DISTANCE),
                still_before: wind.calm_before,
                still: wind.speed == 0.0,
            },
        }
    }
}

impl MotionState {
    /// One step of a one-pole glide towards the commanded motion. The way is a count, which only follows.
    fn glide(&mut self, share: f64) {
        self.absent_before = self.now.is_none();
        self.now = self.target.map(|target| {
            let mut now = self.now.unwrap_or(target);
            let share = share as f32;
            let (m, t) = (&mut now.motion, &target.motion);
            for (value, target) in [
                (&mut m.speed, t.speed),
                (&mut m.spin, t.spin),
                (&mut m.joint_force, t.joint_force),
                (&mut m.tension, t.tension),
                (&mut m.way, t.way),
                (&mut m.height, t.height),
                (&mut m.parameter, t.parameter),
                (&mut now.pan, target.pan),
                (&mut now.distance, target.distance),
            ] {
                *value += (target - *value) * share;
            }
            now
        });
    }
}

impl WindState {
    /// One step of a one-pole glide towards the commanded wind.
    fn glide(&mut self, share: f64) {
        self.calm_before = self.speed == 0.0;
        let target = f64::from(self.target.speed).max(0.0);
        if self.calm_before {
            // New wind starts where it blows.
            (self.pan, self.distance) = (f64::from(self.target.pan), f64::from(self.target.distance));
        }
        self.speed += (target - self.speed) * share;
        self.gust += (f64::from(self.target.gust) - self.gust) * share;
        self.pan += (f64::from(self.target.pan) - self.pan) * share;
        self.distance += (f64::from(self.target.distance) - self.distance) * share;
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
    /// Takes the target of a command.
    fn follow(&mut self, slide: Slide, now: u64, longest: u64) {
        let place = slide.position.map(|p| f64::from(p).clamp(-1.0, 1.0));
        if self.target.force == 0.0 && self.force == 0.0 {
            // A new slide starts at its position.
            self.way = Way { from: place, to: place, began: now, takes: 1 };
        } else {
            self.way.goes_to(place, now, longest);
        }
        self.target = slide;
    }

    /// One step of a one-pole glide towards the commanded slide.
    fn glide(&mut self, share: f64) {
        let target = f64::from(self.target.force).max(0.0);
        self.speed += (f64::from(self.target.speed).abs() - self.speed) * share;
        self.force += (target - self.force) * share;
        if target == 0.0 && self.force < LEAST_FORCE {
            self.force = 0.0;
        }
    }
}
