//! Bytes to arrays.

use super::{
    Array, Arrays, Data, MAGIC, MAX_DIMS, MAX_FILE_BYTES, MAX_ITEMS, MAX_NAME, PROTOCOL_VERSION,
    ProtocolError, RECORD_WORDS, elements, is_name,
};

impl Arrays {
    /// Reads the bytes that [`encode`](Self::encode) or an engine wrote.
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
            if !is_name(&name) {
                return Err(ProtocolError::Damaged(
                    "a name has other than letters, digits, underscores and dots",
                ));
            }
            let data = read_payload(&item, rest.take(item.payload)?)?;
            rest.take(item.payload.next_multiple_of(8) - item.payload)?;
            let array = Array {
                dims: item.dims,
                data,
            };
            arrays.put(name, array);
        }
        if !names.0.is_empty() || !rest.0.is_empty() {
            return Err(ProtocolError::Damaged("it goes on after its last array"));
        }
        Ok(arrays)
    }
}

/// The header of an array.
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
        let elements = elements(&dims);
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

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
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
