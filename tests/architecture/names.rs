//! Each type of the program has a name of its own, so that a name says which type is meant wherever it stands.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use crate::source::Source;

/// Names that every panel has: its model, its request, and the sources of its model.
const OF_PANELS: [&str; 3] = ["Model", "Request", "Sources"];

#[test]
fn no_two_types_have_one_name() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    for entry in fs::read_dir(root.join("crates")).unwrap() {
        collect(&entry.unwrap().path().join("src"), &mut files);
    }
    collect(&root.join("src"), &mut files);
    let mut places: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for file in files {
        for name in Source::parse(&fs::read_to_string(&file).unwrap()).types {
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

/// The files of Rust below a folder that are no tests.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap_or_default();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|it| it == "rs") && stem != "tests" {
            files.push(path);
        }
    }
}
