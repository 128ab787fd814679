//! Pointer grabs, and the report of a position solve.

use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;

/// Most grabs at one time.
pub const MAX_GRABS: usize = 4;
/// Error below which joints are closed and grabs at their targets, m or rad.
pub const POSITION_TOLERANCE: f64 = 1e-7;

/// A grab of a point of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrabTarget {
    /// Index of the body.
    pub body: usize,
    /// Grabbed point, node frame, m.
    pub point: DVec3,
    /// Target at the step's end, world, m.
    pub target: DVec3,
}

impl GrabTarget {
    /// World position of the grabbed point, m.
    pub fn world_point(&self, bodies: &[RigidBody]) -> DVec3 {
        bodies[self.body].pose().point(self.point)
    }

    /// Distance of the grabbed point from its target, m.
    pub fn error(&self, bodies: &[RigidBody]) -> f64 {
        self.world_point(bodies).distance(self.target)
    }
}

/// Outcome of a position solve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolveOutcome {
    /// Joints closed, grabs at their targets.
    Converged,
    /// Joints closed, but a grab misses its target: it is out of reach.
    GrabOutOfReach,
    /// A joint is still open.
    JointsOpen,
}

/// Report of a position solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolveReport {
    /// Newton passes and relaxation sweeps.
    pub passes: u32,
    /// Largest joint error, m or rad.
    pub residual: f64,
    /// Largest distance beyond a limit, m or rad.
    pub beyond: f64,
    /// Largest distance of a grabbed point from its target, m.
    pub grab_error: f64,
}

impl SolveReport {
    /// How the solve ended, within [`POSITION_TOLERANCE`].
    pub fn outcome(&self) -> SolveOutcome {
        let within = |error: f64| error <= POSITION_TOLERANCE;
        match (within(self.residual), within(self.grab_error)) {
            (true, true) => SolveOutcome::Converged,
            (true, false) => SolveOutcome::GrabOutOfReach,
            (false, _) => SolveOutcome::JointsOpen,
        }
    }

    /// Whether joints are closed and grabs at their targets.
    pub fn converged(&self) -> bool {
        self.outcome() == SolveOutcome::Converged
    }
}
