//! Whichever call to the file system fails under a command, the command says so, no earlier file is gone, and kept files are whole.
//!
//! The faults come from outside, from strace, so that they reach every call, be it a library's. Of each kind of calls every 29-th fails, or
//! every n-th if the environment variable EVERY says so.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod command;
mod fault;
mod tree;

use std::process::ExitCode;

use command::{Commands, Subject};
use fault::Fault;
use tabletop_harness::test_with;

#[test_with(Strace)]
fn commands_survive_faults() {
    let every = std::env::var("EVERY").map_or(29, |every| every.parse().unwrap());
    let commands = Commands::new("faults");
    let mut tried = 0;
    for (offset, subject) in Subject::ALL.into_iter().enumerate() {
        let expected = commands.expected(subject);
        for fault in Fault::ALL {
            let calls = commands.calls(subject, fault);
            // Other ones for each command.
            for call in (1 + offset % every..=calls).step_by(every) {
                if let Err(problem) = commands.survives(subject, &expected, fault, call) {
                    panic!("{subject:?}: {fault:?} at call {call} of {calls}: {problem}");
                }
                tried += 1;
            }
        }
    }
    assert!(tried > 50, "only {tried} faults");
}

#[test_with()]
fn two_that_multiply_into_one_folder_leave_each_other_alone() {
    Commands::new("faults-at-once").multiply_twice_at_once();
}

fn main() -> ExitCode {
    tabletop_harness::run()
}
