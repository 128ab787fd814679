//! One step of a figure, stage by stage.

use super::contacts::{Contacts, EarliestImpact, Impact, LAST_PASS, PassOutcome};
use super::equations::{Equations, Evaluated};
use super::integrate::{Integration, Moving};
use super::joint_loads::JointLoads;
use super::recovery::Recovery;
use super::settings::Settings;
use super::sleep::Sleep;
use super::work_budget::WorkBudget;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::Vec6;

/// Largest phase ω h of the stiffest tension mode in one substep, rad. The fourth-order method is stable up to 2.8;
/// such a mode holds next to none of the energy, and at 1 it loses what little it has within some ten periods.
const TENSION_PHASE: f64 = 3.2;
/// Largest turn of a body in one substep, rad.
const SPIN_PHASE: f64 = 0.25;
/// Most substeps of one step: beyond it motion is followed less finely.
const MOST_SUBSTEPS: f64 = 64.0;
/// The same while joints are open. How they close is made up, not physics: nothing is gained by following it closely, and a
/// scattered clock would need all of the above at every step.
const MOST_SUBSTEPS_OPEN: f64 = 16.0;
/// Most edges of windows that one step stops at; those nearer to each other are stepped over.
const MOST_EDGES: f64 = 1024.0;
/// A hit's time is aimed at this often, until it is right to this, s.
const MAX_AIMS: usize = 3;
const ON_TIME: f64 = 1e-6;

/// A figure in motion. Nothing here allocates after [`Dynamics::new`].
#[derive(Clone)]
pub struct Dynamics {
    /// The bodies' present state. Whoever changes it from outside calls [`Dynamics::disturb`].
    pub bodies: Vec<RigidBody>,
    pub(super) settings: Settings,
    pub(super) equations: Equations,
    pub(super) integration: Integration,
    pub(super) contacts: Contacts,
    pub(super) budget: WorkBudget,
    pub(super) loads: JointLoads,
    pub(super) sleep: Sleep,
    pub(super) recovery: Recovery,
    /// The bodies where the present substep began.
    pub(super) before: Vec<RigidBody>,
    /// Seconds since reset.
    pub(super) time: f64,
    /// Breath of the step before, and of this one, m/s.
    pub(super) breath: [f64; 2],
    /// Substeps of the present step.
    pub(super) substeps: u32,
}

impl Dynamics {
    /// Advances by `dt` seconds under constant external wrenches (N and N m about each centre of mass). Impacts on
    /// the way are appended to `impacts`. Returns the first body with bad numbers, before or after, because of which the figure
    /// was put back.
    pub fn step(&mut self, dt: f64, external: &[Vec6], impacts: &mut Vec<Impact>) -> Option<usize> {
        // Whoever sets bodies from outside may have set them wrong.
        let bad = self.recover_bad_bodies();
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
            self.evaluate_first_stage(now);
            let together = self.budget.is_exhausted() && !self.contacts.is_empty();
            let h = self.next_substep(now, dt - done, (dt, together));
            self.set_shares(now + 0.5 * h);
            done += if together {
                self.substep_time_stepping(h, dt, done, impacts)
            } else {
                self.substep(h, dt, done, impacts)
            };
            self.substeps += 1;
        }
        if self.loads.has_friction && self.bodies.iter().all(RigidBody::is_finite) {
            self.equations.apply_pivot_friction(&mut self.bodies, self.loads.all(), dt);
        }
        let lost = self.end_step(dt, already, impacts);
        self.fall_asleep(dt);
        bad.or(lost)
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

    /// What the joints carry says how long a substep may be; the rate is its first stage.
    fn evaluate_first_stage(&mut self, now: f64) {
        if self.equations.evaluated < Evaluated::Accelerations {
            self.apply_contact_forces();
            self.equations.ensure_accelerations(&mut self.bodies, now);
            self.loads.record(&self.equations.system);
        }
    }

    /// How long the next substep is to be, with `left` of the step's `dt` seconds left at the time `now`.
    fn next_substep(&self, now: f64, left: f64, (dt, together): (f64, bool)) -> f64 {
        let Equations { system, springs, .. } = &self.equations;
        let edge = system.activity.next_edge(now).min(springs.activity.next_edge(now));
        // Asked anew each time: a hit changes what there is to follow.
        let left = left.min((edge - now).max(dt / MOST_EDGES));
        let count = (left / self.substep_length(dt, together)).ceil().max(1.0);
        left / count
    }

    /// Integrates `h` or less (where the error asks for it) or up to the first impact, resolves it, and returns the
    /// time used.
    fn substep(&mut self, h: f64, dt: f64, done: f64, impacts: &mut Vec<Impact>) -> f64 {
        let (integration, mut moving) = self.moving();
        integration.begin_substep(&mut moving);
        let collides = !self.contacts.is_empty();
        if collides || self.contacts.clutches().count() > 0 || self.sleep.any() {
            self.before.copy_from_slice(&self.bodies);
        }
        let now = self.time + done;
        let least = self.shortest_substep(dt);
        let mut used = self.integrate_substep(now, h, least, false);
        if collides {
            if let Some(hit) = self.contacts.first_impact(&self.before, &self.bodies) {
                let until;
                (used, until) = self.integrate_to_impact(&hit, now, used, least);
                // A substep that had to be shorter still comes upon the hit again.
                if used >= until {
                    self.resolve_impact(&hit, (done + used, h), impacts);
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

    /// Integrates `h` seconds or less (where the error asks for it) as if nothing were in the way, puts right at their end what met
    /// or rests, and returns the time used.
    fn substep_time_stepping(&mut self, h: f64, dt: f64, done: f64, impacts: &mut Vec<Impact>) -> f64 {
        let now = self.time + done;
        let least = self.shortest_substep(dt);
        let (integration, mut moving) = self.moving();
        integration.begin_substep(&mut moving);
        self.before.copy_from_slice(&self.bodies);
        self.contacts.begin_substep();
        self.contacts.prepare_contact_forces_once(h, &self.equations.system);
        self.apply_contact_forces();
        let (integration, mut moving) = self.moving();
        let h = integration.integrate(&mut moving, now, h, least);
        while self.sleep.any()
            && let Some(body) = self.contacts.sleeper_hit(&self.before, &self.bodies)
        {
            self.wake(body);
        }
        self.equations.prepare_impulses(&self.bodies);
        let Self { equations, contacts, bodies, before, .. } = self;
        contacts.finish_time_step((done, h), before, &mut equations.system, bodies, impacts);
        contacts.stick(h, &mut equations.system, bodies);
        self.equations.project(&mut self.bodies);
        self.integration.interrupt();
        self.sleep.keep(&mut self.bodies, &self.before);
        while let Some(body) = self.contacts.disturbed_sleeper() {
            self.wake(body);
        }
        self.contacts.end_substep(&self.bodies);
        self.record_joint_loads(now + h);
        self.break_overloaded(now + h);
        self.budget.record_pass(self.bodies.len(), self.contacts.take_operations());
        h
    }

    /// Goes through a substep of `whole` seconds again, up to a hit on its way. Returns the time used, and the time aimed at.
    fn integrate_to_impact(&mut self, hit: &EarliestImpact, now: f64, whole: f64, least: f64) -> (f64, f64) {
        let (mut used, mut until) = (whole, whole * hit.s);
        for aim in 1..=MAX_AIMS {
            self.back_to_start();
            self.contacts.cut_substep();
            // Shorter than what went well: it goes well.
            used = if until > 0.0 { self.integrate_substep(now, until, least.min(until), true) } else { 0.0 };
            let early = self.contacts.time_to_contact(hit, &self.bodies);
            let better = (until + early).clamp(0.0, whole);
            if aim == MAX_AIMS || used < until || (better - until).abs() < ON_TIME {
                break;
            }
            until = better;
        }
        (used, until)
    }

    /// Resolves a hit where the bodies are; `at` is its time in the step and the length of a substep.
    fn resolve_impact(&mut self, hit: &EarliestImpact, at: (f64, f64), impacts: &mut Vec<Impact>) {
        self.wake_for(hit);
        self.equations.prepare_impulses(&self.bodies);
        self.contacts.resolve_impact(hit, at, &mut self.equations.system, &mut self.bodies, impacts);
        self.integration.interrupt();
    }

    /// Notes what the joints carry at the end of a substep, as far as that is known or asked.
    fn record_joint_loads(&mut self, t: f64) {
        if self.loads.needed_at_substep_end {
            // What the joints carry: the last solve was of impulses, or before the substep's end.
            self.apply_contact_forces();
            self.equations.ensure_accelerations(&mut self.bodies, t);
        }
        if self.equations.evaluated == Evaluated::Accelerations {
            self.loads.record(&self.equations.system);
        }
    }

    /// Integrates like [`Integration::integrate`] under the forces that hold what rests, again where they prove wrong or a clutch
    /// gives way; `sure` says that the error need not be asked.
    fn integrate_substep(&mut self, t: f64, mut h: f64, least: f64, sure: bool) -> f64 {
        self.contacts.begin_substep();
        let mut pass = 1;
        loop {
            self.contacts.prepare_contact_forces(h, &self.equations.system);
            self.apply_contact_forces();
            let (integration, mut moving) = self.moving();
            h = integration.integrate(&mut moving, t, h, if sure || pass > 1 { h } else { least });
            // A pass more would be too much: the forces are as good as they get.
            let last = self.budget.is_exhausted();
            let verdict = self.finish_pass(h, if last { LAST_PASS } else { pass }, if last { h } else { least });
            self.budget.record_pass(self.bodies.len(), self.contacts.take_operations());
            match verdict {
                PassOutcome::Repeat => pass += 1,
                PassOutcome::Shorten => (h, pass) = (0.5 * h, 1),
                PassOutcome::ClutchSlips => {
                    self.integration.interrupt();
                    pass = 1;
                }
                PassOutcome::Accepted { .. } => {
                    self.sleep.keep(&mut self.bodies, &self.before);
                    return h;
                }
            }
            self.back_to_start();
        }
    }

    /// Looks what a pass over a substep of `h` seconds has come to, and puts right what rests.
    fn finish_pass(&mut self, h: f64, pass: usize, least: f64) -> PassOutcome {
        let Self { equations, contacts, bodies, before, .. } = self;
        let rests = contacts.has_resting_contacts();
        let verdict = contacts.finish_pass((h, pass, h > 2.0 * least), before, &mut equations.system, bodies);
        if !rests {
            return verdict;
        }
        // Rows and factor of the substep's end serve: joints have closed since by less than what matters to them.
        equations.evaluated = Evaluated::Nothing;
        if let PassOutcome::Accepted { moved } = verdict {
            // Contacts move bodies by first-order steps through the joints: what is left of second order goes here.
            if moved {
                equations.project(bodies)
            } else {
                equations.take_over_state(bodies)
            }
            if contacts.stick(h, &mut equations.system, bodies) {
                equations.evaluated = Evaluated::Nothing;
                self.integration.interrupt();
            }
        }
        verdict
    }

    /// All wrenches: those from outside, and those of what rests.
    fn apply_contact_forces(&mut self) {
        let contacts = &self.contacts;
        if self.equations.wrenches.sum_up(|wrenches| contacts.apply_contact_forces(wrenches)) {
            self.equations.evaluated = self.equations.evaluated.min(Evaluated::Factor);
        }
    }

    /// The integrators, and what they move.
    fn moving(&mut self) -> (&mut Integration, Moving<'_>) {
        let Self { integration, bodies, equations, contacts, .. } = self;
        (integration, Moving { bodies, equations, contacts })
    }

    fn back_to_start(&mut self) {
        let (integration, mut moving) = self.moving();
        integration.back_to_start(&mut moving);
    }

    /// Longest substep that follows the fastest motion: the tension modes, the free spin, what the last error allowed, what tips and,
    /// unless contact is solved `together`, what slides.
    fn substep_length(&self, dt: f64, together: bool) -> f64 {
        let spins = self.bodies.iter().map(|body| body.angular_velocity.length_squared());
        let spin = spins.fold(0.0, f64::max);
        let mut longest = (TENSION_PHASE / self.loads.stiffest().sqrt())
            .min(SPIN_PHASE / spin.sqrt())
            .min(self.integration.suggested_step);
        longest = longest.min(self.contacts.longest_substep(together));
        longest.max(self.shortest_substep(dt))
    }

    /// The shortest substep of a step of `dt` seconds, s.
    fn shortest_substep(&self, dt: f64) -> f64 {
        dt / if self.equations.system.gathers() { MOST_SUBSTEPS_OPEN } else { MOST_SUBSTEPS }
    }

    /// Joints or what acts on them have changed: all wake, and nothing goes on from what was.
    fn joints_changed(&mut self) {
        self.wake_all();
        self.integration.interrupt();
        self.equations.evaluated = Evaluated::Nothing;
    }

    fn set_shares(&mut self, t: f64) {
        if self.equations.system.activity.set_shares(t) | self.equations.springs.activity.set_shares(t) {
            self.joints_changed();
        }
    }

    /// Breaks what carries too much at the time `t`.
    fn break_overloaded(&mut self, t: f64) {
        self.equations.springs.break_overloaded(&self.bodies, t);
        for k in 0..self.equations.system.activity.fragile().len() {
            let system = &mut self.equations.system;
            let index = system.activity.fragile()[k];
            if system.constraint_sleeps(index) {
                continue;
            }
            let load = system.carried(index);
            let together = system.is_together(index);
            system.activity.mended(index, together);
            if system.activity.overloaded(index, load, false) {
                system.activity.break_at(index, t);
                self.joints_changed();
            }
        }
    }

    /// Forgets what happened in the last step, and fires the triggers that waited for this step's breath.
    fn begin_events(&mut self) {
        let [before, speed] = self.breath;
        for activity in [&mut self.equations.system.activity, &mut self.equations.springs.activity] {
            activity.breaks.clear();
            activity.fired.clear();
            activity.breathe(before, speed, self.time);
        }
        self.breath[0] = speed;
    }

    /// Fires what waited for the step's hits, lets time go on and puts back what broke down. Returns the first bad body.
    pub(super) fn end_step(&mut self, dt: f64, already: usize, impacts: &mut Vec<Impact>) -> Option<usize> {
        let Equations { system, springs, .. } = &mut self.equations;
        for impact in &impacts[already..] {
            for body in impact.bodies.into_iter().flatten() {
                system.activity.hit(body, impact.impulse, self.time + impact.time);
                springs.activity.hit(body, impact.impulse, self.time + impact.time);
            }
        }
        self.time += dt;
        let lost = self.recover_bad_bodies();
        if lost.is_some() {
            // What went wrong did not happen.
            impacts.truncate(already);
        }
        self.equations.system.count_turns(&self.bodies);
        self.equations.springs.count_turns(&self.bodies);
        lost
    }

    /// Puts the figure back to where the last step began if a body has bad numbers; returns the first such body. A step
    /// begins with it: whoever looks at the bodies before that, and may have set them, calls it himself.
    pub fn recover(&mut self) -> Option<usize> {
        self.recover_bad_bodies()
    }

    /// Puts bodies with bad numbers back to where the step began, at rest. Returns the first of them.
    pub(super) fn recover_bad_bodies(&mut self) -> Option<usize> {
        let fault = self.recovery.restore(&mut self.bodies);
        if fault.is_some() {
            self.wake_all();
            self.restart();
        }
        fault
    }

    /// The laws start anew from where the bodies are.
    pub(super) fn restart(&mut self) {
        self.equations.system.begin_trains(&self.bodies);
        self.contacts.forget(&self.bodies);
        self.contacts.find_resting_contacts(&self.bodies);
        self.loads.forget();
        self.integration.reset();
        self.equations.evaluated = Evaluated::Nothing;
    }

    /// Sets the breath's speed at the lips from the next step on, m/s; triggers wait for it.
    pub fn set_breath_speed(&mut self, speed: f64) {
        self.breath[1] = speed;
    }

    /// Says that bodies were moved from outside.
    pub fn disturb(&mut self) {
        self.wake_all();
        self.equations.evaluated = Evaluated::Nothing;
        self.recovery.invalidate();
    }
}
