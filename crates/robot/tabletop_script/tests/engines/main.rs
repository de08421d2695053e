//! A robot that scripts drive, in a real GNU Octave.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

#[cfg(unix)]
mod faults;
mod kit;
mod life;
mod sensing;
mod waiting;

use std::process::ExitCode;

fn main() -> ExitCode {
    tabletop_harness::run()
}
