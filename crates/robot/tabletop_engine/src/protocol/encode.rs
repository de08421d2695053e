//! Arrays to bytes.

use super::{
    Array, Arrays, Data, MAGIC, MAX_DIMS, MAX_FILE_BYTES, MAX_ITEMS, MAX_NAME, PREAMBLE,
    PROTOCOL_VERSION, ProtocolError, RECORD_WORDS, elements, is_name,
};

impl Arrays {
    /// The arrays as bytes.
    ///
    /// # Errors
    /// An array's size does not fit its elements, or exceeds the format's range.
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
}

fn pad(bytes: &mut Vec<u8>) {
    bytes.resize(bytes.len().next_multiple_of(8), 0);
}

fn check_name(name: &str) -> Result<(), ProtocolError> {
    let reason = "a name is made of one to 256 letters, digits, underscores and dots";
    if !is_name(name) {
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
    let elements = elements(&array.dims);
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
