//! Breadth-first walks through a mechanism from each anchor outwards, with group masses (method 3.4).
//!
//! Connected bodies form a *piece*. Its *anchors* are joints to the world or to a kinematic body, and grabs. Each
//! anchor has a walk over its piece, breadth first; a piece without an anchor has one from its heaviest body. Joints
//! that a walk does not use close loops.

use crate::articulation::System;

/// Start of a walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// A joint to the world or to a kinematic body.
    Ground {
        /// Index of the joint.
        joint: usize,
    },
    /// A grab, by its index.
    Grab(usize),
    /// No anchor: the piece moves freely.
    Free,
}

/// One body on a walk.
#[derive(Clone, Copy, Debug)]
pub struct Visit {
    /// The body.
    pub body: usize,
    /// Joint it was reached by; none for the first.
    pub joint: Option<usize>,
    /// Mass of the body and of everything beyond it, kg.
    pub group_mass: f64,
    /// Visits that are reached from it, within the walk.
    pub next: (usize, usize),
    /// Index of the visit that it was reached from.
    from: usize,
}

/// A walk: a range of [`Walks::visits`].
#[derive(Clone, Copy, Debug)]
pub struct Walk {
    /// Anchor of its first body.
    pub start: Start,
    /// The piece.
    pub piece: usize,
    first: usize,
    end: usize,
}

/// All walks through a mechanism in its present state. Grows to its largest size once.
#[derive(Clone, Debug, Default)]
pub struct Walks {
    /// Walks of one piece are adjacent, those from the ground first.
    pub walks: Vec<Walk>,
    visits: Vec<Visit>,
    /// Joints that close loops, and whether each joint is fully active.
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
    /// Capacity for walks through a mechanism with at most `grabs` grabs.
    pub fn new(system: &System, bodies: usize, grabs: usize) -> Self {
        let mut beside = vec![Vec::new(); bodies];
        for (index, joint) in system.joints().iter().enumerate() {
            beside[joint.link.a].push(index);
            if let Some(b) = joint.link.b {
                beside[b].push(index);
            }
        }
        let joints = system.joints().len();
        Self {
            walks: Vec::with_capacity(joints + grabs + bodies),
            visits: Vec::with_capacity((4 + grabs) * bodies),
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

    /// Rebuilds all walks for the present activations and grabs on these bodies. `mass` gives each body's mass, kg.
    pub fn rebuild(
        &mut self,
        system: &System,
        mass: impl Fn(usize) -> f64,
        grabs: impl Iterator<Item = usize> + Clone,
    ) {
        self.walks.clear();
        self.visits.clear();
        self.loops.clear();
        for (acts, joint) in self.acts.iter_mut().zip(system.joints()) {
            *acts = joint.constraints.iter().any(|&c| system.activity.activation(c) == 1.0);
        }
        self.piece.fill(NONE);
        self.used.fill(false);
        let bodies = self.piece.len();
        for root in 0..bodies {
            if self.piece[root] != NONE || system.kinematic()[root] {
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
                let Some(body) = self.grounded_body(system, joint).filter(|&body| self.piece[body] == root) else {
                    continue;
                };
                self.used[joint] = true;
                self.start_walk(system, Start::Ground { joint }, body, root, &mass);
            }
            for (index, body) in grabs.clone().enumerate() {
                if self.piece[body] == root {
                    self.start_walk(system, Start::Grab(index), body, root, &mass);
                }
            }
            if self.walks.len() == first_walk {
                self.start_walk(system, Start::Free, heaviest, root, &mass);
            }
            // A joint unused by the first walk closes a loop.
            let Walk { first, end, .. } = self.walks[first_walk];
            for k in first..end {
                if let Some(joint) = self.visits[k].joint {
                    self.used[joint] = true;
                }
            }
        }
        self.loops.extend((0..self.acts.len()).filter(|&joint| self.acts[joint] && !self.used[joint]));
    }

    /// The piece of a body that is not kinematic.
    pub fn piece(&self, body: usize) -> usize {
        self.piece[body]
    }

    /// The walks of the pieces that are held in one place.
    pub fn lone(&self) -> impl Iterator<Item = &Walk> {
        let of = |k: usize| self.walks.get(k).map(|walk| walk.piece);
        let lone = move |(k, walk): &(usize, &Walk)| {
            (*k == 0 || of(k - 1) != Some(walk.piece)) && of(k + 1) != Some(walk.piece)
        };
        self.walks.iter().enumerate().filter(lone).map(|(_, walk)| walk)
    }

    /// Free body of an active joint to the ground.
    fn grounded_body(&self, system: &System, joint: usize) -> Option<usize> {
        let link = system.joints()[joint].link;
        let ground = |body: Option<usize>| body.is_none_or(|body| system.kinematic()[body]);
        match (ground(Some(link.a)), ground(link.b)) {
            (false, true) if self.acts[joint] => Some(link.a),
            (true, false) if self.acts[joint] => link.b,
            _ => None,
        }
    }

    fn start_walk(&mut self, system: &System, start: Start, body: usize, piece: usize, mass: &impl Fn(usize) -> f64) {
        let (first, end) = self.walk(system, body, mass);
        self.walks.push(Walk { start, piece, first, end });
    }

    /// Breadth-first walk from a body over connected bodies that are not kinematic.
    fn walk(&mut self, system: &System, root: usize, mass: &impl Fn(usize) -> f64) -> (usize, usize) {
        self.seen.fill(false);
        self.seen[root] = true;
        let first = self.visits.len();
        self.visits.push(Visit { body: root, joint: None, group_mass: mass(root), next: (1, 1), from: first });
        let mut head = first;
        while head < self.visits.len() {
            let body = self.visits[head].body;
            let next = self.visits.len() - first;
            for &joint in &self.beside[body] {
                let link = system.joints()[joint].link;
                let other = if link.a == body { link.b } else { Some(link.a) };
                let Some(other) = other.filter(|&b| self.acts[joint] && !self.seen[b] && !system.kinematic()[b]) else {
                    continue;
                };
                self.seen[other] = true;
                let group_mass = mass(other);
                self.visits.push(Visit { body: other, joint: Some(joint), group_mass, next: (0, 0), from: head });
            }
            self.visits[head].next = (next, self.visits.len() - first);
            head += 1;
        }
        for k in (first + 1..self.visits.len()).rev() {
            let Visit { group_mass, from, .. } = self.visits[k];
            self.visits[from].group_mass += group_mass;
        }
        (first, self.visits.len())
    }
}
