//! State that all stages of resolving share.

use std::collections::BTreeMap;
use std::path::Path;

use super::super::bodies::Material;
use super::super::budget::Budget;
use super::super::codes;
use super::super::diagnostic::Diagnostic;
use super::super::exhibit::Origin;
use super::super::model::Model;
use super::super::own_timbres::OwnTimbres;
use super::super::paths::SIDECAR;
use super::super::sidecar::Sidecar;
use super::super::source::SidecarText;
use super::sheets::SheetGrid;
use soffio_math::Pose;
use soffio_multibody::dynamics::KinematicBody;

/// State that all stages share.
pub(super) struct Context<'a> {
    pub(super) source: &'a SidecarText,
    pub(super) sidecar: &'a Sidecar,
    pub(super) model: &'a Model,
    /// Nodes of each name, in the model's order.
    pub(super) named: BTreeMap<&'a str, Vec<usize>>,
    pub(super) folder: &'a Path,
    /// Timbres of the exhibit's own folder.
    pub(super) own_timbres: &'a OwnTimbres,
    /// What the exhibit may cost.
    pub(super) budget: &'a Budget,
    pub(super) problems: Vec<Diagnostic>,
    pub(super) origins: Vec<Origin>,
    pub(super) materials: Vec<Material>,
    /// Node of each moving body.
    pub(super) body_nodes: Vec<usize>,
    /// Pose of each moving body in the model.
    pub(super) poses: Vec<Pose>,
    /// Start pose of each moving body: that of the model, of the sidecar, or of a path.
    pub(super) starts: Vec<Pose>,
    /// Kinematic bodies.
    pub(super) drives: Vec<KinematicBody>,
    /// Kinematic body, index of the animation that it follows, and whether that repeats.
    pub(super) followed: Vec<(usize, usize, bool)>,
    /// Sheets of cells.
    pub(super) sheets: Vec<SheetGrid>,
    /// Body that each node belongs to.
    pub(super) owner: Vec<Option<usize>>,
}

impl<'a> Context<'a> {
    pub(super) fn new(
        source: &'a SidecarText,
        sidecar: &'a Sidecar,
        model: &'a Model,
        folder: &'a Path,
        own_timbres: &'a OwnTimbres,
        budget: &'a Budget,
    ) -> Self {
        let mut named: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (index, node) in model.nodes.iter().enumerate() {
            named.entry(&node.name).or_default().push(index);
        }
        Self {
            source,
            sidecar,
            model,
            named,
            folder,
            own_timbres,
            budget,
            problems: Vec::new(),
            origins: Vec::new(),
            materials: Vec::new(),
            body_nodes: Vec::new(),
            poses: Vec::new(),
            starts: Vec::new(),
            drives: Vec::new(),
            followed: Vec::new(),
            sheets: Vec::new(),
            owner: vec![None; model.nodes.len()],
        }
    }

    /// Adds a problem at a place of the sidecar.
    pub(super) fn report(&mut self, at: &str, mut problem: Diagnostic) {
        problem.location = Some(self.source.locate(self.source.span(at)));
        self.problems.push(problem);
    }

    /// Charges memory for `what` at a place of the sidecar, bytes. Returns whether it fits; the first excess is reported.
    pub(super) fn afford(&mut self, bytes: u64, what: &str, at: &str) -> bool {
        let Err(excess) = self.budget.charge(bytes) else { return true };
        if !self.problems.iter().any(|problem| problem.code == codes::BUDGET.name) {
            self.report(at, excess.diagnostic(what));
        }
        false
    }

    /// Records a value and its source: the sidecar where it is set there, else `otherwise`.
    pub(super) fn record_origin(&mut self, of: &str, key: &str, value: String, at: &str, otherwise: &str) {
        let given = self.source.value.pointer(at).is_some();
        let file = SIDECAR;
        let source = if given { format!("{file}:{}", self.source.line(at)) } else { otherwise.to_owned() };
        self.origins.push(Origin { of: of.to_owned(), key: key.to_owned(), value, source });
    }
}
