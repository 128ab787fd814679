//! Search for a recording in any bytes, by normalised cross-correlation; it tests that no microphone sample leaves memory.
//!
//!     cargo run --example correlate -- KNOWN.f32 FILE…
//!
//! KNOWN is mono noise at 48 kHz, 32-bit floats without a header. Every FILE is read as bytes, or, where its name ends in
//! `.strace`, as the payloads of the traced writes, in order. The bytes are read as samples of every usual format, rate and alignment,
//! and as numbers in text. A file whose name ends in `.memory` is memory of a process: numbers are aligned there, have the rate of the
//! device, and may be one channel of interleaved pairs. Each reading is correlated with pieces of the recording:
//!
//! ```text
//! ρ(n) = Σ t_k x_{n+k} / (|t| |x_n…x_{n+K}|)        largest |ρ| over all n
//! ```
//!
//! Noise of K samples correlates with other data by about 1/√K. The maximum over a hundred million places is
//! √(2 ln 10⁸ / K) = 0.095 at K = 4096. It prints the maximum of every file; the exit code is 1 where one is above the bound.

use std::process::ExitCode;

use soffio_fourier::{Complex, ComplexToReal, RealToComplex, real_forward, real_inverse};
use std::sync::Arc;

/// Samples of a piece.
const PIECE: usize = 4096;
/// Samples of a transform.
const BLOCK: usize = 32_768;
/// Correlation from which a copy is found: twice the maximum by chance. A copy has 1, a copy with as much noise 0.7.
const BOUND: f64 = 0.2;
/// Possible sample rates of a copy, relative to 48 kHz.
const RATES: [f64; 4] = [1.0, 44_100.0 / 48_000.0, 1.0 / 3.0, 1.0 / 6.0];
/// Number of text columns that are read.
const COLUMNS: usize = 8;
/// Places of the pieces, as shares of the recording. The last one is what a ring of the last seconds still holds.
const PLACES: [f64; 3] = [0.25, 0.6, 0.85];

fn main() -> ExitCode {
    let files: Vec<String> = std::env::args().skip(1).collect();
    let Some((known, files)) = files.split_first() else {
        eprintln!("usage: correlate KNOWN.f32 FILE…");
        return ExitCode::from(2);
    };
    let known = samples(&read(known), 4, 0, |b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])));
    let matcher = Matcher::new(&known);
    let mut found = false;
    for file in files {
        let bytes = if file.ends_with(".strace") { payloads(&read(file)) } else { read(file) };
        let (most, how) = if file.ends_with(".memory") { matcher.look_at_memory(&bytes) } else { matcher.look(&bytes) };
        let verdict = if most > BOUND { "FOUND" } else { "nothing" };
        println!("{verdict} {most:.3} {how} in {} bytes of {file}", bytes.len());
        found |= most > BOUND;
    }
    ExitCode::from(u8::from(found))
}

fn read(file: &str) -> Vec<u8> {
    std::fs::read(file).unwrap_or_else(|error| panic!("{file}: {error}"))
}

/// Written bytes in a trace of `strace -xx`: those between quotes.
fn payloads(trace: &[u8]) -> Vec<u8> {
    let digit = |c: u8| (c as char).to_digit(16).unwrap_or(0) as u8;
    let (mut out, mut at) = (Vec::new(), 0);
    while at + 3 < trace.len() {
        if trace[at..].starts_with(b"\\x") {
            out.push(digit(trace[at + 2]) << 4 | digit(trace[at + 3]));
            at += 4;
        } else {
            at += 1;
        }
    }
    out
}

/// Bytes as samples of `width` bytes, from `offset`. Values that are not finite, or far beyond full scale, become 0.
fn samples(bytes: &[u8], width: usize, offset: usize, read: impl Fn(&[u8]) -> f64) -> Vec<f64> {
    let valid = |x: f64| if x.is_finite() && x.abs() <= 10.0 { x } else { 0.0 };
    bytes.get(offset..).unwrap_or_default().chunks_exact(width).map(|b| valid(read(b))).collect()
}

/// Numbers in text, from one column of each line, scaled to their maximum.
fn numbers(bytes: &[u8], column: usize) -> Vec<f64> {
    let part_of_number = |c: &u8| c.is_ascii_digit() || b"+-.eE".contains(c);
    let number = |word: &[u8]| std::str::from_utf8(word).ok()?.parse::<f64>().ok();
    let in_line = |line: &[u8]| line.split(|c| !part_of_number(c)).filter_map(number).nth(column);
    let values: Vec<f64> = bytes.split(|&c| c == b'\n').filter_map(in_line).collect();
    let most = values.iter().filter(|x: &&f64| x.is_finite()).fold(1e-30, |m: f64, x| m.max(x.abs()));
    values.iter().map(|x| if x.is_finite() { x / most } else { 0.0 }).collect()
}

/// Pieces of the recording, for correlation with any data.
struct Matcher {
    forward: Arc<dyn RealToComplex<f64>>,
    back: Arc<dyn ComplexToReal<f64>>,
    /// Spectra of the pieces, unit energy, conjugated.
    pieces: Vec<Vec<Complex<f64>>>,
}

impl Matcher {
    fn new(known: &[f64]) -> Self {
        let (forward, back) = (real_forward(BLOCK), real_inverse(BLOCK));
        let mut pieces = Vec::new();
        for rate in RATES {
            for place in PLACES {
                let mut piece = vec![0.0; BLOCK];
                let begin = place * known.len() as f64;
                (0..PIECE).for_each(|i| piece[i] = band_limited(known, begin + i as f64 / rate, rate));
                let energy = piece.iter().map(|x| x * x).sum::<f64>().sqrt();
                assert!(energy > 0.0, "the recording is too short or silent");
                piece.iter_mut().for_each(|x| *x /= energy);
                let mut spectrum = forward.make_output_vec();
                forward.process(&mut piece, &mut spectrum).expect("lengths fit");
                pieces.push(spectrum.iter().map(Complex::conj).collect());
            }
        }
        Self { forward, back, pieces }
    }

    /// The largest |ρ| of any reading of memory, and the format of that reading.
    fn look_at_memory(&self, bytes: &[u8]) -> (f64, &'static str) {
        let f32_at = |b: &[u8]| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
        let i16_at = |b: &[u8]| f64::from(i16::from_le_bytes([b[0], b[1]])) / 32_768.0;
        let readings: [(&str, Vec<f64>); 7] = [
            ("f64", samples(bytes, 8, 0, |b| f64::from_le_bytes(b.try_into().expect("eight bytes")))),
            ("f32", samples(bytes, 4, 0, f32_at)),
            ("first of two f32", samples(bytes, 8, 0, f32_at)),
            ("second of two f32", samples(bytes, 8, 4, f32_at)),
            ("i16", samples(bytes, 2, 0, i16_at)),
            ("first of two i16", samples(bytes, 4, 0, i16_at)),
            ("second of two i16", samples(bytes, 4, 2, i16_at)),
        ];
        // The first pieces are those at the rate of the recording.
        let at_its_rate = &self.pieces[..PLACES.len()];
        let correlated = readings.iter().map(|(name, reading)| (self.slide(reading, at_its_rate), *name));
        correlated.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, "at all"))
    }

    /// The largest |ρ| of any reading of the bytes, and the format of that reading.
    fn look(&self, bytes: &[u8]) -> (f64, &'static str) {
        let mut most = (0.0, "at all");
        let mut hold = |name: &'static str, x: Vec<f64>| {
            let rho = self.slide(&x, &self.pieces);
            if rho > most.0 {
                most = (rho, name);
            }
        };
        for offset in 0..8 {
            hold("f64", samples(bytes, 8, offset, |b| f64::from_le_bytes(b.try_into().expect("eight bytes"))));
        }
        for offset in 0..4 {
            hold("f32", samples(bytes, 4, offset, |b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))));
            hold("i32", samples(bytes, 4, offset, |b| f64::from(i32::from_le_bytes([b[0], b[1], b[2], b[3]])) / 2e9));
        }
        for offset in 0..3 {
            hold("i24", samples(bytes, 3, offset, |b| f64::from(i32::from_le_bytes([0, b[0], b[1], b[2]])) / 2e9));
        }
        for offset in 0..2 {
            hold("i16", samples(bytes, 2, offset, |b| f64::from(i16::from_le_bytes([b[0], b[1]])) / 32_768.0));
        }
        hold("u8", samples(bytes, 1, 0, |b| f64::from(b[0]) / 128.0 - 1.0));
        for column in 0..COLUMNS {
            hold("text", numbers(bytes, column));
        }
        most
    }

    /// The largest |ρ| of any of these pieces at any place.
    fn slide(&self, x: &[f64], pieces: &[Vec<Complex<f64>>]) -> f64 {
        let hop = BLOCK - PIECE;
        let (mut spectrum, mut product) = (self.forward.make_output_vec(), self.forward.make_output_vec());
        let mut product_time = self.back.make_output_vec();
        let mut most = 0.0_f64;
        let mut from = 0;
        while from + PIECE <= x.len() {
            let mut block = vec![0.0; BLOCK];
            let there = (x.len() - from).min(BLOCK);
            block[..there].copy_from_slice(&x[from..from + there]);
            from += hop;
            // A copy of a piece needs as many samples.
            if block.iter().filter(|x| **x != 0.0).count() < PIECE / 2 {
                continue;
            }
            let mut energy: Vec<f64> = Vec::with_capacity(BLOCK + 1);
            energy.push(0.0);
            block.iter().for_each(|x| energy.push(energy[energy.len() - 1] + x * x));
            self.forward.process(&mut block, &mut spectrum).expect("lengths fit");
            for piece in pieces {
                product.iter_mut().zip(spectrum.iter().zip(piece)).for_each(|(p, (s, t))| *p = s * t);
                // Rounding may leave an imaginary part here.
                (product[0].im, product[BLOCK / 2].im) = (0.0, 0.0);
                self.back.process(&mut product, &mut product_time).expect("lengths fit");
                for n in 0..=hop {
                    let power = energy[n + PIECE] - energy[n];
                    // Skip silence, and windows so quiet that rounding of the rest of the block would count.
                    if power > 1e-9 * energy[BLOCK] {
                        most = most.max(product_time[n].abs() / (BLOCK as f64 * power.sqrt()));
                    }
                }
            }
        }
        most
    }
}

/// The recording at a fraction of a sample, low-passed for a lower rate: a Hann-windowed sinc over 16 of its samples.
fn band_limited(x: &[f64], at: f64, rate: f64) -> f64 {
    let (half, middle) = (16.0 / rate, at.floor() as i64);
    let reach = half.ceil() as i64;
    (middle - reach..=middle + reach)
        .filter_map(|i| {
            let (d, sample) = (i as f64 - at, x.get(usize::try_from(i).ok()?)?);
            let angle = std::f64::consts::PI * d * rate;
            let sinc = if angle.abs() < 1e-9 { 1.0 } else { angle.sin() / angle };
            let window = if d.abs() < half { 0.5 + 0.5 * (std::f64::consts::PI * d / half).cos() } else { 0.0 };
            Some(sample * sinc * window)
        })
        .sum()
}
