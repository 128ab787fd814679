//! Tubes and bars that are heard: the bending modes of [`beam_modes`] and what they radiate.
//!
//! κ: Cowper, J. Appl. Mech. 33 (1966). A tube radiates as a dipole line: a wire that moves across itself gives
//! π² ρ₀ ω³ a⁴ v²/4c² W per metre (Morse, "Vibration and Sound", §26), hence the radiation efficiency
//! σ = (π²/4)(ka)³ against ρ₀ c v²/2 on its shadow 2aL; 1 at most. Below coincidence, where the bending wave is slower
//! than sound, neighbouring half waves cancel: × f/(f + f_c), f_c = c²/(2πK√(E/ρ)).

use super::beam::{Section, beam_modes};
use super::mode::{Matter, Mode, ModeError};
use super::shape::Shape;
use crate::excitation::{FULL_SCALE_PRESSURE, IMPEDANCE, SOUND_SPEED};
use crate::timbre::{Bar, BeamModel, MaterialOverride, Modal, Tube};
use soffio_math::{PI, exp, ln};

/// A tube of the body's own dimensions. It hangs at the node of the first mode, 0.2242 of the length from its end.
pub(super) const BODYS_TUBE: Tube = Tube {
    model: BeamModel::Timoshenko,
    length: None,
    outer: None,
    inner: None,
    hang: 0.2242,
    split: 0.0,
    plane: 0.5,
    radiation_loss: false,
    material: NO_OVERRIDE,
};
/// A bar of the body's own dimensions. It hangs at the node of the first mode, 0.2242 of the length from its end.
pub(super) const BODYS_BAR: Bar = Bar {
    model: BeamModel::Timoshenko,
    length: None,
    width: None,
    thickness: None,
    hang: 0.2242,
    radiation_loss: false,
    material: NO_OVERRIDE,
};
/// The body's own material.
const NO_OVERRIDE: MaterialOverride =
    MaterialOverride { youngs_modulus: None, shear_modulus: None, poisson: None, density: None, loss_factor: None };

/// A beam that is heard.
struct Sounding {
    section: Section,
    /// Half the width that the listener sees, m.
    radius: f64,
    hang: f64,
    radiates: bool,
}

impl Sounding {
    fn partials(&self, matter: &Matter, modal: &Modal, planes: &[(f64, Option<f64>)]) -> Result<Vec<Mode>, ModeError> {
        let section = &self.section;
        let modes = beam_modes(section, modal.partials.div_ceil(planes.len()));
        let mass = section.density * section.area * section.length;
        if !(mass > 0.0 && mass.is_finite() && section.gyration > 0.0 && section.length > 0.0) {
            return Err((
                "from",
                format!("no beam of {} m, {} m² can ring; all must be above 0", section.length, section.area),
            ));
        }
        let coincidence = SOUND_SPEED * SOUND_SPEED / (2.0 * PI * section.stiffness());
        let face = 2.0 * self.radius * section.length;
        let mut out = Vec::with_capacity(modes.len() * planes.len());
        for mode in modes {
            for &(cents, plane) in planes {
                let frequency = mode.frequency * exp(cents * ln(2.0) / 1200.0);
                let ka = 2.0 * PI * frequency / SOUND_SPEED * self.radius;
                let dipole = 0.25 * PI * PI * ka * ka * ka;
                let efficiency = dipole / (1.0 + dipole) * frequency / (frequency + coincidence);
                let hung = mode.shape(self.hang - 0.5);
                // φ² of mean square 1, so that the support's loss is a rate.
                let support = modal.support_loss * hung * hung * mass;
                let radiated = if self.radiates { IMPEDANCE * face * efficiency / (2.0 * mass) } else { 0.0 };
                out.push(Mode {
                    frequency,
                    decay: matter.loss(frequency) + support + radiated,
                    amplitude: IMPEDANCE / FULL_SCALE_PRESSURE * (face * efficiency / (4.0 * PI * mass)).sqrt(),
                    shape: Shape::Beam(mode, plane),
                });
            }
        }
        Ok(out)
    }
}

/// Partials of a tube.
pub(super) fn tube(tube: &Tube, matter: &Matter, modal: &Modal) -> Result<Vec<Mode>, ModeError> {
    let length = tube.length.unwrap_or(2.0 * matter.body.half_extents[0]);
    let outer = tube.outer.unwrap_or(2.0 * matter.body.half_extents[1]);
    // What the mass leaves of the full section.
    let hole = outer * outer - 4.0 / PI * matter.volume / (2.0 * matter.body.half_extents[0]);
    let inner = tube.inner.unwrap_or_else(|| hole.max(0.0).sqrt());
    if inner.is_nan() || inner >= outer {
        return Err(("inner", format!("{inner} m is not below the outer diameter, {outer} m")));
    }
    let nu = matter.material.poisson;
    let m2 = (inner / outer) * (inner / outer);
    let wide = (1.0 + m2) * (1.0 + m2);
    let kappa = 6.0 * (1.0 + nu) * wide / ((7.0 + 6.0 * nu) * wide + (20.0 + 12.0 * nu) * m2);
    let section = Section {
        length,
        area: PI / 4.0 * (outer * outer - inner * inner),
        gyration: 0.25 * (outer * outer + inner * inner).sqrt(),
        youngs_modulus: matter.material.youngs_modulus,
        shear_stiffness: shear(tube.model, kappa, matter),
        density: matter.material.density,
    };
    let sounding = Sounding { section, radius: 0.5 * outer, hang: tube.hang, radiates: tube.radiation_loss };
    let half = 0.5 * tube.split;
    // Both planes start in phase: the stroke is the loudest moment, then they beat.
    let planes = [(-half, Some(tube.plane)), (half, Some(tube.plane - 0.5 * PI))];
    sounding.partials(matter, modal, if tube.split > 0.0 { &planes } else { &[(0.0, None)] })
}

/// Partials of a bar.
pub(super) fn bar(bar: &Bar, matter: &Matter, modal: &Modal) -> Result<Vec<Mode>, ModeError> {
    let width = bar.width.unwrap_or(2.0 * matter.body.half_extents[1]);
    let thickness = bar.thickness.unwrap_or(matter.body.thickness);
    let nu = matter.material.poisson;
    let section = Section {
        length: bar.length.unwrap_or(2.0 * matter.body.half_extents[0]),
        area: width * thickness,
        gyration: thickness / 12f64.sqrt(),
        youngs_modulus: matter.material.youngs_modulus,
        shear_stiffness: shear(bar.model, 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu), matter),
        density: matter.material.density,
    };
    let sounding = Sounding { section, radius: 0.5 * width, hang: bar.hang, radiates: bar.radiation_loss };
    sounding.partials(matter, modal, &[(0.0, None)])
}

fn shear(model: BeamModel, kappa: f64, matter: &Matter) -> f64 {
    match model {
        BeamModel::Thesis => f64::INFINITY,
        BeamModel::Timoshenko => kappa * matter.shear_modulus,
    }
}
