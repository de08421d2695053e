//! The ends of engines: by themselves, on command, or because they did not answer in time.

use std::{
    process::ExitStatus,
    time::{Duration, Instant},
};

use super::{GRACE, LOOK_AFTER, Running};
use crate::{
    config::Trigger,
    error::{EngineError, ScriptLocation},
    kind::EngineKind,
    worker::{signal::Signal, trigger_file::Op},
};

/// The last output of an engine that has ended is waited for so long.
const LAST_OUTPUT: Duration = Duration::from_millis(300);
/// A script that was interrupted may take so long to clean up.
const CLEANUP: Duration = Duration::from_millis(200);
/// Time from one further interrupt to the next: short, because a shell that gets one before it knows of interrupts ends as if it
/// had got none.
const INTERRUPTS: Duration = Duration::from_millis(40);

impl Running {
    /// Lets the engine leave the script, if it does within a while. Python reports where that was; Octave and MATLAB have left it
    /// all when they answer again.
    pub(super) fn interrupt(&mut self) -> Vec<ScriptLocation> {
        self.worker.killer.interrupt();
        let config = &self.worker.config;
        match (config.engine.kind, config.trigger) {
            (EngineKind::Python, _) => {
                let has_left = self.leaves_script();
                let reply = self.session.read_reply().ok().filter(|_| has_left);
                let error = reply.and_then(|reply| self.script_error(&reply));
                error.map_or_else(Vec::new, |error| error.stack)
            }
            (EngineKind::Octave, Trigger::Stdin) => {
                self.next_request();
                let line = format!("printf(\"\\001done {}\\n\"); fflush(stdout);", self.seq);
                if self.process.write_line(&line).is_ok() {
                    self.leaves_script();
                }
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    /// True if the engine reports within a while that it has left the script. A program that Octave's script has started may have got
    /// the interrupt in its place, so there are more; Python's `finally` is let be.
    fn leaves_script(&mut self) -> bool {
        let repeats = self.worker.config.engine.kind == EngineKind::Octave;
        let start = Instant::now();
        let mut pause = CLEANUP;
        while start.elapsed() < GRACE {
            match self.worker.inbox.recv_timeout(pause) {
                Ok(Signal::Done(seq)) if seq == self.seq => return true,
                Ok(Signal::Closed) => self.note_closed_output(),
                Ok(_) => {}
                Err(_) if repeats => {
                    self.worker.killer.interrupt();
                    pause = INTERRUPTS;
                }
                Err(_) => {}
            }
            if self.process.ended().is_some() {
                return false;
            }
        }
        false
    }

    /// The engine does not listen any more: why.
    pub(super) fn death(&mut self) -> EngineError {
        match self.process.wait(GRACE) {
            Some(status) => self.died(status),
            None => EngineError::Died {
                status: "it closed its input".into(),
                stderr: self.worker.console.take_last_errors(),
            },
        }
    }

    pub(super) fn died(&mut self, status: ExitStatus) -> EngineError {
        self.drain_output();
        EngineError::Died {
            status: status.to_string(),
            stderr: self.worker.console.take_last_errors(),
        }
    }

    /// Waits for the last output of an engine that has ended.
    fn drain_output(&mut self) {
        let start = Instant::now();
        while self.open_outputs > 0 {
            let rest = LAST_OUTPUT.saturating_sub(start.elapsed());
            match self.worker.inbox.recv_timeout(rest) {
                Ok(Signal::Closed) => self.note_closed_output(),
                Ok(_) => {}
                Err(_) => break,
            }
        }
    }

    /// Lets the engine end by itself, so that it closes the script's files. Dropping it does the rest.
    pub(super) fn end(&mut self, limit: Duration) {
        self.next_request();
        if let Some(file) = &mut self.trigger_file {
            drop(file.request(self.seq, Op::End, false));
        }
        self.process.close_input();
        let limit = self.wait_for_end(limit);
        if self.process.ended().is_some() {
            self.drain_output();
            return;
        }
        let note = format!(
            "the script's engine was killed, because it did not end within {} s; its unwritten data are lost",
            limit.as_secs()
        );
        self.note(&note);
    }

    /// Waits until the engine has ended, for at most `limit`, or less if a stop allows less. Returns the limit that held.
    fn wait_for_end(&mut self, mut limit: Duration) -> Duration {
        let start = Instant::now();
        while start.elapsed() < limit && self.process.wait(LOOK_AFTER).is_none() {
            while let Ok(signal) = self.worker.inbox.try_recv() {
                match signal {
                    Signal::Stop(sooner) => limit = limit.min(sooner),
                    Signal::Closed => self.note_closed_output(),
                    Signal::Init(_) | Signal::Step(_) | Signal::Done(_) => {}
                }
            }
        }
        limit
    }
}
