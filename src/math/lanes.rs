//! Four numbers side by side, and the same formula for four bodies or for one.
//!
//! The numbers of bodies in hot loops are stored in lane blocks of four: number k of a [`Four`] belongs to the body
//! in lane k. A formula is written once, over a [`Real`]; [`Lanes`] selects all four lanes, as one vector of the
//! processor, or one of them. Vectors are added, multiplied and divided number by number, each rounded as IEEE 754
//! says and nothing fused, so the bits are the same on every processor and for either choice (a test checks that).
//!
//! `fearless_simd::dispatch!` makes a loop for each set of vector instructions that `.cargo/config.toml` leaves (SSE2 and
//! AVX2 on x86-64; without that file all four), and takes the best that the processor has. Whatever such a loop calls must
//! be inlined into it: hence `#[inline(always)]`.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4};

use super::{DQuat, DVec3};

/// Lanes of a block.
pub const WIDTH: usize = 4;

/// A number of each body of a lane block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub struct Four(pub [f64; WIDTH]);

impl Four {
    /// The same number in all four lanes.
    #[inline]
    pub const fn splat(x: f64) -> Self {
        Self([x; WIDTH])
    }
}

/// What a formula calculates with: a number, or four.
pub trait Real:
    Copy
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + AddAssign
    + SubAssign
{
    /// A constant, of this one's kind.
    fn all(self, x: f64) -> Self;
}

impl Real for f64 {
    #[inline(always)]
    fn all(self, x: f64) -> Self {
        x
    }
}

impl<S: Simd> Real for f64x4<S> {
    #[inline(always)]
    fn all(self, x: f64) -> Self {
        Self::splat(self.simd, x)
    }
}

/// Lanes that a formula computes: all four, or one.
pub trait Lanes: Copy {
    /// What it calculates with.
    type T: Real;

    /// The numbers of these bodies, in the order of the lanes.
    fn gather(self, number: impl Fn(usize) -> f64) -> Self::T;

    /// N numbers of each of these bodies.
    fn rows<'a, const N: usize>(self, of: impl Fn(usize) -> &'a [f64; N]) -> [Self::T; N];

    /// Scatters: calls `to` with each lane and its N numbers, the last lane first, for the first `count` lanes.
    fn scatter<const N: usize>(self, count: usize, x: &[Self::T; N], to: impl FnMut(usize, &[f64; N]));

    /// The number of one body.
    fn lane(self, x: &Self::T, lane: usize) -> f64;

    /// Reads.
    fn get(self, from: &Four) -> Self::T;

    /// Writes.
    fn put(self, to: &mut Four, x: Self::T);
}

/// All four.
#[derive(Clone, Copy, Debug)]
pub struct All<S>(pub S);

/// One of the four.
#[derive(Clone, Copy, Debug)]
pub struct One(pub usize);

impl<S: Simd> Lanes for All<S> {
    type T = f64x4<S>;

    #[inline(always)]
    fn gather(self, number: impl Fn(usize) -> f64) -> Self::T {
        [number(0), number(1), number(2), number(3)].simd_into(self.0)
    }

    #[inline(always)]
    fn rows<'a, const N: usize>(self, of: impl Fn(usize) -> &'a [f64; N]) -> [Self::T; N] {
        let rows = [of(0), of(1), of(2), of(3)];
        let mut out = [f64x4::splat(self.0, 0.0); N];
        let mut n = 0;
        while n + WIDTH <= N {
            let four = transposed([
                f64x4::from_slice(self.0, &rows[0][n..n + WIDTH]),
                f64x4::from_slice(self.0, &rows[1][n..n + WIDTH]),
                f64x4::from_slice(self.0, &rows[2][n..n + WIDTH]),
                f64x4::from_slice(self.0, &rows[3][n..n + WIDTH]),
            ]);
            out[n..n + WIDTH].copy_from_slice(&four);
            n += WIDTH;
        }
        while n < N {
            out[n] = [rows[0][n], rows[1][n], rows[2][n], rows[3][n]].simd_into(self.0);
            n += 1;
        }
        out
    }

    #[inline(always)]
    fn scatter<const N: usize>(self, count: usize, x: &[Self::T; N], mut to: impl FnMut(usize, &[f64; N])) {
        let mut out = [[0.0; N]; WIDTH];
        let mut n = 0;
        while n + WIDTH <= N {
            let four = transposed([x[n], x[n + 1], x[n + 2], x[n + 3]]);
            for k in 0..WIDTH {
                four[k].store_slice(&mut out[k][n..n + WIDTH]);
            }
            n += WIDTH;
        }
        while n < N {
            for k in 0..WIDTH {
                out[k][n] = x[n][k];
            }
            n += 1;
        }
        for lane in (0..WIDTH).rev() {
            if lane < count {
                to(lane, &out[lane]);
            }
        }
    }

    #[inline(always)]
    fn lane(self, x: &Self::T, lane: usize) -> f64 {
        x[lane]
    }

    #[inline(always)]
    fn get(self, from: &Four) -> Self::T {
        from.0.simd_into(self.0)
    }

    #[inline(always)]
    fn put(self, to: &mut Four, x: Self::T) {
        to.0 = x.into();
    }
}

/// Rows for columns.
#[inline(always)]
fn transposed<S: Simd>(rows: [f64x4<S>; 4]) -> [f64x4<S>; 4] {
    let [a, b, c, d] = rows;
    let (low, high) = ((a.zip_low(c), b.zip_low(d)), (a.zip_high(c), b.zip_high(d)));
    [low.0.zip_low(low.1), low.0.zip_high(low.1), high.0.zip_low(high.1), high.0.zip_high(high.1)]
}

impl Lanes for One {
    type T = f64;

    #[inline(always)]
    fn gather(self, number: impl Fn(usize) -> f64) -> f64 {
        number(self.0)
    }

    #[inline(always)]
    fn rows<'a, const N: usize>(self, of: impl Fn(usize) -> &'a [f64; N]) -> [f64; N] {
        *of(self.0)
    }

    #[inline(always)]
    fn scatter<const N: usize>(self, _: usize, x: &[f64; N], mut to: impl FnMut(usize, &[f64; N])) {
        to(self.0, x);
    }

    #[inline(always)]
    fn lane(self, x: &f64, _: usize) -> f64 {
        *x
    }

    #[inline(always)]
    fn get(self, from: &Four) -> f64 {
        from.0[self.0]
    }

    #[inline(always)]
    fn put(self, to: &mut Four, x: f64) {
        to.0[self.0] = x;
    }
}

/// Three numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct V3<T> {
    /// x.
    pub x: T,
    /// y.
    pub y: T,
    /// z.
    pub z: T,
}

impl<T> V3<T> {
    /// From its parts.
    #[inline(always)]
    pub const fn new(x: T, y: T, z: T) -> Self {
        Self { x, y, z }
    }
}

impl<T: Real> V3<T> {
    /// Sum of the products.
    #[inline(always)]
    pub fn dot(self, v: Self) -> T {
        self.x * v.x + self.y * v.y + self.z * v.z
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, v: Self) -> Self {
        Self { x: self.y * v.z - v.y * self.z, y: self.z * v.x - v.z * self.x, z: self.x * v.y - v.x * self.y }
    }

    /// Part by part.
    #[inline(always)]
    pub fn times(self, v: Self) -> Self {
        Self { x: self.x * v.x, y: self.y * v.y, z: self.z * v.z }
    }
}

impl V3<Four> {
    /// Reads.
    #[inline(always)]
    pub fn get<L: Lanes>(&self, lanes: L) -> V3<L::T> {
        V3 { x: lanes.get(&self.x), y: lanes.get(&self.y), z: lanes.get(&self.z) }
    }

    /// Writes.
    #[inline(always)]
    pub fn put<L: Lanes>(&mut self, lanes: L, v: V3<L::T>) {
        lanes.put(&mut self.x, v.x);
        lanes.put(&mut self.y, v.y);
        lanes.put(&mut self.z, v.z);
    }
}

impl<T: Real> Neg for V3<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z }
    }
}

impl<T: Real> Add for V3<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, v: Self) -> Self {
        Self { x: self.x + v.x, y: self.y + v.y, z: self.z + v.z }
    }
}

impl<T: Real> Sub for V3<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, v: Self) -> Self {
        Self { x: self.x - v.x, y: self.y - v.y, z: self.z - v.z }
    }
}

impl<T: Real> Mul<T> for V3<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: T) -> Self {
        Self { x: self.x * s, y: self.y * s, z: self.z * s }
    }
}

impl<T: Real> AddAssign for V3<T> {
    #[inline(always)]
    fn add_assign(&mut self, v: Self) {
        *self = *self + v;
    }
}

impl<T: Real> SubAssign for V3<T> {
    #[inline(always)]
    fn sub_assign(&mut self, v: Self) {
        *self = *self - v;
    }
}

/// A quaternion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quat<T> {
    /// Imaginary part.
    pub v: V3<T>,
    /// Real part.
    pub w: T,
}

impl<T: Real> Quat<T> {
    /// Product.
    #[inline(always)]
    pub fn times(self, q: Self) -> Self {
        let p = self;
        Self { v: q.v * p.w + p.v * q.w + p.v.cross(q.v), w: p.w * q.w - p.v.dot(q.v) }
    }

    /// As [`super::renormalized`].
    #[inline(always)]
    pub fn renormalized(self) -> Self {
        let s = self.w.all(1.5) - self.w.all(0.5) * (self.v.dot(self.v) + self.w * self.w);
        Self { v: self.v * s, w: self.w * s }
    }

    /// As [`super::rotation`], to the bit.
    #[inline(always)]
    pub fn of_turn<L: Lanes<T = T>>(lanes: L, w: V3<T>) -> Self {
        let x = w.x.all(0.25) * w.dot(w);
        let small = (0..WIDTH).all(|k| lanes.lane(&x, k) < super::SMALL);
        if small {
            let (s, c) = super::small_turn(x);
            return Self { v: w * s, w: c };
        }
        Self::gather(lanes, |k| {
            super::rotation(DVec3::new(lanes.lane(&w.x, k), lanes.lane(&w.y, k), lanes.lane(&w.z, k)))
        })
    }

    /// Of each body.
    #[inline(always)]
    pub fn gather<L: Lanes<T = T>>(lanes: L, of: impl Fn(usize) -> DQuat) -> Self {
        let rows: [[f64; 4]; WIDTH] = std::array::from_fn(|k| of(k).to_array());
        let [x, y, z, w] = lanes.rows(|k| &rows[k]);
        Self { v: V3 { x, y, z }, w }
    }
}

impl Quat<Four> {
    /// Reads.
    #[inline(always)]
    pub fn get<L: Lanes>(&self, lanes: L) -> Quat<L::T> {
        Quat { v: self.v.get(lanes), w: lanes.get(&self.w) }
    }

    /// Writes.
    #[inline(always)]
    pub fn put<L: Lanes>(&mut self, lanes: L, q: &Quat<L::T>) {
        self.v.put(lanes, q.v);
        lanes.put(&mut self.w, q.w);
    }
}

impl From<DVec3> for V3<f64> {
    #[inline(always)]
    fn from(v: DVec3) -> Self {
        Self { x: v.x, y: v.y, z: v.z }
    }
}

impl From<V3<f64>> for DVec3 {
    #[inline(always)]
    fn from(v: V3<f64>) -> Self {
        Self::new(v.x, v.y, v.z)
    }
}
