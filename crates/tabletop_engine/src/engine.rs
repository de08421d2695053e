//! An engine from outside: what it is started with, the handle to it, and what it replies.

use std::{
    env,
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex, PoisonError,
        mpsc::{self, Receiver, Sender},
    },
    thread::{self, JoinHandle},
    time::Duration,
};

use crate::{
    agent::{Aux, InitReply},
    choice::EngineKind,
    console::{Console, ConsoleLine, Output},
    error::EngineError,
    find::FoundEngine,
    motor::Motor,
    private_folder::PrivateFolder,
    process::Killer,
    sensor::Sensor,
    worker::{Signal, Worker},
};

/// How an engine learns of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trigger {
    /// By a line on its standard input. Fast; not possible with MATLAB everywhere.
    Stdin,
    /// By a file that it looks at again and again. Not for Python and users' drivers.
    Poll,
}

/// How long to wait for an engine. What takes longer is ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timeouts {
    /// For its start.
    pub start: Duration,
    /// For the init script.
    pub init: Duration,
    /// For a call of the callback script.
    pub step: Duration,
}

impl Default for Timeouts {
    fn default() -> Self {
        Self {
            start: Duration::from_secs(120),
            init: Duration::from_secs(120),
            step: Duration::from_secs(30),
        }
    }
}

/// What an engine is started with.
#[derive(Clone, Debug)]
pub struct EngineConfig {
    /// The engine.
    pub engine: FoundEngine,
    /// How it learns of requests.
    pub trigger: Trigger,
    /// The folder that holds agentBehavior.m and the scripts that it names (MATLAB, Octave), or the file with the functions
    /// `init` and `callback` (Python), or whatever a user's driver runs. A relative path is one from the working directory.
    pub agent: PathBuf,
    /// The names of an init and a callback script to run instead of those that agentBehavior.m names.
    pub pair: Option<[String; 2]>,
    /// The directory in which the engine runs.
    pub working_dir: PathBuf,
    /// How long to wait.
    pub timeouts: Timeouts,
    /// Whether there is a display that figures can appear on.
    pub display: bool,
    /// How much is kept of what the script prints.
    pub output: Output,
    /// Where the agent is if its files come from the program; it goes with the last of those that need it.
    written: Option<Arc<PrivateFolder>>,
}

impl EngineConfig {
    /// The usual: scripts of the folder "matlab" (or the file "python/example.py") in the current directory.
    pub fn new(engine: FoundEngine) -> Self {
        let set = |name| env::var_os(name).is_some_and(|value| !value.is_empty());
        let unix = cfg!(unix) && !cfg!(target_os = "macos");
        Self {
            trigger: match engine.kind {
                EngineKind::Matlab => Trigger::Poll,
                EngineKind::Octave | EngineKind::Python | EngineKind::Driver => Trigger::Stdin,
            },
            agent: match engine.kind {
                EngineKind::Python => "python/example.py".into(),
                EngineKind::Driver => PathBuf::new(),
                EngineKind::Matlab | EngineKind::Octave => "matlab".into(),
            },
            engine,
            pair: None,
            working_dir: ".".into(),
            timeouts: Timeouts::default(),
            display: !unix || set("DISPLAY") || set("WAYLAND_DISPLAY"),
            output: Output::default(),
            written: None,
        }
    }

    /// Takes an agent of which nothing is on disk: its files, by their paths, are written to a folder that is there as long as the
    /// engine is. `agent` is the path of one of them, or of a folder.
    ///
    /// # Errors
    /// They cannot be written anywhere.
    pub fn write_agent<'a>(
        &mut self,
        agent: &Path,
        files: impl IntoIterator<Item = (&'a str, &'a str)> + Clone,
    ) -> Result<(), EngineError> {
        let folder = PrivateFolder::filled(|folder| {
            let mut files = files.clone().into_iter();
            files.try_for_each(|(path, text)| folder.write(path, text.as_bytes()))
        })?;
        self.agent = folder.path().join(agent);
        self.written = Some(Arc::new(folder));
        Ok(())
    }

    /// Whether the agent goes with the engine.
    pub(crate) fn is_agent_temporary(&self) -> bool {
        self.written.is_some()
    }
}

/// What comes back from an engine: one for its start, one for each request, and one when it ends.
#[derive(Clone, Debug)]
pub enum Reply {
    /// The engine is there.
    Started {
        /// Which one, with its version and program.
        description: String,
    },
    /// The init script has run.
    Init(InitReply),
    /// The callback script has run.
    Step(Box<StepReply>),
    /// Something went wrong. If [`EngineError::is_fatal`], nothing more comes; else there may be another [`EngineHandle::init`].
    Failed(EngineError),
}

/// What a callback script wants.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepReply {
    /// What the robot shall do.
    pub motor: Motor,
    /// Whether the script is done.
    pub exit: bool,
    /// How long it took, from writing the request to having read the answer.
    pub took: Duration,
}

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
        let console = Console::new(config.output);
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
        // An engine that has ended has said so; requests to it have no effect.
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
