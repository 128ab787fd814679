//! Slip clutches: couplings that carry so much torque and then give way, as a minute hand on its arbor.
//!
//! Dry friction between two bodies about one axis has two states (D. Karnopp, "Computer simulation of stick-slip friction
//! in mechanical dynamic systems", ASME J. Dynamic Systems, Measurement, and Control 107, 1985); what slips is greased:
//!
//! ```text
//! holds    C = q − q₀ = 0                  a row like any other, multiplier λ            until |λ| > τ
//! slips    f = −τ (sign q̇ + q̇/ω₁)          a touch among those that rest                  until q̇ = 0 at |f| < τ; then q₀ = q
//! ```
//!
//! `contacts/grip.rs` has the touch. The state is looked at between substeps, so that a row is there for all of their stages
//! or for none. A substep that ends with a clutch under too much is gone through again from its start with that clutch
//! slipping: contact forces that were found as if it held are not there. So nothing presses through a clutch harder than
//! the clutch carries.
//!
//! | symbol | here | unit |
//! |---|---|---|
//! | q, q₀ | value of the coupling, its offset | rad |
//! | τ | `torque` | N m |
//! | λ | `load` | N m |
//! | f | a touch's impulse over h | N m |
//! | ω₁ | `contacts/grip.rs` | rad/s |

use crate::articulation::{Constraint, System};

use super::contacts::JacobianRow;

/// One clutch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clutch {
    pub constraint: usize,
    /// τ, N m.
    pub torque: f64,
    /// λ at the end of the present pass over a substep, and of the last substep that it held through, N m.
    pub load: f64,
    pub carried: f64,
    pub slips: bool,
}

/// All clutches of a figure.
#[derive(Clone, Debug, Default)]
pub(super) struct Clutches(Vec<Clutch>);

impl Clutches {
    /// All of them hold.
    pub fn new(constraints: &[Constraint]) -> Self {
        let clutch = |(constraint, c): (usize, &Constraint)| {
            c.slips.map(|torque| Clutch { constraint, torque, load: 0.0, carried: 0.0, slips: false })
        };
        Self(constraints.iter().enumerate().filter_map(clutch).collect())
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// Those that slip, each with its index.
    pub fn slipping(&self) -> impl Iterator<Item = (usize, &Clutch)> {
        self.0.iter().enumerate().filter(|(_, clutch)| clutch.slips)
    }

    /// Does any hold?
    pub fn any_holds(&self) -> bool {
        self.0.iter().any(|clutch| !clutch.slips)
    }

    /// Notes what those that hold carry by the last solve, of forces.
    pub fn record_loads(&mut self, system: &System) {
        for clutch in self.0.iter_mut().filter(|clutch| !clutch.slips) {
            clutch.load = system.coupling(clutch.constraint).multiplier;
        }
    }

    /// Adds what they carry by the last solve, of impulses over `h` seconds.
    pub fn add_loads(&mut self, h: f64, system: &System) {
        for clutch in self.0.iter_mut().filter(|clutch| !clutch.slips) {
            clutch.load += system.coupling(clutch.constraint).multiplier / h;
        }
    }

    /// Lets slip what carries too much; tells `found` its index, its row and what it carried before. Did anything?
    pub fn slip_overloaded(&mut self, system: &mut System, mut found: impl FnMut(usize, JacobianRow, f64)) -> bool {
        let mut any = false;
        for index in 0..self.0.len() {
            let Clutch { constraint, torque, load, carried, slips } = self.0[index];
            if slips {
                continue;
            }
            if load.abs() <= torque {
                self.0[index].carried = load;
                continue;
            }
            (self.0[index].slips, any) = (true, true);
            system.let_slip(constraint);
            found(index, self.row(index, 1.0, system), carried);
        }
        any
    }

    /// J of a clutch at the joints' last evaluation, times `scale`.
    pub fn row(&self, index: usize, scale: f64, system: &System) -> JacobianRow {
        let mut row = JacobianRow::default();
        for (body, block) in system.coupling(self.0[index].constraint).parts {
            row.add(Some(*body), scale, block);
        }
        row
    }

    /// Lets one that slips hold, under a `load` in N m; answers its constraint, whose row is to act from here on.
    pub fn stick(&mut self, index: usize, load: f64) -> usize {
        let clutch = &mut self.0[index];
        (clutch.slips, clutch.carried) = (false, load);
        clutch.constraint
    }

    /// Does a clutch slip that touches this body?
    pub fn slips(&self, system: &System, body: usize) -> bool {
        let touches = |clutch: &Clutch| system.coupling(clutch.constraint).parts.iter().any(|part| part.0 == body);
        self.slipping().any(|(_, clutch)| touches(clutch))
    }
}
