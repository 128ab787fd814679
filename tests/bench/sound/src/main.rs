//! Soffio's bank of partials beside fundsp's `BiquadBank<f32x8>`: the same partials, in turns, in one run.

use std::hint::black_box;

use clap::Parser;
use cpu_time::ThreadTime;
use fundsp::F32x;
use fundsp::Frame;
use fundsp::biquad_bank::BiquadBank;
use fundsp::prelude::{AudioNode, BiquadCoefs};
use soffio_math::{PI, amplitude_to_db, exp, ln, sincos};
use soffio_math::noise::Random;
use soffio_sound::modal::{BLOCK, Bank, Partial};

const RATE: f64 = 48_000.0;
/// Partials side by side in the peer.
const LANES: usize = 8;
/// Rounds; the best counts, as the machine's other work can only add.
const ROUNDS: usize = 5;

/// Partials × real time on one core of each engine, thread CPU time, best of five rounds that take turns.
#[derive(Parser)]
struct Args {
    /// Numbers of partials.
    #[arg(long, value_delimiter = ',', default_value = "64,600,6328")]
    partials: Vec<usize>,
    /// Samples of a block.
    #[arg(long, value_delimiter = ',', default_value = "64,512")]
    block: Vec<usize>,
    /// Seconds of sound of a round.
    #[arg(long, default_value_t = 4.0)]
    seconds: f64,
}

fn main() {
    let args = Args::parse();
    println!(
        "{:>9} {:>6} {:>12} {:>12} {:>12} {:>7} {:>10} {:>10}",
        "partials", "block", "soffio", "by samples", "by banks", "ratio", "our error", "its error"
    );
    for &count in &args.partials {
        for &block in &args.block {
            let mut random = Random::new(7);
            let partials: Vec<Partial> = (0..count)
                .map(|_| Partial {
                    frequency: 40.0 * exp(random.unit() * ln(400.0)),
                    decay: 6.908 / (2.0 * exp(random.unit() * ln(10.0))),
                })
                .collect();
            let total = (args.seconds * RATE) as usize / block * block;
            let mut best = [f64::INFINITY; 3];
            let mut errors = [0.0; 3];
            let reference = reference(&partials);
            for _ in 0..ROUNDS {
                let mut out = vec![0.0; total];
                let runs: [fn(&[Partial], &mut [f32], usize); 3] = [ours, by_samples, by_banks];
                for (i, run) in runs.iter().enumerate() {
                    out.fill(0.0);
                    let start = ThreadTime::now();
                    run(&partials, &mut out, block);
                    best[i] = best[i].min(start.elapsed().as_secs_f64());
                    errors[i] = error(black_box(&out), &reference);
                }
            }
            let rate = best.map(|seconds| count as f64 * total as f64 / RATE / seconds);
            println!(
                "{count:>9} {block:>6} {:>12.0} {:>12.0} {:>12.0} {:>7.1} {:>7.1} dB {:>7.1} dB",
                rate[0],
                rate[1],
                rate[2],
                rate[0] / rate[1].max(rate[2]),
                errors[0],
                errors[1]
            );
        }
    }
}

fn ours(partials: &[Partial], out: &mut [f32], block: usize) {
    let mut bank = Bank::new(partials, RATE, fearless_simd::Level::new());
    // So short a pulse is an impulse.
    let mut ahead = [0.0; 2 * BLOCK];
    bank.strike(|_| 1.0 / partials.len() as f64, 1e-12, BLOCK, &mut ahead);
    for block in out.chunks_mut(block) {
        for part in block.as_chunks_mut::<BLOCK>().0 {
            bank.render(None, part);
        }
        black_box(&block);
    }
}

fn biquads(partials: &[Partial]) -> Vec<BiquadBank<F32x>> {
    let lanes = |of: &dyn Fn(f64, f64) -> f64, partials: &[Partial]| {
        let mut x = [0.0; LANES];
        for (x, p) in x.iter_mut().zip(partials) {
            *x = of(exp(-p.decay / RATE), 2.0 * PI * p.frequency / RATE) as f32;
        }
        F32x::new(x)
    };
    let level = 1.0 / partials.len() as f64;
    let bank = |partials: &[Partial]| {
        BiquadBank::with_coefs(BiquadCoefs::arbitrary(
            lanes(&|r, w| -2.0 * r * sincos(w).1, partials),
            lanes(&|r, _| r * r, partials),
            F32x::splat(0.0),
            lanes(&|r, w| level * r * sincos(w).0, partials),
            F32x::splat(0.0),
        ))
    };
    partials.chunks(LANES).map(bank).collect()
}

fn by_samples(partials: &[Partial], out: &mut [f32], block: usize) {
    let mut banks = biquads(partials);
    let mut x = Frame::splat(1.0);
    for block in out.chunks_mut(block) {
        for y in &mut *block {
            let mut sum = F32x::splat(0.0);
            for bank in &mut banks {
                sum += F32x::new((*bank.tick(&x).as_array()).into());
            }
            *y = sum.reduce_add();
            x = Frame::splat(0.0);
        }
        black_box(&block);
    }
}

fn by_banks(partials: &[Partial], out: &mut [f32], block: usize) {
    let mut banks = biquads(partials);
    let mut first = 1.0;
    let mut sums = vec![F32x::splat(0.0); block];
    for block in out.chunks_mut(block) {
        sums.fill(F32x::splat(0.0));
        for bank in &mut banks {
            let mut x = Frame::splat(first);
            for sum in &mut sums {
                *sum += F32x::new((*bank.tick(&x).as_array()).into());
                x = Frame::splat(0.0);
            }
        }
        for (y, sum) in block.iter_mut().zip(&sums) {
            *y = sum.reduce_add();
        }
        first = 0.0;
        black_box(&block);
    }
}

/// The first second of Σ a e^(−ct) sin ωt, every 97th sample.
fn reference(partials: &[Partial]) -> Vec<f64> {
    (0..RATE as usize)
        .step_by(97)
        .map(|t| {
            let t = t as f64 / RATE;
            let y = partials.iter().map(|p| exp(-p.decay * t) * sincos(2.0 * PI * p.frequency * t).0);
            y.sum::<f64>() / partials.len() as f64
        })
        .collect()
}

/// dB below the sound itself.
fn error(out: &[f32], reference: &[f64]) -> f64 {
    let (mut wrong, mut right) = (0.0, 0.0);
    for (i, y) in reference.iter().enumerate() {
        let e = f64::from(out[97 * i]) - y;
        wrong += e * e;
        right += y * y;
    }
    amplitude_to_db((wrong / right).sqrt())
}
