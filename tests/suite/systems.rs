//! Which exhibit proves which system of the method: asked of the loaded exhibits, row by row, not of their names.

use soffio_exhibit::{self as exhibit, Exhibit, Motion, SoundTrigger};
use soffio_geometry::support::Core;
use soffio_multibody::articulation::{Constraint, ConstraintKind, LimitKind, Measure, Spring, SpringKind, Trigger};
use soffio_wind::ambient::WindKind;
use soffio_wind::breath::SpreadLaw;

/// A system, and how an exhibit that shows it is known.
type System = (&'static str, fn(&Exhibit) -> bool);

fn any(exhibit: &Exhibit, is: impl Fn(&Constraint) -> bool) -> bool {
    exhibit.constraints.iter().any(is)
}

/// Rows of a combination: points, orientations, planes, by the table that they come from.
fn combined(exhibit: &Exhibit, rows: [usize; 3]) -> bool {
    any(exhibit, |first| {
        let parts = || exhibit.constraints.iter().filter(|c| c.group() == first.group());
        let count = |is: fn(&ConstraintKind) -> bool| parts().filter(|c| is(&c.kind)).count();
        let found = [
            count(|kind| matches!(kind, ConstraintKind::PointToPoint { .. })),
            count(|kind| matches!(kind, ConstraintKind::Orientation { .. })),
            count(|kind| matches!(kind, ConstraintKind::PointOnPlane { .. })),
        ];
        found == rows && parts().count() > 1
    })
}

/// Is there a coupling of these measures, a turn written as true?
fn coupled(exhibit: &Exhibit, turns: &[bool]) -> bool {
    any(exhibit, |c| match &c.kind {
        ConstraintKind::Coupling { terms } => {
            terms.iter().map(|term| matches!(term.measure, Measure::Angle { .. })).eq(turns.iter().copied())
        }
        _ => false,
    })
}

fn moves(exhibit: &Exhibit, body: Option<usize>) -> bool {
    let of = |body: usize| exhibit.drives.iter().find(|drive| drive.body == body);
    body.and_then(of).is_some_and(|drive| drive.motion.keys.len() > 1)
}

/// A ball joint of which one element is gone for a time: three planes of one table, one of them with windows.
fn minus_an_element(exhibit: &Exhibit) -> bool {
    any(exhibit, |first| {
        let parts = || exhibit.constraints.iter().filter(|c| c.group() == first.group());
        let planes = parts().filter(|c| matches!(c.kind, ConstraintKind::PointOnPlane { .. })).count();
        planes == 3 && parts().filter(|c| !c.schedule.windows.is_empty()).count() == 1
    })
}

/// Orientations that take turns: one ends where another begins.
fn changes(exhibit: &Exhibit) -> bool {
    let edges = |c: &Constraint| match &c.kind {
        ConstraintKind::Orientation { .. } => c.schedule.windows.first().map(|w| (w.start, w.end)),
        _ => None,
    };
    let all: Vec<(f64, f64)> = exhibit.constraints.iter().filter_map(edges).collect();
    all.iter().any(|one| all.iter().any(|other| one.1 == other.0))
}

fn sounds(exhibit: &Exhibit, on: SoundTrigger, timbre: &str) -> bool {
    let played = |index: usize| exhibit.instruments[index].timbre.starts_with(timbre);
    exhibit.sounds.iter().any(|sound| sound.on == on && played(sound.instrument))
}

fn shape(exhibit: &Exhibit, is: fn(&Core) -> bool) -> bool {
    exhibit.colliders.iter().any(|collider| is(&collider.shape.core))
}

fn limit(exhibit: &Exhibit, is: fn(&LimitKind) -> bool) -> bool {
    exhibit.limits.iter().any(|limit| is(&limit.kind))
}

#[rustfmt::skip] // rows of a table
const SYSTEMS: &[System] = &[
    // 1.3: the constraint library
    ("point to point", |e| any(e, |c| matches!(&c.kind, ConstraintKind::PointToPoint { a, b } if a.body.is_some() && b.body.is_some()))),
    ("point to nail", |e| any(e, |c| matches!(&c.kind, ConstraintKind::PointToPoint { a, b } if a.body.is_none() || b.body.is_none()))),
    ("point on a moving path", |e| any(e, |c| matches!(&c.kind, ConstraintKind::PointToPoint { a, b } if moves(e, a.body) || moves(e, b.body)))),
    ("orientation", |e| any(e, |c| matches!(c.kind, ConstraintKind::Orientation { .. }) && c.group() == c.name)),
    ("point on plane", |e| any(e, |c| matches!(c.kind, ConstraintKind::PointOnPlane { .. }) && c.group() == c.name)),
    ("gear to gear", |e| coupled(e, &[true, true])),
    ("gear to weight", |e| coupled(e, &[true, false]) || coupled(e, &[false, true])),
    ("ball joint minus an element", minus_an_element),
    ("spring and damper, linear", |e| e.springs.iter().any(|s| matches!(s.kind, SpringKind::Linear { .. }))),
    ("spring and damper, angular", |e| e.springs.iter().any(|s| matches!(s.kind, SpringKind::Angular { .. }))),
    ("hinge and windmill joint", |e| combined(e, [1, 2, 0])),
    ("windmill joint", |e| combined(e, [1, 2, 0]) && any(e, |c| c.name.ends_with("/point"))),
    ("universal joint", |e| combined(e, [1, 1, 0])),
    ("slider", |e| combined(e, [0, 3, 2])),
    ("line", |e| combined(e, [0, 0, 2])),
    ("weld", |e| combined(e, [1, 3, 0])),
    ("friction of a pivot", |e| any(e, |c| c.friction.is_some())),
    ("stops of a turn or way", |e| limit(e, |l| matches!(l, LimitKind::Range { .. }))),
    ("ratchet", |e| limit(e, |l| matches!(l, LimitKind::Ratchet { .. }))),
    ("slack cord", |e| limit(e, |l| matches!(l, LimitKind::Distance { .. }))),
    ("tilt on a point", |e| limit(e, |l| matches!(l, LimitKind::Tilt { .. }))),
    // 1.1 and 1.4: time
    ("self-assembly when it comes on", |e| e.assembles && e.constraints.len() > 1),
    ("self-assembly in the course of it", |e| any(e, |c| c.schedule.trigger.is_some() && matches!(c.kind, ConstraintKind::PointToPoint { .. }))),
    ("time window", |e| any(e, |c| !c.schedule.windows.is_empty())),
    ("ramp", |e| any(e, |c| c.schedule.ramp_in > 0.0 && c.schedule.ramp_out > 0.0)),
    ("periodic window", |e| any(e, |c| c.schedule.period.is_some())),
    ("event trigger", |e| any(e, |c| matches!(c.schedule.trigger, Some(Trigger::Breath { .. })))),
    ("breaking at a limit", |e| any(e, |c| c.breaking.is_some_and(|b| b.force.is_finite()))),
    ("transition between axes", changes),
    // 1.5: kinematic bodies
    ("body that follows a path", |e| e.drives.iter().any(|d| d.motion.keys.len() > 1)),
    // 2: collisions
    ("sphere", |e| shape(e, |s| matches!(s, Core::Point))),
    ("several points of two bodies", |e| e.colliders.iter().filter(|c| matches!(c.shape.core, Core::Box { .. })).count() > 1),
    ("teeth that touch", |e| e.colliders.len() > 40 && e.constraints.iter().any(|c| matches!(c.kind, ConstraintKind::Coupling { .. }))),
    // 3: position-based motion, pointer grabs, balls
    ("choice of the solver while it runs", |e| matches!(e.motion, Motion::Auto { .. })),
    ("taken by the hand", |e| e.touch.permitted && e.bodies.len() > 10),
    ("tyres that grip and drift", |e| e.materials.iter().any(|m| m.full_slip > 0.0) && combined(e, [1, 2, 0])),
    ("cloth that shears and bends", |e| {
        let seams = |s: &&Spring| matches!(s.kind, SpringKind::Angular { measure: Measure::Displacement { .. } });
        e.springs.iter().filter(seams).count() > 10 && e.model.skins.iter().any(|skin| skin.joints.len() > 10)
    }),
    ("rolling and sliding balls", |e| {
        shape(e, |s| matches!(s, Core::Point)) && e.materials.iter().any(|m| m.resistance.rolling > 0.0)
    }),
    // 4: wind
    ("breath as a jet", |e| e.breath.law == SpreadLaw::Jet && !e.wind_surfaces.is_empty()),
    ("breath as a cone", |e| e.breath.law == SpreadLaw::Cone && !e.wind_surfaces.is_empty()),
    ("fan", |e| e.winds.iter().any(|w| matches!(w.kind, WindKind::Fan { .. }))),
    ("draught or gust", |e| e.winds.iter().any(|w| matches!(w.kind, WindKind::Draught { .. }))),
    ("the room's own air", |e| e.winds.iter().any(|w| matches!(w.kind, WindKind::Turbulence { .. }))),
    // 5: sound
    ("a tube that rings", |e| sounds(e, SoundTrigger::Impact, "chime-")),
    ("bell", |e| sounds(e, SoundTrigger::Impact, "bell")),
    ("drum", |e| sounds(e, SoundTrigger::Impact, "drum")),
    ("metal", |e| sounds(e, SoundTrigger::Impact, "metal")),
    ("wood", |e| sounds(e, SoundTrigger::Impact, "wood")),
    ("plates that ring", |e| sounds(e, SoundTrigger::Impact, "plate")),
    ("scratching wood", |e| sounds(e, SoundTrigger::Slide, "scrape-wood")),
    ("wind that is heard", |e| sounds(e, SoundTrigger::Wind, "wind-")),
];

fn load(id: &str) -> Exhibit {
    let folder = exhibit::resolve(id).unwrap_or_else(|report| panic!("{report}"));
    exhibit::load(&folder).unwrap_or_else(|report| panic!("{id}: {}", report.to_text()))
}

#[test]
fn every_system_of_the_method_is_shown_by_an_exhibit() {
    let all: Vec<Exhibit> = exhibit::ids().iter().map(|id| load(id)).collect();
    let mut missing = Vec::new();
    for (system, shows) in SYSTEMS {
        let shown: Vec<&str> = all.iter().filter(|exhibit| shows(exhibit)).map(|exhibit| exhibit.id.as_str()).collect();
        println!("{system}: {}", shown.join(", "));
        if shown.is_empty() {
            missing.push(*system);
        }
    }
    assert!(missing.is_empty(), "no exhibit shows: {}", missing.join(", "));
}

#[test]
fn each_small_exhibit_shows_what_its_label_says() {
    let proof = [
        ("blown-together", "self-assembly in the course of it"),
        ("blown-together", "event trigger"),
        ("blown-together", "ramp"),
        ("loose-nail", "ball joint minus an element"),
        ("loose-nail", "periodic window"),
        ("universal-joint", "universal joint"),
        ("moving-path", "point on a moving path"),
        ("axis-wheel", "transition between axes"),
        ("breaking-chain", "breaking at a limit"),
        ("windmill", "windmill joint"),
        ("gear-train", "gear to weight"),
        ("terry-clock", "teeth that touch"),
        ("terry-clock", "line"),
        ("breath-clock", "ratchet"),
        ("strikers", "weld"),
        ("strikers", "spring and damper, angular"),
        ("marionette", "taken by the hand"),
        ("billiards", "rolling and sliding balls"),
        ("cart", "tyres that grip and drift"),
        ("pennant", "cloth that shears and bends"),
        ("scratch-board", "scratching wood"),
        ("hang-it", "point on plane"),
        ("windy-corner", "fan"),
        ("chains", "body that follows a path"),
        ("steel-fish", "plates that ring"),
        ("wind-chimes", "a tube that rings"),
    ];
    for (id, system) in proof {
        let (_, shows) = SYSTEMS.iter().find(|(name, _)| *name == system).unwrap_or_else(|| panic!("no {system}"));
        assert!(shows(&load(id)), "{id} does not show: {system}");
    }
}
