//! The camera's sway in attract mode: small, slow, without a jerk, gone when somebody comes, never where less motion is wanted.

use glam::DVec3;
use soffio_exhibit::View;
use soffio_kiosk::attract::camera_sway::CameraSway;

const REST: View = View { eye: DVec3::new(0.3, 0.4, 1.9), target: DVec3::new(0.1, 0.2, 0.0), up: DVec3::Y, fovy: 0.5 };
/// Pictures a second.
const RATE: f64 = 60.0;

/// Angle between two cameras about what they look at, rad.
fn angle(a: &View, b: &View) -> f64 {
    let [p, q] = [a, b].map(|view| (view.eye - view.target).normalize());
    p.cross(q).length().atan2(p.dot(q))
}

/// Two minutes of attract mode.
fn attract(drift: &mut CameraSway, calm: bool) -> Vec<View> {
    (0..(120.0 * RATE) as usize).map(|i| drift.view(REST, i as f64 / RATE, !calm)).collect()
}

#[test]
fn it_sways_within_four_degrees_and_no_faster_than_a_slow_breath() {
    /// Largest angle, rad, and fastest, rad/s: half a degree.
    const MOST: f64 = 0.07;
    const FASTEST: f64 = 0.0087;
    /// Largest change of that speed, rad/s²: what starts and ends is not felt as a jerk.
    const JERK: f64 = 0.003;
    let views = attract(&mut CameraSway::default(), false);
    let far = views.iter().map(|view| angle(&REST, view)).fold(0.0, f64::max);
    let fast = views.windows(2).map(|w| angle(&w[0], &w[1]) * RATE).fold(0.0, f64::max);
    let turn = |w: &[View]| (w[2].eye - 2.0 * w[1].eye + w[0].eye).length() / (REST.eye - REST.target).length();
    let jerk = views.windows(3).map(|w| turn(w) * RATE * RATE).fold(0.0, f64::max);
    println!("{far:.4} rad, {fast:.5} rad/s, {jerk:.5} rad/s²");
    assert!(far > 0.5 * MOST && far < MOST && fast < FASTEST && jerk < JERK);
    for view in &views {
        let way = (view.eye - view.target).length() / (REST.eye - REST.target).length();
        assert!((way - 1.0).abs() < 1e-12, "the distance stays");
    }
}

#[test]
fn whoever_comes_finds_the_exhibits_own_camera_within_a_second() {
    let mut drift = CameraSway::default();
    attract(&mut drift, false);
    let after: Vec<View> = (0..=61).map(|i| drift.view(REST, 120.0 + f64::from(i) / RATE, false)).collect();
    assert!(angle(&REST, &after[0]) > 0.0 && after[61] == REST);
}

#[test]
fn where_less_motion_is_wanted_the_camera_stands_still() {
    assert!(attract(&mut CameraSway::default(), true).iter().all(|view| *view == REST));
}
