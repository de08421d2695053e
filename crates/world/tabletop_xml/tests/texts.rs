//! The parser on the texts with which `tests/schema` tries the schema.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on panics")]

#[path = "schema/texts.rs"]
mod texts;

use std::path::Path;

use tabletop_xml::{Fault, parse, read_task};

fn faults(text: &str) -> Vec<Fault> {
    parse(Path::new("snippet.xml"), text.as_bytes()).faults
}

#[test]
fn shipped_files_have_no_faults() {
    for path in texts::shipped_files() {
        assert_eq!(read_task(&path).unwrap().faults, []);
    }
}

#[test]
fn the_parser_accepts_every_text_the_schema_accepts() {
    for text in texts::accepted() {
        assert_eq!(faults(&text), [], "{text}");
    }
}

#[test]
fn the_parser_rejects_every_text_the_schema_rejects() {
    for text in texts::rejected() {
        assert_ne!(faults(&text), [], "{text}");
    }
}
