//! Even motion is seen evenly: the times that pictures show, from the uneven times at which they are begun. No clock runs.

use glam::DVec3;
use soffio_kiosk::step::frame_interpolation::{DELAY_STEPS, SnapshotHistory};
use soffio_kiosk::window::frame_pacing::FramePacer;
use soffio_math::Pose;
use soffio_simulation::{STEPS_PER_SECOND, Snapshot};

/// How late pictures are begun after their refresh, ms, over and over: mostly a little, every few pictures up to two.
const DELAYS: [f64; 40] = [
    0.21, 0.18, 0.25, 1.32, 0.19, 0.22, 0.41, 0.20, 2.05, 0.24, 0.19, 0.33, 0.18, 0.97, 0.22, 0.20, 0.26, 1.71, 0.19,
    0.23, 0.52, 0.18, 0.21, 0.29, 1.12, 0.20, 0.19, 0.24, 0.36, 0.18, 1.48, 0.22, 0.20, 0.31, 0.19, 0.66, 0.23, 0.18,
    0.25, 1.94,
];
/// How late steps are published, ms, likewise.
const LATE: [f64; 23] = [
    0.06, 0.09, 0.07, 0.12, 0.35, 0.07, 0.08, 0.06, 1.10, 0.09, 0.07, 0.11, 0.06, 0.48, 0.08, 0.07, 0.10, 0.06, 0.07,
    0.83, 0.09, 0.06, 0.08,
];
/// Uneven steps on the screen that nobody sees, as a share of the way from picture to picture: a body that crosses a
/// 4K screen in four seconds goes 16 pixels, and misses its place by a sixth of one. Drawn at the times at which pictures
/// are begun it would be a ninth of the way at 60 Hz, a quarter at 144.
const JUDDER: f64 = 0.01;
/// Pictures until the loop has settled.
const SETTLED: usize = 240;

fn at(step: u64) -> Snapshot {
    let position = DVec3::X * (step as f64 / STEPS_PER_SECOND as f64);
    Snapshot { step, poses: vec![Pose { position, ..Pose::IDENTITY }], ..Snapshot::default() }
}

/// Where a body that goes 1 m/s is seen in each picture, by a display of `hertz` that says it had `said`.
fn seen(hertz: f64, said: Option<f64>, missed: impl Fn(usize) -> bool) -> Vec<(usize, f64)> {
    let mut rhythm = FramePacer::default();
    rhythm.set_refresh(said.map(|hertz| 1.0 / hertz));
    let mut history = SnapshotHistory::new(&at(0));
    let mut newest = 0;
    let (mut seen, mut moment) = (Vec::new(), Snapshot::default());
    for picture in (0..1200).filter(|&picture| !missed(picture)) {
        let now = picture as f64 / hertz + 1e-3 * DELAYS[picture % DELAYS.len()];
        let published = |step: u64| step as f64 / STEPS_PER_SECOND as f64 + 1e-3 * LATE[step as usize % LATE.len()];
        while published(newest + 1) <= now {
            newest += 1;
            history.push(&at(newest));
        }
        let shown = rhythm.next(now);
        let since = shown * STEPS_PER_SECOND as f64 - newest as f64;
        history.interpolate(DELAY_STEPS - since, &mut moment);
        seen.push((picture, moment.poses[0].position.x));
    }
    seen
}

/// Largest unevenness of motion from picture to picture, as a share of the way between two refreshes.
fn judder(hertz: f64, seen: &[(usize, f64)]) -> f64 {
    let uneven = |w: &[(usize, f64)]| {
        let way = |i: usize| (w[i + 1].1 - w[i].1) * hertz - (w[i + 1].0 - w[i].0) as f64;
        way(0).abs()
    };
    seen[SETTLED..].windows(2).map(uneven).fold(0.0, f64::max)
}

#[test]
fn a_body_that_moves_evenly_is_seen_to_at_every_rate() {
    for hertz in [50.0, 59.94, 60.0, 75.0, 120.0, 144.0] {
        for said in [Some(hertz), Some(f64::round(hertz)), None] {
            let judder = judder(hertz, &seen(hertz, said, |_| false));
            println!("{hertz} Hz, said {said:?}: {:.2} % uneven", 100.0 * judder);
            assert!(judder < JUDDER, "{hertz} Hz, said {said:?}: {judder}");
        }
    }
}

#[test]
fn a_refresh_that_is_missed_leaves_the_body_where_it_should_be() {
    for hertz in [60.0, 144.0] {
        let judder = judder(hertz, &seen(hertz, Some(hertz), |picture| picture % 97 == 31));
        assert!(judder < JUDDER, "{hertz} Hz: {judder}");
    }
}

#[test]
fn what_is_seen_is_never_ahead_of_what_has_happened_and_never_far_behind() {
    /// Steps behind the clock, and the delays that come to it, s.
    const BEHIND_S: f64 = (DELAY_STEPS + 1.0) / STEPS_PER_SECOND as f64;
    for hertz in [50.0, 59.94, 144.0] {
        for (picture, place) in &seen(hertz, Some(hertz), |_| false)[SETTLED..] {
            let now = *picture as f64 / hertz;
            assert!(*place <= now + 3e-3 && *place > now - BEHIND_S, "{hertz} Hz: {place} at {now}");
        }
    }
}

#[test]
fn after_a_pause_the_time_shown_is_the_time_it_is() {
    let mut rhythm = FramePacer::default();
    rhythm.set_refresh(Some(1.0 / 60.0));
    for picture in 0..60 {
        rhythm.next(f64::from(picture) / 60.0 + 0.004);
    }
    assert_eq!(rhythm.next(7.5), 7.5);
}
