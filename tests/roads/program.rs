//! The program, as a user runs it.

use std::{
    fs::{self, File},
    path::{Path, PathBuf},
    process::{Command, ExitStatus, Stdio},
    thread,
    time::{Duration, Instant},
};

/// Longest time of a command, however busy the computer is.
const PATIENCE: Duration = Duration::from_secs(300);

/// A command that has ended.
#[derive(Debug)]
pub struct Ended {
    /// `None` if it had to be killed.
    pub status: Option<ExitStatus>,
    pub stdout: String,
    pub stderr: String,
}

impl Ended {
    pub fn is_success(&self) -> bool {
        self.status.is_some_and(|status| status.success())
    }

    /// True if it ended by itself with a code for a failure.
    pub fn is_refusal(&self) -> bool {
        let code = self.status.and_then(|status| status.code());
        matches!(code, Some(1 | 2))
    }
}

/// Runs the program without a display, its output in a folder.
pub fn run(arguments: &[&str], folder: &Path) -> Ended {
    let outputs = output_files(folder);
    let file = |path: &Path| Stdio::from(File::create(path).unwrap());
    let mut child = Command::new(env!("CARGO_BIN_EXE_tabletop"))
        .args(arguments)
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .stdin(Stdio::null())
        .stdout(file(&outputs[0]))
        .stderr(file(&outputs[1]))
        .spawn()
        .unwrap();
    let began = Instant::now();
    let status = loop {
        match child.try_wait().unwrap() {
            Some(status) => break Some(status),
            None if began.elapsed() > PATIENCE => {
                child.kill().unwrap();
                child.wait().unwrap();
                break None;
            }
            None => thread::sleep(Duration::from_millis(5)),
        }
    };
    let [stdout, stderr] = outputs.map(|path| {
        let text = fs::read(&path).unwrap();
        fs::remove_file(path).unwrap();
        String::from_utf8_lossy(&text).into_owned()
    });
    Ended {
        status,
        stdout,
        stderr,
    }
}

fn output_files(folder: &Path) -> [PathBuf; 2] {
    let folder = match folder == Path::new(".") {
        true => Path::new(env!("CARGO_TARGET_TMPDIR")),
        false => folder,
    };
    let thread = format!("{:?}", thread::current().id());
    let number: String = thread.chars().filter(char::is_ascii_digit).collect();
    ["out", "err"].map(|kind| folder.join(format!("roads-{number}.{kind}")))
}
