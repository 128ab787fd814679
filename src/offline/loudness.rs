//! Loudness of exhibits and recordings (EBU R 128), and the level correction that makes exhibits equally loud.
//!
//! All exhibits are levelled to one loudness, so that none is startling and a site's calibration holds for all. An
//! exhibit is measured in a standard scene, a minute with three visitors, through the kiosk's own synthesiser, reverb
//! and limiter. Its level is found iteratively, because the limiter is not linear.

use std::path::Path;
use std::sync::Arc;

use ebur128::{EbuR128, Mode};

use super::atomic_file::AtomicFile;
use soffio_exhibit::{Exhibit, SIDECAR, files};
use soffio_math::{amplitude_to_db, db_to_amplitude};
use soffio_simulation::{SAMPLE_RATE, SAMPLES_PER_STEP, STEPS_PER_SECOND, Script, Settings, Simulation, StepInput};
use soffio_sound::{PROGRAMME, ReverbSpec, SoundCommand, Synth};

/// Actions of visitors in the standard scene: a gentle, a normal and a hard breath, and a gentle one elsewhere.
const VISITORS: &str = r#"{"t": 1, "aim": [0.5, 0.5], "blow": {"strength": 0.4, "hold": 1.5, "release": 0.3}}
{"t": 12, "aim": [0.4, 0.45], "blow": {"strength": 0.7, "hold": 2.0, "release": 0.3}}
{"t": 26, "aim": [0.6, 0.5], "blow": {"strength": 1.0, "hold": 2.5, "release": 0.3}}
{"t": 42, "aim": [0.5, 0.6], "blow": {"strength": 0.5, "hold": 1.5, "release": 0.3}}"#;
/// Duration of the scene, s.
const SCENE_S: f64 = 60.0;
/// Largest short-term loudness (3 s), LUFS.
const MAX_SHORT_TERM: f64 = -18.0;
/// Largest gain of an exhibit, dB: intentionally quiet exhibits stay quiet.
const MAX_GAIN: f64 = 18.0;
/// Most iterations, and the tolerance of the result, LU.
const MAX_ITERATIONS: usize = 4;
const TOLERANCE: f64 = 0.1;

/// Loudness measures of EBU R 128.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Measured {
    /// Integrated loudness, LUFS; `None` for silence.
    pub lufs: Option<f64>,
    /// Largest short-term loudness (3 s), LUFS.
    pub short_term_lufs: Option<f64>,
    /// True peak, dBTP.
    pub true_peak_dbtp: Option<f64>,
}

/// Measures interleaved samples.
///
/// # Errors
/// Where the meter refuses the channels or the sample rate.
pub fn measure(samples: &[f32], channels: u32, sample_rate: u32) -> Result<Measured, String> {
    let says = |e: ebur128::Error| e.to_string();
    let mut meter = EbuR128::new(channels, sample_rate, Mode::I | Mode::S | Mode::TRUE_PEAK).map_err(says)?;
    let mut short_term = f64::NEG_INFINITY;
    // EBU Tech 3341: ten measurements a second.
    for block in samples.chunks((channels * sample_rate / 10).max(1) as usize) {
        meter.add_frames_f32(block).map_err(says)?;
        short_term = short_term.max(meter.loudness_shortterm().map_err(says)?);
    }
    let mut peak = 0.0f64;
    for channel in 0..channels {
        peak = peak.max(meter.true_peak(channel).map_err(says)?);
    }
    let finite = |x: f64| x.is_finite().then_some(x);
    Ok(Measured {
        lufs: finite(meter.loudness_global().map_err(says)?),
        short_term_lufs: finite(short_term),
        true_peak_dbtp: finite(amplitude_to_db(peak)),
    })
}

/// Level correction, dB, of a sound with these measures.
pub fn correction(measured: &Measured) -> f64 {
    let to = |target: f64, now: Option<f64>| now.map_or(0.0, |now| target - now);
    to(PROGRAMME, measured.lufs).min(to(MAX_SHORT_TERM, measured.short_term_lufs))
}

/// Loudness of an exhibit, and its corrected level.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Levelled {
    /// Id of the exhibit.
    pub exhibit: String,
    /// Its present loudness.
    pub now: Measured,
    /// Its present `scene.level`, dB.
    pub level_db: f64,
    /// The level that makes it as loud as the others, dB.
    pub fitting_db: f64,
    /// Its loudness at that level.
    pub then: Measured,
}

/// Measures an exhibit in the standard scene and finds its level.
///
/// # Errors
/// Where a timbre is invalid.
pub fn level(exhibit: &Arc<Exhibit>, settings: Settings, reverb: Option<&ReverbSpec>) -> Result<Levelled, String> {
    let sounds = scene(exhibit, settings)?;
    let hear = |raised: f64| {
        let mut instruments = exhibit.instruments.clone();
        instruments.iter_mut().for_each(|instrument| instrument.gain *= db_to_amplitude(raised));
        let mut synth = Synth::new(SAMPLE_RATE, &instruments, settings.seed).map_err(|e| e.to_string())?;
        synth.set_reverb(reverb);
        let mut out = vec![0.0; 2 * SAMPLES_PER_STEP as usize * sounds.len()];
        for (step, block) in sounds.iter().zip(out.chunks_mut(2 * SAMPLES_PER_STEP as usize)) {
            step.iter().for_each(|sound| synth.command(*sound));
            synth.render(block);
        }
        measure(&out, 2, SAMPLE_RATE)
    };
    let now = hear(0.0)?;
    let (mut raised, mut then) = (0.0, now);
    for _ in 0..MAX_ITERATIONS {
        let missing = correction(&then);
        let next = (raised + missing).min(MAX_GAIN);
        if (next - raised).abs() < TOLERANCE {
            break;
        }
        raised = next;
        then = hear(raised)?;
    }
    let level_db = exhibit.level_db;
    // A tenth of a decibel is precise enough.
    let fitting_db = ((level_db + raised) * 10.0).round() / 10.0;
    Ok(Levelled { exhibit: exhibit.id.clone(), now, level_db, fitting_db, then })
}

/// Sound commands of each step of the standard scene.
fn scene(exhibit: &Arc<Exhibit>, settings: Settings) -> Result<Vec<Vec<SoundCommand>>, String> {
    let mut script = Script::parse(VISITORS).map_err(|e| e.to_string())?;
    let mut simulation = Simulation::new(exhibit.clone(), settings);
    let mut commands = Vec::new();
    let mut sounds = Vec::new();
    for step in 0..(SCENE_S * STEPS_PER_SECOND as f64) as u64 {
        commands.clear();
        script.due(step as f64 / STEPS_PER_SECOND as f64, &mut commands);
        let pointer = script.aim();
        simulation.step(&StepInput { pointer, aspect: 16.0 / 9.0, commands: &commands, ..StepInput::default() });
        sounds.push(simulation.sounds().to_vec());
    }
    Ok(sounds)
}

/// Writes the level into the exhibit's sidecar and leaves the rest of the file unchanged.
///
/// # Errors
/// The sidecar cannot be read, changed or written; the reason.
pub fn write(folder: &Path, level_db: f64) -> Result<(), String> {
    let path = folder.join(SIDECAR);
    let says = |e: &dyn std::fmt::Display| format!("{}: {e}", path.display());
    let text = files::read_text(&path, files::MAX_SIDECAR_BYTES).map_err(|problem| problem.message)?;
    let mut document: toml_edit::DocumentMut = text.parse().map_err(|e| says(&e))?;
    let scene = document.entry("scene").or_insert_with(toml_edit::table);
    let Some(scene) = scene.as_table_like_mut() else { return Err(says(&"[scene] is no table")) };
    let value = toml_edit::value(format!("{level_db} dB"));
    match scene.get_mut("level").and_then(|item| item.as_value_mut().zip(value.as_value())) {
        Some((old, new)) => {
            // Keep the comment behind it.
            let decor = old.decor().clone();
            *old = new.clone();
            *old.decor_mut() = decor;
        }
        None => {
            scene.insert("level", value);
        }
    }
    let mut file = AtomicFile::create(&path).map_err(|e| says(&e))?;
    std::io::Write::write_all(&mut file, document.to_string().as_bytes()).map_err(|e| says(&e))?;
    file.finish().map_err(|e| says(&e))
}
