//! Looks up nodes by name, and the points, axes and meshes of their bodies.

use super::super::codes;
use super::super::diagnostic::{Diagnostic, quoted, similar_names};
use super::super::model::Primitive;
use super::super::sidecar::Point;
use super::super::source::natural_key;
use super::context::Context;
use soffio_geometry::TriangleMesh;
use soffio_math::{DMat3, DMat4, DQuat, DVec3, Pose};
use soffio_multibody::articulation::{Anchor, Axis};

impl Context<'_> {
    /// The node named `name`: a unique name, a path `Frame/Arm`, or `#12`.
    pub(super) fn node(&mut self, name: &str, at: &str, used_for: &str) -> Option<usize> {
        self.node_below(None, name, at, used_for)
    }

    /// The node named `name`; nodes below `root` have precedence.
    pub(super) fn node_below(&mut self, root: Option<usize>, name: &str, at: &str, used_for: &str) -> Option<usize> {
        let model = self.model;
        if let Some(index) = name.strip_prefix('#').and_then(|digits| digits.parse::<usize>().ok())
            && index < model.nodes.len()
        {
            return Some(index);
        }
        let mut found = self.nodes_named(name);
        if found.len() > 1
            && let Some(root) = root
        {
            found.retain(|&node| self.is_below(node, root));
        }
        match found.as_slice() {
            [one] => Some(*one),
            [] => {
                let likely = similar_names(name, model.nodes.iter().map(|node| node.name.as_str()));
                let help = match likely.as_slice() {
                    [] => "names are case-sensitive; `soffio explain` lists the nodes".to_owned(),
                    names => format!("similar names: {}", quoted(names)),
                };
                let message = format!("no node named \"{name}\" in {}", self.sidecar.model);
                self.report(
                    at,
                    Diagnostic::new(codes::NOT_FOUND, message).label(format!("used for {used_for}")).help(help),
                );
                None
            }
            several => {
                let indices: Vec<String> = several.iter().map(|i| format!("#{i}")).collect();
                let message = format!("{} nodes are named \"{name}\"", several.len());
                let help = format!("rename them, write a path \"Parent/{name}\", or an index: {}", indices.join(", "));
                self.report(
                    at,
                    Diagnostic::new(codes::AMBIGUOUS, message).label(format!("used for {used_for}")).help(help),
                );
                None
            }
        }
    }

    /// Nodes with this name, or at the end of this path.
    pub(super) fn nodes_named(&self, name: &str) -> Vec<usize> {
        let nodes = &self.model.nodes;
        let with = |name: &str| self.named.get(name).cloned().unwrap_or_default();
        let exact = with(name);
        if !exact.is_empty() {
            return exact;
        }
        let Some((_, last)) = name.rsplit_once('/') else { return exact };
        let ends = |leaf: &usize| {
            let mut at = Some(*leaf);
            name.rsplit('/').all(|part| {
                let here = at.filter(|&i| nodes[i].name == part);
                at = here.and_then(|i| nodes[i].parent);
                here.is_some()
            })
        };
        with(last).into_iter().filter(ends).collect()
    }

    /// The nodes of a pattern such as `Rod.*`, in natural order: children of `root` that belong to its body, or without
    /// a root all fixed nodes.
    pub(super) fn marker_nodes(
        &mut self,
        root: Option<usize>,
        pattern: &str,
        at: &str,
        used_for: &str,
    ) -> Option<Vec<usize>> {
        let model = self.model;
        let Some(start) = pattern.strip_suffix('*').filter(|start| !start.is_empty() && !start.contains('*')) else {
            let message = format!("\"{pattern}\" is not a pattern of names");
            let help = "write the beginning of their names and a *, such as \"Rod.*\", or list them one by one";
            self.report(at, Diagnostic::new(codes::WRONG_SHAPE, message).help(help));
            return None;
        };
        let candidates: Vec<usize> = match root {
            Some(root) => model.nodes[root].children.clone(),
            None => (0..model.nodes.len()).collect(),
        };
        let owner = root.and_then(|root| self.owner[root]);
        let named = |node: &usize| self.owner[*node] == owner && model.nodes[*node].name.starts_with(start);
        let mut marker_nodes: Vec<usize> = candidates.into_iter().filter(named).collect();
        marker_nodes.sort_by_cached_key(|&node| natural_key(&model.nodes[node].name));
        if marker_nodes.len() < 2 {
            let place = match root {
                Some(root) => format!("below \"{}\"", model.nodes[root].name),
                None => "that is fixed".to_owned(),
            };
            let message = match marker_nodes.len() {
                0 => format!("no node {place} has a name that begins with \"{start}\""),
                _ => format!("only one node {place} has a name that begins with \"{start}\""),
            };
            let known = model.nodes.iter().map(|node| node.name.as_str());
            let help = match similar_names(start, known).as_slice() {
                [] => "at least two are needed".to_owned(),
                names => format!("at least two are needed; similar names: {}", quoted(names)),
            };
            self.report(
                at,
                Diagnostic::new(codes::NOT_FOUND, message).label(format!("used for {used_for}")).help(help),
            );
            return None;
        }
        Some(marker_nodes)
    }

    /// Is `node` `root` or below it?
    pub(super) fn is_below(&self, node: usize, root: usize) -> bool {
        std::iter::successors(Some(node), |&n| self.model.nodes[n].parent).any(|n| n == root)
    }

    /// Name of a body, or of the world, for messages.
    pub(super) fn body_name(&self, body: Option<usize>) -> &str {
        body.map_or("the world", |b| self.model.nodes[self.body_nodes[b]].name.as_str())
    }

    pub(super) fn pose_of(&self, body: Option<usize>) -> Pose {
        body.map_or(Pose::IDENTITY, |b| self.poses[b])
    }

    /// Start pose of a body (or of the world).
    pub(super) fn start_of(&self, body: Option<usize>) -> Pose {
        body.map_or(Pose::IDENTITY, |b| self.starts[b])
    }

    /// Is the body kinematic?
    pub(super) fn is_kinematic(&self, body: usize) -> bool {
        self.drives.iter().any(|drive| drive.body == body)
    }

    /// A point of a node's space as an anchor of the body that the node belongs to.
    pub(super) fn anchor(&self, node: usize, point: DVec3) -> Anchor {
        let body = self.owner[node];
        let world = self.model.nodes[node].world.transform_point3(point);
        Anchor { body, point: self.pose_of(body).inverse_point(world) }
    }

    /// A direction of a node's space as an axis of the body that the node belongs to.
    pub(super) fn axis(&mut self, node: usize, direction: [f64; 3], at: &str) -> Option<Axis> {
        let body = self.owner[node];
        let world = self.model.nodes[node].world.transform_vector3(DVec3::from(direction));
        self.unit(world, at).map(|unit| Axis { body, direction: self.pose_of(body).inverse_vector(unit) })
    }

    pub(super) fn unit(&mut self, direction: DVec3, at: &str) -> Option<DVec3> {
        let unit = direction.try_normalize();
        if unit.is_none() {
            let problem = Diagnostic::new(codes::NO_AXIS, "a direction has length zero");
            self.report(at, problem.help("give a vector such as [0, 1, 0]"));
        }
        unit
    }

    /// A point given as a node's name or as coordinates in the space of `node`.
    pub(super) fn point(&mut self, node: usize, given: Option<&Point>, at: &str, used_for: &str) -> Option<Anchor> {
        match given {
            None => Some(self.anchor(node, DVec3::ZERO)),
            Some(Point::Position(p)) => Some(self.anchor(node, DVec3::from(p.map(|x| x.0)))),
            Some(Point::Node(name)) => {
                let mark = self.node_below(Some(node), name, at, used_for)?;
                if self.owner[mark] != self.owner[node] {
                    let (mark_body, body) = (self.body_name(self.owner[mark]), self.body_name(self.owner[node]));
                    let message = format!("node \"{name}\" belongs to {mark_body}, not to {body}");
                    self.report(
                        at,
                        Diagnostic::new(codes::NOT_DESCENDANT, message)
                            .help("move the node below the body in the model's tree"),
                    );
                    return None;
                }
                Some(self.anchor(mark, DVec3::ZERO))
            }
        }
    }

    /// World position of an anchor in the model.
    pub(super) fn reference_position(&self, anchor: &Anchor) -> DVec3 {
        self.pose_of(anchor.body).point(anchor.point)
    }

    /// World position of an anchor at the start.
    pub(super) fn start_position(&self, anchor: &Anchor) -> DVec3 {
        self.start_of(anchor.body).point(anchor.point)
    }

    /// Nodes at and below `root` that belong to the same body, without the subtrees in `except`.
    pub(super) fn subtree(&self, root: usize, except: &[usize]) -> Vec<usize> {
        let mut nodes = Vec::new();
        let mut waiting = vec![root];
        while let Some(node) = waiting.pop() {
            nodes.push(node);
            let children = self.model.nodes[node].children.iter().copied();
            waiting.extend(children.filter(|c| self.owner[*c] == self.owner[root] && !except.contains(c)));
        }
        nodes.sort_unstable();
        nodes
    }

    /// The mesh of one node in the frame of its body; `None` where it has none.
    pub(super) fn node_mesh(&self, node: usize) -> Option<TriangleMesh> {
        if let Some(cell) = self.cell_at(node) {
            return Some(cell);
        }
        let mesh = &self.model.meshes[self.model.nodes[node].mesh?];
        let frame = self.pose_of(self.owner[node]).matrix().inverse() * self.model.nodes[node].world;
        let mirrored = DMat3::from_mat4(frame).determinant() < 0.0;
        let mut out = TriangleMesh::default();
        for primitive in &mesh.primitives {
            let base = out.positions.len() as u32;
            out.positions.extend(primitive.positions.iter().map(|p| DVec3::from(p.map(f64::from))));
            out.triangles.extend(primitive.indices.chunks_exact(3).map(|t| {
                if mirrored { [base + t[0], base + t[2], base + t[1]] } else { [base + t[0], base + t[1], base + t[2]] }
            }));
        }
        // Weld before the transform: equal vertices are equal in the file, not always after rounding.
        out = out.welded();
        for p in &mut out.positions {
            *p = frame.transform_point3(*p);
        }
        (!out.triangles.is_empty()).then_some(out)
    }

    /// Memory of the triangles that a node shows, with the edges by which a mesh is tested for holes, bytes.
    fn mesh_bytes(&self, node: usize) -> u64 {
        const TRIANGLE: u64 = size_of::<[u32; 3]>() as u64 + 3 * 40;
        let primitives = self.model.nodes[node].mesh.map_or(&[][..], |mesh| &self.model.meshes[mesh].primitives);
        let bytes = |primitive: &Primitive| {
            let (corners, triangles) = (primitive.positions.len() as u64, primitive.indices.len() as u64 / 3);
            corners * size_of::<DVec3>() as u64 + triangles * TRIANGLE
        };
        primitives.iter().map(bytes).sum()
    }

    /// The meshes at and below a node, in the frame of its body; reports a missing mesh.
    pub(super) fn mesh_of(&mut self, node: usize, at: &str, used_for: &str) -> Option<TriangleMesh> {
        let mut mesh = TriangleMesh::default();
        for part in self.subtree(node, &[]) {
            let bytes = self.mesh_bytes(part);
            if !self.afford(bytes, used_for, at) {
                return None;
            }
            if let Some(own) = self.node_mesh(part) {
                mesh.append(&own);
            }
        }
        if mesh.triangles.is_empty() {
            let name = &self.model.nodes[node].name;
            let message = format!("node \"{name}\" has no mesh");
            let problem = Diagnostic::new(codes::NO_MESH, message).label(format!("needed for {used_for}"));
            self.report(at, problem.help("give it a mesh in the model, or name the node that has one"));
            return None;
        }
        Some(mesh)
    }
}

/// Rotation and position of a matrix of rotation, translation and one positive scale; `None` for other matrices.
pub(super) fn rigid(matrix: &DMat4) -> Option<Pose> {
    /// glTF stores single precision: seven digits, of which chains of nodes lose one or two.
    const EVEN: f64 = 1e-5;
    let axes = DMat3::from_mat4(*matrix);
    let lengths = DVec3::new(axes.x_axis.length(), axes.y_axis.length(), axes.z_axis.length());
    let scale = lengths.element_sum() / 3.0;
    let even = (lengths - scale).abs().max_element() <= EVEN * scale;
    let square = [(axes.x_axis, axes.y_axis), (axes.y_axis, axes.z_axis), (axes.z_axis, axes.x_axis)];
    let right_angled = square.iter().all(|(a, b)| a.dot(*b).abs() <= EVEN * scale * scale);
    if !(scale > 0.0 && even && right_angled && axes.determinant() > 0.0) {
        return None;
    }
    let rotation =
        DQuat::from_mat3(&DMat3::from_cols(axes.x_axis / lengths.x, axes.y_axis / lengths.y, axes.z_axis / lengths.z));
    Some(Pose { rotation: rotation.normalize(), position: matrix.w_axis.truncate() })
}
