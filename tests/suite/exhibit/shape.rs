//! The shape check knows all that the sidecar's JSON Schema asks. `tests/schemas` holds it against a whole implementation.

use std::collections::BTreeSet;

use serde_json::Value;
use soffio_exhibit::schema::schema;
use soffio_exhibit::schema::validate::KEYWORDS;

#[test]
fn all_keywords_of_the_format_are_known() {
    fn look(schema: &Value, seen: &mut BTreeSet<String>) {
        for (keyword, checked) in schema.as_object().into_iter().flatten() {
            seen.insert(keyword.clone());
            match keyword.as_str() {
                "properties" | "patternProperties" | "$defs" => {
                    checked.as_object().into_iter().flatten().for_each(|(_, part)| look(part, seen));
                }
                "anyOf" | "oneOf" | "prefixItems" => {
                    checked.as_array().into_iter().flatten().for_each(|part| look(part, seen))
                }
                "items" | "additionalProperties" => look(checked, seen),
                _ => {}
            }
        }
    }
    let mut seen = BTreeSet::new();
    look(&schema(), &mut seen);
    let unknown: Vec<&String> = seen.iter().filter(|keyword| !KEYWORDS.contains(&keyword.as_str())).collect();
    assert!(unknown.is_empty() && seen.contains("pattern"), "{unknown:?}");
}
