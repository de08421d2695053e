//! Named arrays as bytes, which the program and an engine exchange.
//!
//! `docs/script-protocol.md` describes the format for those who write an engine in another language. Everything here is
//! little endian; reading any bytes ends with [`Arrays`] or with a [`ProtocolError`].

mod array;
mod decode;
mod encode;

pub use array::{Array, Data};

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

/// The error of bytes that are not arrays, or of arrays that cannot be written.
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
        /// The fault.
        reason: &'static str,
    },
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
}

/// The number of elements in an array of this size.
fn elements(dims: &[u32]) -> usize {
    let dims = dims.iter().map(|dim| *dim as usize);
    dims.fold(1, usize::saturating_mul)
}

/// Whether arrays can have this name.
fn is_name(name: &str) -> bool {
    let is_plain = |letter: u8| letter.is_ascii_alphanumeric() || matches!(letter, b'_' | b'.');
    (1..=MAX_NAME).contains(&name.len()) && name.bytes().all(is_plain)
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
        fn encoded_arrays_read_back(arrays in any_arrays()) {
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
            arrays in any_arrays(), place in any::<prop::sample::Index>(), byte in any::<u8>()
        ) {
            let mut bytes = arrays.encode().unwrap();
            let place = place.index(bytes.len());
            bytes[place] = byte;
            if let Ok(arrays) = Arrays::decode(&bytes) {
                prop_assert!(arrays.encode().is_ok(), "{:?} cannot be written", arrays);
            }
        }

        #[test]
        fn names_are_read_if_they_can_be_written(name in "[a-z._]{0,2}.?") {
            let mut bytes = Arrays(vec![("x".repeat(name.len().max(1)), Array::scalar(1.0))]).encode().unwrap();
            let place = PREAMBLE + RECORD_WORDS * 4;
            bytes[place..place + name.len()].copy_from_slice(name.as_bytes());
            let read = Arrays::decode(&bytes);
            prop_assert_eq!(read.is_ok(), is_name(&name) || name.is_empty());
        }

        #[test]
        fn files_that_are_cut_off_or_go_on_are_refused(
            arrays in any_arrays(), cut in any::<prop::sample::Index>(), more in prop::collection::vec(any::<u8>(), 1..20)
        ) {
            let mut bytes = arrays.encode().unwrap();
            prop_assert!(Arrays::decode(&bytes[..cut.index(bytes.len())]).is_err());
            bytes.extend(more);
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
