//! The program and the examples of scripts, as a user runs them.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod allowed_paths;
mod anywhere;
mod element_docs;
mod examples;
mod explain;
mod imitate;
#[cfg(feature = "window")]
mod keys;
mod kinematics;
mod language;
mod multiply;
mod originals;
mod panda;
mod replay;
mod require;
mod robot;
mod scenarios;
mod scripts;
mod strange_recordings;
mod strange_scenes;
mod support;
mod task_files;
