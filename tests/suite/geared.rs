//! What only trains feel: their answer in their own coordinates beside the dense solver's, which knows no trains.

use soffio_exhibit as exhibit;
use soffio_math::DVec3;
use soffio_math::noise::Random;
use soffio_math::spatial::{Vec6, dot, vec6};
use soffio_multibody::articulation::{LinearSolver, System};
use soffio_simulation::{Settings, start_dynamics};

/// Of the larger of the two rows' answers to themselves: the dense solver goes through 150 rows.
const SOLVED: f64 = 1e-9;
const SEED: u64 = 8;

fn wrench(random: &mut Random) -> Vec6 {
    let mut vector = || DVec3::new(random.signed(), random.signed(), random.signed());
    vec6(vector(), vector())
}

#[test]
fn trains_respond_to_each_other_as_the_whole_mechanism_does() {
    // A going train with a clutch, an anchor that a pendulum is looped to, a striking train, weights, levers.
    let folder = exhibit::resolve("terry-clock").unwrap_or_else(|report| panic!("{report}"));
    let clock = exhibit::load(&folder).unwrap_or_else(|report| panic!("{}", report.to_text()));
    let bodies = start_dynamics(&clock, &Settings::default()).bodies;
    let kinematic = vec![false; bodies.len()];
    let [mut lean, mut whole] = [LinearSolver::Sparse, LinearSolver::Dense].map(|method| {
        let mut system = System::new(&bodies, &kinematic, &clock.constraints, method);
        system.activity.update_activations(0.0);
        system.activity.set_time(0.0);
        system.evaluate(&bodies);
        system.factor();
        system
    });
    let index = |name: &str| clock.bodies.iter().position(|body| body.name == name).expect("a body of the clock");
    let pairs = [
        ["EscapeWheel", "Anchor"],
        ["Drum", "GreatWheel"],
        ["Cannon", "Flirt"],
        ["LockWheel", "CountLever"],
        ["StrikeDrum", "StrikeWheel"],
        ["Hammer", "PinWheel"],
        ["Anchor", "CountWheel"],
    ];
    let mut random = Random::new(SEED);
    let rows: Vec<[Option<(usize, Vec6)>; 2]> =
        pairs.iter().map(|two| two.map(|name| Some((index(name), wrench(&mut random))))).collect();
    let train_row: Vec<_> = rows.iter().map(|row| lean.train_row(row).expect("trains alone")).collect();
    let mut answers = vec![vec![0.0; rows.len()]; rows.len()];
    let mut expected = answers.clone();
    for (j, row) in rows.iter().enumerate() {
        lean.respond_to_train_row(&train_row[j]);
        whole.b.fill([0.0; 6]);
        row.iter().flatten().for_each(|(body, block)| whole.push_impulse(*body, block, 1.0));
        whole.solve_impulse();
        for i in 0..rows.len() {
            answers[i][j] = lean.train_row_rate(&train_row[i]);
            expected[i][j] = rows[i].iter().flatten().map(|(body, block)| dot(block, &whole.a[*body])).sum();
        }
    }
    let mut together = 0;
    for i in 0..rows.len() {
        for j in 0..rows.len() {
            let scale = expected[i][i].max(expected[j][j]);
            let off = (answers[i][j] - expected[i][j]).abs();
            assert!(off < SOLVED * scale, "seed {SEED}, {:?} by {:?}: {off} of {scale}", pairs[i], pairs[j]);
            together += usize::from(i != j && expected[i][j].abs() > 1e-3 * scale);
        }
    }
    assert!(together > 4, "the rows hardly feel each other");
    // The pendulum is in no train.
    let other = [Some((index("Pendulum"), wrench(&mut random))), Some((index("Anchor"), wrench(&mut random)))];
    assert!(lean.train_row(&other).is_none());
}
