//! Motion by the laws: Lagrange multipliers, integration, friction of pivots, impacts.
//!
//! One step is: integrate the constrained equations of motion by a method of fourth order (Adams' where motion is smooth, else
//! Runge–Kutta's), close what the joints drifted apart (projection), stop at each impact on the way, and let pivot friction act.
//!
//! Symbols as in `articulation`: C constraint value, J its Jacobian, λ multipliers. Accelerations solve
//!
//! ```text
//! M a − Jᵀ λ = F        J a = −J̇ẋ − ω₀² C − 2 ω₀ Ċ
//! ```
//!
//! The last two terms (Baumgarte 1972, critically damped) draw a scattered figure together and vanish once it is;
//! from then on projection keeps the joints closed to rounding.

mod adams;
mod answers;
mod clutches;
mod contacts;
mod course;
mod drive;
mod faults;
pub mod forces;
pub mod impulse;
mod integrate;
mod limits;
mod moved;
mod pace;
mod passes;
mod sleep;
mod told;

pub use crate::articulation::Method as Solver;
use crate::articulation::quads::State;
use crate::articulation::{Constraint, Limit, Spring, System};
use crate::collision::Collider;
use soffio_geometry::bodies::RigidBody;
use soffio_math::lanes::{Four, One};
use soffio_math::spatial::Vec6;
use soffio_math::{DMat3, DVec3};

use adams::Run;
use contacts::Verdict;
pub use contacts::{
    Contacts, ENDS, Impact, ImpactKind, Met, Resistance, Strike, Struck, SurfacePair, Touching, couple_rows, strike,
};
use course::{Course, Rate};
pub use drive::{Drive, Instant, Motion};
use forces::{Damping, Springs};
pub use moved::Moved;
use passes::{Begin, Return};
use sleep::Sleep;

/// Largest phase ω h of the stiffest tension mode in one substep, rad. The fourth-order method is stable up to 2.8;
/// such a mode holds next to none of the energy, and at 1 it loses what little it has within some ten periods.
const TENSION_PHASE: f64 = 3.2;
/// Largest turn of a body in one substep, rad.
const SPIN_PHASE: f64 = 0.25;
/// Most substeps of one step: beyond it motion is followed less finely.
const MOST_SUBSTEPS: f64 = 64.0;
/// Most edges of windows that one step stops at; those nearer to each other are stepped over.
const MOST_EDGES: f64 = 1024.0;
/// Figures of at most this many bodies, without anything to hit, are integrated precisely where nothing else is asked:
/// it costs a microsecond or two.
const FEW: usize = 8;
/// A hit's time is aimed at this often, until it is right to this, s.
const AIMS: usize = 3;
const ON_TIME: f64 = 1e-6;

/// How time is advanced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// Precise where that costs next to nothing (few bodies, no contact), else Adams' method of fourth order where motion is smooth,
    /// else Runge–Kutta.
    #[default]
    Auto,
    /// Semi-implicit Euler with projection: one solve a step, first order.
    Fast,
    /// The classical fourth-order Runge–Kutta method with projection.
    RungeKutta,
    /// The Gauss–Legendre method of sixth order: energy stays bounded over days.
    Precise,
}

/// What is constant over a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// World acceleration, m/s².
    pub gravity: DVec3,
    /// Pivot friction, damping and losses at impacts; off for tests of conservation.
    pub friction: bool,
    /// 1/ω₀ of the stabiliser, s.
    pub stabilization_time: f64,
    /// How time is advanced.
    pub integrator: Integrator,
    /// Which linear solver finds the multipliers.
    pub solver: Solver,
}

/// How much of a figure's system belongs to the present state: each the more after the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Known {
    /// Nothing: bodies have moved, or joints have changed.
    Nothing,
    /// Rows and factor, as a projection or a substep's end leaves them; not the accelerations, since forces have changed.
    Factor,
    /// The accelerations too.
    Rates,
}

/// Everything a figure needs to move.
pub struct Figure<'a> {
    /// Bodies in their start state.
    pub bodies: Vec<RigidBody>,
    /// Damping per body.
    pub damping: Vec<Damping>,
    /// Joints.
    pub constraints: &'a [Constraint],
    /// What stays within bounds.
    pub limits: &'a [Limit],
    /// Springs.
    pub springs: &'a [Spring],
    /// Bodies that follow a given motion.
    pub drives: &'a [Drive],
    /// Collision shapes, materials resolved per pair.
    pub colliders: &'a [Collider],
    /// Pairs that can meet and what their surfaces do.
    pub pairs: Vec<SurfacePair>,
}

/// A figure in motion. Nothing here allocates after [`Dynamics::new`].
#[derive(Clone)]
pub struct Dynamics {
    /// The bodies' present state. Whoever changes it from outside calls [`Dynamics::disturb`].
    pub bodies: Vec<RigidBody>,
    settings: Settings,
    precise: bool,
    /// Is there friction in any pivot?
    rubs: bool,
    /// Does anything ask at a substep's end what the joints carry there: pivots that rub, or joints that break? Else the next
    /// one's first stage tells, under its own forces.
    weighs: bool,
    springs: Springs,
    drives: Vec<Drive>,
    /// Body and acceleration of each drive at the time last asked for.
    driven_accelerations: Vec<(usize, Vec6)>,
    system: System,
    /// The same joints without trains, for movers by places.
    plain: Option<Box<System>>,
    contacts: Contacts,
    sleep: Sleep,
    /// Wrenches from outside, and with those of resting contacts.
    given: Vec<Vec6>,
    external: Vec<Vec6>,
    /// Force that each joint carried when it was last asked, N.
    loads: Vec<f64>,
    /// Stiffness of each joint's tension mode: ω² per N of load, 1/(kg m).
    levers: Vec<f64>,
    pressed: Vec<Vec6>,
    /// By quads of the joints' tree.
    courses: Vec<Course>,
    /// The steps that Adams' method goes on from.
    run: Run,
    /// h of the last substep; `None` where its error says nothing of the next.
    fourth_step: Option<f64>,
    /// Rates of the Gauss–Legendre stages, by quads.
    stages: [Vec<Rate<Four>>; 3],
    /// What a pass over the bodies found of each, for sums in their order.
    norms: Vec<[f64; 2]>,
    before: Vec<RigidBody>,
    before_step: Vec<State<f64>>,
    /// Seconds since reset, and of the present step.
    time: f64,
    dt: f64,
    /// Substep that the error allows, s.
    stride: f64,
    /// What of the system belongs to the present state.
    known: Known,
    /// Breath of the step before, and of this one, m/s.
    breath: [f64; 2],
    /// Nothing has moved or set bodies since their numbers were looked at.
    sane: bool,
    /// First body with bad numbers in the last step.
    fault: Option<usize>,
    substeps: u32,
}

impl Dynamics {
    /// A figure at its start.
    pub fn new(figure: Figure, settings: Settings) -> Self {
        let n = figure.bodies.len();
        let mut driven = vec![false; n];
        for drive in figure.drives {
            driven[drive.body] = true;
        }
        let mut bodies = figure.bodies;
        for drive in figure.drives {
            drive.motion.at(0.0).carry(&mut bodies[drive.body]);
        }
        let mut system = System::new(&bodies, &driven, figure.constraints, settings.solver);
        let plain = system
            .has_trains()
            .then(|| Box::new(System::without_trains(&bodies, &driven, figure.constraints, settings.solver)));
        system.evaluate(&bodies);
        let joints = (system.states().len(), settings.stabilization_time);
        let contacts =
            Contacts::new(figure.colliders, figure.pairs, (figure.limits, figure.constraints), &bodies, joints);
        let precise = match settings.integrator {
            Integrator::Auto => n <= FEW && contacts.is_empty(),
            Integrator::Precise => true,
            Integrator::Fast | Integrator::RungeKutta => false,
        };
        // The other methods are there to be measured by.
        let sleeps = !precise && settings.integrator != Integrator::Fast && settings.solver == Solver::Sparse;
        let ties = (figure.constraints, figure.limits, figure.springs);
        let sleep = Sleep::new(&bodies, &driven, ties, sleeps);
        let damping = if settings.friction { figure.damping } else { vec![Damping::default(); n] };
        let members = system.quads().members();
        let rubs = settings.friction && figure.constraints.iter().any(|constraint| constraint.friction.is_some());
        let stages = || vec![Rate::default(); if precise { members.len() } else { 0 }];
        let courses = members.iter().map(|members| Course::new(members.bodies.map(|body| damping[body]))).collect();
        Self {
            loads: vec![0.0; system.joints().len()],
            levers: levers(&system, &bodies),
            contacts,
            sleep,
            precise,
            rubs,
            weighs: rubs || figure.constraints.iter().any(|constraint| constraint.breaking.is_some()),
            before_step: vec![State::default(); n],
            before: bodies.clone(),
            springs: Springs::new(figure.springs, &bodies),
            drives: figure.drives.to_vec(),
            driven_accelerations: figure.drives.iter().map(|drive| (drive.body, [0.0; 6])).collect(),
            settings,
            given: vec![[0.0; 6]; n],
            external: vec![[0.0; 6]; n],
            pressed: vec![[0.0; 6]; n],
            courses,
            run: Run::default(),
            fourth_step: None,
            stages: [stages(), stages(), stages()],
            norms: vec![[0.0; 2]; n],
            system,
            plain,
            time: 0.0,
            dt: 0.0,
            stride: f64::INFINITY,
            known: Known::Nothing,
            breath: [0.0; 2],
            sane: false,
            fault: None,
            substeps: 0,
            bodies,
        }
    }

    /// Advances by `dt` seconds under constant external wrenches (N and N m about each centre of mass). Impacts on
    /// the way are appended to `impacts`. Returns the bodies that had to be restored from bad numbers.
    pub fn step(&mut self, dt: f64, external: &[Vec6], impacts: &mut Vec<Impact>) -> usize {
        // Whoever sets bodies from outside may have set them wrong.
        self.fault = None;
        let bad = self.restore_bad_bodies();
        self.sane = false;
        for (before, body) in self.before_step.iter_mut().zip(&self.bodies) {
            *before = State::of(One(0), |_| body);
        }
        self.given.copy_from_slice(external);
        while let Some(body) = self.sleep.roused(&self.bodies, &self.before, &self.given) {
            self.wake(body);
        }
        self.dt = dt;
        self.contacts.begin_step(self.time);
        self.begin_happenings();
        self.substeps = 0;
        let already = impacts.len();
        let mut done = 0.0;
        while done < dt * (1.0 - 1e-12) {
            if self.substeps > 0 && !self.bodies.iter().all(RigidBody::is_finite) {
                break;
            }
            let now = self.time + done;
            if self.known < Known::Rates {
                // What the joints carry says how long a substep may be; the rate is its first stage.
                self.press();
                self.ensure_rates(now);
                self.weigh();
            }
            let edge = self.system.activity.next_edge(now).min(self.springs.activity.next_edge(now));
            // Asked anew each time: a hit changes what there is to follow.
            let left = (dt - done).min((edge - now).max(dt / MOST_EDGES));
            let count = (left / self.substep_length(dt)).ceil().max(1.0);
            let h = left / count;
            self.set_shares(now + 0.5 * h);
            done += self.substep(h, dt, done, impacts);
            self.substeps += 1;
        }
        if self.rubs && self.bodies.iter().all(RigidBody::is_finite) {
            self.rub(dt);
        }
        let lost = self.end_step(dt, already, impacts);
        self.fall_asleep();
        bad + lost
    }

    /// Integrates `h` or less (where the error asks for it) or up to the first impact, resolves it, and returns the
    /// time used.
    fn substep(&mut self, h: f64, dt: f64, done: f64, impacts: &mut Vec<Impact>) -> f64 {
        self.by_quads(Begin);
        self.run.begin();
        let collides = !self.contacts.is_empty();
        if collides || self.contacts.clutches().count() > 0 || self.sleep.any() {
            self.before.copy_from_slice(&self.bodies);
        }
        let now = self.time + done;
        let least = dt / MOST_SUBSTEPS;
        let mut used = self.hold(now, h, least, false);
        if collides {
            if let Some(hit) = self.contacts.first_impact(&self.before, &self.bodies) {
                let mut until = used * hit.s;
                let whole = used;
                for aim in 1..=AIMS {
                    self.back_to_start();
                    self.contacts.cut_substep();
                    // Shorter than what went well: it goes well.
                    used = if until > 0.0 { self.hold(now, until, least.min(until), true) } else { 0.0 };
                    let early = self.contacts.early(&hit, &self.bodies);
                    let better = (until + early).clamp(0.0, whole);
                    if aim == AIMS || used < until || (better - until).abs() < ON_TIME {
                        break;
                    }
                    until = better;
                }
                // A substep that had to be shorter still comes upon the hit again.
                if used >= until {
                    self.wake_for(&hit);
                    self.prepare_impulses();
                    let at = (done + used, h);
                    self.contacts.resolve_hit(&hit, at, &mut self.system, &mut self.bodies, impacts);
                    self.run.end();
                }
            }
            while let Some(body) = self.contacts.leant_on() {
                self.wake(body);
            }
            self.contacts.end_substep(&self.bodies);
        }
        if self.weighs {
            // What the joints carry: the last solve was of impulses, or before the substep's end.
            self.press();
            self.ensure_rates(now + used);
        }
        if self.known == Known::Rates {
            self.weigh();
        }
        self.break_overloaded(now + used);
        used
    }

    /// Notes what the joints carry.
    fn weigh(&mut self) {
        for (joint, load) in self.loads.iter_mut().enumerate() {
            if self.system.is_weighed(joint) {
                *load = self.system.load(joint);
            }
        }
    }

    /// Integrates like [`Dynamics::integrate`] under the forces that hold what rests, again where they prove wrong or a clutch
    /// gives way; `sure` says that the error need not be asked.
    fn hold(&mut self, t: f64, mut h: f64, least: f64, sure: bool) -> f64 {
        self.contacts.begin_substep();
        let mut pass = 1;
        loop {
            self.contacts.lay_out(h, &self.system);
            self.press();
            h = self.integrate(t, h, if sure || pass > 1 { h } else { least });
            match self.settle(h, pass, least) {
                Verdict::Again => pass += 1,
                Verdict::Shorter => (h, pass) = (0.5 * h, 1),
                Verdict::Slips => {
                    self.run.end();
                    pass = 1;
                }
                Verdict::Stands { .. } => {
                    self.keep_asleep();
                    return h;
                }
            }
            self.back_to_start();
        }
    }

    /// Looks what a pass over a substep of `h` seconds has come to, and puts right what rests.
    fn settle(&mut self, h: f64, pass: usize, least: f64) -> Verdict {
        let rests = self.contacts.anything_rests();
        let (before, system) = (&self.before, &mut self.system);
        let verdict = self.contacts.settle((h, pass, h > 2.0 * least), before, system, &mut self.bodies);
        if !rests {
            return verdict;
        }
        // Rows and factor of the substep's end serve: joints have closed since by less than what matters to them.
        self.known = Known::Nothing;
        if let Verdict::Stands { moved } = verdict {
            // Contacts move bodies by first-order steps through the joints: what is left of second order goes here.
            if moved {
                self.project()
            } else {
                self.look_at_rates()
            }
            if self.contacts.take_hold(h, &mut self.system, &self.bodies) {
                self.run.end();
                self.known = Known::Nothing;
            }
        }
        verdict
    }

    /// All wrenches: those from outside, and those of what rests.
    fn press(&mut self) {
        self.pressed.copy_from_slice(&self.given);
        self.contacts.press(&mut self.pressed);
        if self.pressed != self.external {
            std::mem::swap(&mut self.pressed, &mut self.external);
            self.known = self.known.min(Known::Factor);
        }
    }

    /// Integrates from the substep's start at the time `t` over `h`, or over less where the error asks for it, but
    /// not less than `least`; returns the time used.
    fn integrate(&mut self, t: f64, mut h: f64, least: f64) -> f64 {
        let whole = h > 0.999 * self.dt;
        if whole && !self.precise && self.settings.integrator == Integrator::Auto && self.adams(t, h) {
            self.known = Known::Factor;
            self.stride = f64::INFINITY;
            return h;
        }
        loop {
            let (good, wish) = if self.settings.integrator == Integrator::Fast {
                self.euler(t, h);
                (true, f64::INFINITY)
            } else if self.precise {
                let settled = self.gauss(t, h);
                (settled, if settled { f64::INFINITY } else { 0.5 * h })
            } else {
                let error = self.runge_kutta(t, h);
                pace::judge(h, self.dt, error)
            };
            self.known = Known::Rates;
            self.stride = wish;
            if good || h <= least {
                return h;
            }
            self.back_to_start();
            self.fourth_step = None;
            h = wish.min(0.5 * h).max(least);
        }
    }

    fn back_to_start(&mut self) {
        self.by_quads(Return);
        self.known = Known::Nothing;
    }

    /// Longest substep that follows the fastest motion: the tension modes (a body that hangs by the arm r under the
    /// load λ swings about it with ω² = |λ| |r| / I⊥), the free spin, and what the last error allowed.
    fn substep_length(&self, dt: f64) -> f64 {
        let stiffest = self.loads.iter().zip(&self.levers).fold(0.0, |most: f64, (load, lever)| most.max(load * lever));
        let spins = self.bodies.iter().map(|body| body.angular_velocity.length_squared());
        let spin = spins.fold(0.0, f64::max);
        let longest = (TENSION_PHASE / stiffest.sqrt())
            .min(SPIN_PHASE / spin.sqrt())
            .min(self.stride)
            .min(self.contacts.longest_substep());
        longest.max(dt / MOST_SUBSTEPS)
    }

    fn set_shares(&mut self, t: f64) {
        if self.system.activity.set_shares(t) | self.springs.activity.set_shares(t) {
            self.wake_all();
            self.run.end();
            self.known = Known::Nothing;
        }
    }

    /// Breaks what carries too much at the time `t`.
    fn break_overloaded(&mut self, t: f64) {
        self.springs.break_overloaded(&self.bodies, t);
        for k in 0..self.system.activity.fragile().len() {
            let index = self.system.activity.fragile()[k];
            if self.system.constraint_sleeps(index) {
                continue;
            }
            let load = self.system.carried(index);
            let together = self.system.is_together(index);
            self.system.activity.mended(index, together);
            if self.system.activity.overloaded(index, load, false) {
                self.system.activity.break_at(index, t);
                self.wake_all();
                self.run.end();
                self.known = Known::Nothing;
            }
        }
    }

    /// Forgets what happened in the last step, and fires the triggers that waited for this step's breath.
    fn begin_happenings(&mut self) {
        let [before, speed] = self.breath;
        for activity in [&mut self.system.activity, &mut self.springs.activity] {
            activity.breaks.clear();
            activity.fired.clear();
            activity.breathe(before, speed, self.time);
        }
        self.breath[0] = speed;
    }

    /// Sets the breath's speed at the lips from the next step on, m/s; triggers wait for it.
    pub fn breathe(&mut self, speed: f64) {
        self.breath[1] = speed;
    }

    /// Says that bodies were moved from outside.
    pub fn disturb(&mut self) {
        self.wake_all();
        (self.known, self.sane) = (Known::Nothing, false);
    }
}

/// ω² per N of load of each joint's tension mode: the greatest |r| / I⊥ of its bodies at the start, 1/(kg m). Arms and
/// inertias turn with their body, so it stays what it is.
fn levers(system: &System, bodies: &[RigidBody]) -> Vec<f64> {
    let lever = |body: usize, arm: DVec3| arm.length() / least_inertia_across(&bodies[body].inertia_world(), arm);
    let of_joint = |index: usize| {
        let (arm_a, arm_b) = system.arms(index);
        let link = system.joints()[index].link;
        let own = |body: usize, arm| if system.driven()[body] { 0.0 } else { lever(body, arm) };
        own(link.a, arm_a).max(link.b.map_or(0.0, |b| own(b, arm_b)))
    };
    (0..system.joints().len()).map(of_joint).collect()
}

/// Smallest moment of inertia about an axis across `arm`, kg m².
pub(in crate::dynamics) fn least_inertia_across(inertia: &DMat3, arm: DVec3) -> f64 {
    let Some(n) = arm.try_normalize() else { return f64::INFINITY };
    let (t, b) = soffio_math::tangents(n);
    let (tt, bb, tb) = (t.dot(*inertia * t), b.dot(*inertia * b), t.dot(*inertia * b));
    0.5 * (tt + bb) - (0.25 * (tt - bb) * (tt - bb) + tb * tb).sqrt()
}
