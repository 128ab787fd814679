//! The site's configuration: what differs between two museums, never between two exhibits.
//!
//! One annotated file, `kiosk-config/kiosk.toml`; the command line stands over it and the built-in defaults under it.
//! Every key has a unit, a range and a default. The shipped file *is* the default (a test compares), and the
//! defaults are the only list of keys there is: a key they do not have is unknown (`config/diagnose.rs`).
//!
//! Invariant: a [`Config`] that came from [`Config::load`] or [`Config::parse`] is inside every range of [`LIMITS`].
//!
//! It reads one file, and writes none. It never applies a setting: the kiosk and the program do. A mistake in the file is a
//! [`ConfigError`] that lists all problems with their lines and the nearest valid key.
//!
//! The main types are [`Config`] (one table per concern), [`OpenHours`] and [`Hours`] (when the house is open, quiet or
//! dark), [`Pin`] (the staff's, as an Argon2 hash), [`Chord`] (keys pressed together) and [`remedies`] (what to tell staff
//! when a device is missing).
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

use soffio_simulation::{Profile, Settings};
use soffio_sound::{MOST_PARTIALS, ReverbSpec, VolumeSettings};

mod care;
pub mod chord;
mod diagnose;
mod groups;
mod hours;
mod mqtt;
mod opening;
mod pin;
pub mod remedies;
mod time_text;

pub use care::{CLEANING_S, Care};
pub use chord::Chord;
pub use diagnose::{ConfigError, Problem};
pub use groups::Group;
pub use hours::{Hours, TimeOfDay};
pub use mqtt::{MqttOrder, MqttSettings};
pub use opening::{Day, Holiday, OpenHours, Opening};
pub use pin::{DIGITS, Pin};

/// Where the file lies, below the working directory or one of its parents.
pub const FILE: &str = "kiosk-config/kiosk.toml";

/// Stands in `exhibits.show` for all exhibits that are not named.
pub const OTHERS: &str = "*";

/// The site's configuration.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Config {
    /// The picture.
    pub screen: Screen,
    /// What is shown.
    pub exhibits: Exhibits,
    /// From breath to wind.
    pub breath: Breath,
    /// Microphone and loudspeaker.
    pub audio: AudioSettings,
    /// The room that the sounds are heard in.
    pub room: RoomSettings,
    /// How loud it may be.
    pub volume: Loudness,
    /// When the house is quiet.
    pub night: Hours,
    /// When the house is open.
    pub opening: Opening,
    /// What the kiosk looks after by itself.
    pub care: Care,
    /// What visitors may do.
    pub visit: Visit,
    /// Other ways to blow and to aim.
    pub controllers: ControllerSettings,
    /// What happens when nobody is there.
    pub attract: AttractSettings,
    /// Staff only.
    pub staff: Staff,
    /// Whoever looks after many kiosks.
    pub mqtt: MqttSettings,
    /// Words.
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

/// What is shown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Exhibits {
    /// Ids in the order in which visitors find them, the first on show; `*` stands for all others in the folder.
    pub show: Vec<String>,
    /// Folder that holds the exhibits' folders.
    pub folder: PathBuf,
    /// Load an exhibit anew when a file in its folder changes, and notice folders that come and go.
    pub hot_reload: bool,
    /// How the works are grouped on the page of works, in this order.
    pub groups: Vec<Group>,
}

impl Default for Exhibits {
    fn default() -> Self {
        let first = ["steel-fish", "wind-chimes", "twelve-moons", "noise-mobile", "terry-clock", "*"];
        Self {
            show: first.map(str::to_owned).into(),
            folder: "exhibits".into(),
            hot_reload: true,
            groups: Group::shipped(),
        }
    }
}

/// From breath to wind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Breath {
    /// How a breath becomes wind: `gallery` or `true`.
    #[serde(with = "ProfileName")]
    #[schemars(with = "ProfileName")]
    pub profile: Profile,
    /// Multiplies the force of the breath on top of the profile's own gain.
    pub gain: f64,
    /// Added to the microphone's level before it becomes a speed, dB: how strong a breath is taken to be, never whether
    /// it is one. `soffio doctor --blow` proposes it.
    pub sensitivity_db: f64,
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
            distance_m: settings.distance,
            lip_diameter_m: settings.lip_diameter,
        }
    }
}

/// Names of the two profiles in the file; `true` is the old name of `physical`.
#[derive(Serialize, Deserialize, schemars::JsonSchema)]
#[serde(remote = "Profile", rename_all = "lowercase")]
enum ProfileName {
    Gallery,
    #[serde(alias = "true")]
    Physical,
}

/// Microphone and loudspeaker.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AudioSettings {
    /// Id (`soffio devices`) or any part of the microphone's name; empty is the system's own choice.
    pub microphone: String,
    /// Which of its channels listens, from 1; 0 takes all: two as two capsules, more as one mix.
    pub microphone_channel: u16,
    /// Which other channel of it is a second capsule, from 1; 0 where there is one capsule only.
    pub second_capsule_channel: u16,
    /// Id or any part of the loudspeaker's name; empty is the system's own choice.
    pub loudspeaker: String,
    /// Id or any part of the name of a second output, for a hearing loop; empty for none.
    pub hearing_loop: String,
    /// Volume of the hearing loop, dB of full scale: fixed, whatever visitors do to the loudspeaker.
    pub hearing_loop_db: f64,
    /// Volume that every visitor finds, dB of full scale.
    pub volume_db: f64,
    /// Length of one block of either device, ms: short answers at once, long never stutters. 5 takes 5 ms off the way
    /// from a hit to its sound, where the device offers it; the staff panel's status says so, and counts late blocks.
    pub block_ms: f64,
    /// Most partials that ring at once; the quietest leave first.
    pub most_partials: u32,
}

impl Default for AudioSettings {
    fn default() -> Self {
        Self {
            microphone: String::new(),
            microphone_channel: 0,
            second_capsule_channel: 0,
            loudspeaker: String::new(),
            hearing_loop: String::new(),
            hearing_loop_db: -6.0,
            volume_db: -6.0,
            block_ms: 10.0,
            most_partials: MOST_PARTIALS as u32,
        }
    }
}

/// The room that the sounds are heard in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RoomSettings {
    /// Which one.
    pub name: RoomName,
    /// Energy of its reverberation over the sound itself, dB.
    pub level_db: f64,
    /// Times in which it decays by 60 dB at 125, 250, 500, 1000, 2000, 4000 and 8000 Hz, s; empty: the named room's own.
    pub t60_s: Vec<f64>,
}

/// A room by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum RoomName {
    /// The open air.
    Off,
    /// A gallery with plastered walls.
    Gallery,
}

impl Default for RoomSettings {
    fn default() -> Self {
        Self { name: RoomName::Gallery, level_db: ReverbSpec::GALLERY.level_db, t60_s: Vec::new() }
    }
}

impl RoomSettings {
    /// The room as the synth builds it; `None` is the open air.
    pub fn spec(&self) -> Option<ReverbSpec> {
        let RoomName::Gallery = self.name else { return None };
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
    /// What a sound meter shows at the visitor's ear for a full-scale sine at a volume of 0 dB, dB(A); 0 where nobody has
    /// measured it, and then there is no cap.
    pub full_scale_db_spl: f64,
    /// Greatest mean level at the visitor's ear, dB(A).
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
    /// Which kinds are listened to.
    pub listen: Vec<ControllerKind>,
    /// Key, or switch that acts as one, that blows while it is held, as it is called on a US keyboard.
    pub key: String,
    /// Key, or button with a raised mark, that reads aloud what is written, and hushes.
    pub read_key: String,
    /// How fast a stick at its end or an arrow key moves the aim, heights of the picture a second.
    pub stick_speed: f64,
    /// Any part of the name of the MIDI port; empty takes the first instrument there is.
    pub midi: String,
    /// Number of the control change that is breath.
    pub midi_controller: u8,
    /// Address and port at which OSC messages are heard.
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

/// What happens when nobody is there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AttractSettings {
    /// Play the exhibit's attract script when nobody is there.
    pub enabled: bool,
    /// Time without any input, breath included, after which nobody is there, s.
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
    /// May they blow? Where they may not, in times of an outbreak, the microphone is closed, and the invitation says
    /// that they press and hold.
    pub breath: bool,
    /// A press begins the breath and the next one ends it, so that nobody must hold; visitors can choose it too.
    pub press_once: bool,
    /// Who rests the pointer on something presses it, so that nobody must press; visitors can choose it too.
    pub dwell: bool,
    /// How long it rests, s.
    pub dwell_s: f64,
    /// Time without a touch after which the page behind "More" closes, s.
    pub page_closes_s: f64,
    /// Less motion: a work is there at once instead of gathering its parts, no dust in the air, gentler attract mode;
    /// visitors can choose it too.
    pub calm: bool,
    /// Program that reads aloud: `espeak-ng`, or one that takes its arguments; empty: nothing is read.
    pub reads_aloud: String,
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
            calm: false,
            reads_aloud: "espeak-ng".into(),
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
    /// Time without a touch after which it closes, s.
    pub closes_s: f64,
    /// Keys that open the kiosk while the house is closed, and close it again.
    pub open: Chord,
    /// Keys that mute the kiosk, and let it sound again.
    pub mute: Chord,
    /// Keys that go from the configured hours to night, to day, and back.
    pub night: Chord,
    /// File that gets the kiosk's numbers every 15 s, in the text format of Prometheus; empty for none.
    pub metrics: PathBuf,
    /// Folder for what outlives a restart; empty for the system's own place.
    pub state: PathBuf,
}

impl Default for Staff {
    fn default() -> Self {
        let chord = |key| Chord::new(true, true, false, key);
        Self {
            chord: chord("S"),
            pin: Pin::default(),
            closes_s: 120.0,
            open: chord("O"),
            mute: chord("M"),
            night: chord("N"),
            metrics: PathBuf::new(),
            state: PathBuf::new(),
        }
    }
}

/// Words.
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
    Limit { key: "breath.distance_m", low: 0.1, high: 2.0, unit: "m" },
    Limit { key: "breath.lip_diameter_m", low: 0.003, high: 0.03, unit: "m" },
    Limit { key: "audio.microphone_channel", low: 0.0, high: 64.0, unit: "1" },
    Limit { key: "audio.second_capsule_channel", low: 0.0, high: 64.0, unit: "1" },
    Limit { key: "audio.hearing_loop_db", low: -60.0, high: 0.0, unit: "dB" },
    Limit { key: "audio.volume_db", low: -60.0, high: 0.0, unit: "dB" },
    Limit { key: "audio.block_ms", low: 2.0, high: 100.0, unit: "ms" },
    Limit { key: "audio.most_partials", low: 16.0, high: 65_536.0, unit: "1" },
    Limit { key: "room.level_db", low: -40.0, high: 6.0, unit: "dB" },
    Limit { key: "volume.step_db", low: 1.0, high: 10.0, unit: "dB" },
    Limit { key: "volume.steps", low: 0.0, high: 10.0, unit: "1" },
    Limit { key: "volume.full_scale_db_spl", low: 0.0, high: 140.0, unit: "dB(A)" },
    Limit { key: "volume.max_laeq_db", low: 40.0, high: 85.0, unit: "dB(A)" },
    Limit { key: "controllers.stick_speed", low: 0.05, high: 5.0, unit: "1/s" },
    Limit { key: "controllers.midi_controller", low: 0.0, high: 127.0, unit: "1" },
    Limit { key: "controllers.serial_baud", low: 300.0, high: 4e6, unit: "1/s" },
    Limit { key: "care.foam_blows", low: 0.0, high: 1e6, unit: "1" },
    Limit { key: "care.cleaning_s", low: 5.0, high: 600.0, unit: "s" },
    Limit { key: "visit.dwell_s", low: 0.3, high: 5.0, unit: "s" },
    Limit { key: "visit.page_closes_s", low: 10.0, high: 600.0, unit: "s" },
    Limit { key: "attract.idle_s", low: 1.0, high: 3600.0, unit: "s" },
    Limit { key: "staff.closes_s", low: 10.0, high: 3600.0, unit: "s" },
];

impl Config {
    /// The configuration of this site: the file at `path`, or [`FILE`] in the working directory or above it, or
    /// `/etc/soffio/kiosk.toml` of an installed program, or the built-in default. Says which file it was.
    pub fn load(path: Option<&Path>) -> Result<(Self, Option<PathBuf>), ConfigError> {
        let found = path.map(Path::to_path_buf).or_else(find);
        let Some(file) = found else { return Ok((Self::default(), None)) };
        let text = std::fs::read_to_string(&file).map_err(|error| ConfigError::unreadable(&file, &error))?;
        Ok((Self::parse(&text, &file)?, Some(file)))
    }

    /// Reads a configuration from the text of `file` (the name appears in messages). All problems are said at once.
    pub fn parse(text: &str, file: &Path) -> Result<Self, ConfigError> {
        diagnose::parse(text, file)
    }

    /// What the volume needs of it.
    pub fn volume_settings(&self) -> VolumeSettings {
        VolumeSettings {
            default_db: self.audio.volume_db,
            step_db: self.volume.step_db,
            steps: self.volume.steps,
            full_scale_db_spl: Some(self.volume.full_scale_db_spl).filter(|spl| *spl > 0.0),
            max_laeq_db: self.volume.max_laeq_db,
        }
    }

    /// What the simulation needs of it.
    pub fn simulation_settings(&self, seed: u64) -> Settings {
        Settings {
            profile: self.breath.profile,
            breath_gain: self.breath.gain,
            sensitivity_db: self.breath.sensitivity_db,
            distance: self.breath.distance_m,
            lip_diameter: self.breath.lip_diameter_m,
            seed,
            ..Settings::default()
        }
    }
}

/// JSON Schema (draft 2020-12) of the file, with the ranges of [`LIMITS`].
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
