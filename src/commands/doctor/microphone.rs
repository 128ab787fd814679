//! Findings about a microphone: its level without a breath, and a breath.

use super::finding::{Finding, Health};
use soffio_config::remedies::{self, NORMAL_M_S};
use soffio_detector::bands::{BANDS, BIN_HZ, EDGES};
use soffio_detector::{BlowDetector, BlowEstimate, Reason};
use soffio_math::{amplitude_to_db, log10};

/// Judges a microphone by a second of sound without a breath.
pub fn judge_room(samples: &[f32], sample_rate: u32) -> Finding {
    /// Quieter than any room through any microphone, dB of full scale: it is switched off.
    const MUTED_DBFS: f64 = -100.0;
    /// Share of samples at the rails from which it clips.
    const CLIPPED: f64 = 1e-4;
    /// Rise from the first to the last tenth of the time, dB, that only a gain that adapts makes in a steady room.
    const CREEPING_DB: f64 = 8.0;
    const WHAT: &str = "microphone level";

    // The first tenth is left out: streams begin with silence and clicks.
    let settled = &samples[samples.len() / 10..];
    let peak = settled.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
    let level = |part: &[f32]| {
        let power: f64 = part.iter().map(|&x| f64::from(x) * f64::from(x)).sum();
        amplitude_to_db((power / part.len().max(1) as f64).sqrt())
    };
    let rms = level(settled);
    let tenths: Vec<f64> = settled.chunks((settled.len() / 9).max(1)).map(level).collect();
    let creeps = tenths.windows(2).all(|pair| pair[1] >= pair[0])
        && tenths.first().zip(tenths.last()).is_some_and(|(first, last)| last - first > CREEPING_DB);
    let railed = settled.iter().filter(|sample| sample.abs() >= 0.999).count();
    let clipped = railed as f64 / settled.len().max(1) as f64;
    let mut detector = BlowDetector::new(sample_rate);
    detector.push(samples, &[]);
    let floor = detector.estimate().floor_dbfs;

    let found = match peak {
        0.0 => "not a single sample differs from zero".to_owned(),
        _ => format!(
            "{rms:.1} dBFS, peak {:.1} dBFS, {railed} samples at full scale; floor of the band of breath {floor:.1} dBFS",
            amplitude_to_db(f64::from(peak))
        ),
    };
    if settled.len() < sample_rate as usize / 2 {
        let found = format!("{} samples in a second that has {sample_rate}", samples.len());
        return Finding::new(WHAT, Health::Bad, found, "too few samples arrive: try another socket or another device");
    }
    if rms < MUTED_DBFS {
        return Finding::new(WHAT, Health::Bad, found, remedies::MUTED);
    }
    if clipped > CLIPPED {
        return Finding::new(WHAT, Health::Warn, found, remedies::CLIPPING);
    }
    if creeps {
        let remedy = format!("the level creeps up by itself: {}", remedies::GAIN_CONTROL);
        return Finding::new(WHAT, Health::Warn, found, remedy);
    }
    if rms > remedies::LOUD_DBFS {
        return Finding::new(WHAT, Health::Warn, found, remedies::LOUD);
    }
    Finding::new(WHAT, Health::Ok, found, "")
}

/// Names a microphone that cuts off low tones, by the mean level of each band during breaths, dB of full scale. Air at a capsule has a
/// flat spectrum below its corner, so low bands that are weaker were cut off. `None` where it cuts off no more than rumble.
pub fn judge_low_tones(levels: &[f64; BANDS]) -> Option<Finding> {
    /// Weaker than the strongest band by so much a hertz: cut off.
    const CUT_DB: f64 = 10.0;
    /// A high-pass up to here leaves the most of a breath, Hz.
    const HARMLESS_HZ: f64 = 75.0;
    let density = |band: usize| levels[band] - 10.0 * log10((EDGES[band + 1] - EDGES[band]) as f64);
    let strongest = (0..BANDS).map(density).fold(f64::NEG_INFINITY, f64::max);
    let first = (0..BANDS).find(|band| density(*band) > strongest - CUT_DB)?;
    let from_hz = EDGES[first] as f64 * BIN_HZ;
    let found = format!(
        "a breath has its lowest tones at {from_hz:.0} Hz: the microphone or its driver cuts off what is below"
    );
    let remedy = "switch off its low cut (\"HPF\", \"voice\"), or use another microphone; until then visitors must blow from \
                  within 25 cm";
    (from_hz > HARMLESS_HZ).then(|| Finding::new("low tones", Health::Warn, found, remedy))
}

/// Factor within which a speed is normal: breaths differ by as much.
const ALIKE: f64 = 1.35;

/// Without a detected breath, more than one step in so many at full scale means clipping.
const CLIPPED_PART: usize = 10;
/// Remedy for an input at full scale.
const RAILED: &str =
    "the input is at full scale and cannot distinguish strong from gentle: turn the input gain down, then repeat";

/// Judges microphone and settings by normal breaths from where visitors stand. `steps` are the detector's estimates, and
/// `sensitivity_db` is the setting that they were measured with.
pub fn judge_blow(steps: &[BlowEstimate], sensitivity_db: f64) -> Finding {
    const WHAT: &str = "a breath";
    let blown = || steps.iter().filter(|step| step.reason == Reason::Blow);
    let count = blown().count();
    if count == 0 {
        let loudest = steps.iter().max_by(|a, b| a.level_dbfs.total_cmp(&b.level_dbfs)).copied().unwrap_or_default();
        let found = format!(
            "none heard: at most {:.0} dBFS over a room of {:.0}, {:?}",
            loudest.level_dbfs, loudest.floor_dbfs, loudest.reason
        );
        let clipped = steps.iter().filter(|step| step.clipping).count();
        let remedy = if clipped > steps.len() / CLIPPED_PART {
            RAILED
        } else {
            "blow at the capsule itself, nearer, for a second; take off thick foam; or turn the input gain up"
        };
        return Finding::new(WHAT, Health::Bad, found, remedy);
    }
    let mean = blown().map(|step| step.speed).sum::<f64>() / count as f64;
    let rails = blown().filter(|step| step.clipping).count() as f64 / count as f64;
    let last = steps.last().copied().unwrap_or_default();
    let breaths = steps.windows(2).filter(|two| two[1].reason == Reason::Blow && two[0].reason != Reason::Blow).count()
        + usize::from(steps[0].reason == Reason::Blow);
    let found = format!(
        "heard {breaths}, {mean:.1} m/s at the lips, {:.0} % of the time at full scale; floor {:.0} dBFS",
        100.0 * rails,
        last.floor_dbfs
    );
    if last.gain_control {
        let found = format!("{found}; the room is quieter after a breath than before it");
        return Finding::new(WHAT, Health::Warn, found, remedies::GAIN_CONTROL);
    }
    let wanted = remedies::sensitivity(mean, sensitivity_db);
    if rails > 0.5 && mean > NORMAL_M_S {
        return Finding::new(WHAT, Health::Warn, found, RAILED);
    }
    if (NORMAL_M_S / ALIKE..NORMAL_M_S * ALIKE).contains(&mean) {
        return Finding::new(WHAT, Health::Ok, found, "");
    }
    let remedy =
        format!("if that was a normal breath, set breath.sensitivity_db = {wanted:.1} in kiosk-config/kiosk.toml");
    Finding::new(WHAT, Health::Warn, found, remedy)
}
