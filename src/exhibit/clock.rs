//! Exhibits that tell the time: which body the hand is, and how the figure stands at another hour.
//!
//! A clock's model shows one time. Whoever hangs it up sets it: overnight it is brought to the last time before now at
//! which its minute hand stands as in the model, by turning what depends on the hour alone (hour wheel, count wheel);
//! then the minute hand is carried to now, by the hand, through the clock's own works (`simulation/carrying.rs`).
//!
//! ```text
//! n = ⌊(now − shows)/1 h⌋ mod 12        hours that it is brought forward
//! turn of a wheel = n · (turn an hour)  or  Σ of the hours struck on the way · (turn a blow)
//! ```

use soffio_geometry::bodies::RigidBody;
use soffio_math::{DVec3, rotation};

/// s.
pub const HOUR: f64 = 3600.0;
/// After which a dial shows the same, s.
pub const ROUND: f64 = 12.0 * HOUR;

/// A clock's hands.
#[derive(Clone, Debug, PartialEq)]
pub struct Clock {
    /// The body of the minute hand, which is held by a clutch.
    pub hand: usize,
    /// Axis about which it turns with the sun, node frame.
    pub axis: DVec3,
    /// Friction of its clutch, N m.
    pub friction: f64,
    /// What the hands show at the start, s after twelve.
    pub shows: f64,
    /// What turns by the hour.
    pub by_hour: Vec<Turning>,
    /// What turns by the blow.
    pub by_blow: Vec<Turning>,
    /// What runs while it strikes: whoever carries the hands waits for it.
    pub strikes: Option<usize>,
}

/// A body that stands otherwise at another hour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning {
    /// Which.
    pub body: usize,
    /// About this axis through its origin, node frame.
    pub axis: DVec3,
    /// rad, for each.
    pub angle: f64,
}

impl Clock {
    /// Whole hours from what the model shows to `time` (s after any midnight or noon): 0 to 11.
    pub fn hours_before(&self, time: f64) -> u32 {
        ((time - self.shows).rem_euclid(ROUND) / HOUR) as u32
    }

    /// What is left to be carried then, s: less than an hour.
    pub fn left(&self, time: f64) -> f64 {
        (time - self.shows).rem_euclid(HOUR)
    }

    /// Blows of the hours that are passed when it is brought forward by so many.
    pub fn blows(&self, hours: u32) -> u32 {
        let first = (self.shows / HOUR) as u32;
        (1..=hours).map(|k| (first + k - 1) % 12 + 1).sum()
    }

    /// Brings bodies in their start state forward to where they stood last before `time`.
    pub fn set(&self, time: f64, bodies: &mut [RigidBody]) {
        let hours = self.hours_before(time);
        let counts = [(hours, &self.by_hour), (self.blows(hours), &self.by_blow)];
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
pub fn time_of_day(text: &str) -> Result<f64, String> {
    let wrong = || format!("\"{text}\" is no time of day: write hours and minutes, as in \"14:35\"");
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
        let (by_hour, by_blow) = (Vec::new(), Vec::new());
        Clock { hand: 0, axis: DVec3::Z, friction: 0.01, shows, by_hour, by_blow, strikes: None }
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
            assert_eq!((clock.hours_before(time), clock.left(time)), (hours, left), "{now}");
            // Eleven hours on it has struck all but the ten that comes next.
            assert_eq!(clock.blows(hours), blows, "{now}");
        }
    }

    #[test]
    fn what_is_no_time_of_day_is_refused() {
        for wrong in ["", "12", "24:00", "12:60", "a:b", "1:2:3:4", "-1:00"] {
            assert!(time_of_day(wrong).is_err(), "{wrong}");
        }
    }
}
