//! Aim assist during a run: its targets, their visibility from the lips, and the selected one.

use super::aim::{Aim, AimTarget, CameraRay};
use super::camera::Camera;
use super::input::{CENTRE, Profile, Settings, StepInput};
use super::rate::{DT, STEPS_PER_SECOND};
use super::source::BreathState;
use soffio_exhibit::Exhibit;
use soffio_geometry::bodies::RigidBody;
use soffio_multibody::dynamics::Dynamics;
use soffio_wind::force::WindField;
use soffio_wind::{Surface, SurfaceShape};

/// Steps between two selections of a target: sixty selections a second.
const SELECTION_STEPS: u64 = STEPS_PER_SECOND / 60;
/// Selections between two visibility tests of another target while nobody blows.
const IDLE_SELECTIONS: u64 = 8;

/// The aim of the breath and the targets of the aim assist.
#[derive(Clone)]
pub(crate) struct AimAssist {
    /// Where the breath is aimed.
    pub aim: Aim,
    /// Pointer of the last step, picture coordinates.
    pointer: [f64; 2],
    candidates: Vec<Candidate>,
    /// The candidates at the present poses of their bodies.
    targets: Vec<AimTarget>,
}

/// A surface that may be selected.
#[derive(Clone)]
struct Candidate {
    /// Index of the wind surface.
    surface: usize,
    /// In the node frame of its body.
    target: AimTarget,
}

impl Candidate {
    /// The target at the present pose of its body.
    fn posed(&self, context: &AimContext) -> AimTarget {
        self.target.at(context.bodies[context.exhibit.wind_surfaces[self.surface].body].pose())
    }
}

/// Inputs of the aim in one step.
pub(crate) struct AimContext<'a> {
    /// The exhibit.
    pub exhibit: &'a Exhibit,
    /// Constants of the run.
    pub settings: &'a Settings,
    /// The camera of the picture in which the pointer lies.
    pub camera: &'a Camera,
    /// State of the breath at the lips.
    pub breath: &'a BreathState,
    /// Present state of all bodies.
    pub bodies: &'a [RigidBody],
    /// Steps done.
    pub step: u64,
}

impl AimAssist {
    /// No target is selected yet. `dynamics` should be a copy that is not shown: computing mobilities wakes its bodies.
    pub fn new(exhibit: &Exhibit, dynamics: &mut Dynamics) -> Self {
        Self {
            aim: Aim::default(),
            pointer: CENTRE,
            targets: Vec::with_capacity(exhibit.wind_surfaces.len()),
            candidates: candidates(exhibit, dynamics),
        }
    }

    /// Aims the breath of a step. A target is selected sixty times a second, and at once when a breath begins or when one that is
    /// still compensated is pointed elsewhere. A visitor who interrupts attract mode blows one step before the script's aim
    /// ends, and the onset compensation must not act on the script's target.
    pub fn update(&mut self, input: &StepInput, context: &AimContext, wind: &mut WindField) {
        let pointer = input.pointer.unwrap_or(CENTRE);
        let Settings { distance, profile, .. } = *context.settings;
        let Camera { aspect, ref view, .. } = *context.camera;
        self.aim.set_ray(view, CameraRay::through(view, pointer, aspect), distance);
        let jumps = std::mem::replace(&mut self.pointer, pointer) != pointer;
        let onset = &context.breath.onset;
        let begins = onset.begins() || jumps && onset.is_compensating();
        let selects = profile == Profile::Gallery && (begins || context.step.is_multiple_of(SELECTION_STEPS));
        if selects {
            self.update_visibility(context, wind, context.step / SELECTION_STEPS, begins);
            self.targets.clear();
            self.targets.extend(self.candidates.iter().map(|candidate| candidate.posed(context)));
            self.aim.select_target(&self.targets);
        }
        let selected = self.aim.selected().map(|index| self.candidates[index].posed(context));
        self.aim.track(selected.as_ref(), if begins { f64::INFINITY } else { DT });
    }

    /// Tests the visibility of candidates from the lips: of all when a breath begins; else of the selected one and of another in
    /// turn, because occlusion changes slowly. While nobody blows, only at every eighth selection.
    fn update_visibility(&mut self, context: &AimContext, wind: &mut WindField, selection: u64, begins: bool) {
        let interval = if context.breath.speed > 0.0 { 1 } else { IDLE_SELECTIONS };
        let count = self.candidates.len();
        if count < 2 || !(begins || selection.is_multiple_of(interval)) {
            return;
        }
        let next = (selection / interval % count as u64) as usize;
        for (index, Candidate { surface, target }) in self.candidates.iter_mut().enumerate() {
            if begins || index == next || self.aim.selected() == Some(index) {
                let pose = context.bodies[context.exhibit.wind_surfaces[*surface].body].pose();
                let lips = self.aim.lips_facing(pose.point(target.center));
                target.visible = wind.visible_fraction(*surface, context.bodies, lips);
            }
        }
    }
}

/// The mesh surfaces of an exhibit; wires are not aimed at.
fn candidates(exhibit: &Exhibit, dynamics: &mut Dynamics) -> Vec<Candidate> {
    let candidate = |(index, surface): (usize, &Surface)| match &surface.shape {
        SurfaceShape::Mesh { mesh, .. } => {
            Some(Candidate { surface: index, target: AimTarget::of(mesh, surface.body, dynamics) })
        }
        SurfaceShape::Wire { .. } => None,
    };
    let mut candidates = exhibit.wind_surfaces.iter().enumerate().filter_map(candidate).collect::<Vec<_>>();
    normalise_mobility(&mut candidates);
    candidates
}

/// Divides all mobilities by the greatest.
fn normalise_mobility(candidates: &mut [Candidate]) {
    let most = candidates.iter().fold(0.0, |most: f64, candidate| most.max(candidate.target.mobility));
    for Candidate { target, .. } in candidates {
        target.mobility = if most > 0.0 { target.mobility / most } else { 1.0 };
    }
}
