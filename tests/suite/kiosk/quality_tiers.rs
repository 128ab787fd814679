//! The way to draw that a machine keeps up with: found, kept, and left again when it can do better. No clock runs.

use soffio_kiosk::window::quality_tiers::{QUALITY_TIERS, QualityController, WAITS};

const REFRESH: f64 = 1.0 / 60.0;

/// Which tier, 0 the finest.
fn place(tiers: &QualityController) -> usize {
    QUALITY_TIERS.iter().position(|tier| *tier == tiers.tier()).expect("one of them")
}

/// Seconds on a machine that takes so long for a picture of each tier, on a display that shows one each refresh. Returns
/// the seconds spent on each tier.
fn run(tiers: &mut QualityController, seconds: f64, cost: [f64; QUALITY_TIERS.len()]) -> [f64; QUALITY_TIERS.len()] {
    let (mut time, mut spent) = (0.0, [0.0; QUALITY_TIERS.len()]);
    while time < seconds {
        let tier = place(tiers);
        let way = ((cost[tier].max(QUALITY_TIERS[tier].least) - 1e-9) / REFRESH).ceil().max(1.0) * REFRESH;
        tiers.record(way, REFRESH);
        time += way;
        spent[tier] += way;
    }
    spent
}

#[test]
fn a_machine_that_keeps_up_draws_the_finest_whatever_single_pictures_take() {
    let mut tiers = QualityController::default();
    for _ in 0..20 {
        run(&mut tiers, 5.0, [0.010; 4]);
        run(&mut tiers, 0.2, [0.045; 4]);
    }
    assert_eq!((place(&tiers), tiers.changes()), (0, 0));
}

#[test]
fn each_machine_finds_the_finest_tier_that_it_keeps_up_with_and_seldom_leaves_it() {
    /// Share of an hour that finer tiers may be tried for.
    const TRIED: f64 = 0.02;
    const CHANGES: u64 = 40;
    for (right, cost) in
        [(1, [0.030, 0.015, 0.010, 0.010]), (2, [0.040, 0.025, 0.014, 0.014]), (3, [0.05, 0.04, 0.03, 0.03])]
    {
        let mut tiers = QualityController::default();
        let spent = run(&mut tiers, 3600.0, cost);
        println!("{right}: {spent:.1?} s, {} changes", tiers.changes());
        assert!(spent[right] > (1.0 - TRIED) * 3600.0 && tiers.changes() < CHANGES, "{right}: {spent:?}");
    }
}

#[test]
fn a_machine_that_recovers_draws_the_finest_again() {
    let mut tiers = QualityController::default();
    run(&mut tiers, 600.0, [0.05, 0.04, 0.03, 0.03]);
    assert_eq!(place(&tiers), 3);
    run(&mut tiers, 3.0 * WAITS.1 + 60.0, [0.010; 4]);
    assert_eq!(place(&tiers), 0);
}

#[test]
fn a_pause_is_no_slow_picture() {
    let mut tiers = QualityController::default();
    for _ in 0..1000 {
        tiers.record(0.9, REFRESH);
    }
    assert_eq!(place(&tiers), 0);
}
