//! Resolves materials: the built-in table, changes of the sidecar, and material pairs.

use super::super::diagnostic::{Diagnostic, quoted, similar_names};
use super::super::quantity::Length;
use super::super::source::join;
use super::super::{Material, MaterialPair, codes, materials};
use super::context::Context;
use soffio_multibody::dynamics::RollingResistance;

impl Context<'_> {
    pub(super) fn materials(&mut self) {
        for name in self.source.keys_of("/material") {
            let Some(given) = self.sidecar.material.get(&name) else { continue };
            let at = join("/material", &name);
            let base = materials::builtin(&name);
            let default = base.clone().unwrap_or(Material {
                name: name.clone(),
                density: 0.0,
                static_friction: 0.4,
                dynamic_friction: 0.3,
                restitution: 0.4,
                youngs_modulus: 0.0,
                poisson: 0.3,
                loss_factor: 0.01,
                full_slip: 0.0,
                resistance: RollingResistance::default(),
            });
            let [rolling, spinning] =
                self.resistances([given.rolling_resistance, given.spin_resistance], &at).map(Option::unwrap_or_default);
            let material = Material {
                name: name.clone(),
                density: given.density.map_or(default.density, |v| v.0),
                static_friction: given.static_friction.unwrap_or(default.static_friction),
                dynamic_friction: given.dynamic_friction.unwrap_or(default.dynamic_friction),
                restitution: given.restitution.unwrap_or(default.restitution),
                youngs_modulus: given.youngs_modulus.map_or(default.youngs_modulus, |v| v.0),
                poisson: given.poisson.unwrap_or(default.poisson),
                loss_factor: given.loss_factor.unwrap_or(default.loss_factor),
                full_slip: given.full_slip.unwrap_or(default.full_slip),
                resistance: RollingResistance { rolling, spinning },
            };
            for (key, value) in [("density", material.density), ("youngs_modulus", material.youngs_modulus)] {
                if value <= 0.0 {
                    let what = if base.is_none() {
                        "a material that is not built in needs it"
                    } else {
                        "it must be above zero"
                    };
                    let message = format!("material \"{name}\" has no {key}");
                    let known = materials::names().collect::<Vec<_>>().join(", ");
                    self.report(
                        &at,
                        Diagnostic::new(codes::RANGE, message).label(what).help(format!("built in: {known}")),
                    );
                }
            }
            self.record_material_origins(&material, &at, base.is_some());
            self.materials.push(material);
        }
    }

    pub(super) fn record_material_origins(&mut self, material: &Material, at: &str, builtin: bool) {
        let of = format!("material {}", material.name);
        let otherwise = if builtin { "built-in table" } else { "default" };
        for (key, value) in [
            ("density", format!("{} kg/m³", material.density)),
            ("static_friction", material.static_friction.to_string()),
            ("dynamic_friction", material.dynamic_friction.to_string()),
            ("restitution", material.restitution.to_string()),
            ("youngs_modulus", format!("{} GPa", material.youngs_modulus / 1e9)),
            ("poisson", material.poisson.to_string()),
            ("loss_factor", material.loss_factor.to_string()),
            ("full_slip", material.full_slip.to_string()),
            ("rolling_resistance", format!("{} mm", 1e3 * material.resistance.rolling)),
            ("spin_resistance", format!("{} mm", 1e3 * material.resistance.spinning)),
        ] {
            self.record_origin(&of, key, value, &join(at, key), otherwise);
        }
    }

    pub(super) fn material_pairs(&mut self) -> Vec<MaterialPair> {
        let sidecar = self.sidecar;
        let mut pairs = Vec::new();
        for (i, given) in sidecar.material_pair.iter().enumerate() {
            let at = format!("/material_pair/{i}/pair");
            let first = self.material(&given.pair[0], &format!("{at}/0"));
            let second = self.material(&given.pair[1], &format!("{at}/1"));
            let given_resistances = [given.rolling_resistance, given.spin_resistance];
            let [rolling_resistance, spin_resistance] =
                self.resistances(given_resistances, &format!("/material_pair/{i}"));
            if let (Some(a), Some(b)) = (first, second) {
                pairs.push(MaterialPair {
                    pair: (a, b),
                    restitution: given.restitution,
                    dynamic_friction: given.dynamic_friction,
                    static_friction: given.static_friction,
                    rolling_resistance,
                    spin_resistance,
                });
            }
        }
        pairs
    }

    /// Rolling and spin resistance of the table at `at`, m.
    fn resistances(&mut self, given: [Option<Length>; 2], at: &str) -> [Option<f64>; 2] {
        let [rolling, spinning] = given;
        [(rolling, "rolling_resistance"), (spinning, "spin_resistance")]
            .map(|(given, key)| given.map(|length| self.not_negative(length.0, &join(at, key))))
    }

    /// Index of a material of the sidecar or of the built-in table.
    pub(super) fn material(&mut self, name: &str, at: &str) -> Option<usize> {
        if let Some(index) = self.materials.iter().position(|m| m.name == name) {
            return Some(index);
        }
        if let Some(material) = materials::builtin(name) {
            self.record_material_origins(&material, "/material/-", true);
            self.materials.push(material);
            return Some(self.materials.len() - 1);
        }
        let builtin: Vec<&str> = materials::names().collect();
        let known = self.sidecar.material.keys().map(String::as_str).chain(builtin.iter().copied());
        let likely = similar_names(name, known);
        let help = match likely.as_slice() {
            [] => format!(
                "built in: {}; or write a table [material.{name}]",
                materials::names().collect::<Vec<_>>().join(", ")
            ),
            names => format!("did you mean {}?", quoted(names)),
        };
        self.report(at, Diagnostic::new(codes::UNKNOWN_MATERIAL, format!("no material named \"{name}\"")).help(help));
        None
    }
}
