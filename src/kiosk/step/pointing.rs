//! Aim of the breath. Pointer, finger and controllers (OSC) set it; a stick or the arrow keys move it from where it is. The
//! last input that moved counts.

use crate::step::controls::Controls;
use soffio_simulation::{CENTRE, STEPS_PER_SECOND};

/// State of the aim.
#[derive(Clone, Debug, Default)]
pub struct Pointing {
    at: Option<[f64; 2]>,
    pointer: Option<[f64; 2]>,
    named: u64,
}

impl Pointing {
    /// The aim of this step, picture coordinates; `None` is the centre. `stick` moves it, right and down, picture heights/s.
    pub fn step(&mut self, controls: &Controls, stick: [f64; 2]) -> Option<[f64; 2]> {
        if controls.aim != self.pointer {
            self.pointer = controls.aim;
            self.at = controls.aim;
        }
        if let Some((place, count)) = controls.named
            && count != self.named
        {
            (self.at, self.named) = (Some(place), count);
        }
        if stick != [0.0; 2] {
            let [x, y] = self.at.unwrap_or(CENTRE);
            let step = stick.map(|speed| speed / STEPS_PER_SECOND as f64);
            let aspect = if controls.aspect > 0.0 { controls.aspect } else { 1.0 };
            self.at = Some([(x + step[0] / aspect).clamp(0.0, 1.0), (y + step[1]).clamp(0.0, 1.0)]);
        }
        self.at
    }

    /// The visitor has left: the next one starts from the centre.
    pub fn forget(&mut self) {
        self.at = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of 240 additions.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn whoever_moved_last_aims() {
        let mut pointing = Pointing::default();
        let mut controls = Controls { aspect: 2.0, ..Controls::default() };
        assert_eq!(pointing.step(&controls, controls.stick), None);
        controls.stick = [0.4, -0.2];
        for _ in 0..STEPS_PER_SECOND {
            pointing.step(&controls, controls.stick);
        }
        controls.stick = [0.0; 2];
        let [x, y] = pointing.step(&controls, controls.stick).expect("an aim");
        assert!((x - 0.7).abs() < ROUNDING && (y - 0.3).abs() < ROUNDING, "as far on the glass each way: {x} {y}");
        controls.aim = Some([0.1, 0.9]);
        assert_eq!(pointing.step(&controls, controls.stick), Some([0.1, 0.9]));
        controls.named = Some(([0.6, 0.6], 1));
        assert_eq!(pointing.step(&controls, controls.stick), Some([0.6, 0.6]));
        assert_eq!(
            pointing.step(&controls, controls.stick),
            Some([0.6, 0.6]),
            "a pointer that lies still does not take it back"
        );
        controls.stick = [9.0, 9.0];
        (0..STEPS_PER_SECOND).for_each(|_| _ = pointing.step(&controls, controls.stick));
        assert_eq!(pointing.step(&controls, controls.stick), Some([1.0, 1.0]));
        controls.stick = [0.0; 2];
        pointing.forget();
        assert_eq!(pointing.step(&controls, controls.stick), None);
    }
}
