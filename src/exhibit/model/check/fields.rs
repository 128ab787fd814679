//! Walks a document by the [tables](super::tables): types, ranges, required fields and indices. It also makes the JSON
//! one that the `gltf` crate can read: whole numbers written `1.0` become integers, words that are not known yet go.

use serde_json::{Map, Value};

use super::super::fault::{Cause, Faults, Place};
use super::tables::{EXTENSIONS, Field, Kind, LIGHTS, PUNCTUAL, Range, Table};

/// Integers up to here are exact in double precision.
const EXACT: f64 = 9_007_199_254_740_992.0;

/// Numbers of entries of the lists that indices refer to, and the extensions that the document declares.
pub struct Walk<'f> {
    lengths: Map<String, Value>,
    used: Vec<String>,
    /// Where faults go.
    pub faults: &'f mut Faults,
}

/// Number of entries of a list in `value`.
fn length(value: Option<&Value>) -> usize {
    value.and_then(Value::as_array).map_or(0, Vec::len)
}

/// Name of a value's JSON type, with its article.
pub fn type_name(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "a text",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    }
}

impl<'f> Walk<'f> {
    /// A walk through `root`.
    pub fn new(root: &Value, faults: &'f mut Faults) -> Self {
        let mut lengths: Map<String, Value> = Map::new();
        for (key, value) in root.as_object().into_iter().flatten() {
            lengths.insert(key.clone(), length(Some(value)).into());
        }
        for (list, extension) in [(LIGHTS, PUNCTUAL), ("variants", "KHR_materials_variants")] {
            let held = root["extensions"][extension].get(list);
            lengths.insert(list.to_owned(), length(held).into());
        }
        let used = root["extensionsUsed"].as_array().into_iter().flatten();
        let used = used.filter_map(|name| name.as_str().map(str::to_owned)).collect();
        Self { lengths, used, faults }
    }

    /// Number of entries of a top-level list.
    fn length(&self, list: &str) -> u64 {
        self.lengths.get(list).and_then(Value::as_u64).unwrap_or(0)
    }

    fn wrong(&mut self, place: Place, value: &Value, wanted: &str) {
        self.faults.add(Cause::WrongType, place, format_args!("is {}; it must be {wanted}", type_name(value)));
    }

    /// Checks an object by its table.
    pub fn object(&mut self, value: &mut Value, table: &'static Table, place: Place) {
        let Some(map) = value.as_object_mut() else { return self.wrong(place, value, "an object") };
        for field in table.fields {
            let at = Place::Key(&place, field.key);
            match map.get_mut(field.key).map(|held| self.field(held, field, at)) {
                Some(true) => {}
                Some(false) => drop(map.remove(field.key)),
                None if field.required => self.faults.add(Cause::Missing, at, "is missing"),
                None => {}
            }
        }
        if let Some(extensions) = map.get_mut("extensions") {
            self.extensions(extensions, table.name, Place::Key(&place, "extensions"));
        }
    }

    fn extensions(&mut self, value: &mut Value, owner: &str, place: Place) {
        let Some(map) = value.as_object_mut() else { return self.wrong(place, value, "an object") };
        for (name, held) in map {
            let at = Place::Key(&place, name);
            if !held.is_object() {
                self.wrong(at, held, "an object");
                continue;
            }
            if !self.used.contains(name) {
                self.faults.add(Cause::Harmless, at, "is not listed in extensionsUsed");
            }
            let mut known = EXTENSIONS.iter().filter(|(extension, ..)| extension == name).peekable();
            if known.peek().is_none() {
                continue;
            }
            match known.find(|(_, extends, _)| *extends == owner) {
                Some((.., table)) => self.object(held, table, at),
                None => self.faults.add(Cause::Harmless, at, "has no meaning here; it is ignored"),
            }
        }
    }

    /// Checks a field; false where it is to be read as if it were not there.
    fn field(&mut self, value: &mut Value, field: &Field, place: Place) -> bool {
        match field.kind {
            Kind::Object(table) => self.object(value, table, place),
            Kind::Objects(table) => self.each(value, place, |walk, entry, at| walk.object(entry, table, at)),
            Kind::Index(list) => self.index(value, list, place),
            Kind::Indices(list) => {
                self.each(value, place, |walk, entry, at| walk.index(entry, list, at));
                self.repeated(value, place);
            }
            Kind::Accessors => self.accessors(value, place),
            Kind::AccessorSets => self.each(value, place, Self::accessors),
            Kind::Whole(least) => {
                if let Some(number) = self.whole(value, place)
                    && number < least
                {
                    self.faults.add(Cause::Range, place, format_args!("is {number}; it must be at least {least}"));
                }
            }
            Kind::Number(range) => self.number(value, range, place),
            Kind::Numbers(least, most, range) => {
                self.each(value, place, |walk, entry, at| walk.number(entry, range, at));
                let count = length(Some(value));
                if value.is_array() && !(least..=most).contains(&count) {
                    let wanted = if least == most { least.to_string() } else { format!("{least} to {most}") };
                    self.faults.add(Cause::Count, place, format_args!("has {count} numbers; it must have {wanted}"));
                }
            }
            Kind::Flag if !value.is_boolean() => self.wrong(place, value, "true or false"),
            Kind::Text if !value.is_string() => self.wrong(place, value, "a text"),
            Kind::Flag | Kind::Text => {}
            Kind::Texts => {
                self.each(value, place, |walk, entry, at| {
                    if !entry.is_string() {
                        walk.wrong(at, entry, "a text");
                    }
                });
                self.repeated(value, place);
            }
            Kind::Choice(words) => match value.as_str() {
                Some(word) if words.contains(&word) => {}
                Some(word) => return self.unknown(field, place, format_args!("\"{word}\""), &words.join(", ")),
                None => self.wrong(place, value, "a text"),
            },
            Kind::Code(codes) => {
                let Some(code) = self.whole(value, place) else { return true };
                if !codes.contains(&code) {
                    let known: Vec<String> = codes.iter().map(u64::to_string).collect();
                    return self.unknown(field, place, format_args!("{code}"), &known.join(", "));
                }
            }
        }
        true
    }

    fn unknown(&mut self, field: &Field, place: Place, value: std::fmt::Arguments, known: &str) -> bool {
        if field.hint {
            self.faults.add(Cause::Skipped, place, format_args!("is {value}, which is ignored; known are {known}"));
        } else {
            self.faults.add(Cause::Range, place, format_args!("is {value}; it must be one of {known}"));
        }
        !field.hint
    }

    /// Each entry of a list.
    fn each(&mut self, value: &mut Value, place: Place, mut check: impl FnMut(&mut Self, &mut Value, Place)) {
        let Some(list) = value.as_array_mut() else { return self.wrong(place, value, "a list") };
        if list.is_empty() {
            self.faults.add(Cause::Harmless, place, "is an empty list; leave it out");
        }
        for (index, entry) in list.iter_mut().enumerate() {
            check(self, entry, Place::Item(&place, index));
        }
    }

    /// Warns of entries that occur twice.
    fn repeated(&mut self, value: &Value, place: Place) {
        let mut entries: Vec<(String, usize)> = value
            .as_array()
            .into_iter()
            .flatten()
            .enumerate()
            .map(|(index, entry)| (entry.to_string(), index))
            .collect();
        entries.sort();
        for pair in entries.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            self.faults.add(Cause::Harmless, Place::Item(&place, pair[1].1), format_args!("repeats {}", pair[1].0));
        }
    }

    fn accessors(&mut self, value: &mut Value, place: Place) {
        let Some(map) = value.as_object_mut() else { return self.wrong(place, value, "an object") };
        if map.is_empty() {
            self.faults.add(Cause::Harmless, place, "is an empty object; leave it out");
        }
        for (key, entry) in map {
            self.index(entry, "accessors", Place::Key(&place, key));
        }
    }

    /// A whole number that is not negative; `1.0` counts as one (RFC 8259 has a single kind of number).
    fn whole(&mut self, value: &mut Value, place: Place) -> Option<u64> {
        let Some(number) = value.as_f64() else {
            self.wrong(place, value, "a whole number");
            return None;
        };
        if value.as_u64().is_none() {
            if !((0.0..EXACT).contains(&number) && number.fract() == 0.0) {
                let what = format_args!("is {value}; it must be a whole number of at least 0");
                self.faults.add(Cause::Range, place, what);
                return None;
            }
            *value = (number as u64).into();
        }
        value.as_u64()
    }

    fn index(&mut self, value: &mut Value, list: &str, place: Place) {
        let Some(index) = self.whole(value, place) else { return };
        let length = self.length(list);
        if index >= length {
            let what = match length {
                0 => format!("is {index}, but the model has no {list}"),
                1 => format!("is {index}, but the model has one of {list}, number 0"),
                _ => format!("is {index}, but the model has {length} {list}, numbered 0 to {}", length - 1),
            };
            self.faults.add(Cause::Index, place, what);
        }
    }

    fn number(&mut self, value: &mut Value, range: Range, place: Place) {
        let Some(number) = value.as_f64() else { return self.wrong(place, value, "a number") };
        let Range { low, high, above } = range;
        if number.abs() > f64::from(f32::MAX) {
            self.faults.add(Cause::NotFinite, place, format_args!("is {number:e}, infinite in single precision"));
        } else if number < low || number > high || (above && number <= low) {
            let wanted = match (above, high.is_finite()) {
                (false, true) => format!("from {low} to {high:.4}"),
                (true, true) => format!("above {low} and at most {high:.4}"),
                (false, false) => format!("at least {low}"),
                (true, false) => format!("above {low}"),
            };
            self.faults.add(Cause::Range, place, format_args!("is {number}; it must be {wanted}"));
        }
    }
}
