//! Factor and solves of the tree (`tree.rs`): sweeps over its steps, from the leaves or from the roots.
//!
//! A quad's bodies are eliminated together. What they leave to their parents is added body by body, the last first, so
//! that sums come out the same however the bodies are put together.

use fearless_simd::Simd;

use super::ball::{Arms, Ball, Twist, Wanted};
use super::block::{MAX_ROWS, for_rows};
use super::hang::Step;
use super::loops::Loops;
use super::quads::{Quad, Slot};
use super::trains::Trains;
use super::tree::{Form, JointRows, Tree};
use soffio_math::DVec3;
use soffio_math::lanes::{All, Lanes, One};
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
                Step::Quad(quad) if self.hooks[quad].leaves => {
                    let Quad { mass, inertia, .. } = &quads[quad];
                    let alone = Articulated::alone(All(simd).get(mass), inertia.get(All(simd)));
                    self.factor_balls(All(simd), quad, &alone);
                }
                Step::Quad(quad) => {
                    let mass = self.articulated(All(simd), quad);
                    self.factor_balls(All(simd), quad, &mass);
                }
                Step::Point(Slot { quad, lane }) => {
                    let mass = self.articulated(One(lane), quad);
                    self.factor_balls(One(lane), quad, &mass);
                }
                Step::Body(body) => self.factor_one(body, form),
                Step::Loops(component) => loops.factor(component, &mut self.articulated, of_loops),
            }
        }
    }

    /// Articulated masses of these bodies of a quad.
    #[inline(always)]
    fn articulated<L: Lanes>(&self, lanes: L, quad: usize) -> Articulated<L::T> {
        let members = &self.members[quad];
        Articulated::of_numbers(&lanes.rows(|k| &self.articulated[members.bodies[k]]))
    }

    /// Eliminates these bodies of a quad, of these articulated masses; their arms are known.
    #[inline(always)]
    fn factor_balls<L: Lanes>(&mut self, lanes: L, quad: usize, mass: &Articulated<L::T>) {
        let (members, parents) = (&self.members[quad], &self.hooks[quad].parents);
        let ball = Ball::factor(self.balls[quad].arms.get(lanes), mass);
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
            let mass = self.articulated(One(lane), quad);
            return self.factor_balls(One(lane), quad, &mass);
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

    /// The way up: h of the joints into `lambda`, what they push into `b`. `a` has what is given; `wanted` says what points
    /// by which bodies hang are to do.
    #[inline(always)]
    pub fn sweep_up<S: Simd>(
        &mut self,
        simd: S,
        loops: &mut Loops,
        (b, g, a): (&mut [Vec6], &[f64], &[Vec6]),
        (wanted, lambda): (Wanted, &mut [f64]),
    ) {
        for index in (0..self.awake.len()).rev() {
            match self.awake[index] {
                Step::Quad(quad) => self.up_balls(All(simd), quad, b, wanted),
                Step::Point(Slot { quad, lane }) => self.up_balls(One(lane), quad, b, wanted),
                Step::Body(body) => self.up(body, b, Some(g), lambda),
                Step::Loops(component) => loops.up(component, b, g, a),
            }
        }
    }

    /// The way down: the accelerations and the final `lambda`, but of the points by which bodies hang.
    #[inline(always)]
    pub fn sweep_down<S: Simd>(
        &mut self,
        simd: S,
        loops: &mut Loops,
        (b, wanted): (&[Vec6], Wanted),
        (lambda, a): (&mut [f64], &mut [Vec6]),
    ) {
        for index in 0..self.awake.len() {
            match self.awake[index] {
                Step::Quad(quad) => self.down_balls(All(simd), quad, wanted, a),
                Step::Point(Slot { quad, lane }) => self.down_balls(One(lane), quad, wanted, a),
                Step::Body(body) => self.down(body, b, Wanted::Told, lambda, a),
                Step::Loops(component) => loops.down(component, b, lambda, a),
            }
        }
    }

    #[inline(always)]
    fn up_balls<L: Lanes>(&mut self, lanes: L, quad: usize, b: &mut [Vec6], wanted: Wanted) {
        let (members, hooks, points) = (&self.members[quad], &self.hooks[quad], &mut self.points[quad]);
        let ball = self.balls[quad].get(lanes);
        let (torque, w) = ball.up(Twist::gather(lanes, |k| &b[members.bodies[k]]), points.wanted(lanes, wanted));
        points.torque.put(lanes, torque);
        points.force.put(lanes, w);
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
    fn down_balls<L: Lanes>(&mut self, lanes: L, quad: usize, wanted: Wanted, a: &mut [Vec6]) {
        const STILL: Vec6 = [0.0; 6];
        let (members, hooks, points) = (&self.members[quad], &self.hooks[quad], &mut self.points[quad]);
        let ball = self.balls[quad].get(lanes);
        let parent = |k: usize| a.get(hooks.parents[k]).unwrap_or(&STILL);
        let carried = Twist::gather(lanes, parent);
        let up = (points.torque.get(lanes), points.force.get(lanes));
        let (acceleration, lambda) = ball.down(points.wanted(lanes, wanted), up, carried);
        points.force.put(lanes, lambda);
        lanes.scatter(
            members.count,
            &acceleration.numbers(),
            #[inline(always)]
            |lane, own| a[members.bodies[lane]] = *own,
        );
    }

    /// The way up for one body. Without `g`, g is 0.
    #[inline(always)]
    pub fn up(&mut self, body: usize, b: &mut [Vec6], g: Option<&[f64]>, lambda: &mut [f64]) {
        let hang = &self.hang[body];
        if hang.ball {
            let Slot { quad, lane } = self.slots[body];
            let Some(g) = g else { return self.up_balls(One(lane), quad, b, Wanted::Nothing) };
            let g = DVec3::from_slice(&g[hang.at..]) * hang.sign();
            self.points[quad].wanted.put(One(lane), g.into());
            return self.up_balls(One(lane), quad, b, Wanted::Told);
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

    /// The way down for one body, after its parent. Where it hangs by a point, this was `wanted` on the way up.
    #[inline(always)]
    pub fn down(&mut self, body: usize, b: &[Vec6], wanted: Wanted, lambda: &mut [f64], a: &mut [Vec6]) {
        if self.hang[body].ball {
            let Slot { quad, lane } = self.slots[body];
            self.down_balls(One(lane), quad, wanted, a);
            let force: DVec3 = self.points[quad].force.get(One(lane)).into();
            let hang = &self.hang[body];
            (force * hang.sign()).write_to_slice(&mut lambda[hang.at..]);
            return;
        }
        let hang = &self.hang[body];
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
