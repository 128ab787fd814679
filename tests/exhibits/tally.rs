//! What must be seen often enough in all exhibits together.

use std::sync::atomic::{AtomicUsize, Ordering};

/// A sum over all exhibits. It is judged once each of them has had its turn, so a filtered run judges nothing.
pub struct Tally {
    what: &'static str,
    /// The sum must be larger.
    least: usize,
    sum: AtomicUsize,
    exhibits: AtomicUsize,
}

impl Tally {
    pub const fn new(what: &'static str, least: usize) -> Self {
        Self { what, least, sum: AtomicUsize::new(0), exhibits: AtomicUsize::new(0) }
    }

    /// Adds what one exhibit showed.
    pub fn add(&self, seen: usize) {
        self.sum.fetch_add(seen, Ordering::Relaxed);
        self.exhibits.fetch_add(1, Ordering::Relaxed);
    }

    /// False, with a sentence on stderr, where all exhibits together showed too little.
    pub fn is_enough(&self, exhibits: usize) -> bool {
        let (sum, done) = (self.sum.load(Ordering::Relaxed), self.exhibits.load(Ordering::Relaxed));
        let enough = done < exhibits || sum > self.least;
        if !enough {
            eprintln!("all exhibits together: only {sum} {}, which must be more than {}", self.what, self.least);
        }
        enough
    }
}
