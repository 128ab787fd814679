//! Loudness control: volume steps of visitors, mute and night mode of staff, and the exposure limit.
//!
//! It updates once a second. A change of volume by a visitor takes effect at once, everything else within a second.

use std::time::{Duration, Instant};

use jiff::Zoned;

use soffio_config::{Hours, TimeOfDay};
use soffio_devices::audio::{Knobs, PlayedEnergy};
use soffio_math::db_to_amplitude;
use soffio_sound::{Exposure, Volume, VolumeSettings};

/// Time between two updates.
const UPDATE_INTERVAL: Duration = Duration::from_secs(1);

/// What decides whether it is night.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum NightBy {
    /// The configured hours.
    #[default]
    Hours,
    /// Staff: night.
    Night,
    /// Staff: day.
    Day,
}

impl NightBy {
    fn next(self) -> Self {
        match self {
            Self::Hours => Self::Night,
            Self::Night => Self::Day,
            Self::Day => Self::Hours,
        }
    }
}

impl NightBy {
    /// Presses of the night key that lead here from the configured hours.
    pub fn presses(self) -> u32 {
        match self {
            Self::Hours => 0,
            Self::Night => 1,
            Self::Day => 2,
        }
    }
}

/// Requested changes of the loudness, collected by the window; a step takes all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VolumeRequests {
    /// Volume steps up; negative: down.
    pub louder: i32,
    /// Mute or unmute by a remote command.
    pub muted: Option<bool>,
    /// Presses of the staff's mute key after that command.
    pub mutes: u32,
    /// Presses of the staff's night key.
    pub nights: u32,
    /// The visitor has left: volume steps are reset.
    pub leaves: bool,
}

impl VolumeRequests {
    /// Adds the next requests.
    pub fn add(&mut self, next: Self) {
        self.louder += next.louder;
        if next.muted.is_some() {
            (self.muted, self.mutes) = (next.muted, 0);
        }
        self.mutes += next.mutes;
        self.nights += next.nights;
        self.leaves |= next.leaves;
    }
}

/// State of the loudness, for the staff panel and the metrics.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoudnessStatus {
    /// Volume, dB.
    pub volume_db: f64,
    /// Volume steps of the visitor.
    pub steps: i32,
    /// Muted by staff?
    pub muted: bool,
    /// Is it night?
    pub night: bool,
    /// What decides it.
    pub by: NightBy,
    /// Attenuation that keeps the exposure limit, dB: above 0 after a minute that was too loud.
    pub exposure_attenuation_db: f64,
    /// A-weighted level of the last minute and of the day, dB of a full-scale sine; −∞ for silence.
    pub level_db: [f64; 2],
    /// The same at the listening position, dB(A), where the kiosk is calibrated.
    pub laeq_db: [Option<f64>; 2],
}

/// Settings of the loudness, from the site's configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct LoudnessSettings {
    /// Volume, its steps, and the exposure limit.
    pub volume: VolumeSettings,
    /// Hours of night mode.
    pub night: Hours,
    /// Does attract mode play without a sound?
    pub silent_attract: bool,
}

/// What the kiosk does now, as far as it changes the volume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KioskActivity {
    /// Does attract mode play?
    pub attracts: bool,
    /// Is the venue closed? Then the kiosk is silent.
    pub closed: bool,
}

/// Whether the output still counts from where it began.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputCount {
    /// It counts on.
    Continued,
    /// It was opened again and counts from zero.
    Restarted,
}

/// Loudness control of the kiosk.
pub struct Loudness {
    volume: Volume,
    exposure: Exposure,
    hours: Hours,
    by: NightBy,
    night: bool,
    silent_attract: bool,
    activity: KioskActivity,
    looked: Option<Instant>,
    /// What the output had played at the last update.
    before: PlayedEnergy,
}

impl Loudness {
    /// The state that every visitor finds.
    pub fn new(settings: LoudnessSettings) -> Self {
        let LoudnessSettings { volume, night, silent_attract } = settings;
        Self {
            volume: Volume::new(volume),
            exposure: Exposure::default(),
            hours: night,
            by: NightBy::Hours,
            night: false,
            silent_attract,
            activity: KioskActivity::default(),
            looked: None,
            before: PlayedEnergy::default(),
        }
    }

    /// Takes over changed settings. The measured exposure is kept, and so is the mute of staff.
    pub fn reconfigure(&mut self, settings: LoudnessSettings, output: OutputCount) {
        let (by, exposure) = (self.by, std::mem::take(&mut self.exposure));
        let before = match output {
            OutputCount::Continued => self.before,
            OutputCount::Restarted => PlayedEnergy::default(),
        };
        let mut former = self.volume.clone();
        former.reconfigure(settings.volume);
        *self = Self { volume: former, by, exposure, before, ..Self::new(settings) };
    }

    /// Applies the requests and sets volume and night mode of the output.
    pub fn update(&mut self, requests: VolumeRequests, activity: KioskActivity, knobs: &Knobs) {
        let requested = requests != VolumeRequests::default() || activity != self.activity;
        self.activity = activity;
        let due = self.looked.is_none_or(|at| at.elapsed() >= UPDATE_INTERVAL);
        if !(requested || due) {
            return;
        }
        self.volume.step(requests.louder);
        let muted = self.volume.is_muted();
        if (requests.muted.unwrap_or(muted) != (requests.mutes % 2 == 1)) != muted {
            self.volume.toggle_mute();
            tracing::info!("{}", if self.volume.is_muted() { "muted by staff" } else { "unmuted by staff" });
        }
        (0..requests.nights).for_each(|_| self.by = self.by.next());
        if requests.leaves {
            self.volume.reset();
        }
        self.look(due, knobs);
        let silent = activity.closed || self.volume.is_muted() || activity.attracts && self.silent_attract;
        knobs.set_volume(if silent { 0.0 } else { db_to_amplitude(self.volume.db()) as f32 });
        knobs.set_night(self.night);
    }

    /// Sets the volume again at the next update: something else has set it meanwhile.
    pub fn invalidate(&mut self) {
        self.looked = None;
    }

    fn look(&mut self, due: bool, knobs: &Knobs) {
        let now = Zoned::now();
        let minutes = 60 * u16::from(now.hour().unsigned_abs()) + u16::from(now.minute().unsigned_abs());
        let night = match self.by {
            NightBy::Hours => self.hours.contain(TimeOfDay::from_minutes(minutes)),
            NightBy::Night => true,
            NightBy::Day => false,
        };
        if night != self.night {
            tracing::info!("sound mode: {}", if night { "night" } else { "day" });
        }
        self.night = night;
        if !due {
            return;
        }
        self.looked = Some(Instant::now());
        let played = knobs.played();
        let passed = played.seconds - self.before.seconds;
        if passed > 0.0 {
            let day = 366 * u64::from(now.year().unsigned_abs()) + u64::from(now.day_of_year().unsigned_abs());
            self.exposure.note((played.energy - self.before.energy) / passed, passed, day);
            self.volume.apply_exposure_limit(self.exposure.minute(), passed);
            self.before = played;
        }
    }

    /// The present state.
    pub fn status(&self) -> LoudnessStatus {
        let level_db = [self.exposure.minute(), self.exposure.day()];
        LoudnessStatus {
            volume_db: self.volume.db(),
            steps: self.volume.steps(),
            muted: self.volume.is_muted(),
            night: self.night,
            by: self.by,
            exposure_attenuation_db: self.volume.attenuation_db(),
            level_db,
            laeq_db: level_db.map(|level| self.volume.spl(level)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Settings with this volume, dB.
    fn settings(default_db: f64) -> LoudnessSettings {
        let volume = VolumeSettings { default_db, step_db: 3.0, steps: 3, full_scale_db_spl: None, max_laeq_db: 70.0 };
        LoudnessSettings { volume, night: Hours::default(), silent_attract: false }
    }

    #[test]
    fn a_staff_mute_outlasts_a_changed_configuration_and_a_visitors_steps_go_with_the_visitor() {
        let knobs = Knobs::new(1.0);
        let mut loudness = Loudness::new(settings(-6.0));
        let update = |loudness: &mut Loudness, requests| loudness.update(requests, KioskActivity::default(), &knobs);
        update(&mut loudness, VolumeRequests { louder: 2, mutes: 1, ..VolumeRequests::default() });
        assert!(loudness.status().muted && loudness.status().steps == 2);

        let silent = LoudnessSettings { silent_attract: true, ..settings(-9.0) };
        loudness.reconfigure(silent, OutputCount::Continued);
        update(&mut loudness, VolumeRequests { louder: 1, ..VolumeRequests::default() });
        assert!(loudness.status().muted, "nobody has unmuted it");
        assert_eq!(
            (loudness.status().steps, loudness.status().volume_db),
            (1, -6.0),
            "the site's new volume, one step up"
        );

        update(&mut loudness, VolumeRequests { leaves: true, ..VolumeRequests::default() });
        assert!(loudness.status().muted && loudness.status().steps == 0, "the next visitor finds the site's volume");
    }

    #[test]
    fn the_last_word_on_the_sound_counts() {
        let mut requests = VolumeRequests::default();
        let order = |muted| VolumeRequests { muted: Some(muted), ..VolumeRequests::default() };
        let press = VolumeRequests { mutes: 1, louder: 1, ..VolumeRequests::default() };
        [press, order(true), order(true)].into_iter().for_each(|next| requests.add(next));
        assert_eq!(requests, VolumeRequests { muted: Some(true), louder: 1, ..VolumeRequests::default() });
        requests.add(press);
        assert_eq!(requests, VolumeRequests { muted: Some(true), mutes: 1, louder: 2, ..VolumeRequests::default() });

        let knobs = Knobs::new(1.0);
        let mut loudness = Loudness::new(settings(-6.0));
        let mut update = |requests| {
            loudness.update(requests, KioskActivity::default(), &knobs);
            loudness.status().muted
        };
        assert!(update(order(true)) && update(order(true)), "ordered twice it stays muted");
        assert!(!update(requests), "muted from afar, and sounds again by staff");
        assert!(!update(order(false)));
    }
}
