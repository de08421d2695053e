//! Recordings that were cut off.

use std::{fs, path::Path};

use crate::support::{record_shipped, stderr, stdout, tabletop};

/// Removes the end of a recording from its log, as if the program had been killed.
fn cut_off(recording: &str) {
    let log = Path::new(recording).join("session.jsonl");
    let text = fs::read_to_string(&log).unwrap();
    let (beginning, end) = text.trim_end().rsplit_once('\n').unwrap();
    assert!(end.contains("Finish"), "{end}");
    fs::write(&log, format!("{beginning}\n")).unwrap();
}

#[test]
fn its_task_is_told_as_far_as_it_goes() {
    let demo = record_shipped("stack_three", "cut_off_task");
    let whole = tabletop(&["explain", &demo]);
    assert_eq!(stderr(&whole), "");
    cut_off(&demo);
    for command in [
        &["explain"][..],
        &["explain", "--json"],
        &["require"],
        &["require", "--step", "1", "any"],
        &["imitate"],
    ] {
        let output = tabletop(&[&[command[0], &demo], &command[1..]].concat());
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(0), "{command:?}: {said}");
        let first = said.lines().next().unwrap();
        let notice = format!("tabletop: {demo} was cut off in tick ");
        assert!(first.starts_with(&notice), "{command:?}: {said}");
        assert!(first.ends_with(", and is explained that far"), "{said}");
        assert_eq!(said.matches("was cut off").count(), 1, "{said}");
    }
    let explained = tabletop(&["explain", &demo]);
    let sentences = |text: &str| text.lines().count();
    assert_eq!(sentences(&stdout(&explained)), sentences(&stdout(&whole)));
}
