//! `tabletop tell`: tasks in sentences.

use std::{collections::BTreeMap, fs};

use serde_json::Value;

use crate::support::{place, replays_to_the_same_bytes, stderr, stdout, tabletop};

/// Two red blocks, one green one, and a tray with walls.
const BLOCKS: &str = r#"
  <block id="RedA" location="(-4,-3,0.5)" xspan="1" yspan="1" zspan="1" color="red"/>
  <block id="RedB" location="(-2,-4,0.5)" rotation="(0,0,30)" xspan="1" yspan="1" zspan="1" color="red"/>
  <block id="Green" location="(0,-3,0.5)" xspan="1.2" yspan="1.2" zspan="1" color="green"/>
  <box id="Tray" location="(4,-3,0.4)" xspan="4" yspan="3" zspan="0.8" thickness="0.1" color="blue" mass="2"/>"#;

fn setup(name: &str, objects: &str) -> String {
    let path = place(name);
    let root = "<tabletop xmlns='http://synapse.cs.umd.edu/tabletop-xml' xspan='20' yspan='12'>";
    fs::write(&path, format!("{root}{objects}</tabletop>")).unwrap();
    path.to_str().unwrap().to_owned()
}

/// The final locations of a program's objects.
fn after(sentences: &str, setup: &str, options: &[&str]) -> BTreeMap<String, [f64; 3]> {
    let arguments = ["tell", sentences, "--setup", setup, "--final-state", "-"];
    let output = tabletop(&[&arguments, options].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = stdout(&output);
    let rows = said.lines().map(|row| {
        let cells: Vec<_> = row.split(',').collect();
        let number = |i: usize| cells[i].parse().unwrap();
        (cells[0].to_owned(), [number(1), number(2), number(3)])
    });
    rows.collect()
}

fn refused(arguments: &[&str], code: i32) -> String {
    let output = tabletop(&[&["tell"], arguments].concat());
    assert_eq!(output.status.code(), Some(code), "{arguments:?}");
    stderr(&output)
}

#[test]
fn a_sentence_is_checked_without_a_table() {
    let output = tabletop(&[
        "tell",
        "--check",
        "put all the red cubes in the blue container",
    ]);
    let said = stdout(&output);
    let (sentence, json) = said.split_once('\n').unwrap();
    assert_eq!(sentence, "Put every red block into the blue box.");
    let json: Value = serde_json::from_str(json).unwrap();
    assert_eq!(json["sentences"][0]["instructions"][0]["do"], "put");
    let said = refused(&["--check", "Put every red blokc into the box."], 2);
    assert!(said.contains("1:15: `blokc`"), "{said}");
    assert!(said.contains("Put every red block into the box."), "{said}");
}

#[test]
fn a_program_is_read_from_a_file_as_sentences_and_as_json() {
    let file = place("tell_program.txt");
    fs::write(
        &file,
        "# tidy up\n1. Put every red block into the box.\n2. Remove the green block.\n",
    )
    .unwrap();
    let file = file.to_str().unwrap();
    let output = tabletop(&["tell", "--check", "--program", file]);
    let said = stdout(&output);
    let (sentences, json) = said.split_once('{').unwrap();
    assert_eq!(
        sentences,
        "Put every red block into the box.\nRemove the green block.\n"
    );
    let copy = place("tell_program.json");
    fs::write(&copy, format!("{{{json}")).unwrap();
    let again = tabletop(&["tell", "--check", "--program", copy.to_str().unwrap()]);
    assert_eq!(stdout(&again), said);
    let schema = tabletop(&["tell", "--schema"]);
    assert!(serde_json::from_str::<Value>(&stdout(&schema)).is_ok());
    let said = refused(&["--check", "--program", "missing.txt"], 2);
    assert!(said.contains("missing.txt"), "{said}");
}

#[test]
fn a_dry_run_prints_the_steps_and_does_nothing() {
    let setup = setup("tell_dry.xml", BLOCKS);
    let output = tabletop(&[
        "tell",
        "Put every red block into the box.",
        "--setup",
        &setup,
        "--dry-run",
    ]);
    let expected = "1. Put RedA into the blue box.\n2. Put RedB into the blue box.\n";
    assert_eq!(stdout(&output), expected);
    let said = refused(
        &["Put the red block aside.", "--setup", &setup, "--dry-run"],
        1,
    );
    assert!(
        said.contains("the red block can be any of RedA, RedB"),
        "{said}"
    );
    let output = tabletop(&[
        "tell",
        "Remove every yellow block.",
        "--setup",
        &setup,
        "--dry-run",
    ]);
    assert_eq!(stdout(&output), "There is nothing to do.\n");
}

#[test]
fn the_hand_fills_a_tray() {
    let setup = setup("tell_hand.xml", BLOCKS);
    let after = after("Put every red block into the box.", &setup, &[]);
    for id in ["RedA", "RedB"] {
        let [x, y, z] = after[id];
        assert!(
            (2.0..6.0).contains(&x) && (-4.5..-1.5).contains(&y) && z < 0.7,
            "{id}: {x} {y} {z}"
        );
    }
    assert!((after["Green"][0]).abs() < 0.1);
}

#[test]
fn the_robot_builds_a_tower() {
    let setup = setup("tell_robot.xml", BLOCKS);
    let after = after(
        "Put all blocks on each other, the largest first.",
        &setup,
        &["--imitate"],
    );
    let heights = ["Green", "RedA", "RedB"].map(|id| after[id][2]);
    for (height, expected) in heights.into_iter().zip([0.5, 1.5, 2.5]) {
        assert!((height - expected).abs() < 0.05, "{heights:?}");
    }
}

#[test]
fn what_the_hand_did_is_a_demonstration() {
    let setup = setup("tell_record.xml", BLOCKS);
    let demo = place("tell_record");
    let demo = demo.to_str().unwrap();
    let output = tabletop(&[
        "tell",
        "Put every red block into the box.",
        "--setup",
        &setup,
        "--record",
        demo,
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stdout(&output), "Done: 2 steps, 0 corrections.\n");
    replays_to_the_same_bytes(demo);
    let explained = tabletop(&["explain", demo]);
    let said = stdout(&explained);
    assert!(said.contains("1. Put RedA into the blue box."), "{said}");
    let meant = tabletop(&["explain", demo, "--program"]);
    let said = stdout(&meant);
    assert!(
        said.starts_with("Put every red block into the box.\n"),
        "{said}"
    );
    assert!(
        said.contains("Not moved, but of every block: Green.\n"),
        "{said}"
    );
}

#[test]
fn lids_are_opened_and_closed() {
    let sentences =
        "If the box is closed, open it. Put the yellow block into the box. Close the box.";
    for performer in [&[][..], &["--imitate"]] {
        let after = after(sentences, "shipped:tablesetup/chest.xml", performer);
        let [x, y, z] = after["Yellow"];
        assert!(
            (1.0..4.0).contains(&x) && (-4.0..-1.0).contains(&y) && z < 1.0,
            "{x} {y} {z}"
        );
        assert!(
            (after["chest-lid"][0] - 2.5).abs() < 0.3,
            "{:?}",
            after["chest-lid"]
        );
    }
}

#[test]
fn trials_are_counted() {
    let setup = setup("tell_trials.xml", BLOCKS);
    let arguments = [
        "tell",
        "Put every red block into the box.",
        "--setup",
        &setup,
        "--trials",
        "4",
    ];
    let said = stdout(&tabletop(&arguments));
    assert!(said.starts_with("done              4 of 4\n"), "{said}");
    let failing = [
        "tell",
        "Put the blue block aside.",
        "--setup",
        &setup,
        "--trials",
        "2",
    ];
    let output = tabletop(&failing);
    assert_eq!(output.status.code(), Some(1));
    assert!(stdout(&output).contains("impossible        2  seeds 0, 1\n"));
}
