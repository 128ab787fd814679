//! Orbit camera: the angle of a pull, its soft limits and its return. Breath and pointer follow the visible directions, a record replays
//! the same run, and pictures show the exhibit from the computed viewpoint.

use std::sync::Arc;

use soffio_exhibit::{Attract, AttractAction, AttractStep, Exhibit, OrbitLimits, View};
use soffio_kiosk::live::recording::Recording;
use soffio_kiosk::step::controls::Controls;
use soffio_kiosk::step::stage::Stage;
use soffio_kiosk::visitor::gesture::{Lift, Press};
use soffio_kiosk::visitor::orbit::{PRESS, TURN, soft};
use soffio_math::Pose;
use soffio_simulation::{Settings, Simulation, record};

use super::pages::load;
use crate::pictures::{mobile, renderer};

const ASPECT: f64 = 16.0 / 9.0;
/// A place beside every work that is looked at here.
const BESIDE: [f64; 2] = [0.06, 0.85];
/// Steps in which the camera has followed, and in which it has come home: many of its time constants.
const FOLLOWED: usize = 2 * 240;
const HOME: usize = 5 * 240;

/// Somebody looks round.
fn round() -> Controls {
    Controls { aspect: ASPECT, look_around: true, ..Controls::default() }
}

/// A finger goes that way (picture heights, right and down) from beside the work, in a third of a second, and lifts.
fn drag(stage: &mut Stage, controls: &Controls, way: [f64; 2]) {
    const STEPS: usize = 80;
    let at = |share: f64| [BESIDE[0] + share * way[0] / ASPECT, BESIDE[1] + share * way[1]];
    for i in 0..=STEPS {
        let press = Press { id: 5, at: at(i as f64 / STEPS as f64) };
        stage.step(&Controls { presses: vec![press], ..controls.clone() }, None);
    }
    let lift = Lift { id: 5, from: BESIDE, at: at(1.0) };
    stage.lift(lift);
    stage.step(controls, None);
}

fn stage(id: &str) -> Stage {
    Stage::new(load(id), Settings::default(), None, None)
}

fn wait(stage: &mut Stage, controls: &Controls, steps: usize) {
    (0..steps).for_each(|_| stage.step(controls, None));
}

#[test]
fn a_pull_beside_the_work_turns_it_as_far_as_it_goes_and_nothing_else() {
    /// Where the camera stops for good.
    const THERE: f64 = 1e-4;
    for way in [[0.3, 0.0], [-0.2, 0.15]] {
        let mut stage = stage("steel-fish");
        drag(&mut stage, &round(), way);
        wait(&mut stage, &round(), FOLLOWED);
        let state = stage.snapshot();
        let wanted = [-TURN * way[0], TURN * way[1]];
        for (turn, wanted) in state.turn.iter().zip(wanted) {
            assert!((turn - wanted).abs() < THERE, "{way:?}: {:?} instead of {wanted:?}", state.turn);
        }
        assert_eq!(
            (state.breath.speed, state.diagnostics.grabs, stage.swipes()),
            (0.0, 0, 0),
            "no breath, hand or swipe"
        );
    }
    // Without having asked to look round, the same pull blows and turns nothing.
    let mut stage = stage("steel-fish");
    let plain = Controls { look_around: false, ..round() };
    drag(&mut stage, &plain, [0.1, 0.0]);
    assert!(stage.snapshot().breath.speed > 0.0 && stage.snapshot().turn == [0.0; 2]);
}

#[test]
fn ends_are_soft_nothing_goes_beyond_and_whoever_pulls_back_is_answered() {
    for id in ["steel-fish", "billiards", "terry-clock", "twelve-moons"] {
        let leeway = load(id).orbit_limits(ASPECT);
        let OrbitLimits { yaw: aside, down, up } = leeway;
        for (way, end, axis) in
            [([-3.0, 0.0], aside, 0), ([3.0, 0.0], aside, 0), ([0.0, 3.0], up, 1), ([0.0, -3.0], down, 1)]
        {
            let mut stage = stage(id);
            let mut last = 0.0;
            for _ in 0..3 {
                drag(&mut stage, &round(), way);
                for _ in 0..FOLLOWED {
                    stage.step(&round(), None);
                    let turn = stage.snapshot().turn[axis].abs();
                    assert!(turn >= last && turn <= end, "{id} {way:?}: {turn} after {last}, {end} at the most");
                    last = turn;
                }
            }
            assert!(last > 0.9 * end, "{id} {way:?}: {last} of {end}");
            let there = stage.snapshot().turn[axis];
            drag(&mut stage, &round(), way.map(|x| -0.1 * x));
            wait(&mut stage, &round(), FOLLOWED);
            let back = stage.snapshot().turn[axis] * there.signum();
            assert!(end == 0.0 || back < 0.95 * last, "{id} {way:?}: {back} after {last}");
        }
    }
    // One slope at the joint, and less and less beyond.
    const SMALL: f64 = 1e-6;
    let slope = |goal: f64| (soft(goal + SMALL, 1.0) - soft(goal - SMALL, 1.0)) / (2.0 * SMALL);
    assert!((slope(0.75) - 1.0).abs() < 10.0 * SMALL && slope(1.0) < 0.5 && slope(-1.0) < 0.5 && soft(9.0, 1.0) <= 1.0);
}

#[test]
fn it_neither_jerks_nor_overshoots_and_with_less_motion_it_stops_with_the_finger() {
    let mut stage = stage("steel-fish");
    drag(&mut stage, &round(), [-0.3, 0.0]);
    let before = stage.snapshot().turn[0];
    let way: Vec<f64> = (0..FOLLOWED)
        .map(|_| {
            stage.step(&round(), None);
            stage.snapshot().turn[0]
        })
        .collect();
    assert!(way.windows(2).all(|w| w[1] >= w[0]) && way[0] > before, "it only goes on");
    assert!(*way.last().expect("steps") <= TURN * 0.3 + 1e-9, "and not beyond");
    let calm = Controls { reduced_motion: true, ..round() };
    let mut stage = self::stage("steel-fish");
    drag(&mut stage, &calm, [-0.3, 0.0]);
    let stopped = stage.snapshot().turn;
    wait(&mut stage, &calm, 240);
    assert_eq!(stage.snapshot().turn, stopped, "nothing moves by itself");
    assert!((stopped[0] - TURN * 0.3).abs() < 1e-9, "{stopped:?}");
    stage.step(&Controls { look_around: false, ..calm }, None);
    assert_eq!(stage.snapshot().turn, [0.0; 2], "and it is back at once");
}

#[test]
fn keys_and_sticks_turn_and_a_press_turns_for_whoever_presses_once() {
    let mut stage = stage("steel-fish");
    let stick = Controls { stick: [0.5, -0.25], ..round() };
    wait(&mut stage, &stick, 120);
    wait(&mut stage, &round(), FOLLOWED);
    let [right, up] = stage.snapshot().turn;
    assert!((right - 0.25 * TURN).abs() < 1e-4 && (up - 0.125 * TURN).abs() < 1e-4, "{right} {up}");
    // As a pointer that rests presses: down and up between two steps.
    let once = Controls { press_once: true, ..round() };
    let mut stage = self::stage("steel-fish");
    for (at, turned) in [([0.95, 0.6], [PRESS, 0.0]), ([0.04, 0.6], [0.0, 0.0])] {
        let lift = Lift { id: 1, from: at, at };
        stage.lift(lift);
        stage.step(&once, None);
        wait(&mut stage, &once, FOLLOWED);
        let turn = stage.snapshot().turn;
        assert!((turn[0] - turned[0]).abs() < 1e-4 && turn[1] == turned[1], "{at:?}: {turn:?}");
        assert!(!stage.holds(), "and no breath begins");
    }
}

#[test]
fn it_comes_home_when_nobody_is_there_when_it_is_asked_to_and_with_another_work() {
    let idle = Some(3.0);
    let mut stage = Stage::new(load("steel-fish"), Settings::default(), None, idle);
    drag(&mut stage, &round(), [-0.4, 0.1]);
    wait(&mut stage, &round(), 240);
    assert!(stage.snapshot().turn[0] > 0.4);
    wait(&mut stage, &round(), 3 * 240 + HOME);
    assert!(stage.attracts());
    assert_eq!(stage.snapshot().turn, [0.0; 2], "the work's own view, to the bit");
    let mut stage = self::stage("steel-fish");
    drag(&mut stage, &round(), [-0.4, 0.1]);
    let far = stage.snapshot().turn[0];
    let plain = Controls { look_around: false, ..round() };
    stage.step(&plain, None);
    assert!(stage.snapshot().turn[0] > 0.8 * far, "softly");
    wait(&mut stage, &plain, HOME);
    assert_eq!(stage.snapshot().turn, [0.0; 2]);
    drag(&mut stage, &round(), [-0.4, 0.1]);
    stage.swap(load("wind-chimes"), None);
    stage.step(&plain, None);
    assert_eq!(stage.snapshot().turn, [0.0; 2], "another work is seen from its own view");
}

#[test]
fn the_attract_script_leads_it_softly_round_and_home_and_nowhere_where_less_motion_is_wanted() {
    /// Remaining share of the path after eight seconds, and of the return path after two.
    const NEARLY: f64 = 0.02;
    /// Fastest turn of two equal lags of 0.8/s, of the way, 1/s: 0.8/e.
    const FASTEST: f64 = 0.8 / std::f64::consts::E;
    /// A step of 1/240 s is a little of a lag.
    const STEP: f64 = 1e-4;
    const THERE: [f64; 2] = [0.3, 0.1];
    let led = |controls: &Controls| {
        let mut fish = (*load("steel-fish")).clone();
        let look = |at, there| AttractStep { at, action: AttractAction::Look(there) };
        fish.attract = Attract { steps: vec![look(1.0, THERE)], duration: 10.0 };
        let mut stage = Stage::new(Arc::new(fish), Settings::default(), None, Some(1.0));
        // Two seconds of nobody, then the way there.
        let mut turns = Vec::new();
        for _ in 0..10 * 240 {
            stage.step(controls, None);
            turns.push(stage.snapshot().turn);
        }
        (stage, turns)
    };
    let plain = Controls { aspect: ASPECT, ..Controls::default() };
    let (stage, turns) = led(&plain);
    let last = *turns.last().expect("steps");
    for i in 0..2 {
        assert!((last[i] - THERE[i]).abs() < NEARLY * THERE[i], "{last:?}");
        let fastest = turns.windows(2).map(|w| 240.0 * (w[1][i] - w[0][i])).fold(0.0, f64::max);
        assert!(fastest <= (1.0 + STEP) * FASTEST * THERE[i], "{fastest} rad/s");
        assert!(
            turns.windows(2).all(|w| w[1][i] >= w[0][i] && w[1][i] <= THERE[i]),
            "it neither turns back nor overshoots"
        );
    }
    // The round lasts a second more, and in the first of the next one nothing is said of the camera.
    let mut next_round = stage.clone();
    wait(&mut next_round, &plain, 2 * 240 - 10);
    let turn = next_round.snapshot().turn;
    assert!(next_round.attracts() && turn[0] < 0.9 * THERE[0], "{turn:?}: the next round begins at the front");
    let mut visited = stage;
    (1..=2 * 240).for_each(|activity| visited.step(&Controls { activity, ..plain.clone() }, None));
    assert!(
        !visited.attracts() && visited.snapshot().turn[0] < NEARLY * THERE[0],
        "and whoever comes has the work's own view"
    );
    let (stage, turns) = led(&Controls { reduced_motion: true, ..plain });
    assert!(
        stage.attracts() && turns.iter().all(|turn| *turn == [0.0; 2]),
        "nothing flies where less motion is wanted"
    );
}

#[test]
fn breath_and_hand_go_where_they_are_seen_to_go() {
    /// Half a pixel of a picture of full HD.
    const HALF_PIXEL: f64 = 0.5 / 1080.0;
    let exhibit = load("steel-fish");
    let settings = Settings { profile: soffio_simulation::Profile::Physical, ..Settings::default() };
    let mut stage = Stage::new(exhibit.clone(), settings, None, None);
    drag(&mut stage, &round(), [-0.4, 0.2]);
    wait(&mut stage, &round(), FOLLOWED);
    let view = exhibit.view(ASPECT).orbited(stage.snapshot().turn);
    let aim = [0.3, 0.4];
    wait(&mut stage, &Controls { aim: Some(aim), ..round() }, 240);
    let seen = view.project(stage.snapshot().breath.ring.center, ASPECT).expect("before the eye");
    assert!((seen[0] - aim[0]).abs() < HALF_PIXEL && (seen[1] - aim[1]).abs() < HALF_PIXEL, "{seen:?}");
    // A body is taken where this view shows it, and not where the other one would.
    let mut own = Simulation::new(exhibit.clone(), settings);
    let free = |at: [f64; 2], own: &mut Simulation| !own.hit_test(at, ASPECT);
    let at = stage
        .snapshot()
        .poses
        .iter()
        .filter_map(|pose| view.project(pose.position, ASPECT))
        .find(|at| free(*at, &mut own) && (0.05..0.95).contains(&at[0]) && takes(&stage, *at));
    assert!(at.is_some(), "nothing is taken only where it is seen");
}

/// Does a pull there take something?
fn takes(stage: &Stage, at: [f64; 2]) -> bool {
    let mut stage = stage.clone();
    for i in 0..40 {
        let press = Press { id: 8, at: [at[0] + 0.001 * f64::from(i), at[1]] };
        stage.step(&Controls { presses: vec![press], ..round() }, None);
    }
    stage.snapshot().diagnostics.grabs == 1
}

#[test]
fn a_record_of_it_is_the_same_run_to_the_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("day.jsonl");
    let fish = load("steel-fish");
    let mut stage = Stage::new(fish.clone(), Settings::default(), None, None);
    let mut recording = Recording::create(&path).expect("writable");
    recording.begin(&fish, Settings::default());
    let mut turns = Vec::new();
    for step in 0..4 * 240 {
        let t = f64::from(step) / 240.0;
        let presses = if t < 1.0 { vec![Press { id: 1, at: [BESIDE[0] + 0.2 * t, BESIDE[1]] }] } else { Vec::new() };
        stage.step(&Controls { presses, hold: (1.5..3.0).contains(&t), aim: Some([0.3, 0.4]), ..round() }, None);
        recording.record(&stage);
        turns.push(stage.snapshot().turn);
    }
    recording.end(&stage);
    recording.finish();
    let text = std::fs::read_to_string(&path).expect("a record");
    let mut parts = record::parse(&text).expect("a good record");
    let mut again = Simulation::new(fish, parts[0].begin.settings);
    for (step, turn) in (0..).zip(turns) {
        again.step(&parts[0].input(step));
        assert_eq!(again.snapshot().turn, turn, "step {step}");
    }
    assert_eq!(again.state_hash(), stage.state_hash());
    assert!(stage.snapshot().turn[0] < -0.3, "and it was turned: {:?}", stage.snapshot().turn);
}

/// The middle of what is red in a picture, picture coordinates.
fn red(picture: &image::RgbaImage) -> [f64; 2] {
    let (mut sum, mut count) = ([0.0; 2], 0.0);
    for (x, y, pixel) in picture.enumerate_pixels() {
        let [r, g, b, _] = pixel.0.map(f64::from);
        // The orange disc has half as much green.
        if r > 4.0 * g.max(b) && r > 60.0 {
            sum = [sum[0] + f64::from(x) + 0.5, sum[1] + f64::from(y) + 0.5];
            count += 1.0;
        }
    }
    assert!(count > 50.0, "{count} red pixels");
    [sum[0] / count / f64::from(picture.width()), sum[1] / count / f64::from(picture.height())]
}

/// The middle of the red plate's front as a view shows it: its triangles' middles, by the area that they cover.
fn seen(exhibit: &Arc<Exhibit>, view: &View, aspect: f64) -> [f64; 2] {
    let node = exhibit.model.nodes.iter().find(|node| node.name == "red").expect("a red plate");
    let mesh = &exhibit.model.meshes[node.mesh.expect("with a mesh")].primitives[0];
    let at = |i: u32| {
        let point = glam::Vec3::from_array(mesh.positions[i as usize]).as_dvec3();
        view.project(node.world.transform_point3(point), aspect).expect("before the eye")
    };
    let (mut sum, mut all) = ([0.0; 2], 0.0);
    // The first half are the fan of one side; the plate is as thin as paper.
    for triangle in mesh.indices.chunks_exact(3).take(4) {
        let [a, b, c] = [at(triangle[0]), at(triangle[1]), at(triangle[2])];
        let area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
        sum = std::array::from_fn(|i| sum[i] + area * (a[i] + b[i] + c[i]) / 3.0);
        all += area;
    }
    sum.map(|x| x / all)
}

#[test]
fn after_a_drag_the_silhouette_is_where_the_formula_says() {
    /// Pixels: which of those on the edge are red is a matter of their share.
    const TOLERANCE: f64 = 0.5;
    const SIZE: (u32, u32) = (600, 400);
    let aspect = 1.5;
    let exhibit = Arc::new(mobile());
    let Some(mut renderer) = renderer(&exhibit, |_| {}) else { return };
    let mut stage = Stage::new(exhibit.clone(), Settings::default(), None, None);
    let controls = Controls { aspect, ..round() };
    let poses: Vec<Pose> = exhibit.bodies.iter().map(|body| body.pose).collect();
    for (i, way) in [[0.0, 0.0], [0.35, 0.0], [0.0, 0.25], [-0.6, -0.2]].into_iter().enumerate() {
        drag(&mut stage, &controls, way);
        wait(&mut stage, &controls, FOLLOWED);
        let view = exhibit.view(aspect).orbited(stage.snapshot().turn);
        let frame = soffio_render::FrameInput {
            poses: &poses,
            dust: &[],
            curves: &[],
            view,
            size: SIZE,
            exposure: 1.0,
            time: 0.0,
        };
        let picture = renderer.draw(&frame).expect("a picture");
        if let Ok(folder) = std::env::var("SOFFIO_PICTURES") {
            picture.save(std::path::Path::new(&folder).join(format!("orbit-{i}.png"))).expect("a writable folder");
        }
        let (found, wanted) = (red(&picture), seen(&exhibit, &view, aspect));
        let off = [(found[0] - wanted[0]) * f64::from(SIZE.0), (found[1] - wanted[1]) * f64::from(SIZE.1)];
        println!("{:?}: {found:?}, {off:.2?} pixels off", stage.snapshot().turn);
        assert!(off[0].hypot(off[1]) < TOLERANCE, "{way:?}: {found:?} instead of {wanted:?}");
    }
}
