//! An engine's process with all that it has started, none of which outlives this program.

use std::{
    io::{self, Read, Write as _},
    path::Path,
    process::{Child, ChildStdin, Command, ExitStatus, Stdio},
    sync::{Arc, Mutex, PoisonError},
    thread,
    time::{Duration, Instant},
};

use super::descendants::{Descendants, FOLDER_VARIABLE};

/// A killed process may take so long to be gone.
const REAP_LIMIT: Duration = Duration::from_secs(2);

/// Ends a process from any thread, also one that has not been started yet.
#[derive(Clone, Debug, Default)]
pub(crate) struct Killer(Arc<Mutex<KillTarget>>);

#[derive(Debug, Default)]
struct KillTarget {
    pid: Option<u32>,
    cancelled: bool,
}

impl Killer {
    /// Ends the process and all that it has started, now.
    pub(crate) fn kill(&self) {
        let mut target = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        target.cancelled = true;
        if let Some(pid) = target.pid {
            kill_group(pid);
        }
    }

    /// Interrupts the process and all that it has started, as Ctrl-C would, on platforms that have interrupts.
    pub(crate) fn interrupt(&self) {
        let target = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pid) = target.pid {
            interrupt_group(pid);
        }
    }
}

/// A running engine.
#[derive(Debug)]
pub(crate) struct Process {
    child: Child,
    stdin: Option<ChildStdin>,
    killer: Killer,
    descendants: Descendants,
    /// Waits for this program's end in its place.
    watchdog: Option<Child>,
}

impl Process {
    /// Starts a command in a group of its own. When this program ends in any way, the group soon does as well, and `folder` goes.
    ///
    /// # Errors
    /// The system refuses, or the killer has been used already ([`io::ErrorKind::Interrupted`]).
    pub(crate) fn start(
        mut command: Command,
        piped: bool,
        folder: &Path,
        killer: Killer,
    ) -> io::Result<Self> {
        let stdin = if piped { Stdio::piped() } else { Stdio::null() };
        command
            .stdin(stdin)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        command.env(FOLDER_VARIABLE, folder);
        own_group(&mut command);
        let mut target = killer.0.lock().unwrap_or_else(PoisonError::into_inner);
        if target.cancelled {
            return Err(io::Error::from(io::ErrorKind::Interrupted));
        }
        let mut child = command.spawn()?;
        target.pid = Some(child.id());
        drop(target);
        let watchdog = watch(child.id(), folder);
        let descendants = Descendants::of(child.id(), folder);
        let stdin = child.stdin.take();
        let mut process = Self {
            child,
            stdin,
            killer,
            descendants,
            watchdog: None,
        };
        process.watchdog = watchdog?;
        Ok(process)
    }

    /// Standard output and standard error, once.
    pub(crate) fn outputs(&mut self) -> impl Iterator<Item = Box<dyn Read + Send>> {
        let out = self
            .child
            .stdout
            .take()
            .map(|out| Box::new(out) as Box<dyn Read + Send>);
        let err = self
            .child
            .stderr
            .take()
            .map(|err| Box::new(err) as Box<dyn Read + Send>);
        [out, err].into_iter().flatten()
    }

    /// Writes a line to its standard input.
    pub(crate) fn write_line(&mut self, line: &str) -> io::Result<()> {
        let Some(stdin) = &mut self.stdin else {
            return Err(io::Error::from(io::ErrorKind::BrokenPipe));
        };
        stdin.write_all(format!("{line}\n").as_bytes())?;
        stdin.flush()
    }

    /// Closes its standard input.
    pub(crate) fn close_input(&mut self) {
        self.stdin = None;
    }

    /// Takes leave of processes that the engine has started and left, and that have ended.
    pub(crate) fn reap_orphans(&self) {
        self.descendants.reap();
    }

    /// Its exit status, if it has ended.
    pub(crate) fn ended(&mut self) -> Option<ExitStatus> {
        let mut target = self.killer.0.lock().unwrap_or_else(PoisonError::into_inner);
        let status = self.child.try_wait().ok().flatten()?;
        if let Some(pid) = target.pid.take() {
            // The processes that it started and left behind.
            kill_group(pid);
            drop(target);
            self.descendants.kill();
        }
        Some(status)
    }

    /// Its exit status, waiting for at most `limit`.
    pub(crate) fn wait(&mut self, limit: Duration) -> Option<ExitStatus> {
        let start = Instant::now();
        loop {
            let ended = self.ended();
            if ended.is_some() || start.elapsed() >= limit {
                return ended;
            }
            thread::sleep(Duration::from_millis(2));
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.killer.kill();
        self.wait(REAP_LIMIT);
        self.descendants.kill();
        if let Some(watchdog) = &mut self.watchdog {
            // If it is gone already there is nothing to do.
            drop(watchdog.kill());
            drop(watchdog.wait());
        }
    }
}

#[cfg(unix)]
fn own_group(command: &mut Command) {
    use std::os::unix::process::CommandExt as _;
    command.process_group(0);
}

#[cfg(unix)]
fn kill_group(pid: u32) {
    signal_group(pid, nix::sys::signal::Signal::SIGKILL);
}

#[cfg(unix)]
fn interrupt_group(pid: u32) {
    signal_group(pid, nix::sys::signal::Signal::SIGINT);
}

#[cfg(unix)]
fn signal_group(pid: u32, signal: nix::sys::signal::Signal) {
    use nix::{sys::signal::killpg, unistd::Pid};
    if let Ok(group) = i32::try_from(pid) {
        // It fails if nothing of the group is left, which is the goal.
        let _ = killpg(Pid::from_raw(group), signal);
    }
}

/// A shell that reads from a pipe to which nobody ever writes. The pipe ends when this program does, however it does. An engine
/// without a request then ends by itself; one that runs a script is interrupted first, and killed in the end.
#[cfg(unix)]
fn watch(pid: u32, folder: &Path) -> io::Result<Option<Child>> {
    let mut command = Command::new("/bin/sh");
    let script = r#"
        wait_for_it() { for tenth in 1 2 3 4 5 6 7 8 9 10; do kill -0 "$1" || break; sleep 0.1; done; }
        while read -r line; do :; done
        wait_for_it "$1"
        kill -INT -"$1" && wait_for_it "$1"
        kill -9 -"$1"
        for environment in $(grep -ls -- "$3=$2" /proc/[0-9]*/environ); do
            pid=${environment#/proc/}
            kill -9 "${pid%/environ}"
        done
        rm -rf -- "$2"
    "#;
    command
        .args(["-c", script, "tabletop-watchdog"])
        .arg(pid.to_string())
        .arg(folder)
        .arg(FOLDER_VARIABLE);
    command
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    own_group(&mut command);
    command.spawn().map(Some)
}

#[cfg(not(unix))]
fn own_group(_command: &mut Command) {}

#[cfg(not(unix))]
fn kill_group(pid: u32) {
    let mut command = Command::new("taskkill");
    command.args(["/T", "/F", "/PID", &pid.to_string()]);
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    // It fails if the process is gone, which is the goal.
    drop(command.status());
}

#[cfg(not(unix))]
fn interrupt_group(_pid: u32) {}

/// Here an engine sees by the missing heartbeat or the end of its input that this program is gone.
#[cfg(not(unix))]
fn watch(_pid: u32, _folder: &Path) -> io::Result<Option<Child>> {
    Ok(None)
}
