//! The shape check against a whole implementation of JSON Schema: the same values are good, the others are bad at the same
//! places.

use std::collections::BTreeSet;

use serde_json::{Map, Value, json};
use soffio_exhibit::shape::schema;
use soffio_exhibit::shape::validate::{KEYWORDS, Kind, Problem, problems};

/// Sidecars with many keys: one that has them all, and two that are shipped.
const SIDECARS: [&str; 3] = [
    "tests/cases/exhibit-full/exhibit.toml",
    "exhibits/marionette/exhibit.toml",
    "exhibits/breaking-chain/exhibit.toml",
];

fn sidecar(path: &str) -> Value {
    let table: toml::Table = std::fs::read_to_string(path).expect(path).parse().expect(path);
    serde_json::to_value(table).expect("plain data")
}

/// Pointers to all values within.
fn places(value: &Value, at: String, out: &mut Vec<String>) {
    match value {
        Value::Object(object) => object.iter().for_each(|(key, inner)| places(inner, format!("{at}/{key}"), out)),
        Value::Array(list) => list.iter().enumerate().for_each(|(i, inner)| places(inner, format!("{at}/{i}"), out)),
        _ => {}
    }
    out.push(at);
}

/// What may have gone wrong with a value while somebody wrote it.
fn wrong_ones(value: &Value) -> Vec<Value> {
    let mut all = vec![
        Value::Null,
        json!(true),
        json!(-1),
        json!(2.0),
        json!(1e9),
        json!("12 mm"),
        json!("1.5e-3 kg"),
        json!(" .5 m/s "),
        json!("#80ff00"),
        json!(""),
        json!([]),
        json!([1.0, 2.0]),
        json!([0, 1, 2, 3, 4]),
        json!({}),
        json!({ "x_own": 1 }),
    ];
    match value {
        Value::Object(object) => {
            for key in object.keys() {
                let mut less: Map<String, Value> = object.clone();
                less.remove(key);
                all.push(Value::Object(less));
            }
            for key in ["nmae", "x_own"] {
                let mut more = object.clone();
                more.insert(key.into(), json!(1));
                all.push(Value::Object(more));
            }
        }
        Value::Array(list) => {
            all.push(Value::Array(list.iter().skip(1).cloned().collect()));
            all.push(Value::Array(list.iter().chain(list).cloned().collect()));
        }
        Value::String(word) => all.extend([json!(format!("{word}x")), json!([word])]),
        _ => {}
    }
    all
}

fn ours<'a>(found: &'a [Problem]) -> BTreeSet<(&'a str, &'static str)> {
    let word = |kind: &Kind| match kind {
        Kind::Unknown(_) => "unknown",
        Kind::Missing(_) => "missing",
        Kind::Choice(_) | Kind::Many(_) => "choice",
        Kind::Type(_) => "type",
        Kind::Constant(_) | Kind::Words(_) => "word",
        Kind::Pattern(_) => "pattern",
        Kind::Minimum(_) | Kind::Maximum(_) => "range",
        Kind::Short(_) | Kind::Long(_) => "length",
        Kind::Forbidden => "forbidden",
    };
    found.iter().map(|problem| (problem.at.as_str(), word(&problem.kind))).collect()
}

#[test]
fn all_keywords_of_the_format_are_known() {
    fn look(schema: &Value, seen: &mut BTreeSet<String>) {
        for (keyword, asked) in schema.as_object().into_iter().flatten() {
            seen.insert(keyword.clone());
            match keyword.as_str() {
                "properties" | "patternProperties" | "$defs" => {
                    asked.as_object().into_iter().flatten().for_each(|(_, part)| look(part, seen));
                }
                "anyOf" | "oneOf" | "prefixItems" => {
                    asked.as_array().into_iter().flatten().for_each(|part| look(part, seen))
                }
                "items" | "additionalProperties" => look(asked, seen),
                _ => {}
            }
        }
    }
    let mut seen = BTreeSet::new();
    look(&schema(), &mut seen);
    let unknown: Vec<&String> = seen.iter().filter(|keyword| !KEYWORDS.contains(&keyword.as_str())).collect();
    assert!(unknown.is_empty() && seen.contains("pattern"), "{unknown:?}");
}

/// Of the 5,700 mistakes one in so many, another of each value's.
const SOME: usize = 7;

#[test]
fn what_is_wrong_is_what_a_whole_implementation_finds() {
    both_find_the_same(SOME);
}

/// `cargo test --no-default-features --release --test suite every_mistake_is -- --ignored`
#[test]
#[ignore = "a minute of the machine; part `shape` of tests/check.sh --long"]
fn every_mistake_is_what_a_whole_implementation_finds() {
    both_find_the_same(1);
}

/// Makes one in `every` of the mistakes.
fn both_find_the_same(every: usize) {
    use jsonschema::error::ValidationErrorKind as Theirs;
    let schema = schema();
    let whole = jsonschema::validator_for(&schema).expect("a valid schema");
    let (mut good, mut bad, mut number) = (0, 0, 0);
    for path in SIDECARS {
        let written = sidecar(path);
        assert!(problems(&schema, &written).is_empty(), "{path}");
        let mut all = Vec::new();
        places(&written, String::new(), &mut all);
        for at in all {
            for wrong in wrong_ones(written.pointer(&at).expect("it is there")) {
                number += 1;
                if number % every != 0 {
                    continue;
                }
                let mut value = written.clone();
                *value.pointer_mut(&at).expect("it is there") = wrong.clone();
                let found = problems(&schema, &value);
                let theirs: Vec<(String, &str)> = whole
                    .iter_errors(&value)
                    .map(|error| {
                        let word = match error.kind() {
                            Theirs::AdditionalProperties { .. } => "unknown",
                            Theirs::Required { .. } => "missing",
                            Theirs::AnyOf { .. } | Theirs::OneOfNotValid { .. } | Theirs::OneOfMultipleValid { .. } => {
                                "choice"
                            }
                            Theirs::Type { .. } => "type",
                            Theirs::Constant { .. } | Theirs::Enum { .. } => "word",
                            Theirs::Pattern { .. } => "pattern",
                            Theirs::Minimum { .. } | Theirs::Maximum { .. } => "range",
                            Theirs::MinItems { .. } | Theirs::MaxItems { .. } => "length",
                            _ => "other",
                        };
                        (error.instance_path().to_string(), word)
                    })
                    .collect();
                let theirs: BTreeSet<(&str, &str)> = theirs.iter().map(|(at, word)| (at.as_str(), *word)).collect();
                assert_eq!(ours(&found), theirs, "{path}: {wrong} at {at}");
                if found.is_empty() { good += 1 } else { bad += 1 }
            }
        }
    }
    // Many of both, or it shows little.
    assert!(good > 500 / every && bad > 5000 / every, "{good} good, {bad} bad");
}
