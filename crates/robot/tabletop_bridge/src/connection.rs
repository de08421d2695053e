//! Connections that are not waited for longer than one wants to.

use std::{
    io,
    net::{TcpStream, ToSocketAddrs as _},
    time::Duration,
};

use crate::{address::authority, transport::TransportError};

/// A connection to a host, whose small messages are sent at once. Each of the host's addresses has that time.
pub(crate) fn connect_within(
    host: &str,
    port: u16,
    patience: Duration,
) -> Result<TcpStream, TransportError> {
    let unreachable = |source| TransportError::Unreachable {
        address: authority(host, port),
        source,
    };
    let addresses = (host, port).to_socket_addrs().map_err(unreachable)?;
    let mut fault = io::Error::new(io::ErrorKind::NotFound, "the host has no address");
    for address in addresses {
        let connected = TcpStream::connect_timeout(&address, patience);
        match connected.and_then(|stream| stream.set_nodelay(true).map(|()| stream)) {
            Ok(stream) => return Ok(stream),
            Err(error) => fault = error,
        }
    }
    Err(unreachable(fault))
}

/// True if a connection has not ended, but there was nothing to read or no room to write for as long as one wanted to wait.
pub(crate) fn is_timeout(error: &io::Error) -> bool {
    [io::ErrorKind::WouldBlock, io::ErrorKind::TimedOut].contains(&error.kind())
}
