//! Synthetic visitors: their intents, breaths, presses and sounds, drawn from a seed.
//!
//! Distances, angles and strengths are those of people in front of a microphone on a gooseneck. A child blows 3.6 to 10.5 m/s, an
//! adult 6 to 17 m/s, soft as often as hard. Most blow at the microphone, some past it: a jet has half of its speed 5 degrees off
//! its axis, and next to none at 12.

use std::ops::Range;

use super::loudness::{loud, scaled};
use soffio_math::noise::{Random, hash_words};
use soffio_soundscape::breath::{Breath as Recipe, Manner, Person};
use soffio_soundscape::filters::peaked;
use soffio_soundscape::scenes::Scenario;
use soffio_soundscape::{RATE, noises, voices};

/// Distance from lips to microphone, m.
const DISTANCE_M: (f64, f64) = (0.10, 0.45);
/// Largest near distance, m.
const NEAR_M: f64 = 0.18;
/// Largest middle distance, m.
const FAR_M: f64 = 0.30;
/// Largest angle of a straight breath, degrees.
const STRAIGHT_DEG: f64 = 3.0;
/// Largest angle of a breath aside, degrees.
const ASIDE_DEG: f64 = 6.0;
/// Largest angle of all, degrees.
const WIDEST_DEG: f64 = 9.0;
/// Largest gentle speed, m/s.
const NORMAL_M_S: f64 = 6.5;
/// Largest normal speed, m/s.
const STRONG_M_S: f64 = 11.0;

/// Level of talk at the microphone from 0.3 to 1.5 m, dB of sound. Normal, loud and shouted speech have 62, 75 and 82 dB at a metre
/// (ANSI S3.5-1997).
const TALK_DB: (f64, f64) = (58.0, 76.0);
/// Level of a shout at the microphone, dB of sound.
const SHOUT_DB: (f64, f64) = (82.0, 98.0);
/// Level of laughter, dB of sound.
const LAUGHTER_DB: (f64, f64) = (70.0, 88.0);
/// Level of steps on a floor, dB of sound.
const STEPS_DB: (f64, f64) = (45.0, 65.0);

/// Peak level of a hand on the glass, dB of sound.
const HAND_DB: (f64, f64) = (75.0, 97.0);

/// Pause between two breaths of a visitor, s.
const BREATH_PAUSE_S: (f64, f64) = (1.5, 4.0);
/// Number of breaths after which a visitor who sees no response gives up.
const MAX_BREATHS: usize = 3;

/// Intent of a visitor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Intent {
    /// Blows.
    Blows,
    /// Blows while companions talk and laugh.
    InAGroup,
    /// Shouts at the kiosk, then blows.
    Shouts,
    /// Blows at the same time as another visitor.
    TwoAtOnce,
    /// Blows, then grabs a part of the exhibit.
    ThenTouches,
    /// Presses and holds, without blowing.
    Holds,
    /// Looks, talks and walks away.
    WalksAway,
}

/// Probability of each intent.
const INTENT_PROBABILITY: [(Intent, f64); 7] = [
    (Intent::Blows, 0.40),
    (Intent::InAGroup, 0.13),
    (Intent::Shouts, 0.11),
    (Intent::TwoAtOnce, 0.08),
    (Intent::ThenTouches, 0.10),
    (Intent::Holds, 0.10),
    (Intent::WalksAway, 0.08),
];

/// One breath of the day.
#[derive(Clone, Copy, Debug)]
pub struct Breath {
    /// Arrival of the first air at the microphone, s of the day.
    pub onset: f64,
    /// How it is blown, without quiet before.
    pub recipe: Recipe,
    /// From the first flow at the lips to the arrival of the air, s.
    travel: f64,
    /// From the arrival to the last air, s.
    length: f64,
    seed: u64,
}

impl Breath {
    fn new(onset: f64, child: bool, random: &mut Random) -> Self {
        let person = if child { Person::Child } else { Person::Adult };
        let manner = match random.unit() {
            x if x < 0.75 => Manner::Plain,
            x if x < 0.85 => Manner::Puff,
            x if x < 0.95 => Manner::Pfff,
            _ => Manner::Whoo,
        };
        let angle_deg = match random.unit() {
            x if x < 0.6 => random.range(0.0, STRAIGHT_DEG),
            x if x < 0.88 => random.range(STRAIGHT_DEG, ASIDE_DEG),
            _ => random.range(ASIDE_DEG, WIDEST_DEG),
        };
        let drawn = Recipe::random(manner, person, DISTANCE_M, random);
        let azimuth_deg = random.range(0.0, 360.0);
        Self::of(onset, Recipe { angle_deg, azimuth_deg, ..drawn }, random.word())
    }

    /// A recipe whose air arrives at a time, s of the day.
    fn of(onset: f64, recipe: Recipe, seed: u64) -> Self {
        let label = recipe.label(0.0, &recipe.speeds(seed));
        Self { onset, recipe, travel: label.arrival, length: label.end - label.arrival, seed }
    }

    /// Another breath of the same visitor, a little softer or harder.
    fn again(&self, onset: f64, random: &mut Random) -> Self {
        let (soft, hard) = (Person::Child.speeds().0, Person::Adult.speeds().1);
        let speed = (self.recipe.speed * random.range(0.7, 1.3)).clamp(soft, hard);
        let recipe = Recipe { speed, hold: random.range(0.5, 2.5), ..self.recipe };
        Self::of(onset, recipe, random.word())
    }

    /// Beginning of the flow at the lips, s of the day.
    pub fn lips(&self) -> f64 {
        self.onset - self.travel
    }

    /// End of the air at the microphone, s of the day.
    pub fn end(&self) -> f64 {
        self.onset + self.length
    }

    /// Sound at each of 1 or 2 capsules with this spacing, m, from [`Breath::lips`] on; Pa at 16 kHz.
    pub fn sound(&self, capsules: usize, spacing: f64) -> Vec<Vec<f64>> {
        // The visitor stands in front of one of both capsules.
        let spacing = if capsules > 1 { spacing } else { 0.0 };
        let beside = if self.seed.is_multiple_of(2) { 0.5 } else { -0.5 } * spacing;
        let recipe = Recipe { spacing, beside, ..self.recipe };
        recipe.air(RATE, self.seed).pressure
    }
}

/// A press.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Press {
    /// A key or a switch that blows.
    Key,
    /// A finger that blows, at a place of the picture.
    Finger([f64; 2]),
    /// A finger that grabs a part and pulls it.
    Pull {
        /// Part, as a fraction of all parts, 0 … 1.
        which: f64,
        /// Displacement, picture heights.
        by: [f64; 2],
    },
}

/// A press over time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedPress {
    /// Beginning, s of the day.
    pub from: f64,
    /// End, s of the day.
    pub until: f64,
    /// The press.
    pub press: Press,
}

/// Pointing at the exhibit.
#[derive(Clone, Copy, Debug)]
pub struct Aim {
    /// Time, s of the day.
    pub at: f64,
    /// Point in picture coordinates.
    pub point: [f64; 2],
}

/// One visit.
#[derive(Clone, Debug)]
pub struct Visit {
    /// Intent of the visitor.
    pub intent: Intent,
    /// The visitor is a child.
    pub child: bool,
    /// Arrival, s of the day.
    pub arrives: f64,
    /// Departure, s of the day.
    pub leaves: f64,
    /// Where the visitor points before the first breath; `None` for most, who touch nothing before they blow.
    pub aim: Option<Aim>,
    /// Breaths in order.
    pub breaths: Vec<Breath>,
    /// Presses in order.
    pub presses: Vec<TimedPress>,
    seed: u64,
}
impl Visit {
    /// A visit that begins at a time, s of the day, with the first action at least `ready` seconds later; its intent is random.
    pub fn new(arrives: f64, ready: f64, random: &mut Random) -> Self {
        let mut left = random.unit();
        let intent = INTENT_PROBABILITY.iter().find(|(_, probability)| {
            left -= probability;
            left < 0.0
        });
        Self::of(intent.map_or(Intent::Blows, |(intent, _)| *intent), arrives, ready, random)
    }

    /// A visit with a given intent.
    pub fn of(intent: Intent, arrives: f64, ready: f64, random: &mut Random) -> Self {
        let child = random.unit() < 0.4;
        let place = |random: &mut Random| [random.range(0.3, 0.7), random.range(0.25, 0.6)];
        let first = arrives + ready + random.range(2.0, 7.0);
        let aim = (random.unit() < 0.4).then(|| Aim { at: first - random.range(0.8, 2.0), point: place(random) });
        let (mut breaths, mut presses) = (Vec::new(), Vec::new());
        let mut end = first;
        match intent {
            Intent::WalksAway => {}
            Intent::Holds => {
                for _ in 0..1 + (random.unit() * 2.0) as u32 {
                    let from = if presses.is_empty() { first } else { end + random.range(1.0, 4.0) };
                    end = from + random.range(1.0, 3.0);
                    let press = if random.unit() < 0.5 { Press::Key } else { Press::Finger(place(random)) };
                    presses.push(TimedPress { from, until: end, press });
                }
            }
            _ => {
                let breath = Breath::new(first, child, random);
                breaths.push(breath);
                end = breath.end();
                if intent == Intent::TwoAtOnce {
                    // While the first breath lasts.
                    let onset = first + random.range(0.0, 0.6_f64.min(breath.end() - first));
                    let other_child = random.unit() < 0.4;
                    let other = Breath::new(onset, other_child, random);
                    breaths.push(other);
                    end = end.max(other.end());
                }
                for _ in 0..[0, 0, 0, 1, 1, 2][(random.unit() * 6.0) as usize] {
                    let next = breath.again(end + random.range(BREATH_PAUSE_S.0, BREATH_PAUSE_S.1), random);
                    end = next.end();
                    breaths.push(next);
                }
            }
        }
        if intent == Intent::ThenTouches {
            let from = end + random.range(0.5, 1.5);
            end = from + random.range(1.0, 2.5);
            let by = [random.range(-0.15, 0.15), random.range(-0.1, 0.1)];
            let press = Press::Pull { which: random.unit(), by };
            presses.push(TimedPress { from, until: end, press });
        }
        let leaves = end + random.range(1.0, 6.0);
        Self { intent, child, arrives, leaves, aim, breaths, presses, seed: random.word() }
    }

    /// Time of the first action, s of the day; `None` for a visitor who walks away.
    pub fn onset(&self) -> Option<f64> {
        let breath = self.breaths.first().map(|breath| breath.onset);
        breath.or(self.presses.first().map(|pressed| pressed.from))
    }

    /// End of the last breath, s of the day; `None` without a breath.
    pub fn last_breath_end(&self) -> Option<f64> {
        self.breaths.iter().map(Breath::end).reduce(f64::max)
    }

    /// Next breath of a visitor who has blown and sees no response, from the same place. `None` for one who gives up, or touches the
    /// screen instead.
    pub fn retry(&self) -> Option<Breath> {
        let tries = self.breaths.len() < MAX_BREATHS && self.intent != Intent::ThenTouches;
        let first = self.breaths.first().filter(|_| tries)?;
        let mut random = Random::new(hash_words(&[self.seed, 0x7472_6965, self.breaths.len() as u64]));
        let onset = self.last_breath_end()? + random.range(BREATH_PAUSE_S.0, BREATH_PAUSE_S.1);
        Some(first.again(onset, &mut random))
    }

    /// Breaths that begin after the end of all earlier ones, with their indices.
    pub fn successive_breaths(&self) -> impl Iterator<Item = (usize, &Breath)> {
        let mut end = f64::NEG_INFINITY;
        self.breaths.iter().enumerate().filter(move |(_, breath)| {
            let is_later = breath.onset > end;
            end = end.max(breath.end());
            is_later
        })
    }

    /// Times of each action, s of the day; those of a breath begin at the lips, which can be heard.
    pub fn action_times(&self) -> impl Iterator<Item = Range<f64>> + '_ {
        let breaths = self.breaths.iter().map(|breath| breath.lips()..breath.end());
        breaths.chain(self.presses.iter().map(|pressed| pressed.from..pressed.until))
    }

    /// Groups of the visitor, for the report.
    pub fn groups(&self) -> Vec<&'static str> {
        let mut groups = vec![match self.intent {
            Intent::Blows => "alone",
            Intent::InAGroup => "in a group",
            Intent::Shouts => "shouts before",
            Intent::TwoAtOnce => "two at once",
            Intent::ThenTouches => "then touches",
            Intent::Holds => "presses and holds",
            Intent::WalksAway => "walks away",
        }];
        if let Some(breath) = self.breaths.first() {
            let recipe = &breath.recipe;
            groups.push(if self.child { "children" } else { "adults" });
            groups.push(match recipe.distance {
                d if d < NEAR_M => "near (10-18 cm)",
                d if d < FAR_M => "middle (18-30 cm)",
                _ => "far (30-45 cm)",
            });
            groups.push(match recipe.angle_deg {
                a if a < STRAIGHT_DEG => "straight (0-3°)",
                a if a < ASIDE_DEG => "aside (3-6°)",
                _ => "far aside (6-9°)",
            });
            groups.push(match recipe.speed {
                s if s < NORMAL_M_S => "gentle (< 6.5 m/s)",
                s if s < STRONG_M_S => "normal",
                _ => "strong (> 11 m/s)",
            });
        }
        groups
    }

    /// Sounds of the visit other than breaths: their times, s of the day, and the sound at each capsule.
    pub fn noises(&self, scenario: &Scenario, capsules: usize) -> Vec<(f64, Vec<Vec<f64>>)> {
        let mut random = Random::new(hash_words(&[self.seed, 0x6e6f_6973]));
        let random = &mut random;
        let mut out = Vec::new();
        let stay = self.leaves - self.arrives;
        let mut say = |at: f64, sound: Vec<f64>, (low, high): (f64, f64), random: &mut Random| {
            let gain = loud(random.range(low, high));
            let sound = scenario.before_the_kiosk(&sound, capsules);
            out.push((at, scaled(sound, gain)));
        };
        say(self.arrives, noises::footsteps(1.5, random), STEPS_DB, random);
        match self.intent {
            Intent::InAGroup => {
                for _ in 0..2 + (random.unit() * 3.0) as u32 {
                    say(self.arrives, scenario.speech(stay, random), TALK_DB, random);
                }
                let at = random.range(self.arrives, self.leaves);
                say(at, voices::laughter(&scenario.voice(random), random), LAUGHTER_DB, random);
            }
            Intent::Shouts => {
                let onset = self.onset().unwrap_or(self.leaves);
                let length = random.range(0.5, 1.8);
                let shout = voices::speech(&scenario.voice(random).shouting(), length, random);
                // The visitor breathes in between.
                say(onset - length - random.range(0.6, 1.5), shout, SHOUT_DB, random);
            }
            Intent::WalksAway => say(self.arrives, scenario.speech(stay, random), TALK_DB, random),
            _ if random.unit() < 0.3 => say(self.arrives, scenario.speech(2.0, random), TALK_DB, random),
            _ => {}
        }
        // A hand on the glass reaches the microphone through the table, not through the room.
        for pressed in self.presses.iter().filter(|pressed| pressed.press != Press::Key) {
            let gain = loud(random.range(HAND_DB.0, HAND_DB.1));
            let hand: Vec<f64> = peaked(noises::handling(random)).into_iter().map(|x| gain * x).collect();
            out.push((pressed.from, vec![hand; capsules]));
        }
        out
    }
}
