//! Import of glTF physics: `KHR_physics_rigid_bodies` with `KHR_implicit_shapes` (drafts of the Khronos Group, 2024 to
//! 2026; <https://github.com/eoineoineoin/glTF_Physics>) as sidecar tables.
//!
//! Motions become bodies, shapes colliders, materials materials (with a pair for each combine rule), joints
//! constraints. Limits without freedom lock their axes, and the locked axes determine the kind of joint. Frames are
//! nodes in both formats, so every joint names its two nodes. What the sidecar cannot express is reported, node by
//! node.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde_json::Value;

use super::khr_joint;
use super::nodes::{Names, fit, toml_vector};
use super::piece::NO_MASS;
use super::texts::quoted;
use soffio_exhibit::model::Model;
use soffio_geometry::bodies::MassProperties;
use soffio_math::{DMat3, DQuat, DVec3, PI, Pose};

/// Name of the physics extension.
pub const PHYSICS: &str = "KHR_physics_rigid_bodies";
/// Name of the shape extension.
pub const SHAPES: &str = "KHR_implicit_shapes";
/// The extension has no density: that of water, kg/m³.
const DENSITY: f64 = 1000.0;
/// Most pairs of materials and of colliders that are written.
const MAX_PAIRS: usize = 400;

/// Most colliders with filters whose pairs are compared.
const MAX_FILTERED: usize = 1000;

/// A model's physics as sidecar tables.
#[derive(Clone, Debug, Default)]
pub struct Physics {
    /// Tables of the sidecar.
    pub text: String,
    /// What was changed or left out, and why.
    pub remarks: Vec<String>,
    /// Nodes that move by forces.
    pub moving: Vec<usize>,
    /// Are joints open at the start?
    pub joints_open: bool,
}

/// Converts a model's physics; `None` where it has none. `json` is the file's JSON.
pub fn physics(model: &Model, json: &Value) -> Option<Physics> {
    let mut reader = Reader {
        model,
        json,
        names: Names::new(model),
        owners: Vec::new(),
        parts: BTreeMap::new(),
        out: Physics::default(),
    };
    let carries = (0..model.nodes.len()).any(|node| reader.extension(node).is_some());
    carries.then(|| {
        reader.owners();
        reader.materials();
        reader.bodies();
        reader.colliders();
        reader.joints();
        reader.out
    })
}

/// A vector of three numbers.
pub(super) fn vector(value: &Value) -> Option<DVec3> {
    let numbers: Vec<f64> = value.as_array()?.iter().filter_map(Value::as_f64).collect();
    <[f64; 3]>::try_from(numbers).ok().map(DVec3::from)
}

/// A shape of stated size, in its own frame.
enum Solid {
    Sphere {
        radius: f64,
    },
    Box {
        size: DVec3,
    },
    /// `height` is the distance between the centres of the ends.
    Capsule {
        height: f64,
        radius: f64,
    },
    Cylinder {
        height: f64,
        radius: f64,
    },
    Plane,
}

impl Solid {
    fn toml(&self) -> String {
        match self {
            Self::Sphere { radius } => format!("{{ sphere = {{ radius = {radius:?} }} }}"),
            Self::Box { size } => format!("{{ box = {{ size = {} }} }}", toml_vector(*size)),
            Self::Capsule { height, radius } => {
                format!("{{ capsule = {{ height = {height:?}, radius = {radius:?} }} }}")
            }
            Self::Cylinder { height, radius } => {
                format!("{{ cylinder = {{ height = {height:?}, radius = {radius:?} }} }}")
            }
            Self::Plane => "{ plane = {} }".to_owned(),
        }
    }

    /// Volume, m³, and moments of inertia about the centre over the mass, m².
    fn volume(&self) -> (f64, DVec3) {
        match *self {
            Self::Sphere { radius } => (4.0 / 3.0 * PI * radius * radius * radius, DVec3::splat(0.4 * radius * radius)),
            Self::Box { size: DVec3 { x, y, z } } => {
                (x * y * z, DVec3::new(y * y + z * z, z * z + x * x, x * x + y * y) / 12.0)
            }
            Self::Cylinder { height: h, radius: r } => {
                let across = (3.0 * r * r + h * h) / 12.0;
                (PI * r * r * h, DVec3::new(across, 0.5 * r * r, across))
            }
            Self::Capsule { height: h, radius: r } => {
                let (tube, ends) = (PI * r * r * h, 4.0 / 3.0 * PI * r * r * r);
                let volume = tube + ends;
                // A hemisphere's centre of mass is 3r/8 from its face.
                let across = tube * (3.0 * r * r + h * h) / 12.0 + ends * (0.4 * r * r + 0.25 * h * h + 0.375 * h * r);
                let along = tube * 0.5 * r * r + ends * 0.4 * r * r;
                (volume, DVec3::new(across, along, across) / volume)
            }
            Self::Plane => (0.0, DVec3::ZERO),
        }
    }
}

pub(super) struct Reader<'a> {
    pub(super) model: &'a Model,
    json: &'a Value,
    pub(super) names: Names<'a>,
    /// For each node, the nearest ancestor with a motion, or the node itself.
    owners: Vec<Option<usize>>,
    /// The nodes that move with each node that has a motion.
    parts: BTreeMap<usize, Vec<usize>>,
    pub(super) out: Physics,
}

impl Reader<'_> {
    /// A node's physics extension.
    pub(super) fn extension(&self, node: usize) -> Option<&Value> {
        self.json["nodes"].get(node)?.get("extensions")?.get(PHYSICS)
    }

    /// A top-level list of the extension.
    pub(super) fn list(&self, key: &str) -> &[Value] {
        self.json["extensions"][PHYSICS][key].as_array().map_or(&[], Vec::as_slice)
    }

    pub(super) fn remark(&mut self, node: usize, what: impl std::fmt::Display) {
        let name = self.names.of(node);
        self.out.remarks.push(format!("node \"{name}\": {what}"));
    }

    /// Finds what each node moves with, from the roots on.
    fn owners(&mut self) {
        let nodes = &self.model.nodes;
        self.owners = vec![None; nodes.len()];
        let mut open: Vec<usize> = (0..nodes.len()).filter(|&node| nodes[node].parent.is_none()).collect();
        while let Some(node) = open.pop() {
            let moves = self.extension(node).is_some_and(|extension| extension.get("motion").is_some());
            self.owners[node] =
                if moves { Some(node) } else { nodes[node].parent.and_then(|above| self.owners[above]) };
            open.extend(&nodes[node].children);
        }
        for (node, owner) in self.owners.iter().enumerate() {
            if let Some(owner) = owner {
                self.parts.entry(*owner).or_default().push(node);
            }
        }
    }

    /// The nearest ancestor with a motion, or the node itself.
    pub(super) fn moving_ancestor(&self, node: usize) -> Option<usize> {
        self.owners[node]
    }

    fn materials(&mut self) {
        let list = self.list("physicsMaterials").to_vec();
        let number = |material: &Value, key: &str, default: f64| material[key].as_f64().unwrap_or(default);
        let out = &mut self.out.text;
        for (i, material) in list.iter().enumerate() {
            let _ = write!(
                out,
                "# The model's physicsMaterials {i}. It has neither density nor stiffness: REPLACE these by the real ones.\n\
                 [material.khr-{i}]\ndensity = {DENSITY}\nyoungs_modulus = \"10 GPa\"\n\
                 static_friction = {:?}\ndynamic_friction = {:?}\nrestitution = {:?}\n\n",
                number(material, "staticFriction", 0.6),
                number(material, "dynamicFriction", 0.6),
                number(material, "restitution", 0.0).clamp(0.0, 1.0),
            );
        }
        if list.len() * (list.len() + 1) / 2 > MAX_PAIRS {
            self.out.remarks.push(format!("{} materials: their pairs combine by the geometric mean", list.len()));
            return;
        }
        for (i, a) in list.iter().enumerate() {
            for (k, b) in list.iter().enumerate().skip(i) {
                let of = |key: &str, rule: &str, default: f64| {
                    let (x, y) = (number(a, key, default), number(b, key, default));
                    combined(x, y, [&a[rule], &b[rule]].map(|rule| rule.as_str().unwrap_or("average")))
                };
                let _ = write!(
                    out,
                    "[[material_pair]]\npair = [\"khr-{i}\", \"khr-{k}\"]\nstatic_friction = {:?}\ndynamic_friction = {:?}\nrestitution = {:?}\n\n",
                    of("staticFriction", "frictionCombine", 0.6),
                    of("dynamicFriction", "frictionCombine", 0.6),
                    of("restitution", "restitutionCombine", 0.0).clamp(0.0, 1.0),
                );
            }
        }
    }

    fn bodies(&mut self) {
        for node in 0..self.model.nodes.len() {
            let Some(motion) = self.extension(node).and_then(|extension| extension.get("motion")).cloned() else {
                continue;
            };
            let animated =
                self.model.animations.iter().any(|a| a.channels.iter().any(|c| c.node == node && !c.shapes()));
            let mut table = format!("[[body]]\nnode = {}\n", quoted(&self.names.of(node)));
            let kinematic = motion["isKinematic"].as_bool() == Some(true);
            let infinite = motion["mass"].as_f64() == Some(0.0);
            if animated {
                table.push_str("motion = \"kinematic\"\n\n");
                self.out.text.push_str(&table);
                continue;
            }
            if kinematic || infinite {
                let why = if kinematic { "is kinematic and has no animation" } else { "has an infinite mass" };
                self.remark(node, format_args!("{why}: it is fixed"));
                table.push_str("motion = \"static\"\n\n");
                self.out.text.push_str(&table);
                continue;
            }
            self.out.moving.push(node);
            self.write_mass(node, &motion, &mut table);
            let turn = rotation_of(self.model, node);
            let speeds = [("velocity", "linearVelocity"), ("angular_velocity", "angularVelocity")];
            let initial: Vec<String> = speeds
                .iter()
                .filter_map(|(ours, theirs)| Some((ours, turn * vector(&motion[*theirs])?)))
                .filter(|(_, v)| *v != DVec3::ZERO)
                .map(|(ours, v)| format!("{ours} = {}", toml_vector(v)))
                .collect();
            if !initial.is_empty() {
                let _ = writeln!(table, "initial = {{ {} }}", initial.join(", "));
            }
            if motion["gravityFactor"].as_f64().is_some_and(|factor| factor != 1.0) {
                self.remark(node, "gravityFactor is skipped: all bodies have the gravity of [scene]");
            }
            table.push('\n');
            self.out.text.push_str(&table);
        }
    }

    /// Writes material, mass, centre and inertia: given ones, else those of the shapes, as the extension says, else of
    /// the mesh.
    fn write_mass(&mut self, node: usize, motion: &Value, table: &mut String) {
        let material = self
            .nodes_of_body(node)
            .into_iter()
            .find_map(|part| self.extension(part)?["collider"]["physicsMaterial"].as_u64());
        let _ = match material {
            Some(i) => writeln!(table, "material = \"khr-{i}\""),
            None => writeln!(table, "material = \"beech\"  # the model names none"),
        };
        let shapes = self.shape_mass(node);
        let given = motion["mass"].as_f64();
        if let Some(mass) = given.or((shapes.mass > 0.0).then_some(shapes.mass)) {
            let _ = writeln!(
                table,
                "mass = {mass:?}{}",
                if given.is_none() { "  # volume of its shapes × density" } else { "" }
            );
            if let Some(center) = vector(&motion["centerOfMass"]) {
                let _ = writeln!(table, "center_of_mass = {}", toml_vector(center));
            } else if shapes.mass > 0.0 {
                // Node space can be scaled.
                let center = self.model.nodes[node]
                    .world
                    .inverse()
                    .transform_point3(rigid_frame(self.model, node).point(shapes.center));
                let _ = writeln!(table, "center_of_mass = {}", toml_vector(center));
            }
            let diagonal = vector(&motion["inertiaDiagonal"]);
            match diagonal {
                Some(d) if d.min_element() > 0.0 => {
                    let turn = motion["inertiaOrientation"].as_array().into_iter().flatten().filter_map(Value::as_f64);
                    let turn = <[f64; 4]>::try_from(turn.collect::<Vec<_>>());
                    let turn = turn.map_or(String::new(), |q| format!(", orientation = {q:?}"));
                    let _ = writeln!(table, "inertia = {{ diagonal = {}{turn} }}", toml_vector(d));
                }
                other => {
                    if other.is_some() {
                        self.remark(node, "an infinite moment of inertia is skipped; lock its axis by a constraint");
                    }
                    if shapes.mass > 0.0 {
                        let (moments, axes) =
                            soffio_geometry::mass::principal_axes(shapes.inertia * (mass / shapes.mass));
                        let q = DQuat::from_mat3(&axes).normalize();
                        let _ = writeln!(
                            table,
                            "inertia = {{ diagonal = {}, orientation = [{:?}, {:?}, {:?}, {:?}] }}",
                            toml_vector(moments),
                            q.x,
                            q.y,
                            q.z,
                            q.w
                        );
                    }
                }
            }
        }
    }

    /// Nodes that move with a body's node.
    fn nodes_of_body(&self, node: usize) -> Vec<usize> {
        self.parts.get(&node).cloned().unwrap_or_default()
    }

    /// Mass properties of a body's shapes, in its rigid frame.
    fn shape_mass(&mut self, node: usize) -> MassProperties {
        let base = rigid_frame(self.model, node);
        let mut total = NO_MASS;
        for part in self.nodes_of_body(node) {
            let Some((solid, _)) = self.solid(part, false) else { continue };
            let (volume, moments) = solid.volume();
            let extension = rigid_frame(self.model, part);
            let turn = DMat3::from_quat(base.rotation.inverse() * extension.rotation);
            let mass = DENSITY * volume;
            let inertia = turn * DMat3::from_diagonal(mass * moments) * turn.transpose();
            total = total.combine(&MassProperties { mass, center: base.inverse_point(extension.position), inertia });
        }
        total
    }

    /// The collision shape of a node at its scale, and what the conversion changes.
    fn solid(&self, node: usize, reported: bool) -> Option<(Solid, Option<String>)> {
        let collider = self.extension(node)?.get("collider")?;
        // Drafts differ: collider.shape, then collider.geometry.shape.
        let index = collider["geometry"]["shape"].as_u64().or(collider["shape"].as_u64())?;
        let shape = self.json["extensions"][SHAPES]["shapes"].get(usize::try_from(index).ok()?)?;
        let kind = shape["type"].as_str()?;
        let extension = &shape[kind];
        let axes = DMat3::from_mat4(self.model.nodes[node].world);
        let scale = DVec3::new(axes.x_axis.length(), axes.y_axis.length(), axes.z_axis.length());
        let round = 0.5 * (scale.x + scale.z);
        let number = |key: &str, default: f64| extension[key].as_f64().unwrap_or(default);
        let mut lost = None;
        let mut radius = |default: f64| {
            let (top, bottom) = (number("radiusTop", default), number("radiusBottom", default));
            if reported && top != bottom {
                lost = Some(format!(
                    "its {kind} is {bottom} m wide at one end and {top} m at the other: both become the mean"
                ));
            }
            0.5 * (top + bottom) * round
        };
        let solid = match kind {
            "sphere" => Solid::Sphere { radius: number("radius", 0.5) * scale.max_element() },
            "box" => Solid::Box { size: vector(&extension["size"]).unwrap_or(DVec3::ONE) * scale },
            "capsule" => Solid::Capsule { height: number("height", 0.5) * scale.y, radius: radius(0.25) },
            "cylinder" => Solid::Cylinder { height: number("height", 0.5) * scale.y, radius: radius(0.25) },
            "plane" => {
                if reported && (extension.get("sizeX").is_some() || extension.get("sizeZ").is_some()) {
                    lost = Some("its plane is finite: it becomes infinite".to_owned());
                }
                Solid::Plane
            }
            _ => return None,
        };
        Some((solid, lost))
    }

    fn colliders(&mut self) {
        let mut filtered: Vec<(usize, Value)> = Vec::new();
        for node in 0..self.model.nodes.len() {
            let Some(extension) = self.extension(node).cloned() else { continue };
            if extension.get("trigger").is_some() {
                self.remark(
                    node,
                    "its trigger is skipped: constraints here wait for impacts or a breath (trigger = …)",
                );
            }
            let Some(collider) = extension.get("collider") else { continue };
            let Some(shape) = self.shape_of(node, collider) else { continue };
            let material =
                collider["physicsMaterial"].as_u64().map_or(String::new(), |i| format!("material = \"khr-{i}\"\n"));
            let name = quoted(&self.names.of(node));
            let _ = write!(self.out.text, "[[collider]]\nnode = {name}\n{material}shape = {shape}\n\n");
            if let Some(i) = collider["collisionFilter"].as_u64()
                && let Some(filter) = self.list("collisionFilters").get(i as usize)
            {
                filtered.push((node, filter.clone()));
            }
        }
        let mut joints_open = Vec::new();
        if filtered.len() > MAX_FILTERED {
            let count = filtered.len();
            self.out
                .remarks
                .push(format!("{count} colliders have filters: these are skipped; see [collision] exclude"));
            filtered.clear();
        }
        for (i, (a, one)) in filtered.iter().enumerate() {
            for (b, other) in &filtered[i + 1..] {
                if !(collides(one, other) && collides(other, one)) {
                    joints_open.push(format!(
                        "    [{}, {}],\n",
                        quoted(&self.names.of(*a)),
                        quoted(&self.names.of(*b))
                    ));
                }
            }
        }
        if joints_open.len() > MAX_PAIRS {
            self.out.remarks.push(format!("{} pairs excluded by its filters are skipped", joints_open.len()));
        } else if !joints_open.is_empty() {
            let _ = write!(
                self.out.text,
                "[collision]\n# The model's collisionFilters.\nexclude = [\n{}]\n\n",
                joints_open.concat()
            );
        }
    }

    /// The shape of a collider as TOML.
    fn shape_of(&mut self, node: usize, collider: &Value) -> Option<String> {
        if let Some((solid, lost)) = self.solid(node, true) {
            if let Some(lost) = lost {
                self.remark(node, lost);
            }
            let still = self.moving_ancestor(node).is_none();
            if matches!(solid, Solid::Plane) && !still {
                self.remark(node, "its plane moves: skipped, use a box");
                return None;
            }
            return Some(solid.toml());
        }
        let geometry = &collider["geometry"];
        // A mesh: of this node, of another one, or by its number.
        let of = geometry["node"].as_u64().map(|n| n as usize).filter(|&n| n < self.model.nodes.len());
        let here = of.unwrap_or(node);
        let by_number = geometry["mesh"].as_u64().map(|m| m as usize);
        if here != node || by_number.is_some_and(|mesh| self.model.nodes[node].mesh != Some(mesh)) {
            self.remark(node, "collides as the mesh of another node: skipped; give it that mesh, or a shape");
            return None;
        }
        if self.model.nodes[node].mesh.is_none() {
            self.remark(node, "has an unknown collision shape: skipped");
            return None;
        }
        let Some(fit) = fit(self.model, node) else {
            self.remark(node, "no shape can be fitted to its mesh: it has no collider");
            return None;
        };
        if geometry["convexHull"].as_bool() != Some(true) {
            self.remark(node, "collides as its triangles: its convex hull is used");
        }
        Some(format!("{{ fit = \"{fit}\" }}"))
    }

    fn joints(&mut self) {
        for node in 0..self.model.nodes.len() {
            let Some(joint) = self.extension(node).and_then(|extension| extension.get("joint")).cloned() else {
                continue;
            };
            khr_joint::convert_joint(self, node, &joint);
        }
    }
}

/// Combines two coefficients by the rule with higher precedence.
fn combined(x: f64, y: f64, rules: [&str; 2]) -> f64 {
    let either = |rule: &str| rules.contains(&rule);
    if either("average") {
        0.5 * (x + y)
    } else if either("minimum") {
        x.min(y)
    } else if either("maximum") {
        x.max(y)
    } else {
        x * y
    }
}

/// Does a collider with filter `a` collide with one with filter `b`?
fn collides(a: &Value, b: &Value) -> bool {
    let words = |value: &Value| -> Option<Vec<String>> {
        Some(value.as_array()?.iter().filter_map(|word| word.as_str().map(str::to_owned)).collect())
    };
    let systems = words(&b["collisionSystems"]).unwrap_or_default();
    let named = |list: &Value| words(list).map(|list| systems.iter().any(|system| list.contains(system)));
    named(&a["collideWithSystems"]).unwrap_or(true) && !named(&a["notCollideWithSystems"]).unwrap_or(false)
}

/// World rotation of a node, without scale.
pub(super) fn rotation_of(model: &Model, node: usize) -> DQuat {
    let axes = DMat3::from_mat4(model.nodes[node].world);
    let unit = |v: DVec3| v.normalize_or(DVec3::X);
    let (x, y) = (unit(axes.x_axis), unit(axes.y_axis));
    // A mirrored frame has no rotation: its third axis is reversed.
    DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y))).normalize()
}

/// Pose of a node without scale.
fn rigid_frame(model: &Model, node: usize) -> Pose {
    Pose { rotation: rotation_of(model, node), position: model.nodes[node].world.w_axis.truncate() }
}
