//! Training of the frame model: logistic loss, Adam (Kingma and Ba 2015), in one fixed order, so that the same data give the
//! same table to the bit.
//!
//! ```text
//! loss = Σ w (−y ln p − (1 − y) ln(1 − p)) + r |θ|²,    p = 1 / (1 + e^−ℓ)
//! ```
//!
//! What is learnt from is what the ear itself heard while it judged the take, so that the room which it holds still for a
//! sound that might be breath is the same in the lesson as in the gallery (Ross, Gordon and Bagnell 2011 call it
//! dataset aggregation). Only frames count in which something has risen above the room: the others are decided
//! without the model. At the edges of a breath a frame holds both: it is left out. A frame weighs by what its mistake
//! would cost: noise by how near it is to a ghost, breath while it has not been heard yet. Of frames that the ear
//! is sure of and right about, a few stand for all.

use std::fmt::Write as _;

use super::{Kind, Take};
use crate::math::{PI, cos, exp};
use crate::noise::Random;
use crate::wind::blow::features::{COUNT, MEANS_S, MEASURED, NAMES};
use crate::wind::blow::model::{B, C, FIRST, Model, PARAMETERS, SECOND};
use crate::wind::blow::{BlowDetector, BlowSettings};

/// Weight of a frame of noise, and what is added on the way to a ghost; to one that may never be, so many times as much.
const NOISE_WEIGHT: f32 = 1.5;
const GHOST_WEIGHT: f32 = 5.0;
const NEVER: f32 = 3.0;
/// Weight of a frame of breath that is not heard yet, and of one that should have been heard already.
const UNHEARD_WEIGHT: f32 = 3.0;
const EARLY_WEIGHT: f32 = 5.0;
const EARLY_S: f64 = 0.15;
/// What is left of a breath after its end may still sound like one, s.
const TAIL_S: f64 = 0.25;
/// Log-odds beyond which a right answer is a matter of course, nats; and one of how many such frames is kept.
const SURE: f64 = 4.0;
const SPARED: u64 = 8;
/// What is left of a step's length when the examples have been met before.
const REVISION: f64 = 0.4;
/// Frames of a step.
const BATCH: usize = 64;
/// Step length at first.
const RATE: f64 = 2e-3;
/// Penalty on squared weights, a step.
const RIDGE: f64 = 1e-5;
/// Standardised features are shaken by up to this much, so that nothing hangs on their last digits: the same as a
/// penalty on the slope of ℓ (Bishop, "Training with Noise is Equivalent to Tikhonov Regularization", 1995).
const JITTER: f64 = 0.2;

/// One frame to learn from.
#[derive(Clone, Copy, Debug)]
pub struct Example {
    /// As the front end gives them.
    pub features: [f32; COUNT],
    /// Somebody blows.
    pub breath: bool,
    /// How much it counts.
    pub weight: f32,
}

/// Appends the examples of a take, as an ear of these settings hears it.
pub fn examples(take: &Take, settings: &BlowSettings, out: &mut Vec<Example>) {
    if take.kind == Kind::Ambiguous || take.breaths.iter().any(|b| b.faint) {
        return;
    }
    let mut ear = BlowDetector::with_settings(take.sample_rate, settings.clone());
    // A museum is noisy; but knocks and the kiosk itself may never trigger.
    let never = take.kind == Kind::Impulse || !take.played.is_empty();
    let ghost_weight = GHOST_WEIGHT * if never { NEVER } else { 1.0 };
    let mut frames = 0;
    for (i, &sample) in take.left.iter().enumerate() {
        ear.push(&[sample], take.played.get(i..=i).unwrap_or_default());
        let heard = ear.heard();
        if heard.frames == frames {
            continue;
        }
        frames = heard.frames;
        let t = i as f64 / f64::from(take.sample_rate);
        let breath = take.breaths.iter().find(|b| t > b.onset - 0.02 && t < b.offset + TAIL_S);
        let is_breath = match breath {
            Some(b) if t > b.onset + 0.025 && t < b.offset - 0.1 => true,
            Some(_) => continue,
            None => false,
        };
        // Neighbours are nearly alike: of noise, every other frame will do.
        if !heard.possible || (!is_breath && frames % 2 == 1) {
            continue;
        }
        let progress = heard.progress as f32;
        let mut weight = match breath {
            Some(b) if is_breath && t < b.onset + EARLY_S => EARLY_WEIGHT,
            Some(_) if is_breath && progress < 1.0 => UNHEARD_WEIGHT,
            Some(_) if is_breath => 1.0,
            _ => NOISE_WEIGHT + ghost_weight * progress,
        };
        let sure = if is_breath { heard.log_odds > SURE } else { heard.log_odds < -SURE && progress == 0.0 };
        if sure {
            if !frames.is_multiple_of(2 * SPARED) {
                continue;
            }
            weight *= SPARED as f32;
        }
        out.push(Example { features: heard.features.map(|x| x as f32), breath: is_breath, weight });
    }
}

/// A model that knows nothing: it calls every frame as likely as not, and so never hears a breath.
pub fn untaught() -> Model {
    Model { scale: [[0.0, 1.0]; COUNT], weights: [0.0; PARAMETERS] }
}

/// Trains a model for so many rounds over all examples; returns it with its mean loss. One that knows nothing begins
/// anew.
pub fn train(taught: &Model, examples: &[Example], rounds: usize, seed: u64) -> (Model, f64) {
    let mut random = Random::new(seed);
    let mut model = taught.clone();
    let new = model == untaught();
    if new {
        model.scale = scale(examples);
        // Each row starts at random, of a size that keeps its sum near 1 (Glorot and Bengio 2010).
        let (first, rest) = model.weights.split_at_mut(B);
        first.iter_mut().for_each(|w| *w = random.signed() * (6.0 / (COUNT + FIRST) as f64).sqrt());
        rest.iter_mut().for_each(|w| *w = random.signed() * (6.0 / (FIRST + SECOND) as f64).sqrt());
    }
    let longest = if new { RATE } else { REVISION * RATE };
    let mut order: Vec<u32> = (0..examples.len() as u32).collect();
    let (mut mean, mut square) = (vec![0.0; PARAMETERS], vec![0.0; PARAMETERS]);
    let (mut decay1, mut decay2) = (1.0, 1.0);
    let steps = (examples.len() / BATCH).max(1) * rounds;
    let (mut step, mut loss) = (0, 0.0);
    for _ in 0..rounds {
        for i in (1..order.len()).rev() {
            order.swap(i, (random.unit() * (i + 1) as f64) as usize);
        }
        loss = 0.0;
        let mut weights = 1e-9;
        for batch in order.chunks(BATCH) {
            let mut gradient = [0.0; PARAMETERS];
            let mut weight = 0.0;
            for &i in batch {
                let example = &examples[i as usize];
                loss += descend(&model, example, &mut random, &mut gradient);
                weight += f64::from(example.weight);
            }
            weights += weight;
            let rate = longest * (0.02 + 0.49 * (1.0 + cos(PI * step as f64 / steps as f64)));
            step += 1;
            (decay1, decay2) = (0.9 * decay1, 0.999 * decay2);
            for (((w, g), m), s) in model.weights.iter_mut().zip(&gradient).zip(&mut mean).zip(&mut square) {
                let g = g / weight + RIDGE * *w;
                *m += 0.1 * (g - *m);
                *s += 0.001 * (g * g - *s);
                *w -= rate * (*m / (1.0 - decay1)) / ((*s / (1.0 - decay2)).sqrt() + 1e-8);
            }
        }
        loss /= weights;
    }
    (model, loss)
}

/// Mean and deviation of each feature.
fn scale(examples: &[Example]) -> [[f64; 2]; COUNT] {
    let n = examples.len().max(1) as f64;
    std::array::from_fn(|i| {
        let values = || examples.iter().map(|e| f64::from(e.features[i]));
        let mean = values().sum::<f64>() / n;
        let square = values().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n;
        [mean, square.sqrt().max(1e-3)]
    })
}

/// Adds one example's gradient; returns its loss.
fn descend(model: &Model, example: &Example, random: &mut Random, gradient: &mut [f64; PARAMETERS]) -> f64 {
    let input = model.standardised(&example.features.map(f64::from)).map(|x| x + JITTER * random.signed());
    let layers = model.layers(&input);
    let z = layers.log_odds.clamp(-30.0, 30.0);
    let p = 1.0 / (1.0 + exp(-z));
    let (y, weight) = (f64::from(u8::from(example.breath)), f64::from(example.weight));
    let slope = weight * (p - y);
    // dσ/dz = (1 − |σ|)².
    let bend = |s: f64| (1.0 - s.abs()) * (1.0 - s.abs());
    let mut d2 = [0.0; SECOND];
    for j in 0..SECOND {
        gradient[C + j] += slope * layers.second[j];
        d2[j] = slope * model.weights[C + j] * bend(layers.second[j]);
    }
    gradient[C + SECOND] += slope;
    let mut d1 = [0.0; FIRST];
    for i in 0..FIRST {
        let row = &model.weights[B + i * SECOND..][..SECOND];
        d1[i] = row.iter().zip(&d2).map(|(w, d)| w * d).sum::<f64>() * bend(layers.first[i]);
    }
    add_outer(&mut gradient[B..C], &layers.first, &d2);
    add_outer(&mut gradient[..B], &layers.input, &d1);
    let likely = if example.breath { p } else { 1.0 - p };
    -weight * crate::math::ln(likely.max(1e-12))
}

/// Adds the outer product x dᵀ, and d for the row after it.
fn add_outer<const N: usize, const M: usize>(gradient: &mut [f64], x: &[f64; N], d: &[f64; M]) {
    for (row, x) in gradient.as_chunks_mut::<M>().0.iter_mut().zip(x.iter().chain(&[1.0])) {
        for (g, d) in row.iter_mut().zip(d) {
            *g += d * x;
        }
    }
}

/// The model as the source of `src/wind/blow/table.rs`.
pub fn table(model: &Model) -> String {
    let mut out = String::from(
        "//! The trained model: written by `soffio breath train`, not by hand.\n\nuse super::model::Model;\n\n\
         /// The trained model.\n#[rustfmt::skip]\n\
         #[allow(clippy::approx_constant)] // what was learnt, whatever it resembles\npub static TRAINED: Model = Model {\n    scale: [\n",
    );
    for (i, ([mean, deviation], name)) in model.scale.iter().zip(NAMES.iter().cycle()).enumerate() {
        let over = i.checked_sub(MEASURED).map(|i| format!(", mean of {} s", MEANS_S[i / MEASURED]));
        let _ = writeln!(out, "        [{mean:.4}, {deviation:.4}], // {name}{}", over.unwrap_or_default());
    }
    out.push_str("    ],\n    weights: [\n");
    for row in model.weights.chunks(11) {
        let cells: Vec<String> = row.iter().map(|w| format!("{w:.4}")).collect();
        let _ = writeln!(out, "        {},", cells.join(", "));
    }
    out.push_str("    ],\n};\n");
    out
}
