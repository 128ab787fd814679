//! What a level of instructions allows at most: multiply-adds with nothing to read or write. For benchmarks; it stands here
//! because this crate is compiled for speed, and the program is not.

use std::hint::black_box;

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f32x16};

/// Vectors that do not wait for each other: two multiply-adds a cycle of a latency of four to five.
const VECTORS: usize = 6;
/// Numbers of a vector: one of AVX-512.
const LANES: usize = 16;

/// Does `rounds` times as many multiply-adds as there are lanes. Their number, and a sum that has to be used, or nothing
/// would be computed.
pub fn multiply_adds(level: Level, rounds: usize) -> (usize, f32) {
    #[inline(always)]
    fn turn<S: Simd>(simd: S, rounds: usize) -> f32 {
        let factor = f32x16::splat(simd, black_box(0.999));
        let step = f32x16::splat(simd, black_box(0.001));
        // No two lanes alike, or the halves of a vector that the processor has not would be one.
        let mut sums: [f32x16<S>; VECTORS] = std::array::from_fn(|i| {
            std::array::from_fn::<f32, LANES, _>(|lane| (LANES * i + lane) as f32).simd_into(simd)
        });
        for _ in 0..rounds {
            for sum in &mut sums {
                *sum = sum.mul_add(factor, step);
            }
        }
        // All lanes, or those that nothing reads would not be computed.
        sums.iter().map(|sum| <[f32; LANES]>::from(*sum).iter().sum::<f32>()).sum()
    }
    (rounds * VECTORS * LANES, dispatch!(level, simd => turn(simd, rounds)))
}
