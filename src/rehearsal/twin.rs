//! The same moment without the visitor: what the work does of itself.
//!
//! A run is a function of its state and its inputs, so a copy of the stage that is stepped on without what a visitor does
//! shows, to the pixel, what there would have been to see had nobody blown. Where the two pictures differ, the visitor
//! has changed the work, however much it swings anyhow.

use super::judge::{FPS, SOON};
use soffio_kiosk::step::controls::Controls;
use soffio_kiosk::step::stage::Stage;
use soffio_math::Pose;
use soffio_simulation::STEPS_PER_SECOND;

/// Poses of the bodies in the first [`SOON`] pictures after a moment, with nobody there from that moment on; the last picture
/// before it has the number `middle`.
pub fn left_alone(stage: &Stage, controls: &Controls, middle: u64) -> Vec<Vec<Pose>> {
    let nobody = controls.without_visitor();
    let mut stage = stage.clone();
    let every = STEPS_PER_SECOND / FPS;
    let mut shown = Vec::with_capacity(SOON);
    let mut step = stage.steps();
    while shown.len() < SOON {
        stage.step(&nobody, None);
        step += 1;
        if step.is_multiple_of(every) && step / every > middle {
            shown.push(stage.snapshot().poses.clone());
        }
    }
    shown
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use soffio_exhibit as exhibit;
    use soffio_simulation::Settings;

    #[test]
    fn alone_it_goes_on_to_the_bit_and_a_hold_is_left_out() {
        let folder = exhibit::resolve("steel-fish").expect("a shipped work");
        let work = Arc::new(exhibit::load(&folder).expect("a good one"));
        let mut stage = Stage::new(work, Settings::default(), None, None);
        let nobody = Controls { aspect: 16.0 / 9.0, ..Controls::default() };
        let holding = Controls { hold: true, ..nobody.clone() };
        // Somewhere between two pictures.
        (0..STEPS_PER_SECOND + 3).for_each(|_| stage.step(&nobody, None));
        let alone = left_alone(&stage, &holding, FPS);
        for (controls, same) in [(&nobody, true), (&holding, false)] {
            let mut stage = stage.clone();
            let mut last = stage.snapshot().poses.clone();
            while stage.steps() < (FPS + SOON as u64) * STEPS_PER_SECOND / FPS {
                stage.step(controls, None);
                last.clone_from(&stage.snapshot().poses);
            }
            assert_eq!(alone.len(), SOON);
            assert_eq!(alone[SOON - 1] == last, same);
        }
    }
}
