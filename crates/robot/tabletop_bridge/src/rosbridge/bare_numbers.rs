//! JSON as rosbridge writes it: numbers that are not finite stand there bare, as `NaN`, `Infinity` or `-Infinity`, which JSON has not.

use serde_json::Value as Json;

const BARE: [&str; 3] = ["NaN", "-Infinity", "Infinity"];

/// The value in a text, with null for numbers that are not finite; none if it makes no sense.
pub(super) fn read_json(text: &str) -> Option<Json> {
    serde_json::from_str(text)
        .or_else(|_| serde_json::from_str(&with_nulls(text)))
        .ok()
}

/// The text with `null` in the place of each bare number, but within strings.
fn with_nulls(text: &str) -> String {
    let mut changed = String::with_capacity(text.len());
    let mut rest = text;
    let mut is_in_string = false;
    while let Some(letter) = rest.chars().next() {
        let bare = BARE
            .iter()
            .find(|bare| !is_in_string && rest.starts_with(**bare));
        let length = match (bare, letter) {
            (Some(bare), _) => {
                changed.push_str("null");
                rest = &rest[bare.len()..];
                continue;
            }
            // What is escaped does not end the string.
            (None, '\\') => 1 + rest[1..].chars().next().map_or(0, char::len_utf8),
            (None, letter) => {
                is_in_string ^= letter == '"';
                letter.len_utf8()
            }
        };
        changed.push_str(&rest[..length]);
        rest = &rest[length..];
    }
    changed
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use serde_json::json;

    use super::*;

    #[test]
    fn bare_numbers_are_nulls_and_strings_stay() {
        let text = r#"{"position": [0.5, NaN, -Infinity, Infinity], "name": ["NaN", "a \"NaN\\", "\\"], "x": NaN}"#;
        let read = read_json(text).unwrap();
        assert_eq!(read["position"], json!([0.5, null, null, null]));
        assert_eq!(read["name"], json!(["NaN", "a \"NaN\\", "\\"]));
        assert_eq!(read["x"], Json::Null);
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_none(text in "[NaInfty\"\\\\\\[\\],{}:é-]{0,40}") {
            let _ = read_json(&text);
        }
    }
}
