//! Sparse factorisation of closed loops: the Schur complement of each biconnected component's rows.
//!
//! The joints of an articulation form a tree of biconnected components (`biconnected.rs`). A component with loops is
//! attached to its *top* t, a body or the ground. It is eliminated like a body with its parent in `tree.rs`, by the
//! same equations, where c stands for all of its bodies but the top. A is their articulated inertia (one block a
//! body, with all children eliminated). J_c and J_t are the blocks of the component's rows on them and on the top,
//! J_d those on bodies whose a is given:
//!
//! ```text
//! K = J_c A⁻¹ J_cᵀ + Γ         W = A⁻¹ J_cᵀ         e = g − Wᵀ b_c − J_d a_d
//! λ = K⁻¹ (e − J_t a_t)        A_t += J_tᵀ K⁻¹ J_t        b_t += J_tᵀ K⁻¹ e        a_c = A⁻¹ b_c + W λ
//! ```
//!
//! K has a block for each two joints that share a body, so it is as sparse as the mechanism. `sparse_structure.rs`
//! finds its elimination order once. A chain of loops costs as much as its loops one by one, a net of n knots about
//! n^1.5.
//!
//! All rows of a component are eliminated before its top. No row is lost: where joints are closed, a rigid motion of
//! component and top opens none of them, so independent rows stay independent with the top held. Open joints may
//! violate this; then rows are being stabilised, and are soft.
//!
//! A train (`trains/`) is a body of one coordinate: a row's block on it is its f, A its m. The ground carries it, so that no
//! component with a train has a top.
//!
//! Rows that repeat others (a planar four-bar of hinges has three) get the multiplier 0, as in the tree.

pub(super) mod biconnected;
mod cluster;
mod eliminate;
mod sparse_factor;
mod sparse_structure;

use super::trains::Trains;
use super::tree::{JointRows, Tree};
use cluster::{Cluster, Node};
use eliminate::RowSource;
use soffio_math::spatial::row_blocks::RowVec;
use soffio_math::spatial::{NUMBERS, Vec6};

/// Γ of rows that close loops during stabilisation, relative to their uncoupled effective inverse mass. During
/// assembly rows may be almost redundant but inconsistent; this compliance keeps their multipliers small.
pub const STABILISING_COMPLIANCE: f64 = 1e-4;

/// What the elimination of a component reads beside its own rows.
#[derive(Clone, Copy)]
pub struct LoopInputs<'a> {
    /// Row blocks of the joints.
    pub blocks: &'a [JointRows],
    /// Gear trains.
    pub trains: &'a Trains,
    /// Whether any row is being closed by stabilisation: then rows that close loops get [`STABILISING_COMPLIANCE`].
    pub stabilising: bool,
}

/// One row outside the tree. Where it is one of a joint, only the dense solver keeps its numbers here.
#[derive(Clone, Debug)]
pub struct LoopRow {
    /// Where its numbers are in `g` and `lambda`.
    pub at: usize,
    /// Does it act now?
    pub active: bool,
    /// J: a block per body that it touches.
    pub parts: Vec<(usize, Vec6)>,
    /// Which row of its joint it is; those before it stand before it here.
    pub place: usize,
    /// Γ with the rows of its joint, from the first to itself.
    pub compliance: RowVec,
    /// Is it a coupling inside a gear train? The train's own elimination holds it, so the loops leave it out.
    pub train_internal: bool,
}

impl LoopRow {
    /// Is it between bodies that sleep?
    pub fn sleeps(&self, asleep: &[bool]) -> bool {
        self.parts.iter().any(|(body, _)| asleep[*body])
    }
}

/// Rows of a joint or a coupling outside the tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    /// Index of the first.
    pub first: usize,
    /// Most that there may be.
    pub count: usize,
    /// Where a joint has its blocks; a coupling has them in the row.
    pub block: Option<usize>,
}

/// Rows of all loops, and their factor.
#[derive(Clone, Debug, Default)]
pub struct Loops {
    /// Every row that there may be.
    pub rows: Vec<LoopRow>,
    clusters: Vec<Cluster>,
    /// Component and node of each row; none where nothing gives way to it.
    places: Vec<Option<(usize, usize)>>,
    /// Impulses of the rows along each train.
    pushes: Vec<f64>,
    /// The same for a rate of each train alone that they are not asked to keep; empty until it is asked for.
    train_responses: Vec<f64>,
}

impl Loops {
    /// Those beside a tree, of joints and couplings that have these spans of them.
    pub(super) fn new(rows: Vec<LoopRow>, tree: &Tree, spans: &[Span], trains: &Trains) -> Self {
        let new = |component| Cluster::new(component, spans, &rows, trains, |body| tree.has_children(body));
        let clusters: Vec<Cluster> = tree.components.iter().map(new).collect();
        let mut places = vec![None; rows.len()];
        for (cluster, of) in clusters.iter().enumerate() {
            for (node, Node { span, .. }) in of.nodes.iter().enumerate() {
                places[span.first..span.first + span.count].fill(Some((cluster, node)));
            }
        }
        let count = trains.count();
        Self { rows, clusters, places, pushes: vec![0.0; count], train_responses: Vec::with_capacity(count * count) }
    }

    /// Was this row, which acts, found to repeat others at the last factorisation? So does one to which nothing gives way.
    pub fn is_redundant(&self, row: usize) -> bool {
        let repeats = |(cluster, node): (usize, usize)| {
            let of: &Cluster = &self.clusters[cluster];
            of.factor.is_redundant(node, row - of.nodes[node].span.first)
        };
        self.places[row].map_or(!self.rows[row].train_internal, repeats)
    }

    /// How many numbers the factors of all components hold at most.
    pub fn numbers(&self) -> usize {
        self.clusters.iter().map(|cluster| cluster.factor.numbers()).sum()
    }

    /// A new factor is made.
    pub fn begin(&mut self) {
        self.train_responses.clear();
    }

    /// Eliminates a component, after all children of its bodies.
    #[inline(always)]
    pub fn factor(&mut self, index: usize, masses: &mut [[f64; NUMBERS]], inputs: LoopInputs) {
        let LoopInputs { blocks, trains, stabilising } = inputs;
        self.clusters[index].factor(RowSource { blocks, rows: &self.rows }, masses, trains, stabilising);
    }

    /// Begins a solve.
    #[inline(always)]
    pub fn begin_solve(&mut self) {
        self.pushes.fill(0.0);
    }

    /// The way up of a component. `a` lends the accelerations of driven bodies and of trains as if there were nothing else.
    #[inline(always)]
    pub fn inward(&mut self, index: usize, b: &mut [Vec6], g: &[f64], a: &[Vec6]) {
        self.clusters[index].inward(b, g, a);
    }

    /// The way down of a component, after its top.
    #[inline(always)]
    pub fn outward(&mut self, index: usize, b: &[Vec6], lambda: &mut [f64], a: &mut [Vec6]) {
        self.clusters[index].outward(b, lambda, a, &mut self.pushes);
    }

    /// What the rows push along each train's coordinate, after a solve.
    pub fn pushes(&self) -> &[f64] {
        &self.pushes
    }

    /// Adds the rows' response to an impulse that acts on trains alone, whose own responses are set. Contacts need
    /// this often, and there are few trains, so the responses to each of them are computed once.
    pub fn correct_trains(&mut self, trains: &mut Trains) {
        let count = self.pushes.len();
        if self.train_responses.is_empty() {
            self.train_responses.resize(count * count, 0.0);
            for (train, pushes) in self.train_responses.chunks_exact_mut(count.max(1)).enumerate() {
                self.clusters.iter_mut().for_each(|cluster| cluster.respond_to_train(train, pushes));
            }
        }
        // The answers are the same both ways round.
        for (push, train_responses) in self.pushes.iter_mut().zip(self.train_responses.chunks_exact(count.max(1))) {
            *push = train_responses.iter().enumerate().map(|(train, response)| response * trains.rate(train)).sum();
        }
        for (train, push) in self.pushes.iter().enumerate().filter(|(_, push)| **push != 0.0) {
            trains.add_push(train, *push);
        }
    }
}
