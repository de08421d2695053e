//! Faults of system calls, brought about with strace.

use std::{
    fs,
    path::Path,
    process::{Command, Output},
};

/// A kind of system calls, and the error of the one that fails.
#[derive(Clone, Copy, Debug)]
pub struct Fault {
    pub calls: &'static str,
    pub error: &'static str,
}

impl Fault {
    const fn new(calls: &'static str, error: &'static str) -> Self {
        Self { calls, error }
    }

    pub const ALL: [Self; 11] = [
        Self::new("write", "ENOSPC"),
        Self::new("write", "EIO"),
        Self::new("openat", "EIO"),
        Self::new("rename", "ENOSPC"),
        Self::new("linkat", "EPERM"),
        Self::new("mkdir", "ENOSPC"),
        Self::new("unlink", "EIO"),
        Self::new("rmdir", "EIO"),
        Self::new("fsync", "EIO"),
        Self::new("ftruncate", "EIO"),
        Self::new("chmod", "EPERM"),
    ];
}

/// Runs a program of which the call of this number fails.
pub fn run_with(fault: Fault, call: usize, program: &Command, folder: &Path) -> Output {
    let Fault { calls, error } = fault;
    let inject = format!("inject={calls}:error={error}:when={call}");
    let trace = format!("trace={calls}");
    strace(
        &["-o", "/dev/null", "-e", &trace, "-e", &inject],
        program,
        folder,
    )
}

/// The number of calls of a kind that a program makes in one of its threads, at most.
pub fn count(fault: Fault, program: &Command, folder: &Path) -> usize {
    let traces = folder.with_extension("traces");
    fs::create_dir_all(&traces).unwrap();
    let prefix = traces.join("thread");
    let trace = format!("trace={}", fault.calls);
    // With a file for each thread.
    let output = strace(
        &["-ff", "-o", prefix.to_str().unwrap(), "-e", &trace],
        program,
        folder,
    );
    assert!(output.status.success(), "{output:?}");
    let threads = fs::read_dir(&traces).unwrap();
    let calls = threads.map(|thread| {
        let text = fs::read_to_string(thread.unwrap().path()).unwrap();
        let is_call = |line: &&str| line.starts_with(fault.calls);
        text.lines().filter(is_call).count()
    });
    let most = calls.max().unwrap_or_default();
    fs::remove_dir_all(traces).unwrap();
    most
}

fn strace(options: &[&str], program: &Command, folder: &Path) -> Output {
    Command::new("strace")
        .args(["-f", "-qq", "--seccomp-bpf"])
        .args(options)
        .arg(program.get_program())
        .args(program.get_args())
        .current_dir(folder)
        .env_remove("DISPLAY")
        .output()
        .unwrap()
}
