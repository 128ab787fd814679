//! Pace of the steps: none is lost, and a long delay is dropped.

use std::time::Duration;

use soffio_kiosk::live::step_scheduler::{MOST_BEHIND, StepScheduler};

#[test]
fn an_hour_of_uneven_waking_is_exactly_240_steps_a_second() {
    let mut pacer = StepScheduler::default();
    let mut random = soffio_math::noise::Random::new(11);
    let (mut now, mut steps) = (Duration::ZERO, 0);
    while now < Duration::from_secs(3600) {
        now = (now + Duration::from_nanos(random.range(1e3, 2e7) as u64)).min(Duration::from_secs(3600));
        steps += pacer.due(now);
        assert!(pacer.present() <= now && now < pacer.next(), "the present is the last step due");
    }
    assert_eq!((steps, pacer.dropped()), (3600 * 240, 0));
}

#[test]
fn a_short_delay_is_made_up_and_a_long_one_is_dropped() {
    let mut pacer = StepScheduler::default();
    assert_eq!(pacer.due(Duration::from_millis(250)), MOST_BEHIND, "a quarter of a second is made up");
    assert_eq!(pacer.due(Duration::from_millis(1250)), 1, "a second is not: the motion goes on where it was");
    assert_eq!(pacer.dropped(), 239);
    assert_eq!(pacer.due(Duration::from_millis(1250)), 0);
    assert_eq!(pacer.due(Duration::from_millis(1300)), 12, "and keeps its pace");
}
