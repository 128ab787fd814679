//! Biconnected components of the graph of joints and couplings (J. Hopcroft, R. Tarjan, Algorithm 447, 1973): where
//! the tree of joints has loops.
//!
//! Vertices are the free bodies, the gear trains, and the ground: the world and all kinematic bodies. Every joint is
//! an edge; a coupling is a cycle of edges through all that it touches. A *component* is a largest set of edges of
//! which any two lie on one cycle. Two components share one vertex at most, so they form a tree. A component of one
//! joint is an edge of the tree; any other is a [`Component`] that is eliminated at once (`mod.rs`). Its *top* is its
//! vertex nearest to the ground, or to the first body of a floating piece.

use crate::articulation::topology::Link;

/// A vertex: a body, or what comes after them.
type Vertex = usize;

/// A joint or a coupling: couplings are counted on after the joints.
pub(in crate::articulation) type Tie = usize;

/// What is joined by loops.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::articulation) struct Component {
    /// Its joints and couplings, in order.
    pub ties: Vec<Tie>,
    /// Its bodies but for the top, in order.
    pub bodies: Vec<usize>,
    /// Its trains, in order.
    pub trains: Vec<usize>,
    /// The body by which it hangs; `None` is the ground.
    pub top: Option<usize>,
}

impl Component {
    /// Is it one joint, of which there are so many, and no loop?
    pub fn is_bridge(&self, joints: usize) -> bool {
        matches!(self.ties[..], [tie] if tie < joints)
    }
}

/// Vertices of the graph.
#[derive(Clone, Debug)]
pub(in crate::articulation) struct Graph<'a> {
    /// Whether each body's motion is given.
    pub kinematic: &'a [bool],
    /// The train that each body is in.
    pub train: &'a [Option<usize>],
}

/// An edge of what a tie is; that which holds a train on the ground is of none.
#[derive(Clone, Copy, Debug)]
struct Edge {
    ends: [Vertex; 2],
    tie: Option<Tie>,
}

impl Graph<'_> {
    fn ground(&self) -> Vertex {
        self.kinematic.len()
    }

    fn vertex(&self, body: Option<usize>) -> Vertex {
        match body {
            Some(body) if !self.kinematic[body] => self.train[body].map_or(body, |train| self.ground() + 1 + train),
            _ => self.ground(),
        }
    }

    /// Vertices of a joint or coupling; `None` is the world. One that touches a train also touches the ground that
    /// carries it.
    fn cycle(&self, touched: &[Option<usize>]) -> Vec<Vertex> {
        let mut cycle: Vec<Vertex> = touched.iter().map(|&body| self.vertex(body)).collect();
        if cycle.iter().any(|&vertex| vertex > self.ground()) {
            cycle.push(self.ground());
        }
        cycle.sort_unstable();
        cycle.dedup();
        cycle
    }

    /// All components, for these joints (`None`: inside a gear train) and couplings, each by the bodies it touches.
    pub fn components(&self, joints: &[Option<Link>], couplings: &[Vec<Option<usize>>]) -> Vec<Component> {
        let trains = self.train.iter().flatten().map(|train| train + 1).max().unwrap_or(0);
        let axle = |train: usize| Edge { ends: [self.ground(), self.ground() + 1 + train], tie: None };
        let mut edges: Vec<Edge> = (0..trains).map(axle).collect();
        for (tie, link) in joints.iter().enumerate() {
            let Some(link) = link else { continue };
            edges.push(Edge { ends: [self.vertex(Some(link.a)), self.vertex(link.b)], tie: Some(tie) });
        }
        for (index, touched) in couplings.iter().enumerate() {
            let (cycle, tie) = (self.cycle(touched), Some(joints.len() + index));
            let next = cycle.iter().skip(1).chain(cycle.first());
            edges.extend(cycle.iter().zip(next).map(|(&a, &b)| Edge { ends: [a, b], tie }));
        }
        // Nothing gives way to what is on the ground at both ends.
        edges.retain(|edge| edge.ends[0] != edge.ends[1]);
        let found = self.search(&edges, self.ground() + 1 + trains);
        found.into_iter().filter_map(|(top, own)| self.component(top, own.iter().map(|&edge| &edges[edge]))).collect()
    }

    fn component<'a>(&self, top: Vertex, edges: impl Iterator<Item = &'a Edge>) -> Option<Component> {
        let (mut ties, mut vertices) = (Vec::new(), Vec::new());
        for edge in edges {
            ties.extend(edge.tie);
            vertices.extend(edge.ends.into_iter().filter(|&vertex| vertex != top));
        }
        for list in [&mut ties, &mut vertices] {
            list.sort_unstable();
            list.dedup();
        }
        let (bodies, others): (Vec<_>, Vec<_>) = vertices.into_iter().partition(|&vertex| vertex < self.ground());
        let trains = others.into_iter().map(|vertex| vertex - self.ground() - 1).collect();
        let top = (top < self.ground()).then_some(top);
        (!ties.is_empty()).then_some(Component { ties, bodies, trains, top })
    }

    /// Tops and edges of the components, by a search in depth from the ground, then from each body that it has not reached.
    fn search(&self, edges: &[Edge], vertices: usize) -> Vec<(Vertex, Vec<usize>)> {
        let mut beside = vec![Vec::new(); vertices];
        for (index, edge) in edges.iter().enumerate() {
            edge.ends.iter().for_each(|&end| beside[end].push(index));
        }
        // When a vertex was met, and the earliest that is met from it on; edges on the way, open edges.
        let (mut discovered, mut low, mut count) = (vec![0; vertices], vec![0; vertices], 0);
        let (mut seen, mut open, mut found) = (vec![false; edges.len()], Vec::new(), Vec::new());
        for root in std::iter::once(self.ground()).chain(0..self.ground()) {
            if discovered[root] > 0 {
                continue;
            }
            // A vertex, the next of its edges to be looked at, and how many edges were open when it was met.
            let mut path = vec![(root, 0, 0)];
            count += 1;
            (discovered[root], low[root]) = (count, count);
            while let Some(&mut (vertex, ref mut next, since)) = path.last_mut() {
                if let Some(&edge) = beside[vertex].get(*next) {
                    *next += 1;
                    if std::mem::replace(&mut seen[edge], true) {
                        continue;
                    }
                    let [a, b] = edges[edge].ends;
                    let other = if a == vertex { b } else { a };
                    let opened = open.len();
                    open.push(edge);
                    if discovered[other] == 0 {
                        count += 1;
                        (discovered[other], low[other]) = (count, count);
                        path.push((other, 0, opened));
                    } else {
                        low[vertex] = low[vertex].min(discovered[other]);
                    }
                    continue;
                }
                path.pop();
                let Some(&(before, ..)) = path.last() else { break };
                low[before] = low[before].min(low[vertex]);
                if low[vertex] >= discovered[before] {
                    found.push((before, open.split_off(since)));
                }
            }
        }
        found
    }
}
