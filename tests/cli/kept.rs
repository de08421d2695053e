//! Nothing that was there is lost, and no command that has failed ends as if it had not.

use std::{fs, path::Path};

#[cfg(unix)]
use crate::support::small_files;
use crate::support::{command, place, record_shipped, scenario, stderr, stdout, tabletop};

const DEMONSTRATION: &str =
    r#"Start, Grasp("RedBlock"), MoveTo((-1.5, 0.2, 1)), Wait(0.5), Release, Wait(0.5)"#;

/// A scenario that does not finish its recording.
fn unfinished(name: &str) -> String {
    scenario(name, DEMONSTRATION).to_str().unwrap().to_owned()
}

/// Runs the program, which must end with this code and say this.
fn ends(arguments: &[&str], code: i32, said: &str) {
    let output = tabletop(arguments);
    let reported = stdout(&output) + &stderr(&output);
    assert_eq!(
        output.status.code(),
        Some(code),
        "{arguments:?}: {reported}"
    );
    assert!(reported.contains(said), "{arguments:?}: {reported}");
}

fn last_line(text: &str) -> &str {
    text.lines().last().unwrap_or_default()
}

#[test]
fn only_a_recording_is_moved_aside_and_the_last_line_says_where_to() {
    let scenario = unfinished("kept_aside.ron");
    let demo = place("kept_aside");
    let aside = place("kept_aside-1");
    let path = demo.to_str().unwrap();
    let record = ["run", &scenario, "--record", path];
    ends(&record, 0, "");
    let first = fs::read(demo.join("states.csv")).unwrap();
    fs::write(demo.join("notes.txt"), "mine").unwrap();
    let output = tabletop(&record);
    let moved = format!("the earlier recording there is now {}", aside.display());
    assert!(last_line(&stderr(&output)).ends_with(&moved), "{output:?}");
    assert_eq!(fs::read(aside.join("states.csv")).unwrap(), first);
    assert!(aside.join("notes.txt").exists());

    let other = place("kept_other");
    fs::create_dir(&other).unwrap();
    fs::write(other.join("notes.txt"), "mine").unwrap();
    let path = other.to_str().unwrap();
    let holds = "holds something else than a recording";
    ends(&["run", &scenario, "--record", path], 1, holds);
    let demo = demo.to_str().unwrap();
    ends(&["replay", demo, "--out", path], 1, holds);
    assert_eq!(fs::read_dir(&other).unwrap().count(), 1);
}

#[test]
fn a_replay_names_the_recording_it_moved_aside() {
    let demo = record_shipped("stack_two_blocks", "kept_replayed");
    let out = place("kept_replayed_out");
    place("kept_replayed_out-1");
    let path = out.to_str().unwrap();
    ends(&["replay", &demo, "--out", path], 0, "");
    ends(
        &["replay", &demo, "--out", path],
        0,
        "the earlier recording there is now",
    );
}

/// A disk that is full, in the middle and in the last tick.
#[cfg(unix)]
#[test]
fn a_recording_that_fails_ends_with_1() {
    let folder = place("kept_full");
    let out = folder.to_str().unwrap();
    let demo = record_shipped("stack_three", "kept_full_demo");
    let scenario = unfinished("kept_full.ron");
    for arguments in [
        vec!["run", scenario.as_str(), "--record", out],
        vec!["imitate", demo.as_str(), "--record", out],
        vec!["replay", demo.as_str(), "--out", out],
    ] {
        let output = small_files(&arguments);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {said}");
        assert_eq!(said.matches("the recording has ended").count(), 1, "{said}");
        assert!(said.contains("cannot write"), "{said}");
        // Only what is recorded live is kept as far as it goes.
        let is_live = arguments[0] == "run";
        assert_eq!(folder.exists(), is_live, "{arguments:?}");
        if is_live {
            fs::remove_dir_all(&folder).unwrap();
        }
    }
}

#[cfg(unix)]
#[test]
fn no_part_of_a_demonstration_is_kept() {
    let demo = record_shipped("stack_three", "kept_parts_demo");
    let out = place("kept_parts");
    let path = out.to_str().unwrap();
    let output = small_files(&["multiply", &demo, "--count", "2", "--out", path]);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("File too large"), "{said}");
    let names = fs::read_dir(&out).unwrap();
    let names: Vec<_> = names.map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names, ["multiply.json"]);
}

#[test]
fn demonstrations_of_other_files_are_not_mixed() {
    let demo = record_shipped("stack_three", "kept_changed_demo");
    let out = place("kept_changed");
    let setup = place("kept_changed.xml");
    let blocks = fs::read_to_string("tablesetup/blocks.xml").unwrap();
    fs::write(&setup, &blocks).unwrap();
    let (path, setup) = (out.to_str().unwrap(), setup.to_str().unwrap());
    let multiply = [
        "multiply", &demo, "--count", "1", "--out", path, "--setup", setup,
    ];
    ends(&multiply, 0, "1 made");
    ends(&multiply, 0, "1 were there");
    fs::write(setup, blocks.replacen("color", "  color", 1)).unwrap();
    ends(&multiply, 0, "1 were there");
    let moved = blocks.replacen("(-3,", "(-3.5,", 1);
    assert_ne!(moved, blocks);
    fs::write(setup, moved).unwrap();
    ends(&multiply, 2, "of something else");
    fs::write(setup, blocks).unwrap();
    ends(&["require", &demo, "--step", "1", "shape"], 0, "");
    ends(&multiply, 2, "of something else");
}

#[cfg(unix)]
#[test]
fn only_whole_demonstrations_of_the_collection_count() {
    let demo = record_shipped("stack_three", "kept_counted_demo");
    let out = place("kept_counted");
    let path = out.to_str().unwrap();
    let made = |count: &str, code, said: &str| {
        let multiply = ["multiply", &demo, "--out", path, "--count", count];
        ends(&multiply, code, said);
    };
    made("1", 0, "1 made");
    fs::create_dir(out.join("0001")).unwrap();
    made("2", 0, "1 were there\n1 made");
    let none = "no whole recording of this collection";
    std::os::unix::fs::symlink(out.join("0000"), out.join("0002")).unwrap();
    made("3", 2, none);
    fs::remove_file(out.join("0002")).unwrap();
    // Of another number, and one that was cut off.
    fs::rename(out.join("0001"), out.join("0002")).unwrap();
    made("3", 2, none);
    fs::rename(out.join("0002"), out.join("0001")).unwrap();
    let session = out.join("0001/session.jsonl");
    let text = fs::read_to_string(&session).unwrap();
    let cut = text.lines().count() - 1;
    let lines: String = text.split_inclusive('\n').take(cut).collect();
    fs::write(&session, lines).unwrap();
    made("2", 2, none);
}

#[test]
fn an_impossible_imitation_is_no_success() {
    let still = scenario("kept_still.ron", "Start, Wait(0.5), Finish");
    let demo = place("kept_still");
    let path = demo.to_str().unwrap();
    ends(&["run", still.to_str().unwrap(), "--record", path], 0, "");
    ends(&["imitate", path], 2, "there is nothing to imitate");
    ends(
        &["imitate", path, "--trials", "3"],
        2,
        "there is nothing to imitate",
    );

    let demo = record_shipped("stack_three", "kept_no_room_demo");
    let setup = place("kept_no_room.xml");
    let blocks = fs::read_to_string("tablesetup/blocks.xml").unwrap();
    let crowd: String = (0..400)
        .map(|index| {
            let (x, y) = (f64::from(index % 20) - 9.5, f64::from(index / 20) * 0.6 - 6.0);
            format!("<block id='crowd{index}' location='({x},{y},0.2)' xspan='0.9' yspan='0.5' zspan='0.4'/>")
        })
        .collect();
    let end = blocks.rfind("</tabletop>").unwrap();
    let crowded = format!("{}{crowd}{}", &blocks[..end], &blocks[end..]);
    fs::write(&setup, crowded).unwrap();
    let setup = setup.to_str().unwrap();
    let imitate = ["imitate", &demo, "--setup", setup, "--seed", "1"];
    ends(&imitate, 1, "There is no room for everything");
    ends(&[&imitate[..], &["--trials", "1"]].concat(), 1, "no room");
}

/// A stranger's recording that ends after days of nothing.
#[test]
fn a_replay_does_not_fill_the_disk() {
    let demo = record_shipped("stack_two_blocks", "kept_endless");
    let session = Path::new(&demo).join("session.jsonl");
    let text = fs::read_to_string(&session).unwrap();
    let (rest, last) = text.trim_end().rsplit_once('\n').unwrap();
    let mut last: serde_json::Value = serde_json::from_str(last).unwrap();
    last["tick"] = 1_000_000.into();
    fs::write(&session, format!("{rest}\n{last}\n")).unwrap();
    let temporary = place("kept_endless_temporary");
    fs::create_dir(&temporary).unwrap();
    let output = command(&["replay", &demo])
        .env("TMPDIR", &temporary)
        .output()
        .unwrap();
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(
        said.contains("4.6 hours of simulated time are replayed"),
        "{said}"
    );
    ends(&["replay", &demo, "--verify"], 1, "the replay differs");
    assert_eq!(fs::read_dir(&temporary).unwrap().count(), 0);
}

#[cfg(unix)]
#[test]
fn paths_need_not_be_unicode() {
    use std::{ffi::OsStr, os::unix::ffi::OsStrExt as _};
    let folder = place("kept_bytes");
    fs::create_dir(&folder).unwrap();
    let name = |name: &[u8]| folder.join(OsStr::from_bytes(name));
    let scenario = name(b"\xff.ron");
    let setup = "shipped:tablesetup/blocks.xml";
    let steps = r#"Start, Grasp("Red"), Glide(to: (3, -2.5, 4), seconds: 0.3), Glide(to: (3, -2.5, 1.5), seconds: 0.3), WaitUntilThere(1), Release, Wait(0.5)"#;
    fs::write(&scenario, format!("(setup: {setup:?}, steps: [{steps}])")).unwrap();
    fs::copy("tablesetup/blocks.xml", name(b"\xfe.xml")).unwrap();
    let run = |arguments: &[&OsStr]| {
        let output = command(&[]).args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    };
    let (demo, setup, out) = (name(b"\xfd"), name(b"\xfe.xml"), name(b"\xfc"));
    let text = |text: &'static str| OsStr::new(text);
    let options = [text("--setup"), setup.as_os_str()];
    run(&[
        &[
            text("run"),
            scenario.as_os_str(),
            text("--record"),
            demo.as_os_str(),
        ],
        &options[..],
    ]
    .concat());
    run(&[text("replay"), demo.as_os_str(), text("--verify")]);
    run(&[
        &[
            text("multiply"),
            demo.as_os_str(),
            text("--count"),
            text("1"),
            text("--out"),
            out.as_os_str(),
        ],
        &options[..],
    ]
    .concat());
    run(&[&[text("run"), text("--seconds"), text("0.1")], &options[..]].concat());
    let robot = name(b"\xfb");
    fs::create_dir(&robot).unwrap();
    for file in ["panda.urdf", "robot.ron"] {
        fs::copy(format!("assets/panda/{file}"), robot.join(file)).unwrap();
    }
    let (robot, demo) = (robot.join("robot.ron"), name(b"\xfa"));
    let options = [
        text("--robot"),
        robot.as_os_str(),
        text("--record"),
        demo.as_os_str(),
    ];
    run(&[&[text("run"), scenario.as_os_str()], &options[..]].concat());
    run(&[text("replay"), demo.as_os_str(), text("--verify")]);
}
