//! The body that a timbre is tried on where there is no exhibit, and how it is played then.

use schemars::JsonSchema;
use serde::Deserialize;

use super::number::Player;
use super::preset::Preset;
use crate::{
    BodyMotion, InstrumentSpec, MotionSound, Slide, SoundBody, SoundCommand, SoundMaterial, Strike, WindSound,
};
use soffio_math::PI;

/// A body and a way to play it. The defaults: a steel disc of 12 cm, half a millimetre thick.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Specimen {
    /// What its dimensions are those of.
    pub shape: Shape,
    /// Length, m.
    pub length: f64,
    /// Of a disc or tube: its diameter; m.
    pub width: f64,
    /// Of a tube: its wall; m.
    pub thickness: f64,
    /// kg; without it, from the dimensions.
    pub mass: Option<f64>,
    /// Pa.
    pub youngs_modulus: f64,
    /// ν.
    pub poisson: f64,
    /// Density, kg/m³.
    pub density: f64,
    /// η.
    pub loss_factor: f64,
    /// Effective mass of a hit, kg.
    pub hit_mass: f64,
    /// Its approach speed, m/s.
    pub speed: f64,
    /// Its impulse, N s.
    pub impulse: f64,
    /// Its place along the body, −1…1.
    pub at: f64,
    /// Its place across the body, −1…1.
    pub at_y: f64,
    /// Wind, m/s.
    pub wind: f64,
    /// Speed of sliding, m/s.
    pub slip: f64,
    /// Force of sliding, N.
    pub force: f64,
    /// Speed of the body, m/s.
    pub body_speed: f64,
    /// Angular speed of the body, rad/s.
    pub body_spin: f64,
    /// Force of a joint, N.
    pub joint_force: f64,
    /// Pull of a spring or cord, N.
    pub tension: f64,
    /// Height above the start, m.
    pub height: f64,
    /// The sound's own parameter.
    pub parameter: f64,
}

/// Shape of a specimen.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// A round sheet.
    #[default]
    Disc,
    /// A rectangular sheet, bar or board.
    Bar,
    /// A round tube; a rod where the wall fills it.
    Tube,
}

impl Default for Specimen {
    fn default() -> Self {
        Self {
            shape: Shape::Disc,
            length: 0.12,
            width: 0.12,
            thickness: 5e-4,
            mass: None,
            youngs_modulus: 2e11,
            poisson: 0.3,
            density: 7850.0,
            loss_factor: 6e-4,
            hit_mass: 0.003,
            speed: 0.3,
            impulse: 5e-4,
            at: 0.8,
            at_y: 0.0,
            wind: 2.0,
            slip: 0.2,
            force: 2.0,
            body_speed: 0.5,
            body_spin: 3.0,
            joint_force: 1.0,
            tension: 1.0,
            height: 0.1,
            parameter: 1.0,
        }
    }
}

impl Specimen {
    /// The first number that no body can have.
    pub fn problem(&self) -> Option<(&'static str, f64)> {
        let above_zero = [
            ("length", self.length),
            ("width", self.width),
            ("thickness", self.thickness),
            ("mass", self.mass.unwrap_or(1.0)),
            ("youngs_modulus", self.youngs_modulus),
            ("density", self.density),
            ("loss_factor", self.loss_factor),
            ("hit_mass", self.hit_mass),
        ];
        above_zero.into_iter().find(|(_, value)| !(value.is_finite() && *value > 0.0))
    }

    /// The command that plays a timbre on the body from this sample on, 1 m away: a hit, wind, a slide or motion.
    pub fn command(&self, preset: &Preset, instrument: u16, sample: u64) -> SoundCommand {
        let (pan, distance) = (0.0, 1.0);
        let position = [self.at as f32, self.at_y as f32];
        match preset.player() {
            Player::Hit => {
                let (impulse, speed, mass) = (self.impulse as f32, self.speed as f32, self.hit_mass as f32);
                SoundCommand::Strike(Strike { sample, instrument, impulse, speed, mass, position, pan, distance })
            }
            Player::Wind => {
                SoundCommand::Wind(WindSound { sample, instrument, speed: self.wind as f32, ..WindSound::default() })
            }
            Player::Slide => {
                let (speed, force) = (self.slip as f32, self.force as f32);
                SoundCommand::Slide(Slide { sample, instrument, speed, force, position, pan, distance })
            }
            Player::Motion => {
                let motion = BodyMotion {
                    speed: self.body_speed as f32,
                    spin: self.body_spin as f32,
                    joint_force: self.joint_force as f32,
                    tension: self.tension as f32,
                    way: 0.0,
                    height: self.height as f32,
                    parameter: self.parameter as f32,
                };
                SoundCommand::Motion(MotionSound { sample, instrument, motion, pan, distance })
            }
        }
    }

    /// The body as an instrument of a timbre.
    pub fn spec(&self, timbre: &str) -> InstrumentSpec {
        let (face, section) = match self.shape {
            Shape::Disc => (PI / 4.0 * self.length * self.width, None),
            Shape::Bar => (self.length * self.width, None),
            Shape::Tube => {
                let wall = self.thickness.min(0.5 * self.width);
                (self.length * self.width, Some(PI * wall * (self.width - wall)))
            }
        };
        let volume = section.map_or(face * self.thickness, |section| section * self.length);
        let body = SoundBody {
            half_extents: [0.5 * self.length.max(self.width), 0.5 * self.length.min(self.width)],
            thickness: if self.shape == Shape::Tube { self.width } else { self.thickness },
            area: face,
            mass: self.mass.unwrap_or(volume * self.density),
        };
        let material = SoundMaterial {
            youngs_modulus: self.youngs_modulus,
            poisson: self.poisson,
            density: self.density,
            loss_factor: self.loss_factor,
        };
        InstrumentSpec { timbre: timbre.into(), own: None, body, material, surface: None, gain: 1.0, max_voices: 1 }
    }
}
