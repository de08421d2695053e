//! Arithmetic between dollar signs: `+ - * /`, parentheses, numbers and variables, in 32 bits.

use std::{fmt, rc::Rc};

use crate::elements::value::finite_or_huge;

/// Largest depth of nested parentheses.
const MAX_DEPTH: usize = 100;

/// The error of a text that is no arithmetic.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ArithmeticError {
    /// Its syntax is wrong.
    Malformed,
    /// There is no variable of this name.
    Unknown(String),
    /// A variable holds a text that is not a number.
    NotANumber {
        /// The variable.
        name: String,
        /// Its text.
        text: Rc<str>,
    },
    /// The result is not a finite number.
    Infinite,
}

/// The result of an expression, in which names stand for the texts that `variable` gives for them. Text after a complete expression is
/// ignored, as in the later program.
pub(crate) fn evaluate(
    expression: &str,
    variable: impl FnMut(&str) -> Option<Rc<str>>,
) -> Result<f32, ArithmeticError> {
    let mut parser = Parser {
        rest: expression,
        depth: 0,
        variable,
    };
    let result = parser.sum()?;
    match result.is_finite() {
        true => Ok(result),
        false => Err(ArithmeticError::Infinite),
    }
}

struct Parser<'e, V> {
    rest: &'e str,
    depth: usize,
    variable: V,
}

impl<V: FnMut(&str) -> Option<Rc<str>>> Parser<'_, V> {
    fn sum(&mut self) -> Result<f32, ArithmeticError> {
        let mut sum = self.product()?;
        loop {
            sum = match self.next_of(&['+', '-']) {
                Some('+') => sum + self.product()?,
                Some(_) => sum - self.product()?,
                None => return Ok(sum),
            };
        }
    }

    fn product(&mut self) -> Result<f32, ArithmeticError> {
        let mut product = self.operand()?;
        loop {
            product = match self.next_of(&['*', '/']) {
                Some('*') => product * self.operand()?,
                Some(_) => product / self.operand()?,
                None => return Ok(product),
            };
        }
    }

    /// A number, a variable or parentheses, perhaps with a sign directly before it.
    fn operand(&mut self) -> Result<f32, ArithmeticError> {
        let sign = match self.next_of(&['+', '-']) {
            Some('-') => -1.0,
            Some(_) => 1.0,
            None => {
                self.skip_blanks();
                1.0
            }
        };
        if let Some(rest) = self.rest.strip_prefix('(') {
            self.rest = rest;
            return Ok(sign * self.parentheses()?);
        }
        let is_of_token = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.');
        let end = self.rest.find(|c| !is_of_token(c));
        let (token, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        self.rest = rest;
        Ok(sign * self.value(token)?)
    }

    fn parentheses(&mut self) -> Result<f32, ArithmeticError> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(ArithmeticError::Malformed);
        }
        let inner = self.sum()?;
        self.depth -= 1;
        match self.next_of(&[')']) {
            Some(_) => Ok(inner),
            None => Err(ArithmeticError::Malformed),
        }
    }

    fn value(&mut self, token: &str) -> Result<f32, ArithmeticError> {
        if token.is_empty() {
            return Err(ArithmeticError::Malformed);
        }
        if let Some(number) = finite_or_huge(token) {
            return Ok(number);
        }
        let name = || token.to_owned();
        let text = (self.variable)(token).ok_or_else(|| ArithmeticError::Unknown(name()))?;
        finite_or_huge(&text).ok_or_else(|| ArithmeticError::NotANumber { name: name(), text })
    }

    /// Takes one of these marks, if it comes next.
    fn next_of(&mut self, marks: &[char]) -> Option<char> {
        let rest = self.rest.trim_start_matches([' ', '\t']);
        let next = rest.chars().next().filter(|next| marks.contains(next))?;
        self.rest = &rest[next.len_utf8()..];
        Some(next)
    }

    fn skip_blanks(&mut self) {
        self.rest = self.rest.trim_start_matches([' ', '\t']);
    }
}

/// A result as the later program writes it: without a fraction if it is within 10⁻⁶ of a whole number, small ones with an exponent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Result32(pub f32);

impl fmt::Display for Result32 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let whole = self.0.round();
        if (self.0 - whole).abs() < 1e-6 {
            // Never `-0`.
            return write!(f, "{}", whole + 0.0);
        }
        if self.0.abs() >= 1e-3 {
            return write!(f, "{}", self.0);
        }
        let scientific = format!("{:e}", self.0);
        match scientific.split_once('e') {
            Some((digits, exponent)) if !digits.contains('.') => write!(f, "{digits}.0E{exponent}"),
            _ => f.write_str(&scientific.replace('e', "E")),
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn variable(name: &str) -> Option<Rc<str>> {
        let text = match name {
            "a" => "3",
            "half" => " 0.5 ",
            "my.var_2" => "2e1",
            "1e1" => "7",
            "color" => "red",
            _ => return None,
        };
        Some(text.into())
    }

    fn result(expression: &str) -> Result<f32, ArithmeticError> {
        evaluate(expression, variable)
    }

    #[test]
    fn expressions_have_their_usual_values() {
        for (expression, value) in [
            ("1+2*3", 7.0),
            ("(1+2)*3", 9.0),
            ("7-2-1", 4.0),
            ("8/2/2", 2.0),
            (" \t2 - 3 ", -1.0),
            ("2*-3", -6.0),
            ("2--3", 5.0),
            ("+a", 3.0),
            ("-a*half", -1.5),
            ("-(a+1)", -4.0),
            ("my.var_2/4", 5.0),
            (".5+1.", 1.5),
            ("((((a))))", 3.0),
        ] {
            assert_eq!(result(expression), Ok(value), "{expression}");
        }
    }

    #[test]
    fn a_number_with_an_exponent_is_no_variable() {
        assert_eq!(result("1e1"), Ok(10.0));
    }

    #[test]
    fn numbers_have_32_bits() {
        assert_eq!(result("1/3"), Ok(1.0_f32 / 3.0));
        assert_eq!(result("16777216+1"), Ok(16_777_216.0));
    }

    #[test]
    fn text_after_an_expression_is_ignored() {
        for expression in ["2 x", "2)", "2 3", "2,color", "2é"] {
            assert_eq!(result(expression), Ok(2.0), "{expression}");
        }
    }

    #[test]
    fn malformed_arithmetic_gives_the_reason() {
        for expression in [
            "", " ", "2+", "2+ *3", "- 3", "2*- 3", "---3", "(2", "()", "é",
        ] {
            assert_eq!(
                result(expression),
                Err(ArithmeticError::Malformed),
                "{expression}"
            );
        }
        let deep = "(".repeat(100_000);
        assert_eq!(result(&deep), Err(ArithmeticError::Malformed));
        assert_eq!(result("b+1"), Err(ArithmeticError::Unknown("b".into())));
        let not_a_number = ArithmeticError::NotANumber {
            name: "color".into(),
            text: "red".into(),
        };
        assert_eq!(result("color"), Err(not_a_number));
        for expression in ["1/0", "0/0", "1e30*1e30", "1e999"] {
            assert_eq!(
                result(expression),
                Err(ArithmeticError::Infinite),
                "{expression}"
            );
        }
    }

    #[test]
    fn results_are_written_as_the_later_program_does() {
        for (result, text) in [
            (2.0, "2"),
            (-0.0, "0"),
            (-1e-7, "0"),
            (2.000_000_4, "2"),
            (1.0 / 3.0, "0.33333334"),
            (0.000_25, "2.5E-4"),
            (-0.000_5, "-5.0E-4"),
            (0.001, "0.001"),
            (-2.5, "-2.5"),
            (1e7, "10000000"),
            (1e30, "1000000000000000000000000000000"),
        ] {
            assert_eq!(Result32(result).to_string(), text);
        }
    }

    proptest! {
        #[test]
        fn any_text_is_evaluated(expression in "[-+*/() a-c0-9.é\t]{0,40}") {
            let _result = result(&expression);
        }

        #[test]
        fn results_read_back(number in -1e6_f32..1e6) {
            let text = Result32(number).to_string();
            let read: f32 = text.parse().unwrap();
            prop_assert!(read == number || (read - number).abs() < 1e-6, "{}", text);
        }
    }
}
