//! Faults of a frame.

use std::fmt;

/// The longest text of a stranger that a fault repeats, in letters.
const LONGEST_QUOTE: usize = 200;

/// A frame that is not what it should be: where in it, and what is wrong there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FormatError {
    place: String,
    fault: String,
}

impl FormatError {
    /// A fault at the value of a key.
    pub fn at(key: &str, fault: impl Into<String>) -> Self {
        Self {
            place: shortened(key),
            fault: fault.into(),
        }
    }

    /// The same fault in a map that is the value of a key.
    #[must_use]
    pub(crate) fn below(mut self, key: &str) -> Self {
        let key = shortened(key);
        self.place = match self.place.is_empty() {
            true => key,
            false => format!("{key}.{}", self.place),
        };
        self
    }
}

impl fmt::Display for FormatError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.place.is_empty() {
            true => f.write_str(&self.fault),
            false => write!(f, "{}: {}", self.place, self.fault),
        }
    }
}

impl std::error::Error for FormatError {}

/// The beginning of a text that may be long.
pub(crate) fn shortened(text: &str) -> String {
    match text.char_indices().nth(LONGEST_QUOTE) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}
