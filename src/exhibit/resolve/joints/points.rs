//! Resolves the basic constraints: points, nails, orientations, planes.

use super::super::super::codes;
use super::super::super::diagnostic::Diagnostic;
use super::super::super::sidecar::{self, Attachment, BodyAxis, Point, Target};
use super::super::context::Context;
use super::super::nail_paths::path_node;
use super::{Header, Joints};
use soffio_math::DVec3;
use soffio_math::Function;
use soffio_multibody::articulation::{Anchor, Axis, ConstraintKind};

impl Context<'_> {
    pub(super) fn point_to_point(&mut self, given: &sidecar::PointToPoint, at: &str, out: &mut Joints) {
        let header = self.header(&given.name, &given.timing, at, out);
        let a = self.attachment(&given.a, &format!("{at}/a"), &given.name);
        let b = self.attachment(&given.b, &format!("{at}/b"), &given.name);
        if let (Some(a), Some(b)) = (a, b) {
            let kind = ConstraintKind::PointToPoint { a, b };
            self.single(out, &header, kind, given.friction, given.limit.as_ref(), &given.a.node);
        }
    }

    pub(super) fn nail(&mut self, given: &sidecar::Nail, at: &str, out: &mut Joints) {
        let header = self.header(&given.name, &given.timing, at, out);
        let a = self.point_of(&given.body, given.at.as_ref(), at, &given.name);
        let b = self.target(&given.to, &format!("{at}/to"), &given.name);
        if let (Some(a), Some(b)) = (a, b) {
            let kind = ConstraintKind::PointToPoint { a, b };
            self.single(out, &header, kind, given.friction, given.limit.as_ref(), &given.body);
        }
    }

    pub(super) fn orientation(&mut self, given: &sidecar::Orientation, at: &str, out: &mut Joints) {
        let header = self.header(&given.name, &given.timing, at, out);
        let places = (format!("{at}/body"), format!("{at}/body_axis"));
        let a = self.body_axis(&given.body, given.body_axis, &places.0, &places.1, &given.name);
        let b = self.second_axis(given.world_axis, given.other.as_ref(), at, &given.name);
        let angle = given.angle.as_ref().map_or(Function::default(), |f| self.function(f, &format!("{at}/angle")));
        if let (Some(a), Some(b)) = (a, b) {
            let kind = ConstraintKind::Orientation { a, b, angle };
            self.single(out, &header, kind, given.friction, given.limit.as_ref(), &given.body);
        }
    }

    pub(super) fn point_on_plane(&mut self, given: &sidecar::PointOnPlane, at: &str, out: &mut Joints) {
        let header = self.header(&given.name, &given.timing, at, out);
        let used_for = format!("constraint \"{}\"", given.name);
        let point = self.point_of(&given.body, given.at.as_ref(), at, &given.name);
        let place = format!("{at}/plane");
        let plane = match &given.plane.node {
            Some(name) => {
                let Some(node) = self.node(name, &format!("{place}/node"), &used_for) else { return };
                let anchor = self.point(node, given.plane.at.as_ref(), &format!("{place}/at"), &used_for);
                anchor.zip(self.axis(node, given.plane.normal, &format!("{place}/normal")))
            }
            None => {
                let anchor = match &given.plane.at {
                    None => Some(Anchor { body: None, point: DVec3::ZERO }),
                    Some(Point::Position(p)) => Some(Anchor { body: None, point: DVec3::from(p.map(|x| x.0)) }),
                    Some(Point::Node(name)) => {
                        let node = self.node(name, &format!("{place}/at"), &used_for);
                        node.map(|node| self.anchor(node, DVec3::ZERO))
                    }
                };
                let normal = self.unit(DVec3::from(given.plane.normal), &format!("{place}/normal"));
                anchor.zip(normal.map(|direction| Axis { body: None, direction }))
            }
        };
        let (Some(point), Some((plane, normal))) = (point, plane) else { return };
        // A plane through a marker node with a normal in world axes moves with the body of the marker.
        let world_normal = self.pose_of(normal.body).vector(normal.direction);
        let normal = self.pose_of(plane.body).inverse_vector(world_normal);
        let height = world_normal.dot(self.reference_position(&point) - self.reference_position(&plane));
        let offset = match &given.plane.offset {
            Some(given) => self.function(given, &format!("{place}/offset")),
            None => height.into(),
        };
        let kind = ConstraintKind::PointOnPlane { point, plane, normal, offset };
        self.single(out, &header, kind, None, None, &given.body);
    }

    /// Adds a table that is one constraint.
    fn single(
        &mut self,
        out: &mut Joints,
        header: &Header,
        kind: ConstraintKind,
        friction: Option<sidecar::Friction>,
        tilt: Option<&sidecar::Tilt>,
        first: &str,
    ) {
        let Some(&(a, b)) = super::pairs::pairs(&kind).first() else { return };
        if !self.joinable(a, b, header.name, header.at) {
            return;
        }
        let friction = self.friction(friction, header.at);
        let before = out.constraints.len();
        self.push(out, header, "", kind, friction);
        self.record_header_origins(header, "", out, before);
        if let Some(tilt) = tilt {
            let limit = self.tilt_limit(tilt, first, b, &format!("{}/limit", header.at), header.name);
            out.limits.extend(limit);
        }
    }

    /// A point of the body named `body`, from the table's key `at`.
    pub(super) fn point_of(&mut self, body: &str, point: Option<&Point>, at: &str, name: &str) -> Option<Anchor> {
        let used_for = format!("constraint \"{name}\"");
        let node = self.node(body, &format!("{at}/body"), &used_for)?;
        self.point(node, point, &format!("{at}/at"), &used_for)
    }

    pub(super) fn attachment(&mut self, given: &Attachment, at: &str, name: &str) -> Option<Anchor> {
        let used_for = format!("constraint \"{name}\"");
        let node = self.node(&given.node, &format!("{at}/node"), &used_for)?;
        self.point(node, given.at.as_ref(), &format!("{at}/at"), &used_for)
    }

    /// The point that a body is nailed to.
    pub(super) fn target(&mut self, to: &Target, at: &str, name: &str) -> Option<Anchor> {
        match to {
            Target::World(p) => Some(Anchor { body: None, point: DVec3::from(p.map(|x| x.0)) }),
            Target::Node(to) => self.attachment(to, at, name),
            Target::Path { .. } => {
                let node = self.node(&path_node(name), at, "the nail's path")?;
                Some(self.anchor(node, DVec3::ZERO))
            }
        }
    }

    /// The node that gives the axes of a target; `None` is the world.
    pub(super) fn target_node(&mut self, to: Option<&Target>, at: &str, name: &str) -> Option<usize> {
        match to {
            Some(Target::Node(to)) => self.node(&to.node, &format!("{at}/node"), &format!("constraint \"{name}\"")),
            _ => None,
        }
    }

    pub(in super::super) fn body_axis(
        &mut self,
        body: &str,
        axis: [f64; 3],
        at_body: &str,
        at_axis: &str,
        name: &str,
    ) -> Option<Axis> {
        let node = self.node(body, at_body, &format!("constraint \"{name}\""))?;
        self.axis(node, axis, at_axis)
    }

    /// The axis given as `world_axis` or `other`; `None` where a problem was reported.
    pub(super) fn second_axis(
        &mut self,
        world: Option<[f64; 3]>,
        other: Option<&BodyAxis>,
        at: &str,
        name: &str,
    ) -> Option<Axis> {
        match (world, other) {
            (Some(axis), None) => {
                let unit = self.unit(DVec3::from(axis), &format!("{at}/world_axis"));
                unit.map(|direction| Axis { body: None, direction })
            }
            (None, Some(other)) => {
                let place = format!("{at}/other");
                self.body_axis(&other.body, other.axis, &format!("{place}/body"), &format!("{place}/axis"), name)
            }
            _ => {
                let message = format!("constraint \"{name}\" needs either world_axis or other");
                self.report(at, Diagnostic::new(codes::MISSING_KEY, message).help("add world_axis = [0, 1, 0]"));
                None
            }
        }
    }

    /// The body that the node named `frame` belongs to; the outer `None` where it is not found.
    pub(super) fn carrier(&mut self, frame: Option<&String>, at: &str, name: &str) -> Option<Option<usize>> {
        match frame {
            None => Some(None),
            Some(frame) => {
                let node = self.node(frame, &format!("{at}/frame"), &format!("constraint \"{name}\""))?;
                Some(self.owner[node])
            }
        }
    }
}
