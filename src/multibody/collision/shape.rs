//! Colliders and the shapes they are made of.

use soffio_geometry::hull::Hull;
use soffio_geometry::support::{Core, Placed, RIM_CORNERS, Support, along};
use soffio_math::{DQuat, DVec3, Pose};

/// A convex collision shape: the Minkowski sum of a convex core and a ball, placed in the frame of its body.
///
/// A sphere is a point and a ball, a capsule a segment and a ball, sheet metal a flat polygon with half its thickness
/// as the ball: thin plates keep a well-defined normal however they are grazed. Boxes, cylinders and hulls may have
/// edges rounded by a ball of their own, inside their stated size.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The core in its own frame.
    pub core: Core,
    /// Radius of the ball, m.
    pub radius: f64,
    /// The core's frame in the node frame of the body (the world for static bodies).
    pub place: Pose,
}

impl Shape {
    /// A ball, m.
    pub fn sphere(center: DVec3, radius: f64) -> Self {
        Self { core: Core::Point, radius, place: at(center) }
    }

    /// All points within `radius` of the segment between two points, m.
    pub fn capsule(from: DVec3, to: DVec3, radius: f64) -> Self {
        let (place, half) = axis(from, to);
        Self { core: Core::Segment { half }, radius, place }
    }

    /// A cylinder between the middles of its ends, its edges rounded by `rounding` (at most the radius and half the
    /// height), m.
    pub fn cylinder(from: DVec3, to: DVec3, radius: f64, rounding: f64) -> Self {
        let (place, half) = axis(from, to);
        let ball = rounding.min(radius).min(half);
        Self { core: Core::Cylinder { half: half - ball, radius: radius - ball }, radius: ball, place }
    }

    /// A box about the origin of `place` with half its edges, its edges rounded by `rounding`, m.
    pub fn cuboid(place: Pose, half: DVec3, rounding: f64) -> Self {
        let ball = rounding.min(half.min_element());
        Self { core: Core::Box { half: half - ball }, radius: ball, place }
    }

    /// All that lies below the plane through a point with a unit normal. Only for static and kinematic bodies, as
    /// it has no mass.
    pub fn plane(point: DVec3, normal: DVec3) -> Self {
        Self { core: Core::HalfSpace, radius: 0.0, place: Pose { rotation: along(normal), position: point } }
    }

    /// The convex hull of corners (one at least) with a ball of radius `radius` around, m.
    pub fn hull(corners: &[DVec3], radius: f64) -> Self {
        Self { core: Core::Hull(Hull::new(corners)), radius, place: Pose::IDENTITY }
    }

    /// Sheet metal: the convex polygon of its mid-surface and half its thickness, m.
    pub fn plate(corners: &[DVec3], half_thickness: f64) -> Self {
        Self::hull(corners, half_thickness)
    }

    /// The core in the world while its body's node frame stands at `body`.
    pub fn placed(&self, body: &Pose) -> Placed<'_> {
        let pose = Pose { rotation: body.rotation * self.place.rotation, position: body.point(self.place.position) };
        Placed::new(&self.core, &pose)
    }

    /// Middle of the core, node frame, m.
    pub fn middle(&self) -> DVec3 {
        self.place.point(self.core.middle())
    }

    /// Farthest distance of the core's points from a point of the node frame, m. The ball turns into itself, so this
    /// is the arm by which turning moves the surface.
    pub fn bounding_radius(&self, from: DVec3) -> f64 {
        self.core.bounding_radius(self.place.inverse_point(from))
    }

    /// Middle and half extents of a box along the node frame's axes around the whole shape, m.
    pub fn extents(&self) -> (DVec3, DVec3) {
        let placed = self.placed(&Pose::IDENTITY);
        (placed.middle(), placed.extents() + self.radius)
    }

    /// Corners of its largest face at most.
    pub(super) fn most_corners(&self) -> usize {
        match &self.core {
            Core::Hull(hull) => hull.corners().len(),
            _ => RIM_CORNERS,
        }
    }

    /// Is it bounded on one side alone?
    pub fn is_plane(&self) -> bool {
        self.core == Core::HalfSpace
    }

    /// In words, for `explain`.
    pub fn describe(&self) -> String {
        let mm = |x: f64| format!("{:.2} mm", x * 1e3);
        let r = self.radius;
        match &self.core {
            Core::Point => format!("sphere, radius {}", mm(r)),
            Core::Segment { half } => format!("capsule, {} between centres, radius {}", mm(2.0 * half), mm(r)),
            Core::Box { half } => {
                let size = (*half + r) * 2e3;
                format!("box, {:.2} × {:.2} × {:.2} mm, edges rounded by {}", size.x, size.y, size.z, mm(r))
            }
            Core::Cylinder { half, radius } => format!(
                "cylinder, height {}, radius {}, edges rounded by {}",
                mm(2.0 * (half + r)),
                mm(radius + r),
                mm(r)
            ),
            Core::HalfSpace => "plane".to_owned(),
            Core::Hull(hull) => format!("{} corners + {}", hull.corners().len(), mm(r)),
        }
    }
}

fn at(position: DVec3) -> Pose {
    Pose { rotation: DQuat::IDENTITY, position }
}

/// The frame with Y from one point to another about their middle, and half their distance.
fn axis(from: DVec3, to: DVec3) -> (Pose, f64) {
    let offset = to - from;
    let rotation = offset.try_normalize().map_or(DQuat::IDENTITY, along);
    (Pose { rotation, position: 0.5 * (from + to) }, 0.5 * offset.length())
}

/// A shape that collides.
#[derive(Clone, Debug)]
pub struct Collider {
    /// Index of the moving body it belongs to; `None` stands still.
    pub body: Option<usize>,
    /// Its shape in the body's node frame (world frame where `body` is `None`).
    pub shape: Shape,
    /// Index of the material.
    pub material: usize,
    /// Name of the glTF node, for messages and events.
    pub node: String,
}

impl Collider {
    /// Middle of the core and the farthest point of the core from it: with the shape's ball, a ball around the whole
    /// (m, node frame).
    pub fn bounds(&self) -> (DVec3, f64) {
        let middle = self.shape.middle();
        (middle, self.shape.bounding_radius(middle))
    }
}
