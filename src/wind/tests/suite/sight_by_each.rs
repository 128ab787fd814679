//! Visibility of the breath and of each other wind from the patches, against rays that test every triangle.

use soffio_geometry::TriangleMesh;
use soffio_geometry::bodies::RigidBody;
use soffio_math::noise::Random;
use soffio_math::{DVec3, rotation};
use soffio_wind::ambient::{Inlet, Modulation, Wind, WindKind};
use soffio_wind::force::{BreathJet, PatchSample, TURBULENCE, WindField};
use soffio_wind::{Shelter, Surface, SurfaceShape};

use super::bodies::*;

/// As in `visibility.rs`: offset of a ray's start from its face, and length of rays without an end, m.
const START: f64 = 1e-4;
const FAR: f64 = 50.0;
const STEPS: usize = 20;

/// Which sides of a surface the wind acts on.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Solid,
    Sheet,
    Wire,
}

/// A shallow bowl, whose rim, 12 mm high, shelters its inside.
fn bowl() -> TriangleMesh {
    let mut mesh = ball(0.04, 8);
    mesh.triangles.retain(|triangle| triangle.iter().all(|&i| mesh.positions[i as usize].z < 1e-9));
    mesh.positions.iter_mut().for_each(|corner| corner.z *= 0.3);
    mesh
}

/// Balls, bowls and plates with `patches` patches each, and wires with one; one surface a body.
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

/// Bodies at each step of a straight motion.
fn moving(seed: u64, count: usize) -> impl Fn(usize) -> Vec<RigidBody> {
    let mut random = Random::new(seed);
    let starts: Vec<[DVec3; 3]> =
        (0..count).map(|_| [0.12, 3.0, 4e-3].map(|size| any_vector(&mut random, size))).collect();
    move |step| {
        let place = |&[place, turn, velocity]: &[DVec3; 3]| {
            turned(place + step as f64 * velocity, rotation(turn + step as f64 * 5.0 * velocity))
        };
        starts.iter().map(place).collect()
    }
}

/// Whether a patch faces an origin (a direction as `Err`, a point as `Ok`) and no triangle blocks its ray there.
fn sees(field: &WindField, sample: &PatchSample, kind: Kind, from: Result<DVec3, DVec3>) -> bool {
    let toward = from.map_or_else(|direction| direction, |place| place - sample.point);
    let facing = sample.axis.dot(toward);
    let lift = if kind == Kind::Wire { 0.0 } else { START * facing.signum() };
    let start = sample.point + lift * sample.axis;
    let (direction, far) =
        from.map_or_else(|direction| (direction, FAR), |place| ((place - start).normalize(), place.distance(start)));
    (kind != Kind::Solid || facing > 0.0) && !field.occluders().block_by_each(start, direction, far)
}

#[test]
fn patches_see_the_lips_where_no_triangle_blocks() {
    const SEED: u64 = 41;
    let (surfaces, kinds) = surfaces(40, 60);
    let mut field = field(&surfaces, 40);
    let bodies = moving(SEED, 40);
    let breath = breath(8.9);
    let (mut seen, mut hidden) = (0, 0);
    for step in 0..STEPS {
        for sample in field.sample_patches(&bodies(step), &breath) {
            let expected = sees(&field, &sample, kinds[sample.surface], Ok(breath.origin(sample.point)));
            assert_eq!(sample.visible, expected, "seed {SEED}, step {step}: {sample:?}");
            *if expected { &mut seen } else { &mut hidden } += 1;
        }
    }
    assert!(seen > 5000 && hidden > 5000, "{seen} seen, {hidden} hidden");
}

#[test]
fn each_wind_acts_on_the_patches_that_no_triangle_hides() {
    const SEED: u64 = 42;
    let at = DVec3::new(0.1, 0.5, 0.0);
    let wind_kinds = [
        WindKind::Fan { at, direction: -at.normalize(), diameter: 0.05 },
        WindKind::Draught { direction: DVec3::NEG_Y, inlet: None },
        WindKind::Draught { direction: DVec3::NEG_X, inlet: Some(Inlet { center: DVec3::X * 0.02, width: 0.2 }) },
    ];
    let (surfaces, kinds) = surfaces(120, 1);
    let shelters = Shelter::of(&surfaces);
    let jet = BreathJet { breath: breath(8.9), jet_front: None, gain: 1.0, turbulence: TURBULENCE };
    for kind in wind_kinds.map(Some).into_iter().chain([None]) {
        let wind =
            kind.map(|kind| Wind { name: "wind".into(), kind, speed: 2.0.into(), modulation: Modulation::Steady });
        let mut field = WindField::new(&surfaces, &shelters, wind.as_slice(), 120, SEED);
        let bodies = moving(SEED, 120);
        let jet = kind.is_none().then_some(&jet);
        let (mut pushed, mut unmoved) = (0, 0);
        for step in 0..STEPS {
            let mut out = vec![[0.0; 6]; 120];
            field.apply_forces(&bodies(step), 0.0, jet, &mut out);
            for sample in field.sample_patches(&bodies(step), &breath(8.9)) {
                let from = match kind {
                    Some(WindKind::Fan { at, .. }) => Ok(at),
                    Some(WindKind::Draught { direction, .. }) => Err(-direction),
                    _ => Ok(breath(8.9).origin(sample.point)),
                };
                let blows = field.directed_velocity(jet, sample.point) != DVec3::ZERO;
                let expected = blows && sees(&field, &sample, kinds[sample.surface], from);
                let is_pushed = out[sample.surface] != [0.0; 6];
                assert_eq!(is_pushed, expected, "seed {SEED}, {kind:?}, step {step}: {sample:?}");
                *if expected { &mut pushed } else { &mut unmoved } += 1;
            }
        }
        assert!(pushed > 100 && unmoved > 100, "{kind:?}: {pushed} pushed, {unmoved} not");
    }
}

#[test]
fn a_wire_through_the_lips_is_seen_patch_by_patch() {
    let breath = breath(8.9);
    // From a plate 30 mm before the lips to a point behind them, where each patch is its own origin.
    let points = vec![DVec3::Z * 0.35, DVec3::Z * 0.55];
    let wire = Surface { shape: SurfaceShape::Wire { points, radius: 1e-3 }, ..solid(0, face(1.0), 1) };
    let mut field = field(&[wire, sheet(1, face(0.05), 1)], 2);
    let bodies = [body(DVec3::ZERO), body(DVec3::new(0.004, 0.001, 0.47))];
    let samples = field.sample_patches(&bodies, &breath);
    let seen: Vec<bool> = samples.iter().filter(|sample| sample.surface == 0).map(|sample| sample.visible).collect();
    let expected: Vec<bool> = samples[..seen.len()].iter().map(|sample| sample.point.z > 0.47).collect();
    assert_eq!(seen, expected);
}
