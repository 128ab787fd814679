//! From examples to a model, and the model as a file.

use std::collections::HashMap;

use safetensors::tensor::{Dtype, TensorView};
use soffio_detector::features::is_rising;
use soffio_detector::model::Model;
use soffio_math::StateHash;

use super::boosting::{Examples, Loss, grown};
use super::examples::Collection;

/// A model that is trained on examples, with `odds` trees for the log-odds and `speed` trees for the speed.
pub fn trained(examples: &Collection, odds: usize, speed: usize, seed: u64) -> Model {
    let count = examples.edges.len();
    let rising: Vec<bool> = (0..count).map(is_rising).collect();
    let odds = grown(&examples.breaths, &examples.edges, &rising, Loss::Logistic, odds, seed);
    let breaths: Vec<usize> = (0..examples.levels.len()).filter(|i| examples.breaths.targets[*i] > 0.5).collect();
    let slope = slope(breaths.iter().map(|i| (f64::from(examples.levels[*i]), f64::from(examples.log_air[*i]))));
    let rest = |i: &usize| examples.log_air[*i] - slope * examples.levels[*i];
    let speeds = Examples {
        columns: examples.breaths.columns.iter().map(|bins| breaths.iter().map(|i| bins[*i]).collect()).collect(),
        targets: breaths.iter().map(rest).collect(),
        weights: vec![1.0; breaths.len()],
    };
    let speed = grown(&speeds, &examples.edges, &vec![false; count], Loss::Squares, speed, seed);
    Model { odds, speed, slope }
}

/// Slope of the line of least squares through points.
fn slope(points: impl Iterator<Item = (f64, f64)> + Clone) -> f32 {
    let count = points.clone().count() as f64;
    let (x, y) = points.clone().fold((0.0, 0.0), |sum, point| (sum.0 + point.0 / count, sum.1 + point.1 / count));
    let (xy, xx) = points.fold((0.0, 0.0), |sum, p| (sum.0 + (p.0 - x) * (p.1 - y), sum.1 + (p.0 - x) * (p.0 - x)));
    (xy / xx) as f32
}

/// A safetensors file of the model, with facts about the training as its metadata.
///
/// # Errors
/// The format refuses the tensors.
pub fn written(model: &Model, facts: &[(&str, String)]) -> Result<Vec<u8>, String> {
    let bytes = |numbers: Vec<f32>| numbers.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let tensors: Vec<_> = model.tensors().into_iter().map(|(name, numbers)| (name, bytes(numbers))).collect();
    let views = tensors.iter().map(|(name, bytes)| {
        let view = TensorView::new(Dtype::F32, vec![bytes.len() / 4], bytes);
        view.map(|view| (name, view))
    });
    let views: Vec<_> = views.collect::<Result<_, _>>().map_err(|error| error.to_string())?;
    let facts: HashMap<String, String> = facts.iter().map(|(key, fact)| ((*key).to_owned(), fact.clone())).collect();
    safetensors::serialize(views, Some(facts)).map_err(|error| error.to_string())
}

/// One word that distinguishes two models.
pub fn hash(model: &Model) -> String {
    let mut hash = StateHash::default();
    model.tensors().iter().flat_map(|(_, numbers)| numbers).for_each(|x| hash.add(f64::from(*x)));
    format!("{:016x}", hash.0)
}
