//! Trains the logistic model of the blow detector and prints its table (for `src/wind/blow/model.rs`):
//!
//! ```text
//! cargo test --release --no-default-features --test suite train_blow -- --ignored --nocapture
//! ```
//!
//! Data: the labelled recordings under `../shared/breath`, at random gains, and generated breaths. Figures on
//! unseen recordings come from five folds: groups of recordings that share a speaker or a take stay together.
//! The room stands still while the present model hears a breath, so features depend on the model: three rounds.

use soffio::noise::{Random, hash_words};
use soffio::wind::blow::features::{COUNT, Features, NAMES};
use soffio::wind::blow::model::{Line, Model};
use soffio::wind::blow::{BlowDetector, BlowSettings};
use soffio::wind::generate::{self, BreathShape};

use super::dataset::{self, Clip, Scores};

const FOLDS: u64 = 5;
const ROUNDS: usize = 3;
/// Breaths in noise that are mixed for training.
const MIXES: usize = 200;
/// Every clip is heard at a gain drawn from ± this, dB.
const GAIN_DB: f64 = 12.0;
/// Penalty on squared weights, in frames: only ties are broken by it.
const RIDGE: f64 = 20.0;
/// Visitors forgive a late wind sooner than a ghost: a frame of noise weighs as much as this many of breath.
const NEGATIVE_WEIGHT: f64 = 2.0;
/// The first frames of a breath decide how late the wind comes: they weigh more, for this long, s.
const EARLY_WEIGHT: f64 = 4.0;
const EARLY_S: f64 = 0.2;

struct Frame {
    features: Features,
    breath: bool,
    weight: f64,
}

/// Frames of one clip, as the detector with this model hears them.
fn frames(model: &Model, clip: &Clip, out: &mut Vec<Frame>) {
    let settings = BlowSettings { model: model.clone(), ..BlowSettings::default() };
    let mut detector = BlowDetector::with_settings(clip.sample_rate, settings);
    let block = (clip.sample_rate / 1000) as usize;
    let (mut seen, mut heard) = (0, 0);
    for samples in clip.samples.chunks(block) {
        detector.push(samples, &[]);
        heard += samples.len();
        let (features, count) = detector.features();
        if count == seen {
            continue;
        }
        seen = count;
        let t = heard as f64 / f64::from(clip.sample_rate);
        // At the edges of a breath the frame holds both; the first third of a second is for the room.
        let breath = match clip.span {
            Some((onset, offset)) if t > onset + 0.045 && t < offset - 0.12 => true,
            Some((onset, offset)) if t > onset - 0.02 && t < offset + 0.35 => continue,
            _ => false,
        };
        // Frames that do not rise are decided without the model.
        if t > 0.3 && clip.expected != "ambiguous" && features[0] > 0.4 {
            let early = clip.span.is_some_and(|(onset, _)| t < onset + EARLY_S);
            let weight = if !breath {
                NEGATIVE_WEIGHT
            } else if early {
                EARLY_WEIGHT
            } else {
                1.0
            };
            out.push(Frame { features: *features, breath, weight });
        }
    }
}

const SIZE: usize = 3 * COUNT + 1;

/// The model's basis functions at one frame, the bias first.
fn basis(knees: &[[f64; 2]; COUNT], features: &Features) -> [f64; SIZE] {
    let mut row = [1.0; SIZE];
    for i in 0..COUNT {
        row[3 * i + 1..3 * i + 4].copy_from_slice(&Line::basis(&knees[i], features[i]));
    }
    row
}

/// Newton's method on the penalised log-likelihood (iteratively reweighted least squares). The knees lie at the
/// terciles of the frames of which the first glance is not enough (rise of 5 dB or more).
fn fit(frames: &[Frame]) -> Model {
    let knees: [[f64; 2]; COUNT] = std::array::from_fn(|i| {
        let risen: Vec<f64> = frames.iter().filter(|f| f.features[0] > 0.5).map(|f| f.features[i]).collect();
        [Scores::quantile(&risen, 1.0 / 3.0), Scores::quantile(&risen, 2.0 / 3.0)]
    });
    let mut beta = [0.0; SIZE];
    for _ in 0..10 {
        let mut hessian = [[0.0; SIZE]; SIZE];
        let mut gradient = [0.0; SIZE];
        for i in 1..SIZE {
            hessian[i][i] = RIDGE;
            gradient[i] = -RIDGE * beta[i];
        }
        hessian[0][0] = 1e-6;
        for frame in frames {
            let x = basis(&knees, &frame.features);
            let z: f64 = x.iter().zip(&beta).map(|(x, b)| x * b).sum();
            let p = 1.0 / (1.0 + (-z).exp());
            let error = frame.weight * (f64::from(u8::from(frame.breath)) - p);
            let curvature = frame.weight * (p * (1.0 - p)).max(1e-6);
            for i in 0..SIZE {
                gradient[i] += error * x[i];
                let scaled = curvature * x[i];
                for j in 0..=i {
                    hessian[i][j] += scaled * x[j];
                }
            }
        }
        let step = solve(&mut hessian, gradient);
        beta.iter_mut().zip(step).for_each(|(b, s)| *b += s);
    }
    let line = |i: usize| Line { knees: knees[i], slopes: [beta[3 * i + 1], beta[3 * i + 2], beta[3 * i + 3]] };
    Model { bias: beta[0], lines: std::array::from_fn(line) }
}

/// Solves A x = b for symmetric positive definite A, of which only the lower triangle is given (Cholesky).
fn solve<const N: usize>(a: &mut [[f64; N]; N], mut b: [f64; N]) -> [f64; N] {
    for i in 0..N {
        for j in 0..=i {
            let dot: f64 = (0..j).map(|k| a[i][k] * a[j][k]).sum();
            a[i][j] = if i == j { (a[i][i] - dot).sqrt() } else { (a[i][j] - dot) / a[j][j] };
        }
        let dot: f64 = (0..i).map(|k| a[i][k] * b[k]).sum();
        b[i] = (b[i] - dot) / a[i][i];
    }
    for i in (0..N).rev() {
        let dot: f64 = (i + 1..N).map(|k| a[k][i] * b[k]).sum();
        b[i] = (b[i] - dot) / a[i][i];
    }
    b
}

/// Breaths before noises of the set, at signal-to-noise ratios of 0–15 dB: `known` decides which of both are used.
fn mixed(known: &[Clip]) -> Vec<Clip> {
    let mut random = Random::new(11);
    let pick = |random: &mut Random, from: &[&Clip]| from[(random.unit() * from.len() as f64) as usize].clone();
    let breaths: Vec<&Clip> =
        known.iter().filter(|c| c.is_blow() && c.snr_db.is_none() && c.sample_rate == 16000).collect();
    let long = |c: &&Clip| c.duration() > 5.0 && c.sample_rate == 16000;
    let noises: Vec<&Clip> = known
        .iter()
        .filter(|c| c.expected == "not_blow" && !c.is_impulse() && c.label != "silence")
        .filter(long)
        .collect();
    let power = |samples: &[f32]| samples.iter().map(|x| f64::from(x * x)).sum::<f64>() / samples.len().max(1) as f64;
    (0..MIXES)
        .map(|_| {
            let (breath, mut noise) = (pick(&mut random, &breaths), pick(&mut random, &noises));
            let (onset, offset) = breath.span.unwrap();
            let at = |t: f64| (t * 16000.0) as usize;
            let start = at(random.range(0.4, 1.5));
            let body = &breath.samples[at(onset)..at(offset).min(breath.samples.len())];
            let snr = random.range(0.0, 15.0);
            let ratio = power(&noise.samples) * 10f64.powf(snr / 10.0) / power(body);
            // The louder of the two keeps its level.
            let (gain, noise_gain) = if ratio > 1.0 { (1.0, (1.0 / ratio).sqrt()) } else { (ratio.sqrt(), 1.0) };
            noise.samples.iter_mut().for_each(|x| *x *= noise_gain as f32);
            for (n, b) in noise.samples[start..].iter_mut().zip(body) {
                *n += b * gain as f32;
            }
            let onset = start as f64 / 16000.0;
            let end = onset + body.len() as f64 / 16000.0;
            Clip { span: Some((onset, end)), expected: "blow".into(), snr_db: Some(snr), ..noise }
        })
        .collect()
}

fn train(known: &[Clip]) -> Model {
    let mixes = mixed(known);
    let mut model = Model { bias: -9.0, ..Model::default() };
    for round in 0..ROUNDS {
        let mut all = Vec::new();
        let mut random = Random::new(round as u64);
        for clip in known.iter().chain(&mixes) {
            frames(&model, &clip.with_gain(random.range(-GAIN_DB, GAIN_DB)), &mut all);
        }
        model = fit(&all);
    }
    model
}

fn fold(group: &str) -> u64 {
    let letters: Vec<u64> = group.bytes().map(u64::from).collect();
    hash_words(&letters) % FOLDS
}

/// A generated clip at 16 kHz.
fn clip(name: String, span: Option<(f64, f64)>, samples: Vec<f32>) -> Clip {
    Clip {
        label: "generated".into(),
        expected: if span.is_some() { "blow" } else { "not_blow" }.into(),
        span,
        level: None,
        snr_db: None,
        group: name.clone(),
        file: name,
        samples,
        sample_rate: 16000,
    }
}

/// Breaths of the generator, gentle to hard, near and far, before three kinds of microphone; and what is no breath.
fn generated() -> Vec<Clip> {
    let mut random = Random::new(7);
    let mut clips = Vec::new();
    for i in 0..24 {
        let shape = BreathShape {
            strength: random.range(3.5, 17.0),
            attack: random.range(0.05, 0.2),
            hold: random.range(0.5, 2.0),
            release: random.range(0.1, 0.4),
            distance: random.range(0.05, 0.3),
            corner_hz: [20.0, 60.0, 100.0][i % 3],
            ..BreathShape::default()
        };
        clips.push(clip(format!("breath {i}"), Some(shape.span()), generate::breath(16000, i as u64, &shape)));
    }
    for i in 0..12 {
        let times: Vec<f64> = (1..6).map(|k| 0.8 * f64::from(k) + random.range(0.0, 0.3)).collect();
        let peak = random.range(0.1, 0.9);
        let bursts = [generate::thuds, generate::plosives, generate::knocks];
        for (kind, burst) in bursts.into_iter().enumerate() {
            let mut samples = burst(16000, i, 5.0, &times, peak);
            generate::mix(&mut samples, &generate::pink_noise(16000, i + 100, 5.0, -60.0));
            clips.push(clip(format!("burst {kind} {i}"), None, samples));
        }
    }
    for i in 0..6 {
        let mut voice = generate::voice(16000, i, 4.0, random.range(85.0, 250.0), random.range(-35.0, -12.0));
        generate::mix(&mut voice, &generate::pink_noise(16000, i + 200, 4.0, -60.0));
        clips.push(clip(format!("voice {i}"), None, voice));
    }
    clips
}

#[test]
#[ignore = "trains the model; run by hand when features change"]
fn train_blow() {
    let Some(set) = dataset::load() else {
        panic!("needs ../shared/breath/labels.csv beside the repository, or SOFFIO_BREATH_DATA");
    };
    let extra = generated();
    let (set, extra) = (&set, &extra);
    let held_out = |k: u64| {
        let (held, mut known): (Vec<Clip>, Vec<Clip>) = set.iter().cloned().partition(|c| fold(&c.group) == k);
        known.extend(extra.iter().cloned());
        let model = train(&known);
        held.into_iter().map(|clip| (model.clone(), clip)).collect::<Vec<_>>()
    };
    let unseen: Vec<_> = std::thread::scope(|scope| {
        let folds: Vec<_> = (0..FOLDS).map(|k| scope.spawn(move || held_out(k))).collect();
        folds.into_iter().flat_map(|fold| fold.join().unwrap()).collect()
    });
    // The operating curve: log-odds are shifted before the verdict.
    for shift in [-0.5, 0.0, 0.5] {
        let mut scores = Scores::default();
        for (model, clip) in &unseen {
            let verdict = dataset::judge(&Model { bias: model.bias + shift, ..model.clone() }, clip);
            scores.add(clip, &verdict);
            let wrong = verdict.false_triggers > 0 || clip.is_blow() && !verdict.detected;
            let slow = verdict.latency.is_some_and(|l| l > 0.25);
            if shift == 0.0 && clip.expected != "ambiguous" && (wrong || slow) {
                println!("  {} {:?}: {verdict:?}", clip.file, clip.snr_db);
            }
        }
        println!("held out, shifted by {shift:+}: {scores}");
    }
    let known: Vec<Clip> = set.iter().chain(extra).cloned().collect();
    let model = train(&known);
    println!("trained on all: {}", dataset::score(&model, set));
    for gain in [-12.0, 12.0] {
        let scaled: Vec<Clip> = set.iter().map(|c| c.with_gain(gain)).collect();
        println!("  at {gain:+} dB: {}", dataset::score(&model, &scaled));
    }
    println!("    bias: {:.3},\n    lines: [", model.bias);
    for (line, name) in model.lines.iter().zip(NAMES) {
        println!("        line({:.3?}, {:.3?}), // {name}", line.knees, line.slopes);
    }
    println!("    ],");
}
