//! Network of the dual microphone: weighs the features of both spectra, the coherence and the high band together.
//!
//! Half the sum gives the features of one capsule, half the difference isolates wind (`dual_mic.rs`), and the coherence shows a
//! single near source (`coherence.rs`). None of them suffices alone: coherent hiss comes from lips or from an s, and uncorrelated
//! rumble is wind or a hand on the table. Their weights are trained, as those of the single-spectrum network are.

use super::coherence::Coherence;
use super::dual_mic::DualMic;
use super::features::{self, Features, power_to_db};
use super::high_band::{self, HighBand};
use super::model::Network;

/// Network of the dual microphone.
pub type DualMicModel = Network<COUNT, 32, 12>;

/// Coherence regions below 4 kHz.
pub(super) const REGIONS: usize = 3;
/// Inputs before those of the high band: log-odds and features of both spectra, δ, the sustained time, and for each region the
/// decorrelation and the coherent rise.
const LOW_SUBBAND_INPUTS: usize = 2 * (1 + features::COUNT) + 2 + 2 * REGIONS;
/// Number of inputs.
pub const COUNT: usize = LOW_SUBBAND_INPUTS + high_band::COUNT;

/// Inputs of one frame.
pub type Inputs = [f64; COUNT];

/// Inputs of a frame; `spectra` are log-odds and features of half the sum, then of half the difference.
pub(super) fn inputs(
    spectra: [(f64, &Features); 2],
    dual_mic: &DualMic,
    coherence: &Coherence<REGIONS>,
    high_band: &HighBand,
) -> Inputs {
    let mut all = [0.0; COUNT];
    let difference_ratio = 0.1 * power_to_db(dual_mic.difference_ratio.unwrap_or(1.0));
    let of_spectra =
        spectra.into_iter().flat_map(|(log_odds, features)| std::iter::once(0.1 * log_odds).chain(*features));
    let of_waves = coherence
        .decorrelation
        .iter()
        .map(|decorrelation| 0.1 * power_to_db(*decorrelation))
        .chain(coherence.rise_db.map(|rise| 0.1 * rise));
    let each = of_spectra.chain([difference_ratio, dual_mic.sustained()]).chain(of_waves).chain(high_band.inputs);
    all.iter_mut().zip(each).for_each(|(input, x)| *input = x);
    all
}

/// Name of an input.
pub fn name(input: usize) -> String {
    const SPECTRUM: usize = 1 + features::COUNT;
    const REST: [&str; 2 + 2 * REGIONS] = [
        "difference ratio, 10 dB",
        "sustained time of the difference",
        "decorrelation of 0.4 to 0.9 kHz, 10 dB",
        "decorrelation of 0.9 to 2 kHz",
        "decorrelation of 2 to 3.3 kHz",
        "coherent rise of 0.4 to 0.9 kHz, 10 dB",
        "coherent rise of 0.9 to 2 kHz",
        "coherent rise of 2 to 3.3 kHz",
    ];
    let of = if input < SPECTRUM { "sum" } else { "difference" };
    if let Some(input) = input.checked_sub(LOW_SUBBAND_INPUTS) {
        return format!("high band: {}", high_band::name(input));
    }
    match input.checked_sub(2 * SPECTRUM) {
        Some(rest) => REST[rest].to_owned(),
        None if input.is_multiple_of(SPECTRUM) => format!("{of}: log-odds, 10"),
        None => format!("{of}: {}", features::name(input % SPECTRUM - 1)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::coherence::LOW_SUBBAND;
    use super::*;
    use crate::model::Model;
    use crate::{BlowSettings, dual_mic_table, table};

    #[test]
    fn every_network_has_all_its_weights_and_every_input_its_name() {
        assert_eq!(table::TRAINED.weights.len(), Model::PARAMETERS);
        assert_eq!(dual_mic_table::TRAINED.weights.len(), DualMicModel::PARAMETERS);
        let names: Vec<String> = (0..COUNT).map(name).collect();
        assert_eq!(names[0], "sum: log-odds, 10");
        assert_eq!(names[1 + features::COUNT], "difference: log-odds, 10");
        assert!(names[2 * (1 + features::COUNT) - 1].ends_with("over 0.16 s, mean of 0.5 s"));
        assert!(names.iter().all(|name| !name.is_empty()));
    }

    #[test]
    fn a_sustained_difference_speaks_for_breath_and_coherent_sound_against_it() {
        let settings = BlowSettings::default();
        let log_odds = |difference_ratio: f64| {
            let mut dual_mic = DualMic::new();
            dual_mic.difference_ratio = Some(difference_ratio);
            (0..20).for_each(|_| dual_mic.track_puff(20.0, 0.0));
            // All inputs are at their training mean, except those of the difference.
            let mut inputs: Inputs = std::array::from_fn(|i| settings.dual_mic_model.scale[i][0]);
            let ends = self::inputs(
                [(0.0, &[0.0; features::COUNT]); 2],
                &dual_mic,
                &Coherence::new(LOW_SUBBAND),
                &HighBand::new(),
            );
            inputs[2 * (1 + features::COUNT)..][..2].copy_from_slice(&ends[2 * (1 + features::COUNT)..][..2]);
            settings.dual_mic_model.log_odds(&inputs)
        };
        assert!(log_odds(0.9) > log_odds(0.001), "{} of wind, {} of a wave", log_odds(0.9), log_odds(0.001));
    }
}
