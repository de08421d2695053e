//! No engine outlives its program, however that ends.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    time::{Duration, Instant},
};

use nix::{sys::signal, unistd::Pid};
use tabletop_engine::Trigger;
use tabletop_harness::test_with;

use crate::common::{self, Folder, PATIENCE, Session, TRIGGERS};

/// The folder of the scripts, for this binary as a program that has an engine.
const FOLDER: &str = "TABLETOP_TEST_FOLDER";
const TRIGGER: &str = "TABLETOP_TEST_TRIGGER";

/// A script that writes its session's folder, its process and those of these children to a file, then hangs or not.
fn pair(folder: &Path, children: &[&str], hang: bool) -> Folder {
    let note = folder.join("processes");
    let children = children.join("; ");
    let init = format!(
        "[~, children] = system('{children}');\nsession = fileparts(fileparts(which('tabletop_call')));\n\
         fid = fopen('{0}.part', 'w'); fprintf(fid, '%s %d %s', session, getpid(), children); fclose(fid); rename('{0}.part', '{0}');\n\
         log = fopen('{1}', 'w'); fputs(log, 'written');",
        note.display(),
        folder.join("log").display()
    );
    Folder::pair(&init, if hang { "while true, end" } else { "" })
}

/// A child in the engine's group, one that has left it, and one that has also left its environment behind.
const CHILDREN: [&str; 3] = [
    "sleep 1000 >/dev/null 2>&1 & echo $!",
    "setsid sleep 1000 >/dev/null 2>&1 & echo $!",
    "env -i setsid sleep 1000 >/dev/null 2>&1 & echo $!",
];

struct Note {
    processes: Vec<Pid>,
    session: PathBuf,
}

/// Waits for the note of a script that still runs.
fn read(folder: &Path, mut runs: impl FnMut() -> bool) -> Note {
    let start = Instant::now();
    loop {
        if let Ok(text) = fs::read_to_string(folder.join("processes")) {
            let mut words = text.split_whitespace();
            let session = words.next().unwrap().into();
            let processes = words.map(|pid| Pid::from_raw(pid.parse().unwrap()));
            let processes = processes.collect();
            return Note { processes, session };
        }
        let may_come = runs() && start.elapsed() < PATIENCE;
        assert!(may_come, "the script has not run");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// True if a process is there and no zombie.
fn lives(pid: Pid) -> bool {
    let state = fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
    signal::kill(pid, None).is_ok()
        && !state
            .rsplit(')')
            .next()
            .unwrap_or_default()
            .trim_start()
            .starts_with('Z')
}

fn all_gone(note: &Note, limit: Duration) -> bool {
    let start = Instant::now();
    while start.elapsed() < limit {
        if !note.processes.iter().any(|pid| lives(*pid)) && !note.session.exists() {
            return true;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    false
}

#[test_with(Octave)]
fn with_the_last_handle_all_is_gone() {
    for trigger in TRIGGERS {
        let folder = Folder::new(&[]);
        let scripts = pair(&folder.0, &CHILDREN, false);
        let session = Session::octave(&scripts.0, trigger);
        session.init().unwrap();
        session.step(&common::at_rest()).unwrap();
        let note = read(&folder.0, || true);
        assert!(note.processes.iter().all(|pid| lives(*pid)) && note.session.exists());
        assert_eq!(note.processes.len(), 1 + CHILDREN.len());
        drop(session);
        assert!(all_gone(&note, PATIENCE));
    }
}

#[test_with(Octave)]
fn with_a_killed_program_all_is_gone() {
    for trigger in TRIGGERS {
        let folder = Folder::new(&[]);
        let scripts = pair(&folder.0, &CHILDREN[..2], true);
        let mut program = Command::new(env::current_exe().unwrap())
            .env(FOLDER, &scripts.0)
            .env(TRIGGER, format!("{trigger:?}"))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let note = read(&folder.0, || program.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(200));
        assert!(note.processes.iter().all(|pid| lives(*pid)));
        program.kill().unwrap();
        program.wait().unwrap();
        assert!(all_gone(&note, PATIENCE), "{trigger:?}");
        let log = fs::read_to_string(folder.0.join("log")).unwrap();
        assert_eq!(log, "written", "{trigger:?}");
    }
}

/// Runs this binary as a program that has an engine with a script that hangs, if it was started so.
pub fn is_program() -> bool {
    let Some(folder) = env::var_os(FOLDER) else {
        return false;
    };
    let trigger = match env::var(TRIGGER).unwrap().as_str() {
        "Poll" => Trigger::Poll,
        _ => Trigger::Stdin,
    };
    let session = Session::octave(Path::new(&folder), trigger);
    session.init().unwrap();
    session.step(&common::at_rest()).unwrap();
    true
}

#[test_with(Octave)]
fn a_polling_engine_ends_when_nobody_asks_any_more() {
    let folder = Folder::new(&[("done.bin", "12345678")]);
    let driver = Path::new("matlab");
    // The real limit is half a minute.
    let poll = fs::read_to_string(driver.join("tabletop_poll.m"))
        .unwrap()
        .replace("quiet < 30", "quiet < 0.3");
    fs::write(folder.0.join("tabletop_poll.m"), poll).unwrap();
    let script = format!(
        "addpath('{}'); tabletop_poll('{0}/'); exit",
        folder.0.display()
    );
    let ended = Command::new("octave-cli")
        .args(["-q", "--eval", &script])
        .output()
        .unwrap();
    assert!(ended.status.success());
}
