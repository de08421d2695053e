//! What the program is told on the command line, and its exit codes: 0 done, 1 the run failed, 2 wrong usage or input.

mod check;
#[cfg(feature = "window")]
mod display;
#[cfg(feature = "window")]
mod keys;
mod replay;
mod robot;
mod robot_options;
mod run;
mod script;
mod terminal;
mod window;

use std::{
    fmt, fs,
    io::{self, ErrorKind, Write as _},
    path::PathBuf,
    process::ExitCode,
};

use clap::{Parser, Subcommand};

use terminal::say;

/// A virtual demonstrator environment for robot imitation learning.
///
/// Without a command, opens the window.
#[derive(Parser)]
#[command(version)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    window: window::WindowArgs,
}

#[derive(Subcommand)]
enum Command {
    /// Simulate a task file without a window, as fast as possible
    Run(run::RunArgs),
    /// Run a recording again, to verify it or to make its pictures anew
    Replay(replay::ReplayArgs),
    /// Check task files: every fault with its place; exit code 2 if there is one
    Check(check::CheckArgs),
    /// Answer questions about the robot's joints and frames, a line of JSON each
    Robot(robot::RobotArgs),
    /// List the keys of the window and what they do
    #[cfg(feature = "window")]
    Keys(keys::KeysArgs),
}

/// The task file that is loaded when none is named.
const DEFAULT_SETUP: &str = "tablesetup/default.xml";

/// Wrong usage or input.
const WRONG_INPUT: u8 = 2;

/// Why the program ends before it is done.
#[derive(Debug)]
struct Failure {
    /// What is wrong, if nobody has said it yet.
    message: Option<String>,
    code: u8,
}

impl Failure {
    /// The user's input is at fault.
    fn input(error: impl fmt::Display) -> Self {
        Self {
            message: Some(error.to_string()),
            code: WRONG_INPUT,
        }
    }

    /// The run failed.
    fn run(error: impl fmt::Display) -> Self {
        Self {
            message: Some(error.to_string()),
            code: 1,
        }
    }

    /// The run failed, and there is nothing more to say.
    fn silent() -> Self {
        Self {
            message: None,
            code: 1,
        }
    }
}

/// Reads the command line and does what it says.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let result = match cli.command {
        Some(Command::Run(args)) => run::run(&args),
        Some(Command::Replay(args)) => replay::run(&args),
        Some(Command::Check(args)) => check::check(&args),
        Some(Command::Robot(args)) => robot::robot(&args),
        #[cfg(feature = "window")]
        Some(Command::Keys(args)) => keys::list(&args),
        None => window::open(cli.window),
    };
    result.unwrap_or_else(|failure| {
        if let Some(message) = failure.message {
            say(format_args!("tabletop: {message}"));
        }
        ExitCode::from(failure.code)
    })
}

/// A path, or `-` for standard output.
#[derive(Clone, Debug)]
enum Output {
    Stdout,
    File(PathBuf),
}

impl From<std::ffi::OsString> for Output {
    fn from(name: std::ffi::OsString) -> Self {
        match name.to_str() {
            Some("-") => Self::Stdout,
            _ => Self::File(name.into()),
        }
    }
}

impl Output {
    /// Whether it can be written. This leaves no trace.
    fn check(&self) -> Result<(), Failure> {
        let Self::File(path) = self else {
            return Ok(());
        };
        // A pipe that is opened and closed has told its reader that all has come.
        if path.exists() && !path.is_file() && !path.is_dir() {
            return Ok(());
        }
        let is_new = path.symlink_metadata().is_err();
        let mut options = fs::OpenOptions::new();
        let opened = options.append(true).create(true).open(path);
        opened
            .and_then(|_| match is_new {
                true => fs::remove_file(path),
                false => Ok(()),
            })
            .map_err(|error| Failure::run(format!("{}: {error}", path.display())))
    }

    /// Writes all of it, or says where it could not be written.
    fn write(&self, bytes: &[u8]) -> Result<(), Failure> {
        match self {
            Self::Stdout => {
                let mut stdout = io::stdout().lock();
                let written = stdout.write_all(bytes).and_then(|()| stdout.flush());
                written.map_err(|error| match error.kind() {
                    ErrorKind::BrokenPipe => Failure::silent(),
                    _ => Failure::run(format!("standard output: {error}")),
                })
            }
            Self::File(path) => fs::write(path, bytes)
                .map_err(|error| Failure::run(format!("{}: {error}", path.display()))),
        }
    }
}
