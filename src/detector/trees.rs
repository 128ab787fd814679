//! The detector's model: sums of decision trees (gradient boosting, Friedman, Annals of Statistics 29, 2001).
//!
//! ```text
//! y(x) = y₀ + Σ_t leaf_t(x)
//! ```
//!
//! Each tree asks [`DEPTH`] questions "is x_f > θ?", each depending on the answers before, and adds a number. Questions lie as in a
//! heap: the root is 0, and those after question i are 2 i + 1 (no) and 2 i + 2 (yes). Sums run in the order of the trees, so the same
//! weights give the same bits on any processor.
//!
//! The weights are an asset, `audio/models/breath.safetensors`, which `soffio-training train` writes.

use safetensors::tensor::TensorView;
use safetensors::{Dtype, SafeTensors};

/// Questions from the root of a tree to a leaf.
pub const DEPTH: usize = 4;
/// Questions of a tree.
pub const SPLITS: usize = (1 << DEPTH) - 1;
/// Leaves of a tree.
pub const LEAVES: usize = 1 << DEPTH;

/// A tree: for each question the index of its input and its threshold, and the numbers of the leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree {
    /// Index f of the input of each question.
    pub inputs: [u16; SPLITS],
    /// Threshold θ of each question.
    pub thresholds: [f32; SPLITS],
    /// Number of each leaf; the first one answers every question by no.
    pub leaves: [f32; LEAVES],
}

impl Tree {
    /// The number of the leaf that `x` leads to.
    pub fn leaf(&self, x: &[f32]) -> f32 {
        let mut node = 0;
        while node < SPLITS {
            node = 2 * node + 1 + usize::from(x[usize::from(self.inputs[node])] > self.thresholds[node]);
        }
        self.leaves[node - SPLITS]
    }
}

/// A sum of trees.
#[derive(Clone, Debug, PartialEq)]
pub struct Trees {
    /// y₀.
    pub base: f32,
    /// Trees in the order of the sum.
    pub trees: Vec<Tree>,
}

impl Trees {
    /// y(x).
    pub fn sum(&self, x: &[f32]) -> f64 {
        f64::from(self.base) + self.trees.iter().map(|tree| f64::from(tree.leaf(x))).sum::<f64>()
    }

    /// Reads the trees `name` of a file, for `inputs` inputs.
    ///
    /// # Errors
    /// Names the tensor that is missing or wrong.
    pub fn read(file: &SafeTensors<'_>, name: &str, inputs: usize) -> Result<Self, String> {
        let base = numbers(file, &format!("{name}.base"))?;
        let indices = numbers(file, &format!("{name}.inputs"))?;
        let thresholds = numbers(file, &format!("{name}.thresholds"))?;
        let leaves = numbers(file, &format!("{name}.leaves"))?;
        let count = leaves.len() / LEAVES;
        let sizes = [base.len(), indices.len(), thresholds.len(), leaves.len()];
        if sizes != [1, count * SPLITS, count * SPLITS, count * LEAVES] {
            return Err(format!("the tensors of \"{name}\" have sizes {sizes:?}, which do not belong together"));
        }
        if let Some(wrong) = indices.iter().find(|i| **i < 0.0 || **i >= inputs as f32 || i.fract() != 0.0) {
            return Err(format!("tensor \"{name}.inputs\" names the input {wrong}; there are {inputs}"));
        }
        let tree = |t: usize| Tree {
            inputs: std::array::from_fn(|i| indices[t * SPLITS + i] as u16),
            thresholds: std::array::from_fn(|i| thresholds[t * SPLITS + i]),
            leaves: std::array::from_fn(|i| leaves[t * LEAVES + i]),
        };
        Ok(Self { base: base[0], trees: (0..count).map(tree).collect() })
    }

    /// Tensors of the trees `name`, as [`Trees::read`] wants them.
    pub fn tensors(&self, name: &str) -> Vec<(String, Vec<f32>)> {
        let of = |part: &str, numbers: Vec<f32>| (format!("{name}.{part}"), numbers);
        vec![
            of("base", vec![self.base]),
            of("inputs", self.trees.iter().flat_map(|tree| tree.inputs.map(f32::from)).collect()),
            of("thresholds", self.trees.iter().flat_map(|tree| tree.thresholds).collect()),
            of("leaves", self.trees.iter().flat_map(|tree| tree.leaves).collect()),
        ]
    }
}

/// Numbers of a tensor, all of them finite.
pub fn numbers(file: &SafeTensors<'_>, name: &str) -> Result<Vec<f32>, String> {
    let tensor: TensorView<'_> = file.tensor(name).map_err(|error| format!("tensor \"{name}\": {error}"))?;
    let numbers: Vec<f32> = tensor.data().as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    if tensor.dtype() != Dtype::F32 || numbers.iter().any(|x| !x.is_finite()) {
        return Err(format!("tensor \"{name}\" must hold finite numbers of 32 bits"));
    }
    Ok(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tree_answers_its_questions_in_turn() {
        // Input 1 decides the first question, input 0 all others, with thresholds that grow along the heap.
        let mut inputs = [0; SPLITS];
        inputs[0] = 1;
        let tree =
            Tree { inputs, thresholds: std::array::from_fn(|i| i as f32), leaves: std::array::from_fn(|i| i as f32) };
        let trees = Trees { base: 0.5, trees: vec![tree.clone(), tree] };
        assert_eq!(trees.sum(&[-1.0, 0.0]), 0.5, "no at every question");
        assert_eq!(trees.sum(&[100.0, 1.0]), 0.5 + 2.0 * 15.0, "yes at every question");
        // Yes; 5 > θ₂ = 2 yes; 5 > θ₆ = 6 no; 5 > θ₁₃ = 13 no: node 27, leaf 12.
        assert_eq!(trees.sum(&[5.0, 1.0]), 0.5 + 2.0 * 12.0);
    }
}
