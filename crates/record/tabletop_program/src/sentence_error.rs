//! Faults of sentences.

use std::fmt::{self, Display, Formatter};

/// The fault of a text that is no program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SentenceError {
    /// The line, from 1.
    pub line: usize,
    /// The letter in its line, from 1.
    pub column: usize,
    /// The word that does not fit; `None` at the end.
    pub found: Option<String>,
    /// What fits there.
    pub expected: Vec<String>,
    /// The nearest text that is a program, if there is one near.
    pub nearest: Option<String>,
}

/// The most words that an error lists.
const MOST_LISTED: usize = 8;

impl Display for SentenceError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: ", self.line, self.column)?;
        match &self.found {
            Some(found) => write!(f, "`{found}` does not fit here")?,
            None => f.write_str("it ends too early")?,
        }
        let listed = self.expected.iter().take(MOST_LISTED);
        let listed: Vec<_> = listed.map(String::as_str).collect();
        if !listed.is_empty() {
            let more = self.expected.len() > MOST_LISTED;
            let more = if more { ", ..." } else { "" };
            write!(f, "; expected {}{more}", listed.join(", "))?;
        }
        match &self.nearest {
            Some(nearest) => write!(f, "; the nearest that is understood: {nearest}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for SentenceError {}
