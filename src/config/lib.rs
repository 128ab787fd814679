//! The site's configuration: settings that differ between museums, never between exhibits.
//!
//! They are in one annotated file, `kiosk-config/kiosk.toml`. Options of the command line take precedence over it, and
//! built-in defaults fill what it leaves out. Every key has a unit, a range and a default. The shipped file *is* the
//! default (a test compares), and the defaults are the only list of keys: any other key is unknown (`diagnose.rs`).
//!
//! Invariant: a [`Config`] that came from [`Config::load`] or [`Config::parse`] is inside every range of [`LIMITS`].
//!
//! It reads one file, the password that this may name, and the settings of staff over it ([`StaffOverrides`]). It writes none. It never applies a setting: the kiosk and the program do. A mistake in the file is a
//! [`ConfigError`] that lists all problems with their lines and the nearest valid key. Old names of keys are read with a
//! warning (`soffio_exhibit::renamed`).
//!
//! | type | holds |
//! |---|---|
//! | [`Config`] | all settings, one table per concern |
//! | [`OpenHours`], [`Hours`] | opening hours; hours of quieter sound |
//! | [`Pin`] | the staff's PIN as an Argon2 hash |
//! | [`Chord`] | keys pressed together |
//! | [`remedies`] | advice for staff about a microphone |
//!
//! ```
//! use std::path::Path;
//!
//! use soffio_config::Config;
//!
//! let file = Path::new("kiosk.toml");
//! let config = Config::parse("[visit]\nbreath = false\n", file).expect("a good file");
//! assert!(!config.visit.breath);
//! assert_eq!(config.screen, Config::default().screen, "what is left out has its default");
//!
//! let error = Config::parse("[visit]\nbreth = false\n", file).expect_err("there is no such key");
//! assert!(error.to_string().contains("breath"), "the nearest key is named");
//! ```

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use soffio_exhibit::renamed::{FileKind, add_old_names};
use soffio_simulation::{Profile, Settings};
use soffio_sound::{MOST_PARTIALS, ReverbSpec, VolumeSettings};

pub mod chord;
mod diagnose;
mod groups;
mod hours;
mod maintenance;
mod mqtt;
mod opening;
mod pin;
pub mod remedies;
mod secret_file;
mod staff_overrides;
mod time_text;

pub use chord::{Chord, Modifiers};
pub use diagnose::{ConfigError, Problem};
pub use groups::ExhibitGroup;
pub use hours::{Hours, TimeOfDay};
pub use maintenance::{CLEANING_S, MaintenanceSettings};
pub use mqtt::{MqttOrder, MqttSettings};
pub use opening::{Day, Holiday, OpenHours, Opening};
pub use pin::{DIGITS, Pin};
pub use staff_overrides::{STAFF_FILE, STAFF_KEYS, StaffOverrides};

/// Place of the file, below the working directory or one of its parents.
pub const FILE: &str = "kiosk-config/kiosk.toml";

/// Stands in `exhibits.show` for all exhibits that are not named.
pub const OTHERS: &str = "*";

/// The site's configuration.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Config {
    /// The picture.
    pub screen: Screen,
    /// The exhibits on offer.
    pub exhibits: Exhibits,
    /// From breath to wind.
    pub breath: Breath,
    /// Microphone and loudspeaker.
    pub audio: AudioSettings,
    /// Reverberation of the sounds.
    pub reverb: ReverbSettings,
    /// How loud it may be.
    pub volume: Loudness,
    /// Hours of quieter sound.
    pub night: Hours,
    /// Opening hours.
    pub opening: Opening,
    /// Checks that the kiosk does by itself.
    pub maintenance: MaintenanceSettings,
    /// What visitors may do.
    pub visit: Visit,
    /// Other ways to blow and to aim.
    pub controllers: ControllerSettings,
    /// Attract mode, which plays when nobody is there.
    pub attract: AttractSettings,
    /// Staff only.
    pub staff: Staff,
    /// Remote status and commands.
    pub mqtt: MqttSettings,
    /// Languages of the texts.
    pub languages: Languages,
}

/// The picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Screen {
    /// Fill the screen, without borders.
    pub fullscreen: bool,
    /// Width of one pixel on the glass, mm: buttons are made 15 mm large by it.
    pub mm_per_px: f64,
    /// Most pictures a second on a software renderer, so that motion and sound keep their share of the processor.
    pub software_fps: f64,
}

impl Default for Screen {
    fn default() -> Self {
        Self { fullscreen: true, mm_per_px: 0.25, software_fps: 15.0 }
    }
}

/// The exhibits on offer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Exhibits {
    /// Ids in the order in which visitors find them, the first on show; `*` stands for all others in the folder.
    pub show: Vec<String>,
    /// Folder that holds the exhibits' folders.
    pub folder: PathBuf,
    /// Reload an exhibit when a file in its folder changes, and notice new and removed folders.
    pub hot_reload: bool,
    /// Groups on the page of exhibits, in this order.
    pub groups: Vec<ExhibitGroup>,
}

impl Default for Exhibits {
    fn default() -> Self {
        let first = ["steel-fish", "wind-chimes", "twelve-moons", "noise-mobile", "terry-clock", "*"];
        Self {
            show: first.map(str::to_owned).into(),
            folder: "exhibits".into(),
            hot_reload: true,
            groups: ExhibitGroup::shipped(),
        }
    }
}

/// From breath to wind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Breath {
    /// How a breath becomes wind: `gallery` or `physical`.
    #[serde(with = "ProfileName")]
    #[schemars(with = "ProfileName")]
    pub profile: Profile,
    /// Multiplies the force of the breath on top of the profile's own gain.
    pub gain: f64,
    /// Added to the microphone's level before it becomes a speed, dB. It scales the strength of a breath and has no
    /// effect on its detection. `soffio doctor --blow` proposes it.
    pub sensitivity_db: f64,
    /// How much surer than usual the detector must be of a breath, as the natural logarithm of odds: more of it means fewer false
    /// triggers and more missed breaths. `soffio breath fit` proposes it from recordings of the venue.
    pub threshold: f64,
    /// Breaths of the last recordings of the venue that the detector heard, and how many there were; 0: not measured. `soffio breath fit`
    /// says both, and the staff page shows them.
    pub detected: u32,
    /// Number of those breaths.
    pub detected_of: u32,
    /// Median distance of those breaths, cm.
    pub detected_at_cm: f64,
    /// Distance of the lips before the sculpture, m.
    pub distance_m: f64,
    /// Diameter of the blowing lips, m.
    pub lip_diameter_m: f64,
}

impl Default for Breath {
    fn default() -> Self {
        let settings = Settings::default();
        Self {
            profile: settings.profile,
            gain: settings.breath_gain,
            sensitivity_db: settings.sensitivity_db,
            threshold: settings.threshold,
            detected: 0,
            detected_of: 0,
            detected_at_cm: 0.0,
            distance_m: settings.distance,
            lip_diameter_m: settings.lip_diameter,
        }
    }
}

/// Names of the two profiles in the file.
#[derive(Serialize, Deserialize, schemars::JsonSchema)]
#[serde(remote = "Profile", rename_all = "lowercase")]
enum ProfileName {
    Gallery,
    Physical,
}

/// Microphone and loudspeaker.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AudioSettings {
    /// Id (`soffio devices`) or any part of the microphone's name; empty is the system's own choice.
    pub microphone: String,
    /// Channel to use, from 1. 0: all channels; two are two microphones, more are mixed to one.
    pub microphone_channel: u16,
    /// Channel of a second microphone in the same device, from 1; 0: none is named.
    pub second_microphone_channel: u16,
    /// Output device: id or any part of the loudspeaker's name; empty is the system's own choice.
    pub output: String,
    /// Id or any part of the name of a second output, for a hearing loop; empty for none.
    pub hearing_loop: String,
    /// Volume of the hearing loop, dB of full scale. Visitors cannot change it.
    pub hearing_loop_db: f64,
    /// Volume that every visitor finds, dB of full scale.
    pub volume_db: f64,
    /// Length of one sound block, ms. Short blocks are heard sooner, long ones never stutter. With 5 ms a hit is heard
    /// 5 ms sooner than with 10, where the device allows it. The staff panel shows the length, and counts late blocks.
    pub block_ms: f64,
    /// Limit of sounding partials; the quietest are stopped first.
    pub most_partials: u32,
}

impl Default for AudioSettings {
    fn default() -> Self {
        Self {
            microphone: String::new(),
            microphone_channel: 0,
            second_microphone_channel: 0,
            output: String::new(),
            hearing_loop: String::new(),
            hearing_loop_db: -6.0,
            volume_db: -6.0,
            block_ms: 10.0,
            most_partials: MOST_PARTIALS as u32,
        }
    }
}

/// Reverberation of the sounds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ReverbSettings {
    /// Which reverberation.
    pub name: ReverbName,
    /// Energy of the reverberation relative to the direct sound, dB.
    pub level_db: f64,
    /// Times in which it decays by 60 dB at 125, 250, 500, 1000, 2000, 4000 and 8000 Hz, s; empty: those of the named reverberation.
    pub t60_s: Vec<f64>,
}

/// A reverberation by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ReverbName {
    /// None, as in the open air.
    Off,
    /// A gallery with plastered walls.
    Gallery,
}

impl Default for ReverbSettings {
    fn default() -> Self {
        Self { name: ReverbName::Gallery, level_db: ReverbSpec::GALLERY.level_db, t60_s: Vec::new() }
    }
}

impl ReverbSettings {
    /// The reverberation as the synth builds it; `None` is the open air.
    pub fn spec(&self) -> Option<ReverbSpec> {
        let ReverbName::Gallery = self.name else { return None };
        let t60 = self.t60_s.as_slice().try_into().unwrap_or(ReverbSpec::GALLERY.t60);
        Some(ReverbSpec { level_db: self.level_db, t60 })
    }
}

/// How loud it may be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Loudness {
    /// One step of a visitor's, dB.
    pub step_db: f64,
    /// Steps up, and as many down; 0 leaves the volume to staff.
    pub steps: u32,
    /// Level at the listening position for a full-scale sine at a volume of 0 dB, dB(A). 0: not measured, and then the level
    /// is not limited.
    pub full_scale_db_spl: f64,
    /// Greatest mean level at the listening position, dB(A).
    pub max_laeq_db: f64,
}

impl Default for Loudness {
    fn default() -> Self {
        Self { step_db: 3.0, steps: 3, full_scale_db_spl: 0.0, max_laeq_db: 70.0 }
    }
}

/// Other ways to blow and to aim than microphone, pointer and glass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ControllerSettings {
    /// Kinds of controllers in use.
    pub listen: Vec<ControllerKind>,
    /// Key, or switch that acts as one, that blows while it is held, as it is called on a US keyboard.
    pub key: String,
    /// Key, or button with a raised mark, that starts and stops reading aloud.
    pub read_key: String,
    /// How fast a stick at its end or an arrow key moves the aim, heights of the picture a second.
    pub stick_speed: f64,
    /// Any part of the name of the MIDI port; empty takes the first instrument.
    pub midi: String,
    /// Number of the control change that is breath.
    pub midi_controller: u8,
    /// Address and port at which OSC messages are received.
    pub osc: String,
    /// Device of a serial line.
    pub serial: String,
    /// Speed of the serial line, bits a second.
    pub serial_baud: u32,
}

impl Default for ControllerSettings {
    fn default() -> Self {
        Self {
            listen: vec![ControllerKind::Gamepad, ControllerKind::Midi],
            key: "Space".into(),
            read_key: "R".into(),
            stick_speed: 0.7,
            midi: String::new(),
            midi_controller: 2,
            osc: "127.0.0.1:9000".into(),
            serial: String::new(),
            serial_baud: 115_200,
        }
    }
}

/// A kind of controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ControllerKind {
    /// Gamepads and adaptive controllers.
    Gamepad,
    /// MIDI breath controllers.
    Midi,
    /// Messages over the network.
    Osc,
    /// A sensor on a serial line.
    Serial,
}

impl ControllerKind {
    /// As the file spells it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gamepad => "gamepad",
            Self::Midi => "midi",
            Self::Osc => "osc",
            Self::Serial => "serial",
        }
    }
}

/// Attract mode, which plays when nobody is there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AttractSettings {
    /// Play the exhibit's attract script when nobody is there.
    pub enabled: bool,
    /// Time without any input, breath included, after which attract mode begins, s.
    pub idle_s: f64,
    /// Play it without a sound.
    pub silent: bool,
}

impl Default for AttractSettings {
    fn default() -> Self {
        Self { enabled: true, idle_s: 60.0, silent: false }
    }
}

/// What visitors may do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Visit {
    /// May visitors blow? If not, as in an outbreak, the microphone is off, and the invitation asks them to press and
    /// hold.
    pub breath: bool,
    /// A press begins the breath and the next one ends it, for visitors who cannot hold. They can choose it too.
    pub press_once: bool,
    /// Resting the pointer on something presses it, for visitors who cannot press. They can choose it too.
    pub dwell: bool,
    /// How long the pointer rests until it presses, s.
    pub dwell_s: f64,
    /// Time without a touch after which the page behind "More" closes, s.
    pub page_closes_s: f64,
    /// Less motion: no assembly animation, no dust in the air, gentler attract mode. Visitors can choose it too.
    pub reduced_motion: bool,
    /// Program that reads aloud: `espeak-ng`, or one that takes the same arguments; empty: none.
    pub read_aloud: String,
}

/// Default of [`Visit::page_closes_s`], s: 30 s or more, with a countdown (Natural History Museum, London).
pub const PAGE_CLOSES_S: f64 = 30.0;

impl Default for Visit {
    fn default() -> Self {
        Self {
            breath: true,
            press_once: false,
            dwell: false,
            dwell_s: 1.2,
            page_closes_s: PAGE_CLOSES_S,
            reduced_motion: false,
            read_aloud: "espeak-ng".into(),
        }
    }
}

/// Staff only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Staff {
    /// Keys that open and close the staff panel.
    pub chord: Chord,
    /// Hash of the PIN that it asks for (`soffio pin`); without one the panel shows and changes nothing.
    pub pin: Pin,
    /// Language of the panel; empty: the language that visitors find first, else English.
    pub language: String,
    /// Time without a touch after which the panel closes, s.
    pub closes_s: f64,
    /// Keys that open the kiosk outside opening hours, and close it again.
    pub open: Chord,
    /// Keys that mute and unmute the kiosk.
    pub mute: Chord,
    /// Do the keys of `mute` work without the PIN?
    pub mute_without_pin: bool,
    /// Keys that switch from the configured hours to night, to day, and back.
    pub night: Chord,
    /// File for the kiosk's metrics, written every 15 s in the text format of Prometheus; empty: none.
    pub metrics: PathBuf,
    /// Folder for the state that is kept over a restart; empty: the system's own place.
    pub state: PathBuf,
}

impl Default for Staff {
    fn default() -> Self {
        let chord = |key| Chord::new(Modifiers::CTRL_ALT, key);
        Self {
            chord: chord("S"),
            pin: Pin::default(),
            language: String::new(),
            closes_s: 120.0,
            open: chord("O"),
            mute: chord("M"),
            mute_without_pin: false,
            night: chord("N"),
            metrics: PathBuf::new(),
            state: PathBuf::new(),
        }
    }
}

/// Languages of the texts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Languages {
    /// Language shown first; empty is the exhibit's own.
    pub first: String,
    /// Languages offered, in this order; empty offers all that the exhibit has.
    pub offered: Vec<String>,
}

/// Range of one number of the file.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// Dotted key.
    pub key: &'static str,
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
    /// Unit, as it is written in the file.
    pub unit: &'static str,
}

/// Ranges of all numbers of the file.
pub const LIMITS: &[Limit] = &[
    Limit { key: "screen.mm_per_px", low: 0.05, high: 2.0, unit: "mm" },
    Limit { key: "screen.software_fps", low: 2.0, high: 60.0, unit: "1/s" },
    Limit { key: "breath.gain", low: 0.1, high: 10.0, unit: "1" },
    Limit { key: "breath.sensitivity_db", low: -40.0, high: 40.0, unit: "dB" },
    Limit { key: "breath.threshold", low: -3.0, high: 4.0, unit: "1" },
    Limit { key: "breath.detected", low: 0.0, high: 1e4, unit: "1" },
    Limit { key: "breath.detected_of", low: 0.0, high: 1e4, unit: "1" },
    Limit { key: "breath.detected_at_cm", low: 0.0, high: 200.0, unit: "cm" },
    Limit { key: "breath.distance_m", low: 0.1, high: 2.0, unit: "m" },
    Limit { key: "breath.lip_diameter_m", low: 0.003, high: 0.03, unit: "m" },
    Limit { key: "audio.microphone_channel", low: 0.0, high: 64.0, unit: "1" },
    Limit { key: "audio.second_microphone_channel", low: 0.0, high: 64.0, unit: "1" },
    Limit { key: "audio.hearing_loop_db", low: -60.0, high: 0.0, unit: "dB" },
    Limit { key: "audio.volume_db", low: -60.0, high: 0.0, unit: "dB" },
    Limit { key: "audio.block_ms", low: 2.0, high: 100.0, unit: "ms" },
    Limit { key: "audio.most_partials", low: 16.0, high: 65_536.0, unit: "1" },
    Limit { key: "reverb.level_db", low: -40.0, high: 6.0, unit: "dB" },
    Limit { key: "volume.step_db", low: 1.0, high: 10.0, unit: "dB" },
    Limit { key: "volume.steps", low: 0.0, high: 10.0, unit: "1" },
    Limit { key: "volume.full_scale_db_spl", low: 0.0, high: 140.0, unit: "dB(A)" },
    Limit { key: "volume.max_laeq_db", low: 40.0, high: 85.0, unit: "dB(A)" },
    Limit { key: "controllers.stick_speed", low: 0.05, high: 5.0, unit: "1/s" },
    Limit { key: "controllers.midi_controller", low: 0.0, high: 127.0, unit: "1" },
    Limit { key: "controllers.serial_baud", low: 300.0, high: 4e6, unit: "1/s" },
    Limit { key: "maintenance.foam_blows", low: 0.0, high: 1e6, unit: "1" },
    Limit { key: "maintenance.cleaning_s", low: 5.0, high: 600.0, unit: "s" },
    Limit { key: "visit.dwell_s", low: 0.3, high: 5.0, unit: "s" },
    Limit { key: "visit.page_closes_s", low: 10.0, high: 600.0, unit: "s" },
    Limit { key: "attract.idle_s", low: 1.0, high: 3600.0, unit: "s" },
    Limit { key: "staff.closes_s", low: 10.0, high: 3600.0, unit: "s" },
];

/// A configuration with the file that it comes from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadedConfig {
    /// The configuration.
    pub config: Config,
    /// The file; `None` for the built-in default.
    pub file: Option<PathBuf>,
    /// Old names in the file, which were read as the new ones, and secrets that cannot be read.
    pub warnings: Vec<Problem>,
    /// Settings of the staff panel over the file; `None` where there are none.
    pub staff: Option<StaffOverrides>,
}

impl LoadedConfig {
    /// Each warning with its file, place and remedy.
    pub fn warning_texts(&self) -> impl Iterator<Item = String> {
        let file = self.file.as_deref().unwrap_or(Path::new(FILE));
        self.warnings.iter().map(move |warning| warning.in_file(file))
    }
}

impl Config {
    /// The configuration of this site: the file at `path`, or [`FILE`] in the working directory or above it, or
    /// `/etc/soffio/kiosk.toml` of an installed program, or the built-in default.
    ///
    /// # Errors
    ///
    /// The file cannot be read, or has problems; all of them are in the error.
    pub fn load(path: Option<&Path>) -> Result<LoadedConfig, ConfigError> {
        let found = path.map(Path::to_path_buf).or_else(find);
        let Some(file) = found else { return Ok(LoadedConfig::default()) };
        let text = std::fs::read_to_string(&file).map_err(|error| ConfigError::unreadable(&file, &error))?;
        let (mut config, mut warnings) = diagnose::parse(&text, &file)?;
        warnings.extend(secret_file::read_password(&mut config.mqtt, &file));
        Ok(LoadedConfig { config, file: Some(file), warnings, staff: None })
    }

    /// Reads a configuration from the text of `file`, whose name appears in messages.
    ///
    /// # Errors
    ///
    /// The text has problems; all of them are in the error.
    pub fn parse(text: &str, file: &Path) -> Result<Self, ConfigError> {
        Self::parse_with_warnings(text, file).map(|(config, _)| config)
    }

    /// As [`Config::parse`], with a warning for each old name in the text.
    ///
    /// # Errors
    ///
    /// As [`Config::parse`].
    pub fn parse_with_warnings(text: &str, file: &Path) -> Result<(Self, Vec<Problem>), ConfigError> {
        diagnose::parse(text, file)
    }

    /// Settings of the volume.
    pub fn volume_settings(&self) -> VolumeSettings {
        VolumeSettings {
            default_db: self.audio.volume_db,
            step_db: self.volume.step_db,
            steps: self.volume.steps,
            full_scale_db_spl: Some(self.volume.full_scale_db_spl).filter(|spl| *spl > 0.0),
            max_laeq_db: self.volume.max_laeq_db,
        }
    }

    /// Settings of the simulation, with the seed of all random numbers.
    pub fn simulation_settings(&self, seed: u64) -> Settings {
        Settings {
            profile: self.breath.profile,
            breath_gain: self.breath.gain,
            sensitivity_db: self.breath.sensitivity_db,
            threshold: self.breath.threshold,
            distance: self.breath.distance_m,
            lip_diameter: self.breath.lip_diameter_m,
            seed,
            ..Settings::default()
        }
    }
}

/// JSON Schema (draft 2020-12) of the file, with the ranges of [`LIMITS`]. Old names are marked as deprecated.
pub fn schema() -> serde_json::Value {
    let inline = schemars::generate::SchemaSettings::draft2020_12().with(|settings| settings.inline_subschemas = true);
    let mut schema = inline.into_generator().into_root_schema_for::<Config>().to_value();
    for limit in LIMITS {
        let pointer = format!("/properties/{}", limit.key.replace('.', "/properties/"));
        if let Some(serde_json::Value::Object(number)) = schema.pointer_mut(&pointer) {
            number.insert("minimum".into(), limit.low.into());
            number.insert("maximum".into(), limit.high.into());
        }
    }
    add_old_names(FileKind::Configuration, &mut schema);
    schema
}

/// The first [`FILE`] from the working directory upwards, else the one that is installed with the program.
fn find() -> Option<PathBuf> {
    let here = std::env::current_dir().ok()?;
    let own = here.ancestors().map(|folder| folder.join(FILE)).find(|file| file.is_file());
    own.or_else(installed)
}

/// `/etc/soffio/kiosk.toml` for a program in `/usr/bin`, wherever the root is.
fn installed() -> Option<PathBuf> {
    let program = std::env::current_exe().ok()?;
    let prefix = program.parent()?.parent().filter(|prefix| prefix.ends_with("usr"))?;
    Some(prefix.parent()?.join("etc/soffio/kiosk.toml")).filter(|file| file.is_file())
}
