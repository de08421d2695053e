//! Every kind of recording on every road that leads from recordings: right, or refused with a sentence.
//!
//! A usual run goes a third of the roads from each kind. `TABLETOP_ROADS=all cargo test --release --test roads` goes all of them, and
//! writes `docs/roads.md`.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kind;
#[path = "../../crates/robot/tabletop_bridge/tests/rosbridge/mock.rs"]
#[expect(dead_code, reason = "it has more than is needed here")]
mod mock;
mod playback;
mod program;
mod road;
mod shown;
mod table;

use std::{env, fs, path::Path};

use self::{
    kind::{Kind, Recordings},
    road::Road,
    table::Table,
};

/// True if all roads are to be gone.
fn goes_all() -> bool {
    env::var("TABLETOP_ROADS").is_ok_and(|value| value == "all")
}

/// Part of the roads that a usual run goes, of each kind others.
const THIRD: usize = 3;

fn is_usual(row: usize, column: usize) -> bool {
    (row + column).is_multiple_of(THIRD)
}

#[test]
fn every_recording_goes_every_road_or_is_refused_with_a_sentence() {
    let recordings = Recordings::make();
    let cells: Vec<_> = (0..Kind::ALL.len())
        .flat_map(|row| (0..Road::ALL.len()).map(move |column| (row, column)))
        .filter(|&(row, column)| goes_all() || is_usual(row, column))
        .collect();
    let table = Table::of(&recordings, &cells);
    assert!(table.wrong.is_empty(), "{}", table.wrong.join("\n"));
    let page = Path::new("docs/roads.md");
    if goes_all() {
        fs::write(page, table.page()).unwrap();
    }
    let page = fs::read_to_string(page).unwrap();
    let differing = table.differing(&page);
    assert!(
        differing.is_empty(),
        "docs/roads.md is not true any more:\n{}",
        differing.join("\n")
    );
}

/// A command that is added gets a road, or a reason why it takes no recording.
#[test]
fn every_command_is_a_road_or_takes_no_recording() {
    let help = program::run(&["--help"], Path::new("."));
    let commands = help.stdout.lines().skip_while(|line| *line != "Commands:");
    let commands: Vec<_> = commands
        .skip(1)
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    assert!(commands.len() > 10, "{}", help.stdout);
    let roads: Vec<_> = Road::ALL.iter().map(|road| road.command()).collect();
    for command in &commands {
        let is_road = roads.contains(command);
        let is_none = road::WITHOUT_RECORDING.contains(command);
        assert!(is_road != is_none, "{command}: {commands:?}");
    }
}
