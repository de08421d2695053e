//! The program and the examples of scripts, as a user runs them.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod allowed_paths;
mod anywhere;
mod cut_off;
mod element_docs;
mod examples;
mod explain;
mod imitate;
mod kept;
#[cfg(feature = "window")]
mod keys;
mod kinematics;
mod language;
mod man;
mod multiply;
mod originals;
mod panda;
mod ranges;
mod replay;
mod robot;
mod scenarios;
mod scripts;
mod strange_recordings;
mod strange_scenes;
mod support;
mod task_files;
mod usage;
#[cfg(feature = "window")]
mod window;
