//! A small billiard table whose bed slopes towards its centre, and seven hollow balls that a breath can move.

use soffio_math::{DQuat, DVec2, DVec3, PI, Pose, cos, rotation, sin};

use soffio_authoring::glb::{Finish, Scene};
use soffio_authoring::piece::Piece;
use soffio_authoring::solid::{Solid, extrude, revolve, revolve_ring};
use soffio_authoring::stock_parts::{MM, WOOD, finishes, part, rod};

use crate::sloped_bed::SlopedBed;

/// Radius of a ball, m, as in the sidecar: that of table tennis, whose celluloid shell it has.
const RADIUS: f64 = 20.0 * MM;
/// Segments of a ball's outline: edges of 3.5 mm, chosen by eye.
const AROUND: usize = 36;
/// The bed between the cushions; its edge is high enough that balls roll back.
const BED: SlopedBed = SlopedBed { half: DVec2::new(240.0 * MM, 150.0 * MM), height: 64.0 * MM, rise: 3.0 * MM };
/// Balls, their stripes, and their start positions (x and z).
const BALLS: [([&str; 2], [f64; 2]); 7] = [
    (["Ball1", "Stripe1"], [-155.0, 55.0]),
    (["Ball2", "Stripe2"], [-70.0, -45.0]),
    (["Ball3", "Stripe3"], [20.0, 80.0]),
    (["Ball4", "Stripe4"], [5.0, 0.0]),
    (["Ball5", "Stripe5"], [115.0, -60.0]),
    (["Ball6", "Stripe6"], [55.0, -100.0]),
    (["Ball7", "Stripe7"], [175.0, 45.0]),
];
/// Planes of the sidecar: the four slopes of the bed and the four cushions.
const PLANES: [[&str; 2]; 4] = [
    ["BedLeft", "CushionLeft"],
    ["BedRight", "CushionRight"],
    ["BedBack", "CushionBack"],
    ["BedFront", "CushionFront"],
];

/// The model.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let stock_parts = finishes(&mut scene);
    let mut add =
        |name, color, roughness, finish| scene.finish(&Finish { name, color, metallic: 0.0, roughness, finish });
    let ivory = add("Ivory", [0.80, 0.72, 0.56], 0.22, Some("paint"));
    let cloth = add("Green cloth", [0.02, 0.16, 0.07], 0.95, Some("felt"));
    let rubber = add("Dark green cloth", [0.012, 0.10, 0.045], 0.9, Some("felt"));
    let (none, upright) = (DVec3::ZERO, DQuat::IDENTITY);
    let flat = rotation(-0.5 * PI * DVec3::X);
    let frame =
        |inner: f64, outer: f64, height: f64| extrude(&BED.rectangle(outer), &[BED.rectangle(inner)], height, 1.5 * MM);
    let leg = |x: f64, z: f64| DVec3::new(x * (BED.half.x + 20.0 * MM), 0.0, z * (BED.half.y + 20.0 * MM));
    let mut parts = vec![
        part("Bed", BED.solid(20.0 * MM), none, upright, WOOD, cloth),
        part("Cushions", frame(0.0, 14.0 * MM, 28.0 * MM), (BED.height + 14.0 * MM) * DVec3::Y, flat, WOOD, rubber),
        part(
            "Rails",
            frame(12.0 * MM, 46.0 * MM, 62.0 * MM),
            (BED.height + 3.0 * MM) * DVec3::Y,
            flat,
            WOOD,
            stock_parts.wood,
        ),
    ];
    for (name, x, z) in [("Leg1", -1.0, -1.0), ("Leg2", 1.0, -1.0), ("Leg3", -1.0, 1.0), ("Leg4", 1.0, 1.0)] {
        parts.push(part(name, rod(11.0 * MM, 0.0, BED.height - 26.0 * MM), leg(x, z), upright, WOOD, stock_parts.wood));
    }
    let table = Piece { name: "Table", parts, wires: Vec::new(), markers: Vec::new() };
    table.write(&mut scene, Pose::IDENTITY);

    BED.write_planes(&mut scene, PLANES);
    let colors = [
        stock_parts.red,
        stock_parts.blue,
        stock_parts.black,
        stock_parts.red,
        stock_parts.brass,
        stock_parts.blue,
        stock_parts.black,
    ];
    for (k, ((names, at), color)) in BALLS.into_iter().zip(colors).enumerate() {
        let ball = Piece {
            name: names[0],
            parts: vec![
                part(names[0], sphere(), none, upright, WOOD, ivory),
                part(names[1], stripe(), none, upright, WOOD, color),
            ],
            wires: Vec::new(),
            markers: Vec::new(),
        };
        let turn = rotation(DVec3::new(0.9 + 0.5 * k as f64, 0.7 * k as f64, 0.4));
        ball.write(&mut scene, Pose { rotation: turn, position: resting(DVec2::from(at) * MM) });
    }
    let (eye, target) = (DVec3::new(0.06, 0.62, 0.78), DVec3::new(0.0, BED.height, 0.01));
    scene.camera("CamFront", eye, target, 27.0 * PI / 180.0, 16.0 / 9.0);
    scene.into_glb("Billiards", "Original work of the Soffio project; MIT OR Apache-2.0")
}

/// Centre of a ball on the bed.
fn resting(at: DVec2) -> DVec3 {
    DVec3::new(at.x, BED.above(at, RADIUS), at.y)
}

/// A point of a circle about the origin, `angle` above the equator.
fn on_circle(radius: f64, angle: f64) -> DVec2 {
    radius * DVec2::new(cos(angle), sin(angle))
}

fn sphere() -> Solid {
    /// Segments from pole to pole.
    const ARCS: usize = 20;
    let arc = |k: usize| on_circle(RADIUS, PI * (k as f64 / ARCS as f64 - 0.5));
    let profile: Vec<DVec2> = (0..=ARCS)
        .map(|k| if k == 0 || k == ARCS { DVec2::new(0.0, arc(k).y.signum() * RADIUS) } else { arc(k) })
        .collect();
    revolve(&profile, AROUND)
}

/// A band about the equator, which makes the rolling visible.
fn stripe() -> Solid {
    /// Half the angle that the stripe takes from pole to pole, rad.
    const HALF: f64 = 0.22;
    let outer = (0..=6).map(|k| on_circle(RADIUS + 0.08 * MM, HALF * (k as f64 / 3.0 - 1.0)));
    let inner = [HALF, -HALF].map(|angle| on_circle(RADIUS - 0.6 * MM, angle));
    revolve_ring(&outer.chain(inner).collect::<Vec<_>>(), AROUND)
}
