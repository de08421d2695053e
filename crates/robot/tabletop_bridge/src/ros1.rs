//! ROS 1 as its nodes speak it, so that a robot needs nothing but a cable: calls in XML-RPC, messages by TCPROS.

mod codec;
mod definition;
mod http;
mod node;
mod publisher;
mod rpc;
mod service;
mod slave;
mod subscriber;
mod tcpros;
mod xmlrpc;

use std::{
    collections::BTreeSet,
    io,
    net::TcpListener,
    process,
    sync::{Arc, atomic::Ordering},
    thread::Builder,
    time::Duration,
};

use codec::encode;
use definition::MessageType;
use node::{Node, Publication, Subscription, lock};
use rpc::{PATIENCE, RpcPeer};
use serde_json::{Value as Json, json};
use xmlrpc::RpcValue;

use crate::{
    address::authority,
    clock::WallClock,
    connection::connect_within,
    transport::{Listener, Received, ServiceCall, TopicType, Transport, TransportError},
};

/// A node of ROS 1, known to a master.
#[derive(Debug)]
pub struct Ros1 {
    node: Arc<Node>,
    master: RpcPeer,
}

impl Ros1 {
    /// Makes a node. The master, and the nodes to which it publishes, reach it by the address from which it reaches the master.
    ///
    /// # Errors
    /// There is no master, or this computer gives no ports and threads.
    pub fn connect(host: &str, port: u16, clock: WallClock) -> Result<Self, TransportError> {
        let unreachable = |source: io::Error| TransportError::Unreachable {
            address: authority(host, port),
            source,
        };
        let master = RpcPeer {
            host: host.to_owned(),
            port,
        };
        let own = connect_within(host, port, PATIENCE)?
            .local_addr()
            .map_err(unreachable)?
            .ip();
        let listen = || {
            let listener = TcpListener::bind((own, 0)).map_err(unreachable)?;
            let port = listener.local_addr().map_err(unreachable)?.port();
            Ok::<_, TransportError>((listener, port))
        };
        let ((calls, rpc_port), (messages, message_port)) = (listen()?, listen()?);
        let name = format!("/tabletop_{}_{rpc_port}", process::id());
        let node = Arc::new(Node::new(name, own, host, [rpc_port, message_port], clock));
        // From here on a fault closes it.
        let ros = Self { node, master };
        ros.ask("getPid", &[])?;
        let of_calls = ros.node.clone();
        let thread = Builder::new().name("is called".into());
        thread
            .spawn(move || slave::serve(&of_calls, &calls))
            .map_err(unreachable)?;
        let of_messages = ros.node.clone();
        let thread = Builder::new().name("is asked for messages".into());
        thread
            .spawn(move || publisher::serve(&of_messages, &messages))
            .map_err(unreachable)?;
        Ok(ros)
    }

    /// Asks the master, to whom the node says its name first.
    fn ask(&self, method: &str, arguments: &[&str]) -> Result<Option<RpcValue>, TransportError> {
        let texts = [self.node.name.as_str()]
            .into_iter()
            .chain(arguments.iter().copied());
        let texts: Vec<_> = texts.map(RpcValue::text).collect();
        self.master.ask(method, &texts)
    }
}

impl Listener for Ros1 {
    fn subscribe(&mut self, topic: &TopicType) -> Result<(), TransportError> {
        let name = &topic.topic;
        let subscription = Subscription {
            message: find(topic)?,
            publishers: BTreeSet::new(),
            followed: BTreeSet::new(),
        };
        lock(&self.node.subscriptions)
            .entry(name.clone())
            .or_insert(subscription);
        let publishers = self.ask(
            "registerSubscriber",
            &[name, &topic.message, &self.node.uri()],
        )?;
        let publishers = publishers
            .as_ref()
            .and_then(RpcValue::as_list)
            .unwrap_or_default();
        let publishers = publishers
            .iter()
            .filter_map(RpcValue::as_text)
            .map(str::to_owned);
        subscriber::follow_publishers(&self.node, name, publishers.collect());
        Ok(())
    }

    fn parameter(&mut self, name: &str, _: Duration) -> Result<Option<Json>, TransportError> {
        let value = self.ask("getParam", &[name])?;
        Ok(value.as_ref().map(json_of))
    }

    fn type_of(&mut self, topic: &str, _: Duration) -> Result<Option<String>, TransportError> {
        let published = self.ask("getPublishedTopics", &[""])?;
        let published = published.as_ref().and_then(RpcValue::as_list);
        let mut types = published.unwrap_or_default().iter().filter_map(|pair| {
            let [name, kind] = pair.as_list()? else {
                return None;
            };
            (name.as_text()? == topic).then_some(kind.as_text()?.to_owned())
        });
        Ok(types.next_back())
    }

    fn poll(&mut self, deadline: Duration) -> Result<Option<Received>, TransportError> {
        let patience = self.node.clock.until(deadline);
        match patience.is_zero() {
            true => Ok(None),
            false => Ok(self.node.next(patience)),
        }
    }

    fn nonsense(&self) -> u64 {
        self.node.nonsense.load(Ordering::Relaxed)
    }
}

impl Transport for Ros1 {
    fn advertise(&mut self, topic: &TopicType, latched: bool) -> Result<(), TransportError> {
        let publication = Publication {
            message: find(topic)?,
            is_latched: latched,
            last: None,
            receivers: Vec::new(),
        };
        lock(&self.node.publications)
            .entry(topic.topic.clone())
            .or_insert(publication);
        self.ask(
            "registerPublisher",
            &[&topic.topic, &topic.message, &self.node.uri()],
        )?;
        Ok(())
    }

    fn publish(&mut self, topic: &str, message: &Json) -> Result<(), TransportError> {
        let bytes = {
            let publications = lock(&self.node.publications);
            let kind = publications.get(topic).map(|it| &it.message);
            kind.map(|kind| encode(kind, message))
        };
        let bytes = bytes.unwrap_or_else(|| Err("it was not advertised".into()));
        let bytes = bytes.map_err(|fault| TransportError::Unfit {
            topic: topic.to_owned(),
            fault,
        })?;
        publisher::publish(&self.node, topic, &bytes.into())
    }

    fn listeners(&self, topic: &str) -> Option<usize> {
        let publications = lock(&self.node.publications);
        Some(publications.get(topic)?.receivers.len())
    }

    fn call(&mut self, call: &ServiceCall, patience: Duration) -> Result<Json, TransportError> {
        service::call(&self.node, &self.master, call, patience)
    }
}

impl Drop for Ros1 {
    /// Tells the master that it goes, as far as that still answers.
    fn drop(&mut self) {
        let uri = self.node.uri();
        let read: Vec<_> = lock(&self.node.subscriptions).keys().cloned().collect();
        let written: Vec<_> = lock(&self.node.publications).keys().cloned().collect();
        let goodbyes = [
            ("unregisterSubscriber", read),
            ("unregisterPublisher", written),
        ];
        let mut goodbyes = goodbyes
            .iter()
            .flat_map(|(method, topics)| topics.iter().map(move |topic| (method, topic)));
        while let Some((method, topic)) = goodbyes.next()
            && self.ask(method, &[topic, &uri]).is_ok()
        {}
        self.node.close();
    }
}

fn find(topic: &TopicType) -> Result<MessageType, TransportError> {
    MessageType::find(&topic.message).ok_or_else(|| TransportError::Unfit {
        topic: topic.topic.clone(),
        fault: format!("the type {} is not known", topic.message),
    })
}

fn json_of(value: &RpcValue) -> Json {
    match value {
        RpcValue::Int(number) => json!(number),
        RpcValue::Bool(truth) => json!(truth),
        RpcValue::Double(number) => json!(number),
        RpcValue::Text(text) => json!(text),
        RpcValue::List(values) => values.iter().map(json_of).collect(),
        RpcValue::Struct(members) => members
            .iter()
            .map(|(name, value)| (name.clone(), json_of(value)))
            .collect(),
    }
}
