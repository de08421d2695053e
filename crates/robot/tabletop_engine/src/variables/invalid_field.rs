//! Faults in variables that a script has set.

use std::fmt;

use crate::kind::EngineKind;

/// The largest coordinate that a marker may have, in units.
pub(crate) const FARTHEST: f64 = 1e6;

/// The error of a variable that a script has set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InvalidField {
    /// A variable is missing or is no struct.
    #[error("{name} is {found}; it must be {expected}")]
    NoStruct {
        /// The variable.
        name: String,
        /// Size and class of the value.
        found: String,
        /// The content that was expected.
        expected: &'static str,
    },
    /// A field has another size or class.
    #[error("{field} is {found}; it must be {expected}")]
    Size {
        /// The field, with its variable.
        field: String,
        /// Size and class of the value.
        found: String,
        /// The content that was expected.
        expected: String,
    },
    /// A number is not one.
    #[error("{element} is {found}; it must be a finite number")]
    NotFinite {
        /// The faulty element.
        element: MatrixElement,
        /// NaN, Inf or -Inf.
        found: &'static str,
    },
    /// A marker is too far away to be drawn anywhere.
    #[error("{element} is {found:e}; it must be between -{FARTHEST:e} and {FARTHEST:e}")]
    TooFar {
        /// The faulty coordinate of a marker.
        element: MatrixElement,
        /// Its value.
        found: f64,
    },
    /// There is a field that nobody knows.
    #[error("{field} is not a field that the robot knows; known are {known}{}", suggest(.suggestion))]
    Unknown {
        /// The field, with its variable.
        field: String,
        /// All that may be there.
        known: String,
        /// The one that may have been meant.
        suggestion: Option<&'static str>,
    },
}

impl InvalidField {
    /// The same, with indices as the scripts of this engine write them.
    #[must_use]
    pub(crate) fn written_for(mut self, kind: EngineKind) -> Self {
        if let Self::NotFinite { element, .. } | Self::TooFar { element, .. } = &mut self {
            element.is_python = kind == EngineKind::Python;
        }
        self
    }
}

/// An element of a matrix.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MatrixElement {
    field: String,
    rows: usize,
    columns: usize,
    /// Its place, column by column.
    place: usize,
    is_python: bool,
}

impl MatrixElement {
    pub(crate) fn new(field: &str, dims: &[u32], place: usize) -> Self {
        let extent = |dim: usize| dims.get(dim).map_or(1, |extent| *extent as usize).max(1);
        Self {
            field: field.to_owned(),
            rows: extent(0),
            columns: extent(1),
            place,
            is_python: false,
        }
    }
}

impl fmt::Display for MatrixElement {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let Self { field, .. } = self;
        let (row, column) = (self.place % self.rows, self.place / self.rows);
        match (self.is_python, self.rows, self.columns) {
            (false, ..) => write!(formatter, "{field}({},{})", row + 1, column + 1),
            (true, 1, 1) => formatter.write_str(field),
            (true, _, 1) => write!(formatter, "{field}[{row}]"),
            (true, ..) => write!(formatter, "{field}[{row}][{column}]"),
        }
    }
}

fn suggest(suggestion: &Option<&str>) -> String {
    suggestion.map_or(String::new(), |name| format!(" (did you mean {name}?)"))
}
