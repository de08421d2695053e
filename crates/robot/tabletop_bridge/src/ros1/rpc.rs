//! Calls of a master's and of other nodes' methods.

use std::time::Duration;

use super::{
    http::{post, read_body},
    xmlrpc::{RpcMessage, RpcValue, call, parse},
};
use crate::{
    address::{authority, host_and_port},
    connection::connect_within,
    transport::TransportError,
};

/// How long an answer is waited for.
pub(super) const PATIENCE: Duration = Duration::from_secs(2);

/// A master or another node, where it can be called.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct RpcPeer {
    pub(super) host: String,
    pub(super) port: u16,
}

/// A peer's answer that it cannot do what it was asked for.
const NO: &str = "it answers with an error";

impl RpcPeer {
    /// The peer of a URI such as `http://host:1234/`.
    pub(super) fn parse(uri: &str) -> Option<Self> {
        let (_, rest) = uri.split_once("://")?;
        let authority = rest.split('/').next()?;
        let (host, port) = host_and_port(authority, None).ok()?;
        Some(Self { host, port })
    }

    /// Calls a method, and returns the value of its answer `[1, status, value]`. None if the peer says that it is not so (`[-1, status, value]`).
    ///
    /// # Errors
    /// The peer cannot be reached, or is no node.
    pub(super) fn ask(
        &self,
        method: &str,
        arguments: &[RpcValue],
    ) -> Result<Option<RpcValue>, TransportError> {
        let address = authority(&self.host, self.port);
        let foreign = |fault: String| TransportError::Foreign {
            address: address.clone(),
            expected: "node of ROS 1",
            fault,
        };
        let stream = connect_within(&self.host, self.port, PATIENCE)?;
        let exchange = || {
            stream.set_read_timeout(Some(PATIENCE))?;
            stream.set_write_timeout(Some(PATIENCE))?;
            post(&stream, &address, "/", &call(method, arguments))?;
            read_body(&stream)
        };
        let body = exchange().map_err(|error| foreign(format!("{method}: {error}")))?;
        match parse(&body).map_err(foreign)? {
            RpcMessage::Answer(RpcValue::List(mut answer)) if answer.len() == 3 => {
                let value = answer.pop();
                match answer.first().and_then(RpcValue::as_int) {
                    Some(1) => Ok(value),
                    Some(-1) => Ok(None),
                    Some(_) | None => Err(TransportError::Declined {
                        asked: format!("{method} of {address}"),
                        reason: answer
                            .get(1)
                            .and_then(RpcValue::as_text)
                            .unwrap_or(NO)
                            .to_owned(),
                    }),
                }
            }
            RpcMessage::Fault(fault) => Err(foreign(format!("{method}: {fault:?}"))),
            RpcMessage::Answer(_) | RpcMessage::Call { .. } => {
                Err(foreign(format!("{method} has no answer of three values")))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peers_are_read_from_their_addresses() {
        let peer = RpcPeer::parse("http://011305P0002.local:40123/").unwrap();
        assert_eq!(
            (peer.host.as_str(), peer.port),
            ("011305P0002.local", 40123)
        );
        assert_eq!(
            RpcPeer::parse("rosrpc://[fe80::1]:7").unwrap().host,
            "fe80::1"
        );
        for wrong in ["", "http://", "http://host/", "host:1", "http://host:0/"] {
            assert_eq!(RpcPeer::parse(wrong), None, "{wrong}");
        }
    }
}
