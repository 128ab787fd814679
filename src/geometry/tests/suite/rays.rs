//! Lines of sight and first triangles by the hierarchies, against the same by every triangle.

use soffio_geometry::TriangleMesh;
use soffio_geometry::rays::{Hint, Occluders, SightLine};
use soffio_math::noise::Random;
use soffio_math::{DVec3, PI, Pose, rotation, sincos};

/// Steps in which parts move, and bundles that look in each.
const STEPS: usize = 12;
const BUNDLES: usize = 40;

fn any(random: &mut Random) -> DVec3 {
    DVec3::new(random.signed(), random.signed(), random.signed())
}

/// A strip bent round the y axis, of `2 n` triangles.
fn bent(n: usize) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for i in 0..=n {
        let (s, c) = sincos(PI * (i as f64 / n as f64 - 0.5));
        mesh.positions.extend([-0.02, 0.02].map(|y| DVec3::new(0.03 * s, y, 0.03 * c)));
    }
    let strip = (0..n as u32).flat_map(|i| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]]);
    mesh.triangles = strip.collect();
    mesh
}

/// Parts of one to many triangles; the last one stands still.
fn parts(count: usize) -> Occluders {
    let meshes: Vec<TriangleMesh> = (0..count).map(|index| bent(1 + index % 7 * (index % 3 + 1))).collect();
    Occluders::new(meshes.iter().enumerate().map(|(body, mesh)| ((body + 1 < count).then_some(body), mesh)))
}

/// Moves bodies apart as time goes on, so that the tree of boxes is built again on the way.
fn scatter(occluders: &mut Occluders, random: &mut Random, count: usize, spread: f64) {
    let poses: Vec<Pose> =
        (0..count).map(|_| Pose { rotation: rotation(3.0 * any(random)), position: spread * any(random) }).collect();
    occluders.refit(|body| poses[body]);
}

/// Lines that begin close to each other and go to one place, or one way.
fn bundle(random: &mut Random, spread: f64, hints: &[Hint]) -> Vec<SightLine> {
    let (middle, to) = (spread * any(random), spread * any(random));
    let axis = DVec3::AXES[(3.0 * random.unit()) as usize];
    let way = [any(random).normalize(), axis][usize::from(random.unit() < 0.3)];
    let parallel = random.unit() < 0.5;
    let count = 1 + (50.0 * random.unit()) as usize;
    let any_hint = |random: &mut Random| match hints.len() {
        0 => Hint::default(),
        n => hints[(n as f64 * random.unit()) as usize],
    };
    (0..count)
        .map(|_| {
            let origin = middle + 0.05 * any(random);
            let (direction, far) =
                if parallel { (way, 50.0) } else { ((to - origin).normalize(), to.distance(origin)) };
            SightLine { origin, direction, far, past: None, hint: any_hint(random) }
        })
        .collect()
}

#[test]
fn lines_of_sight_end_where_some_triangle_stands() {
    for (seed, count) in [(1, 1), (2, 3), (3, 17), (4, 200)] {
        let mut random = Random::new(seed);
        let mut occluders = parts(count);
        let (mut hints, mut blocked, mut open) = (Vec::new(), 0, 0);
        for step in 0..STEPS {
            let spread = 0.03 + 0.03 * step as f64;
            scatter(&mut occluders, &mut random, count, spread);
            for _ in 0..BUNDLES {
                // Hints of other lines and of parts that have moved on: they must mislead nobody.
                let mut lines = bundle(&mut random, spread, &hints);
                occluders.look(&mut lines);
                for line in &lines {
                    let expected = occluders.block_by_each(line.origin, line.direction, line.far);
                    assert_eq!(!line.hint.is_open(), expected, "seed {seed}, step {step}: {line:?}");
                    *if expected { &mut blocked } else { &mut open } += 1;
                }
                hints.extend(lines.iter().map(|line| line.hint).take(4));
            }
        }
        assert!(blocked > 100 && open > 100, "{count} parts: {blocked} blocked, {open} open");
    }
}

#[test]
fn the_first_triangle_is_the_nearest_of_all() {
    for (seed, count) in [(5, 1), (6, 30), (7, 200)] {
        let mut random = Random::new(seed);
        let mut occluders = parts(count);
        let mut met = 0;
        for step in 0..STEPS {
            let spread = 0.03 + 0.03 * step as f64;
            scatter(&mut occluders, &mut random, count, spread);
            for _ in 0..BUNDLES {
                let origin = spread * any(&mut random);
                let direction = (spread * any(&mut random) - origin).normalize();
                let found = occluders.first(origin, direction);
                assert_eq!(
                    found,
                    occluders.first_by_each(origin, direction),
                    "seed {seed}: {origin} along {direction}"
                );
                met += usize::from(found.is_some());
            }
        }
        assert!(met > 20, "{count} parts: {met} met");
    }
}

#[test]
fn a_line_passes_what_it_is_told_to_pass() {
    let mut occluders = parts(3);
    occluders.refit(|body| Pose { position: DVec3::Z * body as f64, ..Pose::default() });
    // Down the z axis through part 1 at 1 m, part 0 at the origin, and part 2, which stands still there too.
    let look = |from: f64, far: f64, past: Option<usize>| {
        let mut line =
            [SightLine { origin: DVec3::Z * from, direction: DVec3::NEG_Z, far, past, hint: Hint::default() }];
        occluders.look(&mut line);
        line[0].hint.is_open()
    };
    assert!(!look(1.5, 1.0, None), "part 1 is in the way");
    assert!(look(1.5, 1.0, Some(1)), "and passed");
    assert!(!look(1.5, 1.0, Some(0)), "which another is not");
    assert!(!look(1.5, 2.0, Some(1)), "nor what stands behind it");
}
