//! JSON Schema validation (draft 2020-12): all violations of a value.
//!
//! It supports only the keywords that the format's schema uses: `$ref` into the schema's own `$defs`, `type`, `const`,
//! `enum`, `anyOf`, `oneOf`, `properties`, `patternProperties`, `additionalProperties`, `required`, `items`,
//! `prefixItems`, `minItems`, `maxItems`, `minimum`, `maximum` and `pattern`. A test compares it with a complete
//! implementation, and fails when the schema contains a keyword that is not in [`KEYWORDS`].

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt;

use regex_lite::Regex;
use serde_json::{Map, Value};

use crate::source::join;

/// Supported keywords: those that constrain a value, and those that only document it.
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

/// A violation of the schema.
#[derive(Debug)]
pub struct Problem<'a> {
    /// JSON pointer of the value.
    pub at: String,
    /// The value.
    pub value: &'a Value,
    /// The part of the schema that it violates.
    pub schema: &'a Value,
    /// Kind of the violation.
    pub kind: Kind<'a>,
}

/// Kinds of violations.
#[derive(Debug)]
pub enum Kind<'a> {
    /// Keys that the object may not have.
    Unknown(Vec<&'a str>),
    /// A required key that is missing.
    Missing(&'a str),
    /// The value matches none of the choices; the problems of each.
    Choice(Vec<Vec<Problem<'a>>>),
    /// The value has none of these types.
    Type(Vec<&'a str>),
    /// The value is not this constant.
    Constant(&'a Value),
    /// The value is not one of these.
    OneOf(&'a [Value]),
    /// The text does not match the pattern.
    Pattern(&'a str),
    /// The number is below the minimum.
    Minimum(&'a Value),
    /// The number is above the maximum.
    Maximum(&'a Value),
    /// The list is shorter than the minimum.
    TooShort(u64),
    /// The list is longer than the maximum.
    TooLong(u64),
    /// The value matches so many choices where only one is allowed.
    Ambiguous(usize),
    /// No value is allowed here.
    Forbidden,
}

impl Problem<'_> {
    /// Depth of the value in the file.
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
            Kind::Choice(_) => write!(f, "{value} is not allowed here"),
            Kind::Type(types) => write!(f, "{value} is not of type {}", types.join(" or ")),
            Kind::Constant(only) => write!(f, "{value} is not {only}"),
            Kind::OneOf(values) => write!(f, "{value} is none of {}", Value::from(values.to_vec())),
            Kind::Pattern(pattern) => write!(f, "{value} does not match {pattern}"),
            Kind::Minimum(limit) => write!(f, "{value} is less than {limit}"),
            Kind::Maximum(limit) => write!(f, "{value} is more than {limit}"),
            Kind::TooShort(limit) => write!(f, "the list has fewer than {limit} entries"),
            Kind::TooLong(limit) => write!(f, "the list has more than {limit} entries"),
            Kind::Ambiguous(count) => write!(f, "{value} can be read in {count} ways"),
            Kind::Forbidden => write!(f, "no value is allowed here"),
        }
    }
}

/// All violations of `value`; `root` contains the `$defs` of the schema.
pub fn problems<'a>(root: &'a Value, value: &'a Value) -> Vec<Problem<'a>> {
    let mut found = Vec::new();
    Instance { root, value, at: String::new() }.validate(root, &mut found);
    found
}

/// Does the value meet this part of a schema?
pub fn fits(root: &Value, schema: &Value, value: &Value) -> bool {
    Instance { root, value, at: String::new() }.problems_with(schema).is_empty()
}

/// A value with its JSON pointer.
struct Instance<'a> {
    root: &'a Value,
    value: &'a Value,
    at: String,
}

impl<'a> Instance<'a> {
    fn within(&self, key: &str, value: &'a Value) -> Self {
        Self { root: self.root, value, at: join(&self.at, key) }
    }

    fn validate(&self, schema: &'a Value, found: &mut Vec<Problem<'a>>) {
        // `true` allows everything, `false` nothing.
        if schema == &Value::Bool(false) {
            found.push(Problem { at: self.at.clone(), value: self.value, schema, kind: Kind::Forbidden });
        }
        for (keyword, requirement) in schema.as_object().into_iter().flatten() {
            let mut wrong = |kind| found.push(Problem { at: self.at.clone(), value: self.value, schema, kind });
            match keyword.as_str() {
                "$ref" => {
                    let part = requirement.as_str().and_then(|path| self.root.pointer(path.strip_prefix('#')?));
                    if let Some(part) = part {
                        self.validate(part, found);
                    }
                }
                "type" => {
                    let types = one_or_all(requirement);
                    if !types.iter().any(|name| is_of(self.value, name)) {
                        wrong(Kind::Type(types));
                    }
                }
                "const" if requirement != self.value => wrong(Kind::Constant(requirement)),
                "enum" => match requirement.as_array() {
                    Some(values) if !values.contains(self.value) => wrong(Kind::OneOf(values)),
                    _ => {}
                },
                "anyOf" | "oneOf" => {
                    let branches: Vec<Vec<Problem>> =
                        list(requirement).iter().map(|branch| self.problems_with(branch)).collect();
                    match branches.iter().filter(|branch| branch.is_empty()).count() {
                        0 => wrong(Kind::Choice(branches)),
                        1 => {}
                        count if keyword == "oneOf" => wrong(Kind::Ambiguous(count)),
                        _ => {}
                    }
                }
                _ => match self.value {
                    Value::Object(object) => self.validate_object(object, schema, keyword, found),
                    Value::Array(entries) => self.validate_list(entries, schema, keyword, found),
                    Value::Number(_) => {
                        let (limit, number) = (requirement.as_f64(), self.value.as_f64());
                        match keyword.as_str() {
                            "minimum" if number < limit => wrong(Kind::Minimum(requirement)),
                            "maximum" if number > limit => wrong(Kind::Maximum(requirement)),
                            _ => {}
                        }
                    }
                    Value::String(text) if keyword == "pattern" => {
                        let pattern = requirement.as_str().unwrap_or_default();
                        if !matches(pattern, text) {
                            wrong(Kind::Pattern(pattern));
                        }
                    }
                    _ => {}
                },
            }
        }
    }

    fn problems_with(&self, schema: &'a Value) -> Vec<Problem<'a>> {
        let mut found = Vec::new();
        self.validate(schema, &mut found);
        found
    }

    fn validate_object(
        &self,
        object: &'a Map<String, Value>,
        schema: &'a Value,
        keyword: &str,
        found: &mut Vec<Problem<'a>>,
    ) {
        let requirement = &schema[keyword];
        match keyword {
            "required" => {
                let missing =
                    list(requirement).iter().filter_map(Value::as_str).filter(|key| !object.contains_key(*key));
                found.extend(missing.map(|key| Problem {
                    at: self.at.clone(),
                    value: self.value,
                    schema,
                    kind: Kind::Missing(key),
                }));
            }
            "properties" => {
                for (key, part) in requirement.as_object().into_iter().flatten() {
                    if let Some(value) = object.get(key) {
                        self.within(key, value).validate(part, found);
                    }
                }
            }
            "patternProperties" => {
                for (pattern, part) in requirement.as_object().into_iter().flatten() {
                    for (key, value) in object.iter().filter(|(key, _)| matches(pattern, key)) {
                        self.within(key, value).validate(part, found);
                    }
                }
            }
            "additionalProperties" => {
                let named = |key: &str| schema.get("properties").is_some_and(|all| all.get(key).is_some());
                let patterns = schema.get("patternProperties").and_then(Value::as_object);
                let matched = |key: &str| patterns.into_iter().flatten().any(|(pattern, _)| matches(pattern, key));
                let others = object.iter().filter(|(key, _)| !named(key) && !matched(key));
                if requirement == &Value::Bool(false) {
                    let unknown: Vec<&str> = others.map(|(key, _)| key.as_str()).collect();
                    if !unknown.is_empty() {
                        let kind = Kind::Unknown(unknown);
                        found.push(Problem { at: self.at.clone(), value: self.value, schema, kind });
                    }
                } else {
                    others.for_each(|(key, value)| self.within(key, value).validate(requirement, found));
                }
            }
            _ => {}
        }
    }

    fn validate_list(&self, entries: &'a [Value], schema: &'a Value, keyword: &str, found: &mut Vec<Problem<'a>>) {
        let requirement = &schema[keyword];
        let (count, limit) = (entries.len() as u64, requirement.as_u64());
        let mut wrong = |kind| found.push(Problem { at: self.at.clone(), value: self.value, schema, kind });
        match (keyword, limit) {
            ("minItems", Some(limit)) if count < limit => wrong(Kind::TooShort(limit)),
            ("maxItems", Some(limit)) if count > limit => wrong(Kind::TooLong(limit)),
            ("prefixItems", _) => {
                for ((index, entry), part) in entries.iter().enumerate().zip(list(requirement)) {
                    self.within(&index.to_string(), entry).validate(part, found);
                }
            }
            ("items", _) => {
                let before = schema.get("prefixItems").map_or(0, |parts| list(parts).len());
                for (index, entry) in entries.iter().enumerate().skip(before) {
                    self.within(&index.to_string(), entry).validate(requirement, found);
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
        // JSON does not distinguish 2 and 2.0.
        "integer" => value.as_f64().is_some_and(|number| number.fract() == 0.0),
        _ => false,
    }
}

/// Patterns come from the schema itself; one that cannot be read matches nothing, and a test fails. Each is compiled once a thread:
/// a sidecar may have thousands of texts.
fn matches(pattern: &str, text: &str) -> bool {
    thread_local!(static COMPILED: RefCell<BTreeMap<String, Option<Regex>>> = const { RefCell::new(BTreeMap::new()) });
    COMPILED.with_borrow_mut(|compiled| {
        if !compiled.contains_key(pattern) {
            compiled.insert(pattern.to_owned(), Regex::new(pattern).ok());
        }
        compiled.get(pattern).and_then(Option::as_ref).is_some_and(|pattern| pattern.is_match(text))
    })
}
