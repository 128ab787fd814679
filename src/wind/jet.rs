//! The breath as a field: how fast the air is at a point before the lips.
//!
//! Symbols: d lip diameter, U₀ speed at the lips, x distance along the axis, r distance from it.
//!
//! **Jet** (default). A round turbulent jet keeps its momentum and entrains air (S. B. Pope, Turbulent
//! Flows, 2000, section 5.1):
//!
//! ```text
//! v_c(x) = U₀ min(1, 6 d/x)        v(x, r) = v_c exp(−ln 2 (r / 0.094 x)²)        Q = U₀ π d²/4
//! ```
//!
//! **Front.** The head of a starting jet travels at half the speed of its centre line, dx/dt = 3 U₀ d/x, so that air
//! found at x left the lips when the blown length Φ(t) = ∫ U₀ dt was smaller by x²/(6 d). With Φ kept as a history,
//! the speed at x is that of the air that left at that time: a breath that swells and fades reaches a plate in the
//! same order, and its tail still arrives after the lips have closed.
//!
//! The air near the lips follows a straight tube of width d until its half-width by the jet law is wider.

use std::collections::VecDeque;

use crate::math::{DVec3, PI, exp};

/// kg/m³, air at 20 °C.
pub const AIR_DENSITY: f64 = 1.2;
/// Centre-line decay: v_c = DECAY · U₀ d / x.
pub const DECAY: f64 = 6.0;
/// Half-speed radius over distance.
pub const SPREAD: f64 = 0.094;
/// How long air that has left the lips is followed, s.
const MEMORY: f64 = 3.0;
/// After the lips close the puff still drifts on: its drive falls by 1/e in this time, s.
const DRIFT_TIME: f64 = 0.4;

/// A breath: where it comes from, where it goes, how fast it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// Centre of the lips, world, m.
    pub mouth: DVec3,
    /// Unit.
    pub direction: DVec3,
    /// d, m.
    pub lip_diameter: f64,
    /// U₀, m/s.
    pub speed: f64,
}

impl Jet {
    /// Momentum flow ρ Q U₀ at the lips, N: no breath pushes harder than this.
    pub fn momentum_flow(&self) -> f64 {
        AIR_DENSITY * 0.25 * PI * self.lip_diameter * self.lip_diameter * self.speed * self.speed
    }

    /// Speed on the axis at distance x of air that left the lips at `speed`, m/s.
    pub fn center_speed(&self, x: f64, speed: f64) -> f64 {
        speed * (DECAY * self.lip_diameter / x.max(f64::MIN_POSITIVE)).min(1.0)
    }

    /// Distance along the axis and share of the axis speed at a point; `None` behind the lips.
    pub fn profile(&self, point: DVec3) -> Option<(f64, f64)> {
        let from = point - self.mouth;
        let x = from.dot(self.direction);
        if x <= 0.0 {
            return None;
        }
        let r2 = (from - x * self.direction).length_squared();
        let half = (SPREAD * x).max(0.5 * self.lip_diameter);
        Some((x, exp(-std::f64::consts::LN_2 * r2 / (half * half))))
    }

    /// Velocity of the air at a point, the front long past, m/s.
    pub fn velocity(&self, point: DVec3) -> DVec3 {
        match self.profile(point) {
            Some((x, share)) => self.flow_direction(point) * (share * self.center_speed(x, self.speed)),
            None => DVec3::ZERO,
        }
    }

    /// Where the air goes at a point: it fans out from a virtual origin behind the lips.
    pub fn flow_direction(&self, point: DVec3) -> DVec3 {
        // The visible cone of 11.8° meets the lips' rim this far behind them.
        let behind = 0.5 * self.lip_diameter / TAN_HALF_ANGLE;
        (point - self.mouth + behind * self.direction).try_normalize().unwrap_or(self.direction)
    }
}

/// Tangent of the visible half-angle, 11.8°.
const TAN_HALF_ANGLE: f64 = 0.208_916;

/// The blown length Φ over the last seconds: which air is where.
#[derive(Clone, Debug, Default)]
pub struct Front {
    /// (Φ, U₀) at the end of each step, newest last.
    history: VecDeque<(f64, f64)>,
    drive: f64,
}

impl Front {
    /// Remembers one step of `dt` seconds at source speed `speed`.
    pub fn advance(&mut self, speed: f64, dt: f64) {
        self.drive = speed.max(self.drive * exp(-dt / DRIFT_TIME));
        if self.history.is_empty() {
            // Room for all that is ever remembered.
            self.history.reserve((MEMORY / dt) as usize + 2);
            self.history.push_back((0.0, 0.0));
        }
        let blown = self.history.back().map_or(0.0, |&(phi, _)| phi) + self.drive * dt;
        self.history.push_back((blown, speed));
        if self.history.len() as f64 * dt > MEMORY {
            self.history.pop_front();
        }
    }

    /// Source speed of the air that is now at distance `x` (m) before lips of diameter `d` (m).
    pub fn speed_at(&self, x: f64, d: f64) -> f64 {
        let Some(&(now, _)) = self.history.back() else { return 0.0 };
        let left = now - x * x / (DECAY * d);
        // Φ never falls, so the history is sorted.
        let index = self.history.partition_point(|&(phi, _)| phi < left);
        if index == 0 && self.history.front().is_some_and(|&(phi, _)| phi > left) {
            return 0.0;
        }
        self.history.get(index).map_or(0.0, |&(_, speed)| speed)
    }

    /// Is air still on its way?
    pub fn in_flight(&self) -> bool {
        self.history.iter().any(|&(_, speed)| speed > 0.0)
    }

    /// Forgets all air in flight.
    pub fn clear(&mut self) {
        self.history.clear();
        self.drive = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn jet(speed: f64) -> Jet {
        Jet { mouth: DVec3::ZERO, direction: DVec3::Z, lip_diameter: 0.01, speed }
    }

    #[test]
    fn momentum_is_conserved_along_the_jet() {
        // ∫ ρ v² dA of the Gaussian profile: π/(2 ln 2) (0.094)² 36 = 0.72 of the flow at the lips at any x.
        // The published constants of decay and spread belong to the mean flow; turbulence carries the rest.
        let at = |x: f64| {
            let jet = jet(9.0);
            let n = 2000;
            let dr = 0.8 * x / f64::from(n);
            let flow: f64 = (0..n)
                .map(|i| {
                    let r = (f64::from(i) + 0.5) * dr;
                    let (x, share) = jet.profile(DVec3::new(r, 0.0, x)).expect("ahead");
                    let v = share * jet.center_speed(x, 9.0);
                    AIR_DENSITY * v * v * 2.0 * PI * r * dr
                })
                .sum();
            flow / jet.momentum_flow()
        };
        // Midpoint rule on 2000 rings.
        const QUADRATURE: f64 = 1e-3;
        let expected = PI / (2.0 * std::f64::consts::LN_2) * SPREAD * SPREAD * DECAY * DECAY / (0.25 * PI);
        for x in [0.3, 0.5, 0.8, 1.2] {
            assert!((at(x) / expected - 1.0).abs() < QUADRATURE, "{} at {x} m", at(x));
        }
    }

    #[test]
    fn centre_speeds_are_the_published_ones() {
        // 6 U₀ d/x for a normal breath, 8.9 m/s through lips of 10 mm: 1.8, 1.07, 0.67, 0.45 m/s at 0.3, 0.5, 0.8, 1.2 m.
        for (x, v) in [(0.3, 1.8), (0.5, 1.07), (0.8, 0.67), (1.2, 0.45)] {
            assert!((jet(8.9).center_speed(x, 8.9) / v - 1.0).abs() < 0.02);
        }
    }

    #[test]
    fn the_front_arrives_when_the_formula_says() {
        let (dt, d, speed, x) = (1.0 / 240.0, 0.01, 8.9, 0.5);
        let mut front = Front::default();
        let mut arrival = None;
        for step in 1..480 {
            front.advance(speed, dt);
            if front.speed_at(x, d) > 0.0 {
                arrival = Some(f64::from(step) * dt);
                break;
            }
        }
        // t = x²/(6 U₀ d) = 0.468 s; found within one step.
        let expected = x * x / (DECAY * speed * d);
        assert!((arrival.expect("the front arrives") - expected).abs() < 1.5 * dt, "{arrival:?} for {expected}");
    }

    #[test]
    fn the_tail_arrives_and_then_the_air_is_still() {
        let dt = 1.0 / 240.0;
        let mut front = Front::default();
        for _ in 0..240 {
            front.advance(8.9, dt);
        }
        front.advance(0.0, dt);
        assert!(front.speed_at(0.4, 0.01) > 0.0, "air on its way still arrives");
        for _ in 0..960 {
            front.advance(0.0, dt);
        }
        assert_eq!(front.speed_at(0.4, 0.01), 0.0);
    }
}
