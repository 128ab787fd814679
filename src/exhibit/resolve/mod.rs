//! Resolves sidecar and model to a valid [`Exhibit`]: each stage turns names into indices and reports problems.
//!
//! A stage does not stop at its first problem. Values that cannot be resolved are left out and reported, so an exhibit
//! is returned only without errors. Stages in order: materials, bodies, wires, cords, masses, joints, colliders, wind and
//! sound, texts, finishes.

mod bodies;
mod charts;
mod clock;
mod colliders;
mod context;
mod cords;
mod finishes;
mod joints;
mod kinds;
mod lights;
mod materials;
mod motion;
mod nail_paths;
mod nodes;
mod picture;
mod sheets;
mod signals;
mod sounds;
mod surfaces;
mod texts;
mod winds;
mod wires;

use std::path::{Path, PathBuf};

use super::behavior::{BreathTuning, Motion, TouchPermission};
use super::bodies::Body;
use super::budget::Budget;
use super::diagnostic::{Diagnostic, Report, quoted};
use super::exhibit::Exhibit;
use super::finish::{Choice, dress};
use super::light::LightRig;
use super::model::{Imported, Model, import, import_within};
use super::own_timbres::OwnTimbres;
use super::paths::SIDECAR;
use super::presentation::{Attract, Credit, Labels};
use super::shape_tracks::shapes;
use super::sidecar::{self, Sidecar};
use super::source::SidecarText;
use super::{codes, files, paths, schema, thumbnail};
use context::Context;
use kinds::Joined;
use nail_paths::add_path_nodes;
use soffio_math::DVec3;
use soffio_multibody::articulation::{Constraint, Spring};
use soffio_multibody::dynamics::{Integrator, Solver};
use soffio_multibody::procedural::PositionSolver;
use sounds::Sounding;

/// Memory of a parsed sidecar over its size: keys and numbers with their places.
const PARSED: u64 = 200;
/// Format version that this program reads.
const VERSION: &str = "exhibit/1";
/// Default gravity, m/s².
const GRAVITY: DVec3 = DVec3::new(0.0, -9.81, 0.0);

/// Loads and validates the exhibit in `folder`.
///
/// # Errors
/// All problems at once.
pub fn load(folder: &Path) -> Result<Exhibit, Report> {
    load_within(folder, &Budget::default())
}

/// As [`load`], within a budget.
///
/// # Errors
/// All problems at once.
pub fn load_within(folder: &Path, budget: &Budget) -> Result<Exhibit, Report> {
    let bytes = files::read_sidecar(folder).map_err(Report::single)?;
    let file = folder.join(SIDECAR).display().to_string();
    budget.charge(PARSED * bytes.len() as u64).map_err(|excess| Report::single(excess.diagnostic(&file)))?;
    let text = String::from_utf8(bytes).map_err(|error| {
        Report::single(Diagnostic::new(codes::SYNTAX, format!("{file} is not UTF-8: {error}")).help("save it as UTF-8"))
    })?;
    let alone = |diagnostics| Report::in_file(&file, text.as_str().into(), diagnostics);
    let source = SidecarText::parse(&file, &text).map_err(|problem| alone(vec![problem]))?;
    let sidecar = typed(&source).map_err(&alone)?;
    let placed = |mut problem: Diagnostic| {
        problem.location.get_or_insert_with(|| source.locate(source.span("/model")));
        problem
    };
    let model_path = paths::inside(folder, &sidecar.model).map_err(|problem| alone(vec![placed(problem)]))?;
    let Imported { mut model, warnings, .. } = import_within(&model_path, budget)
        .map_err(|report| alone(report.diagnostics.into_iter().map(placed).collect()))?;
    add_path_nodes(&mut model, &sidecar);
    let own = OwnTimbres::read(folder, budget);
    let mut context = Context::new(&source, &sidecar, &model, folder, &own, budget);
    context.problems.extend(thumbnail::check(folder, budget).err());
    context.problems.extend(warnings.into_iter().map(placed));
    context.problems.extend(source.old_names());
    let exhibit = context.resolve();
    if !context.problems.iter().any(|problem| problem.code == codes::BUDGET.name) {
        context.problems.extend(budget.check_time().err().map(|excess| excess.diagnostic(&file)));
    }
    let mut report = alone(std::mem::take(&mut context.problems));
    report.absorb(own.into_report());
    if report.has_errors() {
        return Err(report);
    }
    Ok(Exhibit { warnings: report.diagnostics, ..exhibit })
}

/// Loads a plain model as an exhibit in which nothing moves.
///
/// # Errors
/// All problems of the model.
pub fn load_model(model_path: &Path) -> Result<Exhibit, Report> {
    let Imported { model, warnings, .. } = import(model_path)?;
    let id = model_path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = model_path.parent().map(PathBuf::from).unwrap_or_default();
    Ok(Exhibit { id, folder, warnings, ..Exhibit::from_model(model) })
}

impl Exhibit {
    /// An exhibit of a model alone, in which nothing moves, seen through its first camera.
    pub fn from_model(mut model: Model) -> Self {
        dress(&mut model, |_| Choice::default());
        let camera_node = model.nodes.iter().position(|node| node.camera.is_some());
        Self { camera_node, ..empty(model, PathBuf::new()) }
    }
}

/// An exhibit of nothing but a model.
fn empty(model: Model, folder: PathBuf) -> Exhibit {
    Exhibit {
        id: String::new(),
        folder,
        shapes: shapes(&model, |_| None),
        model,
        light: LightRig::DEFAULT,
        gravity: GRAVITY,
        camera_node: None,
        materials: Vec::new(),
        material_pairs: Vec::new(),
        bodies: Vec::new(),
        constraints: Vec::new(),
        limits: Vec::new(),
        springs: Vec::new(),
        drives: Vec::new(),
        duration: f64::INFINITY,
        assembles: false,
        motion: Motion::Dynamics,
        touch: TouchPermission::default(),
        clock: None,
        integrator: Integrator::Auto,
        solver: Solver::Sparse,
        stabilization_time: STABILIZATION_TIME,
        wires: Vec::new(),
        cords: Vec::new(),
        colliders: Vec::new(),
        excluded_pairs: Vec::new(),
        wind_surfaces: Vec::new(),
        shelters: Vec::new(),
        winds: Vec::new(),
        breath: BreathTuning::default(),
        idle_damping: None,
        level_db: 0.0,
        instruments: Vec::new(),
        own_timbres: Vec::new(),
        sounds: Vec::new(),
        charts: Vec::new(),
        signals: Vec::new(),
        attract: Attract::default(),
        labels: Labels::default(),
        credit: Credit::default(),
        warnings: Vec::new(),
        origins: Vec::new(),
    }
}

/// The sidecar as types, after the checks of version and schema.
fn typed(source: &SidecarText) -> Result<Sidecar, Vec<Diagnostic>> {
    let version = source.value.get("schema").and_then(|v| v.as_str());
    if let Some(other) = version.filter(|v| *v != VERSION) {
        let mut problem = Diagnostic::new(codes::VERSION, format!("the format \"{other}\" is not known"))
            .help(format!("this program reads schema = \"{VERSION}\""));
        problem.location = Some(source.locate(source.span("/schema")));
        return Err(vec![problem]);
    }
    let problems = schema::check(source);
    if !problems.is_empty() {
        return Err(problems);
    }
    // The schema comes from these types; what it cannot express (a number beyond f32) is caught here.
    serde_json::from_value(source.value.clone()).map_err(|error| {
        let mut problem = Diagnostic::new(codes::WRONG_SHAPE, format!("{}: {error}", source.file))
            .help("write a number of ordinary size there");
        problem.location = Some(source.locate(source.span("")));
        vec![problem]
    })
}

/// Default time constant 1/ω₀ of the constraint stabilisation, s.
const STABILIZATION_TIME: f64 = 0.04;

/// Default processor time of a step, s, above which position-based motion takes over: two thirds of the step's length.
const BUDGET: f64 = 2.8e-3;
/// Default force of a grab over the weight of all moving bodies: it lifts them, and breaks no constraint that bears
/// more than twice its own load.
const STRENGTH: f64 = 2.0;
/// Standard gravity, m/s², which gives the force of a grab where there is no gravity.
const STANDARD_GRAVITY: f64 = 9.81;

impl Context<'_> {
    fn resolve(&mut self) -> Exhibit {
        let scene = &self.sidecar.scene;
        let gravity = scene.gravity.map_or(GRAVITY, |g| DVec3::from(g.map(|a| a.0)));
        let camera_node = self.camera();
        let folder_name =
            self.folder.canonicalize().ok().and_then(|f| Some(f.file_name()?.to_string_lossy().into_owned()));
        let id = self.sidecar.id.clone().or(folder_name).unwrap_or_default();
        self.record_origin("scene", "gravity", format!("{gravity} m/s²"), "/scene/gravity", "default");
        self.duplicate_nodes();
        self.materials();
        let material_pairs = self.material_pairs();
        let declared = self.declare_bodies();
        let wires = self.wires();
        let cords = self.cords(&wires);
        let bodies = self.resolve_masses(&declared, &wires);
        let joints::Joints { constraints, limits, springs, .. } = self.joints();
        let drives = std::mem::take(&mut self.drives);
        self.check_gear_rings(&constraints);
        self.check_rank(&constraints, &drives);
        self.check_mass_ratios(&constraints, &bodies, &drives);
        let excluded_pairs = self.excluded_pairs(&bodies, &constraints, &limits);
        let colliders = self.colliders(&wires);
        let motion = self.motion(&constraints, &springs);
        self.check_kinds(&bodies, &Joined { constraints: &constraints, limits: &limits, springs: &springs });
        let charts = self.charts(&constraints);
        let signals = self.signals(&springs);
        self.check_triggers(&constraints, &springs, &colliders);
        let wind_surfaces = self.wind_surfaces(&wires);
        let shelters = self.shelters(&wind_surfaces);
        let winds = self.winds();
        let breath = self.breath_tuning();
        let calm = self.calm();
        let sounding = Sounding {
            bodies: &bodies,
            colliders: &colliders,
            wires: &wires,
            wind_surfaces: &wind_surfaces,
            constraints: &constraints,
            springs: &springs,
        };
        let (instruments, sounds) = self.sounds(&sounding);
        let (integrator, solver, stabilization_time) = self.solver();
        let touch = self.touch(&bodies);
        let clock = self.clock(&constraints);
        let labels = self.labels();
        let attract = self.attract(&labels);
        let light = self.light();
        Exhibit {
            id,
            light,
            gravity,
            camera_node,
            materials: std::mem::take(&mut self.materials),
            material_pairs,
            bodies,
            constraints,
            limits,
            springs,
            drives,
            shapes: shapes(self.model, |node| {
                let followed = self.followed.iter().find(|(body, ..)| self.owner[node] == Some(*body));
                followed.map(|&(_, animation, repeat)| (animation, repeat))
            }),
            duration: self.duration(),
            assembles: self.sidecar.scene.assembly_animation.unwrap_or(true),
            motion,
            touch,
            clock,
            integrator,
            solver,
            stabilization_time,
            wires,
            cords,
            colliders,
            excluded_pairs,
            wind_surfaces,
            shelters,
            winds,
            breath,
            idle_damping: calm,
            level_db: self.sidecar.scene.level.0,
            instruments,
            own_timbres: self.own_timbres.presets(),
            sounds,
            charts,
            signals,
            attract,
            labels,
            credit: self.credit(),
            origins: std::mem::take(&mut self.origins),
            ..empty(self.dressed(), self.folder.to_path_buf())
        }
    }

    /// Duration of a run, s.
    fn duration(&mut self) -> f64 {
        let Some(given) = self.sidecar.scene.duration else { return f64::INFINITY };
        let duration = self.positive(given.seconds(), "/scene/duration");
        self.record_origin("scene", "duration", format!("{duration} s"), "/scene/duration", "");
        duration
    }

    /// Integrator, linear solver, and time constant of the stabilisation, s.
    fn solver(&mut self) -> (Integrator, Solver, f64) {
        let sidecar = self.sidecar;
        let given = &sidecar.solver;
        let integrator = match given.integrator {
            sidecar::Integrator::Auto => Integrator::Auto,
            sidecar::Integrator::Fast => Integrator::Fast,
            sidecar::Integrator::RungeKutta => Integrator::RungeKutta,
            sidecar::Integrator::Precise => Integrator::Precise,
        };
        let solver = match given.method {
            sidecar::Method::Sparse => Solver::Sparse,
            sidecar::Method::Dense => Solver::Dense,
        };
        let place = "/solver/stabilize/time_constant";
        let time = given.stabilize.time_constant.map_or(STABILIZATION_TIME, |t| t.0);
        let time = self.positive(time, place);
        self.record_origin("solver", "integrator", format!("{integrator:?}"), "/solver/integrator", "default");
        self.record_origin("solver", "method", format!("{solver:?}"), "/solver/method", "default");
        self.record_origin("solver", "time_constant", format!("{time} s"), place, "default");
        (integrator, solver, time)
    }

    /// Motion mode.
    fn motion(&mut self, constraints: &[Constraint], springs: &[Spring]) -> Motion {
        let given = &self.sidecar.solver;
        let budget = given.budget.map_or(BUDGET, |time| time.0);
        let budget = self.positive(budget, "/solver/budget");
        let motion = match given.motion {
            sidecar::MovedBy::Auto => Motion::Auto { budget },
            sidecar::MovedBy::Dynamics => Motion::Dynamics,
            sidecar::MovedBy::Procedural => Motion::PositionBased(PositionSolver::Relaxation),
            sidecar::MovedBy::PositionBased => Motion::PositionBased(PositionSolver::TreeSolve),
        };
        if given.budget.is_some() && given.motion != sidecar::MovedBy::Auto {
            let problem = Diagnostic::new(codes::UNUSED, "the budget is for motion = \"auto\" and does nothing here");
            self.report("/solver/budget", problem.help("leave it out, or write motion = \"auto\""));
        }
        if let Motion::PositionBased(_) = motion
            && let Some(why) = Motion::refusal(constraints, springs, &self.materials)
        {
            let problem = Diagnostic::new(codes::DYNAMICS_ONLY, format!("this exhibit moves by dynamics alone: {why}"));
            self.report("/solver/motion", problem.help("write motion = \"dynamics\" or \"auto\""));
        }
        self.record_origin("solver", "motion", format!("{motion:?}"), "/solver/motion", "default");
        motion
    }

    /// Permission and force of grabs.
    fn touch(&mut self, bodies: &[Body]) -> TouchPermission {
        let given = &self.sidecar.touch;
        let weight: f64 = bodies.iter().map(|body| body.properties.mass * STANDARD_GRAVITY).sum();
        let force = given.force.map_or(STRENGTH * weight, |force| force.0);
        let force = if bodies.is_empty() { force } else { self.positive(force, "/touch/force") };
        self.record_origin("touch", "permitted", given.permitted.to_string(), "/touch/permitted", "default");
        self.record_origin(
            "touch",
            "force",
            format!("{force:.3} N"),
            "/touch/force",
            "twice the weight of all moving bodies",
        );
        TouchPermission { permitted: self.sidecar.touch.permitted, force, together: self.together(bodies) }
    }

    /// Does the exhibit allow open constraints at the start?
    fn assembles(&self) -> bool {
        self.sidecar.solver.assemble
    }

    fn camera(&mut self) -> Option<usize> {
        let name = self.sidecar.scene.camera.as_ref()?;
        let node = self.node(name, "/scene/camera", "the visitor's camera")?;
        if self.model.nodes[node].camera.is_none() {
            let cameras = self.model.nodes.iter().filter(|n| n.camera.is_some()).map(|n| n.name.as_str());
            let names: Vec<&str> = cameras.collect();
            let help = if names.is_empty() {
                "the model has no cameras; leave the key out".into()
            } else {
                format!("cameras: {}", quoted(&names))
            };
            self.report(
                "/scene/camera",
                Diagnostic::new(codes::NOT_FOUND, format!("node \"{name}\" has no camera")).help(help),
            );
            return None;
        }
        Some(node)
    }

    /// Warns of duplicate node names, which are a trap even where the sidecar does not use them yet; the glTF validator
    /// does not report them.
    fn duplicate_nodes(&mut self) {
        let mut names: Vec<&str> = self.model.nodes.iter().map(|node| node.name.as_str()).collect();
        names.sort_unstable();
        let mut twice: Vec<&str> = names.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
        twice.dedup();
        for name in twice {
            let message = format!("several nodes of the model are named \"{name}\"");
            self.report(
                "/model",
                Diagnostic::new(codes::DUPLICATE_NODE, message)
                    .help("rename them, or point at one by its path or #index"),
            );
        }
    }
}
