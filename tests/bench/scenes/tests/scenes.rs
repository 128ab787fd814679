//! Every generated scene is valid, the same each time, and stands a short run.

use soffio_multibody::dynamics::{Integrator, Solver};
use soffio_offline::scene::run::{Limits, observe};
use soffio_offline::scene::{PhysicsScene, Soffio};

/// Step, s.
const DT: f64 = 1.0 / 240.0;

fn all() -> Vec<PhysicsScene> {
    soffio_scenes::measured().into_iter().chain(soffio_scenes::tuning()).collect()
}

#[test]
fn every_scene_is_read_back_as_it_was_made_and_has_a_name_of_its_own() {
    let scenes = all();
    for (scene, again) in scenes.iter().zip(all()) {
        let text = scene.to_json();
        assert_eq!(text, again.to_json(), "{}: made twice", scene.name);
        let read = PhysicsScene::parse(&text, &scene.name).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(&read, scene);
    }
    let mut names: Vec<_> = scenes.iter().map(|scene| &scene.name).collect();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), scenes.len());
}

#[test]
fn the_stated_sizes_are_there() {
    let scenes = soffio_scenes::measured();
    for (name, bodies, joints) in [
        ("tower_20", 20, 0),
        ("pile_50", 50, 0),
        ("pegs_100", 100, 0),
        ("chimes_200", 200, 200),
        ("cradle_7_gap_0.2mm", 7, 7),
        ("contacts_1000", 250, 0),
        ("ladder_160_limits", 480, 640),
        ("net_176", 176, 228),
    ] {
        let scene = scenes.iter().find(|scene| scene.name == name).unwrap_or_else(|| panic!("no scene {name}"));
        assert_eq!((scene.bodies.len(), scene.joints.len()), (bodies, joints), "{name}");
    }
}

#[test]
fn nothing_overlaps_at_the_start_and_a_step_of_each_goes_well() {
    /// Corners that touch exactly, m.
    const TOUCHING: f64 = 1e-9;
    /// Nothing moves within it, s.
    const INSTANT: f64 = 1e-6;
    for scene in all() {
        let mut engine = Soffio::new(&scene, INSTANT, Integrator::Auto, Solver::Sparse);
        let watched = observe(&scene, &mut engine, INSTANT, Limits { seconds: INSTANT, budget: f64::INFINITY });
        assert_eq!(watched.report.diverged_at_s, None, "{}", scene.name);
        if let Some(contacts) = watched.report.contacts {
            assert!(contacts.max_penetration_m < TOUCHING, "{}: {contacts:?}", scene.name);
        }
    }
}

#[test]
fn a_short_run_of_every_small_scene_stands() {
    /// Bodies of a small scene: the debug build runs all of them within seconds.
    const SMALL: usize = 20;
    /// Twelve steps, s.
    const SHORT: f64 = 0.05;
    for scene in all().into_iter().filter(|scene| scene.bodies.len() <= SMALL) {
        let mut engine = Soffio::new(&scene, DT, Integrator::Auto, Solver::Sparse);
        let watched = observe(&scene, &mut engine, DT, Limits { seconds: SHORT, budget: f64::INFINITY });
        assert_eq!(watched.report.diverged_at_s, None, "{}: {:?}", scene.name, watched.report);
        assert_eq!(watched.times.us().len(), 12, "{}: a step for each time", scene.name);
    }
}

#[test]
fn of_a_cradle_the_last_ball_leaves_as_the_first_one_came() {
    /// Share of the first ball's speed that the last one may lack, and that ten strikes may differ by: balls with gaps between them
    /// do not hang still, and take a little.
    const LEAVES: f64 = 0.02;
    const STRIKES: f64 = 0.05;
    for scene in soffio_scenes::measured().into_iter().filter(|scene| scene.name.starts_with("cradle")) {
        let mut dynamics = scene.dynamics(Integrator::Auto, Solver::Sparse);
        let (still, mut impacts) = (vec![[0.0; 6]; scene.bodies.len()], Vec::new());
        let last = scene.bodies.len() - 1;
        let (mut strikes, mut quiet, mut leaves) = (Vec::new(), 0.0, 0.0_f64);
        for step in 0..1440 {
            impacts.clear();
            dynamics.step(DT, &still, &mut impacts);
            let hardest = impacts.iter().map(|impact| impact.speed).fold(0.0, f64::max);
            if hardest > 0.5 && f64::from(step) * DT - quiet > 0.2 {
                strikes.push(hardest);
            }
            if hardest > 0.5 {
                quiet = f64::from(step) * DT;
            }
            if strikes.len() == 1 {
                leaves = leaves.max(dynamics.bodies[last].velocity.length());
            }
        }
        let share = |speed: f64| (speed / strikes[0] - 1.0).abs();
        assert!(share(leaves) < LEAVES, "{}: {leaves} of {} m/s", scene.name, strikes[0]);
        assert!(strikes.len() >= 10, "{}: {strikes:?}", scene.name);
        assert!(strikes[..10].iter().all(|speed| share(*speed) < STRIKES), "{}: {strikes:?}", scene.name);
    }
}
