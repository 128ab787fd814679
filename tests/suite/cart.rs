//! The sailing cart as a visitor finds it: it starts at once, grips, drifts, stays on its tray and comes to rest.

use std::sync::Arc;

use soffio_exhibit as exhibit;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::noise::Random;
use soffio_simulation::{Command, EventKind, PointerGrab, STEPS_PER_SECOND, Settings, Simulation, StepInput};
use soffio_sound::SoundCommand;

/// Half lengths of the tray between its rims, m: `exhibits/forge/cart.rs`.
const FIELD: [f64; 2] = [0.33, 0.23];
/// Slip from which its tyres slide entirely: `exhibits/cart/exhibit.toml`.
const FULL_SLIP: f64 = 0.2;

/// Somebody before the cart.
struct Visit {
    simulation: Simulation,
    aim: [f64; 2],
    blow: Option<f64>,
    hand: Option<[f64; 2]>,
    bumps: usize,
    strikes: usize,
}

impl Visit {
    fn new(seed: u64) -> Self {
        let folder = exhibit::resolve("cart").unwrap_or_else(|report| panic!("{report}"));
        let cart = exhibit::load(&folder).unwrap_or_else(|report| panic!("{}", report.to_text()));
        let simulation = Simulation::new(Arc::new(cart), Settings { seed, ..Settings::default() });
        Self { simulation, aim: [0.5, 0.45], blow: None, hand: None, bumps: 0, strikes: 0 }
    }

    fn step(&mut self) {
        let commands = [Command::Blow(self.blow)];
        let cart = self.index("Cart");
        let hands: Vec<_> = self.hand.map(|at| PointerGrab { id: 1, at, body: Some(cart) }).into_iter().collect();
        let pointer = Some(self.aim);
        self.simulation.step(&StepInput {
            commands: &commands,
            pointer,
            pointer_grabs: &hands,
            ..StepInput::default()
        });
        for event in self.simulation.events() {
            assert!(event.kind != EventKind::Fault, "{event:?}");
            self.bumps += usize::from(event.kind == EventKind::Impact && event.bodies.contains(&Some(cart)));
        }
        let struck = |sound: &&SoundCommand| matches!(sound, SoundCommand::Strike(_));
        self.strikes += self.simulation.sounds().iter().filter(struck).count();
    }

    fn run(&mut self, seconds: f64) {
        (0..(seconds * STEPS_PER_SECOND as f64).round() as usize).for_each(|_| self.step());
    }

    fn index(&self, name: &str) -> usize {
        let bodies = &self.simulation.exhibit().bodies;
        bodies.iter().position(|body| body.name == name).unwrap_or_else(|| panic!("no body {name}"))
    }

    fn body(&self, name: &str) -> &RigidBody {
        &self.simulation.bodies()[self.index(name)]
    }

    /// Velocity of the rear axle's middle along the cart and across it, m/s.
    fn rear(&self) -> (f64, f64) {
        let cart = self.body("Cart");
        let velocity = cart.velocity_at(cart.pose().position);
        (velocity.dot(cart.rotation * DVec3::X), velocity.dot(cart.rotation * DVec3::Z))
    }

    /// Largest slip of the rear tyres while nobody touches it, of those times when it rolls.
    fn largest_slip(&mut self, seconds: f64) -> f64 {
        /// Slower wheels stand, m/s.
        const ROLLS: f64 = 0.03;
        let mut largest: f64 = 0.0;
        for _ in 0..(seconds * STEPS_PER_SECOND as f64) as usize {
            self.step();
            let (along, across) = self.rear();
            if along.abs() > ROLLS {
                largest = largest.max(across.abs() / along.abs());
            }
        }
        largest
    }

    /// Asserts that the cart stands on its wheels within the rims.
    fn assert_on_tray(&self) {
        /// Two slopes of 0.039 at right angles, and what a bump lifts; the stop of its tilt is at 40°.
        const UPRIGHT: f64 = 0.75;
        for wheel in ["WheelLeft", "WheelRight", "WheelFront"] {
            let at = self.body(wheel).position;
            assert!(at.x.abs() < FIELD[0] && at.z.abs() < FIELD[1] && at.y > 0.0, "{wheel} at {at}");
        }
        let up = self.body("Cart").rotation * DVec3::Y;
        assert!(up.y > UPRIGHT, "it leans: {up}");
    }
}

#[test]
fn a_gentle_breath_rolls_the_cart_at_once_without_a_drift() {
    let mut visit = Visit::new(1);
    visit.run(1.0);
    let start = visit.body("Cart").position;
    visit.blow = Some(4.0);
    let slip = visit.largest_slip(1.0);
    let way = visit.body("Cart").position.distance(start);
    println!("rolls {:.0} mm in the first second, slip {slip:.4}", 1e3 * way);
    assert!(way > 0.015, "{way} m");
    // The side forces are a small part of what the tyres can bear.
    assert!(slip < 0.3 * FULL_SLIP, "its tyres slip by {slip}");
}

#[test]
fn a_hard_breath_from_the_side_makes_it_drift_and_bump_into_the_rim() {
    let mut visit = Visit::new(1);
    visit.run(1.0);
    visit.aim = [0.44, 0.45];
    visit.blow = Some(14.0);
    let slip = visit.largest_slip(1.2);
    visit.blow = None;
    visit.run(3.0);
    println!("slip {slip:.2}, {} bumps, {} strikes", visit.bumps, visit.strikes);
    assert!(slip > FULL_SLIP, "its tyres grip at a slip of {slip}");
    assert!(visit.bumps > 0 && visit.strikes > 0, "{} bumps, {} strikes", visit.bumps, visit.strikes);
}

#[test]
fn it_stays_on_the_tray_whatever_is_blown_and_comes_to_rest() {
    /// A cart at rest, m/s: a millimetre in a minute.
    const REST: f64 = 2e-5;
    for seed in 1..=3 {
        let (mut visit, mut random) = (Visit::new(seed), Random::new(seed));
        for _ in 0..12 {
            visit.aim = [random.range(0.2, 0.8), random.range(0.25, 0.75)];
            visit.blow = Some(random.range(4.0, 17.0));
            for _ in 0..STEPS_PER_SECOND {
                visit.step();
                visit.assert_on_tray();
            }
            visit.blow = None;
            visit.run(random.range(0.2, 2.0));
            visit.assert_on_tray();
        }
        visit.run(20.0);
        let fastest = visit.simulation.bodies().iter().map(|b| b.velocity.length()).fold(0.0, f64::max);
        println!("seed {seed}: {} bumps, {fastest:e} m/s at the end", visit.bumps);
        assert!(fastest < REST, "seed {seed}: {fastest} m/s");
        assert!(visit.simulation.joint_error() < 1e-9);
    }
}

#[test]
fn a_hand_that_lifts_and_throws_it_leaves_it_on_its_wheels() {
    for (seed, to) in [[0.1, 0.1], [0.9, 0.1], [0.5, 0.0], [0.95, 0.9]].into_iter().enumerate() {
        let mut visit = Visit::new(seed as u64 + 1);
        visit.hand = Some([0.5, 0.5]);
        visit.run(0.3);
        visit.hand = Some(to);
        visit.run(0.5);
        visit.hand = None;
        visit.run(4.0);
        visit.assert_on_tray();
    }
}
