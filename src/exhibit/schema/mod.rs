//! Schema check: validates the sidecar against the format's JSON Schema and locates every violation.

mod bounds;
pub mod validate;

use schemars::transform::RecursiveTransform;
use schemars::{Schema, generate::SchemaSettings};
use serde_json::{Value, json};

use super::codes;
use super::diagnostic::{Diagnostic, quoted, similar_names};
use super::renamed::{FileKind, add_old_names};
use super::sidecar::Sidecar;
use super::source::{SidecarText, join};
use validate::{Kind, Problem};

/// Most violations that are explained: each is looked for in the text, and names like those that are known are looked for.
const MAX_EXPLAINED: usize = 1000;

/// JSON Schema (draft 2020-12) of `exhibit.toml`.
pub fn schema() -> Value {
    let open = RecursiveTransform(|schema: &mut Schema| {
        // Keys of other programs: closed objects accept x_*.
        if schema.get("additionalProperties") == Some(&json!(false)) {
            schema.insert("patternProperties".into(), json!({ "^x_": true }));
        }
    });
    let mut root =
        SchemaSettings::draft2020_12().with_transform(open).into_generator().into_root_schema_for::<Sidecar>();
    root.insert("title".into(), "Soffio exhibit sidecar, format exhibit/1".into());
    root.to_value()
}

/// The schema for editors: old names are allowed, and marked as deprecated.
pub fn schema_with_old_names() -> Value {
    let mut schema = schema();
    add_old_names(FileKind::Sidecar, &mut schema);
    schema
}

/// All violations of the sidecar's schema, each with its location and remedy.
pub fn check(source: &SidecarText) -> Vec<Diagnostic> {
    let schema = schema();
    let mut found = Vec::new();
    for problem in validate::problems(&schema, &source.value).iter().take(MAX_EXPLAINED) {
        explain(source, problem, &mut found);
    }
    if found.is_empty() {
        found = bounds::check(source, &schema);
    }
    found
}

fn explain(source: &SidecarText, problem: &Problem, found: &mut Vec<Diagnostic>) {
    let at = &problem.at;
    let place = if at.is_empty() { "at the top of the file".to_owned() } else { format!("in {}", readable(at)) };
    match &problem.kind {
        Kind::Unknown(keys) => {
            let known = properties(problem);
            for key in keys {
                let likely = similar_names(key, known.iter().copied());
                let help = match likely.as_slice() {
                    [] => format!("allowed here: {}; keys of your own begin with x_", known.join(", ")),
                    names => format!("did you mean {}? Keys of your own begin with x_", quoted(names)),
                };
                let mut diagnostic = Diagnostic::new(codes::UNKNOWN_KEY, format!("unknown key \"{key}\" {place}"))
                    .label("the format has no such key")
                    .help(help);
                diagnostic.location = Some(source.locate(source.key_span(&join(at, key))));
                found.push(diagnostic);
            }
        }
        Kind::Missing(name) => {
            let mut diagnostic = Diagnostic::new(codes::MISSING_KEY, format!("key \"{name}\" is missing {place}"))
                .label(format!("needs \"{name}\""))
                .help(format!("add {name} = …{}", described(problem, name)));
            diagnostic.location = Some(source.locate(source.span(at)));
            found.push(diagnostic);
        }
        Kind::Choice(all) if let Some(branch) = meant(all, problem.depth()) => {
            for inner in branch {
                explain(source, inner, found);
            }
        }
        kind => {
            let (code, message, help) = value_problem(kind, problem.value, &readable(at));
            let mut diagnostic = Diagnostic::new(code, message);
            diagnostic.help = help;
            diagnostic.location = Some(source.locate(source.span(at)));
            found.push(diagnostic);
        }
    }
}

/// The branch of a choice that was probably meant. Branches for another type or another tag are ruled out; of the rest,
/// the one with the fewest problems.
fn meant<'p, 'v>(all: &'p [Vec<Problem<'v>>], here: usize) -> Option<&'p [Problem<'v>]> {
    let other = |problem: &Problem| match problem.kind {
        // Of a choice between words none is more likely than the others: all are named.
        Kind::Constant(_) => true,
        Kind::Missing(_) | Kind::Unknown(_) => false,
        _ => problem.depth() == here,
    };
    let problems = |problem: &Problem| match &problem.kind {
        Kind::Unknown(keys) => keys.len(),
        _ => 1,
    };
    let mut every = Vec::new();
    branches(all, here, &mut every);
    every
        .into_iter()
        .filter(|branch| !branch.is_empty() && !branch.iter().any(other))
        .min_by_key(|branch| branch.iter().map(problems).sum::<usize>())
}

/// The branches of a choice; a branch that is itself a choice of the same value is replaced by its own branches.
fn branches<'p, 'v>(all: &'p [Vec<Problem<'v>>], here: usize, out: &mut Vec<&'p [Problem<'v>]>) {
    for branch in all {
        match branch.as_slice() {
            [Problem { kind: Kind::Choice(inner), .. }] if branch[0].depth() == here => branches(inner, here, out),
            _ => out.push(branch),
        }
    }
}

/// All problems of the value itself in a choice, nested choices included.
fn flat<'p, 'v>(all: &'p [Vec<Problem<'v>>], out: &mut Vec<&'p Problem<'v>>) {
    for problem in all.iter().flatten() {
        match &problem.kind {
            Kind::Choice(inner) => flat(inner, out),
            _ => out.push(problem),
        }
    }
}

fn value_problem(kind: &Kind, value: &Value, place: &str) -> (codes::Code, String, Option<String>) {
    let shown = brief(value);
    match kind {
        Kind::Type(types) => {
            let help = if let [one] = types[..] { one } else { "" };
            let help = match help {
                "string" => "write a text, in quotes",
                "number" | "integer" => "write a number, without quotes",
                "boolean" => "write true or false",
                "array" => "write a list: [ …, … ]",
                "object" => "write a table: { key = …, … }",
                _ => "`soffio schema exhibit` lists what is allowed here",
            };
            (
                codes::WRONG_TYPE,
                format!("{place} is {shown}, which is not of type {}", types.join(" or ")),
                Some(help.to_owned()),
            )
        }
        Kind::Choice(all) => {
            // A choice between words or quantities: each branch is one of them.
            let mut problems = Vec::new();
            flat(all, &mut problems);
            let mut words: Vec<&str> = problems
                .iter()
                .flat_map(|problem| match problem.kind {
                    Kind::Constant(word) => std::slice::from_ref(word),
                    Kind::OneOf(words) => words,
                    _ => &[],
                })
                .filter_map(Value::as_str)
                .collect();
            words.dedup();
            let units = problems.iter().find_map(|problem| match problem.kind {
                Kind::Pattern(pattern) => units_of(pattern),
                _ => None,
            });
            match (units, words.is_empty()) {
                (Some(units), no_words) => {
                    let words = if no_words { String::new() } else { format!("; or {}", quoted(&words)) };
                    let help = format!("write a number, or a text with one of these units: {units}{words}");
                    (codes::WRONG_TYPE, format!("{place} is {shown}, which has no valid unit"), Some(help))
                }
                (None, false) => {
                    let help = format!("allowed are {}", quoted(&words));
                    (codes::WRONG_SHAPE, format!("{place} is {shown}"), Some(help))
                }
                (None, true) => {
                    let help = problems.iter().max_by_key(|problem| problem.depth()).map(ToString::to_string);
                    (codes::WRONG_TYPE, format!("{place} is {shown}, which does not have the form of this key"), help)
                }
            }
        }
        Kind::OneOf(words) => {
            let names: Vec<&str> = words.iter().filter_map(Value::as_str).collect();
            (codes::WRONG_SHAPE, format!("{place} is {shown}"), Some(format!("allowed are {}", quoted(&names))))
        }
        Kind::Minimum(limit) => {
            (codes::RANGE, format!("{place} is {shown}"), Some(format!("it must be at least {limit}")))
        }
        Kind::Maximum(limit) => {
            (codes::RANGE, format!("{place} is {shown}"), Some(format!("it must be at most {limit}")))
        }
        Kind::TooShort(limit) => {
            (codes::WRONG_SHAPE, format!("{place} has too few entries"), Some(format!("give at least {limit}")))
        }
        Kind::TooLong(limit) => {
            (codes::WRONG_SHAPE, format!("{place} has too many entries"), Some(format!("give at most {limit}")))
        }
        _ => {
            let help = "`soffio schema exhibit` lists what is allowed here";
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

/// `/body/2/node` as `body[2].node`, counted from 0.
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

fn properties<'a>(problem: &Problem<'a>) -> Vec<&'a str> {
    let object = problem.schema.get("properties").and_then(Value::as_object);
    object.into_iter().flat_map(|object| object.keys().map(String::as_str)).collect()
}

fn described(problem: &Problem, name: &str) -> String {
    let text = problem.schema.get("properties").and_then(|all| all.get(name)?.get("description")?.as_str());
    text.map(|text| format!(" ({text})")).unwrap_or_default()
}
