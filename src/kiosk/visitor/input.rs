//! Input of a visitor: pointer, touch and keys as inputs of the simulation and requests to the kiosk.
//!
//! Each action has several inputs: aim with pointer, finger or arrow keys; blow by holding button, finger or a key; grab the
//! sculpture by pulling with button or finger (`gesture` distinguishes them). The pointer sets the aim only after it has
//! moved, not by its place when the window opens.
//!
//! Invariant: everything that is held is released at the latest when the window loses the focus.

use crate::visitor::gesture::{Lift, Press};
use soffio_config::{Chord, Modifiers};

/// Distance that a pointer must move before it aims, picture heights or widths.
const FIRST_MOVE: f64 = 0.01;

/// Place of a pointer that has not moved yet.
const CENTRE: [f64; 2] = [0.5, 0.5];

/// An input event of the window. Positions are picture coordinates, (0,0) top left, (1,1) bottom right.
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
    /// The window lost the focus: no release will be reported any more.
    FocusLost,
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

/// A key and the modifiers held with it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Key {
    /// Place of the key on a US keyboard: `A`, `7`, `F1`, `Space`, `Escape`.
    pub name: String,
    /// Down or up.
    pub pressed: bool,
    /// Down again and again because it is held.
    pub repeat: bool,
    /// The modifiers held with it.
    pub modifiers: Modifiers,
}

/// A request to the kiosk, besides aim and blow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// The next language.
    NextLanguage,
    /// The language at this place among those offered.
    Language(usize),
    /// So many steps louder.
    Louder(i32),
    /// Open or close the page behind "More".
    Menu,
    /// Show the exhibit at this place among those offered.
    Exhibit(usize),
    /// Go forward by so many exhibits; while the page is open, by so many pages.
    Page(i32),
    /// Large type on or off.
    Large,
    /// High contrast on or off.
    Contrast,
    /// Microphone off or on.
    ToggleMicrophone,
    /// "Press once" on or off: a press begins the breath and the next one ends it.
    PressOnce,
    /// Dwell clicking on or off.
    Dwell,
    /// Reduced motion on or off.
    ReducedMotion,
    /// Looking around the exhibit on or off.
    LookAround,
    /// Start or stop reading aloud.
    ReadAloud,
    /// Move the focus to the next button in this direction, right and down.
    MoveFocus([i32; 2]),
    /// Press the focused button.
    PressFocused,
    /// Nothing: a press beside all buttons of a page.
    Nothing,
    /// Staff mute or unmute the kiosk.
    Mute,
    /// Staff switch from the configured hours to night, to day, and back.
    Night,
    /// Staff open the kiosk outside opening hours, or close it again.
    Open,
    /// Open or close the staff panel.
    ToggleStaff,
    /// Close a window on a desk. No input of a visitor in the gallery requests it.
    Close,
}

/// State of pointer, fingers and keys.
#[derive(Clone, Debug, Default)]
pub struct Visitor {
    aim: Option<[f64; 2]>,
    /// Where the pointer is, aiming or not.
    lies: Option<[f64; 2]>,
    /// First place of the pointer, before it aims.
    resting: Option<[f64; 2]>,
    /// The finger that aims.
    finger: Option<u64>,
    /// Presses that are down, by finger (`None`: the pointer's button), and where they came down.
    presses: Vec<(Option<u64>, Press, [f64; 2])>,
    /// Presses that have come up and were not taken yet.
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

/// Keys of the site's configuration.
#[derive(Clone, Copy, Debug)]
pub struct Keys<'a> {
    /// Opens the staff panel.
    pub staff: &'a Chord,
    /// Mutes the kiosk.
    pub mute: &'a Chord,
    /// Changes between day and night.
    pub night: &'a Chord,
    /// Opens the kiosk outside opening hours.
    pub open: &'a Chord,
    /// Blows while it is held.
    pub blow: &'a str,
    /// Reads aloud.
    pub read: &'a str,
    /// Is the page open? Then arrows choose, and nothing blows.
    pub menu: bool,
}

impl Keys<'_> {
    /// Request of the staff's chords.
    pub fn chord(&self, key: &Key) -> Option<Request> {
        let chords = [
            (self.staff, Request::ToggleStaff),
            (self.open, Request::Open),
            (self.mute, Request::Mute),
            (self.night, Request::Night),
        ];
        let pressed = |chord: &Chord| chord.matches(key.modifiers, &key.name);
        let new = key.pressed && !key.repeat;
        chords.into_iter().find(|(chord, _)| new && pressed(chord)).map(|(_, request)| request)
    }
}

impl Visitor {
    /// Handles a signal. `windowed`: the kiosk runs in a window on a desk, not in the gallery.
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
            Signal::FocusLost => self.release_all(),
        }
        None
    }

    /// Aim of the breath; `None` is the centre.
    pub fn aim(&self) -> Option<[f64; 2]> {
        self.aim
    }

    /// Is the key held that blows?
    pub fn holds_key(&self) -> bool {
        self.key
    }

    /// Presses that are down, in the order in which they came.
    pub fn presses(&self) -> impl Iterator<Item = Press> {
        self.presses.iter().map(|(_, press, _)| *press)
    }

    /// Takes the presses that have come up since the last call, however short they were.
    pub fn lifts(&mut self) -> Vec<Lift> {
        std::mem::take(&mut self.lifts)
    }

    /// Number of presses of the key that blows.
    pub fn keyed(&self) -> u64 {
        self.keyed
    }

    /// Direction of the arrow keys, right and down, −1, 0 or 1 each.
    pub fn stick(&self) -> [f64; 2] {
        let [left, right, up, down] = self.arrows.map(|held| f64::from(u8::from(held)));
        [right - left, down - up]
    }

    /// Number of inputs so far; while it grows, somebody is there.
    pub fn activity(&self) -> u64 {
        self.activity
    }

    /// Place where a signal begins a press on the picture; `None` for other signals.
    pub fn press_position(&self, signal: &Signal) -> Option<[f64; 2]> {
        match signal {
            Signal::Button(true) => self.lies,
            Signal::Touch { at, phase: Phase::Down, .. } => Some(*at),
            _ => None,
        }
    }

    /// Place of the pointer for dwell clicking, once it has moved; `None` while something is pressed.
    pub fn resting_pointer(&self) -> Option<[f64; 2]> {
        self.aim.and(self.lies).filter(|_| self.presses.is_empty() && self.finger.is_none())
    }

    /// A short press at this place by dwell clicking.
    pub fn tap(&mut self, at: [f64; 2]) {
        self.press(None, at, true);
        self.press(None, at, false);
        self.activity += 1;
    }

    /// Counts an input that is neither aim nor breath.
    pub fn count_input(&mut self) {
        self.activity += 1;
    }

    /// Releases everything that is held, as when a page opens.
    pub fn release_all(&mut self) {
        (self.finger, self.key, self.arrows) = (None, false, [false; 4]);
        self.presses.clear();
        self.lifts.clear();
    }

    /// The visitor has left: the next one starts from the centre.
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
        let plain = !(key.modifiers.ctrl || key.modifiers.alt);
        // A released key ends the blow, whatever modifiers are held.
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
                return Some(Request::MoveFocus(ways[arrow]));
            }
            if key.name == "Enter" || key.name == "NumpadEnter" || key.name == keys.blow {
                return Some(Request::PressFocused);
            }
        }
        if let Some(request) = keys.chord(key) {
            return Some(request);
        }
        match key.name.as_str() {
            name if plain && LOUDER.contains(&name) => Some(Request::Louder(1)),
            name if plain && SOFTER.contains(&name) => Some(Request::Louder(-1)),
            name if plain && name == keys.read => Some(Request::ReadAloud),
            "L" if plain => Some(Request::NextLanguage),
            "Tab" if !key.modifiers.ctrl && !key.modifiers.alt => Some(Request::Menu),
            "PageDown" if plain => Some(Request::Page(1)),
            "PageUp" if plain => Some(Request::Page(-1)),
            "Escape" if windowed => Some(Request::Close),
            _ => None,
        }
    }
}

/// Inside the picture.
fn clamp(at: [f64; 2]) -> [f64; 2] {
    at.map(|x| x.clamp(0.0, 1.0))
}
