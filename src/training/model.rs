//! Weights as a safetensors file, and their hash.

use std::collections::HashMap;

use safetensors::tensor::{Dtype, TensorView};
use soffio_detector::network::Network;
use soffio_math::StateHash;

/// A safetensors file of the weights, with facts about the training as its metadata.
///
/// # Errors
/// The format refuses the tensors.
pub fn written(network: &mut Network, facts: &[(&str, String)]) -> Result<Vec<u8>, String> {
    let tensors: Vec<(&str, Vec<u8>)> = network
        .tensors_mut()
        .into_iter()
        .map(|(name, weights)| (name, weights.iter().flat_map(|w| w.to_le_bytes()).collect()))
        .collect();
    let views = tensors.iter().map(|(name, bytes)| {
        let view = TensorView::new(Dtype::F32, vec![bytes.len() / 4], bytes);
        view.map(|view| (*name, view))
    });
    let views: Vec<_> = views.collect::<Result<_, _>>().map_err(|error| error.to_string())?;
    let facts: HashMap<String, String> = facts.iter().map(|(key, fact)| ((*key).to_owned(), fact.clone())).collect();
    safetensors::serialize(views, Some(facts)).map_err(|error| error.to_string())
}

/// One word that distinguishes two networks.
pub fn hash(network: &mut Network) -> String {
    let mut hash = StateHash::default();
    network.tensors_mut().iter().flat_map(|(_, weights)| weights.iter()).for_each(|w| hash.add(f64::from(*w)));
    format!("{:016x}", hash.0)
}
