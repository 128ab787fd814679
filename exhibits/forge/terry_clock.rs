//! A 30-hour clock with wooden works, after Eli Terry: going train, recoil escapement, motion work.
//!
//! # Train
//!
//! No tooth counts of Terry's are published; these give 6720 beats an hour on a pendulum of the usual 11¼ inches:
//!
//! ```text
//! great wheel 64 → 8 minute arbor 64 → 8 third arbor 60 → 6 escape wheel 42        80 turns an hour, two beats a tooth
//! cannon 12 → 36 minute wheel 10 → 40 hour wheel                                   12 : 1
//! ```
//!
//! # Escapement
//!
//! All in one plane, the wheel rotating clockwise about the origin. N teeth end on the circle of radius R. The anchor
//! spans `SPAN` teeth. Its pallets work at E and X, the angle β = π SPAN/N to the left and right of the top. Its arbor
//! is where the tangents there meet, R/cos β above the wheel's, at the distance a = R tan β from both. With n the
//! outward radius and t the direction of motion of the teeth at either place:
//!
//! ```text
//! face of a pallet   from its tip along f = −sin γ t + cos γ n, towards the teeth m = −cos γ t − sin γ n
//! lift               the tip is at E (X) when the pendulum has carried it out by ψ
//! drop δ             a tooth that leaves a tip falls by δ on the other side; while one face works the teeth
//!                    advance by s = π R/N − δ and the pallet moves out by p = 2 ψ a, and s = p tan γ
//! ```
//!
//! Beyond ±ψ the face continues to push: the wheel recoils.

use soffio_math::{DQuat, DVec2, DVec3, PI, Pose, atan2, cos, rotation, sin};

use super::terry_layout::{
    BACK, CENTER, DRUM, ESCAPING, FRONT, MIDDLE, MODULE, MOTION, SWING, ToothCounts, WHEEL, along_z, flat, piece,
    toward, wheel,
};
use super::{terry_case, terry_strike};
use soffio_authoring::glb::{Finish, Scene};
use soffio_authoring::outline::{Polygon, ellipse};
use soffio_authoring::piece::{Part, Piece};
use soffio_authoring::solid::{Solid, extrude, revolve};
use soffio_authoring::stock_parts::{
    BRASS, Finishes, LEAD, MM, ROUND, STEEL, WOOD, finishes, meshing_phase, part, ring, rod, slab, spur_gear, y_to_z,
};

/// Teeth of the great wheel, and of the pinion that it drives.
pub const GREAT: ToothCounts = ToothCounts { wheel: 64, pinion: 8 };
/// Teeth of the minute wheel, and of the pinion that it drives.
pub(crate) const MINUTE: ToothCounts = ToothCounts { wheel: 64, pinion: 8 };
/// Teeth of the third wheel, and of the pinion that it drives.
pub(crate) const THIRD: ToothCounts = ToothCounts { wheel: 60, pinion: 6 };
/// Teeth of the escape wheel.
pub(crate) const ESCAPE: usize = 42;
/// Teeth of the cannon pinion and of the minute wheel of the motion work.
pub const CANNON: ToothCounts = ToothCounts { wheel: 12, pinion: 36 };
/// Teeth of the minute wheel's pinion and of the hour wheel.
pub(crate) const HOUR: ToothCounts = ToothCounts { wheel: 10, pinion: 40 };
/// R: radius of the circle on which the teeth of the escape wheel end, m.
pub const TIP: f64 = 22.5 * MM;
/// Number of teeth that the anchor spans.
pub const SPAN: f64 = 7.5;
/// Radius of the tooth ends, m.
pub const TOOTH: f64 = 0.1 * MM;
/// Drop δ, m.
pub const DROP: f64 = 0.47 * MM;
/// ψ: half the angle through which a pallet is pushed, rad.
pub const LIFT: f64 = 2.25 * PI / 180.0;
/// Length of a pallet's face, m.
const FACE: f64 = 5.0 * MM;
/// Thickness of a pallet, m.
const THICKNESS: f64 = 0.6 * MM;
/// Width of a pallet along its arbor, m.
const WIDTH: f64 = 3.0 * MM;

/// Length of the simple pendulum with the period of this one, m. It is regulated by the mean rate of twelve hours with
/// all their strikes (`in_half_a_day_it_strikes_seventy_eight_blows` in tests/suite/clock.rs prints the rate): to
/// correct a gain of g seconds a day, the bob is lowered by 2 g/86,400 of the length. The recoil speeds the pendulum
/// up, the more the harder the train drives, and more than its amplitude slows it. While the pin lifts the flirt, ten
/// minutes before each hour, the train has less power and the clock loses, by 6 s a day at most; for most of the hour
/// it gains 1 s a day.
const LENGTH: f64 = 290.3952 * MM;
/// Radius of the bob, m.
const BOB_RADIUS: f64 = 20.0 * MM;
/// Position of a leaf of sheet brass on the rod, m below the pivot. It is oblique, so that a breath from the front is
/// deflected and pushes the pendulum; the leaf is an addition to Terry's design.
const LEAF: f64 = 200.0 * MM;

/// Hour that the hands show at the start.
const HOURS: usize = 10;
/// Minute that the hands show at the start: ten minutes before the clock strikes.
const MINUTES: f64 = 50.0;

/// Positions of the arbors in the plane of the plates, m.
pub fn places() -> [DVec3; 5] {
    let great = CENTER + GREAT.center_distance(MODULE) * DVec3::new(-0.6, -0.8, 0.0);
    let third = CENTER + MINUTE.center_distance(MODULE) * DVec3::new(0.6, 0.8, 0.0);
    let over = third.x - CENTER.x;
    let up = (THIRD.center_distance(MODULE) * THIRD.center_distance(MODULE) - over * over).sqrt();
    let escape = third + DVec3::new(-over, up, 0.0);
    let anchor = escape + DVec3::Y * TIP / cos(half_span());
    [great, CENTER, third, escape, anchor]
}

/// β, rad.
fn half_span() -> f64 {
    PI * SPAN / ESCAPE as f64
}

/// Unit vector at an angle from x, rad.
fn direction(angle: f64) -> DVec3 {
    DVec3::new(cos(angle), sin(angle), 0.0)
}

/// Direction of the minute hand at the start, rad from x.
pub fn minute_hand() -> f64 {
    0.5 * PI - 2.0 * PI * MINUTES / 60.0
}

/// Direction of the hour hand at the start, rad from x.
pub fn hour_hand() -> f64 {
    0.5 * PI - 2.0 * PI * (HOURS as f64 + MINUTES / 60.0) / 12.0
}

/// A hand that points at `angle`.
pub fn hand(name: &'static str, [length, width]: [f64; 2], out: f64, z: f64, angle: f64, finish: usize) -> Part {
    let place = out * direction(angle) + DVec3::Z * z;
    part(name, slab(length, width, 0.8 * MM), place, rotation(DVec3::Z * angle), LEAD, finish)
}

/// The escape wheel: tooth 0 points along +y, its leading side (clockwise) is radial.
pub fn escape_wheel() -> Solid {
    let step = 2.0 * PI / ESCAPE as f64;
    let root = TIP - 3.4 * MM;
    // (radius, distance along the tip circle against the direction of rotation), counter-clockwise.
    let corners = [(root, -TOOTH), (TIP + TOOTH, -TOOTH), (TIP + TOOTH, TOOTH), (root, 1.5 * MM)];
    let outline: Polygon = (0..ESCAPE)
        .flat_map(|k| corners.map(|(r, way)| (r, 0.5 * PI + step * k as f64 + way / r)))
        .map(|(r, angle)| DVec2::new(r * cos(angle), r * sin(angle)))
        .collect();
    let holes: Vec<Polygon> = (0..5)
        .map(|k| {
            let angle = 0.4 * PI * f64::from(k);
            ellipse(11.0 * MM * DVec2::new(cos(angle), sin(angle)), DVec2::splat(4.6 * MM), 0.0, 24)
        })
        .collect();
    extrude(&outline, &holes, 1.2 * MM, 0.03 * MM)
}

/// Centre of the pallet on one side (−1 at E, +1 at X) in the frame of the anchor at rest, and its rotation: x along
/// the face, y away from the teeth.
fn pallet(side: f64) -> Pose {
    let beta = half_span();
    let n = DVec3::new(side * sin(beta), cos(beta), 0.0);
    let t = DVec3::new(n.y, -n.x, 0.0);
    let way = PI * TIP / ESCAPE as f64 - DROP;
    let gamma = atan2(way, 2.0 * LIFT * TIP * sin(beta) / cos(beta));
    let m = -cos(gamma) * t - sin(gamma) * n;
    let f = -sin(gamma) * t + cos(gamma) * n;
    let tip = n * TIP - DVec3::Y * TIP / cos(beta) - m * TOOTH;
    let middle = tip + 0.5 * FACE * f - 0.5 * THICKNESS * m;
    // Undo the rotation by ψ: clockwise at E, counter-clockwise at X.
    let back = rotation(DVec3::Z * (-side * LIFT));
    Pose { rotation: back * rotation(DVec3::Z * atan2(f.y, f.x)), position: back * middle }
}

/// Rotation of the escape wheel at the start: its teeth are clear of the anchor, which is swung by 4° to the left.
pub fn escape_phase() -> f64 {
    half_span() + 1.8 * MM / TIP
}

/// The pendulum in its own frame, the pivot at the origin, with the period of a simple one of this length (m); with a
/// leaf, where a breath should move it.
pub fn pendulum(finishes: &Finishes, simple: f64, with_leaf: bool) -> Piece {
    let b = BOB_RADIUS;
    let lens = [(0.0, -5.5), (9.0, -5.2), (15.0, -3.8), (1e3 * b, 0.0), (15.0, 3.8), (9.0, 5.2), (0.0, 5.5)];
    let lens = revolve(&lens.map(|(r, y)| DVec2::new(r, y) * MM), 2 * ROUND);
    let leaf = extrude(&ellipse(DVec2::ZERO, DVec2::new(20.0, 44.0) * MM, 0.0, 2 * ROUND), &[], 0.2 * MM, 0.05 * MM);
    let with_bob = |depth: f64| {
        let (none, along) = (DVec3::ZERO, DQuat::IDENTITY);
        let mut parts = vec![
            part("Rod", rod(0.9 * MM, -depth + b, 3.0 * MM), none, along, STEEL, finishes.steel),
            part("Bob", lens.clone(), -depth * DVec3::Y, y_to_z(), BRASS, finishes.brass),
            part("Nut", rod(2.5 * MM, -depth - b - 4.0 * MM, -depth - b), none, along, BRASS, finishes.brass),
        ];
        if with_leaf {
            let askew = rotation(0.25 * PI * DVec3::Y);
            parts.push(part("Leaf", leaf.clone(), -LEAF * DVec3::Y, askew, BRASS, finishes.brass));
        }
        piece("Pendulum", parts)
    };
    let length = |piece: &Piece| {
        let mass = piece.mass();
        mass.inertia_about(DVec3::ZERO).z_axis.z / (mass.mass * -mass.center.y)
    };
    // A rod longer by δ makes the pendulum longer by nearly δ.
    let depth = (0..40).fold(simple, |depth, _| depth + simple - length(&with_bob(depth)));
    let mut piece = with_bob(depth);
    piece.markers.push(("RodSlot", DVec3::new(0.0, -45.0 * MM, 0.0)));
    piece
}

/// The anchor with its strip pallets and the crutch, in the frame of its arbor; z = 0 is the pendulum's plane.
pub fn anchor(finishes: &Finishes) -> Piece {
    let plane = ESCAPING - SWING;
    let mut parts = vec![along_z("AnchorArbor", 1.2 * MM, (-62.0 * MM, -4.0 * MM), STEEL, finishes.steel)];
    for (name, strap, side) in [("PalletEntry", "StrapEntry", -1.0), ("PalletExit", "StrapExit", 1.0)] {
        let mut place = pallet(side);
        place.position.z = plane;
        let strip = extrude(
            &[(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(x, y)| DVec2::new(0.5 * FACE * x, 0.5 * THICKNESS * y))
                .into(),
            &[],
            WIDTH,
            0.03 * MM,
        );
        parts.push(Part { name, solid: strip, place, density: STEEL, finish: finishes.steel });
        // A strap from the arbor to the far end of the strip.
        let end = place.point(DVec3::new(0.4 * FACE, 0.0, 0.0)).with_z(0.0);
        let turn = rotation(DVec3::Z * atan2(end.y, end.x));
        let middle = (0.5 * end).with_z(plane);
        parts.push(part(strap, slab(end.length(), 2.0 * MM, 1.6 * MM), middle, turn, STEEL, finishes.steel));
    }
    let crutch = slab(46.0 * MM, 1.6 * MM, 1.6 * MM);
    let down = rotation(DVec3::Z * (0.5 * PI));
    parts.push(part("Crutch", crutch, DVec3::new(0.0, -22.5 * MM, -6.0 * MM), down, STEEL, finishes.steel));
    parts.push(part(
        "CrutchLoop",
        ring(1.4 * MM, 2.6 * MM, 1.2 * MM),
        DVec3::new(0.0, -45.0 * MM, 0.0),
        DQuat::IDENTITY,
        STEEL,
        finishes.steel,
    ));
    let mut piece = piece("Anchor", parts);
    piece.markers.push(("CrutchEye", DVec3::new(0.0, -45.0 * MM, 0.0)));
    piece
}

/// A piece and the position of its frame in the model.
type Placed = (Piece, Pose);

/// Upright at this position.
fn at(position: DVec3) -> Pose {
    Pose { rotation: DQuat::IDENTITY, position }
}

/// Great wheel with the drum, minute arbor, cannon, third wheel and escape wheel.
fn going_train(finishes: &Finishes) -> [Placed; 5] {
    let [great, minute, third, escape, _] = places();
    let wood = finishes.wood;
    let great_wheel = piece(
        "GreatWheel",
        vec![
            flat("GreatWheel", wheel(GREAT.wheel, 0.0), BACK, WOOD, wood),
            along_z("Drum", DRUM - 0.5 * MM, (BACK + 4.0 * MM, BACK + 30.0 * MM), WOOD, wood),
            along_z("GreatArbor", 3.0 * MM, (-48.0 * MM, 0.0), WOOD, wood),
        ],
    );
    let phase = meshing_phase(GREAT.pinion, GREAT.wheel, 0.0, toward(great, minute));
    let arbor_parts = vec![
        flat("MinuteArbor", wheel(MINUTE.wheel, 0.0), MIDDLE, WOOD, wood),
        flat("MinutePinion", spur_gear(GREAT.pinion, MODULE, 6.0 * MM, phase, &[]), BACK, WOOD, wood),
        along_z("CenterArbor", 2.2 * MM, (-48.0 * MM, 18.0 * MM), WOOD, wood),
    ];
    let phase = meshing_phase(MINUTE.pinion, MINUTE.wheel, 0.0, toward(minute, third));
    let pinion = spur_gear(MINUTE.pinion, MODULE, 6.0 * MM, phase, &[]);
    let third_wheel = piece(
        "ThirdWheel",
        vec![
            flat("ThirdWheel", wheel(THIRD.wheel, 0.0), FRONT, WOOD, wood),
            flat("ThirdPinion", pinion, MIDDLE, WOOD, wood),
            along_z("ThirdArbor", 2.0 * MM, (-48.0 * MM, 0.0), WOOD, wood),
        ],
    );
    let turned_by = escape_phase();
    let phase = meshing_phase(THIRD.pinion, THIRD.wheel, 0.0, toward(third, escape)) - turned_by;
    [
        (great_wheel, at(great)),
        (piece("MinuteArbor", arbor_parts), at(minute)),
        (cannon(finishes), at(minute)),
        (third_wheel, at(third)),
        (escape_piece(finishes, phase), Pose { rotation: rotation(DVec3::Z * turned_by), position: escape }),
    ]
}

/// The cannon sits tight on the arbor, and can still be turned: it carries the hand, the motion work and the strike.
fn cannon(finishes: &Finishes) -> Piece {
    let cannon_parts = vec![
        flat("Cannon", spur_gear(CANNON.wheel, MODULE, WHEEL, 0.0, &[]), MOTION, WOOD, finishes.wood),
        hand("MinuteHand", [88.0 * MM, 3.0 * MM], 34.0 * MM, 16.0 * MM, minute_hand(), finishes.black),
        terry_strike::peg(
            "LiftingPin",
            terry_strike::LIFTING_PIN * direction(minute_hand() - 0.5 * PI + terry_strike::lifting_pin_at_the_hour()),
            (-14.0 * MM, -6.0 * MM),
            finishes.steel,
        ),
    ];
    piece("Cannon", cannon_parts)
}

/// The escape wheel with its pinion, whose teeth begin at `phase`, and one tooth as a part of its own.
fn escape_piece(finishes: &Finishes, phase: f64) -> Piece {
    piece(
        "EscapeWheel",
        vec![
            flat("EscapeWheel", escape_wheel(), ESCAPING, BRASS, finishes.brass),
            flat("EscapePinion", spur_gear(THIRD.pinion, MODULE, 6.0 * MM, phase, &[]), FRONT, WOOD, finishes.wood),
            along_z("EscapeArbor", 1.8 * MM, (-48.0 * MM, 14.0 * MM), WOOD, finishes.wood),
            part(
                "EscapeTooth",
                rod(TOOTH, -MM, 1.0 * MM),
                DVec3::new(0.0, TIP - 1.5 * MM, ESCAPING),
                DQuat::IDENTITY,
                BRASS,
                finishes.brass,
            ),
        ],
    )
}

/// Minute wheel and hour wheel with its hand.
fn motion_work(finishes: &Finishes) -> [Placed; 2] {
    let wood = finishes.wood;
    let minute_wheel_at = CENTER + 24.0 * MM * DVec3::new(-sin(0.9), -cos(0.9), 0.0);
    let phase = meshing_phase(CANNON.pinion, CANNON.wheel, 0.0, toward(CENTER, minute_wheel_at));
    let minute_wheel = piece(
        "MinuteWheel",
        vec![
            flat("MinuteWheel", spur_gear(CANNON.pinion, MODULE, WHEEL, phase, &[]), MOTION, WOOD, wood),
            flat("HourPinion", spur_gear(HOUR.wheel, 0.96 * MM, 6.0 * MM, 0.0, &[]), MOTION + 5.0 * MM, WOOD, wood),
        ],
    );
    let phase = meshing_phase(HOUR.pinion, HOUR.wheel, 0.0, toward(minute_wheel_at, CENTER));
    let hour_wheel = piece(
        "HourWheel",
        vec![
            flat(
                "HourWheel",
                spur_gear(
                    HOUR.pinion,
                    0.96 * MM,
                    WHEEL,
                    phase,
                    &[ellipse(DVec2::ZERO, DVec2::splat(3.0 * MM), 0.0, 32)],
                ),
                MOTION + 5.0 * MM,
                WOOD,
                wood,
            ),
            hand("HourHand", [54.0 * MM, 4.0 * MM], 31.0 * MM, MOTION + 8.0 * MM, hour_hand(), finishes.black),
        ],
    );
    [(minute_wheel, at(minute_wheel_at)), (hour_wheel, at(CENTER))]
}

/// The weight of the going train.
fn weight(finishes: &Finishes) -> Piece {
    piece(
        "TimeWeight",
        vec![part(
            "TimeWeight",
            rod(22.0 * MM, -60.0 * MM, 60.0 * MM),
            DVec3::ZERO,
            DQuat::IDENTITY,
            LEAD,
            finishes.lead,
        )],
    )
}

/// The back plate, and the cock that holds the anchor's arbor at `pivot`.
fn frame(finishes: &Finishes, pivot: DVec3) -> Piece {
    let back_plate = part(
        "BackPlate",
        slab(190.0 * MM, 159.0 * MM, 5.0 * MM),
        CENTER + DVec3::Z * (-48.0 * MM),
        rotation(DVec3::Z * (0.5 * PI)),
        WOOD,
        finishes.wood,
    );
    let cock = part("AnchorCock", rod(4.0 * MM, -4.0 * MM, 4.0 * MM), pivot, y_to_z(), BRASS, finishes.brass);
    piece("Frame", vec![back_plate, cock])
}

/// The model; all arbors are parallel to z.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    // Terry's wheels are of cherry, his plates of oak. Here one train is of beech, so that they differ to the eye.
    let mut wood = |name, color, finish| {
        let finish = Finish { name, color, metallic: 0.0, roughness: 0.5, finish: Some(finish) };
        Finishes { wood: scene.finish(&finish), ..finishes }
    };
    let of_plates = wood("Oak", [0.17, 0.09, 0.042], "oak");
    let of_striking = wood("Cherry", [0.31, 0.115, 0.05], "walnut");
    let [.., arbor] = places();
    let pivot = arbor + DVec3::Z * SWING;
    let hangs = DVec3::new(-0.125, 0.36, -10.0 * MM);
    let [case, dial] = terry_case::pieces(&mut scene, &finishes, [hangs, terry_strike::weight_at()]);
    let mut pieces: Vec<Placed> = [frame(&of_plates, pivot), case, dial].map(|still| (still, at(DVec3::ZERO))).into();
    pieces.extend(going_train(&finishes));
    pieces.push((anchor(&finishes), at(pivot)));
    pieces.push((pendulum(&finishes, LENGTH, true), at(pivot)));
    pieces.extend(motion_work(&finishes));
    pieces.push((weight(&finishes), at(hangs)));
    let bell = terry_strike::bell(&finishes);
    let hanging = at(bell.place.position);
    let at_home =
        Part { place: Pose { rotation: bell.place.rotation, position: DVec3::ZERO }, name: "BellCup", ..bell };
    pieces.push((piece("Bell", vec![at_home]), hanging));
    pieces.extend(terry_strike::pieces(&of_striking, HOURS));
    for (piece, pose) in &pieces {
        piece.write(&mut scene, *pose);
    }
    scene.camera("CamFront", DVec3::new(0.14, 0.38, 1.62), DVec3::new(0.01, 0.295, 0.0), 27.0 * PI / 180.0, 16.0 / 9.0);
    scene.into_glb("Eli Terry's clock", "Original work of the Soffio project; MIT OR Apache-2.0")
}
