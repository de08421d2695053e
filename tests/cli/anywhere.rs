//! The program in a folder in which nothing of it is.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

use serde_json::Value;

use crate::support::{command, place, stderr, stdout, tabletop};

/// An empty folder.
fn folder(name: &str) -> PathBuf {
    let folder = place(&format!("anywhere-{name}"));
    fs::create_dir(&folder).unwrap();
    folder
}

fn run_in(folder: &Path, arguments: &[&str]) -> Output {
    command(arguments).current_dir(folder).output().unwrap()
}

fn succeeded(output: &Output) {
    assert_eq!(output.status.code(), Some(0), "{}", stderr(output));
}

#[test]
fn the_default_task_file_is_inside_the_program() {
    let folder = folder("default");
    let output = run_in(&folder, &["run", "--seconds", "1", "--final-state", "-"]);
    succeeded(&output);
    assert!(stdout(&output).contains("RedBlock"));
    let said = stderr(&output);
    assert!(
        said.starts_with("tabletop: shipped:tablesetup/default.xml: "),
        "{said}"
    );

    fs::create_dir(folder.join("tablesetup")).unwrap();
    let own = "<tabletop xmlns='http://synapse.cs.umd.edu/tabletop-xml'/>";
    fs::write(folder.join("tablesetup/default.xml"), own).unwrap();
    let output = run_in(&folder, &["run", "--seconds", "1", "--final-state", "-"]);
    succeeded(&output);
    assert!(
        !stdout(&output).contains("RedBlock"),
        "the folder's own goes first"
    );
}

#[test]
fn without_a_display_the_window_is_a_run_anywhere() {
    let output = run_in(&folder("window"), &[]);
    assert!(stdout(&output).contains("RedBlock"), "{}", stderr(&output));
}

#[test]
fn task_files_and_robots_are_found_by_their_usual_names() {
    let folder = folder("names");
    let output = run_in(&folder, &["check", "tablesetup/tower.xml"]);
    succeeded(&output);
    assert_eq!(stdout(&output), "tablesetup/tower.xml: ok\n");
    let smile = ["--robot", "assets/baxter/baxter_smile.urdf", "--quiet"];
    let output = run_in(
        &folder,
        &[&["run", "--seconds", "0.1"], &smile[..]].concat(),
    );
    succeeded(&output);
    assert_eq!(stderr(&output), "");
    let output = run_in(&folder, &["run", "scenarios/no_such.ron"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("scenarios/no_such.ron"));
}

#[test]
fn a_shipped_scenario_is_recorded_with_its_true_name_and_replayed_elsewhere() {
    let folder = folder("scenario");
    let scenario = ["run", "scenarios/stack_two_blocks.ron", "--record", "demo"];
    let smile = ["--robot", "assets/baxter/baxter_smile.urdf"];
    succeeded(&run_in(&folder, &[&scenario[..], &smile].concat()));
    let log = fs::read_to_string(folder.join("demo/session.jsonl")).unwrap();
    let header: Value = serde_json::from_str(log.lines().next().unwrap()).unwrap();
    let settings = &header["settings"];
    assert_eq!(
        settings["scenario"],
        "shipped:scenarios/stack_two_blocks.ron"
    );
    let source = &settings["robot"]["description"]["path"];
    assert_eq!(source, "shipped:assets/baxter/baxter_smile.urdf");
    let demo = folder.join("demo");
    succeeded(&tabletop(&["replay", demo.to_str().unwrap(), "--verify"]));
}

#[test]
fn a_working_folder_is_written_and_used() {
    let folder = folder("init");
    let written = run_in(&folder, &["init", "work"]);
    succeeded(&written);
    let said = stdout(&written);
    assert_eq!(said.lines().count(), 6, "{said}");
    for file in [
        "tablesetup/default.xml",
        "tablesetup/tabletop.xsd",
        "matlab/agentBehavior.m",
        "scenarios/stack_two_blocks.ron",
        "python/example.py",
        "assets/panda/robot.ron",
    ] {
        let text = fs::read(folder.join("work").join(file)).unwrap();
        assert_eq!(text, fs::read(file).unwrap(), "{file}");
    }
    let again = run_in(&folder, &["init", "work"]);
    succeeded(&again);
    assert!(stdout(&again).contains("there already"));

    fs::remove_file(folder.join("work/python/example.py")).unwrap();
    fs::write(folder.join("work/tablesetup/default.xml"), "mine").unwrap();
    let refused = run_in(&folder, &["init", "work"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(stderr(&refused).contains("work/tablesetup/default.xml"));
    assert!(
        !folder.join("work/python/example.py").exists(),
        "nothing is written"
    );
    let own = fs::read_to_string(folder.join("work/tablesetup/default.xml")).unwrap();
    assert_eq!(own, "mine");
}

#[test]
fn names_without_folder_and_ending_lead_to_shipped_files() {
    for (args, near) in [
        (
            ["run", "stack_three", "--quiet"],
            "scenarios/stack_three.ron",
        ),
        (["robot", "check", "panda"], "assets/panda/robot.ron"),
        (["run", "--setup", "block"], "tablesetup/blocks.xml"),
        (["run", "default", "--quiet"], "tablesetup/default.xml"),
        (["check", "towr.xml", "--dump"], "tablesetup/tower.xml"),
        (
            ["--setup", "hanoi", "--no-settings"],
            "tablesetup/hanoi.xml",
        ),
    ] {
        let refused = tabletop(&args);
        assert_eq!(refused.status.code(), Some(2), "{args:?}");
        let said = stderr(&refused);
        assert!(said.contains(&format!("did you mean {near}?")), "{said}");
    }
}

#[test]
fn shells_get_completions() {
    for (shell, words) in [
        ("bash", "complete -F _tabletop"),
        ("zsh", "#compdef tabletop"),
        ("fish", "complete -c tabletop"),
    ] {
        let output = tabletop(&["completions", shell]);
        succeeded(&output);
        assert!(stdout(&output).contains(words), "{shell}");
    }
    let script = stdout(&tabletop(&["completions", "bash"]));
    let mut bash = Command::new("bash");
    let checked = bash.args(["-n", "-c", &script]).status();
    assert!(checked.is_ok_and(|status| status.success()));
}

#[test]
fn the_program_is_put_among_the_applications_of_the_desktop() {
    let folder = folder("desktop");
    let data = folder.join("data");
    let output = command(&["init", "work", "--desktop"])
        .current_dir(&folder)
        .env("XDG_DATA_HOME", &data)
        .output()
        .unwrap();
    succeeded(&output);
    let entry = fs::read_to_string(data.join("applications/tabletop.desktop")).unwrap();
    assert!(entry.contains(env!("CARGO_BIN_EXE_tabletop")), "{entry}");
    let work = folder.join("work");
    assert!(
        entry.contains(&format!("Path={}\n", work.display())),
        "{entry}"
    );
    assert!(work.join("tablesetup").is_dir());
    assert!(
        data.join("icons/hicolor/scalable/apps/tabletop.svg")
            .is_file()
    );
    fs::remove_dir_all(folder).unwrap();
}
