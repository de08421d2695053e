//! Files of tensors, in the safetensors layout: the length of the header as 8 bytes, the header as JSON, then all numbers, little-endian
//! (<https://github.com/huggingface/safetensors>).

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

/// Numbers by name, and texts about them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct TensorFile {
    pub metadata: BTreeMap<String, String>,
    pub tensors: BTreeMap<String, Tensor>,
}

/// Numbers, the last index of the shape running fastest.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Tensor {
    pub shape: Vec<usize>,
    pub numbers: Vec<f32>,
}

const METADATA: &str = "__metadata__";
const BYTES: usize = size_of::<f32>();

impl TensorFile {
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut header = Map::new();
        header.insert(METADATA.into(), json!(self.metadata));
        let mut end = 0;
        for (name, tensor) in &self.tensors {
            let first = end;
            end += tensor.numbers.len() * BYTES;
            let entry =
                json!({ "dtype": "F32", "shape": tensor.shape, "data_offsets": [first, end] });
            header.insert(name.clone(), entry);
        }
        let mut header = Value::Object(header).to_string().into_bytes();
        // So that the numbers are aligned in memory.
        header.resize(header.len().next_multiple_of(8), b' ');
        let mut bytes = (header.len() as u64).to_le_bytes().to_vec();
        bytes.extend(header);
        let tensors = self.tensors.values().flat_map(|tensor| &tensor.numbers);
        bytes.extend(tensors.flat_map(|number| number.to_le_bytes()));
        bytes
    }

    /// Reads a file's bytes.
    ///
    /// # Errors
    /// What is wrong, and where.
    pub fn parse(bytes: &[u8]) -> Result<Self, String> {
        let too_short = || format!("it ends after {} bytes, within the header", bytes.len());
        let (length, rest) = bytes.split_first_chunk().ok_or_else(too_short)?;
        let length = usize::try_from(u64::from_le_bytes(*length)).ok();
        let split = length.and_then(|length| rest.split_at_checked(length));
        let (header, data) = split.ok_or_else(too_short)?;
        let header: Map<String, Value> =
            serde_json::from_slice(header).map_err(|error| format!("header: {error}"))?;
        let mut file = Self::default();
        let mut used = Vec::new();
        for (name, entry) in &header {
            let at = |fault: String| format!("header, {name:?}: {fault}");
            if name == METADATA {
                file.metadata =
                    serde_json::from_value(entry.clone()).map_err(|error| at(error.to_string()))?;
                continue;
            }
            let (range, tensor) = tensor(entry, data).map_err(at)?;
            used.push((range, name));
            file.tensors.insert(name.clone(), tensor);
        }
        used.sort();
        let mut end = 0;
        for ([first, last], name) in used {
            if first != end {
                return Err(format!(
                    "header, {name:?}: it begins at byte {first} of the numbers, expected {end}"
                ));
            }
            end = last;
        }
        match end == data.len() {
            true => Ok(file),
            false => Err(format!(
                "it has {} bytes of numbers, expected {end}",
                data.len()
            )),
        }
    }
}

/// The tensor of an entry of the header, and where its numbers begin and end.
fn tensor(entry: &Value, data: &[u8]) -> Result<([usize; 2], Tensor), String> {
    let dtype = &entry["dtype"];
    if dtype != "F32" {
        return Err(format!("its dtype is {dtype}, expected \"F32\""));
    }
    let list = |name: &str| -> Result<Vec<usize>, String> {
        serde_json::from_value(entry[name].clone()).map_err(|error| format!("{name}: {error}"))
    };
    let shape = list("shape")?;
    let offsets = list("data_offsets")?;
    let [first, end] = offsets[..] else {
        return Err(format!(
            "data_offsets: {} numbers, expected 2",
            offsets.len()
        ));
    };
    let bytes = data.get(first..end).ok_or_else(|| {
        format!(
            "data_offsets: {first} to {end} are not within the {} bytes of numbers",
            data.len()
        )
    })?;
    let count = shape
        .iter()
        .try_fold(BYTES, |all, side| all.checked_mul(*side));
    if count != Some(bytes.len()) {
        return Err(format!(
            "{} bytes do not fit the shape {shape:?}",
            bytes.len()
        ));
    }
    let numbers = bytes
        .as_chunks()
        .0
        .iter()
        .map(|&number| f32::from_le_bytes(number));
    let numbers = numbers.collect();
    Ok(([first, end], Tensor { shape, numbers }))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn file() -> TensorFile {
        let tensor = |shape: &[usize], numbers: &[f32]| Tensor {
            shape: shape.to_vec(),
            numbers: numbers.to_vec(),
        };
        TensorFile {
            metadata: [("format".to_owned(), "1".to_owned())].into(),
            tensors: [
                ("b".to_owned(), tensor(&[2], &[1.0, -2.5])),
                (
                    "a".to_owned(),
                    tensor(&[1, 3], &[f32::MIN_POSITIVE, 0.0, 3.0]),
                ),
            ]
            .into(),
        }
    }

    fn with_header(header: &str, data: &[u8]) -> Vec<u8> {
        let length = (header.len() as u64).to_le_bytes();
        [&length[..], header.as_bytes(), data].concat()
    }

    #[test]
    fn what_is_written_is_read_back() {
        assert_eq!(TensorFile::parse(&file().to_bytes()), Ok(file()));
        let empty = TensorFile::default();
        assert_eq!(TensorFile::parse(&empty.to_bytes()), Ok(empty));
    }

    #[test]
    fn a_fault_is_located() {
        let whole = file().to_bytes();
        let fault = |bytes: &[u8]| TensorFile::parse(bytes).unwrap_err();
        assert_eq!(
            fault(&whole[..5]),
            "it ends after 5 bytes, within the header"
        );
        assert_eq!(
            fault(&whole[..whole.len() - 1]),
            r#"header, "b": data_offsets: 12 to 20 are not within the 19 bytes of numbers"#
        );
        let more = [&whole[..], &[0]].concat();
        assert_eq!(fault(&more), "it has 21 bytes of numbers, expected 20");
        let other = with_header(
            r#"{"a":{"dtype":"BF16","shape":[],"data_offsets":[0,2]}}"#,
            &[0; 2],
        );
        assert_eq!(
            fault(&other),
            r#"header, "a": its dtype is "BF16", expected "F32""#
        );
        let hole = with_header(
            r#"{"a":{"dtype":"F32","shape":[1],"data_offsets":[4,8]}}"#,
            &[0; 8],
        );
        assert_eq!(
            fault(&hole),
            r#"header, "a": it begins at byte 4 of the numbers, expected 0"#
        );
        let huge = format!(
            r#"{{"a":{{"dtype":"F32","shape":[{0},{0}],"data_offsets":[0,4]}}}}"#,
            1_u64 << 40
        );
        assert!(fault(&with_header(&huge, &[0; 4])).contains("do not fit the shape"));
        assert!(fault(&with_header("{", &[])).starts_with("header: EOF"));
    }

    proptest! {
        #[test]
        fn damage_never_panics(
            at in any::<prop::sample::Index>(),
            byte: u8,
            cut in any::<prop::sample::Index>(),
        ) {
            let mut bytes = file().to_bytes();
            let at = at.index(bytes.len());
            bytes[at] = byte;
            bytes.truncate(cut.index(bytes.len()) + 1);
            let _ = TensorFile::parse(&bytes);
        }

        #[test]
        fn any_bytes_are_refused_or_written_the_same(bytes: Vec<u8>) {
            if let Ok(file) = TensorFile::parse(&bytes) {
                prop_assert_eq!(TensorFile::parse(&file.to_bytes()), Ok(file));
            }
        }
    }
}
