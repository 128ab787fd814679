//! Topology of the kinematic tree: parents, breadth-first order, elimination steps in lane blocks.

use super::lane_blocks::{BlockBodies, BodyLane};
use super::loops::biconnected::Component;
use soffio_math::lanes::{Four, WIDTH};

/// The two bodies of a joint: the first is always a body, the second may be the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// First body.
    pub a: usize,
    /// Second body; `None` is the world.
    pub b: Option<usize>,
}

/// A body's place in the kinematic tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct TreeNode {
    /// Parent body; `None`: the world, or no parent.
    pub parent: Option<usize>,
    /// Joint to the parent; `None` for the root of a floating piece.
    pub joint: Option<usize>,
    /// Where the joint's numbers begin in `g` and `lambda`.
    pub at: usize,
    /// Whether this body is the joint's first one.
    pub first: bool,
    /// Whether the joint was a ball joint at the last factorisation.
    pub ball_joint: bool,
    /// Number of joints on the path from the root.
    pub depth: usize,
    /// Whether it has no children.
    pub leaf: bool,
    /// Index of the loop component that it is eliminated with, if any.
    pub component: Option<usize>,
}

/// Parent references of a lane block's bodies.
#[derive(Clone, Copy, Debug)]
pub(super) struct ParentReferences {
    /// Indices of the parents; without one, the index after the last body, which stands for the world.
    pub parents: [usize; WIDTH],
    /// Lanes of the parents.
    pub body_lanes: [BodyLane; WIDTH],
    /// 1 where the body is its joint's first one, −1 where it is the second.
    pub signs: Four,
    /// Where the joints' numbers begin in `g` and `lambda`.
    pub at: [usize; WIDTH],
    /// Whether none of the bodies has children.
    pub leaves: bool,
}

/// One step of the elimination.
#[derive(Clone, Copy, Debug)]
pub(super) enum EliminationStep {
    /// All bodies of a lane block: ball-joint bodies of one depth.
    LaneBlock(usize),
    /// A ball-joint body without others of its depth.
    Point(BodyLane),
    /// A body on any other joint.
    Body(usize),
    /// All bodies of a loop component.
    Loops(usize),
}

/// Elimination steps from the roots, and the bodies of each lane block: two to four ball-joint bodies of one depth
/// share a block, the others fill blocks in their order. Kinematic bodies are in blocks, but have no step.
pub(super) fn schedule_elimination(
    order: &[usize],
    nodes: &[TreeNode],
    kinematic: &[bool],
    components: &[Component],
) -> (Vec<EliminationStep>, Vec<BlockBodies>) {
    let (mut steps, mut block_bodies) = (Vec::new(), Vec::<BlockBodies>::new());
    // A component may consist of trains alone.
    let of_none = |&component: &usize| components[component].bodies.is_empty();
    steps.extend((0..components.len()).filter(of_none).map(EliminationStep::Loops));
    let mut open = None;
    for level in order.chunk_by(|&a, &b| nodes[a].depth == nodes[b].depth) {
        let (points, mut others): (Vec<usize>, Vec<usize>) = level.iter().partition(|&&body| nodes[body].ball_joint);
        for bodies_of_block in points.chunks(WIDTH) {
            let (&first, others_of_four) = bodies_of_block.split_first().unwrap_or((&0, &[]));
            if others_of_four.is_empty() {
                others.push(first);
                continue;
            }
            steps.push(EliminationStep::LaneBlock(block_bodies.len()));
            let mut lane_block = BlockBodies::first(first);
            others_of_four.iter().for_each(|&body| lane_block.push(body));
            block_bodies.push(lane_block);
        }
        for body in others {
            let lane_block = match open.filter(|&lane_block: &usize| block_bodies[lane_block].count < WIDTH) {
                Some(lane_block) => {
                    block_bodies[lane_block].push(body);
                    lane_block
                }
                None => {
                    block_bodies.push(BlockBodies::first(body));
                    block_bodies.len() - 1
                }
            };
            open = Some(lane_block);
            let body_lane = BodyLane { lane_block, lane: block_bodies[lane_block].count - 1 };
            match nodes[body].component {
                Some(component) if components[component].bodies[0] == body => {
                    steps.push(EliminationStep::Loops(component))
                }
                None if nodes[body].ball_joint => steps.push(EliminationStep::Point(body_lane)),
                None if !kinematic[body] => steps.push(EliminationStep::Body(body)),
                _ => {}
            }
        }
    }
    (steps, block_bodies)
}

/// Tree nodes of all bodies, and the bodies in breadth-first order. `at` is where each joint's numbers begin,
/// `points` whether it is always a ball joint; `bridges` says which joints are edges of the tree, beside the loop
/// `components`.
pub(super) fn build_nodes(
    kinematic: &[bool],
    links: &[Link],
    (at, points): (&[usize], &[bool]),
    (bridges, components): (&[bool], &[Component]),
) -> (Vec<TreeNode>, Vec<usize>) {
    let bodies = kinematic.len();
    let mut nodes: Vec<Option<TreeNode>> = vec![None; bodies];
    let mut order = Vec::with_capacity(bodies);
    for body in (0..bodies).filter(|&body| kinematic[body]) {
        nodes[body] = Some(TreeNode::root(None, at));
        order.push(body);
    }
    for (joint, link) in links.iter().enumerate().filter(|(joint, _)| bridges[*joint]) {
        if link.b.is_none() {
            nodes[link.a] = Some(TreeNode::root(Some(joint), at));
            order.push(link.a);
        }
    }
    let beside = links_of(bodies, links);
    let enter = |top: Option<usize>, depth: usize, nodes: &mut [Option<TreeNode>], order: &mut Vec<usize>| {
        for (index, component) in components.iter().enumerate().filter(|(_, component)| component.top == top) {
            for &body in &component.bodies {
                nodes[body] = Some(TreeNode { depth, component: Some(index), ..TreeNode::root(None, at) });
                order.push(body);
            }
        }
    };
    enter(None, 0, &mut nodes, &mut order);
    let mut head = 0;
    for piece in 0..=bodies {
        while head < order.len() {
            let parent = order[head];
            head += 1;
            let depth = nodes[parent].map_or(0, |node| node.depth) + 1;
            for &joint in beside[parent].iter().filter(|&&joint| bridges[joint]) {
                let link = links[joint];
                let child = if link.a == parent { link.b } else { Some(link.a) };
                let Some(child) = child.filter(|&child| nodes[child].is_none()) else { continue };
                let (first, at) = (link.a == child, at[joint]);
                let (parent, joint) = (Some(parent), Some(joint));
                let leaf = true;
                nodes[child] =
                    Some(TreeNode { parent, joint, at, first, ball_joint: false, depth, leaf, component: None });
                order.push(child);
            }
            enter(Some(parent), depth, &mut nodes, &mut order);
        }
        if piece < bodies && nodes[piece].is_none() {
            nodes[piece] = Some(TreeNode::root(None, at));
            order.push(piece);
        }
    }
    let mut nodes: Vec<TreeNode> = nodes.into_iter().flatten().collect();
    for (node, &kinematic) in nodes.iter_mut().zip(kinematic) {
        node.ball_joint = !kinematic && node.joint.is_some_and(|joint| points[joint]);
    }
    for body in 0..bodies {
        if let Some(parent) = nodes[body].parent {
            nodes[parent].leaf = false;
        }
    }
    for top in components.iter().filter_map(|component| component.top) {
        nodes[top].leaf = false;
    }
    (nodes, order)
}

/// Joints of each body.
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

/// Lane of each body, and the parent references of each lane block.
pub(super) fn parent_references(
    nodes: &[TreeNode],
    block_bodies: &[BlockBodies],
) -> (Vec<BodyLane>, Vec<ParentReferences>) {
    let world = BodyLane { lane_block: block_bodies.len(), lane: 0 };
    let mut body_lanes = vec![world; nodes.len()];
    for (lane_block, bodies_of_block) in block_bodies.iter().enumerate() {
        for lane in 0..bodies_of_block.count {
            body_lanes[bodies_of_block.bodies[lane]] = BodyLane { lane_block, lane };
        }
    }
    let of_quad = |bodies_of_block: &BlockBodies| ParentReferences {
        parents: bodies_of_block.bodies.map(|body| nodes[body].parent.unwrap_or(nodes.len())),
        body_lanes: bodies_of_block.bodies.map(|body| nodes[body].parent.map_or(world, |parent| body_lanes[parent])),
        signs: Four(bodies_of_block.bodies.map(|body| nodes[body].sign())),
        at: bodies_of_block.bodies.map(|body| nodes[body].at),
        leaves: bodies_of_block.all().iter().all(|&body| nodes[body].leaf),
    };
    let references = block_bodies.iter().map(of_quad).collect();
    (body_lanes, references)
}

impl TreeNode {
    /// A root: on a joint to the world, or on none. `at` is where each joint's numbers begin.
    fn root(joint: Option<usize>, at: &[usize]) -> Self {
        let at = joint.map_or(0, |j| at[j]);
        Self { parent: None, joint, at, first: true, ball_joint: false, depth: 0, leaf: true, component: None }
    }

    /// Sign of the joint's rows as seen from this body: they are written for the joint's first one.
    #[inline]
    pub fn sign(&self) -> f64 {
        if self.first { 1.0 } else { -1.0 }
    }
}
