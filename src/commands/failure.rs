//! How a command ends.

use soffio_exhibit::printable;
use soffio_offline::play::PlayError;
#[cfg(feature = "kiosk")]
use soffio_render::RenderError;

/// What a command returns.
pub type Outcome = Result<(), Failure>;

/// How a command ended when it did not succeed.
#[derive(Debug)]
pub struct Failure {
    /// 1 bad input or problems found, 2 usage, 3 a device or driver is missing or another kiosk has it, 130 interrupted.
    pub code: u8,
    /// Message with place, reason and remedy. Empty where everything is printed already.
    pub message: String,
}

impl Failure {
    /// Bad input, or problems found.
    pub fn input(message: impl std::fmt::Display) -> Self {
        Self { code: 1, message: message.to_string() }
    }

    /// The message as it may be shown on a terminal: of escape sequences only those that set a colour, which reports have.
    pub fn shown(&self) -> String {
        /// Begin of a sequence that sets colours and weight; digits and `;` follow, then `m`.
        const COLOR: &str = "\x1b[";
        let mut parts = self.message.split(COLOR);
        let mut out = printable::lines(parts.next().unwrap_or_default()).into_owned();
        for part in parts {
            let end = part.find(|c: char| !c.is_ascii_digit() && c != ';').unwrap_or(part.len());
            out.push_str(if part[end..].starts_with('m') { COLOR } else { r"\u{1b}[" });
            out.push_str(&printable::lines(part));
        }
        out
    }

    /// A device or driver is missing, or another kiosk is running.
    pub fn device(message: impl std::fmt::Display) -> Self {
        Self { code: 3, message: message.to_string() }
    }

    /// A run that ended early.
    pub fn of_run(error: PlayError) -> Self {
        match error {
            PlayError::Interrupted => Self { code: 130, message: "interrupted; nothing was written".into() },
            error => Self::input(error),
        }
    }

    /// A picture that could not be drawn. A missing driver is not the visitor's input.
    #[cfg(feature = "kiosk")]
    pub fn of_picture(error: RenderError) -> Self {
        match error {
            RenderError::TooManyBodies { .. } | RenderError::Size { .. } => Self::input(error),
            _ => Self::device(error),
        }
    }
}
