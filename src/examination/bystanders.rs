//! Takes without breath: noises, draughts and the kiosk's own sound; and clear breaths in draughts.

use soffio_math::noise::{Random, hash_words};
use soffio_soundscape::RATE;
use soffio_soundscape::breath::{Breath, Manner, Person};
use soffio_soundscape::draught::Draught;
use soffio_soundscape::microphone::Microphone;
use soffio_soundscape::scenes::{Noise, Scenario, Stage};

use crate::breaths::{add_gallery, spacing};
use crate::listening::{Readings, is_clear};
use crate::subject::Make;
use crate::tally::{Section, Tally};

/// Length of a take of noise, s.
const MINUTE_S: f64 = 60.0;
/// Time of learning before noise counts, s.
const LEARNING_S: f64 = 5.0;
/// Time of learning before a draught counts, s.
const DRAUGHT_LEARNING_S: f64 = 120.0;
/// Breaths after a draught.
const BREATHS_IN_DRAUGHT: usize = 6;
/// Level of a full-scale output at the microphone, dB of sound.
const ECHO_DB: (f64, f64) = (88.0, 104.0);

/// Noise of one kind, or a museum's mixture, without breath.
pub fn noise(
    make: &Make<'_>,
    scenario: &Scenario,
    (seed, index): (u64, u64),
    capsules: usize,
    kind: Option<Noise>,
) -> Tally {
    let number = kind.map_or(99, |kind| kind as u64);
    let mut random = Random::new(hash_words(&[seed, index, 0x6e6f_6973, number]));
    let mut stage = Stage::new(MINUTE_S + LEARNING_S, capsules);
    let seconds = stage.seconds() + 0.01;
    let level = random.range(32.0, 52.0);
    stage.add_noise(0.0, &scenario.air_noise(seconds, level, capsules, &mut random), &[]);
    let (sound, events) = match kind {
        Some(kind) => scenario.noise(kind, seconds - LEARNING_S, capsules, &mut random),
        None => scenario.crowd(seconds - LEARNING_S, random.range(0.3, 2.0), capsules, &mut random),
    };
    stage.add_noise(LEARNING_S, &sound, &events);
    let take = stage.recorded(&Microphone::random(&mut random), seed ^ index);
    let triggers = Readings::of(make, &take).false_positives(&[], LEARNING_S);
    let mut tally = Tally::default();
    let name = kind.map_or("a museum".to_owned(), |kind| format!("b {}", kind.name()));
    tally.rate(Section::Noises, &name, triggers, MINUTE_S);
    tally
}

/// A draught of a speed (m/s) and a length (m) over some seconds after two minutes of learning, then clear breaths in it.
pub fn draught(
    make: &Make<'_>,
    scenario: &Scenario,
    (seed, index): (u64, u64),
    capsules: usize,
    (speed, length, seconds): (f64, f64, f64),
) -> Tally {
    let mut random = Random::new(hash_words(&[seed, index, speed.to_bits(), length.to_bits()]));
    let learning = DRAUGHT_LEARNING_S.min(2.0 * seconds);
    let spacing = spacing(capsules, &mut random);
    let breath = |_| Breath {
        lead_in: random.range(1.5, 4.0),
        spacing,
        beside: 0.5 * spacing,
        angle_deg: random.range(0.0, 4.0),
        ..Breath::random(Manner::Plain, Person::Adult, (0.09, 0.30), &mut random)
    };
    let breaths: Vec<Breath> = (0..BREATHS_IN_DRAUGHT).map(breath).collect();
    let whole = learning + seconds + breaths.iter().map(Breath::duration).sum::<f64>() + 0.5;
    let mut stage = Stage::new(whole, capsules);
    let level = random.range(32.0, 50.0);
    stage.add_noise(0.0, &scenario.air_noise(whole, level, capsules, &mut random), &[]);
    let air = Draught::random(speed, length, spacing, &mut random);
    stage.add_noise(0.0, &air.pressure(whole, RATE, random.word()), &[]);
    let mut at = learning + seconds;
    for breath in &breaths {
        stage.add_breath(at, breath, random.word());
        at += breath.duration();
    }
    let take = stage.recorded(&Microphone::random(&mut random), seed ^ index);
    let readings = Readings::of(make, &take);
    let mut tally = Tally::default();
    let name = format!("{speed:.1} m/s, length {length:4.2} m");
    let triggers = readings.false_positives(&take.breaths, learning);
    tally.rate(Section::Draughts, &format!("a triggers in {name}"), triggers, whole - learning);
    tally.rate(Section::Draughts, "b triggers in all draughts", triggers, whole - learning);
    for breath in take.breaths.iter().filter(|breath| is_clear(breath)) {
        let detected = readings.answer(breath).detected;
        tally.share(Section::Draughts, &format!("c clear breaths in {speed:.1} m/s"), detected);
    }
    tally
}

/// The kiosk's own sound at full volume, in a room.
pub fn kiosk(make: &Make<'_>, scenario: &Scenario, (seed, index): (u64, u64), capsules: usize) -> Tally {
    let mut random = Random::new(hash_words(&[seed, index, 0x6b69_6f73]));
    let mut stage = Stage::new(MINUTE_S, capsules);
    add_gallery(scenario, &mut stage, capsules, &mut random);
    let played = scenario.kiosk_output(MINUTE_S, &mut random);
    let level = random.range(ECHO_DB.0, ECHO_DB.1);
    let echo = scenario.echo(&played, level, capsules, &mut random);
    stage.add_echo(&played, &echo);
    let take = stage.recorded(&Microphone::random(&mut random), seed ^ index);
    let triggers = Readings::of(make, &take).false_positives(&[], LEARNING_S);
    let mut tally = Tally::default();
    tally.rate(Section::Kiosk, "self-triggers at full volume", triggers, MINUTE_S - LEARNING_S);
    tally
}
