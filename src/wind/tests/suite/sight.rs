//! Visibility of the lips: rays against the source's depth buffer and against every triangle; partial shelter.

use std::cell::Cell;

use assert_no_alloc::assert_no_alloc;
use soffio_geometry::TriangleMesh;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::noise::Random;
use soffio_math::spatial::linear;
use soffio_wind::ambient::{Modulation, Wind, WindKind};
use soffio_wind::force::WindField;
use soffio_wind::{Shelter, Surface};

use super::bodies::*;
use super::depth_buffer::IdBuffer;

/// Balls and plates, one a body, at random positions in the breath's cone.
struct Crowd {
    surfaces: Vec<Surface>,
    meshes: Vec<TriangleMesh>,
    bodies: Vec<RigidBody>,
}

fn crowd(seed: u64) -> Crowd {
    let mut random = Random::new(seed);
    let mut crowd = Crowd { surfaces: Vec::new(), meshes: Vec::new(), bodies: Vec::new() };
    for index in 0..40 {
        let mesh = if index % 2 == 0 { ball(random.range(0.01, 0.03), 6) } else { face(random.range(0.02, 0.08)) };
        crowd.surfaces.push(if index % 2 == 0 {
            solid(index, mesh.clone(), 100)
        } else {
            sheet(index, mesh.clone(), 100)
        });
        crowd.meshes.push(mesh);
        crowd.bodies.push(body(DVec3::ZERO));
    }
    scatter(&mut crowd, &mut random);
    crowd
}

/// Moves every body to a random pose.
fn scatter(crowd: &mut Crowd, random: &mut Random) {
    for place in &mut crowd.bodies {
        *place = turned(DVec3::new(0.1, 0.1, 0.2) * any_vector(random, 1.0), any_turn(random));
    }
}

/// Number of patches on which rays and an ID buffer of `pixels` disagree, and the visible area by each, m².
fn compared(crowd: &Crowd, pixels: usize) -> (usize, [f64; 2]) {
    let breath = breath(8.9);
    let mut buffer = IdBuffer::new(&breath, pixels, 0.45);
    for (id, (mesh, body)) in crowd.meshes.iter().zip(&crowd.bodies).enumerate() {
        buffer.draw(id as u32, mesh, &body.pose());
    }
    let samples = field(&crowd.surfaces, crowd.bodies.len()).sample_patches(&crowd.bodies, &breath);
    let (mut differ, mut seen, mut hidden, mut areas) = (0, 0, 0, [0.0; 2]);
    for sample in &samples {
        // The buffer shows the same body on a solid's lee side, which its front hides.
        let faces = sample.surface % 2 == 1 || sample.axis.dot(breath.vertex() - sample.point) > 0.0;
        let drawn = faces && buffer.seen_at(sample.point) == Some(sample.surface as u32);
        differ += usize::from(drawn != sample.visible);
        seen += usize::from(sample.visible);
        hidden += usize::from(faces && !sample.visible);
        areas[0] += f64::from(u8::from(sample.visible)) * sample.area;
        areas[1] += f64::from(u8::from(drawn)) * sample.area;
    }
    println!("{pixels} pixels: {seen} patches seen, {hidden} sheltered, {differ} of {} differ", samples.len());
    assert!(seen > 500 && hidden > 300, "{seen} seen, {hidden} sheltered");
    (differ, areas)
}

#[test]
fn rays_and_the_depth_buffer_see_the_same() {
    // A patch within half a pixel of an outline may be seen by one and not by the other: that is the sampling error, and
    // it goes with the pixel's width w. Half a pixel along the outline of a disc of radius r is w/r of its area, and twice
    // that where something in front of it has an outline there too. The picture is 0.9 m wide at a metre, the parts lie at
    // 0.51 m from the vertex, so w = 0.9·0.51/2048 = 0.224 mm; they are balls of 20 mm and plates of 50 mm in the mean, so
    // r = 22.5 mm: 2 w/r = 0.0199.
    const SAMPLING: f64 = 0.0199;
    for seed in [31, 32, 33] {
        let crowd = crowd(seed);
        let (coarse, _) = compared(&crowd, 256);
        let (fine, [by_rays, by_buffer]) = compared(&crowd, 2048);
        assert!((by_rays / by_buffer - 1.0).abs() < SAMPLING, "seed {seed}: {by_rays} and {by_buffer} m²");
        assert!(
            2 * fine < coarse,
            "seed {seed}: {fine} patches differ, and {coarse} where pixels are eight times as wide"
        );
    }
}

#[test]
fn the_hierarchies_find_every_blocking_triangle() {
    const SEED: u64 = 34;
    let mut random = Random::new(SEED);
    let mut crowd = crowd(SEED);
    let mut field = field(&crowd.surfaces, crowd.bodies.len());
    let hint = Cell::default();
    let (mut blocked, mut open) = (0, 0);
    for round in 0..20 {
        // Refitted, never rebuilt: parts move to any pose.
        scatter(&mut crowd, &mut random);
        field.sample_patches(&crowd.bodies, &breath(8.9));
        for _ in 0..200 {
            let origin = any_vector(&mut random, 0.15);
            let toward = any_vector(&mut random, 1.0);
            let (direction, far) = (toward.normalize(), random.range(0.01, 1.0));
            // The hint is that of another ray and must not change the result.
            let found = field.occluders().block(origin, direction, far, &hint);
            let expected = field.occluders().block_by_each(origin, direction, far);
            assert_eq!(found, expected, "seed {SEED}, round {round}: from {origin} along {direction} for {far} m");
            blocked += usize::from(found);
            open += usize::from(!found);
        }
    }
    assert!(blocked > 200 && open > 200, "{blocked} blocked, {open} open");
}

/// Force on a plate behind a screen over that on an open one, in a uniform wind.
fn sheltered_share(screen: DVec3, patches: usize) -> f64 {
    let surfaces = [sheet(0, face(0.1), patches), sheet(1, face(1.0), 16)];
    let wind = Wind {
        name: "draught".into(),
        kind: WindKind::Draught { direction: DVec3::NEG_Z, inlet: None },
        speed: 2.0.into(),
        modulation: Modulation::Steady,
    };
    let mut field = WindField::new(&surfaces, &Shelter::of(&surfaces), &[wind], 2, 1);
    let mut force = |screen: DVec3| {
        let mut out = [[0.0; 6]; 2];
        field.apply_forces(&[body(DVec3::ZERO), body(screen)], 0.0, None, &mut out);
        linear(&out[0]).length()
    };
    force(screen) / force(DVec3::new(9.0, 0.0, 0.1))
}

#[test]
fn a_half_covered_plate_feels_half() {
    // A screen of a metre whose edge runs over the plate at a share of its width. A low-discrepancy set of n points is
    // off by less than 2/√n; random points would be off by half that on average.
    for patches in [64, 256, 1024] {
        for covered in [0.0, 0.25, 0.5, 0.75, 1.0] {
            let edge = -0.05 + 0.1 * covered;
            let left = sheltered_share(DVec3::new(edge - 0.5, 0.0, 0.1), patches);
            let sampling = 2.0 / (patches as f64).sqrt();
            let exact = covered == 0.0 || covered == 1.0;
            let off = (left - (1.0 - covered)).abs();
            assert!(off < if exact { 1e-12 } else { sampling }, "{left} left of {covered} covered, {patches} patches");
        }
    }
}

#[test]
fn a_breath_is_sheltered_like_any_wind() {
    let surfaces = [sheet(0, face(0.1), 400), sheet(1, face(0.4), 16)];
    let mut field = field(&surfaces, 2);
    let mut force = |screen: DVec3| {
        let mut out = [[0.0; 6]; 2];
        field.apply_forces(&[body(DVec3::ZERO), body(screen)], 0.0, Some(&jet(8.9)), &mut out);
        linear(&out[0]).length()
    };
    let open = force(DVec3::new(9.0, 0.0, 0.1));
    let half = force(DVec3::new(-0.2, 0.0, 0.1));
    assert!(open > 1e-4, "an open plate is pushed: {open} N");
    assert_eq!(force(DVec3::new(0.0, 0.0, 0.1)), 0.0, "a sheltered one is not");
    // The two halves differ by their gusts.
    assert!((half / open - 0.5).abs() < 0.15, "{half} N of {open} N");
}

#[test]
fn objects_behind_the_lips_give_no_shelter() {
    let breath = jet(8.9).breath;
    let screens = Shelter { body: None, mesh: cuboid(DVec3::new(0.4, 0.4, 1e-3)) };
    let screen = |behind: f64| {
        let at = breath.mouth - behind * breath.direction;
        let mut mesh = screens.mesh.clone();
        mesh.positions.iter_mut().for_each(|corner| *corner += at);
        [Shelter { body: None, mesh }]
    };
    let force = |shelters: &[Shelter]| {
        let mut out = [[0.0; 6]];
        let mut field = WindField::new(&[sheet(0, face(0.1), 64)], shelters, &[], 1, 1);
        field.apply_forces(&[body(DVec3::ZERO)], 0.0, Some(&jet(8.9)), &mut out);
        linear(&out[0])
    };
    let open = force(&[]);
    assert!(open.length() > 0.0);
    for behind in [0.1, 0.5, 0.9].map(|share| share * breath.vertex_distance()) {
        assert_eq!(force(&screen(behind)), open, "{behind} m behind the lips");
        assert_eq!(force(&screen(-behind)), DVec3::ZERO, "{behind} m before them");
    }
}

#[test]
fn fixed_shelters_without_a_surface_shelter_too() {
    let plate = sheet(0, face(0.1), 64);
    let post = Shelter { body: None, mesh: cuboid(DVec3::new(0.4, 0.4, 0.02)) };
    let force = |shelters: &[Shelter]| {
        let mut out = [[0.0; 6]];
        let mut field = WindField::new(std::slice::from_ref(&plate), shelters, &[], 1, 1);
        field.apply_forces(&[body(DVec3::NEG_Z * 0.1)], 0.0, Some(&jet(8.9)), &mut out);
        linear(&out[0]).length()
    };
    assert!(force(&[]) > 0.0);
    assert_eq!(force(&[post]), 0.0);
}

/// The allocator that watches is that of `realtime.rs`; it acts in debug builds.
#[test]
fn apply_forces_does_not_allocate() {
    let crowd = crowd(35);
    let kind = WindKind::Fan { at: DVec3::Z, direction: DVec3::NEG_Z, diameter: 0.1 };
    let winds = [
        Wind { name: "fan".into(), kind, speed: 2.0.into(), modulation: Modulation::Steady },
        Wind {
            name: "room".into(),
            kind: WindKind::Turbulence { scale: 0.3, period: 4.0, seed: 1 },
            speed: 0.2.into(),
            modulation: Modulation::Gusty { strength: 0.5, period: 2.0, seed: 2 },
        },
    ];
    let mut field = WindField::new(&crowd.surfaces, &Shelter::of(&crowd.surfaces), &winds, 40, 1);
    let mut out = vec![[0.0; 6]; 40];
    for step in 0..10 {
        assert_no_alloc(|| field.apply_forces(&crowd.bodies, f64::from(step), Some(&jet(8.9)), &mut out));
    }
}
