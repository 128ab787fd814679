//! The calm between breaths.
//!
//! A mobile swings on for minutes, and the next visitor's breath is lost in the swing that the last one left. In the
//! *gallery* profile an exhibit may ask for calm: once nobody has blown or held it for some time, its motion fades, and
//! the first breath ends that.
//!
//! ```text
//! F = −r m v      M = −r I ω      r = min(t/R, 1) (1 + (K − 1) min(t/G, 1))/τ
//!                                 t: since the calm began, s; R: it comes over so long; K: it grows so much firmer within G
//! ```
//!
//! It is gentle at first, so that whoever has blown sees the work swing on, and grows firmer the longer nobody is there: the
//! room's draught, at whose pace a mobile may turn as fast as a gentle breath turns it, then drifts it slowly.
//!
//! Damping in proportion to mass (Rayleigh, *The Theory of Sound*, § 97) slows all that moves alike, whatever joins the
//! bodies: what turns freely as exp(−t/τ), what swings as exp(−t/2τ), each in its own shape. The room's air goes on stirring.
//!
//! What attract mode has set swinging is not what a visitor who now comes has done, and would hide what they are about to do:
//! then the calm does not wait, and is five times as strong ([`Idle::hush`]).

use soffio_exhibit::Calm;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, add_scaled, vec6};

/// R: the calm comes over so long, s. At once it would look like a hand.
const RISE: f64 = 1.0;
/// G and K: within so long, s, it grows so much firmer. The next visitor comes ten seconds after the last at the earliest: then
/// the swing is gone, and what the draught moves of a mobile's picture has a fifth to a quarter of the energy.
const GROWTH: f64 = 5.0;
const FIRMER: f64 = 8.0;
/// R of a calm that does not wait, s, and its τ as a share of the exhibit's: still within two seconds, and yet no hand.
const HUSHED_RISE: f64 = 0.3;
const HUSHED: f64 = 0.2;

/// How long nobody has blown or held anything.
#[derive(Clone, Copy, Debug, Default)]
pub struct Idle {
    /// s.
    time: f64,
    /// Since the calm was asked for, s.
    hushed: Option<f64>,
}

impl Idle {
    /// Lets `dt` seconds pass, in which somebody did something or not.
    pub fn advance(&mut self, done: bool, dt: f64) {
        self.time = if done { 0.0 } else { self.time + dt };
        self.hushed = self.hushed.filter(|_| !done).map(|since| since + dt);
    }

    /// Lets the calm come at once, until somebody does something.
    pub fn hush(&mut self) {
        self.hushed.get_or_insert(0.0);
    }

    /// r, 1/s.
    fn rate(&self, calm: Calm) -> f64 {
        let part = |since: f64, whole: f64| (since / whole).clamp(0.0, 1.0);
        let since = self.time - calm.after;
        let grown = part(since, RISE) * (1.0 + (FIRMER - 1.0) * part(since, GROWTH)) / calm.time;
        let hushed = self.hushed.map_or(0.0, |since| part(since, HUSHED_RISE) / (HUSHED * calm.time));
        grown.max(hushed)
    }

    /// Adds what calms the bodies to the wrenches on them (force, torque about the centre of mass).
    pub fn calm(&self, calm: Calm, bodies: &[RigidBody], wrenches: &mut [Vec6]) {
        let rate = self.rate(calm);
        if rate <= 0.0 {
            return;
        }
        for (body, wrench) in bodies.iter().zip(wrenches) {
            let momentum = vec6(body.properties.mass * body.velocity, body.inertia_world() * body.angular_velocity);
            add_scaled(wrench, -rate, &momentum);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CALM: Calm = Calm { after: 4.0, time: 2.0 };
    const DT: f64 = 1.0 / 240.0;

    fn pass(idle: &mut Idle, done: bool, seconds: f64) {
        (0..(seconds / DT).round() as usize).for_each(|_| idle.advance(done, DT));
    }

    #[test]
    fn it_waits_is_gentle_and_grows_firmer_until_somebody_does_something() {
        const ROUNDING: f64 = 1e-9;
        let mut idle = Idle::default();
        pass(&mut idle, false, CALM.after);
        assert!(idle.rate(CALM) < ROUNDING, "it swings on");
        pass(&mut idle, false, RISE);
        let gentle = idle.rate(CALM) * CALM.time;
        assert!((1.0..2.5).contains(&gentle), "{gentle} of its own rate");
        pass(&mut idle, false, GROWTH - RISE);
        assert!((idle.rate(CALM) * CALM.time - FIRMER).abs() < ROUNDING);
        pass(&mut idle, false, 60.0);
        assert!((idle.rate(CALM) * CALM.time - FIRMER).abs() < ROUNDING, "and no firmer");
        pass(&mut idle, true, DT);
        assert_eq!(idle.rate(CALM), 0.0);
    }

    #[test]
    fn what_is_hushed_does_not_wait_and_is_calmed_no_less_later() {
        let mut idle = Idle::default();
        idle.hush();
        let mut least = 0.0;
        for _ in 0..40 {
            pass(&mut idle, false, 0.5);
            assert!(idle.rate(CALM) >= least, "{} 1/s after {least} 1/s", idle.rate(CALM));
            least = 1.0 / (HUSHED * CALM.time);
        }
        pass(&mut idle, true, DT);
        assert_eq!(idle.rate(CALM), 0.0);
    }
}
