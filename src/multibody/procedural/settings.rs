//! Settings of position-based motion.

/// Default of [`Settings::control`]: the rotation of least kinetic energy.
pub const DEFAULT_CONTROL: f64 = 1.0;

/// How joints are closed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PositionSolver {
    /// Joint-by-joint relaxation, the source's compulsive motion.
    Relaxation,
    /// Newton's method on all joints at once.
    #[default]
    TreeSolve,
}

/// Settings of position-based motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How joints are closed.
    pub method: PositionSolver,
    /// Control c of the compulsive rotation, from 0, no unit: the greater, the less bodies rotate when pulled. 1 is
    /// the rotation of least kinetic energy.
    pub control: f64,
    /// Fraction of the velocity kept per step besides the bodies' own damping, 0 … 1.
    pub retention: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { method: PositionSolver::default(), control: DEFAULT_CONTROL, retention: 1.0 }
    }
}
