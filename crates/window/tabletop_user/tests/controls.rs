//! `docs/controls.md` names every key, and every test that it names exists.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::{fs, path::Path};

use tabletop_user::{Action, Keymap};

fn root() -> &'static Path {
    let folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    folders.into_iter().nth(3).unwrap()
}

fn page() -> String {
    fs::read_to_string(root().join("docs/controls.md")).unwrap()
}

/// The beginning of an action's line.
fn line_of(action: Action) -> String {
    let keymap = Keymap::default();
    let bindings = keymap.bindings(action).iter();
    let keys: Vec<_> = bindings
        .map(|binding| format!("`{}`", binding.label()))
        .collect();
    format!(
        "| {} | {} | `{action}` | ",
        keys.join(", "),
        keymap.description(action)
    )
}

#[test]
fn every_action_has_a_line_with_its_keys() {
    let page = page();
    let missing: Vec<_> = Keymap::default()
        .actions()
        .map(line_of)
        .filter(|line| !page.lines().any(|there| there.starts_with(line)))
        .collect();
    assert!(
        missing.is_empty(),
        "docs/controls.md lacks\n{}",
        missing.join("\n")
    );
}

#[test]
fn no_line_is_left_of_an_action_that_has_gone() {
    let page = page();
    let (_, keys) = page.split_once("## Keys").unwrap();
    let lines = keys.lines().filter(|line| line.starts_with("| `")).count();
    assert_eq!(lines, Keymap::default().actions().count());
}

#[test]
fn every_line_of_a_table_is_proven_by_tests_that_exist() {
    let page = page();
    let lines = page.lines().filter(|line| {
        let is_head = line.contains("proven by") || line.starts_with("|---");
        line.starts_with('|') && !is_head
    });
    for line in lines {
        let proof = line.trim_end_matches(" |").rsplit("| ").next().unwrap();
        let links: Vec<_> = proof.split("[`").skip(1).collect();
        assert!(!links.is_empty(), "no proof: {line}");
        for link in links {
            let (test, rest) = link.split_once("`](../").unwrap();
            let (file, _) = rest.split_once(')').unwrap();
            let source = fs::read_to_string(root().join(file));
            let source = source.unwrap_or_else(|error| panic!("{file}: {error}"));
            let function = format!("fn {test}(");
            assert!(source.contains(&function), "{file} has no test {test}");
        }
    }
}

/// The program's sources without their tests and without the table of actions itself.
fn sources() -> String {
    fn read(folder: &Path, text: &mut String) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.ends_with("keymap") || path.ends_with("tests.rs") {
                continue;
            }
            if path.is_dir() {
                read(&path, text);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let source = fs::read_to_string(&path).unwrap();
                let tests = source.find("#[cfg(test)]\nmod tests");
                text.push_str(&source[..tests.unwrap_or(source.len())]);
            }
        }
    }
    let mut text = String::new();
    read(&root().join("src"), &mut text);
    for floor in fs::read_dir(root().join("crates")).unwrap() {
        for folder in fs::read_dir(floor.unwrap().path()).unwrap() {
            read(&folder.unwrap().path().join("src"), &mut text);
        }
    }
    text
}

#[test]
fn every_action_is_read_somewhere() {
    let sources = sources();
    let unread: Vec<_> = Keymap::default()
        .actions()
        .filter(|action| {
            let name = format!("{action:?}");
            let (variant, _) = name.split_once('(').unwrap_or((&name, ""));
            let named = format!("Action::{variant}");
            let mut found = sources.match_indices(&named);
            !found.any(|(at, _)| !sources[at + named.len()..].starts_with(char::is_alphanumeric))
        })
        .collect();
    assert_eq!(unread, []);
}
