//! What should stand still.

use soffio_math::DVec3;
use soffio_offline::scene::PhysicsScene;

use crate::builder::{Builder, WOOD, at, cuboid};

/// Wood on wood.
const FRICTION: f64 = 0.5;
/// Half the edge of a cube, m.
const HALF: f64 = 0.05;
/// Simulated time, s.
const DURATION: f64 = 10.0;

fn wood(name: &str, about: &str) -> Builder {
    Builder::new(name, about, DURATION).colliding(FRICTION, 0.0).floor()
}

/// `n` cubes of 0.1 m on each other.
pub fn tower(n: usize) -> PhysicsScene {
    let mut builder = wood(&format!("tower_{n}"), "wooden cubes of 0.1 m on each other");
    for i in 0..n {
        builder.body(cuboid(DVec3::splat(HALF)), WOOD, at(DVec3::Y * (2 * i + 1) as f64 * HALF));
    }
    builder.finish(0.0)
}

/// Cubes of 0.1 m in rows on a floor, `gap` apart.
pub fn floor(name: &str, [across, deep]: [usize; 2], gap: f64) -> PhysicsScene {
    let mut builder = wood(name, "wooden cubes of 0.1 m side by side on a floor: four points each");
    let pitch = 2.0 * HALF + gap;
    for i in 0..across * deep {
        let place = DVec3::new((i % across) as f64 * pitch, HALF, (i / across) as f64 * pitch);
        builder.body(cuboid(DVec3::splat(HALF)), WOOD, at(place));
    }
    builder.finish(0.0)
}

/// Rows of cubes, each one shorter than the row below.
pub fn pyramid(base: usize) -> PhysicsScene {
    let mut builder = wood(&format!("pyramid_{base}"), "rows of wooden cubes, each on two of the row below");
    for row in 0..base {
        for i in 0..base - row {
            let place = DVec3::new((2 * i + row) as f64 * HALF * 1.01, (2 * row + 1) as f64 * HALF, 0.0);
            builder.body(cuboid(DVec3::splat(HALF)), WOOD, at(place));
        }
    }
    builder.finish(0.0)
}

/// Courses of bricks in running bond, each a little farther over the edge of the course below.
pub fn leaning_wall(courses: usize, bricks: usize) -> PhysicsScene {
    /// Half a brick, m, and how far a course stands over, m.
    const BRICK: DVec3 = DVec3::new(0.12, 0.03, 0.055);
    const LEAN: f64 = 4e-3;
    let name = format!("leaning_wall_{courses}_{bricks}");
    let mut builder = wood(&name, "courses of bricks, each 4 mm over the edge of the one below");
    for course in 0..courses {
        let bond = if course % 2 == 1 { BRICK.x } else { 0.0 };
        for i in 0..bricks {
            let x = 2.005 * BRICK.x * i as f64 + bond;
            let place = DVec3::new(x, (2 * course + 1) as f64 * BRICK.y, LEAN * course as f64);
            builder.body(cuboid(BRICK), 3.0 * WOOD, at(place));
        }
    }
    builder.finish(0.0)
}
