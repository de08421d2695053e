//! Results are not written over what they are made of, nor over anything else of the user's.

use std::{collections::BTreeMap, fs, path::Path};

use crate::support::{files, place, record_shipped, stderr, tabletop};

/// The command is refused as wrong input, for this reason, and nothing changes.
fn refused(arguments: &[&str], folder: &Path, reason: &str) {
    refused_with(2, arguments, folder, reason);
}

fn refused_with(code: i32, arguments: &[&str], folder: &Path, reason: &str) {
    let before = files(folder);
    let output = tabletop(arguments);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
    assert!(said.contains(reason), "{arguments:?}: {said}");
    assert_eq!(changed(&before, &files(folder)), [""; 0], "{arguments:?}");
}

fn changed<'f>(
    before: &'f BTreeMap<String, Vec<u8>>,
    after: &'f BTreeMap<String, Vec<u8>>,
) -> Vec<&'f String> {
    let names = before.keys().chain(after.keys());
    names
        .filter(|name| before.get(*name) != after.get(*name))
        .collect()
}

/// A folder with a recording `demo` in it, and the path of a name in it.
fn workplace(name: &str) -> (std::path::PathBuf, impl Fn(&str) -> String) {
    let folder = place(name);
    fs::create_dir(&folder).unwrap();
    record_shipped("stack_two_blocks", &format!("{name}/demo"));
    let inner = folder.clone();
    (folder, move |name: &str| {
        inner.join(name).to_str().unwrap().to_owned()
    })
}

/// A run with a file or folder for its result.
fn run_with<'a>(option: &'a str, place: &'a str) -> Vec<&'a str> {
    vec![
        "run",
        "shipped:scenarios/stack_two_blocks.ron",
        option,
        place,
    ]
}

#[test]
fn nothing_is_written_into_a_recording() {
    let (folder, at) = workplace("results_inside");
    let (demo, inner) = (at("demo"), at("demo/inner"));
    let inside = "it would be in the recording";
    refused(
        &["report", &demo, &at("demo/session.jsonl")],
        &folder,
        inside,
    );
    refused(&["report", &demo, &at("demo/page.html")], &folder, inside);
    refused(&["init", &demo], &folder, inside);
    refused(&["video", &demo, &at("demo/0/0.png")], &folder, inside);
    refused(&["edit", &demo, &inner, "--drop", "1"], &folder, inside);
    refused(&["replay", &demo, "--out", &inner], &folder, inside);
    refused(&["learn", &demo, "--out", &inner], &folder, inside);
    refused(&["multiply", &demo, "--out", &inner], &folder, inside);
    refused(&["imitate", &demo, "--record", &inner], &folder, inside);
    refused(
        &["dataset", "merge", &demo, "--out", &inner],
        &folder,
        inside,
    );
    refused(&["dataset", "trim", &demo, &inner], &folder, inside);
    refused(
        &["dataset", "split", &demo, &inner, "--into", "a=1"],
        &folder,
        inside,
    );
    for format in ["lerobot", "rlds", "mat", "mcap", "robomimic"] {
        refused(&["export", &demo, "--to", format, &inner], &folder, inside);
    }
    refused(
        &run_with("--final-state", &at("demo/states.csv")),
        &folder,
        inside,
    );
    refused(
        &run_with("--final-robot", &at("demo/robot.json")),
        &folder,
        inside,
    );
    refused(&run_with("--save", &at("demo/scene.xml")), &folder, inside);
    refused(&run_with("--record", &inner), &folder, inside);
}

#[test]
fn mixed_up_arguments_leave_a_recording_alone() {
    let (folder, at) = workplace("results_mixed_up");
    let (demo, other) = (at("demo"), at("other"));
    let copied = tabletop(&["edit", &demo, &other, "--retime", "1=0.9"]);
    assert!(copied.status.success(), "{}", stderr(&copied));
    for format in ["mat", "mcap", "lerobot", "rlds"] {
        let arguments = ["export", "--to", format, &demo, &other];
        refused(&arguments, &folder, "neither empty nor");
    }
    let session = at("other/session.jsonl");
    refused(
        &["export", "--to", "robomimic", &session, &demo],
        &folder,
        "it would be in the recording",
    );
}

#[test]
fn only_what_is_of_its_kind_is_replaced_and_only_if_that_is_said() {
    let (folder, at) = workplace("results_kinds");
    let demo = at("demo");
    for (name, text) in [
        ("thesis.html", "<!doctype html><title>Mine</title>"),
        ("film.mp4", "no film"),
        ("poses.csv", "mine,too"),
        ("robot.json", "mine"),
        ("policy.safetensors", "mine"),
        ("picture.svg", "<svg/>"),
    ] {
        fs::write(folder.join(name), text).unwrap();
    }
    let stays = "is there, and stays; name another file";
    refused(
        &["report", &demo, &at("thesis.html"), "--replace"],
        &folder,
        stays,
    );
    refused(
        &["video", &demo, &at("film.mp4"), "--replace"],
        &folder,
        stays,
    );
    refused(&run_with("--final-state", &at("poses.csv")), &folder, stays);
    refused(
        &run_with("--final-robot", &at("robot.json")),
        &folder,
        stays,
    );
    refused(
        &["learn", &demo, "--out", &at("policy.safetensors")],
        &folder,
        stays,
    );
    refused(
        &["learn", &demo, "--out", &at("picture.safetensors")],
        &folder,
        stays,
    );
    let plot = "the plot of the loss has this name";
    refused(&["learn", &demo, "--out", &at("new.svg")], &folder, plot);

    let page = at("page.html");
    assert!(tabletop(&["report", &demo, &page]).status.success());
    refused(&["report", &demo, &page], &folder, "--replace replaces it");
    assert!(
        tabletop(&["report", &demo, &page, "--replace"])
            .status
            .success()
    );
}

#[test]
fn a_missing_folder_is_noticed_before_the_work() {
    let (folder, at) = workplace("results_missing");
    let demo = at("demo");
    let missing = "there is no folder";
    refused_with(
        1,
        &["learn", &demo, "--out", &at("none/policy")],
        &folder,
        missing,
    );
    refused_with(
        1,
        &["report", &demo, &at("none/page.html")],
        &folder,
        missing,
    );
    refused_with(1, &["video", &demo, &at("none/film.mp4")], &folder, missing);
}
