//! Sleeping bodies (`dynamics/sleep.rs`) as the contacts need them.

/// Which bodies sleep, and how many resting contacts are among them.
#[derive(Clone, Debug)]
pub(super) struct SleepingBodies {
    /// Whether each body sleeps.
    pub bodies: Vec<bool>,
    /// Number of resting pairs and bounds whose bodies all sleep.
    pub resting: usize,
}

impl SleepingBodies {
    /// All of so many bodies are awake.
    pub fn new(bodies: usize) -> Self {
        Self { bodies: vec![false; bodies], resting: 0 }
    }

    /// Whether both bodies sleep, or one of them if the other is the world.
    pub fn both(&self, bodies: [Option<usize>; 2]) -> bool {
        bodies.into_iter().flatten().all(|body| self.bodies[body])
    }

    /// The one of two bodies that sleeps while the other is awake.
    pub fn one_of(&self, bodies: [Option<usize>; 2]) -> Option<usize> {
        match bodies {
            [Some(a), Some(b)] if self.bodies[a] != self.bodies[b] => Some(if self.bodies[a] { a } else { b }),
            _ => None,
        }
    }
}
