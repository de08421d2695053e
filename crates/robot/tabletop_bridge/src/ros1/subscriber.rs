//! Messages of other nodes.

use std::{
    collections::BTreeSet,
    io,
    net::{TcpStream, ToSocketAddrs as _},
    sync::{Arc, atomic::Ordering},
    thread::Builder,
    time::Duration,
};

use super::{
    codec::decode,
    definition::MessageType,
    node::{Node, lock},
    rpc::{PATIENCE, RpcPeer},
    tcpros::{header, read_frame, read_header, write_header},
    xmlrpc::RpcValue,
};
use crate::{
    address::authority,
    connection::connect_within,
    transport::{Received, TransportError},
};

/// The time after which a node is asked again that did not answer, or has gone.
const RETRY: Duration = Duration::from_millis(500);

/// The nodes that publish a topic are now these; those that are new are followed.
pub(super) fn follow_publishers(node: &Arc<Node>, topic: &str, publishers: BTreeSet<String>) {
    let mut subscriptions = lock(&node.subscriptions);
    let Some(subscription) = subscriptions.get_mut(topic) else {
        return;
    };
    subscription.publishers = publishers;
    let new: Vec<_> = subscription
        .publishers
        .difference(&subscription.followed)
        .cloned()
        .collect();
    for uri in new {
        let (of_thread, topic, message) =
            (node.clone(), topic.to_owned(), subscription.message.clone());
        let publisher = uri.clone();
        let thread = Builder::new().name(format!("reads {topic}"));
        let thread = thread.spawn(move || follow(&of_thread, &topic, &message, &publisher));
        if thread.is_ok() {
            subscription.followed.insert(uri);
        }
    }
}

/// Reads from a node for as long as it publishes the topic.
fn follow(node: &Arc<Node>, topic: &str, message: &MessageType, publisher: &str) {
    loop {
        // A fault of a node shows in what does not come: the state gets old.
        drop(read_from(node, topic, message, publisher));
        node.pause(RETRY);
        let mut subscriptions = lock(&node.subscriptions);
        let Some(subscription) = subscriptions.get_mut(topic) else {
            return;
        };
        if node.is_closed() || !subscription.publishers.contains(publisher) {
            subscription.followed.remove(publisher);
            return;
        }
    }
}

/// Reads from a node until its connection ends.
fn read_from(
    node: &Arc<Node>,
    topic: &str,
    message: &MessageType,
    publisher: &str,
) -> Result<(), TransportError> {
    let mut stream = connect(node, topic, publisher)?;
    let lost = |error: io::Error| TransportError::Lost(format!("{publisher}: {error}"));
    let _kept = node.keep(&stream).map_err(lost)?;
    stream.set_read_timeout(Some(PATIENCE)).map_err(lost)?;
    let own = header([
        ("callerid", &node.name),
        ("topic", topic),
        ("type", &message.name),
        ("md5sum", &message.checksum),
        ("message_definition", &message.definition),
        ("tcp_nodelay", "1"),
    ]);
    write_header(&mut stream, &own).map_err(lost)?;
    let theirs = read_header(&mut stream).map_err(lost)?;
    if let Some(reason) = theirs.get("error") {
        return Err(TransportError::Declined {
            asked: publisher.to_owned(),
            reason: reason.clone(),
        });
    }
    let checksum = theirs.get("md5sum");
    if checksum.is_some_and(|checksum| *checksum != message.checksum && checksum != "*") {
        return Err(TransportError::Unfit {
            topic: topic.to_owned(),
            fault: format!("{publisher} has another {}", message.name),
        });
    }
    // A node may be silent for as long as it wants.
    stream.set_read_timeout(None).map_err(lost)?;
    loop {
        let frame = read_frame(&mut stream).map_err(lost)?;
        let at = node.clock.now();
        match decode(message, &frame) {
            Ok(message) => node.deliver(Received {
                topic: topic.to_owned(),
                message,
                at,
            }),
            Err(_) => drop(node.nonsense.fetch_add(1, Ordering::Relaxed)),
        }
    }
}

/// Asks a node where it sends a topic's messages, and connects there.
fn connect(node: &Node, topic: &str, publisher: &str) -> Result<TcpStream, TransportError> {
    let unfit = |fault: String| TransportError::Unfit {
        topic: topic.to_owned(),
        fault,
    };
    let peer =
        RpcPeer::parse(publisher).ok_or_else(|| unfit(format!("{publisher} is no address")))?;
    let peer = known(node, peer);
    let protocols = RpcValue::List(vec![RpcValue::List(vec![RpcValue::text("TCPROS")])]);
    let arguments = [RpcValue::text(&node.name), RpcValue::text(topic), protocols];
    let answer = peer.ask("requestTopic", &arguments)?;
    let answer = answer
        .as_ref()
        .and_then(RpcValue::as_list)
        .unwrap_or_default();
    let [_, host, port] = answer else {
        return Err(unfit(format!("{publisher} does not publish it by TCPROS")));
    };
    let port = port.as_int().and_then(|port| u16::try_from(port).ok());
    let (Some(host), Some(port)) = (host.as_text(), port) else {
        return Err(unfit(format!("{publisher} does not say where")));
    };
    let target = known(
        node,
        RpcPeer {
            host: host.to_owned(),
            port,
        },
    );
    connect_within(&target.host, target.port, PATIENCE)
}

/// The same peer under a host that this computer knows. Robots name themselves as their own network does; then it is the master's host, on which
/// all nodes of a robot are.
pub(super) fn known(node: &Node, peer: RpcPeer) -> RpcPeer {
    let name = authority(&peer.host, peer.port);
    let is_known = name
        .to_socket_addrs()
        .is_ok_and(|mut addresses| addresses.next().is_some());
    match is_known {
        true => peer,
        false => RpcPeer {
            host: node.master_host.clone(),
            port: peer.port,
        },
    }
}
