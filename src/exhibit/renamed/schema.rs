//! Old names in a JSON Schema: allowed, and marked as deprecated, so that an editor strikes them through.

use serde_json::{Map, Value, json};

use super::{FileKind, OLD_NAMES, OldName, Subject};

/// Adds the old names of a kind of file to its schema.
pub fn add_old_names(kind: FileKind, schema: &mut Value) {
    for name in OLD_NAMES.iter().filter(|name| name.file == kind) {
        let keys: Vec<&str> = name.path.split('.').filter(|key| !key.is_empty()).collect();
        let mut pointers = Vec::new();
        places(schema, "", &keys, &mut pointers);
        for pointer in pointers {
            match schema.pointer_mut(&pointer) {
                Some(Value::Object(part)) if name.subject == Subject::Key => add_key(part, name),
                Some(Value::Object(part)) => add_word(part, name),
                _ => {}
            }
        }
    }
}

/// JSON pointers of all parts of the schema that describe the value at a path.
fn places(schema: &Value, pointer: &str, keys: &[&str], out: &mut Vec<String>) {
    let Some(part) = schema.pointer(pointer) else { return };
    if let Some(target) = part.get("$ref").and_then(Value::as_str) {
        places(schema, target.trim_start_matches('#'), keys, out);
    }
    for choice in ["anyOf", "oneOf", "allOf"] {
        let count = part.get(choice).and_then(Value::as_array).map_or(0, Vec::len);
        (0..count).for_each(|i| places(schema, &format!("{pointer}/{choice}/{i}"), keys, out));
    }
    if part.get("items").is_some() {
        places(schema, &format!("{pointer}/items"), keys, out);
    }
    match keys.split_first() {
        None => out.push(pointer.to_owned()),
        Some((&"*", rest)) => places(schema, &format!("{pointer}/additionalProperties"), rest, out),
        Some((key, rest)) => places(schema, &format!("{pointer}/properties/{key}"), rest, out),
    }
}

fn add_key(part: &mut Map<String, Value>, name: &OldName) {
    let Some(Value::Object(properties)) = part.get_mut("properties") else { return };
    let Some(mut old) = properties.get(name.new).cloned() else { return };
    if let Value::Object(old) = &mut old {
        old.insert("deprecated".into(), true.into());
        old.insert("description".into(), format!("Old name of `{}`.", name.new).into());
    }
    properties.insert(name.old.to_owned(), old);
    // Where the new name is needed, the old one does as well.
    if let Some(Value::Array(required)) = part.get_mut("required")
        && let Some(index) = required.iter().position(|key| key == name.new)
    {
        required.remove(index);
        let one_of_both = json!({ "anyOf": [{ "required": [name.new] }, { "required": [name.old] }] });
        if let Value::Array(all) = part.entry("allOf").or_insert_with(|| json!([])) {
            all.push(one_of_both);
        }
    }
}

fn add_word(part: &mut Map<String, Value>, name: &OldName) {
    if let Some(Value::Array(words)) = part.get_mut("enum")
        && words.iter().any(|word| word == name.new)
    {
        words.push(name.old.into());
    } else if let Some(Value::Array(choices)) = part.get_mut("oneOf")
        && choices.iter().any(|choice| choice.get("const").is_some_and(|word| word == name.new))
    {
        let description = format!("Old name of \"{}\".", name.new);
        choices.push(json!({ "const": name.old, "deprecated": true, "description": description }));
    }
}
