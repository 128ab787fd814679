//! Inspection of one moment, for curators who debug an exhibit: joints, bodies and wind patches. Steps do not use it.

use super::air::AimedBreath;
use super::step::Simulation;
use soffio_math::DVec3;
use soffio_multibody::articulation::ConstraintKind;
use soffio_multibody::dynamics::Dynamics;

/// What is inspected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum InspectionScope {
    /// Nothing.
    #[default]
    Nothing,
    /// Bodies and joints.
    Bodies,
    /// Patches of the wind surfaces.
    Wind,
}

/// Result of an inspection; lists outside its scope are empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inspection {
    /// Steps done.
    pub step: u64,
    /// In the order of the exhibit's constraints.
    pub joints: Vec<JointState>,
    /// In the order of the exhibit's bodies.
    pub bodies: Vec<BodyState>,
    /// Every patch of the wind surfaces.
    pub wind: Vec<WindSample>,
}

/// State of a constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointState {
    /// Constraint error: m, for an angle rad.
    pub error: f64,
    /// Whether it constrains an angle.
    pub angle: bool,
    /// Reaction force of its joint in the last step, all distance constraints between the two bodies together, N; `None` for
    /// angles and couplings.
    pub load: Option<f64>,
}

/// State of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Speed of its centre of mass, m/s.
    pub speed: f64,
    /// Angular speed, rad/s.
    pub spin: f64,
    /// Height of its centre of mass, world, m.
    pub height: f64,
}

/// State of a wind patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindSample {
    /// Index of its surface among the exhibit's.
    pub surface: usize,
    /// Position, world, m.
    pub point: DVec3,
    /// Whether it lies in the breath as it is aimed now, and is visible from the lips.
    pub in_breath: bool,
    /// Speed of the air there, m/s, breath and ambient winds together.
    pub speed: f64,
}

impl Simulation {
    /// Present values for the staff panel, as far as `scope` asks for them. The run itself is not changed.
    pub fn inspect(&mut self, scope: InspectionScope) -> Inspection {
        let empty = Inspection { step: self.clock.step, ..Inspection::default() };
        match scope {
            InspectionScope::Nothing => empty,
            InspectionScope::Bodies => Inspection { joints: self.joint_states(), bodies: self.body_states(), ..empty },
            InspectionScope::Wind => Inspection { wind: self.wind_samples(), ..empty },
        }
    }

    fn joint_states(&self) -> Vec<JointState> {
        let of_kind = |dynamics: &Dynamics| (dynamics.joint_loads(), dynamics.system().gaps(&dynamics.bodies));
        let kinds: Vec<_> = self.motion.kinds().map(of_kind).collect();
        let states = self.exhibit.constraints.iter().enumerate();
        states
            .map(|(index, constraint)| {
                let (loads, errors) = &kinds[self.motion.kind_of(constraint)];
                let angle = matches!(constraint.kind, ConstraintKind::Orientation { .. });
                JointState { error: errors[index], angle, load: loads[index].filter(|_| !angle) }
            })
            .collect()
    }

    fn body_states(&self) -> Vec<BodyState> {
        let state = |body: &soffio_geometry::bodies::RigidBody| BodyState {
            speed: body.velocity.length(),
            spin: body.angular_velocity.length(),
            height: body.position.y,
        };
        self.motion.dynamics.bodies.iter().map(state).collect()
    }

    fn wind_samples(&mut self) -> Vec<WindSample> {
        let Self { exhibit, settings, breath, aim_assist, air, motion, .. } = self;
        let aimed = AimedBreath { exhibit, settings, aim: &aim_assist.aim, speed: breath.speed };
        let breath = aimed.breath();
        let samples = air.wind.sample_patches(&motion.dynamics.bodies, &breath);
        let jet = aimed.jet(&air.jet_front);
        let sample = |sample: soffio_wind::force::PatchSample| {
            let jet = jet.as_ref().filter(|_| sample.visible);
            let velocity = air.wind.directed_velocity(jet, sample.point) + air.wind.undirected_velocity(sample.point);
            let in_breath = sample.visible && breath.relative_speed(sample.point).is_some();
            WindSample { surface: sample.surface, point: sample.point, in_breath, speed: velocity.length() }
        };
        samples.into_iter().map(sample).collect()
    }
}
