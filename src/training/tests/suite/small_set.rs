//! Synthesis of the small set of labelled clips in `tests/cases/breath`, which the scores use by default, and a check of the files.

use std::path::{Path, PathBuf};

use soffio_detector::generate::{self, BreathShape};
use soffio_math::noise::Random;
use soffio_soundscape::scenes::{Condition, Hearing, Scenario};
use soffio_soundscape::{FIRST_VALIDATION_SEED, RATE, Take};

/// One clip: its row of `labels.csv` without the file's length, and its samples.
struct Clip {
    file: String,
    label: &'static str,
    expected: &'static str,
    /// Onset and offset of the breath, s.
    span: Option<(f64, f64)>,
    level: Option<f64>,
    snr_db: Option<f64>,
    group: String,
    notes: String,
    samples: Vec<f32>,
}

/// The folder of the set.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/cases/breath")
}

fn blow(file: String, seed: u64, shape: &BreathShape) -> Clip {
    Clip {
        file,
        label: "blow",
        expected: "blow",
        span: Some(shape.span()),
        level: None,
        snr_db: None,
        group: format!("blow-{seed}"),
        notes: format!("{} m/s from {} m at {} degrees", shape.strength, shape.distance, shape.angle_deg),
        samples: generate::breath(RATE, seed, shape),
    }
}

/// A clip without breath: the sound over quiet pink noise.
fn quiet(label: &'static str, seed: u64, sound: &[f32]) -> Clip {
    let mut samples = generate::pink_noise(RATE, 400 + seed, sound.len() as f64 / f64::from(RATE), -60.0);
    generate::mix(&mut samples, sound);
    Clip {
        file: format!("{label}-{seed}.wav"),
        label,
        expected: "not_blow",
        span: None,
        level: None,
        snr_db: None,
        group: format!("{label}-{seed}"),
        notes: String::new(),
        samples,
    }
}

/// Part of a synthetic scene, from a time, s, and of a length, s.
fn cut(take: &Take, from: f64, seconds: f64) -> Vec<f32> {
    let at = |t: f64| ((t.max(0.0) * f64::from(RATE)) as usize).min(take.left.len());
    take.left[at(from)..at(from + seconds)].to_vec()
}

fn clips() -> Vec<Clip> {
    /// Seed of the scenes' scenario, which neither training nor another test uses.
    const SEED: u64 = FIRST_VALIDATION_SEED + 2026;
    let hearing = Hearing { gain_db: 0.0, stereo: false };
    let scenario = Scenario::new(SEED);
    let mut clips = Vec::new();
    // One visitor at increasing strength.
    for (step, strength) in [4.5, 6.0, 8.0, 10.5, 13.5, 17.0].into_iter().enumerate() {
        let shape = BreathShape { strength, lead_out: 0.6, ..BreathShape::default() };
        let clip = blow(format!("ladder-{step}.wav"), 900, &shape);
        clips.push(Clip { level: Some(strength), group: "ladder-1".into(), ..clip });
    }
    // Other visitors: near and far, on and off the axis, in quiet and less quiet rooms.
    let mut random = Random::new(2026);
    for seed in 0..8 {
        let shape = BreathShape {
            strength: random.range(5.0, 15.0),
            attack: random.range(0.06, 0.2),
            hold: random.range(0.6, 1.4),
            distance: random.range(0.06, 0.2),
            angle_deg: random.range(0.0, 20.0),
            noise_dbfs: random.range(-66.0, -52.0),
            lead_out: 0.6,
            ..BreathShape::default()
        };
        clips.push(blow(format!("blow-{seed}.wav"), 910 + seed, &shape));
    }
    for index in 0..4 {
        const SNR_DB: f64 = 5.0;
        let take = scenario.take(Condition::Noisy(SNR_DB), index, hearing);
        let breath = take.breaths[0];
        let from = (breath.onset - 1.5).max(0.0);
        clips.push(Clip {
            file: format!("crowd-{index}.wav"),
            label: "blow",
            expected: "blow",
            span: Some((breath.onset - from, breath.offset - from)),
            level: None,
            snr_db: Some(SNR_DB),
            group: format!("crowd-{index}"),
            notes: "a made museum around it".into(),
            samples: cut(&take, from, breath.offset - from + 0.6),
        });
    }
    for index in 0..2 {
        let take = scenario.take(Condition::Museum, index, hearing);
        let clip = quiet("museum", index, &[]);
        clips.push(Clip { samples: cut(&take, 20.0, 8.0), notes: "voices and steps in a made museum".into(), ..clip });
    }
    for seed in 0..2 {
        let times = [0.6, 1.3, 2.1];
        clips.push(quiet("voice", seed, &generate::voice(RATE, seed, 3.0, [110.0, 210.0][seed as usize], -18.0)));
        clips.push(quiet("impulse", seed, &generate::knocks(RATE, seed, 2.5, &times, 0.7)));
        clips.push(quiet("plosive_pop", seed, &generate::plosives(RATE, seed, 2.5, &times, 0.5)));
        clips.push(quiet("handling_thump", seed, &generate::thuds(RATE, seed, 2.5, &times, 0.4)));
    }
    clips.push(quiet("mechanical", 0, &generate::hum(RATE, 3.0, 50.0, -20.0)));
    clips.push(quiet("weather_lf", 0, &generate::pink_noise(RATE, 77, 3.0, -25.0)));
    clips
}

/// A WAV of 16 bits, mono.
fn wav(samples: &[f32]) -> Vec<u8> {
    let spec =
        hound::WavSpec { channels: 1, sample_rate: RATE, bits_per_sample: 16, sample_format: hound::SampleFormat::Int };
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut file = hound::WavWriter::new(&mut bytes, spec).expect("in memory");
    for x in samples {
        file.write_sample((x * 32767.0).round().clamp(-32768.0, 32767.0) as i16).expect("in memory");
    }
    file.finalize().expect("in memory");
    bytes.into_inner()
}

/// All files of the set except its README.
fn files() -> Vec<(String, Vec<u8>)> {
    let number = |x: Option<f64>| x.map_or(String::new(), |x| format!("{x:.3}"));
    let clips = clips();
    let mut table = String::from(
        "file,label,expected,onset_s,offset_s,source,licence,author,kind,sr,dur_s,level,snr_db,group,notes\n",
    );
    for clip in &clips {
        let (onset, offset) = clip.span.unzip();
        let cells = [
            clip.file.as_str(),
            clip.label,
            clip.expected,
            &number(onset),
            &number(offset),
            "soffio-detector and soffio-soundscape",
            "MIT OR Apache-2.0",
            "the Soffio authors",
            "synthetic",
            &RATE.to_string(),
            &format!("{:.2}", clip.samples.len() as f64 / f64::from(RATE)),
            &number(clip.level),
            &number(clip.snr_db),
            &clip.group,
            &clip.notes,
        ];
        table += &(cells.join(",") + "\n");
    }
    let waves = clips.iter().map(|clip| (clip.file.clone(), wav(&clip.samples)));
    waves.chain([("labels.csv".into(), table.into_bytes())]).collect()
}

#[test]
fn the_small_set_is_up_to_date() {
    for (name, bytes) in files() {
        let stored = std::fs::read(folder().join(&name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(stored == bytes, "{name} differs from the synthesis: run `write_the_small_set`, and score it again");
    }
}

/// `cargo test -p soffio-training write_the_small_set -- --ignored`
#[test]
#[ignore = "writes tests/cases/breath"]
fn write_the_small_set() {
    std::fs::create_dir_all(folder()).expect("a writable tree");
    for (name, bytes) in files() {
        std::fs::write(folder().join(name), bytes).expect("a writable folder");
    }
}
