//! Gear trains in reduced coordinates: bodies on hinges and sliders of the world, coupled to one coordinate.
//!
//! A body on a hinge or slider of the world moves along one twist s alone. Couplings that tie such bodies in a tree
//! keep all their coordinates q_i in fixed proportion to one, q_i = ρ_i q. So a whole train costs one division
//! instead of six rows a body and one a coupling. With p any motion that its joints require,
//!
//! ```text
//! a_i = p_i + ρ_i s_i q̈       m q̈ = Σ ρ_i s_i·(b_i − M_i p_i)       m = Σ ρ_i² s_i·M_i s_i
//! accelerations   p = ω×(ω×r), s·M p = 0         r from the axle to the centre of mass
//! velocities      p = −v                         what remains is the least in kinetic energy
//! places          p = from where it is to where q has it
//! ```
//!
//! and m is constant. Positions come from the angle of the train's fastest wheel and its whole revolutions, so that
//! phases keep the ratio of the teeth for ever. A row outside the tree that touches a train (`loops/`) has the
//! coefficient f = Σ ρ_i s_i·J_i, and the train adds f²/m to its effective inverse mass.
//!
//! A train's joints always act, never break and have no friction; their loads are not computed.

mod detection;

use super::lane_blocks::LaneBlocks;
use soffio_math::spatial::{Vec6, add_scaled, angular, dot, linear, vec6};
use soffio_math::{DQuat, DVec3, PI, Pose, atan2, product, renormalized, rotation, sincos};

/// What the bodies of a train are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolveKind {
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
    Revolute { about: DVec3, pivot: DVec3 },
    /// Slides along the direction.
    Prismatic(DVec3),
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
    prescribed: Vec6,
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
    revolutions: i64,
    /// q̈ of the last solve.
    rate: f64,
    /// |ρ| of the wheel that told where the train goes on.
    source_ratio: f64,
}

/// All gear trains of an articulation.
#[derive(Clone, Debug, Default)]
pub struct Trains {
    wheels: Vec<Wheel>,
    trains: Vec<Train>,
    /// Which wheel a body is.
    of_body: Vec<Option<usize>>,
    /// Wheels and trains that are awake.
    awake_wheels: Vec<usize>,
    awake_trains: Vec<usize>,
    /// Whether each constraint is one of a train's.
    own: Vec<bool>,
}

impl Trains {
    /// Leaves out trains that sleep: a whole train does, or none of it.
    pub fn let_sleep(&mut self, asleep: &[bool]) {
        let Self { wheels, trains, awake_wheels, awake_trains, .. } = self;
        awake_wheels.clear();
        awake_wheels.extend((0..wheels.len()).filter(|&wheel| !asleep[wheels[wheel].body]));
        awake_trains.clear();
        awake_trains.extend((0..trains.len()).filter(|&train| !asleep[wheels[trains[train].leader].body]));
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

    /// The train that a body is in.
    pub fn of(&self, body: usize) -> Option<usize> {
        self.of_body.get(body).copied().flatten().map(|wheel| self.wheels[wheel].train)
    }

    /// Is a constraint a train's own?
    pub fn owns(&self, constraint: usize) -> bool {
        self.own.get(constraint).copied().unwrap_or(false)
    }

    /// Lets q be 0 where the bodies were put; [`Trains::set_angle`] sets it where it is known.
    pub fn start_at(&mut self, lane_blocks: &LaneBlocks) {
        for wheel in &mut self.wheels {
            match wheel.freedom {
                Freedom::Revolute { about, .. } => {
                    let d = lane_blocks.rotation(wheel.body) * wheel.origin.rotation.conjugate();
                    let angle = 2.0 * atan2(DVec3::new(d.x, d.y, d.z).dot(about), d.w);
                    wheel.start.rotation = (rotation(about * angle) * wheel.origin.rotation).normalize();
                }
                Freedom::Prismatic(direction) => {
                    let gone = (lane_blocks.position(wheel.body) - wheel.origin.position).dot(direction);
                    wheel.start.position = wheel.origin.position + direction * gone;
                }
            }
        }
        for train in &mut self.trains {
            (train.angle, train.revolutions, train.source_ratio) = (0.0, 0, f64::INFINITY);
        }
    }

    /// Sets how far a body has rotated about an axis since the start, with whole revolutions, rad. The train
    /// continues from there with the phases of the start; its slowest wheel determines the revolutions of its leader.
    pub fn set_angle(&mut self, body: usize, axis: DVec3, angle: f64) {
        let Some(index) = self.of_body.get(body).copied().flatten() else { return };
        let Wheel { train: of, freedom: Freedom::Revolute { about, .. }, ratio, .. } = self.wheels[index] else {
            return;
        };
        let train = &mut self.trains[of];
        if ratio.abs() < train.source_ratio {
            (train.source_ratio, train.rate) = (ratio.abs(), angle * axis.dot(about).signum() / ratio);
        }
        for wheel in self.wheels.iter_mut().filter(|wheel| wheel.train == of) {
            wheel.start = wheel.origin;
        }
    }

    /// Resumes counting from the angles of [`Trains::set_angle`].
    pub fn resume_count(&mut self, lane_blocks: &LaneBlocks) {
        for train in &mut self.trains {
            if train.source_ratio.is_finite() {
                (train.angle, train.revolutions) = (0.0, 0);
            }
        }
        self.count_revolutions(lane_blocks);
        for train in &mut self.trains {
            if train.source_ratio.is_finite() {
                train.revolutions = ((train.rate - train.angle) / (2.0 * PI)).round() as i64;
            }
        }
    }

    /// How far a body has turned about an axis by its train's count, rad.
    pub fn angle_of(&self, body: usize, axis: DVec3) -> Option<f64> {
        let wheel = &self.wheels[self.of_body.get(body).copied().flatten()?];
        let Freedom::Revolute { about, .. } = wheel.freedom else { return None };
        let train = &self.trains[wheel.train];
        Some(wheel.ratio * (train.angle + 2.0 * PI * train.revolutions as f64) * axis.dot(about).signum())
    }

    /// Lays out the twists where the bodies are.
    #[inline(always)]
    pub fn evaluate(&mut self, lane_blocks: &LaneBlocks) {
        for &index in &self.awake_wheels {
            let wheel = &mut self.wheels[index];
            if let Freedom::Revolute { .. } = wheel.freedom {
                wheel.twist = wheel.along(lane_blocks.frame(wheel.body) * wheel.arm);
            }
        }
    }

    /// The bodies' answer to `b` into `a`, as if there were nothing outside the trains.
    #[inline(always)]
    pub fn solve(&mut self, kind: SolveKind, lane_blocks: &LaneBlocks, b: &[Vec6], a: &mut [Vec6]) {
        if self.is_empty() {
            return;
        }
        if kind == SolveKind::Place {
            self.count_revolutions(lane_blocks);
        }
        for train in &mut self.trains {
            train.rate = 0.0;
        }
        for &index in &self.awake_wheels {
            let wheel = &mut self.wheels[index];
            let train = &mut self.trains[wheel.train];
            match kind {
                SolveKind::Impulse => wheel.prescribed = [0.0; 6],
                SolveKind::Acceleration => wheel.prescribed = wheel.centripetal(lane_blocks),
                SolveKind::Velocity => {
                    let (v, w) = lane_blocks.velocity(wheel.body);
                    wheel.prescribed = vec6(-v, -w);
                }
                SolveKind::Place => {
                    let q = wheel.ratio * (train.angle + 2.0 * PI * (train.revolutions % wheel.cycle) as f64);
                    wheel.prescribed = wheel.placing(q, lane_blocks);
                }
            }
            let push = &b[wheel.body];
            let along = match kind {
                SolveKind::Impulse | SolveKind::Acceleration => dot(&wheel.twist, push),
                SolveKind::Velocity | SolveKind::Place => {
                    dot(&wheel.twist, &wheel.remaining_impulse(push, lane_blocks))
                }
            };
            train.rate += wheel.ratio * along;
        }
        for train in &mut self.trains {
            train.rate /= train.mass;
        }
        for &index in &self.awake_wheels {
            let wheel = &self.wheels[index];
            let rate = wheel.ratio * self.trains[wheel.train].rate;
            a[wheel.body] = std::array::from_fn(|k| wheel.prescribed[k] + rate * wheel.twist[k]);
        }
    }

    /// f of a row's part, and its train.
    #[inline(always)]
    pub fn row_coefficient(&self, (body, block): &(usize, Vec6)) -> Option<(usize, f64)> {
        let wheel = &self.wheels[self.of_body.get(*body).copied().flatten()?];
        Some((wheel.train, wheel.ratio * dot(&wheel.twist, block)))
    }

    /// Lets every train's rate be its answer to these f alone.
    pub fn respond(&mut self, coefficients: impl Iterator<Item = (usize, f64)>) {
        self.trains.iter_mut().for_each(|train| train.rate = 0.0);
        for (train, f) in coefficients {
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

    /// Entry J M⁻¹ Jᵀ of two rows that act on one train with coefficients `f` and `g`: f g / m, m the train's mass.
    #[inline(always)]
    pub fn response(&self, train: usize, f: f64, g: f64) -> f64 {
        f * g / self.trains[train].mass
    }

    /// Adds the answer to impulses (or forces) `f` along each train's coordinate.
    #[inline(always)]
    pub fn push(&self, f: &[f64], a: &mut [Vec6]) {
        for &index in &self.awake_wheels {
            let wheel = &self.wheels[index];
            let impulse = f[wheel.train];
            if impulse != 0.0 {
                let rate = wheel.ratio * impulse / self.trains[wheel.train].mass;
                add_scaled(&mut a[wheel.body], rate, &wheel.twist);
            }
        }
    }

    /// Counts q of every train up to where the bodies are.
    fn count_revolutions(&mut self, lane_blocks: &LaneBlocks) {
        for &index in &self.awake_trains {
            let train = &mut self.trains[index];
            let wheel = &self.wheels[train.leader];
            match wheel.freedom {
                Freedom::Revolute { about, .. } => {
                    let d = lane_blocks.rotation(wheel.body) * wheel.start.rotation.conjugate();
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
                    train.revolutions += i64::from(step < -PI) - i64::from(step > PI);
                    train.angle = wrapped;
                }
                Freedom::Prismatic(direction) => {
                    train.angle = (lane_blocks.position(wheel.body) - wheel.start.position).dot(direction)
                }
            }
        }
    }
}

impl Wheel {
    /// s for an arm in world axes.
    #[inline(always)]
    fn along(&self, arm: DVec3) -> Vec6 {
        match self.freedom {
            Freedom::Revolute { about, .. } => vec6(about.cross(arm), about),
            Freedom::Prismatic(direction) => vec6(direction, DVec3::ZERO),
        }
    }

    /// What a push leaves to the coordinate beside p: b − M p.
    #[inline(always)]
    fn remaining_impulse(&self, push: &Vec6, lane_blocks: &LaneBlocks) -> Vec6 {
        let (mass, p, rotation_vector) =
            (lane_blocks.mass(self.body), linear(&self.prescribed), angular(&self.prescribed));
        let set_angle: DVec3 = lane_blocks.inertia(self.body).mul(rotation_vector.into()).into();
        let mut remaining_impulse = *push;
        add_scaled(&mut remaining_impulse, -1.0, &vec6(mass * p, set_angle));
        remaining_impulse
    }

    /// ω×(ω×r).
    #[inline(always)]
    fn centripetal(&self, lane_blocks: &LaneBlocks) -> Vec6 {
        let Freedom::Revolute { about, .. } = self.freedom else { return [0.0; 6] };
        let spin = lane_blocks.spin(self.body).dot(about);
        // n×(n×r), and n×r stands in s.
        vec6(spin * spin * about.cross(linear(&self.twist)), DVec3::ZERO)
    }

    /// From where it is to where q has it.
    fn placing(&self, q: f64, lane_blocks: &LaneBlocks) -> Vec6 {
        let (now, set_angle) = (lane_blocks.position(self.body), lane_blocks.rotation(self.body));
        match self.freedom {
            Freedom::Revolute { about, pivot } => {
                let (sine, cosine) = sincos(0.5 * q);
                let rotation_vector = DQuat::from_xyzw(sine * about.x, sine * about.y, sine * about.z, cosine);
                let goal = renormalized(product(rotation_vector, self.start.rotation));
                let d = goal * set_angle.conjugate();
                let rotation_vector = DVec3::new(d.x, d.y, d.z) * (2.0 * d.w.signum());
                vec6(pivot + goal * self.arm - now, rotation_vector)
            }
            Freedom::Prismatic(direction) => {
                let d = self.start.rotation * set_angle.conjugate();
                let rotation_vector = DVec3::new(d.x, d.y, d.z) * (2.0 * d.w.signum());
                vec6(self.start.position + direction * q - now, rotation_vector)
            }
        }
    }
}
