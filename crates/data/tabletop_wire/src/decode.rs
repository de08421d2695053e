//! From bytes to values. Every count is compared with the bytes that there are before it is believed.

use crate::{
    array::{MOST_DIMENSIONS, NumpyArray},
    dtype::Dtype,
    format_error::FormatError,
    value::{WireMap, WireValue},
};

/// The most maps and lists in each other.
const MOST_DEPTH: usize = 16;
/// The most values of a frame, an array counting as its map.
const MOST_VALUES: usize = 1 << 16;

/// The value of a frame.
///
/// # Errors
/// It is none, has something after it, or is beyond the bounds: 16 maps and lists in each other, 65,536 values, and arrays of 8 dimensions.
pub fn decode(bytes: &[u8]) -> Result<WireValue, FormatError> {
    let mut decoder = Decoder {
        rest: bytes,
        values: 0,
    };
    let value = decoder.value(0)?;
    match decoder.rest.len() {
        0 => Ok(value),
        more => Err(fault(format!("{more} bytes follow the value"))),
    }
}

fn fault(fault: impl Into<String>) -> FormatError {
    FormatError::at("", fault)
}

struct Decoder<'b> {
    rest: &'b [u8],
    values: usize,
}

impl<'b> Decoder<'b> {
    fn bytes(&mut self, count: usize) -> Result<&'b [u8], FormatError> {
        let split = self.rest.split_at_checked(count);
        let (bytes, rest) = split.ok_or_else(|| {
            fault(format!(
                "{count} bytes should follow, and {} do",
                self.rest.len()
            ))
        })?;
        self.rest = rest;
        Ok(bytes)
    }

    fn chunk<const N: usize>(&mut self) -> Result<[u8; N], FormatError> {
        let bytes = self.bytes(N)?;
        Ok(bytes.first_chunk().copied().unwrap_or([0; N]))
    }

    /// A count of one, two or four bytes.
    fn count(&mut self, bytes: usize) -> Result<usize, FormatError> {
        let all = self.bytes(bytes)?.iter();
        Ok(all.fold(0, |count, byte| count << 8 | usize::from(*byte)))
    }

    fn value(&mut self, depth: usize) -> Result<WireValue, FormatError> {
        self.values += 1;
        if self.values > MOST_VALUES {
            return Err(fault(format!("more than {MOST_VALUES} values")));
        }
        let [marker] = self.chunk()?;
        Ok(match marker {
            0x00..=0x7f => WireValue::Integer(i64::from(marker)),
            0xe0..=0xff => WireValue::Integer(i64::from(marker) - 0x100),
            0xc0 => WireValue::Nil,
            0xc2 | 0xc3 => WireValue::Boolean(marker == 0xc3),
            0xca => WireValue::Number(f64::from(f32::from_be_bytes(self.chunk()?))),
            0xcb => WireValue::Number(f64::from_be_bytes(self.chunk()?)),
            0xcc => WireValue::Integer(i64::from(u8::from_be_bytes(self.chunk()?))),
            0xcd => WireValue::Integer(i64::from(u16::from_be_bytes(self.chunk()?))),
            0xce => WireValue::Integer(i64::from(u32::from_be_bytes(self.chunk()?))),
            0xcf => whole(u64::from_be_bytes(self.chunk()?)),
            0xd0 => WireValue::Integer(i64::from(i8::from_be_bytes(self.chunk()?))),
            0xd1 => WireValue::Integer(i64::from(i16::from_be_bytes(self.chunk()?))),
            0xd2 => WireValue::Integer(i64::from(i32::from_be_bytes(self.chunk()?))),
            0xd3 => WireValue::Integer(i64::from_be_bytes(self.chunk()?)),
            0xa0..=0xbf => self.text(usize::from(marker & 0x1f))?,
            0xd9..=0xdb => {
                let length = self.count(1 << (marker - 0xd9))?;
                self.text(length)?
            }
            0xc4..=0xc6 => {
                let length = self.count(1 << (marker - 0xc4))?;
                WireValue::Bytes(self.bytes(length)?.to_vec())
            }
            0x90..=0x9f => self.list(usize::from(marker & 0x0f), depth)?,
            0xdc | 0xdd => {
                let length = self.count(2 << (marker - 0xdc))?;
                self.list(length, depth)?
            }
            0x80..=0x8f => self.map(usize::from(marker & 0x0f), depth)?,
            0xde | 0xdf => {
                let length = self.count(2 << (marker - 0xde))?;
                self.map(length, depth)?
            }
            0xc1 | 0xc7..=0xc9 | 0xd4..=0xd8 => {
                return Err(fault(format!(
                    "a byte 0x{marker:02x}, which begins no value of openpi's"
                )));
            }
        })
    }

    fn text(&mut self, length: usize) -> Result<WireValue, FormatError> {
        let text = String::from_utf8(self.bytes(length)?.to_vec());
        let text = text.map_err(|_| fault("a text that is not UTF-8"))?;
        Ok(WireValue::Text(text))
    }

    fn list(&mut self, length: usize, depth: usize) -> Result<WireValue, FormatError> {
        let depth = self.deeper(length, depth)?;
        let items = (0..length).map(|_| self.value(depth));
        Ok(WireValue::List(items.collect::<Result<_, _>>()?))
    }

    fn map(&mut self, length: usize, depth: usize) -> Result<WireValue, FormatError> {
        let depth = self.deeper(length, depth)?;
        let mut map = WireMap::new();
        for _ in 0..length {
            let key = key_of(self.value(depth)?)?;
            let value = self.value(depth).map_err(|fault| fault.below(&key))?;
            if map.contains_key(&key) {
                return Err(FormatError::at(&key, "the key is there twice"));
            }
            map.insert(key, value);
        }
        if map.contains_key("__ndarray__") {
            return array(&mut map).map(WireValue::Array);
        }
        if map.contains_key("__npgeneric__") {
            let number = map.remove("data");
            return number.ok_or_else(|| FormatError::at("data", "a number of NumPy's lacks it"));
        }
        Ok(WireValue::Map(map))
    }

    fn deeper(&self, length: usize, depth: usize) -> Result<usize, FormatError> {
        if depth >= MOST_DEPTH {
            return Err(fault(format!(
                "more than {MOST_DEPTH} maps and lists in each other"
            )));
        }
        // Each value has a byte at least.
        match length > self.rest.len() {
            true => Err(fault(format!(
                "{length} values should follow, and {} bytes do",
                self.rest.len()
            ))),
            false => Ok(depth + 1),
        }
    }
}

fn whole(number: u64) -> WireValue {
    i64::try_from(number).map_or(WireValue::Number(number as f64), WireValue::Integer)
}

/// A key: a text, or bytes that are one.
fn key_of(value: WireValue) -> Result<String, FormatError> {
    match value {
        WireValue::Text(text) => Ok(text),
        WireValue::Bytes(bytes) => {
            String::from_utf8(bytes).map_err(|_| fault("a key that is not UTF-8"))
        }
        WireValue::Integer(number) => Ok(number.to_string()),
        WireValue::Nil
        | WireValue::Boolean(_)
        | WireValue::Number(_)
        | WireValue::List(_)
        | WireValue::Map(_)
        | WireValue::Array(_) => Err(fault(format!(
            "{} where a key should be, which is a text",
            value.kind()
        ))),
    }
}

/// The array that a map describes.
fn array(map: &mut WireMap) -> Result<NumpyArray, FormatError> {
    let mut part = |key: &str| map.remove(key).unwrap_or(WireValue::Nil);
    let (dtype, data, shape) = (part("dtype"), part("data"), part("shape"));
    let wrong = |key: &str, value: &WireValue, expected: &str| {
        FormatError::at(key, format!("{}, expected {expected}", value.kind()))
    };
    let WireValue::Text(name) = dtype else {
        return Err(wrong("dtype", &dtype, "NumPy's name of a type"));
    };
    let named = Dtype::named(&name);
    let (dtype, is_swapped) = named.ok_or_else(|| {
        FormatError::at(
            "dtype",
            format!("{name:?}, expected whole or real numbers such as \"<f4\" or \"|u1\""),
        )
    })?;
    let WireValue::Bytes(bytes) = data else {
        return Err(wrong("data", &data, "bytes"));
    };
    let WireValue::List(sides) = shape else {
        return Err(wrong("shape", &shape, "a list of whole numbers"));
    };
    let mut shape = Vec::new();
    for side in sides.into_iter().take(MOST_DIMENSIONS + 1) {
        let WireValue::Integer(side) = side else {
            return Err(wrong("shape", &side, "whole numbers"));
        };
        let side = usize::try_from(side);
        shape.push(side.map_err(|_| FormatError::at("shape", "a side below 0"))?);
    }
    let array = NumpyArray::new(dtype, shape, bytes).map_err(fault)?;
    Ok(match is_swapped {
        true => array.swapped(),
        false => array,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(bytes: &[u8]) -> String {
        decode(bytes).unwrap_err().to_string()
    }

    #[test]
    fn a_fault_says_where_it_is() {
        assert_eq!(refusal(&[]), "1 bytes should follow, and 0 do");
        assert_eq!(refusal(&[0xc0, 0xc0]), "1 bytes follow the value");
        assert_eq!(
            refusal(&[0x81, 0xa1, b'a', 0x81, 0xa1, b'b', 0xc1]),
            "a.b: a byte 0xc1, which begins no value of openpi's"
        );
        assert_eq!(
            refusal(&[0xdd, 0xff, 0xff, 0xff, 0xff]),
            "4294967295 values should follow, and 0 bytes do"
        );
        assert_eq!(
            refusal(&[0x82, 0xa1, b'a', 0xc0, 0xc4, 1, b'a', 0xc0]),
            "a: the key is there twice"
        );
        assert_eq!(
            refusal(&[0x91; 17]),
            "more than 16 maps and lists in each other"
        );
        let mut many = vec![0xdd, 0, 1, 0, 0];
        many.extend([0xc0; 1 << 16]);
        assert_eq!(refusal(&many), "more than 65536 values");
    }

    #[test]
    fn numbers_of_numpy_are_numbers() {
        let mut bytes = vec![0x83, 0xc4, 13];
        bytes.extend(b"__npgeneric__");
        bytes.extend([0xc3, 0xc4, 4]);
        bytes.extend(b"data");
        bytes.extend([0x07, 0xc4, 5]);
        bytes.extend(b"dtype");
        bytes.extend([0xa3]);
        bytes.extend(b"<i8");
        assert_eq!(decode(&bytes), Ok(WireValue::Integer(7)));
    }
}
