//! The shape check: is the sidecar what the format's JSON Schema says? All violations at once, each where it stands.

use schemars::transform::RecursiveTransform;
use schemars::{Schema, generate::SchemaSettings};
use serde_json::{Value, json};

use jsonschema::ValidationError;
use jsonschema::error::{TypeKind, ValidationErrorKind};

use super::codes;
use super::diagnostic::{Diagnostic, near, quoted};
use super::sidecar::Sidecar;
use super::source::{Source, join};

/// JSON Schema (draft 2020-12) of `exhibit.toml`.
pub fn schema() -> Value {
    let open = RecursiveTransform(|schema: &mut Schema| {
        // Keys of other programs: closed objects stay open for x_*.
        if schema.get("additionalProperties") == Some(&json!(false)) {
            schema.insert("patternProperties".into(), json!({ "^x_": true }));
        }
    });
    let mut root =
        SchemaSettings::draft2020_12().with_transform(open).into_generator().into_root_schema_for::<Sidecar>();
    root.insert("title".into(), "Soffio exhibit sidecar, format exhibit/1".into());
    root.to_value()
}

/// All places where the sidecar does not have the shape of the format.
pub fn check(source: &Source) -> Vec<Diagnostic> {
    let schema = schema();
    let validator = match jsonschema::validator_for(&schema) {
        Ok(validator) => validator,
        Err(error) => {
            return vec![Diagnostic::new(codes::WRONG_SHAPE, format!("the format's own schema is broken: {error}"))];
        }
    };
    let mut found = Vec::new();
    for error in validator.iter_errors(&source.value) {
        explain(source, &schema, &error, &mut found);
    }
    found
}

fn explain(source: &Source, schema: &Value, error: &ValidationError, found: &mut Vec<Diagnostic>) {
    let at = error.instance_path().to_string();
    let place = if at.is_empty() { "at the top of the file".to_owned() } else { format!("in {}", readable(&at)) };
    match error.kind() {
        ValidationErrorKind::AdditionalProperties { unexpected } => {
            let known = properties(schema, &error.schema_path().to_string());
            for key in unexpected {
                let likely = near(key, known.iter().map(String::as_str));
                let help = match likely.as_slice() {
                    [] => format!("known here: {}; keys of your own begin with x_", known.join(", ")),
                    names => format!("did you mean {}? Keys of your own begin with x_", quoted(names)),
                };
                let mut diagnostic = Diagnostic::new(codes::UNKNOWN_KEY, format!("unknown key \"{key}\" {place}"))
                    .label("the format has no such key")
                    .help(help);
                diagnostic.location = Some(source.locate(source.key_span(&join(&at, key))));
                found.push(diagnostic);
            }
        }
        ValidationErrorKind::Required { property } => {
            let name = property.as_str().unwrap_or_default();
            let mut diagnostic = Diagnostic::new(codes::MISSING_KEY, format!("key \"{name}\" is missing {place}"))
                .label(format!("needs \"{name}\""))
                .help(format!("add {name} = …{}", described(schema, &error.schema_path().to_string(), name)));
            diagnostic.location = Some(source.locate(source.span(&at)));
            found.push(diagnostic);
        }
        ValidationErrorKind::AnyOf { context } | ValidationErrorKind::OneOfNotValid { context }
            if let Some(branch) = meant(context, depth(error)) =>
        {
            for inner in branch {
                explain(source, schema, inner, found);
            }
        }
        kind => {
            let (code, message, help) = value_problem(kind, error.instance(), &readable(&at));
            let mut diagnostic = Diagnostic::new(code, message);
            diagnostic.help = help;
            diagnostic.location = Some(source.locate(source.span(&at)));
            found.push(diagnostic);
        }
    }
}

/// Of a choice, the branch that was meant: not one for another type of value or with another tag, and of the rest the
/// one with the fewest problems.
fn meant<'a>(context: &'a [Vec<ValidationError<'static>>], here: usize) -> Option<&'a [ValidationError<'static>]> {
    let other = |error: &ValidationError| match error.kind() {
        // Of a choice of words none is meant more than the others: all of them are named.
        ValidationErrorKind::Constant { .. } => true,
        ValidationErrorKind::Required { .. } | ValidationErrorKind::AdditionalProperties { .. } => false,
        _ => depth(error) == here,
    };
    let problems = |error: &ValidationError| match error.kind() {
        ValidationErrorKind::AdditionalProperties { unexpected } => unexpected.len(),
        _ => 1,
    };
    let mut all = Vec::new();
    branches(context, here, &mut all);
    all.into_iter()
        .filter(|branch| !branch.is_empty() && !branch.iter().any(other))
        .min_by_key(|branch| branch.iter().map(problems).sum::<usize>())
}

/// The branches of a choice; one that is itself a choice of the same value (an optional one is) stands for its own branches.
fn branches<'a>(
    context: &'a [Vec<ValidationError<'static>>],
    here: usize,
    out: &mut Vec<&'a [ValidationError<'static>]>,
) {
    for branch in context {
        match branch.as_slice() {
            [one] if depth(one) == here => match one.kind() {
                ValidationErrorKind::AnyOf { context } | ValidationErrorKind::OneOfNotValid { context } => {
                    branches(context, here, out);
                }
                _ => out.push(branch),
            },
            _ => out.push(branch),
        }
    }
}

/// All problems of a choice with the value itself, choices within it included.
fn flat<'a>(context: &'a [Vec<ValidationError<'static>>], out: &mut Vec<&'a ValidationError<'static>>) {
    for error in context.iter().flatten() {
        match error.kind() {
            ValidationErrorKind::AnyOf { context } | ValidationErrorKind::OneOfNotValid { context } => {
                flat(context, out);
            }
            _ => out.push(error),
        }
    }
}

fn depth(error: &ValidationError) -> usize {
    error.instance_path().to_string().matches('/').count()
}

fn value_problem(kind: &ValidationErrorKind, value: &Value, place: &str) -> (codes::Code, String, Option<String>) {
    let shown = brief(value);
    match kind {
        ValidationErrorKind::Type { kind } => {
            let wanted = match kind {
                TypeKind::Single(one) => one.to_string(),
                TypeKind::Multiple(many) => many.iter().map(|t| t.to_string()).collect::<Vec<_>>().join(" or "),
            };
            let help = match kind {
                TypeKind::Single(one) => one.to_string(),
                TypeKind::Multiple(_) => String::new(),
            };
            let help = match help.as_str() {
                "string" => "write a text, in quotes",
                "number" | "integer" => "write a number, without quotes",
                "boolean" => "write true or false",
                "array" => "write a list: [ …, … ]",
                "object" => "write a table: { key = …, … }",
                _ => "`soffio schema exhibit` says what may stand here",
            };
            (codes::WRONG_TYPE, format!("{place} is {shown}, which is not of type {wanted}"), Some(help.to_owned()))
        }
        ValidationErrorKind::AnyOf { context } | ValidationErrorKind::OneOfNotValid { context } => {
            // A choice of words or quantities: each branch is one of them.
            let mut problems = Vec::new();
            flat(context, &mut problems);
            let mut words: Vec<&str> = problems
                .iter()
                .flat_map(|e| match e.kind() {
                    ValidationErrorKind::Constant { expected_value } => vec![expected_value.as_str()],
                    ValidationErrorKind::Enum { options } => {
                        options.as_array().into_iter().flatten().map(Value::as_str).collect()
                    }
                    _ => Vec::new(),
                })
                .flatten()
                .collect();
            words.dedup();
            let units = problems.iter().find_map(|e| match e.kind() {
                ValidationErrorKind::Pattern { pattern } if e.instance().is_string() => units_of(pattern.as_str()),
                _ => None,
            });
            match (units, words.is_empty()) {
                (Some(units), no_words) => {
                    let words = if no_words { String::new() } else { format!("; or {}", quoted(&words)) };
                    let help = format!("write a number, or a text with one of these units: {units}{words}");
                    (codes::WRONG_TYPE, format!("{place} is {shown}, which has no unit that fits"), Some(help))
                }
                (None, false) => {
                    let help = format!("allowed are {}", quoted(&words));
                    (codes::WRONG_SHAPE, format!("{place} is {shown}"), Some(help))
                }
                (None, true) => {
                    let help = problems.iter().max_by_key(|error| depth(error)).map(|error| error.to_string());
                    (codes::WRONG_TYPE, format!("{place} is {shown}, which has not the shape of this key"), help)
                }
            }
        }
        ValidationErrorKind::Enum { options } => {
            let names: Vec<&str> = options.as_array().into_iter().flatten().filter_map(Value::as_str).collect();
            (codes::WRONG_SHAPE, format!("{place} is {shown}"), Some(format!("allowed are {}", quoted(&names))))
        }
        ValidationErrorKind::Minimum { limit } => {
            (codes::RANGE, format!("{place} is {shown}"), Some(format!("it must be at least {limit}")))
        }
        ValidationErrorKind::Maximum { limit } => {
            (codes::RANGE, format!("{place} is {shown}"), Some(format!("it must be at most {limit}")))
        }
        ValidationErrorKind::MinItems { limit } => {
            (codes::WRONG_SHAPE, format!("{place} has too few entries"), Some(format!("give at least {limit}")))
        }
        ValidationErrorKind::MaxItems { limit } => {
            (codes::WRONG_SHAPE, format!("{place} has too many entries"), Some(format!("give at most {limit}")))
        }
        _ => {
            let help = "`soffio schema exhibit` says what may stand here";
            (codes::WRONG_SHAPE, format!("{place} is {shown}, which this key does not allow"), Some(help.to_owned()))
        }
    }
}

/// The units in the pattern of a quantity, `(m|mm|cm)\s*$`.
fn units_of(pattern: &str) -> Option<String> {
    let inner = pattern.strip_suffix(r")\s*$")?;
    let start = inner.rfind('(')?;
    Some(inner[start + 1..].replace("\\/", "/").replace('|', ", "))
}

fn brief(value: &Value) -> String {
    const LENGTH: usize = 60;
    let text = value.to_string();
    if text.chars().count() <= LENGTH { text } else { text.chars().take(LENGTH).chain("…".chars()).collect() }
}

/// `/body/2/node` as `body[2].node`, numbers from 0 as in the file's order.
fn readable(pointer: &str) -> String {
    let mut text = String::new();
    for key in pointer.split('/').skip(1) {
        match key.parse::<usize>() {
            Ok(index) => text.push_str(&format!("[{index}]")),
            Err(_) if text.is_empty() => text.push_str(key),
            Err(_) => {
                text.push('.');
                text.push_str(key);
            }
        }
    }
    text
}

/// The schema object that holds the keyword at `schema_path`.
fn holder<'a>(schema: &'a Value, schema_path: &str) -> Option<&'a Value> {
    let parent = &schema_path[..schema_path.rfind('/')?];
    schema.pointer(parent)
}

fn properties(schema: &Value, schema_path: &str) -> Vec<String> {
    let object = holder(schema, schema_path).and_then(|s| s.get("properties")).and_then(Value::as_object);
    object.into_iter().flat_map(|o| o.keys().cloned()).collect()
}

fn described(schema: &Value, schema_path: &str, name: &str) -> String {
    let parent = holder(schema, schema_path);
    let text = parent.and_then(|s| s.get("properties")?.get(name)?.get("description")?.as_str());
    text.map(|text| format!(" ({text})")).unwrap_or_default()
}
