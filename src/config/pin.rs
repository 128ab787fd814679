//! The staff's PIN. The configuration holds its Argon2id hash, never the digits. A reader of the file has to try PINs one
//! by one, and each try costs 64 MiB and some tenths of a second. PINs that are tried first are refused.

use std::ops::RangeInclusive;

use argon2::password_hash::{PasswordHash, PasswordHasher, PasswordVerifier, SaltString};
use argon2::{ARGON2ID_IDENT, Algorithm, Argon2, Params, Version};
use serde::{Deserialize, Serialize};

/// How many digits a PIN may have. All PINs of six digits take three years of processor time to try.
pub const DIGITS: RangeInclusive<usize> = 6..=12;

/// Memory and passes of a new hash: the second recommended choice of RFC 9106, section 4, on one thread. KiB, and a number.
const COST: (u32, u32) = (64 * 1024, 3);
/// Digits in a row, each one more or one less than the one before, that are a run.
const RUN: usize = 4;
/// A PIN has at least so many different digits.
const DIFFERENT: usize = 3;

/// Most memory that a hash may need, KiB: a typing error must not stop the kiosk at the first try.
const MOST_MEMORY: u32 = 256 * 1024;
/// Most passes that a hash may need.
const MOST_PASSES: u32 = 16;

/// A PIN as its hash in the text form of PHC strings; empty where none is set.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(try_from = "String", into = "String")]
#[schemars(with = "String")]
pub struct Pin(String);

impl Pin {
    /// The hash of these digits with 16 random bytes.
    ///
    /// # Errors
    ///
    /// The digits are too few or too many, or something else than digits, or easily guessed; the message says which.
    pub fn new(digits: &str, salt: &[u8; 16]) -> Result<Self, String> {
        if !DIGITS.contains(&digits.len()) || !digits.bytes().all(|b| b.is_ascii_digit()) {
            return Err(format!("a PIN has {} to {} digits and nothing else", DIGITS.start(), DIGITS.end()));
        }
        if let Some(why) = weakness(digits) {
            return Err(format!("somebody who guesses tries this PIN first: {why}; take digits without a pattern"));
        }
        let salt = SaltString::encode_b64(salt).map_err(|error| error.to_string())?;
        let params = Params::new(COST.0, COST.1, 1, None).map_err(|error| error.to_string())?;
        let hasher = Argon2::new(Algorithm::Argon2id, Version::V0x13, params);
        let hash = hasher.hash_password(digits.as_bytes(), &salt).map_err(|error| error.to_string())?;
        Ok(Self(hash.to_string()))
    }

    /// Is there one?
    pub fn is_set(&self) -> bool {
        !self.0.is_empty()
    }

    /// Are these its digits? Takes some tenths of a second and 64 MiB; an older hash takes less. Without a PIN nothing matches.
    pub fn matches(&self, digits: &str) -> bool {
        // The parameters are the hash's own.
        PasswordHash::new(&self.0).is_ok_and(|hash| Argon2::default().verify_password(digits.as_bytes(), &hash).is_ok())
    }
}

impl TryFrom<String> for Pin {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        if text.is_empty() {
            return Ok(Self(text));
        }
        let help = "`soffio pin` asks for a PIN and prints this line";
        let wrong = |why: &str| format!("this is no PIN's hash ({why}); {help}");
        let hash = PasswordHash::new(&text).map_err(|error| wrong(&error.to_string()))?;
        if hash.algorithm != ARGON2ID_IDENT || hash.hash.is_none() || hash.salt.is_none() {
            return Err(wrong("it does not begin with $argon2id$, or its end is missing"));
        }
        let params = Params::try_from(&hash).map_err(|error| wrong(&error.to_string()))?;
        if params.m_cost() > MOST_MEMORY || params.t_cost() > MOST_PASSES {
            return Err(wrong("it needs too much memory or time"));
        }
        Ok(Self(text))
    }
}

impl From<Pin> for String {
    fn from(pin: Pin) -> Self {
        pin.0
    }
}

/// Why a PIN is easily guessed, if it is.
fn weakness(pin: &str) -> Option<&'static str> {
    let digits: Vec<i32> = pin.bytes().map(|digit| i32::from(digit - b'0')).collect();
    let mut different = digits.clone();
    different.sort_unstable();
    different.dedup();
    let repeats = |period: usize| digits.iter().skip(period).zip(&digits).all(|(a, b)| a == b);
    let is_run = |part: &[i32]| [1, 9].iter().any(|step| part.windows(2).all(|w| (w[0] + step) % 10 == w[1]));
    if different.len() < DIFFERENT {
        Some("it has fewer than three different digits")
    } else if (1..=digits.len() / 2).any(repeats) {
        Some("it repeats itself")
    } else if digits.windows(RUN).any(is_run) {
        Some("it counts up or down, as 1234 does")
    } else if is_date(&digits) {
        Some("it is a date")
    } else {
        None
    }
}

/// Six or eight digits that are day, month and year in one of the usual orders.
fn is_date(digits: &[i32]) -> bool {
    let two = |at: usize| 10 * digits[at] + digits[at + 1];
    let day_and_month = |a: i32, b: i32| {
        let fits = |day: i32, month: i32| (1..=31).contains(&day) && (1..=12).contains(&month);
        fits(a, b) || fits(b, a)
    };
    let century = |at: usize| (19..=20).contains(&two(at));
    match digits.len() {
        6 => day_and_month(two(0), two(2)) || (two(2) <= 12 && day_and_month(two(4), two(2))),
        8 => century(0) && day_and_month(two(4), two(6)) || century(4) && day_and_month(two(0), two(2)),
        _ => false,
    }
}
