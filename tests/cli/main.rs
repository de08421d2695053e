//! The program, as a user runs it.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod allowed_paths;
mod anywhere;
mod at_once;
mod cut_off;
mod dataset;
mod documentation;
mod edit;
mod element_docs;
mod explain;
mod export;
mod imitate;
mod import;
mod judged;
mod kept;
#[cfg(feature = "window")]
mod keys;
mod kinematics;
mod language;
mod loads;
mod man;
mod multiply;
mod originals;
mod policy;
mod ranges;
mod real;
mod replay;
mod report;
mod require;
mod results;
mod robot;
mod scenarios;
mod script_options;
mod seeds;
mod served;
mod strange_recordings;
mod strange_scenes;
mod strange_sets;
mod support;
mod task_files;
mod teach;
mod tell;
mod usage;
mod validate;
mod video;
mod watch;
#[cfg(feature = "window")]
mod window;
