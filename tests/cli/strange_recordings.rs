//! Pipes, devices and links in the place of a recording's files are refused: nothing waits for them, fills the memory, or follows them.

#![cfg(unix)]

use std::{
    fs::{self, File},
    os::unix::fs::symlink,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

use crate::support::{command, record_shipped, stderr, stdout};

/// The program must end within this time.
const DEADLINE: Duration = Duration::from_secs(60);

fn recorded(name: &str) -> PathBuf {
    record_shipped("red_on_blue", name).into()
}

/// Runs the program, which must not wait for ever.
fn ended(arguments: &[&str], recording: &Path) -> Output {
    let mut program = command(arguments);
    program.arg(recording);
    let mut running = program
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let start = Instant::now();
    while running.try_wait().unwrap().is_none() {
        if start.elapsed() > DEADLINE {
            running.kill().unwrap();
            panic!("{arguments:?} does not end");
        }
        sleep(Duration::from_millis(5));
    }
    running.wait_with_output().unwrap()
}

/// Puts a link, a device and a pipe in the place of a file in turn, and has the program refuse them.
fn is_refused_unless_a_file(file: &Path, arguments: &[&str], recording: &Path) {
    let elsewhere = recording.with_extension("elsewhere");
    match file.exists() {
        true => fs::rename(file, &elsewhere).unwrap(),
        false => fs::write(&elsewhere, r#"{"roles":{}}"#).unwrap(),
    }
    let link = |target: &Path| symlink(target, file).unwrap();
    let pipe = || {
        let made = Command::new("mkfifo").arg(file).status().unwrap();
        assert!(made.success());
    };
    let replacements: [&dyn Fn(); 3] =
        [&|| link(&elsewhere), &|| link("/dev/zero".as_ref()), &pipe];
    for replace in replacements {
        replace();
        let output = ended(arguments, recording);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{said}");
        let name = file.file_name().unwrap().to_str().unwrap();
        assert!(
            said.contains("it is no file but a link") && said.contains(name),
            "{said}"
        );
        fs::remove_file(file).unwrap();
    }
}

#[test]
fn pictures_and_logs_are_compared_only_if_they_are_files() {
    let demo = recorded("strange_files");
    let verify = ["replay", "--verify"];
    for file in ["0/0.png", "0.txt", "states.csv"] {
        let path = demo.join(file);
        let content = fs::read(&path).unwrap();
        is_refused_unless_a_file(&path, &verify, &demo);
        fs::write(&path, content).unwrap();
    }
    assert_eq!(ended(&verify, &demo).status.code(), Some(0));
}

#[test]
fn a_picture_without_end_is_compared_as_far_as_it_can_be_the_same() {
    let demo = recorded("strange_size");
    let picture = File::options().write(true).open(demo.join("0/0.png"));
    picture.unwrap().set_len(1 << 40).unwrap();
    let output = ended(&["replay", "--verify"], &demo);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).contains("0/0.png: the pictures differ"));
}

#[test]
fn a_folder_that_is_a_link_to_itself_is_refused() {
    let demo = recorded("strange_folder");
    let folder = demo.join("0");
    fs::remove_dir_all(&folder).unwrap();
    symlink("0", &folder).unwrap();
    let output = ended(&["replay", "--verify"], &demo);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains(&format!("{}: it is no file", folder.display())),
        "{said}"
    );
}

#[test]
fn a_line_without_end_is_shown_in_part() {
    let demo = recorded("strange_line");
    let log = File::options()
        .write(true)
        .truncate(true)
        .open(demo.join("0.txt"));
    log.unwrap().set_len(1 << 40).unwrap();
    let output = ended(&["replay", "--verify"], &demo);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("0.txt: line 1: recorded") && said.len() < 4000,
        "{said}"
    );
}

#[test]
fn requirements_are_read_only_from_a_file() {
    let demo = recorded("strange_requirements");
    let file = demo.join("task.json");
    is_refused_unless_a_file(&file, &["explain"], &demo);
    let output = ended(&["explain"], &demo);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("red"), "{}", stdout(&output));
}
