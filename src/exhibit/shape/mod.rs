//! The shape check: is the sidecar what the format's JSON Schema says? All violations at once, each where it stands.

pub mod validate;

use schemars::transform::RecursiveTransform;
use schemars::{Schema, generate::SchemaSettings};
use serde_json::{Value, json};

use super::codes;
use super::diagnostic::{Diagnostic, near, quoted};
use super::sidecar::Sidecar;
use super::source::{Source, join};
use validate::{Kind, Problem};

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
    let mut found = Vec::new();
    for problem in validate::problems(&schema, &source.value) {
        explain(source, &problem, &mut found);
    }
    found
}

fn explain(source: &Source, problem: &Problem, found: &mut Vec<Diagnostic>) {
    let at = &problem.at;
    let place = if at.is_empty() { "at the top of the file".to_owned() } else { format!("in {}", readable(at)) };
    match &problem.kind {
        Kind::Unknown(keys) => {
            let known = properties(problem);
            for key in keys {
                let likely = near(key, known.iter().copied());
                let help = match likely.as_slice() {
                    [] => format!("known here: {}; keys of your own begin with x_", known.join(", ")),
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

/// Of a choice, the branch that was meant: not one for another type of value or with another tag, and of the rest the
/// one with the fewest problems.
fn meant<'p, 'v>(all: &'p [Vec<Problem<'v>>], here: usize) -> Option<&'p [Problem<'v>]> {
    let other = |problem: &Problem| match problem.kind {
        // Of a choice of words none is meant more than the others: all of them are named.
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

/// The branches of a choice; one that is itself a choice of the same value (an optional one is) stands for its own branches.
fn branches<'p, 'v>(all: &'p [Vec<Problem<'v>>], here: usize, out: &mut Vec<&'p [Problem<'v>]>) {
    for branch in all {
        match branch.as_slice() {
            [Problem { kind: Kind::Choice(inner), .. }] if branch[0].depth() == here => branches(inner, here, out),
            _ => out.push(branch),
        }
    }
}

/// All problems of a choice with the value itself, choices within it included.
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
                _ => "`soffio schema exhibit` says what may stand here",
            };
            (
                codes::WRONG_TYPE,
                format!("{place} is {shown}, which is not of type {}", types.join(" or ")),
                Some(help.to_owned()),
            )
        }
        Kind::Choice(all) => {
            // A choice of words or quantities: each branch is one of them.
            let mut problems = Vec::new();
            flat(all, &mut problems);
            let mut words: Vec<&str> = problems
                .iter()
                .flat_map(|problem| match problem.kind {
                    Kind::Constant(word) => std::slice::from_ref(word),
                    Kind::Words(words) => words,
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
                    (codes::WRONG_TYPE, format!("{place} is {shown}, which has no unit that fits"), Some(help))
                }
                (None, false) => {
                    let help = format!("allowed are {}", quoted(&words));
                    (codes::WRONG_SHAPE, format!("{place} is {shown}"), Some(help))
                }
                (None, true) => {
                    let help = problems.iter().max_by_key(|problem| problem.depth()).map(ToString::to_string);
                    (codes::WRONG_TYPE, format!("{place} is {shown}, which has not the shape of this key"), help)
                }
            }
        }
        Kind::Words(words) => {
            let names: Vec<&str> = words.iter().filter_map(Value::as_str).collect();
            (codes::WRONG_SHAPE, format!("{place} is {shown}"), Some(format!("allowed are {}", quoted(&names))))
        }
        Kind::Minimum(limit) => {
            (codes::RANGE, format!("{place} is {shown}"), Some(format!("it must be at least {limit}")))
        }
        Kind::Maximum(limit) => {
            (codes::RANGE, format!("{place} is {shown}"), Some(format!("it must be at most {limit}")))
        }
        Kind::Short(limit) => {
            (codes::WRONG_SHAPE, format!("{place} has too few entries"), Some(format!("give at least {limit}")))
        }
        Kind::Long(limit) => {
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

fn properties<'a>(problem: &Problem<'a>) -> Vec<&'a str> {
    let object = problem.schema.get("properties").and_then(Value::as_object);
    object.into_iter().flat_map(|object| object.keys().map(String::as_str)).collect()
}

fn described(problem: &Problem, name: &str) -> String {
    let text = problem.schema.get("properties").and_then(|all| all.get(name)?.get("description")?.as_str());
    text.map(|text| format!(" ({text})")).unwrap_or_default()
}
