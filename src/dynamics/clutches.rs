//! Slip clutches: couplings that carry so much torque and then give way, as a minute hand on its arbor.
//!
//! Dry friction between two bodies about one axis has two states (D. Karnopp, "Computer simulation of stick-slip friction
//! in mechanical dynamic systems", ASME J. Dynamic Systems, Measurement, and Control 107, 1985); what slips is greased:
//!
//! ```text
//! holds    C = q − q₀ = 0                  a row like any other, multiplier λ             until |λ| > τ
//! slips    f = −τ (sign q̇ + q̇/ω₁)          until the torque that would bring q̇ to rest within a step's time h,
//!                                          −(q̇/h + a₀)/W, is below τ; then q₀ = q
//! ```
//!
//! a₀ is what q̈ would be without friction and W its answer to a unit of torque, joints held. f is taken at the end of a
//! substep, where q̇ + h (a₀ + W f), so that neither what is light swings about its rest, nor what is pulled hard is flung
//! away. The state is looked at between substeps, so that a row is there for all of their stages or for none; what is left
//! of q̇ goes with the projection.
//!
//! | symbol | here | unit |
//! |---|---|---|
//! | q, q₀ | value of the coupling, its offset | rad |
//! | τ | `torque` | N m |
//! | f | `rubs` | N m |
//! | ω₁ | `GREASE` | rad/s |

use crate::articulation::block::{Vec6, add_scaled};
use crate::articulation::{Constraint, System};
use crate::bodies::RigidBody;

/// ω₁: a clutch that slips so fast carries twice its torque, rad/s.
const GREASE: f64 = 0.5;

/// One clutch.
#[derive(Clone, Copy, Debug)]
struct Clutch {
    constraint: usize,
    /// τ.
    torque: f64,
    /// Torque on its first body while it slips, with its sign; 0 while it holds.
    rubs: f64,
}

/// All clutches of a figure.
#[derive(Clone, Debug, Default)]
pub(super) struct Clutches(Vec<Clutch>);

impl Clutches {
    /// All of them hold.
    pub fn new(constraints: &[Constraint]) -> Self {
        let clutch =
            |(constraint, c): (usize, &Constraint)| c.slips.map(|torque| Clutch { constraint, torque, rubs: 0.0 });
        Self(constraints.iter().enumerate().filter_map(clutch).collect())
    }

    /// Adds the torques of what slips.
    pub fn press(&self, system: &System, out: &mut [Vec6]) {
        for clutch in self.0.iter().filter(|clutch| clutch.rubs != 0.0) {
            for (body, block) in system.coupling(clutch.constraint).parts {
                add_scaled(&mut out[*body], clutch.rubs, block);
            }
        }
    }

    /// Lets slip what carries too much, by the last solve of forces. Did anything?
    pub fn give_way(&mut self, system: &mut System) -> bool {
        let mut changed = false;
        for clutch in self.0.iter_mut().filter(|clutch| clutch.rubs == 0.0) {
            let load = system.coupling(clutch.constraint).multiplier;
            if load.abs() > clutch.torque {
                clutch.rubs = clutch.torque.copysign(load);
                system.let_slip(clutch.constraint);
                changed = true;
            }
        }
        changed
    }

    /// Finds the torques of what slips for a substep of `h` seconds, by the accelerations at its start, which are none
    /// afterwards. Did anything take hold? Then its row acts, and what is left of its rate is to go.
    pub fn rub(&mut self, h: f64, system: &mut System, bodies: &[RigidBody]) -> bool {
        let mut held = false;
        for clutch in self.0.iter_mut().filter(|clutch| clutch.rubs != 0.0) {
            let now = system.coupling(clutch.constraint);
            let (rate, acceleration) = (now.rate(bodies), now.acceleration(&system.a));
            let answer = system.answer_along(clutch.constraint);
            let stops = clutch.rubs - (rate / h + acceleration) / answer;
            if stops.abs() < clutch.torque {
                clutch.rubs = 0.0;
                system.take_hold(clutch.constraint, bodies);
                held = true;
            } else {
                let (viscosity, free) = (clutch.torque / GREASE, acceleration - answer * clutch.rubs);
                let dry = clutch.torque.copysign(stops);
                clutch.rubs = (dry - viscosity * (rate + h * free)) / (1.0 + viscosity * h * answer);
            }
        }
        held
    }

    /// How many slip now.
    pub fn slipping(&self) -> usize {
        self.0.iter().filter(|clutch| clutch.rubs != 0.0).count()
    }

    /// Does a clutch slip that touches this body?
    pub fn slips(&self, system: &System, body: usize) -> bool {
        let touches = |clutch: &Clutch| system.coupling(clutch.constraint).parts.iter().any(|part| part.0 == body);
        self.0.iter().any(|clutch| clutch.rubs != 0.0 && touches(clutch))
    }
}
