//! Where other nodes and the master call this one.

use std::{
    collections::BTreeSet,
    io,
    net::{TcpListener, TcpStream},
    process,
    sync::Arc,
    thread::Builder,
};

use super::{
    http::{read_body, respond},
    node::{Node, lock},
    rpc::PATIENCE,
    subscriber::follow_publishers,
    xmlrpc::{RpcMessage, RpcValue, answer, parse},
};

/// Answers calls until the node is closed.
pub(super) fn serve(node: &Arc<Node>, listener: &TcpListener) {
    for stream in listener.incoming() {
        if node.is_closed() {
            return;
        }
        let Ok(stream) = stream else {
            continue;
        };
        let of_thread = node.clone();
        let thread = Builder::new().name("answers calls".into());
        // Without a thread the call ends without an answer.
        drop(thread.spawn(move || answer_call(&of_thread, &stream)));
    }
}

fn answer_call(node: &Arc<Node>, stream: &TcpStream) -> io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let body = read_body(stream)?;
    let said = match parse(&body) {
        Ok(RpcMessage::Call { method, arguments }) => carry_out(node, &method, &arguments),
        Ok(RpcMessage::Answer(_) | RpcMessage::Fault(_)) => refusal("this is no call"),
        Err(fault) => refusal(&fault),
    };
    respond(stream, &answer(&said))
}

/// Every call has the caller's name as its first argument.
fn carry_out(node: &Arc<Node>, method: &str, arguments: &[RpcValue]) -> RpcValue {
    let topic = arguments.get(1).and_then(RpcValue::as_text);
    match (method, topic) {
        ("requestTopic", Some(topic)) => match lock(&node.publications).contains_key(topic) {
            true => success(RpcValue::List(vec![
                RpcValue::text("TCPROS"),
                RpcValue::text(node.host.to_string()),
                RpcValue::Int(node.message_port.into()),
            ])),
            false => refusal(&format!("{topic} is not published here")),
        },
        ("publisherUpdate", Some(topic)) => {
            let publishers = arguments
                .get(2)
                .and_then(RpcValue::as_list)
                .unwrap_or_default();
            let publishers = publishers
                .iter()
                .filter_map(RpcValue::as_text)
                .map(str::to_owned);
            follow_publishers(node, topic, publishers.collect::<BTreeSet<_>>());
            success(RpcValue::Int(0))
        }
        ("getPid", _) => success(RpcValue::Int(process::id().try_into().unwrap_or_default())),
        ("getBusStats" | "getBusInfo" | "getSubscriptions" | "getPublications", _) => {
            success(RpcValue::List(Vec::new()))
        }
        // Nobody else ends this program, and it has no parameters that it keeps.
        ("shutdown" | "paramUpdate", _) => success(RpcValue::Int(0)),
        _ => refusal(&format!("{method} is not known here")),
    }
}

fn success(value: RpcValue) -> RpcValue {
    RpcValue::List(vec![RpcValue::Int(1), RpcValue::text(""), value])
}

fn refusal(why: &str) -> RpcValue {
    RpcValue::List(vec![
        RpcValue::Int(-1),
        RpcValue::text(why),
        RpcValue::Int(0),
    ])
}
