//! Places in a scenario file.

use std::{
    fmt,
    path::{Path, PathBuf},
};

use ron::error::Position;

/// A place in a file, displayed as `file:line:column`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceLocation {
    /// The file.
    pub path: PathBuf,
    /// The line, from 1.
    pub line: usize,
    /// The column in characters, from 1.
    pub column: usize,
}

impl SourceLocation {
    pub(crate) fn start_of(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            line: 1,
            column: 1,
        }
    }

    /// The place that a position in the text that begins here means.
    pub(crate) fn followed_by(&self, position: Position) -> Self {
        let column = match position.line {
            1 => self.column + position.col - 1,
            _ => position.col,
        };
        Self {
            path: self.path.clone(),
            line: self.line + position.line - 1,
            column,
        }
    }
}

impl fmt::Display for SourceLocation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.path.display(), self.line, self.column)
    }
}

/// Finds places in a text, fast if each comes after the one before.
#[derive(Debug)]
pub(crate) struct Places<'a> {
    text: &'a str,
    offset: usize,
    /// The place of that offset.
    at: SourceLocation,
}

impl<'a> Places<'a> {
    pub(crate) fn of(path: &Path, text: &'a str) -> Self {
        Self {
            text,
            offset: 0,
            at: SourceLocation::start_of(path),
        }
    }

    pub(crate) fn find(&mut self, offset: usize) -> SourceLocation {
        if offset < self.offset {
            *self = Self::of(&self.at.path, self.text);
        }
        let between = self.text.get(self.offset..offset).unwrap_or_default();
        for character in between.chars() {
            (self.at.line, self.at.column) = match character {
                '\n' => (self.at.line + 1, 1),
                _ => (self.at.line, self.at.column + 1),
            };
        }
        self.offset = offset;
        self.at.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_from_one_in_characters() {
        let path = Path::new("a.ron");
        let text = "ä\nöüx";
        let mut places = Places::of(path, text);
        let x = places.find(text.find('x').unwrap_or(0));
        assert_eq!(x.to_string(), "a.ron:2:3");
        assert_eq!(places.find(0).to_string(), "a.ron:1:1");
        let same_line = x.followed_by(Position { line: 1, col: 4 });
        assert_eq!((same_line.line, same_line.column), (2, 6));
        let next_line = x.followed_by(Position { line: 2, col: 4 });
        assert_eq!((next_line.line, next_line.column), (3, 4));
    }
}
