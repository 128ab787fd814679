//! Friction of resting contacts: sliding, rolling and spinning, with rolling resistance (method 3.7).
//!
//! Position-based motion gives each resting contact one normal impulse P_n. Besides Coulomb's law, which
//! `dynamics::impulse` has solved, there is the source's law for a ball on a surface: friction by the slip ratio,
//!
//! ```text
//! s = |v_t − r ω×n|/|v_t|, at most 1        F = s F_friction        s = 1 slides, s = 0 rolls
//! ```
//!
//! v_t is the tangential velocity of the ball's centre over the surface, so v_t − r ω×n is the slip u of the contact
//! point. As −F̂ = u/|u|, the law is F = −μ N u/max(|u|, |v_t|), smooth down to rolling, which it approaches as
//! e^(−t/τ). A ball that starts at v₀ without spin obeys, with v∞ = 5/7 v₀,
//!
//! ```text
//! v̇ = −(7/2) μ g (v − v∞)/v        v₀ − v + v∞ ln((v₀ − v∞)/(v − v∞)) = (7/2) μ g t
//! ```
//!
//! The law is integrated over the step's budget q = μ P_n in [`PIECES`] pieces by the midpoint rule, with u fading by
//! exp(−K_T q/|v_t|) in each, which never overshoots.
//!
//! **Resistance.** Couples up to b P_n against rolling and d P_n against spinning (`dynamics::RollingResistance`). A
//! ball that rolls keeps rolling while it slows down: the couple M comes with the friction −K_T⁻¹ K_Tω M that leaves
//! the slip unchanged (the source's velocity matching), within the friction limit. While it slides, the couple acts
//! alone under Coulomb's law, and grows with 1 − s under the source's.

use crate::dynamics::SweptContact;
use soffio_math::{DMat2, DMat3, DVec2, DVec3, exp};

/// Integration pieces of a step's friction.
const PIECES: usize = 4;
/// Slip below which a contact rolls, relative to the speeds before: ten times what `impulse` leaves.
const ROLLING_SLIP: f64 = 1e-8;
/// Effective inverse mass below which the joints lock a motion, 1/kg or 1/(kg m²).
const LOCKED: f64 = 1e-9;

/// Effective inverse masses of a contact point and its couple in the frame (t, b, n): velocities are K P.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactMobility {
    /// Contact point velocity per force impulse there, 1/kg.
    pub point: DMat3,
    /// Contact point velocity per couple impulse, and transposed, 1/(kg m).
    pub mixed: DMat3,
    /// Relative angular velocity per couple impulse, 1/(kg m²).
    pub rotation: DMat3,
    /// Velocity of the ball's centre over the surface per force impulse at the contact point, 1/kg.
    pub center: DMat3,
}

/// Relative velocities at a contact, (t, b, n).
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactVelocity {
    /// Slip of the contact points, m/s.
    pub slip: DVec3,
    /// Velocity of the ball's centre over the surface, m/s; the slip where there is no ball.
    pub center: DVec3,
    /// Relative angular velocity, rad/s.
    pub rotation: DVec3,
}

/// Force and couple impulses on the first body, (t, b, n), N s and N m s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ContactImpulse {
    /// Impulse of the force, N s.
    pub force: DVec3,
    /// Impulse of the couple, N m s.
    pub couple: DVec3,
}

impl ContactImpulse {
    /// Adds force and couple impulses, and updates the velocities.
    fn add(&mut self, mobility: &ContactMobility, velocity: &mut ContactVelocity, force: DVec3, couple: DVec3) {
        velocity.slip += mobility.point * force + mobility.mixed * couple;
        velocity.rotation += mobility.mixed.transpose() * force + mobility.rotation * couple;
        velocity.center += mobility.center * force;
        self.force += force;
        self.couple += couple;
    }
}

/// Impulse of a resting contact; `coulomb` is Coulomb's, `velocity` is that before it. `slip_ratio` selects the
/// source's law.
pub(super) fn resting_impulse(
    contact: &SweptContact,
    mobility: &ContactMobility,
    mut velocity: ContactVelocity,
    coulomb: DVec3,
    slip_ratio: bool,
) -> ContactImpulse {
    let mut whole = ContactImpulse::default();
    let limit = contact.friction * coulomb.z;
    let mut rolling = contact.resistance.rolling * coulomb.z;
    let mut sticks = true;
    if slip_ratio {
        whole.add(mobility, &mut velocity, DVec3::Z * coulomb.z, DVec3::ZERO);
        for _ in 0..PIECES {
            let force = slip_ratio_impulse(mobility, &velocity, limit / PIECES as f64);
            whole.add(mobility, &mut velocity, force.extend(0.0), DVec3::ZERO);
        }
        rolling *= 1.0 - ratio(&velocity);
    } else {
        let fast = velocity.center.truncate().length() + velocity.slip.length();
        whole.add(mobility, &mut velocity, coulomb, DVec3::ZERO);
        sticks = velocity.slip.truncate().length() <= ROLLING_SLIP * fast;
    }
    let spinning = contact.resistance.spinning * coulomb.z;
    let free = mobility.rotation.z_axis.z > LOCKED;
    let spin = if free { (-velocity.rotation.z / mobility.rotation.z_axis.z).clamp(-spinning, spinning) } else { 0.0 };
    whole.add(mobility, &mut velocity, DVec3::ZERO, DVec3::Z * spin);
    if rolling > 0.0 {
        let (force, couple) =
            stop_rolling(mobility, &velocity, rolling, sticks.then_some((whole.force.truncate(), limit)));
        whole.add(mobility, &mut velocity, force.extend(0.0), couple.extend(0.0));
    }
    whole
}

/// Slip ratio s, 0 … 1.
fn ratio(velocity: &ContactVelocity) -> f64 {
    let (slip, speed) = (velocity.slip.truncate().length(), velocity.center.truncate().length());
    if slip >= speed && slip > 0.0 { 1.0 } else { slip / speed.max(f64::MIN_POSITIVE) }
}

/// Friction of the source's law for a piece of its budget, N s, with the rate at the middle of the piece.
fn slip_ratio_impulse(mobility: &ContactMobility, velocity: &ContactVelocity, budget: f64) -> DVec2 {
    let mut middle = *velocity;
    ContactImpulse::default().add(
        mobility,
        &mut middle,
        fading_impulse(mobility, velocity, velocity, 0.5 * budget).extend(0.0),
        DVec3::ZERO,
    );
    fading_impulse(mobility, velocity, &middle, budget)
}

/// Friction that fades the slip of one velocity at the rate of another over a budget, N s.
fn fading_impulse(
    mobility: &ContactMobility,
    velocity: &ContactVelocity,
    there: &ContactVelocity,
    budget: f64,
) -> DVec2 {
    let k = mobility.point.x_axis.x.max(mobility.point.y_axis.y);
    let (slip, speed) = (velocity.slip.truncate(), there.center.truncate().length());
    let (slides, slides_there) = (slip.length(), there.slip.truncate().length());
    if slides == 0.0 || k <= LOCKED {
        DVec2::ZERO
    } else if slides_there >= speed {
        // The full budget, but no more than stops the slip.
        -slip * (budget / slides).min(1.0 / k)
    } else {
        -slip * ((1.0 - exp(-k * budget / speed)) / k)
    }
}

/// Friction and couple against rolling, of at most `limit`. Where the point sticks (its friction and the friction
/// limit are given), added friction leaves the slip unchanged within the limit.
fn stop_rolling(
    mobility: &ContactMobility,
    velocity: &ContactVelocity,
    limit: f64,
    sticks: Option<(DVec2, f64)>,
) -> (DVec2, DVec2) {
    // Blocks across the normal.
    let block = |m: &DMat3| DMat2::from_cols(m.x_axis.truncate(), m.y_axis.truncate());
    let (k, mixed, rotation) = (block(&mobility.point), block(&mobility.mixed), block(&mobility.rotation));
    let wanted = -velocity.rotation.truncate();
    if let Some((already, radius)) = sticks {
        let rigid = rotation - mixed.transpose() * (k.inverse() * mixed);
        let couple = (rigid.inverse() * wanted).clamp_length_max(limit);
        let force = -(k.inverse() * (mixed * couple));
        if (already + force).length() <= radius {
            return (force, couple);
        }
    }
    let couple = (rotation.inverse() * wanted).clamp_length_max(limit);
    (DVec2::ZERO, if couple.is_finite() { couple } else { DVec2::ZERO })
}
