//! Resolves wind surfaces and sounds, from the meshes and wires of the bodies.

use super::super::diagnostic::{Diagnostic, quoted, similar_names};
use super::super::sidecar::{self, Faces, Trigger};
use super::super::{Body, ImpactFrame, SoundBinding, SoundTrigger, Wire, codes, fit};
use super::context::Context;
use soffio_geometry::{Extents, TriangleMesh};
use soffio_math::db_to_amplitude;
use soffio_multibody::collision::Collider;
use soffio_sound::{InstrumentSpec, SoundBody, SoundMaterial, timbre};
use soffio_wind::{Surface, SurfaceShape};

/// Drag coefficient of a round wire in cross-flow, Reynolds 10² … 10⁵ (Hoerner, Fluid-Dynamic Drag, 3-9).
const WIRE_DRAG: f64 = 1.2;
/// Skin friction of a wire along its axis.
const WIRE_SKIN: f64 = 0.02;
/// A mesh counts as a sheet where its smallest extent is below this fraction of its second.
const SHEET: f64 = 0.1;
/// Default number of simultaneous impact sounds of a body.
const DEFAULT_VOICES: usize = 4;
/// Thickness of a sheet without a thickness in the model or the sidecar, m.
const NOMINAL_THICKNESS: f64 = 5e-4;

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

    /// Instruments and their triggers.
    pub(super) fn sounds(
        &mut self,
        bodies: &[Body],
        colliders: &[Collider],
        wires: &[Wire],
    ) -> (Vec<InstrumentSpec>, Vec<SoundBinding>) {
        let sidecar = self.sidecar;
        let (mut instruments, mut bindings): (Vec<InstrumentSpec>, Vec<SoundBinding>) = (Vec::new(), Vec::new());
        for (i, given) in sidecar.sound.iter().enumerate() {
            let at = format!("/sound/{i}");
            self.unique(&given.name, bindings.iter().any(|b| b.name == given.name), &format!("{at}/name"));
            if let Some((instrument, binding)) = self.sound(given, bodies, colliders, wires, instruments.len(), &at) {
                instruments.push(instrument);
                bindings.push(binding);
            }
        }
        (instruments, bindings)
    }

    fn sound(
        &mut self,
        given: &sidecar::Sound,
        bodies: &[Body],
        colliders: &[Collider],
        wires: &[Wire],
        instrument: usize,
        at: &str,
    ) -> Option<(InstrumentSpec, SoundBinding)> {
        let used_for = format!("sound \"{}\"", given.name);
        let body_node = self.node(&given.body, &format!("{at}/body"), &used_for)?;
        let Some(body) = self.owner[body_node] else {
            let message = format!("node \"{}\" is not a moving body", given.body);
            let problem = Diagnostic::new(codes::UNKNOWN_BODY, message).label("it cannot trigger a sound");
            self.report(&format!("{at}/body"), problem.help("make it a [[body]], or name the body that is hit"));
            return None;
        };
        let node = match &given.node {
            Some(name) => self.node_below(Some(body_node), name, &format!("{at}/node"), &used_for)?,
            None => body_node,
        };
        if given.on != Trigger::Wind && !colliders.iter().any(|c| c.body == Some(body)) {
            let message = format!("{used_for} waits for contacts of \"{}\", which has no collider", given.body);
            let help = format!("add [[collider]] node = \"{}\"", given.node.as_ref().unwrap_or(&given.body));
            self.report(&format!("{at}/body"), Diagnostic::new(codes::NO_COLLIDER, message).help(help));
        }
        self.check_timbre(given, at, &used_for);
        let wire = given.wire.as_ref().and_then(|name| self.sounding_wire(name, wires, at, &used_for));
        if given.caption.is_none() {
            let problem = Diagnostic::new(codes::NO_CAPTION, format!("{used_for} has no caption"));
            self.report(
                at,
                problem
                    .label("visitors who cannot hear it get no caption")
                    .help("add caption = \"key\" and label.*.caption.key"),
            );
        }
        let place = format!("{at}/{}", if given.node.is_some() { "node" } else { "body" });
        let mesh = self.mesh_of(node, &place, &used_for)?;
        let extents = mesh.extents()?;
        // A body of an unknown material was reported; there may be none at all.
        let material = self.materials.get(self.part_material(body, node).unwrap_or(bodies.get(body)?.material))?;
        let sound_material = SoundMaterial {
            youngs_modulus: material.youngs_modulus,
            poisson: material.poisson,
            density: material.density,
            loss_factor: material.loss_factor,
        };
        let own_mass = (given.node.is_none()).then(|| bodies[body].properties.mass);
        let size = sound_body(given.params, &mesh, &extents, own_mass, material.density);
        self.record_size_origins(&size, at, &used_for);
        self.record_origin(&used_for, "timbre", given.timbre.clone(), &format!("{at}/timbre"), "");
        self.record_origin(&used_for, "gain", format!("{} dB", given.gain.0), &format!("{at}/gain"), "default");
        let spec = InstrumentSpec {
            timbre: given.timbre.clone(),
            body: size,
            material: sound_material,
            // Only sliding contacts read it.
            surface: (given.on == Trigger::Slide).then(|| self.surface_line(node)).flatten(),
            gain: db_to_amplitude(given.gain.0 + self.sidecar.scene.level.0),
            max_voices: given.max_voices.unwrap_or(DEFAULT_VOICES),
        };
        let frame = ImpactFrame { longest: extents.axes.x_axis, middle: extents.axes.y_axis, center: extents.center };
        Some((
            spec,
            SoundBinding {
                name: given.name.clone(),
                body,
                on: trigger(given.on),
                instrument,
                frame,
                wire,
                caption: given.caption.clone(),
            },
        ))
    }

    /// Checks the size of a sounding body and records its source.
    fn record_size_origins(&mut self, size: &SoundBody, at: &str, used_for: &str) {
        for (key, value) in
            [("half_length", size.half_extents[0]), ("half_width", size.half_extents[1]), ("thickness", size.thickness)]
        {
            let place = format!("{at}/params/{key}");
            self.positive(value, &place);
            self.record_origin(used_for, key, format!("{:.3} mm", value * 1e3), &place, "derived: mesh");
        }
    }

    /// Index of the wire that a sound names.
    fn sounding_wire(&mut self, name: &str, wires: &[Wire], at: &str, used_for: &str) -> Option<usize> {
        let found = wires.iter().position(|wire| wire.name == name);
        if found.is_none() {
            let likely = similar_names(name, wires.iter().map(|wire| wire.name.as_str()));
            let help = match likely.as_slice() {
                [] => "give the name of a [[wire]]".to_owned(),
                names => format!("did you mean {}?", quoted(names)),
            };
            let problem = Diagnostic::new(codes::UNKNOWN_WIRE, format!("no wire named \"{name}\""));
            self.report(&format!("{at}/wire"), problem.label(format!("used for {used_for}")).help(help));
        }
        found
    }

    /// Reports an unknown timbre, or one that the trigger does not play.
    fn check_timbre(&mut self, given: &sidecar::Sound, at: &str, used_for: &str) {
        let (name, at) = (given.timbre.as_str(), &format!("{at}/timbre"));
        if let Ok(preset) = timbre::Preset::shipped(name) {
            let player = match (preset.continuous(), preset.slides()) {
                (false, _) => Trigger::Impact,
                (true, false) => Trigger::Wind,
                (true, true) => Trigger::Slide,
            };
            if player != given.on {
                let word = |trigger| match trigger {
                    Trigger::Impact => "impact",
                    Trigger::Slide => "slide",
                    Trigger::Wind => "wind",
                };
                let message = format!("timbre \"{name}\" is not played by on = \"{}\"", word(given.on));
                let help = format!("it sounds on = \"{}\"; `soffio sound --list` names all timbres", word(player));
                self.report(at, Diagnostic::new(codes::UNPLAYED, message).label(used_for).help(help));
            }
            return;
        }
        let likely = similar_names(name, timbre::names());
        let help = match likely.as_slice() {
            [] => format!("there are {}", quoted(&timbre::names().collect::<Vec<_>>())),
            names => format!("did you mean {}? `soffio sound --list` names them all", quoted(names)),
        };
        let problem = Diagnostic::new(codes::UNKNOWN_TIMBRE, format!("no timbre named \"{name}\""));
        self.report(at, problem.label(format!("used for {used_for}")).help(help));
    }

    /// Material of the `[[body.part]]` that a node belongs to; `None` where it is the body's own.
    fn part_material(&self, body: usize, node: usize) -> Option<usize> {
        let declared = self.sidecar.body.iter().find(|d| self.nodes_named(&d.node).contains(&self.body_nodes[body]))?;
        let part =
            declared.part.iter().find(|part| self.nodes_named(&part.node).iter().any(|&p| self.is_below(node, p)))?;
        self.materials.iter().position(|m| m.name == part.material)
    }
}

/// The trigger of a sidecar's `on`.
fn trigger(given: Trigger) -> SoundTrigger {
    match given {
        Trigger::Impact => SoundTrigger::Impact,
        Trigger::Slide => SoundTrigger::Slide,
        Trigger::Wind => SoundTrigger::Wind,
    }
}

/// Size and mass of a sounding body: those of the mesh where the sidecar gives none. `own_mass` is that of the whole
/// body, kg, where it sounds as a whole; a part has the mass of its own material.
fn sound_body(
    params: sidecar::SoundParams,
    mesh: &TriangleMesh,
    extents: &Extents,
    own_mass: Option<f64>,
    density: f64,
) -> SoundBody {
    let closed = mesh.is_closed();
    let measured = if extents.half.z > 0.0 { 2.0 * extents.half.z } else { NOMINAL_THICKNESS };
    let thickness = params.thickness.map_or(measured, |t| t.0);
    let volume = if closed { mesh.volume() } else { mesh.area() * thickness };
    SoundBody {
        half_extents: [
            params.half_length.map_or(extents.half.x, |l| l.0),
            params.half_width.map_or(extents.half.y, |l| l.0),
        ],
        thickness,
        area: if closed { volume / measured } else { mesh.area() },
        mass: own_mass.unwrap_or(volume * density),
    }
}
