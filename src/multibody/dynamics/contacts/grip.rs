//! Clutches that slip (`dynamics/clutches.rs`), as touches among those that rest: what they carry is found with the forces
//! of all contacts, so that none presses harder than they let it.
//!
//! With u = q̇ the rate of the coupling at the substep's end, P the impulse on it over the substep's h seconds, k its answer
//! to a unit of impulse and w = u − k P the rate without it,
//!
//! ```text
//! |w/k| ≤ τ h     u = 0                          it takes hold
//! else            P = −τ h (sign w + u/ω₁)       or  u + x P = −x τ h sign w  with  x = ω₁/(τ h)
//! ```
//!
//! taken at the end, so that neither what is light swings about its rest, nor what is pulled hard is flung away. Rounds would
//! be long in finding P, where a light hand sits on a heavy train; so a clutch's own equation is solved for it once and for
//! all, which is the exchange of P and u in W (a principal pivot), and the rounds go over the others.

use super::problem::Problem;
use soffio_math::DVec3;

impl Problem {
    /// Solves for the impulses of all touches with those of the clutches in exchange for their rates: first as if all of these
    /// took hold, then with those slipping that would carry too much.
    pub(super) fn among_clutches(&mut self, solve: impl Fn(&mut Self) -> bool) -> bool {
        loop {
            let first = self.touches.iter().position(|touch| touch.grip.is_some());
            let Some(first) = first else { return solve(self) };
            let end = first + self.touches[first..].iter().take_while(|touch| touch.grip.is_some()).count();
            (first..end).for_each(|index| self.bind(index));
            self.take_blocks();
            let settled = solve(self);
            (first..end).rev().for_each(|index| self.unbind(index));
            self.take_blocks();
            let mut gives = false;
            for touch in &mut self.touches[first..end] {
                let Some(grip) = &mut touch.grip else { continue };
                if !grip.slips && touch.impulse.x.abs() > grip.most {
                    (grip.slips, gives) = (true, true);
                }
            }
            if !gives {
                return settled;
            }
        }
    }

    /// Lets a clutch satisfy its law, and go on doing so whatever the other impulses: its place in `u` is its impulse.
    fn bind(&mut self, index: usize) {
        let (n, touch) = (self.rows.len(), &self.touches[index]);
        let Some(grip) = touch.grip else { return };
        let (row, p, yields) = (touch.first, touch.impulse.x, grip.yields());
        let more = (yields * (grip.most.copysign(p) - p) - self.u[row]) / (self.w[row * n + row] + yields);
        self.set(index, DVec3::X * (p + more));
        self.w[row * n + row] += yields;
        self.exchange(row);
        self.u[row] = p + more;
    }

    /// Takes back [`Problem::bind`], with the impulse that it has come to.
    fn unbind(&mut self, index: usize) {
        let n = self.rows.len();
        let Some(grip) = self.touches[index].grip else { return };
        let (row, yields) = (self.touches[index].first, grip.yields());
        let p = self.u[row];
        self.exchange(row);
        self.w[row * n + row] -= yields;
        self.u[row] = yields * (grip.most.copysign(p) - p);
        self.touches[index].impulse.x = p;
    }

    /// Exchanges impulse and velocity of a row in W; a second time it takes this back.
    fn exchange(&mut self, row: usize) {
        let n = self.rows.len();
        let pivot = self.w[row * n + row];
        for other in (0..n).filter(|&other| other != row) {
            // What an impulse on the other row does to this one, which the exchange turns into what it asks of it.
            let share = self.w[other * n + row] / pivot;
            for k in (0..n).filter(|&k| k != row) {
                self.w[other * n + k] -= share * self.w[row * n + k];
            }
            self.w[other * n + row] = -share;
        }
        for k in (0..n).filter(|&k| k != row) {
            self.w[row * n + k] /= pivot;
        }
        self.w[row * n + row] = pivot.recip();
    }
}
