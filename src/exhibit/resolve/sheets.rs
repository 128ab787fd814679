//! Sheets: a grid of rigid cells becomes bodies, joints, springs and wind surfaces.
//!
//! With rows i from the hem down, columns j along x, cells of width w and height h, and per width K the stretch stiffness, G the
//! shear stiffness, B the bending stiffness:
//!
//! ```text
//! mass          thickness × density × area of each cell
//! down          a ball joint in the middle of the edge between (i, j) and (i+1, j): no stretch
//! seams         springs on how far the middles of the edges at the seam between (i, j) and (i, j+1) lie apart, in the frame of
//!               (i, j): k = K h/w along x (stretch), G h/w along y (shear), K h/w along z (it does not tear open)
//! bending       torsion about x between (i, j) and (i+1, j): κ = B w/h; twice that at the hem, half a cell from the edge
//!               torsion about y between (i, j) and (i, j+1): κ = B h/w
//! ```
//!
//! Shear by γ turns each cell by γ in the plane and opens a seam by γ w along it: ½ k (γ w)² is ½ G γ² of an area w h. A
//! curvature c down the sheet turns neighbours by c h: ½ κ (c h)² is ½ B c² of an area w h. So the sheet has the energies of a
//! continuous one, as fine as its cells.

use super::super::diagnostic::Diagnostic;
use super::super::sidecar::Sheet;
use super::super::{Body, codes};
use super::context::Context;
use super::nodes::rigid;
use soffio_geometry::TriangleMesh;
use soffio_geometry::bodies::MassProperties;
use soffio_math::{DVec3, Pose};
use soffio_wind::{Surface, SurfaceShape};

/// Wind is sampled at the middles of two by two parts of a cell.
const SAMPLES: usize = 4;

/// The cells of a sheet.
pub(super) struct SheetGrid {
    /// Index of its table.
    pub entry: usize,
    /// Body of the first cell; the others follow row by row.
    pub first_body: usize,
    /// How many rows and columns.
    pub size: [usize; 2],
    /// World positions of the cells' corners in the model, rows + 1 by columns + 1, m.
    corners: Vec<DVec3>,
}

impl SheetGrid {
    /// Body of the cell in row `i` and column `j`.
    pub fn body(&self, i: usize, j: usize) -> usize {
        self.first_body + i * self.size[1] + j
    }

    /// Row and column of a body that is one of its cells.
    fn place(&self, body: usize) -> Option<(usize, usize)> {
        let index = body.checked_sub(self.first_body).filter(|index| *index < self.size[0] * self.size[1])?;
        Some((index / self.size[1], index % self.size[1]))
    }

    /// A corner of cells in the model, world, m.
    pub fn corner(&self, i: usize, j: usize) -> DVec3 {
        self.corners[i * (self.size[1] + 1) + j]
    }

    /// Middle of the upper edge of the cell in row `i` (one more than the last for the lower edge) and column `j`, world, m.
    pub fn edge(&self, i: usize, j: usize) -> DVec3 {
        0.5 * (self.corner(i, j) + self.corner(i, j + 1))
    }

    /// Middle of the left edge of the cell in row `i` and column `j` (one more than the last for the right edge), world, m.
    pub fn seam(&self, i: usize, j: usize) -> DVec3 {
        0.5 * (self.corner(i, j) + self.corner(i + 1, j))
    }

    /// Width and height of a cell, m.
    pub fn extent(&self, i: usize, j: usize) -> [f64; 2] {
        [self.seam(i, j).distance(self.seam(i, j + 1)), self.edge(i, j).distance(self.edge(i + 1, j))]
    }

    /// All cells, row by row.
    pub fn cells(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let [rows, columns] = self.size;
        (0..rows).flat_map(move |i| (0..columns).map(move |j| (i, j)))
    }
}

impl Context<'_> {
    /// Declares the cells of all sheets as bodies.
    pub(super) fn declare_sheets(&mut self) {
        let sidecar = self.sidecar;
        for (entry, given) in sidecar.sheet.iter().enumerate() {
            let at = format!("/sheet/{entry}");
            let taken = sidecar.sheet[..entry].iter().any(|other| other.name == given.name);
            self.unique(&given.name, taken, &format!("{at}/name"));
            if let Some(grid) = self.sheet_grid(entry, given, &at) {
                self.sheets.push(grid);
            }
        }
    }

    fn sheet_grid(&mut self, entry: usize, given: &Sheet, at: &str) -> Option<SheetGrid> {
        let place = format!("{at}/cells");
        let used_for = format!("sheet \"{}\"", given.name);
        let nodes = self.marker_nodes(None, &given.cells, &place, &used_for)?;
        let (rows, columns) = (nodes.len() / given.columns, given.columns);
        if rows * columns != nodes.len() {
            let message = format!("{} cells do not fill rows of {columns}", nodes.len());
            let problem =
                Diagnostic::new(codes::WRONG_SHAPE, message).label(format!("{} is not a multiple", nodes.len()));
            self.report(&format!("{at}/columns"), problem.help("write how many cells of the model lie side by side"));
            return None;
        }
        let first_body = self.body_nodes.len();
        let mut middles = Vec::new();
        for &node in &nodes {
            let name = &self.model.nodes[node].name;
            let pose = rigid(&self.model.nodes[node].world);
            if self.body_nodes.contains(&node) || pose.is_none() {
                let message = format!("node \"{name}\" is a body already, or is scaled unevenly");
                let problem = Diagnostic::new(codes::DUPLICATE_BODY, message);
                self.report(&place, problem.help("leave the cells of a sheet to [[sheet]], and apply their scale"));
                return None;
            }
            let pose = pose.unwrap_or(Pose::IDENTITY);
            middles.push(pose);
        }
        let corners = corners(&middles, rows, columns);
        self.body_nodes.extend(&nodes);
        self.poses.extend(&middles);
        self.starts.extend(&middles);
        Some(SheetGrid { entry, first_body, size: [rows, columns], corners })
    }

    /// The cells as bodies, in the order of their declaration.
    pub(super) fn sheet_bodies(&mut self) -> Vec<Body> {
        let sheets = std::mem::take(&mut self.sheets);
        let mut bodies = Vec::new();
        for grid in &sheets {
            let given = &self.sidecar.sheet[grid.entry];
            let at = format!("/sheet/{}", grid.entry);
            let of = format!("sheet {}", given.name);
            let material = self.material(&given.material, &format!("{at}/material")).unwrap_or(0);
            let thickness = self.positive(given.thickness.0, &format!("{at}/thickness"));
            let density = self.materials.get(material).map_or(1.0, |material| material.density);
            let mut mass = 0.0;
            for (i, j) in grid.cells() {
                let body = grid.body(i, j);
                let moments = self.cell(grid, i, j).sheet_moments(thickness, density);
                mass += moments.mass;
                if moments.mass <= 0.0 {
                    let message = format!("cell ({i}, {j}) of sheet \"{}\" has no area", given.name);
                    let problem = Diagnostic::new(codes::NO_MASS, message);
                    self.report(&format!("{at}/cells"), problem.help("its nodes must lie apart, row by row along x"));
                }
                bodies.push(Body {
                    name: self.model.nodes[self.body_nodes[body]].name.clone(),
                    node: self.body_nodes[body],
                    properties: MassProperties {
                        mass: moments.mass,
                        center: moments.center(),
                        inertia: moments.inertia(),
                    },
                    pose: self.starts[body],
                    velocity: DVec3::ZERO,
                    angular_velocity: DVec3::ZERO,
                    linear_damping: 0.0,
                    angular_damping: 0.0,
                    material,
                    moved_by: None,
                });
            }
            let [rows, columns] = grid.size;
            self.record_origin(&of, "cells", format!("{rows} rows of {columns}"), &format!("{at}/cells"), "");
            self.record_origin(&of, "mass", format!("{mass:.6} kg"), "/-", "derived: area × thickness × density");
        }
        self.sheets = sheets;
        bodies
    }

    /// The cells as wind surfaces.
    pub(super) fn sheet_surfaces(&self) -> Vec<Surface> {
        let surface = |grid: &SheetGrid, i: usize, j: usize| {
            let given = &self.sidecar.sheet[grid.entry];
            let body = grid.body(i, j);
            Surface {
                body,
                node: self.model.nodes[self.body_nodes[body]].name.clone(),
                shape: SurfaceShape::Mesh {
                    mesh: self.cell(grid, i, j),
                    per_area: 0.0,
                    count: SAMPLES..=SAMPLES,
                    sheet: true,
                    seed: body as u64,
                },
                drag_normal: given.drag.normal,
                drag_tangential: given.drag.tangential,
                gain: given.drag.gain,
            }
        };
        self.sheets.iter().flat_map(|grid| grid.cells().map(move |(i, j)| surface(grid, i, j))).collect()
    }

    /// The mesh of the cell at `node`, in its node frame; `None` where the node is no cell.
    pub(super) fn cell_at(&self, node: usize) -> Option<TriangleMesh> {
        let body = self.body_nodes.iter().position(|&cell| cell == node)?;
        self.sheets.iter().find_map(|grid| grid.place(body).map(|(i, j)| self.cell(grid, i, j)))
    }

    /// The mesh of a cell in its node frame.
    fn cell(&self, grid: &SheetGrid, i: usize, j: usize) -> TriangleMesh {
        let pose = self.pose_of(Some(grid.body(i, j)));
        let corners = [(i + 1, j), (i + 1, j + 1), (i, j + 1), (i, j)];
        let positions = corners.map(|(i, j)| pose.inverse_point(grid.corner(i, j))).to_vec();
        TriangleMesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]] }
    }
}

/// Corners of cells: half-way between the middles around them, beyond the outer ones as far as inside.
fn corners(middles: &[Pose], rows: usize, columns: usize) -> Vec<DVec3> {
    let middle = |i: usize, j: usize| middles[i * columns + j].position;
    // Along a row: at j − ½, extrapolated at its ends. A single column has the cell's own x axis for want of a neighbour.
    let across = |i: usize, j: usize| match (j, columns) {
        (_, 1) => {
            let down = if rows > 1 { (middle(1, 0) - middle(0, 0)).length() } else { 1.0 };
            middle(i, 0) + (j as f64 - 0.5) * down * (middles[i].rotation * DVec3::X)
        }
        (0, _) => 1.5 * middle(i, 0) - 0.5 * middle(i, 1),
        (j, n) if j == n => 1.5 * middle(i, n - 1) - 0.5 * middle(i, n - 2),
        (j, _) => 0.5 * (middle(i, j - 1) + middle(i, j)),
    };
    (0..=rows)
        .flat_map(|i| (0..=columns).map(move |j| (i, j)))
        .map(|(i, j)| match (i, rows) {
            (i, 1) => {
                let side = across(0, 1).distance(across(0, 0));
                across(0, j) + (0.5 - i as f64) * side * (middles[j.min(columns - 1)].rotation * DVec3::Y)
            }
            (0, _) => 1.5 * across(0, j) - 0.5 * across(1, j),
            (i, n) if i == n => 1.5 * across(n - 1, j) - 0.5 * across(n - 2, j),
            (i, _) => 0.5 * (across(i - 1, j) + across(i, j)),
        })
        .collect()
}
