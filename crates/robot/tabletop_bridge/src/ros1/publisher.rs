//! Messages for other nodes.

use std::{
    io,
    net::{TcpListener, TcpStream},
    sync::{
        Arc,
        mpsc::{TrySendError, sync_channel},
    },
    thread::Builder,
};

use super::{
    node::{Node, lock},
    rpc::PATIENCE,
    tcpros::{ConnectionHeader, header, read_header, write_frame, write_header},
};
use crate::transport::TransportError;

/// The most messages that wait for a node. One that does not even take these gets no more: commands must not come late.
const MOST_WAITING: usize = 8;

/// The most connections at once.
const MOST_RECEIVERS: usize = 64;

/// Waits for nodes that want messages, until the node is closed.
pub(super) fn serve(node: &Arc<Node>, listener: &TcpListener) {
    for stream in listener.incoming() {
        if node.is_closed() {
            return;
        }
        let Ok(stream) = stream else {
            continue;
        };
        let of_thread = node.clone();
        let thread = Builder::new().name("writes messages".into());
        // Without a thread the connection ends, and the other node tries again.
        drop(thread.spawn(move || write_to(&of_thread, stream)));
    }
}

/// Writes to a node until its connection ends.
fn write_to(node: &Arc<Node>, mut stream: TcpStream) -> io::Result<()> {
    let _kept = node.keep(&stream)?;
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let theirs = read_header(&mut stream)?;
    let (sender, messages) = sync_channel(MOST_WAITING);
    let own = {
        let mut publications = lock(&node.publications);
        let of = |field: &str| theirs.get(field).map(String::as_str).unwrap_or_default();
        let topic = of("topic");
        let publication = publications.get_mut(topic);
        let publication = publication.filter(|it| it.receivers.len() < MOST_RECEIVERS);
        match publication {
            None => Err(format!("{topic} is not published here")),
            Some(it) if of("md5sum") != it.message.checksum && of("md5sum") != "*" => Err(format!(
                "{topic} is of the type {} with the checksum {}",
                it.message.name, it.message.checksum
            )),
            Some(it) => {
                if let Some(last) = it.last.clone().filter(|_| it.is_latched) {
                    drop(sender.try_send(last));
                }
                it.receivers.push(sender);
                Ok(header([
                    ("callerid", &node.name),
                    ("topic", topic),
                    ("type", &it.message.name),
                    ("md5sum", &it.message.checksum),
                    ("message_definition", &it.message.definition),
                    ("latching", if it.is_latched { "1" } else { "0" }),
                ]))
            }
        }
    };
    match own {
        Ok(own) => write_header(&mut stream, &own)?,
        Err(reason) => {
            let refusal: ConnectionHeader = header([("error", &reason)]);
            return write_header(&mut stream, &refusal);
        }
    }
    for message in messages {
        write_frame(&mut stream, &message)?;
    }
    Ok(())
}

/// Sends a message to all nodes that want it.
pub(super) fn publish(node: &Node, topic: &str, bytes: &Arc<[u8]>) -> Result<(), TransportError> {
    let mut publications = lock(&node.publications);
    let publication = publications
        .get_mut(topic)
        .ok_or_else(|| TransportError::Unfit {
            topic: topic.to_owned(),
            fault: "it was not advertised".into(),
        })?;
    publication.last = Some(bytes.clone());
    let mut is_stuck = false;
    publication
        .receivers
        .retain(|receiver| match receiver.try_send(bytes.clone()) {
            Ok(()) => true,
            Err(TrySendError::Full(_)) => {
                is_stuck = true;
                false
            }
            Err(TrySendError::Disconnected(_)) => false,
        });
    match is_stuck && publication.receivers.is_empty() {
        true => Err(TransportError::Stuck(topic.to_owned())),
        false => Ok(()),
    }
}
