//! From sidecar and model to a valid [`Exhibit`]: each stage resolves names to indices and reports what does not hold.
//!
//! A stage never stops at its first problem, and never returns half a value: what cannot be resolved is left out and
//! an error stands in the report, so that an exhibit comes out only where there is none. Stages in order: materials,
//! bodies (who belongs to whom), wires, masses, joints, colliders, wind and sound, words.

mod bodies;
mod colliders;
mod joints;
mod surfaces;
mod wires;
mod words;

use std::path::{Path, PathBuf};

use super::diagnostic::{Diagnostic, Report, near, quoted};
use super::model::{Imported, Model, import};
use super::sidecar::{Point, Sidecar};
use super::source::{Source, join};
use super::{Exhibit, Material, MaterialPair, Origin, SIDECAR, codes, materials, paths, shape};
use crate::articulation::{Anchor, Axis};
use crate::geometry::TriangleMesh;
use crate::math::{DMat3, DMat4, DQuat, DVec3, Pose};

/// Most bytes of a sidecar.
const MAX_SIDECAR_BYTES: u64 = 4 << 20;
/// The version this program reads.
const VERSION: &str = "exhibit/1";
/// Standard gravity, rounded as curators do, m/s².
const GRAVITY: DVec3 = DVec3::new(0.0, -9.81, 0.0);

/// Loads and checks the exhibit in `folder`: all problems at once, or a valid exhibit with its warnings.
pub fn load(folder: &Path) -> Result<Exhibit, Report> {
    let path = folder.join(SIDECAR);
    let bytes = paths::read_limited(&path, MAX_SIDECAR_BYTES).map_err(Report::of)?;
    let file = path.display().to_string();
    let text = String::from_utf8(bytes).map_err(|error| {
        Report::of(Diagnostic::new(codes::SYNTAX, format!("{file} is not UTF-8: {error}")).help("save it as UTF-8"))
    })?;
    let alone = |diagnostics| Report::in_file(&file, text.as_str().into(), diagnostics);
    let source = Source::parse(&file, &text).map_err(|problem| alone(vec![problem]))?;
    let sidecar = typed(&source).map_err(&alone)?;
    let placed = |mut problem: Diagnostic| {
        problem.location.get_or_insert_with(|| source.locate(source.span("/model")));
        problem
    };
    let model_path = paths::inside(folder, &sidecar.model).map_err(|problem| alone(vec![placed(problem)]))?;
    let Imported { model, warnings } =
        import(&model_path).map_err(|report| alone(report.diagnostics.into_iter().map(placed).collect()))?;
    let mut context = Context::new(&source, &sidecar, &model, folder);
    context.problems.extend(warnings.into_iter().map(placed));
    let exhibit = context.resolve();
    let report = alone(std::mem::take(&mut context.problems));
    if report.has_errors() {
        return Err(report);
    }
    Ok(Exhibit { warnings: report.diagnostics, ..exhibit })
}

/// A plain model as an exhibit in which nothing moves.
pub fn plain(model_path: &Path) -> Result<Exhibit, Report> {
    let Imported { model, warnings } = import(model_path)?;
    let id = model_path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = model_path.parent().map(PathBuf::from).unwrap_or_default();
    Ok(Exhibit { id, folder, warnings, ..Exhibit::of_model(model) })
}

impl Exhibit {
    /// A model alone as an exhibit in which nothing moves, seen through its first camera.
    pub fn of_model(model: Model) -> Self {
        let camera_node = model.nodes.iter().position(|node| node.camera.is_some());
        Self { camera_node, ..empty(model, PathBuf::new()) }
    }
}

/// An exhibit of nothing but its model.
fn empty(model: Model, folder: PathBuf) -> Exhibit {
    Exhibit {
        id: String::new(),
        folder,
        model,
        gravity: GRAVITY,
        camera_node: None,
        materials: Vec::new(),
        material_pairs: Vec::new(),
        bodies: Vec::new(),
        constraints: Vec::new(),
        springs: Vec::new(),
        wires: Vec::new(),
        colliders: Vec::new(),
        excluded_pairs: Vec::new(),
        wind_surfaces: Vec::new(),
        instruments: Vec::new(),
        sounds: Vec::new(),
        attract: super::Attract::default(),
        labels: super::Labels::default(),
        credit: super::Credit::default(),
        warnings: Vec::new(),
        origins: Vec::new(),
    }
}

/// The sidecar as types, once its version and shape are right.
fn typed(source: &Source) -> Result<Sidecar, Vec<Diagnostic>> {
    let version = source.value.get("schema").and_then(|v| v.as_str());
    if let Some(other) = version.filter(|v| *v != VERSION) {
        let mut problem = Diagnostic::new(codes::VERSION, format!("the format \"{other}\" is not known"))
            .help(format!("this program reads schema = \"{VERSION}\""));
        problem.location = Some(source.locate(source.span("/schema")));
        return Err(vec![problem]);
    }
    let problems = shape::check(source);
    if !problems.is_empty() {
        return Err(problems);
    }
    // The schema is made from these types; what it cannot say (a number beyond f32) is caught here.
    serde_json::from_value(source.value.clone())
        .map_err(|error| vec![Diagnostic::new(codes::WRONG_SHAPE, format!("{}: {error}", source.file))])
}

/// What all stages share.
struct Context<'a> {
    source: &'a Source,
    sidecar: &'a Sidecar,
    model: &'a Model,
    folder: &'a Path,
    problems: Vec<Diagnostic>,
    origins: Vec<Origin>,
    materials: Vec<Material>,
    /// Node of each moving body.
    body_nodes: Vec<usize>,
    /// Rest pose of each moving body.
    poses: Vec<Pose>,
    /// Moving body that each node belongs to.
    owner: Vec<Option<usize>>,
}

impl<'a> Context<'a> {
    fn new(source: &'a Source, sidecar: &'a Sidecar, model: &'a Model, folder: &'a Path) -> Self {
        Self {
            source,
            sidecar,
            model,
            folder,
            problems: Vec::new(),
            origins: Vec::new(),
            materials: Vec::new(),
            body_nodes: Vec::new(),
            poses: Vec::new(),
            owner: vec![None; model.nodes.len()],
        }
    }

    fn resolve(&mut self) -> Exhibit {
        let scene = &self.sidecar.scene;
        let gravity = scene.gravity.map_or(GRAVITY, |g| DVec3::from(g.map(|a| a.0)));
        let camera_node = self.camera();
        let folder_name =
            self.folder.canonicalize().ok().and_then(|f| Some(f.file_name()?.to_string_lossy().into_owned()));
        let id = self.sidecar.id.clone().or(folder_name).unwrap_or_default();
        self.trace("scene", "gravity", format!("{gravity} m/s²"), "/scene/gravity", "default");
        self.duplicate_nodes();
        self.materials();
        let material_pairs = self.material_pairs();
        let declared = self.declare_bodies();
        let wires = self.wires();
        let bodies = self.weigh_bodies(&declared, &wires);
        let constraints = self.constraints();
        let springs = self.springs();
        self.check_topology(&constraints);
        let excluded_pairs = self.excluded_pairs(&constraints);
        let colliders = self.colliders(&wires);
        let wind_surfaces = self.wind_surfaces(&wires);
        let (instruments, sounds) = self.sounds(&bodies, &colliders);
        let labels = self.labels();
        let attract = self.attract(&labels);
        Exhibit {
            id,
            gravity,
            camera_node,
            materials: std::mem::take(&mut self.materials),
            material_pairs,
            bodies,
            constraints,
            springs,
            wires,
            colliders,
            excluded_pairs,
            wind_surfaces,
            instruments,
            sounds,
            attract,
            labels,
            credit: self.credit(),
            origins: std::mem::take(&mut self.origins),
            ..empty(self.model.clone(), self.folder.to_path_buf())
        }
    }

    /// Adds a problem at a place of the sidecar.
    fn report(&mut self, at: &str, mut problem: Diagnostic) {
        problem.location = Some(self.source.locate(self.source.span(at)));
        self.problems.push(problem);
    }

    /// Notes a value: from the sidecar where it stands there, else from `otherwise`.
    fn trace(&mut self, of: &str, key: &str, value: String, at: &str, otherwise: &str) {
        let given = self.source.value.pointer(at).is_some();
        let file = SIDECAR;
        let source = if given { format!("{file}:{}", self.source.line(at)) } else { otherwise.to_owned() };
        self.origins.push(Origin { of: of.to_owned(), key: key.to_owned(), value, source });
    }

    fn camera(&mut self) -> Option<usize> {
        let name = self.sidecar.scene.camera.as_ref()?;
        let node = self.node(name, "/scene/camera", "the visitor's camera")?;
        if self.model.nodes[node].camera.is_none() {
            let cameras = self.model.nodes.iter().filter(|n| n.camera.is_some()).map(|n| n.name.as_str());
            let names: Vec<&str> = cameras.collect();
            let help = if names.is_empty() {
                "the model has no cameras; leave the key out".into()
            } else {
                format!("cameras: {}", quoted(&names))
            };
            self.report(
                "/scene/camera",
                Diagnostic::new(codes::NOT_FOUND, format!("node \"{name}\" has no camera")).help(help),
            );
            return None;
        }
        Some(node)
    }

    /// Two nodes of one name are a trap even where the sidecar does not name them yet; the glTF validator is silent.
    fn duplicate_nodes(&mut self) {
        let mut names: Vec<&str> = self.model.nodes.iter().map(|node| node.name.as_str()).collect();
        names.sort_unstable();
        let mut twice: Vec<&str> = names.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
        twice.dedup();
        for name in twice {
            let message = format!("several nodes of the model are named \"{name}\"");
            self.report(
                "/model",
                Diagnostic::new(codes::DUPLICATE_NODE, message)
                    .help("rename them, or point at one by its path or #index"),
            );
        }
    }

    fn materials(&mut self) {
        for name in self.source.keys_of("/material") {
            let Some(given) = self.sidecar.material.get(&name) else { continue };
            let at = join("/material", &name);
            let base = materials::builtin(&name);
            let default = base.clone().unwrap_or(Material {
                name: name.clone(),
                density: 0.0,
                static_friction: 0.4,
                dynamic_friction: 0.3,
                restitution: 0.4,
                youngs_modulus: 0.0,
                poisson: 0.3,
                loss_factor: 0.01,
            });
            let material = Material {
                name: name.clone(),
                density: given.density.map_or(default.density, |v| v.0),
                static_friction: given.static_friction.unwrap_or(default.static_friction),
                dynamic_friction: given.dynamic_friction.unwrap_or(default.dynamic_friction),
                restitution: given.restitution.unwrap_or(default.restitution),
                youngs_modulus: given.youngs_modulus.map_or(default.youngs_modulus, |v| v.0),
                poisson: given.poisson.unwrap_or(default.poisson),
                loss_factor: given.loss_factor.unwrap_or(default.loss_factor),
            };
            for (key, value) in [("density", material.density), ("youngs_modulus", material.youngs_modulus)] {
                if value <= 0.0 {
                    let what = if base.is_none() {
                        "a material that is not built in needs it"
                    } else {
                        "it must be above zero"
                    };
                    let message = format!("material \"{name}\" has no {key}");
                    let known = materials::names().collect::<Vec<_>>().join(", ");
                    self.report(
                        &at,
                        Diagnostic::new(codes::RANGE, message).label(what).help(format!("built in: {known}")),
                    );
                }
            }
            self.trace_material(&material, &at, base.is_some());
            self.materials.push(material);
        }
    }

    fn trace_material(&mut self, material: &Material, at: &str, builtin: bool) {
        let of = format!("material {}", material.name);
        let otherwise = if builtin { "built-in table" } else { "default" };
        for (key, value) in [
            ("density", format!("{} kg/m³", material.density)),
            ("static_friction", material.static_friction.to_string()),
            ("dynamic_friction", material.dynamic_friction.to_string()),
            ("restitution", material.restitution.to_string()),
            ("youngs_modulus", format!("{} GPa", material.youngs_modulus / 1e9)),
            ("poisson", material.poisson.to_string()),
            ("loss_factor", material.loss_factor.to_string()),
        ] {
            self.trace(&of, key, value, &join(at, key), otherwise);
        }
    }

    fn material_pairs(&mut self) -> Vec<MaterialPair> {
        let sidecar = self.sidecar;
        let mut pairs = Vec::new();
        for (i, given) in sidecar.material_pair.iter().enumerate() {
            let at = format!("/material_pair/{i}/pair");
            let first = self.material(&given.pair[0], &format!("{at}/0"));
            let second = self.material(&given.pair[1], &format!("{at}/1"));
            if let (Some(a), Some(b)) = (first, second) {
                pairs.push(MaterialPair {
                    pair: (a, b),
                    restitution: given.restitution,
                    dynamic_friction: given.dynamic_friction,
                    static_friction: given.static_friction,
                });
            }
        }
        pairs
    }

    /// Index of a material of the sidecar or of the built-in table.
    fn material(&mut self, name: &str, at: &str) -> Option<usize> {
        if let Some(index) = self.materials.iter().position(|m| m.name == name) {
            return Some(index);
        }
        if let Some(material) = materials::builtin(name) {
            self.trace_material(&material, "/material/-", true);
            self.materials.push(material);
            return Some(self.materials.len() - 1);
        }
        let builtin: Vec<&str> = materials::names().collect();
        let known = self.sidecar.material.keys().map(String::as_str).chain(builtin.iter().copied());
        let likely = near(name, known);
        let help = match likely.as_slice() {
            [] => format!(
                "built in: {}; or write a table [material.{name}]",
                materials::names().collect::<Vec<_>>().join(", ")
            ),
            names => format!("did you mean {}?", quoted(names)),
        };
        self.report(at, Diagnostic::new(codes::UNKNOWN_MATERIAL, format!("no material named \"{name}\"")).help(help));
        None
    }

    /// The node named `name`: a unique name, a path `Frame/Arm`, or `#12`.
    fn node(&mut self, name: &str, at: &str, used_for: &str) -> Option<usize> {
        self.node_below(None, name, at, used_for)
    }

    /// The node named `name`, those below `root` first.
    fn node_below(&mut self, root: Option<usize>, name: &str, at: &str, used_for: &str) -> Option<usize> {
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
                let likely = near(name, model.nodes.iter().map(|node| node.name.as_str()));
                let help = match likely.as_slice() {
                    [] => "names are case-sensitive; `soffio explain` lists the nodes".to_owned(),
                    names => format!("nodes with near names: {}", quoted(names)),
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
    fn nodes_named(&self, name: &str) -> Vec<usize> {
        let nodes = &self.model.nodes;
        let exact: Vec<usize> = (0..nodes.len()).filter(|&i| nodes[i].name == name).collect();
        if !exact.is_empty() || !name.contains('/') {
            return exact;
        }
        let ends = |leaf: &usize| {
            let mut at = Some(*leaf);
            name.rsplit('/').all(|part| {
                let here = at.filter(|&i| nodes[i].name == part);
                at = here.and_then(|i| nodes[i].parent);
                here.is_some()
            })
        };
        (0..nodes.len()).filter(ends).collect()
    }

    /// Is `node` `root` or below it?
    fn is_below(&self, node: usize, root: usize) -> bool {
        std::iter::successors(Some(node), |&n| self.model.nodes[n].parent).any(|n| n == root)
    }

    /// Name of a body, or of the world, for messages.
    fn body_name(&self, body: Option<usize>) -> &str {
        body.map_or("the world", |b| self.model.nodes[self.body_nodes[b]].name.as_str())
    }

    fn pose_of(&self, body: Option<usize>) -> Pose {
        body.map_or(Pose::IDENTITY, |b| self.poses[b])
    }

    /// A point of a node's space as an anchor of the body that the node belongs to.
    fn anchor(&self, node: usize, point: DVec3) -> Anchor {
        let body = self.owner[node];
        let world = self.model.nodes[node].world.transform_point3(point);
        Anchor { body, point: self.pose_of(body).inverse_point(world) }
    }

    /// A direction of a node's space as an axis of the body that the node belongs to.
    fn axis(&mut self, node: usize, direction: [f64; 3], at: &str) -> Option<Axis> {
        let body = self.owner[node];
        let world = self.model.nodes[node].world.transform_vector3(DVec3::from(direction));
        self.unit(world, at).map(|unit| Axis { body, direction: self.pose_of(body).inverse_vector(unit) })
    }

    fn unit(&mut self, direction: DVec3, at: &str) -> Option<DVec3> {
        let unit = direction.try_normalize();
        if unit.is_none() {
            let problem = Diagnostic::new(codes::NO_AXIS, "a direction has no length");
            self.report(at, problem.help("give a vector such as [0, 1, 0]"));
        }
        unit
    }

    /// A point given as a node's name or as coordinates in the space of `node`.
    fn point(&mut self, node: usize, given: Option<&Point>, at: &str, used_for: &str) -> Option<Anchor> {
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
                            .help("hang the node below the body in the model"),
                    );
                    return None;
                }
                Some(self.anchor(mark, DVec3::ZERO))
            }
        }
    }

    /// World position of an anchor at rest.
    fn at_rest(&self, anchor: &Anchor) -> DVec3 {
        self.pose_of(anchor.body).point(anchor.point)
    }

    /// Nodes at and below `root` that belong to the same body, without the subtrees in `except`.
    fn subtree(&self, root: usize, except: &[usize]) -> Vec<usize> {
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
    fn node_mesh(&self, node: usize) -> Option<TriangleMesh> {
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
        // Weld before the transform: equal corners are equal in the file, not always after rounding.
        out = out.welded();
        for p in &mut out.positions {
            *p = frame.transform_point3(*p);
        }
        (!out.triangles.is_empty()).then_some(out)
    }

    /// The meshes at and below a node, in the frame of its body; reports where there is none.
    fn mesh_of(&mut self, node: usize, at: &str, used_for: &str) -> Option<TriangleMesh> {
        let mut mesh = TriangleMesh::default();
        for part in self.subtree(node, &[]) {
            if let Some(own) = self.node_mesh(part) {
                mesh.append(&own);
            }
        }
        if mesh.triangles.is_empty() {
            let name = &self.model.nodes[node].name;
            let message = format!("node \"{name}\" has no mesh");
            self.report(at, Diagnostic::new(codes::NO_MESH, message).label(format!("needed for {used_for}")));
            return None;
        }
        Some(mesh)
    }
}

/// Rotation and position of a matrix of rotation, translation and one positive scale; `None` where it is more.
fn rigid(matrix: &DMat4) -> Option<Pose> {
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
