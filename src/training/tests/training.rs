//! The training makes the same bits from the same seed, on any machine and any number of threads.

use soffio_training::{examples, model};

/// Hash of the model that six trees learn from two scenes. A change of the generator, the front end or the growth of trees changes
/// it: then train the shipped model again and renew this word.
const EXPECTED: &str = "cdc6ad7b67fb4ac9";

#[test]
fn a_short_training_makes_the_known_model() {
    let examples = examples::of_seed(1, 2);
    let trained = model::trained(&examples, 6, 2, 1);
    assert_eq!(model::hash(&trained), EXPECTED);
    let file = model::written(&trained, &[("seed", "1".to_owned())]).expect("a file");
    assert_eq!(soffio_detector::model::Model::read(&file).as_ref(), Ok(&trained), "the file holds the model");
}
