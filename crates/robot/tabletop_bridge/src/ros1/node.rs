//! This program as a node of ROS 1: what its threads share.

use std::{
    collections::{BTreeMap, BTreeSet, VecDeque},
    io,
    net::{IpAddr, Shutdown, SocketAddr, TcpStream},
    sync::{
        Arc, Condvar, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, AtomicU64, Ordering},
        mpsc::SyncSender,
    },
    time::Duration,
};

use super::definition::MessageType;
use crate::{address::authority, clock::WallClock, transport::Received};

/// The most messages that wait to be polled; beyond that the oldest gives way.
const MOST_WAITING: usize = 256;

/// A node.
#[derive(Debug)]
pub(super) struct Node {
    /// Its name, which begins with a slash.
    pub(super) name: String,
    /// The address by which this computer is seen from the master.
    pub(super) host: IpAddr,
    /// The master's host, on which nodes are whose own name for their host nobody knows.
    pub(super) master_host: String,
    /// The ports where it is called, and where its messages are fetched.
    pub(super) rpc_port: u16,
    pub(super) message_port: u16,
    pub(super) clock: WallClock,
    /// What it publishes and reads, by topic.
    pub(super) publications: Mutex<BTreeMap<String, Publication>>,
    pub(super) subscriptions: Mutex<BTreeMap<String, Subscription>>,
    /// Messages that could not be understood.
    pub(super) nonsense: AtomicU64,
    inbox: Mutex<VecDeque<Received>>,
    arrived: Condvar,
    is_closed: AtomicBool,
    closing: (Mutex<()>, Condvar),
    streams: Mutex<(u64, BTreeMap<u64, TcpStream>)>,
}

/// A topic that is published.
#[derive(Debug)]
pub(super) struct Publication {
    pub(super) message: MessageType,
    pub(super) is_latched: bool,
    pub(super) last: Option<Arc<[u8]>>,
    /// Those who get its messages.
    pub(super) receivers: Vec<SyncSender<Arc<[u8]>>>,
}

/// A topic that is read.
#[derive(Debug)]
pub(super) struct Subscription {
    pub(super) message: MessageType,
    /// The nodes that publish it, and those that a thread follows.
    pub(super) publishers: BTreeSet<String>,
    pub(super) followed: BTreeSet<String>,
}

/// A connection that ends when the node is closed.
#[derive(Debug)]
pub(super) struct NodeStream {
    node: Arc<Node>,
    id: u64,
}

impl Node {
    /// A node that neither publishes nor reads.
    pub(super) fn new(
        name: String,
        host: IpAddr,
        master_host: &str,
        ports: [u16; 2],
        clock: WallClock,
    ) -> Self {
        Self {
            name,
            host,
            master_host: master_host.to_owned(),
            rpc_port: ports[0],
            message_port: ports[1],
            clock,
            publications: Mutex::default(),
            subscriptions: Mutex::default(),
            nonsense: AtomicU64::new(0),
            inbox: Mutex::default(),
            arrived: Condvar::new(),
            is_closed: AtomicBool::new(false),
            closing: (Mutex::default(), Condvar::new()),
            streams: Mutex::default(),
        }
    }

    /// Where it is called.
    pub(super) fn uri(&self) -> String {
        format!(
            "http://{}/",
            authority(&self.host.to_string(), self.rpc_port)
        )
    }

    /// A message has come.
    pub(super) fn deliver(&self, received: Received) {
        let mut inbox = lock(&self.inbox);
        inbox.push_back(received);
        if inbox.len() > MOST_WAITING {
            inbox.pop_front();
        }
        self.arrived.notify_one();
    }

    /// The next message, if one comes within a time.
    pub(super) fn next(&self, patience: Duration) -> Option<Received> {
        let inbox = lock(&self.inbox);
        let waited = self
            .arrived
            .wait_timeout_while(inbox, patience, |inbox| inbox.is_empty());
        let (mut inbox, _) = waited.unwrap_or_else(PoisonError::into_inner);
        inbox.pop_front()
    }

    pub(super) fn is_closed(&self) -> bool {
        self.is_closed.load(Ordering::SeqCst)
    }

    /// Waits for a time, or until the node is closed.
    pub(super) fn pause(&self, time: Duration) {
        let (mutex, closing) = &self.closing;
        let waited = closing.wait_timeout_while(lock(mutex), time, |()| !self.is_closed());
        drop(waited);
    }

    /// Takes care that a connection ends when the node is closed.
    pub(super) fn keep(self: &Arc<Self>, stream: &TcpStream) -> io::Result<NodeStream> {
        let clone = stream.try_clone()?;
        let id = {
            let mut streams = lock(&self.streams);
            streams.0 += 1;
            let id = streams.0;
            streams.1.insert(id, clone);
            id
        };
        let kept = NodeStream {
            node: self.clone(),
            id,
        };
        match self.is_closed() {
            true => Err(io::ErrorKind::ConnectionAborted.into()),
            false => Ok(kept),
        }
    }

    /// Ends all connections and threads.
    pub(super) fn close(&self) {
        {
            let _guard = lock(&self.closing.0);
            self.is_closed.store(true, Ordering::SeqCst);
        }
        self.closing.1.notify_all();
        lock(&self.publications).clear();
        for stream in lock(&self.streams).1.values() {
            drop(stream.shutdown(Shutdown::Both));
        }
        // Those who wait for connections get one.
        for port in [self.rpc_port, self.message_port] {
            let own = SocketAddr::new(self.host, port);
            drop(TcpStream::connect_timeout(&own, Duration::from_millis(100)));
        }
    }
}

impl Drop for NodeStream {
    fn drop(&mut self) {
        lock(&self.node.streams).1.remove(&self.id);
    }
}

/// What a mutex guards, even if a thread has panicked with it.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
