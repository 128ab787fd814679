//! Contacts of what sleeps (`dynamics/sleep.rs`): left out, the forces there kept, until somebody comes.

use super::problem::Source;
use super::sweep::Hit;
use super::{Contacts, Held};
use crate::collision::{Manifold, Sweep, TOUCH};
use soffio_geometry::bodies::RigidBody;

impl Contacts {
    /// Leaves out what touches among bodies that sleep, and takes up again what no longer does.
    pub(in crate::dynamics) fn let_sleep(&mut self, asleep: &[bool], bodies: &[RigidBody]) {
        self.asleep.copy_from_slice(asleep);
        for (body, sweep) in self.sweeps.iter_mut().enumerate().filter(|(body, _)| asleep[*body]) {
            *sweep = Sweep::new(&bodies[body], &bodies[body]);
        }
        self.broad.let_sleep(asleep);
        self.limits.let_sleep(asleep);
        let sleeps = |held: &Held| held.ends.iter().flatten().any(|lever| asleep[lever.body]);
        let moves = |from: &mut Vec<Held>, to: &mut Vec<Held>, which: bool| {
            to.extend(from.iter().filter(|held| sleeps(held) == which));
            from.retain(|held| sleeps(held) != which);
        };
        moves(&mut self.held, &mut self.kept, true);
        moves(&mut self.kept, &mut self.held, false);
        let bounds = (0..self.limits.count()).filter(|&bound| self.limits.resting(bound) && self.limits.sleeps(bound));
        let pairs = self.at_rest.iter().filter(|&&pair| self.sleeps(pair));
        self.asleep_at_rest = bounds.count() + pairs.count();
    }

    /// Is a pair between bodies that sleep, or one that does and the world?
    pub(super) fn sleeps(&self, pair: usize) -> bool {
        self.bodies_of(pair).into_iter().flatten().all(|body| self.asleep[body])
    }

    /// The body of a pair that sleeps while the other one does not.
    fn sleeper(&self, pair: usize) -> Option<usize> {
        match self.bodies_of(pair) {
            [Some(a), Some(b)] if self.asleep[a] != self.asleep[b] => Some(if self.asleep[a] { a } else { b }),
            _ => None,
        }
    }

    /// The two bodies of everything that lies on each other.
    pub(in crate::dynamics) fn leaning(&self) -> impl Iterator<Item = [Option<usize>; 2]> {
        self.at_rest.iter().map(|&pair| self.bodies_of(pair))
    }

    /// A body that sleeps while something leans on it that does not.
    pub(in crate::dynamics) fn leant_on(&self) -> Option<usize> {
        self.at_rest.iter().find_map(|&pair| self.sleeper(pair))
    }

    /// A body that sleeps and is about to feel a hit: it is hit itself, or touches what moves.
    pub(in crate::dynamics) fn shaken(&mut self, hit: &Hit, bodies: &[RigidBody]) -> Option<usize> {
        self.find_near(bodies, bodies);
        for near in 0..self.near.len() {
            let pair = self.near[near];
            let Some(sleeper) = self.sleeper(pair) else { continue };
            let touches = |manifold: Manifold| manifold.points().iter().any(|at| at.gap <= TOUCH);
            if hit.source == Source::Pair(pair)
                || (self.may_touch(pair, bodies) && touches(self.manifold(pair, bodies)))
            {
                return Some(sleeper);
            }
        }
        None
    }

    /// Enters work that is no contact's: what a body had left when it was put to rest, J.
    pub(in crate::dynamics) fn lose(&mut self, energy: f64) {
        self.work -= energy;
    }
}
