//! Stochastic gradient descent on the frame networks: logistic loss and Adam (Kingma and Ba 2015). The order of operations is fixed,
//! so the same data give the same table to the bit.
//!
//! ```text
//! loss = Σ w (−y ln p − (1 − y) ln(1 − p)) + r |θ|²,    p = 1 / (1 + e^−ℓ)
//! ```
//!
//! Examples come from the detector's own run over a take, so that the noise floor, which its decisions freeze, is the same in
//! training as in the gallery (dataset aggregation; Ross, Gordon and Bagnell 2011). Only frames above the noise floor count, as
//! the others are decided without the network. Frames at the edges of a breath are left out.
//!
//! Weights follow the cost of an error: noise by its progress towards a false positive, breath while it is not detected yet. Of
//! frames that the detector classifies correctly and surely, one in eight is kept with eight times the weight.

use std::sync::Arc;

use soffio_detector::model::Network;
use soffio_detector::{BlowDetector, BlowSettings, FrameReport, dual_mic_model, features};
use soffio_math::noise::Random;
use soffio_math::{PI, cos, exp};
use soffio_soundscape::{Kind, Take};

/// Weight of a frame of noise.
const NOISE_WEIGHT: f32 = 1.5;
/// Additional weight of a frame of noise at full progress towards a false positive.
const FALSE_POSITIVE_WEIGHT: f32 = 5.0;
/// Factor on that weight for sounds that must never trigger.
const NEVER: f32 = 3.0;
/// Weight of a frame of a breath that is not detected yet.
const MISSED_WEIGHT: f32 = 3.0;
/// Weight of a frame in the first [`EARLY_S`] of a breath.
const EARLY_WEIGHT: f32 = 5.0;
/// Time in which a breath should be detected, s.
const EARLY_S: f64 = 0.15;
/// Time after the end of a breath in which it may still sound, s.
const TAIL_S: f64 = 0.25;
/// Log-odds from which a correct frame is sure, nats.
const SURE: f64 = 4.0;
/// One in this many sure frames is kept.
const SPARED: u64 = 8;
/// Factor on the learning rate of a network that was trained before.
const REVISION: f64 = 0.4;
/// Frames of a mini-batch.
const MINI_BATCH: usize = 64;
/// Initial learning rate.
const RATE: f64 = 2e-3;
/// L2 penalty on the weights, per step.
const RIDGE: f64 = 1e-5;
/// Amplitude of the noise on standardised features, against overfitting. It acts as a penalty on the slope of ℓ (Bishop, "Training
/// with Noise is Equivalent to Tikhonov Regularization", 1995).
const JITTER: f64 = 0.2;

/// One training example: a frame.
#[derive(Clone, Copy, Debug)]
pub struct Example<const IN: usize> {
    /// Inputs of the network.
    pub inputs: [f32; IN],
    /// The frame is breath.
    pub breath: bool,
    /// Weight in the loss.
    pub weight: f32,
}

/// One of the detector's networks, as training handles it.
#[derive(Clone, Copy, Debug)]
pub struct NetworkSpec<const IN: usize, const FIRST: usize, const SECOND: usize> {
    /// Takes have two capsules.
    pub stereo: bool,
    /// Inputs of a frame; `None` where the network is not used.
    pub inputs: fn(&FrameReport<'_>) -> Option<[f64; IN]>,
    /// The network in a detector's settings.
    pub get: fn(&BlowSettings) -> &Network<IN, FIRST, SECOND>,
    /// Sets the network in a detector's settings.
    pub set: fn(&mut BlowSettings, Network<IN, FIRST, SECOND>),
    /// Name in messages.
    pub title: &'static str,
    /// Module of the network's type in `soffio-detector`.
    pub module: &'static str,
    /// Type of the network.
    pub type_name: &'static str,
    /// Name of an input.
    pub input: fn(usize) -> String,
}

/// Network of one spectrum.
pub const SINGLE_MIC: NetworkSpec<{ features::COUNT }, 64, 24> = NetworkSpec {
    stereo: false,
    inputs: |report| Some(*report.features),
    get: |settings| &settings.model,
    set: |settings, network| settings.model = Arc::new(network),
    title: "one spectrum",
    module: "model",
    type_name: "Model",
    input: features::name,
};

/// Network of a dual microphone.
pub const DUAL_MIC: NetworkSpec<{ dual_mic_model::COUNT }, 32, 12> = NetworkSpec {
    stereo: true,
    inputs: |report| report.dual_mic.copied(),
    get: |settings| &settings.dual_mic_model,
    set: |settings, network| settings.dual_mic_model = Arc::new(network),
    title: "two capsules",
    module: "dual_mic_model",
    type_name: "DualMicModel",
    input: dual_mic_model::name,
};

/// Appends the examples of a take, from a run of the detector with these settings.
pub fn examples<const IN: usize>(
    take: &Take,
    settings: &BlowSettings,
    inputs: fn(&FrameReport<'_>) -> Option<[f64; IN]>,
    out: &mut Vec<Example<IN>>,
) {
    if take.kind == Kind::Ambiguous || take.breaths.iter().any(|b| b.faint) {
        return;
    }
    let mut detector = BlowDetector::with_settings(take.sample_rate, settings.clone());
    // A museum is noisy; but knocks and the kiosk's own sound must never trigger.
    let never = take.kind == Kind::Impulse || !take.played.is_empty();
    let false_positive_weight = FALSE_POSITIVE_WEIGHT * if never { NEVER } else { 1.0 };
    let mut frames = 0;
    for (i, &sample) in take.left.iter().enumerate() {
        let played = take.played.get(i..=i).unwrap_or_default();
        match &take.right {
            Some(right) => detector.push_stereo(&[sample], &right[i..=i], played),
            None => detector.push(&[sample], played),
        }
        let report = detector.last_frame();
        if report.frames == frames {
            continue;
        }
        frames = report.frames;
        let t = i as f64 / f64::from(take.sample_rate);
        let breath = take.breaths.iter().find(|b| t > b.onset - 0.02 && t < b.offset + TAIL_S);
        let is_breath = match breath {
            Some(b) if t > b.onset + 0.025 && t < b.offset - 0.1 => true,
            Some(_) => continue,
            None => false,
        };
        // Neighbouring frames are nearly alike, so every other frame of noise is enough.
        if !report.possible || (!is_breath && frames % 2 == 1) {
            continue;
        }
        let progress = report.progress as f32;
        let mut weight = match breath {
            Some(b) if is_breath && t < b.onset + EARLY_S => EARLY_WEIGHT,
            Some(_) if is_breath && progress < 1.0 => MISSED_WEIGHT,
            Some(_) if is_breath => 1.0,
            _ => NOISE_WEIGHT + false_positive_weight * progress,
        };
        let sure = if is_breath { report.log_odds > SURE } else { report.log_odds < -SURE && progress == 0.0 };
        if sure {
            if !frames.is_multiple_of(2 * SPARED) {
                continue;
            }
            weight *= SPARED as f32;
        }
        let inputs = inputs(&report).map(|inputs| inputs.map(|x| x as f32));
        out.extend(inputs.map(|inputs| Example { inputs, breath: is_breath, weight }));
    }
}

/// An untrained network: its log-odds are 0 for every frame, so it never detects a breath.
pub fn untrained<const IN: usize, const FIRST: usize, const SECOND: usize>() -> Network<IN, FIRST, SECOND> {
    let weights = vec![0.0; Network::<IN, FIRST, SECOND>::PARAMETERS];
    Network { scale: [[0.0, 1.0]; IN], weights: weights.into() }
}

/// Trains a network for a number of epochs over all examples; returns it with its mean loss. An untrained network starts from random
/// weights.
pub fn train<const IN: usize, const FIRST: usize, const SECOND: usize>(
    initial: &Network<IN, FIRST, SECOND>,
    examples: &[Example<IN>],
    epochs: usize,
    seed: u64,
) -> (Network<IN, FIRST, SECOND>, f64) {
    let mut random = Random::new(seed);
    let mut network = initial.clone();
    let new = network == untrained();
    let parameters = network.weights.len();
    let weights = network.weights.to_mut();
    if new {
        network.scale = scale(examples);
        // Random weights, scaled so that each sum is near 1 (Glorot and Bengio 2010).
        let (first, rest) = weights.split_at_mut(Network::<IN, FIRST, SECOND>::B);
        first.iter_mut().for_each(|w| *w = random.signed() * (6.0 / (IN + FIRST) as f64).sqrt());
        rest.iter_mut().for_each(|w| *w = random.signed() * (6.0 / (FIRST + SECOND) as f64).sqrt());
    }
    let longest = if new { RATE } else { REVISION * RATE };
    let mut order: Vec<u32> = (0..examples.len() as u32).collect();
    let (mut mean, mut square) = (vec![0.0; parameters], vec![0.0; parameters]);
    let mut gradient = vec![0.0; parameters];
    let (mut decay1, mut decay2) = (1.0, 1.0);
    let steps = (examples.len() / MINI_BATCH).max(1) * epochs;
    let (mut step, mut loss) = (0, 0.0);
    for _ in 0..epochs {
        for i in (1..order.len()).rev() {
            order.swap(i, (random.unit() * (i + 1) as f64) as usize);
        }
        loss = 0.0;
        let mut counted = 1e-9;
        for batch in order.chunks(MINI_BATCH) {
            gradient.fill(0.0);
            let mut weight = 0.0;
            for &i in batch {
                let example = &examples[i as usize];
                loss += accumulate_gradient(&network, example, &mut random, &mut gradient);
                weight += f64::from(example.weight);
            }
            counted += weight;
            let rate = longest * (0.02 + 0.49 * (1.0 + cos(PI * step as f64 / steps as f64)));
            step += 1;
            (decay1, decay2) = (0.9 * decay1, 0.999 * decay2);
            let weights = network.weights.to_mut();
            for (((w, g), m), s) in weights.iter_mut().zip(&gradient).zip(&mut mean).zip(&mut square) {
                let g = g / weight + RIDGE * *w;
                *m += 0.1 * (g - *m);
                *s += 0.001 * (g * g - *s);
                *w -= rate * (*m / (1.0 - decay1)) / ((*s / (1.0 - decay2)).sqrt() + 1e-8);
            }
        }
        loss /= counted;
    }
    (network, loss)
}

/// Mean and deviation of each input.
fn scale<const IN: usize>(examples: &[Example<IN>]) -> [[f64; 2]; IN] {
    let n = examples.len().max(1) as f64;
    std::array::from_fn(|i| {
        let values = || examples.iter().map(|e| f64::from(e.inputs[i]));
        let mean = values().sum::<f64>() / n;
        let square = values().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n;
        [mean, square.sqrt().max(1e-3)]
    })
}

/// Adds the gradient of one example; returns its loss.
fn accumulate_gradient<const IN: usize, const FIRST: usize, const SECOND: usize>(
    network: &Network<IN, FIRST, SECOND>,
    example: &Example<IN>,
    random: &mut Random,
    gradient: &mut [f64],
) -> f64 {
    let (b, c) = (Network::<IN, FIRST, SECOND>::B, Network::<IN, FIRST, SECOND>::C);
    let input = network.standardised(&example.inputs.map(f64::from)).map(|x| x + JITTER * random.signed());
    let layers = network.layers(&input);
    let z = layers.log_odds.clamp(-30.0, 30.0);
    let p = 1.0 / (1.0 + exp(-z));
    let (y, weight) = (f64::from(u8::from(example.breath)), f64::from(example.weight));
    let slope = weight * (p - y);
    // dσ/dz = (1 − |σ|)².
    let softsign_slope = |s: f64| (1.0 - s.abs()) * (1.0 - s.abs());
    let mut d2 = [0.0; SECOND];
    for j in 0..SECOND {
        gradient[c + j] += slope * layers.second[j];
        d2[j] = slope * network.weights[c + j] * softsign_slope(layers.second[j]);
    }
    gradient[c + SECOND] += slope;
    let mut d1 = [0.0; FIRST];
    for i in 0..FIRST {
        let row = &network.weights[b + i * SECOND..][..SECOND];
        d1[i] = row.iter().zip(&d2).map(|(w, d)| w * d).sum::<f64>() * softsign_slope(layers.first[i]);
    }
    add_outer(&mut gradient[b..c], &layers.first, &d2);
    add_outer(&mut gradient[..b], &layers.input, &d1);
    let likely = if example.breath { p } else { 1.0 - p };
    -weight * soffio_math::ln(likely.max(1e-12))
}

/// Adds the outer product x dᵀ, and d to the row after it.
fn add_outer<const N: usize, const M: usize>(gradient: &mut [f64], x: &[f64; N], d: &[f64; M]) {
    for (row, x) in gradient.as_chunks_mut::<M>().0.iter_mut().zip(x.iter().chain(&[1.0])) {
        for (g, d) in row.iter_mut().zip(d) {
            *g += d * x;
        }
    }
}
