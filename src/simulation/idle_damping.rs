//! Idle damping: Rayleigh damping in proportion to mass while nobody interacts, in the gallery profile.
//!
//! A mobile swings for minutes, and the effect of the next visitor's breath would be lost in that swing. An exhibit may ask
//! for idle damping (`[wind.calm]`): some time after the last breath or grab its motion fades; the next breath ends that.
//!
//! ```text
//! F = −r m v      M = −r I ω      r = min(t/R, 1) (1 + (K − 1) min(t/G, 1))/τ
//!                                 t: time since the damping began, s; R: rise time; K: growth within G seconds
//! ```
//!
//! It is weak at first, so that a visitor who has blown sees the exhibit swing. It grows later, so that the ambient draught,
//! which can turn a mobile as fast as a gentle breath does, turns it only slowly.
//!
//! Damping in proportion to mass (Rayleigh, *The Theory of Sound*, § 97) slows all modes alike, whatever joins the bodies:
//! rotation without a restoring force decays as exp(−t/τ), oscillation as exp(−t/2τ). The ambient wind continues.
//!
//! The motion that attract mode leaves behind would hide what a new visitor does. [`IdleDamping::settle`] damps it at once,
//! five times as strongly.

use soffio_exhibit::IdleDampingSpec;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, add_scaled, vec6};

/// Time course of the damping.
struct Tuning {
    /// R, s: a sudden damping would look like a hand.
    rise: f64,
    /// G, s: the next visitor comes ten seconds after the last at the earliest. Then the swing is gone, and the draught's motion
    /// in the picture has a fifth to a quarter of the energy.
    growth_time: f64,
    /// K.
    growth: f64,
    /// R of [`IdleDamping::settle`], s.
    settle_rise: f64,
    /// τ of [`IdleDamping::settle`] over the exhibit's: settles within two seconds.
    settle_time: f64,
}

const TUNING: Tuning = Tuning { rise: 1.0, growth_time: 5.0, growth: 8.0, settle_rise: 0.3, settle_time: 0.2 };

/// Time without interaction, from which the damping follows.
#[derive(Clone, Copy, Debug, Default)]
pub struct IdleDamping {
    /// Since the last breath or grab, s.
    idle_time: f64,
    /// Since [`Self::settle`], s.
    settling: Option<f64>,
}

impl IdleDamping {
    /// Advances by `dt` seconds with or without a breath or grab.
    pub fn advance(&mut self, interaction: bool, dt: f64) {
        self.idle_time = if interaction { 0.0 } else { self.idle_time + dt };
        self.settling = self.settling.filter(|_| !interaction).map(|since| since + dt);
    }

    /// Damps at once, until the next interaction.
    pub fn settle(&mut self) {
        self.settling.get_or_insert(0.0);
    }

    /// r, 1/s.
    fn rate(&self, settings: IdleDampingSpec) -> f64 {
        let ramp = |since: f64, duration: f64| (since / duration).clamp(0.0, 1.0);
        let since = self.idle_time - settings.after;
        let growth = 1.0 + (TUNING.growth - 1.0) * ramp(since, TUNING.growth_time);
        let idle = ramp(since, TUNING.rise) * growth / settings.time;
        let settling =
            self.settling.map_or(0.0, |since| ramp(since, TUNING.settle_rise) / (TUNING.settle_time * settings.time));
        idle.max(settling)
    }

    /// Adds the damping of the bodies to the wrenches on them (force, torque about the centre of mass).
    pub fn apply(&self, settings: IdleDampingSpec, bodies: &[RigidBody], wrenches: &mut [Vec6]) {
        let rate = self.rate(settings);
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

    const SETTINGS: IdleDampingSpec = IdleDampingSpec { after: 4.0, time: 2.0 };
    const DT: f64 = 1.0 / 240.0;

    fn pass(idle: &mut IdleDamping, interaction: bool, seconds: f64) {
        (0..(seconds / DT).round() as usize).for_each(|_| idle.advance(interaction, DT));
    }

    #[test]
    fn it_waits_starts_weakly_and_grows_until_an_interaction() {
        const ROUNDING: f64 = 1e-9;
        let mut idle = IdleDamping::default();
        pass(&mut idle, false, SETTINGS.after);
        assert!(idle.rate(SETTINGS) < ROUNDING, "no damping yet");
        pass(&mut idle, false, TUNING.rise);
        let weak = idle.rate(SETTINGS) * SETTINGS.time;
        assert!((1.0..2.5).contains(&weak), "{weak} of its own rate");
        pass(&mut idle, false, TUNING.growth_time - TUNING.rise);
        assert!((idle.rate(SETTINGS) * SETTINGS.time - TUNING.growth).abs() < ROUNDING);
        pass(&mut idle, false, 60.0);
        assert!((idle.rate(SETTINGS) * SETTINGS.time - TUNING.growth).abs() < ROUNDING, "no stronger later");
        pass(&mut idle, true, DT);
        assert_eq!(idle.rate(SETTINGS), 0.0);
    }

    #[test]
    fn settling_does_not_wait_and_does_not_weaken() {
        let mut idle = IdleDamping::default();
        idle.settle();
        let mut least = 0.0;
        for _ in 0..40 {
            pass(&mut idle, false, 0.5);
            assert!(idle.rate(SETTINGS) >= least, "{} 1/s after {least} 1/s", idle.rate(SETTINGS));
            least = 1.0 / (TUNING.settle_time * SETTINGS.time);
        }
        pass(&mut idle, true, DT);
        assert_eq!(idle.rate(SETTINGS), 0.0);
    }
}
