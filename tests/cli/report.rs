//! `tabletop report`: recordings as pages.

use std::fs;

use crate::support::{place, record_shipped, stderr, tabletop};

fn report(paths: &[&str]) -> String {
    let output = tabletop(&[&["report"], paths].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    fs::read_to_string(paths.last().unwrap()).unwrap()
}

#[test]
fn a_page_says_and_shows_what_was_done_and_asks_no_network() {
    let demo = record_shipped("stack_three", "report_demo");
    let out = place("report.html");
    let page = report(&[&demo, out.to_str().unwrap()]);
    for part in [
        "<h2>What was done</h2>",
        "Put the red block on the",
        "<h2>Timeline</h2>",
        "RightHand grasps",
        "Z: up",
        "id=\"play\"",
    ] {
        assert!(page.contains(part), "{part}");
    }
    for foreign in ["http://", "https://", "src=\"//", "@import"] {
        assert!(!page.contains(foreign), "{foreign}");
    }
    assert!(page.matches("data:image/png;base64,").count() > 20);
}

#[test]
fn many_recordings_are_a_table() {
    let folder = place("report_many");
    fs::create_dir_all(&folder).unwrap();
    for number in ["0", "1"] {
        let demo = record_shipped("stack_two_blocks", &format!("report_many/{number}"));
        assert!(demo.ends_with(number));
    }
    let out = place("report_many.html");
    let page = report(&[folder.to_str().unwrap(), out.to_str().unwrap()]);
    assert!(page.contains("<h1>2 recordings</h1>"));
    assert_eq!(page.matches("class=\"small\"").count(), 4);
}

#[test]
fn names_become_no_elements() {
    let demo = record_shipped("stack_two_blocks", "report_<img src=x onerror=alert(1)>");
    let out = place("report_strange.html");
    let page = report(&[&demo, out.to_str().unwrap()]);
    assert!(page.contains("&lt;img src=x onerror=alert(1)&gt;"));
    assert!(!page.contains("<img src=x"));
}

#[test]
fn a_folder_in_the_place_of_the_page_is_refused() {
    let demo = record_shipped("stack_two_blocks", "report_folder_demo");
    let output = tabletop(&["report", &demo, &demo]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("is a folder"),
        "{}",
        stderr(&output)
    );
}
