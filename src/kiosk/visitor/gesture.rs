//! What a press means: press and hold blows, press and pull takes the sculpture by the hand, a swipe beside it leads to
//! the next work.
//!
//! A press that lies on something that can be taken waits 0.18 s for what it becomes; one that lies on nothing blows
//! at once. A press that has become one thing stays it until it ends, so a breath that is steered never turns into a hand.
//! The first press that blows aims; keys and switches blow without a press.
//!
//! A swipe is a press that came down where nothing can be taken and left again soon, far to one side: faster than anybody
//! steers a breath. What pulls a body is never a swipe.
//!
//! Whoever looks round the work pulls at the air beside it: there a press neither blows nor swipes, it turns the camera. On
//! the work everything is as it was.
//!
//! Whoever cannot hold presses once: what comes up without having taken or swiped begins a breath, and the next one ends
//! it. A hand that is not steady may slide a little meanwhile. Looking round, a press beside the work turns by so much
//! towards where it lies.

use crate::visitor::orbit;
use soffio_simulation::{PointerGrab, STEPS_PER_SECOND};

/// A pointer button or finger that is down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Press {
    /// Which; another one has another number.
    pub id: u64,
    /// Where it is, picture coordinates.
    pub at: [f64; 2],
}

/// A pointer button or finger that has come up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lift {
    /// Which press it was.
    pub id: u64,
    /// Where it came down, picture coordinates.
    pub from: [f64; 2],
    /// Where it left.
    pub at: [f64; 2],
}

/// What is pressed in one step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Touch<'a> {
    /// What is down.
    pub presses: &'a [Press],
    /// What has come up since the last step.
    pub lifts: &'a [Lift],
    /// Is a key, a switch or a controller held?
    pub hold: bool,
    /// Times that the key went down so far: a short press may lie between two steps.
    pub keyed: u64,
    /// Does a press begin the breath and the next one end it?
    pub once: bool,
    /// Does the visitor look round the work?
    pub round: bool,
    /// Width over height of the picture.
    pub aspect: f64,
}

/// How far a press is pulled before it takes, picture heights, and where a hand is not steady.
const PULL: f64 = 0.015;
const UNSTEADY_PULL: f64 = 0.05;
/// How long it waits before it blows, s.
const PATIENCE: f64 = 0.18;
/// A swipe goes at least so far to a side, picture heights, within so long, s, and that much more aside than up or down.
const SWIPE: f64 = 0.25;
const SWIPE_S: f64 = 0.4;
const SWIPE_SLOPE: f64 = 2.0;

/// What a press has become.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Meaning {
    /// It lies on something; nothing yet, for so many steps.
    Waits(u64),
    Blows,
    Takes,
    Turns,
}

/// A press and where it began.
#[derive(Clone, Copy, Debug)]
struct Known {
    id: u64,
    from: [f64; 2],
    /// Where it was when it was seen last.
    at: [f64; 2],
    meaning: Meaning,
    /// Did it come down beside everything that can be taken?
    free: bool,
    /// Steps since it was seen, and since it took.
    age: u64,
    held: u64,
}

/// All presses over time.
#[derive(Clone, Debug, Default)]
pub struct Gestures {
    known: Vec<Known>,
    hands: Vec<PointerGrab>,
    /// Is a breath on that nobody holds?
    latched: bool,
    keyed: u64,
    hold: bool,
    turned: i64,
    pulled: [f64; 2],
}

impl Gestures {
    /// Takes in what is pressed in one step. `takeable` says whether something that can be taken lies at a place. Returns
    /// where the first press that blows is.
    pub fn step(&mut self, touch: &Touch, mut takeable: impl FnMut([f64; 2]) -> bool) -> Option<[f64; 2]> {
        self.switch(touch);
        self.pulled = [0.0; 2];
        for lift in touch.lifts {
            self.lift(lift, touch, &mut takeable);
        }
        self.known.retain(|known| touch.presses.iter().any(|press| press.id == known.id));
        self.hands.clear();
        let (mut blows, mut turns) = (None, None);
        for press in touch.presses {
            let index = self.known.iter().position(|known| known.id == press.id).unwrap_or_else(|| {
                let free = !takeable(press.at);
                let meaning = match (free, touch.round) {
                    (true, true) => Meaning::Turns,
                    (true, false) => Meaning::Blows,
                    (false, _) => Meaning::Waits(0),
                };
                self.known.push(Known { id: press.id, from: press.at, at: press.at, meaning, free, age: 0, held: 0 });
                self.known.len() - 1
            });
            let known = &mut self.known[index];
            known.age += 1;
            if let Meaning::Waits(steps) = known.meaning {
                let [x, y] = way(known.from, press.at, touch.aspect);
                known.meaning = if x.hypot(y) > if touch.once { UNSTEADY_PULL } else { PULL } {
                    Meaning::Takes
                } else if steps as f64 >= PATIENCE * STEPS_PER_SECOND as f64 && !touch.once {
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
                    self.hands.push(PointerGrab { id: press.id, at, body: None });
                }
                Meaning::Blows if !touch.once => blows = blows.or(Some(press.at)),
                // The first finger turns; another beside it would turn twice as far.
                Meaning::Turns => turns = turns.or(Some(way(known.at, press.at, touch.aspect))),
                Meaning::Blows | Meaning::Waits(_) => {}
            }
            known.at = press.at;
        }
        if let Some(way) = turns {
            self.pull(way);
        }
        blows
    }

    /// The hands on the sculpture.
    pub fn hands(&self) -> &[PointerGrab] {
        &self.hands
    }

    /// Is a breath on that was begun by a press and is ended by the next one?
    pub fn latched(&self) -> bool {
        self.latched
    }

    /// Ends it.
    pub fn unlatch(&mut self) {
        self.latched = false;
    }

    /// Works that were swiped on so far, less those that were swiped back.
    pub fn turned(&self) -> i64 {
        self.turned
    }

    /// What presses beside the work turned in the last step, to the right and up, rad.
    pub fn pulled(&self) -> [f64; 2] {
        self.pulled
    }

    /// Turns by a way of a finger, picture heights: what is seen follows it, so the eye goes against it.
    fn pull(&mut self, [x, y]: [f64; 2]) {
        self.pulled[0] -= orbit::TURN * x;
        self.pulled[1] += orbit::TURN * y;
    }

    /// Keys, switches and controllers of whoever presses once: each press counts, however short, and none must be held.
    fn switch(&mut self, touch: &Touch) {
        let keyed = touch.keyed.wrapping_sub(self.keyed);
        let presses = if keyed == 0 { u64::from(touch.hold && !self.hold) } else { keyed };
        self.latched = touch.once && self.latched != (presses % 2 == 1);
        (self.keyed, self.hold) = (touch.keyed, touch.hold);
    }

    /// What a press was, now that it is over.
    fn lift(&mut self, lift: &Lift, touch: &Touch, takeable: &mut impl FnMut([f64; 2]) -> bool) {
        let known = self.known.iter().find(|known| known.id == lift.id);
        if known.is_some_and(|known| known.meaning == Meaning::Takes) {
            return;
        }
        let turns = known.map_or_else(|| touch.round && !takeable(lift.from), |known| known.meaning == Meaning::Turns);
        if turns {
            let [x, y] = way(lift.from, lift.at, touch.aspect);
            if touch.once && x.hypot(y) < UNSTEADY_PULL {
                let [x, y] = way([0.5, 0.5], lift.at, touch.aspect);
                let aside =
                    if x.abs() > y.abs() { [orbit::PRESS.copysign(x), 0.0] } else { [0.0, -orbit::PRESS.copysign(y)] };
                self.pulled = std::array::from_fn(|i| self.pulled[i] + aside[i]);
            }
            return self.pull(way(known.map_or(lift.from, |known| known.at), lift.at, touch.aspect));
        }
        let (free, age) = known.map_or_else(|| (!takeable(lift.from), 0), |known| (known.free, known.age));
        let [x, y] = way(lift.from, lift.at, touch.aspect);
        let soon = age as f64 <= SWIPE_S * STEPS_PER_SECOND as f64;
        if free && soon && x.abs() > SWIPE && x.abs() > SWIPE_SLOPE * y.abs() {
            // To the left leads on, as a page is turned.
            self.turned += if x < 0.0 { 1 } else { -1 };
        } else if touch.once {
            self.latched = !self.latched;
        }
    }
}

/// From one place to another, picture heights.
fn way(from: [f64; 2], to: [f64; 2], aspect: f64) -> [f64; 2] {
    [(to[0] - from[0]) * aspect, to[1] - from[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASPECT: f64 = 16.0 / 9.0;

    fn press(id: u64, x: f64) -> Press {
        Press { id, at: [x, 0.5] }
    }

    fn step(gestures: &mut Gestures, presses: &[Press], takeable: bool) -> Option<[f64; 2]> {
        gestures.step(&Touch { presses, aspect: ASPECT, ..Touch::default() }, |_| takeable)
    }

    /// A finger goes from one x to another in so many steps and leaves; `once` as the visitor has chosen.
    fn slide(gestures: &mut Gestures, [from, to]: [[f64; 2]; 2], steps: u64, once: bool, takeable: bool) {
        let touch = Touch { once, aspect: ASPECT, ..Touch::default() };
        for i in 0..steps {
            let share = i as f64 / steps as f64;
            let at = [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])];
            gestures.step(&Touch { presses: &[Press { id: 9, at }], ..touch }, |_| takeable);
        }
        gestures.step(&Touch { lifts: &[Lift { id: 9, from, at: to }], ..touch }, |_| takeable);
    }

    #[test]
    fn a_press_beside_the_sculpture_blows_at_once_and_goes_on_wherever_it_is_moved() {
        let mut gestures = Gestures::default();
        assert_eq!(step(&mut gestures, &[press(1, 0.1)], false), Some([0.1, 0.5]));
        assert_eq!(step(&mut gestures, &[press(1, 0.6)], true), Some([0.6, 0.5]));
        assert!(gestures.hands().is_empty());
        assert_eq!(step(&mut gestures, &[], true), None);
    }

    #[test]
    fn press_and_hold_blows_and_press_and_pull_takes_what_lay_there() {
        let mut gestures = Gestures::default();
        let waits = (PATIENCE * STEPS_PER_SECOND as f64).ceil() as usize;
        for _ in 0..waits {
            assert_eq!(step(&mut gestures, &[press(1, 0.5)], true), None, "it may yet be pulled");
        }
        step(&mut gestures, &[press(1, 0.5)], true);
        assert_eq!(step(&mut gestures, &[press(1, 0.52)], true), Some([0.52, 0.5]), "held, then steered");
        // A second finger pulls meanwhile.
        step(&mut gestures, &[press(1, 0.52), press(2, 0.3)], true);
        let blows = step(&mut gestures, &[press(1, 0.52), press(2, 0.35)], true);
        assert_eq!(blows, Some([0.52, 0.5]));
        assert_eq!(gestures.hands(), [PointerGrab { id: 2, at: [0.3, 0.5], body: None }]);
        step(&mut gestures, &[press(2, 0.4)], true);
        assert_eq!(gestures.hands(), [PointerGrab { id: 2, at: [0.4, 0.5], body: None }]);
        step(&mut gestures, &[], true);
        assert!(gestures.hands().is_empty());
    }

    #[test]
    fn a_swipe_turns_and_nothing_else_does() {
        let (left, right, up) = ([0.3, 0.5], [0.6, 0.52], [0.35, 0.1]);
        let quick = (0.5 * SWIPE_S * STEPS_PER_SECOND as f64) as u64;
        let turned = |ends: [[f64; 2]; 2], steps: u64, takeable: bool| {
            let mut gestures = Gestures::default();
            slide(&mut gestures, ends, steps, false, takeable);
            gestures.turned()
        };
        assert_eq!(turned([right, left], quick, false), 1, "to the left: the next");
        assert_eq!(turned([left, right], quick, false), -1, "to the right: the one before");
        assert_eq!(turned([left, right], 0, false), -1, "over before a step saw it");
        assert_eq!(turned([left, right], quick, true), 0, "it pulled a body");
        assert_eq!(turned([left, right], 0, true), 0, "it would have pulled one");
        assert_eq!(turned([left, right], 3 * quick, false), 0, "a breath that is steered");
        assert_eq!(turned([left, [0.4, 0.5]], quick, false), 0, "not far");
        assert_eq!(turned([left, up], quick, false), 0, "upwards");
    }

    #[test]
    fn whoever_presses_once_need_not_hold() {
        let mut gestures = Gestures::default();
        let (here, near) = ([0.5, 0.5], [0.52, 0.51]);
        // On the sculpture and beside it, quickly or slowly, even between two steps, and with a hand that shakes.
        for (steps, takeable) in [(20, false), (20, true), (0, false), (0, true), (500, false), (500, true)] {
            slide(&mut gestures, [here, near], steps, true, takeable);
            assert!(gestures.latched(), "{steps} steps, takeable: {takeable}");
            assert!(gestures.hands().is_empty());
            slide(&mut gestures, [near, here], steps, true, takeable);
            assert!(!gestures.latched(), "{steps} steps, takeable: {takeable}");
        }
        // A pull still takes, and a swipe still turns; neither blows.
        slide(&mut gestures, [here, [0.8, 0.5]], 60, true, true);
        assert!(!gestures.latched());
        slide(&mut gestures, [here, [0.8, 0.5]], 60, true, false);
        assert_eq!((gestures.latched(), gestures.turned()), (false, -1));
    }

    #[test]
    fn a_key_or_a_switch_pressed_once_blows_until_it_is_pressed_again() {
        let mut gestures = Gestures::default();
        let mut on = |hold: bool, keyed: u64, once: bool| {
            gestures.step(&Touch { hold, keyed, once, aspect: ASPECT, ..Touch::default() }, |_| false);
            gestures.latched()
        };
        assert!(on(true, 1, true) && on(true, 1, true) && on(false, 1, true), "down and up: it blows");
        assert!(!on(true, 2, true) && !on(false, 2, true), "again: it ends");
        assert!(on(false, 3, true), "a press between two steps counts");
        assert!(on(false, 5, true), "so do two");
        assert!(!on(true, 5, true) && !on(false, 5, true), "a controller without a key");
        assert!(on(true, 6, true) && !on(true, 6, false), "whoever holds again holds");
        assert!(!on(false, 6, true));
    }
}
