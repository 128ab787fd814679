//! Fewer pictures at rest: what counts as rest, step by step, and that its end is seen in the same step. No clock runs.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use soffio_exhibit::{Exhibit, View};
use soffio_kiosk::step::controls::Controls;
use soffio_kiosk::step::idle_detection::{BRIGHT, IDLE_FRAME_S, IdleDetector, QUIET_S, UNSEEN};
use soffio_kiosk::step::stage::Stage;
use soffio_kiosk::window::idle_rendering::{FrameActivity, IdleRendering};
use soffio_simulation::{DustParticle, STEPS_PER_SECOND, Settings, Simulation, Snapshot};

use super::pages::load;

const ASPECT: f64 = 16.0 / 9.0;
/// Steps after which what is quiet is at rest.
const QUIET: usize = (QUIET_S * STEPS_PER_SECOND as f64) as usize;
/// Steps between two pictures at rest.
const LOOK: f64 = IDLE_FRAME_S * STEPS_PER_SECOND as f64;

/// Something that ends a rest, by its name.
type Sign = (&'static str, fn(&mut Snapshot));

/// Somebody looks on at a work whose moments are made.
struct Watch {
    exhibit: Arc<Exhibit>,
    view: View,
    moment: Snapshot,
    idle_detector: IdleDetector,
}

impl Watch {
    fn new(id: &str) -> Self {
        let exhibit = load(id);
        let mut moment = Simulation::new(exhibit.clone(), Settings::default()).snapshot();
        moment.dust_particles.clear();
        Self { view: exhibit.view(ASPECT), exhibit, moment, idle_detector: IdleDetector::default() }
    }

    /// A step after which that is so; is it rest?
    fn step(&mut self, change: impl FnOnce(&mut Snapshot)) -> bool {
        change(&mut self.moment);
        self.idle_detector.update(&self.exhibit, &self.moment, &self.view);
        self.idle_detector.is_still()
    }

    /// So many steps of the same; is it rest after the last?
    fn steps(&mut self, count: usize, change: impl Fn(&mut Snapshot)) -> bool {
        (0..count).map(|_| self.step(&change)).last().expect("steps")
    }

    fn settle(&mut self) {
        assert!(self.steps(2 * QUIET, |_| ()), "nothing moves");
    }
}

#[test]
fn what_stands_still_is_at_rest_after_half_a_second_and_each_sign_ends_it_in_its_step() {
    let mut watch = Watch::new("pendulum");
    assert!(!watch.steps(QUIET - 1, |_| ()) && watch.step(|_| ()));
    let signs: [Sign; 8] = [
        ("a breath", |moment| moment.breath.speed = 0.1),
        ("the detector", |moment| moment.breath.estimate.speed = 0.1),
        ("a hand", |moment| moment.diagnostics.grabs = 1),
        ("the camera", |moment| moment.turn[0] += 1e-3),
        ("the aim", |moment| moment.breath.ring.center.x += 0.01),
        ("a body", |moment| moment.poses[0].position.y += 0.01),
        ("a turn", |moment| moment.poses[0].rotation *= DQuat::from_rotation_y(0.1)),
        ("dust", |moment| {
            moment.dust_particles.push(DustParticle { brightness: 1.1 * BRIGHT, ..DustParticle::default() })
        }),
    ];
    for (name, sign) in signs {
        assert!(!watch.step(sign), "{name} ends the rest at once");
        watch.step(|moment| {
            moment.dust_particles.clear();
            (moment.breath.speed, moment.breath.estimate.speed, moment.diagnostics.grabs) = (0.0, 0.0, 0);
        });
        watch.settle();
    }
    // Dust that floats in still air is too faint to be seen to move.
    watch.step(|moment| {
        moment.dust_particles.push(DustParticle { brightness: 0.9 * BRIGHT, ..DustParticle::default() })
    });
    assert!(watch.step(|_| ()));
    // Another work starts again, even a copy of the same.
    watch.exhibit = Arc::new((*watch.exhibit).clone());
    assert!(!watch.step(|_| ()));
}

#[test]
fn a_quarter_of_a_pixel_between_two_pictures_is_what_counts_wherever_it_is() {
    for id in ["pendulum", "steel-fish", "windmill"] {
        let base = Watch::new(id);
        let (axes, reach) = (base.view.axes(), base.exhibit.body_radii()[0]);
        // Aside, where a way is seen in full; what is nearest to the eye counts.
        let depth = (base.moment.poses[0].position - base.view.eye).dot(axes.2) - reach;
        let unseen = UNSEEN * base.view.height_at(depth);
        for (share, rests) in [(0.9, true), (1.3, false)] {
            let mut watch = Watch::new(id);
            let way = share * unseen / LOOK * axes.0;
            assert_eq!(watch.steps(3 * QUIET, |moment| moment.poses[0].position += way), rests, "{id}, {share}");
        }
        // A slow turn: at its rim the chord is seen; the bound is at most π/2 times as much.
        for (share, rests) in [(0.6, true), (1.3, false)] {
            let mut watch = Watch::new(id);
            let turn = DQuat::from_axis_angle(DVec3::Y, share * unseen / reach / LOOK);
            let turns = |moment: &mut Snapshot| moment.poses[0].rotation = turn * moment.poses[0].rotation;
            assert_eq!(watch.steps(3 * QUIET, turns), rests, "{id}, a turn of {share}");
        }
    }
}

#[test]
fn the_page_and_every_touch_count_too() {
    let mut rest = IdleRendering::default();
    let still = FrameActivity { still: true, ..FrameActivity::default() };
    // (time, visible changes, may the next picture wait?)
    let script = [
        (0.0, FrameActivity::default(), false),
        (0.1, still, false),
        (0.4, still, false),
        (0.5, still, true),
        (0.6, still, true),
        (0.7, FrameActivity { inputs: 1, ..still }, false),
        (0.8, FrameActivity { inputs: 1, ..still }, false),
        (1.2, FrameActivity { inputs: 1, ..still }, true),
        (1.3, FrameActivity { inputs: 1, page_moves: true, ..still }, false),
        (1.7, FrameActivity { inputs: 1, ..still }, false),
        (1.8, FrameActivity { inputs: 1, ..still }, true),
        (1.9, FrameActivity { inputs: 1, ..FrameActivity::default() }, false),
        (2.5, FrameActivity { inputs: 1, ..still }, true),
    ];
    for (time, signs, waits) in script {
        assert_eq!(rest.update(time, signs), waits, "at {time} s");
        assert_eq!(rest.is_idle(), waits);
    }
}

/// Times of the pictures, s, of a window that draws sixty a second, or fewer at rest, with these controls of the stage.
fn pictures(stage: &mut Stage, steps: u64, controls: impl Fn(u64) -> Controls) -> (Vec<f64>, Option<f64>) {
    const REFRESH: f64 = 1.0 / 60.0;
    let (mut idle_detector, mut rest) = (IdleDetector::default(), IdleRendering::default());
    let (mut times, mut onset, mut next, mut was_still) = (Vec::new(), None, 0.0, false);
    for step in 0..steps {
        let time = step as f64 / STEPS_PER_SECOND as f64;
        let controls = controls(step);
        stage.step(&controls, None);
        idle_detector.update(stage.exhibit(), stage.snapshot(), stage.sight());
        if stage.snapshot().breath.speed > 0.0 {
            onset = onset.or(Some(time));
        }
        // As the simulation's thread does.
        if was_still && !idle_detector.is_still() && rest.is_idle() {
            next = time;
        }
        was_still = idle_detector.is_still();
        if time >= next - 1e-9 {
            times.push(time);
            let signs = FrameActivity { still: was_still, page_moves: false, inputs: controls.activity };
            next = time + if rest.update(time, signs) { IDLE_FRAME_S } else { REFRESH };
        }
    }
    (times, onset)
}

#[test]
fn a_still_work_is_shown_ten_times_a_second_and_a_breath_at_once() {
    for id in ["breaking-chain", "plates"] {
        let mut stage = Stage::new(load(id), Settings::default(), None, None);
        let blows = 10 * STEPS_PER_SECOND + 7;
        let controls = |step: u64| Controls { aspect: ASPECT, hold: step >= blows, ..Controls::default() };
        let mut alone = Stage::new(load(id), Settings::default(), None, None);
        let mut brightest: f32 = 0.0;
        for step in 0..5 * STEPS_PER_SECOND {
            alone.step(&controls(step), None);
            brightest = alone.snapshot().dust_particles.iter().map(|mote| mote.brightness).fold(brightest, f32::max);
        }
        assert!(brightest < BRIGHT, "{id}: dust of still air is {brightest}");
        let (times, onset) = pictures(&mut stage, 12 * STEPS_PER_SECOND, controls);
        let onset = onset.expect("it blows");
        let count = |from: f64, to: f64| times.iter().filter(|time| (from..to).contains(*time)).count();
        assert!((39..=41).contains(&count(5.0, 9.0)), "{id}: {} pictures in four seconds of rest", count(5.0, 9.0));
        assert!(times.contains(&onset), "{id}: the step of the onset, {onset} s, has its picture");
        assert!(
            (58..=62).contains(&count(onset, onset + 1.0)),
            "{id}: {} in the second after",
            count(onset, onset + 1.0)
        );
        let next = times.iter().find(|time| **time > onset).expect("another");
        assert!(next - onset < 0.018, "{id}: and the next one follows a refresh later");
    }
}

#[test]
fn a_work_that_moves_is_never_at_rest() {
    let mut stage = Stage::new(load("terry-clock"), Settings::default(), None, None);
    let (times, _) = pictures(&mut stage, 5 * STEPS_PER_SECOND, |_| Controls { aspect: ASPECT, ..Controls::default() });
    assert!(times.len() >= 299, "{} pictures in five seconds", times.len());
}
