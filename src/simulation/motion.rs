//! Motion of an exhibit: constrained dynamics, position-based motion, or the assembly animation, with the pointers' grabs.

use super::assembly::{self, Assembly};
use super::camera::Camera;
use super::clock_setting::{ClockSetting, SettingStep};
use super::emit::LIST_CAPACITY;
use super::idle_damping::IdleDamping;
use super::input::{MotionMode, Profile, Settings, StepInput};
use super::pointer_grabs::{PickScene, PointerGrabs};
use super::rate::{DT, STEPS_PER_SECOND};
use super::start::{start_clock_setting, start_dynamics};
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_math::spatial::Vec6;
use soffio_multibody::dynamics::{Dynamics, Impact};
use soffio_multibody::procedural::{self, PositionSolver, Procedural};
use soffio_wind::force::WindField;

/// An assembly animation in progress.
#[derive(Clone)]
struct RunningAssembly {
    assembly: Assembly,
    steps_left: u64,
}

/// All that moves the bodies of an exhibit.
#[derive(Clone)]
pub(crate) struct Motion {
    /// Constrained dynamics.
    pub dynamics: Dynamics,
    /// Procedural motion.
    pub procedural: Procedural,
    /// Parts that pointers hold.
    pub pointer_grabs: PointerGrabs,
    /// Which of the motions is in use.
    pub mode: MotionMode,
    /// The exhibit moves by dynamics alone.
    dynamics_only: bool,
    assembly: Option<RunningAssembly>,
    /// `Some` until the clock, if there is one, shows the time.
    pub clock_setting: Option<ClockSetting>,
    /// Damping that calms the exhibit after a breath.
    pub idle_damping: IdleDamping,
    /// From wind, idle damping and grabs in the present step, N and N m about each centre of mass.
    pub wrenches: Vec<Vec6>,
    /// Of the last step.
    pub impacts: Vec<Impact>,
}

impl Motion {
    /// An exhibit at its start.
    pub fn new(exhibit: &Exhibit, settings: &Settings) -> Self {
        let dynamics = start_dynamics(exhibit, settings);
        Self {
            clock_setting: start_clock_setting(exhibit, settings, &dynamics.bodies),
            procedural: Procedural::new(&dynamics, procedural::Settings::default()),
            dynamics,
            pointer_grabs: PointerGrabs::new(exhibit),
            mode: MotionMode::of(exhibit),
            dynamics_only: exhibit::Motion::refusal(&exhibit.constraints, &exhibit.springs).is_some(),
            assembly: None,
            idle_damping: IdleDamping::default(),
            wrenches: vec![[0.0; 6]; exhibit.bodies.len()],
            impacts: Vec::with_capacity(LIST_CAPACITY),
        }
    }

    /// Returns to the start of the exhibit, at time 0. Not inlined into the step, which would then reserve the 140 KB of stack for
    /// new dynamics every time.
    #[inline(never)]
    pub fn restart(&mut self, exhibit: &Exhibit, settings: &Settings) {
        self.assembly = None;
        self.dynamics = start_dynamics(exhibit, settings);
        self.clock_setting = start_clock_setting(exhibit, settings, &self.dynamics.bodies);
        self.procedural = Procedural::new(&self.dynamics, procedural::Settings::default());
        self.idle_damping = IdleDamping::default();
    }

    /// Scatters the bodies and starts the assembly animation.
    #[inline(never)] // as `restart`
    pub fn assemble(&mut self, exhibit: &Exhibit, settings: &Settings, seed: u64) {
        let (assembly, scattered) = Assembly::new(exhibit, settings, seed);
        self.dynamics = scattered;
        let steps_left = (assembly::DURATION * STEPS_PER_SECOND as f64) as u64;
        self.assembly = Some(RunningAssembly { assembly, steps_left });
    }

    /// Whether an assembly animation has just ended.
    pub fn is_assembled(&self) -> bool {
        self.assembly.as_ref().is_some_and(|running| running.steps_left == 0)
    }

    /// Present greatest distance of a body from its final position, m; `None` outside an assembly.
    pub fn assembly_distance(&self) -> Option<f64> {
        self.assembly.as_ref().map(|running| running.assembly.max_distance(&self.dynamics.bodies))
    }

    /// Adds idle damping to the wrenches, in the gallery profile. `blows`: whether a breath blows in this step.
    pub fn apply_idle_damping(&mut self, exhibit: &Exhibit, settings: &Settings, blows: bool) {
        self.idle_damping.advance(blows || self.pointer_grabs.count() > 0, DT);
        let Settings { profile, friction, .. } = *settings;
        let damping = exhibit.idle_damping.filter(|_| profile == Profile::Gallery && friction);
        if let Some(damping) = damping {
            self.idle_damping.apply(damping, &self.dynamics.bodies, &mut self.wrenches);
        }
    }

    /// Moves the bodies for a step, `elapsed` seconds after the reset. Returns the first body with invalid numbers, if any; the
    /// bodies are then restored.
    pub fn advance(
        &mut self,
        input: &StepInput,
        exhibit: &Exhibit,
        elapsed: f64,
        camera: &Camera,
        wind: &mut WindField,
    ) -> Option<usize> {
        self.impacts.clear();
        let scene = PickScene {
            view: &camera.view,
            aspect: camera.aspect,
            exhibit,
            bodies: &self.dynamics.bodies,
            is_kinematic: self.dynamics.system().kinematic(),
        };
        self.pointer_grabs.update(input.pointer_grabs, wind, &scene);
        self.mode = match input.mode.unwrap_or(MotionMode::of(exhibit)) {
            _ if self.dynamics_only => MotionMode::Dynamic,
            mode => mode,
        };
        if let Some(RunningAssembly { assembly, steps_left }) = &mut self.assembly {
            *steps_left -= 1;
            self.wrenches.fill([0.0; 6]);
            if self.mode != MotionMode::Dynamic {
                let (dynamics, impacts) = (&mut self.dynamics, &mut self.impacts);
                return dynamics
                    .position_step(DT, &self.wrenches, impacts, |step| assembly.advance_positions(DT, step.bodies));
            }
            assembly.apply_forces(&self.dynamics.bodies, &mut self.wrenches);
            return self.dynamics.step(DT, &self.wrenches, &mut self.impacts);
        }
        let method = match self.mode {
            MotionMode::Dynamic => {
                self.pointer_grabs.apply_forces(&mut self.dynamics, DT, &mut self.wrenches);
                self.set_clock(exhibit, elapsed);
                return self.dynamics.step(DT, &self.wrenches, &mut self.impacts);
            }
            MotionMode::Procedural => PositionSolver::Relaxation,
            MotionMode::PositionBased => PositionSolver::TreeSolve,
        };
        self.procedural.settings_mut().method = method;
        let targets = self.pointer_grabs.position_targets(&self.dynamics.bodies, DT);
        self.procedural.step(&mut self.dynamics, DT, &self.wrenches, targets, &mut self.impacts)
    }

    /// Adds the torque of a clock setting to the wrenches, and ends the setting once the clock shows the time.
    fn set_clock(&mut self, exhibit: &Exhibit, elapsed: f64) {
        if let (Some(setting), Some(clock)) = (&mut self.clock_setting, &exhibit.clock)
            && !setting.apply(clock, SettingStep { elapsed, dt: DT }, &mut self.dynamics, &mut self.wrenches)
        {
            self.clock_setting = None;
        }
    }
}
