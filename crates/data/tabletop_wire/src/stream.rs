//! Streams that nobody waits for longer than he wants to.

use std::{
    io::{self, Read, Write},
    net::{TcpStream, ToSocketAddrs as _},
    time::{Duration, Instant},
};

/// The most bytes of a frame: four pictures of 2048x2048, and 16 MiB more.
pub(crate) const MOST_BYTES: usize = 64 << 20;

/// The shortest wait for bytes: a system's clock knows no shorter ones.
const SHORTEST_WAIT: Duration = Duration::from_millis(1);

/// A stream of which nothing is read or written after a deadline, even if bytes come one by one.
#[derive(Debug)]
pub(crate) struct PatientStream {
    stream: TcpStream,
    /// `None` to wait for ever.
    pub deadline: Option<Instant>,
}

impl PatientStream {
    /// A stream whose small messages are sent at once, until the deadline.
    pub fn new(stream: TcpStream, deadline: Instant) -> io::Result<Self> {
        stream.set_nodelay(true)?;
        Ok(Self {
            stream,
            deadline: Some(deadline),
        })
    }

    /// Connects to a host, one of its addresses after the other, until the deadline.
    pub fn connect(host: &str, port: u16, deadline: Instant) -> io::Result<Self> {
        let mut fault = io::Error::new(io::ErrorKind::NotFound, "the host has no address");
        for address in (host, port).to_socket_addrs()? {
            let wait = deadline.saturating_duration_since(Instant::now());
            let connected = TcpStream::connect_timeout(&address, wait.max(SHORTEST_WAIT));
            match connected.and_then(|stream| Self::new(stream, deadline)) {
                Ok(stream) => return Ok(stream),
                Err(error) => fault = error,
            }
        }
        Err(fault)
    }

    /// The time that is left; an error if none is.
    fn wait(&self) -> io::Result<Option<Duration>> {
        let left = |deadline: Instant| deadline.saturating_duration_since(Instant::now());
        match self.deadline.map(left) {
            Some(Duration::ZERO) => Err(io::ErrorKind::WouldBlock.into()),
            wait => Ok(wait.map(|wait| wait.max(SHORTEST_WAIT))),
        }
    }
}

impl Read for PatientStream {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.stream.set_read_timeout(self.wait()?)?;
        self.stream.read(bytes)
    }
}

impl Write for PatientStream {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.set_write_timeout(self.wait()?)?;
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

/// True if there was nothing to read, or no room to write, until the deadline.
pub(crate) fn is_timeout(error: &io::Error) -> bool {
    [io::ErrorKind::WouldBlock, io::ErrorKind::TimedOut].contains(&error.kind())
}
