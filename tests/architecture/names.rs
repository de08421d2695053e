//! Each type of the program has a name of its own, so that a name says which type is meant wherever it stands.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::PathBuf,
};

use crate::source::program;

/// Names that every panel has: its model, its request, and the sources of its model.
const OF_PANELS: [&str; 3] = ["Model", "Request", "Sources"];

#[test]
fn no_two_types_have_one_name() {
    let mut places: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for (file, source) in program() {
        // A macro's `$Name` is none.
        for name in source.types.into_iter().filter(|name| name != "$") {
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

#[test]
fn the_glossary_names_types_that_there_are() {
    let types: BTreeSet<String> = program()
        .into_iter()
        .flat_map(|(_, source)| source.types)
        .collect();
    let page = fs::read_to_string("docs/glossary.md").unwrap();
    let rows = page.lines().filter(|line| line.starts_with("| "));
    let named: Vec<_> = rows
        .flat_map(|row| row.split('`').skip(1).step_by(2))
        .collect();
    assert!(named.len() > 40, "{named:?}");
    let unknown: Vec<_> = named
        .iter()
        .filter(|name| !types.contains(**name))
        .collect();
    assert!(unknown.is_empty(), "docs/glossary.md: {unknown:?}");
}
