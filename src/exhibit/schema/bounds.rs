//! Numbers of a sidecar against the limits of their kinds ([`crate::quantity::BOUNDS`]).
//!
//! The schema says of what kind a number is: a quantity refers to the definition of its type, other numbers have the format
//! `double`, and counts the format `uint`. Seeds are 64-bit integers and have no limit.

use serde_json::Value;

use super::readable;
use super::validate;
use crate::codes;
use crate::diagnostic::Diagnostic;
use crate::quantity::{BOUNDS, Bound, MAX_COUNT, MAX_NUMBER};
use crate::source::{SidecarText, join};

/// Reference to a definition.
const DEFINITIONS: &str = "#/$defs/";
/// Definition of a path, whose points are lists of plain numbers.
const PATH: &str = "Path";

/// All numbers beyond their limits, each with its location. The sidecar is valid by the schema.
pub(super) fn check(source: &SidecarText, schema: &Value) -> Vec<Diagnostic> {
    let mut walk = Walk { source, root: schema, found: Vec::new() };
    walk.value(schema, &source.value, "");
    walk.found
}

struct Walk<'a> {
    source: &'a SidecarText,
    root: &'a Value,
    found: Vec<Diagnostic>,
}

impl Walk<'_> {
    /// Looks at a value by its part of the schema, and at all values within.
    fn value(&mut self, schema: &Value, value: &Value, at: &str) {
        if let Some(name) = schema["$ref"].as_str().and_then(|path| path.strip_prefix(DEFINITIONS)) {
            if let Some(bound) = BOUNDS.iter().find(|bound| bound.name == name) {
                return self.quantity(bound, value, at);
            }
            if name == PATH {
                self.path(&value["points"], &join(at, "points"));
            }
            let part = &self.root["$defs"][name];
            self.value(part, value, at);
        }
        match (schema["format"].as_str(), value) {
            (Some("double" | "float"), Value::Number(number))
                if number.as_f64().is_some_and(|number| number.abs() > MAX_NUMBER) =>
            {
                self.report(at, value, "a number", &format!("{MAX_NUMBER:e}"));
            }
            (Some("uint" | "uint32"), Value::Number(number))
                if number.as_f64().is_some_and(|number| number > MAX_COUNT as f64) =>
            {
                self.report(at, value, "a count", &MAX_COUNT.to_string());
            }
            _ => {}
        }
        for keyword in ["anyOf", "oneOf", "allOf"] {
            // The branches that the value is of.
            for branch in schema[keyword].as_array().into_iter().flatten() {
                if validate::fits(self.root, branch, value) {
                    self.value(branch, value, at);
                }
            }
        }
        match value {
            Value::Object(object) => {
                for (key, inner) in object {
                    let part = schema["properties"].get(key).or_else(|| schema.get("additionalProperties"));
                    self.value(part.unwrap_or(&Value::Null), inner, &join(at, key));
                }
            }
            Value::Array(entries) => {
                let first = schema["prefixItems"].as_array().map_or(&[][..], Vec::as_slice);
                for (index, inner) in entries.iter().enumerate() {
                    let part = first.get(index).unwrap_or(&schema["items"]);
                    self.value(part, inner, &join(at, &index.to_string()));
                }
            }
            _ => {}
        }
    }

    /// The points of a path: a time and a place.
    fn path(&mut self, points: &Value, at: &str) {
        let bound = |name: &str| BOUNDS.iter().find(|bound| bound.name == name);
        for (index, point) in points.as_array().into_iter().flatten().enumerate() {
            let at = join(at, &index.to_string());
            for (column, number) in point.as_array().into_iter().flatten().enumerate() {
                if let Some(bound) = bound(if column == 0 { "Time" } else { "Length" }) {
                    self.quantity(bound, number, &join(&at, &column.to_string()));
                }
            }
        }
    }

    fn quantity(&mut self, bound: &Bound, value: &Value, at: &str) {
        if bound.value(value).is_some_and(|number| number.abs() > bound.most) {
            let article = if bound.kind.starts_with(['a', 'i']) { "an" } else { "a" };
            self.report(at, value, &format!("{article} {}", bound.kind), &bound.shown());
        }
    }

    fn report(&mut self, at: &str, value: &Value, kind: &str, most: &str) {
        let message = format!("{} is {value}, beyond the limit of {kind}", readable(at));
        let help = format!("write a value from -{most} to {most}: no exhibit of a museum needs more");
        let mut problem = Diagnostic::new(codes::RANGE, message).help(help);
        problem.location = Some(self.source.locate(self.source.span(at)));
        self.found.push(problem);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn beyond(text: &str) -> Vec<(usize, String)> {
        let text = format!("schema = \"exhibit/1\"\nmodel = \"m.glb\"\n{text}");
        let source = SidecarText::parse("exhibit.toml", &text).expect("TOML");
        let problems = super::super::check(&source);
        problems
            .iter()
            .map(|p| (p.location.as_ref().map_or(0, |at| at.line), format!("{} {:?}", p.message, p.help)))
            .collect()
    }

    #[test]
    fn a_number_beyond_its_limit_is_located_and_the_limit_is_said() {
        for (text, limit) in [
            ("[[body]]\nnode = \"A\"\nmass = 1e9", "1000000 kg"),
            ("[[body]]\nnode = \"A\"\nmass = \"1e9 t\"", "1000000 kg"),
            ("[[body]]\nnode = \"A\"\ninitial.position = [0, 1e9, 0]", "1000 m"),
            ("[[wind.fan]]\nname = \"f\"\nat = [0, 0, 0]\ndirection = [1e300, 0, 0]\ndiameter = 1\nspeed = 2", "1e9"),
            (
                "[[wind.fan]]\nname = \"f\"\nat = [0, 0, 0]\ndirection = [1, 0, 0]\ndiameter = 1\nspeed = 2e3",
                "1000 m/s",
            ),
            ("[scene]\nduration = 1e9", "10000000 s"),
        ] {
            let found = beyond(text);
            assert_eq!(found.len(), 1, "{text}: {found:?}");
            assert!(found[0].1.contains(&format!("to {limit}")) && found[0].0 > 2, "{found:?}");
        }
        assert!(beyond("[wind.ambient]\nspeed = 0.1\nseed = 9000000000000000000").is_empty(), "a seed has no limit");
    }

    #[test]
    fn every_kind_of_quantity_is_a_definition_of_the_schema() {
        let schema = super::super::schema();
        let missing: Vec<&str> =
            BOUNDS.iter().map(|bound| bound.name).filter(|name| schema["$defs"].get(*name).is_none()).collect();
        assert!(missing.is_empty(), "without a definition the limit is not checked: {missing:?}");
    }
}
