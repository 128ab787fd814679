//! Training by stochastic gradient descent with Adam (Kingma and Ba, ICLR 2015), the same bits on any number of processors.
//!
//! Scenes are laid end to end on [`LANES`] lanes, in an order that each epoch shuffles. A step takes the next second of every lane,
//! carries the recurrent state on, and ends the backpropagation there. Lanes are summed in pairs of a fixed order, so the number of threads does not
//! matter.

use super::gradient::{Example, add_gradient};
use super::parallel::parallel;
use soffio_detector::features::COUNT;
use soffio_detector::network::{CELLS, Network, State};
use soffio_math::noise::{Random, hash_words};
use soffio_math::{PI, cos, pow};

/// Scenes side by side.
const LANES: usize = 32;
/// Lanes that one task sums.
const LANES_PER_TASK: usize = 8;
/// Frames of a step: one second.
const RUN: usize = 125;
/// Largest rate of learning, at the start; it falls to 0 with half a cosine (Loshchilov and Hutter, ICLR 2017).
const RATE: f64 = 3e-3;
/// Steps in which the rate rises from 0.
const WARM_UP: f64 = 200.0;
/// Adam's forgetting factors of the mean and of the square of the gradient, as in its paper, and the term that keeps it finite.
const FORGETTING: [f64; 2] = [0.9, 0.999];
const EPSILON: f32 = 1e-8;
/// Largest norm of a step's gradient: longer ones are shortened (Pascanu, Mikolov and Bengio, ICML 2013).
const LONGEST: f64 = 1.0;
/// Deviation of the first weights relative to 1/√inputs.
const FIRST_WEIGHTS: f64 = 0.7;

/// A network with random weights, scaled to the examples.
pub fn initial(scenes: &[Vec<Example>], seed: u64) -> Network {
    let mut network = Network::zeros();
    let mut random = Random::new(hash_words(&[seed, 1]));
    for (name, weights) in network.tensors_mut() {
        let inputs = match name {
            "input" => COUNT,
            "recurrent" | "odds" | "speed" => CELLS,
            "speed_out" => soffio_detector::network::SPEED_CELLS,
            _ => continue,
        };
        let scale = FIRST_WEIGHTS * (3.0 / inputs as f64).sqrt();
        weights.iter_mut().for_each(|w| *w = (scale * random.signed()) as f32);
    }
    let mut count = 0.0;
    let (mut sum, mut square) = ([0.0; COUNT], [0.0; COUNT]);
    for example in scenes.iter().flatten().step_by(7) {
        count += 1.0;
        for ((s, q), x) in sum.iter_mut().zip(&mut square).zip(example.inputs.map(f64::from)) {
            *s += x;
            *q += x * x;
        }
    }
    for ((scale, sum), square) in network.scale.iter_mut().zip(sum).zip(square) {
        let mean = sum / f64::max(count, 1.0);
        let variance = square / f64::max(count, 1.0) - mean * mean;
        *scale = [mean as f32, variance.max(1e-4).sqrt() as f32];
    }
    network
}

/// Trains a network; `report` is called after each epoch with its number and the mean loss.
pub fn train(network: &mut Network, scenes: &[Vec<Example>], epochs: usize, seed: u64, mut report: impl FnMut(usize, f64, &Network)) {
    let frames: usize = scenes.iter().map(Vec::len).sum();
    let steps = epochs * frames.div_ceil(LANES * RUN);
    let mut adam = Adam::new(steps);
    for epoch in 0..epochs {
        let lanes = lanes(scenes, hash_words(&[seed, 2, epoch as u64]));
        let longest = lanes.iter().map(|lane| lane.iter().map(|s| s.len()).sum::<usize>()).max().unwrap_or(0);
        let mut cursors: Vec<Cursor> = lanes.iter().map(|lane| Cursor { scenes: lane, at: (0, 0), state: [0.0; CELLS] }).collect();
        let (mut loss, mut counted) = (0.0, 0.0);
        for _ in 0..longest.div_ceil(RUN) {
            let tasks: Vec<std::sync::Mutex<&mut [Cursor]>> =
                cursors.chunks_mut(LANES_PER_TASK).map(std::sync::Mutex::new).collect();
            let current = &*network;
            let sums = parallel(tasks.len(), |task| {
                let mut sum = Network::zeros();
                let (mut loss, mut weight) = (0.0, 0.0);
                if let Ok(mut cursors) = tasks[task].lock() {
                    for cursor in cursors.iter_mut() {
                        let run = cursor.next_run();
                        weight += run.iter().map(|e| f64::from(e.weight)).sum::<f64>();
                        loss += add_gradient(current, &mut cursor.state, &run, &mut sum);
                    }
                }
                (sum, loss, weight)
            });
            let mut total = Network::zeros();
            let mut weight = 0.0;
            for (mut part, part_loss, part_weight) in sums {
                loss += part_loss;
                weight += part_weight;
                for ((_, sum), (_, part)) in total.tensors_mut().into_iter().zip(part.tensors_mut()) {
                    sum.iter_mut().zip(part).for_each(|(s, p)| *s += *p);
                }
            }
            counted += weight;
            adam.step(network, &mut total, weight.max(1.0));
        }
        report(epoch, loss / f64::max(counted, 1.0), network);
    }
}

/// Mean loss of a network over scenes.
pub fn loss(network: &Network, scenes: &[Vec<Example>]) -> f64 {
    let parts = parallel(scenes.len(), |i| {
        let weight: f64 = scenes[i].iter().map(|e| f64::from(e.weight)).sum();
        (add_gradient(network, &mut [0.0; CELLS], &scenes[i], &mut Network::zeros()), weight)
    });
    let (loss, weight) = parts.into_iter().fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
    loss / f64::max(weight, 1.0)
}

/// Scenes in a shuffled order, dealt to the lanes: each goes to the shortest.
fn lanes(scenes: &[Vec<Example>], seed: u64) -> Vec<Vec<&[Example]>> {
    let mut order: Vec<usize> = (0..scenes.len()).collect();
    let mut random = Random::new(seed);
    for i in (1..order.len()).rev() {
        order.swap(i, (random.unit() * (i + 1) as f64) as usize);
    }
    let mut lanes = vec![Vec::new(); LANES];
    let mut lengths = [0; LANES];
    for scene in order {
        let shortest = (0..LANES).min_by_key(|lane| lengths[*lane]).unwrap_or(0);
        lanes[shortest].push(scenes[scene].as_slice());
        lengths[shortest] += scenes[scene].len();
    }
    lanes
}

/// Position in a lane.
struct Cursor<'a> {
    scenes: &'a [&'a [Example]],
    /// Scene, and frame in it.
    at: (usize, usize),
    state: State,
}

impl Cursor<'_> {
    /// The next frames, [`RUN`] at most.
    fn next_run(&mut self) -> Vec<Example> {
        let mut run = Vec::with_capacity(RUN);
        while run.len() < RUN && self.at.0 < self.scenes.len() {
            let scene = self.scenes[self.at.0];
            let until = scene.len().min(self.at.1 + RUN - run.len());
            run.extend_from_slice(&scene[self.at.1..until]);
            self.at = if until == scene.len() { (self.at.0 + 1, 0) } else { (self.at.0, until) };
        }
        run
    }
}

/// State of Adam.
struct Adam {
    mean: Network,
    square: Network,
    done: f64,
    steps: f64,
}

impl Adam {
    fn new(steps: usize) -> Self {
        let zeros = || {
            let mut zeros = Network::zeros();
            zeros.scale.as_flattened_mut().fill(0.0);
            zeros
        };
        Self { mean: zeros(), square: zeros(), done: 0.0, steps: steps.max(1) as f64 }
    }

    /// Moves the weights against the gradient, which is divided by the number of frames. The scale of the inputs stays.
    fn step(&mut self, network: &mut Network, gradient: &mut Network, frames: f64) {
        self.done += 1.0;
        let gradient: Vec<&mut [f32]> = gradient.tensors_mut().into_iter().skip(1).map(|(_, g)| g).collect();
        let square: f64 = gradient.iter().flat_map(|g| g.iter()).map(|g| f64::from(*g) * f64::from(*g)).sum();
        let norm = square.sqrt() / frames;
        let shortened = (1.0 / frames) * (LONGEST / norm.max(LONGEST));
        let phase = (self.done / self.steps).min(1.0);
        let rate = RATE * (self.done / WARM_UP).min(1.0) * 0.5 * (1.0 + cos(PI * phase));
        let [mean_left, square_left] = FORGETTING.map(|f| 1.0 - pow(f, self.done));
        let (rate, root) = ((rate / mean_left) as f32, (1.0 / square_left) as f32);
        let [keep_mean, keep_square] = FORGETTING.map(|f| f as f32);
        let weights = network.tensors_mut().into_iter().skip(1);
        let moments = self.mean.tensors_mut().into_iter().zip(self.square.tensors_mut()).skip(1);
        for (((_, weights), ((_, means), (_, squares))), gradient) in weights.zip(moments).zip(gradient) {
            for (((w, m), s), g) in weights.iter_mut().zip(means).zip(squares).zip(gradient.iter()) {
                let g = g * shortened as f32;
                *m = keep_mean * *m + (1.0 - keep_mean) * g;
                *s = keep_square * *s + (1.0 - keep_square) * g * g;
                *w -= rate * *m / ((*s * root).sqrt() + EPSILON);
            }
        }
    }
}
