//! Kinematic bodies follow paths and glTF animations; nails move with them.

use soffio_exhibit::{self as exhibit, Exhibit, codes};
use soffio_math::Interpolation;
use soffio_math::{DVec3, PI, Pose, cos, rotation, rotation_vector, sin};
use soffio_multibody::articulation::ConstraintKind;
use soffio_multibody::dynamics::KeyframeMotion;

use super::glb::{Folder, Scene, cuboid};

/// glTF holds single precision: seven digits.
const SINGLE: f64 = 1e-6;

/// A stand that holds still at (0, 1, 0), turned by 90° about y; below it Swing, and Box beside them.
fn scene() -> (Scene, usize) {
    let mut scene = Scene::default();
    let swing = scene.node("Swing", [0.0, 0.0, 0.5], Some(&cuboid([0.1; 3])), &[]);
    let stand = scene.node("Stand", [0.0, 1.0, 0.0], None, &[swing]);
    let half = 0.5_f32.sqrt();
    scene.set(stand, "rotation", serde_json::json!([0.0, half, 0.0, half]));
    scene.node("Box", [0.5, 1.0, 0.0], Some(&cuboid([0.1; 3])), &[]);
    (scene, swing)
}

fn load(scene: &Scene, text: &str) -> Exhibit {
    exhibit::load(Folder::exhibit(&scene.glb(), text).path()).unwrap_or_else(|report| panic!("{}", report.to_text()))
}

const BOX: &str = "[[body]]\nnode = \"Box\"\nmaterial = \"oak\"\n";

#[test]
fn a_linear_animation_is_followed_through_still_parents() {
    let (mut scene, swing) = scene();
    scene.animate("Glide", swing, "translation", "LINEAR", &[(0.0, vec![0.0, 0.0, 0.5]), (2.0, vec![0.0, 1.0, 0.5])]);
    let turn = |angle: f64| vec![0.0, 0.0, sin(0.5 * angle) as f32, cos(0.5 * angle) as f32];
    scene.animate("Turn", swing, "rotation", "LINEAR", &[(0.0, turn(0.0)), (1.0, turn(1.0)), (2.0, turn(0.0))]);
    let text = "[[body]]\nnode = \"Swing\"\nmotion = \"kinematic\"\n";
    let glide = load(&scene, text);
    assert_eq!((glide.bodies.len(), glide.drives.len(), glide.drives[0].body), (1, 1, 0));
    // z of the node's parent is x of the world; y stays.
    let at = glide.drives[0].motion.at(0.5);
    assert!(at.pose.position.distance(DVec3::new(0.5, 1.25, 0.0)) < SINGLE, "{:?}", at.pose);
    assert!(at.velocity.distance(DVec3::new(0.0, 0.5, 0.0)) < SINGLE);
    // Animations loop by default.
    assert!(glide.drives[0].motion.at(2.5).pose.position.distance(at.pose.position) < SINGLE);
    let once = load(&scene, &format!("{text}animation = {{ name = \"Turn\", loop = false }}\n"));
    let motion = &once.drives[0].motion;
    assert!(motion.at(0.5).angular_velocity.distance(DVec3::X) < SINGLE, "{:?}", motion.at(0.5));
    assert_eq!(motion.at(2.5).angular_velocity, DVec3::ZERO);
}

#[test]
fn stepped_and_cubic_animations_are_interpolated_as_gltf_says() {
    let (mut scene, swing) = scene();
    scene.animate(
        "Hop",
        swing,
        "translation",
        "STEP",
        &[(0.0, vec![0.0; 3]), (1.0, vec![0.0, 1.0, 0.0]), (2.0, vec![0.0; 3])],
    );
    // From 0 to 1 with flat ends: 3s² − 2s³, in-tangent, value and out-tangent at each key.
    let flat = |y: f32| vec![0.0, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, 0.0];
    scene.animate("Rise", swing, "translation", "CUBICSPLINE", &[(0.0, flat(0.0)), (2.0, flat(1.0))]);
    let with = |name: &str| {
        load(
            &scene,
            &format!("[[body]]\nnode = \"Swing\"\nmotion = \"kinematic\"\nanimation = {{ name = \"{name}\" }}\n"),
        )
    };
    let hop = &with("Hop").drives[0].motion;
    assert_eq!((hop.at(0.9).pose.position.y, hop.at(1.1).pose.position.y), (1.0, 2.0));
    let rise = &with("Rise").drives[0].motion;
    /// The cubic is followed through 60 poses a second: error h⁴ f⁗ and rounding of the file; more at the ends, where
    /// it begins with a jerk.
    const FOLLOWED: f64 = 1e-4;
    for i in 0..=20 {
        let t = 0.1 * f64::from(i).min(19.99);
        let s = t / 2.0;
        let found = rise.at(t).pose.position.y - 1.0;
        assert!((found - s * s * (3.0 - 2.0 * s)).abs() < FOLLOWED, "{found} at {t} s");
    }
    assert!((rise.at(1.0).velocity.y - 0.75).abs() < 10.0 * FOLLOWED);
}

#[test]
fn a_nail_on_a_path_or_a_kinematic_node_moves() {
    let text = format!(
        "{BOX}[[constraint.nail]]\nname = \"thread\"\nbody = \"Box\"\n\
         to = {{ path = {{ points = [[0, 0.5, 1, 0], [1, 0.6, 1.2, 0], [2, 0.5, 1, 0]], loop = true }} }}\n"
    );
    let exhibit = load(&scene().0, &text);
    let ConstraintKind::PointToPoint { a, b } = &exhibit.constraints[0].kind else { panic!("not a nail") };
    assert_eq!((a.body, b.body, exhibit.drives[0].body), (Some(0), Some(1), 1));
    let carrier = &exhibit.bodies[1];
    assert_eq!(exhibit.model.nodes[carrier.node].name, "thread/path");
    assert!(carrier.properties.mass > 0.0 && exhibit.drives[0].motion.interpolation == Interpolation::Spline);
    assert!(exhibit.drives[0].motion.at(1.0).pose.point(b.point).distance(DVec3::new(0.6, 1.2, 0.0)) < SINGLE);

    let text = format!(
        "{BOX}[[body]]\nnode = \"Swing\"\nmotion = \"kinematic\"\npath = {{ points = [[0, 0.5, 1, 0], [1, 0.5, 2, 0]] }}\n\
         [[constraint.nail]]\nname = \"hook\"\nbody = \"Box\"\nto = {{ node = \"Swing\" }}\n"
    );
    let exhibit = load(&scene().0, &text);
    let ConstraintKind::PointToPoint { b, .. } = &exhibit.constraints[0].kind else { panic!("not a nail") };
    assert_eq!((b.body, exhibit.drives[0].body), (Some(1), 1));
}

#[test]
fn a_mechanism_may_start_scattered_only_if_it_assembles() {
    let nail = "[[constraint.nail]]\nname = \"pin\"\nbody = \"Box\"\nto = [0.5, 1, 0]\n";
    let scattered = format!("{BOX}initial = {{ position = [2, 0, \"30 cm\"], rotation = [0, 0, 0.6, 0.8] }}\n{nail}");
    let report = exhibit::load(Folder::exhibit(&scene().0.glb(), &scattered).path()).expect_err("it would be torn");
    assert!(report.has(codes::APART), "{report}");
    let exhibit = load(
        &scene().0,
        &format!("{scattered}[solver]\nassemble = true\nstabilize = {{ time_constant = \"80 ms\" }}\n"),
    );
    let ConstraintKind::PointToPoint { a, .. } = &exhibit.constraints[0].kind else { panic!("not a nail") };
    // The body starts elsewhere, and the nail goes where the model has it.
    assert!(exhibit.bodies[0].pose.position.distance(DVec3::new(2.0, 0.0, 0.3)) < SINGLE);
    assert!(a.point.length() < SINGLE && exhibit.stabilization_time == 0.08);
    let turned = rotation_vector(exhibit.bodies[0].pose.rotation);
    assert!(turned.distance(2.0 * soffio_math::asin(0.6) * DVec3::Z) < SINGLE);
}

#[test]
fn the_solver_is_chosen_in_the_sidecar() {
    use soffio_multibody::dynamics::{Integrator, Solver};
    let text =
        format!("{BOX}[solver]\nintegrator = \"runge-kutta\"\nmethod = \"dense\"\n[scene]\nduration = \"5 min\"\n");
    let exhibit = load(&scene().0, &text);
    assert_eq!((exhibit.integrator, exhibit.solver), (Integrator::RungeKutta, Solver::Dense));
    assert_eq!((exhibit.duration, exhibit.stabilization_time), (300.0, 0.04));
    let plain = load(&scene().0, BOX);
    assert_eq!((plain.integrator, plain.solver, plain.duration), (Integrator::Auto, Solver::Sparse, f64::INFINITY));
}

#[test]
fn a_splines_velocities_and_accelerations_are_those_of_its_poses() {
    /// Central differences of width 1e-5 s.
    const DIFFERENCE: f64 = 1e-4;
    let pose = |x: f64, y: f64, w: DVec3| Pose { rotation: rotation(w), position: DVec3::new(x, y, 0.3 * x * y) };
    let keys = vec![
        (0.0, pose(0.0, 0.0, DVec3::ZERO)),
        (0.7, pose(1.0, -0.5, DVec3::new(0.4, 0.9, -0.3))),
        (1.5, pose(0.4, 0.8, DVec3::new(-1.1, 0.2, 0.8))),
        (2.0, pose(0.1, 0.3, DVec3::new(0.0, 0.3 * PI, 0.1))),
        (3.0, pose(0.0, 0.0, DVec3::ZERO)),
    ];
    for repeat in [false, true] {
        let motion = KeyframeMotion { keys: keys.clone(), interpolation: Interpolation::Spline, repeat };
        for (t, wanted) in &keys[..4] {
            assert!(motion.at(*t).pose.position.distance(wanted.position) < SINGLE);
            let (before, after) = (motion.at(t + 3.0 - 1e-9), motion.at(t + 3.0 + 1e-9));
            if repeat {
                assert!(before.velocity.distance(after.velocity) < SINGLE, "v jumps at {t} s");
                assert!(before.angular_velocity.distance(after.angular_velocity) < SINGLE, "ω jumps at {t} s");
                assert!(before.angular_acceleration.distance(after.angular_acceleration) < 1e-4, "ω̇ jumps at {t} s");
                assert!(before.acceleration.distance(after.acceleration) < 1e-4, "a jumps at {t} s");
            }
        }
        for i in 1..60 {
            let (t, h) = (0.049 * f64::from(i) + 0.0071, 1e-5);
            let (before, here, after) = (motion.at(t - h), motion.at(t), motion.at(t + h));
            let v = (after.pose.position - before.pose.position) / (2.0 * h);
            let w = rotation_vector(after.pose.rotation * before.pose.rotation.conjugate());
            let w = if w.length() > PI { w - 2.0 * PI * w.normalize() } else { w } / (2.0 * h);
            let a = (after.velocity - before.velocity) / (2.0 * h);
            let alpha = (after.angular_velocity - before.angular_velocity) / (2.0 * h);
            assert!(v.distance(here.velocity) < DIFFERENCE, "v at {t} s");
            assert!(w.distance(here.angular_velocity) < DIFFERENCE, "ω at {t} s: {w} {}", here.angular_velocity);
            assert!(a.distance(here.acceleration) < 10.0 * DIFFERENCE, "a at {t} s");
            assert!(alpha.distance(here.angular_acceleration) < 10.0 * DIFFERENCE, "ω̇ at {t} s: {alpha}");
        }
    }
}
