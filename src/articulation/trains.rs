//! Trains: wheels and weights that turn and slide on what stands still, geared to each other, have one coordinate.
//!
//! A body on a hinge or slider of the world moves along one twist s alone. Where couplings tie such bodies in a tree, the
//! turns and ways q_i of all of them are in fixed proportion to one, q_i = ρ_i q, so that a whole train costs one division
//! instead of six rows a body and one a coupling. With p any motion that its joints ask for,
//!
//! ```text
//! a_i = p_i + ρ_i s_i q̈       m q̈ = Σ ρ_i s_i·(b_i − M_i p_i)       m = Σ ρ_i² s_i·M_i s_i
//! accelerations   p = ω×(ω×r), s·M p = 0         r from the axle to the centre of mass
//! velocities      p = −v                         what remains is the least in kinetic energy
//! places          p = from where it is to where q has it
//! ```
//!
//! and m does not change. Places come from the angle of the train's fastest wheel and its whole turns, so that phases stay in
//! the ratio of the teeth for ever. A row outside the tree that touches a train (`loops.rs`) answers it by
//! f = Σ ρ_i s_i·J_i, to which it adds f²/m.
//!
//! A train's joints always act, never break and do not rub; what they carry is not asked.

use super::block::{Vec6, add_scaled, angular, dot, linear, vec6};
use super::quads::Quads;
use super::{Anchor, Axis, Constraint, ConstraintKind, Function, Measure, Term};
use crate::bodies::RigidBody;
use crate::math::{DMat3, DQuat, DVec3, PI, Pose, atan2, product, renormalized, rotation, sincos};

/// Directions that differ by less than this are one, rad.
const SAME: f64 = 1e-9;
/// Points that differ by less than this are one, m.
const CLOSED: f64 = 1e-6;

/// What the bodies of a train are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked {
    /// The accelerations under forces.
    Acceleration,
    /// Velocity changes that let the joints hold.
    Velocity,
    /// Displacements that close the joints.
    Place,
    /// The answer to impulses.
    Impulse,
}

/// One twist along which a body is free.
#[derive(Clone, Copy, Debug)]
enum Freedom {
    /// Turns about the direction through the point, world axes, m.
    Turn { about: DVec3, pivot: DVec3 },
    /// Slides along the direction.
    Slide(DVec3),
}

/// A body of a train.
#[derive(Clone, Copy, Debug)]
struct Wheel {
    body: usize,
    train: usize,
    /// ρ.
    ratio: f64,
    /// After so many turns of the train it stands where it stood: they are taken off in whole numbers, or the rounding of 2π and
    /// of ρ would move phases with every turn.
    cycle: i64,
    freedom: Freedom,
    /// From the pivot to the centre of mass, body axes, m.
    arm: DVec3,
    /// Where it was at first, and where it is at q = 0: centre of mass and rotation.
    origin: Pose,
    start: Pose,
    /// s and p now.
    twist: Vec6,
    given: Vec6,
}

/// A train.
#[derive(Clone, Copy, Debug)]
struct Train {
    /// m.
    mass: f64,
    /// Index of the wheel with ρ = 1, which no other outruns.
    leader: usize,
    /// q at the last count: angle (wrapped, with whole turns) or way.
    angle: f64,
    turns: i64,
    /// q̈ of the last solve.
    rate: f64,
    /// |ρ| of the wheel that told where the train goes on.
    told: f64,
}

/// All trains of a figure.
#[derive(Clone, Debug, Default)]
pub struct Trains {
    wheels: Vec<Wheel>,
    trains: Vec<Train>,
    /// Which wheel a body is.
    of_body: Vec<Option<usize>>,
    /// Wheels and trains that are awake.
    turning: Vec<usize>,
    running: Vec<usize>,
    /// Whether each constraint is one of a train's.
    own: Vec<bool>,
}

impl Trains {
    /// The trains among bodies that stand like this, where there is any coupling.
    pub fn new(bodies: &[RigidBody], driven: &[bool], constraints: &[Constraint]) -> Self {
        let none = Self { own: vec![false; constraints.len()], ..Self::default() };
        if !constraints.iter().any(|c| matches!(c.kind, ConstraintKind::Coupling { .. })) {
            return none;
        }
        let holds = |body: usize| -> Vec<usize> {
            let of = |c: &Constraint| match c.link() {
                Some((Some(a), None)) => a == body,
                Some((None, Some(b))) => b == body,
                _ => false,
            };
            (0..constraints.len()).filter(|&c| of(&constraints[c])).collect()
        };
        let grounded: Vec<bool> = (0..bodies.len()).map(|body| driven[body] || !holds(body).is_empty()).collect();
        // Whatever else is joined to it must not hang on it.
        let carries = |body: usize| {
            constraints.iter().filter_map(Constraint::link).any(|link| match link {
                (Some(a), Some(b)) if a == body => !grounded[b],
                (Some(a), Some(b)) if b == body => !grounded[a],
                _ => false,
            })
        };
        let mut free: Vec<Option<Freedom>> = (0..bodies.len())
            .map(|body| {
                let held = holds(body);
                let plain = held.iter().all(|&c| always(&constraints[c]));
                if driven[body] || !plain || carries(body) { None } else { freedom(body, &held, bodies, constraints) }
            })
            .collect();
        // Ratios, train by train: a coupling either ties a free body to a train or closes a ring and stays a row.
        let ties: Vec<(usize, [(usize, f64); 2])> = (0..constraints.len())
            .filter(|&c| always(&constraints[c]))
            .filter_map(|c| Some((c, tie(&constraints[c], &free, bodies)?)))
            .collect();
        let mut ratio: Vec<Option<(usize, f64)>> = vec![None; bodies.len()];
        let mut own = vec![false; constraints.len()];
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for &(_, [(first, _), _]) in &ties {
            if ratio[first].is_some() {
                continue;
            }
            ratio[first] = Some((groups.len(), 1.0));
            let mut members = vec![first];
            let mut head = 0;
            while head < members.len() {
                let body = members[head];
                head += 1;
                let Some((train, turns)) = ratio[body] else { continue };
                for &(index, [a, b]) in &ties {
                    let (here, there) = if a.0 == body { (a, b) } else { (b, a) };
                    if here.0 == body && ratio[there.0].is_none() {
                        ratio[there.0] = Some((train, -turns * here.1 / there.1));
                        own[index] = true;
                        members.push(there.0);
                    }
                }
            }
            groups.push(members);
        }
        // What turns alone is one too: it costs a division as well.
        for body in 0..bodies.len() {
            if free[body].is_some() && ratio[body].is_none() && !groups.is_empty() {
                ratio[body] = Some((groups.len(), 1.0));
                groups.push(vec![body]);
            }
        }
        let mut all = Self { of_body: vec![None; bodies.len()], own, ..Self::default() };
        for (train, members) in groups.iter().enumerate() {
            let of = |body: usize| ratio[body].map_or(0.0, |(_, ratio)| ratio);
            let turns = |body: &usize| matches!(free[*body], Some(Freedom::Turn { .. }));
            let fastest = members.iter().copied().filter(turns).fold(members[0], |best, body| {
                let better = !turns(&best) || of(body).abs() > of(best).abs();
                if better { body } else { best }
            });
            let mut mass = 0.0;
            let mut leader = 0;
            for &body in members {
                let Some(freedom) = free[body].take() else { continue };
                let (state, properties) = (&bodies[body], &bodies[body].properties);
                let start = Pose { rotation: state.rotation, position: state.position };
                let arm = match freedom {
                    Freedom::Turn { pivot, .. } => start.rotation.conjugate() * (start.position - pivot),
                    Freedom::Slide(_) => DVec3::ZERO,
                };
                let (twist, given) = ([0.0; 6], [0.0; 6]);
                let mut wheel = Wheel {
                    body,
                    train,
                    ratio: of(body) / of(fastest),
                    cycle: match freedom {
                        Freedom::Turn { .. } => denominator(of(body) / of(fastest)).unwrap_or(i64::MAX),
                        Freedom::Slide(_) => i64::MAX,
                    },
                    freedom,
                    arm,
                    origin: start,
                    start,
                    twist,
                    given,
                };
                wheel.twist = wheel.along(start.rotation * arm);
                let (v, w) = (linear(&wheel.twist), angular(&wheel.twist));
                let own = properties.mass * v.length_squared() + w.dot(state.inertia_world() * w);
                mass += wheel.ratio * wheel.ratio * own;
                if body == fastest {
                    leader = all.wheels.len();
                }
                all.of_body[body] = Some(all.wheels.len());
                all.wheels.push(wheel);
                for c in holds(body) {
                    all.own[c] = true;
                }
            }
            all.trains.push(Train { mass, leader, angle: 0.0, turns: 0, rate: 0.0, told: f64::INFINITY });
        }
        (all.turning, all.running) = ((0..all.wheels.len()).collect(), (0..all.trains.len()).collect());
        all
    }

    /// Leaves out trains that sleep: a whole train does, or none of it.
    pub fn let_sleep(&mut self, asleep: &[bool]) {
        let Self { wheels, trains, turning, running, .. } = self;
        turning.clear();
        turning.extend((0..wheels.len()).filter(|&wheel| !asleep[wheels[wheel].body]));
        running.clear();
        running.extend((0..trains.len()).filter(|&train| !asleep[wheels[trains[train].leader].body]));
    }

    /// Are there none?
    pub fn is_empty(&self) -> bool {
        self.trains.is_empty()
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.trains.len()
    }

    /// Is a body in one?
    pub fn has(&self, body: usize) -> bool {
        self.of_body.get(body).is_some_and(Option::is_some)
    }

    /// Is a constraint a train's own?
    pub fn owns(&self, constraint: usize) -> bool {
        self.own.get(constraint).copied().unwrap_or(false)
    }

    /// Lets q be 0 where the bodies were put; [`Trains::turned`] tells better where it is known.
    pub fn begin(&mut self, quads: &Quads) {
        for wheel in &mut self.wheels {
            match wheel.freedom {
                Freedom::Turn { about, .. } => {
                    let d = quads.rotation(wheel.body) * wheel.origin.rotation.conjugate();
                    let angle = 2.0 * atan2(DVec3::new(d.x, d.y, d.z).dot(about), d.w);
                    wheel.start.rotation = (rotation(about * angle) * wheel.origin.rotation).normalize();
                }
                Freedom::Slide(way) => {
                    let gone = (quads.position(wheel.body) - wheel.origin.position).dot(way);
                    wheel.start.position = wheel.origin.position + way * gone;
                }
            }
        }
        for train in &mut self.trains {
            (train.angle, train.turns, train.told) = (0.0, 0, f64::INFINITY);
        }
    }

    /// Tells how far a body has turned about an axis since the start, whole turns and all, rad: the train goes on from there,
    /// in the phases of the start, with as many turns of its leader as its slowest wheel says.
    pub fn turned(&mut self, body: usize, axis: DVec3, angle: f64) {
        let Some(index) = self.of_body.get(body).copied().flatten() else { return };
        let Wheel { train: of, freedom: Freedom::Turn { about, .. }, ratio, .. } = self.wheels[index] else { return };
        let train = &mut self.trains[of];
        if ratio.abs() < train.told {
            (train.told, train.rate) = (ratio.abs(), angle * axis.dot(about).signum() / ratio);
        }
        for wheel in self.wheels.iter_mut().filter(|wheel| wheel.train == of) {
            wheel.start = wheel.origin;
        }
    }

    /// Counts on from what [`Trains::turned`] told.
    pub fn go_on(&mut self, quads: &Quads) {
        for train in &mut self.trains {
            if train.told.is_finite() {
                (train.angle, train.turns) = (0.0, 0);
            }
        }
        self.count_turns(quads);
        for train in &mut self.trains {
            if train.told.is_finite() {
                train.turns = ((train.rate - train.angle) / (2.0 * PI)).round() as i64;
            }
        }
    }

    /// How far a body has turned about an axis by its train's count, rad.
    pub fn turn_of(&self, body: usize, axis: DVec3) -> Option<f64> {
        let wheel = &self.wheels[self.of_body.get(body).copied().flatten()?];
        let Freedom::Turn { about, .. } = wheel.freedom else { return None };
        let train = &self.trains[wheel.train];
        Some(wheel.ratio * (train.angle + 2.0 * PI * train.turns as f64) * axis.dot(about).signum())
    }

    /// Lays out the twists where the bodies are.
    #[inline(always)]
    pub fn evaluate(&mut self, quads: &Quads) {
        for &index in &self.turning {
            let wheel = &mut self.wheels[index];
            if let Freedom::Turn { .. } = wheel.freedom {
                wheel.twist = wheel.along(quads.frame(wheel.body) * wheel.arm);
            }
        }
    }

    /// The bodies' answer to `b` into `a`, as if there were nothing outside the trains.
    #[inline(always)]
    pub fn solve(&mut self, asked: Asked, quads: &Quads, b: &[Vec6], a: &mut [Vec6]) {
        if self.is_empty() {
            return;
        }
        if asked == Asked::Place {
            self.count_turns(quads);
        }
        for train in &mut self.trains {
            train.rate = 0.0;
        }
        for &index in &self.turning {
            let wheel = &mut self.wheels[index];
            let train = &mut self.trains[wheel.train];
            match asked {
                Asked::Impulse => wheel.given = [0.0; 6],
                Asked::Acceleration => wheel.given = wheel.centripetal(quads),
                Asked::Velocity => {
                    let (v, w) = quads.velocity(wheel.body);
                    wheel.given = vec6(-v, -w);
                }
                Asked::Place => {
                    let q = wheel.ratio * (train.angle + 2.0 * PI * (train.turns % wheel.cycle) as f64);
                    wheel.given = wheel.placing(q, quads);
                }
            }
            let push = &b[wheel.body];
            let along = match asked {
                Asked::Impulse | Asked::Acceleration => dot(&wheel.twist, push),
                Asked::Velocity | Asked::Place => dot(&wheel.twist, &wheel.left(push, quads)),
            };
            train.rate += wheel.ratio * along;
        }
        for train in &mut self.trains {
            train.rate /= train.mass;
        }
        for &index in &self.turning {
            let wheel = &self.wheels[index];
            let rate = wheel.ratio * self.trains[wheel.train].rate;
            a[wheel.body] = std::array::from_fn(|k| wheel.given[k] + rate * wheel.twist[k]);
        }
    }

    /// f of a row's part, and its train.
    #[inline(always)]
    pub fn share(&self, (body, block): &(usize, Vec6)) -> Option<(usize, f64)> {
        let wheel = &self.wheels[self.of_body.get(*body).copied().flatten()?];
        Some((wheel.train, wheel.ratio * dot(&wheel.twist, block)))
    }

    /// Lets every train's rate be its answer to these f alone.
    pub fn answer(&mut self, shares: impl Iterator<Item = (usize, f64)>) {
        self.trains.iter_mut().for_each(|train| train.rate = 0.0);
        for (train, f) in shares {
            self.trains[train].rate += f / self.trains[train].mass;
        }
    }

    /// Adds the answer to `f` along a train's coordinate to its rate.
    pub fn add_push(&mut self, train: usize, f: f64) {
        self.trains[train].rate += f / self.trains[train].mass;
    }

    /// The rate of a train's coordinate, as last found.
    pub fn rate(&self, train: usize) -> f64 {
        self.trains[train].rate
    }

    /// f²/m for two rows' f on one train.
    #[inline(always)]
    pub fn response(&self, train: usize, f: f64, g: f64) -> f64 {
        f * g / self.trains[train].mass
    }

    /// Adds the answer to impulses (or forces) `f` along each train's coordinate.
    #[inline(always)]
    pub fn push(&self, f: &[f64], a: &mut [Vec6]) {
        for &index in &self.turning {
            let wheel = &self.wheels[index];
            let more = f[wheel.train];
            if more != 0.0 {
                let rate = wheel.ratio * more / self.trains[wheel.train].mass;
                add_scaled(&mut a[wheel.body], rate, &wheel.twist);
            }
        }
    }

    /// Counts q of every train up to where the bodies are.
    fn count_turns(&mut self, quads: &Quads) {
        for &index in &self.running {
            let train = &mut self.trains[index];
            let wheel = &self.wheels[train.leader];
            match wheel.freedom {
                Freedom::Turn { about, .. } => {
                    let d = quads.rotation(wheel.body) * wheel.start.rotation.conjugate();
                    let raw = 2.0 * atan2(DVec3::new(d.x, d.y, d.z).dot(about), d.w);
                    let wrapped = raw
                        - if raw > PI {
                            2.0 * PI
                        } else if raw <= -PI {
                            -2.0 * PI
                        } else {
                            0.0
                        };
                    let step = wrapped - train.angle;
                    train.turns += i64::from(step < -PI) - i64::from(step > PI);
                    train.angle = wrapped;
                }
                Freedom::Slide(way) => train.angle = (quads.position(wheel.body) - wheel.start.position).dot(way),
            }
        }
    }
}

impl Wheel {
    /// s for an arm in world axes.
    #[inline(always)]
    fn along(&self, arm: DVec3) -> Vec6 {
        match self.freedom {
            Freedom::Turn { about, .. } => vec6(about.cross(arm), about),
            Freedom::Slide(way) => vec6(way, DVec3::ZERO),
        }
    }

    /// What a push leaves to the coordinate beside p: b − M p.
    #[inline(always)]
    fn left(&self, push: &Vec6, quads: &Quads) -> Vec6 {
        let (mass, p, turn) = (quads.mass(self.body), linear(&self.given), angular(&self.given));
        let turned: DVec3 = quads.inertia(self.body).mul(turn.into()).into();
        let mut left = *push;
        add_scaled(&mut left, -1.0, &vec6(mass * p, turned));
        left
    }

    /// ω×(ω×r).
    #[inline(always)]
    fn centripetal(&self, quads: &Quads) -> Vec6 {
        let Freedom::Turn { about, .. } = self.freedom else { return [0.0; 6] };
        let spin = quads.spin(self.body).dot(about);
        // n×(n×r), and n×r stands in s.
        vec6(spin * spin * about.cross(linear(&self.twist)), DVec3::ZERO)
    }

    /// From where it is to where q has it.
    fn placing(&self, q: f64, quads: &Quads) -> Vec6 {
        let (now, turned) = (quads.position(self.body), quads.rotation(self.body));
        match self.freedom {
            Freedom::Turn { about, pivot } => {
                let (sine, cosine) = sincos(0.5 * q);
                let turn = DQuat::from_xyzw(sine * about.x, sine * about.y, sine * about.z, cosine);
                let goal = renormalized(product(turn, self.start.rotation));
                let d = goal * turned.conjugate();
                let turn = DVec3::new(d.x, d.y, d.z) * (2.0 * d.w.signum());
                vec6(pivot + goal * self.arm - now, turn)
            }
            Freedom::Slide(way) => {
                let d = self.start.rotation * turned.conjugate();
                let turn = DVec3::new(d.x, d.y, d.z) * (2.0 * d.w.signum());
                vec6(self.start.position + way * q - now, turn)
            }
        }
    }
}

/// The denominator of a ratio of whole numbers: of the first convergent of its continued fraction that is the ratio but for
/// rounding. Where no small one is, none.
fn denominator(ratio: f64) -> Option<i64> {
    /// Products of some ratios of teeth.
    const ROUNDING: f64 = 16.0 * f64::EPSILON;
    /// A ratio that is none of teeth comes so near to one with a larger denominator only.
    const LARGEST: f64 = 1e6;
    let (mut rest, mut above, mut below) = (ratio.abs(), [0.0, 1.0], [1.0, 0.0]);
    loop {
        let whole = rest.floor();
        above = [above[1], whole * above[1] + above[0]];
        below = [below[1], whole * below[1] + below[0]];
        if below[1].is_nan() || below[1] > LARGEST {
            return None;
        }
        if (above[1] / below[1] - ratio.abs()).abs() <= ROUNDING * ratio.abs() {
            return Some(below[1] as i64);
        }
        rest = 1.0 / (rest - whole);
    }
}

/// Does it always act, whatever it carries, without friction?
fn always(constraint: &Constraint) -> bool {
    let Constraint { schedule, breaking, friction, slips, .. } = constraint;
    schedule.is_always() && breaking.is_none() && friction.is_none() && slips.is_none()
}

/// The one twist that these constraints leave a body on the world: those of a hinge, or of a slider.
fn freedom(body: usize, held: &[usize], bodies: &[RigidBody], constraints: &[Constraint]) -> Option<Freedom> {
    let state = &bodies[body];
    let frame = DMat3::from_quat(state.rotation);
    let point = |anchor: &Anchor| anchor.body.map_or(anchor.point, |_| state.pose().point(anchor.point));
    let direction = |axis: &Axis| axis.body.map_or(axis.direction, |_| frame * axis.direction);
    let still = |function: &Function| matches!(function, Function::Constant(value) if *value == 0.0);
    let (mut points, mut planes, mut own, mut across) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for &index in held {
        match &constraints[index].kind {
            ConstraintKind::PointToPoint { a, b } => {
                let (p, q) = (point(a), point(b));
                if p.distance(q) > CLOSED {
                    return None;
                }
                points.push(if a.body.is_some() { q } else { p });
            }
            ConstraintKind::PointOnPlane { point: p, plane, normal, offset } => {
                let (height, fixed) = ((point(p) - point(plane)).dot(*normal), plane.body.is_none());
                if !fixed || !matches!(offset, Function::Constant(o) if (height - o).abs() < CLOSED) {
                    return None;
                }
                planes.push(*normal);
            }
            ConstraintKind::Orientation { a, b, angle } => {
                let (t, n) = (direction(a), direction(b));
                if !still(angle) || b.body.is_some() || t.dot(n).abs() > SAME {
                    return None;
                }
                own.push(t);
                across.push(n);
            }
            ConstraintKind::Coupling { .. } => return None,
        }
    }
    let along = across.first()?.cross(*across.get(1)?).try_normalize()?;
    let one = |v: &DVec3| v.cross(along).length() < SAME;
    // The axle's own direction is held across two of the world: it points along what is across both.
    if !one(&own[0]) || !one(&own[1]) {
        return None;
    }
    match (&points[..], planes.len(), own.len()) {
        ([pivot], 0, 2) => Some(Freedom::Turn { about: along, pivot: *pivot }),
        ([], 2, 3) => {
            let square = planes.iter().all(|normal| normal.dot(along).abs() < SAME);
            let apart = planes[0].dot(planes[1]).abs() < SAME && own[2].dot(along).abs() < SAME;
            (square && apart).then_some(Freedom::Slide(along))
        }
        _ => None,
    }
}

/// The two bodies that a coupling ties, each with what its coordinate counts.
fn tie(constraint: &Constraint, free: &[Option<Freedom>], bodies: &[RigidBody]) -> Option<[(usize, f64); 2]> {
    let ConstraintKind::Coupling { terms } = &constraint.kind else { return None };
    let of = |term: &Term| match term.measure {
        Measure::Angle { axis, frame: None } => {
            let body = axis.body?;
            let Some(Freedom::Turn { about, .. }) = free[body] else { return None };
            let cosine = (bodies[body].rotation * axis.direction).dot(about);
            (cosine.abs() > 1.0 - SAME).then_some((body, term.coefficient * cosine.signum()))
        }
        Measure::Way { point, direction } if direction.body.is_none() => {
            let body = point.body?;
            let Some(Freedom::Slide(way)) = free[body] else { return None };
            Some((body, term.coefficient * direction.direction.dot(way)))
        }
        _ => None,
    };
    let [a, b] = &terms[..] else { return None };
    let (a, b) = (of(a)?, of(b)?);
    (a.0 != b.0 && a.1 != 0.0 && b.1 != 0.0).then_some([a, b])
}

#[cfg(test)]
mod tests {
    use super::denominator;

    #[test]
    fn ratios_of_teeth_come_round() {
        for (above, below, round) in
            [(1, 1, 1), (12, 60, 5), (-7, 3, 3), (78 * 80, 6 * 7, 7), (6 * 6 * 8, 78 * 80 * 77, 5005)]
        {
            let found = denominator(f64::from(above) / f64::from(below)).expect("a ratio of whole numbers");
            assert_eq!(found, round, "{above}/{below}");
        }
        assert_eq!(denominator(std::f64::consts::PI), None);
        assert_eq!(denominator(f64::NAN), None);
    }
}
