//! The thread on which an engine lives.

mod descendants;
mod driver;
mod ending;
mod exchange_folder;
mod launch;
mod output;
pub(crate) mod process;
pub(crate) mod signal;
mod trigger_file;

use std::{
    collections::VecDeque,
    fs, io,
    path::{Path, PathBuf},
    sync::mpsc::{Receiver, Sender},
    thread,
    time::{Duration, Instant},
};

use self::{
    exchange_folder::ExchangeFolder,
    launch::{command, preparation, quoted},
    output::read_output,
    process::{Killer, Process},
    signal::Signal,
    trigger_file::{Op, TriggerFile},
};
use crate::{
    config::{EngineConfig, Trigger},
    console::{Console, Stream},
    error::{EngineError, ScriptError},
    kind::EngineKind,
    octave::hint::hint,
    octave::script_folder::{self, Encoding},
    protocol::{Array, Arrays},
    reply::{Reply, StepReply},
    variables::auxiliary::{Aux, InitReply},
    variables::invalid_field::InvalidField,
    variables::motor::MotorCommand,
    variables::sensor::Sensor,
};

/// So often, an engine that polls is shown that this program is alive, and one that waits is looked after.
const HEARTBEAT: Duration = Duration::from_secs(1);
/// So often, an engine that runs a script is looked after.
const LOOK_AFTER: Duration = Duration::from_millis(50);
/// An engine that does not listen or was interrupted may take so long to end by itself.
const GRACE: Duration = Duration::from_secs(1);
/// Figures are brought up to date at most this often.
const DRAW_INTERVAL: Duration = Duration::from_millis(200);

/// A note for the user about an agent that is not on disk.
const TEMPORARY: &str = "the program's own scripts run in a temporary folder: files that they save there are removed with it";

/// The engine's side of the program.
pub(crate) struct Worker {
    pub(crate) config: EngineConfig,
    pub(crate) inbox: Receiver<Signal>,
    pub(crate) own_inbox: Sender<Signal>,
    pub(crate) outbox: Sender<Reply>,
    pub(crate) console: Console,
    pub(crate) killer: Killer,
}

impl Worker {
    /// Starts the engine and serves requests until the end.
    pub(crate) fn run(self) {
        let outbox = self.outbox.clone();
        let error = match Running::start(self) {
            Ok(running) => running.serve(),
            Err(error) => error,
        };
        // If nobody listens any more, nobody needs to know.
        drop(outbox.send(Reply::Failed(error)));
    }
}

/// An engine that has been started.
struct Running {
    worker: Worker,
    // The process and the open file go before the folder in which they are.
    process: Process,
    trigger_file: Option<TriggerFile>,
    session: ExchangeFolder,
    waiting: VecDeque<Signal>,
    seq: u32,
    open_outputs: u32,
    last_drawn: Option<Instant>,
    /// The number of limbs, and of joints of each.
    size: [usize; 2],
    /// The script that is called back, if the engine has reported it.
    callback: Option<PathBuf>,
}

impl Running {
    fn start(worker: Worker) -> Result<Self, EngineError> {
        let config = &worker.config;
        let session = ExchangeFolder::new(&driver::files(config.engine.kind))?;
        let trigger_file = match config.trigger {
            Trigger::Poll => Some(TriggerFile::create(session.folder())?),
            Trigger::Stdin => None,
        };
        let start_fault = |reason: String| EngineError::Start {
            engine: config.engine.program.clone(),
            reason,
        };
        if !config.working_dir.is_dir() {
            let reason = format!(
                "there is no directory {} to run in",
                config.working_dir.display()
            );
            return Err(start_fault(reason));
        }
        let command = command(config, &session).map_err(start_fault)?;
        let piped = config.trigger == Trigger::Stdin;
        let process = Process::start(command, piped, session.folder(), worker.killer.clone());
        let process = process.map_err(|error| {
            if error.kind() == io::ErrorKind::Interrupted {
                EngineError::Stopped
            } else {
                start_fault(error.to_string())
            }
        })?;
        let mut running = Self {
            process,
            session,
            trigger_file,
            waiting: VecDeque::new(),
            seq: 0,
            open_outputs: 0,
            last_drawn: None,
            size: [0; 2],
            callback: None,
            worker,
        };
        running.read_outputs()?;
        running.hello()?;
        Ok(running)
    }

    fn read_outputs(&mut self) -> Result<(), EngineError> {
        for (output, stream) in self.process.outputs().zip([Stream::Out, Stream::Error]) {
            let console = self.worker.console.clone();
            let inbox = self.worker.own_inbox.clone();
            let kind = self.worker.config.engine.kind;
            self.open_outputs += 1;
            thread::Builder::new()
                .name("script output".into())
                .spawn(move || read_output(output, stream, kind, &console, &inbox))
                .map_err(|error| EngineError::Start {
                    engine: "a thread".into(),
                    reason: error.to_string(),
                })?;
        }
        Ok(())
    }

    fn hello(&mut self) -> Result<(), EngineError> {
        if self.worker.config.engine.kind == EngineKind::Octave
            && self.worker.config.trigger == Trigger::Stdin
        {
            let line = preparation(&self.worker.config, &self.session);
            self.process.write_line(&line).map_err(|_| self.death())?;
        }
        let limit = self.worker.config.timeouts.start;
        let reply = self.call(Op::Hello, "the engine's start", limit)?;
        let engine = reply
            .get("engine")
            .and_then(Array::as_text)
            .unwrap_or("an engine");
        let program = self.worker.config.engine.program.display();
        let description = format!("{engine} ({program})");
        drop(self.worker.outbox.send(Reply::Started { description }));
        if self.worker.config.is_agent_temporary() {
            self.note(TEMPORARY);
        }
        Ok(())
    }

    /// Serves requests until the engine ends, and returns why it did.
    fn serve(mut self) -> EngineError {
        let mut reaped = Instant::now();
        loop {
            if reaped.elapsed() >= HEARTBEAT {
                self.process.reap_orphans();
                reaped = Instant::now();
            }
            let signal = match self.waiting.pop_front() {
                Some(signal) => Ok(signal),
                None => self.worker.inbox.recv_timeout(HEARTBEAT),
            };
            let reply = match signal {
                Ok(Signal::Init(aux)) => self.init(&aux).map(Reply::Init),
                Ok(Signal::Step(sensor)) => {
                    self.step(&sensor).map(|reply| Reply::Step(Box::new(reply)))
                }
                Ok(Signal::Stop(limit)) => {
                    self.end(limit);
                    return EngineError::Stopped;
                }
                Ok(Signal::Done(_)) => continue,
                Ok(Signal::Closed) => {
                    self.note_closed_output();
                    // The end of the outputs comes a moment before that of the process.
                    match self.process.wait(LOOK_AFTER) {
                        Some(status) => return self.died(status),
                        None => continue,
                    }
                }
                Err(_) => {
                    if let Some(file) = &mut self.trigger_file {
                        file.beat();
                    }
                    match self.process.ended() {
                        Some(status) => return self.died(status),
                        None => continue,
                    }
                }
            };
            match reply {
                Ok(reply) => drop(self.worker.outbox.send(reply)),
                Err(error) if error.is_fatal() => {
                    self.end(GRACE);
                    return error;
                }
                Err(error) => drop(self.worker.outbox.send(Reply::Failed(error))),
            }
        }
    }

    fn init(&mut self, aux: &Aux) -> Result<InitReply, EngineError> {
        let config = &self.worker.config;
        let agent = config.agent_path();
        if let Some(fault) = config.fault() {
            return Err(EngineError::Script(ScriptError::plain(fault)));
        }
        let is_file = match config.engine.kind {
            EngineKind::Python | EngineKind::Driver => !agent.is_dir(),
            EngineKind::Matlab | EngineKind::Octave => false,
        };
        let folder = if is_file {
            config.agent.parent().unwrap_or(Path::new(""))
        } else {
            &config.agent
        };
        let mut path = match folder.to_string_lossy() {
            here if here.is_empty() => ".".to_owned(),
            folder => folder.into_owned(),
        };
        if !path.ends_with(['/', '\\']) {
            path.push('/');
        }
        self.size = aux.size();
        let mut arrays = aux.arrays(&path);
        arrays.put("agent.folder", Array::text(agent.to_string_lossy()));
        if let Some([init, callback]) = &config.pair {
            arrays.put("agent.init", Array::text(init.as_str()));
            arrays.put("agent.callback", Array::text(callback.as_str()));
        }
        if config.engine.kind == EngineKind::Octave {
            let encoding = Encoding::of(&agent);
            if let Some(note) = encoding.note() {
                self.note(&note);
            }
            if let Encoding::Windows(_) = encoding {
                arrays.put("agent.encoding", Array::text("windows-1252"));
            }
        }
        self.session.write_request(&arrays)?;
        let limit = config.timeouts.init;
        let reply = self.call(Op::Init, "the init script", limit)?;
        let [init, callback] = match self.worker.config.engine.kind {
            EngineKind::Python | EngineKind::Driver => [Some(agent.clone()), Some(agent)],
            EngineKind::Matlab | EngineKind::Octave => {
                let scripts = ["agent.init", "agent.callback"].map(|name| {
                    let file = reply.get(name).and_then(Array::as_text)?;
                    (!file.is_empty()).then(|| PathBuf::from(self.of_original(file)))
                });
                let notes = scripts
                    .iter()
                    .flatten()
                    .filter_map(|file| script_folder::note(file));
                notes.for_each(|note| self.note(&note));
                scripts
            }
        };
        self.callback = callback;
        InitReply::read(&reply, self.size).map_err(|field| self.invalid_field(field, init))
    }

    fn step(&mut self, sensor: &Sensor) -> Result<StepReply, EngineError> {
        let start = Instant::now();
        self.session.write_request(&sensor.arrays())?;
        let limit = self.worker.config.timeouts.step;
        let reply = self.call(Op::Step, "the callback script", limit)?;
        let motor = MotorCommand::read(&reply, self.size)
            .map_err(|field| self.invalid_field(field, self.callback.clone()))?;
        Ok(StepReply {
            motor,
            exit: reply.get("aux.exit").is_some(),
            took: start.elapsed(),
        })
    }

    /// The error for a field that a script has set and nobody can use.
    fn invalid_field(&self, field: InvalidField, script: Option<PathBuf>) -> EngineError {
        EngineError::InvalidField {
            field: field.written_for(self.worker.config.engine.kind),
            script,
        }
    }

    /// Counts the requests; none has the number 0.
    fn next_request(&mut self) {
        self.seq = self.seq.wrapping_add(1).max(1);
    }

    fn note_closed_output(&mut self) {
        self.open_outputs = self.open_outputs.saturating_sub(1);
    }

    /// Gives the engine a request and reads its answer.
    fn call(&mut self, op: Op, what: &'static str, limit: Duration) -> Result<Arrays, EngineError> {
        self.next_request();
        self.trigger(op)?;
        self.wait(what, limit)?;
        let reply = self.session.read_reply()?;
        let Some(mut error) = self.script_error(&reply) else {
            return Ok(reply);
        };
        if let Some(hint) = hint(&error, matches!(op, Op::Init)) {
            let link = match error.message.contains('\n') {
                true => "\n",
                false => ": ",
            };
            error.message = format!("{}{link}{hint}", error.message);
        }
        Err(EngineError::Script(error))
    }

    /// The error in a reply.
    fn script_error(&self, reply: &Arrays) -> Option<ScriptError> {
        reply.get("error.message")?;
        let text = |name| {
            let text = reply.get(name).and_then(Array::as_text);
            self.of_original(text.unwrap_or_default())
        };
        let [id, message, stack] = ["error.id", "error.message", "error.stack"].map(text);
        Some(ScriptError::new(&id, &message, &stack))
    }

    /// A text of the engine, with the user's scripts in place of repaired copies that it may run.
    fn of_original(&self, text: &str) -> String {
        let copies = self.session.folder().join("repaired");
        let agent = self.worker.config.agent_path();
        let mut original = text.to_owned();
        for copy in fs::read_dir(&copies).into_iter().flatten().flatten() {
            let name = copy.file_name();
            let (copy, script) = (copies.join(&name), agent.join(&name));
            original = original.replace(&*copy.to_string_lossy(), &script.to_string_lossy());
        }
        original.replace(".m.sourced", ".m")
    }

    /// Adds a remark to the output of the script.
    fn note(&self, note: &str) {
        self.worker.console.push(Stream::Note, note.as_bytes());
    }

    fn trigger(&mut self, op: Op) -> Result<(), EngineError> {
        let config = &self.worker.config;
        let draw = match op {
            Op::Hello => config.display,
            Op::End | Op::Init | Op::Step => {
                config.display
                    && self
                        .last_drawn
                        .is_none_or(|last| last.elapsed() >= DRAW_INTERVAL)
            }
        };
        if draw {
            self.last_drawn = Some(Instant::now());
        }
        let seq = self.seq;
        if let Some(file) = &mut self.trigger_file {
            return file.request(seq, op, draw);
        }
        let (name, draw) = (op.name(), u8::from(draw));
        let line = match config.engine.kind {
            EngineKind::Python | EngineKind::Driver => format!("{name} {seq}"),
            EngineKind::Matlab | EngineKind::Octave => {
                format!(
                    "tabletop_call('{name}', {}, {seq}, {draw}, 0);",
                    quoted(self.session.folder())
                )
            }
        };
        self.process.write_line(&line).map_err(|_| self.death())
    }

    /// Waits until the engine has carried out its request.
    fn wait(&mut self, what: &'static str, limit: Duration) -> Result<(), EngineError> {
        let start = Instant::now();
        let mut looked_after = start;
        loop {
            let waited = start.elapsed();
            if waited >= limit {
                let stack = self.interrupt();
                return Err(EngineError::Timeout { what, limit, stack });
            }
            let pause = match self.trigger_file {
                None => LOOK_AFTER,
                Some(_) if waited < Duration::from_millis(20) => Duration::from_micros(50),
                Some(_) => Duration::from_millis(1),
            };
            match self.worker.inbox.recv_timeout(pause.min(limit - waited)) {
                Ok(Signal::Done(seq)) if seq == self.seq => return Ok(()),
                Ok(Signal::Done(_)) => {}
                Ok(Signal::Stop(_)) => {
                    self.interrupt();
                    return Err(EngineError::Stopped);
                }
                Ok(Signal::Closed) => {
                    self.note_closed_output();
                    if self.process.wait(LOOK_AFTER).is_some() {
                        return Err(self.death());
                    }
                }
                Ok(request) => self.waiting.push_back(request),
                Err(_) => {}
            }
            if self
                .trigger_file
                .as_mut()
                .is_some_and(|file| file.is_done(self.seq))
            {
                return Ok(());
            }
            if looked_after.elapsed() >= LOOK_AFTER {
                looked_after = Instant::now();
                if let Some(status) = self.process.ended() {
                    return Err(self.died(status));
                }
            }
        }
    }
}
