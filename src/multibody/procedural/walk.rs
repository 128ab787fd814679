//! Ways through a figure: from each thing that holds it, outwards, with the mass of everything beyond (method 3.4).
//!
//! Bodies joined now form a *piece*. What holds a piece is an *anchor*: a joint to the world or to a driven body, or a
//! grip. Each anchor has a walk of its own over its piece, breadth first; a piece without an anchor has one from its
//! heaviest body. Joints that a walk does not use close loops.

use crate::articulation::System;

/// What a walk begins at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// A joint to the world or to a driven body.
    Ground {
        /// Index of the joint.
        joint: usize,
    },
    /// A grip, by its index.
    Grip(usize),
    /// Nothing: the piece moves freely.
    Free,
}

/// One body on a walk.
#[derive(Clone, Copy, Debug)]
pub struct Visit {
    /// The body.
    pub body: usize,
    /// The joint it was reached by; none for the first.
    pub joint: Option<usize>,
    /// Mass of the body and of everything beyond it, kg.
    pub group: f64,
    /// Index of the visit that it was reached from.
    from: usize,
}

/// A walk: a range of [`Walks::visits`].
#[derive(Clone, Copy, Debug)]
pub struct Walk {
    /// What holds its first body.
    pub start: Start,
    /// The piece.
    pub piece: usize,
    first: usize,
    end: usize,
}

/// All walks through a figure as it is joined and held now. Grows to its largest size once.
#[derive(Clone, Debug, Default)]
pub struct Walks {
    /// Walks of one piece stand together, those from the ground first.
    pub walks: Vec<Walk>,
    visits: Vec<Visit>,
    /// Joints that close loops, and which joints act.
    pub loops: Vec<usize>,
    acts: Vec<bool>,
    used: Vec<bool>,
    piece: Vec<usize>,
    seen: Vec<bool>,
    /// Joints of each body.
    beside: Vec<Vec<usize>>,
}

/// In no piece.
const NONE: usize = usize::MAX;

impl Walks {
    /// Room for walks through a figure with this many grips at most.
    pub fn new(system: &System, bodies: usize, grips: usize) -> Self {
        let mut beside = vec![Vec::new(); bodies];
        for (index, joint) in system.joints().iter().enumerate() {
            beside[joint.link.a].push(index);
            if let Some(b) = joint.link.b {
                beside[b].push(index);
            }
        }
        let joints = system.joints().len();
        Self {
            walks: Vec::with_capacity(joints + grips + bodies),
            visits: Vec::with_capacity((4 + grips) * bodies),
            loops: Vec::with_capacity(joints),
            acts: vec![false; joints],
            used: vec![false; joints],
            piece: vec![NONE; bodies],
            seen: vec![false; bodies],
            beside,
        }
    }

    /// The bodies of a walk in its order.
    pub fn visits(&self, walk: &Walk) -> &[Visit] {
        &self.visits[walk.first..walk.end]
    }

    /// Walks anew: for what acts now, and for grips on these bodies. `masses` gives each body's, kg.
    pub fn lay_out(
        &mut self,
        system: &System,
        mass: impl Fn(usize) -> f64,
        grips: impl Iterator<Item = usize> + Clone,
    ) {
        self.walks.clear();
        self.visits.clear();
        self.loops.clear();
        for (acts, joint) in self.acts.iter_mut().zip(system.joints()) {
            *acts = joint.constraints.iter().any(|&c| system.activity.share(c) == 1.0);
        }
        self.piece.fill(NONE);
        self.used.fill(false);
        let bodies = self.piece.len();
        for root in 0..bodies {
            if self.piece[root] != NONE || system.driven()[root] {
                continue;
            }
            let first_walk = self.walks.len();
            // A first walk finds the piece and its anchors.
            let (first, end) = self.walk(system, root, &mass);
            let heaviest =
                |best: usize, k: usize| if mass(self.visits[k].body) > mass(self.visits[best].body) { k } else { best };
            let heaviest = self.visits[(first..end).fold(first, heaviest)].body;
            for k in first..end {
                self.piece[self.visits[k].body] = root;
            }
            self.visits.truncate(first);
            for joint in 0..self.acts.len() {
                let Some(body) = self.anchored(system, joint).filter(|&body| self.piece[body] == root) else {
                    continue;
                };
                self.used[joint] = true;
                self.begin(system, Start::Ground { joint }, body, root, &mass);
            }
            for (index, body) in grips.clone().enumerate() {
                if self.piece[body] == root {
                    self.begin(system, Start::Grip(index), body, root, &mass);
                }
            }
            if self.walks.len() == first_walk {
                self.begin(system, Start::Free, heaviest, root, &mass);
            }
            // What the first walk does not use closes a loop.
            let Walk { first, end, .. } = self.walks[first_walk];
            for k in first..end {
                if let Some(joint) = self.visits[k].joint {
                    self.used[joint] = true;
                }
            }
        }
        self.loops.extend((0..self.acts.len()).filter(|&joint| self.acts[joint] && !self.used[joint]));
    }

    /// The free body of a joint that acts between it and the ground.
    fn anchored(&self, system: &System, joint: usize) -> Option<usize> {
        let link = system.joints()[joint].link;
        let ground = |body: Option<usize>| body.is_none_or(|body| system.driven()[body]);
        match (ground(Some(link.a)), ground(link.b)) {
            (false, true) if self.acts[joint] => Some(link.a),
            (true, false) if self.acts[joint] => link.b,
            _ => None,
        }
    }

    fn begin(&mut self, system: &System, start: Start, body: usize, piece: usize, mass: &impl Fn(usize) -> f64) {
        let (first, end) = self.walk(system, body, mass);
        self.walks.push(Walk { start, piece, first, end });
    }

    /// Breadth first from a body over what is joined and not driven.
    fn walk(&mut self, system: &System, root: usize, mass: &impl Fn(usize) -> f64) -> (usize, usize) {
        self.seen.fill(false);
        self.seen[root] = true;
        let first = self.visits.len();
        self.visits.push(Visit { body: root, joint: None, group: mass(root), from: first });
        let mut head = first;
        while head < self.visits.len() {
            let body = self.visits[head].body;
            for &joint in &self.beside[body] {
                let link = system.joints()[joint].link;
                let other = if link.a == body { link.b } else { Some(link.a) };
                let Some(other) = other.filter(|&b| self.acts[joint] && !self.seen[b] && !system.driven()[b]) else {
                    continue;
                };
                self.seen[other] = true;
                self.visits.push(Visit { body: other, joint: Some(joint), group: mass(other), from: head });
            }
            head += 1;
        }
        for k in (first + 1..self.visits.len()).rev() {
            let Visit { group, from, .. } = self.visits[k];
            self.visits[from].group += group;
        }
        (first, self.visits.len())
    }
}
