//! Closed loops, which do not collide.

use soffio_math::noise::Random;
use soffio_math::{DQuat, DVec3, cos, sin};
use soffio_offline::scene::{BodyState, PhysicsScene};

use crate::builder::{Builder, STEEL, at, ball, cuboid};

/// Simulated time, s.
const DURATION: f64 = 10.0;
/// Half the thickness of a bar, m.
const THIN: f64 = 0.003;

/// A bar from one point to another: half length along x, and its state at rest.
fn bar(from: DVec3, to: DVec3) -> (DVec3, BodyState) {
    let rotation = DQuat::from_rotation_arc(DVec3::X, (to - from).normalize());
    (DVec3::new(0.5 * from.distance(to), THIN, THIN), BodyState { rotation, ..at(0.5 * (from + to)) })
}

/// Four-bar linkages under each other: two rails hang on the rung above and carry the next. All joints are hinges, the
/// rails lean at the start; with `limits` each left rail stops at a lean of −0.3 and 0.6 rad.
pub fn ladder(rungs: usize, limits: bool) -> PhysicsScene {
    const WIDTH: f64 = 0.2;
    const RAIL: f64 = 0.05;
    const LEAN: f64 = 0.4;
    const STOPS: [f64; 2] = [-0.3, 0.6];
    let name = format!("ladder_{rungs}{}", if limits { "_limits" } else { "" });
    let mut builder = Builder::new(&name, "four-bar linkages under each other, released from a lean", DURATION);
    let fall = RAIL * DVec3::new(sin(LEAN), -cos(LEAN), 0.0);
    let [left, right] = [0.0, WIDTH].map(|x| DVec3::X * x);
    let mut above = None;
    for rung in 0..rungs {
        let (top, bottom) = (rung as f64 * fall, (rung + 1) as f64 * fall);
        let mut make = |from: DVec3, to: DVec3| {
            let (half, state) = bar(from, to);
            builder.body(cuboid(half), STEEL, state)
        };
        let rails = [left, right].map(|side| make(top + side, bottom + side));
        let own = make(bottom + left, bottom + right);
        for (k, (rail, side)) in rails.into_iter().zip([left, right]).enumerate() {
            let stops = (limits && k == 0).then_some(STOPS.map(|lean| lean - LEAN));
            builder.hinge(above, rail, top + side, stops);
            builder.hinge(Some(rail), own, bottom + side, None);
        }
        above = Some(own);
    }
    builder.finish(-RAIL * rungs as f64)
}

/// A net of `n` by `n` knots and the rods between them on ball joints, its corners nailed. It hangs between two equal
/// arcs that carry each other (a translation surface), so that all rods have one length. Knots differ in weight, so that it
/// sways.
pub fn net(n: usize) -> PhysicsScene {
    const ROD: f64 = 0.05;
    const KNOT: f64 = 0.004;
    /// Lean of the first and last rod of an arc, rad.
    const SAG: f64 = 0.6;
    let name = format!("net_{}", n * n + 2 * n * (n - 1));
    let mut builder = Builder::new(&name, "a net of rods on ball joints, hung by its corners", DURATION);
    // Way along an arc: rods lean evenly from −SAG to SAG.
    let mut arc = vec![[0.0; 2]];
    for i in 0..n - 1 {
        let lean = SAG * (2.0 * i as f64 / (n - 2) as f64 - 1.0);
        let [way, height] = arc[i];
        arc.push([way + ROD * cos(lean), height + ROD * sin(lean)]);
    }
    let place = |i: usize, j: usize| DVec3::new(arc[i][0], arc[i][1] + arc[j][1], arc[j][0]);
    let mut random = Random::new(crate::SEED);
    let knots: Vec<usize> = (0..n * n)
        .map(|k| {
            let (i, j) = (k / n, k % n);
            builder.body(ball(KNOT), STEEL * random.range(0.5, 2.0), at(place(i, j)))
        })
        .collect();
    let mut rod = |a: (usize, usize), b: (usize, usize)| {
        let (from, to) = (place(a.0, a.1), place(b.0, b.1));
        let (half, state) = bar(from, to);
        let rod = builder.body(cuboid(half), STEEL, state);
        builder.spherical(Some(knots[a.0 * n + a.1]), rod, from);
        builder.spherical(Some(rod), knots[b.0 * n + b.1], to);
    };
    for i in 0..n {
        for j in 0..n - 1 {
            rod((i, j), (i, j + 1));
            rod((j, i), (j + 1, i));
        }
    }
    for (i, j) in [(0, 0), (0, n - 1), (n - 1, 0), (n - 1, n - 1)] {
        builder.spherical(None, knots[i * n + j], place(i, j));
    }
    builder.finish(2.0 * arc[n / 2][1])
}
