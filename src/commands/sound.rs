//! `soffio sound`: one sound of one timbre, for listening and for measuring.

use std::io::Write;
use std::path::PathBuf;

use super::{Failure, Outcome};
use crate::math::PI;
use crate::offline::wav;
use crate::simulation::SAMPLE_RATE;
use crate::sound::{InstrumentSpec, Preset, SoundBody, SoundCommand, SoundMaterial, Strike, Synth, WindSound, timbre};

/// Renders one sound, dry mono.
#[derive(clap::Args, Debug, Default)]
#[command(after_help = "\
Example: soffio sound plate --impulse 5e-4 --at 0.8 -o clank.wav
         soffio sound plate --set radius=0.2 --set thickness=0.001 --set body.detune=0 -o gong.wav
         soffio sound wind-room --speed 3 --seconds 10 -o wind.wav

--set takes the body's dimensions and material
    radius, length, width, thickness (m), mass (kg), youngs_modulus (Pa), poisson, density (kg/m3), loss_factor,
the hit's mass (hit_mass, kg), its place across (at_y, -1 to 1), the seed (seed),
and any number of a node of the timbre (node.key, such as body.partials).")]
pub struct Args {
    /// Name of the timbre; see --list.
    #[arg(required_unless_present = "list")]
    timbre: Option<String>,
    /// Names the timbres, one a line.
    #[arg(long)]
    list: bool,
    /// Impulse of the hit, N s [default: 5e-4].
    #[arg(long, value_name = "NS", conflicts_with = "force")]
    impulse: Option<f64>,
    /// Greatest force of the hit, N, instead of its impulse: J = 2 F tau / pi for a half sine of Hertz's duration.
    #[arg(long, value_name = "N")]
    force: Option<f64>,
    /// Place of the hit along the body, -1 to 1.
    #[arg(long, value_name = "X", default_value_t = 0.8, allow_hyphen_values = true)]
    at: f64,
    /// Approach speed of the hit, or speed of the wind, m/s [default: 0.3 for a hit, 2 for wind].
    #[arg(long, value_name = "V")]
    speed: Option<f64>,
    /// Changes a number; see below.
    #[arg(long, value_name = "K=V")]
    set: Vec<String>,
    /// Length, s.
    #[arg(long, value_name = "S", default_value_t = 3.0)]
    seconds: f64,
    /// The file to write: mono, 48 kHz, 32-bit float.
    #[arg(short, long, value_name = "WAV", required_unless_present = "list")]
    output: Option<PathBuf>,
}

/// What `--set` can change, with the defaults: a steel disc of 12 cm, half a millimetre thick.
struct Setup {
    length: f64,
    width: f64,
    round: bool,
    thickness: f64,
    mass: Option<f64>,
    material: SoundMaterial,
    hit_mass: f64,
    at_y: f64,
    seed: u64,
}

impl Default for Setup {
    fn default() -> Self {
        Self {
            length: 0.12,
            width: 0.12,
            round: true,
            thickness: 5e-4,
            mass: None,
            material: SoundMaterial { youngs_modulus: 2e11, poisson: 0.3, density: 7850.0, loss_factor: 6e-4 },
            hit_mass: 0.003,
            at_y: 0.0,
            seed: 1,
        }
    }
}

impl Setup {
    /// Whether the key is one of its own.
    fn set(&mut self, key: &str, value: f64) -> bool {
        match key {
            "radius" => (self.length, self.width, self.round) = (2.0 * value, 2.0 * value, true),
            "length" => (self.length, self.round) = (value, false),
            "width" => (self.width, self.round) = (value, false),
            "thickness" => self.thickness = value,
            "mass" => self.mass = Some(value),
            "youngs_modulus" => self.material.youngs_modulus = value,
            "poisson" => self.material.poisson = value,
            "density" => self.material.density = value,
            "loss_factor" => self.material.loss_factor = value,
            "hit_mass" => self.hit_mass = value,
            "at_y" => self.at_y = value,
            "seed" => self.seed = value as u64,
            _ => return false,
        }
        true
    }

    fn spec(&self, timbre: &str) -> InstrumentSpec {
        let area = self.length * self.width * if self.round { PI / 4.0 } else { 1.0 };
        let body = SoundBody {
            half_extents: [0.5 * self.length.max(self.width), 0.5 * self.length.min(self.width)],
            thickness: self.thickness,
            area,
            mass: self.mass.unwrap_or(area * self.thickness * self.material.density),
        };
        InstrumentSpec { timbre: timbre.into(), body, material: self.material, gain: 1.0, max_voices: 1 }
    }
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    if args.list {
        let names: String = timbre::names().map(|name| format!("{name}\n")).collect();
        // A reader that closed the pipe has read enough.
        let _ = std::io::stdout().write_all(names.as_bytes());
        return Ok(());
    }
    let (Some(name), Some(output)) = (&args.timbre, &args.output) else {
        return Err(Failure { code: 2, message: "say a timbre and -o OUT.wav, or --list".into() });
    };
    if !(args.seconds > 0.0 && args.seconds <= 600.0) {
        return Err(Failure { code: 2, message: "--seconds must be above 0 and at most 600".into() });
    }
    let (setup, preset) = settings(name, &args.set)?;
    let mut synth = Synth::with_preset(SAMPLE_RATE, &preset, &setup.spec(name), setup.seed).map_err(Failure::input)?;
    synth.set_dry(true);
    synth.command(command(&args, &setup, &preset, &synth));
    let mut stereo = vec![0.0; 2 * (args.seconds * f64::from(SAMPLE_RATE)) as usize];
    synth.render(&mut stereo);
    if synth.faults() > 0 {
        return Err(Failure::input(
            "a number given cannot be played: --impulse, --force, --speed, --at and masses must be finite, an impulse at least 0",
        ));
    }
    // A centred sound is 1/√2 on either side: their sum over √2 is the sound itself.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let mono: Vec<f32> = stereo.as_chunks::<2>().0.iter().map(|[left, right]| (left + right) * half).collect();
    wav::write_float(output, 1, SAMPLE_RATE, &mono).map_err(Failure::input)
}

/// `--set`: the body's, or the preset's.
fn settings(name: &str, pairs: &[String]) -> Result<(Setup, Preset), Failure> {
    let mut setup = Setup::default();
    let shipped = Preset::shipped(name).map_err(Failure::input)?;
    let mut table: toml::Table = timbre::source(name).unwrap_or_default().parse().map_err(Failure::input)?;
    let usage = |message: String| Failure { code: 2, message };
    for pair in pairs {
        let (key, text) = pair.split_once('=').ok_or_else(|| usage(format!("--set {pair}: must be key=value")))?;
        let value: f64 = text.parse().map_err(|_| usage(format!("--set {pair}: \"{text}\" is not a number")))?;
        if setup.set(key, value) {
            continue;
        }
        let Some((node, field)) = key.split_once('.').filter(|(node, _)| shipped.node.contains_key(*node)) else {
            let nodes: Vec<_> = shipped.node.keys().map(|node| format!("{node}.…")).collect();
            return Err(usage(format!("--set {key}: not a key of the body (see --help), nor of {}", nodes.join(", "))));
        };
        // Whole numbers stay whole: `partials` is one.
        let whole = text.parse::<i64>().map(toml::Value::Integer);
        if let Some(node) = table["node"][node].as_table_mut() {
            node.insert(field.into(), whole.unwrap_or(toml::Value::Float(value)));
        }
    }
    Ok((setup, Preset::from_table(name, table).map_err(Failure::input)?))
}

fn command(args: &Args, setup: &Setup, preset: &Preset, synth: &Synth) -> SoundCommand {
    if preset.continuous() {
        let speed = args.speed.unwrap_or(2.0) as f32;
        return SoundCommand::Wind(WindSound { sample: 0, speed, gust: 0.0, pan: 0.0 });
    }
    let speed = args.speed.unwrap_or(0.3);
    let contact_time = synth.contact_time(0, setup.hit_mass, speed).unwrap_or_default();
    let impulse = match args.force {
        Some(force) => 2.0 * force * contact_time / PI,
        None => args.impulse.unwrap_or(5e-4),
    };
    SoundCommand::Strike(Strike {
        sample: 0,
        instrument: 0,
        impulse: impulse as f32,
        speed: speed as f32,
        mass: setup.hit_mass as f32,
        position: [args.at as f32, setup.at_y as f32],
        pan: 0.0,
        distance: 1.0,
    })
}
