//! Groups: bodies that belong together because something is between them.

/// Bodies in groups, each known by its first body, whatever the order in which they were joined.
#[derive(Clone, Debug, Default)]
pub struct Groups(Vec<usize>);

impl Groups {
    /// So many bodies, each alone.
    pub fn new(bodies: usize) -> Self {
        Self((0..bodies).collect())
    }

    /// The first body of a body's group.
    pub fn first(&self, body: usize) -> usize {
        let mut at = body;
        while self.0[at] != at {
            at = self.0[at];
        }
        at
    }

    /// Puts the groups of two bodies together.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.first(a), self.first(b));
        self.0[a.max(b)] = a.min(b);
    }

    /// Puts the groups of all these bodies together.
    pub fn join_all(&mut self, bodies: impl IntoIterator<Item = usize>) {
        let mut bodies = bodies.into_iter();
        if let Some(first) = bodies.next() {
            bodies.for_each(|body| self.join(first, body));
        }
    }

    /// Takes over what others are joined.
    pub fn copy(&mut self, other: &Self) {
        self.0.copy_from_slice(&other.0);
    }
}
