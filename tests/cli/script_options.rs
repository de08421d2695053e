//! Options of scripts that are refused before any engine starts.

use crate::support::{command, place, stderr, tabletop};

/// A script that is there.
const SCRIPT: &str = "python:python/example.py";

#[test]
fn wrong_options_are_reported() {
    for (arguments, message) in [
        (
            &["run", "--script", "ruby:x.rb"][..],
            "expected matlab, octave, python or other",
        ),
        (
            &["run", "--script", "other"],
            "the path of the script after other",
        ),
        (&["run", "--engine", "octave"], "--script"),
        (&["run", "--no-objects"], "--script"),
        (&["run", "--picture-every", "2"], "--script"),
        (&["run", "--script-timeout", "2"], "--script"),
        (&["run", "--seconds", "-1"], "expected a number from 0 to"),
        (
            &["run", "--script", SCRIPT, "--script-timeout", "-1"],
            "expected a number from 0.01 to 86400 seconds",
        ),
        (
            &["run", "--script", SCRIPT, "--picture-every", "-1"],
            "expected a whole number from 1 to 1000000000 ticks",
        ),
        (
            &["--engine", "/nonexistent"],
            "there is no program /nonexistent",
        ),
    ] {
        let output = tabletop(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let printed = stderr(&output);
        assert!(printed.contains(message), "{arguments:?}: {printed}");
        assert!(!printed.contains("Python 3"), "{arguments:?}: {printed}");
    }
}

#[test]
fn where_nothing_can_be_written_nothing_is_run() {
    for output in ["--final-robot", "--final-state"] {
        let run = ["run", "--script", SCRIPT, output, "no/such/folder/end"];
        let output = tabletop(&run);
        assert_eq!(output.status.code(), Some(1));
        let printed = stderr(&output);
        assert!(
            printed.starts_with("tabletop: no/such/folder/end: ") && printed.lines().count() == 1,
            "{printed}"
        );
    }
    let end = place("never-written");
    let output = command(&["run", "--setup", "no.xml", "--final-state"])
        .arg(&end)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(!end.exists());
}
