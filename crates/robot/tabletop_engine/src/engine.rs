//! The handle to an engine: requests go in, replies and printed lines come out.

use std::{
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        mpsc::{self, Receiver, Sender},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use crate::{
    config::{EngineConfig, Timeouts},
    console::{Console, ConsoleLine},
    error::EngineError,
    reply::Reply,
    variables::{auxiliary::Aux, sensor::Sensor},
    worker::{Worker, process::Killer, signal::Signal},
};

/// An engine that is no longer needed may take so long to end by itself.
const FAREWELL: Duration = Duration::from_secs(10);
/// The same while somebody waits for it.
const SHORT_FAREWELL: Duration = Duration::from_secs(2);

/// So long after its time limit, a request fails even if the engine's thread does not say so.
const BACKSTOP: Duration = Duration::from_secs(10);
/// The end of that thread is waited for so much longer than the engine's farewell.
const LAST_WAIT: Duration = Duration::from_secs(8);

/// An engine that runs, or is about to. Clones are the same engine; with the last of them it ends.
#[derive(Clone, Debug)]
pub struct EngineHandle(Arc<Shared>);

#[derive(Debug)]
struct Shared {
    inbox: Sender<Signal>,
    replies: Mutex<Receiver<Reply>>,
    timeouts: Timeouts,
    /// The request that has no reply yet.
    pending: Mutex<Option<Pending>>,
    console: Console,
    killer: Killer,
    thread: Option<JoinHandle<()>>,
}

/// A request without a reply.
#[derive(Clone, Copy, Debug)]
struct Pending {
    what: &'static str,
    since: Instant,
    limit: Duration,
}

impl Pending {
    fn new(what: &'static str, limit: Duration) -> Self {
        let since = Instant::now();
        Self { what, since, limit }
    }

    /// The time after which nobody waits for the engine's thread any more, which should have ended it long before.
    fn rest(&self) -> Duration {
        self.limit
            .saturating_add(BACKSTOP)
            .saturating_sub(self.since.elapsed())
    }
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
        let timeouts = config.timeouts;
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
            timeouts,
            pending: Mutex::new(Some(Pending::new("the engine's start", timeouts.start))),
            console,
            killer,
            thread: Some(thread),
        })))
    }

    /// Asks for the init script, in an empty workspace. [`Reply::Init`] or [`Reply::Failed`] follows.
    pub fn init(&self, aux: Aux) {
        self.expect("the init script", self.0.timeouts.init);
        self.send(Signal::Init(Box::new(aux)));
    }

    /// Asks for the callback script. [`Reply::Step`] or [`Reply::Failed`] follows.
    pub fn step(&self, sensor: Sensor) {
        self.expect("the callback script", self.0.timeouts.step);
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

    /// The next reply, or nothing if none comes in time or no more will. A request whose time is long over fails, even if
    /// the engine's thread is stuck.
    pub fn recv_timeout(&self, limit: Duration) -> Option<Reply> {
        let replies = lock(&self.0.replies);
        let pending = *lock(&self.0.pending);
        let wait = pending.map_or(limit, |pending| limit.min(pending.rest()));
        if let Ok(reply) = replies.recv_timeout(wait) {
            *lock(&self.0.pending) = None;
            return Some(reply);
        }
        let Pending { what, limit, .. } = pending.filter(|pending| pending.rest().is_zero())?;
        *lock(&self.0.pending) = None;
        self.kill();
        let stack = Vec::new();
        Some(Reply::Failed(EngineError::Timeout { what, limit, stack }))
    }

    /// The output of the script since the last call, as far as [`EngineConfig::console_limit`] lets it be kept.
    pub fn drain_console(&self) -> Vec<ConsoleLine> {
        self.0.console.drain()
    }

    /// True if the engine has not ended.
    pub fn is_alive(&self) -> bool {
        self.0
            .thread
            .as_ref()
            .is_some_and(|thread| !thread.is_finished())
    }

    fn expect(&self, what: &'static str, limit: Duration) {
        *lock(&self.0.pending) = Some(Pending::new(what, limit));
    }

    fn send(&self, signal: Signal) {
        // An engine that has ended has reported it; requests to it have no effect.
        drop(self.0.inbox.send(signal));
    }
}

impl Drop for Shared {
    fn drop(&mut self) {
        drop(self.inbox.send(Signal::Stop(SHORT_FAREWELL)));
        let Some(thread) = self.thread.take() else {
            return;
        };
        for patience in [SHORT_FAREWELL + LAST_WAIT, LAST_WAIT] {
            if is_finished_within(&thread, patience) {
                drop(thread.join());
                return;
            }
            // Something keeps the thread, such as a pipe that is full; with the engine it goes.
            self.killer.kill();
        }
    }
}

fn is_finished_within(thread: &JoinHandle<()>, limit: Duration) -> bool {
    let start = Instant::now();
    while !thread.is_finished() && start.elapsed() < limit {
        thread::sleep(Duration::from_millis(1));
    }
    thread.is_finished()
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
