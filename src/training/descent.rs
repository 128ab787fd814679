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

use std::sync::Arc;

use soffio_detector::model::Network;
use soffio_detector::{BlowDetector, BlowSettings, Heard, features, pair};
use soffio_math::noise::Random;
use soffio_math::{PI, cos, exp};
use soffio_soundscape::{Kind, Take};

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
pub struct Example<const IN: usize> {
    /// What the network weighs.
    pub inputs: [f32; IN],
    /// Somebody blows.
    pub breath: bool,
    /// How much it counts.
    pub weight: f32,
}

/// Which of the ear's networks learns.
#[derive(Clone, Copy, Debug)]
pub struct Subject<const IN: usize, const FIRST: usize, const SECOND: usize> {
    /// Takes have two capsules.
    pub stereo: bool,
    /// What it weighs of a frame; `None` where it is not asked.
    pub inputs: fn(&Heard<'_>) -> Option<[f64; IN]>,
    /// The network of an ear.
    pub of: fn(&BlowSettings) -> &Network<IN, FIRST, SECOND>,
    /// Gives an ear a network.
    pub give: fn(&mut BlowSettings, Network<IN, FIRST, SECOND>),
    /// The constant and the type of its table, and what each input is, in words.
    pub name: [&'static str; 3],
    /// What each input is, in words.
    pub input: fn(usize) -> String,
}

/// The network of one spectrum.
pub const ONE: Subject<{ features::COUNT }, 64, 24> = Subject {
    stereo: false,
    inputs: |heard| Some(*heard.features),
    of: |settings| &settings.model,
    give: |settings, network| settings.model = Arc::new(network),
    name: ["one spectrum", "model", "Model"],
    input: features::name,
};

/// The network of two capsules.
pub const TWO: Subject<{ pair::COUNT }, 32, 12> = Subject {
    stereo: true,
    inputs: |heard| heard.pair.copied(),
    of: |settings| &settings.pair,
    give: |settings, network| settings.pair = Arc::new(network),
    name: ["two capsules", "pair", "PairModel"],
    input: pair::name,
};

/// Appends the examples of a take, as an ear of these settings hears it.
pub fn examples<const IN: usize>(
    take: &Take,
    settings: &BlowSettings,
    inputs: fn(&Heard<'_>) -> Option<[f64; IN]>,
    out: &mut Vec<Example<IN>>,
) {
    if take.kind == Kind::Ambiguous || take.breaths.iter().any(|b| b.faint) {
        return;
    }
    let mut ear = BlowDetector::with_settings(take.sample_rate, settings.clone());
    // A museum is noisy; but knocks and the kiosk itself may never trigger.
    let never = take.kind == Kind::Impulse || !take.played.is_empty();
    let ghost_weight = GHOST_WEIGHT * if never { NEVER } else { 1.0 };
    let mut frames = 0;
    for (i, &sample) in take.left.iter().enumerate() {
        let played = take.played.get(i..=i).unwrap_or_default();
        match &take.right {
            Some(right) => ear.push_stereo(&[sample], &right[i..=i], played),
            None => ear.push(&[sample], played),
        }
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
        let inputs = inputs(&heard).map(|inputs| inputs.map(|x| x as f32));
        out.extend(inputs.map(|inputs| Example { inputs, breath: is_breath, weight }));
    }
}

/// A network that knows nothing: it calls every frame as likely as not, and so never hears a breath.
pub fn untaught<const IN: usize, const FIRST: usize, const SECOND: usize>() -> Network<IN, FIRST, SECOND> {
    let weights = vec![0.0; Network::<IN, FIRST, SECOND>::PARAMETERS];
    Network { scale: [[0.0, 1.0]; IN], weights: weights.into() }
}

/// Trains a network for so many rounds over all examples; returns it with its mean loss. One that knows nothing begins
/// anew.
pub fn train<const IN: usize, const FIRST: usize, const SECOND: usize>(
    taught: &Network<IN, FIRST, SECOND>,
    examples: &[Example<IN>],
    rounds: usize,
    seed: u64,
) -> (Network<IN, FIRST, SECOND>, f64) {
    let mut random = Random::new(seed);
    let mut network = taught.clone();
    let new = network == untaught();
    let parameters = network.weights.len();
    let weights = network.weights.to_mut();
    if new {
        network.scale = scale(examples);
        // Each row starts at random, of a size that keeps its sum near 1 (Glorot and Bengio 2010).
        let (first, rest) = weights.split_at_mut(Network::<IN, FIRST, SECOND>::B);
        first.iter_mut().for_each(|w| *w = random.signed() * (6.0 / (IN + FIRST) as f64).sqrt());
        rest.iter_mut().for_each(|w| *w = random.signed() * (6.0 / (FIRST + SECOND) as f64).sqrt());
    }
    let longest = if new { RATE } else { REVISION * RATE };
    let mut order: Vec<u32> = (0..examples.len() as u32).collect();
    let (mut mean, mut square) = (vec![0.0; parameters], vec![0.0; parameters]);
    let mut gradient = vec![0.0; parameters];
    let (mut decay1, mut decay2) = (1.0, 1.0);
    let steps = (examples.len() / BATCH).max(1) * rounds;
    let (mut step, mut loss) = (0, 0.0);
    for _ in 0..rounds {
        for i in (1..order.len()).rev() {
            order.swap(i, (random.unit() * (i + 1) as f64) as usize);
        }
        loss = 0.0;
        let mut counted = 1e-9;
        for batch in order.chunks(BATCH) {
            gradient.fill(0.0);
            let mut weight = 0.0;
            for &i in batch {
                let example = &examples[i as usize];
                loss += descend(&network, example, &mut random, &mut gradient);
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

/// Adds one example's gradient; returns its loss.
fn descend<const IN: usize, const FIRST: usize, const SECOND: usize>(
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
    let bend = |s: f64| (1.0 - s.abs()) * (1.0 - s.abs());
    let mut d2 = [0.0; SECOND];
    for j in 0..SECOND {
        gradient[c + j] += slope * layers.second[j];
        d2[j] = slope * network.weights[c + j] * bend(layers.second[j]);
    }
    gradient[c + SECOND] += slope;
    let mut d1 = [0.0; FIRST];
    for i in 0..FIRST {
        let row = &network.weights[b + i * SECOND..][..SECOND];
        d1[i] = row.iter().zip(&d2).map(|(w, d)| w * d).sum::<f64>() * bend(layers.first[i]);
    }
    add_outer(&mut gradient[b..c], &layers.first, &d2);
    add_outer(&mut gradient[..b], &layers.input, &d1);
    let likely = if example.breath { p } else { 1.0 - p };
    -weight * soffio_math::ln(likely.max(1e-12))
}

/// Adds the outer product x dᵀ, and d for the row after it.
fn add_outer<const N: usize, const M: usize>(gradient: &mut [f64], x: &[f64; N], d: &[f64; M]) {
    for (row, x) in gradient.as_chunks_mut::<M>().0.iter_mut().zip(x.iter().chain(&[1.0])) {
        for (g, d) in row.iter_mut().zip(d) {
            *g += d * x;
        }
    }
}
