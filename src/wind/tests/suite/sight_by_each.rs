//! What patches see of the breath and feel of every other wind, against lines of sight that ask every triangle.

use soffio_geometry::TriangleMesh;
use soffio_geometry::bodies::RigidBody;
use soffio_math::noise::Random;
use soffio_math::{DVec3, rotation};
use soffio_wind::force::{Blown, Sample, WindField};
use soffio_wind::weather::{Rhythm, Wind, WindKind};
use soffio_wind::{Shelter, Surface, SurfaceShape};

use super::bodies::*;

/// As the wind has it: lines start so far off their face, and what comes from afar comes from here, m.
const START: f64 = 1e-4;
const FAR: f64 = 50.0;
const STEPS: usize = 20;

/// How a surface takes hold of the wind.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Solid,
    Sheet,
    Wire,
}

/// A shallow bowl: what lies before its inside is its own rim, 12 mm high.
fn bowl() -> TriangleMesh {
    let mut mesh = ball(0.04, 8);
    mesh.triangles.retain(|triangle| triangle.iter().all(|&i| mesh.positions[i as usize].z < 1e-9));
    mesh.positions.iter_mut().for_each(|corner| corner.z *= 0.3);
    mesh
}

/// Balls, bowls, plates and wires, one a body, with as many patches each; wires have one.
fn surfaces(count: usize, patches: usize) -> (Vec<Surface>, Vec<Kind>) {
    let surface = |index: usize| match index % 4 {
        0 => (solid(index, ball(0.03, 6), patches), Kind::Solid),
        1 => (sheet(index, bowl(), patches), Kind::Sheet),
        2 => (sheet(index, face(0.08), patches), Kind::Sheet),
        _ => {
            let shape = SurfaceShape::Wire { points: vec![DVec3::ZERO, DVec3::X * 0.02], radius: 1e-3 };
            (Surface { shape, ..solid(index, face(1.0), 1) }, Kind::Wire)
        }
    };
    (0..count).map(surface).unzip()
}

/// Where bodies are at first, and how they move from step to step.
fn moving(seed: u64, count: usize) -> impl Fn(usize) -> Vec<RigidBody> {
    let mut random = Random::new(seed);
    let starts: Vec<[DVec3; 3]> =
        (0..count).map(|_| [0.12, 3.0, 4e-3].map(|size| any_vector(&mut random, size))).collect();
    move |step| {
        let place = |&[place, turn, way]: &[DVec3; 3]| {
            turned(place + step as f64 * way, rotation(turn + step as f64 * 5.0 * way))
        };
        starts.iter().map(place).collect()
    }
}

/// Does a patch face this way (unit, or to a place) and see as far, asking every triangle?
fn sees(field: &WindField, sample: &Sample, kind: Kind, from: Result<DVec3, DVec3>) -> bool {
    let toward = from.map_or_else(|way| way, |place| place - sample.point);
    let facing = sample.axis.dot(toward);
    let lift = if kind == Kind::Wire { 0.0 } else { START * facing.signum() };
    let start = sample.point + lift * sample.axis;
    let (direction, far) =
        from.map_or_else(|way| (way, FAR), |place| ((place - start).normalize(), place.distance(start)));
    (kind != Kind::Solid || facing > 0.0) && !field.occluders().block_by_each(start, direction, far)
}

#[test]
fn patches_see_the_lips_past_what_no_triangle_hides() {
    const SEED: u64 = 41;
    let (surfaces, kinds) = surfaces(40, 60);
    let mut field = field(&surfaces, 40);
    let bodies = moving(SEED, 40);
    let breath = breath(8.9);
    let (mut seen, mut hidden) = (0, 0);
    for step in 0..STEPS {
        for sample in field.samples(&bodies(step), &breath) {
            let expected = sees(&field, &sample, kinds[sample.surface], Ok(breath.origin(sample.point)));
            assert_eq!(sample.seen, expected, "seed {SEED}, step {step}: {sample:?}");
            *if expected { &mut seen } else { &mut hidden } += 1;
        }
    }
    assert!(seen > 5000 && hidden > 5000, "{seen} seen, {hidden} hidden");
}

#[test]
fn a_patch_feels_each_wind_that_no_triangle_hides() {
    const SEED: u64 = 42;
    let at = DVec3::new(0.1, 0.5, 0.0);
    let kinds_of_wind = [
        WindKind::Fan { at, direction: -at.normalize(), diameter: 0.05 },
        WindKind::Draught { direction: DVec3::NEG_Y, place: None },
        WindKind::Draught { direction: DVec3::NEG_X, place: Some((DVec3::X * 0.02, 0.2)) },
    ];
    let (surfaces, kinds) = surfaces(120, 1);
    let shelters = Shelter::of(&surfaces);
    let blown = Blown { breath: breath(8.9), front: None, gain: 1.0 };
    for kind in kinds_of_wind.map(Some).into_iter().chain([None]) {
        let wind = kind.map(|kind| Wind { name: "wind".into(), kind, speed: 2.0.into(), rhythm: Rhythm::Even });
        let mut field = WindField::new(&surfaces, &shelters, wind.as_slice(), 120, SEED);
        let bodies = moving(SEED, 120);
        let blown = kind.is_none().then_some(&blown);
        let (mut felt, mut still) = (0, 0);
        for step in 0..STEPS {
            let mut out = vec![[0.0; 6]; 120];
            field.push(&bodies(step), 0.0, blown, &mut out);
            for sample in field.samples(&bodies(step), &breath(8.9)) {
                let from = match kind {
                    Some(WindKind::Fan { at, .. }) => Ok(at),
                    Some(WindKind::Draught { direction, .. }) => Err(-direction),
                    _ => Ok(breath(8.9).origin(sample.point)),
                };
                let blows = field.streams(blown, sample.point) != DVec3::ZERO;
                let expected = blows && sees(&field, &sample, kinds[sample.surface], from);
                let feels = out[sample.surface] != [0.0; 6];
                assert_eq!(feels, expected, "seed {SEED}, {kind:?}, step {step}: {sample:?}");
                *if expected { &mut felt } else { &mut still } += 1;
            }
        }
        assert!(felt > 100 && still > 100, "{kind:?}: {felt} felt, {still} not");
    }
}

#[test]
fn a_wire_through_the_lips_is_seen_patch_by_patch() {
    let breath = breath(8.9);
    // From before the lips and a plate 30 mm before them to behind them, where a breath comes from every point itself.
    let points = vec![DVec3::Z * 0.35, DVec3::Z * 0.55];
    let wire = Surface { shape: SurfaceShape::Wire { points, radius: 1e-3 }, ..solid(0, face(1.0), 1) };
    let mut field = field(&[wire, sheet(1, face(0.05), 1)], 2);
    let bodies = [body(DVec3::ZERO), body(DVec3::new(0.004, 0.001, 0.47))];
    let samples = field.samples(&bodies, &breath);
    let seen: Vec<bool> = samples.iter().filter(|sample| sample.surface == 0).map(|sample| sample.seen).collect();
    let expected: Vec<bool> = samples[..seen.len()].iter().map(|sample| sample.point.z > 0.47).collect();
    assert_eq!(seen, expected);
}
