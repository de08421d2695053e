//! The map of the crates: ARCHITECTURE.md and the documentation of the root have a line for each, the first sentence of its own documentation.
//! `TABLETOP_WRITE=1 cargo test --test architecture map` writes them.

use std::{env, fs, path::Path};

use crate::source::crates;

/// A crate.
struct Room {
    floor: String,
    name: String,
    sentence: String,
}

/// The crates, from the lowest floor up.
fn rooms() -> Vec<Room> {
    let name = |folder: &Path| folder.file_name().unwrap().to_string_lossy().into_owned();
    let room = |folder: &Path| Room {
        floor: name(folder.parent().unwrap()),
        name: name(folder),
        sentence: first_sentence(&fs::read_to_string(folder.join("src/lib.rs")).unwrap()),
    };
    crates().iter().map(|folder| room(folder)).collect()
}

/// The first sentence of a file's documentation.
fn first_sentence(text: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix("//!"));
    let paragraph: Vec<_> = lines
        .map(str::trim)
        .take_while(|line| !line.is_empty())
        .collect();
    let paragraph = paragraph.join(" ");
    let end = paragraph.find(". ").unwrap_or(paragraph.len());
    paragraph[..end].trim_end_matches('.').to_owned()
}

/// The text of a file between two lines, which is to be this; it is written if that is asked for.
fn compare(file: &str, [begin, end]: [&str; 2], table: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let text = fs::read_to_string(&path).unwrap();
    let (before, rest) = text.split_once(begin).unwrap();
    let (now, after) = rest.split_once(end).unwrap();
    if env::var_os("TABLETOP_WRITE").is_some() {
        fs::write(&path, format!("{before}{begin}{table}{end}{after}")).unwrap();
    } else {
        assert!(now == table, "{file} is to have this table:\n{table}");
    }
}

#[test]
fn architecture_has_a_line_a_crate() {
    let mut table = "| floor | crate | content |\n|---|---|---|\n".to_owned();
    let mut last = String::new();
    for room in rooms() {
        let Room {
            floor,
            name,
            sentence,
        } = room;
        let shown = if floor == last { "" } else { &floor };
        table += &format!("| {shown} | `{name}` | {sentence} |\n");
        last = floor;
    }
    let marks = ["<!-- crates -->\n", "<!-- /crates -->"];
    compare("ARCHITECTURE.md", marks, &table);
}

#[test]
fn the_roots_documentation_has_a_line_a_crate() {
    let lib = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs")).unwrap();
    let mut table = String::new();
    for room in rooms() {
        let exported = format!("pub use {} as ", room.name);
        let module = lib.lines().find_map(|line| line.strip_prefix(&exported));
        // Those of the window are not in every build, and links to them would lead nowhere.
        if let Some(module) = module.filter(|_| room.floor != "window") {
            let module = module.trim_end_matches(';');
            table += &format!("//! | [`{module}`] | {} |\n", room.sentence);
        }
    }
    let marks = [
        "//! | crate | content |\n//! |---|---|\n",
        "//!\n//! [`TabletopSimPlugins`]",
    ];
    compare("src/lib.rs", marks, &table);
}
