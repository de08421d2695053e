//! What is wrong with a task file, and where.

mod position;

use std::{
    fmt,
    path::{Path, PathBuf},
};

use crate::fault::position::PositionCursor;

/// The most faults of a file that are reported; one more fault then says that there are others.
pub const MAX_FAULTS: usize = 200;

/// One thing that is wrong with a task file.
///
/// ```
/// use tabletop_xml::Fault;
///
/// let fault = Fault {
///     file: "task.xml".into(),
///     line: 3,
///     column: 10,
///     element: Some("block".into()),
///     attribute: Some("color".into()),
///     problem: "`reed` is not a colour".into(),
///     expected: "#rrggbb".into(),
/// };
/// assert_eq!(
///     fault.to_string(),
///     "task.xml:3:10: block, color: `reed` is not a colour, expected #rrggbb"
/// );
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The file.
    pub file: PathBuf,
    /// The line, from 1.
    pub line: usize,
    /// The column in characters, from 1.
    pub column: usize,
    /// Name of the element at fault; absent where the fault is in none.
    pub element: Option<String>,
    /// Name of the attribute at fault; absent where the fault is in none.
    pub attribute: Option<String>,
    /// What is wrong.
    pub problem: String,
    /// What should be there instead.
    pub expected: String,
}

impl fmt::Display for Fault {
    /// Writes `file:line:column: element, attribute: what is wrong, expected what should be there`, on one line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            file,
            line,
            column,
            element,
            attribute,
            problem,
            expected,
        } = self;
        write!(f, "{}:{line}:{column}: ", file.display())?;
        match (element, attribute) {
            (Some(element), Some(attribute)) => write!(f, "{element}, {attribute}: ")?,
            (Some(element), None) => write!(f, "{element}: ")?,
            (None, Some(attribute)) => write!(f, "{attribute}: ")?,
            (None, None) => {}
        }
        write!(f, "{problem}, expected {expected}")
    }
}

impl std::error::Error for Fault {}

/// A place in the text of a task file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place<'a> {
    pub offset: usize,
    pub element: Option<&'a str>,
    pub attribute: Option<&'a str>,
}

impl Place<'_> {
    /// A place in no element.
    pub const fn outside(offset: usize) -> Self {
        Self {
            offset,
            element: None,
            attribute: None,
        }
    }
}

/// The faults found so far, in any order.
#[derive(Debug, Default)]
pub(crate) struct Faults {
    found: Vec<Found>,
    first_left_out: Option<usize>,
}

#[derive(Debug)]
struct Found {
    offset: usize,
    element: Option<String>,
    attribute: Option<String>,
    problem: String,
    expected: String,
}

impl Faults {
    /// Whether no more faults are noted.
    pub fn is_full(&self) -> bool {
        self.found.len() >= MAX_FAULTS
    }

    /// Notes a fault.
    pub fn report(
        &mut self,
        place: Place,
        problem: impl fmt::Display,
        expected: impl fmt::Display,
    ) {
        if self.is_full() {
            self.first_left_out.get_or_insert(place.offset);
            return;
        }
        let name = |name: &str| Excerpt(name).to_string();
        self.found.push(Found {
            offset: place.offset,
            element: place.element.map(name),
            attribute: place.attribute.map(name),
            problem: problem.to_string(),
            expected: expected.to_string(),
        });
    }

    /// The faults in the order of the text.
    pub fn locate(mut self, file: &Path, text: &str) -> Vec<Fault> {
        self.found.sort_by_key(|found| found.offset);
        if let Some(offset) = self.first_left_out {
            let last = self.found.last().map_or(0, |found| found.offset);
            self.found.push(Found {
                offset: offset.max(last),
                element: None,
                attribute: None,
                problem: "more faults follow".into(),
                expected: format!("at most {MAX_FAULTS}"),
            });
        }
        let mut cursor = PositionCursor::new(text);
        self.found
            .into_iter()
            .map(|found| {
                let (line, column) = cursor.advance_to(found.offset);
                Fault {
                    file: file.to_path_buf(),
                    line,
                    column,
                    element: found.element,
                    attribute: found.attribute,
                    problem: found.problem,
                    expected: found.expected,
                }
            })
            .collect()
    }
}

/// Displays the beginning of a text that may be of any length, on one line.
pub(crate) struct Excerpt<'a>(pub &'a str);

impl fmt::Display for Excerpt<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const LONGEST: usize = 40;
        let mut characters = self.0.chars();
        for character in characters.by_ref().take(LONGEST) {
            match character.is_control() {
                true => write!(f, "{}", character.escape_default())?,
                false => write!(f, "{character}")?,
            }
        }
        match characters.next() {
            Some(_) => f.write_str("…"),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_are_sorted_and_located() {
        let mut faults = Faults::default();
        faults.report(Place::outside(3), "late", "x");
        faults.report(
            Place {
                offset: 1,
                element: Some("box"),
                attribute: None,
            },
            "early",
            "y",
        );
        let lines: Vec<_> = faults
            .locate(Path::new("f.xml"), "a\nbc")
            .iter()
            .map(Fault::to_string)
            .collect();
        assert_eq!(
            lines,
            [
                "f.xml:1:2: box: early, expected y",
                "f.xml:2:2: late, expected x"
            ]
        );
    }

    #[test]
    fn faults_beyond_the_limit_are_counted_as_one() {
        let mut faults = Faults::default();
        for offset in (0..1000).rev() {
            faults.report(Place::outside(offset), "p", "e");
        }
        let faults = faults.locate(Path::new("f"), &"x".repeat(1000));
        assert_eq!(faults.len(), MAX_FAULTS + 1);
        assert_eq!(faults[MAX_FAULTS].problem, "more faults follow");
        assert!(faults.is_sorted_by_key(|fault| fault.column));
    }

    #[test]
    fn an_excerpt_is_short_and_on_one_line() {
        assert_eq!(Excerpt("a\nb").to_string(), "a\\nb");
        assert_eq!(Excerpt(&"ä".repeat(41)).to_string().chars().count(), 41);
        assert_eq!(Excerpt(&"ä".repeat(40)).to_string(), "ä".repeat(40));
    }
}
