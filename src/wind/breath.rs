//! Velocity field of a breath: a round turbulent jet, or a cone of constant flow.
//!
//! Symbols: d = 2 r₀ lip diameter, U₀ speed at the lips, x distance along the axis, r distance from it, Q = U₀ π d²/4
//! the flow, l₀ distance of the cone's vertex behind the lips: by default r₀/tan 11.8°. Two spreading laws (method 4.1):
//!
//! ```text
//! jet    v(x, r) = U₀ min(1, 6 d/x) exp(−ln 2 (r / 0.094 x)²)
//! cone   v(x, r) = U₀ (l₀/(l₀ + x))²   where r ≤ r₀ (1 + x/l₀), else 0
//! ```
//!
//! The *jet* (default) is a round turbulent jet, which keeps its momentum and entrains air (S. B. Pope, Turbulent Flows,
//! 2000, section 5.1). Near the lips its half-width is d/2 until the law gives more. The *cone* follows from continuity:
//! the flow Q fills the cone with one speed over each section. It is far weaker at arm's length, since no air is
//! entrained.

use soffio_math::{DVec3, PI, exp};

/// Density of air, kg/m³ (20 °C, 1013 hPa).
pub const AIR_DENSITY: f64 = 1.2;
/// B of the centre-line decay of the jet, v_c = B U₀ d / x (Pope 2000, table 5.1: 5.8 to 6.1).
pub const DECAY: f64 = 6.0;
/// Half-speed radius of the jet over distance, S (Pope 2000, table 5.1: 0.094).
pub const SPREAD: f64 = 0.094;
/// Tangent of the visible half-angle of a round jet, 11.8°.
pub const TAN_HALF_ANGLE: f64 = 0.208_916;
/// Radius of the jet in half-speed radii; beyond it the speed is below a 65,000th of that on the axis.
const JET_EDGE: f64 = 4.0;

/// Law by which a breath spreads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum SpreadLaw {
    /// Constant flow: the air that leaves the lips fills a cone.
    Cone {
        /// l₀, m: the longer, the narrower; `None` is r₀/tan 11.8°, as wide as a jet looks.
        vertex_distance: Option<f64>,
    },
    /// Constant momentum: a round turbulent jet.
    #[default]
    Jet,
}

/// Speed of a breath at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JetPoint {
    /// Distance along the axis, m.
    pub distance: f64,
    /// v/U₀.
    pub speed_ratio: f64,
}

/// A breath: position, direction and speed at the lips, and its spreading law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Breath {
    /// Centre of the lips, world, m.
    pub mouth: DVec3,
    /// Direction of the breath, unit.
    pub direction: DVec3,
    /// d, m.
    pub lip_diameter: f64,
    /// U₀, m/s.
    pub speed: f64,
    /// Its spreading law.
    pub law: SpreadLaw,
}

impl Breath {
    /// Momentum flow ρ Q U₀ of air that leaves the lips at `speed` (m/s), N: upper bound of the force of the breath.
    pub fn momentum_flow(&self, speed: f64) -> f64 {
        AIR_DENSITY * 0.25 * PI * self.lip_diameter * self.lip_diameter * speed * speed
    }

    /// Vertex of the cone, l₀ behind the lips, world, m: the virtual origin of the jet.
    pub fn vertex(&self) -> DVec3 {
        self.mouth - self.vertex_distance() * self.direction
    }

    /// Point of the lips' plane from which air reaches a point in front, world, m. Rays end here and not at the vertex, so an
    /// object between the vertex and the lips gives no shelter.
    pub fn origin(&self, point: DVec3) -> DVec3 {
        let (vertex, behind) = (self.vertex(), self.vertex_distance());
        let x = (point - self.mouth).dot(self.direction).max(0.0);
        vertex + behind / (behind + x) * (point - vertex)
    }

    /// l₀: distance of the vertex behind the lips, m.
    pub fn vertex_distance(&self) -> f64 {
        match self.law {
            SpreadLaw::Cone { vertex_distance: Some(distance) } => distance,
            _ => 0.5 * self.lip_diameter / TAN_HALF_ANGLE,
        }
    }

    /// Half-width at a distance `x` (m) from the lips, m: half-speed radius of the jet, or radius of the cone.
    pub fn half_width(&self, x: f64) -> f64 {
        match self.law {
            SpreadLaw::Jet => (SPREAD * x).max(0.5 * self.lip_diameter),
            SpreadLaw::Cone { vertex_distance: None } => 0.5 * self.lip_diameter + TAN_HALF_ANGLE * x,
            SpreadLaw::Cone { vertex_distance: Some(distance) } => 0.5 * self.lip_diameter * (1.0 + x / distance),
        }
    }

    /// Distance along the axis and v(x, r)/U₀ at a point (world, m); `None` outside the breath.
    #[inline]
    pub fn relative_speed(&self, point: DVec3) -> Option<JetPoint> {
        let from = point - self.mouth;
        let x = from.dot(self.direction);
        if x <= 0.0 {
            return None;
        }
        let r2 = (from - x * self.direction).length_squared();
        let half = self.half_width(x);
        let speed_ratio = match self.law {
            SpreadLaw::Jet if r2 < JET_EDGE * JET_EDGE * half * half => {
                (DECAY * self.lip_diameter / x).min(1.0) * exp(-std::f64::consts::LN_2 * r2 / (half * half))
            }
            SpreadLaw::Cone { .. } if r2 <= half * half => {
                let narrowing = self.vertex_distance() / (self.vertex_distance() + x);
                narrowing * narrowing
            }
            _ => return None,
        };
        Some(JetPoint { distance: x, speed_ratio })
    }

    /// Whether the breath may reach a ball (world, m). Conservative: false only where the ball lies behind the lips, or where
    /// its point nearest to the axis is outside the breath's width at its far end.
    pub fn intersects_ball(&self, center: DVec3, radius: f64) -> bool {
        let from = center - self.mouth;
        let x = from.dot(self.direction);
        let edge = match self.law {
            SpreadLaw::Jet => JET_EDGE,
            SpreadLaw::Cone { .. } => 1.0,
        };
        let off = (from - x * self.direction).length() - radius;
        x > -radius && off <= edge * self.half_width(x + radius)
    }

    /// Steady mean velocity at a point (world, m), without gusts and without the delay of the front, m/s.
    pub fn velocity(&self, point: DVec3) -> DVec3 {
        let Some(JetPoint { speed_ratio, .. }) = self.relative_speed(point) else { return DVec3::ZERO };
        self.flow_direction(point) * (speed_ratio * self.speed)
    }

    /// Unit direction of the flow at a point: away from the vertex.
    pub fn flow_direction(&self, point: DVec3) -> DVec3 {
        (point - self.vertex()).try_normalize().unwrap_or(self.direction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::noise::Random;

    const CONE: SpreadLaw = SpreadLaw::Cone { vertex_distance: None };

    fn breath(law: SpreadLaw, speed: f64) -> Breath {
        Breath { mouth: DVec3::ZERO, direction: DVec3::Z, lip_diameter: 0.01, speed, law }
    }

    fn on_axis(law: SpreadLaw, speed: f64, x: f64) -> f64 {
        breath(law, speed).velocity(DVec3::Z * x).length()
    }

    /// ∫ f(v) dA over the section at x: the midpoint rule on rings.
    fn over_section(breath: &Breath, x: f64, f: impl Fn(f64) -> f64) -> f64 {
        let n = 4000;
        let dr = JET_EDGE * breath.half_width(x) / f64::from(n);
        (0..n)
            .map(|i| {
                let r = (f64::from(i) + 0.5) * dr;
                let ratio = breath.relative_speed(DVec3::new(r, 0.0, x)).map_or(0.0, |at| at.speed_ratio);
                f(ratio * breath.speed) * 2.0 * PI * r * dr
            })
            .sum()
    }

    /// Midpoint rule on 4000 rings, one of which straddles the cone's rim.
    const QUADRATURE: f64 = 1e-3;

    #[test]
    fn the_jet_keeps_its_momentum() {
        // ∫ ρ v² dA of the Gaussian profile: π/(2 ln 2) (0.094)² 36 = 0.72 of the flow at the lips at any x.
        // The published constants of decay and spread belong to the mean flow; turbulence carries the rest.
        let expected = PI / (2.0 * std::f64::consts::LN_2) * SPREAD * SPREAD * DECAY * DECAY / (0.25 * PI);
        for x in [0.3, 0.5, 0.8, 1.2] {
            let breath = breath(SpreadLaw::Jet, 9.0);
            let flow = over_section(&breath, x, |v| AIR_DENSITY * v * v) / breath.momentum_flow(9.0);
            assert!((flow / expected - 1.0).abs() < QUADRATURE, "{flow} at {x} m");
        }
    }

    #[test]
    fn the_cone_keeps_its_flow_at_any_spread() {
        for vertex_distance in [None, Some(0.005), Some(0.05), Some(1.0)] {
            for x in [0.05, 0.3, 0.5, 1.2] {
                let breath = breath(SpreadLaw::Cone { vertex_distance }, 9.0);
                let flow = over_section(&breath, x, |v| v) / (0.25 * PI * 1e-4 * 9.0);
                assert!((flow - 1.0).abs() < QUADRATURE, "{flow} of the flow at {x} m, l₀ {vertex_distance:?}");
            }
        }
    }

    #[test]
    fn a_farther_vertex_gives_a_narrower_and_faster_cone() {
        // (l₀/(l₀ + x))² and r₀ (l₀ + x)/l₀, in figures: l₀ of 50 mm at 450 mm gives a hundredth and ten times the lips.
        let cone = |distance| breath(SpreadLaw::Cone { vertex_distance: Some(distance) }, 9.0);
        assert!((cone(0.05).velocity(DVec3::Z * 0.45).length() - 0.09).abs() < 1e-12);
        assert!((cone(0.05).half_width(0.45) - 0.05).abs() < 1e-12);
        assert!(cone(0.5).half_width(0.45) < 0.01 && cone(0.5).velocity(DVec3::Z * 0.45).length() > 2.0);
        assert_eq!(cone(0.05).velocity(DVec3::new(0.051, 0.0, 0.45)), DVec3::ZERO, "outside it the air is still");
    }

    #[test]
    fn centre_speeds_are_the_published_ones() {
        // Tables of human breaths (two digits): the jet at 8.9 m/s through 10 mm, and the cone at half a metre.
        const TWO_DIGITS: f64 = 0.03;
        for (x, v) in [(0.3, 1.8), (0.5, 1.07), (0.8, 0.67), (1.2, 0.45)] {
            assert!((on_axis(SpreadLaw::Jet, 8.9, x) / v - 1.0).abs() < TWO_DIGITS);
        }
        let (jet, cone) = (on_axis(SpreadLaw::Jet, 8.9, 0.5), on_axis(CONE, 8.9, 0.5));
        assert!((cone / 0.019 - 1.0).abs() < TWO_DIGITS, "{cone} m/s");
        assert!((jet / cone / 57.0 - 1.0).abs() < TWO_DIGITS, "the jet is {} times as fast", jet / cone);
    }

    #[test]
    fn air_behind_the_lips_and_outside_the_breath_is_still() {
        for law in [CONE, SpreadLaw::Jet] {
            let breath = breath(law, 9.0);
            assert_eq!(breath.velocity(DVec3::new(0.0, 0.0, -0.01)), DVec3::ZERO);
            assert_eq!(breath.velocity(DVec3::new(0.3, 0.0, 0.5)), DVec3::ZERO);
        }
    }

    #[test]
    fn no_air_moves_in_a_ball_outside_the_breath() {
        const SEED: u64 = 12;
        let mut random = Random::new(SEED);
        let mut any = |size: f64| DVec3::new(random.signed(), random.signed(), random.signed()) * size;
        for law in [CONE, SpreadLaw::Jet] {
            let (breath, mut out, mut in_reach) = (breath(law, 9.0), 0, 0);
            for _ in 0..2000 {
                let (center, radius) = (any(0.3), any(0.1).length());
                let moves = (0..20).any(|_| {
                    let point = center + any(1.0).normalize() * (radius * any(1.0).x.abs());
                    breath.velocity(point) != DVec3::ZERO
                });
                if breath.intersects_ball(center, radius) {
                    in_reach += 1;
                } else {
                    out += 1;
                    assert!(!moves, "seed {SEED}, {law:?}: air moves within {radius} m of {center}");
                }
            }
            assert!(out > 100 && in_reach > 100, "{law:?}: {out} out of reach, {in_reach} in reach");
        }
    }
}
