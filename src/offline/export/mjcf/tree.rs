//! Kinematic tree: joints between pairs of bodies, found from their constraints.
//!
//! The permanent constraints between two bodies are counted: points, planes and orientations. Counts that match a
//! MuJoCo joint become joints of a tree, found breadth first from the world. Constraints that close a loop become
//! equalities.

use std::collections::{BTreeMap, VecDeque};

use soffio_exhibit::Exhibit;
use soffio_math::DVec3;
use soffio_math::Function;
use soffio_multibody::articulation::{Anchor, Axis, Constraint, ConstraintKind, Measure};

/// Points farther apart at the start are not yet joined, m.
const CLOSED: f64 = 1e-5;
/// Directions whose angle has a smaller sine count as parallel.
const SAME: f64 = 1e-6;

/// A degree of freedom of a joint, world frame at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Freedom {
    /// All rotations about a point.
    Ball,
    /// Rotation about this axis.
    Rotation(DVec3),
    /// Translation along this axis.
    Translation(DVec3),
    /// All six degrees of freedom.
    Free,
}

/// The joint between a body and its parent.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Names of the constraints that it represents.
    pub names: Vec<String>,
    /// Degrees of freedom in the order in which they act.
    pub freedoms: Vec<Freedom>,
    /// Position, world, at the start, m.
    pub point: DVec3,
}

/// A body in the tree.
#[derive(Clone, Debug)]
pub struct TreeBody {
    /// Parent body; `None` is the world.
    pub parent: Option<usize>,
    /// Joint to the parent.
    pub joint: Joint,
    /// Bodies that it carries, in order.
    pub children: Vec<usize>,
}

/// An equality constraint that closes a loop.
#[derive(Clone, Debug)]
pub enum Equality {
    /// Two points coincide, each in its body's node frame.
    Points(String, Anchor, Anchor),
    /// Two bodies keep their relative pose.
    Rigid(String, Option<usize>, Option<usize>),
}

/// The kinematic tree of all bodies.
pub struct Tree {
    /// Node of each body.
    pub bodies: Vec<TreeBody>,
    /// Bodies without a parent, in order.
    pub roots: Vec<usize>,
    /// Equality constraints that close loops.
    pub equalities: Vec<Equality>,
    /// Constraints without an equivalent, and the reasons.
    pub omitted: Vec<(String, &'static str)>,
}

type Ends = (Option<usize>, Option<usize>);

impl Tree {
    /// Builds the tree from the exhibit's constraints.
    pub fn new(exhibit: &Exhibit) -> Self {
        let count = exhibit.bodies.len();
        let mut omitted = Vec::new();
        let mut links: BTreeMap<Ends, Vec<&Constraint>> = BTreeMap::new();
        for constraint in &exhibit.constraints {
            match ends(&constraint.kind) {
                _ if !constraint.schedule.is_always() => omitted.push((constraint.name.clone(), "comes and goes")),
                None => {}
                Some(_) if constraint.breaking.is_some() => omitted.push((constraint.name.clone(), "breaks")),
                Some((a, b)) => links.entry((a.min(b), a.max(b))).or_default().push(constraint),
            }
        }
        let is_kinematic: Vec<bool> = (0..count).map(|i| exhibit.drives.iter().any(|drive| drive.body == i)).collect();
        let still = Joint { names: Vec::new(), freedoms: Vec::new(), point: DVec3::ZERO };
        let free = Joint { freedoms: vec![Freedom::Free], ..still.clone() };
        let mut bodies: Vec<Option<TreeBody>> = vec![None; count];
        let mut tree = Self { bodies: Vec::new(), roots: Vec::new(), equalities: Vec::new(), omitted };
        let mut open: VecDeque<Option<usize>> = VecDeque::from([None]);
        for body in (0..count).filter(|&i| is_kinematic[i]) {
            bodies[body] = Some(TreeBody { parent: None, joint: still.clone(), children: Vec::new() });
            tree.roots.push(body);
            open.push_back(Some(body));
        }
        let mut next_free = 0;
        while let Some(carrier) = open.pop_front() {
            let here: Vec<Ends> = links.keys().copied().filter(|(a, b)| *a == carrier || *b == carrier).collect();
            for ends in here {
                let other = if ends.0 == carrier { ends.1 } else { ends.0 };
                let Some(body) = other.filter(|&body| bodies[body].is_none()) else { continue };
                let Some((joint, rest)) = joint(exhibit, body, &links[&ends]) else { continue };
                links.insert(ends, rest);
                bodies[body] = Some(TreeBody { parent: carrier, joint, children: Vec::new() });
                match carrier {
                    Some(parent) => bodies[parent].iter_mut().for_each(|tree_body| tree_body.children.push(body)),
                    None => tree.roots.push(body),
                }
                open.push_back(Some(body));
            }
            // A body that is not reached is free, and can carry others.
            while open.is_empty() && next_free < count {
                if bodies[next_free].is_none() {
                    bodies[next_free] = Some(TreeBody { parent: None, joint: free.clone(), children: Vec::new() });
                    tree.roots.push(next_free);
                    open.push_back(Some(next_free));
                }
                next_free += 1;
            }
        }
        tree.bodies = bodies.into_iter().flatten().collect();
        for (ends, rest) in links {
            tree.close(exhibit, ends, &rest);
        }
        tree
    }

    /// Closes a loop by the remaining constraints between two bodies.
    fn close(&mut self, exhibit: &Exhibit, ends: Ends, rest: &[&Constraint]) {
        let orientations = rest.iter().filter(|c| matches!(c.kind, ConstraintKind::Orientation { .. })).count();
        let rigid = orientations == 3 && rest.iter().any(|c| matches!(c.kind, ConstraintKind::PointToPoint { .. }));
        if let Some(first) = rest.first().filter(|_| rigid) {
            return self.equalities.push(Equality::Rigid(first.group().to_owned(), ends.0, ends.1));
        }
        // Right angles belong to a hinge where a point is constrained as well.
        let held = rest.iter().any(|c| matches!(c.kind, ConstraintKind::PointToPoint { .. }));
        let axis = axis_of(exhibit, rest).filter(|_| held);
        for constraint in rest {
            match &constraint.kind {
                ConstraintKind::PointToPoint { a, b } => {
                    self.equalities.push(Equality::Points(constraint.name.clone(), *a, *b));
                    if let Some(axis) = axis {
                        /// Distance of a second point along a hinge's axis, m.
                        const ALONG: f64 = 0.02;
                        let along = |anchor: &Anchor| Anchor {
                            point: local(exhibit, anchor.body, world(exhibit, anchor) + axis * ALONG),
                            ..*anchor
                        };
                        let name = format!("{}/along", constraint.name);
                        self.equalities.push(Equality::Points(name, along(a), along(b)));
                    }
                }
                ConstraintKind::Orientation { .. } if axis.is_some() => {}
                _ => self.omitted.push((constraint.name.clone(), "closes a ring, and is no point, hinge or weld")),
            }
        }
    }

    /// A measure as a sum of joint coordinates: (body, index of its degree of freedom, coefficient); `None` where it is
    /// not one.
    pub fn coordinates(&self, exhibit: &Exhibit, measure: &Measure) -> Option<Vec<(usize, usize, f64)>> {
        let (body, frame) = measure.bodies();
        let (direction, turns) = match measure {
            Measure::Angle { axis, .. } => (direction(exhibit, axis), true),
            Measure::Displacement { direction: slide, .. } => (direction(exhibit, slide), false),
        };
        let mut out = Vec::new();
        let mut at = body;
        while at != frame {
            let index = at?;
            let tree_body = &self.bodies[index];
            for (k, freedom) in tree_body.joint.freedoms.iter().enumerate() {
                match freedom {
                    Freedom::Rotation(axis) if turns && axis.cross(direction).length() < SAME => {
                        out.push((index, k, axis.dot(direction).signum()));
                    }
                    Freedom::Translation(axis) if !turns => out.push((index, k, axis.dot(direction))),
                    Freedom::Translation(_) => {}
                    _ => return None,
                }
            }
            at = tree_body.parent;
        }
        Some(out).filter(|out| !out.is_empty())
    }
}

/// The two bodies of a constraint; `None` for a coupling.
fn ends(kind: &ConstraintKind) -> Option<Ends> {
    match kind {
        ConstraintKind::PointToPoint { a, b } => Some((a.body, b.body)),
        ConstraintKind::PointOnPlane { point, plane, .. } => Some((point.body, plane.body)),
        ConstraintKind::Orientation { a, b, .. } => Some((a.body, b.body)),
        ConstraintKind::Coupling { .. } => None,
    }
}

pub(super) fn world(exhibit: &Exhibit, anchor: &Anchor) -> DVec3 {
    anchor.body.map_or(anchor.point, |body| exhibit.bodies[body].pose.point(anchor.point))
}

pub(super) fn local(exhibit: &Exhibit, body: Option<usize>, point: DVec3) -> DVec3 {
    body.map_or(point, |body| exhibit.bodies[body].pose.inverse_point(point))
}

fn direction(exhibit: &Exhibit, axis: &Axis) -> DVec3 {
    axis.body.map_or(axis.direction, |body| exhibit.bodies[body].pose.vector(axis.direction))
}

/// The joint of `body` that constraints to its parent form, and the remaining constraints.
fn joint<'a>(exhibit: &Exhibit, body: usize, between: &[&'a Constraint]) -> Option<(Joint, Vec<&'a Constraint>)> {
    let point = between.iter().find_map(|c| match &c.kind {
        ConstraintKind::PointToPoint { a, b } => {
            let (p, q) = (world(exhibit, a), world(exhibit, b));
            (p.distance(q) < CLOSED).then_some(p)
        }
        _ => None,
    });
    let still = |f: &Function| *f == Function::Constant(0.0);
    let right: Vec<(DVec3, DVec3)> = between
        .iter()
        .filter_map(|c| match &c.kind {
            ConstraintKind::Orientation { a, b, angle } if still(angle) => {
                // The parent's axis first.
                let (own, other) = if a.body == Some(body) { (a, b) } else { (b, a) };
                Some((direction(exhibit, other), direction(exhibit, own)))
            }
            _ => None,
        })
        .collect();
    let planes: Vec<(DVec3, DVec3)> = between
        .iter()
        .filter_map(|c| match &c.kind {
            ConstraintKind::PointOnPlane { point, plane, normal, offset } if still(offset) => {
                let normal = plane.body.map_or(*normal, |b| exhibit.bodies[b].pose.vector(*normal));
                Some((world(exhibit, point), normal))
            }
            _ => None,
        })
        .collect();
    let slide_axis = match planes.as_slice() {
        [(_, n), (_, m)] => n.cross(*m).try_normalize(),
        _ => None,
    };
    let (freedoms, at) = match (point, right.len(), planes.len()) {
        (Some(p), 1, 0) => (vec![Freedom::Rotation(right[0].0), Freedom::Rotation(right[0].1)], p),
        (Some(p), 2, 0) => (vec![axis_of(exhibit, between).map_or(Freedom::Ball, Freedom::Rotation)], p),
        (Some(p), 3, 0) => (Vec::new(), p),
        (None, 3, 2) => (vec![Freedom::Translation(slide_axis?)], planes[0].0),
        (None, 0, 2) => (vec![Freedom::Translation(slide_axis?), Freedom::Ball], planes[0].0),
        // The first of several points is the joint's; the others are closed by equalities.
        (Some(p), _, _) => (vec![Freedom::Ball], p),
        _ => return None,
    };
    // A ball joint uses one point and nothing else.
    let mut points = 0;
    let ball = freedoms == [Freedom::Ball];
    let (used, rest): (Vec<&Constraint>, Vec<&Constraint>) = between.iter().partition(|c| match c.kind {
        ConstraintKind::PointToPoint { .. } => {
            points += 1;
            points == 1
        }
        _ => !ball,
    });
    let mut names: Vec<String> = used.iter().map(|c| c.group().to_owned()).collect();
    names.dedup();
    Some((Joint { names, freedoms, point: at }, rest))
}

/// The rotation axis that two right angles leave: one direction of one body, perpendicular to two of the other.
fn axis_of(exhibit: &Exhibit, between: &[&Constraint]) -> Option<DVec3> {
    let mut pairs = between.iter().filter_map(|c| match &c.kind {
        ConstraintKind::Orientation { a, b, angle: Function::Constant(0.0) } => {
            let (t, n) = (direction(exhibit, a), direction(exhibit, b));
            Some(if a.body < b.body { (t, n) } else { (n, t) })
        }
        _ => None,
    });
    let (Some((t, n)), Some((u, m)), None) = (pairs.next(), pairs.next(), pairs.next()) else { return None };
    if t.cross(u).length() < SAME {
        Some(t)
    } else if n.cross(m).length() < SAME {
        Some(n)
    } else {
        None
    }
}
