//! Recordings, run again.

use std::{
    fs,
    path::{Path, PathBuf},
};

#[cfg(unix)]
use crate::support::small_files;
use crate::support::{
    command, place, record, record_shipped, replays_to_the_same_bytes, scenario, shipped, stderr,
    tabletop,
};

/// A recording of a shipped scenario.
fn recording(scenario: &str, folder: &str) -> PathBuf {
    record_shipped(scenario, folder).into()
}

#[test]
fn every_shipped_scenario_replays_to_the_same_bytes() {
    for scenario in [
        "stack_two_blocks",
        "build_letters",
        "lidbox",
        "break_chain",
        "presets",
        "rings",
        "hanoi_rings",
        "cup",
        "cut_wire",
        "buttons",
        "shears",
        "robot_cut",
        "panel",
        "dock",
        "lock",
        "dispenser",
        "valve",
        "robot_valve",
    ] {
        let folder = recording(scenario, scenario);
        assert!(folder.join("0/0.png").exists(), "{scenario} has no picture");
        replays_to_the_same_bytes(&folder);
    }
}

/// Somebody cuts a link in a recording of a shipped scenario.
fn is_cut_by(scenario: &str, who: &str, blade: &str, link: &str) {
    let folder = recording(scenario, &format!("{scenario}-events"));
    let events = fs::read_dir(&folder).unwrap().filter_map(|file| {
        let path = file.unwrap().path();
        let is_text = path.extension().is_some_and(|it| it == "txt");
        is_text.then(|| fs::read_to_string(path).unwrap())
    });
    let events = events.collect::<String>();
    let cut = format!(",cut,{who},{blade},{link}\n");
    assert!(events.contains(&cut), "{cut} in {events}");
    let [cut, delete] = [cut, format!(",delete,{link}\n")].map(|line| events.find(&line));
    assert!(cut < delete, "{events}");
}

#[test]
fn recordings_tell_who_has_cut() {
    is_cut_by("cut_wire", "RightHand", "Scissors_lower", "Wire-link4");
    is_cut_by("shears", "LeftHand", "anvil", "wire-link2");
    is_cut_by("robot_cut", "robot:right", "Scissors_lower", "wire-link2");
}

#[cfg(unix)]
#[test]
fn a_replay_that_cannot_be_written_is_reported() {
    let folder = recording("stack_two_blocks", "replay-small-files");
    let copy = place("replay-small-files-copy");
    let [folder, copy] = [&folder, &copy].map(|path| path.to_str().unwrap());
    let output = small_files(&["replay", folder, "--out", copy]);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    let words = [
        "the recording has ended: cannot write ",
        "replay-small-files-copy",
    ];
    let is_said = words.iter().all(|words| said.contains(words));
    assert!(is_said && said.lines().count() == 1, "{said}");
    assert!(!Path::new(copy).exists());
}

#[test]
fn a_recording_that_was_cut_off_replays_as_far_as_it_goes() {
    let steps =
        "Grasp(\"RedBlock\"), MoveBy((0, 0, 3)), Wait(0.2), Release, Wait(0.3),".repeat(300);
    let scenario = scenario("cut.ron", &format!("Start, {steps} Finish,"));
    for bytes in [2_000, 20_000, 50_000, 100_000] {
        let folder = place("cut");
        let [scenario, into] = [&scenario, &folder].map(|path| path.to_str().unwrap());
        let arguments = ["run", scenario, "--record", into, "--seconds", "600"];
        let mut running = command(&arguments).spawn().unwrap();
        let states = folder.join("states.csv");
        while fs::metadata(&states).map_or(0, |file| file.len()) < bytes {
            assert_eq!(running.try_wait().unwrap(), None, "it ended too early");
        }
        running.kill().unwrap();
        running.wait().unwrap();

        let output = tabletop(&["replay", into, "--verify"]);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(0), "{bytes}: {said}");
        assert!(said.contains("was cut off in tick"), "{said}");
    }
}

#[test]
fn a_recording_may_be_cut_off_right_after_a_picture() {
    let folder = recording("stack_two_blocks", "cut-after-a-picture");
    let session = fs::read_to_string(folder.join("session.jsonl")).unwrap();
    let start = number_after(&session, "\"start_tick\":");
    let frame = last_picture(&folder.join("1"));
    let tick = start + 15 * frame;
    for file in ["states.csv", "joints.csv"] {
        keep_lines(&folder.join(file), |line| {
            number(line).is_none_or(|of| of < tick)
        });
    }
    keep_lines(&folder.join("1.txt"), |line| number(line) < Some(frame));
    keep_lines(&folder.join("session.jsonl"), |line| {
        let has_tick = line.starts_with("{\"tick\":") || line.starts_with("{\"segment\":");
        !has_tick || number_after(line, "\"tick\":") < tick
    });
    fs::remove_file(folder.join("2.txt")).unwrap();
    fs::remove_dir_all(folder.join("2")).unwrap();

    let output = tabletop(&["replay", folder.to_str().unwrap(), "--verify"]);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(
        said.contains(&format!("was cut off in tick {tick},")),
        "{said}"
    );
}

fn last_picture(folder: &Path) -> u64 {
    let files = fs::read_dir(folder).unwrap();
    let frames = files.map(|file| number(file.unwrap().file_name().to_str().unwrap()));
    frames.max().unwrap().unwrap()
}

fn keep_lines(path: &Path, keep: impl Fn(&str) -> bool) {
    let text = fs::read_to_string(path).unwrap();
    let kept: String = text
        .split_inclusive('\n')
        .filter(|line| keep(line))
        .collect();
    fs::write(path, kept).unwrap();
}

/// The number with which a text begins.
fn number(text: &str) -> Option<u64> {
    let end = text.find(|letter: char| !letter.is_ascii_digit());
    text[..end.unwrap_or(text.len())].parse().ok()
}

fn number_after(text: &str, words: &str) -> u64 {
    number(text.split_once(words).unwrap().1).unwrap()
}

#[test]
fn acts_of_hands_before_the_start_are_replayed() {
    for (name, steps) in [
        (
            "before",
            "Grasp(\"RedBlock\"), Glide(to: (-2, 0.3, 4), seconds: 0.7), Turn(axis: Z, degrees: 30), Wait(0.1), Release,
             Wait(0.2), Start, Grasp(\"GreenBlock\"), MoveTo((5, 0, 3)), Wait(1), Release, Wait(1), Finish,",
        ),
        (
            "held",
            "With(Left, Grasp(\"RedBlock\")), With(Left, MoveTo((3, 1, 3))), Wait(0.3), Start, Wait(0.3),
             Select(Right), Grasp(\"RedBlock\"), MoveTo((-2, 0, 6)), Wait(0.5), Destroy, Wait(0.5), Finish,",
        ),
        (
            "held_over_a_scene",
            "Grasp(\"RedBlock\"), MoveTo((-6, 0, 3)), Wait(0.5), Load(file: \"SETUP\"), Wait(0.2), Start,
             Grasp(\"GreenBlock\"), MoveTo((0, 0, 3)), Wait(1), Release, Wait(1), Finish,",
        ),
        (
            "another_scene_before",
            "Grasp(\"RedBlock\"), MoveTo((-2, 0, 3)), Wait(0.5), Release, Wait(0.2),
             Load(file: \"LIDBOX\"), Wait(0.5), Grasp(\"obj-lid\"), MoveBy((0, 3, 2)), Wait(1), Release, Wait(0.3),
             Load(file: \"SETUP\"), Grasp(\"RedBlock\"), MoveTo((-2, 0.4, 4)), Wait(0.5), Release, Wait(0.1), Start,
             Grasp(\"GreenBlock\"), MoveTo((2, 0, 4)), Wait(1), Release, Wait(2), Finish,",
        ),
        (
            "recorded_and_undone_before",
            "Start, Grasp(\"RedBlock\"), MoveTo((-2, 0.1, 5)), Wait(0.4), Release, Wait(0.1), Grasp(\"GreenBlock\"), Wait(0.2),
             Destroy, Wait(0.2), Undo, Undo, Wait(0.1), Finish, Grasp(\"RedBlock\"), MoveTo((-2, 0, 5)), Wait(0.4), Release,
             Start, Grasp(\"GreenBlock\"), MoveBy((2, 0, 4)), Wait(1), Release, Wait(2), Finish,",
        ),
        (
            "paused",
            "Wait(0.2), Grasp(\"RedBlock\"), MoveTo((-2, 0.1, 5)), Wait(0.2), Pause(true), Load(file: \"CHAIN\"), Wait(0.1), Start,
             Wait(0.1), Pause(false), Wait(1), Pause(true), Clear, Wait(0.2), Pause(false), Wait(0.5), Finish,",
        ),
        (
            "changed_in_a_pause",
            "Wait(0.2), Start, Wait(0.5), Pause(true), Load(file: \"CHAIN\"), Clear, Load(file: \"LIDBOX\"), Clear, Wait(0.1),
             Load(file: \"SETUP\"), Pause(false), Wait(0.5), Grasp(\"GreenBlock\"), Wait(0.5), Finish,",
        ),
        (
            "undone_in_a_pause",
            "Wait(0.3), Start, Grasp(\"RedBlock\"), MoveTo((-2, 0.1, 5)), Wait(1), Pause(true), Wait(0.1), Undo, Pause(false), Wait(0.5),
             Redo, Wait(1), Release, Wait(1), Pause(true), Undo, Wait(0.1), Redo, Undo, Wait(0.1), Pause(false), Wait(0.5), Finish,",
        ),
        (
            "cleared_before",
            "Clear, Wait(0.2), Start, Wait(0.3), Load(file: \"CHAIN\"), Wait(1), Finish,",
        ),
    ] {
        let mut steps = steps.to_owned();
        for (word, file) in [
            ("SETUP", "default.xml"),
            ("LIDBOX", "lidbox.xml"),
            ("CHAIN", "chain.xml"),
        ] {
            steps = steps.replace(word, &format!("shipped:tablesetup/{file}"));
        }
        let scenario = scenario(&format!("replay_{name}.ron"), &steps);
        let scenario = scenario.to_str().unwrap();
        replays_to_the_same_bytes(record(scenario, &format!("replay_{name}")));
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
    let out = place("rendered-large");
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
fn pictures_are_made_from_another_place_with_distances_and_numbers() {
    let folder = recording("stack_two_blocks", "seen_from_above");
    let out = place("from-above");
    let output = tabletop(&[
        "replay",
        folder.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
        "--camera",
        "2,0,20",
        "--look-at",
        "2,0,0",
        "--fov",
        "30",
        "--depth",
        "--ids",
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    // The red block lies at (2, 0, 1), and is two units high.
    let (width, _, color) = pixels(&out.join("0/0.png"));
    let middle = (75 * width + 100) as usize;
    assert_eq!(color[4 * middle..][..4], [255, 0, 0, 255]);
    let value = |name: &str| {
        let (_, _, bytes) = pixels(&out.join(name));
        u16::from_be_bytes([bytes[2 * middle], bytes[2 * middle + 1]])
    };
    let depth = value("0/0.depth.png");
    assert!(depth.abs_diff(18_000) < 20, "{depth}");
    let text = fs::read_to_string(out.join("0.txt")).unwrap();
    let red = text
        .lines()
        .position(|line| line.starts_with("0,create,RedBlock"));
    assert_eq!(usize::from(value("0/0.ids.png")), red.unwrap() + 2);
}

/// Width, height and bytes of a PNG file.
fn pixels(path: &Path) -> (u32, u32, Vec<u8>) {
    let file = fs::File::open(path).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file))
        .read_info()
        .unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    (info.width, info.height, bytes)
}

/// A recording with a changed header.
fn with_header(name: &str, old: &str, new: &str) -> PathBuf {
    let folder = recording("stack_two_blocks", name);
    let session = folder.join("session.jsonl");
    let text = fs::read_to_string(&session).unwrap();
    assert!(text.contains(old), "{text}");
    fs::write(&session, text.replacen(old, new, 1)).unwrap();
    folder
}

#[test]
fn settings_that_this_program_does_not_have_are_located() {
    for (name, old, new, words) in [
        (
            "stickiness",
            "\"friction\"",
            "\"stickiness\"",
            "settings.physics: unknown field `stickiness`",
        ),
        (
            "weightless",
            "\"gravity\":98.1",
            "\"gravity\":1e300",
            "settings.physics: gravity: inf is not a number from -10000 to 10000",
        ),
        (
            "ticks",
            "\"ticks_per_second\":60",
            "\"ticks_per_second\":50",
            "ticks_per_second: expected 60, found 50",
        ),
        (
            "beginning",
            "\"begin_tick\":0",
            "\"begin_tick\":null",
            "begin_tick: the commands before the recording are not known",
        ),
    ] {
        let folder = with_header(name, old, new);
        let output = tabletop(&["replay", folder.to_str().unwrap(), "--verify"]);
        assert_eq!(output.status.code(), Some(2));
        let message = format!(
            "tabletop: {}:1: {words}",
            folder.join("session.jsonl").display()
        );
        assert!(stderr(&output).starts_with(&message), "{}", stderr(&output));
    }
}

#[test]
fn other_settings_give_other_states() {
    let folder = with_header("moon", "\"gravity\":98.1", "\"gravity\":16.2");
    let output = tabletop(&["replay", folder.to_str().unwrap(), "--verify"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        stderr(&output).contains("the replay differs: "),
        "{}",
        stderr(&output)
    );
}

#[test]
fn a_recording_of_another_version_that_differs_says_so() {
    let version = concat!("\"program\":\"", env!("CARGO_PKG_VERSION"), "\"");
    let folder = with_header("version", version, "\"program\":\"0.0.7\"");
    let output = tabletop(&["replay", folder.to_str().unwrap(), "--verify"]);
    let message = stderr(&output);
    assert!(message.contains("recorded with version 0.0.7"), "{message}");
}

#[test]
fn without_a_display_a_replay_in_the_window_says_so() {
    let folder = recording("stack_two_blocks", "windowless");
    let output = tabletop(&["replay", folder.to_str().unwrap(), "--window"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("no window"), "{}", stderr(&output));
    assert_eq!(stderr(&output).lines().count(), 1, "{}", stderr(&output));
}

#[test]
fn a_missing_recording_is_exit_code_2() {
    let output = tabletop(&["replay", "no such folder"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(stderr(&output).lines().count(), 1, "{}", stderr(&output));
}

#[test]
fn a_camera_that_is_too_large_is_located() {
    let folder = with_header("large_camera", "\"width\":200", "\"width\":20000");
    let output = tabletop(&["replay", folder.to_str().unwrap(), "--verify"]);
    assert_eq!(output.status.code(), Some(2));
    let place = format!(
        "{}:1: camera: 20000x150",
        folder.join("session.jsonl").display()
    );
    assert!(stderr(&output).contains(&place), "{}", stderr(&output));
}

#[test]
fn control_characters_are_escaped() {
    let scenario = scenario("escape.ron", "Grasp(\"\\u{1b}[31mred\"),");
    let output = tabletop(&["run", scenario.to_str().unwrap()]);
    let said = stderr(&output);
    assert!(said.contains("\\u{1b}[31mred"), "{said}");
    assert!(!said.contains('\u{1b}'), "{said}");
}

#[test]
fn hand_cameras_that_the_recorded_robot_lacks_are_not_passed_over() {
    let scenario = shipped("scenarios", "panda_stack.ron");
    let [demo, out] = ["replay_panda", "replay_panda_out"].map(place);
    let [scenario, demo, out] = [&scenario, &demo, &out].map(|path| path.to_str().unwrap());
    let robot = "shipped:assets/panda/robot.ron";
    let output = tabletop(&["run", scenario, "--robot", robot, "--record", demo]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let output = tabletop(&["replay", demo, "--out", out, "--hand-cameras"]);
    assert_eq!(output.status.code(), Some(2));
    let told = stderr(&output);
    assert!(
        told.contains("the robot Panda has no hand cameras"),
        "{told}"
    );
}
