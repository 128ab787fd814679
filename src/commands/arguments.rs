//! Arguments that several commands share.

use clap::ValueEnum;
use soffio_exhibit::Exhibit;
use soffio_simulation::MotionMode;

/// Solver on the command line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum SolverArg {
    /// Constrained dynamics.
    Dynamics,
    /// Procedural motion, joint by joint.
    Procedural,
    /// Position-based motion, all joints at once.
    PositionBased,
    /// The exhibit's own choice.
    #[default]
    Auto,
}

impl SolverArg {
    /// Why an exhibit cannot move by this solver; `None` where it can.
    pub fn refusal(self, exhibit: &Exhibit) -> Option<String> {
        let by_positions = matches!(self, Self::Procedural | Self::PositionBased);
        let why = exhibit.refusal().filter(|_| by_positions)?;
        Some(format!("{} moves by dynamics alone: {why}", exhibit.id))
    }

    /// `None` is the exhibit's own choice.
    pub fn mode(self) -> Option<MotionMode> {
        match self {
            Self::Auto => None,
            Self::Dynamics => Some(MotionMode::Dynamic),
            Self::Procedural => Some(MotionMode::Procedural),
            Self::PositionBased => Some(MotionMode::PositionBased),
        }
    }
}

/// Reads a positive number of seconds.
///
/// # Errors
/// The text is no positive number up to a million.
pub fn parse_seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse::<f64>().ok().filter(|s| s.is_finite() && *s > 0.0 && *s <= 1e6);
    seconds.ok_or_else(|| format!("\"{text}\" is no length; write seconds, as in 12.5"))
}

/// Reads `WxH`.
///
/// # Errors
/// The text is not of this form, or a side is 0 or above 16384.
pub fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let wrong = || format!("\"{text}\" is no size; write pixels, as in 1280x720, at most 16384 a side");
    let (w, h) = text.split_once('x').ok_or_else(wrong)?;
    let read = |part: &str| part.parse::<u32>().ok().filter(|v| (1..=16384).contains(v));
    Ok((read(w).ok_or_else(wrong)?, read(h).ok_or_else(wrong)?))
}
