//! Factor and solves of the tree (`tree.rs`): sweeps over its steps, from the leaves or from the roots.
//!
//! A quad's bodies are eliminated together. What they leave to their parents is added body by body, the last first, so
//! that sums come out the same however the bodies are put together.

use fearless_simd::Simd;

use super::ball::{Arms, Ball, Twist};
use super::block::{MAX_ROWS, for_rows};
use super::hang::Step;
use super::loops::Loops;
use super::quads::{Quad, Slot};
use super::trains::Trains;
use super::tree::{Form, JointRows, Tree};
use soffio_math::lanes::{All, Four, Lanes, One, V3};
use soffio_math::spatial::Articulated;
use soffio_math::spatial::{Vec6, add_scaled, dot, inverse, mul};

impl Tree {
    /// Factors the system for bodies of these masses and world inertias, the joints' present forms and the rows of loops.
    /// Does the figure gather?
    #[inline(always)]
    pub fn factor<'a, S: Simd>(
        &mut self,
        simd: S,
        quads: &[Quad],
        form: &impl Fn(usize) -> Form<'a>,
        loops: &mut Loops,
        of_loops: (&[JointRows], &Trains, bool),
    ) {
        for &index in &self.begun {
            let (members, quad, lanes) = (&self.members[index], &quads[index], All(simd));
            let alone = Articulated::alone(lanes.get(&quad.mass), quad.inertia.get(lanes));
            lanes.scatter(members.count, &alone.numbers(), |lane, mass| {
                self.articulated[members.bodies[lane]] = *mass;
            });
        }
        for index in (0..self.awake.len()).rev() {
            match self.awake[index] {
                Step::Quad(quad) => self.factor_balls(All(simd), quad),
                Step::Point(Slot { quad, lane }) => self.factor_balls(One(lane), quad),
                Step::Body(body) => self.factor_one(body, form),
                Step::Loops(component) => loops.factor(component, &mut self.articulated, of_loops),
            }
        }
    }

    /// Eliminates these bodies of a quad; their arms are known.
    #[inline(always)]
    fn factor_balls<L: Lanes>(&mut self, lanes: L, quad: usize) {
        let (members, parents) = (&self.members[quad], &self.hooks[quad].parents);
        let mass = lanes.rows(|k| &self.articulated[members.bodies[k]]);
        let ball = Ball::factor(self.balls[quad].arms.get(lanes), &Articulated::of_numbers(&mass));
        self.balls[quad].put_factor(lanes, &ball);
        let articulated = &mut self.articulated;
        lanes.scatter(
            members.count,
            &ball.load().numbers(),
            #[inline(always)]
            |lane, load| add(&mut articulated[parents[lane]], load),
        );
    }

    #[inline(always)]
    fn factor_one<'a>(&mut self, body: usize, form: &impl Fn(usize) -> Form<'a>) {
        let Slot { quad, lane } = self.slots[body];
        let hang = &mut self.hang[body];
        let Some(general) = self.general[body].as_mut().filter(|_| !self.driven[body]) else { return };
        let shape = hang.joint.map(form);
        if let Some(Form::Point(a, b)) = shape {
            hang.ball = true;
            let (own, parent) = if hang.first { (a, b) } else { (b, a) };
            self.balls[quad].arms.put(One(lane), &Arms { own: own.into(), parent: parent.into() });
            return self.factor_balls(One(lane), quad);
        }
        hang.ball = false;
        general.rows = 0;
        let mass = Articulated::of_numbers(&self.articulated[body]);
        general.inverse = if hang.leaf { mass.inverse_alone() } else { inverse(&mass.matrix()) };
        let Some(Form::Rows(rows)) = shape else { return };
        general.eliminate(rows, hang.first, hang.parent.is_some());
        if let Some(parent) = hang.parent {
            for k in 0..general.rows {
                let load = Articulated::outer(&general.jp[k], &general.x[k]);
                add(&mut self.articulated[parent], &load.numbers());
            }
        }
    }

    /// The way up: h of the joints into `lambda`, what they push into `b`. `a` has what is given.
    #[inline(always)]
    pub fn sweep_up<S: Simd>(
        &self,
        simd: S,
        loops: &mut Loops,
        (b, g, a): (&mut [Vec6], &[f64], &[Vec6]),
        lambda: &mut [f64],
    ) {
        for step in self.awake.iter().rev() {
            match *step {
                Step::Quad(quad) => self.up_balls(All(simd), quad, b, Some(g), lambda),
                Step::Point(Slot { quad, lane }) => self.up_balls(One(lane), quad, b, Some(g), lambda),
                Step::Body(body) => self.up(body, b, Some(g), lambda),
                Step::Loops(component) => loops.up(component, b, g, a),
            }
        }
    }

    /// The way down: the accelerations and the final `lambda`.
    #[inline(always)]
    pub fn sweep_down<S: Simd>(
        &self,
        simd: S,
        loops: &mut Loops,
        (b, g): (&[Vec6], &[f64]),
        (lambda, a): (&mut [f64], &mut [Vec6]),
    ) {
        for step in &self.awake {
            match *step {
                Step::Quad(quad) => self.down_balls(All(simd), quad, b, Some(g), lambda, a),
                Step::Point(Slot { quad, lane }) => self.down_balls(One(lane), quad, b, Some(g), lambda, a),
                Step::Body(body) => self.down(body, b, Some(g), lambda, a),
                Step::Loops(component) => loops.down(component, b, lambda, a),
            }
        }
    }

    #[inline(always)]
    fn up_balls<L: Lanes>(&self, lanes: L, quad: usize, b: &mut [Vec6], g: Option<&[f64]>, lambda: &mut [f64]) {
        let (members, hooks) = (&self.members[quad], &self.hooks[quad]);
        let ball = self.balls[quad].get(lanes);
        let wrench = Twist::gather(lanes, |k| &b[members.bodies[k]]);
        let wanted = wanted(lanes, g, &hooks.at, &hooks.signs);
        let w = ball.up(wrench, wanted);
        lanes.scatter(
            members.count,
            &[w.x, w.y, w.z],
            #[inline(always)]
            |lane, w| put(lambda, hooks.at[lane], w),
        );
        lanes.scatter(
            members.count,
            &ball.wrench(w).numbers(),
            #[inline(always)]
            |lane, push| {
                if let Some(b) = b.get_mut(hooks.parents[lane]) {
                    add(b, push);
                }
            },
        );
    }

    #[inline(always)]
    fn down_balls<L: Lanes>(
        &self,
        lanes: L,
        quad: usize,
        b: &[Vec6],
        g: Option<&[f64]>,
        lambda: &mut [f64],
        a: &mut [Vec6],
    ) {
        const STILL: Vec6 = [0.0; 6];
        let (members, hooks) = (&self.members[quad], &self.hooks[quad]);
        let ball = self.balls[quad].get(lanes);
        let wrench = Twist::gather(lanes, |k| &b[members.bodies[k]]);
        let wanted = wanted(lanes, g, &hooks.at, &hooks.signs);
        let w = triples(lanes, lambda, &hooks.at);
        let parent = |k: usize| a.get(hooks.parents[k]).unwrap_or(&STILL);
        let carried = Twist::gather(lanes, parent);
        let (acceleration, l) = ball.down(wrench, wanted, w, carried);
        let l = l * lanes.get(&hooks.signs);
        lanes.scatter(
            members.count,
            &[l.x, l.y, l.z],
            #[inline(always)]
            |lane, l| put(lambda, hooks.at[lane], l),
        );
        lanes.scatter(
            members.count,
            &acceleration.numbers(),
            #[inline(always)]
            |lane, own| a[members.bodies[lane]] = *own,
        );
    }

    /// The way up for one body. Without `g`, g is 0.
    #[inline(always)]
    pub fn up(&self, body: usize, b: &mut [Vec6], g: Option<&[f64]>, lambda: &mut [f64]) {
        let hang = &self.hang[body];
        if hang.ball {
            let Slot { quad, lane } = self.slots[body];
            return self.up_balls(One(lane), quad, b, g, lambda);
        }
        let Some(f) = self.general[body].as_ref().filter(|_| !self.driven[body]) else { return };
        let (lambda, push) = (&mut lambda[hang.at..hang.at + f.rows], b[body]);
        let g = g.map(|g| &g[hang.at..hang.at + f.rows]);
        let mut ends = hang.parent.map(|parent| &mut b[parent]);
        for_rows!(f.rows, rows => {
            let mut wanted = [0.0; MAX_ROWS];
            for k in 0..rows {
                wanted[k] = g.map_or(0.0, |g| g[k]) - dot(&f.w[k], &push);
            }
            for k in 0..rows {
                let h = (0..rows).fold(0.0, |sum, l| sum + f.k[k][l] * wanted[l]);
                lambda[k] = h;
                if let Some(parent) = &mut ends {
                    add_scaled(parent, h, &f.jp[k]);
                }
            }
        });
    }

    /// The way down for one body, after its parent.
    #[inline(always)]
    pub fn down(&self, body: usize, b: &[Vec6], g: Option<&[f64]>, lambda: &mut [f64], a: &mut [Vec6]) {
        let hang = &self.hang[body];
        if hang.ball {
            let Slot { quad, lane } = self.slots[body];
            return self.down_balls(One(lane), quad, b, g, lambda, a);
        }
        let Some(f) = self.general[body].as_ref().filter(|_| !self.driven[body]) else { return };
        let mut out = mul(&f.inverse, &b[body]);
        let lambda = &mut lambda[hang.at..hang.at + f.rows];
        let carried = hang.parent.map(|parent| &a[parent]);
        for_rows!(f.rows, rows => {
            for k in 0..rows {
                if let Some(carried) = carried {
                    lambda[k] -= dot(&f.x[k], carried);
                }
                add_scaled(&mut out, lambda[k], &f.w[k]);
            }
        });
        a[body] = out;
    }
}

/// x += y.
#[inline(always)]
fn add<const N: usize>(x: &mut [f64; N], y: &[f64; N]) {
    for k in 0..N {
        x[k] += y[k];
    }
}

/// The wanted g of point joints, as seen from their bodies.
#[inline(always)]
fn wanted<L: Lanes>(lanes: L, g: Option<&[f64]>, at: &[usize; 4], signs: &Four) -> V3<L::T> {
    match g {
        Some(g) => triples(lanes, g, at) * lanes.get(signs),
        None => {
            let zero = lanes.gather(|_| 0.0);
            V3 { x: zero, y: zero, z: zero }
        }
    }
}

/// Three numbers of each body.
#[inline(always)]
fn triples<L: Lanes>(lanes: L, v: &[f64], at: &[usize; 4]) -> V3<L::T> {
    let [x, y, z] = lanes.rows(|k| v[at[k]..].first_chunk().unwrap_or(&[0.0; 3]));
    V3 { x, y, z }
}

#[inline(always)]
fn put(v: &mut [f64], at: usize, x: &[f64; 3]) {
    v[at..at + 3].copy_from_slice(x);
}
