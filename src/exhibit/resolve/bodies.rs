//! Resolves bodies: their nodes, mass properties and start states.

use super::super::diagnostic::Diagnostic;
use super::super::sidecar::{self, Motion};
use super::super::{Body, Wire, codes};
use super::context::Context;
use super::kinds::own_motion;
use super::nail_paths::path_node;
use super::nodes::rigid;
use soffio_geometry::Moments;
use soffio_geometry::bodies::MassProperties;
use soffio_geometry::mass::principal_axes;
use soffio_math::{DMat3, DQuat, DVec3, Pose};

/// Most moving bodies of an exhibit.
const MAX_BODIES: usize = 1024;

/// Origin of a body.
pub(super) enum Declared {
    /// The `[[body]]` of this number.
    Entry(usize),
    /// The path of a moving nail.
    Path,
}

/// Mass properties of kinematic bodies, whose motion does not depend on them.
const NOMINAL: MassProperties = MassProperties { mass: 1.0, center: DVec3::ZERO, inertia: DMat3::IDENTITY };

/// A point for messages, to the micrometre.
pub(super) fn meters(p: DVec3) -> String {
    // Adding zero turns −0 into 0.
    let [x, y, z] = p.to_array().map(|v| (v * 1e6).round() / 1e6 + 0.0);
    format!("[{x}, {y}, {z}] m")
}

impl Context<'_> {
    /// Finds the moving bodies, and the body that each node belongs to.
    pub(super) fn declare_bodies(&mut self) -> Vec<Declared> {
        let sidecar = self.sidecar;
        let mut declared = Vec::new();
        let mut seen: Vec<usize> = Vec::new();
        let mut fixed: Vec<usize> = Vec::new();
        for (entry, body) in sidecar.body.iter().enumerate() {
            let at = format!("/body/{entry}/node");
            let Some(node) = self.node(&body.node, &at, "a body") else { continue };
            if seen.contains(&node) {
                let message = format!("node \"{}\" is a body already", body.node);
                self.report(&at, Diagnostic::new(codes::DUPLICATE_BODY, message).help("join the two [[body]] tables"));
                continue;
            }
            seen.push(node);
            if body.motion != Motion::Kinematic {
                for (key, given) in [("path", body.path.is_some()), ("animation", body.animation.is_some())] {
                    if given {
                        let message = format!("body \"{}\" has a {key} but is not kinematic", body.node);
                        let problem = Diagnostic::new(codes::WRONG_SHAPE, message);
                        self.report(&format!("/body/{entry}/{key}"), problem.help("add motion = \"kinematic\""));
                    }
                }
            }
            if body.motion == Motion::Static {
                fixed.push(node);
                continue;
            }
            let pose = rigid(&self.model.nodes[node].world).unwrap_or_else(|| {
                let message = format!("node \"{}\" is scaled unevenly, sheared or mirrored", body.node);
                let help = "apply the scale in the modelling program (Blender: Ctrl-A, Scale) and export again";
                self.report(
                    &at,
                    Diagnostic::new(codes::SCALED_BODY, message).label("a rigid body has one scale").help(help),
                );
                Pose::IDENTITY
            });
            self.body_nodes.push(node);
            self.poses.push(pose);
            let start = if body.motion == Motion::Kinematic {
                self.drive(body, node, &format!("/body/{entry}"))
            } else {
                self.start(body, pose, &format!("/body/{entry}/initial"))
            };
            self.starts.push(start);
            declared.push(Declared::Entry(entry));
        }
        for (name, path) in sidecar.constraint.paths() {
            // The loader has added a node for each path.
            let Some(&node) = self.nodes_named(&path_node(name)).first() else { continue };
            self.body_nodes.push(node);
            let place = format!("{}/to/path", self.place(name));
            let start = self.drive_along(path, Pose::IDENTITY, &place);
            self.poses.push(start);
            self.starts.push(start);
            seen.push(node);
            declared.push(Declared::Path);
        }
        self.declare_sheets();
        seen.extend_from_slice(&self.body_nodes[declared.len()..]);
        if self.body_nodes.len() > MAX_BODIES {
            let message = format!("{} moving bodies; the limit is {MAX_BODIES}", self.body_nodes.len());
            let problem = Diagnostic::new(codes::MODEL_LIMIT, message);
            self.report("/body", problem.help("join bodies that do not move against each other"));
        }
        for node in 0..self.model.nodes.len() {
            let ancestors = std::iter::successors(Some(node), |&n| self.model.nodes[n].parent);
            let nearest = ancestors.into_iter().find(|n| seen.contains(n)).filter(|n| !fixed.contains(n));
            self.owner[node] = nearest.and_then(|n| self.body_nodes.iter().position(|&b| b == n));
        }
        declared
    }

    /// Mass, centre, inertia and start of each declared body.
    pub(super) fn resolve_masses(&mut self, declared: &[Declared], wires: &[Wire]) -> Vec<Body> {
        let sidecar = self.sidecar;
        let mut bodies = Vec::new();
        for (index, entry) in declared.iter().enumerate() {
            let Declared::Entry(entry) = *entry else {
                bodies.push(self.path_body(index));
                continue;
            };
            let given = &sidecar.body[entry];
            let at = format!("/body/{entry}");
            let of = format!("body {}", given.node);
            let named = given.material.as_deref();
            let material = self.material(named.unwrap_or("steel"), &format!("{at}/material"));
            let weightless = given.motion == Motion::Kinematic && named.is_none() && given.mass.is_none();
            if named.is_none() && given.mass.is_none() && !weightless {
                let message = format!("body \"{}\" has neither material nor mass", given.node);
                let help = "add material = \"steel\" (mass from the mesh), or mass = \"85 g\"";
                self.report(&at, Diagnostic::new(codes::NO_MASS, message).help(help));
            }
            self.record_origin(&of, "material", named.unwrap_or("steel").into(), &format!("{at}/material"), "default");
            let properties =
                if weightless { NOMINAL } else { self.body_mass_properties(given, index, material, wires, &at, &of) };
            let pose = self.starts[index];
            let source = if self.is_kinematic(index) { "its motion at 0 s" } else { "glTF node" };
            self.record_origin(&of, "position", meters(pose.position), &format!("{at}/initial/position"), source);
            let rotation = format!("{} (x y z w)", pose.rotation);
            self.record_origin(&of, "rotation", rotation, &format!("{at}/initial/rotation"), source);
            let velocity = given.initial.velocity.map_or(DVec3::ZERO, |v| DVec3::from(v.map(|x| x.0)));
            let angular_velocity = given.initial.angular_velocity.map_or(DVec3::ZERO, |v| DVec3::from(v.map(|x| x.0)));
            let linear_damping =
                self.not_negative(given.linear_damping.map_or(0.0, |r| r.0), &format!("{at}/linear_damping"));
            let angular_damping =
                self.not_negative(given.angular_damping.map_or(0.0, |r| r.0), &format!("{at}/angular_damping"));
            for (key, value) in [
                ("initial.velocity", format!("{velocity} m/s")),
                ("initial.angular_velocity", format!("{angular_velocity} rad/s")),
                ("linear_damping", format!("{linear_damping} /s")),
                ("angular_damping", format!("{angular_damping} /s")),
            ] {
                self.record_origin(&of, key, value, &format!("{at}/{}", key.replace('.', "/")), "default");
            }
            bodies.push(Body {
                name: self.model.nodes[self.body_nodes[index]].name.clone(),
                node: self.body_nodes[index],
                properties,
                pose,
                velocity,
                angular_velocity,
                linear_damping,
                angular_damping,
                material: material.unwrap_or(0),
                moved_by: given.moved_by.map(own_motion),
            });
        }
        bodies.extend(self.sheet_bodies());
        bodies
    }

    /// The body of a path: a moving point.
    fn path_body(&mut self, index: usize) -> Body {
        let material = self.material("steel", "/-").unwrap_or(0);
        Body {
            name: self.model.nodes[self.body_nodes[index]].name.clone(),
            node: self.body_nodes[index],
            properties: NOMINAL,
            pose: self.starts[index],
            velocity: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
            linear_damping: 0.0,
            angular_damping: 0.0,
            material,
            moved_by: None,
        }
    }

    /// Reports a negative number, and returns 0 then.
    pub(super) fn not_negative(&mut self, value: f64, at: &str) -> f64 {
        if value < 0.0 {
            let problem = Diagnostic::new(codes::RANGE, format!("{value} is below zero"));
            self.report(at, problem.help("write 0 or a number above it"));
        }
        value.max(0.0)
    }

    /// Reports a number that is not above zero.
    pub(super) fn positive(&mut self, value: f64, at: &str) -> f64 {
        if value > 0.0 {
            return value;
        }
        let problem = Diagnostic::new(codes::RANGE, format!("{value} is not above zero"));
        self.report(at, problem.help("write a number above zero"));
        f64::MIN_POSITIVE
    }

    fn body_mass_properties(
        &mut self,
        given: &sidecar::Body,
        body: usize,
        material: Option<usize>,
        wires: &[Wire],
        at: &str,
        of: &str,
    ) -> MassProperties {
        let problems_before = self.problems.len();
        let moments = self.geometry(given, body, material, at, of, wires);
        let geometry_good = self.problems.len() == problems_before;
        let mut properties =
            MassProperties { mass: moments.mass, center: moments.center(), inertia: moments.inertia() };
        let derived = "derived: geometry × density";
        if let Some(mass) = given.mass {
            let mass = self.positive(mass.0, &format!("{at}/mass"));
            if moments.mass > 0.0 {
                properties.inertia *= mass / moments.mass;
            }
            properties.mass = mass;
        }
        if let Some(center) = given.center_of_mass {
            let node = self.body_nodes[body];
            properties.center = self.anchor(node, DVec3::from(center.map(|x| x.0))).point;
        }
        if let Some(inertia) = &given.inertia {
            let q = inertia.orientation.map_or(DQuat::IDENTITY, DQuat::from_array);
            if q.length() == 0.0 {
                let problem = Diagnostic::new(codes::NO_AXIS, "the quaternion has no length");
                self.report(&format!("{at}/inertia/orientation"), problem.help("leave it out, or write [0, 0, 0, 1]"));
            } else {
                let axes = DMat3::from_quat(q.normalize());
                let diagonal = DVec3::from(inertia.diagonal.map(|x| x.0));
                properties.inertia = axes * DMat3::from_diagonal(diagonal) * axes.transpose();
            }
        }
        self.record_origin(of, "mass", format!("{:.6} kg", properties.mass), &format!("{at}/mass"), derived);
        let center = meters(properties.center);
        self.record_origin(of, "center_of_mass", center, &format!("{at}/center_of_mass"), derived);
        let (moments, _) = principal_axes(properties.inertia);
        self.record_origin(
            of,
            "inertia",
            format!("{:.4e}, {:.4e}, {:.4e} kg m² (principal)", moments.x, moments.y, moments.z),
            &format!("{at}/inertia"),
            derived,
        );
        // A mesh without a mass was reported already; the missing mass is no second problem.
        if geometry_good {
            self.check_mass(&properties, &given.node, at);
        }
        properties
    }

    /// Checks that such a body is possible: each moment of inertia is at most the sum of the other two, since the three
    /// are sums of pairs of positive integrals.
    fn check_mass(&mut self, properties: &MassProperties, name: &str, at: &str) {
        /// Tolerance for an inertia typed with four digits (a flat plate has equality).
        const TYPED: f64 = 1e-3;
        if properties.mass <= 0.0 || !properties.mass.is_finite() {
            let message = format!("body \"{name}\" has no mass");
            let help = "give it a closed mesh, a wire or a sheet with a thickness, or write mass = \"85 g\"";
            self.report(at, Diagnostic::new(codes::NO_MASS, message).help(help));
            return;
        }
        let (i, _) = principal_axes(properties.inertia);
        if i.x <= 0.0 {
            let message = format!("body \"{name}\" has no moment of inertia about some axis");
            self.report(
                at,
                Diagnostic::new(codes::INERTIA, message)
                    .help("write inertia = { diagonal = [ … ] }, or give it a mesh"),
            );
        } else if i.z > (i.x + i.y) * (1.0 + TYPED) {
            let message = format!("the moments of inertia of \"{name}\" are impossible");
            let label = format!("{} > {} + {}", i.z, i.x, i.y);
            let help =
                "no moment is larger than the other two together; leave the key out to compute them from the mesh";
            self.report(&format!("{at}/inertia"), Diagnostic::new(codes::INERTIA, message).label(label).help(help));
        }
    }

    /// Moments of meshes, sheets and wires with their densities.
    fn geometry(
        &mut self,
        given: &sidecar::Body,
        body: usize,
        material: Option<usize>,
        at: &str,
        of: &str,
        wires: &[Wire],
    ) -> Moments {
        let root = self.body_nodes[body];
        let mut parts = vec![(root, material, given.thickness.map(|t| t.0), format!("{at}/node"))];
        for (i, part) in given.part.iter().enumerate() {
            let place = format!("{at}/part/{i}");
            let Some(node) = self.node_below(Some(root), &part.node, &format!("{place}/node"), "a part") else {
                continue;
            };
            if self.owner[node] != Some(body) || node == root {
                let message = format!("node \"{}\" is not below the body \"{}\"", part.node, given.node);
                let problem = Diagnostic::new(codes::NOT_DESCENDANT, message);
                self.report(&format!("{place}/node"), problem.help("move it below the body in the model's tree"));
                continue;
            }
            let material = self.material(&part.material, &format!("{place}/material"));
            parts.push((node, material, part.thickness.map(|t| t.0), format!("{place}/node")));
        }
        let roots: Vec<usize> = parts.iter().map(|part| part.0).collect();
        let mut total = Moments::default();
        for (node, material, thickness, place) in parts {
            let density = material.map_or(1.0, |m| self.materials[m].density);
            for piece in self.subtree(node, &roots) {
                let moments = self.piece(piece, density, thickness, given.mass.is_some(), &place);
                if moments.mass > 0.0 {
                    let source = format!("derived: mesh × {density} kg/m³");
                    let name = self.model.nodes[piece].name.clone();
                    self.record_origin(
                        of,
                        &format!("mass of {name}"),
                        format!("{:.6} kg", moments.mass),
                        "/-",
                        &source,
                    );
                }
                total.add(&moments);
            }
        }
        for wire in wires.iter().filter(|wire| wire.body == Some(body)) {
            let density = self.materials[wire.material].density;
            let mut moments = Moments::default();
            moments.add_wire(&wire.points, wire.radius, density);
            let source = format!("derived: length × πr² × {density} kg/m³");
            self.record_origin(
                of,
                &format!("mass of wire {}", wire.name),
                format!("{:.6} kg", moments.mass),
                "/-",
                &source,
            );
            total.add(&moments);
        }
        total
    }

    /// Moments of one node's mesh, as a solid or as a sheet.
    fn piece(&mut self, node: usize, density: f64, thickness: Option<f64>, mass_given: bool, at: &str) -> Moments {
        let Some(mesh) = self.node_mesh(node) else { return Moments::default() };
        let name = self.model.nodes[node].name.clone();
        let open = mesh.open_edges();
        if open == 0 {
            let moments = mesh.solid_moments(density);
            if moments.mass <= 0.0 {
                let message = format!("the faces of mesh \"{name}\" point inwards");
                let help = "turn its normals outwards (Blender: Shift-N) and export again";
                self.report(at, Diagnostic::new(codes::INSIDE_OUT, message).label("its volume is negative").help(help));
            }
            return moments;
        }
        if let Some(thickness) = thickness {
            let thickness = self.positive(thickness, at);
            return mesh.sheet_moments(thickness, density);
        }
        if mass_given {
            // The mass is given; the surface determines its distribution. A nominal millimetre gives it some depth.
            const NOMINAL: f64 = 1e-3;
            return mesh.sheet_moments(NOMINAL, density);
        }
        let message = format!("mesh \"{name}\" is not closed: {open} edges have no neighbour");
        let help = "close it (Blender: Select > All by Trait > Non Manifold), or write thickness = \"0.5 mm\" for sheet metal, or mass = \"85 g\"";
        self.report(at, Diagnostic::new(codes::NOT_CLOSED, message).label("density needs a volume").help(help));
        Moments::default()
    }
}
