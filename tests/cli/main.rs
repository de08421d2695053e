//! The command line, as a user types it.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kinematics;
mod replay;
mod robot;
mod scenarios;
mod support;
mod task_files;
