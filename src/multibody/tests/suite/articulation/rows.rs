//! Every row against finite differences of its own value: J along random displacements, J ẋ − ḟ and J ẍ + J̇ẋ − f̈ along
//! random motions.
//!
//! The motion through a state is x(t) = x + v t + a t²/2, q(t) = exp(ω t + α t²/2) q: at t = 0 it has the velocities
//! (v, ω) and the accelerations (a, α), the latter because φ̇×φ̇ = 0.

use soffio_geometry::bodies::RigidBody;
use soffio_math::Function;
use soffio_math::Interpolation;
use soffio_math::noise::Random;
use soffio_math::spatial::matrix;
use soffio_math::spatial::{Vec6, angular, dot, linear, vec6};
use soffio_math::{DMat3, Pose, rotation};
use soffio_multibody::articulation::rows::coupling::{self, Gauge};
use soffio_multibody::articulation::rows::{BodyStates, JacobianRow, orientation, plane, point};
use soffio_multibody::articulation::{Constraint, ConstraintKind, LinearSolver, Measure, System};
use soffio_multibody::dynamics::KeyframeMotion;

use super::mechanisms::{self, axis, below, body, unit, vector};

/// Step of the stencils, s or of the displacements.
const STEP: f64 = 2e-3;
/// The five-point stencils err by STEP⁴/30 C⁽⁵⁾ and STEP⁴/90 C⁽⁶⁾, some 1e-10 of derivatives of about a hundred;
/// rounding by 1e-16/STEP and 1e-16/STEP².
const FIRST: f64 = 2e-9;
const SECOND: f64 = 2e-8;
/// Random states a kind.
const STATES: u64 = 60;

/// First and second derivative of a value at 0.
fn differences(value: impl Fn(f64) -> f64) -> (f64, f64) {
    let [a, b, c, d, e] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| value(k * STEP));
    let first = (a - 8.0 * b + 8.0 * d - e) / (12.0 * STEP);
    (first, (-a + 16.0 * b - 30.0 * c + 16.0 * d - e) / (12.0 * STEP * STEP))
}

/// The bodies at the time t of the motion of the file's head.
fn shifted(bodies: &[RigidBody], accelerations: &[Vec6], t: f64) -> Vec<RigidBody> {
    let mut out = bodies.to_vec();
    for (body, a) in out.iter_mut().zip(accelerations) {
        let half = 0.5 * t * t;
        let (displacement, rotated) = (soffio_math::spatial::linear(a), soffio_math::spatial::angular(a));
        body.position += t * body.velocity + half * displacement;
        body.rotation = rotation(t * body.angular_velocity + half * rotated) * body.rotation;
    }
    out
}

/// Rows of a kind between bodies 0, 1 (or the world) and 2, with blocks for all three bodies.
fn evaluate(
    kind: &ConstraintKind,
    gauges: &[(Gauge, f64)],
    bodies: &[RigidBody],
    t: f64,
) -> Vec<(JacobianRow, [Vec6; 3])> {
    let frames: Vec<DMat3> = bodies.iter().map(|body| matrix(body.rotation)).collect();
    let scene = BodyStates { bodies, frames: &frames, time: t };
    let both = |row: JacobianRow| {
        let mut blocks = [[0.0; 6]; 3];
        let (a, b) = Constraint::new("", kind.clone()).link().expect("two bodies");
        a.into_iter().for_each(|a| blocks[a] = row.a);
        b.into_iter().for_each(|b| blocks[b] = row.b);
        (row, blocks)
    };
    match kind {
        ConstraintKind::PointToPoint { a, b } => point::rows(&scene, a, b).into_iter().map(both).collect(),
        ConstraintKind::PointOnPlane { point, plane, normal, offset } => {
            vec![both(plane::row(&scene, point, plane, *normal, offset))]
        }
        ConstraintKind::Orientation { a, b, angle } => vec![both(orientation::row(&scene, a, b, angle, || None))],
        ConstraintKind::Coupling { .. } => {
            let mut parts = [(0, [0.0; 6]), (1, [0.0; 6]), (2, [0.0; 6])];
            let row = coupling::row(&scene, gauges, &mut parts);
            vec![(row, parts.map(|(_, block)| block))]
        }
    }
}

fn check(name: &str, make: impl Fn(&mut Random) -> ConstraintKind) {
    let mut worst = [0.0_f64; 3];
    for seed in 0..STATES {
        let mut random = Random::new(seed);
        let bodies: Vec<RigidBody> = (0..3).map(|_| body(&mut random)).collect();
        let kind = make(&mut random);
        let gauges: Vec<(Gauge, f64)> = match &kind {
            ConstraintKind::Coupling { terms } => {
                // Zero where the bodies stood some time ago.
                let before = shifted(&bodies, &[[0.0; 6]; 3], -0.7);
                terms.iter().map(|term| (Gauge::new(term.measure, &before), term.coefficient)).collect()
            }
            _ => Vec::new(),
        };
        let t = random.range(0.0, 3.0);
        let accelerations: Vec<Vec6> = (0..3).map(|_| mechanisms::wrench(&mut random)).collect();
        let now = evaluate(&kind, &gauges, &bodies, t);
        for (k, (row, blocks)) in now.iter().enumerate() {
            let times = |v: &[Vec6]| (0..3).map(|i| dot(&blocks[i], &v[i])).sum::<f64>();
            // J alone: the bodies move, time and functions stand still.
            let original: Vec<RigidBody> = bodies.clone();
            let (displacement, _) =
                differences(|s| evaluate(&kind, &gauges, &shifted(&original, &[[0.0; 6]; 3], s), t)[k].0.value);
            let velocities: Vec<Vec6> = bodies.iter().map(|b| vec6(b.velocity, b.angular_velocity)).collect();
            let along = |s: f64| evaluate(&kind, &gauges, &shifted(&bodies, &accelerations, s), t + s)[k].0.value;
            let (rate, bend) = differences(along);
            let errors = [
                (displacement - times(&velocities)).abs(),
                (rate - (times(&velocities) - row.prescribed_rate)).abs(),
                (bend - (times(&accelerations) + row.bias)).abs(),
            ];
            for (worst, error) in worst.iter_mut().zip(errors) {
                *worst = worst.max(error);
            }
            assert!(errors[0] < FIRST && errors[1] < FIRST, "{name}, seed {seed}, row {k}: J off by {errors:?}");
            assert!(errors[2] < SECOND, "{name}, seed {seed}, row {k}: bias off by {:e}", errors[2]);
        }
    }
    println!("{name}: J off by {:.0e}, Ċ by {:.0e}, C̈ by {:.0e}", worst[0], worst[1], worst[2]);
}

/// The second body, or the world.
fn other(random: &mut Random) -> Option<usize> {
    (random.unit() < 0.6).then_some(1)
}

#[test]
fn points_planes_and_orientations_have_the_derivatives_they_say() {
    check("point", |random| {
        let b = other(random);
        mechanisms::point(random, Some(0), b)
    });
    check("plane", |random| {
        let b = other(random);
        if random.unit() < 0.5 { mechanisms::plane(random, Some(0), b) } else { mechanisms::plane(random, b, Some(0)) }
    });
    check("orientation", |random| {
        let b = other(random);
        if random.unit() < 0.5 {
            mechanisms::orientation(random, Some(0), b)
        } else {
            mechanisms::orientation(random, b, Some(0))
        }
    });
}

#[test]
fn turns_and_ways_have_the_derivatives_they_say_on_moving_frames_too() {
    let one = |measure: Measure| {
        let terms = vec![soffio_multibody::articulation::Term { measure, coefficient: 1.5 }];
        ConstraintKind::Coupling { terms }
    };
    check("turn", |random| {
        let frame = other(random);
        one(Measure::Angle { axis: axis(random, Some(0)), frame })
    });
    check("turn of the world", |random| one(Measure::Angle { axis: axis(random, None), frame: Some(0) }));
    check("way", |random| {
        let frame = other(random);
        one(Measure::Displacement { point: mechanisms::anchor(random, Some(0)), direction: axis(random, frame) })
    });
    check("coupling", |random| mechanisms::coupling(random, 3));
}

#[test]
fn functions_have_the_derivatives_they_say() {
    let kinds = [Interpolation::Linear, Interpolation::Smooth, Interpolation::Spline];
    for seed in 0..STATES {
        let mut random = Random::new(seed);
        let keys: Vec<(f64, f64)> = (0..5).map(|i| (f64::from(i) + 0.3 * random.signed(), random.signed())).collect();
        for interpolation in kinds {
            let repeat = random.unit() < 0.5;
            let function = Function::Keys { keys: keys.clone(), interpolation, repeat };
            // Away from the keys, where a third derivative may jump.
            let key = below(&mut random, 4);
            let t = keys[key].0 + random.range(0.1, 0.9) * (keys[key + 1].0 - keys[key].0);
            let (rate, bend) = differences(|s| function.at(t + s).value);
            let found = function.at(t);
            let off = [(rate - found.rate).abs(), (bend - found.acceleration).abs()];
            // Quintics over spans of half a second bend a thousand times more than mechanisms do.
            assert!(off[0] < 1e2 * FIRST && off[1] < 1e3 * SECOND, "{interpolation:?}, seed {seed}: off by {off:?}");
        }
    }
}

#[test]
fn driven_bodies_have_the_velocities_and_accelerations_they_say() {
    for seed in 0..STATES {
        let mut random = Random::new(seed);
        let keys: Vec<(f64, Pose)> = (0..5)
            .map(|i| {
                let rotation = rotation(unit(&mut random) * random.range(0.0, 3.0));
                (f64::from(i) + 0.3 * random.signed(), Pose { rotation, position: vector(&mut random) })
            })
            .collect();
        for interpolation in [Interpolation::Linear, Interpolation::Smooth, Interpolation::Spline] {
            let motion = KeyframeMotion { keys: keys.clone(), interpolation, repeat: false };
            let key = below(&mut random, 4);
            let t = keys[key].0 + random.range(0.1, 0.9) * (keys[key + 1].0 - keys[key].0);
            let template = body(&mut random);
            let at = |s: f64| {
                let mut body = template;
                motion.at(t + s).place(&mut body);
                body
            };
            let mut now = template;
            let rate = motion.at(t).place(&mut now);
            let (acceleration, rotated) = (linear(&rate), angular(&rate));
            // Three points of the body say all of its motion.
            for arm in [vector(&mut random), vector(&mut random), vector(&mut random)] {
                let r = now.arm(arm);
                let velocity = now.velocity_at(now.position + r);
                let centripetal = now.angular_velocity.cross(now.angular_velocity.cross(r));
                let bend = acceleration + rotated.cross(r) + centripetal;
                for k in 0..3 {
                    let (first, second) = differences(|s| (at(s).position + at(s).arm(arm))[k]);
                    let off = [(first - velocity[k]).abs(), (second - bend[k]).abs()];
                    // As above: quintics bend more.
                    let good = off[0] < 1e3 * FIRST && off[1] < 1e4 * SECOND;
                    assert!(good, "{interpolation:?}, seed {seed}: off by {off:?}");
                }
            }
        }
    }
}

#[test]
fn solved_accelerations_keep_every_row_as_it_moves() {
    // The whole way from rows to accelerations: where nothing gathers, C̈ is 0 along the motion.
    let (mut seed, mut done) = (0, 0);
    while done < 60 {
        let mut random = Random::new(seed);
        let kinds = mechanisms::Kinds { loops: true, partial_rows: false, friction: false };
        let mechanism = mechanisms::mechanism(&mut random, kinds);
        let method = if seed % 2 == 0 { LinearSolver::Sparse } else { LinearSolver::Dense };
        seed += 1;
        let t = mechanism.time;
        let mut system = System::new(&mechanism.bodies, &mechanism.kinematic, &mechanism.constraints, method);
        system.activity.update_activations(t);
        system.activity.set_time(t);
        system.evaluate(&mechanism.bodies);
        let rows = system.acting_rows();
        if !super::kkt::well_posed(&system, &mechanism.bodies, &rows, 0.1) {
            continue;
        }
        done += 1;
        system.factor();
        let given: Vec<Vec6> = mechanism.bodies.iter().map(|_| mechanisms::wrench(&mut random)).collect();
        for i in 0..given.len() {
            system.b[i] = mechanisms::wrench(&mut random);
            if mechanism.kinematic[i] {
                system.a[i] = given[i];
            }
        }
        system.solve_acceleration(&mechanism.bodies, 1.0);
        let accelerations = system.a.clone();
        let value = |row: usize, s: f64| {
            let mut other = system.clone();
            other.activity.set_time(t + s);
            other.evaluate(&shifted(&mechanism.bodies, &accelerations, s));
            other.states()[row].value
        };
        // Stiff answers move fast: what they bend by is measured against them.
        let size = accelerations.iter().flatten().fold(1.0_f64, |s, x| s.max(x.abs()));
        for &row in &rows {
            let (_, bend) = differences(|s| value(row, s));
            let error = bend.abs() / (size * size);
            assert!(error < 1e2 * SECOND, "seed {}, {method:?}, row {row}: C̈ off by {error:e}", seed - 1);
        }
    }
}
