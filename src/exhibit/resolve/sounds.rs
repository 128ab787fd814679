//! Resolves sounds: instruments, what plays them, and what their timbres follow.

use std::sync::Arc;

use super::super::diagnostic::{Diagnostic, quoted, similar_names};
use super::super::own_timbres::FOLDER;
use super::super::sidecar::{self, AirOf, Trigger};
use super::super::{AirAt, Body, Follows, ForceOf, ImpactFrame, SoundBinding, SoundTrigger, Wire, codes};
use super::context::Context;
use soffio_geometry::{Extents, TriangleMesh};
use soffio_math::db_to_amplitude;
use soffio_multibody::articulation::{Constraint, Spring};
use soffio_multibody::collision::Collider;
use soffio_sound::timbre::{self, Input};
use soffio_sound::{InstrumentSpec, Preset, SoundBody, SoundMaterial, SoundSurface};
use soffio_wind::Surface;

/// Default number of simultaneous impact sounds of a body.
const DEFAULT_VOICES: usize = 4;
/// Thickness of a sheet without a thickness in the model or the sidecar, m.
const NOMINAL_THICKNESS: f64 = 5e-4;

/// All that sounds can refer to.
pub(super) struct Sounding<'a> {
    pub bodies: &'a [Body],
    pub colliders: &'a [Collider],
    pub wires: &'a [Wire],
    pub wind_surfaces: &'a [Surface],
    pub constraints: &'a [Constraint],
    pub springs: &'a [Spring],
}

/// The timbre of a sound.
struct Timbre {
    preset: Arc<Preset>,
    /// Is it of the exhibit's own folder?
    own: bool,
}

impl Context<'_> {
    /// Instruments and their triggers.
    pub(super) fn sounds(&mut self, sounding: &Sounding) -> (Vec<InstrumentSpec>, Vec<SoundBinding>) {
        let sidecar = self.sidecar;
        let (mut instruments, mut bindings): (Vec<InstrumentSpec>, Vec<SoundBinding>) = (Vec::new(), Vec::new());
        for (i, given) in sidecar.sound.iter().enumerate() {
            let at = format!("/sound/{i}");
            self.unique(&given.name, bindings.iter().any(|b| b.name == given.name), &format!("{at}/name"));
            if let Some((instrument, binding)) = self.sound(given, sounding, instruments.len(), &at) {
                instruments.push(instrument);
                bindings.push(binding);
            }
        }
        (instruments, bindings)
    }

    fn sound(
        &mut self,
        given: &sidecar::Sound,
        sounding: &Sounding,
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
        let touched = matches!(given.on, Trigger::Impact | Trigger::Slide);
        if touched && !sounding.colliders.iter().any(|c| c.body == Some(body)) {
            let message = format!("{used_for} waits for contacts of \"{}\", which has no collider", given.body);
            let help = format!("add [[collider]] node = \"{}\"", given.node.as_ref().unwrap_or(&given.body));
            self.report(&format!("{at}/body"), Diagnostic::new(codes::NO_COLLIDER, message).help(help));
        }
        let timbre = self.timbre(given, at, &used_for);
        let follows = self.follows(given, timbre.as_ref(), body, sounding, at, &used_for);
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
        let material =
            self.materials.get(self.part_material(body, node).unwrap_or(sounding.bodies.get(body)?.material))?;
        let sound_material = SoundMaterial {
            youngs_modulus: material.youngs_modulus,
            poisson: material.poisson,
            density: material.density,
            loss_factor: material.loss_factor,
        };
        let own_mass = (given.node.is_none()).then(|| sounding.bodies[body].properties.mass);
        let size = sound_body(given.params, &mesh, &extents, own_mass, material.density);
        self.record_size_origins(&size, at, &used_for);
        self.record_origin(&used_for, "timbre", given.timbre.clone(), &format!("{at}/timbre"), "");
        self.record_origin(&used_for, "gain", format!("{} dB", given.gain.0), &format!("{at}/gain"), "default");
        let frame = ImpactFrame { longest: extents.axes.x_axis, middle: extents.axes.y_axis, center: extents.center };
        let rings = timbre.as_ref().is_some_and(|timbre| timbre.preset.rings());
        let spec = InstrumentSpec {
            timbre: timbre.as_ref().map_or_else(|| given.timbre.clone(), |timbre| timbre.preset.name.clone()),
            own: timbre.filter(|timbre| timbre.own).map(|timbre| timbre.preset),
            body: size,
            material: sound_material,
            // Only sliding contacts read it.
            surface: (given.on == Trigger::Slide)
                .then(|| self.surface_relief(node, &frame, size.half_extents, at))
                .flatten()
                .map(|relief| SoundSurface::Relief(Arc::new(relief))),
            gain: db_to_amplitude(given.gain.0 + self.sidecar.scene.level.0),
            max_voices: given.max_voices.unwrap_or(DEFAULT_VOICES),
        };
        if spec.own.is_some()
            && let Err(error) = spec.check()
        {
            let problem = self.own_timbres.problem(&spec.timbre, &error);
            self.problems.push(problem.label(format!("{used_for} cannot play it")));
        }
        let on = trigger(given.on);
        let is_struck = on == SoundTrigger::Impact || (on == SoundTrigger::Motion && rings);
        let (name, caption) = (given.name.clone(), given.caption.clone());
        Some((spec, SoundBinding { name, body, on, is_struck, instrument, frame, follows, caption }))
    }

    /// What the timbre follows beside contacts, and whether the sound names it.
    fn follows(
        &mut self,
        given: &sidecar::Sound,
        timbre: Option<&Timbre>,
        body: usize,
        sounding: &Sounding,
        at: &str,
        used_for: &str,
    ) -> Follows {
        let wire = given.wire.as_ref().and_then(|name| self.sounding_wire(name, sounding.wires, at, used_for));
        let force = given.force_of.as_ref().and_then(|name| self.force_of(name, sounding, at, used_for));
        let parameter = given.parameter.as_ref().map(|number| self.function(number, &format!("{at}/parameter")));
        let Some(Timbre { preset, .. }) = timbre else { return Follows::default() };
        for (input, wanted) in [(Input::JointForce, "constraint"), (Input::Tension, "spring")] {
            let fits = match force {
                None => given.force_of.is_some(),
                Some(ForceOf::Constraint(_)) => wanted == "constraint",
                Some(ForceOf::Spring(_)) => wanted == "spring",
            };
            if preset.follows_input(input) && !fits {
                let message =
                    format!("the timbre of {used_for} follows the force of a {wanted}, which the sound does not name");
                let help = format!("add force_of = \"NAME\", the name of a {wanted}");
                self.report(&format!("{at}/force_of"), Diagnostic::new(codes::NO_FORCE, message).help(help));
            }
        }
        let idle = |key: &str, of: &str| {
            let problem = Diagnostic::new(codes::UNUSED, format!("{key} of {used_for} has no effect"));
            problem
                .help(format!("its timbre follows no {of}; leave {key} out, or let a number of the timbre follow it"))
        };
        if given.force_of.is_some() && ![Input::JointForce, Input::Tension].iter().any(|i| preset.follows_input(*i)) {
            self.report(&format!("{at}/force_of"), idle("force_of", "`joint_force` or `tension`"));
        }
        if given.parameter.is_some() && !preset.follows_input(Input::Parameter) {
            self.report(&format!("{at}/parameter"), idle("parameter", "`parameter`"));
        }
        let whole = given.air == AirOf::Exhibit;
        let surfaces = sounding.wind_surfaces.iter().enumerate().filter(|(_, surface)| whole || surface.body == body);
        let air = wire.map_or_else(|| AirAt::Surfaces(surfaces.map(|(i, _)| i).collect()), AirAt::Wire);
        Follows {
            air: preset.follows_wind().then_some(air),
            motion: preset.follows_motion(),
            force,
            parameter: parameter.unwrap_or_default(),
        }
    }

    /// The constraint or spring of a name.
    fn force_of(&mut self, name: &str, sounding: &Sounding, at: &str, used_for: &str) -> Option<ForceOf> {
        let constraint = sounding.constraints.iter().position(|c| c.name == name || c.group() == name);
        let spring = || sounding.springs.iter().position(|spring| spring.name == name);
        let found = constraint.map(ForceOf::Constraint).or_else(|| spring().map(ForceOf::Spring));
        if found.is_none() {
            let springs = sounding.springs.iter().map(|spring| spring.name.as_str());
            let likely = similar_names(name, sounding.constraints.iter().map(Constraint::group).chain(springs));
            let help = match likely.as_slice() {
                [] => "give the name of a constraint or spring".to_owned(),
                names => format!("did you mean {}?", quoted(names)),
            };
            let problem =
                Diagnostic::new(codes::UNKNOWN_CONSTRAINT, format!("no constraint or spring named \"{name}\""));
            self.report(&format!("{at}/force_of"), problem.label(format!("used for {used_for}")).help(help));
        }
        found
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

    /// The timbre of a sound. Reports an unknown one, or one that the trigger does not play.
    fn timbre(&mut self, given: &sidecar::Sound, at: &str, used_for: &str) -> Option<Timbre> {
        let at = &format!("{at}/timbre");
        let path = given.timbre.strip_prefix(FOLDER).and_then(|rest| rest.strip_prefix('/')).unwrap_or(&given.timbre);
        let name = path.strip_suffix(".toml").unwrap_or(path);
        let own = self.own_timbres;
        if own.has(name) {
            let preset = own.preset(name)?;
            self.check_player(&preset, given.on, at, used_for);
            return Some(Timbre { preset, own: true });
        }
        if let Ok(preset) = Preset::shipped(name).map(Arc::new) {
            self.check_player(&preset, given.on, at, used_for);
            return Some(Timbre { preset, own: false });
        }
        let mut all: Vec<&str> = own.names().collect();
        timbre::names().for_each(|name| all.push(name));
        let likely = similar_names(name, all.iter().copied());
        let help = match likely.as_slice() {
            [] => format!(
                "there are {}; a file {FOLDER}/{name}.toml in the exhibit's folder would be another",
                quoted(&all)
            ),
            names => format!("did you mean {}? `soffio sound --list` names the shipped ones", quoted(names)),
        };
        let problem = Diagnostic::new(codes::UNKNOWN_TIMBRE, format!("no timbre named \"{name}\""));
        self.report(at, problem.label(format!("used for {used_for}")).help(help));
        None
    }

    /// Reports a timbre that the trigger does not play.
    fn check_player(&mut self, preset: &Preset, on: Trigger, at: &str, used_for: &str) {
        let player = match (preset.continuous(), preset.slides(), preset.moves()) {
            (false, ..) => Trigger::Impact,
            (_, true, _) => Trigger::Slide,
            (.., true) => Trigger::Motion,
            _ => Trigger::Wind,
        };
        if player != on && !(on == Trigger::Impact && preset.rings()) {
            let word = |trigger| match trigger {
                Trigger::Impact => "impact",
                Trigger::Slide => "slide",
                Trigger::Wind => "wind",
                Trigger::Motion => "motion",
            };
            let message = format!("timbre \"{}\" is not played by on = \"{}\"", preset.name, word(on));
            let help = format!("it sounds on = \"{}\"; `soffio sound --list` names all shipped timbres", word(player));
            self.report(at, Diagnostic::new(codes::UNPLAYED, message).label(used_for).help(help));
        }
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
        Trigger::Motion => SoundTrigger::Motion,
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
