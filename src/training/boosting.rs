//! Gradient boosting: each tree corrects the sum of those before it.
//!
//! For examples i with target t, weight w and present sum y, the loss has the gradient g = w ∂L/∂y and the curvature h = w ∂²L/∂y².
//! A node with sums G and H takes the value v = −G/(H + λ), and gains ½ G²/(H + λ) (Chen and Guestrin, "XGBoost", KDD 2016).
//! A split is the question with the greatest sum of both sides' gains. Inputs are sorted into [`BINS`] bins of equal numbers of examples
//! before, so a node's best question comes from one histogram per input.
//!
//! ```text
//! logistic  L = ln(1 + e^y) − t y:   g = w (σ(y) − t),   h = w σ(y) (1 − σ(y))
//! squares   L = ½ (y − t)²:          g = w (y − t),      h = w
//! ```
//!
//! Each tree sees a random part of the examples. Some inputs are *rising*: a larger value never lowers y. There the left value may not
//! exceed the right one, and the middle of both bounds whatever grows below. Each input's sums run in the order of the examples, so the
//! bits do not depend on the number of threads.

use soffio_detector::trees::{DEPTH, LEAVES, SPLITS, Tree, Trees};
use soffio_math::noise::Random;
use soffio_math::{exp, ln};

use super::parallel::parallel;

/// Bins of an input.
pub const BINS: usize = 64;
/// λ: keeps the value of a node with few examples small.
const SHRINK: f64 = 1.0;
/// Share of a tree's values that is added: later trees mend what it misjudges.
const RATE: f64 = 0.1;
/// Least curvature on each side of a split: that of 200 undecided examples.
const LEAST_CURVATURE: f64 = 50.0;
/// Share of the examples that a tree sees.
const SEEN: f64 = 0.3;

/// What is minimised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loss {
    /// The sum is a logarithm of odds, and targets are 0 or 1.
    Logistic,
    /// The sum estimates the target.
    Squares,
}

/// Examples, their inputs sorted into bins.
#[derive(Clone, Debug, Default)]
pub struct Examples {
    /// Bin of each input of each example; one column per input.
    pub columns: Vec<Vec<u8>>,
    /// t.
    pub targets: Vec<f32>,
    /// w.
    pub weights: Vec<f32>,
}

/// Sums of a node, or of a bin of it.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    g: f64,
    h: f64,
}

impl Sums {
    fn value(self, (least, most): (f64, f64)) -> f64 {
        (-self.g / (self.h + SHRINK)).clamp(least, most)
    }

    /// Gain of a value v: −G v − ½ (H + λ) v².
    fn gain(self, v: f64) -> f64 {
        -self.g * v - 0.5 * (self.h + SHRINK) * v * v
    }
}

/// A question, and what it gains.
#[derive(Clone, Copy, Debug)]
struct Split {
    gain: f64,
    input: usize,
    /// Bins up to this one answer no.
    bin: usize,
    /// Values of both sides.
    values: (f64, f64),
}

/// Upper edges of the bins of one input, from a sample of its values. The last bin has none.
pub fn edges(mut sample: Vec<f32>) -> Vec<f32> {
    sample.sort_by(f32::total_cmp);
    let mut edges: Vec<f32> = (1..BINS).map(|bin| sample[bin * sample.len() / BINS]).collect();
    edges.dedup();
    edges
}

/// Bin of a value: the number of edges below it.
pub fn bin(edges: &[f32], x: f32) -> u8 {
    edges.partition_point(|edge| *edge < x) as u8
}

/// Grows `count` trees. `edges` are those of each input; `rising` says which inputs never lower the sum.
pub fn grown(examples: &Examples, edges: &[Vec<f32>], rising: &[bool], loss: Loss, count: usize, seed: u64) -> Trees {
    let length = examples.targets.len();
    let total: f64 = examples.weights.iter().map(|w| f64::from(*w)).sum();
    let mean = examples.targets.iter().zip(&examples.weights).map(|(t, w)| f64::from(t * w)).sum::<f64>() / total;
    let base = match loss {
        Loss::Logistic => ln(mean / (1.0 - mean)) as f32,
        Loss::Squares => mean as f32,
    };
    let mut sums = vec![base; length];
    let mut random = Random::new(seed);
    let mut trees = Trees { base, trees: Vec::with_capacity(count) };
    for _ in 0..count {
        let slopes: Vec<[f32; 2]> = (0..length)
            .map(|i| {
                let (t, w, y) = (examples.targets[i], examples.weights[i], sums[i]);
                if random.unit() >= SEEN {
                    return [0.0; 2];
                }
                match loss {
                    Loss::Squares => [w * (y - t), w],
                    Loss::Logistic => {
                        let p = (1.0 / (1.0 + exp(f64::from(-y)))) as f32;
                        [w * (p - t), w * p * (1.0 - p)]
                    }
                }
            })
            .collect();
        let (tree, nodes) = tree(examples, edges, rising, &slopes);
        sums.iter_mut().zip(nodes).for_each(|(y, leaf)| *y += tree.leaves[usize::from(leaf)]);
        trees.trees.push(tree);
    }
    trees
}

/// One tree, and the leaf of each example. `slopes` are g and h of the examples that it sees.
fn tree(examples: &Examples, edges: &[Vec<f32>], rising: &[bool], slopes: &[[f32; 2]]) -> (Tree, Vec<u8>) {
    let seen: Vec<u32> = (0..slopes.len() as u32).filter(|i| slopes[*i as usize][1] > 0.0).collect();
    let mut nodes = vec![0_u8; slopes.len()];
    let mut tree = Tree { inputs: [0; SPLITS], thresholds: [f32::MAX; SPLITS], leaves: [0.0; LEAVES] };
    // Bounds and value of each node of the present level.
    let mut bounds = vec![(f64::NEG_INFINITY, f64::INFINITY)];
    let mut values = vec![0.0];
    for level in 0..DEPTH {
        let first = (1 << level) - 1;
        let best = parallel(examples.columns.len(), |input| {
            let mut bins = vec![[Sums::default(); BINS]; 1 << level];
            let column = &examples.columns[input];
            for i in &seen {
                let i = *i as usize;
                let sums = &mut bins[usize::from(nodes[i])][usize::from(column[i])];
                sums.g += f64::from(slopes[i][0]);
                sums.h += f64::from(slopes[i][1]);
            }
            let best = |(bins, bounds): (&[Sums; BINS], &(f64, f64))| best_split(bins, *bounds, input, rising[input]);
            bins.iter().zip(&bounds).map(best).collect::<Vec<_>>()
        });
        let mut next = Vec::with_capacity(2 << level);
        let mut next_values = Vec::with_capacity(2 << level);
        let mut bin_of = vec![(0, usize::MAX); 1 << level];
        for node in 0..1 << level {
            let split =
                best.iter().filter_map(|splits| splits[node]).reduce(|a, b| if b.gain > a.gain { b } else { a });
            let (least, most) = bounds[node];
            let Some(split) = split else {
                // All answers are no.
                next.extend([(least, most); 2]);
                next_values.extend([values[node]; 2]);
                continue;
            };
            tree.inputs[first + node] = split.input as u16;
            tree.thresholds[first + node] = edges[split.input][split.bin];
            bin_of[node] = (split.input, split.bin);
            let middle = 0.5 * (split.values.0 + split.values.1);
            let (left, right) =
                if rising[split.input] { ((least, middle), (middle, most)) } else { ((least, most), (least, most)) };
            next.extend([left, right]);
            next_values.extend([split.values.0, split.values.1]);
        }
        for (i, node) in nodes.iter_mut().enumerate() {
            let (input, bin) = bin_of[usize::from(*node)];
            *node = 2 * *node + u8::from(usize::from(examples.columns[input][i]) > bin);
        }
        (bounds, values) = (next, next_values);
    }
    tree.leaves = std::array::from_fn(|leaf| (RATE * values[leaf]) as f32);
    (tree, nodes)
}

/// The best question about one input in a node.
fn best_split(bins: &[Sums; BINS], bounds: (f64, f64), input: usize, rising: bool) -> Option<Split> {
    let total = bins.iter().fold(Sums::default(), |a, b| Sums { g: a.g + b.g, h: a.h + b.h });
    let alone = total.gain(total.value(bounds));
    let (mut left, mut best) = (Sums::default(), None::<Split>);
    for (bin, sums) in bins[..BINS - 1].iter().enumerate() {
        left = Sums { g: left.g + sums.g, h: left.h + sums.h };
        let right = Sums { g: total.g - left.g, h: total.h - left.h };
        if left.h < LEAST_CURVATURE || right.h < LEAST_CURVATURE {
            continue;
        }
        let values = (left.value(bounds), right.value(bounds));
        let gain = left.gain(values.0) + right.gain(values.1) - alone;
        if (!rising || values.0 <= values.1) && gain > best.map_or(0.0, |best| best.gain) {
            best = Some(Split { gain, input, bin, values });
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two inputs of even scatter, binned, with targets from them.
    fn examples(target: impl Fn(f32, f32) -> f32) -> (Examples, Vec<Vec<f32>>, Vec<[f32; 2]>) {
        let mut random = Random::new(3);
        let points: Vec<[f32; 2]> = (0..60_000).map(|_| [random.unit() as f32, random.unit() as f32]).collect();
        let edges: Vec<Vec<f32>> = (0..2).map(|k| edges(points.iter().map(|p| p[k]).collect())).collect();
        let column = |k: usize| points.iter().map(|p| bin(&edges[k], p[k])).collect();
        let examples = Examples {
            columns: (0..2).map(column).collect(),
            targets: points.iter().map(|p| target(p[0], p[1])).collect(),
            weights: vec![1.0; points.len()],
        };
        (examples, edges, points)
    }

    #[test]
    fn trees_learn_a_function_of_two_inputs() {
        /// Trees are steps: what 60 of them leave of a deviation of 0.22.
        const LEFT: f64 = 0.03;
        let (examples, edges, points) = examples(|a, b| a * b);
        let trees = grown(&examples, &edges, &[false; 2], Loss::Squares, 60, 1);
        let error = |p: &[f32; 2]| trees.sum(p) - f64::from(p[0] * p[1]);
        let error = (points.iter().map(|p| error(p) * error(p)).sum::<f64>() / points.len() as f64).sqrt();
        assert!(error < LEFT, "{error}");
    }

    #[test]
    fn odds_follow_the_share_of_ones_and_a_rising_input_never_lowers_them() {
        // Half of the right side are ones, none on the left; large values of the second input lower the share.
        let mut random = Random::new(4);
        let ones: Vec<f64> = (0..60_000).map(|_| random.unit()).collect();
        let next = std::cell::Cell::new(0);
        let (examples, edges, points) = examples(|a, b| {
            let i = next.replace(next.get() + 1);
            f32::from(u8::from(a > 0.5 && ones[i] < 0.6 - 0.2 * f64::from(b)))
        });
        let free = grown(&examples, &edges, &[false; 2], Loss::Logistic, 80, 1);
        let p = |y: f64| 1.0 / (1.0 + exp(-y));
        let (right, left) = (p(free.sum(&[0.75, 0.1])), p(free.sum(&[0.25, 0.5])));
        assert!((right - 0.58).abs() < 0.06 && left < 0.01, "{right}, {left}");
        assert!(free.sum(&[0.75, 0.95]) < free.sum(&[0.75, 0.05]));
        let rising = grown(&examples, &edges, &[false, true], Loss::Logistic, 80, 1);
        for [a, _] in &points[..200] {
            let y: Vec<f64> = (0..50).map(|k| rising.sum(&[*a, k as f32 / 50.0])).collect();
            assert!(y.is_sorted(), "{a}: {y:?}");
        }
    }
}
