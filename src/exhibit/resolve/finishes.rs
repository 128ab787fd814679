//! Resolves finishes and colours: what the sidecar says of each node, and the model dressed in it.
//!
//! The nearest wins: the part, the part's material, the body, the body's material. A body's material says nothing of parts, which
//! have materials of their own. What the sidecar leaves open, the model's extras say.

use super::super::codes;
use super::super::diagnostic::{Diagnostic, quoted, similar_names};
use super::super::finish::{self, Choice, Finish, dress};
use super::super::model::Model;
use super::super::sidecar::Color;
use super::super::source::join;
use super::context::Context;
use super::wires::linear;

/// Nodes for which a place of the sidecar chooses.
struct Chosen {
    at: String,
    nodes: Vec<usize>,
}

impl Context<'_> {
    /// The model with its finishes.
    pub(super) fn dressed(&mut self) -> Model {
        let (choices, chosen) = self.choices();
        let shared = self.shared_mesh_bytes();
        self.afford(shared, "dressing meshes that several nodes share", "/model");
        let mut model = self.model.clone();
        if self.problems.iter().any(Diagnostic::is_error) {
            return model;
        }
        let changed = dress(&mut model, |node| choices[node]);
        for Chosen { at, nodes } in chosen {
            if !nodes.iter().any(|node| changed.contains(node)) {
                let problem = Diagnostic::new(codes::UNUSED, "no mesh here can take the finish or the colour")
                    .label("meshes with textures of their own, glass and bending meshes stay as they are");
                self.report(&at, problem.help("leave finish and color out, or change the model"));
            }
        }
        model
    }

    /// Memory of the copies of shared meshes: each node may be given another finish, bytes.
    fn shared_mesh_bytes(&self) -> u64 {
        let mut seen = vec![false; self.model.meshes.len()];
        let again = |mesh: &usize| std::mem::replace(&mut seen[*mesh], true);
        self.model
            .nodes
            .iter()
            .filter_map(|node| node.mesh)
            .filter(again)
            .map(|mesh| self.model.meshes[mesh].bytes())
            .sum()
    }

    /// What the sidecar chooses for each node, and where it does.
    fn choices(&mut self) -> (Vec<Choice>, Vec<Chosen>) {
        let sidecar = self.sidecar;
        for (name, material) in &sidecar.material {
            self.finish_named(material.finish.as_deref(), &join("/material", name));
        }
        let mut choices = vec![Choice::default(); self.model.nodes.len()];
        let mut chosen = Vec::new();
        let roots: Vec<Option<usize>> = sidecar.body.iter().map(|body| self.known_node(None, &body.node)).collect();
        for (entry, (body, root)) in sidecar.body.iter().zip(&roots).enumerate() {
            let Some(root) = *root else { continue };
            let stops: Vec<usize> = roots.iter().flatten().copied().filter(|&other| other != root).collect();
            let at = format!("/body/{entry}");
            let own = self.choice(body.finish.as_deref(), body.color.as_ref(), &at);
            let whole = Choice { finish: own.finish.or(self.finish_of_material(body.material.as_deref())), ..own };
            let nodes = self.subtree(root, &stops);
            nodes.iter().for_each(|&node| choices[node] = whole);
            let of = format!("body {}", body.node);
            if let Some(finish) = whole.finish {
                self.record_origin(&of, "finish", finish.name.into(), &join(&at, "finish"), "its material");
            }
            if let Some(color) = own.color {
                self.record_origin(&of, "color", format!("{color:?} (linear RGB)"), &join(&at, "color"), "");
            }
            for (number, part) in body.part.iter().enumerate() {
                let Some(top) = self.known_node(Some(root), &part.node) else { continue };
                let at = format!("{at}/part/{number}");
                let given = self.choice(part.finish.as_deref(), part.color.as_ref(), &at);
                let finish = given.finish.or(self.finish_of_material(Some(&part.material))).or(own.finish);
                let nodes = self.subtree(top, &stops);
                nodes.iter().for_each(|&node| choices[node] = Choice { finish, color: given.color.or(own.color) });
                if given.finish.is_some() || given.color.is_some() {
                    chosen.push(Chosen { at, nodes });
                }
            }
            if own.finish.is_some() || own.color.is_some() {
                chosen.push(Chosen { at, nodes });
            }
        }
        (choices, chosen)
    }

    /// What one table says.
    fn choice(&mut self, finish: Option<&str>, color: Option<&Color>, at: &str) -> Choice {
        Choice { finish: self.finish_named(finish, at), color: color.map(linear) }
    }

    /// The finish of this name; reports a name that is not known.
    fn finish_named(&mut self, name: Option<&str>, at: &str) -> Option<&'static Finish> {
        let name = name?;
        let known = finish::named(name);
        if known.is_none() {
            let all = quoted(&finish::names().collect::<Vec<_>>());
            let help = match similar_names(name, finish::names()).as_slice() {
                [] => format!("there are {all}"),
                names => format!("did you mean {}? There are {all}", quoted(names)),
            };
            let problem = Diagnostic::new(codes::UNKNOWN_FINISH, format!("no finish named \"{name}\""));
            self.report(&join(at, "finish"), problem.help(help));
        }
        known
    }

    /// The finish of a material of the sidecar.
    fn finish_of_material(&self, name: Option<&str>) -> Option<&'static Finish> {
        finish::named(self.sidecar.material.get(name?)?.finish.as_deref()?)
    }

    /// The node of this name, as the stage of bodies finds it; it reports the names that are wrong.
    fn known_node(&self, root: Option<usize>, name: &str) -> Option<usize> {
        if let Some(index) = name.strip_prefix('#').and_then(|digits| digits.parse::<usize>().ok()) {
            return (index < self.model.nodes.len()).then_some(index);
        }
        let mut found = self.nodes_named(name);
        if found.len() > 1
            && let Some(root) = root
        {
            found.retain(|&node| self.is_below(node, root));
        }
        if let [one] = found[..] { Some(one) } else { None }
    }
}
