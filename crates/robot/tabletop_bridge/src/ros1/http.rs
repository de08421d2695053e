//! As much of HTTP as XML-RPC needs: a text is posted, and a text comes back.

use std::{
    io::{self, BufRead as _, BufReader, Read, Write},
    net::TcpStream,
};

/// The most bytes of a head, and of a body: a robot's description, the longest parameter, has some 100 kB.
const MOST_HEAD: u64 = 1 << 14;
const MOST_BODY: usize = 1 << 22;

/// The body of a request or an answer.
pub(super) fn read_body(stream: &TcpStream) -> io::Result<String> {
    let mut reader = BufReader::new(stream);
    let mut length = None;
    let mut head = (&mut reader).take(MOST_HEAD);
    let mut line = String::new();
    loop {
        line.clear();
        if head.read_line(&mut line)? == 0 {
            return Err(invalid("its head does not end"));
        }
        let line = line.trim_end();
        if line.is_empty() {
            break;
        }
        if let Some((name, value)) = line.split_once(':')
            && name.eq_ignore_ascii_case("content-length")
        {
            let value = value.trim().parse::<usize>();
            length = Some(value.map_err(|_| invalid("its length is no number"))?);
        }
    }
    let length = length.ok_or_else(|| invalid("it does not say how long it is"))?;
    if length > MOST_BODY {
        return Err(invalid("it is too long"));
    }
    let mut body = vec![0; length];
    reader.read_exact(&mut body)?;
    String::from_utf8(body).map_err(|_| invalid("it is no UTF-8"))
}

/// Posts a text to a path of a host.
pub(super) fn post(mut stream: &TcpStream, host: &str, path: &str, body: &str) -> io::Result<()> {
    let head = format!(
        "POST {path} HTTP/1.0\r\nHost: {host}\r\nContent-Type: text/xml\r\nContent-Length: {}\r\n\r\n",
        body.len()
    );
    stream.write_all((head + body).as_bytes())
}

/// Answers with a text.
pub(super) fn respond(mut stream: &TcpStream, body: &str) -> io::Result<()> {
    let head = format!(
        "HTTP/1.0 200 OK\r\nContent-Type: text/xml\r\nContent-Length: {}\r\n\r\n",
        body.len()
    );
    stream.write_all((head + body).as_bytes())
}

fn invalid(fault: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, fault)
}
