//! Disjoint-set forest (union–find) of bodies.

/// Disjoint sets of bodies. The representative is the lowest index, whatever the order of the unions.
#[derive(Clone, Debug, Default)]
pub struct DisjointSets(Vec<usize>);

impl DisjointSets {
    /// `bodies` sets of one body each.
    pub fn new(bodies: usize) -> Self {
        Self((0..bodies).collect())
    }

    /// Representative of a body's set: its lowest index.
    pub fn first(&self, body: usize) -> usize {
        let mut at = body;
        while self.0[at] != at {
            at = self.0[at];
        }
        at
    }

    /// Unites the sets of two bodies.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.first(a), self.first(b));
        self.0[a.max(b)] = a.min(b);
    }

    /// Unites the sets of all these bodies.
    pub fn join_all(&mut self, bodies: impl IntoIterator<Item = usize>) {
        let mut bodies = bodies.into_iter();
        if let Some(first) = bodies.next() {
            bodies.for_each(|body| self.join(first, body));
        }
    }

    /// Copies the sets of `other`, which has as many bodies.
    pub fn copy(&mut self, other: &Self) {
        self.0.copy_from_slice(&other.0);
    }
}
