//! The schema of task files, checked by a validator that others wrote: `xmllint` (Debian: `libxml2-utils`).

#![expect(clippy::unwrap_used, reason = "a test that cannot go on panics")]

mod texts;

use std::{
    fs,
    io::Write as _,
    process::{Command, ExitCode, Stdio},
};

use tabletop_harness::test_with;
use tabletop_xml::read_task;
use texts::{accepted, rejected, shipped_files, tablesetup};

fn main() -> ExitCode {
    tabletop_harness::run()
}

/// The validator's complaint about a text; `Ok` if it is valid.
fn validate(text: &str) -> Result<(), String> {
    let mut validator = Command::new("xmllint")
        .args(["--noout", "--nonet", "--schema"])
        .arg(tablesetup().join("tabletop.xsd"))
        .arg("-")
        .stdin(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = validator.stdin.take().unwrap();
    input.write_all(text.as_bytes()).unwrap();
    drop(input);
    let output = validator.wait_with_output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    match output.status.code() {
        Some(0) => Ok(()),
        // Not well formed, not valid.
        Some(1 | 3 | 4) => Err(message),
        other => panic!("xmllint failed with {other:?}: {message}"),
    }
}

#[test_with(Xmllint)]
fn shipped_files_are_valid() {
    for path in shipped_files() {
        let text = fs::read_to_string(&path).unwrap();
        assert_eq!(validate(&text), Ok(()), "{}", path.display());
    }
}

#[test_with(Xmllint)]
fn written_files_are_valid() {
    for path in shipped_files() {
        let written = tabletop_xml::write(&read_task(&path).unwrap().scene);
        assert_eq!(validate(&written), Ok(()), "{written}");
    }
}

#[test_with(Xmllint)]
fn the_schema_accepts_every_text_the_parser_accepts() {
    for text in accepted() {
        assert_eq!(validate(&text), Ok(()), "{text}");
    }
}

#[test_with(Xmllint)]
fn the_schema_rejects_every_text_the_parser_rejects() {
    for text in rejected() {
        assert!(validate(&text).is_err(), "{text}");
    }
}
