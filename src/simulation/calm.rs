//! The calm between breaths.
//!
//! A mobile swings on for minutes, and the next visitor's breath is lost in the swing that the last one left. In the
//! *gallery* profile an exhibit may ask for calm: once nobody has blown or held it for some time, its motion fades, and
//! the first breath ends that.
//!
//! ```text
//! F = −r m v      M = −r I ω      r = min(t/R, 1)/τ     t: since the calm began, s; R: it comes over so long
//! ```
//!
//! Damping in proportion to mass (Rayleigh, *The Theory of Sound*, § 97) slows all that moves alike, whatever joins the
//! bodies: what turns freely as exp(−t/τ), what swings as exp(−t/2τ), each in its own shape. The room's air goes on stirring.
//!
//! What attract mode has set swinging is not what a visitor who now comes has done, and would hide what they are about to do:
//! then the calm does not wait, and is five times as strong ([`Idle::hush`]).

use crate::articulation::block::{Vec6, add_scaled, vec6};
use crate::bodies::RigidBody;
use crate::exhibit::Calm;

/// R: the calm comes over so long, s. At once it would look like a hand.
const RISE: f64 = 1.0;
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

    /// Adds what calms the bodies to the wrenches on them (force, torque about the centre of mass).
    pub fn calm(&self, calm: Calm, bodies: &[RigidBody], wrenches: &mut [Vec6]) {
        let (since, rise, time) = match self.hushed {
            Some(since) => (since, HUSHED_RISE, HUSHED * calm.time),
            None => (self.time - calm.after, RISE, calm.time),
        };
        if since <= 0.0 {
            return;
        }
        let rate = (since / rise).min(1.0) / time;
        for (body, wrench) in bodies.iter().zip(wrenches) {
            let momentum = vec6(body.properties.mass * body.velocity, body.inertia_world() * body.angular_velocity);
            add_scaled(wrench, -rate, &momentum);
        }
    }
}
