//! Resolves the gallery's light on an exhibit.

use super::super::codes;
use super::super::diagnostic::Diagnostic;
use super::super::light::LightRig;
use super::context::Context;

impl Context<'_> {
    /// The lamps and the wall.
    pub(super) fn light(&mut self) -> LightRig {
        let given = self.sidecar.light;
        let LightRig { wall, key_to_fill, .. } = LightRig::DEFAULT;
        self.record_origin("light", "side", format!("{:?}", given.side), "/light/side", "default");
        LightRig {
            side: given.side,
            wall: self.within("wall", given.wall, LightRig::WALL, wall),
            key_to_fill: self.within("key_to_fill", given.key_to_fill, LightRig::KEY_TO_FILL, key_to_fill),
        }
    }

    /// A number of the light, or its default where it is left out or out of range.
    fn within(&mut self, key: &str, given: Option<f64>, [low, high]: [f64; 2], default: f64) -> f64 {
        let place = format!("/light/{key}");
        let value = given.unwrap_or(default);
        self.record_origin("light", key, value.to_string(), &place, "default");
        if (low..=high).contains(&value) {
            return value;
        }
        let problem = Diagnostic::new(codes::RANGE, format!("{key} = {value} is out of range"));
        self.report(&place, problem.help(format!("write a number from {low} to {high}; by default {default}")));
        default
    }
}
