//! The laws of touches: what impulse satisfies one, all others as they are, and how it goes with the velocity nearby.
//!
//! With P the impulse, u the velocity less the least one allowed, and K the touch's own block of W:
//!
//! ```text
//! bound       0 ≤ P ⟂ u ≥ 0                                       no pull, no approach, no push where it opens
//! contact     the same of the normal; |P_T| ≤ μ P_n, P_T = −μ P_n u_T/|u_T| where it slides            Coulomb
//! friction    |P_T| ≤ m, P_T = −m u_T/|u_T| where it slides        of a hit whose normal impulse is known
//! couple      |C_n| ≤ d N, |C_T| ≤ b N likewise                   N the normal impulse of its point (`twist.rs`)
//! clutch      P = −τ h (sign u + u/ω₁), or u = 0 at |P| ≤ τ h     see `dynamics/clutches.rs`
//! ```
//!
//! [`ContactLaw::relax`] solves a law exactly with u + K ΔP for u. [`ContactLaw::doing`] says what a touch does now, and [`ActiveBranch::soft`] what
//! impulse it has while it goes on so and gives way a little. What holds a velocity has P⁺ = P − ρ u, ρ large, and friction that
//! slides goes with the normal impulse, and turns against what is across it:
//!
//! ```text
//! P_T = μ P_n e − μ N/|u_T| (1 − e eᵀ) Δu_T        e = −u_T/|u_T|
//! ```
//!
//! so that D = −∂P⁺/∂u is not symmetric. A couple at its bound goes with the normal impulse of its point likewise.

use super::contact::{Contact, GREASE, LOCKED, RollingResistance};
use soffio_math::{DMat2, DMat3, DVec2, DVec3};

/// What a touch obeys at present.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum ContactLaw {
    /// Its impulse stays as it is.
    #[default]
    Still,
    /// P ≥ 0 along its first row.
    Bound,
    /// Coulomb's law with this coefficient.
    Contact(f64),
    /// Friction of at most this, N s, the normal impulse given.
    Friction(f64),
    /// d and b, m, and the impulse N that presses its point, N s.
    Couple(DVec2, f64),
    /// τ h (N m s).
    Clutch(f64),
}

/// What a touch answers to its own impulse.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EffectiveInverseMass {
    /// K, 1/kg, and the inverse of it (a little more where it has none).
    pub k: DMat3,
    pub inverse: DMat3,
    /// Largest answer across the normal, 1/kg.
    pub across: f64,
    /// What turns it is missed by a velocity at this distance, m: that of a couple, where it is as hard to turn as to push. All
    /// else counts as it is.
    pub arm: f64,
}

impl EffectiveInverseMass {
    /// The largest of K's answers, about.
    pub fn most(&self) -> f64 {
        self.k.x_axis.x.max(self.across)
    }
}

impl ContactLaw {
    /// The impulse that satisfies the law, the others' impulses as they are.
    pub fn relax(self, answer: &EffectiveInverseMass, p: DVec3, u: DVec3) -> DVec3 {
        let k = answer.k.x_axis.x;
        match self {
            Self::Still => p,
            Self::Bound => DVec3::X * (p.x - u.x / k).max(0.0),
            Self::Contact(mu) => contact(answer, mu, p, u),
            Self::Friction(most) => {
                let pull = DVec2::new(p.y, p.z) - DVec2::new(u.y, u.z) / answer.across;
                let rub = pull.clamp_length_max(most);
                DVec3::new(p.x, rub.x, rub.y)
            }
            Self::Couple(arms, press) => {
                let most = press * arms;
                let stuck = p - answer.inverse * u;
                let free = |k: f64| k > LOCKED;
                if free(k) && free(answer.across) && within(stuck, most) {
                    return stuck;
                }
                let spin = if free(k) { p.x - u.x / k } else { 0.0 };
                let roll = if free(answer.across) { (p - u / answer.across).with_x(0.0) } else { DVec3::ZERO };
                bounded(roll.with_x(spin), most)
            }
            Self::Clutch(most) => {
                let hold = p.x - u.x / k;
                if hold.abs() <= most {
                    return DVec3::X * hold;
                }
                // P = −τ h (sign w + u/ω₁) at the velocity u = k (P − hold) that it leaves.
                let grease = most / GREASE;
                DVec3::X * ((most.copysign(hold) + grease * k * hold) / (1.0 + grease * k))
            }
        }
    }

    /// What a touch may do, whatever it does now, so far as that is the gradient of a convex function.
    pub fn convex_branch(self, answer: &EffectiveInverseMass, p: DVec3, u: DVec3) -> ActiveBranch {
        match self {
            Self::Contact(mu) => ActiveBranch::Cone(mu),
            Self::Couple(..) => match self.active_branch(answer, p, u) {
                ActiveBranch::Follows { holds: [false, false], turn, .. } => {
                    ActiveBranch::Given(self.relax(answer, p, u), join(0.0, turn))
                }
                ActiveBranch::Follows { holds, .. } => ActiveBranch::Holds(holds),
                other => other,
            },
            _ => self.active_branch(answer, p, u),
        }
    }

    /// What a touch does now, which it is taken to go on doing.
    pub fn active_branch(self, answer: &EffectiveInverseMass, p: DVec3, u: DVec3) -> ActiveBranch {
        let to = self.relax(answer, p, u);
        let slip = DVec2::new(u.y, u.z);
        let rubs = |most: f64| {
            let rub = DVec2::new(to.y, to.z);
            if rub.length() < most * (1.0 - SLIDES) {
                return None;
            }
            let speed = slip.length();
            let e = if speed > 0.0 && slip.dot(rub) < 0.0 { -slip / speed } else { rub.normalize_or_zero() };
            // Friction turns against what is across it; what hardly slides does so as if it stuck.
            Some((e, (DMat2::IDENTITY - outer(e)) * (most / speed.max(SLIDES * answer.across * most))))
        };
        match self {
            Self::Still => ActiveBranch::Given(p, DMat3::ZERO),
            Self::Bound => ActiveBranch::Slides { along: DVec3::X, turn: DMat2::ZERO },
            Self::Contact(mu) => match rubs(mu * to.x) {
                _ if to.x <= 0.0 => ActiveBranch::Slides { along: DVec3::X, turn: DMat2::ZERO },
                Some((e, turn)) => ActiveBranch::Slides { along: DVec3::new(1.0, mu * e.x, mu * e.y), turn },
                None => ActiveBranch::Sticks,
            },
            Self::Friction(most) => match rubs(most) {
                Some((e, turn)) => ActiveBranch::Given(DVec3::new(p.x, most * e.x, most * e.y), join(0.0, turn)),
                None => ActiveBranch::Holds([false, true]),
            },
            Self::Couple(arms, press) => {
                let spins = to.x.abs() >= press * arms.x * (1.0 - SLIDES);
                let (roll, turn) = rubs(press * arms.y).unwrap_or((DVec2::ZERO, DMat2::ZERO));
                let rolls = roll != DVec2::ZERO;
                let spin = if spins { arms.x.copysign(to.x) } else { 0.0 };
                ActiveBranch::Follows {
                    along: DVec3::new(spin, arms.y * roll.x, arms.y * roll.y),
                    turn,
                    holds: [!spins, !rolls],
                }
            }
            Self::Clutch(most) if to.x.abs() <= most => ActiveBranch::Holds([true, false]),
            Self::Clutch(most) => {
                // P = −τ h (sign w + u/ω₁) at the present velocity, whatever a light body of its own would slow it to.
                let (sign, grease) = ((p.x - u.x / answer.k.x_axis.x).signum(), most / GREASE);
                ActiveBranch::Given(DVec3::X * (most * sign - grease * u.x), DMat3::from_diagonal(DVec3::X * grease))
            }
        }
    }

    /// The nearest impulse that the law allows at any velocity.
    pub fn project(self, p: DVec3) -> DVec3 {
        match self {
            Self::Still | Self::Clutch(_) => p,
            Self::Bound => DVec3::X * p.x.max(0.0),
            Self::Contact(mu) => rubbed(p.x.max(0.0), p, mu * p.x.max(0.0)),
            Self::Friction(most) => rubbed(p.x, p, most),
            Self::Couple(arms, press) => bounded(p, press * arms),
        }
    }
}

/// What a touch is taken to go on doing while all are solved at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ActiveBranch {
    /// It has this impulse less D Δu.
    Given(DVec3, DMat3),
    /// It holds its first row, the others, or both.
    Holds([bool; 2]),
    /// It holds all rows, or opens.
    Sticks,
    /// Its impulse stays in the cone of this coefficient, whatever it does: where it slides it opens too.
    Cone(f64),
    /// It presses along this direction, its normal part one, or opens.
    Slides { along: DVec3, turn: DMat2 },
    /// A couple goes along this with the normal impulse of its point, m; it holds its first row, the others, or neither.
    Follows { along: DVec3, turn: DMat2, holds: [bool; 2] },
}

impl Default for ActiveBranch {
    fn default() -> Self {
        Self::Given(DVec3::ZERO, DMat3::ZERO)
    }
}

impl ActiveBranch {
    /// P⁺ and D = −∂P⁺/∂u of a touch with the impulse P that gives way by (P − P⁺)/ρ; `slid` is how its velocity has changed since,
    /// and `press` is P⁺_n of a couple's point.
    pub fn regularized(&self, rho: f64, p: DVec3, (u, slid): (DVec3, DVec3), press: f64) -> (DVec3, DMat3) {
        let a = p - rho * u;
        let held = |[first, others]: [bool; 2]| DVec3::new(f64::from(first), f64::from(others), f64::from(others));
        match *self {
            Self::Given(p, d) => (p - d * slid, d),
            Self::Holds(holds) => {
                let d = held(holds);
                (d * a + (DVec3::ONE - d) * p, DMat3::from_diagonal(d * rho))
            }
            Self::Follows { along, turn, holds } => {
                let (d, turn) = (held(holds), join(0.0, turn));
                (d * a + press * along - turn * slid, DMat3::from_diagonal(d * rho) + turn)
            }
            Self::Cone(mu) => {
                let (to, turn) = on_cone(a, mu);
                (to, turn * rho)
            }
            _ if a.x <= 0.0 => (DVec3::ZERO, DMat3::ZERO),
            Self::Sticks => (a, DMat3::from_diagonal(DVec3::splat(rho))),
            Self::Slides { along, turn } => {
                let rub = turn * DVec2::new(slid.y, slid.z);
                let mut d = join(rho, turn);
                (d.x_axis.y, d.x_axis.z) = (along.y * rho, along.z * rho);
                (a.x * along - DVec3::new(0.0, rub.x, rub.y), d)
            }
        }
    }
}

/// Friction within this share of its bound slides.
const SLIDES: f64 = 1e-9;

impl Contact {
    /// The law of a touch; `normal` is the normal impulse of a couple's point.
    pub(super) fn law(&self, normal: f64) -> ContactLaw {
        if self.answer.most() <= LOCKED {
            return ContactLaw::Still;
        }
        if let Some(twist) = &self.twist {
            let RollingResistance { rolling, spinning } = twist.resistance;
            return ContactLaw::Couple(DVec2::new(spinning, rolling), normal.max(0.0));
        }
        match &self.grip {
            Some(grip) => ContactLaw::Clutch(if grip.slips { grip.most } else { f64::INFINITY }),
            None if self.answer.k.x_axis.x <= LOCKED => ContactLaw::Still,
            None if self.rows == 1 || self.friction == 0.0 => ContactLaw::Bound,
            None => ContactLaw::Contact(self.friction),
        }
    }
}

/// Signorini's and Coulomb's laws of one touch.
fn contact(answer: &EffectiveInverseMass, mu: f64, p: DVec3, u: DVec3) -> DVec3 {
    let EffectiveInverseMass { k, inverse, across, .. } = answer;
    let stuck = p - *inverse * u;
    if stuck.x >= 0.0 && DVec2::new(stuck.y, stuck.z).length_squared() <= (mu * stuck.x) * (mu * stuck.x) {
        return stuck;
    }
    // Slides: the direction that the slip asks for, then the normal impulse that goes with it.
    let pull =
        if *across > LOCKED { DVec2::new(p.y - u.y / across, p.z - u.z / across) } else { DVec2::new(-u.y, -u.z) };
    let along = mu * pull.normalize_or_zero();
    let column = DVec3::new(1.0, along.x, along.y);
    let stiffness = (*k * column).x;
    let normal = if stiffness > 0.1 * k.x_axis.x {
        // u_n − K_n P is what the others do.
        ((*k * p).x - u.x) / stiffness
    } else {
        p.x - u.x / k.x_axis.x
    };
    normal.max(0.0) * column
}

fn rubbed(normal: f64, p: DVec3, most: f64) -> DVec3 {
    let rub = DVec2::new(p.y, p.z).clamp_length_max(most);
    DVec3::new(normal, rub.x, rub.y)
}

fn within(p: DVec3, most: DVec2) -> bool {
    p.x.abs() <= most.x && DVec2::new(p.y, p.z).length() <= most.y
}

fn bounded(p: DVec3, most: DVec2) -> DVec3 {
    rubbed(p.x.clamp(-most.x, most.x), p, most.y)
}

/// Projection on the cone |p_T| ≤ μ p_n and its derivative.
fn on_cone(a: DVec3, mu: f64) -> (DVec3, DMat3) {
    let across = DVec2::new(a.y, a.z);
    let length = across.length();
    if length <= mu * a.x {
        return (a, DMat3::IDENTITY);
    }
    if mu * length <= -a.x {
        return (DVec3::ZERO, DMat3::ZERO);
    }
    let share = (1.0 + mu * mu).recip();
    let normal = share * (a.x + mu * length);
    let along = across / length;
    let to = mu * normal * along;
    // d/da of (1, μ e) P_n with e = a_T/|a_T|.
    let out = outer(along);
    let mut turn = join(share, out * (share * mu * mu) + (DMat2::IDENTITY - out) * (mu * normal / length));
    let side = share * mu * along;
    (turn.x_axis.y, turn.x_axis.z, turn.y_axis.x, turn.z_axis.x) = (side.x, side.y, side.x, side.y);
    (DVec3::new(normal, to.x, to.y), turn)
}

fn outer(e: DVec2) -> DMat2 {
    DMat2::from_cols(e * e.x, e * e.y)
}

/// The matrix of a normal part and a tangential one.
fn join(normal: f64, across: DMat2) -> DMat3 {
    DMat3::from_cols(
        DVec3::X * normal,
        DVec3::new(0.0, across.x_axis.x, across.x_axis.y),
        DVec3::new(0.0, across.y_axis.x, across.y_axis.y),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::noise::Random;

    /// K of a free body that is touched at a random place.
    fn answer(random: &mut Random) -> EffectiveInverseMass {
        let l = DVec3::new(random.signed(), random.signed(), random.signed());
        let k = DMat3::IDENTITY - soffio_math::skew(l) * soffio_math::skew(l);
        let (a, d, b) = (k.y_axis.y, k.z_axis.z, k.y_axis.z);
        let across = 0.5 * (a + d) + (0.25 * (a - d) * (a - d) + b * b).sqrt();
        EffectiveInverseMass { k, inverse: k.inverse(), across, arm: 1.0 }
    }

    #[test]
    fn a_contact_that_has_relaxed_presses_sticks_or_slides_by_the_law() {
        /// What a touch that sticks or presses may still move, m/s.
        const HELD: f64 = 1e-12;
        for seed in 0..2_000 {
            let mut random = Random::new(seed);
            let (answer, mu) = (answer(&mut random), random.unit());
            let (p, u) = (DVec3::ZERO, DVec3::new(random.signed(), random.signed(), random.signed()));
            let to = ContactLaw::Contact(mu).relax(&answer, p, u);
            let after = u + answer.k * (to - p);
            let rub = DVec2::new(to.y, to.z).length();
            assert!(to.x >= 0.0 && rub <= mu * to.x * (1.0 + 1e-9), "seed {seed}: {to}");
            if to.x == 0.0 {
                // What sliding would press on it lets go: it opens by itself or with friction.
                continue;
            }
            assert!(after.x.abs() < HELD, "seed {seed}: {after}");
            if rub < mu * to.x * (1.0 - 1e-9) {
                assert!(after.length() < HELD, "seed {seed}: sticks and moves by {after}");
            }
        }
    }

    #[test]
    fn projections_of_cones_have_the_derivative_that_they_say() {
        const STEP: f64 = 1e-6;
        for seed in 0..500 {
            let mut random = Random::new(seed);
            let (a, mu) = (DVec3::new(random.signed(), random.signed(), random.signed()), random.unit());
            let (_, turn) = on_cone(a, mu);
            for axis in DMat3::IDENTITY.to_cols_array_2d().map(DVec3::from_array) {
                let change = (on_cone(a + STEP * axis, mu).0 - on_cone(a - STEP * axis, mu).0) / (2.0 * STEP);
                // Where the cone begins or ends the derivative jumps.
                let jumps = on_cone(a + STEP * axis, mu).1 != turn && (change - turn * axis).length() > 1e-3;
                assert!(jumps || (change - turn * axis).length() < 1e-3, "seed {seed}: {change}");
            }
        }
    }

    #[test]
    fn a_clutch_carries_more_the_faster_it_slips() {
        let one = EffectiveInverseMass { k: DMat3::IDENTITY, inverse: DMat3::IDENTITY, across: 1.0, arm: 1.0 };
        let (most, u) = (0.1, DVec3::X * 2.0);
        let to = ContactLaw::Clutch(most).relax(&one, DVec3::ZERO, u);
        let rate = (u + to).x;
        assert!((to.x + most * (1.0 + rate / GREASE)).abs() < 1e-12, "{to} at {rate}");
    }
}
