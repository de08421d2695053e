//! `tabletop dataset`: folders of recordings and LeRobot datasets.

use std::{fs, path::Path};

use crate::support::{place, record_shipped, replays_to_the_same_bytes, stderr, stdout, tabletop};

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

fn path(name: &str) -> String {
    place(name).to_str().unwrap().to_owned()
}

/// A folder of three recordings.
fn many(name: &str) -> String {
    let demo = record_shipped("stack_two_blocks", &format!("{name}_demo"));
    let many = path(&format!("{name}_many"));
    done(&["multiply", &demo, "--count", "3", "--out", &many]);
    many
}

/// The bytes of all files below a folder, by their names.
fn files(folder: &str) -> std::collections::BTreeMap<String, Vec<u8>> {
    let mut files = std::collections::BTreeMap::new();
    let mut folders = vec![Path::new(folder).to_owned()];
    while let Some(inner) = folders.pop() {
        for entry in fs::read_dir(inner).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => folders.push(path),
                false => {
                    let name = path.strip_prefix(folder).unwrap().display().to_string();
                    files.insert(name, fs::read(path).unwrap());
                }
            }
        }
    }
    files
}

#[test]
fn recordings_are_described_merged_split_and_dropped_whole() {
    let many = many("dataset_recordings");
    let before = files(&many);
    let info = done(&["dataset", "info", &many]);
    assert!(info.contains("episodes  3\n"), "{info}");
    assert!(info.contains("tasks     1\n       3  "), "{info}");
    let stats = done(&["dataset", "stats", &many]);
    assert!(stats.contains("episode [s]"), "{stats}");

    let [merged, split, rest] =
        ["merged", "split", "rest"].map(|name| path(&format!("dataset_recordings_{name}")));
    done(&["dataset", "merge", &many, &many, "--out", &merged]);
    assert!(done(&["dataset", "info", &merged]).contains("episodes  6\n"));
    let said = done(&[
        "dataset",
        "split",
        &many,
        &split,
        "--into",
        "train=2,valid=1",
    ]);
    assert_eq!(said, "train: 2 episodes.\nvalid: 1 episode.\n");
    done(&["dataset", "drop", &many, &rest, "--episodes", "1"]);
    for (folder, original) in [("0000", "0000"), ("0002", "0002")] {
        let copy = format!("{rest}/{folder}");
        assert_eq!(files(&copy), files(&format!("{many}/{original}")));
        replays_to_the_same_bytes(copy);
    }
    assert!(!Path::new(&rest).join("0001").exists());
    assert_eq!(files(&many), before, "the source stays as it is");

    let output = tabletop(&["dataset", "drop", &many, &rest, "--episodes", "0"]);
    assert_eq!(output.status.code(), Some(2));
    let said = stderr(&output);
    assert!(said.contains("something is there already"), "{said}");
}

#[test]
fn faults_of_recordings_are_found() {
    let many = many("dataset_faults");
    assert_eq!(
        done(&["dataset", "check", &many]),
        "3 episodes, nothing wrong.\n"
    );
    let copy = format!("{many}/0003");
    fs::create_dir(&copy).unwrap();
    for (name, bytes) in files(&format!("{many}/0002")) {
        let path = Path::new(&copy).join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    let states = format!("{many}/0001/states.csv");
    let text = fs::read_to_string(&states).unwrap();
    let last = text.lines().last().unwrap();
    let mut fields: Vec<_> = last.split(',').collect();
    fields[2] = "9.5";
    fs::write(&states, text.replace(last, &fields.join(","))).unwrap();
    fs::write(format!("{many}/0000/0/0.png"), "no picture").unwrap();
    let output = tabletop(&["dataset", "check", &many, "--quick"]);
    assert_eq!(output.status.code(), Some(1));
    let said = stdout(&output);
    for fault in [
        "0003: it is the same as",
        "0001: ",
        "is elsewhere in states.csv",
        "jumps by",
        "0/0.png: ",
    ] {
        assert!(said.contains(fault), "{fault}: {said}");
    }
}

#[test]
fn a_task_that_does_not_last_is_found() {
    let scenario = crate::support::scenario(
        "dataset_falls.ron",
        r#"Start, Grasp("RedBlock"), Glide(to: (2, 0, 6), seconds: 0.5), Glide(to: (-3.5, 0, 6), seconds: 1), Glide(to: (-3.5, 0, 3.05), seconds: 1), Release, Wait(0.1), Finish"#,
    );
    let demo = crate::support::record(scenario.to_str().unwrap(), "dataset_falls");
    let output = tabletop(&["dataset", "check", &demo]);
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(1), "{said}{}", stderr(&output));
    assert!(said.contains("no longer holds 5 s after the end"), "{said}");
}

#[test]
fn still_ends_are_cut_off_and_the_rest_replays() {
    let scenario = crate::support::scenario(
        "dataset_still.ron",
        r#"Start, Wait(3), Grasp("RedBlock"), Glide(to: (3, -2.5, 4), seconds: 0.5), Glide(to: (3, -2.5, 1.1), seconds: 0.5), Release, Wait(5), Finish"#,
    );
    let demo = crate::support::record(scenario.to_str().unwrap(), "dataset_still");
    let trimmed = path("dataset_still_trimmed");
    let said = done(&["dataset", "trim", &demo, &trimmed]);
    assert!(said.starts_with("1 episode, "), "{said}");
    let demo_name = Path::new(&demo).file_name().unwrap();
    let trimmed = Path::new(&trimmed).join(demo_name);
    replays_to_the_same_bytes(&trimmed);
    let trimmed = trimmed.to_str().unwrap();
    let seconds = |folder: &str| -> f64 {
        let info = done(&["dataset", "info", folder]);
        let line = info
            .lines()
            .find_map(|line| line.strip_prefix("seconds   "));
        line.unwrap().parse().unwrap()
    };
    assert!(
        seconds(trimmed) + 6.0 < seconds(&demo),
        "{}",
        seconds(trimmed)
    );
    assert_eq!(done(&["explain", trimmed]), done(&["explain", &demo]));
}

#[test]
fn lerobot_datasets_are_described_divided_and_repaired() {
    let many = many("dataset_lerobot");
    let [dataset, both, rest] =
        ["set", "both", "rest"].map(|name| path(&format!("dataset_lerobot_{name}")));
    done(&["export", &many, "--to", "lerobot", &dataset]);
    let info = done(&["dataset", "info", &dataset]);
    assert!(
        info.contains("kind      LeRobot dataset\nepisodes  3\n"),
        "{info}"
    );
    assert_eq!(
        done(&["dataset", "check", &dataset]),
        "3 episodes, nothing wrong.\n"
    );
    done(&["dataset", "drop", &dataset, &rest, "--episodes", "0-1"]);
    assert!(done(&["dataset", "info", &rest]).contains("episodes  1\n"));
    done(&["dataset", "merge", &dataset, &rest, "--out", &both]);
    let output = tabletop(&["dataset", "check", &both]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        stdout(&output).contains("episode 3: it is the same as"),
        "{}",
        stdout(&output)
    );
    let card = done(&["dataset", "card", &dataset]);
    let card = fs::read_to_string(card.trim()).unwrap();
    assert!(card.contains("- robotics"), "{card}");
    assert!(Path::new(&dataset).join("card/2-last.png").exists());

    let part = Path::new(&dataset).join("data/chunk-000/.file-001.parquet.part");
    fs::write(&part, "half").unwrap();
    let output = tabletop(&["dataset", "info", &dataset]);
    assert_eq!(output.status.code(), Some(2));
    let said = stderr(&output);
    assert!(said.contains("run `tabletop dataset repair`"), "{said}");
    let said = done(&["dataset", "repair", &dataset]);
    assert!(
        said.contains("before its 1 files were whole; that is made up for"),
        "{said}"
    );
    assert!(said.ends_with("3 episodes.\n"), "{said}");
    assert!(!part.exists());
    assert_eq!(
        done(&["dataset", "repair", &dataset]),
        "Nothing to repair.\n3 episodes.\n"
    );
}

#[test]
fn lerobot_datasets_with_videos_are_divided_without_being_decoded() {
    let many = many("dataset_video");
    let [videos, pictures, both, split, rest] = ["set", "pictures", "both", "split", "rest"]
        .map(|name| path(&format!("dataset_video_{name}")));
    let size = ["--size", "48x36"];
    done(
        &[
            &["export", &many, "--to", "lerobot", &videos, "--video"],
            &size[..],
        ]
        .concat(),
    );
    done(&[&["export", &many, "--to", "lerobot", &pictures], &size[..]].concat());
    let before = files(&videos);
    let described = |folder: &str, what: &str| done(&["dataset", what, folder]);
    assert!(described(&videos, "info").contains("cameras   1 (head)"));
    assert_eq!(described(&videos, "stats"), described(&pictures, "stats"));
    assert_eq!(described(&videos, "check"), "3 episodes, nothing wrong.\n");

    done(&["dataset", "drop", &videos, &rest, "--episodes", "1"]);
    assert_eq!(described(&rest, "check"), "2 episodes, nothing wrong.\n");
    done(&["dataset", "split", &videos, &split, "--into", "a=2,b=1"]);
    let halves = ["a", "b"].map(|half| format!("{split}/{half}"));
    assert_eq!(
        described(&halves[0], "check"),
        "2 episodes, nothing wrong.\n"
    );
    done(&["dataset", "merge", &halves[0], &halves[1], "--out", &both]);
    assert_eq!(described(&both, "check"), "3 episodes, nothing wrong.\n");
    let output = tabletop(&[
        "dataset",
        "merge",
        &videos,
        &pictures,
        "--out",
        &path("dataset_video_mixed"),
    ]);
    assert_eq!(output.status.code(), Some(2));
    let said = stderr(&output);
    assert!(said.contains("its observation.images.head is"), "{said}");
    assert_eq!(files(&videos), before, "the source stays as it is");

    let card = done(&["dataset", "card", &videos]);
    let card = fs::read_to_string(card.trim()).unwrap();
    assert!(card.contains("- robotics"), "{card}");

    let video = "videos/observation.images.head/chunk-000/file-000.mp4";
    fs::write(Path::new(&rest).join(video), &before[video]).unwrap();
    let output = tabletop(&["dataset", "check", &rest]);
    assert_eq!(output.status.code(), Some(1));
    let said = stdout(&output);
    assert!(
        said.contains("frames are not those of its episodes"),
        "{said}"
    );
}

#[test]
fn still_ends_of_videos_are_cut_off_where_the_rest_can_be_decoded() {
    // Motions that begin a frame apart: before one of them is a frame that needs the one before it.
    for wait in ["3", "3.25"] {
        let name = |what: &str| format!("dataset_still_video_{wait}{what}");
        let steps = format!(
            r#"Start, Wait({wait}), Grasp("RedBlock"), Glide(to: (3, -2.5, 4), seconds: 0.5), Glide(to: (3, -2.5, 1.1), seconds: 0.5), Release, Wait(5), Finish"#
        );
        let scenario = crate::support::scenario(&name(".ron"), &steps);
        let demo = crate::support::record(scenario.to_str().unwrap(), &name(""));
        let [set, trimmed] = ["_set", "_trimmed"].map(|what| path(&name(what)));
        done(&[
            "export", &demo, "--to", "lerobot", &set, "--video", "--size", "48x36",
        ]);
        let said = done(&["dataset", "trim", &set, &trimmed]);
        assert!(said.starts_with("1 episode, "), "{said}");
        assert_eq!(
            done(&["dataset", "check", &trimmed]),
            "1 episode, nothing wrong.\n"
        );
    }
}
