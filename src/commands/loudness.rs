//! `soffio loudness`: how loud exhibits and recordings are, and the level that makes exhibits alike.

use std::path::{Path, PathBuf};

use super::failure::{Failure, Outcome};
use super::setup;
use soffio_exhibit as exhibit;
use soffio_math::{PI, db_to_amplitude, sin};
use soffio_offline::loudness::{Levelled, Measured, correction, level, measure, write};
use soffio_offline::wav;
use soffio_simulation::SAMPLE_RATE;

/// The calibration tone: Hz, dB of full scale, s.
const TONE: (f64, f64, u32) = (1000.0, -20.0, 60);

/// Measures loudness by EBU R 128: of exhibits in a standard scene, or of recordings.
#[derive(clap::Args, Debug, Default)]
#[command(after_help = "\
Example: soffio loudness exhibits/steel-fish --write
         soffio loudness take.wav
         soffio loudness --tone tone.wav

Exhibits are levelled to -23 LUFS, and no 3 s of them above -18 LUFS; --write puts `level` into their exhibit.toml.

To calibrate a kiosk, set audio.volume_db = 0 and the amplifier as it stays, play the tone over its loudspeaker, and read a
sound meter, dB(A), at the listening position. The tone is 20 dB below full scale: 20 more than the meter shows is
volume.full_scale_db_spl.")]
pub struct Args {
    /// Ids under `exhibits/`, folders, or WAV files; default is every shipped exhibit.
    paths: Vec<String>,
    /// Writes the fitting level into the exhibits.
    #[arg(long)]
    write: bool,
    /// One JSON object a line.
    #[arg(long)]
    json: bool,
    /// Writes the calibration tone: 1 kHz, a minute, stereo.
    #[arg(long, value_name = "WAV", conflicts_with_all = ["paths", "write", "json"])]
    tone: Option<PathBuf>,
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    if let Some(path) = &args.tone {
        return tone(path);
    }
    let paths = if args.paths.is_empty() { exhibit::ids() } else { args.paths };
    if paths.is_empty() {
        return Err(Failure::input("there is no exhibit here; run this where the folder `exhibits` is, or name one"));
    }
    let config = setup::config(None)?;
    let reverb = config.reverb.spec();
    for path in paths {
        if Path::new(&path).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("wav")) {
            recording(&path, args.json)?;
            continue;
        }
        let exhibit = setup::open(&path)?;
        let levelled = level(&exhibit, config.simulation_settings(1), reverb.as_ref()).map_err(Failure::input)?;
        print(&levelled, args.json)?;
        if args.write {
            write(&exhibit.folder, levelled.fitting_db).map_err(Failure::input)?;
        }
    }
    Ok(())
}

fn recording(path: &str, json: bool) -> Outcome {
    let take = wav::read(path).map_err(Failure::input)?;
    let (samples, channels) = match &take.capsules {
        Some([left, right]) => (left.iter().zip(right).flat_map(|(l, r)| [*l, *r]).collect(), 2),
        None => (take.samples, 1),
    };
    let measured = measure(&samples, channels, take.sample_rate).map_err(Failure::input)?;
    if json {
        println!("{}", serde_json::to_string(&measured).map_err(Failure::input)?);
    } else {
        println!("{path}: {}; {:+.1} dB to the programme's loudness", description(&measured), correction(&measured));
    }
    Ok(())
}

fn print(levelled: &Levelled, json: bool) -> Outcome {
    if json {
        println!("{}", serde_json::to_string(levelled).map_err(Failure::input)?);
    } else {
        let Levelled { exhibit, now, level_db, fitting_db, then } = levelled;
        println!(
            "{exhibit}: {} at level {level_db:.1} dB; {} at {fitting_db:.1} dB",
            description(now),
            description(then)
        );
    }
    Ok(())
}

fn description(measured: &Measured) -> String {
    let Measured { lufs: Some(lufs), short_term_lufs, true_peak_dbtp } = measured else { return "silent".into() };
    let or_silence = |x: &Option<f64>| x.map_or_else(|| "-inf".to_owned(), |x| format!("{x:.1}"));
    format!("{lufs:.1} LUFS, 3 s {}, peak {} dBTP", or_silence(short_term_lufs), or_silence(true_peak_dbtp))
}

fn tone(path: &Path) -> Outcome {
    let (frequency, level, seconds) = TONE;
    let turn = 2.0 * PI * frequency / f64::from(SAMPLE_RATE);
    let fade = f64::from(SAMPLE_RATE / 10);
    let frames = seconds * SAMPLE_RATE;
    let sample = |n: u32| {
        let edge = (f64::from(n.min(frames - 1 - n)) / fade).min(1.0);
        (edge * db_to_amplitude(level) * sin(turn * f64::from(n))) as f32
    };
    let samples: Vec<f32> = (0..frames).flat_map(|n| [sample(n); 2]).collect();
    wav::write_float(path, 2, SAMPLE_RATE, &samples).map_err(Failure::input)
}
