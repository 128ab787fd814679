//! Strings and the single spring.
//!
//! **String** of length L: f_n = n v/2L √(1 + B n²); v = √(T L/m) of a stretched string, √(E/ρ) of longitudinal waves.
//! Stiffness gives B = π³ E d⁴/64 T L² for a string of diameter d (Fletcher, JASA 36, 1964). Its own sound is faint; the
//! audible part is the bridge, on which the force T nπ/L q_n acts: equal for every partial of a struck string.
//!
//! **Spring**: f = √(k/m) / 2π.

use super::limits::{HIGHEST, T60_DECAYS};
use super::mode::{Matter, Mode, ModeError};
use super::shape::Shape;
use crate::SoundBody;
use crate::timbre::{MassSpring, Modal, Strung};
use soffio_math::PI;

/// Partials of a string.
pub(super) fn string(string: &Strung, matter: &Matter, modal: &Modal) -> Result<Vec<Mode>, ModeError> {
    let length = string.length.unwrap_or(2.0 * matter.body.half_extents[0]);
    let mass = string.mass.unwrap_or(matter.body.mass);
    let speed = match string.tension {
        Some(tension) => (tension * length / mass).sqrt(),
        None => (matter.material.youngs_modulus / matter.material.density).sqrt(),
    };
    let fundamental = speed / (2.0 * length);
    if !(fundamental.is_finite() && fundamental > 0.0) {
        return Err(("from", format!("no string of {length} m and {mass} kg can ring; all must be above 0")));
    }
    let partial = |n: usize| {
        let number = n as f64;
        let frequency = number * fundamental * (1.0 + string.inharmonicity * number * number).sqrt();
        let decay = matter.loss(frequency) + modal.support_loss;
        Mode { frequency, decay, amplitude: 1.0, shape: Shape::String(n) }
    };
    Ok((1..=modal.partials).map(partial).take_while(|mode| mode.frequency <= HIGHEST).collect())
}

/// The partial of a mass on a spring.
pub(super) fn mass_spring(spring: &MassSpring, body: &SoundBody, support_loss: f64) -> Result<Vec<Mode>, ModeError> {
    let mass = spring.mass.unwrap_or(body.mass);
    if !(mass.is_finite() && mass > 0.0) {
        return Err(("mass", format!("{mass} kg must be above 0")));
    }
    let frequency = (spring.stiffness / mass).sqrt() / (2.0 * PI);
    let decay = T60_DECAYS / spring.t60 + support_loss;
    Ok(vec![Mode { frequency, decay, amplitude: 1.0, shape: Shape::Even }])
}
