//! The staff's PIN. The configuration holds its Argon2id hash, never the digits. A reader of the file has to try PINs one
//! by one, and each try costs 19 MiB and some hundredths of a second.

use std::ops::RangeInclusive;

use argon2::password_hash::{PasswordHash, PasswordHasher, PasswordVerifier, SaltString};
use argon2::{ARGON2ID_IDENT, Algorithm, Argon2, Params, Version};
use serde::{Deserialize, Serialize};

/// How many digits a PIN may have.
pub const DIGITS: RangeInclusive<usize> = 4..=12;

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
    /// The digits are too few or too many, or something else than digits.
    pub fn new(digits: &str, salt: &[u8; 16]) -> Result<Self, String> {
        if !DIGITS.contains(&digits.len()) || !digits.bytes().all(|b| b.is_ascii_digit()) {
            return Err(format!("a PIN has {} to {} digits and nothing else", DIGITS.start(), DIGITS.end()));
        }
        let salt = SaltString::encode_b64(salt).map_err(|error| error.to_string())?;
        let hasher = Argon2::new(Algorithm::Argon2id, Version::V0x13, Params::default());
        let hash = hasher.hash_password(digits.as_bytes(), &salt).map_err(|error| error.to_string())?;
        Ok(Self(hash.to_string()))
    }

    /// Is there one?
    pub fn is_set(&self) -> bool {
        !self.0.is_empty()
    }

    /// Are these its digits? Takes some hundredths of a second and 19 MiB. Without a PIN nothing matches.
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
