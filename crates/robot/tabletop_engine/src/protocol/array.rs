//! An array, the value of a variable of a script.

/// The elements of an [`Array`]. Matrices are in column-major order, as in Matlab.
#[derive(Clone, Debug, PartialEq)]
pub enum Data {
    /// Real numbers.
    Double(Vec<f64>),
    /// Small integers that stay integers.
    Bytes(Vec<u8>),
    /// Text.
    Text(String),
    /// Truth values.
    Logical(Vec<bool>),
    /// Intensities that the script sees as numbers from 0 to 1 (the byte divided by 255).
    Picture(Vec<u8>),
    /// Points in space by name; a `containers.Map` in Matlab, a dictionary in Python.
    Map(Vec<(String, [f64; 3])>),
    /// A list of texts; a cell array in Matlab.
    Texts(Vec<String>),
    /// Something that has no representation here, by the name of its class. Only engines write this.
    Other(String),
}

impl Data {
    /// The number of the class in the format.
    pub(super) fn code(&self) -> u32 {
        match self {
            Self::Double(_) => 0,
            Self::Bytes(_) => 1,
            Self::Text(_) => 2,
            Self::Logical(_) => 3,
            Self::Picture(_) => 4,
            Self::Map(_) => 5,
            Self::Texts(_) => 6,
            Self::Other(_) => 7,
        }
    }

    /// The name of the class, as Matlab calls it.
    pub fn class(&self) -> &str {
        match self {
            Self::Double(_) => "double",
            Self::Bytes(_) | Self::Picture(_) => "uint8",
            Self::Text(_) => "char",
            Self::Logical(_) => "logical",
            Self::Map(_) => "containers.Map",
            Self::Texts(_) => "cell",
            Self::Other(class) => class,
        }
    }

    /// The number of elements, where the data say so themselves.
    pub(super) fn len(&self) -> Option<usize> {
        match self {
            Self::Double(data) => Some(data.len()),
            Self::Bytes(data) | Self::Picture(data) => Some(data.len()),
            Self::Logical(data) => Some(data.len()),
            Self::Map(data) => Some(data.len()),
            Self::Texts(data) => Some(data.len()),
            // A character may be several bytes, and of other classes only the size is known.
            Self::Text(_) | Self::Other(_) => None,
        }
    }
}

/// An array: its size and its elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Its extents, at least two: rows, columns, pages, …
    pub dims: Vec<u32>,
    /// Its elements.
    pub data: Data,
}

impl Array {
    /// A number.
    pub fn scalar(value: f64) -> Self {
        Self {
            dims: vec![1, 1],
            data: Data::Double(vec![value]),
        }
    }

    /// A truth value.
    pub fn logical(value: bool) -> Self {
        Self {
            dims: vec![1, 1],
            data: Data::Logical(vec![value]),
        }
    }

    /// A matrix, given row by row.
    pub fn matrix<const COLUMNS: usize>(rows: &[[f64; COLUMNS]]) -> Self {
        let data = (0..COLUMNS)
            .flat_map(|column| rows.iter().map(move |row| row[column]))
            .collect();
        Self {
            dims: vec![rows.len() as u32, COLUMNS as u32],
            data: Data::Double(data),
        }
    }

    /// A row of numbers.
    pub fn row(values: Vec<f64>) -> Self {
        Self {
            dims: vec![1, values.len() as u32],
            data: Data::Double(values),
        }
    }

    /// A column of numbers.
    pub fn column(values: Vec<f64>) -> Self {
        Self {
            dims: vec![values.len() as u32, 1],
            data: Data::Double(values),
        }
    }

    /// A line of text.
    pub fn text(text: impl Into<String>) -> Self {
        let text = text.into();
        Self {
            dims: vec![1, text.chars().count() as u32],
            data: Data::Text(text),
        }
    }

    /// A list of texts.
    pub fn texts(texts: Vec<String>) -> Self {
        Self {
            dims: vec![1, texts.len() as u32],
            data: Data::Texts(texts),
        }
    }

    /// Points in space by name.
    pub fn map(points: Vec<(String, [f64; 3])>) -> Self {
        Self {
            dims: vec![1, points.len() as u32],
            data: Data::Map(points),
        }
    }

    /// Size and class as a person reads them: "2x7 double".
    pub fn describe(&self) -> String {
        let size: Vec<_> = self.dims.iter().map(u32::to_string).collect();
        format!("{} {}", size.join("x"), self.data.class())
    }

    /// The text, if it is one.
    pub fn as_text(&self) -> Option<&str> {
        if let Data::Text(text) = &self.data {
            Some(text)
        } else {
            None
        }
    }
}
