//! Whichever call to the file system fails under a command, the command says so, nothing that was there is gone, and what is kept is whole.
//!
//! The faults come from outside, from strace, so that they reach every call, be it a library's.
#![cfg(target_os = "linux")]
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod command;
mod fault;
mod tree;

use command::{Commands, Subject};
use fault::{Fault, is_possible};

/// The calls that fail: of each kind every n-th, from another one on for each command.
fn try_commands(step: usize) {
    if !is_possible() {
        return;
    }
    let commands = Commands::new(&format!("faults-{step}"));
    let mut tried = 0;
    for (offset, subject) in Subject::ALL.into_iter().enumerate() {
        let expected = commands.expected(subject);
        for fault in Fault::ALL {
            let calls = commands.calls(subject, fault);
            for call in (1 + offset % step..=calls).step_by(step) {
                if let Err(problem) = commands.survives(subject, &expected, fault, call) {
                    panic!("{subject:?}: {fault:?} at call {call} of {calls}: {problem}");
                }
                tried += 1;
            }
        }
    }
    assert!(tried > 50, "only {tried} faults");
}

#[test]
fn commands_survive_faults() {
    try_commands(29);
}

/// Every one, or every n-th if the environment variable EVERY says so.
#[test]
#[ignore = "takes an hour"]
fn commands_survive_every_fault() {
    let every = std::env::var("EVERY").map_or(1, |every| every.parse().unwrap());
    try_commands(every);
}

#[test]
fn two_that_multiply_into_one_folder_leave_each_other_alone() {
    Commands::new("faults-at-once").multiply_twice_at_once();
}
