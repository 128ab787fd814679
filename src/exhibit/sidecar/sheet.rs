//! Thin sheets that bend: cloth.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::quantity::*;
use super::{Drag, Name};

/// A thin sheet, as of silk: a grid of small cells. Down the sheet, from row to row, joints keep its length. Across, springs
/// give it stretch and shear; both ways springs bend it. Draw it as one skin whose joints are the cells.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sheet {
    /// Unique name.
    pub name: Name,
    /// "Silk.*": all nodes whose names begin with "Silk.", in natural order: row by row from the hem down, each row along x.
    /// A node lies in the middle of its cell, x across the sheet, y up it, z along its normal.
    pub cells: String,
    /// Cells of a row.
    #[schemars(range(min = 1, max = 64))]
    pub columns: usize,
    /// Material: gives the density.
    pub material: String,
    /// Thickness.
    pub thickness: Length,
    /// Node that bears the upper edge, sewn on flat: a body, or a fixed node. Without it the sheet is free.
    pub hem: Option<String>,
    /// Stretch across: force per width over strain.
    pub stretch: Stiffness,
    /// Shear: force per width over the angle of shear.
    pub shear: Stiffness,
    /// Bending, EI per width: moment per width over curvature.
    pub bending: Torque,
    /// Inner friction, as in the Kelvin–Voigt model: damping over stiffness, a time. By default none.
    #[serde(default)]
    pub damping: Time,
    /// Drag coefficients of both sides.
    #[serde(default)]
    pub drag: Drag,
}
