//! What rests on something turns on it: balls between sliding and rolling, rolling resistance, drilling friction (method 3.7).
//!
//! A step by places gives each resting point one normal impulse P_n. Beside Coulomb's law, which `dynamics::impulse` has
//! answered with already, there is the source's for a ball on a surface: friction by the slip ratio,
//!
//! ```text
//! s = |v_t − r ω×n|/|v_t|, at most 1        F = s F_friction        s = 1 slides, s = 0 rolls
//! ```
//!
//! with v_t the tangential velocity of the ball's centre over the surface, so that v_t − r ω×n is the slip u of the contact
//! point. As −F̂ = u/|u|, the law is F = −μ N u/max(|u|, |v_t|), smooth down to rolling, which it reaches as
//! e^(−t/τ): a ball that starts at v₀ without spin obeys, with v∞ = 5/7 v₀,
//!
//! ```text
//! v̇ = −(7/2) μ g (v − v∞)/v        v₀ − v + v∞ ln((v₀ − v∞)/(v − v∞)) = (7/2) μ g t
//! ```
//!
//! The law is integrated over the step's budget q = μ P_n in [`PIECES`] pieces by its midpoint, u fading by
//! exp(−K_T q/|v_t|) in each, which never overshoots.
//!
//! **Resistance.** Couples up to b P_n against rolling and d P_n against spin (`dynamics::RollingResistance`). A ball that rolls goes
//! on rolling while it slows down: the couple M comes with the friction −K_T⁻¹ K_Tω M that leaves the slip as it is (the
//! source's velocity matching), as far as friction reaches. While it slides under Coulomb's law the couple acts alone; under the source's
//! law it grows with 1 − s.

use crate::dynamics::SweptContact;
use soffio_math::{DMat2, DMat3, DVec2, DVec3, exp};

/// Pieces of a step's friction.
const PIECES: usize = 4;
/// Slower slip than this share of the speeds before is none: ten times what `impulse` leaves.
const ROLLS: f64 = 1e-8;
/// Answers smaller than this are none: joints hold what would move, 1/kg or 1/(kg m²).
const LOCKED: f64 = 1e-9;

/// Effective inverse masses of a point and its couple, all in the frame (t, b, n) of the contact: velocities are K P.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    /// Of the contact point to forces there, 1/kg.
    pub point: DMat3,
    /// Of the contact point to couples, and the other way round its transpose, 1/(kg m).
    pub mixed: DMat3,
    /// Of the relative turning to couples, 1/(kg m²).
    pub turn: DMat3,
    /// Of the ball's centre over the surface to forces at the contact point, 1/kg.
    pub center: DMat3,
}

/// Relative velocities at a contact, (t, b, n).
#[derive(Clone, Copy, Debug)]
pub(super) struct Moves {
    /// Of the contact points, m/s.
    pub slip: DVec3,
    /// Of the ball's centre over the surface, m/s; the slip itself where there is no ball.
    pub center: DVec3,
    /// Turning, rad/s.
    pub turn: DVec3,
}

/// Force and couple impulses on the first body, (t, b, n), N s and N m s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Push {
    pub force: DVec3,
    pub couple: DVec3,
}

impl Push {
    /// Adds a force and a couple, and lets the velocities follow.
    fn give(&mut self, patch: &Patch, moves: &mut Moves, force: DVec3, couple: DVec3) {
        moves.slip += patch.point * force + patch.mixed * couple;
        moves.turn += patch.mixed.transpose() * force + patch.turn * couple;
        moves.center += patch.center * force;
        self.force += force;
        self.couple += couple;
    }
}

/// The whole impulse of a resting point: `answer` is Coulomb's, `moves` are the velocities before it.
pub(super) fn resist(met: &SweptContact, patch: &Patch, mut moves: Moves, answer: DVec3, by_ratio: bool) -> Push {
    let mut whole = Push::default();
    let most = met.friction * answer.z;
    let mut rolling = met.resistance.rolling * answer.z;
    let mut sticks = true;
    if by_ratio {
        whole.give(patch, &mut moves, DVec3::Z * answer.z, DVec3::ZERO);
        for _ in 0..PIECES {
            let force = rub(patch, &moves, most / PIECES as f64);
            whole.give(patch, &mut moves, force.extend(0.0), DVec3::ZERO);
        }
        rolling *= 1.0 - ratio(&moves);
    } else {
        let fast = moves.center.truncate().length() + moves.slip.length();
        whole.give(patch, &mut moves, answer, DVec3::ZERO);
        sticks = moves.slip.truncate().length() <= ROLLS * fast;
    }
    let spinning = met.resistance.spinning * answer.z;
    let free = patch.turn.z_axis.z > LOCKED;
    let spin = if free { (-moves.turn.z / patch.turn.z_axis.z).clamp(-spinning, spinning) } else { 0.0 };
    whole.give(patch, &mut moves, DVec3::ZERO, DVec3::Z * spin);
    if rolling > 0.0 {
        let (force, couple) = stop_rolling(patch, &moves, rolling, sticks.then_some((whole.force.truncate(), most)));
        whole.give(patch, &mut moves, force.extend(0.0), couple.extend(0.0));
    }
    whole
}

/// s of what moves so, 0 … 1.
fn ratio(moves: &Moves) -> f64 {
    let (slip, speed) = (moves.slip.truncate().length(), moves.center.truncate().length());
    if slip >= speed && slip > 0.0 { 1.0 } else { slip / speed.max(f64::MIN_POSITIVE) }
}

/// Friction of the source's law for a piece of its budget, N s: the rate is that of the middle of the piece.
fn rub(patch: &Patch, moves: &Moves, budget: f64) -> DVec2 {
    let mut middle = *moves;
    Push::default().give(patch, &mut middle, fade(patch, moves, moves, 0.5 * budget).extend(0.0), DVec3::ZERO);
    fade(patch, moves, &middle, budget)
}

/// Friction that lets the slip of `moves` fade at the rate of `there` over a budget, N s.
fn fade(patch: &Patch, moves: &Moves, there: &Moves, budget: f64) -> DVec2 {
    let k = patch.point.x_axis.x.max(patch.point.y_axis.y);
    let (slip, speed) = (moves.slip.truncate(), there.center.truncate().length());
    let (slides, slides_there) = (slip.length(), there.slip.truncate().length());
    if slides == 0.0 || k <= LOCKED {
        DVec2::ZERO
    } else if slides_there >= speed {
        // All of it, but no more than ends the slip.
        -slip * (budget / slides).min(1.0 / k)
    } else {
        -slip * ((1.0 - exp(-k * budget / speed)) / k)
    }
}

/// Friction and couple against rolling, of at most `most`. Where the point sticks by the friction (what it is, what it may be),
/// more of it leaves the slip as it is, as far as it reaches.
fn stop_rolling(patch: &Patch, moves: &Moves, most: f64, sticks: Option<(DVec2, f64)>) -> (DVec2, DVec2) {
    // Blocks across the normal.
    let block = |m: &DMat3| DMat2::from_cols(m.x_axis.truncate(), m.y_axis.truncate());
    let (k, mixed, turn) = (block(&patch.point), block(&patch.mixed), block(&patch.turn));
    let wanted = -moves.turn.truncate();
    if let Some((already, reach)) = sticks {
        let rigid = turn - mixed.transpose() * (k.inverse() * mixed);
        let couple = (rigid.inverse() * wanted).clamp_length_max(most);
        let force = -(k.inverse() * (mixed * couple));
        if (already + force).length() <= reach {
            return (force, couple);
        }
    }
    let couple = (turn.inverse() * wanted).clamp_length_max(most);
    (DVec2::ZERO, if couple.is_finite() { couple } else { DVec2::ZERO })
}
