//! The detector's model: a small recurrent network (gated recurrent unit, Cho et al., EMNLP 2014) with two outputs.
//!
//! ```text
//! x_i = clamp((f_i − m_i) / s_i, ±5)                               standardised inputs
//! r = σ(W_r x + U_r h + b_r)          z = σ(W_z x + U_z h + b_z)   gates
//! n = tanh(W_n x + b_n + r ∘ (U_n h + c_n))
//! h ← (1 − z) ∘ n + z ∘ h                                          state, once a frame
//! ℓ = w · h + w₀                                                   log-odds of breath, nats
//! v = a · softsign(A [h, y] + b) + a₀                              logarithm of the air's speed at the capsule
//! ```
//!
//! y are the levels of the bands, and they enter v alone: so gain changes the strength of a breath, never its detection.
//! Sums run column by column in f32, which the compiler vectorises without changing their order. The functions are those of
//! [`soffio_math`]. So the same weights give the same bits on any processor.
//!
//! The weights are an asset, `audio/models/breath.safetensors`, which `soffio-training train` writes.

use safetensors::SafeTensors;

use super::bands::BANDS;
use super::features::{COUNT, Inputs};
use soffio_math::exp;

/// Cells of the recurrent state.
pub const CELLS: usize = 64;
/// Inputs of the speed's layer: the state and the levels.
pub const SPEED_INPUTS: usize = CELLS + BANDS;
/// Cells of the speed's layer.
pub const SPEED_CELLS: usize = 12;
/// Limit of standardised inputs: values beyond those of the training count as the largest of those.
const INPUT_LIMIT: f32 = 5.0;
/// Gates r, z and n.
pub const GATES: usize = 3 * CELLS;

/// Recurrent state h.
pub type State = [f32; CELLS];

/// Weights. Matrices are stored column by column: one row here for each input.
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    /// Mean m and deviation s of each input.
    pub scale: [[f32; 2]; COUNT],
    /// W of r, z, n.
    pub input: Box<[[f32; GATES]; COUNT]>,
    /// U of r, z, n.
    pub recurrent: Box<[[f32; GATES]; CELLS]>,
    /// b_r, b_z, b_n.
    pub bias: [f32; GATES],
    /// c_n.
    pub recurrent_bias: [f32; CELLS],
    /// w.
    pub odds: [f32; CELLS],
    /// w₀.
    pub odds_bias: [f32; 1],
    /// A.
    pub speed: Box<[[f32; SPEED_CELLS]; SPEED_INPUTS]>,
    /// b.
    pub speed_bias: [f32; SPEED_CELLS],
    /// a.
    pub speed_out: [f32; SPEED_CELLS],
    /// a₀.
    pub speed_out_bias: [f32; 1],
}

/// Outputs for one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Output {
    /// ℓ, nats.
    pub log_odds: f64,
    /// v: natural logarithm of the speed at the capsule in m/s.
    pub log_speed: f64,
}

impl Network {
    /// Standardised inputs x.
    pub fn standardised(&self, inputs: &Inputs) -> Inputs {
        std::array::from_fn(|i| ((inputs[i] - self.scale[i][0]) / self.scale[i][1]).clamp(-INPUT_LIMIT, INPUT_LIMIT))
    }

    /// Advances the state by a frame. `levels` are those of the bands, dB of full scale.
    pub fn push(&self, state: &mut State, inputs: &Inputs, levels: &[f64; BANDS]) -> Output {
        let mut gates = self.bias;
        accumulate(&mut gates, &self.input[..], &self.standardised(inputs));
        let mut recurrent = [0.0; GATES];
        recurrent[2 * CELLS..].copy_from_slice(&self.recurrent_bias);
        accumulate(&mut recurrent, &self.recurrent[..], state);
        for (i, h) in state.iter_mut().enumerate() {
            let reset = sigmoid(gates[i] + recurrent[i]);
            let keep = sigmoid(gates[CELLS + i] + recurrent[CELLS + i]);
            let new = tanh(gates[2 * CELLS + i] + reset * recurrent[2 * CELLS + i]);
            *h = (1.0 - keep) * new + keep * *h;
        }
        let log_odds = self.odds_bias[0] + dot(&self.odds, state);
        let mut cells = self.speed_bias;
        accumulate(&mut cells, &self.speed[..CELLS], state);
        accumulate(&mut cells, &self.speed[CELLS..], &scaled(levels));
        let log_speed = self.speed_out_bias[0] + dot(&self.speed_out, &cells.map(|z| z / (1.0 + z.abs())));
        Output { log_odds: f64::from(log_odds), log_speed: f64::from(log_speed) }
    }

    /// A network whose weights are all 0.
    pub fn zeros() -> Self {
        Self {
            scale: [[0.0, 1.0]; COUNT],
            input: Box::new([[0.0; GATES]; COUNT]),
            recurrent: Box::new([[0.0; GATES]; CELLS]),
            bias: [0.0; GATES],
            recurrent_bias: [0.0; CELLS],
            odds: [0.0; CELLS],
            odds_bias: [0.0],
            speed: Box::new([[0.0; SPEED_CELLS]; SPEED_INPUTS]),
            speed_bias: [0.0; SPEED_CELLS],
            speed_out: [0.0; SPEED_CELLS],
            speed_out_bias: [0.0],
        }
    }

    /// Names of the tensors in a file, each with its numbers: first the scale, then all that is trained.
    pub fn tensors_mut(&mut self) -> [(&'static str, &mut [f32]); 11] {
        [
            ("scale", self.scale.as_flattened_mut()),
            ("input", self.input.as_flattened_mut()),
            ("recurrent", self.recurrent.as_flattened_mut()),
            ("bias", &mut self.bias),
            ("recurrent_bias", &mut self.recurrent_bias),
            ("odds", &mut self.odds),
            ("odds_bias", &mut self.odds_bias),
            ("speed", self.speed.as_flattened_mut()),
            ("speed_bias", &mut self.speed_bias),
            ("speed_out", &mut self.speed_out),
            ("speed_out_bias", &mut self.speed_out_bias),
        ]
    }

    /// Reads the weights of a safetensors file.
    ///
    /// # Errors
    /// Names the tensor that is missing or has another size.
    pub fn read(file: &[u8]) -> Result<Self, String> {
        let tensors = SafeTensors::deserialize(file).map_err(|error| format!("no safetensors: {error}"))?;
        let mut network = Self::zeros();
        for (name, weights) in network.tensors_mut() {
            let tensor = tensors.tensor(name).map_err(|error| format!("tensor \"{name}\": {error}"))?;
            let (numbers, rest) = tensor.data().as_chunks::<4>();
            if numbers.len() != weights.len() || !rest.is_empty() {
                return Err(format!("tensor \"{name}\" must have {} numbers of 32 bits", weights.len()));
            }
            for (weight, bytes) in weights.iter_mut().zip(numbers) {
                *weight = f32::from_le_bytes(*bytes);
                if !weight.is_finite() {
                    return Err(format!("tensor \"{name}\" has a number that is not finite"));
                }
            }
        }
        Ok(network)
    }
}

/// Levels as inputs: about −2.5 … 2.5.
pub fn scaled(levels: &[f64; BANDS]) -> [f32; BANDS] {
    levels.map(|db| (0.05 * (db + 50.0)) as f32)
}

/// Adds the weighted columns: sum += Σ_i x_i · column_i.
fn accumulate<const N: usize>(sum: &mut [f32; N], columns: &[[f32; N]], x: &[f32]) {
    for (column, x) in columns.iter().zip(x) {
        for (s, w) in sum.iter_mut().zip(column) {
            *s += w * x;
        }
    }
}

fn dot(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
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

    #[test]
    fn the_state_follows_its_equations() {
        /// Rounding of f32.
        const ROUNDING: f64 = 1e-6;
        let mut network = Network::zeros();
        network.scale[0] = [1.0, 2.0];
        network.input[0][2 * CELLS] = 0.5;
        network.bias[CELLS] = -1.0;
        network.recurrent[0][2 * CELLS] = 3.0;
        network.odds[0] = 2.0;
        network.odds_bias[0] = -0.25;
        let mut inputs = [0.0; COUNT];
        inputs[0] = 5.0;
        let mut state = [0.0; CELLS];
        let keep = 1.0 / (1.0 + exp(1.0));
        let mut expected = 0.0_f64;
        for _ in 0..3 {
            // x = (5 − 1)/2 = 2, r = ½.
            let new = (1.0 + 0.5 * 3.0 * expected).tanh();
            expected = (1.0 - keep) * new + keep * expected;
            let output = network.push(&mut state, &inputs, &[-50.0; BANDS]);
            assert!((output.log_odds - (2.0 * expected - 0.25)).abs() < ROUNDING, "{output:?}, state {expected}");
        }
    }

    #[test]
    fn gain_changes_the_speed_and_never_the_odds() {
        let network = crate::BlowSettings::default().network;
        let of = |level: f64| network.push(&mut [0.0; CELLS], &[0.5; COUNT], &[level; BANDS]);
        assert_eq!(of(-60.0).log_odds.to_bits(), of(-20.0).log_odds.to_bits());
        assert!(of(-20.0).log_speed > of(-60.0).log_speed);
    }

    #[test]
    fn a_file_that_is_no_model_is_refused_with_a_reason() {
        let file = crate::MODEL;
        assert!(Network::read(file).is_ok());
        assert!(Network::read(&file[..file.len() - 4]).is_err_and(|why| why.contains("no safetensors")));
        let header = String::from_utf8_lossy(&file[8..]).find("odds_bias").expect("a tensor") + 8;
        let mut renamed = file.to_vec();
        renamed[header] = b'x';
        assert!(Network::read(&renamed).is_err_and(|why| why.contains("tensor \"odds_bias\"")));
    }
}
