//! `tabletop watch` and `tabletop imitate --eyes`: tasks and objects, seen in pictures.

use std::fs;

use serde_json::Value;
use tabletop::{film::Canvas, recorder::read_picture, storage::InnerFile};

use crate::support::{files, place, record_shipped, stderr, stdout, tabletop};

fn recorded(scenario: &str, by: &str) -> String {
    record_shipped(scenario, &format!("watch_{by}_{scenario}"))
}

/// Output of `watch`, without the errors of the poses.
fn seen(arguments: &[&str]) -> String {
    let output = tabletop(&[&["watch"], arguments].concat());
    assert_eq!(stderr(&output), "");
    let said = stdout(&output);
    let lines = said.lines().filter(|line| !line.contains(" pictures; "));
    lines.map(|line| format!("{line}\n")).collect()
}

#[test]
fn pictures_show_the_same_tasks_as_recordings() {
    for scenario in [
        "stack_three",
        "swap",
        "wall",
        "letter_u",
        "hanoi",
        "chest",
        "stand_up",
    ] {
        let demo = recorded(scenario, "tasks");
        assert_eq!(seen(&[&demo]), stdout(&tabletop(&["explain", &demo])));
    }
}

#[test]
fn poses_are_seen_to_a_millimetre_on_average() {
    let demo = recorded("stack_three", "poses");
    let said = stdout(&tabletop(&["watch", &demo, "--json"]));
    let json: Value = serde_json::from_str(&said).unwrap();
    let errors = json["errors"].as_array().unwrap().iter();
    let mut errors: Vec<_> = errors.map(|error| error.as_f64().unwrap()).collect();
    errors.sort_by(f64::total_cmp);
    assert!(errors[errors.len() / 2] < 0.01, "{errors:?}");
    assert!(errors[errors.len() - 1] < 0.1, "{errors:?}");
}

#[test]
fn what_was_watched_is_a_recording() {
    let demo = recorded("stack_three", "record");
    let out = place("watch_recorded");
    let out = out.to_str().unwrap();
    let sentences = seen(&[&demo, "--record", out]);
    assert_eq!(stdout(&tabletop(&["explain", out])), sentences);
    let pictures = |folder: &str| {
        let segments = fs::read_dir(folder).unwrap().map(Result::unwrap);
        let segments = segments.filter(|entry| entry.path().is_dir());
        segments
            .map(|segment| fs::read_dir(segment.path()).unwrap().count())
            .sum::<usize>()
    };
    assert_eq!(pictures(out), pictures(&demo));
    let session = fs::read_to_string(format!("{out}/session.jsonl")).unwrap();
    assert!(session.contains("\"from\":\"pictures\""));
}

#[test]
fn a_folder_of_pictures_is_watched_with_a_task_file() {
    let demo = recorded("stack_three", "folder");
    let pictures = place("watch_pictures");
    fs::create_dir_all(&pictures).unwrap();
    let mut number = 0;
    for segment in 0..5 {
        let folder = format!("{demo}/{segment}");
        let mut frames: Vec<_> = fs::read_dir(folder).unwrap().map(Result::unwrap).collect();
        frames.sort_by_key(|frame| {
            let path = frame.path();
            let name = path.file_stem().unwrap().to_str().unwrap();
            name.parse::<u32>().unwrap()
        });
        for frame in frames {
            fs::copy(frame.path(), pictures.join(format!("{number:05}.png"))).unwrap();
            number += 1;
        }
    }
    let pictures = pictures.to_str().unwrap();
    let told = stdout(&tabletop(&["explain", &demo]));
    let said = seen(&[pictures, "--setup", "tablesetup/blocks.xml"]);
    assert_eq!(said, told);
    // Without it, the objects are described first.
    let output = tabletop(&["watch", pictures]);
    let described = stderr(&output);
    for name in ["red", "green", "blue"] {
        let line = format!("tabletop: {name}: a block at (");
        assert!(described.contains(&line), "{described}");
    }
    assert_eq!(stdout(&output), told);
}

/// A recording with its pictures changed, part by part.
fn with_pictures_changed(demo: &str, name: &str, change: impl Fn(u8) -> u8) -> String {
    let out = place(name);
    let out = out.to_str().unwrap();
    assert!(tabletop(&["watch", demo, "--record", out]).status.success());
    for file in files(out.as_ref())
        .into_keys()
        .filter(|file| file.ends_with(".png"))
    {
        let path = format!("{out}/{file}");
        let mut picture = read_picture(&InnerFile::at(path.as_ref()).unwrap()).unwrap();
        picture
            .rgb
            .iter_mut()
            .for_each(|part| *part = change(*part));
        fs::write(path, Canvas::of(&picture).png().unwrap()).unwrap();
    }
    out.to_owned()
}

#[test]
fn pictures_of_another_brightness_show_the_same_task() {
    let demo = recorded("stack_three", "brightness");
    let told = stdout(&tabletop(&["explain", &demo]));
    for (name, gain, black) in [
        ("darker", 0.7, 0.0),
        ("brighter", 1.2, 0.0),
        ("pale", 0.8, 25.0),
    ] {
        let change = |part: u8| (f32::from(part) * gain + black).round().min(255.0) as u8;
        let changed = with_pictures_changed(&demo, &format!("watch_{name}"), change);
        let output = tabletop(&["watch", &changed]);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", stdout(&output));
        assert_eq!(seen(&[&changed]), told, "{name}");
    }
}

#[test]
fn what_was_not_seen_is_said() {
    let demo = recorded("stack_three", "unsure");
    let empty = with_pictures_changed(&demo, "watch_nothing", |_| 0);
    let output = tabletop(&["watch", &empty]);
    assert_eq!(output.status.code(), Some(1), "{}", stdout(&output));
    for name in ["Red", "Green", "Blue"] {
        let line = format!("Unsure: {name} was never surely seen.");
        assert!(stdout(&output).contains(&line), "{}", stdout(&output));
    }
    let output = tabletop(&["watch", &empty, "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let json: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let doubts = json["doubts"].as_array().unwrap();
    assert!(
        doubts.len() == 3 && doubts.iter().all(|it| it["never_seen"] == true),
        "{json}"
    );
}

#[test]
fn what_cannot_be_watched_is_said() {
    let empty = place("watch_empty");
    fs::create_dir_all(&empty).unwrap();
    for folder in [empty.to_str().unwrap(), "no/such/folder"] {
        let output = tabletop(&["watch", folder]);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).contains(folder), "{}", stderr(&output));
    }
}

#[test]
fn the_robot_does_what_it_sees() {
    let demo = recorded("stack_three", "robot");
    let arguments = ["imitate", &demo, "--eyes", "--watch", "--trials", "3"];
    let output = tabletop(&arguments);
    assert!(
        stdout(&output).contains("done              3 of 3"),
        "{}",
        stdout(&output)
    );
    assert!(!tabletop(&["imitate", &demo, "--watch"]).status.success());
}

#[test]
fn pictures_of_another_size_are_watched_and_none_may_differ() {
    let demo = recorded("stack_three", "size");
    let pictures = place("watch_sizes");
    fs::create_dir_all(&pictures).unwrap();
    let large = place("watch_large");
    let large = large.to_str().unwrap();
    let drawn = tabletop(&["replay", &demo, "--render", "400x300", "--out", large]);
    assert!(drawn.status.success(), "{}", stderr(&drawn));
    let large = fs::read(format!("{large}/0/0.png")).unwrap();
    for number in 0..3 {
        fs::write(pictures.join(format!("{number}.png")), &large).unwrap();
    }
    let setup = ["--setup", "tablesetup/blocks.xml"];
    let folder = pictures.to_str().unwrap();
    let output = tabletop(&[&["watch", folder], &setup[..]].concat());
    assert_eq!(stdout(&output), "Nothing is moved for good.\n");
    assert_eq!(stderr(&output), "");
    fs::copy(format!("{demo}/0/0.png"), pictures.join("3.png")).unwrap();
    let output = tabletop(&[&["watch", folder], &setup[..]].concat());
    assert_eq!(output.status.code(), Some(2));
    let said = stderr(&output);
    assert!(
        said.contains("3.png: the picture has 200 x 150 pixels"),
        "{said}"
    );
}

#[test]
fn a_camera_that_was_bumped_is_found() {
    let demo = recorded("stack_three", "bumped");
    let picture = format!("{demo}/0/0.png");
    let output = tabletop(&["robot", "calibrate", &picture]);
    let found: Value = serde_json::from_str(&stdout(&output)).unwrap();
    let off = |name: &str| found["off"][name].as_f64().unwrap();
    // Nobody has bumped it.
    assert!(off("units") < 0.15 && off("degrees") < 1.0, "{found}");
    assert_eq!(seen(&[&demo, "--calibrate"]), seen(&[&demo]));
    let output = tabletop(&["robot", "calibrate", "nowhere.png"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("nowhere.png"),
        "{}",
        stderr(&output)
    );
}

/// Pegs that look alike and stand in any direction, one of them hidden at first; and blocks that fall a little when they are let go.
#[test]
fn what_was_hidden_or_let_go_is_seen_anew() {
    for (scenario, seeds) in [("hanoi", &["1", "6"][..]), ("wall", &["4", "8"])] {
        let demo = recorded(scenario, "anew");
        for seed in seeds {
            let arguments = ["imitate", &demo, "--eyes", "--watch", "--seed", seed];
            let output = tabletop(&arguments);
            assert!(
                stdout(&output).starts_with("Done"),
                "{scenario} {seed}: {}",
                stdout(&output)
            );
        }
    }
}
