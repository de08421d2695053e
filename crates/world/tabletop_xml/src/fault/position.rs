//! Places in files: byte offsets of a text as line and column.

use std::{fmt, path::PathBuf};

/// A place in a file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Position {
    /// The file.
    pub file: PathBuf,
    /// The line, from 1.
    pub line: usize,
    /// The column in characters, from 1.
    pub column: usize,
}

impl fmt::Display for Position {
    /// Writes `file:line:column`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.file.display(), self.line, self.column)
    }
}

/// Walks once through a text, from offset to offset, and counts lines and characters on the way.
pub(crate) struct PositionCursor<'a> {
    rest: &'a str,
    offset: usize,
    line: usize,
    column: usize,
    after_return: bool,
}

impl<'a> PositionCursor<'a> {
    pub fn new(text: &'a str) -> Self {
        Self {
            rest: text,
            offset: 0,
            line: 1,
            column: 1,
            after_return: false,
        }
    }

    /// Line and column, both from 1, of a byte offset that is not less than that of the call before.
    /// A line ends with a line feed, a carriage return or both; the column counts characters.
    pub fn advance_to(&mut self, offset: usize) -> (usize, usize) {
        let step = self
            .rest
            .floor_char_boundary(offset.saturating_sub(self.offset));
        let (passed, rest) = self.rest.split_at(step);
        for character in passed.chars() {
            match character {
                '\n' if self.after_return => {}
                '\n' | '\r' => {
                    self.line += 1;
                    self.column = 1;
                }
                _ => self.column += 1,
            }
            self.after_return = character == '\r';
        }
        self.rest = rest;
        self.offset += step;
        (self.line, self.column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_and_lines_end_in_three_ways() {
        let text = "aé\nb\r\ncd\re";
        let mut cursor = PositionCursor::new(text);
        for (part, place) in [
            ("a", (1, 1)),
            ("é", (1, 2)),
            ("b", (2, 1)),
            ("c", (3, 1)),
            ("d", (3, 2)),
            ("e", (4, 1)),
        ] {
            assert_eq!(cursor.advance_to(text.find(part).unwrap()), place, "{part}");
        }
    }

    #[test]
    fn an_offset_beyond_the_end_is_the_end() {
        assert_eq!(PositionCursor::new("ab\nc").advance_to(100), (2, 2));
        assert_eq!(PositionCursor::new("é").advance_to(1), (1, 1));
    }
}
