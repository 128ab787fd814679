//! How bodies hang in the tree of their joints: parents, the order from the roots, and the quads that they go by.

use super::loops::graph::Component;
use super::quads::{Members, Slot};
use soffio_math::lanes::{Four, WIDTH};

/// Which bodies a joint connects: the first is always a body, the second may be the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// First body.
    pub a: usize,
    /// Second body; `None` is the world.
    pub b: Option<usize>,
}

/// How a body hangs in the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hang {
    /// Parent body; `None`: the world, or nothing.
    pub parent: Option<usize>,
    /// Joint to the parent; `None` for the root of a piece that is not joined to the ground.
    pub joint: Option<usize>,
    /// Where the joint's numbers begin in `g` and `lambda`.
    pub at: usize,
    /// Is this body the joint's first one?
    pub first: bool,
    /// Was the joint a point at the last factorisation?
    pub ball: bool,
    /// Joints on the way from the root.
    pub depth: usize,
    /// Does nothing hang on it?
    pub leaf: bool,
    /// The component of loops that it is eliminated with.
    pub component: Option<usize>,
}

/// What the bodies of a quad hang on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hooks {
    /// Parents; where there is none, the index after the last body: the world's.
    pub parents: [usize; WIDTH],
    /// Their slots.
    pub slots: [Slot; WIDTH],
    /// Signs of the joints' rows as seen from these bodies.
    pub signs: Four,
    /// Where the joints' numbers begin.
    pub at: [usize; WIDTH],
    /// Does nothing hang on any of the bodies?
    pub leaves: bool,
}

/// One step of the elimination.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    /// The members of a quad, all of one depth, each by one point.
    Quad(usize),
    /// A body that hangs by one point, alone at its depth.
    Point(Slot),
    /// Any other body.
    Body(usize),
    /// The bodies of a component of loops.
    Loops(usize),
}

/// Steps from the roots, and the quads that they go by: two to four bodies of one depth that hang by a point side by
/// side, the others in the order in which they come. What is driven is in a quad, but nothing is to be found of it.
pub(super) fn by_quads(
    order: &[usize],
    hang: &[Hang],
    driven: &[bool],
    components: &[Component],
) -> (Vec<Step>, Vec<Members>) {
    let (mut steps, mut members) = (Vec::new(), Vec::<Members>::new());
    // Trains alone may be in loops too.
    let of_none = |&component: &usize| components[component].bodies.is_empty();
    steps.extend((0..components.len()).filter(of_none).map(Step::Loops));
    let mut open = None;
    for level in order.chunk_by(|&a, &b| hang[a].depth == hang[b].depth) {
        let (points, mut others): (Vec<usize>, Vec<usize>) = level.iter().partition(|&&body| hang[body].ball);
        for four in points.chunks(WIDTH) {
            let (&first, rest) = four.split_first().unwrap_or((&0, &[]));
            if rest.is_empty() {
                others.push(first);
                continue;
            }
            steps.push(Step::Quad(members.len()));
            let mut quad = Members::first(first);
            rest.iter().for_each(|&body| quad.push(body));
            members.push(quad);
        }
        for body in others {
            let quad = match open.filter(|&quad: &usize| members[quad].count < WIDTH) {
                Some(quad) => {
                    members[quad].push(body);
                    quad
                }
                None => {
                    members.push(Members::first(body));
                    members.len() - 1
                }
            };
            open = Some(quad);
            let slot = Slot { quad, lane: members[quad].count - 1 };
            match hang[body].component {
                Some(component) if components[component].bodies[0] == body => steps.push(Step::Loops(component)),
                None if hang[body].ball => steps.push(Step::Point(slot)),
                None if !driven[body] => steps.push(Step::Body(body)),
                _ => {}
            }
        }
    }
    (steps, members)
}

/// How each body hangs, and all bodies roots first. `bridges` are the links of the tree, beside the components of loops.
pub(super) fn hangs(
    driven: &[bool],
    links: &[Link],
    (at, points): (&[usize], &[bool]),
    (bridges, components): (&[bool], &[Component]),
) -> (Vec<Hang>, Vec<usize>) {
    let bodies = driven.len();
    let mut hang: Vec<Option<Hang>> = vec![None; bodies];
    let mut order = Vec::with_capacity(bodies);
    for body in (0..bodies).filter(|&body| driven[body]) {
        hang[body] = Some(Hang::root(None, at));
        order.push(body);
    }
    for (joint, link) in links.iter().enumerate().filter(|(joint, _)| bridges[*joint]) {
        if link.b.is_none() {
            hang[link.a] = Some(Hang::root(Some(joint), at));
            order.push(link.a);
        }
    }
    let beside = links_of(bodies, links);
    let enter = |top: Option<usize>, depth: usize, hang: &mut [Option<Hang>], order: &mut Vec<usize>| {
        for (index, component) in components.iter().enumerate().filter(|(_, component)| component.top == top) {
            for &body in &component.bodies {
                hang[body] = Some(Hang { depth, component: Some(index), ..Hang::root(None, at) });
                order.push(body);
            }
        }
    };
    enter(None, 0, &mut hang, &mut order);
    let mut head = 0;
    for piece in 0..=bodies {
        while head < order.len() {
            let parent = order[head];
            head += 1;
            let depth = hang[parent].map_or(0, |hang| hang.depth) + 1;
            for &joint in beside[parent].iter().filter(|&&joint| bridges[joint]) {
                let link = links[joint];
                let child = if link.a == parent { link.b } else { Some(link.a) };
                let Some(child) = child.filter(|&child| hang[child].is_none()) else { continue };
                let (first, at) = (link.a == child, at[joint]);
                let (parent, joint) = (Some(parent), Some(joint));
                let leaf = true;
                hang[child] = Some(Hang { parent, joint, at, first, ball: false, depth, leaf, component: None });
                order.push(child);
            }
            enter(Some(parent), depth, &mut hang, &mut order);
        }
        if piece < bodies && hang[piece].is_none() {
            hang[piece] = Some(Hang::root(None, at));
            order.push(piece);
        }
    }
    let mut hang: Vec<Hang> = hang.into_iter().flatten().collect();
    for (hang, &driven) in hang.iter_mut().zip(driven) {
        hang.ball = !driven && hang.joint.is_some_and(|joint| points[joint]);
    }
    for body in 0..bodies {
        if let Some(parent) = hang[body].parent {
            hang[parent].leaf = false;
        }
    }
    for top in components.iter().filter_map(|component| component.top) {
        hang[top].leaf = false;
    }
    (hang, order)
}

/// The links of each body.
fn links_of(bodies: usize, links: &[Link]) -> Vec<Vec<usize>> {
    let mut beside: Vec<Vec<usize>> = vec![Vec::new(); bodies];
    for (joint, link) in links.iter().enumerate() {
        beside[link.a].push(joint);
        if let Some(b) = link.b {
            beside[b].push(joint);
        }
    }
    beside
}

/// Where each body's numbers are in the quads, and what the bodies of each quad hang on.
pub(super) fn hooks(hang: &[Hang], members: &[Members]) -> (Vec<Slot>, Vec<Hooks>) {
    let world = Slot { quad: members.len(), lane: 0 };
    let mut slots = vec![world; hang.len()];
    for (quad, four) in members.iter().enumerate() {
        for lane in 0..four.count {
            slots[four.bodies[lane]] = Slot { quad, lane };
        }
    }
    let of_quad = |four: &Members| Hooks {
        parents: four.bodies.map(|body| hang[body].parent.unwrap_or(hang.len())),
        slots: four.bodies.map(|body| hang[body].parent.map_or(world, |parent| slots[parent])),
        signs: Four(four.bodies.map(|body| hang[body].sign())),
        at: four.bodies.map(|body| hang[body].at),
        leaves: four.all().iter().all(|&body| hang[body].leaf),
    };
    let hooks = members.iter().map(of_quad).collect();
    (slots, hooks)
}

impl Hang {
    /// Of a body by a joint to the world, or by nothing. `at` is where each joint's numbers begin.
    fn root(joint: Option<usize>, at: &[usize]) -> Self {
        let at = joint.map_or(0, |j| at[j]);
        Self { parent: None, joint, at, first: true, ball: false, depth: 0, leaf: true, component: None }
    }

    /// Rows are written for the joint's first body: their sign as seen from this one.
    #[inline]
    pub fn sign(&self) -> f64 {
        if self.first { 1.0 } else { -1.0 }
    }
}
