//! Joints between pairs of bodies, read off the constraints, and the tree that they make.
//!
//! What holds two bodies together for ever is counted: points, planes and orientations. The counts that are joints of the
//! field become joints of a tree, found breadth first from the world; what closes a ring becomes an equality.

use std::collections::{BTreeMap, VecDeque};

use soffio_exhibit::Exhibit;
use soffio_math::DVec3;
use soffio_math::Function;
use soffio_multibody::articulation::{Anchor, Axis, Constraint, ConstraintKind, Measure};

/// Points farther apart at the start are not yet joined, m.
const CLOSED: f64 = 1e-5;
/// Directions that make a smaller sine are one.
const SAME: f64 = 1e-6;

/// A degree of freedom of a joint, in the world at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Freedom {
    /// Any turn about a point.
    Ball,
    /// A turn about this axis.
    Turn(DVec3),
    /// A way along this axis.
    Way(DVec3),
    /// Anything.
    Free,
}

/// How a body hangs from what carries it.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Names of the constraints that it stands for.
    pub names: Vec<String>,
    /// In the order in which they act.
    pub freedoms: Vec<Freedom>,
    /// Where, in the world at the start, m.
    pub point: DVec3,
}

/// A body in the tree.
#[derive(Clone, Debug)]
pub struct Member {
    /// What carries it; `None` is the world.
    pub parent: Option<usize>,
    /// How.
    pub joint: Joint,
    /// What it carries, in order.
    pub children: Vec<usize>,
}

/// A ring's last link: bodies, and what holds them.
#[derive(Clone, Debug)]
pub enum Closing {
    /// Two points, each in its body's node frame.
    Points(String, Anchor, Anchor),
    /// Two bodies, turned and placed as at the start.
    Rigid(String, Option<usize>, Option<usize>),
}

/// All bodies by their joints.
pub struct Tree {
    /// A member a body.
    pub members: Vec<Member>,
    /// Bodies without a carrier, in order.
    pub roots: Vec<usize>,
    /// What closes rings.
    pub closings: Vec<Closing>,
    /// Constraints that have no equivalent, and why.
    pub left_out: Vec<(String, &'static str)>,
}

type Ends = (Option<usize>, Option<usize>);

impl Tree {
    /// Reads the exhibit's constraints.
    pub fn new(exhibit: &Exhibit) -> Self {
        let count = exhibit.bodies.len();
        let mut left_out = Vec::new();
        let mut links: BTreeMap<Ends, Vec<&Constraint>> = BTreeMap::new();
        for constraint in &exhibit.constraints {
            match ends(&constraint.kind) {
                _ if !constraint.schedule.is_always() => left_out.push((constraint.name.clone(), "comes and goes")),
                None => {}
                Some(_) if constraint.breaking.is_some() => left_out.push((constraint.name.clone(), "breaks")),
                Some((a, b)) => links.entry((a.min(b), a.max(b))).or_default().push(constraint),
            }
        }
        let driven: Vec<bool> = (0..count).map(|i| exhibit.drives.iter().any(|drive| drive.body == i)).collect();
        let still = Joint { names: Vec::new(), freedoms: Vec::new(), point: DVec3::ZERO };
        let free = Joint { freedoms: vec![Freedom::Free], ..still.clone() };
        let mut members: Vec<Option<Member>> = vec![None; count];
        let mut tree = Self { members: Vec::new(), roots: Vec::new(), closings: Vec::new(), left_out };
        let mut open: VecDeque<Option<usize>> = VecDeque::from([None]);
        for body in (0..count).filter(|&i| driven[i]) {
            members[body] = Some(Member { parent: None, joint: still.clone(), children: Vec::new() });
            tree.roots.push(body);
            open.push_back(Some(body));
        }
        let mut next_free = 0;
        while let Some(carrier) = open.pop_front() {
            let here: Vec<Ends> = links.keys().copied().filter(|(a, b)| *a == carrier || *b == carrier).collect();
            for ends in here {
                let other = if ends.0 == carrier { ends.1 } else { ends.0 };
                let Some(body) = other.filter(|&body| members[body].is_none()) else { continue };
                let Some((joint, rest)) = joint(exhibit, body, &links[&ends]) else { continue };
                links.insert(ends, rest);
                members[body] = Some(Member { parent: carrier, joint, children: Vec::new() });
                match carrier {
                    Some(parent) => members[parent].iter_mut().for_each(|member| member.children.push(body)),
                    None => tree.roots.push(body),
                }
                open.push_back(Some(body));
            }
            // What hangs from nothing that is reached is free, and may carry others.
            while open.is_empty() && next_free < count {
                if members[next_free].is_none() {
                    members[next_free] = Some(Member { parent: None, joint: free.clone(), children: Vec::new() });
                    tree.roots.push(next_free);
                    open.push_back(Some(next_free));
                }
                next_free += 1;
            }
        }
        tree.members = members.into_iter().flatten().collect();
        for (ends, rest) in links {
            tree.close(exhibit, ends, &rest);
        }
        tree
    }

    /// Closes a ring by what is left between two bodies.
    fn close(&mut self, exhibit: &Exhibit, ends: Ends, rest: &[&Constraint]) {
        let orientations = rest.iter().filter(|c| matches!(c.kind, ConstraintKind::Orientation { .. })).count();
        let rigid = orientations == 3 && rest.iter().any(|c| matches!(c.kind, ConstraintKind::PointToPoint { .. }));
        if let Some(first) = rest.first().filter(|_| rigid) {
            return self.closings.push(Closing::Rigid(first.group().to_owned(), ends.0, ends.1));
        }
        // Right angles are a hinge's where a point is held as well.
        let held = rest.iter().any(|c| matches!(c.kind, ConstraintKind::PointToPoint { .. }));
        let axis = axis_of(exhibit, rest).filter(|_| held);
        for constraint in rest {
            match &constraint.kind {
                ConstraintKind::PointToPoint { a, b } => {
                    self.closings.push(Closing::Points(constraint.name.clone(), *a, *b));
                    if let Some(axis) = axis {
                        /// A second point of a hinge's axis, this far along it, m.
                        const ALONG: f64 = 0.02;
                        let along = |anchor: &Anchor| Anchor {
                            point: local(exhibit, anchor.body, world(exhibit, anchor) + axis * ALONG),
                            ..*anchor
                        };
                        let name = format!("{}/along", constraint.name);
                        self.closings.push(Closing::Points(name, along(a), along(b)));
                    }
                }
                ConstraintKind::Orientation { .. } if axis.is_some() => {}
                _ => self.left_out.push((constraint.name.clone(), "closes a ring, and is no point, hinge or weld")),
            }
        }
    }

    /// A measure as a sum of joint coordinates: (body, index of its freedom, coefficient); `None` where it is none.
    pub fn coordinates(&self, exhibit: &Exhibit, measure: &Measure) -> Option<Vec<(usize, usize, f64)>> {
        let (body, frame) = measure.bodies();
        let (direction, turns) = match measure {
            Measure::Angle { axis, .. } => (direction(exhibit, axis), true),
            Measure::Way { direction: way, .. } => (direction(exhibit, way), false),
        };
        let mut out = Vec::new();
        let mut at = body;
        while at != frame {
            let index = at?;
            let member = &self.members[index];
            for (k, freedom) in member.joint.freedoms.iter().enumerate() {
                match freedom {
                    Freedom::Turn(axis) if turns && axis.cross(direction).length() < SAME => {
                        out.push((index, k, axis.dot(direction).signum()));
                    }
                    Freedom::Way(axis) if !turns => out.push((index, k, axis.dot(direction))),
                    Freedom::Way(_) => {}
                    _ => return None,
                }
            }
            at = member.parent;
        }
        Some(out).filter(|out| !out.is_empty())
    }
}

/// The bodies that a constraint of two bodies holds; `None` for a coupling.
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

/// The joint of `body` that some of what is between it and its carrier makes, and the rest.
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
                // The carrier's axis first.
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
    let way = match planes.as_slice() {
        [(_, n), (_, m)] => n.cross(*m).try_normalize(),
        _ => None,
    };
    let (freedoms, at) = match (point, right.len(), planes.len()) {
        (Some(p), 1, 0) => (vec![Freedom::Turn(right[0].0), Freedom::Turn(right[0].1)], p),
        (Some(p), 2, 0) => (vec![axis_of(exhibit, between).map_or(Freedom::Ball, Freedom::Turn)], p),
        (Some(p), 3, 0) => (Vec::new(), p),
        (None, 3, 2) => (vec![Freedom::Way(way?)], planes[0].0),
        (None, 0, 2) => (vec![Freedom::Way(way?), Freedom::Ball], planes[0].0),
        // Of several points the first carries, the others close.
        (Some(p), _, _) => (vec![Freedom::Ball], p),
        _ => return None,
    };
    // One point is in the joint, and of a ball nothing else is.
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

/// The line that two right angles leave to turn about: one direction of one body across two of the other.
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
