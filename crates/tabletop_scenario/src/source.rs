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

    pub(crate) fn of_offset(path: &Path, text: &str, offset: usize) -> Self {
        let before = text.get(..offset).unwrap_or(text);
        let start_of_line = before.rfind('\n').map_or(0, |newline| newline + 1);
        Self {
            path: path.to_owned(),
            line: 1 + before.matches('\n').count(),
            column: 1 + before[start_of_line..].chars().count(),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_from_one_in_characters() {
        let path = Path::new("a.ron");
        let text = "ä\nöüx";
        let x = SourceLocation::of_offset(path, text, text.find('x').unwrap_or(0));
        assert_eq!(x.to_string(), "a.ron:2:3");
        let same_line = x.followed_by(Position { line: 1, col: 4 });
        assert_eq!((same_line.line, same_line.column), (2, 6));
        let next_line = x.followed_by(Position { line: 2, col: 4 });
        assert_eq!((next_line.line, next_line.column), (3, 4));
    }
}
