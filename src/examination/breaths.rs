//! Takes of breaths: one visitor, a room, five breaths; one or many microphones.

use soffio_math::noise::{Random, hash_words};
use soffio_math::pow;
use soffio_soundscape::breath::{Breath, Manner, Person};
use soffio_soundscape::microphone::Microphone;
use soffio_soundscape::scenes::{Scenario, Stage};
use soffio_soundscape::{BreathLabel, Take};

use crate::battery::MANNERS;
use crate::listening::{Readings, is_clear};
use crate::subject::Make;
use crate::tally::{Section, Tally};

/// Time before the first breath, s.
const LEAD_IN_S: (f64, f64) = (6.0, 10.0);
/// Pause between two breaths, s.
const PAUSE_S: (f64, f64) = (0.8, 3.0);
/// Breaths of a take.
const BREATHS: usize = 5;
/// Ranges of distances that takes run through, m.
const DISTANCES_M: [(f64, f64); 3] = [(0.09, 0.20), (0.20, 0.35), (0.35, 0.60)];
/// Level of ventilation and street, dB of sound.
const AIR_DB: (f64, f64) = (35.0, 60.0);
/// Least speed at the capsule of the row of all breaths, m/s.
const FELT_M_S: f64 = 0.35;
/// Corners of high-passes, Hz.
const CORNERS_HZ: [f64; 5] = [20.0, 60.0, 100.0, 150.0, 200.0];
/// Share of a hold that must be tracked.
const TRACKED: f64 = 0.9;

/// A room with ventilation and, in two of three, a museum.
pub fn add_gallery(scenario: &Scenario, stage: &mut Stage, capsules: usize, random: &mut Random) {
    let seconds = stage.seconds() + 0.01;
    let level = random.range(AIR_DB.0, AIR_DB.1);
    stage.add_noise(0.0, &scenario.air_noise(seconds, level, capsules, random), &[]);
    if random.unit() < 0.67 {
        let (sound, events) = scenario.crowd(seconds, random.range(0.2, 1.2), capsules, random);
        stage.add_noise(0.0, &sound, &events);
    }
}

/// Breaths of one visitor.
fn visitor(manners: &[Manner], index: u64, spacing: f64, random: &mut Random) -> Vec<Breath> {
    let person =
        [Person::Adult, Person::Adult, Person::Child, Person::Child, Person::Weak][(random.unit() * 5.0) as usize];
    let distances = DISTANCES_M[index as usize % 3];
    let first = Breath::random(Manner::Plain, person, distances, random);
    let breath = |manner: &Manner| {
        let drawn = Breath::random(*manner, person, distances, random);
        // People stand in front of one capsule, or between both.
        let beside = match (random.unit() * 3.0) as u32 {
            0 if drawn.manner != Manner::Foam => 0.0,
            1 => -0.5 * spacing,
            _ => 0.5 * spacing,
        };
        Breath {
            beside,
            lead_in: random.range(PAUSE_S.0, PAUSE_S.1),
            azimuth_deg: first.azimuth_deg,
            port: first.port,
            grille_db: first.grille_db,
            spacing,
            ..drawn
        }
    };
    manners.iter().map(breath).collect()
}

/// A stage with these breaths.
fn stage(scenario: &Scenario, breaths: &[Breath], capsules: usize, random: &mut Random) -> Stage {
    let first = random.range(LEAD_IN_S.0, LEAD_IN_S.1);
    let seconds = first + breaths.iter().map(Breath::duration).sum::<f64>() + 0.5;
    let mut stage = Stage::new(seconds, capsules);
    add_gallery(scenario, &mut stage, capsules, random);
    let mut at = first;
    for breath in breaths {
        stage.add_breath(at, breath, random.word());
        at += breath.duration();
    }
    stage
}

/// Spacing of two capsules, m: 1 to 10 cm; 0 for one capsule.
pub fn spacing(capsules: usize, random: &mut Random) -> f64 {
    let drawn = 0.01 * pow(10.0, random.unit());
    if capsules > 1 { drawn } else { 0.0 }
}

/// Makes a take of breaths and scores it.
pub fn take(
    make: &Make<'_>,
    scenario: &Scenario,
    (seed, index): (u64, u64),
    capsules: usize,
    microphones: bool,
) -> Tally {
    let mut random = Random::new(hash_words(&[seed, index, 0x6272_6561]));
    let manners: Vec<Manner> = (0..BREATHS).map(|i| MANNERS[(index as usize * BREATHS + i) % MANNERS.len()]).collect();
    let spacing = spacing(capsules, &mut random);
    let breaths = visitor(&manners, index / 2, spacing, &mut random);
    let stage = stage(scenario, &breaths, capsules, &mut random);
    let microphone = Microphone::random(&mut random);
    let mut tally = Tally::default();
    let take = stage.recorded(&microphone, seed ^ index);
    score(make, &take, &mut tally);
    if microphones {
        let open = Microphone { high_pass_hz: 20.0, order: 1, ..microphone };
        other_microphones(make, &stage, &open, seed ^ index, &mut tally);
    }
    tally
}

/// Scores all rows of a plain microphone.
fn score(make: &Make<'_>, take: &Take, tally: &mut Tally) {
    let readings = Readings::of(make, take);
    let section = Section::Breaths;
    for breath in &take.breaths {
        let answer = readings.answer(breath);
        if breath.peak_speed >= FELT_M_S {
            tally.share(section, "b all of 0.35 m/s or more", answer.detected);
            let distance = match breath.distance {
                _ if breath.manner == Manner::Foam => None,
                d if d < DISTANCES_M[0].1 => Some("09-20 cm"),
                d if d < DISTANCES_M[1].1 => Some("20-35 cm"),
                _ => Some("35-60 cm"),
            };
            if let Some(distance) = distance {
                tally.share(section, &format!("c distance {distance}, all of 0.35 m/s or more"), answer.detected);
            }
            tally.pairs(section, "i rank correlation, frames of all of 0.35 m/s or more", readings.pairs(breath));
            if answer.detected {
                tally.pairs(section, "j rank correlation, means of detected breaths", mean_pair(&readings, breath));
            }
        }
        if !is_clear(breath) {
            continue;
        }
        tally.share(section, "a clear", answer.detected);
        tally.share(section, &format!("d manner {}, clear", breath.manner.name()), answer.detected);
        if let Some(delay) = answer.delay {
            tally.time(section, "e delay, clear", delay);
        }
        if breath.manner == Manner::Hold {
            tally.share(section, "f holds of 5 s tracked for 90 %, clear", answer.tracked >= TRACKED);
        }
    }
    let triggers = readings.false_positives(&take.breaths, 0.0);
    tally.rate(section, "h false triggers between breaths", triggers, take.duration());
}

/// Means of local and reported speed over a breath.
fn mean_pair(readings: &Readings, breath: &BreathLabel) -> Option<(f64, f64)> {
    let (count, local, reported) =
        readings.pairs(breath).fold((0.0, 0.0, 0.0), |(n, a, b), (x, y)| (n + 1.0, a + x, b + y));
    (count > 0.0).then(|| (local / count, reported / count))
}

/// Scores the breaths that are clear to an open microphone behind all others.
fn other_microphones(make: &Make<'_>, stage: &Stage, open: &Microphone, seed: u64, tally: &mut Tally) {
    let plain = stage.recorded(open, seed);
    let clear: Vec<bool> = plain.breaths.iter().map(is_clear).collect();
    let mut compare = |name: &str, take: &Take| {
        let readings = Readings::of(make, take);
        for (breath, _) in take.breaths.iter().zip(&clear).filter(|(_, clear)| **clear) {
            tally.share(Section::Microphones, name, readings.answer(breath).detected);
        }
        let triggers = readings.false_positives(&take.breaths, 0.0);
        tally.rate(Section::Microphones, &format!("{name}: false triggers"), triggers, take.duration());
    };
    compare("a open (20 Hz, order 1)", &plain);
    compare("b gain control", &stage.recorded(&Microphone { gain_control: true, ..*open }, seed));
    compare("c noise suppression", &stage.recorded(&Microphone { suppression: true, ..*open }, seed));
    compare("d gain +12 dB", &stage.recorded(&open.with_gain(12.0), seed));
    compare("e gain -12 dB", &stage.recorded(&open.with_gain(-12.0), seed));
    for rate in [8_000, 44_100, 48_000] {
        compare(&format!("f sample rate {:>4.1} kHz", f64::from(rate) / 1000.0), &plain.at_rate(rate));
    }
    for corner in CORNERS_HZ {
        for order in 1..=4 {
            let microphone = Microphone { high_pass_hz: corner, order, ..*open };
            compare(&format!("g high-pass {corner:3} Hz, order {order}"), &stage.recorded(&microphone, seed));
        }
    }
}

/// Makes a take of holds with dips and scores how they are tracked.
pub fn dips(make: &Make<'_>, scenario: &Scenario, (seed, index): (u64, u64), capsules: usize) -> Tally {
    let mut random = Random::new(hash_words(&[seed, index, 0x6469_7073]));
    let spacing = spacing(capsules, &mut random);
    let breaths = visitor(&[Manner::Hold; 3], index, spacing, &mut random);
    let breaths: Vec<Breath> = breaths.into_iter().map(|breath| Breath { dips: true, ..breath }).collect();
    let stage = stage(scenario, &breaths, capsules, &mut random);
    let take = stage.recorded(&Microphone::random(&mut random), seed ^ index);
    let readings = Readings::of(make, &take);
    let mut tally = Tally::default();
    for breath in take.breaths.iter().filter(|breath| is_clear(breath)) {
        let answer = readings.answer(breath);
        tally.share(Section::Breaths, "g holds with dips of 10 dB tracked for 90 %, clear", answer.tracked >= TRACKED);
    }
    tally
}
