//! Chunks of actions.

use crate::{
    format_error::FormatError,
    value::{WireMap, WireValue},
};

/// The key of the actions in an answer.
const ACTIONS: &str = "actions";
/// The most actions of a chunk, and numbers of an action.
const MOST: usize = 1000;

/// The actions of an answer, one a row.
#[derive(Clone, Debug, PartialEq)]
pub struct ActionChunk {
    rows: Vec<Vec<f64>>,
}

impl ActionChunk {
    /// The first `horizon` actions of an answer, of so many numbers each. An answer with a single action may have one dimension.
    ///
    /// # Errors
    /// The answer has no such `actions`, too few of them, or numbers that are not finite.
    pub fn of(answer: &WireMap, columns: usize, horizon: usize) -> Result<Self, FormatError> {
        let at = |fault: String| FormatError::at(ACTIONS, fault);
        let expected = format!("expected {horizon} or more rows of {columns} numbers");
        let array = match answer.get(ACTIONS) {
            Some(WireValue::Array(array)) => array,
            Some(other) => return Err(at(format!("{}, {expected}", other.kind()))),
            None => {
                let keys: Vec<_> = answer.keys().take(10).map(String::as_str).collect();
                let keys = keys.join(", ");
                return Err(at(format!(
                    "the answer has none, only [{keys}]; {expected}"
                )));
            }
        };
        let (rows, width) = match *array.shape() {
            [rows, width] => (rows, width),
            [width] => (1, width),
            _ => (0, 0),
        };
        if width == 0 || width != columns || rows < horizon.max(1) || rows > MOST || columns > MOST
        {
            return Err(at(format!(
                "their shape is {:?}, {expected}",
                array.shape()
            )));
        }
        let numbers: Vec<f64> = array.numbers().collect();
        if let Some(place) = numbers.iter().position(|number| !number.is_finite()) {
            let (row, column) = (place / width + 1, place % width + 1);
            let number = numbers[place];
            return Err(at(format!("row {row}, column {column} is {number}")));
        }
        let rows = numbers.chunks(width).take(horizon.max(1));
        Ok(Self {
            rows: rows.map(<[f64]>::to_vec).collect(),
        })
    }

    /// The actions, each of as many numbers as were asked for.
    pub fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::array::NumpyArray;

    fn chunk(shape: &[usize], numbers: &[f32]) -> Result<ActionChunk, String> {
        let array = NumpyArray::of_floats(shape, numbers);
        let answer = WireMap::from([(ACTIONS.to_owned(), array.into())]);
        ActionChunk::of(&answer, 2, 2).map_err(|fault| fault.to_string())
    }

    #[test]
    fn the_first_rows_are_taken() {
        let all = chunk(&[3, 2], &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap();
        assert_eq!(all.rows(), [[1.0, 2.0], [3.0, 4.0]]);
    }

    #[test]
    fn lies_are_refused_with_their_place() {
        for (shape, fault) in [
            (
                &[2, 3][..],
                "actions: their shape is [2, 3], expected 2 or more rows of 2 numbers",
            ),
            (&[1, 2], "actions: their shape is [1, 2]"),
            (&[2, 2, 1], "actions: their shape is [2, 2, 1]"),
            (&[2, 0], "actions: their shape is [2, 0]"),
            (&[1001, 2], "actions: their shape is [1001, 2]"),
        ] {
            let refusal = chunk(shape, &[]).unwrap_err();
            assert!(refusal.starts_with(fault), "{refusal}");
        }
        let refusal = chunk(&[2, 2], &[0.0, 0.0, 0.0, f32::NAN]).unwrap_err();
        assert_eq!(refusal, "actions: row 2, column 2 is NaN");
        let answer = WireMap::from([("action".to_owned(), WireValue::Nil)]);
        let refusal = ActionChunk::of(&answer, 2, 2).unwrap_err().to_string();
        assert!(refusal.starts_with("actions: the answer has none, only [action]"));
    }
}
