//! Our JSON Schemas and our own reader of them, against a whole implementation of JSON Schema.
//!
//!     cargo test --manifest-path tests/schemas/Cargo.toml --release

use std::collections::BTreeSet;

use serde_json::{Map, Value, json};
use soffio_exhibit::schema::schema;
use soffio_exhibit::schema::validate::{Kind, Problem, problems};
use soffio_sound::timbre::{self, Preset};

/// Sidecars with many keys: one that has them all, and two that are shipped.
const SIDECARS: [&str; 3] = [
    "tests/cases/exhibit-full/exhibit.toml",
    "exhibits/marionette/exhibit.toml",
    "exhibits/breaking-chain/exhibit.toml",
];

fn sidecar(path: &str) -> Value {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path);
    let table: toml::Table = std::fs::read_to_string(file).expect(path).parse().expect(path);
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
        Kind::Choice(_) | Kind::Ambiguous(_) => "choice",
        Kind::Type(_) => "type",
        Kind::Constant(_) | Kind::OneOf(_) => "word",
        Kind::Pattern(_) => "pattern",
        Kind::Minimum(_) | Kind::Maximum(_) => "range",
        Kind::TooShort(_) | Kind::TooLong(_) => "length",
        Kind::Forbidden => "forbidden",
    };
    found.iter().map(|problem| (problem.at.as_str(), word(&problem.kind))).collect()
}

#[test]
fn every_mistake_in_a_sidecar_is_found_by_both_at_the_same_place() {
    use jsonschema::error::ValidationErrorKind as Theirs;
    let schema = schema();
    let whole = jsonschema::validator_for(&schema).expect("a valid schema");
    let (mut good, mut bad) = (0, 0);
    for path in SIDECARS {
        let written = sidecar(path);
        assert!(problems(&schema, &written).is_empty(), "{path}");
        let mut all = Vec::new();
        places(&written, String::new(), &mut all);
        for at in all {
            for wrong in wrong_ones(written.pointer(&at).expect("it is there")) {
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
    assert!(good > 500 && bad > 5000, "{good} good, {bad} bad");
}

#[test]
fn schemas_are_json_schemas() {
    let timbre = schemars::schema_for!(Preset).to_value();
    for (kind, schema) in [("exhibit", schema()), ("kiosk", soffio_config::schema()), ("timbre", timbre)] {
        assert!(jsonschema::meta::is_valid(&schema), "{kind}");
    }
}

#[test]
fn the_timbres_schema_accepts_what_is_shipped_and_refuses_what_is_not() {
    let schema = schemars::schema_for!(Preset).to_value();
    let validator = jsonschema::validator_for(&schema).expect("a valid schema");
    for name in timbre::names() {
        let table: toml::Table = timbre::source(name).expect("shipped").parse().expect("toml");
        let value = serde_json::to_value(&table).expect("plain data");
        let problems: Vec<String> = validator.iter_errors(&value).map(|error| error.to_string()).collect();
        assert!(problems.is_empty(), "{name}: {problems:?}");
    }
    let bad: toml::Table =
        timbre::source("plate").expect("shipped").replace("\"modal\"", "\"modl\"").parse().expect("toml");
    assert!(!validator.is_valid(&serde_json::to_value(&bad).expect("plain data")));
}
