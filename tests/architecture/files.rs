//! Files are opened and changed in few places: those that open check the kind of file (a pipe could wait for ever, a device never end, a
//! stranger's link lead to any file), and those that change keep the rules of `SECURITY.md`.

use std::collections::BTreeSet;

use crate::source::{Source, program};

/// The ends of the paths of functions that open a file of any kind.
const OPENERS: [[&str; 2]; 4] = [
    ["File", "open"],
    ["OpenOptions", "new"],
    ["fs", "read"],
    ["fs", "read_to_string"],
];

/// The files that call them. All others ask `tabletop_storage` for a regular file.
const OPENING: [&str; 8] = [
    "crates/robot/tabletop_engine/src/regular_file.rs",
    // The system's files about processes.
    "crates/robot/tabletop_engine/src/worker/descendants.rs",
    // Files of an engine's own folder.
    "crates/robot/tabletop_engine/src/worker/exchange_folder.rs",
    "crates/robot/tabletop_engine/src/worker/trigger_file.rs",
    "crates/base/tabletop_storage/src/inner_file.rs",
    "crates/base/tabletop_storage/src/regular_file.rs",
    "crates/base/tabletop_storage/src/storage.rs",
    // The system's file about the program's memory.
    "src/cli/soak.rs",
];

/// The ends of the paths of functions that create, replace, rename or remove.
const CHANGERS: [[&str; 2]; 14] = [
    ["DirBuilder", "new"],
    ["File", "create"],
    ["File", "create_new"],
    ["fs", "copy"],
    ["fs", "create_dir"],
    ["fs", "create_dir_all"],
    ["fs", "hard_link"],
    ["fs", "remove_dir"],
    ["fs", "remove_dir_all"],
    ["fs", "remove_file"],
    ["fs", "rename"],
    ["fs", "set_permissions"],
    ["fs", "write"],
    ["OpenOptions", "new"],
];

/// The files that call them. All others ask a `Storage` of `tabletop_storage`.
const CHANGING: [&str; 8] = [
    // An engine's own folder, of a random name, in memory.
    "crates/robot/tabletop_engine/src/private_folder.rs",
    "crates/robot/tabletop_engine/src/regular_file.rs",
    "crates/robot/tabletop_engine/src/worker/exchange_folder.rs",
    "crates/robot/tabletop_engine/src/worker/trigger_file.rs",
    // A folder of tests, to be mounted on.
    "crates/test/tabletop_harness/src/prerequisite.rs",
    "crates/base/tabletop_storage/src/storage.rs",
    "crates/base/tabletop_storage/src/whole_file.rs",
    // The folder of a test.
    "crates/window/tabletop_window/src/test_folder.rs",
];

/// The beginnings of the paths of the files that read what strangers have recorded, exported or taken pictures of.
const READING_STRANGERS: [&str; 11] = [
    "crates/data/tabletop_dataset/",
    "crates/run/tabletop_episodes/",
    "crates/data/tabletop_export/",
    "crates/run/tabletop_film/",
    "crates/data/tabletop_policy/",
    "crates/record/tabletop_recorder/",
    "crates/run/tabletop_replay/",
    "crates/data/tabletop_report/",
    "crates/record/tabletop_task/",
    "crates/data/tabletop_training/",
    "src/cli",
];

/// True for what the program itself names: a text, a constant, or nothing at all, as threads are joined.
fn is_own(joined: &[String]) -> bool {
    let is_constant = |name: &String| {
        let is_of_constant = |letter: char| letter.is_ascii_uppercase() || letter == '_';
        name.chars().all(is_of_constant)
    };
    match joined {
        [] => true,
        [path @ .., name] => is_constant(name) && path.iter().all(|part| part != "("),
    }
}

/// The files that call one of these functions.
fn callers(functions: &[[&str; 2]]) -> BTreeSet<String> {
    let calls = |path: &Vec<String>| {
        functions
            .iter()
            .any(|function| path.ends_with(&function.map(String::from)))
    };
    program()
        .into_iter()
        .filter(|(_, source)| source.paths.iter().any(calls))
        .map(|(file, _)| file.display().to_string())
        .collect()
}

#[test]
fn few_places_open_files() {
    assert_eq!(callers(&OPENERS), OPENING.map(String::from).into());
}

#[test]
fn few_places_change_files() {
    assert_eq!(callers(&CHANGERS), CHANGING.map(String::from).into());
}

/// A name that a stranger chose may be `../..`, or begin at the root: an `InnerPath` refuses both.
#[test]
fn no_name_of_a_stranger_is_joined_to_a_path() {
    let reads = |file: &str| READING_STRANGERS.iter().any(|it| file.starts_with(it));
    let foreign = program().into_iter().flat_map(|(file, source)| {
        let file = file.display().to_string();
        let joined = source.joined.into_iter();
        let foreign = joined.filter(|joined| reads(&file) && !is_own(joined));
        let foreign: Vec<_> = foreign
            .map(|joined| format!("{file}: join({})", joined.concat()))
            .collect();
        foreign
    });
    assert_eq!(foreign.collect::<Vec<_>>(), Vec::<String>::new());
}

#[test]
fn joined_names_are_seen() {
    let text = "fn f() { a.join(\"b\"); a.join(B); a.join(C::B); thread.join(); a.join(&name); a.join(format!(\"{b}\")); }";
    let joined = Source::parse(text).joined;
    let are_own: Vec<_> = joined.iter().map(|joined| is_own(joined)).collect();
    assert_eq!(are_own, [true, true, true, true, false, false]);
}
