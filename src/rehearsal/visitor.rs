//! Who comes, and what each of them does: drawn by a seed.
//!
//! Distances, angles and strengths are those of people before a microphone on a gooseneck. A child blows 3.6 to 10.5 m/s,
//! an adult 6 to 17 m/s, soft as often as hard; most blow at the microphone, some past it.

use super::loudness::{loud, scaled};
use soffio_detector::generate::filter::peaked;
use soffio_detector::generate::{self, BreathShape};
use soffio_math::noise::{Random, hash_words};
use soffio_math::{from_decibels, pow};
use soffio_soundscape::scenes::{Lips, World};
use soffio_soundscape::{RATE, noises, voices};

/// Lips to microphone, m.
const DISTANCE_M: (f64, f64) = (0.10, 0.45);
/// Bounds between near, middle and far, m.
const NEAR_M: f64 = 0.18;
const FAR_M: f64 = 0.30;
/// Bounds between straight, aside and far aside, degrees.
const STRAIGHT_DEG: f64 = 12.0;
const ASIDE_DEG: f64 = 30.0;
const WIDEST_DEG: f64 = 60.0;
/// Speed at the lips from soft to hard, m/s: children, adults.
const CHILD_M_S: (f64, f64) = (3.6, 10.5);
const ADULT_M_S: (f64, f64) = (6.0, 17.0);
/// Bounds between gentle, normal and strong, m/s.
const NORMAL_M_S: f64 = 6.5;
const STRONG_M_S: f64 = 11.0;

/// Levels at the microphone, dB of sound: who talks, loudly or not, from 0.3 to 1.5 m, who shouts at it (62, 75 and 82 dB at
/// a metre are normal, loud and shouted speech: ANSI S3.5-1997), who laughs; steps on a floor.
const TALK_DB: (f64, f64) = (58.0, 76.0);
const SHOUT_DB: (f64, f64) = (82.0, 98.0);
const LAUGHTER_DB: (f64, f64) = (70.0, 88.0);
const STEPS_DB: (f64, f64) = (45.0, 65.0);

/// Between two breaths of one mouth, s.
const APART_S: (f64, f64) = (1.5, 4.0);
/// Whoever sees nothing move blows again, and gives up after so many breaths.
const GIVES_UP: usize = 3;

/// What somebody comes to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Blows.
    Blows,
    /// Blows while others talk and laugh around.
    InAGroup,
    /// Shouts at the kiosk, then blows.
    Shouts,
    /// Two blow at once.
    TwoAtOnce,
    /// Blows, then takes the work by the hand.
    ThenTouches,
    /// Cannot blow, or will not: presses and holds.
    Holds,
    /// Looks, talks, walks away.
    WalksAway,
}

/// How often each comes.
const OFTEN: [(Way, f64); 7] = [
    (Way::Blows, 0.40),
    (Way::InAGroup, 0.13),
    (Way::Shouts, 0.11),
    (Way::TwoAtOnce, 0.08),
    (Way::ThenTouches, 0.10),
    (Way::Holds, 0.10),
    (Way::WalksAway, 0.08),
];

/// One breath of the day.
#[derive(Clone, Copy, Debug)]
pub struct Breath {
    /// When the first air reaches the microphone, s of the day.
    pub onset: f64,
    /// How it is blown; without quiet before or after.
    pub shape: BreathShape,
    lips: Lips,
    seed: u64,
}

impl Breath {
    fn new(onset: f64, child: bool, random: &mut Random) -> Self {
        let (soft, hard) = if child { CHILD_M_S } else { ADULT_M_S };
        let angle_deg = match random.unit() {
            x if x < 0.6 => random.range(0.0, STRAIGHT_DEG),
            x if x < 0.88 => random.range(STRAIGHT_DEG, ASIDE_DEG),
            _ => random.range(ASIDE_DEG, WIDEST_DEG),
        };
        let shape = BreathShape {
            lead_in: 0.0,
            strength: soft * pow(hard / soft, random.unit()),
            attack: random.range(0.04, 0.22),
            hold: random.range(0.5, 2.5),
            release: random.range(0.08, 0.45),
            lead_out: 0.0,
            distance: DISTANCE_M.0 * pow(DISTANCE_M.1 / DISTANCE_M.0, random.unit()),
            angle_deg,
            foam_db: random.range(0.0, 6.0),
            colour: pow(2.0, random.range(-0.8, 1.4)),
            // The microphone's own corner comes later.
            corner_hz: 5.0,
            ..BreathShape::default()
        };
        let lips = Lips::random(angle_deg, random);
        let seed = random.word();
        let past_deg = Random::new(hash_words(&[seed, 0x7061_7374])).range(0.0, 360.0);
        Self { onset, shape: BreathShape { past_deg, ..shape }, lips, seed }
    }

    /// Another one of the same mouth, a little softer or harder.
    fn again(&self, onset: f64, random: &mut Random) -> Self {
        let strength = (self.shape.strength * random.range(0.7, 1.3)).clamp(CHILD_M_S.0, ADULT_M_S.1);
        let shape = BreathShape { strength, hold: random.range(0.5, 2.5), ..self.shape };
        Self { onset, shape, seed: random.word(), ..*self }
    }

    /// When it is over, s of the day.
    pub fn end(&self) -> f64 {
        self.onset + self.shape.duration()
    }

    /// What arrives at each of so many capsules, two of them so far apart (m); full scale ±1 at 16 kHz.
    pub fn sound(&self, capsules: usize, apart: f64) -> Vec<Vec<f64>> {
        let shape = BreathShape { apart: if capsules > 1 { apart } else { 0.0 }, ..self.shape };
        let at = |capsule| self.lips.heard(generate::stream(RATE, self.seed, &shape, capsule as u64));
        (0..capsules).map(at).collect()
    }
}

/// What a finger or a switch does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Press {
    /// A key or a switch blows.
    Key,
    /// A finger blows from a place of the picture.
    Finger([f64; 2]),
    /// A finger takes what it finds (0 … 1: which part), and pulls it so far, picture heights.
    Pull(f64, [f64; 2]),
}

/// A press over time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pressed {
    /// s of the day.
    pub from: f64,
    /// s of the day.
    pub until: f64,
    /// What is pressed.
    pub press: Press,
}

/// One visit.
#[derive(Clone, Debug)]
pub struct Visit {
    /// What for.
    pub way: Way,
    /// Is it a child?
    pub child: bool,
    /// s of the day.
    pub arrives: f64,
    /// s of the day.
    pub leaves: f64,
    /// Where the visitor points and when, picture coordinates; most touch nothing before they blow.
    pub aim: Option<(f64, [f64; 2])>,
    /// In order.
    pub breaths: Vec<Breath>,
    /// In order.
    pub presses: Vec<Pressed>,
    seed: u64,
}

impl Visit {
    /// Who comes at a time, s of the day, and does the first thing `ready` seconds later at the earliest.
    pub fn new(arrives: f64, ready: f64, random: &mut Random) -> Self {
        let mut left = random.unit();
        let way = OFTEN.iter().find(|(_, often)| {
            left -= often;
            left < 0.0
        });
        Self::of(way.map_or(Way::Blows, |(way, _)| *way), arrives, ready, random)
    }

    /// The same with what they come to do.
    pub fn of(way: Way, arrives: f64, ready: f64, random: &mut Random) -> Self {
        let child = random.unit() < 0.4;
        let place = |random: &mut Random| [random.range(0.3, 0.7), random.range(0.25, 0.6)];
        let first = arrives + ready + random.range(2.0, 7.0);
        let aim = (random.unit() < 0.4).then(|| (first - random.range(0.8, 2.0), place(random)));
        let (mut breaths, mut presses) = (Vec::new(), Vec::new());
        let mut end = first;
        match way {
            Way::WalksAway => {}
            Way::Holds => {
                for _ in 0..1 + (random.unit() * 2.0) as u32 {
                    let from = if presses.is_empty() { first } else { end + random.range(1.0, 4.0) };
                    end = from + random.range(1.0, 3.0);
                    let press = if random.unit() < 0.5 { Press::Key } else { Press::Finger(place(random)) };
                    presses.push(Pressed { from, until: end, press });
                }
            }
            _ => {
                let breath = Breath::new(first, child, random);
                breaths.push(breath);
                end = breath.end();
                if way == Way::TwoAtOnce {
                    let other = Breath::new(first + random.range(0.0, 0.6), random.unit() < 0.4, random);
                    breaths.push(other);
                    end = end.max(other.end());
                }
                for _ in 0..[0, 0, 0, 1, 1, 2][(random.unit() * 6.0) as usize] {
                    let next = breath.again(end + random.range(APART_S.0, APART_S.1), random);
                    end = next.end();
                    breaths.push(next);
                }
            }
        }
        if way == Way::ThenTouches {
            let from = end + random.range(0.5, 1.5);
            end = from + random.range(1.0, 2.5);
            let pull = [random.range(-0.15, 0.15), random.range(-0.1, 0.1)];
            presses.push(Pressed { from, until: end, press: Press::Pull(random.unit(), pull) });
        }
        let leaves = end + random.range(1.0, 6.0);
        Self { way, child, arrives, leaves, aim, breaths, presses, seed: random.word() }
    }

    /// When the visitor first does what the kiosk should answer, s of the day; `None` for who walks away.
    pub fn onset(&self) -> Option<f64> {
        let breath = self.breaths.first().map(|breath| breath.onset);
        breath.or(self.presses.first().map(|pressed| pressed.from))
    }

    /// When the last breath is over, s of the day; `None` for who does not blow.
    pub fn blown(&self) -> Option<f64> {
        self.breaths.iter().map(Breath::end).reduce(f64::max)
    }

    /// What comes next of whoever has blown and sees nothing move: another breath of the same mouth from the same place. `None`
    /// for who gives up, or touches then.
    pub fn tries_again(&self) -> Option<Breath> {
        let tries = self.breaths.len() < GIVES_UP && self.way != Way::ThenTouches;
        let first = self.breaths.first().filter(|_| tries)?;
        let mut random = Random::new(hash_words(&[self.seed, 0x7472_6965, self.breaths.len() as u64]));
        let onset = self.blown()? + random.range(APART_S.0, APART_S.1);
        Some(first.again(onset, &mut random))
    }

    /// Which of the breaths begin after all earlier ones are over.
    pub fn separate(&self) -> impl Iterator<Item = (usize, &Breath)> {
        let mut end = f64::NEG_INFINITY;
        self.breaths.iter().enumerate().filter(move |(_, breath)| {
            let apart = breath.onset > end;
            end = end.max(breath.end());
            apart
        })
    }

    /// When something is done that the kiosk may answer, s of the day.
    pub fn acts(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let breaths = self.breaths.iter().map(|breath| (breath.onset, breath.end()));
        breaths.chain(self.presses.iter().map(|pressed| (pressed.from, pressed.until)))
    }

    /// Groups that the visitor belongs to.
    pub fn groups(&self) -> Vec<&'static str> {
        let mut groups = vec![match self.way {
            Way::Blows => "alone",
            Way::InAGroup => "in a group",
            Way::Shouts => "shouts before",
            Way::TwoAtOnce => "two at once",
            Way::ThenTouches => "then touches",
            Way::Holds => "presses and holds",
            Way::WalksAway => "walks away",
        }];
        if let Some(breath) = self.breaths.first() {
            let shape = &breath.shape;
            groups.push(if self.child { "children" } else { "adults" });
            groups.push(match shape.distance {
                d if d < NEAR_M => "near (10-18 cm)",
                d if d < FAR_M => "middle (18-30 cm)",
                _ => "far (30-45 cm)",
            });
            groups.push(match shape.angle_deg {
                a if a < STRAIGHT_DEG => "straight (0-12°)",
                a if a < ASIDE_DEG => "aside (12-30°)",
                _ => "far aside (30-60°)",
            });
            groups.push(match shape.strength {
                s if s < NORMAL_M_S => "gentle (< 6.5 m/s)",
                s if s < STRONG_M_S => "normal",
                _ => "strong (> 11 m/s)",
            });
        }
        groups
    }

    /// What is heard of the visit beside its breaths: times (s of the day) and sounds at each of so many capsules.
    pub fn noises(&self, world: &World, capsules: usize) -> Vec<(f64, Vec<Vec<f64>>)> {
        let mut random = Random::new(hash_words(&[self.seed, 0x6e6f_6973]));
        let random = &mut random;
        let mut out = Vec::new();
        let stay = self.leaves - self.arrives;
        let mut say = |at: f64, sound: Vec<f64>, (low, high): (f64, f64), random: &mut Random| {
            let gain = loud(random.range(low, high));
            let heard = world.before_the_kiosk(&sound, capsules);
            out.push((at, scaled(heard, gain)));
        };
        say(self.arrives, noises::footsteps(1.5, random), STEPS_DB, random);
        match self.way {
            Way::InAGroup => {
                for _ in 0..2 + (random.unit() * 3.0) as u32 {
                    say(self.arrives, world.speech(stay, random), TALK_DB, random);
                }
                let at = random.range(self.arrives, self.leaves);
                say(at, voices::laughter(&world.voice(random), random), LAUGHTER_DB, random);
            }
            Way::Shouts => {
                let onset = self.onset().unwrap_or(self.leaves);
                let length = random.range(0.5, 1.8);
                let shout = voices::speech(&world.voice(random).shouting(), length, random);
                // Air for the breath is taken after it.
                say(onset - length - random.range(0.6, 1.5), shout, SHOUT_DB, random);
            }
            Way::WalksAway => say(self.arrives, world.speech(stay, random), TALK_DB, random),
            _ if random.unit() < 0.3 => say(self.arrives, world.speech(2.0, random), TALK_DB, random),
            _ => {}
        }
        // A hand on the glass is heard through the table, not through the room.
        for pressed in self.presses.iter().filter(|pressed| pressed.press != Press::Key) {
            let gain = from_decibels(random.range(-44.0, -22.0));
            let hand: Vec<f64> = peaked(noises::handling(random)).into_iter().map(|x| gain * x).collect();
            out.push((pressed.from, vec![hand; capsules]));
        }
        out
    }
}
