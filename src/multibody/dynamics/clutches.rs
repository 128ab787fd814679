//! Slip clutches: couplings with Coulomb friction, such as a minute hand on its arbor.
//!
//! Dry friction between two bodies about one axis has two states (D. Karnopp, "Computer simulation of stick-slip friction in
//! mechanical dynamic systems", ASME J. Dynamic Systems, Measurement, and Control 107, 1985); slip is viscous as well:
//!
//! ```text
//! sticks   C = q − q₀ = 0                  a row of the joints, multiplier λ          until |λ| > τ
//! slips    f = −τ (sign q̇ + q̇/ω₁)          a contact of the contact problem           until q̇ = 0 at |f| < τ; then q₀ = q
//! ```
//!
//! The state changes only between substeps, so a row acts in all stages of a substep or in none. A substep that overloads a
//! clutch is integrated again from its start with that clutch slipping. The contact forces of the first pass, which were found for
//! a sticking clutch, are discarded. So no contact presses through a clutch harder than the clutch carries.
//!
//! | symbol | here | unit |
//! |---|---|---|
//! | q, q₀ | value of the coupling, its offset | rad |
//! | τ | `torque` | N m |
//! | λ | `load` | N m |
//! | f | impulse of a [`ContactKind::Clutch`](super::contacts) over h | N m |
//! | ω₁ | `contacts/contact.rs`, `VISCOUS_SLIP` | rad/s |

use crate::articulation::{Constraint, System};

use super::contacts::JacobianRow;

/// One clutch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clutch {
    /// Index of its constraint.
    pub constraint: usize,
    /// Torque τ up to which it sticks, N m.
    pub torque: f64,
    /// Torque λ at the end of the present pass over a substep, N m.
    pub load: f64,
    /// Torque λ at the end of the last substep in which it stuck, N m.
    pub carried: f64,
    /// Does it slip?
    pub slips: bool,
}

/// All clutches of an articulation.
#[derive(Clone, Debug, Default)]
pub(super) struct Clutches(Vec<Clutch>);

/// A clutch that has begun to slip.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlippedClutch {
    /// Its index.
    pub clutch: usize,
    /// Its Jacobian row.
    pub row: JacobianRow,
    /// Torque that it carried before, N m.
    pub carried: f64,
}

impl Clutches {
    /// The clutches among these constraints, all sticking.
    pub fn new(constraints: &[Constraint]) -> Self {
        let clutch = |(constraint, c): (usize, &Constraint)| {
            c.slips.map(|torque| Clutch { constraint, torque, load: 0.0, carried: 0.0, slips: false })
        };
        Self(constraints.iter().enumerate().filter_map(clutch).collect())
    }

    /// Number of clutches.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// The slipping clutches, each with its index.
    pub fn slipping(&self) -> impl Iterator<Item = (usize, &Clutch)> {
        self.0.iter().enumerate().filter(|(_, clutch)| clutch.slips)
    }

    /// Whether any clutch sticks.
    pub fn any_sticks(&self) -> bool {
        self.0.iter().any(|clutch| !clutch.slips)
    }

    /// Takes the loads of sticking clutches from the last solve, which was of forces.
    pub fn record_loads(&mut self, system: &System) {
        for clutch in self.0.iter_mut().filter(|clutch| !clutch.slips) {
            clutch.load = system.coupling(clutch.constraint).multiplier;
        }
    }

    /// Adds the loads of sticking clutches from the last solve, which was of impulses over `h` seconds.
    pub fn add_loads(&mut self, h: f64, system: &System) {
        for clutch in self.0.iter_mut().filter(|clutch| !clutch.slips) {
            clutch.load += system.coupling(clutch.constraint).multiplier / h;
        }
    }

    /// Lets overloaded clutches slip and passes each to `found`. Returns whether there is any.
    pub fn slip_overloaded(&mut self, system: &mut System, mut found: impl FnMut(SlippedClutch)) -> bool {
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
            found(SlippedClutch { clutch: index, row: self.row(index, 1.0, system), carried });
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

    /// Lets a slipping clutch stick under a `load` in N m. Returns its constraint, whose row acts from here on.
    pub fn stick(&mut self, index: usize, load: f64) -> usize {
        let clutch = &mut self.0[index];
        (clutch.slips, clutch.carried) = (false, load);
        clutch.constraint
    }

    /// Whether a clutch of this body slips.
    pub fn slips(&self, system: &System, body: usize) -> bool {
        let acts_on = |clutch: &Clutch| system.coupling(clutch.constraint).parts.iter().any(|part| part.0 == body);
        self.slipping().any(|(_, clutch)| acts_on(clutch))
    }
}
