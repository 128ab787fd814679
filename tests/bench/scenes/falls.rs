//! Bodies that fall and come to rest.

use soffio_math::noise::Random;
use soffio_math::{DQuat, DVec3, PI, cos, rotation, sin};
use soffio_offline::scene::{BodyState, PhysicsScene, ShapeAxis};

use crate::builder::{Builder, STEEL, WOOD, at, ball, capsule, cuboid, cylinder};

/// Any direction and angle.
fn turned(random: &mut Random) -> DQuat {
    rotation(PI * DVec3::new(random.signed(), random.signed(), random.signed()))
}

/// Cubes of 0.1 m dropped from random places.
pub fn pile(n: usize, seed: u64) -> PhysicsScene {
    let name = format!("pile_{n}");
    let mut builder =
        Builder::new(&name, "wooden cubes of 0.1 m that fall into a heap", 10.0).colliding(0.5, 0.0).floor();
    let mut random = Random::new(seed);
    for place in columns(n, 3, 0.22, &mut random) {
        let state = BodyState { rotation: turned(&mut random), ..at(place) };
        builder.body(cuboid(DVec3::splat(0.05)), WOOD, state);
    }
    builder.finish(0.0)
}

/// Places in layers of `across` by `across`, `pitch` m apart in all three directions, each moved aside by up to a tenth
/// of that.
fn columns(n: usize, across: usize, pitch: f64, random: &mut Random) -> Vec<DVec3> {
    let place = |i: usize| {
        let (x, z, layer) = (i % across, i / across % across, i / (across * across));
        pitch * DVec3::new(x as f64 + 0.1 * random.signed(), layer as f64 + 1.0, z as f64 + 0.1 * random.signed())
    };
    (0..n).map(place).collect()
}

/// Dominoes 0.05 m apart, the first tipped past its balance.
pub fn dominoes(n: usize) -> PhysicsScene {
    /// Half a domino, m: it falls by itself from a lean of atan(0.01/0.05), 11.3 degrees.
    const HALF: DVec3 = DVec3::new(0.01, 0.05, 0.025);
    const SPACING: f64 = 0.05;
    const TIPPED: f64 = 13.0 * PI / 180.0;
    let mut builder =
        Builder::new(&format!("dominoes_{n}"), "a row of dominoes, the first tipped", 5.0).colliding(0.3, 0.1).floor();
    for i in 0..n {
        let edge = DVec3::X * (SPACING * i as f64 + HALF.x);
        let lean = rotation(DVec3::Z * if i == 0 { -TIPPED } else { 0.0 });
        let centre = edge + lean * DVec3::new(-HALF.x, HALF.y, 0.0);
        builder.body(cuboid(HALF), 2.0 * WOOD, BodyState { rotation: lean, ..at(centre) });
    }
    builder.finish(0.0)
}

/// Balls of 1 cm that fall through rows of pegs in a narrow case.
pub fn pegs(n: usize, seed: u64) -> PhysicsScene {
    const RADIUS: f64 = 0.01;
    /// Half the case, m.
    const CASE: DVec3 = DVec3::new(0.2, 0.6, 0.03);
    const WALL: f64 = 0.01;
    const ROWS: usize = 6;
    const PITCH: f64 = 0.06;
    let mut builder = Builder::new(&format!("pegs_{n}"), "balls of 1 cm that fall through rows of pegs", 10.0)
        .colliding(0.3, 0.5)
        .floor();
    for side in [-1.0, 1.0] {
        let walls = [
            (DVec3::X * (CASE.x + WALL), DVec3::new(WALL, CASE.y, CASE.z + 2.0 * WALL)),
            (DVec3::Z * (CASE.z + WALL), DVec3::new(CASE.x + 2.0 * WALL, CASE.y, WALL)),
        ];
        for (place, half) in walls {
            builder.fixed(cuboid(half), side * place + DVec3::Y * CASE.y, DQuat::IDENTITY);
        }
    }
    let along_z = rotation(DVec3::X * (0.5 * PI));
    for row in 0..ROWS {
        let shift = if row % 2 == 1 { 0.5 } else { 0.0 };
        for i in 0..6 {
            let place = DVec3::new((i as f64 - 2.75 + shift) * PITCH, 0.25 + 0.05 * row as f64, 0.0);
            builder.fixed(cylinder(0.004, CASE.z), place, along_z);
        }
    }
    let mut random = Random::new(seed);
    for i in 0..n {
        let (column, layer) = (i % 10, i / 10);
        let aside = 0.3 * RADIUS * DVec3::new(random.signed(), 0.0, random.signed());
        let place = DVec3::new((column as f64 - 4.5) * 0.03, 0.6 + 0.03 * layer as f64, 0.0);
        builder.body(ball(RADIUS), STEEL, at(place + aside));
    }
    builder.finish(0.0)
}

/// Boxes, balls, cylinders and capsules dropped from random places between four walls.
pub fn heap(n: usize, seed: u64) -> PhysicsScene {
    let mut builder =
        Builder::new(&format!("heap_{n}"), "boxes, balls, cylinders and capsules that fall into a heap", 8.0)
            .colliding(0.4, 0.2)
            .floor();
    let mut random = Random::new(seed);
    for (i, place) in columns(n, 4, 0.18, &mut random).into_iter().enumerate() {
        let size = random.range(0.025, 0.04);
        let solid = match i % 4 {
            0 => cuboid(size * DVec3::new(1.0, random.range(0.5, 1.0), random.range(0.5, 1.0))),
            1 => ball(size),
            2 => cylinder(size, random.range(0.4, 1.2) * size),
            _ => capsule(0.6 * size, 0.7 * size, ShapeAxis::Y),
        };
        builder.body(solid, 2.0 * WOOD, BodyState { rotation: turned(&mut random), ..at(place) });
    }
    builder.finish(0.0)
}

/// A chain of capsules that hangs in the air and falls on a floor, end first.
pub fn chain(links: usize) -> PhysicsScene {
    const RADIUS: f64 = 0.008;
    const HALF: f64 = 0.02;
    let mut builder = Builder::new(&format!("falling_chain_{links}"), "a chain that falls on a floor, end first", 6.0)
        .colliding(0.4, 0.1)
        .floor();
    // A slight lean, so that it does not stand on its end.
    let turn = rotation(DVec3::Z * 0.05);
    let along = turn * DVec3::Y;
    let foot = DVec3::Y * 0.1;
    for i in 0..links {
        let centre = foot + (2 * i + 1) as f64 * HALF * along;
        let solid = capsule(RADIUS, HALF - RADIUS, ShapeAxis::Y);
        let link = builder.body(solid, STEEL, BodyState { rotation: turn, ..at(centre) });
        if let Some(below) = link.checked_sub(1) {
            builder.spherical(Some(below), link, foot + 2.0 * i as f64 * HALF * along);
        }
    }
    builder.finish(0.0)
}

/// A bowl of fixed boxes in rings, and balls that run down into it.
pub fn bowl(facets: usize, balls: usize, seed: u64) -> PhysicsScene {
    let mut builder = Builder::new(&format!("bowl_{facets}_{balls}"), "balls in a bowl made of boxes", 8.0)
        .colliding(0.3, 0.4)
        .floor();
    for (ring, (radius, height, lean)) in [(0.14, 0.03, 0.35), (0.25, 0.12, 0.85)].into_iter().enumerate() {
        for i in 0..facets {
            let angle = 2.0 * PI * (i as f64 + 0.5 * ring as f64) / facets as f64;
            let turn = rotation(DVec3::Y * -angle) * rotation(DVec3::Z * lean);
            let place = DVec3::new(radius * cos(angle), height, radius * sin(angle));
            builder.fixed(cuboid(DVec3::new(0.08, 0.005, 0.08)), place, turn);
        }
    }
    let mut random = Random::new(seed);
    for i in 0..balls {
        let angle = 2.0 * PI * i as f64 / balls as f64;
        let radius = random.range(0.012, 0.018);
        let place = DVec3::new(0.2 * cos(angle), 0.3 + 0.02 * random.unit(), 0.2 * sin(angle));
        builder.body(ball(radius), STEEL, at(place));
    }
    builder.finish(0.0)
}
