//! How loud the kiosk is: what visitors and staff ask for, what the house allows, and what is heard in the end.
//!
//! Looks once a second: a change of volume by a visitor is heard at once, everything else within that second.

use std::time::{Duration, Instant};

use jiff::Zoned;

use soffio_config::{Hours, TimeOfDay};
use soffio_devices::audio::Knobs;
use soffio_math::from_decibels;
use soffio_sound::{Exposure, Volume, VolumeSettings};

/// Between two looks.
const LOOK: Duration = Duration::from_secs(1);

/// Who says whether it is night.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum NightBy {
    /// The configured hours.
    #[default]
    Hours,
    /// Staff: it is.
    Night,
    /// Staff: it is not.
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

/// What is asked of the loudness, as the window tells it; taken with each step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wishes {
    /// Steps louder.
    pub louder: i32,
    /// Muted, or not, as ordered from afar, whatever it was before.
    pub muted: Option<bool>,
    /// Presses of the staff's mute, after that.
    pub mutes: u32,
    /// Presses of the staff's night key.
    pub nights: u32,
    /// The last visitor has left, and takes those steps along.
    pub leaves: bool,
}

impl Wishes {
    /// Adds what is asked for next.
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

/// The loudness as staff see it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct View {
    /// Volume, dB.
    pub volume_db: f64,
    /// A visitor's steps.
    pub steps: i32,
    /// Muted by staff?
    pub muted: bool,
    /// Is it night?
    pub night: bool,
    /// By whom.
    pub by: NightBy,
    /// Taken off because the last minute was too loud, dB.
    pub eased_db: f64,
    /// A-weighted level of the last minute and of the day, dB of a full-scale sine; −∞ for silence.
    pub level_db: [f64; 2],
    /// The same at the visitor's ear, dB(A), where the kiosk is calibrated.
    pub laeq_db: [Option<f64>; 2],
}

/// The kiosk's loudness.
pub struct Loudness {
    volume: Volume,
    exposure: Exposure,
    hours: Hours,
    by: NightBy,
    night: bool,
    silent_attract: bool,
    attracts: bool,
    closed: bool,
    looked: Option<Instant>,
    /// Energy and time at the last look.
    before: (f64, f64),
}

impl Loudness {
    /// As a visitor finds it.
    pub fn new(volume: VolumeSettings, hours: Hours, silent_attract: bool) -> Self {
        Self {
            volume: Volume::new(volume),
            exposure: Exposure::default(),
            hours,
            by: NightBy::Hours,
            night: false,
            silent_attract,
            attracts: false,
            closed: false,
            looked: None,
            before: (0.0, 0.0),
        }
    }

    /// Takes over changed settings. What was heard counts on; `anew` says that the loudspeaker's own count begins again.
    pub fn settle(&mut self, volume: VolumeSettings, hours: Hours, silent_attract: bool, anew: bool) {
        let (by, exposure) = (self.by, std::mem::take(&mut self.exposure));
        let before = if anew { (0.0, 0.0) } else { self.before };
        let mut kept = self.volume.clone();
        kept.reconfigure(volume);
        *self = Self { volume: kept, by, exposure, before, ..Self::new(volume, hours, silent_attract) };
    }

    /// Heeds what is asked for, and turns the knobs; `closed` silences them.
    pub fn tend(&mut self, wishes: Wishes, (attracts, closed): (bool, bool), knobs: &Knobs) {
        let asked = wishes != Wishes::default() || attracts != self.attracts || closed != self.closed;
        self.closed = closed;
        let due = self.looked.is_none_or(|at| at.elapsed() >= LOOK);
        if !(asked || due) {
            return;
        }
        self.volume.step(wishes.louder);
        let muted = self.volume.is_muted();
        if (wishes.muted.unwrap_or(muted) != (wishes.mutes % 2 == 1)) != muted {
            self.volume.toggle_mute();
            tracing::info!("{}", if self.volume.is_muted() { "muted by staff" } else { "sounds again" });
        }
        (0..wishes.nights).for_each(|_| self.by = self.by.next());
        if wishes.leaves {
            self.volume.reset();
        }
        self.attracts = attracts;
        self.look(due, knobs);
        let silent = closed || self.volume.is_muted() || attracts && self.silent_attract;
        knobs.set_volume(if silent { 0.0 } else { from_decibels(self.volume.db()) as f32 });
        knobs.set_night(self.night);
    }

    /// Sets the volume anew at the next call: something else has set it meanwhile.
    pub fn forget(&mut self) {
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
            tracing::info!("the sound of the {}", if night { "night" } else { "day" });
        }
        self.night = night;
        if !due {
            return;
        }
        self.looked = Some(Instant::now());
        let (energy, seconds) = knobs.played();
        let passed = seconds - self.before.1;
        if passed > 0.0 {
            let day = 366 * u64::from(now.year().unsigned_abs()) + u64::from(now.day_of_year().unsigned_abs());
            self.exposure.note((energy - self.before.0) / passed, passed, day);
            self.volume.apply_exposure_limit(self.exposure.minute(), passed);
            self.before = (energy, seconds);
        }
    }

    /// As staff see it.
    pub fn view(&self) -> View {
        let level_db = [self.exposure.minute(), self.exposure.day()];
        View {
            volume_db: self.volume.db(),
            steps: self.volume.steps(),
            muted: self.volume.is_muted(),
            night: self.night,
            by: self.by,
            eased_db: self.volume.attenuation_db(),
            level_db,
            laeq_db: level_db.map(|level| self.volume.spl(level)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_staff_mute_outlasts_a_changed_configuration_and_a_visitors_steps_go_with_the_visitor() {
        let settings =
            VolumeSettings { default_db: -6.0, step_db: 3.0, steps: 3, full_scale_db_spl: None, max_laeq_db: 70.0 };
        let knobs = Knobs::new(1.0);
        let mut loudness = Loudness::new(settings, Hours::default(), false);
        let tend = |loudness: &mut Loudness, wishes| loudness.tend(wishes, (false, false), &knobs);
        tend(&mut loudness, Wishes { louder: 2, mutes: 1, ..Wishes::default() });
        assert!(loudness.view().muted && loudness.view().steps == 2);

        loudness.settle(VolumeSettings { default_db: -9.0, ..settings }, Hours::default(), true, false);
        tend(&mut loudness, Wishes { louder: 1, ..Wishes::default() });
        assert!(loudness.view().muted, "nobody has unmuted it");
        assert_eq!((loudness.view().steps, loudness.view().volume_db), (1, -6.0), "the site's new volume, one step up");

        tend(&mut loudness, Wishes { leaves: true, ..Wishes::default() });
        assert!(loudness.view().muted && loudness.view().steps == 0, "the next visitor finds the site's volume");
    }

    #[test]
    fn the_last_word_on_the_sound_counts() {
        let mut wishes = Wishes::default();
        let order = |muted| Wishes { muted: Some(muted), ..Wishes::default() };
        let press = Wishes { mutes: 1, louder: 1, ..Wishes::default() };
        [press, order(true), order(true)].into_iter().for_each(|next| wishes.add(next));
        assert_eq!(wishes, Wishes { muted: Some(true), louder: 1, ..Wishes::default() });
        wishes.add(press);
        assert_eq!(wishes, Wishes { muted: Some(true), mutes: 1, louder: 2, ..Wishes::default() });

        let settings =
            VolumeSettings { default_db: -6.0, step_db: 3.0, steps: 3, full_scale_db_spl: None, max_laeq_db: 70.0 };
        let knobs = Knobs::new(1.0);
        let mut loudness = Loudness::new(settings, Hours::default(), false);
        let mut tend = |wishes| {
            loudness.tend(wishes, (false, false), &knobs);
            loudness.view().muted
        };
        assert!(tend(order(true)) && tend(order(true)), "ordered twice it stays muted");
        assert!(!tend(wishes), "muted from afar, and sounds again by staff");
        assert!(!tend(order(false)));
    }
}
