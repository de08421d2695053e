//! Each promise of `SECURITY.md` has tests, which are there.

use std::{fs, path::Path};

const PROMISES: &str = "## Promised";
const TESTS: &str = "## How it is tested";

/// The lines below a heading, up to the next one.
fn below<'t>(text: &'t str, heading: &str) -> impl Iterator<Item = &'t str> {
    let lines = text.lines().skip_while(move |line| *line != heading);
    lines.skip(1).take_while(|line| !line.starts_with("## "))
}

/// The parts of a text between two marks.
fn between<'t>(text: &'t str, mark: &str) -> Vec<&'t str> {
    text.split(mark).skip(1).step_by(2).collect()
}

#[test]
fn each_promise_has_tests() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("SECURITY.md")).unwrap();
    let promised = below(&text, PROMISES).filter(|line| line.starts_with("- **"));
    let promised: Vec<_> = promised.map(|line| between(line, "**")[0]).collect();
    let rows = below(&text, TESTS).filter_map(|line| line.strip_prefix("| ")?.split_once(" | "));
    // Below the heading and the line under it.
    let rows: Vec<_> = rows.skip(1).collect();
    let tested: Vec<_> = rows.iter().map(|(promise, _)| *promise).collect();
    assert_eq!(promised, tested);
    for (promise, tests) in rows {
        let mut source = String::new();
        let mut count = 0;
        for name in between(tests, "`") {
            if name.ends_with(".rs") {
                source = fs::read_to_string(root.join(name)).expect(name);
            } else {
                let is_there = source.contains(&format!("fn {name}("));
                assert!(is_there, "{promise}: there is no test {name}");
                count += 1;
            }
        }
        assert!(count > 0, "{promise}: no test");
    }
}
