//! Faults of RON files, in the words of those who write them.

use ron::{Error, error::SpannedError};

use crate::misspelling::nearest_name;

/// What is wrong, and what was expected, without the names of the program's own types.
///
/// ```
/// use serde::Deserialize;
/// use tabletop_core::ron_fault;
///
/// #[derive(Debug, Deserialize)]
/// enum Way { Left, Right }
///
/// let error = ron::from_str::<Way>("Rigth").unwrap_err();
/// assert_eq!(ron_fault(&error.code), "there is no Rigth; did you mean Right?");
/// # let _used = [Way::Left, Way::Right];
/// ```
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "the enum is foreign, and the rest of it speaks for itself"
)]
pub fn ron_fault(fault: &Error) -> String {
    match fault {
        Error::NoSuchEnumVariant {
            expected, found, ..
        } => unknown(found, "no", expected),
        Error::NoSuchStructField {
            expected, found, ..
        } => unknown(found, "no field", expected),
        Error::MissingStructField { field, outer } => match outer {
            Some(outer) => format!("{outer} lacks its {field}"),
            None => format!("the {field} is missing"),
        },
        Error::DuplicateStructField { field, .. } => format!("the {field} is given twice"),
        Error::ExpectedFloat => "expected a number".into(),
        Error::ExpectedInteger => "expected a whole number".into(),
        Error::IntegerOutOfBounds => "the number is too large or too small".into(),
        Error::ExpectedString => "expected a text in quotes".into(),
        Error::ExpectedBoolean => "expected true or false".into(),
        Error::ExpectedArray => "expected a list, which begins with [".into(),
        Error::ExpectedMap => "expected pairs in braces, which begin with {".into(),
        Error::ExpectedStructLike | Error::ExpectedNamedStructLike(_) => {
            "expected ( and what belongs to it".into()
        }
        Error::ExpectedStructLikeEnd => "expected ) and nothing more before it".into(),
        Error::ExpectedArrayEnd => "expected ] and nothing more before it".into(),
        Error::ExpectedComma => "expected a comma, or the end of the list".into(),
        Error::ExpectedStringEnd => "the text has no closing quote".into(),
        Error::ExpectedMapColon => "expected a colon and a value".into(),
        Error::ExpectedIdentifier => "expected a name".into(),
        Error::Eof => "the file ends too early".into(),
        Error::TrailingCharacters => "there is more after the end".into(),
        Error::ExceededRecursionLimit => "it is nested too deeply".into(),
        Error::ExpectedDifferentLength { expected, found } => match numbers_in(expected) {
            Some(count) => format!("expected {count} values, found {found}"),
            None => format!("expected {expected}, found {found} values"),
        },
        Error::InvalidValueForType { expected, found } => {
            format!("expected {expected}, found {found}")
        }
        other => other.to_string(),
    }
}

/// What is wrong with a text, with line and column, from 1.
pub fn located_ron_fault(error: &SpannedError) -> String {
    let start = &error.span.start;
    format!("{}:{}: {}", start.line, start.col, ron_fault(&error.code))
}

/// A name that nothing has.
fn unknown(found: &str, no: &str, expected: &[&str]) -> String {
    match (nearest_name(found, expected), expected) {
        (Some(near), _) => format!("there is {no} {found}; did you mean {near}?"),
        (None, []) => format!("there is {no} {found}, and none is expected"),
        (None, expected) => {
            let known = expected.join(", ");
            format!("there is {no} {found}; expected one of {known}")
        }
    }
}

/// The first number in a text.
fn numbers_in(text: &str) -> Option<&str> {
    let begin = text.find(|letter: char| letter.is_ascii_digit())?;
    let number = text[begin..].split(|letter: char| !letter.is_ascii_digit());
    number.into_iter().next()
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::*;

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Move {
        #[expect(dead_code, reason = "it is only read")]
        to: (f32, f32, f32),
        #[expect(dead_code, reason = "it is only read")]
        seconds: f32,
    }

    fn fault(text: &str) -> String {
        ron_fault(&ron::from_str::<Move>(text).unwrap_err().code)
    }

    #[test]
    fn faults_name_no_type_of_the_program() {
        for (text, said) in [
            ("(to: (1,2,3))", "Move lacks its seconds"),
            (
                "(to: (1,2,3), second: 1)",
                "there is no field second; did you mean seconds?",
            ),
            (
                "(to: (1,2,3), pace: 1)",
                "there is no field pace; expected one of to, seconds",
            ),
            ("(to: (1,2), seconds: 1)", "expected 3 values, found 2"),
            ("(to: (1,2,3), seconds: \"a\")", "expected a number"),
            ("(to: (1,2,3), to: (1,2,3))", "the to is given twice"),
            ("[1]", "expected ( and what belongs to it"),
        ] {
            assert_eq!(fault(text), said, "{text}");
        }
    }
}
