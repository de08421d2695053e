//! Values of attributes, read from their texts.

use std::{fmt, ops::RangeInclusive, str::FromStr};

use bevy::math::{DVec3, Vec3};
use tabletop_core::limits::MOST_LINKS;
use tabletop_geometry::{NAMED_COLORS, Rgb};

use crate::{document::syntax::is_blank, fault::Excerpt};

pub(crate) use tabletop_core::limits::{
    DISPLACEMENTS, MASSES, PADDINGS, PRESSING_FORCES, PROPORTIONS, SPANS, SWITCH_ANGLES, TRAVELS,
};

/// Components of locations, in units.
pub(crate) const LOCATIONS: RangeInclusive<f32> = -10_000.0..=10_000.0;
/// Components of rotations, in degrees.
pub(crate) const ROTATIONS: RangeInclusive<f64> = -1e6..=1e6;
/// Numbers of links.
pub(crate) const LINK_COUNTS: RangeInclusive<u32> = 0..=MOST_LINKS;
/// Largest length of an id.
const MAX_ID: usize = 200;
/// Angles of joints, in degrees.
pub(crate) const ANGLES: RangeInclusive<f32> = -180.0..=180.0;
/// Numbers of lights.
pub(crate) const LIGHTS: RangeInclusive<u32> = 0..=999;
/// Numbers of states and of steps.
pub(crate) const STATES: RangeInclusive<u32> = 0..=999;
/// States of push buttons that are pressed.
pub(crate) const PRESSED_STATES: RangeInclusive<u32> = 1..=999;
/// Numbers of sides.
pub(crate) const FRICTIONS: RangeInclusive<f32> = 0.0..=1000.0;
pub(crate) const VELOCITIES: RangeInclusive<f32> = -1000.0..=1000.0;
pub(crate) const SIDES: RangeInclusive<u32> = 3..=1_000_000;

/// The error of a text that is not a value.
#[derive(Debug, PartialEq)]
pub(crate) struct ValueError {
    pub problem: String,
    pub expected: String,
}

impl ValueError {
    pub fn new(text: &str, problem: impl fmt::Display, expected: impl fmt::Display) -> Self {
        Self {
            problem: format!("`{}` {problem}", Excerpt(text)),
            expected: expected.to_string(),
        }
    }
}

/// Reads a decimal number, with or without fraction and exponent.
pub(crate) fn number(text: &str, range: &RangeInclusive<f32>) -> Result<f32, ValueError> {
    let expected = || format!("a number from {} to {}", range.start(), range.end());
    let Some(number) = finite_or_huge(text) else {
        return Err(ValueError::new(text, "is not a number", expected()));
    };
    match range.contains(&number) {
        true => Ok(number),
        false => Err(ValueError::new(text, "is out of range", expected())),
    }
}

/// Reads a vector `(x,y,z)`, with blanks anywhere between its numbers and marks.
pub(crate) fn vector(text: &str, range: &RangeInclusive<f32>) -> Result<Vec3, ValueError> {
    triple(text, range).map(Vec3::from)
}

/// Reads angles `(x,y,z)`. All their digits count, so that the rotation of a saved object reads back to the bit.
pub(crate) fn angles(text: &str, range: &RangeInclusive<f64>) -> Result<DVec3, ValueError> {
    triple(text, range).map(DVec3::from)
}

fn triple<T: FromStr + PartialOrd + fmt::Display>(
    text: &str,
    range: &RangeInclusive<T>,
) -> Result<[T; 3], ValueError> {
    let expected = || {
        let (least, most) = (range.start(), range.end());
        format!("(x,y,z) with numbers from {least} to {most}")
    };
    let Some(triple) = bare_triple(text) else {
        return Err(ValueError::new(text, "is not a vector", expected()));
    };
    match triple.iter().all(|part| range.contains(part)) {
        true => Ok(triple),
        false => Err(ValueError::new(text, "is out of range", expected())),
    }
}

/// Reads a whole number.
pub(crate) fn count(text: &str, range: &RangeInclusive<u32>) -> Result<u32, ValueError> {
    let expected = || format!("a whole number from {} to {}", range.start(), range.end());
    let digits = trim(text);
    let unsigned = digits.strip_prefix(['+', '-']).unwrap_or(digits);
    if unsigned.is_empty() || !unsigned.bytes().all(|digit| digit.is_ascii_digit()) {
        return Err(ValueError::new(text, "is not a whole number", expected()));
    }
    digits
        .parse::<i64>()
        .ok()
        .and_then(|count| u32::try_from(count).ok())
        .filter(|count| range.contains(count))
        .ok_or_else(|| ValueError::new(text, "is out of range", expected()))
}

/// Reads the number of a state; `None` for -1.
pub(crate) fn next_state(text: &str) -> Result<Option<u32>, ValueError> {
    match trim(text) {
        "-1" => Ok(None),
        _ => count(text, &STATES).map(Some).map_err(|error| ValueError {
            expected: "-1 or the number of a state".to_owned(),
            ..error
        }),
    }
}

/// Reads a colour: a name or `#rrggbb`.
pub(crate) fn color(text: &str) -> Result<Rgb, ValueError> {
    text.parse().map_err(|_| {
        let names = NAMED_COLORS.map(|(name, _)| name).join(", ");
        ValueError::new(
            text,
            "is not a colour",
            format!("#rrggbb or one of {names}"),
        )
    })
}

/// Reads an id, which may be empty.
pub(crate) fn id(text: &str) -> Result<String, ValueError> {
    let id = trim(text);
    if id.len() > MAX_ID {
        let expected = format_args!("at most {MAX_ID} characters");
        return Err(ValueError::new(text, "is too long", expected));
    }
    match id.chars().all(is_id_character) {
        true => Ok(id.to_owned()),
        false => Err(ValueError::new(
            text,
            "is not an id",
            "letters a to z and A to Z, digits and underscores",
        )),
    }
}

/// Reads a name: an id that is not empty.
pub(crate) fn name(text: &str) -> Result<String, ValueError> {
    let name = id(text)?;
    match name.is_empty() {
        true => Err(ValueError::new(text, "is empty", "a name")),
        false => Ok(name),
    }
}

/// True if ids may hold the character.
pub(crate) fn is_id_character(character: char) -> bool {
    character == '_' || character.is_ascii_alphanumeric()
}

/// Reads a truth value.
pub(crate) fn boolean(text: &str) -> Result<bool, ValueError> {
    match trim(text) {
        "true" | "1" => Ok(true),
        "false" | "0" => Ok(false),
        _ => Err(ValueError::new(
            text,
            "is not a truth value",
            "true, false, 1 or 0",
        )),
    }
}

/// Removes XML's blanks from both ends.
pub(crate) fn trim(text: &str) -> &str {
    text.trim_matches(is_blank)
}

fn bare_triple<T: FromStr>(text: &str) -> Option<[T; 3]> {
    let inner = trim(text).strip_prefix('(')?.strip_suffix(')')?;
    let mut parts = inner.split(',').map(finite_or_huge);
    let triple = [parts.next()??, parts.next()??, parts.next()??];
    parts.next().is_none().then_some(triple)
}

/// A decimal number; infinite if it is too large for its type, which is out of every range.
pub(crate) fn finite_or_huge<T: FromStr>(text: &str) -> Option<T> {
    let number = trim(text);
    let is_decimal = |byte: u8| byte.is_ascii_digit() || b"+-.eE".contains(&byte);
    match number.bytes().all(is_decimal) {
        true => number.parse().ok(),
        false => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_decimal_and_in_range() {
        for (text, value) in [
            ("1", 1.0),
            (" 2.50\n", 2.5),
            (".5", 0.5),
            ("1.", 1.0),
            ("+3e-1", 0.3),
            ("0.001", 0.001),
            ("1E3", 1000.0),
        ] {
            assert_eq!(number(text, &SPANS), Ok(value), "{text}");
        }
        for (text, problem) in [
            ("", "is not a number"),
            ("1 2", "is not a number"),
            ("0x10", "is not a number"),
            ("NaN", "is not a number"),
            ("inf", "is not a number"),
            ("-infinity", "is not a number"),
            ("1,5", "is not a number"),
            ("٣", "is not a number"),
            ("e", "is not a number"),
            ("1e999", "is out of range"),
            ("-1e999", "is out of range"),
            ("0", "is out of range"),
            ("1000.1", "is out of range"),
        ] {
            let error = number(text, &SPANS).unwrap_err();
            assert_eq!(error.problem, format!("`{text}` {problem}"));
            assert_eq!(error.expected, "a number from 0.001 to 1000");
        }
    }

    #[test]
    fn vectors_have_three_numbers_in_parentheses() {
        for text in ["(1,-2,.5)", " ( 1 , -2 , .5 ) ", "(1.0,\n-2e0,+0.5)"] {
            assert_eq!(vector(text, &LOCATIONS), Ok(Vec3::new(1.0, -2.0, 0.5)));
        }
        for text in [
            "1,2,3",
            "(1,2)",
            "(1,2,3,4)",
            "(1,2,x)",
            "()",
            "(",
            "(1,2,NaN)",
            "(1;2;3)",
        ] {
            let error = vector(text, &LOCATIONS).unwrap_err();
            assert_eq!(error.problem, format!("`{text}` is not a vector"));
        }
        let error = vector("(0,0,1e5)", &LOCATIONS).unwrap_err();
        assert_eq!(error.problem, "`(0,0,1e5)` is out of range");
        assert_eq!(error.expected, "(x,y,z) with numbers from -10000 to 10000");
    }

    #[test]
    fn counts_are_whole() {
        assert_eq!(count(" +12 ", &LINK_COUNTS), Ok(12));
        assert_eq!(count("-0", &LINK_COUNTS), Ok(0));
        for text in ["1.0", "", "-", "1e2", "+-1", "NaN"] {
            let error = count(text, &LINK_COUNTS).unwrap_err();
            assert_eq!(error.problem, format!("`{text}` is not a whole number"));
        }
        for text in ["-1", "1001", "99999999999999999999999"] {
            assert!(
                count(text, &LINK_COUNTS)
                    .unwrap_err()
                    .problem
                    .ends_with("is out of range")
            );
        }
    }

    #[test]
    fn ids_and_truth_values() {
        assert_eq!(id(" a_1 "), Ok("a_1".into()));
        assert_eq!(id(""), Ok(String::new()));
        for text in ["a b", "a-b", "a#0", "é"] {
            assert!(id(text).is_err(), "{text}");
        }
        assert!(name("  ").is_err());
        assert_eq!([boolean("1"), boolean(" false ")], [Ok(true), Ok(false)]);
        assert!(boolean("True").is_err());
    }
}
