//! Training pipeline: iterative dataset aggregation, refinement with recordings, cross-validation, and the validation set.
//!
//! Training uses scenarios with seeds below [`FIRST_VALIDATION_SEED`], validation the others. Recordings are split into folds by
//! group. A model is never scored on a recording whose group it was trained on, alone or mixed into a scene.

use std::fmt::Write as _;

use super::descent::{Example, NetworkSpec, examples, train, untrained};
use super::score::{Table, TakeScore, score_take};
use soffio_detector::BlowSettings;
use soffio_detector::features::power_to_db;
use soffio_detector::model::Network;
use soffio_math::noise::{Random, hash_words};
use soffio_soundscape::scenes::{Condition, Hearing, Scenario};
use soffio_soundscape::{FIRST_VALIDATION_SEED, Kind, Take, parallel::parallel};

/// Number of folds of a cross-validation over recordings.
pub const FOLDS: u64 = 5;
/// Largest gain change of a recording's copies, dB.
const GAIN_DB: f64 = 12.0;
/// Copies of a recording, the first at its own gain.
const COPIES: u64 = 5;
/// Weight of a recorded frame: recordings are few beside synthetic scenes.
const RECORDED: f32 = 4.0;
/// Share of the synthetic scenes whose gain is far too high.
const CLIPPED: f64 = 0.08;
/// Largest additional gain of those scenes, dB.
const CLIPPED_DB: f64 = 28.0;

/// Hyperparameters of a training run.
#[derive(Clone, Copy, Debug)]
pub struct TrainingSettings {
    /// Share of the initial network in the result, 0 … 1, where training continues from a trained one.
    pub keep: f64,
    /// Iterations of dataset aggregation, each with twice as many new scenarios as the last one.
    pub iterations: u64,
    /// Scenarios of the first iteration.
    pub scenarios: u64,
    /// Size of each scenario: 1 is an hour and a half of museum, and the other scenes in proportion.
    pub size: f64,
    /// Epochs over all examples after each iteration.
    pub epochs: usize,
    /// Seed of everything random.
    pub seed: u64,
}

impl TrainingSettings {
    /// Number of scenarios before an iteration.
    fn scenarios_before(&self, iteration: u64) -> u64 {
        self.scenarios * ((1 << iteration) - 1)
    }
}

/// Result of a training run.
#[derive(Clone, Debug)]
pub struct Trained<const IN: usize, const FIRST: usize, const SECOND: usize> {
    /// All examples so far, without those of a first iteration from an untrained network.
    pub examples: Vec<Example<IN>>,
    /// Network at the beginning.
    pub initial: Network<IN, FIRST, SECOND>,
    /// Trained network.
    pub network: Network<IN, FIRST, SECOND>,
    /// Mean loss in the last epoch.
    pub loss: f64,
}

/// Scenes of a scenario for one or two capsules; half of them have gains far from the usual.
fn scenes(size: f64, stereo: bool) -> Vec<(Condition, u64)> {
    let count = |full: f64| (full * size).round() as u64;
    let mut all = vec![
        // False positives of two capsules are hours apart in a museum, so it takes many scenes.
        (Condition::Museum, count(if stereo { 270.0 } else { 90.0 })),
        (Condition::Impulses, count(480.0)),
        (Condition::Alike, count(120.0)),
        (Condition::Isolated, count(180.0)),
        (Condition::Spoken, count(180.0)),
        (Condition::Companions, count(180.0)),
    ];
    all.extend([0.0, 5.0, 10.0, 15.0, 20.0].map(|snr| (Condition::Noisy(snr), count(45.0))));
    all.extend([5.0, 10.0, 15.0, 20.0].map(|snr| (Condition::Aside(snr), count(45.0))));
    all.extend([0, 1, 2].map(|room| (Condition::KioskSound(room), count(24.0))));
    all.extend([0, 1, 2].map(|room| (Condition::Answered(room), count(30.0))));
    if stereo {
        // An off-axis breath often shows in the difference alone.
        all.extend([8.0, 14.0, 20.0, 26.0].map(|snr| (Condition::Between(snr), count(60.0))));
        // Puffs into the microphone that the echo masks: two capsules receive them as wind.
        all.extend([0, 1, 2].map(|room| (Condition::TalkedOver(room), count(24.0))));
    }
    all.into_iter().flat_map(|(condition, n)| (0..n).map(move |i| (condition, i))).collect()
}

/// Examples of one scenario.
fn scenario_examples<const IN: usize, const FIRST: usize, const SECOND: usize>(
    spec: &NetworkSpec<IN, FIRST, SECOND>,
    scenario: &Scenario,
    settings: &BlowSettings,
    training: &TrainingSettings,
) -> Vec<Example<IN>> {
    let mut out = Vec::new();
    for (condition, index) in scenes(training.size, spec.stereo) {
        let mut random = Random::new(hash_words(&[training.seed, index, 3]));
        let clipped = if random.unit() < CLIPPED { random.range(0.0, CLIPPED_DB) } else { 0.0 };
        let hearing = Hearing { gain_db: random.range(-GAIN_DB, GAIN_DB) + clipped, stereo: spec.stereo };
        examples(&scenario.take(condition, index, hearing), settings, spec.inputs, &mut out);
    }
    out
}

fn scenario_seed(training: &TrainingSettings, i: u64) -> u64 {
    hash_words(&[training.seed, i]) % FIRST_VALIDATION_SEED
}

/// Settings of a detector with this network.
pub fn settings_with<const IN: usize, const FIRST: usize, const SECOND: usize>(
    spec: &NetworkSpec<IN, FIRST, SECOND>,
    network: &Network<IN, FIRST, SECOND>,
) -> BlowSettings {
    let mut settings = BlowSettings::default();
    (spec.set)(&mut settings, network.clone());
    settings
}

/// Trains a network on synthetic scenarios, iteration by iteration; `report` is called after each. The examples of a first
/// iteration with an untrained network are discarded after it.
pub fn learn<const IN: usize, const FIRST: usize, const SECOND: usize>(
    spec: &NetworkSpec<IN, FIRST, SECOND>,
    training: &TrainingSettings,
    initial: Network<IN, FIRST, SECOND>,
    mut report: impl FnMut(u64, &Trained<IN, FIRST, SECOND>),
) -> Trained<IN, FIRST, SECOND> {
    let new = initial == untrained();
    let mut trained = Trained { examples: Vec::new(), network: initial.clone(), initial, loss: 0.0 };
    for iteration in 0..training.iterations {
        if iteration == 1 && new {
            trained.examples.clear();
        }
        let scenarios = training.scenarios_before(iteration)..training.scenarios_before(iteration + 1);
        let detector = settings_with(spec, &trained.network);
        let new_examples = parallel(scenarios.collect(), |i| {
            scenario_examples(spec, &Scenario::new(scenario_seed(training, i)), &detector, training)
        });
        trained.examples.extend(new_examples.into_iter().flatten());
        (trained.network, trained.loss) =
            train(&trained.network, &trained.examples, training.epochs, training.seed + iteration);
        report(iteration, &trained);
    }
    trained
}

/// Continues training with recordings, alone and mixed into a scenario of their own; returns the network and its loss.
pub fn refine<const IN: usize, const FIRST: usize, const SECOND: usize>(
    spec: &NetworkSpec<IN, FIRST, SECOND>,
    training: &TrainingSettings,
    synthetic: &Trained<IN, FIRST, SECOND>,
    recordings: &[&Take],
    fold: u64,
) -> (Network<IN, FIRST, SECOND>, f64) {
    let mut all = synthetic.examples.clone();
    let detector = settings_with(spec, &synthetic.network);
    let scenario = Scenario::new(scenario_seed(training, 1000 + fold)).with_recordings(recordings.iter().copied());
    all.extend(scenario_examples(spec, &scenario, &detector, training));
    for copy in 0..COPIES {
        let mut random = Random::new(hash_words(&[training.seed, copy, 4]));
        for take in recordings {
            let gain = random.range(-GAIN_DB, GAIN_DB);
            let from = all.len();
            examples(&take.with_gain(if copy == 0 { 0.0 } else { gain }), &detector, spec.inputs, &mut all);
            all[from..].iter_mut().for_each(|example| example.weight *= RECORDED);
        }
    }
    let (network, loss) = train(&synthetic.network, &all, training.epochs, training.seed);
    (blend_with_initial(training, &synthetic.initial, network), loss)
}

/// Average of the trained and the initial network, by [`TrainingSettings::keep`]; the trained one alone where it began untrained.
pub fn blend_with_initial<const IN: usize, const FIRST: usize, const SECOND: usize>(
    training: &TrainingSettings,
    initial: &Network<IN, FIRST, SECOND>,
    network: Network<IN, FIRST, SECOND>,
) -> Network<IN, FIRST, SECOND> {
    if *initial == untrained() { network } else { interpolate(initial, &network, training.keep) }
}

/// Weighted average of two networks; `share` is that of the first, 0 … 1. It keeps the first one from being forgotten (Wortsman et
/// al., "Model soups", 2022).
fn interpolate<const IN: usize, const FIRST: usize, const SECOND: usize>(
    before: &Network<IN, FIRST, SECOND>,
    after: &Network<IN, FIRST, SECOND>,
    share: f64,
) -> Network<IN, FIRST, SECOND> {
    let mut mean = after.clone();
    mean.weights.to_mut().iter_mut().zip(&*before.weights).for_each(|(w, before)| *w += share * (before - *w));
    mean
}

/// Mean of networks that were trained from the same one, with the input scales of the first; `None` for no network.
pub fn mean<const IN: usize, const FIRST: usize, const SECOND: usize>(
    networks: &[Network<IN, FIRST, SECOND>],
) -> Option<Network<IN, FIRST, SECOND>> {
    let (first, rest) = networks.split_first()?;
    let in_turn = (2..).zip(rest);
    Some(in_turn.fold(first.clone(), |mean, (count, next)| interpolate(next, &mean, 1.0 / f64::from(count))))
}

/// Fold of a group of recordings.
pub fn fold(group: &str) -> u64 {
    let letters: Vec<u64> = group.bytes().map(u64::from).collect();
    hash_words(&letters) % FOLDS
}

/// Scores of recordings by cross-validation: each by the model that was not trained on its group.
pub fn cross_validated<const IN: usize, const FIRST: usize, const SECOND: usize>(
    spec: &NetworkSpec<IN, FIRST, SECOND>,
    training: &TrainingSettings,
    synthetic: &Trained<IN, FIRST, SECOND>,
    recordings: &[Take],
) -> (Table, Vec<String>) {
    let (mut table, mut remarks) = (Table::default(), Vec::new());
    let networks = parallel((0..FOLDS).collect(), |k| {
        let known: Vec<&Take> = recordings.iter().filter(|t| fold(&t.group) != k).collect();
        refine(spec, training, synthetic, &known, k).0
    });
    for (k, network) in (0..FOLDS).zip(networks) {
        let unseen: Vec<Take> = recordings.iter().filter(|t| fold(&t.group) == k).cloned().collect();
        score_takes(&settings_with(spec, &network), &unseen, &mut table, &mut remarks);
    }
    (table, remarks)
}

/// Scores takes, adds them to the table, and adds a remark for each error.
pub fn score_takes(
    settings: &BlowSettings,
    takes: &[Take],
    table: &mut Table,
    remarks: &mut Vec<String>,
) -> Vec<TakeScore> {
    let scores = parallel((0..takes.len()).collect(), |i| score_take(settings, &takes[i]));
    for (take, score) in takes.iter().zip(&scores) {
        if let Some(row) = Table::row(take) {
            table.add(row, take, score);
            remarks.extend(remark(take, score));
        }
    }
    scores
}

/// Errors of a take, in words: missed breaths, and false positives with the sounds that may have caused them.
fn remark(take: &Take, score: &TakeScore) -> Option<String> {
    let missed = take.kind == Kind::Blow && !score.detected();
    if score.false_positives.is_empty() && !missed {
        return None;
    }
    let mut remark = format!("{}:{}", take.name, if missed { " missed" } else { "" });
    for at in &score.false_positives {
        let _ = write!(remark, " wind without breath at {at:.2} s");
        // Sounds that ended long ago or are far quieter than the others are no cause.
        for event in take.events.iter().filter(|e| e.gain > 0.005 && e.at < *at && *at < e.until + 0.5) {
            let path = if event.on_table { " through the table" } else { "" };
            let db = 2.0 * power_to_db(event.gain);
            let _ = write!(remark, ", {}{path} {db:.0} dB since {:.2} s", event.what, event.at);
        }
    }
    Some(remark)
}

/// Validation set: name, condition and number of scenes of each row.
pub fn validation_set(hours: f64) -> Vec<(String, Condition, u64)> {
    let takes = |seconds: f64| (3600.0 * hours / seconds).ceil() as u64;
    let mut rows = vec![
        ("museum".to_owned(), Condition::Museum, takes(60.0)),
        ("knocks, claps, pops, doors".to_owned(), Condition::Impulses, takes(20.0)),
        ("breath, 5-60 cm, 0-60°".to_owned(), Condition::Isolated, takes(5.0)),
    ];
    for distance in [0.1, 0.2, 0.4] {
        for angle in [0.0, 30.0, 60.0] {
            for child in [false, true] {
                let who = if child { "child" } else { "adult" };
                let row = format!("breath, {:.0} cm, {angle:2.0}°, {who}", 100.0 * distance);
                rows.push((row, Condition::Cell(distance, angle, child), takes(5.0 * 18.0)));
            }
        }
    }
    for snr in [0.0, 5.0, 10.0, 20.0] {
        rows.push((format!("breath in a museum, {snr:2.0} dB"), Condition::Noisy(snr), takes(5.0 * 4.0)));
    }
    for snr in [5.0, 10.0, 20.0] {
        rows.push((
            format!("breath past it in a museum, {snr:2.0} dB of hiss"),
            Condition::Aside(snr),
            takes(5.0 * 3.0),
        ));
    }
    for snr in [10.0, 15.0, 20.0] {
        rows.push((
            format!("breath past it in a museum, {snr:2.0} dB between two capsules"),
            Condition::Between(snr),
            takes(5.0 * 3.0),
        ));
    }
    rows.push(("breath after talk".to_owned(), Condition::Spoken, takes(5.0)));
    rows.push(("breath amid companions' talk".to_owned(), Condition::Companions, takes(5.0)));
    for room in 0..3 {
        rows.push((format!("the kiosk itself, room {}", room + 1), Condition::KioskSound(room), takes(180.0)));
        rows.push((
            format!("the kiosk itself, talked over, room {}", room + 1),
            Condition::TalkedOver(room),
            takes(180.0),
        ));
        rows.push((format!("breath that it answers, room {}", room + 1), Condition::Answered(room), takes(60.0)));
    }
    rows
}

/// Scores of synthetic scenes from validation scenarios, `hours` of each row whose name `selected` accepts; and remarks.
pub fn validate(
    settings: &BlowSettings,
    hours: f64,
    seed: u64,
    hearing: Hearing,
    selected: impl Fn(&str) -> bool,
) -> (Table, Vec<String>) {
    const SCENARIOS: u64 = 6;
    let seed_of = |i: u64| FIRST_VALIDATION_SEED + hash_words(&[seed, i]) % FIRST_VALIDATION_SEED;
    let scenarios: Vec<Scenario> = (0..SCENARIOS).map(|i| Scenario::new(seed_of(i))).collect();
    let rows = validation_set(hours).into_iter().filter(|(row, ..)| selected(row));
    let scenes = rows.flat_map(|(row, condition, n)| (0..n).map(move |i| (row.clone(), condition, i)));
    let results = parallel(scenes.collect(), |(row, condition, index)| {
        let mut random = Random::new(hash_words(&[seed, index, 5]));
        let hearing = Hearing { gain_db: hearing.gain_db + random.range(-3.0, 3.0), ..hearing };
        let mut take = scenarios[(index % SCENARIOS) as usize].take(condition, index, hearing);
        let score = score_take(settings, &take);
        // The reference signal is no longer needed.
        take.played = Vec::new();
        let remark = remark(&take, &score).map(|r| format!("{} {r}", take.group));
        let mut table = Table::default();
        table.add(&row, &take, &score);
        (table, remark)
    });
    let (mut table, mut remarks) = (Table::default(), Vec::new());
    for (one, remark) in results {
        table.join(one);
        remarks.extend(remark);
    }
    (table, remarks)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_initial_network_has_its_share_of_the_mean() {
        const ROUNDING: f64 = 1e-12;
        let initial = &BlowSettings::default().model;
        let after = untrained();
        for share in [0.0, 0.25, 1.0] {
            let mean = interpolate(initial, &after, share);
            for ((w, before), after) in mean.weights.iter().zip(&*initial.weights).zip(&*after.weights) {
                assert!((w - (share * before + (1.0 - share) * after)).abs() < ROUNDING, "{share}: {w}");
            }
        }
        let third = super::mean(&[after.clone(), (**initial).clone(), after]).expect("a mean of three");
        let far = third.weights.iter().zip(&*initial.weights).map(|(w, before)| (w - before / 3.0).abs());
        assert!(far.fold(0.0, f64::max) < ROUNDING, "one of three");
    }
}
