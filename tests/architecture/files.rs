//! Files are opened and changed in few places: those that open check the kind of file (a pipe could wait for ever, a device never end, a
//! stranger's link lead to any file), and those that change keep the rules of `SECURITY.md`.

use std::collections::BTreeSet;

use crate::source::program;

/// The ends of the paths of functions that open a file of any kind.
const OPENERS: [[&str; 2]; 4] = [
    ["File", "open"],
    ["OpenOptions", "new"],
    ["fs", "read"],
    ["fs", "read_to_string"],
];

/// The files that call them. All others ask `tabletop_storage` for a regular file.
const OPENING: [&str; 7] = [
    "crates/tabletop_engine/src/regular_file.rs",
    // The system's files about processes.
    "crates/tabletop_engine/src/worker/descendants.rs",
    // Files of an engine's own folder.
    "crates/tabletop_engine/src/worker/exchange_folder.rs",
    "crates/tabletop_engine/src/worker/trigger_file.rs",
    "crates/tabletop_storage/src/regular_file.rs",
    "crates/tabletop_storage/src/storage.rs",
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
    "crates/tabletop_engine/src/private_folder.rs",
    "crates/tabletop_engine/src/regular_file.rs",
    "crates/tabletop_engine/src/worker/exchange_folder.rs",
    "crates/tabletop_engine/src/worker/trigger_file.rs",
    // A folder of tests, to be mounted on.
    "crates/tabletop_harness/src/prerequisite.rs",
    "crates/tabletop_storage/src/storage.rs",
    "crates/tabletop_storage/src/whole_file.rs",
    // The folder of a test.
    "src/test_folder.rs",
];

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
