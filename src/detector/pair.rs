//! What two capsules make of a frame: one network over both spectra, and over what is the same at both.
//!
//! The spectrum of half the sum says what one capsule would say, that of half the difference what of it is wind
//! (`capsules.rs`), and how much of the treble is one wave says whether it comes from one place near by
//! (`nearness.rs`). None of them knows a breath by itself: hiss of one wave is lips', or that of an s; rumble that
//! differs is wind, or a hand on the table. Together they do, and how they are to be weighed is learnt as the rest is.

use super::capsules::Capsules;
use super::features::{self, Features, decibels};
use super::model::Network;
use super::nearness::Nearness;
use super::upper::{self, Upper};

/// The network that weighs them.
pub type PairModel = Network<COUNT, 32, 12>;

/// Regions of the treble below 4 kHz.
pub(super) const REGIONS: usize = 3;
/// Inputs before what lies above 4 kHz: log-odds and features of both spectra, δ, how long the difference has stood, and for each
/// region of the treble how much of it is not one wave, and how far what is has risen.
const BELOW: usize = 2 * (1 + features::COUNT) + 2 + 2 * REGIONS;
/// Number of inputs.
pub const COUNT: usize = BELOW + upper::COUNT;

/// One frame's inputs.
pub type Inputs = [f64; COUNT];

/// The inputs of a frame: log-odds and features of half the sum and of half the difference first.
pub(super) fn inputs(
    spectra: [(f64, &Features); 2],
    capsules: &Capsules,
    nearness: &Nearness<REGIONS>,
    upper: &Upper,
) -> Inputs {
    let mut all = [0.0; COUNT];
    let share = 0.1 * decibels(capsules.share.unwrap_or(1.0));
    let of_spectra =
        spectra.into_iter().flat_map(|(log_odds, features)| std::iter::once(0.1 * log_odds).chain(*features));
    let of_waves =
        nearness.apart.iter().map(|apart| 0.1 * decibels(*apart)).chain(nearness.rise_db.map(|rise| 0.1 * rise));
    let each = of_spectra.chain([share, capsules.lasting()]).chain(of_waves).chain(upper.inputs);
    all.iter_mut().zip(each).for_each(|(input, x)| *input = x);
    all
}

/// What an input is, in words.
pub fn name(input: usize) -> String {
    const SPECTRUM: usize = 1 + features::COUNT;
    const REST: [&str; 2 + 2 * REGIONS] = [
        "share that differs, 10 dB",
        "how long the difference has stood",
        "what of 0.4 to 0.9 kHz is not one wave, 10 dB",
        "of 0.9 to 2 kHz",
        "of 2 to 3.3 kHz",
        "rise of what is one wave of 0.4 to 0.9 kHz, 10 dB",
        "of 0.9 to 2 kHz",
        "of 2 to 3.3 kHz",
    ];
    let of = if input < SPECTRUM { "sum" } else { "difference" };
    if let Some(input) = input.checked_sub(BELOW) {
        return format!("above: {}", upper::name(input));
    }
    match input.checked_sub(2 * SPECTRUM) {
        Some(rest) => REST[rest].to_owned(),
        None if input.is_multiple_of(SPECTRUM) => format!("{of}: log-odds, 10"),
        None => format!("{of}: {}", features::name(input % SPECTRUM - 1)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::nearness::LOWER;
    use super::*;
    use crate::model::Model;
    use crate::{BlowSettings, pair_table, table};

    #[test]
    fn every_network_has_all_its_numbers_and_every_input_its_name() {
        assert_eq!(table::TRAINED.weights.len(), Model::PARAMETERS);
        assert_eq!(pair_table::TRAINED.weights.len(), PairModel::PARAMETERS);
        let names: Vec<String> = (0..COUNT).map(name).collect();
        assert_eq!(names[0], "sum: log-odds, 10");
        assert_eq!(names[1 + features::COUNT], "difference: log-odds, 10");
        assert!(names[2 * (1 + features::COUNT) - 1].ends_with("over 0.16 s, mean of 0.5 s"));
        assert!(names.iter().all(|name| !name.is_empty()));
    }

    #[test]
    fn what_differs_and_stands_speaks_for_breath_and_what_is_the_same_against_it() {
        let settings = BlowSettings::default();
        let heard = |share: f64| {
            let mut capsules = Capsules::new();
            capsules.share = Some(share);
            (0..20).for_each(|_| capsules.note(20.0, 0.0));
            // All as it was in the mean of all lessons, but what the difference says.
            let mut inputs: Inputs = std::array::from_fn(|i| settings.pair.scale[i][0]);
            let ends =
                self::inputs([(0.0, &[0.0; features::COUNT]); 2], &capsules, &Nearness::new(LOWER), &Upper::new());
            inputs[2 * (1 + features::COUNT)..][..2].copy_from_slice(&ends[2 * (1 + features::COUNT)..][..2]);
            settings.pair.log_odds(&inputs)
        };
        assert!(heard(0.9) > heard(0.001), "{} of wind, {} of a wave", heard(0.9), heard(0.001));
    }
}
