//! Contact laws (Signorini's and Coulomb's): the impulse that satisfies one contact, and its derivative by the velocity.
//!
//! P is the impulse, u the velocity less the least one allowed, and K the contact's own block of W:
//!
//! ```text
//! unilateral  0 ≤ P ⟂ u ≥ 0                                       no pull, no approach, no push where it opens
//! Coulomb     the same of the normal; |P_T| ≤ μ P_n, P_T = −μ P_n u_T/|u_T| where it slides
//! tyre        the same of the normal; P_T = −μ P_n g(|u_T|/c) u_T/|u_T|   see `tyre.rs`
//! friction    |P_T| ≤ m, P_T = −m u_T/|u_T| where it slides        of an impact whose normal impulse is known
//! rolling     |C_n| ≤ d N, |C_T| ≤ b N likewise                   N the normal impulse of its point (`rolling_resistance.rs`)
//! clutch      P = −τ h (sign u + u/ω₁), or u = 0 at |P| ≤ τ h     see `dynamics/clutches.rs`
//! ```
//!
//! [`ContactLaw::relax`] solves one law exactly, with u + K ΔP for u. A Newton step needs a smooth branch of the law instead:
//! [`ContactLaw::active_branch`] gives the branch of the present iterate, and [`ActiveBranch::regularized`] its impulse P⁺(u)
//! under the softness 1/ρ. A row that holds a velocity has P⁺ = P − ρ u, ρ large. Sliding friction follows the normal impulse,
//! and its direction turns with the slip:
//!
//! ```text
//! P_T = μ P_n e − μ N/|u_T| (1 − e eᵀ) Δu_T        e = −u_T/|u_T|
//! ```
//!
//! Hence D = −∂P⁺/∂u is not symmetric. A rolling resistance at its bound follows the normal impulse of its point likewise.

use super::contact::{Contact, ContactKind, LOCKED, RollingResistance, VISCOUS_SLIP};
use super::tyre;
use soffio_math::{DMat2, DMat3, DVec2, DVec3};

/// Friction within this share of its bound counts as sliding.
const SLIDES: f64 = 1e-9;

/// The law of one contact in the present solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum ContactLaw {
    /// The impulse stays as it is.
    #[default]
    Fixed,
    /// P ≥ 0 along the first row.
    Unilateral,
    /// Unilateral contact with Coulomb friction.
    Coulomb {
        /// μ.
        friction: f64,
    },
    /// Unilateral contact with the friction of a tyre.
    Tyre {
        /// μ.
        friction: f64,
        /// c: slip velocity from which it slides entirely, m/s.
        full_slip: f64,
    },
    /// Friction of at most `max` (N s); the normal impulse is given.
    Friction {
        /// m, N s.
        max: f64,
    },
    /// Rolling resistance.
    Rolling {
        /// d and b, m.
        arms: DVec2,
        /// N, the normal impulse of the contact point, N s.
        normal_impulse: f64,
    },
    /// Torque of a slipping clutch.
    Clutch {
        /// τ h, N m s.
        max_impulse: f64,
    },
}

/// Effective inverse mass of one contact: the change of its velocity by its own impulse.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EffectiveInverseMass {
    /// K in the frame (n, t, b), 1/kg.
    pub k: DMat3,
    /// K⁻¹, of K plus a small diagonal where joints hold a direction, kg.
    pub inverse: DMat3,
    /// Largest eigenvalue of the tangential block, 1/kg.
    pub tangential: f64,
    /// Length that turns a residual in rad/s into one in m/s, m; 1 for all kinds but rolling resistance.
    pub arm: f64,
}

impl EffectiveInverseMass {
    /// About the largest eigenvalue of K, 1/kg.
    pub fn largest(&self) -> f64 {
        self.k.x_axis.x.max(self.tangential)
    }
}

impl ContactLaw {
    /// The impulse that satisfies the law while all other impulses stay as they are.
    pub fn relax(self, mass: &EffectiveInverseMass, p: DVec3, u: DVec3) -> DVec3 {
        let k = mass.k.x_axis.x;
        match self {
            Self::Fixed => p,
            Self::Unilateral => DVec3::X * (p.x - u.x / k).max(0.0),
            Self::Coulomb { friction } => relax_coulomb(mass, friction, p, u),
            Self::Tyre { friction, full_slip } => tyre::relax(mass, (friction, full_slip), p, u),
            Self::Friction { max } => {
                let sticking = DVec2::new(p.y, p.z) - DVec2::new(u.y, u.z) / mass.tangential;
                let tangential = sticking.clamp_length_max(max);
                DVec3::new(p.x, tangential.x, tangential.y)
            }
            Self::Rolling { arms, normal_impulse } => {
                let max = normal_impulse * arms;
                let stuck = p - mass.inverse * u;
                let free = |k: f64| k > LOCKED;
                if free(k) && free(mass.tangential) && within(stuck, max) {
                    return stuck;
                }
                let spin = if free(k) { p.x - u.x / k } else { 0.0 };
                let roll = if free(mass.tangential) { (p - u / mass.tangential).with_x(0.0) } else { DVec3::ZERO };
                bounded(roll.with_x(spin), max)
            }
            Self::Clutch { max_impulse } => {
                let sticking = p.x - u.x / k;
                if sticking.abs() <= max_impulse {
                    return DVec3::X * sticking;
                }
                // P = −τ h (sign w + u/ω₁) at the velocity u = k (P − sticking) that it leaves.
                let viscosity = max_impulse / VISCOUS_SLIP;
                DVec3::X * ((max_impulse.copysign(sticking) + viscosity * k * sticking) / (1.0 + viscosity * k))
            }
        }
    }

    /// The branch that makes the regularised problem convex: the whole friction cone, whatever the contact does now.
    pub fn convex_branch(self, mass: &EffectiveInverseMass, p: DVec3, u: DVec3) -> ActiveBranch {
        match self {
            Self::Coulomb { friction } => ActiveBranch::Cone { friction },
            Self::Rolling { .. } => match self.active_branch(mass, p, u) {
                ActiveBranch::Follows { holds: HeldRows { normal: false, tangential: false }, turning, .. } => {
                    ActiveBranch::Given { impulse: self.relax(mass, p, u), damping: join(0.0, turning) }
                }
                ActiveBranch::Follows { holds, .. } => ActiveBranch::Holds(holds),
                other => other,
            },
            _ => self.active_branch(mass, p, u),
        }
    }

    /// The branch of the law at the present iterate: open, sticking, sliding, or at its bound.
    pub fn active_branch(self, mass: &EffectiveInverseMass, p: DVec3, u: DVec3) -> ActiveBranch {
        let to = self.relax(mass, p, u);
        let slip = DVec2::new(u.y, u.z);
        let sliding = |max: f64| {
            let friction = DVec2::new(to.y, to.z);
            if friction.length() < max * (1.0 - SLIDES) {
                return None;
            }
            let speed = slip.length();
            let e = if speed > 0.0 && slip.dot(friction) < 0.0 { -slip / speed } else { friction.normalize_or_zero() };
            // Friction turns with the slip. Hardly any slip is as stiff as sticking.
            Some((e, (DMat2::IDENTITY - outer(e)) * (max / speed.max(SLIDES * mass.tangential * max))))
        };
        match self {
            Self::Fixed => ActiveBranch::Given { impulse: p, damping: DMat3::ZERO },
            Self::Unilateral => ActiveBranch::Slides { along: DVec3::X, turning: DMat2::ZERO },
            Self::Coulomb { friction } => match sliding(friction * to.x) {
                _ if to.x <= 0.0 => ActiveBranch::Slides { along: DVec3::X, turning: DMat2::ZERO },
                Some((e, turning)) => {
                    ActiveBranch::Slides { along: DVec3::new(1.0, friction * e.x, friction * e.y), turning }
                }
                None => ActiveBranch::Sticks,
            },
            Self::Tyre { .. } if to.x <= 0.0 => ActiveBranch::Slides { along: DVec3::X, turning: DMat2::ZERO },
            Self::Tyre { friction, full_slip } => {
                let (along, turning) = tyre::branch((friction, full_slip), to.x, slip);
                ActiveBranch::Slides { along: DVec3::new(1.0, along.x, along.y), turning }
            }
            Self::Friction { max } => match sliding(max) {
                Some((e, turning)) => {
                    ActiveBranch::Given { impulse: DVec3::new(p.x, max * e.x, max * e.y), damping: join(0.0, turning) }
                }
                None => ActiveBranch::Holds(HeldRows { normal: false, tangential: true }),
            },
            Self::Rolling { arms, normal_impulse } => {
                let spins = to.x.abs() >= normal_impulse * arms.x * (1.0 - SLIDES);
                let (roll, turning) = sliding(normal_impulse * arms.y).unwrap_or((DVec2::ZERO, DMat2::ZERO));
                let rolls = roll != DVec2::ZERO;
                let spin = if spins { arms.x.copysign(to.x) } else { 0.0 };
                ActiveBranch::Follows {
                    along: DVec3::new(spin, arms.y * roll.x, arms.y * roll.y),
                    turning,
                    holds: HeldRows { normal: !spins, tangential: !rolls },
                }
            }
            Self::Clutch { max_impulse } if to.x.abs() <= max_impulse => {
                ActiveBranch::Holds(HeldRows { normal: true, tangential: false })
            }
            Self::Clutch { max_impulse } => {
                // P = −τ h (sign w + u/ω₁) at the present velocity.
                let (sign, viscosity) = ((p.x - u.x / mass.k.x_axis.x).signum(), max_impulse / VISCOUS_SLIP);
                ActiveBranch::Given {
                    impulse: DVec3::X * (max_impulse * sign - viscosity * u.x),
                    damping: DMat3::from_diagonal(DVec3::X * viscosity),
                }
            }
        }
    }

    /// Projection of an impulse on those that the law allows at some velocity.
    pub fn project(self, p: DVec3) -> DVec3 {
        match self {
            Self::Fixed | Self::Clutch { .. } => p,
            Self::Unilateral => DVec3::X * p.x.max(0.0),
            Self::Coulomb { friction } | Self::Tyre { friction, .. } => {
                with_friction(p.x.max(0.0), p, friction * p.x.max(0.0))
            }
            Self::Friction { max } => with_friction(p.x, p, max),
            Self::Rolling { arms, normal_impulse } => bounded(p, normal_impulse * arms),
        }
    }
}

/// Which rows of a contact hold their velocity at zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HeldRows {
    /// The first row.
    pub normal: bool,
    /// The other two.
    pub tangential: bool,
}

impl HeldRows {
    /// One where a row holds, zero elsewhere.
    fn mask(self) -> DVec3 {
        let tangential = f64::from(self.tangential);
        DVec3::new(f64::from(self.normal), tangential, tangential)
    }
}

/// A smooth branch of a contact law, which a Newton step assumes for a contact (its entry of the active set).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ActiveBranch {
    /// P⁺ = `impulse` − `damping` Δu.
    Given { impulse: DVec3, damping: DMat3 },
    /// Some rows hold.
    Holds(HeldRows),
    /// All rows hold, or the contact opens.
    Sticks,
    /// The impulse stays within the friction cone. Convex, but a contact that slides opens too.
    Cone { friction: f64 },
    /// The impulse is along this direction, whose normal part is one, or the contact opens.
    Slides { along: DVec3, turning: DMat2 },
    /// A rolling resistance at its bound: `along` (m) times the normal impulse of its point, and some rows hold.
    Follows { along: DVec3, turning: DMat2, holds: HeldRows },
}

impl Default for ActiveBranch {
    fn default() -> Self {
        Self::Given { impulse: DVec3::ZERO, damping: DMat3::ZERO }
    }
}

/// What the regularised impulse of a contact depends on.
#[derive(Clone, Copy, Debug)]
pub(super) struct RegularizedInput {
    /// Penalty: the inverse of the softness, kg.
    pub rho: f64,
    /// P of the last active-set step, N s.
    pub impulse: DVec3,
    /// u, m/s.
    pub velocity: DVec3,
    /// Change of u since the branch was chosen, m/s.
    pub change: DVec3,
    /// P⁺_n of the contact point, of a rolling resistance, N s.
    pub normal_impulse: f64,
}

impl ActiveBranch {
    /// P⁺ and D = −∂P⁺/∂u of a contact that yields by (P − P⁺)/ρ.
    pub fn regularized(&self, input: RegularizedInput) -> (DVec3, DMat3) {
        let RegularizedInput { rho, impulse: p, velocity: u, change, normal_impulse } = input;
        let a = p - rho * u;
        match *self {
            Self::Given { impulse, damping } => (impulse - damping * change, damping),
            Self::Holds(holds) => {
                let d = holds.mask();
                (d * a + (DVec3::ONE - d) * p, DMat3::from_diagonal(d * rho))
            }
            Self::Follows { along, turning, holds } => {
                let (d, turning) = (holds.mask(), join(0.0, turning));
                (d * a + normal_impulse * along - turning * change, DMat3::from_diagonal(d * rho) + turning)
            }
            Self::Cone { friction } => {
                let (to, derivative) = project_on_cone(a, friction);
                (to, derivative * rho)
            }
            _ if a.x <= 0.0 => (DVec3::ZERO, DMat3::ZERO),
            Self::Sticks => (a, DMat3::from_diagonal(DVec3::splat(rho))),
            Self::Slides { along, turning } => {
                let turned = turning * DVec2::new(change.y, change.z);
                let mut d = join(rho, turning);
                (d.x_axis.y, d.x_axis.z) = (along.y * rho, along.z * rho);
                (a.x * along - DVec3::new(0.0, turned.x, turned.y), d)
            }
        }
    }
}

impl Contact {
    /// The law of a contact; `normal_impulse` is that of its point, of a rolling resistance.
    pub(super) fn law(&self, normal_impulse: f64) -> ContactLaw {
        if self.inverse_mass.largest() <= LOCKED {
            return ContactLaw::Fixed;
        }
        match self.kind {
            ContactKind::Rolling { resistance: RollingResistance { rolling, spinning }, .. } => {
                ContactLaw::Rolling { arms: DVec2::new(spinning, rolling), normal_impulse: normal_impulse.max(0.0) }
            }
            ContactKind::Clutch { max_impulse, slips, .. } => {
                ContactLaw::Clutch { max_impulse: if slips { max_impulse } else { f64::INFINITY } }
            }
            _ if self.inverse_mass.k.x_axis.x <= LOCKED => ContactLaw::Fixed,
            ContactKind::Point { friction, full_slip, .. } if friction != 0.0 && full_slip != 0.0 => {
                ContactLaw::Tyre { friction, full_slip }
            }
            ContactKind::Point { friction, .. } if friction != 0.0 => ContactLaw::Coulomb { friction },
            _ => ContactLaw::Unilateral,
        }
    }
}

/// Signorini's and Coulomb's laws of one contact point.
fn relax_coulomb(mass: &EffectiveInverseMass, mu: f64, p: DVec3, u: DVec3) -> DVec3 {
    let EffectiveInverseMass { k, inverse, tangential, .. } = mass;
    let stuck = p - *inverse * u;
    if stuck.x >= 0.0 && DVec2::new(stuck.y, stuck.z).length_squared() <= (mu * stuck.x) * (mu * stuck.x) {
        return stuck;
    }
    // It slides: the direction comes from the slip, then the normal impulse that goes with it.
    let against = if *tangential > LOCKED {
        DVec2::new(p.y - u.y / tangential, p.z - u.z / tangential)
    } else {
        DVec2::new(-u.y, -u.z)
    };
    let along = mu * against.normalize_or_zero();
    let column = DVec3::new(1.0, along.x, along.y);
    let stiffness = (*k * column).x;
    let normal = if stiffness > 0.1 * k.x_axis.x {
        // u_n − K_n P is the part of all other impulses.
        ((*k * p).x - u.x) / stiffness
    } else {
        p.x - u.x / k.x_axis.x
    };
    normal.max(0.0) * column
}

fn with_friction(normal: f64, p: DVec3, max: f64) -> DVec3 {
    let friction = DVec2::new(p.y, p.z).clamp_length_max(max);
    DVec3::new(normal, friction.x, friction.y)
}

fn within(p: DVec3, max: DVec2) -> bool {
    p.x.abs() <= max.x && DVec2::new(p.y, p.z).length() <= max.y
}

fn bounded(p: DVec3, max: DVec2) -> DVec3 {
    with_friction(p.x.clamp(-max.x, max.x), p, max.y)
}

/// Projection on the cone |p_T| ≤ μ p_n and its derivative.
fn project_on_cone(a: DVec3, mu: f64) -> (DVec3, DMat3) {
    let across = DVec2::new(a.y, a.z);
    let length = across.length();
    if length <= mu * a.x {
        return (a, DMat3::IDENTITY);
    }
    if mu * length <= -a.x {
        return (DVec3::ZERO, DMat3::ZERO);
    }
    let scale = (1.0 + mu * mu).recip();
    let normal = scale * (a.x + mu * length);
    let along = across / length;
    let to = mu * normal * along;
    // d/da of (1, μ e) P_n with e = a_T/|a_T|.
    let radial = outer(along);
    let mut derivative = join(scale, radial * (scale * mu * mu) + (DMat2::IDENTITY - radial) * (mu * normal / length));
    let side = scale * mu * along;
    (derivative.x_axis.y, derivative.x_axis.z, derivative.y_axis.x, derivative.z_axis.x) =
        (side.x, side.y, side.x, side.y);
    (DVec3::new(normal, to.x, to.y), derivative)
}

/// e eᵀ.
pub(super) fn outer(e: DVec2) -> DMat2 {
    DMat2::from_cols(e * e.x, e * e.y)
}

/// The matrix of a normal part and a tangential one.
fn join(normal: f64, tangential: DMat2) -> DMat3 {
    DMat3::from_cols(
        DVec3::X * normal,
        DVec3::new(0.0, tangential.x_axis.x, tangential.x_axis.y),
        DVec3::new(0.0, tangential.y_axis.x, tangential.y_axis.y),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::noise::Random;

    /// K of a free body with a contact at a random place.
    fn random_mass(random: &mut Random) -> EffectiveInverseMass {
        let l = DVec3::new(random.signed(), random.signed(), random.signed());
        let k = DMat3::IDENTITY - soffio_math::skew(l) * soffio_math::skew(l);
        let (a, d, b) = (k.y_axis.y, k.z_axis.z, k.y_axis.z);
        let tangential = 0.5 * (a + d) + (0.25 * (a - d) * (a - d) + b * b).sqrt();
        EffectiveInverseMass { k, inverse: k.inverse(), tangential, arm: 1.0 }
    }

    #[test]
    fn a_relaxed_contact_presses_sticks_or_slides_by_coulombs_law() {
        /// Velocity that a sticking or pressing contact may keep, m/s.
        const ZERO: f64 = 1e-12;
        for seed in 0..2_000 {
            let mut random = Random::new(seed);
            let (mass, mu) = (random_mass(&mut random), random.unit());
            let (p, u) = (DVec3::ZERO, DVec3::new(random.signed(), random.signed(), random.signed()));
            let to = ContactLaw::Coulomb { friction: mu }.relax(&mass, p, u);
            let after = u + mass.k * (to - p);
            let friction = DVec2::new(to.y, to.z).length();
            assert!(to.x >= 0.0 && friction <= mu * to.x * (1.0 + 1e-9), "seed {seed}: {to}");
            if to.x == 0.0 {
                // It opens, by itself or because friction lifts it.
                continue;
            }
            assert!(after.x.abs() < ZERO, "seed {seed}: {after}");
            if friction < mu * to.x * (1.0 - 1e-9) {
                assert!(after.length() < ZERO, "seed {seed}: sticks and moves by {after}");
            }
        }
    }

    #[test]
    fn the_projection_on_a_cone_has_the_derivative_that_it_returns() {
        const STEP: f64 = 1e-6;
        for seed in 0..500 {
            let mut random = Random::new(seed);
            let (a, mu) = (DVec3::new(random.signed(), random.signed(), random.signed()), random.unit());
            let (_, derivative) = project_on_cone(a, mu);
            for axis in DMat3::IDENTITY.to_cols_array_2d().map(DVec3::from_array) {
                let difference = project_on_cone(a + STEP * axis, mu).0 - project_on_cone(a - STEP * axis, mu).0;
                let error = (difference / (2.0 * STEP) - derivative * axis).length();
                // Where the cone begins or ends the derivative jumps.
                let jumps = project_on_cone(a + STEP * axis, mu).1 != derivative && error > 1e-3;
                assert!(jumps || error < 1e-3, "seed {seed}: {error}");
            }
        }
    }

    #[test]
    fn a_clutch_carries_more_the_faster_it_slips() {
        let one = EffectiveInverseMass { k: DMat3::IDENTITY, inverse: DMat3::IDENTITY, tangential: 1.0, arm: 1.0 };
        let (max_impulse, u) = (0.1, DVec3::X * 2.0);
        let to = ContactLaw::Clutch { max_impulse }.relax(&one, DVec3::ZERO, u);
        let rate = (u + to).x;
        assert!((to.x + max_impulse * (1.0 + rate / VISCOUS_SLIP)).abs() < 1e-12, "{to} at {rate}");
    }
}
