//! Expressions between dollar signs, and texts that contain them.

use std::{borrow::Cow, rc::Rc};

use crate::{
    elements::value::trim,
    expansion::arithmetic::{self, ArithmeticError, Result32},
    fault::Excerpt,
};

/// The value of a variable.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Text(Rc<str>),
    /// It is unknown, and a fault has the reason.
    Faulty,
}

/// The reason why an expression has no value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ExpressionError {
    /// One of its variables has none, and a fault has the reason.
    Faulty,
    /// Its problem, and the expectation.
    Wrong { problem: String, expected: String },
}

/// The value of an expression: the result of its arithmetic or, if it is not arithmetic, the text of the variable that it names.
pub(crate) fn value_of(
    expression: &str,
    mut variable: impl FnMut(&str) -> Option<Value>,
) -> Result<Rc<str>, ExpressionError> {
    let mut has_faulty = false;
    let result = arithmetic::evaluate(expression, |name| match variable(name)? {
        Value::Text(text) => Some(text),
        Value::Faulty => {
            has_faulty = true;
            None
        }
    });
    let error = match result {
        Ok(number) => return Ok(Result32(number).to_string().into()),
        Err(_) if has_faulty => return Err(ExpressionError::Faulty),
        Err(error) => error,
    };
    match variable(trim(expression)) {
        Some(Value::Text(text)) => Ok(text),
        Some(Value::Faulty) => Err(ExpressionError::Faulty),
        None => Err(wrong(expression, &error)),
    }
}

fn wrong(expression: &str, error: &ArithmeticError) -> ExpressionError {
    let whole = Excerpt(expression);
    let (problem, expected) = match error {
        ArithmeticError::Malformed => (
            format!("`${whole}$` is no expression"),
            "a variable, or numbers and variables with + - * / ( )".to_owned(),
        ),
        ArithmeticError::Unknown(name) => (
            format!("`{}` in `${whole}$` is no variable", Excerpt(name)),
            "a <var> of this name".to_owned(),
        ),
        ArithmeticError::NotANumber { name, text } => (
            format!(
                "`{}` in `${whole}$` is `{}`, which is not a number",
                Excerpt(name),
                Excerpt(text)
            ),
            "a number".to_owned(),
        ),
        ArithmeticError::Infinite => (
            format!("the result of `${whole}$` is beyond every number"),
            "a result that is a number".to_owned(),
        ),
    };
    ExpressionError::Wrong { problem, expected }
}

/// A text in which each `$expression$` is replaced with its value, and `$$` with a dollar sign. A dollar sign that has no partner stays.
pub(crate) fn substitute<'a>(
    text: &Cow<'a, str>,
    mut value: impl FnMut(&str) -> Result<Rc<str>, ExpressionError>,
) -> Result<Cow<'a, str>, ExpressionError> {
    let mut rest = text.as_ref();
    let mut substituted = String::new();
    while let Some((before, expression, after)) = next_expression(rest) {
        substituted.push_str(before);
        match expression {
            "" => substituted.push('$'),
            _ => substituted.push_str(&value(expression)?),
        }
        rest = after;
    }
    if rest.len() == text.len() {
        return Ok(text.clone());
    }
    substituted.push_str(rest);
    Ok(Cow::Owned(substituted))
}

/// The parts of a text before, in and after its first expression.
fn next_expression(text: &str) -> Option<(&str, &str, &str)> {
    let (before, rest) = text.split_once('$')?;
    let (expression, after) = rest.split_once('$')?;
    Some((before, expression, after))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn variable(name: &str) -> Option<Value> {
        let text = match name {
            "a" => "3",
            "quarter" => "2.50",
            "seven" => "007",
            "color" => "red",
            "place" => "(1,2,3)",
            "my-name" => "x",
            "empty" => "",
            "faulty" => return Some(Value::Faulty),
            _ => return None,
        };
        Some(Value::Text(text.into()))
    }

    fn substituted(text: &str) -> Result<String, ExpressionError> {
        substitute(&text.into(), |expression| value_of(expression, variable)).map(Cow::into_owned)
    }

    #[test]
    fn texts_are_literal_outside_of_the_dollars() {
        for (text, value) in [
            ("", ""),
            ("no dollar", "no dollar"),
            ("costs 5$", "costs 5$"),
            ("($1+2*3$,0,1)", "(7,0,1)"),
            ("(-$a/3$,$-a$,+$a$)", "(-1,-3,+3)"),
            ("$a$$a$", "33"),
            ("$a$ $", "3 $"),
            ("$$", "$"),
            ("$$a$$ $$$a$$", "$a$ $3$"),
        ] {
            assert_eq!(substituted(text).as_deref(), Ok(value), "{text}");
        }
    }

    #[test]
    fn a_name_without_arithmetic_is_the_text_of_its_variable() {
        for (text, value) in [
            ("$color$", "red"),
            ("$ color $", "red"),
            ("$place$", "(1,2,3)"),
            ("$my-name$", "x"),
            ("id_$empty$", "id_"),
        ] {
            assert_eq!(substituted(text).as_deref(), Ok(value), "{text}");
        }
    }

    #[test]
    fn a_text_that_reads_as_a_number_is_one() {
        assert_eq!(substituted("$quarter$").as_deref(), Ok("2.5"));
        assert_eq!(substituted("block$seven$").as_deref(), Ok("block7"));
    }

    #[test]
    fn expressions_without_a_value_give_the_reason() {
        for (text, expected) in [
            ("$ $", "`$ $` is no expression"),
            ("$2+$", "`$2+$` is no expression"),
            ("$heigth/2$", "`heigth` in `$heigth/2$` is no variable"),
            (
                "$color+1$",
                "`color` in `$color+1$` is `red`, which is not a number",
            ),
            ("$1/0$", "the result of `$1/0$` is beyond every number"),
        ] {
            match substituted(text) {
                Err(ExpressionError::Wrong { problem, .. }) => assert_eq!(problem, expected),
                other => panic!("{text}: {other:?}"),
            }
        }
        for text in ["$faulty$", "$faulty+1$", "$1+faulty$"] {
            assert_eq!(substituted(text), Err(ExpressionError::Faulty), "{text}");
        }
    }

    proptest! {
        #[test]
        fn any_text_is_substituted(text in "[$a-c+*/()0-9. é-]{0,40}") {
            if let Ok(value) = substituted(&text) {
                prop_assert!(text.matches('$').count() > 1 || value == text);
            }
        }
    }
}
