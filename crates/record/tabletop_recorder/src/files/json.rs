//! JSON of a stated depth.

use serde::{Deserialize, Serialize};
use serde_json::error::Error;

/// The depth to which values may be nested: a composite in a composite takes four levels, and task files have a hundred of those.
const MOST_LEVELS: usize = 512;

/// Reads a value.
///
/// # Errors
/// It is no such value, or is nested deeper than recordings are.
pub(crate) fn from_json<'j, T: Deserialize<'j>>(json: &'j [u8]) -> Result<T, Error> {
    if JsonOutline::of(json).depth > MOST_LEVELS {
        let reason = format!("it is nested more than {MOST_LEVELS} levels deep");
        return Err(serde::de::Error::custom(reason));
    }
    let mut reader = serde_json::Deserializer::from_slice(json);
    reader.disable_recursion_limit();
    let value = T::deserialize(&mut reader)?;
    reader.end()?;
    Ok(value)
}

/// Room for most lines, in bytes.
const LINE: usize = 1024;

/// A line that holds a value.
pub(crate) fn to_json_line(value: &impl Serialize) -> Result<Vec<u8>, Error> {
    let mut line = Vec::with_capacity(LINE);
    serde_json::to_writer(&mut line, value)?;
    line.push(b'\n');
    Ok(line)
}

/// True if a value that was written reads back: it has no number that is none, which is written as `null`, and is not too deep.
pub(crate) fn reads_back(json: &[u8]) -> bool {
    let is_short = json.len() <= 2 * MOST_LEVELS;
    if is_short && str::from_utf8(json).is_ok_and(|text| !text.contains("null")) {
        return true;
    }
    let JsonOutline { depth, has_null } = JsonOutline::of(json);
    !has_null && depth <= MOST_LEVELS
}

/// The outline of a JSON text that has not been read.
#[derive(Debug, Default, PartialEq)]
struct JsonOutline {
    /// Largest depth of nested brackets.
    depth: usize,
    has_null: bool,
}

impl JsonOutline {
    fn of(json: &[u8]) -> Self {
        let (mut outline, mut depth) = (Self::default(), 0_usize);
        let (mut is_text, mut is_escaped) = (false, false);
        for &byte in json {
            match byte {
                _ if is_escaped => is_escaped = false,
                b'\\' if is_text => is_escaped = true,
                b'"' => is_text = !is_text,
                _ if is_text => {}
                b'[' | b'{' => {
                    depth += 1;
                    outline.depth = outline.depth.max(depth);
                }
                b']' | b'}' => depth = depth.saturating_sub(1),
                b'n' => outline.has_null = true,
                _ => {}
            }
        }
        outline
    }
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;

    #[test]
    fn values_are_read_up_to_a_depth() {
        let nested = |levels| "[".repeat(levels) + &"]".repeat(levels);
        assert!(from_json::<Value>(nested(MOST_LEVELS).as_bytes()).is_ok());
        for levels in [MOST_LEVELS + 1, 1_000_000] {
            let error = from_json::<Value>(nested(levels).as_bytes()).unwrap_err();
            assert!(
                error.to_string().contains("more than 512 levels"),
                "{error}"
            );
        }
        let text = r#"["[[[\"[[", {"a": [1]}]"#;
        let outline = JsonOutline::of(text.as_bytes());
        assert_eq!((outline.depth, outline.has_null), (3, false));
        assert!(from_json::<Value>(b"[] []").is_err());
    }

    #[test]
    fn nan_and_infinity_do_not_read_back() {
        for (value, reads) in [(1.5, true), (f64::NAN, false), (f64::INFINITY, false)] {
            let line = to_json_line(&("null, none", value)).unwrap();
            assert_eq!(reads_back(&line), reads, "{value}");
        }
    }
}
