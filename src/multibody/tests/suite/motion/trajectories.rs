//! Double and triple pendulums, regular and chaotic, against Lagrange's equations in angles, integrated to rounding.
//!
//! Thin rods of length l and mass m, θ from straight down; a_ij is the displacement of rod i's centre per unit of θ_j (l_j
//! of a rod above it, l_i/2 of its own), B_jk = Σ_i m_i a_ij a_ik:
//!
//! ```text
//! Σ_k (B_jk cos(θ_j − θ_k) + δ_jk m l²/12) θ̈_k + Σ_k B_jk sin(θ_j − θ_k) θ̇_k² + g Σ_i m_i a_ij sin θ_j = 0
//! ```

use soffio_math::{DVec3, cos, sin, sincos};
use soffio_multibody::dynamics::Integrator;

use super::reference::advance;
use super::{CLOSED, G, INTEGRATORS, World, rod, step};

/// Rods: length, mass.
const RODS: [(f64, f64); 3] = [(0.3, 0.2), (0.25, 0.15), (0.2, 0.1)];

/// The pendulum's angular accelerations.
fn rate(y: &[f64]) -> Vec<f64> {
    let n = y.len() / 2;
    let (angle, angle_rate) = y.split_at(n);
    let length = |i: usize, j: usize| match i.cmp(&j) {
        std::cmp::Ordering::Less => 0.0,
        std::cmp::Ordering::Equal => 0.5 * RODS[j].0,
        std::cmp::Ordering::Greater => RODS[j].0,
    };
    let mut m = [[0.0; 4]; 3];
    for j in 0..n {
        for k in 0..n {
            let b: f64 = (0..n).map(|i| RODS[i].1 * length(i, j) * length(i, k)).sum();
            let (s, c) = sincos(angle[j] - angle[k]);
            m[j][k] = b * c;
            m[j][3] -= b * s * angle_rate[k] * angle_rate[k];
        }
        let (l, mass) = RODS[j];
        m[j][j] += mass * l * l / 12.0;
        m[j][3] -= G * (0..n).map(|i| RODS[i].1 * length(i, j)).sum::<f64>() * sin(angle[j]);
    }
    for k in 0..n {
        for i in k + 1..n {
            let s = m[i][k] / m[k][k];
            for j in (k..n).chain([3]) {
                m[i][j] -= s * m[k][j];
            }
        }
    }
    let mut out = angle_rate.to_vec();
    out.extend([0.0; 3].iter().take(n));
    for k in (0..n).rev() {
        out[n + k] = (m[k][3] - (k + 1..n).map(|j| m[k][j] * out[n + j]).sum::<f64>()) / m[k][k];
    }
    out
}

/// Ends of the rods at these angles.
fn places(angles: &[f64]) -> Vec<DVec3> {
    let mut out = vec![DVec3::ZERO];
    for (i, angle) in angles.iter().enumerate() {
        out.push(out[i] + RODS[i].0 * DVec3::new(sin(*angle), -cos(*angle), 0.0));
    }
    out
}

/// Largest error of the tip within `seconds`, m; the largest gap of a joint, m; and the difference between the reference and
/// that of half steps, which grows as all errors do, m.
fn tip_error(start: &[f64], integrator: Integrator, per_second: u32, seconds: u32) -> (f64, f64, f64) {
    let n = start.len();
    let pins = places(start);
    let mut world = World::new((0..n).map(|i| rod(RODS[i].1, pins[i], pins[i + 1])).collect());
    for i in 0..n {
        world.pin(&format!("pin-{i}"), i, i.checked_sub(1), pins[i]);
    }
    let tip = world.anchor(Some(n - 1), pins[n]).point;
    let mut dynamics = world.start(integrator);
    let mut y = start.to_vec();
    y.resize(2 * n, 0.0);
    let dt = 1.0 / f64::from(per_second);
    let no_wrenches = vec![[0.0; 6]; n];
    let (mut worst, mut apart, mut doubt) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut finer = y.clone();
    for _ in 0..per_second * seconds {
        step(&mut dynamics, dt, &no_wrenches);
        y = advance(&|_, y: &[f64]| rate(y), 0.0, &y, dt);
        finer = (0..2).fold(finer, |y, _| advance(&|_, y: &[f64]| rate(y), 0.0, &y, 0.5 * dt));
        let expected = places(&finer[..n])[n];
        doubt = doubt.max(places(&y[..n])[n].distance(expected));
        worst = worst.max(dynamics.bodies[n - 1].pose().point(tip).distance(expected));
        apart = apart.max(dynamics.joint_error());
    }
    (worst, apart, doubt)
}

#[test]
fn regular_pendulums_stay_within_a_nanometre_for_ten_seconds() {
    const BAR: f64 = 1e-9;
    for (name, start) in [("double", &[0.4, 0.5][..]), ("triple", &[0.3, 0.35, 0.4])] {
        for integrator in INTEGRATORS {
            let (error, apart, doubt) = tip_error(start, integrator, 240, 10);
            println!("{name}, regular, {integrator:?} at 1/240: tip off by {error:.1e} m, reference {doubt:.0e} m");
            // The bar of the precise integrator; the fourth order has its own.
            let allowed = if integrator == Integrator::Precise { BAR } else { 1e-5 };
            assert!(error < allowed, "{name}, {integrator:?}: tip off by {error:e} m");
            assert!(apart < CLOSED && doubt < BAR);
        }
    }
}

#[test]
fn chaotic_pendulums_are_followed_for_ten_seconds() {
    // Errors grow by many orders from these starts: the double pendulum's fourth order ends millimetres off. From wilder
    // ones a reference of this precision soon differs from itself in half steps.
    const BAR: f64 = 1e-5;
    for (name, start) in [("double", &[1.45, 1.45][..]), ("triple", &[1.33, 1.33, 1.33])] {
        for integrator in INTEGRATORS {
            let (error, apart, doubt) = tip_error(start, integrator, 1000, 10);
            println!("{name}, chaotic, {integrator:?} at 1/1000: tip off by {error:.1e} m, reference {doubt:.0e} m");
            if integrator == Integrator::Precise {
                assert!(error < BAR, "{name}, {integrator:?}: tip off by {error:e} m");
            }
            assert!(apart < CLOSED && doubt < BAR);
        }
    }
}
