//! Built-in materials, used by name or overridden key by key in the sidecar.
//!
//! Density and Young's modulus are handbook values (Engineering ToolBox, "Young's Modulus of Elasticity"; The Wood
//! Database for timber along the grain). The loss factor is that of a mounted part, two to ten times the bare
//! material's: T60 = 2.2/(η f) (Fletcher and Rossing, "The Physics of Musical Instruments"; Cremer, Heckl and
//! Petersson, "Structure-Borne Sound"). Friction is that of the dry material on itself, worn smooth. Restitution is
//! that of small impacts (about 0.1 m/s). Rolling and spinning are free of resistance. Curators can replace each value
//! by a measured one.

use super::Material;
use soffio_multibody::dynamics::RollingResistance;

/// One row: name, kg/m³, μ static, μ sliding, restitution, E in GPa, Poisson's ratio, installed loss factor.
type BuiltinMaterial = (&'static str, f64, f64, f64, f64, f64, f64, f64);

const TABLE: &[BuiltinMaterial] = &[
    ("steel", 7850.0, 0.45, 0.35, 0.60, 205.0, 0.29, 6e-4),
    ("stainless-steel", 7900.0, 0.45, 0.35, 0.60, 195.0, 0.29, 6e-4),
    ("cast-iron", 7200.0, 0.40, 0.30, 0.45, 120.0, 0.26, 3e-3),
    ("aluminium", 2700.0, 0.60, 0.45, 0.55, 69.0, 0.33, 4e-4),
    ("brass", 8500.0, 0.40, 0.32, 0.55, 102.0, 0.34, 1e-3),
    ("copper", 8900.0, 0.45, 0.35, 0.45, 117.0, 0.34, 2.2e-3),
    ("lead", 11300.0, 0.60, 0.50, 0.15, 17.0, 0.44, 2e-2),
    ("glass", 2500.0, 0.45, 0.35, 0.60, 70.0, 0.22, 2e-3),
    ("bamboo", 700.0, 0.45, 0.35, 0.45, 13.0, 0.35, 1.5e-2),
    ("beech", 720.0, 0.45, 0.40, 0.40, 14.0, 0.35, 1e-2),
    ("cherry", 560.0, 0.45, 0.40, 0.40, 10.3, 0.35, 1e-2),
    ("maple", 710.0, 0.45, 0.40, 0.40, 12.6, 0.35, 1e-2),
    ("oak", 680.0, 0.45, 0.40, 0.40, 12.0, 0.35, 1e-2),
    ("rosewood", 830.0, 0.45, 0.40, 0.45, 12.0, 0.35, 6e-3),
];

/// Names of the built-in materials.
pub fn names() -> impl Iterator<Item = &'static str> {
    TABLE.iter().map(|row| row.0)
}

/// A built-in material.
pub fn builtin(name: &str) -> Option<Material> {
    let row = TABLE.iter().find(|row| row.0 == name)?;
    let &(name, density, static_friction, dynamic_friction, restitution, gigapascals, poisson, loss_factor) = row;
    Some(Material {
        name: name.to_owned(),
        density,
        static_friction,
        dynamic_friction,
        restitution,
        youngs_modulus: gigapascals * 1e9,
        poisson,
        loss_factor,
        full_slip: 0.0,
        resistance: RollingResistance::default(),
    })
}
