//! Texts for states of devices, detector, motion and self-test, in the staff's language.

use std::path::Path;
use std::sync::Arc;

use crate::live::microphone::MicrophoneHealth;
use crate::pages::ui_strings::{TextId, UiStrings};
use crate::venue::self_test::{REFERENCE_RUNS, Verdict};
use soffio_config::remedies;
use soffio_detector::{BlowEstimate, Reason};
use soffio_devices::audio::DeviceState;
use soffio_simulation::MotionMode;

/// State of an audio device. Its name, and the system's reason for a failure, stay in the system's language.
pub(crate) fn device(texts: &UiStrings, state: &DeviceState) -> String {
    match state {
        DeviceState::Starting => texts.get(TextId::StaffDeviceStarting).to_owned(),
        DeviceState::Ok { name, sample_rate } => {
            let variables = [("name", name.as_str().into()), ("rate", sample_rate.to_string().into())];
            texts.format(TextId::StaffDeviceOk, &variables).to_string()
        }
        DeviceState::Missing(reason) => {
            texts.format(TextId::StaffDeviceMissing, &[("reason", reason.as_str().into())]).to_string()
        }
        DeviceState::Closed => texts.get(TextId::StaffDeviceClosed).to_owned(),
    }
}

/// The detector's reason for its decision.
pub(crate) fn reason(reason: Reason) -> TextId {
    match reason {
        Reason::NoSignal => TextId::StaffReasonNoSignal,
        Reason::Settling => TextId::StaffReasonSettling,
        Reason::Quiet => TextId::StaffReasonQuiet,
        Reason::Voiced => TextId::StaffReasonVoiced,
        Reason::OtherSound => TextId::StaffReasonOtherSound,
        Reason::Pending => TextId::StaffReasonPending,
        Reason::Blow => TextId::StaffReasonBlow,
        Reason::LoudspeakerEcho => TextId::StaffReasonMasked,
        Reason::Fault => TextId::StaffReasonFault,
    }
}

/// The detector's decision: reason and confidence.
pub(crate) fn decision(texts: &UiStrings, estimate: &BlowEstimate) -> Arc<str> {
    let confidence = format!("{:.2}", estimate.confidence).into();
    let reason = texts.get(reason(estimate.reason)).into();
    texts.format(TextId::StaffDetectorState, &[("reason", reason), ("confidence", confidence)])
}

/// Was automatic gain control detected?
pub(crate) fn gain_control<'a>(texts: &'a UiStrings, estimate: &BlowEstimate) -> &'a str {
    texts.get(match estimate.gain_control {
        true => TextId::StaffGainControlDetected,
        false => TextId::StaffGainControlNone,
    })
}

/// How often the microphone clipped.
pub(crate) fn clips(texts: &UiStrings, health: &MicrophoneHealth) -> Arc<str> {
    let without = health.clips_without_breath.to_string().into();
    texts.format(TextId::StaffClips, &[("count", health.clips.into()), ("without", without)])
}

/// A remedy of [`remedies`] in the staff's language; others as they are.
pub(crate) fn remedy_text<'a>(texts: &'a UiStrings, remedy: &'static str) -> &'a str {
    match remedy {
        remedies::GAIN_CONTROL => texts.get(TextId::StaffRemedyGainControl),
        remedies::CLIPPING => texts.get(TextId::StaffRemedyClipping),
        remedies::MUTED => texts.get(TextId::StaffRemedyMuted),
        remedies::LOUD => texts.get(TextId::StaffRemedyLoud),
        other => other,
    }
}

/// The kind of motion of the exhibit.
pub(crate) fn mode(mode: MotionMode) -> TextId {
    match mode {
        MotionMode::Dynamic => TextId::StaffMotionDynamics,
        MotionMode::Procedural => TextId::StaffMotionProcedural,
        MotionMode::PositionBased => TextId::StaffMotionPositionBased,
    }
}

/// Verdict of the audio self-test.
pub(crate) fn verdict(texts: &UiStrings, verdict: &Verdict) -> Arc<str> {
    let by = |id, db: String| texts.format(id, &[("db", db.into())]);
    match verdict {
        Verdict::Good(db) => by(TextId::StaffSelfTestGood, format!("{db:+.1}")),
        Verdict::Learns(number) => {
            let variables = [("number", number.to_string().into()), ("count", REFERENCE_RUNS.to_string().into())];
            texts.format(TextId::StaffSelfTestLearning, &variables)
        }
        Verdict::WetFoam(db) => by(TextId::StaffSelfTestWetFoam, format!("{db:.0}")),
        Verdict::Blocked(db) => by(TextId::StaffSelfTestBlocked, format!("{db:.0}")),
        Verdict::Louder(db) => by(TextId::StaffSelfTestLouder, format!("{db:.0}")),
        Verdict::DeadMicrophone => texts.get(TextId::StaffSelfTestDead).into(),
        Verdict::Unheard => texts.get(TextId::StaffSelfTestNotDetected).into(),
        Verdict::Noisy => texts.get(TextId::StaffSelfTestNoisy).into(),
        Verdict::None(why) => texts.format(TextId::StaffSelfTestFailed, &[("reason", why.as_str().into())]),
    }
}

/// Confirms that a file was saved.
pub(crate) fn saved_in(texts: &UiStrings, file: &Path) -> String {
    texts.format(TextId::StaffSavedIn, &[("file", file.display().to_string().into())]).to_string()
}
