//! Files are opened in few places, which make sure of what they open: a pipe could wait for ever, a device never end, and a stranger's link
//! lead to any file.

use std::collections::BTreeSet;

use crate::source::program;

/// The ends of the paths of functions that open whatever is there.
const OPENERS: [[&str; 2]; 4] = [
    ["File", "open"],
    ["OpenOptions", "new"],
    ["fs", "read"],
    ["fs", "read_to_string"],
];

/// The files that call them. All others ask `tabletop_core` for a regular file.
const PLACES: [&str; 9] = [
    "crates/tabletop_core/src/regular_file.rs",
    "crates/tabletop_engine/src/regular_file.rs",
    // What the system tells of processes.
    "crates/tabletop_engine/src/worker/descendants.rs",
    // Files of an engine's own folder.
    "crates/tabletop_engine/src/worker/exchange_folder.rs",
    "crates/tabletop_engine/src/worker/trigger_file.rs",
    // The folder around a recording, to lock it.
    "crates/tabletop_recorder/src/files/folder.rs",
    "crates/tabletop_recorder/src/files/storage.rs",
    // The file that the user names for what is printed.
    "src/cli/output.rs",
    // What the system tells of the program's memory.
    "src/cli/soak.rs",
];

#[test]
fn few_places_open_files() {
    let opens = |path: &Vec<String>| {
        OPENERS
            .iter()
            .any(|opener| path.ends_with(&opener.map(String::from)))
    };
    let places: BTreeSet<_> = program()
        .into_iter()
        .filter(|(_, source)| source.paths.iter().any(opens))
        .map(|(file, _)| file.display().to_string())
        .collect();
    assert_eq!(places, PLACES.map(String::from).into());
}
