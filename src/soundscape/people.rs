//! Who blows, and how: people and their manners of breath, drawn at random.
//!
//! Lips are 4 to 14 mm wide when they blow, and the air leaves them with 3 to 17 m/s: 0.2 to 1.5 litres a second. Children have less air,
//! and old or ill people less pressure.

use soffio_math::noise::Random;
use soffio_math::pow;

use crate::breath::Breath;
use crate::eddies::Port;
use crate::jet::SPREAD;

/// Speed of the hardest blow at the lips, m/s.
pub const HARDEST_M_S: f64 = 17.0;

/// Manner of a breath.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Manner {
    /// Half a second to three.
    Plain,
    /// Five seconds.
    Hold,
    /// 0.15 to 0.3 s.
    Puff,
    /// Through lips that nearly touch: a sudden start and much hiss.
    Pfff,
    /// Begins with voice or whistle.
    Whoo,
    /// Through a straw.
    Straw,
    /// With the lips on the foam of the microphone.
    Foam,
}

impl Manner {
    /// All manners.
    pub const ALL: [Self; 7] = [Self::Plain, Self::Hold, Self::Puff, Self::Pfff, Self::Whoo, Self::Straw, Self::Foam];

    /// Name for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Hold => "hold",
            Self::Puff => "puff",
            Self::Pfff => "pfff",
            Self::Whoo => "whoo",
            Self::Straw => "straw",
            Self::Foam => "foam",
        }
    }
}

/// Somebody who blows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Person {
    /// Soft to hard.
    Adult,
    /// Smaller lips and less air.
    Child,
    /// Old or ill: little pressure.
    Weak,
}

impl Person {
    /// Softest and hardest speed at the lips, m/s.
    pub fn speeds(self) -> (f64, f64) {
        match self {
            Self::Adult => (6.0, HARDEST_M_S),
            Self::Child => (3.6, 10.5),
            Self::Weak => (2.5, 6.0),
        }
    }

    /// Diameters of a round opening of the lips' area, m.
    fn openings(self) -> (f64, f64) {
        match self {
            Self::Adult => (0.006, 0.013),
            Self::Child => (0.005, 0.010),
            Self::Weak => (0.006, 0.014),
        }
    }
}

impl Breath {
    /// A random breath of a manner and a person, from a range of distances (m).
    pub fn random(manner: Manner, person: Person, (near, far): (f64, f64), random: &mut Random) -> Self {
        let (soft, hard) = person.speeds();
        let (narrow, wide) = person.openings();
        let angle_deg = if random.unit() < 0.7 { random.range(0.0, 4.0) } else { random.range(4.0, 14.0) };
        let plain = Self {
            manner,
            speed: soft * pow(hard / soft, random.unit()),
            opening: random.range(narrow, wide),
            lead_in: 0.0,
            attack: random.range(0.05, 0.25),
            hold: random.range(0.4, 2.5),
            release: random.range(0.1, 0.5),
            lead_out: 0.8,
            distance: near * pow(far / near, random.unit()),
            angle_deg,
            azimuth_deg: random.range(0.0, 360.0),
            wander_deg: random.range(0.5, 3.0),
            spread: random.range(SPREAD.0, SPREAD.1),
            port: Port { size: 0.002 * pow(5.0, random.unit()), steepness: random.range(1.5, 2.5) },
            foam: if random.unit() < 0.2 { random.range(0.5, 0.9) } else { 1.0 },
            hiss_db: random.range(-8.0, 6.0),
            grille_db: random.range(-8.0, 6.0),
            ..Self::default()
        };
        match manner {
            Manner::Plain => plain,
            Manner::Hold => Self { hold: 5.0, speed: plain.speed.min(12.0), ..plain },
            Manner::Puff => {
                let length = random.range(0.15, 0.3);
                Self { attack: 0.3 * length, hold: 0.3 * length, release: 0.4 * length, ..plain }
            }
            Manner::Pfff => {
                let (opening, attack, hold) = (0.7 * plain.opening, random.range(0.01, 0.04), random.range(0.2, 1.2));
                Self { opening, attack, hold, speed: 1.2 * plain.speed, ..plain }
            }
            Manner::Whoo => Self { opening: 1.2 * plain.opening, speed: 0.8 * plain.speed, ..plain },
            Manner::Straw => Self { opening: random.range(0.004, 0.007), speed: 1.3 * plain.speed, ..plain },
            Manner::Foam => Self {
                distance: random.range(0.012, 0.03),
                angle_deg: random.range(0.0, 8.0),
                foam: random.range(0.1, 0.35),
                ..plain
            },
        }
    }
}
