//! The window where there is none.

use std::fs;

use crate::support::{place, stderr, stdout, tabletop};

#[test]
fn files_that_cannot_be_read_are_reported_before_a_window_opens() {
    let picture = place("window.png");
    let picture = picture.to_str().unwrap();
    for (arguments, path) in [
        (&["--setup", "no such.xml"][..], "no such.xml"),
        (
            &["--setup", "no such.xml", "--screenshot", picture],
            "no such.xml",
        ),
        (&["--setup", "tests"], "tests"),
        (&["--keys", "no such.ron"], "no such.ron"),
        (&["--robot", "no such.urdf"], "no such.urdf"),
        (&["--script", "python:no such.py"], "no such.py"),
        (&["replay", "no such folder", "--window"], "no such folder"),
    ] {
        let output = tabletop(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let said = stderr(&output);
        assert!(said.starts_with("tabletop: "), "{said}");
        assert!(said.contains(path) && !said.contains("no window"), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
        assert_eq!(stdout(&output), "");
    }
    assert!(fs::metadata(picture).is_err());
}

#[test]
fn a_picture_that_cannot_be_taken_is_a_failure() {
    let picture = place("no-display.png");
    let output = tabletop(&["--screenshot", picture.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(said.starts_with("tabletop: no window: "), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    assert_eq!(stdout(&output), "");
    assert!(fs::metadata(picture).is_err());
}
