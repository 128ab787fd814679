//! Sabotage: an exhibit's sidecar without one of its systems, in a folder of its own.

use std::fs;
use std::path::Path;

use soffio_exhibit::{self as exhibit, Exhibit, SIDECAR};
use toml::{Table, Value};

/// What a twin's sidecar lacks, or has in place of it. Tables are named by their dotted path, and tables of an array by the
/// value of their `name`, `node` or `body`.
#[derive(Clone, Copy, Debug)]
pub enum Cut {
    /// Without this table of an array.
    Row(&'static str, &'static str),
    /// Without all tables of an array, or without one table.
    All(&'static str),
    /// Without a key of one table of an array; the key may lie in a table of it.
    Key(&'static str, &'static str, &'static str),
    /// Without a key of a table.
    Plain(&'static str, &'static str),
    /// With another value of a key of a table.
    Set(&'static str, &'static str, &'static str),
    /// A joint becomes a nail at the same point: it leaves all rotations free.
    Nail(&'static str, &'static str),
}

/// Keys that a nail has in common with the joints that it replaces.
const NAIL_KEYS: [&str; 5] = ["name", "body", "at", "to", "friction"];

impl Cut {
    fn apply(self, sidecar: &mut Table) {
        match self {
            Self::Row(array, name) => {
                take(sidecar, array, name);
            }
            Self::All(path) => {
                let (parent, last) = path.rsplit_once('.').unwrap_or(("", path));
                let table = table(sidecar, parent);
                table.remove(last).unwrap_or_else(|| panic!("nothing is called {path}"));
            }
            Self::Key(array, name, key) => {
                let (within, key) = key.rsplit_once('.').unwrap_or(("", key));
                let table = table(row(sidecar, array, name), within);
                table.remove(key).unwrap_or_else(|| panic!("{name} has no {key}"));
            }
            Self::Plain(path, key) => {
                table(sidecar, path).remove(key).unwrap_or_else(|| panic!("{path} has no {key}"));
            }
            Self::Set(path, key, value) => {
                let value = value.parse::<Value>().expect("a value");
                table(sidecar, path).insert(key.to_owned(), value);
            }
            Self::Nail(array, name) => {
                let mut joint = take(sidecar, array, name);
                joint.retain(|key, _| NAIL_KEYS.contains(&key));
                // Before the other nails: the order of joints is of no matter.
                rows(sidecar, "constraint.nail").push(Value::Table(joint));
            }
        }
    }
}

/// The table of a dotted path; the empty path is the sidecar, and a number counts tables of an array from 0. Missing tables
/// are made.
fn table<'a>(sidecar: &'a mut Table, path: &str) -> &'a mut Table {
    let mut names = path.split('.').filter(|name| !name.is_empty());
    let mut table = sidecar;
    while let Some(name) = names.next() {
        let mut below = table.entry(name.to_owned()).or_insert_with(|| Value::Table(Table::new()));
        if let Value::Array(rows) = below {
            let index: usize = names.next().and_then(|index| index.parse().ok()).expect("an index");
            below = &mut rows[index];
        }
        table = below.as_table_mut().unwrap_or_else(|| panic!("{path} is no table"));
    }
    table
}

/// The tables of an array by its dotted path; a missing one is made.
fn rows<'a>(sidecar: &'a mut Table, path: &str) -> &'a mut Vec<Value> {
    let (parent, last) = path.rsplit_once('.').unwrap_or(("", path));
    let array = table(sidecar, parent).entry(last.to_owned()).or_insert_with(|| Value::Array(Vec::new()));
    array.as_array_mut().unwrap_or_else(|| panic!("{path} is no array of tables"))
}

/// Index of a table of an array.
fn place(rows: &[Value], array: &str, name: &str) -> usize {
    let is = |row: &Value, key| row.get(key).and_then(Value::as_str) == Some(name);
    let named = |row: &Value| ["name", "node", "body"].iter().any(|key| is(row, key));
    rows.iter().position(named).unwrap_or_else(|| panic!("no {name} in {array}"))
}

/// A table of an array.
fn row<'a>(sidecar: &'a mut Table, array: &str, name: &str) -> &'a mut Table {
    let rows = rows(sidecar, array);
    let index = place(rows, array, name);
    rows[index].as_table_mut().expect("a table")
}

/// Removes a table of an array and returns it.
fn take(sidecar: &mut Table, array: &str, name: &str) -> Table {
    let rows = rows(sidecar, array);
    let index = place(rows, array, name);
    match rows.remove(index) {
        Value::Table(row) => row,
        other => panic!("{array} holds {other}"),
    }
}

/// The shipped exhibit.
pub fn shipped(id: &str) -> Exhibit {
    let folder = exhibit::resolve(id).unwrap_or_else(|report| panic!("{report}"));
    exhibit::load(&folder).unwrap_or_else(|report| panic!("{id}: {}", report.to_text()))
}

/// The exhibit with these cuts in its sidecar, loaded from a copy of its folder.
pub fn twin(id: &str, cuts: &[Cut]) -> Exhibit {
    let folder = exhibit::resolve(id).unwrap_or_else(|report| panic!("{report}"));
    let text = fs::read_to_string(folder.join(SIDECAR)).expect("a sidecar");
    let mut sidecar: Table = text.parse().expect("TOML");
    cuts.iter().for_each(|cut| cut.apply(&mut sidecar));
    let copy = tempfile::tempdir().expect("a folder");
    for entry in fs::read_dir(&folder).expect("the exhibit's folder").map(|entry| entry.expect("an entry").path()) {
        if entry.is_file() {
            fs::copy(&entry, copy.path().join(entry.file_name().expect("a name"))).expect("a copy");
        } else {
            copy_folder(&entry, &copy.path().join(entry.file_name().expect("a name")));
        }
    }
    fs::write(copy.path().join(SIDECAR), sidecar.to_string()).expect("the twin's sidecar");
    exhibit::load(copy.path()).unwrap_or_else(|report| panic!("the twin of {id}, {cuts:?}: {}", report.to_text()))
}

/// Copies the files of a folder.
fn copy_folder(from: &Path, to: &Path) {
    fs::create_dir(to).expect("a folder");
    for entry in fs::read_dir(from).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        fs::copy(&entry, to.join(entry.file_name().expect("a name"))).expect("a copy");
    }
}
