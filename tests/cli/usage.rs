//! The command line: refusals, help and the version.

use crate::support::{command, stderr, stdout, tabletop};

/// Letters that a terminal would obey.
fn is_obeyed(letter: char) -> bool {
    letter.is_control() && !matches!(letter, '\n' | '\t')
}

#[test]
fn control_characters_are_escaped_in_refusals() {
    for arguments in [
        &["--\u{1b}[31mred"][..],
        &["run", "--\u{1b}[31mred\u{9b}2J"],
        &["run", "--seconds", "\u{1b}[31mred"],
        &["run", "one.ron", "\u{1b}[31mred\r"],
        &["completions", "\u{1b}[31mred"],
        &["\u{1b}[31mred"],
        &["robot", "\u{1b}[31mred"],
    ] {
        let output = tabletop(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let said = stderr(&output);
        assert!(said.starts_with("error: "), "{said}");
        assert!(said.contains("\\u{1b}[31mred"), "{said}");
        assert!(!said.contains(is_obeyed), "{said:?}");
        assert_eq!(stdout(&output), "");
    }
}

#[cfg(unix)]
#[test]
fn arguments_that_are_no_text_are_refused() {
    use std::{ffi::OsStr, os::unix::ffi::OsStrExt as _};

    for arguments in [
        &[&b"--\xff\x1b[31m"[..]][..],
        &[b"run", b"--seconds", b"\xff\x1b[31m"],
        &[b"completions", b"\xff\x1b[31m"],
    ] {
        let arguments = arguments.iter().map(|bytes| OsStr::from_bytes(bytes));
        let output = command(&[]).args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        let said = stderr(&output);
        assert!(said.starts_with("error: "), "{said}");
        assert!(!said.contains(is_obeyed), "{said:?}");
    }
}

#[test]
fn help_and_version_are_results() {
    for (arguments, line) in [
        (
            &["--help"][..],
            "A virtual demonstrator environment for robot imitation learning",
        ),
        (
            &["run", "-h"],
            "Simulate a task file or a scenario without a window, as fast as possible",
        ),
        (
            &["--version"],
            concat!("tabletop ", env!("CARGO_PKG_VERSION")),
        ),
    ] {
        let output = tabletop(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        assert!(stdout(&output).starts_with(line), "{}", stdout(&output));
        assert_eq!(stderr(&output), "");
    }
    let output = tabletop(&["robot"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("Usage: tabletop robot"));
}

#[test]
fn options_before_a_command_are_refused_with_the_line_that_was_meant() {
    for (arguments, meant) in [
        (
            &["--seed", "7", "imitate", "demo"][..],
            "imitate demo --seed 7",
        ),
        (
            &["--setup", "none.xml", "explain", "demo"],
            "explain demo --setup none.xml",
        ),
    ] {
        let output = tabletop(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let said = stderr(&output);
        assert!(
            said.starts_with("error: options of a command come after it"),
            "{said}"
        );
        assert!(said.contains(meant), "{said}");
    }
}
