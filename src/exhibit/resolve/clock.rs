//! Resolves the hands of a clock.

use super::super::clock::{Clock, CountedRotation, DIAL_PERIOD, time_of_day};
use super::super::codes;
use super::super::diagnostic::Diagnostic;
use super::super::sidecar;
use super::context::Context;
use soffio_multibody::articulation::{Axis, Constraint};

impl Context<'_> {
    /// The clock, from these constraints; `None` where there is none or a problem was reported.
    pub(super) fn clock(&mut self, constraints: &[Constraint]) -> Option<Clock> {
        let sidecar = self.sidecar;
        let given = sidecar.clock.as_ref()?;
        let (hand, axis) = self.clock_wheel(&given.hand, given.axis, "/clock", "/clock/hand")?;
        let shows = match time_of_day(&given.shows) {
            Ok(time) => time % DIAL_PERIOD,
            Err(message) => {
                self.report(
                    "/clock/shows",
                    Diagnostic::new(codes::WRONG_SHAPE, message)
                        .help("write the time that the model shows, such as \"10:50\""),
                );
                return None;
            }
        };
        let held = |c: &Constraint| c.slips.filter(|_| c.kind.acts_on(hand));
        let Some(friction) = constraints.iter().find_map(held) else {
            let message = format!("the hand \"{}\" has no clutch, so it cannot be set", given.hand);
            let help = "join it to its arbor by a [[constraint.clutch]] with a torque";
            self.report("/clock/hand", Diagnostic::new(codes::NOT_FOUND, message).help(help));
            return None;
        };
        let strikes = match &given.strikes {
            Some(name) => Some(self.clock_wheel(name, given.axis, "/clock", "/clock/strikes")?.0),
            None => None,
        };
        self.record_origin("clock", "shows", given.shows.clone(), "/clock/shows", "");
        let by_hour = self.turnings(&given.by_hour, "/clock/by_hour")?;
        let by_strike = self.turnings(&given.by_strike, "/clock/by_strike")?;
        Some(Clock {
            minute_hand: hand,
            axis: axis.direction,
            friction,
            initial_time: shows,
            by_hour,
            by_strike,
            striking_body: strikes,
        })
    }

    fn turnings(&mut self, given: &[sidecar::Turning], at: &str) -> Option<Vec<CountedRotation>> {
        let one = |(index, turning): (usize, &sidecar::Turning)| {
            let at = format!("{at}/{index}");
            let (body, axis) = self.clock_wheel(&turning.body, turning.axis, &at, &format!("{at}/body"))?;
            Some(CountedRotation { body, axis: axis.direction, angle: turning.angle.0 })
        };
        given.iter().enumerate().map(one).collect()
    }

    /// A moving body and an axis of it.
    fn clock_wheel(&mut self, name: &str, axis: [f64; 3], at: &str, at_body: &str) -> Option<(usize, Axis)> {
        let axis = self.body_axis(name, axis, at_body, &format!("{at}/axis"), "clock")?;
        let Some(body) = axis.body else {
            let message = format!("\"{name}\" is not a moving body");
            self.report(at_body, Diagnostic::new(codes::NOT_FOUND, message).help("add a [[body]] with this node"));
            return None;
        };
        Some((body, axis))
    }
}
