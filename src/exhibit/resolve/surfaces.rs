//! Resolves wind surfaces, from the meshes and wires of the bodies.

use super::super::diagnostic::Diagnostic;
use super::super::sidecar::{self, Faces};
use super::super::{Wire, codes, fit};
use super::context::Context;
use soffio_geometry::{Extents, TriangleMesh};
use soffio_wind::{Surface, SurfaceShape};

/// Drag coefficient of a round wire in cross-flow, Reynolds 10² … 10⁵ (Hoerner, Fluid-Dynamic Drag, 3-9).
const WIRE_DRAG: f64 = 1.2;
/// Skin friction of a wire along its axis.
const WIRE_SKIN: f64 = 0.02;
/// A mesh counts as a sheet where its smallest extent is below this fraction of its second.
const SHEET: f64 = 0.1;
fn is_sheet(mesh: &TriangleMesh, extents: &Extents) -> bool {
    extents.half.z < SHEET * extents.half.y || !mesh.is_closed()
}

impl Context<'_> {
    /// Wind surfaces of meshes, then of wires.
    pub(super) fn wind_surfaces(&mut self, wires: &[Wire]) -> Vec<Surface> {
        let sidecar = self.sidecar;
        let mut out: Vec<Surface> = Vec::new();
        for (i, given) in sidecar.wind_surface.iter().enumerate() {
            out.extend(self.wind_surface(given, &format!("/wind_surface/{i}")));
        }
        out.extend(self.sheet_surfaces());
        for wire in wires {
            let feels = sidecar.wire.iter().any(|given| given.name == wire.name && given.wind);
            if let (Some(body), true) = (wire.body, feels) {
                out.push(Surface {
                    body,
                    node: wire.name.clone(),
                    shape: SurfaceShape::Wire { points: wire.points.clone(), radius: wire.radius },
                    drag_normal: WIRE_DRAG,
                    drag_tangential: WIRE_SKIN,
                    gain: 1.0,
                });
            }
        }
        out
    }

    fn wind_surface(&mut self, given: &sidecar::WindSurface, at: &str) -> Option<Surface> {
        let place = format!("{at}/node");
        let node = self.node(&given.node, &place, "a wind surface")?;
        let Some(body) = self.owner[node] else {
            let message = format!("node \"{}\" belongs to no body: wind does not move it", given.node);
            self.report(
                &place,
                Diagnostic::new(codes::UNKNOWN_BODY, message).help("make it a [[body]], or leave this table out"),
            );
            return None;
        };
        if given.sampling.min > given.sampling.max || given.sampling.per_area.0 <= 0.0 {
            let message = "sampling needs min ≤ max and a density above zero";
            let problem = Diagnostic::new(codes::RANGE, message);
            self.report(
                &format!("{at}/sampling"),
                problem.help("such as { per_area = \"400 /m2\", min = 16, max = 64 }"),
            );
        }
        let mesh = self.mesh_of(node, &place, "a wind surface")?;
        let extents = mesh.extents()?;
        let sheet = given.faces.map_or_else(|| is_sheet(&mesh, &extents), |faces| faces == Faces::Both);
        // A closed plate is one surface with two sides, represented by one of its faces.
        let mesh = if sheet && mesh.is_closed() { fit::one_side(&mesh, extents.axes.z_axis) } else { mesh };
        let of = format!("wind surface {}", given.node);
        let area = format!("{:.6} m²{}", mesh.area(), if sheet { ", both sides" } else { "" });
        self.record_origin(&of, "area", area, "/-", "derived: mesh");
        self.record_origin(
            &of,
            "drag.normal",
            given.drag.normal.to_string(),
            &format!("{at}/drag/normal"),
            "default: flat plate",
        );
        self.record_origin(
            &of,
            "drag.tangential",
            given.drag.tangential.to_string(),
            &format!("{at}/drag/tangential"),
            "default",
        );
        Some(Surface {
            body,
            node: given.node.clone(),
            shape: SurfaceShape::Mesh {
                mesh,
                per_area: given.sampling.per_area.0,
                count: given.sampling.min..=given.sampling.max,
                sheet,
                seed: given.sampling.seed,
            },
            drag_normal: given.drag.normal,
            drag_tangential: given.drag.tangential,
            gain: given.drag.gain,
        })
    }
}
