//! Difficult contacts: heavy bodies on light ones, many bodies, joints that close past obstacles, teeth with play.

use soffio_multibody::articulation::Term;

use super::*;

/// Two boxes of these masses on the floor, the first below.
fn stack(light: f64, heavy: f64) -> Dynamics {
    let half = DVec3::new(0.05, 0.03, 0.05);
    let bodies = vec![cube(light, half, DVec3::Y * half.y), cube(heavy, half, DVec3::Y * 3.0 * half.y)];
    let colliders = vec![block(0, half), block(1, half), floor()];
    Scene::new(bodies, colliders).dynamics()
}

#[test]
fn a_light_box_bears_a_hundred_thousand_times_its_weight() {
    // A million times it still bears; beyond that a substep would have to be shorter than a 64th of a step.
    for (heavy, seconds) in [(10.0, 10.0), (100.0, 2.0)] {
        let mut dynamics = stack(1e-3, heavy);
        run(&mut dynamics, 1.0);
        assert_stays(&mut dynamics, seconds);
        let sunk = 0.09 - dynamics.bodies[1].position.y;
        assert!(sunk.abs() < 1e-5, "under {heavy} kg: sunk by {sunk} m");
    }
}

#[test]
fn of_many_chimes_only_neighbours_are_measured() {
    // Three hundred tubes that hang in a grid and swing against their neighbours.
    const COLUMNS: usize = 20;
    let (count, radius, half) = (300, 0.01, 0.1);
    let mut scene = Scene::new(Vec::new(), Vec::new());
    for i in 0..count {
        let at = DVec3::new((i % COLUMNS) as f64, 0.0, (i / COLUMNS) as f64) * 0.04;
        let inertia = DVec3::new(1.0, 0.02, 1.0) * (0.1 * 4.0 * half * half / 12.0);
        let mut tube = body(0.1, inertia, at);
        let hook = at + DVec3::Y * half;
        let away = 2.0 * ((i * 37 % 11) as f64 / 10.0 - 0.5);
        tube.angular_velocity = DVec3::new(away, 0.0, -2.0 * away);
        tube.velocity = tube.angular_velocity.cross(at - hook);
        scene.bodies.push(tube);
        let nail = ConstraintKind::PointToPoint { a: anchor(Some(i), DVec3::Y * half), b: anchor(None, hook) };
        scene.constraints.push(Constraint::new(&format!("nail-{i}"), nail));
        let end = DVec3::Y * (half - radius);
        scene.colliders.push(collider(Some(i), Shape::capsule(-end, end, radius)));
    }
    let mut dynamics = scene.dynamics();
    let no_wrenches = vec![[0.0; 6]; count];
    let mut impacts = Vec::new();
    let mut most = 0.0_f64;
    for _ in 0..60 {
        assert_eq!(dynamics.step(DT, &no_wrenches, &mut impacts), None, "bad numbers");
        // A cut substep measures twice.
        most = most.max(dynamics.measured_pairs() as f64 / f64::from(dynamics.substeps()));
    }
    let all = count * (count - 1) / 2;
    println!("{} hits; at most {most:.0} of {all} pairs measured in a substep", impacts.len());
    assert!(impacts.len() > 10, "they hardly meet");
    // Four neighbours each, half of a pair each, and a few that swing past.
    assert!(most < 4.0 * count as f64, "{most} of {all} pairs");
}

/// A chain of rods with colliders that hangs from the origin, each rod displaced.
fn scattered(seed: u64) -> Scene {
    let (count, half, radius) = (6, 0.05, 0.006);
    let mut random = soffio_math::noise::Random::new(seed);
    let mut scene = Scene::new(Vec::new(), Vec::new());
    scene.damping = 1.0;
    for i in 0..count {
        let inertia = DVec3::new(1.0, 0.02, 1.0) * (0.02 * 4.0 * half * half / 12.0);
        let mut any = || DVec3::new(random.signed(), random.signed(), random.signed());
        let mut rod = body(0.02, inertia, DVec3::Y * (-half * (2 * i + 1) as f64) + 0.15 * any());
        rod.rotation = rotation(2.0 * any());
        scene.bodies.push(rod);
        let above = if i == 0 { anchor(None, DVec3::ZERO) } else { anchor(Some(i - 1), DVec3::Y * -half) };
        let point = ConstraintKind::PointToPoint { a: anchor(Some(i), DVec3::Y * half), b: above };
        scene.constraints.push(Constraint::new(&format!("link-{i}"), point));
        let end = DVec3::Y * (half - 2.5 * radius);
        scene.colliders.push(collider(Some(i), Shape::capsule(-end, end, radius)));
    }
    scene
}

#[test]
fn joints_closing_past_obstacles_neither_burst_nor_pass_through() {
    /// Faster than this it would be thrown, m/s: the stabiliser closes half a metre at 0.5/(e · 0.04 s).
    const THROWN: f64 = 50.0;
    let mut closed = 0;
    let count = 24;
    for seed in 0..count {
        let scene = scattered(seed);
        let mut dynamics = scene.dynamics();
        let no_wrenches = vec![[0.0; 6]; dynamics.bodies.len()];
        let mut fastest: f64 = 0.0;
        for step in 0..240 * 4 {
            assert_eq!(dynamics.step(DT, &no_wrenches, &mut Vec::new()), None, "seed {seed}, step {step}: bad numbers");
            fastest = dynamics.bodies.iter().fold(fastest, |most, b| most.max(b.velocity.length()));
        }
        assert!(fastest < THROWN, "seed {seed}: {fastest} m/s");
        // Rods may be caught crosswise; most are not.
        closed += u64::from(dynamics.joint_error() < 1e-9);
        let now = dynamics.bodies.iter().fold(0.0, |most: f64, b| most.max(b.velocity.length()));
        assert!(now < 2.0, "seed {seed}: still {now} m/s");
    }
    println!("{closed} of {count} gathered");
    assert!(closed * 4 >= 3 * count, "{closed} of {count} gathered");
}

#[test]
fn an_obstacle_stops_a_closing_joint_without_growing_force() {
    // A ball is pulled to a nail behind a wall: it rests against the wall, which bears the stabiliser's force.
    let r = 0.01;
    let mut scene = Scene::new(vec![ball(0.1, r, DVec3::new(0.05, 0.0, 0.0))], Vec::new());
    scene.gravity = DVec3::ZERO;
    scene.friction = 0.0;
    let nail = ConstraintKind::PointToPoint { a: anchor(Some(0), DVec3::ZERO), b: anchor(None, DVec3::X * -0.1) };
    scene.constraints = vec![Constraint::new("nail", nail)];
    let wall = Shape::plane(DVec3::ZERO, DVec3::X);
    scene.colliders = vec![sphere(0, r), collider(None, wall)];
    let mut dynamics = scene.dynamics();
    run(&mut dynamics, 1.0);
    for second in 0..10 {
        run(&mut dynamics, 1.0);
        let (at, speed) = (dynamics.bodies[0].position, dynamics.bodies[0].velocity.length());
        assert!((at - DVec3::X * r).length() < 1e-4, "after {second} s at {at}");
        assert!(speed < 0.05, "after {second} s at {speed} m/s");
    }
}

/// Two wheels with a play of `play` (m, at the pitch circles) between their teeth.
fn loose_gear(play: f64) -> Dynamics {
    let wheel = |x: f64, mass: f64| body(mass, DVec3::splat(mass * 1e-3), DVec3::X * x);
    let mut scene = Scene::new(vec![wheel(0.0, 0.2), wheel(0.09, 0.1)], Vec::new());
    scene.gravity = DVec3::ZERO;
    for (i, x) in [0.0, 0.09].into_iter().enumerate() {
        scene.constraints.extend(hinge(i, DVec3::X * x, DVec3::ZERO));
    }
    let term = |body, coefficient| Term { measure: angle_about_z(body), coefficient };
    let kind = LimitKind::Play { terms: [term(0, 0.06), term(1, 0.03)], play };
    scene.limits = vec![Limit { name: "mesh".into(), kind, restitution: 0.0 }];
    scene.dynamics()
}

/// r₁ φ₁ + r₂ φ₂, m.
fn slack(dynamics: &Dynamics) -> f64 {
    let angle = |i: usize| 2.0 * dynamics.bodies[i].rotation.z.atan2(dynamics.bodies[i].rotation.w);
    0.06 * angle(0) + 0.03 * angle(1)
}

#[test]
fn loose_teeth_meet_flank_by_flank_and_lose_the_impact_s_energy() {
    const PLAY: f64 = 2e-3;
    let (i1, i2, r1, r2) = (2e-4, 1e-4, 0.06, 0.03);
    let mut dynamics = loose_gear(PLAY);
    dynamics.bodies[0].angular_velocity = DVec3::Z * 0.5;
    // Free until half the play is taken up: 1 mm at 30 mm/s.
    let before = run(&mut dynamics, 0.032);
    assert!(before.is_empty() && dynamics.bodies[1].angular_velocity.length() < 1e-12, "{before:?}");
    let energy = dynamics.energy();
    let hits = run(&mut dynamics, 0.01);
    assert_eq!((hits.len(), hits[0].kind), (1, ImpactKind::Stop), "{hits:?}");
    // ω₁' = ω₁ − r₁ P/I₁, ω₂' = − r₂ P/I₂, r₁ ω₁' + r₂ ω₂' = 0.
    let p = r1 * 0.5 / (r1 * r1 / i1 + r2 * r2 / i2);
    let (w1, w2) = (0.5 - r1 * p / i1, -r2 * p / i2);
    let found = [0, 1].map(|i| dynamics.bodies[i].angular_velocity.z);
    assert!((found[0] - w1).abs() < 1e-9 && (found[1] - w2).abs() < 1e-9, "{found:?} against {w1} and {w2}");
    let lost = energy - dynamics.energy();
    let expected = 0.5 * p * r1 * 0.5;
    assert!((lost / expected - 1.0).abs() < 1e-9, "lost {lost} J of {expected} J");
    assert!((dynamics.contact_work() + lost).abs() < 1e-9 * lost, "the ledger says {} J", dynamics.contact_work());
    // Driven on it drives the other wheel without play, at the ratio; then back across all of the play.
    let drive = |dynamics: &mut Dynamics, torque: f64, steps: usize| {
        let external = [[0.0, 0.0, 0.0, 0.0, 0.0, torque], [0.0; 6]];
        let mut impacts = Vec::new();
        let mut range = (f64::INFINITY, f64::NEG_INFINITY);
        for _ in 0..steps {
            dynamics.step(DT, &external, &mut impacts);
            let slack = slack(dynamics);
            range = (range.0.min(slack), range.1.max(slack));
        }
        (impacts, range)
    };
    let (_, range) = drive(&mut dynamics, 1e-3, 60);
    assert!(range.0 > 0.5 * PLAY - 1e-5 && range.1 < 0.5 * PLAY + 1e-5, "{range:?}");
    let ratio = dynamics.bodies[1].angular_velocity.z / dynamics.bodies[0].angular_velocity.z;
    assert!((ratio + 2.0).abs() < 1e-6, "{ratio}");
    let (back, range) = drive(&mut dynamics, -1e-3, 240);
    assert!(back.iter().any(|impact| impact.kind != ImpactKind::Impact), "{back:?}");
    assert!(range.0 > -0.5 * PLAY - 1e-5 && range.0 < -0.5 * PLAY + 1e-5 && range.1 < 0.5 * PLAY + 1e-5, "{range:?}");
    // I₁ ω₁ − I₂ ω₂ r₁/r₂ grows by the torque's impulse alone, on whatever flank.
    let momentum = |d: &Dynamics| i1 * d.bodies[0].angular_velocity.z - 2.0 * i2 * d.bodies[1].angular_velocity.z;
    let start = momentum(&dynamics);
    let (_, _) = drive(&mut dynamics, 5e-4, 480);
    let gained = momentum(&dynamics) - start;
    assert!((gained / (5e-4 * 2.0) - 1.0).abs() < 1e-9, "gained {gained}");
}

#[test]
fn each_constraint_closes_with_its_own_time_constant() {
    // Critically damped: C = C₀ (1 + t/τ) exp(−t/τ).
    const PACE: f64 = 1e-4;
    let mut scene = Scene::new(vec![ball(0.1, 0.01, DVec3::X * 0.2), ball(0.1, 0.01, DVec3::Z * 0.2)], Vec::new());
    let nail = |body| ConstraintKind::PointToPoint { a: anchor(Some(body), DVec3::ZERO), b: anchor(None, DVec3::ZERO) };
    scene.constraints = vec![Constraint::new("own", nail(0)), Constraint::new("figure's", nail(1))];
    scene.constraints[0].stabilization_time = Some(0.1);
    let mut dynamics = scene.dynamics();
    run(&mut dynamics, 0.1);
    for (body, time) in [(0, 0.1), (1, settings().stabilization_time)] {
        let x: f64 = 0.1 / time;
        let expected = 0.2 * (1.0 + x) * (-x).exp();
        let found = dynamics.bodies[body].position.length();
        assert!((found - expected).abs() < PACE * 0.2, "{found} against {expected} m with {time} s");
    }
}
