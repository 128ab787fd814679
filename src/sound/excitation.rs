//! Excitation of a body by an impact: contact time, spectrum and loudness.
//!
//! Symbols of the impact: J impulse (N s), v approach speed (m/s), m effective mass (kg), R radius of the surfaces in contact (m),
//! E* contact modulus (Pa), τ contact time (s). Of the body: S face area (m²), M mass (kg), r distance (m).
//!
//! **Contact** (Hertz; Johnson, "Contact Mechanics", 11.4): τ = 2.87 (m² / (R E*² v))^(1/5), with
//! 1/E* = 2 (1 − ν²)/E for two bodies of one material. Faster impacts are shorter, hence brighter.
//!
//! **Spectrum**: the force is nearly a half sine of area J (`modal/pulse.rs`).
//!
//! **Loudness**: an ideal impulse at x sets mass-normalised mode k moving at q̇ = J φ_k(x), which is √(q̇²/M) as root mean
//! square over the face. Radiating ρ₀ c S σ v² as a point source in all directions gives the pressure amplitude
//! p = ρ₀ c √(S σ / 4π) v / r, with σ the radiation efficiency. The same energy balance damps the
//! mode by c = ρ₀ c S σ / 2M.
//!
//! **Radiation efficiency** of an unbaffled plate, from its three asymptotes: a dipole (σ ∝ (ka)⁴) while the plate is
//! smaller than the wave; neighbouring half waves cancel (σ ∝ f) below the coincidence frequency
//! f_c = c²/(2π) √(μ/D); 1 above. (Fahy and Gardonio, "Sound and Structural Vibration", chapter 3.)

use super::{SoundBody, SoundMaterial};
use soffio_math::{PI, pow};

/// Characteristic impedance of air, ρ c, Pa s/m (20 °C).
pub(super) const IMPEDANCE: f64 = 413.0;
/// Speed of sound, m/s (20 °C).
pub(super) const SOUND_SPEED: f64 = 343.0;
/// Pressure that is digital full scale, Pa. Chosen so that a plate of a few grams hit at 0.3 m/s is clearly heard at
/// arm's length without leaning on the limiter.
pub(super) const FULL_SCALE_PRESSURE: f64 = 1.0;
/// Shortest contact that Hertz's law is trusted with, s: a tenth of a period of 5 kHz; shorter ones sound alike.
const SHORTEST_CONTACT: f64 = 2e-5;
/// Longest contact that Hertz's law is trusted with, s: longer ones are pushes, without a sound.
pub(super) const LONGEST_CONTACT: f64 = 2e-2;

/// Surfaces in contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    /// R, m.
    radius: f64,
    /// E*, Pa.
    modulus: f64,
}

impl Contact {
    /// `surface_modulus` replaces the material's own where something soft lies between.
    pub fn new(radius: f64, surface_modulus: Option<f64>, material: &SoundMaterial) -> Self {
        let e = surface_modulus.unwrap_or(material.youngs_modulus);
        Self { radius, modulus: e / (2.0 * (1.0 - material.poisson * material.poisson)) }
    }

    /// Hertz contact time τ, s, of an impact with an effective mass, kg, at an approach speed, m/s: τ = 2.87 (m²/(R E*² v))^⅕.
    pub fn time(&self, mass: f64, speed: f64) -> f64 {
        let stiff = self.radius * self.modulus * self.modulus * speed.max(1e-4);
        (2.87 * pow(mass.max(1e-6) * mass.max(1e-6) / stiff, 0.2)).clamp(SHORTEST_CONTACT, LONGEST_CONTACT)
    }
}

/// Radiation of a vibrating face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Radiator {
    /// Radius of the circle of the same area, m.
    radius: f64,
    /// f_c, Hz.
    coincidence: f64,
    /// ρ₀ c √(S/4π) / full scale: pressure at 1 m per m/s.
    level: f64,
    /// ρ₀ c S / 2M, 1/s.
    damping: f64,
    /// M, kg.
    mass: f64,
}

impl Radiator {
    /// The radiator that a body of this material is.
    pub fn new(body: &SoundBody, material: &SoundMaterial) -> Self {
        let h = body.thickness;
        let rigidity = material.youngs_modulus * h * h * h / (12.0 * (1.0 - material.poisson * material.poisson));
        Self {
            radius: (body.area / PI).sqrt(),
            coincidence: SOUND_SPEED * SOUND_SPEED / (2.0 * PI) * (body.mass / body.area / rigidity).sqrt(),
            level: IMPEDANCE * (body.area / (4.0 * PI)).sqrt() / FULL_SCALE_PRESSURE,
            damping: IMPEDANCE * body.area / (2.0 * body.mass),
            mass: body.mass,
        }
    }

    fn efficiency(&self, frequency: f64) -> f64 {
        let ka = 2.0 * PI * frequency / SOUND_SPEED * self.radius;
        let dipole = ka * ka * ka * ka / (1.0 + ka * ka * ka * ka);
        dipole * frequency / (frequency + self.coincidence)
    }

    /// Amplitude 1 m away, full scale, of a mode per (N s of impulse · 1/√kg of shape).
    pub fn amplitude(&self, frequency: f64) -> f64 {
        self.level * (self.efficiency(frequency) / self.mass).sqrt()
    }

    /// Damping by radiation, 1/s.
    pub fn loss(&self, frequency: f64) -> f64 {
        self.damping * self.efficiency(frequency)
    }

    /// Amplitude 1 m away, full scale, if the whole face moved at impulse / mass.
    pub fn rigid_pressure(&self, impulse: f64) -> f64 {
        self.level * impulse / self.mass
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_steel_ball_on_aluminium_touches_as_long_as_the_tables_say() {
        // Steel ball, 10 g, radius 7 mm, on a massive aluminium tube at 0.3 m/s: 0.078 ms.
        let (steel, aluminium) = ((2.05e11, 0.3), (6.89e10, 0.33));
        let modulus = 1.0 / ((1.0 - steel.1 * steel.1) / steel.0 + (1.0 - aluminium.1 * aluminium.1) / aluminium.0);
        let contact = Contact { radius: 0.007, modulus };
        // The table has two digits.
        const TOLERANCE: f64 = 0.006e-3;
        assert!((contact.time(0.01, 0.3) - 0.078e-3).abs() < TOLERANCE, "{}", contact.time(0.01, 0.3));
    }
}
