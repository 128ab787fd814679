//! Holds a value against a JSON Schema (draft 2020-12), and finds all that is wrong with it.
//!
//! It knows the keywords that the format's schema has, and no others: `$ref` into the schema's own `$defs`, `type`, `const`,
//! `enum`, `anyOf`, `oneOf`, `properties`, `patternProperties`, `additionalProperties`, `required`, `items`, `prefixItems`,
//! `minItems`, `maxItems`, `minimum`, `maximum` and `pattern`. A test holds it against a whole implementation, and fails when
//! the schema gets a keyword that is not in [`KEYWORDS`].

use std::fmt;

use regex_lite::Regex;
use serde_json::{Map, Value};

use crate::source::join;

/// What this knows of: keywords that ask something of a value, and those that only tell people something.
pub const KEYWORDS: [&str; 23] = [
    "$defs",
    "$ref",
    "$schema",
    "additionalProperties",
    "anyOf",
    "const",
    "default",
    "description",
    "enum",
    "format",
    "items",
    "maxItems",
    "maximum",
    "minItems",
    "minimum",
    "oneOf",
    "pattern",
    "patternProperties",
    "prefixItems",
    "properties",
    "required",
    "title",
    "type",
];

/// Something wrong with a value.
#[derive(Debug)]
pub struct Problem<'a> {
    /// Where the value stands: a JSON pointer.
    pub at: String,
    /// The value.
    pub value: &'a Value,
    /// The part of the schema that it does not satisfy.
    pub schema: &'a Value,
    /// What is wrong.
    pub kind: Kind<'a>,
}

/// What can be wrong with a value.
#[derive(Debug)]
pub enum Kind<'a> {
    /// Keys that the object may not have.
    Unknown(Vec<&'a str>),
    /// A key that it must have.
    Missing(&'a str),
    /// It is none of the choices; of each, what is wrong.
    Choice(Vec<Vec<Problem<'a>>>),
    /// It is of none of these types.
    Type(Vec<&'a str>),
    /// It is not the only value there is.
    Constant(&'a Value),
    /// It is not one of these values.
    Words(&'a [Value]),
    /// The text does not match.
    Pattern(&'a str),
    /// The number is less.
    Minimum(&'a Value),
    /// The number is more.
    Maximum(&'a Value),
    /// The list is shorter.
    Short(u64),
    /// The list is longer.
    Long(u64),
    /// It satisfies so many choices where one is wanted.
    Many(usize),
    /// Nothing may stand here.
    Forbidden,
}

impl Problem<'_> {
    /// How deep in the file the value stands.
    pub fn depth(&self) -> usize {
        self.at.matches('/').count()
    }
}

impl fmt::Display for Problem<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.value;
        match &self.kind {
            Kind::Unknown(keys) => write!(f, "unknown here: {}", keys.join(", ")),
            Kind::Missing(key) => write!(f, "\"{key}\" is missing"),
            Kind::Choice(_) => write!(f, "{value} is none of what may stand here"),
            Kind::Type(types) => write!(f, "{value} is not of type {}", types.join(" or ")),
            Kind::Constant(only) => write!(f, "{value} is not {only}"),
            Kind::Words(words) => write!(f, "{value} is none of {}", Value::from(words.to_vec())),
            Kind::Pattern(pattern) => write!(f, "{value} does not match {pattern}"),
            Kind::Minimum(limit) => write!(f, "{value} is less than {limit}"),
            Kind::Maximum(limit) => write!(f, "{value} is more than {limit}"),
            Kind::Short(limit) => write!(f, "the list has fewer than {limit} entries"),
            Kind::Long(limit) => write!(f, "the list has more than {limit} entries"),
            Kind::Many(count) => write!(f, "{value} can be read in {count} ways"),
            Kind::Forbidden => write!(f, "nothing may stand here"),
        }
    }
}

/// All that is wrong with `value`; the schema's own parts are found in `root`.
pub fn problems<'a>(root: &'a Value, value: &'a Value) -> Vec<Problem<'a>> {
    let mut found = Vec::new();
    Place { root, value, at: String::new() }.hold(root, &mut found);
    found
}

/// A value, and where it stands.
struct Place<'a> {
    root: &'a Value,
    value: &'a Value,
    at: String,
}

impl<'a> Place<'a> {
    fn within(&self, key: &str, value: &'a Value) -> Self {
        Self { root: self.root, value, at: join(&self.at, key) }
    }

    fn hold(&self, schema: &'a Value, found: &mut Vec<Problem<'a>>) {
        // `true` allows everything, `false` nothing.
        if schema == &Value::Bool(false) {
            found.push(Problem { at: self.at.clone(), value: self.value, schema, kind: Kind::Forbidden });
        }
        for (keyword, asked) in schema.as_object().into_iter().flatten() {
            let mut wrong = |kind| found.push(Problem { at: self.at.clone(), value: self.value, schema, kind });
            match keyword.as_str() {
                "$ref" => {
                    let part = asked.as_str().and_then(|path| self.root.pointer(path.strip_prefix('#')?));
                    if let Some(part) = part {
                        self.hold(part, found);
                    }
                }
                "type" => {
                    let types = one_or_all(asked);
                    if !types.iter().any(|name| is_of(self.value, name)) {
                        wrong(Kind::Type(types));
                    }
                }
                "const" if asked != self.value => wrong(Kind::Constant(asked)),
                "enum" => match asked.as_array() {
                    Some(words) if !words.contains(self.value) => wrong(Kind::Words(words)),
                    _ => {}
                },
                "anyOf" | "oneOf" => {
                    let branches: Vec<Vec<Problem>> = list(asked).iter().map(|branch| self.against(branch)).collect();
                    match branches.iter().filter(|branch| branch.is_empty()).count() {
                        0 => wrong(Kind::Choice(branches)),
                        1 => {}
                        count if keyword == "oneOf" => wrong(Kind::Many(count)),
                        _ => {}
                    }
                }
                _ => match self.value {
                    Value::Object(object) => self.hold_object(object, schema, keyword, found),
                    Value::Array(entries) => self.hold_list(entries, schema, keyword, found),
                    Value::Number(_) => {
                        let (limit, number) = (asked.as_f64(), self.value.as_f64());
                        match keyword.as_str() {
                            "minimum" if number < limit => wrong(Kind::Minimum(asked)),
                            "maximum" if number > limit => wrong(Kind::Maximum(asked)),
                            _ => {}
                        }
                    }
                    Value::String(text) if keyword == "pattern" => {
                        let pattern = asked.as_str().unwrap_or_default();
                        if !matches(pattern, text) {
                            wrong(Kind::Pattern(pattern));
                        }
                    }
                    _ => {}
                },
            }
        }
    }

    fn against(&self, schema: &'a Value) -> Vec<Problem<'a>> {
        let mut found = Vec::new();
        self.hold(schema, &mut found);
        found
    }

    fn hold_object(
        &self,
        object: &'a Map<String, Value>,
        schema: &'a Value,
        keyword: &str,
        found: &mut Vec<Problem<'a>>,
    ) {
        let asked = &schema[keyword];
        match keyword {
            "required" => {
                let missing = list(asked).iter().filter_map(Value::as_str).filter(|key| !object.contains_key(*key));
                found.extend(missing.map(|key| Problem {
                    at: self.at.clone(),
                    value: self.value,
                    schema,
                    kind: Kind::Missing(key),
                }));
            }
            "properties" => {
                for (key, part) in asked.as_object().into_iter().flatten() {
                    if let Some(value) = object.get(key) {
                        self.within(key, value).hold(part, found);
                    }
                }
            }
            "patternProperties" => {
                for (pattern, part) in asked.as_object().into_iter().flatten() {
                    for (key, value) in object.iter().filter(|(key, _)| matches(pattern, key)) {
                        self.within(key, value).hold(part, found);
                    }
                }
            }
            "additionalProperties" => {
                let named = |key: &str| schema.get("properties").is_some_and(|all| all.get(key).is_some());
                let patterns = schema.get("patternProperties").and_then(Value::as_object);
                let matched = |key: &str| patterns.into_iter().flatten().any(|(pattern, _)| matches(pattern, key));
                let others = object.iter().filter(|(key, _)| !named(key) && !matched(key));
                if asked == &Value::Bool(false) {
                    let unknown: Vec<&str> = others.map(|(key, _)| key.as_str()).collect();
                    if !unknown.is_empty() {
                        let kind = Kind::Unknown(unknown);
                        found.push(Problem { at: self.at.clone(), value: self.value, schema, kind });
                    }
                } else {
                    others.for_each(|(key, value)| self.within(key, value).hold(asked, found));
                }
            }
            _ => {}
        }
    }

    fn hold_list(&self, entries: &'a [Value], schema: &'a Value, keyword: &str, found: &mut Vec<Problem<'a>>) {
        let asked = &schema[keyword];
        let (count, limit) = (entries.len() as u64, asked.as_u64());
        let mut wrong = |kind| found.push(Problem { at: self.at.clone(), value: self.value, schema, kind });
        match (keyword, limit) {
            ("minItems", Some(limit)) if count < limit => wrong(Kind::Short(limit)),
            ("maxItems", Some(limit)) if count > limit => wrong(Kind::Long(limit)),
            ("prefixItems", _) => {
                for ((index, entry), part) in entries.iter().enumerate().zip(list(asked)) {
                    self.within(&index.to_string(), entry).hold(part, found);
                }
            }
            ("items", _) => {
                let before = schema.get("prefixItems").map_or(0, |parts| list(parts).len());
                for (index, entry) in entries.iter().enumerate().skip(before) {
                    self.within(&index.to_string(), entry).hold(asked, found);
                }
            }
            _ => {}
        }
    }
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn one_or_all(value: &Value) -> Vec<&str> {
    value.as_str().map_or_else(|| list(value).iter().filter_map(Value::as_str).collect(), |one| vec![one])
}

fn is_of(value: &Value, name: &str) -> bool {
    match name {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        "number" => value.is_number(),
        // 2.0 is one: JSON does not tell 2 and 2.0 apart.
        "integer" => value.as_f64().is_some_and(|number| number.fract() == 0.0),
        _ => false,
    }
}

/// Patterns are the schema's own, so they can be read; one that cannot matches nothing, and the test of them fails.
fn matches(pattern: &str, text: &str) -> bool {
    Regex::new(pattern).is_ok_and(|pattern| pattern.is_match(text))
}
