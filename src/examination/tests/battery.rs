//! The battery on detectors whose results are known: one that never speaks, one that always speaks, and a plain meter of level.

use soffio_examination::battery::{Battery, Part, run};
use soffio_examination::subject::Detector;
use soffio_examination::tally::{Section, Tally};
use soffio_math::{PI, exp};

/// Reports the same speed for ever.
struct Constant(f64);

impl Detector for Constant {
    fn push(&mut self, _: &[f32], _: Option<&[f32]>, _: &[f32]) {}

    fn speed(&self) -> f64 {
        self.0
    }
}

/// Reports a speed while the power from 40 to 300 Hz lies 9 dB over its mean of some seconds: it hears breaths, and every door.
struct Meter {
    low: [f64; 2],
    keep: [f64; 2],
    power: f64,
    mean: f64,
    blends: [f64; 2],
}

impl Meter {
    fn new(rate: u32) -> Self {
        let rate = f64::from(rate);
        let keep = [40.0, 300.0].map(|hz| exp(-2.0 * PI * hz / rate));
        Self { low: [0.0; 2], keep, power: 0.0, mean: 1e-6, blends: [0.03, 3.0].map(|time| 1.0 / (time * rate)) }
    }
}

impl Detector for Meter {
    fn push(&mut self, left: &[f32], _: Option<&[f32]>, _: &[f32]) {
        for x in left {
            let x = f64::from(*x);
            for (low, keep) in self.low.iter_mut().zip(self.keep) {
                *low = x + keep * (*low - x);
            }
            let band = self.low[1] - self.low[0];
            self.power += self.blends[0] * (band * band - self.power);
            // A breath counts little in the mean.
            self.mean += self.blends[1] * (self.power.min(2.0 * self.mean) - self.mean);
        }
    }

    fn speed(&self) -> f64 {
        let over = self.power / self.mean;
        if over > 8.0 { over.sqrt() } else { 0.0 }
    }
}

fn scored(part: Part, size: f64, make: impl Fn(u32) -> Box<dyn Detector> + Sync) -> Tally {
    run(&make, &Battery { size, capsules: 1, seed: 7, only: Some(part) })
}

fn value(tally: &Tally, section: Section, name: &str) -> f64 {
    tally.line(section, name).unwrap_or_else(|| panic!("no row {name}:\n{tally}")).value
}

#[test]
fn a_detector_that_is_silent_or_never_silent_detects_nothing() {
    for speed in [0.0, 3.0] {
        let tally = scored(Part::Breaths, 0.03, |_| Box::new(Constant(speed)));
        assert!(value(&tally, Section::Breaths, "b all of 0.35 m/s or more") == 0.0, "{tally}");
        assert!(value(&tally, Section::Breaths, "h false triggers between breaths") == 0.0, "{tally}");
    }
}

#[test]
fn clear_breaths_are_clear_to_a_meter_of_level_and_so_are_noises() {
    let breaths = scored(Part::Breaths, 0.06, |rate| Box::new(Meter::new(rate)));
    println!("{breaths}");
    // The meter may be busy with another sound when a breath begins.
    assert!(value(&breaths, Section::Breaths, "a clear") > 0.6, "{breaths}");
    assert!(
        value(&breaths, Section::Breaths, "a clear") > value(&breaths, Section::Breaths, "b all of 0.35 m/s or more")
    );
    let noises = scored(Part::Noises, 0.03, |rate| Box::new(Meter::new(rate)));
    println!("{noises}");
    assert!(value(&noises, Section::Noises, "b doors and knocks") > 60.0, "{noises}");
    assert!(value(&noises, Section::Noises, "b handling") > 60.0, "{noises}");
}

#[test]
fn the_table_is_the_same_twice_and_another_with_another_seed() {
    let table = |seed| {
        let battery = Battery { size: 0.02, capsules: 2, seed, only: Some(Part::Kiosk) };
        run(&|rate| Box::new(Meter::new(rate)), &battery)
    };
    let (first, second, third) = (table(1), table(1), table(2));
    assert_eq!(first.to_string(), second.to_string());
    assert_ne!(first.to_string(), third.to_string());
    assert_eq!(first.lines().len(), 1);
}
