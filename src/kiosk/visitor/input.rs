//! What a visitor does with pointer, touch and keys, as what the simulation and the overlay are told.
//!
//! One action, many ways to do it: aim with pointer, finger or arrow keys; blow by holding button, finger or a key; take
//! the sculpture by pulling button or finger (`gesture` tells one from the other). The place where a pointer happens to
//! lie when the window opens is nobody's aim: it counts once it has moved.
//!
//! Invariant: whatever is held is let go at the latest when the window loses the focus.

use crate::visitor::gesture::{Lift, Press};
use soffio_config::Chord;

/// How far a pointer must move before it aims, in picture heights or widths.
const FIRST_MOVE: f64 = 0.01;

/// Where a pointer is that was never seen.
const CENTRE: [f64; 2] = [0.5, 0.5];

/// What the window reports. Positions are picture coordinates, (0,0) top left, (1,1) bottom right.
#[derive(Clone, Debug, PartialEq)]
pub enum Signal {
    /// The pointer is there.
    Pointer([f64; 2]),
    /// The pointer's first button went down or up.
    Button(bool),
    /// A finger on the glass.
    Touch {
        /// Which finger.
        finger: u64,
        /// Where it is.
        at: [f64; 2],
        /// What it does.
        phase: Phase,
    },
    /// A key went down or up.
    Key(Key),
    /// The window lost the focus: no release will be heard any more.
    Deserted,
}

/// What a finger does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// It has just come.
    Down,
    /// It slides.
    Move,
    /// It has just left.
    Up,
}

/// A key and what is held with it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Key {
    /// Place of the key on a US keyboard: `A`, `7`, `F1`, `Space`, `Escape`.
    pub name: String,
    /// Down or up.
    pub pressed: bool,
    /// Down again and again because it is held.
    pub repeat: bool,
    /// Control held.
    pub ctrl: bool,
    /// Alt held.
    pub alt: bool,
    /// Shift held.
    pub shift: bool,
}

/// What a signal asks of the kiosk besides aim and blow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// The next language.
    NextLanguage,
    /// The language at this place among those offered.
    Language(usize),
    /// So many steps louder.
    Louder(i32),
    /// Open or close the page with all the rest.
    Menu,
    /// Show the work at this place among those offered.
    Work(usize),
    /// So many works on; while the page is open, so many leaves.
    Leaf(i32),
    /// Large type, or an end of it.
    Large,
    /// High contrast, or an end of it.
    Contrast,
    /// The microphone off, or on again.
    Listen,
    /// A press begins the breath and the next one ends it, or: it is held.
    PressOnce,
    /// Resting the pointer presses, or does not.
    Dwell,
    /// Less motion, or as much as there is.
    Calm,
    /// Look round the work, or back at it as it is shown.
    Round,
    /// Read aloud what is written, or hush.
    Speak,
    /// Mark the next button that way, right and down.
    Look([i32; 2]),
    /// Press the marked button.
    Enter,
    /// It lies beside all buttons.
    Nothing,
    /// Staff mute the kiosk, or let it sound again.
    Mute,
    /// Staff go on from the configured hours to night, to day, and back.
    Night,
    /// Staff open the kiosk while the house is closed, or close it again.
    Open,
    /// Open or close the staff panel.
    ToggleStaff,
    /// Close a window on somebody's desk. Nothing a visitor can do in the gallery asks for it.
    Close,
}

/// The visitor as pointer, fingers and keys show him.
#[derive(Clone, Debug, Default)]
pub struct Visitor {
    aim: Option<[f64; 2]>,
    /// Where the pointer is, aiming or not.
    lies: Option<[f64; 2]>,
    /// Where it lay when it did not aim yet.
    resting: Option<[f64; 2]>,
    /// The finger that aims.
    finger: Option<u64>,
    /// What is down, by finger or by the pointer's button, and where it came down.
    presses: Vec<(Option<u64>, Press, [f64; 2])>,
    /// What has come up and was not told yet.
    lifts: Vec<Lift>,
    /// Presses so far.
    pressed: u64,
    key: bool,
    /// Times that the key went down.
    keyed: u64,
    /// Arrow keys held: left, right, up, down.
    arrows: [bool; 4],
    activity: u64,
}

/// Names of the arrow keys, in the order of `Visitor::arrows`.
const ARROWS: [&str; 4] = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"];

/// Keys of the volume: + and −, beside the digits, on the number pad, and those made for it.
const LOUDER: [&str; 3] = ["Equal", "NumpadAdd", "AudioVolumeUp"];
const SOFTER: [&str; 3] = ["Minus", "NumpadSubtract", "AudioVolumeDown"];

/// Keys that the site chooses.
#[derive(Clone, Copy, Debug)]
pub struct Keys<'a> {
    /// Opens the staff panel.
    pub staff: &'a Chord,
    /// Mutes the kiosk.
    pub mute: &'a Chord,
    /// Changes between day and night.
    pub night: &'a Chord,
    /// Opens the kiosk while the house is closed.
    pub open: &'a Chord,
    /// Blows while it is held.
    pub blow: &'a str,
    /// Reads aloud.
    pub read: &'a str,
    /// Is the page open? Then arrows choose, and nothing blows.
    pub menu: bool,
}

impl Keys<'_> {
    /// What the staff's chords ask for.
    pub fn chord(&self, key: &Key) -> Option<Request> {
        let chords = [
            (self.staff, Request::ToggleStaff),
            (self.open, Request::Open),
            (self.mute, Request::Mute),
            (self.night, Request::Night),
        ];
        let pressed = |chord: &Chord| chord.matches(key.ctrl, key.alt, key.shift, &key.name);
        let new = key.pressed && !key.repeat;
        chords.into_iter().find(|(chord, _)| new && pressed(chord)).map(|(_, request)| request)
    }
}

impl Visitor {
    /// Takes in a signal. `windowed` says that this is somebody's desk and not the gallery.
    pub fn signal(&mut self, signal: &Signal, keys: Keys, windowed: bool) -> Option<Request> {
        match signal {
            Signal::Pointer(at) => self.pointer(*at),
            Signal::Button(down) => {
                self.press(None, self.lies.unwrap_or(CENTRE), *down);
                self.activity += 1;
            }
            Signal::Touch { finger, at, phase } => self.touch(*finger, *at, *phase),
            Signal::Key(key) => {
                self.activity += 1;
                return self.key(key, keys, windowed);
            }
            Signal::Deserted => self.let_go(),
        }
        None
    }

    /// Where the breath is aimed; `None` is the centre.
    pub fn aim(&self) -> Option<[f64; 2]> {
        self.aim
    }

    /// Is the key held that blows?
    pub fn holds_key(&self) -> bool {
        self.key
    }

    /// The button and the fingers that are down, in the order in which they came.
    pub fn presses(&self) -> impl Iterator<Item = Press> {
        self.presses.iter().map(|(_, press, _)| *press)
    }

    /// What has come up since this was asked last: however short a press was, it is told.
    pub fn lifts(&mut self) -> Vec<Lift> {
        std::mem::take(&mut self.lifts)
    }

    /// Times that the key that blows went down.
    pub fn keyed(&self) -> u64 {
        self.keyed
    }

    /// Where the arrow keys push the aim, right and down, −1, 0 or 1 each.
    pub fn stick(&self) -> [f64; 2] {
        let [left, right, up, down] = self.arrows.map(|held| f64::from(u8::from(held)));
        [right - left, down - up]
    }

    /// Inputs so far: whoever sees it grow knows that somebody is there.
    pub fn activity(&self) -> u64 {
        self.activity
    }

    /// Where a signal begins to press on the picture; `None` where it does not.
    pub fn press_position(&self, signal: &Signal) -> Option<[f64; 2]> {
        match signal {
            Signal::Button(true) => self.lies,
            Signal::Touch { at, phase: Phase::Down, .. } => Some(*at),
            _ => None,
        }
    }

    /// Where the pointer is, once it has moved: for whoever rests it. Nowhere while something is pressed.
    pub fn rests(&self) -> Option<[f64; 2]> {
        self.aim.and(self.lies).filter(|_| self.presses.is_empty() && self.finger.is_none())
    }

    /// A short press of a pointer that rests, there.
    pub fn tap(&mut self, at: [f64; 2]) {
        self.press(None, at, true);
        self.press(None, at, false);
        self.activity += 1;
    }

    /// Counts an input that is neither aim nor breath.
    pub fn note(&mut self) {
        self.activity += 1;
    }

    /// Whatever is held is let go: a page has come between.
    pub fn let_go(&mut self) {
        (self.finger, self.key, self.arrows) = (None, false, [false; 4]);
        self.presses.clear();
        self.lifts.clear();
    }

    /// Nobody is there any more: the next visitor starts from the centre.
    pub fn leave(&mut self) {
        let (lies, activity, pressed, keyed) = (self.lies, self.activity, self.pressed, self.keyed);
        *self = Self { lies, resting: lies, activity, pressed, keyed, ..Self::default() };
    }

    /// A button (`None`) or finger goes down or up.
    fn press(&mut self, by: Option<u64>, at: [f64; 2], down: bool) {
        if let Some(index) = self.presses.iter().position(|(other, ..)| *other == by) {
            let (_, press, from) = self.presses.remove(index);
            if !down {
                self.lifts.push(Lift { id: press.id, from, at: clamp(at) });
            }
        }
        if down {
            self.pressed += 1;
            self.presses.push((by, Press { id: self.pressed, at: clamp(at) }, clamp(at)));
        }
    }

    fn slide(&mut self, by: Option<u64>, at: [f64; 2]) {
        self.presses.iter_mut().filter(|(other, ..)| *other == by).for_each(|(_, press, _)| press.at = clamp(at));
    }

    fn pointer(&mut self, at: [f64; 2]) {
        self.lies = Some(at);
        self.slide(None, at);
        let rest = *self.resting.get_or_insert(at);
        let moved = (at[0] - rest[0]).abs().max((at[1] - rest[1]).abs());
        if self.aim.is_some() || moved > FIRST_MOVE {
            self.aim = Some(clamp(at));
            self.activity += 1;
        }
    }

    /// The first finger aims; each one presses.
    fn touch(&mut self, finger: u64, at: [f64; 2], phase: Phase) {
        self.activity += 1;
        match phase {
            Phase::Move => self.slide(Some(finger), at),
            Phase::Down | Phase::Up => self.press(Some(finger), at, phase == Phase::Down),
        }
        match (self.finger, phase) {
            (None, Phase::Down) => (self.finger, self.aim) = (Some(finger), Some(clamp(at))),
            (Some(first), Phase::Move) if first == finger => self.aim = Some(clamp(at)),
            (Some(first), Phase::Up) if first == finger => self.finger = None,
            _ => {}
        }
    }

    fn key(&mut self, key: &Key, keys: Keys, windowed: bool) -> Option<Request> {
        let plain = !(key.ctrl || key.alt);
        // A key that comes up lets go of the blow whatever is held with it by now.
        if key.name == keys.blow && (plain || !key.pressed) {
            self.key = key.pressed && !keys.menu;
            self.keyed += u64::from(self.key && !key.repeat);
        }
        if let Some(arrow) = ARROWS.iter().position(|name| *name == key.name) {
            self.arrows[arrow] = key.pressed && plain && !keys.menu;
        }
        if !key.pressed || key.repeat {
            return None;
        }
        if keys.menu && plain {
            let ways = [[-1, 0], [1, 0], [0, -1], [0, 1]];
            if let Some(arrow) = ARROWS.iter().position(|name| *name == key.name) {
                return Some(Request::Look(ways[arrow]));
            }
            if key.name == "Enter" || key.name == "NumpadEnter" || key.name == keys.blow {
                return Some(Request::Enter);
            }
        }
        if let Some(asked) = keys.chord(key) {
            return Some(asked);
        }
        match key.name.as_str() {
            name if plain && LOUDER.contains(&name) => Some(Request::Louder(1)),
            name if plain && SOFTER.contains(&name) => Some(Request::Louder(-1)),
            name if plain && name == keys.read => Some(Request::Speak),
            "L" if plain => Some(Request::NextLanguage),
            "Tab" if !key.ctrl && !key.alt => Some(Request::Menu),
            "PageDown" if plain => Some(Request::Leaf(1)),
            "PageUp" if plain => Some(Request::Leaf(-1)),
            "Escape" if windowed => Some(Request::Close),
            _ => None,
        }
    }
}

/// Inside the picture.
fn clamp(at: [f64; 2]) -> [f64; 2] {
    at.map(|x| x.clamp(0.0, 1.0))
}
