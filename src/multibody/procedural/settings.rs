//! What a user chooses of motion by places.

/// c where nobody says otherwise: what falls for a step under a long chain turns none of its links, a hand that goes a
/// metre a second does.
pub const CONTROL: f64 = 10.0;

/// How joints are closed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The source's compulsive motion, joint by joint.
    Compulsive,
    /// All joints at once.
    #[default]
    TreeSolve,
}

/// What a user chooses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How joints are closed.
    pub method: Method,
    /// c of the compulsive rotation: the greater, the less bodies turn when pulled (no unit, from 0).
    pub control: f64,
    /// Share of the velocity kept from step to step beside the bodies' own damping, 0 … 1.
    pub retention: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { method: Method::default(), control: CONTROL, retention: 1.0 }
    }
}
