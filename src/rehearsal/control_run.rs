//! Control run: the same moment without the visitor's action.
//!
//! A run is a function of its state and its inputs. So a copy of the stage, stepped without the visitor's input, gives the pictures
//! without a breath, to the pixel. Where the pictures differ, the visitor has changed the exhibit, however much it moves by itself.

use super::scorer::{FPS, SOON};
use soffio_kiosk::step::controls::Controls;
use soffio_kiosk::step::stage::Stage;
use soffio_math::Pose;
use soffio_simulation::STEPS_PER_SECOND;

/// Poses of the bodies in the first [`SOON`] pictures after a moment, without a visitor from that moment on. The last picture before it
/// has the number `middle`.
pub fn control_poses(stage: &Stage, controls: &Controls, middle: u64) -> Vec<Vec<Pose>> {
    let no_visitor = controls.without_visitor();
    let mut stage = stage.clone();
    let every = STEPS_PER_SECOND / FPS;
    let mut shown = Vec::with_capacity(SOON);
    let mut step = stage.steps();
    while shown.len() < SOON {
        stage.step(&no_visitor, None);
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
    fn it_equals_a_run_without_visitor_to_the_bit_and_leaves_out_a_hold() {
        let folder = exhibit::resolve("steel-fish").expect("a shipped exhibit");
        let exhibit = Arc::new(exhibit::load(&folder).expect("a valid exhibit"));
        let mut stage = Stage::new(exhibit, Settings::default(), None, None);
        let no_visitor = Controls { aspect: 16.0 / 9.0, ..Controls::default() };
        let holding = Controls { hold: true, ..no_visitor.clone() };
        // A moment between two pictures.
        (0..STEPS_PER_SECOND + 3).for_each(|_| stage.step(&no_visitor, None));
        let control = control_poses(&stage, &holding, FPS);
        for (controls, same) in [(&no_visitor, true), (&holding, false)] {
            let mut stage = stage.clone();
            let mut last = stage.snapshot().poses.clone();
            while stage.steps() < (FPS + SOON as u64) * STEPS_PER_SECOND / FPS {
                stage.step(controls, None);
                last.clone_from(&stage.snapshot().poses);
            }
            assert_eq!(control.len(), SOON);
            assert_eq!(control[SOON - 1] == last, same);
        }
    }
}
