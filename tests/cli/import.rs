//! Recordings of the original program, imported.

use std::{fs, path::Path};

use crate::support::{place, record_shipped, stderr, stdout, tabletop};

fn original(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli/originals");
    folder.join(name).to_str().unwrap().to_owned()
}

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

/// Imports a recording into a place of this name.
fn imported(source: &str, name: &str, setup: Option<&str>) -> String {
    let out = place(name).to_str().unwrap().to_owned();
    let mut arguments = vec!["import", source, &out];
    arguments.extend(setup.iter().flat_map(|setup| ["--setup", setup]));
    done(&arguments);
    out
}

/// The sentences of the steps, without the times of detours.
fn steps(arguments: &[&str]) -> Vec<String> {
    let said = done(&[&["explain"], arguments].concat());
    let steps = said.lines().filter(|line| !line.contains(" s)."));
    steps.map(str::to_owned).collect()
}

/// The lines of events of a recording that are `meant`, in a folder of their own, without its pictures unless they are wanted.
fn events(demo: &str, name: &str, pictures: bool, meant: impl Fn(&str) -> bool) -> String {
    let folder = place(name);
    fs::create_dir_all(&folder).unwrap();
    for segment in 0.. {
        let text = Path::new(demo).join(format!("{segment}.txt"));
        let Ok(events) = fs::read_to_string(text) else {
            break;
        };
        let kept: String = events
            .split_inclusive('\n')
            .filter(|line| meant(line))
            .collect();
        fs::write(folder.join(format!("{segment}.txt")), kept).unwrap();
        let from = Path::new(demo).join(segment.to_string());
        let to = folder.join(segment.to_string());
        if pictures {
            fs::create_dir(&to).unwrap();
            for picture in fs::read_dir(from).unwrap() {
                let picture = picture.unwrap();
                fs::copy(picture.path(), to.join(picture.file_name())).unwrap();
            }
        }
    }
    folder.to_str().unwrap().to_owned()
}

#[test]
fn an_imported_recording_means_what_the_original_one_means() {
    for year in ["2014", "2017"] {
        let (source, setup) = (original(year), original(&format!("{year}.xml")));
        let demo = imported(&source, &format!("import_{year}"), Some(&setup));
        let expected = steps(&[&source, "--setup", &setup]);
        assert_eq!(steps(&[&demo, "--setup", &setup]), expected, "{year}");
    }
}

#[test]
fn acts_that_no_event_tells_are_in_the_imported_recording() {
    let demo = record_shipped("stack_three", "import_poses_recorded");
    let is_pose = |line: &str| line.contains(",create,") || line.contains(",move,");
    let poses = events(&demo, "import_poses_events", false, is_pose);
    let out = imported(&poses, "import_poses", None);
    assert_eq!(steps(&[&out]), steps(&[&demo]));
    let first_act = fs::read_to_string(Path::new(&out).join("1.txt")).unwrap();
    assert!(first_act.contains(",grasp,"), "{first_act}");
    let header = fs::read_to_string(Path::new(&out).join("session.jsonl")).unwrap();
    let header = header.lines().next().unwrap();
    assert!(header.contains(r#""acts":"inferred""#), "{header}");
}

#[test]
fn all_commands_but_replay_take_an_imported_recording() {
    let demo = record_shipped("stack_three", "import_used_recorded");
    let source = events(&demo, "import_used_events", true, |_| true);
    let out = imported(&source, "import_used", None);
    let picture = |folder: &str| fs::read(Path::new(folder).join("0/0.png")).unwrap();
    assert_eq!(picture(&demo), picture(&out), "pictures are taken over");
    let many = place("import_used_many").to_str().unwrap().to_owned();
    done(&["multiply", &out, "--count", "2", "--out", &many]);
    assert_eq!(steps(&[&format!("{many}/0001")]), steps(&[&demo]));
    done(&["imitate", &out]);
    let dataset = place("import_used_dataset").to_str().unwrap().to_owned();
    done(&["export", &out, "--to", "lerobot", &dataset]);
    let checked = done(&["dataset", "check", &out]);
    assert_eq!(checked, "1 episode, nothing wrong.\n");
    let output = tabletop(&["replay", &out]);
    assert_eq!(output.status.code(), Some(2));
    let said = stderr(&output);
    assert!(
        said.contains("it was made from the original program"),
        "{said}"
    );
}

#[test]
fn lines_that_make_no_sense_are_told_and_left_out() {
    let folder = place("import_strange_source");
    fs::create_dir_all(&folder).unwrap();
    let text = "0,create,a,shape,block,xspan,-3,color,#ff00zz\n0,move,a,0,0,0.5,0,0,0\nhello\n\
        3,move,b,2,0,0.5,0,0,0\n4,grasp,LeftHand,nobody\n";
    fs::write(folder.join("0.txt"), text).unwrap();
    let out = place("import_strange");
    let output = tabletop(&["import", folder.to_str().unwrap(), out.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = stderr(&output);
    for remark in [
        "0.txt:3: expected a frame, found `hello`; the line is left out",
        "0.txt:4: b was not created before",
        "0.txt:5: there is no nobody; the line is left out",
        "it is taken for a block of one unit",
    ] {
        assert!(said.contains(remark), "{remark}: {said}");
    }
    let checked = stdout(&tabletop(&["dataset", "check", out.to_str().unwrap()]));
    assert!(
        checked.ends_with("its task is empty: nothing is moved for good\n1 episode, 1 fault.\n"),
        "{checked}"
    );
}

#[test]
fn other_files_than_originals_are_refused_and_nothing_is_made() {
    let demo = record_shipped("stack_two_blocks", "import_refused_recorded");
    let empty = place("import_refused_empty");
    fs::create_dir_all(&empty).unwrap();
    let out = place("import_refused");
    for source in [demo.as_str(), empty.to_str().unwrap()] {
        let output = tabletop(&["import", source, out.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(2));
        let said = stderr(&output);
        assert!(
            said.contains("no recording of the original program"),
            "{said}"
        );
        assert!(!out.exists());
    }
}
