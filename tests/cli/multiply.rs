//! `tabletop multiply`: one demonstration becomes many.

use std::{fs, path::Path};

use tabletop::{
    controller::Sight,
    core::{HeadCamera, StepApp as _, TICKS_PER_SECOND, Table},
    headless_app_with,
    recorder::RecordingReader,
    replay::Replay,
};

use crate::support::{
    files, place, record, record_shipped, replays_to_the_same_bytes, stderr, stdout, tabletop,
};

fn multiply(demo: &str, out: &Path, options: &[&str]) -> String {
    let out = out.to_str().unwrap();
    let output = tabletop(&[&["multiply", demo, "--out", out], options].concat());
    let reported = stdout(&output) + &stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{reported}");
    reported
}

fn explained(demo: &Path) -> String {
    let output = tabletop(&["explain", demo.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    stdout(&output)
}

#[test]
fn one_demonstration_becomes_many_that_show_the_same() {
    let demo = record_shipped("stack_three", "multiply_same");
    let out = place("multiply_same_out");
    multiply(&demo, &out, &["--count", "4", "--seed", "3"]);
    let expected = explained(Path::new(&demo));
    let mut sessions = Vec::new();
    for number in ["0000", "0001", "0002", "0003"] {
        let folder = out.join(number);
        assert_eq!(explained(&folder), expected, "{number}");
        assert!(folder.join("0/0.png").is_file(), "{number}");
        sessions.push(fs::read(folder.join("session.jsonl")).unwrap());
    }
    sessions.dedup();
    assert_eq!(sessions.len(), 4);
    replays_to_the_same_bytes(out.join("0002"));
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_existing_recordings_are_kept() {
    let demo = record_shipped("stack_three", "multiply_bytes");
    let [one, other] = ["multiply_bytes_one", "multiply_bytes_other"].map(place);
    let options = ["--colors", "--distractors", "3", "--camera", "1"];
    multiply(&demo, &one, &[&options[..], &["--count", "3"]].concat());
    multiply(
        &demo,
        &other,
        &[&options[..], &["--count", "1", "--jobs", "1"]].concat(),
    );
    // As if the program had been killed.
    let left = other.join(".making-1");
    fs::create_dir_all(left.join("0001")).unwrap();
    fs::write(left.join(".tabletop-lock"), "").unwrap();
    fs::write(left.join("0001/session.jsonl"), "{").unwrap();
    let kept = fs::metadata(other.join("0000/states.csv"))
        .unwrap()
        .modified()
        .unwrap();
    let reported = multiply(
        &demo,
        &other,
        &[&options[..], &["--count", "3", "--jobs", "1"]].concat(),
    );
    assert!(reported.contains("1 were there\n2 made in "), "{reported}");
    let still = fs::metadata(other.join("0000/states.csv"))
        .unwrap()
        .modified()
        .unwrap();
    assert_eq!(kept, still);
    let (one, other) = (files(&one), files(&other));
    assert!(one.len() > 30);
    assert_eq!(
        one.keys().collect::<Vec<_>>(),
        other.keys().collect::<Vec<_>>()
    );
    for (name, bytes) in one {
        assert!(other[&name] == bytes, "{name}");
    }
}

#[test]
fn demonstrations_of_other_options_are_not_mixed() {
    let demo = record_shipped("stack_three", "multiply_mixed");
    let out = place("multiply_mixed_out");
    multiply(&demo, &out, &["--count", "1"]);
    let out = out.to_str().unwrap();
    let output = tabletop(&["multiply", &demo, "--out", out, "--seed", "1"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("made with other options"),
        "{}",
        stderr(&output)
    );
    // Nor is anything else in the folder touched.
    let output = tabletop(&["multiply", &demo, "--out", &demo]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("it holds something else"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn variations_keep_required_properties() {
    let demo = record_shipped("stack_three", "multiply_required");
    let output = tabletop(&["require", &demo, "--step", "2", "color=red"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let out = place("multiply_required_out");
    let options = ["--count", "3", "--colors", "--distractors", "2"];
    multiply(&demo, &out, &options);
    for number in ["0000", "0001", "0002"] {
        let reported = explained(&out.join(number));
        assert!(reported.contains("2. Put the red object on"), "{reported}");
        let events = fs::read_to_string(out.join(number).join("0.txt")).unwrap();
        assert!(events.contains("create,Red,"), "{events}");
    }
}

#[test]
fn the_robot_can_show_it() {
    let demo = record_shipped("stack_three", "multiply_robot");
    let out = place("multiply_robot_out");
    multiply(&demo, &out, &["--count", "1", "--robot"]);
    let joints = fs::read_to_string(out.join("0000/joints.csv")).unwrap();
    assert!(joints.lines().count() > 100);
    replays_to_the_same_bytes(out.join("0000"));
}

#[test]
fn objects_are_narrower_and_as_high() {
    let demo = record_shipped("wall", "multiply_sizes");
    let out = place("multiply_sizes_out");
    multiply(&demo, &out, &["--count", "2", "--sizes", "0.2"]);
    for number in ["0000", "0001"] {
        let folder = out.join(number);
        assert_eq!(explained(&folder).lines().count(), 5, "{number}");
        let events = fs::read_to_string(folder.join("0.txt")).unwrap();
        let created = events.lines().filter(|line| line.contains(",create,"));
        for line in created {
            let span = |name: &str| {
                let after = line.split_once(name).unwrap().1;
                let number = after.split(',').next().unwrap();
                number.parse::<f32>().unwrap()
            };
            assert_eq!(span("zspan,"), 1.0, "{line}");
            for name in ["xspan,", "yspan,"] {
                assert!(span(name) > 0.799 && span(name) < 1.0, "{line}");
            }
        }
    }
}

#[test]
fn a_stack_is_shown_with_the_objects_of_another_table() {
    let demo = record_shipped("stack_three", "multiply_setup");
    let out = place("multiply_setup_out");
    let setup = "shipped:tablesetup/wall-blocks.xml";
    multiply(&demo, &out, &["--count", "1", "--setup", setup]);
    let told = explained(&out.join("0000"));
    assert_eq!(told.lines().count(), 2, "{told}");
    let events = fs::read_to_string(out.join("0000/0.txt")).unwrap();
    assert!(events.contains(",create,Orange,"));
}

#[test]
fn the_light_differs_and_nothing_else_does() {
    let demo = record_shipped("stack_three", "multiply_light");
    let [plain, lit, same] = [
        "multiply_light_plain",
        "multiply_light_lit",
        "multiply_light_same",
    ]
    .map(place);
    multiply(&demo, &plain, &["--count", "2"]);
    multiply(&demo, &lit, &["--count", "2", "--light", "0.3"]);
    multiply(
        &demo,
        &same,
        &["--count", "2", "--light", "0.3", "--jobs", "1"],
    );
    let [plain, mut lit, same] = [&plain, &lit, &same].map(|folder| files(folder));
    assert!(lit == same);
    assert_ne!(lit["0000/0/0.png"], plain["0000/0/0.png"]);
    let light = |name: &str| {
        let header = lit[name].split(|byte| *byte == b'\n').next().unwrap();
        let header: serde_json::Value = serde_json::from_slice(header).unwrap();
        header["camera"]["light"].clone()
    };
    let [one, other] = ["0000/session.jsonl", "0001/session.jsonl"].map(light);
    assert!(one["color"][0].is_number());
    assert_ne!(one, other);
    lit.retain(|name, _| name.ends_with(".csv") || name.ends_with(".txt"));
    for (name, bytes) in lit {
        assert!(plain[&name] == bytes, "{name}");
    }
    let folder = place("multiply_light_lit_again");
    multiply(&demo, &folder, &["--count", "1", "--light", "0.3"]);
    replays_to_the_same_bytes(folder.join("0000"));
}

#[test]
fn all_that_is_moved_is_seen() {
    let demo = record_shipped("stack_three", "multiply_in_view");
    let out = place("multiply_in_view_out");
    let printed = multiply(&demo, &out, &["--count", "8", "--in-view"]);
    assert!(
        printed.contains("the head camera did not see all that is moved"),
        "{printed}"
    );
    (0..8).for_each(|number| assert_watched_as_explained(&out.join(format!("{number:04}"))));
    // The red block is put aside where there is room, which may be out of view.
    let demo = record_shipped("swap", "multiply_in_view_swap");
    let out = place("multiply_in_view_swap_out");
    let tenth = ["--seed", "1", "--count", "100", "--shard", "10/100"];
    multiply(&demo, &out, &[&tenth[..], &["--in-view"]].concat());
    assert_watched_as_explained(&out.join("0010"));
}

fn assert_watched_as_explained(recording: &Path) {
    let watched = stdout(&tabletop(&["watch", recording.to_str().unwrap()]));
    let told = explained(recording);
    assert!(
        watched.starts_with(&told),
        "{recording:?}: {watched}\n{told}"
    );
}

#[test]
fn another_robot_shows_it() {
    const PANDA: &str = "shipped:assets/panda/robot.ron";
    // Blocks that fit between its fingers.
    let scenario = place("multiply_panda.ron");
    let text = r#"(
        setup: "shipped:tablesetup/panda-stack.xml",
        steps: [
            WaitUntilRest(3), Start,
            Grasp("Blue"), MoveBy((0, 0, 2)), MoveTo((2, -2.5, 2)), MoveTo((2, -2.5, 0.8)), WaitUntilThere(1), Release,
            WaitUntilRest(3), Finish,
        ],
    )"#;
    fs::write(&scenario, text).unwrap();
    let [demo, out] = ["multiply_panda", "multiply_panda_out"].map(place);
    let [scenario, demo] = [&scenario, &demo].map(|path| path.to_str().unwrap());
    let output = tabletop(&["run", scenario, "--record", demo]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let options = ["--count", "2", "--robot", PANDA, "--camera", "0.5"];
    multiply(demo, &out, &options);
    for number in ["0000", "0001"] {
        let joints = fs::read_to_string(out.join(number).join("joints.csv")).unwrap();
        assert!(joints.contains(",panda_joint1,"), "{joints:.200}");
    }
    replays_to_the_same_bytes(out.join("0000"));
    // Its camera is moved, not Baxter's.
    let recording = RecordingReader::open(out.join("0000")).unwrap();
    let moved = recording.header().camera.unwrap();
    let usual = HeadCamera {
        mount: None,
        ..moved
    };
    let [moved_to, usual_at, baxters] =
        [moved, usual, HeadCamera::default()].map(|it| it.pose(&Table::default()).location);
    let way = (moved_to - usual_at).abs().max_element();
    assert!(moved.mount.is_some() && way <= 0.501, "{way}");
    assert!(usual_at.distance(baxters) > 1.0, "{usual_at}, {baxters}");
    // Those of another robot are others.
    let output = tabletop(&["multiply", demo, "--robot", "--out", out.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    let told = stderr(&output);
    assert!(told.contains("made with other options"), "{told}");
}

/// Lets time pass after the end of a recording; the objects that have moved meanwhile by more than a part of a unit.
fn moved_after(recording: &Path, seconds: u64) -> Vec<String> {
    let replay = Replay::read(recording).unwrap();
    let mut app = headless_app_with(replay.plugins());
    replay.play_in(&mut app);
    app.step(replay.ticks());
    let ended = Sight::of(app.world_mut()).objects;
    app.step(seconds * u64::from(TICKS_PER_SECOND));
    let later = Sight::of(app.world_mut()).objects;
    assert!(!ended.is_empty());
    let has_moved = |id: &&String| match later.get(*id) {
        Some(now) => now.pose.location.distance(ended[*id].pose.location) > 0.1,
        None => true,
    };
    ended.keys().filter(has_moved).cloned().collect()
}

/// `COUNT=1000` looks at more of them.
#[test]
fn objects_that_were_put_down_stay() {
    let count = std::env::var("COUNT").unwrap_or_else(|_| "12".into());
    let steps = "WaitUntilRest(5), Start,
        Grasp(\"Green\"), Glide(to: (0, -4, 4), seconds: 0.3), Glide(to: (3.3, -2.5, 4), seconds: 0.5),
        Glide(to: (3.3, -2.5, 1.5), seconds: 0.5), WaitUntilThere(2), Release, WaitUntilRest(2),
        Grasp(\"Red\"), Glide(to: (-3, -3, 4), seconds: 0.3), Glide(to: (3.55, -2.5, 4), seconds: 0.5),
        Glide(to: (3.55, -2.5, 2.5), seconds: 0.5), WaitUntilThere(2), Release, WaitUntilRest(2), Finish,";
    let file = place("multiply_leaning.ron");
    let text = format!("(setup: \"shipped:tablesetup/blocks.xml\", steps: [{steps}])");
    fs::write(&file, text).unwrap();
    let demo = record(file.to_str().unwrap(), "multiply_leaning");
    let out = place("multiply_leaning_out");
    let options = ["--count", &count, "--sizes", "0.5", "--jobs", "1"];
    let told = multiply(&demo, &out, &options);
    for number in 0..count.parse().unwrap() {
        let moved = moved_after(&out.join(format!("{number:04}")), 10);
        assert!(moved.is_empty(), "{number}: {moved:?}");
    }
    assert!(told.contains("is not where it was put"), "{told}");
}

#[test]
fn mechanisms_are_operated_again() {
    for scenario in ["lock", "panel", "valve", "dispenser", "presets"] {
        let demo = record_shipped(scenario, &format!("multiply_{scenario}"));
        let out = place(&format!("multiply_{scenario}_out"));
        multiply(&demo, &out, &["--count", "3"]);
        let expected = explained(Path::new(&demo));
        let operations = |told: &str| -> Vec<_> {
            let lines = told.lines().filter(|line| line.starts_with("- "));
            let operations = lines.filter(|line| !line.starts_with("- On its way"));
            operations.map(str::to_owned).collect()
        };
        for number in ["0000", "0001", "0002"] {
            let told = explained(&out.join(number));
            assert_eq!(
                operations(&told),
                operations(&expected),
                "{scenario} {number}"
            );
        }
    }
}

#[test]
fn recordings_of_events_alone_are_multiplied() {
    let originals = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli/originals");
    for year in ["2014", "2017"] {
        let demo = originals.join(year).to_str().unwrap().to_owned();
        let out = place(&format!("multiply_{year}"));
        let output = tabletop(&["multiply", &demo, "--out", out.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains("--setup"), "{}", stderr(&output));
        let setup = originals.join(format!("{year}.xml"));
        let options = ["--count", "3", "--setup", setup.to_str().unwrap()];
        multiply(&demo, &out, &options);
        replays_to_the_same_bytes(out.join("0002"));
    }
}

#[test]
fn a_recording_in_the_place_of_a_robot_is_named() {
    let demo = record_shipped("stack_three", "multiply_swapped");
    let output = tabletop(&["multiply", "--robot", &demo, "--out", "nowhere"]);
    assert_eq!(output.status.code(), Some(2));
    let told = stderr(&output);
    assert!(told.contains("a recording comes before --robot"), "{told}");
}

#[test]
fn the_robot_shows_it_with_the_pictures_of_its_hands() {
    let demo = record_shipped("stack_three", "multiply_hand_cameras");
    let out = place("multiply_hand_cameras_out");
    let options = [
        "--count",
        "1",
        "--robot",
        "--hand-cameras",
        "--light",
        "0.2",
    ];
    multiply(&demo, &out, &options);
    let found = files(&out.join("0000/0"));
    let of = |ending: &str| found.keys().filter(|name| name.ends_with(ending)).count();
    let frames = of(".left_hand_camera.png");
    assert!(frames > 20, "{frames}");
    assert_eq!(of(".right_hand_camera.png"), frames);
    assert_eq!(of(".png"), 3 * frames);
    replays_to_the_same_bytes(out.join("0000"));
}

#[test]
fn no_hand_has_a_camera_without_a_robot() {
    let demo = record_shipped("stack_three", "multiply_no_hands");
    let out = place("multiply_no_hands_out");
    let out = out.to_str().unwrap();
    let output = tabletop(&["multiply", &demo, "--out", out, "--hand-cameras"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--robot"), "{}", stderr(&output));
}
