//! What the breath leans to while a run goes on: which surfaces there are, which of them the lips see, which is chosen.

use super::aim::{Aim, AimTarget};
use super::eye::Eye;
use super::input::{CENTRE, Profile, Settings, StepInput};
use super::rate::{DT, STEPS_PER_SECOND};
use super::source::Breathing;
use soffio_exhibit::Exhibit;
use soffio_geometry::bodies::RigidBody;
use soffio_multibody::dynamics::Dynamics;
use soffio_wind::force::WindField;
use soffio_wind::{Surface, SurfaceShape};

/// Where the breath is pointed, and what it leans to.
#[derive(Clone)]
pub(crate) struct Aiming {
    pub aim: Aim,
    /// Where the breath was pointed in the last step, picture coordinates.
    pointer: [f64; 2],
    /// Surfaces that breath leans to: which each is and how it is in its body's node frame; and where they are now.
    leant_to: Vec<(usize, AimTarget)>,
    targets: Vec<AimTarget>,
}

/// What a step is aimed by.
pub(crate) struct Scene<'a> {
    pub exhibit: &'a Exhibit,
    pub settings: &'a Settings,
    pub eye: &'a Eye,
    pub breathing: &'a Breathing,
    pub bodies: &'a [RigidBody],
    /// Steps done.
    pub step: u64,
}

impl Aiming {
    /// At nothing yet. Asking a figure how it answers wakes it: one that is not shown is asked.
    pub fn new(exhibit: &Exhibit, dynamics: &mut Dynamics) -> Self {
        Self {
            aim: Aim::default(),
            pointer: CENTRE,
            targets: Vec::with_capacity(exhibit.wind_surfaces.len()),
            leant_to: leant_to(exhibit, dynamics),
        }
    }

    /// Points the breath. What it leans to is chosen again sixty times a second, and at once by a breath that begins, or that has
    /// only just begun when it is pointed elsewhere: whoever wakes the work from attract mode blows a step before the script's
    /// aim is given up, and what their first moment makes up for would go astray.
    pub fn point(&mut self, input: &StepInput, scene: &Scene, wind: &mut WindField) {
        const EVERY: u64 = STEPS_PER_SECOND / 60;
        let pointer = input.pointer.unwrap_or(CENTRE);
        let Settings { distance, profile, .. } = *scene.settings;
        let Eye { aspect, ref view, .. } = *scene.eye;
        self.aim.point(view, view.ray(pointer, aspect), distance);
        let leaps = std::mem::replace(&mut self.pointer, pointer) != pointer;
        let onset = &scene.breathing.onset;
        let begins = onset.begins() || leaps && onset.is_fresh();
        let chooses = profile == Profile::Gallery && (begins || scene.step.is_multiple_of(EVERY));
        if chooses {
            self.look_at_targets(scene, wind, scene.step / EVERY, begins);
        }
        let (surfaces, bodies) = (&scene.exhibit.wind_surfaces, scene.bodies);
        let stands = |(surface, target): &(usize, AimTarget)| target.at(bodies[surfaces[*surface].body].pose());
        if chooses {
            self.targets.clear();
            self.targets.extend(self.leant_to.iter().map(stands));
            self.aim.choose(&self.targets);
        }
        let chosen = self.aim.chosen().map(|index| stands(&self.leant_to[index]));
        self.aim.lean(chosen.as_ref(), if begins { f64::INFINITY } else { DT });
    }

    /// Sees what hides the surfaces that breath leans to from the lips, where there is a choice: all of them for a breath that
    /// begins. What stands in the way then changes slowly, but for lips that follow a pointer: of the choices one looks at the
    /// surface that is chosen and at another in turn, and while nobody blows every eighth.
    fn look_at_targets(&mut self, scene: &Scene, wind: &mut WindField, choice: u64, begins: bool) {
        let (every, surfaces) = (if scene.breathing.speed > 0.0 { 1 } else { 8 }, self.leant_to.len());
        if surfaces < 2 || !(begins || choice.is_multiple_of(every)) {
            return;
        }
        let next = (choice / every % surfaces as u64) as usize;
        for (index, (surface, target)) in self.leant_to.iter_mut().enumerate() {
            if begins || index == next || self.aim.chosen() == Some(index) {
                let pose = scene.bodies[scene.exhibit.wind_surfaces[*surface].body].pose();
                let lips = self.aim.lips_before(pose.point(target.center));
                target.seen = wind.shown(*surface, scene.bodies, lips);
            }
        }
    }
}

/// Surfaces of sheets that breath leans to: which, and what is leant to in its node frame.
fn leant_to(exhibit: &Exhibit, dynamics: &mut Dynamics) -> Vec<(usize, AimTarget)> {
    let target = |(index, surface): (usize, &Surface)| match &surface.shape {
        SurfaceShape::Mesh { mesh, .. } => Some((index, AimTarget::of(mesh, surface.body, dynamics))),
        SurfaceShape::Wire { .. } => None,
    };
    let mut targets = exhibit.wind_surfaces.iter().enumerate().filter_map(target).collect::<Vec<_>>();
    compare(&mut targets);
    targets
}

/// Makes the readiest of some targets count 1.
fn compare(targets: &mut [(usize, AimTarget)]) {
    let most = targets.iter().fold(0.0, |most: f64, (_, target)| most.max(target.answers));
    targets.iter_mut().for_each(|(_, target)| target.answers = if most > 0.0 { target.answers / most } else { 1.0 });
}
