//! One step of an articulation: event-driven substeps, or Moreau's time stepping where the work budget is exhausted.
//!
//! A substep integrates the constrained equations of motion, finds the forces of resting contacts, and ends early at the first
//! impact. Its length follows the integration error, the fastest tension mode and spin, tipping and sliding contacts, and the
//! edges of the constraints' activation windows.

use super::contacts::{Contacts, EarliestImpact, Impact, Pass, PassOutcome};
use super::equations::{Equations, Evaluated};
use super::integrate::{ErrorControl, Integration, Moving, Substep};
use super::joint_loads::JointLoads;
use super::recovery::Recovery;
use super::settings::Settings;
use super::sleep::{Extent, Sleep};
use super::work_budget::WorkBudget;
use crate::articulation::LoadKind;
use soffio_geometry::bodies::RigidBody;
use soffio_math::function::AT_KEY_S;
use soffio_math::spatial::Vec6;

/// Limits of a substep's length.
struct SubstepLimits {
    /// Largest phase ω h of the stiffest tension mode, rad. Runge–Kutta's method is stable up to 2.8. Such a mode holds hardly any
    /// energy, and at 1 rad loses it within some ten periods.
    tension_phase: f64,
    /// Largest rotation of a body, rad.
    rotation: f64,
    /// Substeps of one step; faster motion is followed less finely.
    count: f64,
    /// The same while joints are open: how they close is not physics, and a scattered clock would need all of the above.
    count_open: f64,
    /// Edges of activation windows at which one step stops; nearer ones are stepped over.
    edges: f64,
}

const LIMITS: SubstepLimits =
    SubstepLimits { tension_phase: 3.2, rotation: 0.25, count: 64.0, count_open: 16.0, edges: 1024.0 };

/// An impact's time is improved at most so often, until its error is below this, s.
const MAX_AIMS: usize = 3;
const IMPACT_TIME_ERROR: f64 = 1e-6;

/// Constrained dynamics of an articulation. Nothing here allocates after [`Dynamics::new`].
#[derive(Clone)]
pub struct Dynamics {
    /// The bodies' present state. Call [`Dynamics::disturb`] after changing it from outside.
    pub bodies: Vec<RigidBody>,
    pub(super) settings: Settings,
    pub(super) equations: Equations,
    pub(super) integration: Integration,
    pub(super) contacts: Contacts,
    pub(super) budget: WorkBudget,
    pub(super) loads: JointLoads,
    pub(super) sleep: Sleep,
    pub(super) recovery: Recovery,
    /// The bodies at the start of the present substep.
    pub(super) before: Vec<RigidBody>,
    /// Seconds since reset.
    pub(super) time: f64,
    pub(super) breath: BreathSpeed,
    /// Substeps of the present step.
    pub(super) substeps: u32,
}

/// Speed of the breath at the lips, m/s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BreathSpeed {
    /// In the last step.
    pub before: f64,
    /// In the present one.
    pub now: f64,
}

/// A substep's place in the step.
#[derive(Clone, Copy, Debug)]
pub(super) struct SubstepSpan {
    /// Seconds after the beginning of the step.
    pub start: f64,
    /// Length, s.
    pub h: f64,
}

/// How impacts within a substep are resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ImpactScheme {
    /// Each at its own time: the substep is cut there.
    EventDriven,
    /// All together at the substep's end.
    TimeStepping,
}

/// What the next substep's length depends on.
#[derive(Clone, Copy, Debug)]
struct RemainingStep {
    /// Seconds since reset.
    now: f64,
    /// Seconds of the step that are left.
    left: f64,
    /// Next time at which a driver's velocity jumps, s since reset.
    jump: f64,
    /// Length of the whole step, s.
    dt: f64,
    scheme: ImpactScheme,
}

/// A substep that was integrated up to an impact.
#[derive(Clone, Copy, Debug)]
struct AimedSubstep {
    /// Time used, s.
    used: f64,
    /// Time of the impact, s. If it is later than `used`, the error asked for a shorter substep.
    target: f64,
}

impl Dynamics {
    /// Advances by `dt` seconds under constant external wrenches (N and N m about each centre of mass). Appends the impacts to
    /// `impacts`. Returns the first body with invalid numbers, before or after, because of which all bodies were put back.
    pub fn step(&mut self, dt: f64, external: &[Vec6], impacts: &mut Vec<Impact>) -> Option<usize> {
        // Bodies may have been set to invalid states from outside.
        let invalid = self.recover();
        self.equations.wrenches.given.copy_from_slice(external);
        self.wake_pushed_bodies();
        self.begin_step(dt);
        let already = impacts.len();
        let mut done = 0.0;
        while done < dt * (1.0 - 1e-12) {
            if self.substeps > 0 && !self.bodies.iter().all(RigidBody::is_finite) {
                break;
            }
            let now = self.time + done;
            if self.equations.next_jump(now - 2.0 * AT_KEY_S) <= now + AT_KEY_S {
                self.equations.jump(&mut self.bodies, now);
                self.integration.interrupt();
            }
            self.evaluate_first_stage(now);
            let exhausted = self.budget.is_exhausted() && !self.contacts.is_empty();
            let scheme = if exhausted { ImpactScheme::TimeStepping } else { ImpactScheme::EventDriven };
            let jump = self.equations.next_jump(now);
            let h = self.next_substep_length(RemainingStep { now, left: dt - done, jump, dt, scheme });
            self.set_activations(now + 0.5 * h);
            let span = SubstepSpan { start: done, h };
            done += match scheme {
                ImpactScheme::EventDriven => self.substep_event_driven(span, dt, impacts),
                ImpactScheme::TimeStepping => self.substep_time_stepping(span, dt, impacts),
            };
            self.substeps += 1;
        }
        if self.loads.has_friction && self.bodies.iter().all(RigidBody::is_finite) {
            self.equations.apply_pivot_friction(&mut self.bodies, self.loads.all(), dt);
        }
        let lost = self.end_step(dt, already, impacts);
        self.fall_asleep(dt, Extent::Island);
        invalid.or(lost)
    }

    /// Begins a step of `dt` seconds.
    pub(super) fn begin_step(&mut self, dt: f64) {
        self.recovery.begin_step(&self.bodies);
        self.integration.begin_step(dt);
        self.contacts.begin_step(self.time);
        self.budget.begin_step();
        self.begin_events();
        self.substeps = 0;
    }

    /// Finds the accelerations of the first stage, and the joints' loads, which bound the substep's length.
    fn evaluate_first_stage(&mut self, now: f64) {
        if self.equations.evaluated < Evaluated::Accelerations {
            self.apply_contact_forces();
            self.equations.ensure_accelerations(&mut self.bodies, now);
            self.loads.record(&self.equations.system);
        }
    }

    /// Length of the next substep, s.
    fn next_substep_length(&self, RemainingStep { now, left, jump, dt, scheme }: RemainingStep) -> f64 {
        let Equations { system, springs, .. } = &self.equations;
        let edge = system.activity.next_edge(now).min(springs.activity.next_edge(now)).min(jump);
        let left = left.min((edge - now).max(dt / LIMITS.edges));
        let count = (left / self.longest_substep(dt, scheme)).ceil().max(1.0);
        left / count
    }

    /// Integrates the substep, or less where the error asks for it or up to the first impact, which it resolves. Returns the time
    /// used, s.
    fn substep_event_driven(&mut self, span: SubstepSpan, dt: f64, impacts: &mut Vec<Impact>) -> f64 {
        let SubstepSpan { start, h } = span;
        let (integration, mut moving) = self.moving();
        integration.begin_substep(&mut moving);
        let collides = !self.contacts.is_empty();
        if collides || self.contacts.clutches().count() > 0 || self.sleep.any() {
            self.before.copy_from_slice(&self.bodies);
        }
        let now = self.time + start;
        let shortest = self.shortest_substep(dt);
        let mut used = self.integrate_substep(Substep { t: now, h, shortest, error_control: ErrorControl::On });
        if collides {
            if let Some(impact) = self.contacts.earliest_impact(&self.before, &self.bodies) {
                let aimed = self.integrate_to_impact(&impact, now, used, shortest);
                used = aimed.used;
                // A substep that had to be shorter still finds the impact again.
                if used >= aimed.target {
                    self.resolve_impact(&impact, SubstepSpan { start: start + used, h }, impacts);
                }
            }
            while let Some(body) = self.contacts.disturbed_sleeper() {
                self.wake(body);
            }
            self.contacts.end_substep(&self.bodies);
        }
        self.record_joint_loads(now + used);
        self.break_overloaded(now + used);
        used
    }

    /// Integrates the substep, or less where the error asks for it, without impacts, and resolves them at its end together with
    /// the resting contacts. Returns the time used, s.
    fn substep_time_stepping(&mut self, span: SubstepSpan, dt: f64, impacts: &mut Vec<Impact>) -> f64 {
        let SubstepSpan { start, h } = span;
        let now = self.time + start;
        let shortest = self.shortest_substep(dt);
        let (integration, mut moving) = self.moving();
        integration.begin_substep(&mut moving);
        self.before.copy_from_slice(&self.bodies);
        self.contacts.begin_substep();
        self.contacts.prepare_contact_forces_once(h, &self.equations.system);
        self.apply_contact_forces();
        let (integration, mut moving) = self.moving();
        let h = integration.integrate(&mut moving, Substep { t: now, h, shortest, error_control: ErrorControl::On });
        while self.sleep.any()
            && let Some(body) = self.contacts.sleeper_reached(&self.before, &self.bodies)
        {
            self.wake(body);
        }
        self.equations.prepare_impulses(&self.bodies);
        let Self { equations, contacts, bodies, before, .. } = self;
        contacts.finish_time_step(SubstepSpan { start, h }, before, &mut equations.system, bodies, impacts);
        contacts.stick_clutches(h, &mut equations.system, bodies);
        self.equations.project(&mut self.bodies);
        self.integration.interrupt();
        self.sleep.restore_sleeping(&mut self.bodies, &self.before);
        while let Some(body) = self.contacts.disturbed_sleeper() {
            self.wake(body);
        }
        self.contacts.end_substep(&self.bodies);
        self.record_joint_loads(now + h);
        self.break_overloaded(now + h);
        self.budget.record_pass(self.bodies.len(), self.contacts.take_operations());
        h
    }

    /// Repeats a substep of `whole` seconds up to an impact within it.
    fn integrate_to_impact(&mut self, impact: &EarliestImpact, now: f64, whole: f64, shortest: f64) -> AimedSubstep {
        let mut aimed = AimedSubstep { used: whole, target: whole * impact.s };
        for aim in 1..=MAX_AIMS {
            self.back_to_start();
            self.contacts.cut_substep();
            let AimedSubstep { target, .. } = aimed;
            // It is shorter than an accepted substep, so its error is smaller.
            aimed.used = if target > 0.0 {
                let shortest = shortest.min(target);
                self.integrate_substep(Substep { t: now, h: target, shortest, error_control: ErrorControl::Off })
            } else {
                0.0
            };
            let correction = self.contacts.time_to_contact(impact, &self.bodies);
            let better = (target + correction).clamp(0.0, whole);
            if aim == MAX_AIMS || aimed.used < target || (better - target).abs() < IMPACT_TIME_ERROR {
                break;
            }
            aimed.target = better;
        }
        aimed
    }

    /// Resolves an impact at the bodies' present state; `at` is its time and the length of the substep.
    fn resolve_impact(&mut self, impact: &EarliestImpact, at: SubstepSpan, impacts: &mut Vec<Impact>) {
        self.wake_for(impact);
        self.equations.prepare_impulses(&self.bodies);
        self.contacts.resolve_impact(impact, at, &mut self.equations.system, &mut self.bodies, impacts);
        self.integration.interrupt();
    }

    /// Records the joints' loads at the end of a substep, if they are known or needed there.
    fn record_joint_loads(&mut self, t: f64) {
        if self.loads.needed_at_substep_end {
            // The last solve was of impulses, or before the substep's end.
            self.apply_contact_forces();
            self.equations.ensure_accelerations(&mut self.bodies, t);
        }
        if self.equations.evaluated == Evaluated::Accelerations {
            self.loads.record(&self.equations.system);
        }
    }

    /// Integrates like [`Integration::integrate`] under the forces of resting contacts, and repeats the substep where they prove
    /// wrong or a clutch slips. Returns the time used, s.
    fn integrate_substep(&mut self, substep: Substep) -> f64 {
        let Substep { t, mut h, shortest, error_control } = substep;
        self.contacts.begin_substep();
        let mut number = 1;
        loop {
            self.contacts.prepare_contact_forces(h, &self.equations.system);
            self.apply_contact_forces();
            let (integration, mut moving) = self.moving();
            // A repeated substep keeps its length.
            let error_control = if number > 1 { ErrorControl::Off } else { error_control };
            h = integration.integrate(&mut moving, Substep { t, h, shortest, error_control });
            let is_last = self.budget.is_exhausted();
            let may_shorten = !is_last && h > 2.0 * shortest;
            let outcome = self.finish_pass(Pass { h, number, is_last, may_shorten });
            self.budget.record_pass(self.bodies.len(), self.contacts.take_operations());
            match outcome {
                PassOutcome::Repeat => number += 1,
                PassOutcome::Shorten => (h, number) = (0.5 * h, 1),
                PassOutcome::ClutchSlips => {
                    self.integration.interrupt();
                    number = 1;
                }
                PassOutcome::Accepted { .. } => {
                    self.sleep.restore_sleeping(&mut self.bodies, &self.before);
                    return h;
                }
            }
            self.back_to_start();
        }
    }

    /// Solves the resting contacts at the end of a pass over a substep.
    fn finish_pass(&mut self, pass: Pass) -> PassOutcome {
        let Self { equations, contacts, bodies, before, .. } = self;
        let had_contacts = contacts.has_resting_contacts();
        let outcome = contacts.finish_pass(pass, before, &mut equations.system, bodies);
        if !had_contacts {
            return outcome;
        }
        // The rows and factor of the substep's end are reused: the joints have closed by less than matters.
        equations.evaluated = Evaluated::Nothing;
        if let PassOutcome::Accepted { pushed_apart } = outcome {
            // Contacts displace bodies through the joints to first order. Projection removes the second-order error.
            if pushed_apart {
                equations.project(bodies)
            } else {
                equations.take_over_state(bodies)
            }
            if contacts.stick_clutches(pass.h, &mut equations.system, bodies) {
                equations.evaluated = Evaluated::Nothing;
                self.integration.interrupt();
            }
        }
        outcome
    }

    /// Sums the external wrenches and those of resting contacts.
    fn apply_contact_forces(&mut self) {
        let contacts = &self.contacts;
        if self.equations.wrenches.sum_up(|wrenches| contacts.apply_contact_forces(wrenches)) {
            self.equations.evaluated = self.equations.evaluated.min(Evaluated::Factor);
        }
    }

    /// The integrators and what they advance.
    fn moving(&mut self) -> (&mut Integration, Moving<'_>) {
        let Self { integration, bodies, equations, contacts, .. } = self;
        (integration, Moving { bodies, equations, contacts })
    }

    fn back_to_start(&mut self) {
        let (integration, mut moving) = self.moving();
        integration.back_to_start(&mut moving);
    }

    /// Longest substep, s: by the tension modes, spin, the last integration error, tipping and, with event-driven impacts, sliding.
    fn longest_substep(&self, dt: f64, scheme: ImpactScheme) -> f64 {
        let spins = self.bodies.iter().map(|body| body.angular_velocity.length_squared());
        let spin = spins.fold(0.0, f64::max);
        let tension = LIMITS.tension_phase / self.loads.stiffest().sqrt();
        let longest = tension.min(LIMITS.rotation / spin.sqrt()).min(self.integration.suggested_step);
        let longest = longest.min(self.contacts.longest_substep(scheme));
        longest.max(self.shortest_substep(dt))
    }

    /// Shortest substep of a step of `dt` seconds, s.
    fn shortest_substep(&self, dt: f64) -> f64 {
        dt / if self.equations.system.is_stabilising() { LIMITS.count_open } else { LIMITS.count }
    }

    /// Joints, or the forces on them, have changed: all bodies wake, and the multistep history ends.
    fn joints_changed(&mut self) {
        self.wake_all();
        self.integration.interrupt();
        self.equations.evaluated = Evaluated::Nothing;
    }

    /// Sets the activation of constraints and springs at the time `t`.
    fn set_activations(&mut self, t: f64) {
        if self.equations.system.activity.update_activations(t) | self.equations.springs.activity.update_activations(t)
        {
            self.joints_changed();
        }
    }

    /// Breaks overloaded constraints and springs at the time `t`.
    fn break_overloaded(&mut self, t: f64) {
        self.equations.springs.break_overloaded(&self.bodies, t);
        for k in 0..self.equations.system.activity.fragile().len() {
            let system = &mut self.equations.system;
            let index = system.activity.fragile()[k];
            if system.constraint_sleeps(index) {
                continue;
            }
            let load = system.constraint_load(index);
            let together = system.is_closed(index);
            system.activity.set_reclosed(index, together);
            if system.activity.overloaded(index, load, LoadKind::Continuous) {
                system.activity.break_at(index, t);
                self.joints_changed();
            }
        }
    }

    /// Clears the events of the last step, and fires triggers by this step's breath.
    fn begin_events(&mut self) {
        let BreathSpeed { before, now } = self.breath;
        for activity in [&mut self.equations.system.activity, &mut self.equations.springs.activity] {
            activity.breaks.clear();
            activity.fired.clear();
            activity.trigger_by_breath(before, now, self.time);
        }
        self.breath.before = now;
    }

    /// Fires triggers by the step's impacts, advances the time, and recovers from invalid numbers. Returns the first body that had
    /// them. `already` is the number of impacts before the step.
    pub(super) fn end_step(&mut self, dt: f64, already: usize, impacts: &mut Vec<Impact>) -> Option<usize> {
        let Equations { system, springs, .. } = &mut self.equations;
        for impact in &impacts[already..] {
            for body in impact.bodies.into_iter().flatten() {
                system.activity.trigger_by_impact(body, impact.impulse, self.time + impact.time);
                springs.activity.trigger_by_impact(body, impact.impulse, self.time + impact.time);
            }
        }
        self.time += dt;
        let lost = self.recover();
        if lost.is_some() {
            // The step did not happen, nor did its impacts.
            impacts.truncate(already);
        }
        self.equations.system.count_revolutions(&self.bodies);
        self.equations.springs.count_revolutions(&self.bodies);
        lost
    }

    /// Puts all bodies back to the beginning of the last step, at rest, if one has invalid numbers. Returns the first such body.
    /// Every step begins with it; call it before that to read bodies that were set from outside.
    pub fn recover(&mut self) -> Option<usize> {
        let fault = self.recovery.recover(&mut self.bodies);
        if fault.is_some() {
            self.wake_all();
            self.restart();
        }
        fault
    }

    /// Restarts constrained dynamics from the bodies' present state.
    pub(super) fn restart(&mut self) {
        self.equations.system.start_trains(&self.bodies);
        self.contacts.restart(&self.bodies);
        self.contacts.find_resting_contacts(&self.bodies);
        self.loads.clear();
        self.integration.reset();
        self.equations.evaluated = Evaluated::Nothing;
    }

    /// Sets the breath's speed at the lips from the next step on, m/s; triggers depend on it.
    pub fn set_breath_speed(&mut self, speed: f64) {
        self.breath.now = speed;
    }

    /// Gives the rest length (m) or rest angle (rad) of a spring whose rest is [`soffio_math::Function::Given`], and its rate, from
    /// the next step on.
    pub fn give_rest(&mut self, spring: usize, value: f64, rate: f64) {
        self.equations.springs.give_rest(spring, value, rate);
        // Accelerations of the state that the step begins with contain the old force.
        self.equations.evaluated = self.equations.evaluated.min(Evaluated::Factor);
    }

    /// Must be called after [`Dynamics::bodies`] were changed from outside: wakes all bodies and validates them.
    pub fn disturb(&mut self) {
        self.wake_all();
        self.equations.evaluated = Evaluated::Nothing;
        self.recovery.invalidate();
    }
}
