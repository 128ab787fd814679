//! Islands of a contact problem, and an order of their nodes that keeps neighbours near each other.
//!
//! Nodes that touches put together are an island; islands do not feel each other and are solved one by one. Within one the
//! nodes stand in the reverse order of E. Cuthill and J. McKee ("Reducing the bandwidth of sparse symmetric matrices", 1969):
//! outwards from one end, layer by layer, so that the matrix of a tower, a wall or a heap is a band as wide as a layer.

use super::contact::Contact;
use super::reduced_coordinates::{Coordinates, NodeBlock};
use std::ops::Range;

/// One island: its coordinates, and its touches in [`Islands::touches`].
#[derive(Clone, Debug)]
pub(super) struct Island {
    nodes: Range<usize>,
    pub coordinates: Range<usize>,
    pub contacts: Range<usize>,
}

/// The islands of a problem.
#[derive(Clone, Debug, Default)]
pub(super) struct Islands {
    pub islands: Vec<Island>,
    /// Touches that something answers, island by island, each island's in their order.
    pub contacts: Vec<usize>,
    /// First coordinate of each node, and of the first one that it shares a touch with and that stands before it.
    pub place: Vec<usize>,
    pub reach: Vec<usize>,
    /// Nodes in order, and their touches: of node i `at_node[first[i]..first[i + 1]]`.
    order: Vec<usize>,
    first: Vec<usize>,
    at_node: Vec<usize>,
    ends: Vec<usize>,
    seen: Vec<u8>,
}

/// Marks of nodes on the way.
const NEW: u8 = 0;
const TRIED: u8 = 1;
const PLACED: u8 = 2;

impl Islands {
    /// Room for so many nodes and touches.
    pub fn with_room(nodes: usize, contacts: usize) -> Self {
        let of_nodes = || Vec::with_capacity(nodes + 1);
        Self {
            islands: Vec::with_capacity(nodes),
            contacts: Vec::with_capacity(3 * contacts),
            place: of_nodes(),
            reach: of_nodes(),
            order: of_nodes(),
            first: of_nodes(),
            at_node: Vec::with_capacity(3 * contacts),
            ends: of_nodes(),
            seen: Vec::with_capacity(nodes),
        }
    }

    /// The nodes of an island, in order.
    pub fn order_of(&self, island: &Island) -> &[usize] {
        &self.order[island.nodes.clone()]
    }

    /// Finds them.
    pub fn find(&mut self, coordinates: &Coordinates, contacts: &[Contact]) {
        let nodes = coordinates.nodes.len();
        self.list_touches(nodes, &coordinates.parts);
        self.islands.clear();
        self.contacts.clear();
        self.order.clear();
        self.seen.clear();
        self.seen.resize(nodes, NEW);
        self.place.clear();
        self.place.resize(nodes, 0);
        let parts = |contact: usize| coordinates.parts_of(&contacts[contact]);
        let mut at = 0;
        for start in 0..nodes {
            if self.seen[start] != NEW {
                continue;
            }
            // The last node of the layers from anywhere is one end.
            let begin = self.order.len();
            self.spread(start, TRIED, &parts);
            let end = self.order[self.order.len() - 1];
            self.order.truncate(begin);
            self.spread(end, PLACED, &parts);
            self.order[begin..].reverse();
            let (from, begun) = (at, self.contacts.len());
            for &node in &self.order[begin..] {
                self.place[node] = at;
                at += coordinates.nodes[node].size;
            }
            for &node in &self.order[begin..] {
                self.contacts.extend(&self.at_node[self.first[node]..self.first[node + 1]]);
            }
            let own = &mut self.contacts[begun..];
            own.sort_unstable();
            // A touch between two nodes was listed twice.
            let mut kept = begun;
            for k in begun..self.contacts.len() {
                if k == begun || self.contacts[k] != self.contacts[kept - 1] {
                    self.contacts[kept] = self.contacts[k];
                    kept += 1;
                }
            }
            self.contacts.truncate(kept);
            self.islands.push(Island { nodes: begin..self.order.len(), coordinates: from..at, contacts: begun..kept });
        }
        self.reach.clear();
        self.reach.extend(&self.place);
        for &contact in &self.contacts {
            let least = parts(contact).iter().map(|part| self.place[part.node]).min().unwrap_or(0);
            for part in parts(contact) {
                self.reach[part.node] = self.reach[part.node].min(least);
            }
        }
    }

    /// Lists the touches of every node.
    fn list_touches(&mut self, nodes: usize, parts: &[NodeBlock]) {
        self.first.clear();
        self.first.resize(nodes + 1, 0);
        parts.iter().for_each(|part| self.first[part.node + 1] += 1);
        for node in 0..nodes {
            self.first[node + 1] += self.first[node];
        }
        self.at_node.clear();
        self.at_node.resize(parts.len(), 0);
        // Filled from behind, so that `first` ends as it was.
        let mut left = std::mem::take(&mut self.ends);
        left.clear();
        left.extend(&self.first[1..]);
        for part in parts.iter().rev() {
            left[part.node] -= 1;
            self.at_node[left[part.node]] = part.contact;
        }
        self.ends = left;
    }

    /// Appends the island of a node to the order, outwards from it, what touches little first.
    fn spread<'a>(&mut self, from: usize, mark: u8, parts: &impl Fn(usize) -> &'a [NodeBlock]) {
        let mut next = self.order.len();
        self.order.push(from);
        self.seen[from] = mark;
        while next < self.order.len() {
            let node = self.order[next];
            next += 1;
            let added = self.order.len();
            for k in self.first[node]..self.first[node + 1] {
                for part in parts(self.at_node[k]) {
                    if self.seen[part.node] != mark {
                        self.seen[part.node] = mark;
                        self.order.push(part.node);
                    }
                }
            }
            let first = &self.first;
            self.order[added..].sort_unstable_by_key(|&node| (first[node + 1] - first[node], node));
        }
    }
}
