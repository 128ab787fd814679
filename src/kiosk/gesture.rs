//! What a press means: press and hold blows, press and pull takes the sculpture by the hand.
//!
//! A press that lies on something that can be taken waits 0.18 s for what it becomes; one that lies on nothing blows
//! at once. A press that has become one thing stays it until it ends, so a breath that is steered never turns into a hand.
//! The first press that blows aims; keys and switches blow without a press.

use crate::simulation::{Hand, STEPS_PER_SECOND};

/// A pointer button or finger that is down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Press {
    /// Which; another one has another number.
    pub id: u64,
    /// Where it is, picture coordinates.
    pub at: [f64; 2],
}

/// How far a press is pulled before it takes, picture heights.
const PULL: f64 = 0.015;
/// How long it waits before it blows, s.
const PATIENCE: f64 = 0.18;

/// What a press has become.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Meaning {
    /// Nothing yet, for so many steps.
    Waits(u64),
    Blows,
    Takes,
}

/// A press and where it began.
#[derive(Clone, Copy, Debug)]
struct Known {
    id: u64,
    from: [f64; 2],
    meaning: Meaning,
    /// Steps since it took.
    held: u64,
}

/// All presses over time.
#[derive(Clone, Debug, Default)]
pub struct Gestures {
    known: Vec<Known>,
    hands: Vec<Hand>,
}

impl Gestures {
    /// Takes in the presses of one step. `takeable` says whether something that can be taken lies at a place. Returns
    /// where the first press that blows is.
    pub fn step(
        &mut self,
        presses: &[Press],
        aspect: f64,
        mut takeable: impl FnMut([f64; 2]) -> bool,
    ) -> Option<[f64; 2]> {
        self.known.retain(|known| presses.iter().any(|press| press.id == known.id));
        self.hands.clear();
        let mut blows = None;
        for press in presses {
            let index = self.known.iter().position(|known| known.id == press.id).unwrap_or_else(|| {
                let meaning = if takeable(press.at) { Meaning::Waits(0) } else { Meaning::Blows };
                self.known.push(Known { id: press.id, from: press.at, meaning, held: 0 });
                self.known.len() - 1
            });
            let known = &mut self.known[index];
            if let Meaning::Waits(steps) = known.meaning {
                let pulled = ((press.at[0] - known.from[0]) * aspect).hypot(press.at[1] - known.from[1]);
                known.meaning = if pulled > PULL {
                    Meaning::Takes
                } else if steps as f64 >= PATIENCE * STEPS_PER_SECOND as f64 {
                    Meaning::Blows
                } else {
                    Meaning::Waits(steps + 1)
                };
            }
            match known.meaning {
                Meaning::Takes => {
                    // It takes what lay under it when it came down.
                    let at = if known.held == 0 { known.from } else { press.at };
                    known.held += 1;
                    self.hands.push(Hand { id: press.id, at, body: None });
                }
                Meaning::Blows => blows = blows.or(Some(press.at)),
                Meaning::Waits(_) => {}
            }
        }
        blows
    }

    /// The hands on the sculpture.
    pub fn hands(&self) -> &[Hand] {
        &self.hands
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASPECT: f64 = 16.0 / 9.0;

    fn press(id: u64, x: f64) -> Press {
        Press { id, at: [x, 0.5] }
    }

    #[test]
    fn a_press_beside_the_sculpture_blows_at_once_and_goes_on_wherever_it_is_moved() {
        let mut gestures = Gestures::default();
        assert_eq!(gestures.step(&[press(1, 0.1)], ASPECT, |_| false), Some([0.1, 0.5]));
        assert_eq!(gestures.step(&[press(1, 0.6)], ASPECT, |_| true), Some([0.6, 0.5]));
        assert!(gestures.hands().is_empty());
        assert_eq!(gestures.step(&[], ASPECT, |_| true), None);
    }

    #[test]
    fn press_and_hold_blows_and_press_and_pull_takes_what_lay_there() {
        let mut gestures = Gestures::default();
        let waits = (PATIENCE * STEPS_PER_SECOND as f64).ceil() as usize;
        for _ in 0..waits {
            assert_eq!(gestures.step(&[press(1, 0.5)], ASPECT, |_| true), None, "it may yet be pulled");
        }
        gestures.step(&[press(1, 0.5)], ASPECT, |_| true);
        assert_eq!(gestures.step(&[press(1, 0.52)], ASPECT, |_| true), Some([0.52, 0.5]), "held, then steered");
        // A second finger pulls meanwhile.
        gestures.step(&[press(1, 0.52), press(2, 0.3)], ASPECT, |_| true);
        let blows = gestures.step(&[press(1, 0.52), press(2, 0.35)], ASPECT, |_| true);
        assert_eq!(blows, Some([0.52, 0.5]));
        assert_eq!(gestures.hands(), [Hand { id: 2, at: [0.3, 0.5], body: None }]);
        gestures.step(&[press(2, 0.4)], ASPECT, |_| true);
        assert_eq!(gestures.hands(), [Hand { id: 2, at: [0.4, 0.5], body: None }]);
        gestures.step(&[], ASPECT, |_| true);
        assert!(gestures.hands().is_empty());
    }
}
