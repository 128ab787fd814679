//! When constraints are active and when they break.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::quantity::*;
use super::{Stabilize, Until};

/// When a constraint is active and when it breaks: the same keys for all kinds.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Timing {
    /// When it is active: one table or a list; by default always.
    pub window: Option<Windows>,
    /// The windows repeat after this time.
    pub period: Option<Time>,
    /// What starts the time of the windows, again each time; by default the exhibit's reset.
    pub trigger: Option<Start>,
    /// The load at which it breaks.
    #[serde(rename = "break")]
    pub breaking: Option<Break>,
    /// How it closes while it is open; by default the `stabilize` of the solver.
    pub stabilize: Option<Stabilize>,
    /// Is it active at all? By default true.
    pub enabled: Option<bool>,
}

/// One window, or several in the order of time.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Windows {
    /// One.
    One(Window),
    /// Several.
    Several(#[schemars(length(min = 1, max = 256))] Vec<Window>),
}

/// A time span in which a constraint is active.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Window {
    /// Start of the span; by default 0.
    pub start: Time,
    /// End of the span; by default "inf".
    pub end: Option<Until>,
    /// Time over which its force grows from zero.
    pub ramp_in: Time,
    /// Time over which its force fades before the end.
    pub ramp_out: Time,
}

/// What starts the time of the windows.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(tag = "on", rename_all = "lowercase", deny_unknown_fields)]
pub enum Start {
    /// An impact on a body.
    Impact {
        /// Node of the body; it needs a collider.
        body: String,
        /// Least impulse; by default any.
        #[serde(default)]
        least: Impulse,
    },
    /// A breath.
    Breath {
        /// Least speed at the lips; by default any.
        #[serde(default)]
        least: Speed,
    },
}

/// The load at which a constraint breaks: force, torque or impulse, at least one of them.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Break {
    /// Largest force that it bears.
    pub force: Option<Force>,
    /// Largest torque that it bears.
    pub torque: Option<Torque>,
    /// Largest impulse of an impact that it bears.
    pub impulse: Option<Impulse>,
    /// Time after which it closes again, or "on-reset" (the default) or "never".
    pub restore: Option<Restore>,
}

/// When a broken constraint closes again.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Restore {
    /// Seconds, or a text with a unit.
    After(Time),
    /// A word.
    Word(RestoreWord),
}

/// When a broken constraint closes again.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RestoreWord {
    /// When the exhibit is reset.
    OnReset,
    /// Not in this run.
    Never,
}
