//! Chimes, cradles and mobiles that hang and collide.

use soffio_math::noise::Random;
use soffio_math::{DVec3, PI, rotation};
use soffio_offline::scene::{BodyState, PhysicsScene, ShapeAxis};

use crate::builder::{Builder, STEEL, ball, capsule};

/// Rods that hang 3 cm apart by ball joints over their tops; one of four is pushed.
pub fn chimes([across, deep]: [usize; 2], seed: u64) -> PhysicsScene {
    const PITCH: f64 = 0.03;
    const RADIUS: f64 = 0.005;
    const HALF: f64 = 0.1;
    const CORD: f64 = 0.05;
    let name = format!("chimes_{}", across * deep);
    let mut builder = Builder::new(&name, "rods that hang 3 cm apart, some pushed", 10.0).colliding(0.2, 0.6);
    let mut random = Random::new(seed);
    for i in 0..across * deep {
        let nail = PITCH * DVec3::new((i % across) as f64, 0.0, (i / across) as f64);
        let arm = DVec3::Y * (CORD + HALF);
        let pushed = random.unit() < 0.25;
        let spin = DVec3::new(random.signed(), 0.0, random.signed()) * if pushed { 3.0 } else { 0.0 };
        let state =
            BodyState { position: nail - arm, velocity: -spin.cross(arm), angular_velocity: spin, ..BodyState::WORLD };
        let rod = builder.body(capsule(RADIUS, HALF - RADIUS, ShapeAxis::Y), STEEL, state);
        builder.spherical(None, rod, nail);
    }
    builder.finish(-(CORD + HALF))
}

/// Newton's cradle: balls on pairs of cords, which let each swing in one plane; the first is lifted by 40 degrees.
pub fn cradle(balls: usize, gap: f64) -> PhysicsScene {
    const RADIUS: f64 = 0.02;
    const CORD: f64 = 0.3;
    const LIFTED: f64 = 40.0 * PI / 180.0;
    let name = format!("cradle_{balls}_gap_{:.1}mm", gap * 1e3);
    let mut builder =
        Builder::new(&name, "Newton's cradle, the first ball lifted by 40 degrees", 10.0).colliding(0.0, 1.0);
    for i in 0..balls {
        let nail = DVec3::X * (2.0 * RADIUS + gap) * i as f64;
        let turn = rotation(DVec3::Z * if i == 0 { -LIFTED } else { 0.0 });
        let position = nail - turn * (DVec3::Y * CORD);
        let index = builder.body(ball(RADIUS), STEEL, BodyState { position, rotation: turn, ..BodyState::WORLD });
        builder.hinge(None, index, nail, None);
    }
    builder.finish(-CORD)
}
