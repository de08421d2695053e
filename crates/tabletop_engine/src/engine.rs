//! The handle to an engine: requests go in, replies and printed lines come out.

use std::{
    sync::{
        Arc, Mutex, PoisonError,
        mpsc::{self, Receiver, Sender},
    },
    thread::{self, JoinHandle},
    time::Duration,
};

use crate::{
    config::EngineConfig,
    console::{Console, ConsoleLine},
    error::EngineError,
    reply::Reply,
    variables::{auxiliary::Aux, sensor::Sensor},
    worker::{Worker, process::Killer, signal::Signal},
};

/// How long an engine that is not needed any more may take to end by itself.
const FAREWELL: Duration = Duration::from_secs(10);
/// The same while somebody waits for it.
const SHORT_FAREWELL: Duration = Duration::from_secs(2);

/// An engine that runs, or is about to. Clones are the same engine; with the last of them it ends.
#[derive(Clone, Debug)]
pub struct EngineHandle(Arc<Shared>);

#[derive(Debug)]
struct Shared {
    inbox: Sender<Signal>,
    replies: Mutex<Receiver<Reply>>,
    console: Console,
    killer: Killer,
    thread: Option<JoinHandle<()>>,
}

impl EngineHandle {
    /// Starts an engine. This returns at once; [`Reply::Started`] or [`Reply::Failed`] follows.
    ///
    /// # Errors
    /// The system gives no more threads.
    pub fn start(config: EngineConfig) -> Result<Self, EngineError> {
        let (inbox, signals) = mpsc::channel();
        let (outbox, replies) = mpsc::channel();
        let console = Console::new(config.console_limit);
        let killer = Killer::default();
        let worker = Worker {
            config,
            inbox: signals,
            own_inbox: inbox.clone(),
            outbox,
            console: console.clone(),
            killer: killer.clone(),
        };
        let thread = thread::Builder::new()
            .name("script engine".into())
            .spawn(move || worker.run())
            .map_err(|error| EngineError::Start {
                engine: "a thread".into(),
                reason: error.to_string(),
            })?;
        Ok(Self(Arc::new(Shared {
            inbox,
            replies: Mutex::new(replies),
            console,
            killer,
            thread: Some(thread),
        })))
    }

    /// Asks for the init script, in an empty workspace. [`Reply::Init`] or [`Reply::Failed`] follows.
    pub fn init(&self, aux: Aux) {
        self.send(Signal::Init(Box::new(aux)));
    }

    /// Asks for the callback script. [`Reply::Step`] or [`Reply::Failed`] follows.
    pub fn step(&self, sensor: Sensor) {
        self.send(Signal::Step(Box::new(sensor)));
    }

    /// Ends the engine: it gets time to end by itself, in which it closes the script's files. A script that runs is interrupted.
    /// This does not wait.
    pub fn stop(&self) {
        self.send(Signal::Stop(FAREWELL));
    }

    /// Ends the engine and all that it has started, at once.
    pub fn kill(&self) {
        self.stop();
        self.0.killer.kill();
    }

    /// The next reply, or nothing if none comes in time or no more will.
    pub fn recv_timeout(&self, limit: Duration) -> Option<Reply> {
        let replies = self
            .0
            .replies
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        replies.recv_timeout(limit).ok()
    }

    /// What the script has printed since the last call, as far as [`EngineConfig::output`] lets it be kept.
    pub fn drain_console(&self) -> Vec<ConsoleLine> {
        self.0.console.drain()
    }

    /// Whether the engine has not ended.
    pub fn is_alive(&self) -> bool {
        self.0
            .thread
            .as_ref()
            .is_some_and(|thread| !thread.is_finished())
    }

    fn send(&self, signal: Signal) {
        // An engine that has ended has reported it; requests to it have no effect.
        drop(self.0.inbox.send(signal));
    }
}

impl Drop for Shared {
    fn drop(&mut self) {
        drop(self.inbox.send(Signal::Stop(SHORT_FAREWELL)));
        if let Some(thread) = self.thread.take() {
            drop(thread.join());
        }
    }
}
