//! Resolves the winds of an exhibit and its shelters.

use super::super::codes;
use super::super::diagnostic::Diagnostic;
use super::super::sidecar::{self, Gusts, Point};
use super::super::{BreathTuning, IdleDampingSpec};
use super::context::Context;
use soffio_geometry::TriangleMesh;
use soffio_math::DVec3;
use soffio_math::Function;
use soffio_wind::ambient::{Inlet, Modulation, Wind, WindKind};
use soffio_wind::breath::SpreadLaw;
use soffio_wind::{Shelter, Surface};

/// Default size (m) and period (s) of the largest eddies of ambient turbulence.
const AMBIENT_SCALE: f64 = 0.6;
const AMBIENT_PERIOD: f64 = 6.0;
/// Distances of a cone's vertex behind the lips, m: from nearly all directions to a beam.
const VERTEX_DISTANCES: std::ops::RangeInclusive<f64> = 1e-3..=10.0;
/// Name of the ambient turbulence among the winds.
const AMBIENT: &str = "room";

impl Context<'_> {
    /// How a breath acts on the exhibit.
    pub(super) fn breath_tuning(&mut self) -> BreathTuning {
        let given = self.sidecar.wind.breath;
        let vertex_distance = given.vertex_distance.and_then(|distance| self.vertex_distance(given.law, distance.0));
        let law = match given.law {
            sidecar::Law::Cone => SpreadLaw::Cone { vertex_distance },
            sidecar::Law::Jet => SpreadLaw::Jet,
        };
        let place = "/wind/breath/lip_diameter";
        let lip_diameter = given.lip_diameter.map(|d| self.positive(d.0, place));
        self.record_origin("breath", "law", format!("{:?}", given.law), "/wind/breath/law", "default");
        self.record_origin("breath", "gain", given.gain.to_string(), "/wind/breath/gain", "default");
        if let Some(d) = lip_diameter {
            self.record_origin("breath", "lip_diameter", format!("{} mm", d * 1e3), place, "");
        }
        self.record_origin("breath", "turbulence", given.turbulence.to_string(), "/wind/breath/turbulence", "default");
        BreathTuning { law, gain: given.gain, lip_diameter, turbulence: given.turbulence }
    }

    /// l₀ of a cone, m; `None` where it was refused.
    fn vertex_distance(&mut self, law: sidecar::Law, distance: f64) -> Option<f64> {
        let place = "/wind/breath/vertex_distance";
        if law == sidecar::Law::Jet {
            let problem =
                Diagnostic::new(codes::RANGE, "a jet has no vertex_distance: its spread follows from turbulence");
            self.report(place, problem.help("write law = \"cone\" beside it, or leave it out"));
            return None;
        }
        if !VERTEX_DISTANCES.contains(&distance) {
            let problem = Diagnostic::new(codes::RANGE, format!("a vertex_distance of {distance} m is out of range"));
            self.report(place, problem.help("give a length from 1 mm to 10 m; 24 mm is usual"));
            return None;
        }
        self.record_origin("breath", "vertex_distance", format!("{} mm", distance * 1e3), place, "");
        Some(distance)
    }

    /// Idle damping.
    pub(super) fn calm(&mut self) -> Option<IdleDampingSpec> {
        let given = self.sidecar.wind.idle_damping?;
        let after = self.not_negative(given.after.0, "/wind/idle_damping/after");
        let time = self.positive(given.time.0, "/wind/idle_damping/time");
        self.record_origin("idle damping", "after", format!("{after} s"), "/wind/idle_damping/after", "");
        self.record_origin("idle damping", "time", format!("{time} s"), "/wind/idle_damping/time", "");
        Some(IdleDampingSpec { after, time })
    }

    /// Ambient turbulence, fans, draughts and gusts.
    pub(super) fn winds(&mut self) -> Vec<Wind> {
        let sidecar = self.sidecar;
        let mut winds: Vec<Wind> = Vec::new();
        if let Some(ambient) = &sidecar.wind.ambient {
            winds.push(self.ambient_turbulence(ambient, "/wind/ambient"));
        }
        for (i, fan) in sidecar.wind.fan.iter().enumerate() {
            let at = format!("/wind/fan/{i}");
            self.unique_wind(&fan.name, &winds, &at);
            winds.extend(self.fan(fan, &at));
        }
        for (i, draught) in sidecar.wind.draught.iter().enumerate() {
            let at = format!("/wind/draught/{i}");
            self.unique_wind(&draught.name, &winds, &at);
            winds.extend(self.draught(draught, &at));
        }
        for (i, gust) in sidecar.wind.gust.iter().enumerate() {
            let at = format!("/wind/gust/{i}");
            self.unique_wind(&gust.name, &winds, &at);
            winds.extend(self.gust(gust, &at));
        }
        winds
    }

    fn unique_wind(&mut self, name: &str, winds: &[Wind], at: &str) {
        self.unique(name, name == AMBIENT || winds.iter().any(|wind| wind.name == name), &format!("{at}/name"));
    }

    fn ambient_turbulence(&mut self, given: &sidecar::AmbientTurbulence, at: &str) -> Wind {
        let scale = given.scale.map_or(AMBIENT_SCALE, |l| self.positive(l.0, &format!("{at}/scale")));
        let period = given.period.map_or(AMBIENT_PERIOD, |t| self.positive(t.0, &format!("{at}/period")));
        self.record_origin("ambient turbulence", "scale", format!("{scale} m"), &format!("{at}/scale"), "default");
        self.record_origin("ambient turbulence", "period", format!("{period} s"), &format!("{at}/period"), "default");
        let kind = WindKind::Turbulence { scale, period, seed: given.seed };
        Wind {
            name: AMBIENT.into(),
            kind,
            speed: self.wind_speed(&given.speed, at, "room"),
            modulation: Modulation::Steady,
        }
    }

    fn fan(&mut self, given: &sidecar::Fan, at: &str) -> Option<Wind> {
        let used_for = format!("fan \"{}\"", given.name);
        let place = self.fixed_point(&given.at, &format!("{at}/at"), &used_for);
        let direction = self.unit(DVec3::from(given.direction), &format!("{at}/direction"));
        let diameter = self.positive(given.diameter.0, &format!("{at}/diameter"));
        let speed = self.wind_speed(&given.speed, at, &given.name);
        let rhythm = self.gusts(given.gusts, at);
        let kind = WindKind::Fan { at: place?, direction: direction?, diameter };
        Some(Wind { name: given.name.clone(), kind, speed, modulation: rhythm })
    }

    fn draught(&mut self, given: &sidecar::Draught, at: &str) -> Option<Wind> {
        let used_for = format!("draught \"{}\"", given.name);
        let kind = self.one_way(given.direction, given.at.as_ref(), given.width.map(|w| w.0), at, &used_for);
        let speed = self.wind_speed(&given.speed, at, &given.name);
        let rhythm = self.gusts(given.gusts, at);
        Some(Wind { name: given.name.clone(), kind: kind?, speed, modulation: rhythm })
    }

    fn gust(&mut self, given: &sidecar::Gust, at: &str) -> Option<Wind> {
        let used_for = format!("gust \"{}\"", given.name);
        let kind = self.one_way(given.direction, given.at.as_ref(), given.width.map(|w| w.0), at, &used_for);
        let speed = self.wind_speed(&given.speed, at, &given.name);
        let every = self.positive(given.every.0, &format!("{at}/every"));
        let lasts = self.positive(given.lasts.0, &format!("{at}/lasts"));
        if lasts > every {
            let message = format!("{used_for} lasts {lasts} s and comes every {every} s");
            let problem = Diagnostic::new(codes::RANGE, message).help("gusts must not overlap: lasts ≤ every");
            self.report(&format!("{at}/lasts"), problem);
        }
        let rhythm = Modulation::Puffs { interval: every, duration: lasts, seed: given.seed };
        Some(Wind { name: given.name.clone(), kind: kind?, speed, modulation: rhythm })
    }

    /// A wind in one direction: everywhere, or of some width around a point.
    fn one_way(
        &mut self,
        direction: [f64; 3],
        place: Option<&Point>,
        width: Option<f64>,
        at: &str,
        used_for: &str,
    ) -> Option<WindKind> {
        let direction = self.unit(DVec3::from(direction), &format!("{at}/direction"));
        let inlet = match (place, width) {
            (None, None) => Some(None),
            (Some(place), Some(width)) => {
                let width = self.positive(width, &format!("{at}/width"));
                self.fixed_point(place, &format!("{at}/at"), used_for).map(|center| Some(Inlet { center, width }))
            }
            _ => {
                let message = format!("{used_for} needs both a place and a width, or neither");
                let help = "add at = [x, y, z] and width = \"0.5 m\", or leave both out: it is then everywhere";
                self.report(at, Diagnostic::new(codes::MISSING_KEY, message).help(help));
                None
            }
        };
        Some(WindKind::Draught { direction: direction?, inlet: inlet? })
    }

    fn wind_speed(
        &mut self,
        given: &sidecar::Function<super::super::quantity::Speed>,
        at: &str,
        name: &str,
    ) -> Function {
        let place = format!("{at}/speed");
        let speed = self.function_from_zero(given, &place);
        if let Function::Constant(speed) = speed {
            self.record_origin(&format!("wind {name}"), "speed", format!("{speed} m/s"), &place, "");
        }
        speed
    }

    fn gusts(&mut self, given: Option<Gusts>, at: &str) -> Modulation {
        given.map_or(Modulation::Steady, |gusts| Modulation::Gusty {
            strength: gusts.strength,
            period: self.positive(gusts.period.0, &format!("{at}/gusts/period")),
            seed: gusts.seed,
        })
    }

    /// Shelters from the wind, one for each body: wind surfaces as sampled, all other meshes as they are.
    pub(super) fn shelters(&mut self, surfaces: &[Surface]) -> Vec<Shelter> {
        let sidecar = self.sidecar;
        let mut taken: Vec<bool> = vec![false; self.model.nodes.len()];
        for (i, name) in sidecar.wind.open.iter().enumerate() {
            if let Some(root) = self.node(name, &format!("/wind/open/{i}"), "a node that lets the wind through") {
                for node in 0..taken.len() {
                    taken[node] |= self.is_below(node, root);
                }
            }
        }
        let opened = taken.clone();
        let mut shelters = Vec::new();
        for given in &sidecar.wind_surface {
            let Some(&root) = self.nodes_named(&given.node).first() else { continue };
            for node in self.subtree(root, &[]) {
                taken[node] = true;
            }
            let own = surfaces.iter().filter(|surface| surface.node == given.node && given.shadow && !opened[root]);
            shelters.extend(Shelter::of(own.cloned().collect::<Vec<_>>().as_slice()));
        }
        // A skin lies where its joints carry it; the surfaces of those bodies give shelter.
        for skin in &self.model.skins {
            taken[skin.node] |= skin.joints.iter().any(|&joint| self.owner[joint].is_some());
        }
        for owner in std::iter::once(None).chain((0..self.body_nodes.len()).map(Some)) {
            let mut mesh = TriangleMesh::default();
            for node in 0..taken.len() {
                if self.owner[node] == owner
                    && !taken[node]
                    && let Some(own) = self.node_mesh(node)
                {
                    mesh.append(&own);
                }
            }
            if !mesh.triangles.is_empty() {
                shelters.push(Shelter { body: owner, mesh });
            }
        }
        shelters
    }
}
