//! `tabletop edit`: a recording of another's segments.

use std::{fs, thread, time::Duration};

use crate::support::{
    command, place, record, replays_to_the_same_bytes, scenario, stderr, stdout, tabletop,
};

fn done(arguments: &[&str]) -> String {
    let output = tabletop(arguments);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{arguments:?}: {}",
        stderr(&output)
    );
    stdout(&output)
}

/// The red block is put to the right, then the green one to the left.
fn demo(name: &str) -> String {
    let steps = r#"Start, Wait(0.5),
        Grasp("RedBlock"), Glide(to: (5, -2.5, 4), seconds: 0.5), Glide(to: (5, -2.5, 1.1), seconds: 0.5), Release, Wait(0.5),
        Grasp("GreenBlock"), Glide(to: (-5, -2.5, 4), seconds: 0.5), Glide(to: (-5, -2.5, 1.1), seconds: 0.5), Release, Wait(0.5),
        Finish"#;
    record(
        scenario(&format!("{name}.ron"), steps).to_str().unwrap(),
        name,
    )
}

fn seconds(folder: &str) -> f64 {
    let info = done(&["dataset", "info", folder]);
    let line = info
        .lines()
        .find_map(|line| line.strip_prefix("seconds   "));
    line.unwrap().parse().unwrap()
}

#[test]
fn segments_are_left_out_exchanged_slowed_and_appended() {
    let demo = demo("edit_demo");
    let explained = done(&["explain", &demo]);
    let both: Vec<_> = explained.lines().collect();
    let out = place("edit_out").to_str().unwrap().to_owned();

    done(&["edit", &demo, &out, "--drop", "3-4"]);
    replays_to_the_same_bytes(&out);
    let said = done(&["explain", &out]);
    assert_eq!(said.lines().collect::<Vec<_>>(), [both[0]]);

    done(&["edit", &demo, &out, "--swap", "1-2,3-4"]);
    replays_to_the_same_bytes(&out);
    let said = done(&["explain", &out]);
    assert!(said.lines().next().unwrap().contains("green"), "{said}");
    assert_eq!(said.lines().count(), 2);

    done(&["edit", &demo, &out, "--retime", "1=2"]);
    replays_to_the_same_bytes(&out);
    let longer = seconds(&out) - seconds(&demo);
    assert!((0.5..2.5).contains(&longer), "{longer}");
    assert_eq!(done(&["explain", &out]), explained);

    let twice = place("edit_twice").to_str().unwrap().to_owned();
    done(&["edit", &demo, &twice, "--splice", &demo]);
    replays_to_the_same_bytes(&twice);
    assert!((seconds(&twice) - 2.0 * seconds(&demo)).abs() < 0.2);
}

#[test]
fn an_edit_that_fails_is_refused_with_the_reason() {
    let demo = demo("edit_refused_demo");
    let out = place("edit_refused");
    for (edit, reason) in [
        (
            ["--drop", "1"],
            "segment 2: the release of RedBlock does not happen any more",
        ),
        (
            ["--swap", "1,2"],
            "segment 2: the release of RedBlock does not happen any more",
        ),
        (
            ["--drop", "9"],
            "there is no segment 9 to edit; the recording has segments 1 to 4",
        ),
        (["--drop", "0"], "there is no segment 0 to edit"),
    ] {
        let output = tabletop(&[&["edit", &demo, out.to_str().unwrap()][..], &edit].concat());
        assert_eq!(
            output.status.code(),
            Some(1),
            "{edit:?}: {}",
            stderr(&output)
        );
        assert!(
            stderr(&output).contains(reason),
            "{edit:?}: {}",
            stderr(&output)
        );
        assert!(!out.exists());
    }
    assert!(fs::read_dir(&demo).is_ok());
    let output = tabletop(&["edit", &demo, out.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn requirements_that_are_not_taken_over_are_named() {
    let demo = demo("edit_required_demo");
    let out = place("edit_required_out").to_str().unwrap().to_owned();
    let edit = ["edit", &demo, &out, "--retime", "3=2", "--quiet"];
    assert_eq!(stderr(&tabletop(&edit)), "");
    fs::write(format!("{demo}/task.json"), "{}").unwrap();
    fs::remove_dir_all(&out).unwrap();
    let output = tabletop(&edit);
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("task.json: these requirements are not taken over"));
}

#[test]
fn a_killed_edit_leaves_nothing_of_its_name() {
    let demo = demo("edit_killed_demo");
    let folder = place("edit_killed");
    fs::create_dir(&folder).unwrap();
    let out = folder.join("out");
    let to = out.to_str().unwrap();
    // All segments, so that it lasts.
    let retimed = ["1=100", "2=100", "3=100", "4=100"].map(|segment| ["--retime", segment]);
    let edit = ["edit", &demo, to];
    let edit: Vec<_> = edit
        .into_iter()
        .chain(retimed.into_iter().flatten())
        .collect();
    let mut edit = command(&edit).spawn().unwrap();
    let is_begun = || fs::read_dir(&folder).unwrap().count() >= 2;
    // The hidden folder and its lock.
    while !is_begun() {
        assert_eq!(edit.try_wait().unwrap(), None, "it has ended");
        thread::sleep(Duration::from_millis(5));
    }
    edit.kill().unwrap();
    edit.wait().unwrap();
    assert!(!out.exists());
    let output = tabletop(&["edit", &demo, to, "--drop", "3-4"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let names = fs::read_dir(&folder).unwrap().count();
    assert_eq!(names, 1, "something of the killed edit is left");
    replays_to_the_same_bytes(&out);
}
