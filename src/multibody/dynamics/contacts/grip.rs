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

use super::problem::{Problem, Source, Touch};
use super::{Contacts, Held, Lever};
use crate::articulation::System;
use crate::dynamics::clutches::Clutches;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;

/// ω₁: a clutch that slips so fast carries twice its torque, rad/s.
const GREASE: f64 = 0.5;

/// What a clutch that slips may carry.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grip {
    clutch: usize,
    /// τ h, N m s.
    most: f64,
    /// Would it carry too much if it took hold?
    slips: bool,
}

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

impl Grip {
    /// x of what slips, nothing of what holds.
    fn yields(&self) -> f64 {
        if self.slips { GREASE / self.most } else { 0.0 }
    }
}

impl Contacts {
    /// Adds what slips to the problem of a substep of `h` seconds.
    pub(super) fn push_clutches(&mut self, h: f64, system: &System) {
        for (index, clutch) in self.clutches.slipping() {
            // Nothing is moved out of it: it has no gap to speak of.
            let source = Source::Bound(self.limits.count() + index);
            let mut touch = Touch::new(source, DVec3::ZERO, DVec3::ZERO, f64::INFINITY, 0.0);
            touch.grip = Some(Grip { clutch: index, most: clutch.torque * h, slips: false });
            self.problem.push(touch, &[self.clutches.row(index, 1.0, system)]);
        }
    }

    /// Keeps the forces that the substep begins with, for the case that it is gone through again.
    pub(in crate::dynamics) fn begin_substep(&mut self) {
        if self.clutches.any_holds() {
            self.began.clone_from(&self.held);
        }
    }

    /// Lets slip what carries too much at the end of a pass. Did anything? Then the substep is to be gone through
    /// again, and begins as it did, with what the clutch carried.
    pub(super) fn give_way(&mut self, system: &mut System) -> bool {
        let Self { clutches, held, began, limits, span, .. } = self;
        let slips = clutches.give_way(system, |index, row, load| {
            let still =
                |(body, block)| Lever { body, block, block_change: [0.0; 6], arm: DVec3::ZERO, way: DVec3::ZERO };
            began.push(Held {
                source: Source::Bound(limits.count() + index),
                couple: false,
                point: DVec3::ZERO,
                force: DVec3::X * load,
                span: *span,
                normal: DVec3::ZERO,
                turn: DVec3::ZERO,
                ends: row.ends.map(|end| end.map(still)),
            });
        });
        if slips {
            held.clone_from(began);
        }
        slips
    }

    /// Lets hold what has come to rest in a substep of `h` seconds that stands. Did anything? Then rows act that did not.
    pub(in crate::dynamics) fn take_hold(&mut self, h: f64, system: &mut System, bodies: &[RigidBody]) -> bool {
        let mut any = false;
        for touch in &self.problem.touches {
            let Some(grip) = touch.grip.filter(|grip| !grip.slips) else { continue };
            let constraint = self.clutches.take_hold(grip.clutch, touch.impulse.x / h);
            system.take_hold(constraint, bodies);
            self.held.retain(|held| held.source != touch.source);
            any = true;
        }
        any
    }

    /// The clutches.
    pub(in crate::dynamics) fn clutches(&self) -> &Clutches {
        &self.clutches
    }
}
