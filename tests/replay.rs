//! Recordings, run again.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

fn tabletop(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tabletop"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// A recording of a shipped scenario, in a folder of this name.
fn recording(scenario: &str, name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    let scenario = format!("scenarios/{scenario}.ron");
    let output = tabletop(&["run", &scenario, "--record", folder.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    folder
}

#[test]
fn every_shipped_scenario_replays_to_the_same_bytes() {
    for scenario in ["stack_two_blocks", "build_letters", "lidbox", "break_chain"] {
        let folder = recording(scenario, scenario);
        assert!(folder.join("0/0.png").exists(), "{scenario} has no picture");
        let output = tabletop(&["replay", folder.to_str().unwrap(), "--verify"]);
        assert_eq!(
            output.status.code(),
            Some(0),
            "{scenario}: {}",
            stderr(&output)
        );
    }
}

#[test]
fn a_changed_recording_differs_in_the_changed_line() {
    let folder = recording("stack_two_blocks", "changed");
    let states = folder.join("states.csv");
    let text = fs::read_to_string(&states).unwrap();
    fs::write(
        &states,
        text.replacen("RedBlock,1.9999999", "RedBlock,2.0", 1),
    )
    .unwrap();
    let output = tabletop(&["replay", folder.to_str().unwrap(), "--verify"]);
    assert_eq!(output.status.code(), Some(1));
    let message = stderr(&output);
    assert!(message.contains("states.csv: line 2"), "{message}");
}

#[test]
fn pictures_are_made_again_at_another_size() {
    let folder = recording("stack_two_blocks", "rendered");
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("rendered-large");
    let _ = fs::remove_dir_all(&out);
    let output = tabletop(&[
        "replay",
        folder.to_str().unwrap(),
        "--render",
        "640x480",
        "--out",
        out.to_str().unwrap(),
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let png = fs::read(out.join("0/0.png")).unwrap();
    // Width and height stand at the beginning of a PNG file's header.
    assert_eq!(png[16..24], [0, 0, 2, 128, 0, 0, 1, 224]);
    let text = |folder: &Path| fs::read_to_string(folder.join("1.txt")).unwrap();
    assert_eq!(text(&folder), text(&out));
}

#[test]
fn what_is_no_recording_is_exit_code_2() {
    let output = tabletop(&["replay", "no such folder"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(stderr(&output).lines().count(), 1, "{}", stderr(&output));
}
