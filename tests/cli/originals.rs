//! Recordings as the original program wrote them, typed from knowledge of its format: of July 2014, with its wrong keys and colours and the
//! wrong hand in a hand-over, and of February 2017, without sizes, with an object that came later and an escaped comma.

use std::path::Path;

use crate::support::{stderr, stdout, tabletop};

fn original(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli/originals");
    folder.join(name).to_str().unwrap().to_owned()
}

fn explained(arguments: &[&str]) -> Vec<String> {
    let output = tabletop(&[&["explain"], arguments].concat());
    assert_eq!(stderr(&output), "");
    stdout(&output).lines().map(str::to_owned).collect()
}

const IN_2014: [&str; 5] = [
    "1. Open the blue box.",
    "2. Put the red block into the blue box.",
    "3. Close the blue box.",
    "4. Hand the green block from the left hand to the right hand and put it where the red block was. (after 2)",
    "5. Remove the blue ball. (at any time)",
];

const IN_2017: [&str; 4] = [
    "- Trigger power.",
    "- Point to Post.",
    "1. Put the red block on the blue block.",
    "2. Put the yellow cylinder on the red block.",
];

#[test]
fn one_of_2014_is_understood() {
    let task = explained(&[&original("2014")]);
    assert_eq!(task[..5], IN_2014);
    let setup = original("2014.xml");
    let bound = explained(&[&original("2014"), "--setup", &setup]);
    assert_eq!(bound[..5], IN_2014);
}

#[test]
fn one_of_2017_is_understood_with_the_sizes_of_its_task_file() {
    let setup = original("2017.xml");
    let task = explained(&[&original("2017"), "--setup", &setup]);
    assert_eq!(task[..4], IN_2017);
}

#[test]
fn the_robot_imitates_original_recordings() {
    for year in ["2014", "2017"] {
        let setup = original(&format!("{year}.xml"));
        let output = tabletop(&["imitate", &original(year), "--setup", &setup]);
        let told = stdout(&output) + &stderr(&output);
        assert_eq!(output.status.code(), Some(0), "{year}: {told}");
    }
}

#[test]
fn the_task_file_has_to_be_named() {
    let output = tabletop(&["imitate", &original("2014")]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("name one with --setup"),
        "{}",
        stderr(&output)
    );
}
