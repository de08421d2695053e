//! Calls of other nodes' services.

use std::{
    io::{self, Read as _},
    time::Duration,
};

use serde_json::Value as Json;

use super::{
    codec::{decode, encode},
    definition::ServiceType,
    node::Node,
    rpc::RpcPeer,
    subscriber::known,
    tcpros::{header, read_frame, read_header, write_frame, write_header},
    xmlrpc::RpcValue,
};
use crate::{
    connection::{connect_within, is_timeout},
    transport::{ServiceCall, TransportError},
};

/// Calls a service that the master knows.
pub(super) fn call(
    node: &Node,
    master: &RpcPeer,
    call: &ServiceCall,
    patience: Duration,
) -> Result<Json, TransportError> {
    let service = &call.service;
    let unfit = |fault: String| TransportError::Unfit {
        topic: service.clone(),
        fault,
    };
    let kind = ServiceType::find(&call.service_type);
    let kind = kind.ok_or_else(|| unfit(format!("the type {} is not known", call.service_type)))?;
    let request = encode(&kind.request, &call.request).map_err(unfit)?;
    let declined = |reason: String| TransportError::Declined {
        asked: service.clone(),
        reason,
    };
    let arguments = [RpcValue::text(&node.name), RpcValue::text(service)];
    let uri = master.ask("lookupService", &arguments)?;
    let uri = uri.ok_or_else(|| declined("there is no such service".into()))?;
    let peer = uri.as_text().and_then(RpcPeer::parse);
    let peer = peer.ok_or_else(|| unfit("the master has no address of it".into()))?;
    let peer = known(node, peer);
    let mut stream = connect_within(&peer.host, peer.port, patience)?;
    let lost = |error: io::Error| match is_timeout(&error) {
        true => TransportError::NoReply {
            asked: service.clone(),
            patience,
        },
        false => TransportError::Lost(format!("{service}: {error}")),
    };
    stream.set_read_timeout(Some(patience)).map_err(lost)?;
    stream.set_write_timeout(Some(patience)).map_err(lost)?;
    let own = header([
        ("callerid", &node.name),
        ("service", service),
        ("md5sum", &kind.checksum),
    ]);
    write_header(&mut stream, &own).map_err(lost)?;
    let theirs = read_header(&mut stream).map_err(lost)?;
    if let Some(reason) = theirs.get("error") {
        return Err(declined(reason.clone()));
    }
    write_frame(&mut stream, &request).map_err(lost)?;
    let mut is_done = [0];
    stream.read_exact(&mut is_done).map_err(lost)?;
    let answer = read_frame(&mut stream).map_err(lost)?;
    match is_done {
        [0] => Err(declined(String::from_utf8_lossy(&answer).into_owned())),
        [_] => decode(&kind.answer, &answer).map_err(unfit),
    }
}
