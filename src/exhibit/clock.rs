//! Clocks: the body of the minute hand, and the wheels' rotations at another hour.
//!
//! A clock's model shows one time. To set the clock, wheels that depend on the hour alone (hour wheel, count wheel) are
//! rotated at once to the last time before now at which the minute hand stands as in the model. Then the minute hand is
//! turned to the present time through the clock's own wheels (`soffio_simulation`).
//!
//! ```text
//! n = ⌊(now − initial time)/1 h⌋ mod 12     hours that the clock is set forward
//! rotation of a wheel = n · (angle an hour)  or  Σ of the hours struck on the way · (angle a strike)
//! ```

use soffio_geometry::bodies::RigidBody;
use soffio_math::{DVec3, rotation};

/// One hour, s.
pub const HOUR: f64 = 3600.0;
/// Time after which a dial shows the same, s.
pub const DIAL_PERIOD: f64 = 12.0 * HOUR;

/// The hands of a clock.
#[derive(Clone, Debug, PartialEq)]
pub struct Clock {
    /// Index of the minute hand among the exhibit's bodies. A clutch holds it on its arbor, so that it can be set.
    pub minute_hand: usize,
    /// Axis of its clockwise rotation, unit, node frame.
    pub axis: DVec3,
    /// Friction torque of its clutch, N m.
    pub friction: f64,
    /// Time that the hands show at the start, s after twelve.
    pub initial_time: f64,
    /// Wheels that rotate by the hour.
    pub by_hour: Vec<CountedRotation>,
    /// Wheels that rotate by the strike of the bell.
    pub by_strike: Vec<CountedRotation>,
    /// Index of the body that moves while the clock strikes: setting the hands waits for it.
    pub striking_body: Option<usize>,
}

/// The rotation of a body for each hour or strike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CountedRotation {
    /// Index of the body.
    pub body: usize,
    /// Axis through its origin, unit, node frame.
    pub axis: DVec3,
    /// Angle for each hour or strike, rad.
    pub angle: f64,
}

impl Clock {
    /// Whole hours from the time shown at the start to `time` (s after any midnight or noon): 0 to 11.
    pub fn hours_before(&self, time: f64) -> u32 {
        ((time - self.initial_time).rem_euclid(DIAL_PERIOD) / HOUR) as u32
    }

    /// Rest of the time beyond the whole hours, s: what the minute hand is to be turned by.
    pub fn remaining_seconds(&self, time: f64) -> f64 {
        (time - self.initial_time).rem_euclid(HOUR)
    }

    /// Strikes of the bell in the first `hours` hours after the start.
    pub fn strike_count(&self, hours: u32) -> u32 {
        let first = (self.initial_time / HOUR) as u32;
        (1..=hours).map(|k| (first + k - 1) % 12 + 1).sum()
    }

    /// Rotates bodies in their start state to where they stood last before `time`.
    pub fn set(&self, time: f64, bodies: &mut [RigidBody]) {
        let hours = self.hours_before(time);
        let counts = [(hours, &self.by_hour), (self.strike_count(hours), &self.by_strike)];
        for (count, turning) in counts.into_iter().flat_map(|(n, all)| all.iter().map(move |one| (n, one))) {
            let body = &mut bodies[turning.body];
            let pose = body.pose();
            let turned = (pose.rotation * rotation(turning.axis * (turning.angle * f64::from(count)))).normalize();
            body.position = pose.position + turned * body.properties.center;
            body.rotation = turned;
        }
    }
}

/// Seconds after midnight of "14:35" or "14:35:10".
///
/// # Errors
/// With a message for the curator where the text is no time of day.
pub fn time_of_day(text: &str) -> Result<f64, String> {
    let wrong = || format!("\"{text}\" is not a time of day: write hours and minutes, as in \"14:35\"");
    let parts: Vec<u32> =
        text.trim().split(':').map(|part| part.parse().map_err(|_| wrong())).collect::<Result<_, _>>()?;
    match parts[..] {
        [h, m] if h < 24 && m < 60 => Ok(f64::from(3600 * h + 60 * m)),
        [h, m, s] if h < 24 && m < 60 && s < 60 => Ok(f64::from(3600 * h + 60 * m + s)),
        _ => Err(wrong()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clock() -> Clock {
        let shows = time_of_day("10:50").expect("a time");
        let (by_hour, by_strike) = (Vec::new(), Vec::new());
        Clock {
            minute_hand: 0,
            axis: DVec3::Z,
            friction: 0.01,
            initial_time: shows,
            by_hour,
            by_strike,
            striking_body: None,
        }
    }

    #[test]
    fn it_is_brought_to_the_hour_before_and_carried_from_there() {
        let clock = clock();
        for (now, hours, left, blows) in [
            ("10:50", 0, 0.0, 0),
            ("22:50:30", 0, 30.0, 0),
            ("11:10", 0, 1200.0, 0),
            ("11:50", 1, 0.0, 11),
            ("13:49:59", 2, 3599.0, 23),
            ("13:50", 3, 0.0, 24),
            ("10:49", 11, 3540.0, 68),
        ] {
            let time = time_of_day(now).expect(now);
            assert_eq!((clock.hours_before(time), clock.remaining_seconds(time)), (hours, left), "{now}");
            // Eleven hours later it has struck every hour except ten, which comes next.
            assert_eq!(clock.strike_count(hours), blows, "{now}");
        }
    }

    #[test]
    fn an_invalid_time_of_day_is_refused() {
        for wrong in ["", "12", "24:00", "12:60", "a:b", "1:2:3:4", "-1:00"] {
            assert!(time_of_day(wrong).is_err(), "{wrong}");
        }
    }
}
