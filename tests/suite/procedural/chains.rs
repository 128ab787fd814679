//! The light and the heavy dragged chain of the exhibit `chains`, in numbers: how far each hangs back, how much its links
//! turn, and how long it goes on when the hand stands still.

use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_math::DVec3;
use soffio_simulation::{self as simulation, MotionMode, Simulation, StepInput};

const LINKS: usize = 8;

fn load(id: &str) -> Arc<Exhibit> {
    let folder = exhibit::resolve(id).unwrap_or_else(|report| panic!("{report}"));
    Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{id}: {}", report.to_text())))
}

/// What a dragged chain does from the fourth to the twentieth second.
#[derive(Clone, Copy, Debug, Default)]
struct Mechanisms {
    /// How far its end hangs beside its hook, rms, m.
    beside: f64,
    /// Turn of a link, rms over the links, rad/s.
    spin: f64,
    /// Bend between a link and the next, rms, rad.
    bend: f64,
    /// By how long its end is behind the carriage, s: the delay at which the two ways agree best.
    behind: f64,
}

fn index(exhibit: &Exhibit, name: &str) -> usize {
    exhibit.bodies.iter().position(|body| body.name == name).unwrap_or_else(|| panic!("no {name}"))
}

fn square(x: f64) -> f64 {
    x * x
}

fn drag(mode: MotionMode) -> [Mechanisms; 2] {
    const FROM: usize = 960;
    const STEPS: usize = 4800;
    let exhibit = load("chains");
    let mut simulation =
        Simulation::new(exhibit.clone(), simulation::Settings { wind: false, ..simulation::Settings::default() });
    let carriage = index(&exhibit, "Carriage");
    let chains = ["Light", "Heavy"].map(|kind| {
        let links: Vec<usize> = (1..=LINKS).map(|k| index(&exhibit, &format!("{kind}{k}"))).collect();
        (links, index(&exhibit, &format!("{kind}Disc")))
    });
    let mut mechanisms = [Mechanisms::default(); 2];
    let (mut way, mut ends) = (Vec::new(), [Vec::new(), Vec::new()]);
    for step in 0..STEPS {
        simulation.step(&StepInput { mode: Some(mode), ..StepInput::default() });
        assert!(simulation.joint_error() < 1e-6, "{mode:?} step {step}: {} m", simulation.joint_error());
        if step < FROM {
            continue;
        }
        let bodies = simulation.bodies();
        let x = bodies[carriage].position.x;
        way.push(x);
        for (k, ((links, disc), mechanisms)) in chains.iter().zip(&mut mechanisms).enumerate() {
            let hook = bodies[links[0]].pose().position;
            let end = bodies[*disc].pose().position;
            ends[k].push(end.x - hook.x + x);
            mechanisms.beside += square(end.x - hook.x);
            for pair in links.windows(2) {
                let [a, b] = [pair[0], pair[1]].map(|link| bodies[link].rotation * DVec3::Y);
                mechanisms.bend += square(a.angle_between(b)) / (LINKS - 1) as f64;
            }
            mechanisms.spin +=
                links.iter().map(|&l| bodies[l].angular_velocity.length_squared()).sum::<f64>() / LINKS as f64;
        }
    }
    for (mechanisms, end) in mechanisms.iter_mut().zip(&ends) {
        let mean = |sum: f64| (sum / way.len() as f64).sqrt();
        (mechanisms.beside, mechanisms.spin, mechanisms.bend) =
            (mean(mechanisms.beside), mean(mechanisms.spin), mean(mechanisms.bend));
        let apart = |delay: usize| -> f64 { (240..way.len()).map(|i| square(end[i] - way[i - delay])).sum() };
        let best = (0..240).min_by(|&a, &b| apart(a).total_cmp(&apart(b))).expect("delays");
        mechanisms.behind = best as f64 / 240.0;
    }
    println!("{mode:?}: light {:?}\n  heavy {:?}", mechanisms[0], mechanisms[1]);
    mechanisms
}

#[test]
fn inertia_over_mass_of_a_heavy_link_is_twice_that_of_a_light_one() {
    let exhibit = load("chains");
    let ratio = |name: &str| {
        let mass = &exhibit.bodies[index(&exhibit, name)].properties;
        (mass.mass, mass.inertia.z_axis.z / mass.mass)
    };
    let ((light, light_ratio), (heavy, heavy_ratio)) = (ratio("Light4"), ratio("Heavy4"));
    println!("light {light} kg, I/m {light_ratio} m²; heavy {heavy} kg, I/m {heavy_ratio} m²");
    assert!(heavy > 40.0 * light, "{heavy} kg and {light} kg");
    assert!(heavy_ratio > 1.5 * light_ratio, "{heavy_ratio} m² and {light_ratio} m²");
}

/// Held by the air at the rate c, a chain of the length L that is dragged evenly leans by c v/g everywhere, so that its end
/// comes c L/g later. The heavy one comes at once, and sways by itself as it has nothing to hold it.
#[test]
fn the_light_chain_hangs_back_by_what_the_air_takes_and_the_heavy_one_sways() {
    const C: f64 = 1.5;
    const LENGTH: f64 = 0.044 * LINKS as f64;
    /// The carriage does not go evenly, s.
    const LATE: f64 = 0.01;
    for mode in [MotionMode::Dynamic, MotionMode::PositionBased] {
        let [light, heavy] = drag(mode);
        assert!((light.behind - C * LENGTH / 9.81).abs() < LATE, "{mode:?}: {} s", light.behind);
        assert!(heavy.behind < LATE, "{mode:?}: {} s", heavy.behind);
        assert!(light.beside > 1.2 * heavy.beside, "{mode:?}: {} and {} m", light.beside, heavy.beside);
        assert!(heavy.spin > 1.4 * light.spin, "{mode:?}: {} and {} rad/s", heavy.spin, light.spin);
        assert!(heavy.bend > 2.5 * light.bend, "{mode:?}: {} and {} rad", heavy.bend, light.bend);
    }
}
