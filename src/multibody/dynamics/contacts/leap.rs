//! Leaps: the contact problem's linear system, for touches that are taken to go on as they are.
//!
//! Touches that press and stick have three unknowns each, those that slide one (the normal impulse, friction going with
//! it): a step of Newton's method on the contact laws (P. Alart and A. Curnier, A mixed formulation for frictional
//! contact problems prone to Newton like solution methods, 1991), damped so that no touch leaves its cone.

use super::problem::Problem;
use super::touch::{Active, PROXIMAL, ROUNDING, Touch};
use soffio_math::{DVec2, DVec3};

/// A leap that changes an impulse by more than this times the velocities it is to correct leads nowhere.
const MOST_LEAP: f64 = 1e10;
/// What presses less than this share of the largest impulse does not hinder a leap.
const SLIGHT: f64 = 1e-3;

impl Problem {
    /// Solves at once for all touches that press, each taken to go on sticking, or sliding the way it does.
    pub(super) fn leap(&mut self) {
        self.find_active();
        if !self.solve_active() {
            return;
        }
        for touch in &mut self.touches {
            touch.leap = DVec3::ZERO;
        }
        for (active, x) in self.active.iter().zip(&self.other) {
            self.touches[active.touch].leap += active.along * x;
        }
        self.go_along();
    }

    /// Finds the unknowns: those of each touch that presses.
    fn find_active(&mut self) {
        self.active.clear();
        for (index, touch) in self.touches.iter().enumerate() {
            if let Some(twist) = &touch.twist {
                let [spin, roll] = self.holds(touch, twist);
                let held = [(spin, DVec3::X), (roll, DVec3::Y), (roll, DVec3::Z)].into_iter().filter(|(held, _)| *held);
                self.active.extend(held.map(|(_, along)| Active { touch: index, along, test: along }));
                continue;
            }
            if touch.impulse.x <= 0.0 || touch.grip.is_some() {
                continue;
            }
            let most = touch.friction * touch.impulse.x;
            let rub = DVec2::new(touch.impulse.y, touch.impulse.z);
            // Slides where friction is all there can be, and opposes the slip: else the cone only caught it by the way.
            let u = self.velocity(touch);
            let slip = DVec2::new(u.y, u.z);
            let slides = rub.length() >= most * (1.0 - ROUNDING) && slip.dot(rub) < -0.5 * slip.length() * rub.length();
            if touch.rows == 3 && most > 0.0 && !slides {
                self.active.extend([DVec3::X, DVec3::Y, DVec3::Z].map(|along| Active {
                    touch: index,
                    along,
                    test: along,
                }));
            } else {
                let along = if touch.rows == 3 { (touch.impulse / touch.impulse.x).with_x(1.0) } else { DVec3::X };
                self.active.push(Active { touch: index, along, test: DVec3::X });
            }
        }
    }

    /// Solves for the unknowns, into `other`. False where that leads nowhere.
    fn solve_active(&mut self) -> bool {
        let (n, count) = (self.rows.len(), self.active.len());
        for (i, at) in self.active.iter().enumerate() {
            let first = self.touches[at.touch].first + at.test.max_position();
            let line = &self.w[first * n..][..n];
            for (j, by) in self.active.iter().enumerate() {
                let touch = &self.touches[by.touch];
                let column = &line[touch.first..touch.first + touch.rows];
                self.matrix[i * count + j] = column.iter().enumerate().map(|(k, w)| w * by.along[k]).sum();
            }
            let touch = &self.touches[at.touch];
            self.matrix[i * count + i] += PROXIMAL * touch.k.x_axis.x.max(touch.tangential);
            let least = if at.test == DVec3::X { touch.least } else { 0.0 };
            self.other[i] = least - self.u[first];
        }
        let wanted = self.other[..count].iter().fold(0.0, |most: f64, u| most.max(u.abs()));
        if !eliminate(&mut self.matrix[..count * count], &mut self.other[..count]) {
            return false;
        }
        // What no impulse can do asks for endless ones.
        let sane = |(at, x): (&Active, &f64)| (x * self.touches[at.touch].k.x_axis.x).abs() < MOST_LEAP * wanted;
        self.active.iter().zip(&self.other[..count]).all(sane)
    }

    /// Lets the touches go along their leaps.
    fn go_along(&mut self) {
        // As far as all that press to speak of keep to the laws: what stops it opens or slides from there on.
        let points = || self.touches.iter().filter(|touch| touch.pushes());
        let largest = points().fold(0.0, |most: f64, touch| most.max(touch.impulse.x));
        let far = points()
            .filter(|touch| touch.impulse.x > SLIGHT * largest)
            .fold(1.0, |far: f64, touch| far.min(touch.most_leap()));
        // Couples do not hinder it: one that leaps beyond its bounds stays on them.
        for index in 0..self.touches.len() {
            let touch = &self.touches[index];
            if touch.grip.is_some() {
                continue;
            }
            let to = touch.impulse + far * touch.leap;
            if let Some(twist) = touch.twist {
                self.set(index, self.bounded_twist(&twist, to));
                continue;
            }
            let normal = to.x.max(0.0);
            let rub = DVec2::new(to.y, to.z).clamp_length_max(touch.friction * normal);
            self.set(index, DVec3::new(normal, rub.x, rub.y));
        }
    }
}

impl Touch {
    /// Share of its leap, up to 1, that keeps it pressing and within the cone.
    fn most_leap(&self) -> f64 {
        let (p, d) = (self.impulse, self.leap);
        let open = if p.x + d.x < 0.0 { p.x / -d.x } else { 1.0 };
        if self.rows == 1 || self.friction == 0.0 {
            return open;
        }
        // |p_T + x d_T|² = μ² (p_n + x d_n)²: the root beyond which it is outside. Sliding ones stay on the cone.
        let mu2 = self.friction * self.friction;
        let a = d.y * d.y + d.z * d.z - mu2 * d.x * d.x;
        let b = p.y * d.y + p.z * d.z - mu2 * p.x * d.x;
        let c = p.y * p.y + p.z * p.z - mu2 * p.x * p.x;
        if c >= -ROUNDING * mu2 * p.x * p.x || a + 2.0 * b + c <= 0.0 {
            return open;
        }
        let root = (b * b - a * c).max(0.0).sqrt();
        open.min(-c / (b + root))
    }
}

/// Solves the system of a row-major square matrix in place by elimination with row pivots; false where it is singular.
fn eliminate(matrix: &mut [f64], b: &mut [f64]) -> bool {
    let n = b.len();
    for column in 0..n {
        let pivot = (column..n).fold(column, |best, row| {
            if matrix[row * n + column].abs() > matrix[best * n + column].abs() { row } else { best }
        });
        if matrix[pivot * n + column] == 0.0 {
            return false;
        }
        if pivot != column {
            let (above, below) = matrix.split_at_mut(pivot * n);
            above[column * n..][..n].swap_with_slice(&mut below[..n]);
            b.swap(column, pivot);
        }
        let (above, below) = matrix.split_at_mut((column + 1) * n);
        let line = &above[column * n..];
        for (row, values) in below.chunks_exact_mut(n).enumerate() {
            let share = values[column] / line[column];
            if share != 0.0 {
                for k in column + 1..n {
                    values[k] -= share * line[k];
                }
                b[column + 1 + row] -= share * b[column];
            }
        }
    }
    for row in (0..n).rev() {
        let line = &matrix[row * n..][..n];
        let sum = (row + 1..n).fold(b[row], |sum, k| sum - line[k] * b[k]);
        b[row] = sum / line[row];
    }
    b.iter().all(|x| x.is_finite())
}
