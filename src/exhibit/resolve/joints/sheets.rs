//! Joints and springs between the cells of a sheet; the formulas stand in `resolve/sheets.rs`.

use super::super::super::sidecar::Timing;
use super::super::context::Context;
use super::super::sheets::SheetGrid;
use super::{Header, Joints};
use soffio_math::{DVec3, Function};
use soffio_multibody::articulation::{Anchor, Axis, ConstraintKind, Measure, Spring, SpringKind};

/// Stiffnesses of a sheet per width, and the damping over the stiffness.
#[derive(Clone, Copy)]
struct Stiffnesses {
    /// K and G, N/m.
    stretch: f64,
    shear: f64,
    /// B, N m.
    bending: f64,
    /// s.
    damping: f64,
}

impl Context<'_> {
    /// Joins the cells of all sheets.
    pub(super) fn join_sheets(&mut self, out: &mut Joints) {
        let (sidecar, sheets) = (self.sidecar, std::mem::take(&mut self.sheets));
        for grid in &sheets {
            let given = &sidecar.sheet[grid.entry];
            let at = format!("/sheet/{}", grid.entry);
            let header = self.header(&given.name, &Timing::default(), &at, out);
            let stiffnesses = Stiffnesses {
                stretch: self.not_negative(given.stretch.0, &format!("{at}/stretch")),
                shear: self.not_negative(given.shear.0, &format!("{at}/shear")),
                bending: self.not_negative(given.bending.0, &format!("{at}/bending")),
                damping: self.not_negative(given.damping.0, &format!("{at}/damping")),
            };
            // The body that bears the hem; `Some(None)` is the world.
            let hem = match &given.hem {
                None => None,
                Some(name) => match self.node(name, &format!("{at}/hem"), "the hem of a sheet") {
                    Some(node) => Some(self.owner[node]),
                    None => continue,
                },
            };
            self.join_rows(out, &header, grid, hem);
            self.join_springs(out, &header, grid, stiffnesses);
            if let Some(owner) = hem {
                self.bend_hem(out, &header, grid, (owner, stiffnesses));
            }
        }
        self.sheets = sheets;
    }

    /// Ball joints down the sheet, and those of its hem.
    fn join_rows(&mut self, out: &mut Joints, header: &Header, grid: &SheetGrid, hem: Option<Option<usize>>) {
        let [_, columns] = grid.size;
        for (i, j) in grid.cells() {
            let at = grid.edge(i, j);
            let a = self.on_body(Some(grid.body(i, j)), at);
            let (b, part) = if i > 0 {
                (self.on_body(Some(grid.body(i - 1, j)), at), format!("row-{i}-{j}"))
            } else {
                let Some(owner) = hem else { continue };
                (self.on_body(owner, at), format!("hem-{j}"))
            };
            self.push(out, header, &part, ConstraintKind::PointToPoint { a, b }, None);
        }
        let rows = if hem.is_some() { grid.size[0] } else { grid.size[0] - 1 };
        let of = format!("sheet {}", header.name);
        self.record_origin(&of, "joints", format!("{} ball joints", rows * columns), "/-", "part of the sheet");
    }

    /// Springs between neighbours.
    fn join_springs(&self, out: &mut Joints, header: &Header, grid: &SheetGrid, stiffnesses: Stiffnesses) {
        let Stiffnesses { stretch, shear, bending, damping } = stiffnesses;
        let [rows, columns] = grid.size;
        let mut add = |part: &str, (i, j): (usize, usize), measure: Measure, stiffness: f64| {
            if stiffness > 0.0 {
                let name = format!("{}/{part}-{i}-{j}", header.name);
                out.springs.push(spring(header, name, measure, [stiffness, stiffness * damping]));
            }
        };
        for (i, j) in grid.cells() {
            let (body, [width, height]) = (grid.body(i, j), grid.extent(i, j));
            if j + 1 < columns {
                let next = grid.body(i, j + 1);
                let slender = height / width;
                let point = self.on_body(Some(next), grid.seam(i, j + 1));
                let across =
                    |direction| Measure::Displacement { point, direction: Axis { body: Some(body), direction } };
                add("stretch", (i, j), across(DVec3::X), stretch * slender);
                add("shear", (i, j), across(DVec3::Y), shear * slender);
                add("seam", (i, j), across(DVec3::Z), stretch * slender);
                add("fold", (i, j), about(next, DVec3::Y, Some(body)), bending * slender);
            }
            if i + 1 < rows {
                let below = grid.body(i + 1, j);
                add("bend", (i, j), about(below, DVec3::X, Some(body)), bending * width / height);
            }
        }
    }

    /// Bending at the hem, where the sheet is sewn on flat.
    fn bend_hem(&self, out: &mut Joints, header: &Header, grid: &SheetGrid, hem: (Option<usize>, Stiffnesses)) {
        let (owner, of) = hem;
        for j in 0..grid.size[1] {
            let [width, height] = grid.extent(0, j);
            let stiffness = 2.0 * of.bending * width / height;
            if stiffness > 0.0 {
                let measure = about(grid.body(0, j), DVec3::X, owner);
                let name = format!("{}/hem-{j}", header.name);
                out.springs.push(spring(header, name, measure, [stiffness, stiffness * of.damping]));
            }
        }
    }

    /// A world point of the model as a point of a body.
    fn on_body(&self, body: Option<usize>, world: DVec3) -> Anchor {
        Anchor { body, point: self.pose_of(body).inverse_point(world) }
    }
}

/// Rotation of a cell about an axis of its node frame, relative to `frame`.
fn about(body: usize, axis: DVec3, frame: Option<usize>) -> Measure {
    Measure::Angle { axis: Axis { body: Some(body), direction: axis }, frame }
}

/// A spring of a sheet with its stiffness and damping, SI.
fn spring(header: &Header, name: String, measure: Measure, [stiffness, damping]: [f64; 2]) -> Spring {
    Spring {
        name,
        kind: SpringKind::Angular { measure },
        rest_length: Function::default(),
        stiffness: stiffness.into(),
        damping: damping.into(),
        schedule: header.schedule.clone(),
        breaking: None,
    }
}
