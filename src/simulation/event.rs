//! Events of a run, for logs, sounds and triggers.

use super::rate::SAMPLE_RATE;
use soffio_exhibit::Exhibit;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_multibody::articulation::{Anchor, ConstraintKind, Measure, SpringKind};
use soffio_multibody::dynamics::{Impact, ImpactKind};

/// Kind of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// Two bodies collide.
    Impact,
    /// Two bodies begin a resting contact.
    Rest,
    /// A constraint or spring breaks.
    Break,
    /// A breath or an impact triggers a constraint or spring.
    Trigger,
    /// Invalid numbers were found and the bodies restored.
    Fault,
}

impl EventKind {
    /// Its name in event logs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Impact => "impact",
            Self::Rest => "rest",
            Self::Break => "break",
            Self::Trigger => "trigger",
            Self::Fault => "fault",
        }
    }
}

/// The constraint or spring that an event comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventSource {
    /// By index.
    Constraint(usize),
    /// By index.
    Spring(usize),
}

impl EventSource {
    /// Its name in the sidecar; constraints of a combined joint have the joint's name.
    pub fn name(self, exhibit: &Exhibit) -> &str {
        match self {
            Self::Constraint(index) => exhibit.constraints[index].group(),
            Self::Spring(index) => &exhibit.springs[index].name,
        }
    }

    /// The bodies that it acts on (`None`: the world) and its position (world, m). Without a position of its own, it is that of
    /// the centre of mass of the body that it turns.
    fn location(self, exhibit: &Exhibit, bodies: &[RigidBody]) -> ([Option<usize>; 2], DVec3) {
        let center = |body: Option<usize>| body.map_or(DVec3::ZERO, |body| bodies[body].position);
        let at = |anchor: &Anchor| anchor.body.map_or(anchor.point, |body| bodies[body].pose().point(anchor.point));
        let of = |measure: &Measure| {
            let (on, against) = measure.bodies();
            let point = match measure {
                Measure::Angle { .. } => center(on),
                Measure::Displacement { point, .. } => at(point),
            };
            ([on, against], point)
        };
        match self {
            Self::Constraint(index) => match &exhibit.constraints[index].kind {
                ConstraintKind::PointToPoint { a, b } => ([a.body, b.body], at(a)),
                ConstraintKind::PointOnPlane { point, plane, .. } => ([point.body, plane.body], at(point)),
                ConstraintKind::Orientation { a, b, .. } => ([a.body, b.body], center(a.body.or(b.body))),
                ConstraintKind::Coupling { terms } => match &terms[..] {
                    [first, second, ..] => {
                        let ([one, _], point) = of(&first.measure);
                        ([one, of(&second.measure).0[0]], point)
                    }
                    [only] => of(&only.measure),
                    [] => ([None; 2], DVec3::ZERO),
                },
            },
            Self::Spring(index) => match &exhibit.springs[index].kind {
                SpringKind::Linear { a, b } => ([a.body, b.body], at(a)),
                SpringKind::Angular { measure } => of(measure),
            },
        }
    }
}

/// One event.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Seconds since the run began.
    pub t: f64,
    /// round(48000 t).
    pub sample: u64,
    /// Kind.
    pub kind: EventKind,
    /// Bodies by index; `None` is the world.
    pub bodies: [Option<usize>; 2],
    /// World point of the event, m.
    pub point: DVec3,
    /// Unit, from the second body to the first.
    pub normal: DVec3,
    /// Impulse of the impact, N s.
    pub impulse: f64,
    /// Approach speed, m/s.
    pub speed: f64,
    /// The constraint or spring that broke or was triggered.
    pub source: Option<EventSource>,
}

impl Event {
    /// An event without an impact, `t` seconds into the run.
    fn without_impact(
        t: f64,
        kind: EventKind,
        bodies: [Option<usize>; 2],
        point: DVec3,
        source: Option<EventSource>,
    ) -> Self {
        Self { t, sample: sample_at(t), kind, bodies, point, normal: DVec3::Y, impulse: 0.0, speed: 0.0, source }
    }

    /// A constraint or spring broke or was triggered, `t` seconds into the run.
    pub(super) fn of_source(
        t: f64,
        kind: EventKind,
        source: EventSource,
        exhibit: &Exhibit,
        bodies: &[RigidBody],
    ) -> Self {
        let (ends, point) = source.location(exhibit, bodies);
        Self::without_impact(t, kind, ends, point, Some(source))
    }

    /// Invalid numbers were found, first in this body.
    pub(super) fn fault(t: f64, body: usize, bodies: &[RigidBody]) -> Self {
        Self::without_impact(t, EventKind::Fault, [Some(body), None], bodies[body].position, None)
    }

    /// An impact in the step from `start` (s).
    pub(super) fn impact(start: f64, impact: &Impact) -> Self {
        let t = start + impact.time;
        Self {
            t,
            sample: sample_at(t),
            kind: match impact.kind {
                ImpactKind::Impact | ImpactKind::Stop => EventKind::Impact,
                ImpactKind::RestingContact => EventKind::Rest,
            },
            bodies: impact.bodies,
            point: impact.point,
            normal: impact.normal,
            impulse: impact.impulse,
            speed: impact.speed,
            source: None,
        }
    }
}

fn sample_at(t: f64) -> u64 {
    (t * f64::from(SAMPLE_RATE)).round() as u64
}
