//! Two programs at once in one place.

use std::{
    fs,
    io::{BufRead as _, BufReader, Read as _},
    path::Path,
    process::{Output, Stdio},
    thread,
    time::Duration,
};

use serde_json::Value;

use crate::support::{command, place, record_shipped, stderr, stdout, tabletop};

/// Runs these commands at once.
fn at_once(commands: &[&[&str]]) -> Vec<Output> {
    let running: Vec<_> = commands
        .iter()
        .map(|arguments| {
            let mut program = command(arguments);
            program.stdout(Stdio::piped()).stderr(Stdio::piped());
            program.spawn().unwrap()
        })
        .collect();
    running
        .into_iter()
        .map(|program| program.wait_with_output().unwrap())
        .collect()
}

/// Copies of a recording, so that an export of them takes a while.
fn copies(demo: &str, name: &str, count: usize) -> String {
    let folder = place(name);
    for number in 0..count {
        let copy = folder.join(number.to_string());
        let merged = tabletop(&["dataset", "merge", demo, "--out", copy.to_str().unwrap()]);
        assert!(merged.status.success(), "{}", stderr(&merged));
        // A merged folder holds the recording by its name.
        let inner = fs::read_dir(&copy).unwrap().next().unwrap().unwrap().path();
        let aside = folder.join(format!("{number}-aside"));
        fs::rename(inner, &aside).unwrap();
        fs::remove_dir(&copy).unwrap();
        fs::rename(aside, &copy).unwrap();
    }
    folder.to_str().unwrap().to_owned()
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

#[test]
fn two_exports_into_one_place_lose_nothing() {
    let demo = record_shipped("stack_two_blocks", "at_once_demo");
    let three = copies(&demo, "at_once_three", 3);
    let pair = |format: &str, place: &str| {
        let outputs = at_once(&[
            &["export", &three, "--to", format, place],
            &["export", &demo, "--to", format, place],
        ]);
        for output in &outputs {
            assert_eq!(output.status.code(), Some(0), "{}", stderr(output));
        }
    };
    let out = |name: &str| {
        let place = place(name);
        (place.to_str().unwrap().to_owned(), place)
    };

    let (name, lerobot) = out("at_once_lerobot");
    pair("lerobot", &name);
    assert_eq!(json(&lerobot.join("meta/info.json"))["total_episodes"], 4);
    let check = tabletop(&["dataset", "check", &name]);
    assert!(
        !stdout(&check).contains("episodes, but"),
        "{}",
        stdout(&check)
    );
    let info = tabletop(&["dataset", "info", &name]);
    assert!(stdout(&info).contains("episodes  4"), "{}", stdout(&info));

    let (name, rlds) = out("at_once_rlds");
    pair("rlds", &name);
    let lengths = &json(&rlds.join("dataset_info.json"))["splits"][0]["shardLengths"];
    let lengths = lengths.as_array().unwrap().iter();
    let episodes = lengths.map(|it| it.as_str().unwrap().parse::<u32>().unwrap());
    assert_eq!(episodes.sum::<u32>(), 4);

    for format in ["mat", "mcap"] {
        let (name, folder) = out(&format!("at_once_{format}"));
        pair(format, &name);
        assert_eq!(fs::read_dir(folder).unwrap().count(), 4);
    }
    let (name, file) = out("at_once.hdf5");
    pair("robomimic", &name);
    assert!(file.is_file());
    let again = tabletop(&["export", &demo, "--to", "robomimic", &name]);
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
}

#[test]
fn a_repair_waits_for_an_export_and_is_done_after_it() {
    let demo = record_shipped("stack_two_blocks", "at_once_repair_demo");
    let folder = place("at_once_repair");
    let out = folder.to_str().unwrap();
    for episodes in 1..=4 {
        let outputs = at_once(&[
            &["export", &demo, "--to", "lerobot", out],
            &["dataset", "repair", out],
        ]);
        let [exported, repaired] = &outputs[..] else {
            panic!("{outputs:?}");
        };
        assert_eq!(exported.status.code(), Some(0), "{}", stderr(exported));
        // At first, there may be nothing yet.
        let code = repaired.status.code();
        assert!(code == Some(0) || episodes == 1, "{}", stderr(repaired));
        let total = &json(&folder.join("meta/info.json"))["total_episodes"];
        assert_eq!(*total, episodes);
    }
}

#[test]
fn the_second_says_for_whom_it_waits_or_is_refused() {
    let demo = record_shipped("stack_two_blocks", "at_once_wait_demo");
    let folder = place("at_once_wait");
    let out = folder.to_str().unwrap();
    let done = tabletop(&["export", &demo, "--to", "lerobot", out]);
    assert!(done.status.success(), "{}", stderr(&done));
    // Somebody who writes for long: this test has the lock.
    let lock = fs::File::create(folder.join(".tabletop-writer")).unwrap();
    lock.lock().unwrap();
    fs::write(folder.join(".tabletop-writer"), "4711 1700000000\n").unwrap();

    for arguments in [
        vec!["export", &demo, "--to", "lerobot", out, "--no-wait"],
        vec!["dataset", "repair", out, "--no-wait"],
    ] {
        let refused = tabletop(&arguments);
        assert_eq!(refused.status.code(), Some(1), "{arguments:?}");
        let said = stderr(&refused);
        let whom = "process 4711 writes there since 2023-11-14 22:13:20 UTC";
        assert!(said.contains(whom), "{said}");
    }
    for action in ["info", "check", "stats"] {
        let refused = tabletop(&["dataset", action, out]);
        let said = stderr(&refused);
        assert!(said.contains("process 4711 writes there"), "{said}");
        assert_ne!(refused.status.code(), Some(0));
    }

    let mut waiting = command(&["export", &demo, "--to", "lerobot", out])
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut said = BufReader::new(waiting.stderr.take().unwrap());
    let mut line = String::new();
    said.read_line(&mut line).unwrap();
    assert!(line.contains("process 4711 writes there since"), "{line}");
    assert!(line.contains("waiting for its end"), "{line}");
    thread::sleep(Duration::from_millis(300));
    assert!(waiting.try_wait().unwrap().is_none(), "it did not wait");
    drop(lock);
    let mut rest = String::new();
    said.read_to_string(&mut rest).unwrap();
    assert!(waiting.wait().unwrap().success(), "{rest}");
    assert_eq!(json(&folder.join("meta/info.json"))["total_episodes"], 2);
}

#[test]
fn two_that_make_one_new_folder_make_it_once() {
    let demo = record_shipped("stack_two_blocks", "at_once_new_demo");
    for action in ["merge", "trim"] {
        let out = place(&format!("at_once_{action}"));
        let to = out.to_str().unwrap();
        let arguments = match action {
            "merge" => vec!["dataset", "merge", &demo, "--out", to],
            _ => vec!["dataset", action, &demo, to],
        };
        let outputs = at_once(&[&arguments, &arguments]);
        let mut codes: Vec<_> = outputs.iter().map(|it| it.status.code()).collect();
        codes.sort();
        assert_eq!(codes, [Some(0), Some(2)], "{outputs:?}");
        assert_eq!(fs::read_dir(&out).unwrap().count(), 1);
    }
    // Two recordings of one name: the first is moved aside, or the second refused.
    let out = place("at_once_edited");
    let to = out.to_str().unwrap();
    let arguments = ["edit", &demo, to, "--retime", "1=0.5"];
    let outputs = at_once(&[&arguments, &arguments]);
    let done = outputs.iter().filter(|it| it.status.success()).count();
    let aside = out.with_file_name("at_once_edited-1");
    assert_eq!(
        usize::from(out.exists()) + usize::from(aside.exists()),
        done,
        "{outputs:?}"
    );
    drop(fs::remove_dir_all(aside));
}

#[test]
fn two_that_require_something_at_once_lose_nothing() {
    let demo = record_shipped("stack_small", "at_once_require");
    for (color, shape) in [("color", "shape"), ("color=red", "shape=block")] {
        let outputs = at_once(&[
            &["require", &demo, "--step", "1", color],
            &["require", &demo, "--step", "2", shape],
        ]);
        for output in &outputs {
            assert_eq!(output.status.code(), Some(0), "{}", stderr(output));
        }
        let required = stdout(&tabletop(&["require", &demo]));
        assert!(
            required.contains("color=") && required.contains("shape="),
            "{required}"
        );
        tabletop(&["require", &demo, "--step", "1", "--remove"]);
        tabletop(&["require", &demo, "--step", "2", "--remove"]);
    }
}
