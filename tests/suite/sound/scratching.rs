//! Scratching: the rings that are seen on the board are the ones that are heard under the nib.

use std::path::Path;
use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_math::{DVec3, PI, amplitude_to_db, sincos};
use soffio_simulation::{Settings, Simulation, StepInput};
use soffio_sound::{SoundSurface, SurfaceRelief, Synth};

use super::{RATE, render};

/// Distance of two years' rings in the board's picture, m (`exhibits/forge/scratch_board.rs`).
const YEAR: f64 = 6e-3;
/// The rings bend and lie about an axis: along a stroke they are this much nearer or farther apart.
const BENT: f64 = 0.15;
/// Window of the envelope, s: shorter than a ring takes under the fastest stroke, longer than a period of the board's partials.
const WINDOW: f64 = 4e-3;

fn board() -> Exhibit {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits/scratch-board");
    exhibit::load(&folder).unwrap_or_else(|report| panic!("{}", report.to_text()))
}

/// The quill is drawn across the rings at a steady speed, m/s: the left side, and the seconds that it took.
fn stroke(exhibit: Exhibit, speed: f64) -> Vec<f64> {
    let quill = exhibit.bodies.iter().position(|body| body.name == "Quill").expect("a quill");
    let scratch: Vec<bool> = exhibit.sounds.iter().map(|sound| sound.name == "scratch").collect();
    let mut instruments = exhibit.instruments.clone();
    for (sound, wanted) in exhibit.sounds.iter().zip(scratch) {
        if !wanted {
            instruments[sound.instrument].gain = 0.0;
        }
    }
    let mut synth = Synth::new(RATE, &instruments, 1).expect("checked");
    synth.set_dry(true);
    let mut simulation = Simulation::new(Arc::new(exhibit), Settings::default());
    let mut out = Vec::new();
    // From near the front edge, where it begins, away from the visitor; the first tenth of a second is the start.
    let steps = (0.16 / speed * 240.0) as usize;
    for step in 0..steps {
        simulation.bodies_mut()[quill].velocity = DVec3::new(0.0, 0.0, -speed);
        simulation.step(&StepInput::default());
        simulation.sounds().iter().for_each(|command| synth.command(*command));
        let frames = render(&mut synth, 200);
        if step >= 24 {
            out.extend(frames.chunks(2).map(|frame| f64::from(frame[0])));
        }
    }
    assert_eq!(synth.faults(), 0);
    out
}

/// Mean square of each window, as a part of the whole, minus 1.
fn envelope(sound: &[f64]) -> Vec<f64> {
    let window = (WINDOW * f64::from(RATE)) as usize;
    let powers: Vec<f64> = sound.chunks_exact(window).map(|part| part.iter().map(|x| x * x).sum()).collect();
    let mean = powers.iter().sum::<f64>() / powers.len() as f64;
    powers.iter().map(|power| power / mean - 1.0).collect()
}

/// Depth of the modulation at a frequency: 1 is from nothing to twice the mean.
fn depth(envelope: &[f64], frequency: f64) -> f64 {
    let (mut re, mut im, mut sum) = (0.0, 0.0, 0.0);
    for (i, value) in envelope.iter().enumerate() {
        let place = (i as f64 + 0.5) / envelope.len() as f64;
        let s = sincos(PI * place).0;
        let weight = s * s;
        let (s, c) = sincos(2.0 * PI * frequency * i as f64 * WINDOW);
        (re, im, sum) = (re + weight * value * c, im + weight * value * s, sum + weight);
    }
    2.0 * (re * re + im * im).sqrt() / sum
}

/// Greatest depth and its frequency, Hz, within ±`BENT` of a wanted frequency, and the mean elsewhere up to three times it.
fn peak(envelope: &[f64], wanted: f64) -> (f64, f64, f64) {
    let (mut best, mut at, mut others, mut count) = (0.0, 0.0, 0.0, 0.0);
    for i in 5..150 {
        let ratio = f64::from(i) / 50.0;
        let depth = depth(envelope, ratio * wanted);
        if (ratio - 1.0).abs() <= BENT {
            if depth > best {
                (best, at) = (depth, ratio * wanted);
            }
        } else if (ratio - 2.0).abs() > 2.0 * BENT {
            (others, count) = (others + depth, count + 1.0);
        }
    }
    (best, at, others / count)
}

#[test]
fn the_rings_are_heard_at_the_speed_of_the_nib() {
    for speed in [0.06, 0.12, 0.24] {
        let envelope = envelope(&stroke(board(), speed));
        let (depth, at, others) = peak(&envelope, speed / YEAR);
        println!("{speed} m/s: depth {depth:.2} at {at:.1} Hz (rings {:.1}), elsewhere {others:.2}", speed / YEAR);
        // 6 dB over what noise has by chance, and plainly audible: a depth of a quarter.
        assert!(depth > 0.25 && depth > 2.0 * others, "{speed} m/s: {depth} at {at} Hz, elsewhere {others}");
    }
}

#[test]
fn without_the_picture_no_rings_are_heard() {
    let mut plain = board();
    for instrument in &mut plain.instruments {
        instrument.surface = None;
    }
    let speed = 0.12;
    let (with, _, _) = peak(&envelope(&stroke(board(), speed)), speed / YEAR);
    let (without, at, _) = peak(&envelope(&stroke(plain, speed)), speed / YEAR);
    println!("with the picture {with:.2}, without {without:.2} at {at:.1} Hz");
    assert!(amplitude_to_db(with / without) > 6.0, "{with} and {without}");
}

#[test]
fn what_the_nib_reads_is_what_is_seen() {
    let board = board();
    let scratch = board.sounds.iter().find(|sound| sound.name == "scratch").expect("it is scraped");
    let Some(SoundSurface::Relief(relief)) = &board.instruments[scratch.instrument].surface else {
        panic!("no picture")
    };
    let SurfaceRelief { values, width } = &**relief;
    // Across the board the picture goes from light to dark once a ring: 240 mm have 40 of them.
    let column: Vec<f32> = values.chunks(*width).map(|row| row[width / 2]).collect();
    let mean = column.iter().sum::<f32>() / column.len() as f32;
    let falls = column.windows(2).filter(|pair| pair[0] < mean && pair[1] >= mean).count();
    println!("{falls} rings across {} pixels", column.len());
    assert!((34..=46).contains(&falls), "{falls} rings");
}
