//! What the integrators do to every body, four at a time.
//!
//! Each pass goes through the quads in the tree's order. What it reads of the bodies is gathered into lanes, what it
//! changes goes back body by body; sums over bodies are made afterwards in the bodies' own order ([`Dynamics::norms`]),
//! so that they do not depend on who stands beside whom.

use fearless_simd::{Simd, dispatch};

use super::adams::less;
use super::course::{Rate, advance};
use super::integrate::{GAUSS_NODES, WEIGHTS};
use super::{Dynamics, forces};
use crate::articulation::ball::Twist;
use crate::articulation::quads::{Members, Quad, State};
use soffio_math::lanes::{All, Lanes, Real, V3};
use soffio_math::spatial::Sym3;

/// Slower motion than this is followed no more closely than this one, m/s.
pub(super) const SLOWEST: f64 = 1e-3;

/// Something that is done to every quad in which somebody is awake.
pub(super) trait Pass: Copy {
    /// Does it to the `index`th.
    fn go<L: Lanes>(self, lanes: L, dynamics: &mut Dynamics, index: usize);
}

impl Dynamics {
    /// Does it to all quads.
    pub(super) fn by_quads(&mut self, pass: impl Pass) {
        dispatch!(self.system.quads().level(), simd => self.by_quads_in(simd, pass));
    }

    #[inline(always)]
    fn by_quads_in<S: Simd>(&mut self, simd: S, pass: impl Pass) {
        for k in 0..self.system.quads().moving().len() {
            let index = self.system.quads().moving()[k];
            pass.go(All(simd), self, index);
        }
    }

    #[inline(always)]
    pub(super) fn quad(&self, index: usize) -> (Members, &Quad) {
        let quads = self.system.quads();
        (quads.members()[index], &quads.all()[index])
    }

    /// The accelerations found last.
    #[inline(always)]
    pub(super) fn accelerations<L: Lanes>(&self, lanes: L, members: &Members) -> Twist<L::T> {
        Twist::gather(lanes, |k| &self.system.a[members.bodies[k]])
    }

    /// Puts bodies into this state.
    #[inline(always)]
    pub(super) fn put<L: Lanes>(&mut self, lanes: L, index: usize, state: &State<L::T>) {
        self.system.quads_mut().all_mut()[index].put(lanes, state);
    }
}

/// Notes where the bodies are: a substep begins.
#[derive(Clone, Copy)]
pub(super) struct Begin;

impl Pass for Begin {
    #[inline(always)]
    fn go<L: Lanes>(self, lanes: L, dynamics: &mut Dynamics, index: usize) {
        let (members, _) = dynamics.quad(index);
        let state = State::of(lanes, |k| &dynamics.bodies[members.bodies[k]]);
        dynamics.courses[index].start.set(lanes, &state);
    }
}

/// Puts the bodies back to where the substep began.
#[derive(Clone, Copy)]
pub(super) struct Return;

impl Pass for Return {
    #[inline(always)]
    fn go<L: Lanes>(self, lanes: L, dynamics: &mut Dynamics, index: usize) {
        let (members, _) = dynamics.quad(index);
        let state = dynamics.courses[index].start.get(lanes);
        state.put(lanes, &members, &mut dynamics.bodies);
    }
}

/// Lets the bodies be where the quads are.
#[derive(Clone, Copy)]
pub(super) struct Show;

impl Pass for Show {
    #[inline(always)]
    fn go<L: Lanes>(self, lanes: L, dynamics: &mut Dynamics, index: usize) {
        let (members, quad) = dynamics.quad(index);
        let state = quad.state.get(lanes);
        state.put(lanes, &members, &mut dynamics.bodies);
    }
}

/// From one Runge–Kutta stage to the next: takes the rate at this one, of this weight, and goes on with it from the
/// start over `h`.
#[derive(Clone, Copy)]
pub(super) struct Stage {
    pub first: bool,
    pub weight: f64,
    pub h: f64,
}

impl Pass for Stage {
    #[inline(always)]
    fn go<L: Lanes>(self, lanes: L, dynamics: &mut Dynamics, index: usize) {
        let (members, quad) = dynamics.quad(index);
        let a = dynamics.accelerations(lanes, &members);
        let course = &dynamics.courses[index];
        let start = course.start.get(lanes);
        let (rate, mut mean) = if self.first {
            let zero = start.velocity.x.all(0.0);
            let none = V3 { x: zero, y: zero, z: zero };
            let mean = Rate { velocity: none, turn: none, acceleration: Twist { linear: none, angular: none } };
            (Rate::of(start.velocity, start.spin, none, a), mean)
        } else {
            let (velocity, spin) = (quad.state.velocity.get(lanes), quad.state.spin.get(lanes));
            (Rate::of(velocity, spin, course.turned.get(lanes), a), course.mean.get(lanes))
        };
        mean.add(self.weight, &rate);
        let (state, turned) = advance(lanes, &start, self.h, &rate);
        let course = &mut dynamics.courses[index];
        if self.first {
            course.begun.put(lanes, &a);
        }
        course.mean.set(lanes, &mean);
        course.turned.put(lanes, turned);
        dynamics.put(lanes, index, &state);
    }
}

/// From the last Runge–Kutta stage to the end of the substep of `h`.
#[derive(Clone, Copy)]
pub(super) struct Last {
    pub h: f64,
}

impl Pass for Last {
    #[inline(always)]
    fn go<L: Lanes>(self, lanes: L, dynamics: &mut Dynamics, index: usize) {
        let (members, quad) = dynamics.quad(index);
        let a = dynamics.accelerations(lanes, &members);
        let course = &dynamics.courses[index];
        let rate = Rate::of(quad.state.velocity.get(lanes), quad.state.spin.get(lanes), course.turned.get(lanes), a);
        let mut mean = course.mean.get(lanes);
        mean.add(WEIGHTS[3], &rate);
        let (state, _) = advance(lanes, &course.start.get(lanes), self.h, &mean);
        dynamics.courses[index].last.put(lanes, &a);
        dynamics.put(lanes, index, &state);
    }
}

/// What the new rate says of the error (`integrate.rs`): each body's share of the two sums.
#[derive(Clone, Copy)]
pub(super) struct Estimate {
    pub per_cube: f64,
    pub spread: f64,
    /// Was there a substep before?
    pub before: bool,
    /// Where the change since the substep began goes.
    pub slot: usize,
}

impl Pass for Estimate {
    #[inline(always)]
    fn go<L: Lanes>(self, lanes: L, dynamics: &mut Dynamics, index: usize) {
        let (members, quad) = dynamics.quad(index);
        let (mass, inertia) = (lanes.get(&quad.mass), quad.inertia.get(lanes));
        let a = dynamics.accelerations(lanes, &members);
        let course = &dynamics.courses[index];
        let (last, before) = (course.last.get(lanes), course.fourth.get(lanes));
        let (per_cube, spread) = (mass.all(self.per_cube), mass.all(self.spread));
        let fourth =
            Twist { linear: (a.linear - last.linear) * per_cube, angular: (a.angular - last.angular) * per_cube };
        let mut change = fourth;
        if self.before {
            change.linear -= before.linear;
            change.angular -= before.angular;
        }
        change = Twist { linear: change.linear * spread, angular: change.angular * spread };
        let now = Twist { linear: quad.state.velocity.get(lanes), angular: quad.state.spin.get(lanes) };
        let error = norm(mass, &inertia, &change);
        let slowest = mass.all(SLOWEST);
        let scale = norm(mass, &inertia, &now) + mass * slowest * slowest;
        let changed = less(a, course.begun.get(lanes));
        let course = &mut dynamics.courses[index];
        course.differences[self.slot].put(lanes, &changed);
        course.fourth.put(lanes, &fourth);
        lanes.scatter(members.count, &[error, scale], |lane, norm| dynamics.norms[members.bodies[lane]] = *norm);
    }
}

/// v·M v.
#[inline(always)]
pub(super) fn norm<T: Real>(mass: T, inertia: &Sym3<T>, v: &Twist<T>) -> T {
    mass * v.linear.dot(v.linear) + v.angular.dot(inertia.mul(v.angular))
}

/// Gravity, damping, the gyroscopic torque and what comes from outside.
#[derive(Clone, Copy)]
pub(super) struct Push;

impl Pass for Push {
    #[inline(always)]
    fn go<L: Lanes>(self, lanes: L, dynamics: &mut Dynamics, index: usize) {
        let (members, quad) = dynamics.quad(index);
        let gravity = dynamics.settings.gravity;
        let external = Twist::gather(lanes, |k| &dynamics.external[members.bodies[k]]);
        let [linear, angular] = dynamics.courses[index].damping.each_ref().map(|rate| lanes.get(rate));
        let motion = (quad.state.velocity.get(lanes), quad.state.spin.get(lanes));
        let (mass, inertia) = (lanes.get(&quad.mass), quad.inertia.get(lanes));
        let own = forces::on_body((mass, &inertia), motion, gravity, (linear, angular));
        let push = Twist { linear: own.linear + external.linear, angular: own.angular + external.angular };
        let b = &mut dynamics.system.b;
        lanes.scatter(members.count, &push.numbers(), |lane, push| b[members.bodies[lane]] = *push);
    }
}

/// The first guess of the three Gauss rates of a substep of `h`.
#[derive(Clone, Copy)]
pub(super) struct Guess {
    pub h: f64,
}

impl Pass for Guess {
    #[inline(always)]
    fn go<L: Lanes>(self, lanes: L, dynamics: &mut Dynamics, index: usize) {
        let (members, _) = dynamics.quad(index);
        let a = dynamics.accelerations(lanes, &members);
        let start = dynamics.courses[index].start.get(lanes);
        let zero = start.velocity.x.all(0.0);
        let rate = Rate::of(start.velocity, start.spin, V3 { x: zero, y: zero, z: zero }, a);
        // A body's velocity changes as its acceleration says, which is the better first guess.
        for (rates, node) in dynamics.stages.iter_mut().zip(GAUSS_NODES) {
            let ahead = zero.all(node * self.h);
            let mut guess = rate;
            guess.velocity += a.linear * ahead;
            guess.turn += a.angular * ahead;
            rates[index].set(lanes, &guess);
        }
    }
}

/// From the start over `h` by these shares of the three Gauss rates.
#[derive(Clone, Copy)]
pub(super) struct Mean {
    pub weights: [f64; 3],
    pub h: f64,
}

impl Pass for Mean {
    #[inline(always)]
    fn go<L: Lanes>(self, lanes: L, dynamics: &mut Dynamics, index: usize) {
        let start = dynamics.courses[index].start.get(lanes);
        let zero = start.velocity.x.all(0.0);
        let none = V3 { x: zero, y: zero, z: zero };
        let mut mean = Rate { velocity: none, turn: none, acceleration: Twist { linear: none, angular: none } };
        for (rates, weight) in dynamics.stages.iter().zip(self.weights) {
            mean.add(weight, &rates[index].get(lanes));
        }
        let (state, turned) = advance(lanes, &start, self.h, &mean);
        dynamics.courses[index].turned.put(lanes, turned);
        dynamics.put(lanes, index, &state);
    }
}

/// Takes over the rate of a Gauss stage: by how much it changed and how large it is, in squares.
#[derive(Clone, Copy)]
pub(super) struct Compare {
    pub stage: usize,
}

impl Pass for Compare {
    #[inline(always)]
    fn go<L: Lanes>(self, lanes: L, dynamics: &mut Dynamics, index: usize) {
        let (members, quad) = dynamics.quad(index);
        let a = dynamics.accelerations(lanes, &members);
        let turned = dynamics.courses[index].turned.get(lanes);
        let rate = Rate::of(quad.state.velocity.get(lanes), quad.state.spin.get(lanes), turned, a);
        let old = dynamics.stages[self.stage][index].get(lanes);
        let (linear, angular) = (a.linear - old.acceleration.linear, a.angular - old.acceleration.angular);
        let turn = rate.turn - old.turn;
        let change = linear.dot(linear) + angular.dot(angular) + turn.dot(turn);
        let size = a.linear.dot(a.linear) + a.angular.dot(a.angular) + rate.turn.dot(rate.turn);
        dynamics.stages[self.stage][index].set(lanes, &rate);
        lanes.scatter(members.count, &[change, size], |lane, norm| dynamics.norms[members.bodies[lane]] = *norm);
    }
}
