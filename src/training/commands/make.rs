//! `soffio-training make`: a folder of labelled scenes.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;

use soffio_math::noise::{Random, hash_words};
use soffio_offline::{atomic_file::AtomicFile, wav};
use soffio_soundscape::scenes::{Condition, Hearing, Scenario};
use soffio_soundscape::{Kind, RATE, Take};

use super::failure::{Failure, Outcome};
use crate::recordings;

/// Makes labelled scenes of breaths and of museums, as WAVs beside a labels.csv.
///
/// Example: soffio-training make out/scenes --count 50 --seed 7
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Folder; it is created if it does not exist.
    folder: PathBuf,
    /// Scenes of each kind.
    #[arg(long, default_value_t = 20)]
    count: u64,
    /// The same seed makes the same scenes.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Two capsules, as two channels.
    #[arg(long)]
    stereo: bool,
    /// A folder of labelled recordings, whose noises are mixed in.
    #[arg(long, value_name = "FOLDER")]
    data: Option<PathBuf>,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Outcome {
    std::fs::create_dir_all(&args.folder)
        .map_err(|error| Failure::input(format!("{}: {error}", args.folder.display())))?;
    let mut scenario = Scenario::new(args.seed);
    if let Some(folder) = &args.data {
        scenario = scenario.with_recordings(&recordings::read(folder).map_err(Failure::input)?);
    }
    let kinds = [
        ("museum", Condition::Museum),
        ("impulses", Condition::Impulses),
        ("breath", Condition::Isolated),
        ("breath-in-noise", Condition::Noisy(10.0)),
        ("kiosk-sound", Condition::KioskSound((args.seed % 3) as u32)),
    ];
    let mut table = String::from("file,label,expected,onset_s,offset_s,level,snr_db,group,notes\n");
    for (kind, condition) in kinds {
        for index in 0..args.count {
            let mut random = Random::new(hash_words(&[args.seed, index, 6]));
            let hearing = Hearing { gain_db: random.range(-12.0, 12.0), stereo: args.stereo };
            let take = scenario.take(condition, index, hearing);
            let file = format!("{kind}-{index:04}.wav");
            write(&take, &args.folder.join(&file))?;
            let _ = writeln!(table, "{}", row(&file, kind, &take));
        }
    }
    let labels = args.folder.join("labels.csv");
    let fail = |error: std::io::Error| Failure::input(format!("{}: {error}", labels.display()));
    let file = AtomicFile::create(&labels).map_err(fail)?;
    file.reopen().and_then(|mut out| out.write_all(table.as_bytes())).map_err(fail)?;
    file.finish().map_err(fail)?;
    println!("{}: {} scenes", args.folder.display(), 5 * args.count);
    Ok(())
}

/// Writes a take. Channels are the capsules, or one capsule and the kiosk's own output.
fn write(take: &Take, path: &std::path::Path) -> Outcome {
    let second = take.right.as_ref().or((!take.played.is_empty()).then_some(&take.played));
    let written = match second {
        Some(right) => {
            let both: Vec<f32> = take.left.iter().zip(right).flat_map(|(l, r)| [*l, *r]).collect();
            wav::write_float(path, 2, RATE, &both)
        }
        None => wav::write_float(path, 1, RATE, &take.left),
    };
    written.map_err(Failure::input)
}

fn row(file: &str, kind: &str, take: &Take) -> String {
    let expected = if take.kind == Kind::Blow { "blow" } else { "not_blow" };
    let label = if take.kind == Kind::Impulse { "impulse" } else { kind };
    let (mut span, mut snr, mut note) = (",".to_owned(), String::new(), String::new());
    if let Some(breath) = take.breaths.first() {
        span = format!("{:.3},{:.3}", breath.onset, breath.offset);
        snr = breath.snr_db.map(|snr| snr.to_string()).unwrap_or_default();
        note = format!("{:.1} m/s{}", breath.strength, if breath.faint { " faint" } else { "" });
    }
    format!("{file},{label},{expected},{span},,{snr},{},{note}", take.group)
}
