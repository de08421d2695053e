//! From values to bytes, as `openpi-client` writes them.

use crate::{
    array::NumpyArray,
    value::{WireMap, WireValue},
};

/// The bytes of a map's frame.
pub fn encode(map: &WireMap) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_map(&mut bytes, map);
    bytes
}

fn write(bytes: &mut Vec<u8>, value: &WireValue) {
    match value {
        WireValue::Nil => bytes.push(0xc0),
        WireValue::Boolean(is_so) => bytes.push(0xc2 + u8::from(*is_so)),
        WireValue::Integer(number) => write_integer(bytes, *number),
        WireValue::Number(number) => {
            bytes.push(0xcb);
            bytes.extend(number.to_be_bytes());
        }
        WireValue::Text(text) => write_text(bytes, text),
        WireValue::Bytes(content) => write_bytes(bytes, content),
        WireValue::List(items) => {
            write_head(bytes, items.len(), (15, 0x90), None, [0xdc, 0xdd]);
            items.iter().for_each(|item| write(bytes, item));
        }
        WireValue::Map(map) => write_map(bytes, map),
        WireValue::Array(array) => write_array(bytes, array),
    }
}

/// The marker of something that has a length, and the length: `short` is the greatest length within a marker, and the marker of none.
fn write_head(
    bytes: &mut Vec<u8>,
    length: usize,
    short: (usize, u8),
    one: Option<u8>,
    [two, four]: [u8; 2],
) {
    if length <= short.0 && short.1 != 0 {
        bytes.push(short.1 | length as u8);
    } else if let (Some(one), Ok(length)) = (one, u8::try_from(length)) {
        bytes.extend([one, length]);
    } else if let Ok(length) = u16::try_from(length) {
        bytes.push(two);
        bytes.extend(length.to_be_bytes());
    } else {
        // No frame is longer than 4 GiB.
        bytes.push(four);
        bytes.extend((length as u32).to_be_bytes());
    }
}

fn write_integer(bytes: &mut Vec<u8>, number: i64) {
    if let Ok(number @ 0..=0x7f) = u8::try_from(number) {
        bytes.push(number);
    } else if let Ok(number @ -32..=-1) = i8::try_from(number) {
        bytes.extend(number.to_be_bytes());
    } else if let Ok(number) = i32::try_from(number) {
        bytes.push(0xd2);
        bytes.extend(number.to_be_bytes());
    } else {
        bytes.push(0xd3);
        bytes.extend(number.to_be_bytes());
    }
}

fn write_text(bytes: &mut Vec<u8>, text: &str) {
    write_head(bytes, text.len(), (31, 0xa0), Some(0xd9), [0xda, 0xdb]);
    bytes.extend(text.as_bytes());
}

fn write_bytes(bytes: &mut Vec<u8>, content: &[u8]) {
    write_head(bytes, content.len(), (0, 0), Some(0xc4), [0xc5, 0xc6]);
    bytes.extend(content);
}

fn write_map(bytes: &mut Vec<u8>, map: &WireMap) {
    write_head(bytes, map.len(), (15, 0x80), None, [0xde, 0xdf]);
    for (key, value) in map {
        write_text(bytes, key);
        write(bytes, value);
    }
}

/// An array is a map whose keys are bytes.
fn write_array(bytes: &mut Vec<u8>, array: &NumpyArray) {
    write_head(bytes, 4, (15, 0x80), None, [0xde, 0xdf]);
    write_bytes(bytes, b"__ndarray__");
    write(bytes, &WireValue::Boolean(true));
    write_bytes(bytes, b"data");
    write_bytes(bytes, array.bytes());
    write_bytes(bytes, b"dtype");
    write_text(bytes, array.dtype().name());
    write_bytes(bytes, b"shape");
    write_head(bytes, array.shape().len(), (15, 0x90), None, [0xdc, 0xdd]);
    for side in array.shape() {
        write_integer(bytes, i64::try_from(*side).unwrap_or(i64::MAX));
    }
}
