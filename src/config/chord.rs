//! A key chord such as `Ctrl+Alt+S`: keys that nobody presses together by chance.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Modifier keys that are held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Modifiers {
    /// Is Control held?
    pub ctrl: bool,
    /// Is Alt held?
    pub alt: bool,
    /// Is Shift held?
    pub shift: bool,
}

impl Modifiers {
    /// Control and Alt: the modifiers of the default chords.
    pub const CTRL_ALT: Self = Self { ctrl: true, alt: true, shift: false };

    /// Number of modifiers that are held.
    fn count(self) -> usize {
        [self.ctrl, self.alt, self.shift].into_iter().filter(|held| *held).count()
    }
}

/// Keys pressed together. Invariant: at least two modifiers, so that a visitor who leans on a keyboard does not press it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(try_from = "String", into = "String")]
#[schemars(with = "String")]
pub struct Chord {
    /// The modifiers.
    pub modifiers: Modifiers,
    /// The key itself: one letter or digit in upper case, or `F1` … `F12`.
    pub key: String,
}

impl Chord {
    /// A chord of modifiers and a key, in upper or lower case.
    pub fn new(modifiers: Modifiers, key: &str) -> Self {
        Self { modifiers, key: key.to_uppercase() }
    }

    /// Is this the chord, with exactly these modifiers? Upper and lower case of the key are the same.
    pub fn matches(&self, modifiers: Modifiers, key: &str) -> bool {
        self.modifiers == modifiers && self.key.eq_ignore_ascii_case(key)
    }
}

impl FromStr for Chord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut chord = Self::new(Modifiers::default(), "");
        for part in text.split('+').map(|part| part.trim().to_uppercase()) {
            match part.as_str() {
                "CTRL" => chord.modifiers.ctrl = true,
                "ALT" => chord.modifiers.alt = true,
                "SHIFT" => chord.modifiers.shift = true,
                key if chord.key.is_empty() && is_key(key) => chord.key = key.into(),
                other => {
                    return Err(format!(
                        "\"{other}\" in \"{text}\" is no key: write one letter, one digit or F1 to F12, after Ctrl, Alt or Shift"
                    ));
                }
            }
        }
        match (chord.key.is_empty(), chord.modifiers.count()) {
            (true, _) => Err(format!("\"{text}\" names no key: write for example \"Ctrl+Alt+S\"")),
            (_, 0 | 1) => Err(format!("\"{text}\" is easily pressed by a visitor: use two of Ctrl, Alt and Shift")),
            _ => Ok(chord),
        }
    }
}

/// One letter, one digit, or a function key.
fn is_key(key: &str) -> bool {
    let one = key.len() == 1 && key.chars().all(|c| c.is_ascii_alphanumeric());
    let function = key.strip_prefix('F').and_then(|n| n.parse::<u32>().ok()).is_some_and(|n| (1..=12).contains(&n));
    one || function
}

impl fmt::Display for Chord {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Modifiers { ctrl, alt, shift } = self.modifiers;
        for (held, name) in [(ctrl, "Ctrl+"), (alt, "Alt+"), (shift, "Shift+")] {
            if held {
                f.write_str(name)?;
            }
        }
        f.write_str(&self.key)
    }
}

impl TryFrom<String> for Chord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Chord> for String {
    fn from(chord: Chord) -> Self {
        chord.to_string()
    }
}
