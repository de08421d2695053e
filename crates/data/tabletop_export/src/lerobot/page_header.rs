//! What a page of a Parquet file says of its size, before anything is reserved for it.

use std::io::{self, BufRead, ErrorKind};

/// Depth to which structures of a header are within each other: statistics in a kind of page in a page.
const DEEPEST: usize = 4;

/// The sizes of a page, in bytes, without its header.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct PageHeader {
    /// As it is read.
    pub uncompressed: u64,
    /// As it is in the file.
    pub compressed: u64,
}

impl PageHeader {
    /// Reads a header, in Thrift's compact protocol.
    ///
    /// # Errors
    /// It is none.
    pub fn read(file: &mut impl BufRead) -> io::Result<Self> {
        let mut header = Self::default();
        let mut field = 0;
        while let Some(kind) = next_field(file, &mut field)? {
            match (field, kind) {
                (2, INT) => header.uncompressed = size(file)?,
                (3, INT) => header.compressed = size(file)?,
                _ => skip(file, kind, DEEPEST)?,
            }
        }
        Ok(header)
    }
}

const BYTE: u8 = 3;
const INT: u8 = 5;
const DOUBLE: u8 = 7;
const BINARY: u8 = 8;
const LIST: u8 = 9;
const SET: u8 = 10;
const STRUCT: u8 = 12;

/// The kind of the next field of a structure; none at its end.
fn next_field(file: &mut impl BufRead, field: &mut i64) -> io::Result<Option<u8>> {
    let head = byte(file)?;
    if head == 0 {
        return Ok(None);
    }
    *field = match head >> 4 {
        0 => zigzag(varint(file)?),
        delta => field.saturating_add(delta.into()),
    };
    Ok(Some(head & 0xf))
}

fn skip(file: &mut impl BufRead, kind: u8, depth: usize) -> io::Result<()> {
    match kind {
        // The kind is the value.
        1 | 2 => Ok(()),
        BYTE => byte(file).map(drop),
        4..=6 => varint(file).map(drop),
        DOUBLE => skip_bytes(file, 8),
        BINARY => {
            let length = varint(file)?;
            skip_bytes(file, length)
        }
        LIST | SET if depth > 0 => {
            let head = byte(file)?;
            let count = match head >> 4 {
                0xf => varint(file)?,
                count => count.into(),
            };
            let kind = match head & 0xf {
                // In a list, each has its value in a byte.
                1 | 2 => BYTE,
                kind => kind,
            };
            (0..count).try_for_each(|_| skip(file, kind, depth - 1))
        }
        STRUCT if depth > 0 => {
            let mut field = 0;
            while let Some(kind) = next_field(file, &mut field)? {
                skip(file, kind, depth - 1)?;
            }
            Ok(())
        }
        _ => Err(foreign()),
    }
}

fn skip_bytes(file: &mut impl BufRead, mut count: u64) -> io::Result<()> {
    while count > 0 {
        let there = file
            .fill_buf()?
            .len()
            .min(usize::try_from(count).unwrap_or(usize::MAX));
        if there == 0 {
            return Err(ErrorKind::UnexpectedEof.into());
        }
        file.consume(there);
        count -= there as u64;
    }
    Ok(())
}

fn size(file: &mut impl BufRead) -> io::Result<u64> {
    u64::try_from(zigzag(varint(file)?)).map_err(|_| foreign())
}

fn byte(file: &mut impl BufRead) -> io::Result<u8> {
    let mut byte = [0];
    file.read_exact(&mut byte)?;
    Ok(byte[0])
}

fn varint(file: &mut impl BufRead) -> io::Result<u64> {
    let mut number = 0;
    for shift in (0..64).step_by(7) {
        let part = byte(file)?;
        number |= u64::from(part & 0x7f) << shift;
        if part < 0x80 {
            return Ok(number);
        }
    }
    Err(foreign())
}

const fn zigzag(number: u64) -> i64 {
    (number >> 1) as i64 ^ -((number & 1) as i64)
}

fn foreign() -> io::Error {
    io::Error::new(ErrorKind::InvalidData, "it is no header of a page")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sizes_are_found_and_the_rest_is_passed_over() {
        // A data page of 300 bytes, 40 of them in the file, a checksum, and a structure with a text and a list.
        let header = [
            0x15, 0, 0x15, 0xd8, 0x04, 0x15, 80, 0x15, 2, 0x1c, 0x18, 2, b'a', b'b', 0x19, 0x25, 2,
            4, 0, 0,
        ];
        let mut file = &header[..];
        let expected = PageHeader {
            uncompressed: 300,
            compressed: 40,
        };
        assert_eq!(PageHeader::read(&mut file).unwrap(), expected);
        assert!(file.is_empty());
        for length in 0..header.len() {
            assert!(
                PageHeader::read(&mut &header[..length]).is_err(),
                "{length}"
            );
        }
    }

    #[test]
    fn what_is_no_header_is_refused() {
        let negative = [0x15, 0, 0x15, 1, 0];
        let deep = [0x1c_u8; 9];
        let endless = [0xff; 20];
        for bytes in [&negative[..], &deep, &endless] {
            assert!(PageHeader::read(&mut &*bytes).is_err());
        }
    }
}
