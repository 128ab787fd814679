//! Contact islands, with their nodes in reverse Cuthill–McKee order.
//!
//! An island is a set of nodes that contacts connect. Islands do not influence each other and are solved one by one. Within one
//! the nodes are in the reverse order of E. Cuthill and J. McKee ("Reducing the bandwidth of sparse symmetric matrices", 1969):
//! outwards from one end, layer by layer. The matrix of a tower, a wall or a heap is then a band as wide as a layer.

use super::contact::Contact;
use super::reduced_coordinates::{NodeBlock, ReducedCoordinates};
use std::ops::Range;

/// One island: its coordinates, and its contacts in [`Islands::contacts`].
#[derive(Clone, Debug)]
pub(super) struct Island {
    nodes: Range<usize>,
    /// Range of its coordinates.
    pub coordinates: Range<usize>,
    /// Range of its contacts in [`Islands::contacts`].
    pub contacts: Range<usize>,
}

/// The islands of a problem.
#[derive(Clone, Debug, Default)]
pub(super) struct Islands {
    /// The islands.
    pub islands: Vec<Island>,
    /// Contacts that act on some node, island by island, ascending within each.
    pub contacts: Vec<usize>,
    /// First coordinate of each node.
    pub first_coordinate: Vec<usize>,
    /// First coordinate of the earliest node that each node shares a contact with: where its envelope starts.
    pub envelope_start: Vec<usize>,
    /// Nodes in order, and their contacts: those of node i are `at_node[first[i]..first[i + 1]]`.
    order: Vec<usize>,
    first: Vec<usize>,
    at_node: Vec<usize>,
    ends: Vec<usize>,
    marks: Vec<Mark>,
}

/// Where a node is in the search for islands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mark {
    Unseen,
    /// Reached by the search for an end of its island.
    Tried,
    /// In the order.
    Placed,
}

impl Islands {
    /// Capacity for so many nodes and contacts.
    pub fn with_capacity(nodes: usize, contacts: usize) -> Self {
        let of_nodes = || Vec::with_capacity(nodes + 1);
        Self {
            islands: Vec::with_capacity(nodes),
            contacts: Vec::with_capacity(3 * contacts),
            first_coordinate: of_nodes(),
            envelope_start: of_nodes(),
            order: of_nodes(),
            first: of_nodes(),
            at_node: Vec::with_capacity(3 * contacts),
            ends: of_nodes(),
            marks: Vec::with_capacity(nodes),
        }
    }

    /// The nodes of an island, in their order.
    pub fn order_of(&self, island: &Island) -> &[usize] {
        &self.order[island.nodes.clone()]
    }

    /// Finds the islands of an assembled problem.
    pub fn find(&mut self, coordinates: &ReducedCoordinates, contacts: &[Contact]) {
        let nodes = coordinates.nodes.len();
        self.list_contacts(nodes, &coordinates.blocks);
        self.islands.clear();
        self.contacts.clear();
        self.order.clear();
        self.marks.clear();
        self.marks.resize(nodes, Mark::Unseen);
        self.first_coordinate.clear();
        self.first_coordinate.resize(nodes, 0);
        let blocks = |contact: usize| coordinates.blocks_of(&contacts[contact]);
        let mut at = 0;
        for start in 0..nodes {
            if self.marks[start] != Mark::Unseen {
                continue;
            }
            // The last node of a breadth-first search from anywhere is one end.
            let begin = self.order.len();
            self.spread(start, Mark::Tried, &blocks);
            let end = self.order[self.order.len() - 1];
            self.order.truncate(begin);
            self.spread(end, Mark::Placed, &blocks);
            self.order[begin..].reverse();
            let (from, first_contact) = (at, self.contacts.len());
            for &node in &self.order[begin..] {
                self.first_coordinate[node] = at;
                at += coordinates.nodes[node].size;
            }
            for &node in &self.order[begin..] {
                self.contacts.extend(&self.at_node[self.first[node]..self.first[node + 1]]);
            }
            let own = &mut self.contacts[first_contact..];
            own.sort_unstable();
            // A contact between two nodes was listed twice.
            let mut kept = first_contact;
            for k in first_contact..self.contacts.len() {
                if k == first_contact || self.contacts[k] != self.contacts[kept - 1] {
                    self.contacts[kept] = self.contacts[k];
                    kept += 1;
                }
            }
            self.contacts.truncate(kept);
            self.islands.push(Island {
                nodes: begin..self.order.len(),
                coordinates: from..at,
                contacts: first_contact..kept,
            });
        }
        self.envelope_start.clear();
        self.envelope_start.extend(&self.first_coordinate);
        for &contact in &self.contacts {
            let least = blocks(contact).iter().map(|block| self.first_coordinate[block.node]).min().unwrap_or(0);
            for block in blocks(contact) {
                self.envelope_start[block.node] = self.envelope_start[block.node].min(least);
            }
        }
    }

    /// Lists the contacts of every node.
    fn list_contacts(&mut self, nodes: usize, blocks: &[NodeBlock]) {
        self.first.clear();
        self.first.resize(nodes + 1, 0);
        blocks.iter().for_each(|block| self.first[block.node + 1] += 1);
        for node in 0..nodes {
            self.first[node + 1] += self.first[node];
        }
        self.at_node.clear();
        self.at_node.resize(blocks.len(), 0);
        // Filled from behind, so that `first` ends as it was.
        let mut left = std::mem::take(&mut self.ends);
        left.clear();
        left.extend(&self.first[1..]);
        for block in blocks.iter().rev() {
            left[block.node] -= 1;
            self.at_node[left[block.node]] = block.contact;
        }
        self.ends = left;
    }

    /// Appends the island of a node to the order by breadth-first search, nodes with few contacts first.
    fn spread<'a>(&mut self, from: usize, mark: Mark, blocks: &impl Fn(usize) -> &'a [NodeBlock]) {
        let mut next = self.order.len();
        self.order.push(from);
        self.marks[from] = mark;
        while next < self.order.len() {
            let node = self.order[next];
            next += 1;
            let added = self.order.len();
            for k in self.first[node]..self.first[node + 1] {
                for block in blocks(self.at_node[k]) {
                    if self.marks[block.node] != mark {
                        self.marks[block.node] = mark;
                        self.order.push(block.node);
                    }
                }
            }
            let first = &self.first;
            self.order[added..].sort_unstable_by_key(|&node| (first[node + 1] - first[node], node));
        }
    }
}
