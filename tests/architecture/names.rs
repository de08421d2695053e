//! Each type of the program has a name of its own, so that a name says which type is meant wherever it stands.

use std::{collections::BTreeMap, path::PathBuf};

use crate::source::program;

/// Names that every panel has: its model, its request, and the sources of its model.
const OF_PANELS: [&str; 3] = ["Model", "Request", "Sources"];

#[test]
fn no_two_types_have_one_name() {
    let mut places: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for (file, source) in program() {
        for name in source.types {
            places.entry(name).or_default().push(file.clone());
        }
    }
    let stands_in_panel =
        |file: &PathBuf| file.components().any(|part| part.as_os_str() == "panels");
    places.retain(|name, files| {
        if OF_PANELS.contains(&name.as_str()) {
            files.retain(|file| !stands_in_panel(file));
        }
        files.len() > 1
    });
    assert!(places.is_empty(), "types of one name: {places:#?}");
}
