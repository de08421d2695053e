//! TCPROS: the connections on which messages go from node to node.

use std::{
    collections::BTreeMap,
    io::{self, Read, Write},
};

/// The most bytes of a message: a picture of 1280x800 has 4 MB.
const MOST_BYTES: usize = 16 << 20;

/// The most bytes of a header.
const MOST_HEADER: usize = 1 << 16;

/// A connection's header: what each side says of itself first.
pub(super) type ConnectionHeader = BTreeMap<String, String>;

/// A header of some fields.
pub(super) fn header<const N: usize>(fields: [(&str, &str); N]) -> ConnectionHeader {
    let owned = fields.map(|(name, value)| (name.to_owned(), value.to_owned()));
    owned.into()
}

/// Writes a header.
pub(super) fn write_header(stream: &mut impl Write, header: &ConnectionHeader) -> io::Result<()> {
    let mut body = Vec::new();
    for (name, value) in header {
        let field = format!("{name}={value}");
        body.extend(length(field.len())?);
        body.extend(field.as_bytes());
    }
    write_frame(stream, &body)
}

/// Reads a header.
pub(super) fn read_header(stream: &mut impl Read) -> io::Result<ConnectionHeader> {
    let body = read_frame_of(stream, MOST_HEADER)?;
    let mut rest = body.as_slice();
    let mut header = ConnectionHeader::new();
    while let Some((length, after)) = rest.split_first_chunk() {
        rest = after;
        let length = u32::from_le_bytes(*length) as usize;
        let field = rest
            .split_off(..length)
            .and_then(|field| str::from_utf8(field).ok());
        let field = field.and_then(|field| field.split_once('='));
        let (name, value) =
            field.ok_or_else(|| invalid("its header has a field without a name"))?;
        header.insert(name.to_owned(), value.to_owned());
    }
    match rest.is_empty() {
        true => Ok(header),
        false => Err(invalid("its header ends too early")),
    }
}

/// Writes a message.
pub(super) fn write_frame(stream: &mut impl Write, body: &[u8]) -> io::Result<()> {
    let mut frame = Vec::with_capacity(body.len() + 4);
    frame.extend(length(body.len())?);
    frame.extend(body);
    stream.write_all(&frame)
}

/// Reads a message.
pub(super) fn read_frame(stream: &mut impl Read) -> io::Result<Vec<u8>> {
    read_frame_of(stream, MOST_BYTES)
}

fn read_frame_of(stream: &mut impl Read, most: usize) -> io::Result<Vec<u8>> {
    let mut length = [0; 4];
    stream.read_exact(&mut length)?;
    let length = u32::from_le_bytes(length) as usize;
    if length > most {
        return Err(invalid("it sends a message that is too long"));
    }
    let mut body = vec![0; length];
    stream.read_exact(&mut body)?;
    Ok(body)
}

fn length(bytes: usize) -> io::Result<[u8; 4]> {
    let length = u32::try_from(bytes).map_err(|_| invalid("a message is too long"))?;
    Ok(length.to_le_bytes())
}

fn invalid(fault: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, fault)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn headers_read_back_as_they_were_written() {
        let sent = header([
            ("topic", "/a"),
            ("md5sum", "*"),
            ("message_definition", "x=1\ny"),
        ]);
        let mut bytes = Vec::new();
        write_header(&mut bytes, &sent).unwrap();
        assert_eq!(read_header(&mut bytes.as_slice()).unwrap(), sent);
        assert_eq!(
            read_frame(&mut [255; 8].as_slice()).unwrap_err().kind(),
            io::ErrorKind::InvalidData
        );
    }

    proptest! {
        #[test]
        fn any_bytes_are_a_header_or_refused(body in prop::collection::vec(any::<u8>(), 0..100)) {
            let mut bytes = Vec::new();
            write_frame(&mut bytes, &body).unwrap();
            drop(read_header(&mut bytes.as_slice()));
            drop(read_header(&mut body.as_slice()));
        }
    }
}
