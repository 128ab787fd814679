//! Which of many boxes may rays meet? A hierarchy of boxes, four a node, for boxes that stay or move.
//!
//! Rays side by side traverse it as one *beam*. o and o + w are the middles of where its rays begin and end, and h is
//! how far (along each axis) a ray may begin or end beside them. Each ray is within h of o + t w at the fraction t of
//! its length. Where it meets a box from a to b, therefore,
//!
//! ```text
//! a − h ≤ o + t w ≤ b + h,  0 ≤ t ≤ 1     in each axis
//! ```
//!
//! that is, the line o + t w meets the box made wider by h: the usual test of slabs, with (a − (o + h))/w for one side and
//! (b − (o − h))/w for the other. A single ray is a beam with h = 0. Rounding can add boxes that are missed by a hair, and
//! lose none: h is wider than what single precision rounds.
//!
//! A node has the boxes of a half of a half, split along the longest way of their middles. Boxes that move are refitted from
//! the leaves to the root. How many nodes a ray meets grows with the surface of the boxes above the leaves. When that surface has
//! grown by half since the last build, the tree is built again. A beam meets the same boxes whatever the tree.
//!
//! | symbol | here | unit |
//! |---|---|---|
//! | o + h, o − h | `Beam::low`, `Beam::high` | m |
//! | 1/w | `Beam::inverse` | 1/m |

use std::ops::Range;

use glam::{Vec3A, Vec4};

/// What single precision rounds, of the size of the numbers, many times over.
const OUTWARDS: f32 = 8.0 * f32::EPSILON;
/// A beam that goes along an axis goes so far along the others, m: its inverse is finite.
const LEAST_WAY: f32 = 1e-30;
/// The tree is built again when the surface of the boxes above the leaves has grown by this factor.
const GROWN: f32 = 1.5;
/// Boxes of a node.
const WIDTH: usize = 4;
/// Nodes that wait while others are asked, at most: three a level, and 4¹⁶ boxes have sixteen levels.
const WAITING: usize = 48;

/// A box along the axes, from its least corner to its greatest, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aabb {
    /// Least corner, m.
    pub low: Vec3A,
    /// Greatest corner, m.
    pub high: Vec3A,
}

impl Aabb {
    /// Of nothing.
    const NONE: Self = Self { low: Vec3A::INFINITY, high: Vec3A::NEG_INFINITY };

    /// Around a middle, rounded outwards.
    #[inline]
    pub fn around(middle: Vec3A, half: Vec3A) -> Self {
        let half = half + OUTWARDS * (half + middle.abs());
        Self { low: middle - half, high: middle + half }
    }

    /// The least box that holds both.
    #[inline]
    pub fn and(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    #[inline]
    fn middle(&self) -> Vec3A {
        0.5 * (self.low + self.high)
    }

    /// Half its surface, m².
    #[inline]
    fn half_area(&self) -> f32 {
        let size = self.high - self.low;
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// Rays side by side.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Beam {
    low: Vec3A,
    high: Vec3A,
    inverse: Vec3A,
}

impl Beam {
    /// Rays that begin within `half` of `origin`, and end within `half` of `origin + way`, m.
    #[inline]
    pub fn new(origin: Vec3A, way: Vec3A, half: Vec3A) -> Self {
        let half = half + OUTWARDS * (origin.abs() + way.abs() + half).max_element();
        let along_axis = way.abs().cmplt(Vec3A::splat(LEAST_WAY));
        let way = Vec3A::select(along_axis, Vec3A::splat(LEAST_WAY), way);
        Self { low: origin + half, high: origin - half, inverse: way.recip() }
    }
}

/// Boxes of a node, number by number.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    low: [Vec4; 3],
    high: [Vec4; 3],
    /// Which places are taken, and which of those by boxes themselves, as bits.
    taken: u32,
    leaves: u32,
    /// Index of the box, or of the node within it.
    below: [u32; WIDTH],
}

impl Node {
    const EMPTY: Self =
        Self { low: [Vec4::INFINITY; 3], high: [Vec4::NEG_INFINITY; 3], taken: 0, leaves: 0, below: [0; WIDTH] };

    /// Which places a beam meets that ends at the share `far` of its way, as bits.
    #[inline(always)]
    pub fn met(&self, beam: &Beam, far: f32) -> u32 {
        let (mut enters, mut leaves) = (Vec4::ZERO, Vec4::splat(far));
        for k in 0..3 {
            let low = (self.low[k] - beam.low[k]) * beam.inverse[k];
            let high = (self.high[k] - beam.high[k]) * beam.inverse[k];
            enters = enters.max(low.min(high));
            leaves = leaves.min(low.max(high));
        }
        enters.cmple(leaves).bitmask() & self.taken
    }

    /// Index of the box in a place.
    #[inline(always)]
    pub fn index(&self, place: usize) -> usize {
        self.below[place] as usize
    }

    /// The least box that holds all.
    #[inline]
    fn around(&self) -> Aabb {
        let [low, high] = [self.low.map(Vec4::min_element), self.high.map(Vec4::max_element)];
        Aabb { low: low.into(), high: high.into() }
    }

    #[inline]
    fn put(&mut self, place: usize, aabb: &Aabb) {
        for k in 0..3 {
            self.low[k][place] = aabb.low[k];
            self.high[k][place] = aabb.high[k];
        }
    }
}

/// The places that bits name.
#[inline(always)]
pub(crate) fn places(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let place = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (place < u32::BITS as usize).then_some(place)
    })
}

/// A hierarchy of boxes.
#[derive(Clone, Debug)]
pub(crate) struct Boxes {
    boxes: Vec<Aabb>,
    /// Indices of boxes in the order of the leaves.
    order: Vec<u32>,
    /// The root first, and every node after the one above it.
    nodes: Vec<Node>,
    /// Half the surface of all boxes above the leaves when they were split, m².
    split: f32,
}

impl Boxes {
    /// A hierarchy of these.
    pub fn new(boxes: Vec<Aabb>) -> Self {
        let count = boxes.len();
        let mut new = Self { boxes, order: (0..count as u32).collect(), nodes: Vec::with_capacity(count), split: 0.0 };
        new.build();
        new
    }

    /// The least box that holds all.
    pub fn around(&self) -> Aabb {
        self.nodes.first().map_or(Aabb::NONE, Node::around)
    }

    /// Moves boxes, named by their indices; asks for no memory.
    pub fn refit(&mut self, moved: impl Iterator<Item = (usize, Aabb)>) {
        moved.for_each(|(index, aabb)| self.boxes[index] = aabb);
        if self.fit() > GROWN * self.split {
            self.build();
        }
    }

    /// Builds the tree from the leaves' present boxes.
    fn build(&mut self) {
        self.nodes.clear();
        if !self.boxes.is_empty() {
            self.split(0..self.order.len());
        }
        self.split = self.fit();
    }

    /// Makes the node of a range of the order and those below it, and says its index.
    fn split(&mut self, range: Range<usize>) -> u32 {
        let halfway = self.halve(range.clone());
        let [quarter, three_quarters] = [range.start..halfway, halfway..range.end].map(|half| self.halve(half));
        let cuts = [range.start, quarter, halfway, three_quarters, range.end];
        let index = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        for place in 0..WIDTH {
            let part = cuts[place]..cuts[place + 1];
            let (taken, leaf) = (!part.is_empty(), part.len() == 1);
            let below = match part.len() {
                0 => 0,
                1 => self.order[part.start],
                _ => self.split(part),
            };
            let node = &mut self.nodes[index];
            node.taken |= u32::from(taken) << place;
            node.leaves |= u32::from(leaf) << place;
            node.below[place] = below;
        }
        index as u32
    }

    /// Sorts a range of the order into a lower and an upper half, and says where the upper one begins.
    fn halve(&mut self, range: Range<usize>) -> usize {
        let (boxes, order) = (&self.boxes, &mut self.order[range.clone()]);
        let half = order.len() / 2;
        if half > 0 {
            let middle = |index: u32| boxes[index as usize].middle();
            let point = |index: u32| Aabb { low: middle(index), high: middle(index) };
            let middles = order.iter().fold(Aabb::NONE, |all, &index| all.and(point(index)));
            let longest = (middles.high - middles.low).max_position();
            order.select_nth_unstable_by(half, |&a, &b| middle(a)[longest].total_cmp(&middle(b)[longest]));
        }
        range.start + half
    }

    /// Fits all nodes to the boxes, and says half the surface of those above the leaves, m².
    fn fit(&mut self) -> f32 {
        let mut area = 0.0;
        for index in (0..self.nodes.len()).rev() {
            let (taken, leaves) = (self.nodes[index].taken, self.nodes[index].leaves);
            for place in places(taken) {
                let below = self.nodes[index].index(place);
                let leaf = leaves >> place & 1 == 1;
                let aabb = if leaf { self.boxes[below] } else { self.nodes[below].around() };
                area += if leaf { 0.0 } else { aabb.half_area() };
                self.nodes[index].put(place, &aabb);
            }
        }
        area
    }

    /// Visits the boxes that a beam meets. `ask` gets a node and a mask of the boxes in it that the beam meets. It returns the
    /// share of the beam's length at which the search ends from then on; below 0 ends it at once.
    #[inline(always)]
    pub fn meet(&self, beam: &Beam, mut ask: impl FnMut(&Node, u32) -> f32) {
        let mut waiting = [0; WAITING];
        let (mut count, mut far) = (usize::from(!self.nodes.is_empty()), 1.0);
        while count > 0 {
            count -= 1;
            let node = &self.nodes[waiting[count] as usize];
            let met = node.met(beam, far);
            let leaves = met & node.leaves;
            if leaves != 0 {
                far = ask(node, leaves);
                if far < 0.0 {
                    return;
                }
            }
            for place in places(met & !node.leaves) {
                waiting[count] = node.below[place];
                count += 1;
            }
        }
    }
}
