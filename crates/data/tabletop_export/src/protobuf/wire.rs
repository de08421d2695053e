//! The bytes of Protocol Buffers.

const VARINT: u32 = 0;
const EIGHT_BYTES: u32 = 1;
const LENGTH_FIRST: u32 = 2;
const FOUR_BYTES: u32 = 5;

/// Writes a field that has a length: a text, bytes, a message or packed numbers.
pub(crate) fn field(to: &mut Vec<u8>, number: u32, bytes: &[u8]) {
    tag(to, number, LENGTH_FIRST);
    varint(to, bytes.len() as u64);
    to.extend_from_slice(bytes);
}

/// Writes a field with a whole number.
pub(crate) fn whole(to: &mut Vec<u8>, number: u32, value: u64) {
    tag(to, number, VARINT);
    varint(to, value);
}

/// Writes a field with a number of 64 bits.
pub(crate) fn eight_bytes(to: &mut Vec<u8>, number: u32, bytes: [u8; 8]) {
    tag(to, number, EIGHT_BYTES);
    to.extend(bytes);
}

/// Writes a field with a number of 32 bits.
pub(crate) fn four_bytes(to: &mut Vec<u8>, number: u32, bytes: [u8; 4]) {
    tag(to, number, FOUR_BYTES);
    to.extend(bytes);
}

/// Writes a whole number of as many bytes as it needs.
pub(crate) fn varint(to: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        to.push(value as u8 | 0x80);
        value >>= 7;
    }
    to.push(value as u8);
}

fn tag(to: &mut Vec<u8>, number: u32, way: u32) {
    varint(to, u64::from(number << 3 | way));
}
