//! The part of JSON Schema that the schema of programs uses.

use serde_json::{Map, Value};
use tabletop_program::SCHEMA;

/// The reason why a value does not fit the schema of programs.
pub fn fault(value: &Value) -> Option<String> {
    let schema: Value = serde_json::from_str(SCHEMA).unwrap();
    fault_in(value, &schema, &schema)
}

fn fault_in(value: &Value, rule: &Value, schema: &Value) -> Option<String> {
    let rule = rule.as_object().unwrap();
    let wrong = |what: &str| Some(format!("{what}: {value}"));
    for (keyword, expected) in rule {
        let fault = match keyword.as_str() {
            "$ref" => {
                let name = expected.as_str().unwrap().strip_prefix("#/$defs/").unwrap();
                fault_in(value, &schema["$defs"][name], schema)
            }
            "oneOf" => {
                let rules = expected.as_array().unwrap().iter();
                let fitting = rules.filter(|rule| fault_in(value, rule, schema).is_none());
                if fitting.count() == 1 {
                    None
                } else {
                    wrong("not one of them")
                }
            }
            "const" => {
                if value == expected {
                    None
                } else {
                    wrong("another constant")
                }
            }
            "enum" => {
                if expected.as_array().unwrap().contains(value) {
                    None
                } else {
                    wrong("unknown")
                }
            }
            "type" => {
                if is_of(value, expected.as_str().unwrap()) {
                    None
                } else {
                    wrong("another type")
                }
            }
            "minimum" => {
                if value
                    .as_i64()
                    .is_none_or(|it| it >= expected.as_i64().unwrap())
                {
                    None
                } else {
                    wrong("too small")
                }
            }
            "maximum" => {
                if value
                    .as_i64()
                    .is_none_or(|it| it <= expected.as_i64().unwrap())
                {
                    None
                } else {
                    wrong("too large")
                }
            }
            "minLength" => {
                if value.as_str() == Some("") {
                    wrong("empty")
                } else {
                    None
                }
            }
            "minItems" => {
                let least = expected.as_u64().unwrap() as usize;
                if value.as_array().is_none_or(|all| all.len() >= least) {
                    None
                } else {
                    wrong("too few")
                }
            }
            "items" => value
                .as_array()
                .into_iter()
                .flatten()
                .find_map(|item| fault_in(item, expected, schema)),
            "properties" => of_properties(value, expected.as_object().unwrap(), schema),
            "required" => {
                let mut names = expected.as_array().unwrap().iter();
                if names.all(|name| value.get(name.as_str().unwrap()).is_some()) {
                    None
                } else {
                    wrong("incomplete")
                }
            }
            // Patterns only hint at what the reader refuses anyway.
            "pattern" | "description" | "title" | "$schema" | "$defs" | "additionalProperties" => {
                None
            }
            keyword => panic!("{keyword}"),
        };
        if fault.is_some() {
            return fault;
        }
    }
    None
}

fn of_properties(value: &Value, known: &Map<String, Value>, schema: &Value) -> Option<String> {
    let Some(value) = value.as_object() else {
        return Some(format!("no object: {value}"));
    };
    value
        .iter()
        .find_map(|(name, value)| match known.get(name) {
            Some(rule) => fault_in(value, rule, schema),
            None => Some(format!("unknown: {name}")),
        })
}

fn is_of(value: &Value, kind: &str) -> bool {
    match kind {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_u64() || value.is_i64(),
        "number" => value.is_number(),
        kind => panic!("{kind}"),
    }
}
