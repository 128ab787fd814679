//! Volume of the kiosk: a visitor's steps, the site's limit, the staff's mute.
//!
//! ```text
//! volume = min(min(default, cap) + steps · step, cap) − attenuation          cap = min(LAeq_max − (S + PROGRAMME), 0 dB)
//! ```
//!
//! S is what a sound meter shows at the visitor's ear, dB(A), for a sine at full scale (1 kHz, both sides) while the
//! volume is 0 dB: the calibration. Exhibits are levelled to one loudness, [`PROGRAMME`], so the cap keeps
//! an exhibit's mean at the site's limit whatever a visitor presses. If one is louder, the attenuation brings the mean of the
//! last minute down to the limit. Without a calibration there is no cap.
//!
//! A visitor's steps end with the visit: the next visitor finds the default. A mute stays until staff end it.

/// Loudness that exhibits are levelled to, LUFS (EBU R 128), which for this purpose is dB of a full-scale sine.
pub const PROGRAMME: f64 = -23.0;
/// Rate at which the attenuation grows, dB/s: too slow to be heard as a change of volume.
const ATTENUATION_RATE: f64 = 0.5;
/// Rate at which the attenuation recovers, dB/s: ten times slower, so that the volume does not sway.
const RECOVERY_RATE: f64 = 0.05;
/// Greatest attenuation, dB: beyond it the calibration is wrong, not the exhibit loud.
const MAX_ATTENUATION: f64 = 24.0;

/// Loudness settings of a site.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VolumeSettings {
    /// Volume that every visitor finds, dB, at most 0.
    pub default_db: f64,
    /// One step, dB.
    pub step_db: f64,
    /// Steps up and as many down.
    pub steps: u32,
    /// S, dB(A); `None` where nobody has measured it.
    pub full_scale_db_spl: Option<f64>,
    /// Greatest LAeq at the visitor's ear, dB(A).
    pub max_laeq_db: f64,
}

/// The volume as it is now.
#[derive(Clone, Debug)]
pub struct Volume {
    settings: VolumeSettings,
    steps: i32,
    attenuation_db: f64,
    muted: bool,
}

impl Volume {
    /// As a visitor finds it.
    pub fn new(settings: VolumeSettings) -> Self {
        Self { settings, steps: 0, attenuation_db: 0.0, muted: false }
    }

    /// Applies other settings. Steps and attenuation restart; the staff's mute stays.
    pub fn reconfigure(&mut self, settings: VolumeSettings) {
        *self = Self { muted: self.muted, ..Self::new(settings) };
    }

    /// Changes the volume by `by` steps, within the number of steps and the cap.
    pub fn step(&mut self, by: i32) {
        let most = i32::try_from(self.settings.steps).unwrap_or(i32::MAX);
        // Steps that the cap swallows would have to be taken back before a step down is heard.
        let useful = ((self.cap_db() - self.base_db()) / self.settings.step_db).ceil();
        self.steps = self.steps.saturating_add(by).clamp(-most, most.min(useful as i32));
    }

    /// Steps above the default.
    pub fn steps(&self) -> i32 {
        self.steps
    }

    /// The last visitor has left.
    pub fn reset(&mut self) {
        self.steps = 0;
    }

    /// Staff's mute, on or off.
    pub fn toggle_mute(&mut self) {
        self.muted = !self.muted;
    }

    /// Is it muted by staff?
    pub fn is_muted(&self) -> bool {
        self.muted
    }

    /// Greatest volume, dB.
    pub fn cap_db(&self) -> f64 {
        let cap = self.settings.full_scale_db_spl.map(|s| self.settings.max_laeq_db - (s + PROGRAMME));
        cap.unwrap_or(0.0).min(0.0)
    }

    /// What a visitor finds, dB.
    fn base_db(&self) -> f64 {
        self.settings.default_db.min(self.cap_db())
    }

    /// Now, dB, muted or not.
    pub fn db(&self) -> f64 {
        let requested = self.base_db() + f64::from(self.steps) * self.settings.step_db;
        requested.min(self.cap_db()) - self.attenuation_db
    }

    /// Present attenuation because the last minute was too loud, dB.
    pub fn attenuation_db(&self) -> f64 {
        self.attenuation_db
    }

    /// Updates the attenuation by the mean level of the last minute, dB of a full-scale sine ([`super::Exposure::minute`]), over
    /// some seconds.
    pub fn apply_exposure_limit(&mut self, minute_db: f64, seconds: f64) {
        let too_loud = self.settings.full_scale_db_spl.is_some_and(|s| s + minute_db > self.settings.max_laeq_db);
        let change = if too_loud { ATTENUATION_RATE } else { -RECOVERY_RATE };
        self.attenuation_db = (self.attenuation_db + change * seconds).clamp(0.0, MAX_ATTENUATION);
    }

    /// A level of dB of a full-scale sine as dB(A) at the visitor's ear; `None` without a calibration.
    pub fn spl(&self, level_db: f64) -> Option<f64> {
        self.settings.full_scale_db_spl.map(|s| s + level_db)
    }
}
