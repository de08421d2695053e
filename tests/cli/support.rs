//! The program, as a user runs it.

use std::{
    collections::BTreeMap,
    fs,
    path::{self, Path, PathBuf},
    process::{Command, Output},
};

/// Runs the program without a display, in the folder of this package, where cargo runs tests.
pub fn tabletop(arguments: &[&str]) -> Output {
    command(arguments).output().unwrap()
}

/// The program, to be run like [`tabletop`] unless something is changed.
pub fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tabletop"));
    command
        .args(arguments)
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("TABLETOP_ENGINE");
    command
}

/// Runs the program where no file can have more than a few KiB, as if the disk were full.
#[cfg(unix)]
pub fn small_files(arguments: &[&str]) -> Output {
    let program = command(arguments);
    let mut shell = Command::new("sh");
    shell
        .args(["-c", r#"trap "" XFSZ; ulimit -f 16; exec "$0" "$@""#])
        .arg(program.get_program())
        .args(program.get_args());
    shell.output().unwrap()
}

pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// The place where a test writes; remains of an earlier run are removed.
pub fn place(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    match path.is_dir() {
        true => fs::remove_dir_all(&path).unwrap(),
        false => drop(fs::remove_file(&path)),
    }
    path
}

/// Records a scenario into a place of this name.
pub fn record(scenario: &str, name: &str) -> String {
    let demo = place(name).to_str().unwrap().to_owned();
    let output = tabletop(&["run", scenario, "--record", &demo, "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    demo
}

/// Records a shipped scenario into a place of this name.
pub fn record_shipped(scenario: &str, name: &str) -> String {
    record(&format!("shipped:scenarios/{scenario}.ron"), name)
}

pub fn replays_to_the_same_bytes(recording: impl AsRef<Path>) {
    let recording = recording.as_ref().to_str().unwrap();
    let output = tabletop(&["replay", recording, "--verify"]);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{recording}: {}",
        stderr(&output)
    );
}

/// A file of the package, by its name in this folder.
pub fn shipped(folder: &str, name: &str) -> PathBuf {
    path::absolute(Path::new(folder).join(name)).unwrap()
}

/// A scenario of these steps, which begin in the second line, on the default table.
pub fn scenario(name: &str, steps: &str) -> PathBuf {
    let path = place(name);
    let setup = "shipped:tablesetup/default.xml";
    fs::write(&path, format!("(setup: {setup:?}, steps: [\n{steps}\n])")).unwrap();
    path
}

/// Every file below a folder, by its path in it.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().display().to_string();
                found.insert(name, fs::read(path).unwrap());
            }
        }
    }
    found
}
