//! What the curves of an exhibit's charts show: measured in every step, drawn from [`CurveView`].
//!
//! A curve has [`CURVE_POINTS`] points. Each is the greatest value within its share of the chart's time.

use std::collections::VecDeque;

use super::motion::Motion;
use super::rate::STEPS_PER_SECOND;
use soffio_exhibit::chart::{Chart, Measured};
use soffio_exhibit::{Body, Exhibit};
use soffio_math::{DMat3, DVec3};

/// Most points of a curve: as many as a picture of full height shows apart on a board of a sixth of its width.
pub const CURVE_POINTS: usize = 240;

/// A curve as it is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurveView {
    /// Index of its chart among the exhibit's.
    pub chart: usize,
    /// Linear colour.
    pub color: [f32; 3],
    /// Points on the board, the latest first, each in shares of its width and height, (0, 0) at the lower left.
    pub points: Vec<[f32; 2]>,
    /// The value in the last step, m.
    pub value: f64,
}

/// A curve with its past.
#[derive(Clone, Debug)]
struct Curve {
    chart: usize,
    color: [f32; 3],
    /// Heights on the board, the latest first.
    heights: VecDeque<f64>,
    /// Steps that the latest point stands for.
    steps_of_latest: u32,
    /// Steps that a point stands for.
    steps_of_point: u32,
    value: f64,
}

/// All curves of an exhibit.
#[derive(Clone, Debug)]
pub(crate) struct Charts {
    curves: Vec<Curve>,
    /// Centres of mass at the start, m.
    starts: Vec<DVec3>,
    /// Scratch, a matrix a body.
    frames: Vec<DMat3>,
}

impl Charts {
    /// Empty boards.
    pub fn new(exhibit: &Exhibit) -> Self {
        let curves = exhibit.charts.iter().enumerate().flat_map(|(chart, board)| {
            let steps_of_point = (board.seconds * STEPS_PER_SECOND as f64 / CURVE_POINTS as f64).ceil().max(1.0) as u32;
            board.curves.iter().map(move |curve| Curve {
                chart,
                color: curve.color,
                heights: VecDeque::with_capacity(CURVE_POINTS),
                steps_of_latest: 0,
                steps_of_point,
                value: 0.0,
            })
        });
        let center = |body: &Body| body.pose.point(body.properties.center);
        Self {
            curves: curves.collect(),
            starts: exhibit.bodies.iter().map(center).collect(),
            frames: vec![DMat3::IDENTITY; exhibit.bodies.len()],
        }
    }

    /// Measures after a step. Nothing is measured in an assembly, which has joints of its own.
    pub fn advance(&mut self, charts: &[Chart], motion: &Motion) {
        if motion.assembly_distance().is_some() {
            return;
        }
        let Self { curves, starts, frames } = self;
        let measured = charts.iter().flat_map(|chart| chart.curves.iter().map(move |curve| (chart, &curve.measured)));
        for (curve, (chart, measured)) in curves.iter_mut().zip(measured) {
            curve.value = match measured {
                Measured::JointError { constraints, body } => {
                    let dynamics = motion.of_body(*body);
                    dynamics.system().largest_gap_of(constraints, &dynamics.bodies, frames)
                }
                Measured::Departure { body, like } => {
                    let moved = |body: usize| motion.dynamics.bodies[body].position - starts[body];
                    moved(*body).distance(moved(*like))
                }
            };
            curve.add(chart.height(curve.value));
        }
    }

    /// The curves as they are drawn.
    pub fn view(&self) -> impl Iterator<Item = CurveView> + '_ {
        self.curves.iter().map(|curve| {
            let latest = curve.steps_of_latest as f64 / curve.steps_of_point as f64;
            let across =
                |k: usize| if k == 0 { 1.0 } else { 1.0 - (k as f64 - 1.0 + latest) / (CURVE_POINTS - 1) as f64 };
            let point = |(k, height): (usize, &f64)| [across(k).max(0.0) as f32, *height as f32];
            let points = curve.heights.iter().enumerate().map(point).collect();
            CurveView { chart: curve.chart, color: curve.color, points, value: curve.value }
        })
    }
}

impl Curve {
    /// Adds the height of a step.
    fn add(&mut self, height: f64) {
        if self.heights.is_empty() || self.steps_of_latest == self.steps_of_point {
            if self.heights.len() == CURVE_POINTS {
                self.heights.pop_back();
            }
            self.heights.push_front(height);
            self.steps_of_latest = 0;
        }
        self.steps_of_latest += 1;
        if let Some(latest) = self.heights.front_mut() {
            *latest = latest.max(height);
        }
    }
}
