//! When constraints act and break.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::quantity::*;
use super::{Stabilize, Until};

/// When a constraint acts and when it gives way: the same keys for all kinds.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Timing {
    /// When it acts: one table or a list; by default always.
    pub window: Option<Windows>,
    /// The windows repeat after this time.
    pub period: Option<Time>,
    /// What starts the clock of the windows, each time anew; by default the exhibit's reset.
    pub trigger: Option<Start>,
    /// The load at which it gives way.
    #[serde(rename = "break")]
    pub breaking: Option<Break>,
    /// How it draws itself together while it is open; by default as `stabilize` of the solver says.
    pub stabilize: Option<Stabilize>,
    /// Does it act at all? By default true.
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

/// A span of time in which a constraint acts.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Window {
    /// By default 0.
    pub start: Time,
    /// By default "inf".
    pub end: Option<Until>,
    /// Time in which its force grows from nothing.
    pub ramp_in: Time,
    /// Time in which its force fades before the end.
    pub ramp_out: Time,
}

/// What starts the clock of the windows.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(tag = "on", rename_all = "lowercase", deny_unknown_fields)]
pub enum Start {
    /// A hit on a body.
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

/// The load at which a constraint gives way: force, torque or impulse, one of them at least.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Break {
    /// Largest force that it bears.
    pub force: Option<Force>,
    /// Largest torque that it bears.
    pub torque: Option<Torque>,
    /// Largest impulse of a hit that it bears.
    pub impulse: Option<Impulse>,
    /// Time after which it closes again, or "on-reset" (the default) or "never": not before the exhibit starts anew.
    pub restore: Option<Restore>,
}

/// When a broken constraint closes again.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Restore {
    /// Seconds, or a text with a unit.
    After(Time),
    /// Not of itself.
    Word(RestoreWord),
}

/// When a broken constraint closes again.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RestoreWord {
    /// When the exhibit starts anew.
    OnReset,
    /// Not in this run.
    Never,
}
