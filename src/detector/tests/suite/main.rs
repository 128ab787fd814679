//! The blow detector on sounds of the examining generator: requirements for any microphone, and for the kiosk's own output.

use assert_no_alloc::AllocDisabler;

mod breaths;
mod echo;
mod robustness;

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

use soffio_detector::{BlowDetector, BlowEstimate};

/// The estimate after every block of 5 ms, with its time, s.
fn estimates(samples: &[f32], sample_rate: u32) -> Vec<(f64, BlowEstimate)> {
    let mut detector = BlowDetector::new(sample_rate);
    let mut count = 0;
    let step = |block: &[f32]| {
        detector.push(block, &[]);
        count += block.len();
        (count as f64 / f64::from(sample_rate), detector.estimate())
    };
    samples.chunks(sample_rate as usize / 200).map(step).collect()
}
