//! Gradient of the network's loss over a run of frames: backpropagation through time (Werbos, Proc. IEEE 78, 1990).
//!
//! Symbols are those of [`soffio_detector::network`]; ŷ is the target, w its weight, U the air's speed.
//!
//! ```text
//! loss = Σ_t w [ln(1 + e^ℓ) − ŷ ℓ]  +  κ Σ_{breath} (v − ln U)²
//! δn = δh ∘ (1 − z) ∘ (1 − n²)     δz = δh ∘ (h′ − n) ∘ z ∘ (1 − z)     δr = δn ∘ (U_n h′ + c_n) ∘ r ∘ (1 − r)
//! δh′ = δh ∘ z + U_rᵀ δr + U_zᵀ δz + U_nᵀ (r ∘ δn)
//! ```

use soffio_detector::bands::BANDS;
use soffio_detector::features::Inputs;
use soffio_detector::network::{CELLS, GATES, Network, SPEED_CELLS, State, scaled};
use soffio_math::{exp, ln};

/// κ: weight of the speed's error against that of the log-odds. A tenth leaves the state to the detection.
const SPEED_WEIGHT: f64 = 0.1;

/// Frames whose outer products are summed together.
const FRAMES_AT_ONCE: usize = 8;

/// One frame of training.
#[derive(Clone, Copy, Debug)]
pub struct Example {
    /// Inputs f.
    pub inputs: Inputs,
    /// Levels of the bands, dB of full scale.
    pub levels: [f32; BANDS],
    /// ŷ: 1 breath, 0 none.
    pub target: f32,
    /// w; 0 where nobody knows.
    pub weight: f32,
    /// ln U of the air at the capsule, U in m/s; used where the target is 1.
    pub log_air: f32,
    /// The recurrent state starts at 0 before this frame.
    pub first: bool,
}

/// What the backward pass needs of one frame.
#[derive(Clone)]
struct Trace {
    input: Inputs,
    before: State,
    reset: State,
    keep: State,
    new: State,
    recurrent_new: State,
    state_error: State,
    /// Errors of the gates, and of their recurrent parts.
    gates: [f32; GATES],
    recurrent: [f32; GATES],
}

/// Loss over a run of frames, which continues from `state`; adds the gradient to `sum`, a network of gradients.
pub fn add_gradient(network: &Network, state: &mut State, run: &[Example], sum: &mut Network) -> f64 {
    let mut traces = Vec::with_capacity(run.len());
    let mut loss = 0.0;
    for example in run {
        if example.first {
            *state = [0.0; CELLS];
        }
        let (trace, part) = forward(network, state, example, sum);
        traces.push(trace);
        loss += part;
    }
    let mut later = [0.0; CELLS];
    for (trace, example) in traces.iter_mut().zip(run).rev() {
        later = backward(network, trace, &later);
        if example.first {
            later = [0.0; CELLS];
        }
    }
    // The outer products of several frames at once: the weights pass through the processor's cache once for all of them.
    for few in traces.chunks(FRAMES_AT_ONCE) {
        for trace in few {
            add_scaled(&mut sum.bias, &trace.gates, 1.0);
            sum.recurrent_bias.iter_mut().zip(&trace.recurrent[2 * CELLS..]).for_each(|(sum, error)| *sum += error);
        }
        for (i, column) in sum.input.iter_mut().enumerate() {
            few.iter().for_each(|trace| add_scaled(column, &trace.gates, trace.input[i]));
        }
        for (i, column) in sum.recurrent.iter_mut().enumerate() {
            few.iter().for_each(|trace| add_scaled(column, &trace.recurrent, trace.before[i]));
        }
    }
    loss
}

/// One frame forward: adds the gradients of both outputs, and returns what the backward pass needs, and the loss.
fn forward(network: &Network, state: &mut State, example: &Example, sum: &mut Network) -> (Trace, f64) {
    let input = network.standardised(&example.inputs);
    let before = *state;
    let mut gates = network.bias;
    accumulate(&mut gates, &network.input[..], &input);
    let mut recurrent = [0.0; GATES];
    recurrent[2 * CELLS..].copy_from_slice(&network.recurrent_bias);
    accumulate(&mut recurrent, &network.recurrent[..], &before);
    let reset: State = std::array::from_fn(|i| sigmoid(gates[i] + recurrent[i]));
    let keep: State = std::array::from_fn(|i| sigmoid(gates[CELLS + i] + recurrent[CELLS + i]));
    let recurrent_new: State = std::array::from_fn(|i| recurrent[2 * CELLS + i]);
    let new: State = std::array::from_fn(|i| tanh(gates[2 * CELLS + i] + reset[i] * recurrent_new[i]));
    *state = std::array::from_fn(|i| (1.0 - keep[i]) * new[i] + keep[i] * before[i]);

    let mut state_error = [0.0; CELLS];
    let mut loss = 0.0;
    if example.weight > 0.0 {
        let log_odds = network.odds_bias[0] + dot(&network.odds, state);
        let error = example.weight * (sigmoid(log_odds) - example.target);
        let odds = f64::from(log_odds);
        let softplus = odds.max(0.0) + ln(1.0 + exp(-odds.abs()));
        loss += f64::from(example.weight) * (softplus - f64::from(example.target) * odds);
        sum.odds_bias[0] += error;
        for i in 0..CELLS {
            sum.odds[i] += error * state[i];
            state_error[i] += error * network.odds[i];
        }
    }
    if example.weight > 0.0 && example.target > 0.0 {
        loss += add_speed_gradient(network, state, example, sum, &mut state_error);
    }
    let (gates, recurrent) = ([0.0; GATES], [0.0; GATES]);
    (Trace { input, before, reset, keep, new, recurrent_new, state_error, gates, recurrent }, loss)
}

/// Adds the gradient of the speed's error; returns the loss.
fn add_speed_gradient(
    network: &Network,
    state: &State,
    example: &Example,
    sum: &mut Network,
    state_error: &mut State,
) -> f64 {
    let levels = scaled(&example.levels.map(f64::from));
    let mut cells = network.speed_bias;
    accumulate(&mut cells, &network.speed[..CELLS], state);
    accumulate(&mut cells, &network.speed[CELLS..], &levels);
    let active = cells.map(|z| z / (1.0 + z.abs()));
    let error = network.speed_out_bias[0] + dot(&network.speed_out, &active) - example.log_air;
    let slope = 2.0 * SPEED_WEIGHT as f32 * error;
    sum.speed_out_bias[0] += slope;
    let mut cell_error = [0.0; SPEED_CELLS];
    for i in 0..SPEED_CELLS {
        sum.speed_out[i] += slope * active[i];
        let derivative = 1.0 / ((1.0 + cells[i].abs()) * (1.0 + cells[i].abs()));
        cell_error[i] = slope * network.speed_out[i] * derivative;
        sum.speed_bias[i] += cell_error[i];
    }
    for (column, x) in sum.speed.iter_mut().zip(state.iter().chain(&levels)) {
        add_scaled(column, &cell_error, *x);
    }
    for (e, column) in state_error.iter_mut().zip(&network.speed[..CELLS]) {
        *e += dot(column, &cell_error);
    }
    SPEED_WEIGHT * f64::from(error) * f64::from(error)
}

/// One frame backward: finds the errors of the gates, and returns the error of the state before the frame.
fn backward(network: &Network, trace: &mut Trace, later: &State) -> State {
    let mut earlier = [0.0; CELLS];
    for i in 0..CELLS {
        let error = later[i] + trace.state_error[i];
        let (reset, keep, new) = (trace.reset[i], trace.keep[i], trace.new[i]);
        let new_error = error * (1.0 - keep) * (1.0 - new * new);
        trace.gates[i] = new_error * trace.recurrent_new[i] * reset * (1.0 - reset);
        trace.gates[CELLS + i] = error * (trace.before[i] - new) * keep * (1.0 - keep);
        trace.gates[2 * CELLS + i] = new_error;
        trace.recurrent[2 * CELLS + i] = new_error * reset;
        earlier[i] = error * keep;
    }
    trace.recurrent[..2 * CELLS].copy_from_slice(&trace.gates[..2 * CELLS]);
    for (weights, e) in network.recurrent.iter().zip(&mut earlier) {
        *e += dot_lanes(weights, &trace.recurrent);
    }
    earlier
}

fn accumulate<const N: usize>(sum: &mut [f32; N], columns: &[[f32; N]], x: &[f32]) {
    let ((fours, rest), (xs, rest_x)) = (columns.as_chunks::<4>(), x.as_chunks::<4>());
    for ([a, b, c, d], [x, y, z, w]) in fours.iter().zip(xs) {
        for i in 0..N {
            sum[i] = sum[i] + a[i] * x + b[i] * y + c[i] * z + d[i] * w;
        }
    }
    for (column, x) in rest.iter().zip(rest_x) {
        add_scaled(sum, column, *x);
    }
}

fn add_scaled<const N: usize>(sum: &mut [f32; N], column: &[f32; N], x: f32) {
    for (s, w) in sum.iter_mut().zip(column) {
        *s += w * x;
    }
}

fn dot(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A dot product in eight sums side by side, which the compiler vectorises.
fn dot_lanes<const N: usize>(a: &[f32; N], b: &[f32; N]) -> f32 {
    let mut sums = [0.0_f32; 8];
    let ((a, rest_a), (b, rest_b)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    for (a, b) in a.iter().zip(b) {
        for i in 0..8 {
            sums[i] += a[i] * b[i];
        }
    }
    sums.iter().sum::<f32>() + dot(rest_a, rest_b)
}

fn sigmoid(z: f32) -> f32 {
    (1.0 / (1.0 + exp(f64::from(-z)))) as f32
}

fn tanh(z: f32) -> f32 {
    (1.0 - 2.0 / (1.0 + exp(f64::from(2.0 * z)))) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::noise::Random;

    #[test]
    fn the_gradient_is_the_slope_of_the_loss() {
        /// Step of the central difference, and its largest error relative to the largest slope: f32 has seven digits.
        const STEP: f32 = 1e-2;
        const ERROR: f64 = 2e-2;
        let mut random = Random::new(3);
        let mut network = Network::zeros();
        for (_, weights) in network.tensors_mut().into_iter().skip(1) {
            weights.iter_mut().for_each(|w| *w = 0.3 * random.signed() as f32);
        }
        let run: Vec<Example> = (0..12)
            .map(|t| Example {
                inputs: std::array::from_fn(|_| random.signed() as f32),
                levels: std::array::from_fn(|_| random.range(-70.0, -30.0) as f32),
                target: f32::from(u8::from(t % 3 == 0)),
                weight: 1.0,
                log_air: random.signed() as f32,
                first: t == 5,
            })
            .collect();
        let loss = |network: &Network| {
            let mut state = [0.1; CELLS];
            add_gradient(network, &mut state, &run, &mut Network::zeros())
        };
        let mut gradient = Network::zeros();
        add_gradient(&network, &mut [0.1; CELLS], &run, &mut gradient);
        let tensors = gradient.tensors_mut().map(|(name, numbers)| (name, numbers.to_vec()));
        for (tensor, (name, slopes)) in tensors.iter().enumerate().skip(1) {
            let largest = slopes.iter().fold(0.0_f64, |m, g| m.max(f64::from(g.abs())));
            for i in (0..slopes.len()).step_by(1 + slopes.len() / 9) {
                let mut moved = |by: f32| {
                    network.tensors_mut()[tensor].1[i] += by;
                    let loss = loss(&network);
                    network.tensors_mut()[tensor].1[i] -= by;
                    loss
                };
                let slope = (moved(STEP) - moved(-STEP)) / f64::from(2.0 * STEP);
                let error = (slope - f64::from(slopes[i])).abs() / largest;
                assert!(error < ERROR, "{name}[{i}]: {} by the gradient, {slope} by differences", slopes[i]);
            }
        }
    }
}
