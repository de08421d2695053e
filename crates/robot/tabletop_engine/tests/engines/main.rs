//! Scripts in a real GNU Octave and a real Python.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod clearing;
mod common;
mod console;
mod drawing;
mod ends;
mod examples;
#[cfg(unix)]
mod fake_matlab;
mod farewell;
mod faults;
mod folders;
#[cfg(unix)]
mod hostile_files;
mod invalid_fields;
mod leaving;
mod life;
mod matlab_objects;
mod messages;
mod one_arm;
#[cfg(unix)]
mod outlive;
mod python;
mod scripts;
mod waiting;

use std::process::ExitCode;

fn main() -> ExitCode {
    #[cfg(unix)]
    if outlive::is_program() {
        return ExitCode::SUCCESS;
    }
    tabletop_harness::run()
}
