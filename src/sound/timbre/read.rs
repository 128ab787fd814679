//! From text to a preset, table by table, so that each error knows its line, its key, and what would be right.

use serde::de::DeserializeOwned;
use toml::{Table, Value};

use super::error::TimbreError;
use super::node::{Node, TYPES};
use super::preset::Preset;
use super::source::{COMMON, Common, Modal, SOURCES, Source};
use super::specimen::Specimen;

/// Jaro–Winkler likeness from which a known name is proposed for an unknown one: chosen by trying misspellings.
const LIKENESS: f64 = 0.75;
/// Deepest nesting of a preset; what is deeper is hostile.
const DEEPEST: usize = 32;
/// Longest preset, bytes: 1 MiB, a bound on hostile files.
const LONGEST: usize = 1 << 20;

/// `; did you mean "x"?`, or which there are.
pub(super) fn hint<'a>(wanted: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    let lower = wanted.to_lowercase();
    let nearest = known
        .clone()
        .map(|name| (strsim::jaro_winkler(&lower, name), name))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(likeness, _)| *likeness >= LIKENESS);
    let all: Vec<_> = known.collect();
    match nearest {
        Some((_, name)) => format!("; did you mean \"{name}\"? There are {}", all.join(", ")),
        None => format!("; there are {}", all.join(", ")),
    }
}

/// A preset's text as a table.
pub(super) fn table(name: &str, text: &str) -> Result<Table, TimbreError> {
    if text.len() > LONGEST {
        let problem = format!("{} bytes; a timbre has at most {LONGEST}", text.len());
        return Err(TimbreError::new(name, "file", problem));
    }
    // The parser is recursive: brackets in a row are counted before it sees them.
    let mut depth = 0usize;
    for byte in text.bytes() {
        match byte {
            b'[' | b'{' => depth += 1,
            b']' | b'}' => depth = depth.saturating_sub(1),
            b'\n' if depth <= 2 => depth = 0,
            _ => {}
        }
        if depth > DEEPEST {
            return Err(TimbreError::new(name, "file", "brackets within brackets without end"));
        }
    }
    text.parse::<Table>().map_err(|e| {
        let line = e.span().map(|span| line_of(text, span.start));
        TimbreError { line, ..TimbreError::new(name, "syntax", e.message()) }
    })
}

/// A preset from its table.
pub(super) fn preset(name: &str, mut table: Table) -> Result<Preset, TimbreError> {
    let nodes = match table.remove("node") {
        Some(Value::Table(nodes)) if !nodes.is_empty() => nodes,
        _ => return Err(TimbreError::new(name, "node", "a timbre needs nodes, such as [node.out]")),
    };
    table.insert("node".into(), Value::Table(Table::new()));
    let head: Head = read(name, "", table, &[])?;
    let mut preset = Preset {
        timbre: head.timbre,
        name: head.name,
        description: head.description,
        specimen: head.specimen,
        node: std::collections::BTreeMap::new(),
    };
    for (key, value) in nodes {
        let path = format!("node.{key}");
        let Value::Table(table) = value else {
            return Err(TimbreError::new(name, path, "must be a table with a type"));
        };
        preset.node.insert(key, node(name, &path, table)?);
    }
    Ok(preset)
}

/// What a preset says beside its nodes.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Head {
    timbre: u32,
    name: String,
    description: String,
    #[serde(default)]
    specimen: Specimen,
    #[serde(rename = "node")]
    _node: Table,
}

fn node(name: &str, path: &str, mut table: Table) -> Result<Node, TimbreError> {
    let kind = choice(name, path, &mut table, "type", &TYPES)?;
    Ok(match kind.as_str() {
        "modal" => Node::Modal(Box::new(modal(name, path, table)?)),
        "noise" => Node::Noise(read(name, path, table, &[])?),
        "oscillator" => Node::Oscillator(read(name, path, table, &[])?),
        "fm" => Node::Fm(read(name, path, table, &[])?),
        "function" => Node::Function(read(name, path, table, &[])?),
        "texture" => Node::Texture(read(name, path, table, &[])?),
        "filter" => Node::Filter(read(name, path, table, &[])?),
        "env" => Node::Env(read(name, path, table, &[])?),
        "value" => Node::Value(read(name, path, table, &[])?),
        "map" => Node::Map(read(name, path, table, &[])?),
        "delay" => Node::Delay(read(name, path, table, &[])?),
        "sum" => Node::Sum(read(name, path, table, &[])?),
        _ => Node::Product(read(name, path, table, &[])?),
    })
}

fn modal(name: &str, path: &str, mut table: Table) -> Result<Modal, TimbreError> {
    let from = choice(name, path, &mut table, "from", &SOURCES)?;
    let mut common = Table::new();
    for key in COMMON {
        if let Some(value) = table.remove(key) {
            common.insert(key.into(), value);
        }
    }
    let source = match from.as_str() {
        "plate" => Source::Plate(read(name, path, table, &COMMON)?),
        "table" => Source::Table(read(name, path, table, &COMMON)?),
        "tube" => Source::Tube(read(name, path, table, &COMMON)?),
        "bar" => Source::Bar(read(name, path, table, &COMMON)?),
        "string" => Source::String(read(name, path, table, &COMMON)?),
        "mass-spring" => Source::MassSpring(read(name, path, table, &COMMON)?),
        "membrane" => Source::Membrane(read(name, path, table, &COMMON)?),
        "random" => Source::Random(read(name, path, table, &COMMON)?),
        _ => Source::Mesh(read(name, path, table, &COMMON)?),
    };
    let common: Common = read(name, path, common, &[])?;
    Ok(Modal { source, common })
}

/// Takes the key that says what the rest is.
fn choice(name: &str, path: &str, table: &mut Table, key: &str, known: &[&str]) -> Result<String, TimbreError> {
    match table.remove(key) {
        Some(Value::String(given)) if known.contains(&given.as_str()) => Ok(given),
        Some(given) => {
            let given = given.as_str().map_or_else(|| given.to_string(), String::from);
            let problem = format!("no {key} \"{given}\"{}", hint(&given, known.iter().copied()));
            Err(TimbreError::new(name, format!("{path}.{key}"), problem))
        }
        None => Err(TimbreError::new(name, path, format!("needs a {key}: one of {}", known.join(", ")))),
    }
}

/// One table as a type. `others`: keys that are allowed beside the type's own.
fn read<T: DeserializeOwned>(name: &str, path: &str, table: Table, others: &[&str]) -> Result<T, TimbreError> {
    let whole = Value::Table(table);
    T::deserialize(whole.clone()).map_err(|e| {
        let message = e.message().to_string();
        let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
        // The parser names the key that it stumbled over, but for unknown ones: those are looked for.
        let inner = e.to_string().lines().find_map(|l| Some(l.strip_prefix("in `")?.strip_suffix('`')?.to_string()));
        let (key, problem) = if let Some(rest) = message.strip_prefix("unknown field `") {
            let unknown = rest.split('`').next().unwrap_or_default();
            let place = find(&whole, unknown).or(inner).unwrap_or_else(|| unknown.to_string());
            let known = quoted.iter().skip(1).copied().filter(|known| *known != "node" || path.is_empty());
            let known: Vec<&str> =
                if place == unknown { known.chain(others.iter().copied()).collect() } else { known.collect() };
            (place, format!("unknown key{}", hint(unknown, known.into_iter())))
        } else if let Some(rest) = message.strip_prefix("unknown variant `") {
            let unknown = rest.split('`').next().unwrap_or_default();
            let known: Vec<&str> = quoted.iter().skip(1).copied().collect();
            let place = inner.or_else(|| find_value(&whole, unknown)).unwrap_or_default();
            (place, format!("no \"{unknown}\"{}", hint(unknown, known.into_iter())))
        } else if let Some(rest) = message.strip_prefix("missing field `") {
            let missing = rest.split('`').next().unwrap_or_default();
            (inner.unwrap_or_default(), format!("needs a key \"{missing}\""))
        } else {
            (inner.unwrap_or_default(), message)
        };
        let key = [path, &key].iter().filter(|part| !part.is_empty()).copied().collect::<Vec<_>>().join(".");
        TimbreError::new(name, if key.is_empty() { "file".into() } else { key }, problem)
    })
}

/// Path of the first key of this name.
fn find(value: &Value, wanted: &str) -> Option<String> {
    search(value, &|key, _| key == wanted)
}

/// Path of the first text that says this.
fn find_value(value: &Value, wanted: &str) -> Option<String> {
    search(value, &|_, value| value.as_str() == Some(wanted))
}

fn search(value: &Value, is_it: &dyn Fn(&str, &Value) -> bool) -> Option<String> {
    let below = |key: String, inside: &Value| search(inside, is_it).map(|rest| format!("{key}.{rest}"));
    match value {
        Value::Table(table) => table
            .iter()
            .find(|(key, value)| is_it(key, value))
            .map(|(key, _)| key.clone())
            .or_else(|| table.iter().find_map(|(key, inside)| below(key.clone(), inside))),
        Value::Array(items) => items.iter().enumerate().find_map(|(i, inside)| below(i.to_string(), inside)),
        _ => None,
    }
}

/// Line, from 1, of the key of this path, or of the nearest table around it.
pub(super) fn line(text: &str, path: &str) -> Option<usize> {
    let document = toml_edit::Document::parse(text).ok()?;
    let mut item = document.as_item();
    let mut span = None;
    for part in path.split('.') {
        if let Ok(index) = part.parse::<usize>()
            && let Some(array) = item.as_array()
        {
            let value = array.get(index)?;
            return Some(line_of(text, value.span().or(span)?.start));
        }
        let Some(table) = item.as_table_like() else { break };
        let Some((key, next)) = table.get_key_value(part) else { break };
        // A table that is only implied, as `node` by [node.out], has no place of its own.
        span = key.span().or_else(|| next.span()).or(span);
        item = next;
    }
    Some(line_of(text, span?.start))
}

fn line_of(text: &str, byte: usize) -> usize {
    text.as_bytes()[..byte.min(text.len())].iter().filter(|b| **b == b'\n').count() + 1
}
