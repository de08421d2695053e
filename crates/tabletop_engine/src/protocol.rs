//! Named arrays as bytes: what the program and an engine tell each other.
//!
//! `docs/script-protocol.md` describes the format for those who write an engine in another language. Everything here is
//! little endian; whatever the bytes are, reading them ends with [`Arrays`] or with a [`ProtocolError`].

/// The first word of every file: "TTA1" as text.
const MAGIC: u32 = u32::from_le_bytes(*b"TTA1");

/// The version of the format. A reader refuses any other.
pub const PROTOCOL_VERSION: u32 = 1;

/// The largest file that is written or read, in bytes.
pub const MAX_FILE_BYTES: usize = 64 << 20;

const MAX_ITEMS: usize = 10_000;
const MAX_DIMS: usize = 8;
const MAX_NAME: usize = 256;
/// Bytes before the first record.
const PREAMBLE: usize = 16;
/// Words that describe an array: class, length of the name and of the payload, number of dimensions, dimensions.
const RECORD_WORDS: usize = 4 + MAX_DIMS;

/// Why bytes are not arrays, or arrays cannot be written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ProtocolError {
    /// The file does not begin as the format says.
    #[error("the file does not begin with \"TTA1\"; it is not one of named arrays")]
    Magic,
    /// The file was written in another version of the format.
    #[error(
        "the file has version {0} of the format; this program speaks version {PROTOCOL_VERSION}"
    )]
    Version(u32),
    /// The file ends too early, is too long or contradicts itself.
    #[error("the file of named arrays is damaged: {0}")]
    Damaged(&'static str),
    /// There is an array that the format has no place for.
    #[error("\"{name}\" cannot be written: {reason}")]
    Unwritable {
        /// The array's name.
        name: String,
        /// What is wrong with it.
        reason: &'static str,
    },
}

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
    fn code(&self) -> u32 {
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

    /// How many elements there are, where the data say so themselves.
    fn len(&self) -> Option<usize> {
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
        match &self.data {
            Data::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The number, if it is a single one.
    pub fn as_scalar(&self) -> Option<f64> {
        match &self.data {
            Data::Double(data) => match data[..] {
                [value] => Some(value),
                _ => None,
            },
            _ => None,
        }
    }
}

/// Arrays by name, in order. A name with dots ("sensor.jointAngles") is the place in nested structs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Arrays(Vec<(String, Array)>);

impl Arrays {
    /// Adds an array at the end.
    pub fn put(&mut self, name: impl Into<String>, array: Array) {
        self.0.push((name.into(), array));
    }

    /// The first array of this name.
    pub fn get(&self, name: &str) -> Option<&Array> {
        self.0
            .iter()
            .find_map(|(own, array)| (own == name).then_some(array))
    }

    /// All names and arrays, in order.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Array)> {
        self.0.iter().map(|(name, array)| (name.as_str(), array))
    }

    /// The arrays as bytes.
    ///
    /// # Errors
    /// An array's size does not fit its elements, or is beyond what the format holds.
    pub fn encode(&self) -> Result<Vec<u8>, ProtocolError> {
        let mut records = Vec::new();
        let mut names = Vec::new();
        let mut payloads = Vec::new();
        for (name, array) in &self.0 {
            check_name(name)?;
            check_size(name, array)?;
            names.extend_from_slice(name.as_bytes());
            let start = payloads.len();
            write_payload(&array.data, &mut payloads);
            let mut record = [0; RECORD_WORDS];
            let (head, dims) = record.split_at_mut(RECORD_WORDS - MAX_DIMS);
            let payload = payloads.len() - start;
            head.copy_from_slice(&[
                array.data.code(),
                name.len() as u32,
                payload as u32,
                array.dims.len() as u32,
            ]);
            for (place, dim) in dims.iter_mut().zip(&array.dims) {
                *place = *dim;
            }
            records.extend_from_slice(&record);
            pad(&mut payloads);
        }
        let size = PREAMBLE + records.len() * 4 + names.len() + payloads.len();
        if self.0.len() > MAX_ITEMS || size > MAX_FILE_BYTES {
            let name = self
                .0
                .last()
                .map_or(String::new(), |(name, _)| name.clone());
            let reason = "there is more than a file may hold";
            return Err(ProtocolError::Unwritable { name, reason });
        }
        let mut bytes = Vec::with_capacity(size + 8);
        for word in [
            MAGIC,
            PROTOCOL_VERSION,
            self.0.len() as u32,
            names.len() as u32,
        ] {
            bytes.extend_from_slice(&word.to_le_bytes());
        }
        for word in records {
            bytes.extend_from_slice(&word.to_le_bytes());
        }
        bytes.extend_from_slice(&names);
        pad(&mut bytes);
        bytes.extend_from_slice(&payloads);
        Ok(bytes)
    }

    /// Reads what [`encode`](Self::encode) or an engine wrote.
    ///
    /// # Errors
    /// The bytes are not of this format.
    pub fn decode(bytes: &[u8]) -> Result<Self, ProtocolError> {
        if bytes.len() > MAX_FILE_BYTES {
            return Err(ProtocolError::Damaged("it is too long"));
        }
        let mut rest = Reader(bytes);
        if rest.word()? != MAGIC {
            return Err(ProtocolError::Magic);
        }
        let version = rest.word()?;
        if version != PROTOCOL_VERSION {
            return Err(ProtocolError::Version(version));
        }
        let count = rest.word()? as usize;
        let names = rest.word()? as usize;
        if count > MAX_ITEMS {
            return Err(ProtocolError::Damaged("it holds too many arrays"));
        }
        let mut records = Reader(rest.take(count * RECORD_WORDS * 4)?);
        let items = (0..count).map(|_| Header::read(&mut records));
        let items = items.collect::<Result<Vec<_>, _>>()?;
        let padding = names
            .checked_next_multiple_of(8)
            .ok_or(ProtocolError::Damaged("a name is too long"))?
            - names;
        let mut names = Reader(rest.take(names)?);
        rest.take(padding)?;
        let mut arrays = Self::default();
        for item in items {
            let name = text(names.take(item.name)?);
            let data = read_payload(&item, rest.take(item.payload)?)?;
            rest.take(item.payload.next_multiple_of(8) - item.payload)?;
            let array = Array {
                dims: item.dims,
                data,
            };
            arrays.put(name, array);
        }
        Ok(arrays)
    }
}

/// What the header says of an array.
struct Header {
    code: u32,
    name: usize,
    payload: usize,
    dims: Vec<u32>,
    elements: usize,
}

impl Header {
    fn read(words: &mut Reader) -> Result<Self, ProtocolError> {
        let code = words.word()?;
        let name = words.word()? as usize;
        let payload = words.word()? as usize;
        let used = words.word()? as usize;
        let mut dims = (0..MAX_DIMS)
            .map(|_| words.word())
            .collect::<Result<Vec<_>, _>>()?;
        if name > MAX_NAME {
            return Err(ProtocolError::Damaged("a name is too long"));
        }
        if !(2..=MAX_DIMS).contains(&used) {
            return Err(ProtocolError::Damaged(
                "an array has too few or too many dimensions",
            ));
        }
        dims.truncate(used);
        let elements = elements(&dims).ok_or(ProtocolError::Damaged("an array is too large"))?;
        Ok(Self {
            code,
            name,
            payload,
            dims,
            elements,
        })
    }
}

/// Bytes from the front.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], ProtocolError> {
        let (taken, rest) = self
            .0
            .split_at_checked(count)
            .ok_or(ProtocolError::Damaged("it ends too early"))?;
        self.0 = rest;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], ProtocolError> {
        let (taken, rest) = self
            .0
            .split_first_chunk()
            .ok_or(ProtocolError::Damaged("it ends too early"))?;
        self.0 = rest;
        Ok(*taken)
    }

    fn word(&mut self) -> Result<u32, ProtocolError> {
        self.array().map(u32::from_le_bytes)
    }

    fn double(&mut self) -> Result<f64, ProtocolError> {
        self.array().map(f64::from_le_bytes)
    }

    fn texts(&mut self, count: usize) -> Result<Vec<String>, ProtocolError> {
        let mut lengths = Reader(self.take(count.saturating_mul(4))?);
        (0..count)
            .map(|_| Ok(text(self.take(lengths.word()? as usize)?)))
            .collect()
    }
}

fn elements(dims: &[u32]) -> Option<usize> {
    let product = dims
        .iter()
        .try_fold(1usize, |product, dim| product.checked_mul(*dim as usize))?;
    (product <= MAX_FILE_BYTES).then_some(product)
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn pad(bytes: &mut Vec<u8>) {
    bytes.resize(bytes.len().next_multiple_of(8), 0);
}

fn check_name(name: &str) -> Result<(), ProtocolError> {
    let reason = "a name is made of one to 256 letters, digits, underscores and dots";
    let plain = |letter: u8| letter.is_ascii_alphanumeric() || matches!(letter, b'_' | b'.');
    if name.is_empty() || name.len() > MAX_NAME || !name.bytes().all(plain) {
        let name = name.chars().take(MAX_NAME).collect();
        return Err(ProtocolError::Unwritable { name, reason });
    }
    Ok(())
}

fn check_size(name: &str, array: &Array) -> Result<(), ProtocolError> {
    let unwritable = |reason| ProtocolError::Unwritable {
        name: name.to_owned(),
        reason,
    };
    if !(2..=MAX_DIMS).contains(&array.dims.len()) {
        return Err(unwritable("an array has from two to eight dimensions"));
    }
    let elements = elements(&array.dims).ok_or_else(|| unwritable("it is too large"))?;
    if array.data.len().is_some_and(|len| len != elements) {
        return Err(unwritable(
            "its size does not fit the number of its elements",
        ));
    }
    Ok(())
}

fn write_payload(data: &Data, bytes: &mut Vec<u8>) {
    match data {
        Data::Double(values) => values
            .iter()
            .for_each(|value| bytes.extend_from_slice(&value.to_le_bytes())),
        Data::Bytes(values) | Data::Picture(values) => bytes.extend_from_slice(values),
        Data::Text(text) | Data::Other(text) => bytes.extend_from_slice(text.as_bytes()),
        Data::Logical(values) => bytes.extend(values.iter().map(|value| u8::from(*value))),
        Data::Map(points) => {
            for value in points.iter().flat_map(|(_, point)| point) {
                bytes.extend_from_slice(&value.to_le_bytes());
            }
            write_texts(points.iter().map(|(name, _)| name.as_str()), bytes);
        }
        Data::Texts(texts) => write_texts(texts.iter().map(String::as_str), bytes),
    }
}

fn write_texts<'a>(texts: impl Iterator<Item = &'a str> + Clone, bytes: &mut Vec<u8>) {
    for text in texts.clone() {
        bytes.extend_from_slice(&(text.len() as u32).to_le_bytes());
    }
    for text in texts {
        bytes.extend_from_slice(text.as_bytes());
    }
}

fn read_payload(item: &Header, payload: &[u8]) -> Result<Data, ProtocolError> {
    let exactly = |bytes: usize| {
        if payload.len() == bytes {
            Ok(())
        } else {
            Err(ProtocolError::Damaged(
                "an array's size does not fit its elements",
            ))
        }
    };
    let mut rest = Reader(payload);
    let data = match item.code {
        0 => {
            exactly(item.elements.saturating_mul(8))?;
            Data::Double(
                (0..item.elements)
                    .map(|_| rest.double())
                    .collect::<Result<_, _>>()?,
            )
        }
        1 | 3 | 4 => {
            exactly(item.elements)?;
            match item.code {
                1 => Data::Bytes(payload.to_vec()),
                3 => Data::Logical(payload.iter().map(|byte| *byte != 0).collect()),
                _ => Data::Picture(payload.to_vec()),
            }
        }
        2 => Data::Text(text(payload)),
        5 => {
            let mut points = Reader(rest.take(item.elements.saturating_mul(24))?);
            let names = rest.texts(item.elements)?;
            let points = names
                .into_iter()
                .map(|name| Ok((name, [points.double()?, points.double()?, points.double()?])))
                .collect::<Result<_, ProtocolError>>()?;
            Data::Map(points)
        }
        6 => Data::Texts(rest.texts(item.elements)?),
        7 => Data::Other(text(payload)),
        _ => return Err(ProtocolError::Damaged("an array has an unknown class")),
    };
    Ok(data)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn any_array() -> impl Strategy<Value = Array> {
        let numbers = prop::collection::vec(-1e6..1e6, 0..20);
        let bytes = prop::collection::vec(any::<u8>(), 0..20);
        let flags = prop::collection::vec(any::<bool>(), 0..20);
        let texts = prop::collection::vec(".{0,12}", 0..6);
        let points = prop::collection::vec((".{0,12}", [-9.0..9.0, -9.0..9.0, -9.0..9.0]), 0..6);
        let column = |data: Data| Array {
            dims: vec![data.len().unwrap_or(1) as u32, 1],
            data,
        };
        prop_oneof![
            numbers.prop_map(move |data| column(Data::Double(data))),
            bytes
                .clone()
                .prop_map(move |data| column(Data::Bytes(data))),
            bytes.prop_map(move |data| column(Data::Picture(data))),
            flags.prop_map(move |data| column(Data::Logical(data))),
            ".{0,30}".prop_map(Array::text),
            texts.prop_map(Array::texts),
            points.prop_map(Array::map),
            "[a-z]{1,9}".prop_map(move |class| column(Data::Other(class))),
        ]
    }

    fn any_arrays() -> impl Strategy<Value = Arrays> {
        let name = "[a-zA-Z][a-zA-Z0-9_.]{0,20}";
        prop::collection::vec((name, any_array()), 0..8).prop_map(Arrays)
    }

    proptest! {
        #[test]
        fn what_is_written_can_be_read(arrays in any_arrays()) {
            let bytes = arrays.encode().unwrap();
            prop_assert_eq!(bytes.len() % 8, 0);
            prop_assert_eq!(Arrays::decode(&bytes).unwrap(), arrays);
        }

        #[test]
        fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            let _ = Arrays::decode(&bytes);
        }

        #[test]
        fn damaged_files_are_read_or_refused(
            arrays in any_arrays(), place in any::<prop::sample::Index>(), byte in any::<u8>(), cut in any::<prop::sample::Index>()
        ) {
            let mut bytes = arrays.encode().unwrap();
            let place = place.index(bytes.len());
            bytes[place] = byte;
            let _ = Arrays::decode(&bytes);
            bytes.truncate(cut.index(bytes.len()));
            prop_assert!(Arrays::decode(&bytes).is_err());
        }
    }

    #[test]
    fn matrices_are_column_major() {
        let matrix = Array::matrix(&[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        assert_eq!(matrix.dims, [2, 3]);
        assert_eq!(
            matrix.data,
            Data::Double(vec![1.0, 4.0, 2.0, 5.0, 3.0, 6.0])
        );
        assert_eq!(matrix.describe(), "2x3 double");
    }

    #[test]
    fn another_version_is_named() {
        let mut bytes = Arrays::default().encode().unwrap();
        bytes[4] = 9;
        assert_eq!(Arrays::decode(&bytes), Err(ProtocolError::Version(9)));
    }

    #[test]
    fn sizes_that_do_not_fit_are_not_written() {
        let mut arrays = Arrays::default();
        let data = Data::Double(vec![1.0]);
        arrays.put(
            "a",
            Array {
                dims: vec![2, 7],
                data,
            },
        );
        assert!(
            matches!(arrays.encode(), Err(ProtocolError::Unwritable { name, .. }) if name == "a")
        );
    }
}
