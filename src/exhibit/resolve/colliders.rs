//! Resolves colliders and excluded pairs.

use super::super::diagnostic::{Diagnostic, quoted, similar_names};
use super::super::fit;
use super::super::sidecar::{self, ConstrainedPairs, Fit};
use super::super::source::join;
use super::super::{Body, Wire, codes};
use super::context::Context;
use super::joints::pairs::{BodyPair, pairs as joined_pairs};
use soffio_math::{DMat3, DVec3, PI, Pose, rotation};
use soffio_multibody::articulation::{Constraint, Limit, LimitKind};
use soffio_multibody::collision::{Collider, Excluded, Exclusion, Shape};

impl Context<'_> {
    /// Collision shapes of nodes and wires.
    pub(super) fn colliders(&mut self, wires: &[Wire]) -> Vec<Collider> {
        let sidecar = self.sidecar;
        let mut out = Vec::new();
        for (i, given) in sidecar.collider.iter().enumerate() {
            let at = format!("/collider/{i}");
            let Some(node) = self.node(&given.node, &format!("{at}/node"), "a collider") else { continue };
            let body = self.owner[node];
            let of_body = body.and_then(|b| {
                let declared = sidecar.body.iter().find(|d| self.nodes_named(&d.node).contains(&self.body_nodes[b]))?;
                declared.material.clone()
            });
            let name = given.material.clone().or(of_body).unwrap_or_else(|| "steel".to_owned());
            let material = self.material(&name, &format!("{at}/material"));
            let mut shapes = self.shapes(given, node, &at);
            if let Some(ring) = given.ring {
                let Some(axis) = self.unit(ring.axis.into(), &format!("{at}/ring/axis")) else { continue };
                shapes = ringed(&shapes, axis, ring.count);
            }
            let of = format!("collider {}", given.node);
            let moves_with = self.body_name(body).to_owned();
            self.record_origin(&of, "body", moves_with, "/-", "glTF node tree");
            self.record_origin(&of, "material", name, &format!("{at}/material"), "the body's");
            let shown = shapes.iter().map(Shape::describe).collect::<Vec<_>>().join("; ");
            self.record_origin(&of, "shape", shown, &format!("{at}/shape"), "");
            let Some(material) = material else { continue };
            out.extend(shapes.into_iter().map(|shape| Collider { body, shape, material, node: given.node.clone() }));
        }
        for wire in wires {
            let collides = sidecar.wire.iter().any(|given| given.name == wire.name && given.collide);
            if collides {
                // The simplified axis stays inside the wire, so that impacts agree with the picture.
                let line = fit::simplify(&wire.points, wire.radius);
                out.extend(line.windows(2).map(|segment| Collider {
                    body: wire.body,
                    shape: Shape::capsule(segment[0], segment[1], wire.radius),
                    material: wire.material,
                    node: wire.name.clone(),
                }));
            }
        }
        out
    }

    fn shapes(&mut self, given: &sidecar::Collider, node: usize, at: &str) -> Vec<Shape> {
        let place = format!("{at}/shape");
        let frame = self.pose_of(self.owner[node]).matrix().inverse() * self.model.nodes[node].world;
        let axes = DMat3::from_mat4(frame);
        // Shapes of stated size keep it: the node gives position and direction, not scale.
        let axes = [axes.x_axis, axes.y_axis, axes.z_axis].map(DVec3::normalize_or_zero);
        let origin = frame.w_axis.truncate();
        match given.shape {
            sidecar::Shape::Sphere(ball) => {
                let radius = self.positive(ball.radius.0, &format!("{place}/sphere/radius"));
                vec![Shape::sphere(origin, radius)]
            }
            sidecar::Shape::Capsule(capsule) => {
                let radius = self.positive(capsule.radius.0, &format!("{place}/capsule/radius"));
                let half = 0.5 * self.not_negative(capsule.height.0, &format!("{place}/capsule/height"));
                vec![Shape::capsule(origin - axes[1] * half, origin + axes[1] * half, radius)]
            }
            sidecar::Shape::Box(shape) => {
                let size = [0, 1, 2].map(|i| self.positive(shape.size[i].0, &format!("{place}/box/size/{i}")));
                vec![fit::rounded_box(origin, axes, 0.5 * DVec3::from(size))]
            }
            sidecar::Shape::Cylinder(shape) => {
                let height = self.positive(shape.height.0, &format!("{place}/cylinder/height"));
                let radius = self.positive(shape.radius.0, &format!("{place}/cylinder/radius"));
                vec![fit::cylinder(origin, axes[1], height, radius)]
            }
            sidecar::Shape::Plane(_) => {
                if self.owner[node].is_some() {
                    let message =
                        format!("\"{}\" moves, but a plane is infinite and must be fixed", self.model.nodes[node].name);
                    let help = "put the plane on a node that belongs to no body, or use a box";
                    self.report(&place, Diagnostic::new(codes::ENDLESS, message).help(help));
                }
                vec![Shape::plane(origin, axes[1])]
            }
            sidecar::Shape::Fit(fit) => self.fitted(fit, node, &place),
        }
    }

    fn fitted(&mut self, fit: Fit, node: usize, at: &str) -> Vec<Shape> {
        let Some(mesh) = self.mesh_of(node, at, "a fitted collider") else { return Vec::new() };
        let shapes = mesh.extents().and_then(|extents| match fit {
            Fit::Sphere => Some(vec![fit::sphere(&mesh, &extents)]),
            Fit::Capsule => Some(vec![fit::capsule(&extents)]),
            Fit::Box => {
                let axes = [extents.axes.x_axis, extents.axes.y_axis, extents.axes.z_axis];
                Some(vec![fit::rounded_box(extents.center, axes, extents.half)])
            }
            Fit::Plate => fit::plate(&mesh, &extents),
            Fit::Convex => fit::convex(&mesh).map(|shape| vec![shape]),
        });
        shapes.unwrap_or_else(|| {
            let message = format!("no {fit:?} can be fitted to \"{}\"", self.model.nodes[node].name);
            let help = "a plate needs a flat sheet, a hull a body with volume; try fit = \"box\"";
            self.report(at, Diagnostic::new(codes::NOT_FLAT, message).help(help));
            Vec::new()
        })
    }

    /// Pairs that never collide, sorted.
    pub(super) fn excluded_pairs(
        &mut self,
        bodies: &[Body],
        constraints: &[Constraint],
        limits: &[Limit],
    ) -> Vec<Exclusion> {
        let sidecar = self.sidecar;
        let mut pairs = self.pairs_of_other_kinds(bodies);
        if sidecar.collision.constrained_pairs == ConstrainedPairs::Exclude {
            let joined =
                constraints.iter().flat_map(|c| joined_pairs(&c.kind).into_iter().map(|pair| (c.group(), pair)));
            // Gears with backlash.
            let meshed = limits.iter().filter_map(|limit| match limit.kind {
                LimitKind::Play { terms: [a, b], .. } => {
                    Some((limit.name.as_str(), (a.measure.bodies().0, b.measure.bodies().0)))
                }
                _ => None,
            });
            for (name, (a, b)) in joined.chain(meshed) {
                let known = pairs.iter().any(|e| e.bodies == (a.min(b), a.max(b)));
                if !known {
                    let reason = format!("joined by {name}");
                    self.exclude(&mut pairs, (a, b), Excluded::Joined, (&reason, "/-"));
                }
            }
        }
        for (i, [first, second]) in sidecar.collision.exclude.iter().enumerate() {
            let at = format!("/collision/exclude/{i}");
            let left = self.group(first, &format!("{at}/0"));
            let right = self.group(second, &format!("{at}/1"));
            for &a in &left {
                for &b in &right {
                    self.exclude(&mut pairs, (a, b), Excluded::ByCurator, ("", &at));
                }
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// Pairs of bodies that different kinds of motion move.
    fn pairs_of_other_kinds(&self, bodies: &[Body]) -> Vec<Exclusion> {
        let free: Vec<usize> = (0..bodies.len()).filter(|&body| !self.is_kinematic(body)).collect();
        let pairs = free.iter().flat_map(|&a| free.iter().map(move |&b| (a, b)));
        let differ = |(a, b): &(usize, usize)| a < b && bodies[*a].moved_by != bodies[*b].moved_by;
        let exclusion = |(a, b)| Exclusion { bodies: (Some(a), Some(b)), why: Excluded::OtherKind };
        pairs.filter(differ).map(exclusion).collect()
    }

    fn exclude(&mut self, pairs: &mut Vec<Exclusion>, (a, b): BodyPair, why: Excluded, (reason, at): (&str, &str)) {
        if a != b {
            let shown = format!("{} – {}", self.body_name(a), self.body_name(b));
            self.record_origin("collision", "excluded", shown, at, reason);
            pairs.push(Exclusion { bodies: (a.min(b), a.max(b)), why });
        }
    }

    /// Bodies of a node's name or of `group:NAME`.
    fn group(&mut self, name: &str, at: &str) -> Vec<Option<usize>> {
        let groups = &self.sidecar.collision.groups;
        let Some(group) = name.strip_prefix("group:") else {
            return self.node(name, at, "a pair that never collides").map(|n| self.owner[n]).into_iter().collect();
        };
        let Some(members) = groups.get(group) else {
            let likely = similar_names(group, groups.keys().map(String::as_str));
            let problem = Diagnostic::new(codes::NOT_FOUND, format!("no group named \"{group}\""));
            let help = format!("groups are defined in [collision] groups; similar names: {}", quoted(&likely));
            self.report(at, problem.help(help));
            return Vec::new();
        };
        let place = join("/collision/groups", group);
        let nodes = members.iter().enumerate().filter_map(|(i, n)| self.node(n, &format!("{place}/{i}"), "a group"));
        let nodes: Vec<usize> = nodes.collect();
        nodes.into_iter().map(|n| self.owner[n]).collect()
    }
}

/// Copies of shapes in the body's frame, evenly around an axis through its origin.
fn ringed(shapes: &[Shape], axis: DVec3, count: usize) -> Vec<Shape> {
    let turned = |k: usize| {
        let turn = rotation(axis * (2.0 * PI * k as f64 / count as f64));
        shapes.iter().map(move |shape| Shape {
            place: Pose { rotation: (turn * shape.place.rotation).normalize(), position: turn * shape.place.position },
            ..shape.clone()
        })
    };
    (0..count).flat_map(turned).collect()
}
