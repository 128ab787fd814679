//! Checks of the generator.

use soffio_math::noise::Random;

use super::noise::Workshop;
use super::turbulence::{Air, Port, pressure};

#[test]
fn look() {
    let mut workshop = Workshop::default();
    let mut random = Random::new(3);
    let n = 500;
    let port =
        Port { coefficient: 1.0, slope: 2.0, size: 0.004, wake: (0.004, 0.05), foam: 0.0, spacing: 0.03, decay: 10.0 };
    let air = Air {
        speed: [vec![1.5; n], vec![1.5; n]],
        eddies: [vec![0.3; n], vec![0.3; n]],
        carrier: vec![1.2; n],
        scale: 0.02,
        lag: 0.0,
    };
    let p = pressure(&mut workshop, &mut random, &air, &port);
    let spec = hound::WavSpec {
        channels: 1,
        sample_rate: 16000,
        bits_per_sample: 32,
        sample_format: hound::SampleFormat::Float,
    };
    let mut f = hound::WavWriter::create("/tmp/h1/p.wav", spec).unwrap();
    p[0].iter().for_each(|x| f.write_sample(*x).unwrap());
}
