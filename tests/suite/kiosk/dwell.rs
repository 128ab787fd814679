//! Pressing by resting the pointer.

use soffio_kiosk::visitor::dwell::{Dwell, Target};
use soffio_kiosk::visitor::input::Request;

const WIDE: f64 = 16.0 / 9.0;
const AFTER: f64 = 1.0;

/// Presses while the pointer is at these places (x, and the target there) for a tenth of a second each.
fn pressed(places: &[(f64, Option<Target>)]) -> Vec<(usize, Target)> {
    let mut dwell = Dwell::default();
    let tend = |(i, &(x, on)): (usize, &(f64, Option<Target>))| {
        Some((i, dwell.update(0.1 * i as f64, Some(([x, 0.5], on)), AFTER, WIDE)?))
    };
    places.iter().enumerate().filter_map(tend).collect()
}

#[test]
fn a_rest_presses_once_and_again_only_after_the_pointer_has_left() {
    let more = Some(Target::Button(Request::Menu));
    let tile = Some(Target::Button(Request::Exhibit(3)));
    let mut places = vec![(0.9, more); 30];
    assert_eq!(pressed(&places), [(10, Target::Button(Request::Menu))]);
    // The page that it opened has a work below the pointer: nothing comes of that.
    places[11..].fill((0.9, tile));
    assert_eq!(pressed(&places).len(), 1);
    places[15] = (0.8, None);
    assert_eq!(pressed(&places), [(10, Target::Button(Request::Menu)), (26, Target::Button(Request::Exhibit(3)))]);
}

#[test]
fn a_trembling_pointer_presses_and_a_passing_one_does_not() {
    let tremor = |i: usize, size: f64| 0.5 + if i.is_multiple_of(2) { size } else { -size };
    let work = Some(Target::Exhibit);
    let small: Vec<_> = (0..15).map(|i| (tremor(i, 0.01), work)).collect();
    assert_eq!(pressed(&small), [(10, Target::Exhibit)]);
    let large: Vec<_> = (0..40).map(|i| (tremor(i, 0.03), work)).collect();
    assert_eq!(pressed(&large), []);
    let wide_button: Vec<_> =
        (0..15).map(|i| (tremor(i, 0.03), Some(Target::Button(Request::ReducedMotion)))).collect();
    assert_eq!(pressed(&wide_button), [(10, Target::Button(Request::ReducedMotion))]);
    let steady: Vec<_> = (0..60).map(|i| (0.01 * i as f64, work)).collect();
    assert_eq!(pressed(&steady), [], "it steers a breath");
    assert_eq!(pressed(&[(0.5, None); 40]), []);
}

#[test]
fn the_ring_fills_from_nothing_to_the_press() {
    let mut dwell = Dwell::default();
    let mut look = |time: f64| {
        let pressed = dwell.update(time, Some(([0.5, 0.5], Some(Target::Exhibit))), AFTER, WIDE).is_some();
        (dwell.progress(time, AFTER), pressed)
    };
    assert_eq!(look(0.0), (None, false));
    assert_eq!(look(0.2), (None, false), "who passes by sees no ring");
    let (half, _) = look(0.625);
    assert!(half.is_some_and(|share| (share - 0.5).abs() < 1e-9), "{half:?}");
    assert!(look(0.999).0.is_some_and(|share| share > 0.99));
    assert_eq!(look(1.0), (None, true));
    dwell.update(1.1, None, AFTER, WIDE);
    assert_eq!(dwell.progress(9.0, AFTER), None);
}
