//! The page of the grammar, whose sentences are all understood as it says.

use tabletop_program::TaskProgram;

const PAGE: &str = include_str!("../../../../../docs/task-programs.md");

fn printed(text: &str) -> String {
    let program: TaskProgram = text
        .parse()
        .unwrap_or_else(|fault| panic!("{text}: {fault}"));
    program.to_string()
}

#[test]
fn sentences_are_printed_as_the_page_has_them() {
    let blocks: Vec<_> = PAGE.split("```program\n").skip(1).collect();
    assert_eq!(blocks.len(), 3);
    for block in blocks {
        let (block, _) = block.split_once("\n```").unwrap();
        assert_eq!(printed(block), block);
    }
}

#[test]
fn other_words_are_understood_as_the_page_says() {
    let (_, table) = PAGE
        .split_once("| said | understood |\n|---|---|\n")
        .unwrap();
    let rows = table.lines().take_while(|line| line.starts_with('|'));
    let mut count = 0;
    for row in rows {
        let cells: Vec<_> = row.split('|').map(str::trim).collect();
        assert_eq!(printed(cells[1]), cells[2]);
        count += 1;
    }
    assert_eq!(count, 13);
}

#[test]
fn the_example_of_a_fault_is_its_message() {
    let said = "Put every red blokc into the box.";
    let fault = said.parse::<TaskProgram>().unwrap_err();
    assert!(PAGE.contains(&format!("tabletop: {fault}\n")), "{fault}");
    assert!(PAGE.contains(said));
}
