//! Motion of an exhibit: constrained dynamics, position-based motion, or the assembly animation, with the pointers' grabs.

use super::assembly::{self, Assembly};
use super::camera::Camera;
use super::clock_setting::{ClockSetting, SettingStep};
use super::emit::LIST_CAPACITY;
use super::idle_damping::IdleDamping;
use super::input::{MotionMode, Profile, Settings, StepInput};
use super::motion_group::{MotionGroup, advance};
use super::pointer_grabs::{PickScene, PointerGrabs};
use super::rate::{DT, STEPS_PER_SECOND};
use super::start::{start_clock_setting, start_dynamics_of};
use soffio_exhibit::Exhibit;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DMat3;
use soffio_math::spatial::Vec6;
use soffio_multibody::articulation::{Constraint, ConstraintKind};
use soffio_multibody::dynamics::{Dynamics, Impact};
use soffio_multibody::procedural::{self, Procedural};
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
    /// Constrained dynamics. Its bodies are all of the exhibit's, those of the groups included.
    pub dynamics: Dynamics,
    /// Procedural motion.
    pub procedural: Procedural,
    /// Bodies that move by a kind of their own.
    pub groups: Vec<MotionGroup>,
    /// Whether each body moves by the exhibit's own kind.
    own: Vec<bool>,
    /// Of each kind, the constraints of lengths that act in it.
    lengths: Vec<Vec<usize>>,
    /// All bodies, those of groups as the groups have moved them.
    of_groups: Vec<RigidBody>,
    /// Whether each body follows a path or an animation.
    pub is_kinematic: Vec<bool>,
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
        let groups = MotionGroup::all(exhibit, settings);
        let own: Vec<bool> = exhibit.bodies.iter().map(|body| body.moved_by.is_none()).collect();
        let dynamics = start_dynamics_of(exhibit, settings, &own);
        let is_kinematic = |body: usize| exhibit.drives.iter().any(|drive| drive.body == body);
        Self {
            lengths: lengths_of_kinds(exhibit, &groups),
            groups,
            own,
            of_groups: dynamics.bodies.clone(),
            is_kinematic: (0..exhibit.bodies.len()).map(is_kinematic).collect(),
            clock_setting: start_clock_setting(exhibit, settings, &dynamics.bodies),
            procedural: Procedural::new(&dynamics, procedural::Settings::default()),
            dynamics,
            pointer_grabs: PointerGrabs::new(exhibit),
            mode: MotionMode::of(exhibit),
            dynamics_only: exhibit.refusal().is_some(),
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
        self.dynamics = start_dynamics_of(exhibit, settings, &self.own);
        self.groups = MotionGroup::all(exhibit, settings);
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
            is_kinematic: &self.is_kinematic,
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
                return dynamics.position_step(DT, &self.wrenches, true, impacts, |step| {
                    assembly.advance_positions(DT, step.bodies)
                });
            }
            assembly.apply_forces(&self.dynamics.bodies, &mut self.wrenches);
            return self.dynamics.step(DT, &self.wrenches, &mut self.impacts);
        }
        if self.mode == MotionMode::Dynamic {
            self.pointer_grabs.apply_forces(&self.own, &mut self.dynamics, DT, &mut self.wrenches);
            self.set_clock(exhibit, elapsed);
        }
        let Self { dynamics, procedural, groups, own, pointer_grabs, wrenches, impacts, of_groups, .. } = self;
        if groups.is_empty() {
            return advance(self.mode, own, (dynamics, procedural), pointer_grabs, wrenches, impacts);
        }
        // The step puts the bodies of groups back to where they started.
        of_groups.copy_from_slice(&dynamics.bodies);
        let mut fault = advance(self.mode, own, (dynamics, procedural), pointer_grabs, wrenches, impacts);
        for group in groups {
            let of_group = group.advance(of_groups, pointer_grabs, wrenches, impacts);
            fault = fault.or(of_group);
        }
        for (index, body) in of_groups.iter().enumerate().filter(|(index, _)| !own[*index]) {
            dynamics.bodies[index] = *body;
        }
        fault
    }

    /// Sets the speed of the breath at the lips from the next step on, m/s.
    pub fn set_breath_speed(&mut self, speed: f64) {
        self.dynamics.set_breath_speed(speed);
        self.groups.iter_mut().for_each(|group| group.dynamics.set_breath_speed(speed));
    }

    /// Gives the rest of a spring, m or rad, and its rate.
    pub fn give_rest(&mut self, spring: usize, value: f64, rate: f64) {
        self.dynamics.give_rest(spring, value, rate);
        self.groups.iter_mut().for_each(|group| group.dynamics.give_rest(spring, value, rate));
    }

    /// The dynamics of each kind of motion, the exhibit's own first.
    pub fn kinds(&self) -> impl Iterator<Item = &Dynamics> {
        std::iter::once(&self.dynamics).chain(self.groups.iter().map(|group| &group.dynamics))
    }

    /// The dynamics that a body moves by.
    pub fn of_body(&self, body: usize) -> &Dynamics {
        self.groups.iter().find(|group| group.has(body)).map_or(&self.dynamics, |group| &group.dynamics)
    }

    /// Index of the kind that a constraint acts in, as in [`Self::kinds`].
    pub fn kind_of(&self, constraint: &Constraint) -> usize {
        kind_of(constraint, &self.groups)
    }

    /// Largest error of a constraint of lengths, m.
    pub fn joint_error(&self) -> f64 {
        if self.groups.is_empty() {
            return self.dynamics.joint_error();
        }
        let mut frames = vec![DMat3::IDENTITY; self.own.len()];
        let of_kind = |(dynamics, lengths): (&Dynamics, &Vec<usize>)| {
            dynamics.system().largest_gap_of(lengths, &dynamics.bodies, &mut frames)
        };
        self.kinds().zip(&self.lengths).map(of_kind).fold(0.0, f64::max)
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

/// Index of the kind that a constraint acts in: 0 is the exhibit's own, then come the groups.
fn kind_of(constraint: &Constraint, groups: &[MotionGroup]) -> usize {
    groups.iter().position(|group| group.is_joined_by(constraint)).map_or(0, |group| group + 1)
}

/// Constraints of lengths that act in each kind.
fn lengths_of_kinds(exhibit: &Exhibit, groups: &[MotionGroup]) -> Vec<Vec<usize>> {
    let mut lengths = vec![Vec::new(); 1 + groups.len()];
    for (index, constraint) in exhibit.constraints.iter().enumerate() {
        if !matches!(constraint.kind, ConstraintKind::Orientation { .. }) {
            lengths[kind_of(constraint, groups)].push(index);
        }
    }
    lengths
}
