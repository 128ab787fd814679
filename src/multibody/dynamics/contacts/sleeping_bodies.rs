//! Who sleeps (`dynamics/sleep.rs`), as contacts see it.

/// Bodies that sleep, and how much of what rests is among them.
#[derive(Clone, Debug)]
pub(super) struct SleepingBodies {
    /// Whether each body sleeps.
    pub bodies: Vec<bool>,
    /// How many of the pairs and bounds at rest are between such.
    pub at_rest: usize,
}

impl SleepingBodies {
    /// Of so many bodies nobody sleeps.
    pub fn new(bodies: usize) -> Self {
        Self { bodies: vec![false; bodies], at_rest: 0 }
    }

    /// Do both of two bodies sleep, or one of them if the other is the world?
    pub fn sleep(&self, two: [Option<usize>; 2]) -> bool {
        two.into_iter().flatten().all(|body| self.bodies[body])
    }

    /// The one of two bodies that sleeps while the other one does not.
    pub fn one_of(&self, two: [Option<usize>; 2]) -> Option<usize> {
        match two {
            [Some(a), Some(b)] if self.bodies[a] != self.bodies[b] => Some(if self.bodies[a] { a } else { b }),
            _ => None,
        }
    }
}
