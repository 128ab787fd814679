//! `soffio breath fit`: sets the detector's threshold and sensitivity for one venue, from recordings made there.

use std::path::PathBuf;

use serde::Serialize;

use crate::commands::failure::{Failure, Outcome};
use soffio_config::{Config, remedies};
use soffio_detector::{BlowDetector, BlowSettings};
use soffio_offline::venue_recordings::{self, Kind, Label};
use soffio_offline::wav::Recording;
use soffio_soundscape::statistics::{poisson, quantile, wilson};

/// Thresholds that are tried, nats: from the lowest that the configuration allows, in steps that a few recordings distinguish.
const THRESHOLDS: std::ops::RangeInclusive<i32> = -6..=8;
/// Size of a step of the threshold, nats.
const STEP: f64 = 0.5;
/// Room that a detector hears before each recording, s: the floors need it.
const AMBIENT_BEFORE_S: f64 = 10.0;
/// Samples that are pushed at once, a part of a second: the detector's own frames.
const BLOCKS_A_SECOND: u32 = 125;

/// Sets the detector for this venue: `breath.threshold` and `breath.sensitivity_db`, from a folder of `soffio-record-breaths`.
///
/// It changes nothing; it prints the lines for kiosk.toml, and how sure the detector is before and after.
///
/// Example: soffio breath fit recordings-of-the-gallery
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Folder with labels.csv and its WAV files.
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    /// The site's configuration [default: kiosk-config/kiosk.toml here or above, else built in]
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// One JSON object instead of text
    #[arg(long)]
    json: bool,
}

/// What a detector does with the recordings of a venue.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Scores {
    /// `breath.threshold`, nats.
    pub threshold: f64,
    /// Breaths that it hears.
    pub detected: usize,
    /// All breaths.
    pub breaths: usize,
    /// 95 % bounds of the share that it hears (Wilson).
    pub share: (f64, f64),
    /// Sounds of the room that it takes for breaths.
    pub triggers: usize,
    /// Length of the recordings of the ambient, h.
    pub hours: f64,
    /// 95 % bounds of its false triggers an hour (Poisson).
    pub triggers_per_hour: (f64, f64),
    /// Mean speed at the lips of each breath that it hears, m/s.
    #[serde(skip)]
    pub speeds: Vec<f64>,
}

/// What is proposed, and how it does.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fit {
    /// With the settings of the configuration.
    pub before: Scores,
    /// With those proposed.
    pub after: Scores,
    /// Proposed `breath.sensitivity_db`.
    pub sensitivity_db: f64,
    /// Median distance of the breaths, cm.
    pub distance_cm: Option<f64>,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Outcome {
    let config = Config::load(args.config.as_deref()).map_err(Failure::input)?.config;
    let takes = venue_recordings::read(&args.folder).map_err(Failure::input)?;
    let breath = &config.breath;
    let fit = fit(&takes, breath.threshold, breath.sensitivity_db).map_err(Failure::input)?;
    if args.json {
        println!("{}", serde_json::json!(fit));
        return Ok(());
    }
    println!("before (breath.threshold = {}): {}", fit.before.threshold, sentence(&fit.before, fit.distance_cm));
    println!("after:  {}", sentence(&fit.after, fit.distance_cm));
    println!("\n[breath]\nthreshold = {:.1}\nsensitivity_db = {:.1}", fit.after.threshold, fit.sensitivity_db);
    println!("detected = {}\ndetected_of = {}", fit.after.detected, fit.after.breaths);
    println!("detected_at_cm = {:.0}", fit.distance_cm.unwrap_or_default());
    println!(
        "\nThreshold and sensitivity were chosen from these recordings. Record ten more breaths to see how they do on others."
    );
    Ok(())
}

/// How sure the detector is, in a sentence.
fn sentence(scores: &Scores, distance_cm: Option<f64>) -> String {
    let at = distance_cm.map_or(String::new(), |cm| format!(" at {cm:.0} cm"));
    let (least, most) = (100.0 * scores.share.0, 100.0 * scores.share.1);
    let ambient = match scores.hours > 0.0 {
        true => format!(
            "{} false triggers in {:.0} min of the room ({:.0} to {:.0} an hour)",
            scores.triggers,
            60.0 * scores.hours,
            scores.triggers_per_hour.0,
            scores.triggers_per_hour.1
        ),
        false => "no recording of the room".to_owned(),
    };
    format!("hears {} of {} breaths{at} ({least:.0} to {most:.0} %); {ambient}", scores.detected, scores.breaths)
}

/// Chooses the threshold in the middle of all those that do best: fewest errors, where a false trigger counts as much as a missed
/// breath. The middle keeps the greatest distance from both kinds of error.
///
/// # Errors
/// No recording is of a breath.
pub fn fit(takes: &[(Label, Recording)], threshold: f64, sensitivity_db: f64) -> Result<Fit, String> {
    if !takes.iter().any(|(label, _)| label.kind == Kind::Breath) {
        return Err("no recording is labelled \"breath\"; ten breaths are needed".to_owned());
    }
    let tried: Vec<Scores> = THRESHOLDS.map(|step| listen(takes, STEP * f64::from(step), sensitivity_db)).collect();
    let errors = |scores: &Scores| scores.breaths - scores.detected + scores.triggers;
    let fewest = tried.iter().map(errors).min().unwrap_or(0);
    let best: Vec<&Scores> = tried.iter().filter(|scores| errors(scores) == fewest).collect();
    let after = best[best.len() / 2].clone();
    let proposed = match after.speeds.is_empty() {
        true => sensitivity_db,
        false => remedies::sensitivity(quantile(&after.speeds, 0.5), sensitivity_db),
    };
    let distances: Vec<f64> = takes.iter().filter_map(|(label, _)| label.distance_cm).collect();
    Ok(Fit {
        before: listen(takes, threshold, sensitivity_db),
        after,
        sensitivity_db: proposed,
        distance_cm: (!distances.is_empty()).then(|| quantile(&distances, 0.5)),
    })
}

/// Runs a detector over all recordings; before each it hears the end of the empty room.
fn listen(takes: &[(Label, Recording)], threshold: f64, sensitivity_db: f64) -> Scores {
    let ambient = takes.iter().find(|(label, _)| label.kind == Kind::EmptyRoom).map(|(_, recording)| recording);
    let mut scores = Scores { threshold, ..Scores::default() };
    for (label, recording) in takes {
        let settings = BlowSettings { threshold, sensitivity_db, ..BlowSettings::default() };
        let mut detector = BlowDetector::with_settings(recording.sample_rate, settings);
        if let Some(ambient) = ambient.filter(|ambient| ambient.sample_rate == recording.sample_rate) {
            let from =
                ambient.samples.len().saturating_sub((AMBIENT_BEFORE_S * f64::from(ambient.sample_rate)) as usize);
            push(&mut detector, ambient, from..ambient.samples.len());
        }
        let block = (recording.sample_rate / BLOCKS_A_SECOND) as usize;
        let (mut triggers, mut before, mut speeds) = (0, detector.estimate().speed, Vec::new());
        for start in (0..recording.samples.len()).step_by(block) {
            push(&mut detector, recording, start..(start + block).min(recording.samples.len()));
            let speed = detector.estimate().speed;
            triggers += usize::from(before == 0.0 && speed > 0.0);
            speeds.extend(Some(speed).filter(|speed| *speed > 0.0));
            before = speed;
        }
        match label.kind {
            Kind::Breath => {
                scores.breaths += 1;
                scores.detected += usize::from(triggers > 0);
                if triggers > 0 {
                    scores.speeds.push(speeds.iter().sum::<f64>() / speeds.len() as f64);
                }
            }
            Kind::EmptyRoom | Kind::FullRoom => {
                scores.triggers += triggers;
                scores.hours += recording.duration() / 3600.0;
            }
        }
    }
    scores.share = wilson(scores.detected, scores.breaths);
    let (least, most) = poisson(scores.triggers);
    let hours = scores.hours.max(f64::MIN_POSITIVE);
    scores.triggers_per_hour = (least / hours, most / hours);
    scores
}

fn push(detector: &mut BlowDetector, recording: &Recording, range: std::ops::Range<usize>) {
    match &recording.capsules {
        Some([left, right]) => detector.push_stereo(&left[range.clone()], &right[range], &[]),
        None => detector.push(&recording.samples[range], &[]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_soundscape::breath::Breath;
    use soffio_soundscape::test_sounds as sounds;

    const RATE: u32 = 16_000;

    fn take(kind: Kind, samples: Vec<f32>) -> (Label, Recording) {
        let label = Label {
            file: String::new(),
            kind,
            distance_cm: Some(20.0).filter(|_| kind == Kind::Breath),
            angle_deg: None,
            age_group: String::new(),
        };
        (label, Recording { samples, capsules: None, sample_rate: RATE })
    }

    #[test]
    fn a_threshold_that_is_too_high_for_the_venue_is_lowered_and_its_strength_set() {
        let quiet = |seed| Breath { speed: 6.0, ..Breath::default() }.recorded(RATE, seed);
        let mut takes: Vec<_> = (0..6).map(|seed| take(Kind::Breath, quiet(seed))).collect();
        takes.push(take(Kind::EmptyRoom, sounds::pink_noise(RATE, 9, 20.0, -60.0)));
        let fit = fit(&takes, 4.0, 0.0).expect("a fit");
        assert!(fit.before.detected < fit.after.detected, "{fit:?}");
        assert_eq!((fit.after.detected, fit.after.triggers, fit.distance_cm), (6, 0, Some(20.0)), "{fit:?}");
        assert!(sentence(&fit.after, fit.distance_cm).starts_with("hears 6 of 6 breaths at 20 cm (61 to 100 %)"));
        let again = listen(&takes, fit.after.threshold, fit.sensitivity_db);
        let median = quantile(&again.speeds, 0.5);
        assert!((median / remedies::NORMAL_M_S - 1.0).abs() < 0.1, "a normal breath has {median} m/s");
        assert!(super::fit(&takes[6..], 0.0, 0.0).is_err_and(|why| why.contains("ten breaths")));
    }
}
