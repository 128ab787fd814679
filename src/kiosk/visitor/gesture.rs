//! Gesture recognition: press and hold blows, press and pull grabs the sculpture, a swipe beside it shows the next exhibit.
//!
//! A press on a body that can be grabbed is decided within 0.18 s; a press beside all bodies blows at once. The meaning of a
//! press then stays until it ends, so a steered breath never becomes a grab. The first press that blows sets the aim; keys
//! and switches blow without a press.
//!
//! A swipe is a press beside all bodies that ends soon and far to one side, faster than a breath is steered. A press that
//! pulls a body is never a swipe.
//!
//! While the visitor looks around, a press beside the exhibit neither blows nor swipes: it turns the camera. A press on the
//! exhibit works as before.
//!
//! With "press once", for visitors who cannot hold, a released press begins a breath and the next one ends it, unless it
//! grabbed or swiped. An unsteady hand may slide a little meanwhile. While looking around, a press beside the exhibit turns
//! the camera by a fixed angle towards it.

use crate::visitor::orbit;
use soffio_simulation::{PointerGrab, STEPS_PER_SECOND};

/// A pointer button or finger that is down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Press {
    /// Unique number of the press.
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
    /// Where it came up.
    pub at: [f64; 2],
}

/// Presses and keys of one step.
#[derive(Clone, Copy, Debug, Default)]
pub struct PressInput<'a> {
    /// Presses that are down.
    pub presses: &'a [Press],
    /// Presses that have come up since the last step.
    pub lifts: &'a [Lift],
    /// Is a key, a switch or a controller held?
    pub hold: bool,
    /// Number of key presses so far; a short one may lie between two steps.
    pub keyed: u64,
    /// Does a press begin the breath and the next one end it?
    pub press_once: bool,
    /// Does the visitor look around the exhibit?
    pub look_around: bool,
    /// Width over height of the picture.
    pub aspect: f64,
}

/// Distance from which a press grabs, picture heights; the second one for an unsteady hand.
const PULL: f64 = 0.015;
const UNSTEADY_PULL: f64 = 0.05;
/// Time after which an undecided press blows, s.
const PATIENCE: f64 = 0.18;
/// A swipe: least distance to the side, picture heights; longest time, s; least ratio of horizontal to vertical distance.
const SWIPE: f64 = 0.25;
const SWIPE_S: f64 = 0.4;
const SWIPE_SLOPE: f64 = 2.0;

/// Meaning of a press.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Meaning {
    /// Undecided for so many steps; it lies on a body.
    Waits(u64),
    BreathCounts,
    Grabs,
    Orbits,
}

/// A press over time.
#[derive(Clone, Copy, Debug)]
struct TrackedPress {
    id: u64,
    from: [f64; 2],
    /// Where it was in the last step.
    at: [f64; 2],
    meaning: Meaning,
    /// Did it come down beside all bodies that can be grabbed?
    free: bool,
    /// Steps since it came down, and since it grabbed.
    age: u64,
    held: u64,
}

/// All presses over time.
#[derive(Clone, Debug, Default)]
pub struct Gestures {
    known: Vec<TrackedPress>,
    grabs: Vec<PointerGrab>,
    /// Is a latched breath on?
    latched: bool,
    keyed: u64,
    hold: bool,
    swipes: i64,
    camera_turn: [f64; 2],
}

impl Gestures {
    /// Advances by one step. `takeable` tests whether a body that can be grabbed lies at a place. Returns the place of the
    /// first press that blows.
    pub fn step(&mut self, input: &PressInput, mut takeable: impl FnMut([f64; 2]) -> bool) -> Option<[f64; 2]> {
        self.update_keys(input);
        self.camera_turn = [0.0; 2];
        for lift in input.lifts {
            self.lift(lift, input, &mut takeable);
        }
        self.known.retain(|known| input.presses.iter().any(|press| press.id == known.id));
        self.grabs.clear();
        let (mut blows, mut turns) = (None, None);
        for press in input.presses {
            let index = self.known.iter().position(|known| known.id == press.id).unwrap_or_else(|| {
                let free = !takeable(press.at);
                let meaning = match (free, input.look_around) {
                    (true, true) => Meaning::Orbits,
                    (true, false) => Meaning::BreathCounts,
                    (false, _) => Meaning::Waits(0),
                };
                self.known.push(TrackedPress {
                    id: press.id,
                    from: press.at,
                    at: press.at,
                    meaning,
                    free,
                    age: 0,
                    held: 0,
                });
                self.known.len() - 1
            });
            let known = &mut self.known[index];
            known.age += 1;
            if let Meaning::Waits(steps) = known.meaning {
                let [x, y] = displacement(known.from, press.at, input.aspect);
                known.meaning = if x.hypot(y) > if input.press_once { UNSTEADY_PULL } else { PULL } {
                    Meaning::Grabs
                } else if steps as f64 >= PATIENCE * STEPS_PER_SECOND as f64 && !input.press_once {
                    Meaning::BreathCounts
                } else {
                    Meaning::Waits(steps + 1)
                };
            }
            match known.meaning {
                Meaning::Grabs => {
                    // It grabs the body that lay under it when it came down.
                    let at = if known.held == 0 { known.from } else { press.at };
                    known.held += 1;
                    self.grabs.push(PointerGrab { id: press.id, at, body: None });
                }
                Meaning::BreathCounts if !input.press_once => blows = blows.or(Some(press.at)),
                // Only the first finger turns the camera; two would turn it twice as far.
                Meaning::Orbits => turns = turns.or(Some(displacement(known.at, press.at, input.aspect))),
                Meaning::BreathCounts | Meaning::Waits(_) => {}
            }
            known.at = press.at;
        }
        if let Some(displacement) = turns {
            self.turn_camera(displacement);
        }
        blows
    }

    /// Grabs of the sculpture.
    pub fn grabs(&self) -> &[PointerGrab] {
        &self.grabs
    }

    /// Is a latched breath on: begun by a press, ended by the next one?
    pub fn latched(&self) -> bool {
        self.latched
    }

    /// Ends a latched breath.
    pub fn unlatch(&mut self) {
        self.latched = false;
    }

    /// Swipes forward so far, less those backward.
    pub fn swipes(&self) -> i64 {
        self.swipes
    }

    /// Camera turn of the last step by presses beside the exhibit, to the right and up, rad.
    pub fn camera_turn(&self) -> [f64; 2] {
        self.camera_turn
    }

    /// Turns the camera by a displacement of a finger, picture heights. The picture follows the finger, so the camera moves
    /// against it.
    fn turn_camera(&mut self, [x, y]: [f64; 2]) {
        self.camera_turn[0] -= orbit::TURN * x;
        self.camera_turn[1] += orbit::TURN * y;
    }

    /// Keys, switches and controllers with "press once": each press counts, however short.
    fn update_keys(&mut self, input: &PressInput) {
        let keyed = input.keyed.wrapping_sub(self.keyed);
        let presses = if keyed == 0 { u64::from(input.hold && !self.hold) } else { keyed };
        self.latched = input.press_once && self.latched != (presses % 2 == 1);
        (self.keyed, self.hold) = (input.keyed, input.hold);
    }

    /// Decides what a finished press was.
    fn lift(&mut self, lift: &Lift, input: &PressInput, takeable: &mut impl FnMut([f64; 2]) -> bool) {
        let known = self.known.iter().find(|known| known.id == lift.id);
        if known.is_some_and(|known| known.meaning == Meaning::Grabs) {
            return;
        }
        let turns =
            known.map_or_else(|| input.look_around && !takeable(lift.from), |known| known.meaning == Meaning::Orbits);
        if turns {
            let [x, y] = displacement(lift.from, lift.at, input.aspect);
            if input.press_once && x.hypot(y) < UNSTEADY_PULL {
                let [x, y] = displacement([0.5, 0.5], lift.at, input.aspect);
                let aside =
                    if x.abs() > y.abs() { [orbit::PRESS.copysign(x), 0.0] } else { [0.0, -orbit::PRESS.copysign(y)] };
                self.camera_turn = std::array::from_fn(|i| self.camera_turn[i] + aside[i]);
            }
            return self.turn_camera(displacement(known.map_or(lift.from, |known| known.at), lift.at, input.aspect));
        }
        let (free, age) = known.map_or_else(|| (!takeable(lift.from), 0), |known| (known.free, known.age));
        let [x, y] = displacement(lift.from, lift.at, input.aspect);
        let soon = age as f64 <= SWIPE_S * STEPS_PER_SECOND as f64;
        if free && soon && x.abs() > SWIPE && x.abs() > SWIPE_SLOPE * y.abs() {
            // To the left is forward, as with pages.
            self.swipes += if x < 0.0 { 1 } else { -1 };
        } else if input.press_once {
            self.latched = !self.latched;
        }
    }
}

/// Displacement from one place to another, picture heights.
fn displacement(from: [f64; 2], to: [f64; 2], aspect: f64) -> [f64; 2] {
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
        gestures.step(&PressInput { presses, aspect: ASPECT, ..PressInput::default() }, |_| takeable)
    }

    /// A finger goes from one x to another in so many steps and leaves; `once` as the visitor has chosen.
    fn slide(gestures: &mut Gestures, [from, to]: [[f64; 2]; 2], steps: u64, once: bool, takeable: bool) {
        let input = PressInput { press_once: once, aspect: ASPECT, ..PressInput::default() };
        for i in 0..steps {
            let share = i as f64 / steps as f64;
            let at = [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])];
            gestures.step(&PressInput { presses: &[Press { id: 9, at }], ..input }, |_| takeable);
        }
        gestures.step(&PressInput { lifts: &[Lift { id: 9, from, at: to }], ..input }, |_| takeable);
    }

    #[test]
    fn a_press_beside_the_sculpture_blows_at_once_and_goes_on_wherever_it_is_moved() {
        let mut gestures = Gestures::default();
        assert_eq!(step(&mut gestures, &[press(1, 0.1)], false), Some([0.1, 0.5]));
        assert_eq!(step(&mut gestures, &[press(1, 0.6)], true), Some([0.6, 0.5]));
        assert!(gestures.grabs().is_empty());
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
        assert_eq!(gestures.grabs(), [PointerGrab { id: 2, at: [0.3, 0.5], body: None }]);
        step(&mut gestures, &[press(2, 0.4)], true);
        assert_eq!(gestures.grabs(), [PointerGrab { id: 2, at: [0.4, 0.5], body: None }]);
        step(&mut gestures, &[], true);
        assert!(gestures.grabs().is_empty());
    }

    #[test]
    fn a_swipe_turns_and_nothing_else_does() {
        let (left, right, up) = ([0.3, 0.5], [0.6, 0.52], [0.35, 0.1]);
        let quick = (0.5 * SWIPE_S * STEPS_PER_SECOND as f64) as u64;
        let swipes = |ends: [[f64; 2]; 2], steps: u64, takeable: bool| {
            let mut gestures = Gestures::default();
            slide(&mut gestures, ends, steps, false, takeable);
            gestures.swipes()
        };
        assert_eq!(swipes([right, left], quick, false), 1, "to the left: the next");
        assert_eq!(swipes([left, right], quick, false), -1, "to the right: the one before");
        assert_eq!(swipes([left, right], 0, false), -1, "over before a step saw it");
        assert_eq!(swipes([left, right], quick, true), 0, "it pulled a body");
        assert_eq!(swipes([left, right], 0, true), 0, "it would have pulled one");
        assert_eq!(swipes([left, right], 3 * quick, false), 0, "a breath that is steered");
        assert_eq!(swipes([left, [0.4, 0.5]], quick, false), 0, "not far");
        assert_eq!(swipes([left, up], quick, false), 0, "upwards");
    }

    #[test]
    fn whoever_presses_once_need_not_hold() {
        let mut gestures = Gestures::default();
        let (here, near) = ([0.5, 0.5], [0.52, 0.51]);
        // On the sculpture and beside it, quickly or slowly, even between two steps, and with a hand that shakes.
        for (steps, takeable) in [(20, false), (20, true), (0, false), (0, true), (500, false), (500, true)] {
            slide(&mut gestures, [here, near], steps, true, takeable);
            assert!(gestures.latched(), "{steps} steps, takeable: {takeable}");
            assert!(gestures.grabs().is_empty());
            slide(&mut gestures, [near, here], steps, true, takeable);
            assert!(!gestures.latched(), "{steps} steps, takeable: {takeable}");
        }
        // A pull still takes, and a swipe still turns; neither blows.
        slide(&mut gestures, [here, [0.8, 0.5]], 60, true, true);
        assert!(!gestures.latched());
        slide(&mut gestures, [here, [0.8, 0.5]], 60, true, false);
        assert_eq!((gestures.latched(), gestures.swipes()), (false, -1));
    }

    #[test]
    fn a_key_or_a_switch_pressed_once_blows_until_it_is_pressed_again() {
        let mut gestures = Gestures::default();
        let mut on = |hold: bool, keyed: u64, once: bool| {
            gestures
                .step(&PressInput { hold, keyed, press_once: once, aspect: ASPECT, ..PressInput::default() }, |_| {
                    false
                });
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
