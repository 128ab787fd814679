//! Inner loops of modal synthesis, for every SIMD instruction set.
//!
//! A partial is a phasor z that turns and shrinks by ρ = e^((−c + iω)/fs) per sample and is heard as Im z. A block of
//! [`BLOCK`] samples is cut into [`FRAMES`] frames of [`FRAME`]. The phasor at the start of frame m is z_m = z ρ^(16 m),
//! and the frame is read off it with stored rows ρ^0 … ρ^15,
//!
//! ```text
//! y[16 m + k] = Im(z_m ρ^k) = Re z_m · Im ρ^k + Im z_m · Re ρ^k
//! ```
//!
//! two multiply-adds a sample, sixteen samples side by side: no recursion in time, hence no waiting. What goes from
//! block to block, z ← z ρ^64, is f64, so pitch and decay are exact to about 1e−12; within a block f32 does (−130 dB).
//! Partials lie in groups of [`GROUP`], whose z_m are computed side by side.
//!
//! **Bits.** Every sum has one order at every level of instructions. A processor with fused multiply-add (AVX2, AVX-512, NEON)
//! rounds it once, others (SSE2, SSE4.2, plain code) twice. Each of the two classes has
//! its own bits, equal on every processor of the class, and both are within 1e−4.5 (−90 dB) of the closed form.
//! [`fuses`] returns the class of a level. Exact fusing in f64 would cost a processor without it ten times the work.
//!
//! **Driven** by a force f_j at audio rate, z_(j+1) = ρ (z_j + b f_j) for a partial of gain b. Over one frame the force
//! adds d = Σ_k f_k ρ^(16−k) to the phasor (by Horner's rule, a group side by side). Within the frame it acts
//! through the first sixteen samples of the body's impulse response, h_k = Σ b Im ρ^k. Both are exact but for rounding.

use fearless_simd::prelude::*;
use std::hint::black_box;

use fearless_simd::{Level, Simd, dispatch, f32x4, f32x16, f64x8};

/// Samples of a frame: one vector of AVX-512, four of SSE.
pub const FRAME: usize = 16;
/// Frames of a block.
pub const FRAMES: usize = 4;
/// Samples of a block.
pub const BLOCK: usize = FRAME * FRAMES;
/// Partials of a group: as many as a frame has samples, so that the same vectors hold them.
pub const GROUP: usize = 16;

/// Numbers of a group's partials: real parts, then imaginary ones.
pub(super) type Phasors<T> = [[T; GROUP]; 2];
/// The phasors at the start of each frame; aligned, so that no store crosses the lines that are read again at once.
#[repr(C, align(64))]
struct States([Phasors<f32>; FRAMES]);
/// Sums of a block: what the real parts gave, and the imaginary ones; apart, so that neither waits for the other. They
/// stay in registers from group to group where there are enough.
#[derive(Clone, Copy)]
pub(super) struct Sums<S: Simd> {
    re: [f32x16<S>; FRAMES],
    im: [f32x16<S>; FRAMES],
}

impl<S: Simd> Sums<S> {
    /// Silence.
    #[inline(always)]
    pub fn silent(simd: S) -> Self {
        let nothing = [f32x16::splat(simd, 0.0); FRAMES];
        Self { re: nothing, im: nothing }
    }

    /// The samples.
    #[inline(always)]
    pub fn samples(&self) -> [f32; BLOCK] {
        let mut samples = [0.0; BLOCK];
        for ((out, re), im) in samples.as_chunks_mut::<FRAME>().0.iter_mut().zip(self.re).zip(self.im) {
            *out = (re + im).into();
        }
        samples
    }
}

/// Rotators of a group's phasors from frame to frame and from block to block.
#[derive(Clone)]
struct BlockRotators {
    /// ρ^64.
    jump: Phasors<f64>,
    /// ρ^16, ρ^32, ρ^48.
    steps: [Phasors<f32>; FRAMES - 1],
}

/// Partials of a group: their rotators and phasors.
#[derive(Clone)]
#[repr(C, align(64))]
pub(super) struct Group {
    /// ρ^k of each partial, k = 0…15: real parts, imaginary ones.
    pub rows: [[[f32; FRAME]; 2]; GROUP],
    /// z at the start of the next block.
    pub state: Phasors<f64>,
    rotators: BlockRotators,
    /// Gain b of a force; real: now, and at the end of the next block, each frame a step on the way.
    pub push: [[f32; GROUP]; 2],
    /// Partials in use.
    pub count: usize,
}

impl Group {
    /// Without partials.
    pub fn empty() -> Self {
        Self {
            rows: [[[0.0; FRAME]; 2]; GROUP],
            state: [[0.0; GROUP]; 2],
            rotators: BlockRotators { jump: [[0.0; GROUP]; 2], steps: [[[0.0; GROUP]; 2]; FRAMES - 1] },
            push: [[0.0; GROUP]; 2],
            count: 0,
        }
    }

    /// The partial `i` turns by ρ per sample from now on.
    pub fn tune(&mut self, i: usize, rho: [f64; 2]) {
        let mut power = [1.0, 0.0];
        for k in 0..FRAME {
            (self.rows[i][0][k], self.rows[i][1][k]) = (power[0] as f32, power[1] as f32);
            power = times(power, rho);
        }
        let frame = power;
        for step in &mut self.rotators.steps {
            (step[0][i], step[1][i]) = (power[0] as f32, power[1] as f32);
            power = times(power, frame);
        }
        (self.rotators.jump[0][i], self.rotators.jump[1][i]) = (power[0], power[1]);
    }

    /// ρ^n of partial `i`, n ≤ [`BLOCK`], to f32's rounding.
    pub fn power(&self, i: usize, n: usize) -> [f64; 2] {
        let row = [self.rows[i][0][n % FRAME], self.rows[i][1][n % FRAME]].map(f64::from);
        match n / FRAME {
            0 => row,
            FRAMES => [self.rotators.jump[0][i], self.rotators.jump[1][i]],
            m => times(row, [self.rotators.steps[m - 1][0][i], self.rotators.steps[m - 1][1][i]].map(f64::from)),
        }
    }

    /// Σ |z|².
    #[inline(always)]
    pub fn energy(&self) -> f64 {
        let mut squares: [f64; GROUP] =
            std::array::from_fn(|i| self.state[0][i] * self.state[0][i] + self.state[1][i] * self.state[1][i]);
        let mut width = GROUP / 2;
        while width > 0 {
            for i in 0..width {
                squares[i] += squares[i + width];
            }
            width /= 2;
        }
        squares[0]
    }
}

/// Whether a level rounds a multiply-add once, which decides the bits of modal synthesis.
pub fn fuses(level: Level) -> bool {
    #[inline(always)]
    fn residue<S: Simd>(simd: S) -> f32 {
        // (1 + ε)(1 − ε) − 1 = −ε², of which a product that is rounded first leaves nothing.
        let [more, less, one] =
            black_box([1.0 + f32::EPSILON, 1.0 - f32::EPSILON, -1.0]).map(|x| f32x4::splat(simd, x));
        more.mul_add(less, one)[0]
    }
    dispatch!(level, simd => residue(simd)) != 0.0
}

/// Complex product.
#[inline(always)]
pub(super) fn times(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// Adds a block of the group's own ringing and moves its phasors to the next.
#[inline(always)]
pub(super) fn ring<S: Simd>(simd: S, group: &mut Group, sums: &mut Sums<S>) {
    let states = rotate(simd, &mut group.state, &group.rotators);
    read(simd, group, &states, sums);
}

/// As [`ring`] for a group that a force drives, without the immediate response ([`add_response`]).
#[inline(always)]
pub(super) fn ring_driven<S: Simd>(simd: S, group: &mut Group, force: &[f32; BLOCK], sums: &mut Sums<S>) {
    let mut states = rotate(simd, &mut group.state, &group.rotators);
    let load = |x: &Phasors<f32>| x.map(|part| -> f32x16<S> { part.simd_into(simd) });
    let silence = [f32x16::splat(simd, 0.0); 2];
    let mut driven = silence;
    let frame = load(&group.rotators.steps[0]);
    let rho = load(&std::array::from_fn(|part| std::array::from_fn(|i| group.rows[i][part][1])));
    let push = load(&group.push);
    for (m, force) in force.as_chunks::<FRAME>().0.iter().enumerate() {
        if m > 0 {
            let [re, im] = load(&states.0[m]);
            states.0[m] = [(re + driven[0]).into(), (im + driven[1]).into()];
        }
        let glide = m as f32 / FRAMES as f32;
        let mut d = silence;
        for f in force {
            let [re, im] = [d[0] + *f, d[1]];
            d = [re * rho[0] - im * rho[1], re * rho[1] + im * rho[0]];
        }
        let [re, im] = driven;
        let b = push[0] + (push[1] - push[0]) * glide;
        driven = [re * frame[0] - im * frame[1] + b * d[0], re * frame[1] + im * frame[0] + b * d[1]];
    }
    let driven: Phasors<f32> = driven.map(Into::into);
    for part in 0..2 {
        for i in 0..GROUP {
            group.state[part][i] += f64::from(driven[part][i]);
        }
    }
    read(simd, group, &states, sums);
}

/// Adds a block of other phasors that turn as this group's do, and moves them to the next.
#[inline(always)]
pub(super) fn ring_beside<S: Simd>(simd: S, group: &Group, phasors: &mut Phasors<f64>, sums: &mut Sums<S>) {
    let states = rotate(simd, phasors, &group.rotators);
    read(simd, group, &states, sums);
}

/// Adds what a force gives within its own frames through the first samples of the impulse response, which goes from one
/// to the other over the block.
pub(super) fn add_response(force: &[f32; BLOCK], [from, to]: &[[f32; FRAME]; 2], out: &mut [f32]) {
    let frames = force.as_chunks::<FRAME>().0.iter().zip(out.as_chunks_mut::<FRAME>().0);
    for (m, (force, out)) in frames.enumerate() {
        let glide = m as f32 / FRAMES as f32;
        let h: [f32; FRAME] = std::array::from_fn(|k| from[k] + glide * (to[k] - from[k]));
        for (k, f) in force.iter().enumerate() {
            for (y, h) in out[k..].iter_mut().zip(&h) {
                *y += f * h;
            }
        }
    }
}

/// The phasors at the start of each frame; `z` moves on to the next block.
#[inline(always)]
fn rotate<S: Simd>(simd: S, z: &mut Phasors<f64>, group: &BlockRotators) -> States {
    let [low, high] = [0, 8];
    let load = |x: &[f64; GROUP], from: usize| f64x8::from_slice(simd, &x[from..from + 8]);
    let mut narrow = [f32x16::splat(simd, 0.0); 2];
    for part in 0..2 {
        narrow[part] = load(&z[part], low).narrow(load(&z[part], high));
    }
    let [re, im] = narrow;
    for from in [low, high] {
        let (re, im) = (load(&z[0], from), load(&z[1], from));
        let (jump_re, jump_im) = (load(&group.jump[0], from), load(&group.jump[1], from));
        (re * jump_re - im * jump_im).store_slice(&mut z[0][from..from + 8]);
        (re * jump_im + im * jump_re).store_slice(&mut z[1][from..from + 8]);
    }
    let mut states = States([[[0.0; GROUP]; 2]; FRAMES]);
    states.0[0] = [re.into(), im.into()];
    for (state, step) in states.0[1..].iter_mut().zip(&group.steps) {
        let (step_re, step_im): (f32x16<S>, f32x16<S>) = (step[0].simd_into(simd), step[1].simd_into(simd));
        state[0] = re.mul_add(step_re, -(im * step_im)).into();
        state[1] = re.mul_add(step_im, im * step_re).into();
    }
    states
}

/// As many frames at once as registers allow; the bits do not depend on it.
#[inline(always)]
fn read<S: Simd>(simd: S, group: &Group, states: &States, sums: &mut Sums<S>) {
    match S::f32s::LEN {
        16 => read_at_once::<S, 4>(simd, group, states, sums),
        8 => read_at_once::<S, 2>(simd, group, states, sums),
        _ => read_at_once::<S, 1>(simd, group, states, sums),
    }
}

#[inline(always)]
fn read_at_once<S: Simd, const N: usize>(simd: S, group: &Group, states: &States, sums: &mut Sums<S>) {
    for first in (0..FRAMES).step_by(N) {
        let mut a: [f32x16<S>; N] = std::array::from_fn(|m| sums.re[first + m]);
        let mut b: [f32x16<S>; N] = std::array::from_fn(|m| sums.im[first + m]);
        for (i, [re, im]) in group.rows[..group.count.min(GROUP)].iter().enumerate() {
            let re: f32x16<S> = f32x16::from_slice(simd, re);
            let im: f32x16<S> = f32x16::from_slice(simd, im);
            for m in 0..N {
                a[m] = f32x16::splat(simd, states.0[first + m][0][i]).mul_add(im, a[m]);
                b[m] = f32x16::splat(simd, states.0[first + m][1][i]).mul_add(re, b[m]);
            }
        }
        sums.re[first..first + N].copy_from_slice(&a);
        sums.im[first..first + N].copy_from_slice(&b);
    }
}
