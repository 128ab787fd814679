//! `soffio doctor`: what it says of a room and of a breath.

use soffio::commands::doctor::{Health, judge_blow, judge_low_tones, judge_room};
use soffio_detector::bands::BANDS;
use soffio_detector::{BlowDetector, BlowEstimate, BlowSettings};
use soffio_soundscape::breath::Breath;
use soffio_soundscape::microphone::Microphone;

const RATE: u32 = 48_000;

/// A second of white noise, full scale 1, through a gain over time (0…1 s).
fn noise(gain: impl Fn(f64) -> f64) -> Vec<f32> {
    let mut random = soffio_math::noise::Random::new(5);
    (0..RATE).map(|i| (random.signed() * gain(f64::from(i) / f64::from(RATE))).clamp(-1.0, 1.0) as f32).collect()
}

#[test]
fn a_quiet_room_is_well_and_every_fault_has_its_remedy() {
    for (what, samples, health, word) in [
        ("quiet", noise(|_| 0.002), Health::Ok, ""),
        ("muted", vec![0.0; RATE as usize], Health::Bad, "muted"),
        ("clipping", noise(|_| 3.0), Health::Warn, "clips"),
        ("loud", noise(|_| 0.3), Health::Warn, "loud"),
        ("gain control", noise(|t| 0.0005 * (1.0 + 9.0 * t)), Health::Warn, "gain control"),
        ("stuttering", noise(|_| 0.002)[..10_000].to_vec(), Health::Bad, "too few samples"),
        ("nothing", Vec::new(), Health::Bad, "too few samples"),
    ] {
        let finding = judge_room(&samples, RATE);
        assert_eq!(finding.health, health, "{what}: {finding:?}");
        assert!(finding.remedy.contains(word), "{what}: {finding:?}");
    }
}

/// What the detector says every 20 ms of a normal breath whose samples were so many dB louder.
fn blown(gain_db: f64, sensitivity_db: f64) -> Vec<BlowEstimate> {
    let gain = soffio_math::db_to_amplitude(gain_db) as f32;
    let breath = Breath::default().recorded(RATE, 7);
    let settings = BlowSettings { sensitivity_db, ..BlowSettings::default() };
    let mut detector = BlowDetector::with_settings(RATE, settings);
    let hear = |block: &[f32]| {
        let samples: Vec<f32> = block.iter().map(|x| (gain * x).clamp(-1.0, 1.0)).collect();
        detector.push(&samples, &[]);
        detector.estimate()
    };
    breath.chunks(RATE as usize / 50).map(hear).collect()
}

#[test]
fn the_doctor_proposes_a_sensitivity_that_makes_a_normal_breath_normal() {
    for gain_db in [-30.0, -20.0] {
        let finding = judge_blow(&blown(gain_db, 0.0), 0.0);
        assert_eq!(finding.health, Health::Warn, "{finding:?}");
        let proposed = finding.remedy.split("sensitivity_db = ").nth(1).and_then(|rest| rest.split(' ').next());
        let proposed: f64 = proposed.and_then(|number| number.parse().ok()).expect("a number in the remedy");
        let again = judge_blow(&blown(gain_db, proposed), proposed);
        assert_eq!(again.health, Health::Ok, "{gain_db} dB, {proposed} dB proposed: {again:?}");
    }
    assert_eq!(judge_blow(&[], 0.0).health, Health::Bad);
    let railed = judge_blow(&blown(40.0, 0.0), 0.0);
    assert!(railed.health != Health::Ok && railed.remedy.contains("gain down"), "{railed:?}");
    let mut turned = blown(-12.0, 0.0);
    turned.iter_mut().for_each(|step| step.gain_control = true);
    let turned = judge_blow(&turned, 0.0);
    assert!(turned.health == Health::Warn && turned.remedy.contains("switch off automatic gain"), "{turned:?}");
}

#[test]
fn the_doctor_names_a_microphone_that_cuts_off_low_tones() {
    let found = |high_pass_hz: f64, order: usize| {
        let microphone = Microphone { high_pass_hz, order, ..Microphone::default() };
        let breath = Breath { speed: 9.0, hold: 2.0, microphone, ..Breath::default() };
        let mut detector = BlowDetector::new(RATE);
        let (mut levels, mut count) = ([0.0; BANDS], 0.0);
        for block in breath.recorded(RATE, 7).chunks(RATE as usize / 50) {
            detector.push(block, &[]);
            if detector.estimate().speed > 0.0 {
                count += 1.0;
                levels
                    .iter_mut()
                    .zip(detector.band_levels())
                    .for_each(|(mean, level)| *mean += (level - *mean) / count);
            }
        }
        assert!(count > 0.0, "{high_pass_hz} Hz, order {order}: no breath was heard");
        judge_low_tones(&levels)
    };
    assert!(found(20.0, 1).is_none());
    let finding = found(150.0, 3).expect("a finding");
    let hz: f64 =
        finding.found.split(" Hz").next().and_then(|s| s.rsplit(' ').next()?.parse().ok()).expect("a frequency");
    assert!((75.0..225.0).contains(&hz) && finding.remedy.contains("low cut"), "{finding:?}");
}
