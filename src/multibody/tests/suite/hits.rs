//! Impacts on random mechanisms: joints, energy, the friction cone and momentum.

use soffio_geometry::bodies::{MassProperties, RigidBody};
use soffio_math::noise::Random;
use soffio_math::{DMat3, DQuat, DVec3, Pose, rotation};
use soffio_multibody::articulation::{Anchor, Axis, Constraint, ConstraintKind, System};
use soffio_multibody::dynamics::impact_law::from_rest;
use soffio_multibody::dynamics::{PointImpact, Solver, resolve_point_impact};

fn body(mass: f64, inertia: DVec3, position: DVec3) -> RigidBody {
    let properties = MassProperties { mass, center: DVec3::ZERO, inertia: DMat3::from_diagonal(inertia) };
    RigidBody::at_rest(properties, Pose { rotation: DQuat::IDENTITY, position })
}

fn anchor(body: Option<usize>, point: DVec3) -> Anchor {
    Anchor { body, point }
}

/// A random tree of bodies on ball joints and hinges, whose velocities satisfy the joints.
fn random_articulation(random: &mut Random) -> (System, Vec<RigidBody>, bool) {
    let count = 2 + (random.unit() * 5.0) as usize;
    let vector = |random: &mut Random| DVec3::new(random.signed(), random.signed(), random.signed());
    let mut bodies = Vec::new();
    let mut constraints = Vec::new();
    let nailed = random.unit() < 0.5;
    for i in 0..count {
        let inertia = DVec3::new(random.range(0.5, 1.0), random.range(0.5, 1.0), random.range(0.5, 1.0));
        let mass = random.range(0.1, 2.0);
        let mut own = body(mass, inertia * (mass * 0.01), vector(random) * 0.3);
        own.rotation = rotation(vector(random) * 2.0);
        (own.velocity, own.angular_velocity) = (vector(random), 3.0 * vector(random));
        bodies.push(own);
        let other = if i == 0 { None } else { Some((random.unit() * i as f64) as usize) };
        if i == 0 && !nailed {
            continue;
        }
        let at = bodies[i].position + 0.1 * vector(random);
        let local = |body: Option<usize>| body.map_or(at, |b| bodies[b].pose().inverse_point(at));
        let kind = ConstraintKind::PointToPoint { a: anchor(Some(i), local(Some(i))), b: anchor(other, local(other)) };
        constraints.push(Constraint::new(&format!("joint-{i}/point"), kind));
        if random.unit() < 0.4 {
            // A hinge about a direction that both hold: across it, two of the other's.
            let axis = vector(random).normalize();
            let (t, u) = soffio_math::tangents(axis);
            for (name, n) in [("t", t), ("u", u)] {
                let place = |body: Option<usize>, d: DVec3| Axis {
                    body,
                    direction: body.map_or(d, |b| bodies[b].pose().inverse_vector(d)),
                };
                let kind =
                    ConstraintKind::Orientation { a: place(Some(i), axis), b: place(other, n), angle: 0.0.into() };
                constraints.push(Constraint::new(&format!("joint-{i}/{name}"), kind));
            }
        }
    }
    let is_kinematic = vec![false; count];
    let mut system = System::new(&bodies, &is_kinematic, &constraints, Solver::Sparse);
    system.evaluate(&bodies);
    system.classify_rows();
    system.factor();
    for _ in 0..2 {
        system.solve_velocity(&bodies);
        system.apply_velocity(&mut bodies);
    }
    (system, bodies, nailed)
}

/// Impacts on random mechanisms at random points, `count` times.
fn assert_impacts_keep_the_laws(count: u64) {
    /// Bars of the project, relative to the speeds, impulses and energies at hand.
    const JOINTS: f64 = 1e-12;
    const MOMENTUM: f64 = 1e-12;
    const ENERGY: f64 = 1e-12;
    const CONE: f64 = 1e-12;
    /// Effective inverse masses with a larger condition number have no usable inverse; others decide to this margin.
    const CONDITION: f64 = 1e6;
    const ROUNDED: f64 = 1e-6;
    let (mut worst, mut stuck, mut slid) = ([0f64; 4], 0, 0);
    let mut seconds = 0.0;
    for seed in 0..count {
        let mut random = Random::new(seed);
        let (mut system, mut bodies, nailed) = random_articulation(&mut random);
        let first = (random.unit() * bodies.len() as f64) as usize;
        let second = (first + 1 + (random.unit() * (bodies.len() - 1) as f64) as usize) % bodies.len();
        let second = if random.unit() < 0.5 { Some(second) } else { None };
        let spread = DVec3::new(random.signed(), random.signed(), random.signed());
        let point = bodies[first].position + 0.15 * spread;
        let speed_at = |bodies: &[RigidBody]| {
            bodies[first].velocity_at(point) - second.map_or(DVec3::ZERO, |b| bodies[b].velocity_at(point))
        };
        let mut normal = DVec3::new(random.signed(), random.signed(), random.signed()).normalize();
        if speed_at(&bodies).dot(normal) > 0.0 {
            normal = -normal;
        }
        let friction = 1.2 * random.unit();
        let impact = PointImpact { point, normal, bodies: [Some(first), second], friction, restitution: random.unit() };
        let before = bodies.clone();
        let began = std::time::Instant::now();
        let Some(result) = resolve_point_impact(&impact, &mut system, &mut bodies) else { continue };
        seconds += began.elapsed().as_secs_f64();
        let energy = |bodies: &[RigidBody]| bodies.iter().map(RigidBody::kinetic_energy).sum::<f64>();
        let rise = (energy(&bodies) - energy(&before)) / energy(&before);
        worst[0] = worst[0].max(rise);
        let p = result.impulse;
        worst[1] = worst[1].max(p.truncate().length() / (friction * p.z).max(1e-300) - 1.0);
        // Joints: the velocity change that they would still need after the impact.
        let scale =
            bodies.iter().fold(0.0, |m: f64, b| m.max(b.velocity.length()).max(0.1 * b.angular_velocity.length()));
        system.solve_velocity(&bodies);
        let left = system.a.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        worst[2] = worst[2].max(left / scale);
        if !nailed {
            // A floating mechanism keeps its momentum but for the impulse of the world.
            let given = if second.is_some() {
                DVec3::ZERO
            } else {
                let (t, u) = soffio_math::tangents(normal);
                p.x * t + p.y * u + p.z * normal
            };
            let momentum = |bodies: &[RigidBody]| {
                bodies.iter().fold((DVec3::ZERO, DVec3::ZERO), |(p, l), b| {
                    let own = b.properties.mass * b.velocity;
                    (p + own, l + b.position.cross(own) + b.inertia_world() * b.angular_velocity)
                })
            };
            let ((p0, l0), (p1, l1)) = (momentum(&before), momentum(&bodies));
            let size = p.length() + bodies.iter().map(|b| b.properties.mass * b.velocity.length()).sum::<f64>();
            worst[3] = worst[3].max((p1 - p0 - given).length() / size);
            worst[3] = worst[3].max((l1 - l0 - point.cross(given)).length() / size);
        }
        // Whether it sticks at the end follows from the inverse.
        let after = result.velocity + result.k * p;
        let inverse = result.k.inverse();
        let holds = inverse.z_axis.truncate().length() <= friction * inverse.z_axis.z;
        // Joints may leave K nearly singular, without a usable inverse.
        let size = |m: &DMat3| m.to_cols_array().iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let undone = size(&(result.k * inverse - DMat3::IDENTITY));
        if inverse.is_finite() && undone < ROUNDED && size(&result.k) * size(&inverse) < CONDITION {
            let margin = inverse.z_axis.truncate().length() / (friction * inverse.z_axis.z) - 1.0;
            let says = from_rest(&result.k, friction).sticks;
            assert!(says == holds || margin.abs() < ROUNDED, "seed {seed}: {says}, by a margin of {margin}");
            let is_stuck = after.truncate().length() < 1e-9 * result.velocity.length();
            stuck += usize::from(is_stuck);
            slid += usize::from(!is_stuck);
            assert!(!is_stuck || holds || margin.abs() < ROUNDED, "seed {seed}: stuck where it cannot");
        }
        let approach = -after.z / result.velocity.length();
        // A slip within a billionth of the speeds is none.
        assert!(approach < 1e-6, "seed {seed}: still approaches at {}: {impact:?} {result:?}", after.z);
        assert!(
            worst[0] <= ENERGY && worst[1] <= CONE && worst[2] <= JOINTS && worst[3] <= MOMENTUM,
            "seed {seed}: energy, cone, joints, momentum {worst:?}"
        );
    }
    println!(
        "{count} hits, {stuck} stuck, {slid} slid: energy, cone, joints, momentum {worst:?}; {:.2} µs a hit",
        seconds / count as f64 * 1e6
    );
    assert!(stuck * 20 > slid && slid * 20 > stuck);
}

#[test]
fn hits_keep_joints_energy_cone_and_momentum() {
    assert_impacts_keep_the_laws(10_000);
}

#[test]
#[ignore = "a million figures: a minute of the machine"]
fn a_million_hits_keep_joints_energy_cone_and_momentum() {
    assert_impacts_keep_the_laws(1_000_000);
}
