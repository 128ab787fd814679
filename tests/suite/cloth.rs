//! Sheets of cloth against formulas: hanging chain, cantilever, shear, stretch, momentum and energy; and the silk pennant as a
//! visitor finds it.
//!
//! Symbols: L length and W width of the sheet, h and w of a cell, σ mass per area, K, G and B the stiffnesses of stretch, shear
//! and bending per width.

use std::fmt::Write;
use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_math::DVec3;
use soffio_math::spatial::{Vec6, vec6};
use soffio_multibody::dynamics::Dynamics;
use soffio_simulation::{Command, EventKind, Settings, Simulation, StepInput, start_dynamics};

use crate::exhibit::glb::{Folder, Scene};

const G: f64 = 9.81;
const DT: f64 = 1.0 / 240.0;
/// Mass per area of the sheets here, kg/m².
const SIGMA: f64 = 0.065;

/// A sheet in the making.
#[derive(Clone, Copy)]
struct Cloth {
    /// Rows and columns.
    cells: [usize; 2],
    /// Width and height of a cell, m.
    size: [f64; 2],
    gravity: f64,
    /// Is its upper edge fixed?
    hem: bool,
    /// K and G, N/m.
    stretch: f64,
    shear: f64,
    /// B, N m.
    bending: f64,
    /// s.
    damping: f64,
}

impl Cloth {
    fn load(&self) -> Exhibit {
        let ([rows, columns], [width, height]) = (self.cells, self.size);
        let mut scene = Scene::default();
        scene.node("Bar", [0.0; 3], None, &[]);
        for i in 0..rows {
            for j in 0..columns {
                let at = [(j as f64 - 0.5 * (columns - 1) as f64) * width, -(i as f64 + 0.5) * height, 0.0];
                scene.node(&format!("Silk.{i}.{j}"), at.map(|x| x as f32), None, &[]);
            }
        }
        let Self { gravity, stretch, shear, bending, damping, .. } = self;
        let mut text = format!(
            "[scene]\ngravity = [0, {}, 0]\n[material.silk]\ndensity = 1300\nyoungs_modulus = 1e9\n[[sheet]]\nname = \"silk\"\n\
             cells = \"Silk.*\"\ncolumns = {columns}\nmaterial = \"silk\"\nthickness = 5e-5\nstretch = {stretch}\nshear = {shear}\n\
             bending = {bending:e}\ndamping = {damping:e}\n",
            -gravity
        );
        if self.hem {
            let _ = writeln!(text, "hem = \"Bar\"");
        }
        let folder = Folder::exhibit(&scene.glb(), &text);
        exhibit::load(folder.path()).unwrap_or_else(|report| panic!("{}", report.to_text()))
    }

    fn dynamics(&self) -> Dynamics {
        start_dynamics(&self.load(), &Settings::default())
    }

    fn cell(&self, i: usize, j: usize) -> usize {
        i * self.cells[1] + j
    }

    fn length(&self) -> f64 {
        self.cells[0] as f64 * self.size[1]
    }
}

fn run(dynamics: &mut Dynamics, wrenches: &[Vec6], seconds: f64) {
    let mut impacts = Vec::new();
    for _ in 0..(seconds / DT).round() as usize {
        assert_eq!(dynamics.step(DT, wrenches, &mut impacts), None, "bad numbers");
    }
}

/// Runs under these wrenches and a drag of 3 m v that lets the sheet settle.
fn settle(dynamics: &mut Dynamics, wrenches: &[Vec6], seconds: f64) {
    /// 1/s: about critical for a cantilever's first mode.
    const DRAG: f64 = 3.0;
    let mut impacts = Vec::new();
    for _ in 0..(seconds / DT).round() as usize {
        let dragged: Vec<Vec6> = wrenches
            .iter()
            .zip(&dynamics.bodies)
            .map(|(wrench, body)| {
                let drag = vec6(-DRAG * body.properties.mass * body.velocity, DVec3::ZERO);
                std::array::from_fn(|k| wrench[k] + drag[k])
            })
            .collect();
        assert_eq!(dynamics.step(DT, &dragged, &mut impacts), None, "bad numbers");
    }
}

/// A strip of one column, 20 mm wide and 400 mm long.
const STRIP: Cloth = Cloth {
    cells: [20, 1],
    size: [0.02, 0.02],
    gravity: G,
    hem: true,
    stretch: 10.0,
    shear: 2.0,
    bending: 0.0,
    damping: 0.0,
};

/// J₀ by its series; ten terms are exact to rounding below 3.
fn bessel_0(x: f64) -> f64 {
    let square = -0.25 * x * x;
    (1..=15)
        .fold((1.0, 1.0), |(sum, term), k| {
            let next = term * square / f64::from(k * k);
            (sum + next, next)
        })
        .0
}

#[test]
fn cells_weigh_what_their_area_says() {
    let cloth = Cloth { cells: [4, 3], size: [0.03, 0.02], ..STRIP };
    let exhibit = cloth.load();
    assert_eq!(exhibit.bodies.len(), 12);
    for body in &exhibit.bodies {
        let mass = SIGMA * 0.03 * 0.02;
        assert!((body.properties.mass / mass - 1.0).abs() < 1e-5, "{} kg of {mass}", body.properties.mass);
        let thin = mass / 12.0 * 0.02 * 0.02;
        assert!((body.properties.inertia.x_axis.x / thin - 1.0).abs() < 1e-3, "{:?}", body.properties);
    }
    assert_eq!(exhibit.constraints.len(), 12, "a joint above each cell");
    assert_eq!(exhibit.wind_surfaces.len(), 12);
}

#[test]
fn a_hanging_strip_swings_like_a_hanging_chain() {
    /// Twenty stiff links for a chain: of the order of 1/N².
    const PERIOD: f64 = 3e-3;
    const ZERO: f64 = 2.404_825_557_695_773;
    let mut dynamics = STRIP.dynamics();
    let (count, length) = (STRIP.cells[0], STRIP.length());
    // The first mode from the free end s: J₀(ζ √(s/L)). A push of this shape, across the strip, excites it alone.
    let mode: Vec<f64> =
        (0..count).map(|i| bessel_0(ZERO * ((length - (i as f64 + 0.5) * STRIP.size[1]) / length).sqrt())).collect();
    let push: Vec<Vec6> = mode.iter().map(|shape| vec6(DVec3::Z * (1e-5 * shape), DVec3::ZERO)).collect();
    run(&mut dynamics, &push, 4.0 * DT);
    let none = vec![[0.0; 6]; count];
    let swing = |dynamics: &Dynamics| -> f64 {
        dynamics.bodies.iter().zip(&mode).map(|(body, shape)| body.position.z * shape).sum()
    };
    let (mut crossings, mut before) = (Vec::new(), swing(&dynamics));
    for step in 0..(10.0 / DT) as usize {
        run(&mut dynamics, &none, DT);
        let now = swing(&dynamics);
        if before < 0.0 && now >= 0.0 {
            crossings.push((step as f64 + before / (before - now)) * DT);
        }
        before = now;
    }
    let found = (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64;
    let expected = 2.0 * std::f64::consts::PI / (0.5 * ZERO * (G / length).sqrt());
    println!("period {found:.5} s, {expected:.5} s of a chain");
    assert!((found / expected - 1.0).abs() < PERIOD, "{found} s against {expected} s");
    assert!(dynamics.joint_error() < 1e-9);
}

#[test]
fn a_cantilever_bends_by_force_times_length_cubed_over_three_ei() {
    // N springs are the trapezoid rule of the formula's integral: 1 + 1/(2 N²).
    const DEFLECTION: f64 = 2e-3;
    let cloth = Cloth { cells: [8, 1], gravity: 0.0, bending: 3e-5, damping: 1e-3, ..STRIP };
    let (mut dynamics, length) = (cloth.dynamics(), cloth.length());
    let count = cloth.cells[0];
    let ei = cloth.bending * cloth.size[0];
    let force = 3.0 * ei / (length * length * length) * (0.01 * length);
    let mut wrenches = vec![[0.0; 6]; count];
    let arm = DVec3::NEG_Y * 0.5 * cloth.size[1];
    wrenches[count - 1] = vec6(DVec3::Z * force, arm.cross(DVec3::Z * force));
    settle(&mut dynamics, &wrenches, 12.0);
    let tip = &dynamics.bodies[count - 1];
    let found = (tip.position + tip.rotation * arm).z;
    let expected = 0.01 * length * (1.0 + 0.5 / (count * count) as f64);
    println!("deflection {:.5} mm, {:.5} mm by the formula", 1e3 * found, 1e3 * expected);
    assert!((found / expected - 1.0).abs() < DEFLECTION, "{found} m against {expected} m");
}

#[test]
fn a_sheet_shears_by_force_over_stiffness() {
    // Outer columns have seams on one side only. The stretch of the rows spreads the load but for shear lag, by which rows differ from their mean.
    const SHEAR: f64 = 1e-2;
    const LAG: f64 = 5e-2;
    let cloth = Cloth { cells: [8, 6], gravity: 0.0, damping: 2e-3, ..STRIP };
    let (mut dynamics, [rows, columns]) = (cloth.dynamics(), cloth.cells);
    let force = 2e-3;
    let mut wrenches = vec![[0.0; 6]; rows * columns];
    for j in 0..columns {
        let (own, arm) = (DVec3::X * (force / columns as f64), DVec3::NEG_Y * 0.5 * cloth.size[1]);
        wrenches[cloth.cell(rows - 1, j)] = vec6(own, arm.cross(own));
    }
    settle(&mut dynamics, &wrenches, 8.0);
    // Half a seam is missing at either side.
    let width = (columns - 1) as f64 * cloth.size[0];
    let expected = force / (cloth.shear * width);
    let found = |i: usize| dynamics.bodies[cloth.cell(i, 2)].rotation.z.asin() * 2.0;
    let mean = (0..rows).map(found).sum::<f64>() / rows as f64;
    assert!((mean / expected - 1.0).abs() < SHEAR, "the rows shear by {mean} rad in the mean, not {expected}");
    // The last row is the one that is pulled (Saint-Venant).
    for i in 0..rows - 1 {
        assert!((found(i) / expected - 1.0).abs() < LAG, "row {i} shears by {} rad, not {expected}", found(i));
    }
}

#[test]
fn a_free_sheet_stretches_by_force_over_stiffness() {
    const STRETCH: f64 = 1e-3;
    let cloth = Cloth { cells: [5, 6], size: [0.02, 0.02], gravity: 0.0, hem: false, damping: 2e-3, ..STRIP };
    let (mut dynamics, [rows, columns]) = (cloth.dynamics(), cloth.cells);
    let force = 5e-3;
    let mut wrenches = vec![[0.0; 6]; rows * columns];
    for i in 0..rows {
        let own = DVec3::X * (force / rows as f64);
        wrenches[cloth.cell(i, columns - 1)] = vec6(own, DVec3::ZERO);
        wrenches[cloth.cell(i, 0)] = vec6(-own, DVec3::ZERO);
    }
    settle(&mut dynamics, &wrenches, 8.0);
    let rest = (columns - 1) as f64 * cloth.size[0];
    let expected = rest * force / (cloth.stretch * cloth.length());
    for i in 0..rows {
        let place = |j| dynamics.bodies[cloth.cell(i, j)].position;
        let found = place(columns - 1).distance(place(0)) - rest;
        assert!((found / expected - 1.0).abs() < STRETCH, "row {i} stretches by {found} m, not {expected} m");
    }
}

/// A push across a free or hanging sheet that folds and shears it.
fn crumpling(cloth: &Cloth) -> Vec<Vec6> {
    let [rows, columns] = cloth.cells;
    (0..rows * columns)
        .map(|k| {
            let (i, j) = ((k / columns) as f64, (k % columns) as f64);
            let force = DVec3::new(0.4 * (i - 2.0), 0.1 * j, 1.0 - 0.5 * i + 0.3 * j) * 1e-3;
            vec6(force, DVec3::new(0.0, 2e-6 * (j - 1.0), 1e-6))
        })
        .collect()
}

#[test]
fn a_free_sheet_keeps_its_momentum_however_it_is_crumpled() {
    /// Of the momentum: rounding of some thousand substeps.
    const ROUNDING: f64 = 1e-9;
    /// Of the angular momentum, which is quadratic in the state: as many errors of 5·10⁻⁹.
    const METHOD: f64 = 1e-5;
    let cloth =
        Cloth { cells: [5, 4], size: [0.03, 0.03], gravity: 0.0, hem: false, bending: 3e-6, damping: 1e-3, ..STRIP };
    let mut dynamics = cloth.dynamics();
    run(&mut dynamics, &crumpling(&cloth), 0.05);
    let momentum = |dynamics: &Dynamics| {
        dynamics.bodies.iter().fold((DVec3::ZERO, DVec3::ZERO), |(p, l), body| {
            let own = body.properties.mass * body.velocity;
            (p + own, l + body.position.cross(own) + body.inertia_world() * body.angular_velocity)
        })
    };
    let before = momentum(&dynamics);
    run(&mut dynamics, &vec![[0.0; 6]; 20], 2.0);
    let after = momentum(&dynamics);
    assert!((after.0 - before.0).length() < ROUNDING * before.0.length(), "{before:?} {after:?}");
    assert!((after.1 - before.1).length() < METHOD * before.1.length(), "{before:?} {after:?}");
}

#[test]
fn a_hanging_sheet_never_gains_energy() {
    let cloth =
        Cloth { cells: [6, 4], size: [0.03, 0.03], bending: 3e-6, damping: 2e-3, stretch: 12.0, shear: 4.0, ..STRIP };
    let mut dynamics = cloth.dynamics();
    let rest = dynamics.energy();
    run(&mut dynamics, &crumpling(&cloth), 0.1);
    let none = vec![[0.0; 6]; 24];
    let (start, mut least) = (dynamics.energy(), dynamics.energy());
    for step in 0..(8.0 / DT) as usize {
        run(&mut dynamics, &none, DT);
        let now = dynamics.energy();
        // A whole step may err by 10⁻⁶ of the velocities, which is twice that of the energy, and both ways.
        assert!(now < least + 4e-6 * (start - rest), "gains {} of {} J in step {step}", now - least, start - rest);
        least = least.min(now);
    }
    println!("{:.3e} J of {:.3e} J are left", dynamics.energy() - rest, start - rest);
    assert!(dynamics.energy() < start, "it loses nothing");
}

/// Somebody before the silk pennant.
struct Visit {
    simulation: Simulation,
    aim: [f64; 2],
    blow: Option<f64>,
}

impl Visit {
    fn new() -> Self {
        let folder = exhibit::resolve("pennant").unwrap_or_else(|report| panic!("{report}"));
        let pennant = exhibit::load(&folder).unwrap_or_else(|report| panic!("{}", report.to_text()));
        Self { simulation: Simulation::new(Arc::new(pennant), Settings::default()), aim: [0.5, 0.6], blow: None }
    }

    /// Runs for this long; the velocities of the tails' cells, root mean square, m/s.
    fn run(&mut self, seconds: f64) -> f64 {
        let (steps, tails) = ((seconds / DT).round() as usize, self.tails());
        let mut squares = 0.0;
        for _ in 0..steps {
            let commands = [Command::Blow(self.blow)];
            let pointer = Some(self.aim);
            self.simulation.step(&StepInput { commands: &commands, pointer, ..StepInput::default() });
            assert!(self.simulation.events().iter().all(|event| event.kind != EventKind::Fault));
            assert!(self.simulation.joint_error() < 1e-9);
            squares += tails.clone().map(|i| self.simulation.bodies()[i].velocity.length_squared()).sum::<f64>();
        }
        (squares / (steps * tails.len()) as f64).sqrt()
    }

    /// The lowest row of cells.
    fn tails(&self) -> std::ops::Range<usize> {
        let count = self.simulation.bodies().len();
        count - 4..count
    }

    /// Middle of the tails, m.
    fn tail(&self) -> DVec3 {
        self.tails().map(|i| self.simulation.bodies()[i].position).sum::<DVec3>() / 4.0
    }
}

#[test]
fn the_pennant_hangs_still_flies_in_a_breath_and_hangs_still_again() {
    let mut visit = Visit::new();
    let still = visit.run(3.0);
    let home = visit.tail();
    assert!(still < 1e-3, "it stirs at {still} m/s when nobody blows");
    visit.blow = Some(4.0);
    visit.run(1.0);
    let way = visit.tail().distance(home);
    println!("a gentle breath moves the tails by {:.0} mm within a second", 1e3 * way);
    assert!(way > 0.03, "a gentle breath moves the tails by {way} m");
    visit.blow = None;
    visit.run(40.0);
    let (left, speed) = (visit.tail().distance(home), visit.run(1.0));
    println!("{:.2} mm and {speed:e} m/s after forty seconds", 1e3 * left);
    assert!(left < 5e-3 && speed < 2e-2, "{left} m and {speed} m/s are left");
}

#[test]
fn the_silk_flutters_more_than_in_proportion_to_the_breath() {
    let flutter = |speed: f64| {
        let mut visit = Visit::new();
        visit.blow = Some(speed);
        visit.run(2.0);
        visit.run(4.0)
    };
    let (weak, strong) = (flutter(1.0), flutter(12.0));
    println!("the tails move at {weak:.3} m/s in a breath of 1 m/s, {strong:.3} m/s in one of 12 m/s");
    assert!(strong > 0.2, "{strong} m/s");
    assert!(strong > 12.0 * weak, "{weak} m/s and {strong} m/s");
}

#[test]
fn a_breath_at_its_edge_turns_the_yard() {
    let mut visit = Visit::new();
    visit.aim = [0.54, 0.5];
    visit.blow = Some(10.0);
    let mut most: f64 = 0.0;
    for _ in 0..20 {
        visit.run(0.1);
        let yard = &visit.simulation.bodies()[0];
        most = most.max((yard.rotation * DVec3::X).z.abs());
    }
    println!("the yard turns by {:.1}°", most.asin().to_degrees());
    assert!(most > 0.05, "the yard turns by {most} rad");
}
