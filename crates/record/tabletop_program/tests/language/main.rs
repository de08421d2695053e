//! Sentences: what they mean, and how they are said.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use proptest::prelude::*;
use tabletop_program::TaskProgram;

mod generated;
mod page;
mod schema;

fn canonical(text: &str) -> String {
    let program: TaskProgram = text
        .parse()
        .unwrap_or_else(|fault| panic!("{text}: {fault}"));
    program.to_string()
}

/// Sentences in their canonical form.
const CANONICAL: &[&str] = &[
    "Put the red block on the blue block.",
    "Put every red block into the blue box.",
    "Put all blocks on each other, the largest first.",
    "Put any green block on the plate.",
    "Put each block into the bowl of its colour.",
    "Put two red blocks into the box.",
    "Put any block from the tower on the plate until it is six high.",
    "If the box is closed, open it.",
    "If the box is open, put the red block into the box, then close it, otherwise remove the red block.",
    "Swap the red block and the blue block.",
    "Move the tower from PegA to PegC by way of PegB.",
    "Copy every block that is on the left side of the table to the right side.",
    "Put the two largest blocks that are not on the table to the left of the small red ball.",
    "Put every other block aside.",
    "Put every block except the red block on the table at (1, -2.5).",
    "Put every object whose use is tool on the left side of the table.",
    "Put RedBlock where \"odd id\" was.",
    "Put all red blocks in a row on the right side of the table, the smallest first.",
    "Put all balls in a grid of three columns.",
    "Remove every block that is on the table.",
    "Close the drawer, then open the drawer.",
    "If there are more red blocks than blue blocks, remove any red block.",
    "Put any block that is on the table into the box until there are three blocks that are in the box.",
    "Put any block that is on the table aside until there is no block that is on the table.",
    "To pack A and B: put A into B; close B.\nPack the red block and the box.",
    "To tidy: remove every ball.\nTidy.",
];

/// Other words for the same.
const LOOSE: &[(&str, &str)] = &[
    (
        "put all the red cubes in the blue container",
        "Put every red block into the blue box.",
    ),
    (
        "Pick up the red cube and place it in the blue box",
        "Put the red block into the blue box.",
    ),
    (
        "Grasp any red block, then put it on the plate, and take the green block and put it aside",
        "Put any red block on the plate, then put the green block aside.",
    ),
    (
        "Stack all the blocks, biggest first!",
        "Put all blocks on each other, the largest first.",
    ),
    (
        "Put the cubes in a line from left to right",
        "Put all blocks in a row, the leftmost first.",
    ),
    (
        "Put every red block on the table into the box.",
        "Put every red block that is on the table into the box.",
    ),
    (
        "Put blocks from the pile on the tower until it is six high.",
        "Put any block from the tower on the tower until it is six high.",
    ),
    (
        "1. Open the box.\n2. Put the red block into it.\n3. Close it.",
        "Open the box.\nPut the red block into the box.\nClose the red block.",
    ),
    (
        "Copy the row on the left to the right.",
        "Copy every object that is on the left side of the table to the right side.",
    ),
    (
        "While there is a block on the table, put a block from the table into the box.",
        "Put any block that is on the table into the box until there is no block that is on the table.",
    ),
    (
        "If the box is empty, put a ball in it.",
        "If there is no object that is in the box, put any ball into the box.",
    ),
    (
        "If any block is on the plate, put it aside.",
        "If any block is on the plate, put any block that is on the plate aside.",
    ),
    (
        "Take all blocks off the tray.",
        "Put every block from the tray on the table.",
    ),
    ("Please remove the rest.", "Remove every other object."),
    (
        "Place a dark grey disc over the post",
        "Put any dark gray ring around the peg.",
    ),
    (
        "Put the three blocks to the right",
        "Put three blocks on the right side of the table.",
    ),
    (
        "Put both balls next to the cup.",
        "Put two balls to the right of the cup.",
    ),
    ("Put Small around PegB.", "Put Small around PegB."),
    ("Put Two on One.", "Put Two on One."),
];

#[test]
fn canonical_sentences_are_printed_as_they_are_read() {
    for sentence in CANONICAL {
        assert_eq!(canonical(sentence), *sentence);
    }
}

#[test]
fn other_words_mean_the_same() {
    for (said, meant) in LOOSE {
        assert_eq!(canonical(said), *meant, "{said}");
    }
}

#[test]
fn faults_have_a_place_and_the_nearest_sentence() {
    for (text, line, column, nearest) in [
        (
            "Put the red blokc on the table.",
            1,
            13,
            "Put the red block on the table.",
        ),
        (
            "Put every red block ito the box.",
            1,
            21,
            "Put every red block into the box.",
        ),
        (
            "Open the box.\nPut red block on the table.",
            2,
            5,
            "Put the red block on the table.",
        ),
        (
            "Pt the red block on the plate.",
            1,
            1,
            "Put the red block on the plate.",
        ),
        ("Stack the red block.", 1, 20, ""),
        ("Put the red block on", 1, 21, ""),
        ("Put all blocks on each other, the bigest first.", 1, 35, ""),
    ] {
        let fault = text.parse::<TaskProgram>().unwrap_err();
        assert_eq!(
            (fault.line, fault.column),
            (line, column),
            "{text}: {fault}"
        );
        if !nearest.is_empty() {
            assert_eq!(fault.nearest.as_deref(), Some(nearest), "{text}: {fault}");
        }
        let known = fault.nearest.unwrap();
        assert_eq!(canonical(&known), known);
    }
}

proptest! {
    #[test]
    fn what_is_printed_is_read_back(program in generated::program()) {
        let text = program.to_string();
        let read = text.parse::<TaskProgram>();
        prop_assert_eq!(read, Ok(program), "{}", text);
    }

    #[test]
    fn json_is_read_back_and_fits_the_schema(program in generated::program()) {
        let json = program.to_json();
        prop_assert_eq!(&TaskProgram::from_json(&json).unwrap(), &program);
        let value = serde_json::from_str(&json).unwrap();
        prop_assert_eq!(schema::fault(&value), None);
    }

    #[test]
    fn any_words_are_read_or_refused(words in proptest::collection::vec(generated::word(), 0..24)) {
        let _ = words.join(" ").parse::<TaskProgram>();
    }

    #[test]
    fn any_text_is_read_or_refused(text in ".{0,60}") {
        let _ = text.parse::<TaskProgram>();
    }
}

#[test]
fn a_fault_of_json_is_found_by_the_schema_and_by_the_reader() {
    let json = "Put every red block into the box."
        .parse::<TaskProgram>()
        .unwrap()
        .to_json();
    for (from, to) in [
        ("\"every\"", "\"evry\""),
        ("\"put\"", "\"throw\""),
        ("\"what\"", "\"whom\""),
        ("\"red\"", "7"),
    ] {
        let broken = json.replace(from, to);
        assert_ne!(broken, json, "{from}");
        assert!(TaskProgram::from_json(&broken).is_err(), "{broken}");
        assert!(
            schema::fault(&serde_json::from_str(&broken).unwrap()).is_some(),
            "{broken}"
        );
    }
    let unsayable = json.replace("\"red\"", "\"vermilion\"");
    assert!(TaskProgram::from_json(&unsayable).is_err());
}

#[test]
fn deep_and_long_texts_are_refused() {
    let deep = format!("Put {} on the table.", "any block that is on ".repeat(2000));
    assert!(deep.parse::<TaskProgram>().is_err());
    let long = "Open the box. ".repeat(10_000);
    assert!(long.parse::<TaskProgram>().is_err());
}
