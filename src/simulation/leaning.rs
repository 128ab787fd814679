//! What the breath leans to while a run goes on: which surfaces there are, which of them the lips see, which is chosen.

use super::aim::AimTarget;
use super::eye::Eye;
use super::{CENTRE, DT, Profile, STEPS_PER_SECOND, Settings, Simulation, StepInput};
use soffio_exhibit::Exhibit;
use soffio_multibody::dynamics::Dynamics;
use soffio_wind::{Surface, SurfaceShape};

impl Simulation {
    /// Points the breath. What it leans to is chosen again sixty times a second, and at once by a breath that begins, or that has
    /// only just begun when it is pointed elsewhere: whoever wakes the work from attract mode blows a step before the script's
    /// aim is given up, and what their first moment makes up for would go astray.
    pub(super) fn take_aim(&mut self, input: &StepInput) {
        const EVERY: u64 = STEPS_PER_SECOND / 60;
        self.eye.look(&self.exhibit, input.aspect, input.turn);
        let pointer = input.pointer.unwrap_or(CENTRE);
        let Settings { distance, profile, .. } = self.settings;
        let Eye { aspect, ref view, .. } = self.eye;
        self.aim.point(view, view.ray(pointer, aspect), distance);
        let leaps = std::mem::replace(&mut self.pointer, pointer) != pointer;
        let begins = self.onset.begins() || leaps && self.onset.is_fresh();
        let chooses = profile == Profile::Gallery && (begins || self.step.is_multiple_of(EVERY));
        if chooses {
            self.look_at_targets(self.step / EVERY, begins);
        }
        let (surfaces, bodies) = (&self.exhibit.wind_surfaces, &self.dynamics.bodies);
        let stands = |(surface, target): &(usize, AimTarget)| target.at(bodies[surfaces[*surface].body].pose());
        if chooses {
            self.aim_targets.clear();
            self.aim_targets.extend(self.leant_to.iter().map(stands));
            self.aim.choose(&self.aim_targets);
        }
        let chosen = self.aim.chosen().map(|index| stands(&self.leant_to[index]));
        self.aim.lean(chosen.as_ref(), if begins { f64::INFINITY } else { DT });
    }

    /// Sees what hides the surfaces that breath leans to from the lips, where there is a choice: all of them for a breath that
    /// begins. What stands in the way then changes slowly, but for lips that follow a pointer: of the choices one looks at the
    /// surface that is chosen and at another in turn, and while nobody blows every eighth.
    fn look_at_targets(&mut self, choice: u64, begins: bool) {
        let (every, surfaces) = (if self.speed > 0.0 { 1 } else { 8 }, self.leant_to.len());
        if surfaces < 2 || !(begins || choice.is_multiple_of(every)) {
            return;
        }
        let next = (choice / every % surfaces as u64) as usize;
        for (index, (surface, target)) in self.leant_to.iter_mut().enumerate() {
            if begins || index == next || self.aim.chosen() == Some(index) {
                let pose = self.dynamics.bodies[self.exhibit.wind_surfaces[*surface].body].pose();
                let lips = self.aim.lips_before(pose.point(target.center));
                target.seen = self.wind.shown(*surface, &self.dynamics.bodies, lips);
            }
        }
    }
}

/// Surfaces of sheets that breath leans to: which, and what is leant to in its node frame.
pub(super) fn leant_to(exhibit: &Exhibit, dynamics: &mut Dynamics) -> Vec<(usize, AimTarget)> {
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
