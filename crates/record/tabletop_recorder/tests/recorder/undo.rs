//! A recording in which something was undone is, byte for byte, one in which it was never done.

use std::collections::BTreeMap;

use tabletop_core::{
    ClockCommand, CommandId, Hand, HandCommand, HistoryCommand, HistoryFact, RecordingCommand,
    SimCommand, SimFact, SimTick, StepApp as _, WriteCommand as _,
};

use crate::stage::{Place, app, grasp, run, scene};

const LEFT: Hand = Hand::Left;
const RIGHT: Hand = Hand::Right;

/// Records a script whose commands come after so many ticks, until the clock stands at 200.
fn record(script: &[(u64, SimCommand)]) -> BTreeMap<String, Vec<u8>> {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["a", "bb", "still"])),
            (3, SimCommand::Recording(RecordingCommand::Start)),
        ],
    );
    run(&mut app, script);
    let now = app.world().resource::<SimTick>().0;
    run(
        &mut app,
        &[(200 - now, SimCommand::Recording(RecordingCommand::Finish))],
    );
    place.tree()
}

fn assert_same(done: &[(u64, SimCommand)], undone: &[(u64, SimCommand)]) {
    let expected = record(done);
    let found = record(undone);
    assert_eq!(
        expected.keys().collect::<Vec<_>>(),
        found.keys().collect::<Vec<_>>()
    );
    for (name, content) in expected {
        assert!(
            content == found[&name],
            "{name} is\n{}\ninstead of\n{}",
            String::from_utf8_lossy(&found[&name]),
            String::from_utf8_lossy(&content)
        );
    }
}

#[test]
fn an_undone_grasp_was_never_made() {
    assert_same(
        &[(20, SimCommand::Hand(HandCommand::Select(LEFT)))],
        &[
            (20, SimCommand::Hand(HandCommand::Select(LEFT))),
            (3, grasp(LEFT, "a")),
            (47, SimCommand::History(HistoryCommand::Undo)),
        ],
    );
}

#[test]
fn commands_of_the_tick_before_the_grasp_stay() {
    assert_same(
        &[
            (20, scene(&["a", "c"])),
            (0, SimCommand::Hand(HandCommand::Select(LEFT))),
        ],
        &[
            (20, scene(&["a", "c"])),
            (0, SimCommand::Hand(HandCommand::Select(LEFT))),
            (0, grasp(LEFT, "a")),
            (47, SimCommand::History(HistoryCommand::Undo)),
        ],
    );
}

#[test]
fn scenes_are_set_before_hands_act_in_any_order_of_commands() {
    assert_same(
        &[(20, scene(&["a", "c"]))],
        &[
            (20, grasp(LEFT, "a")),
            (0, scene(&["a", "c"])),
            (47, SimCommand::History(HistoryCommand::Undo)),
        ],
    );
}

#[test]
fn hands_act_after_undo_in_any_order_of_commands() {
    assert_same(
        &[(20, grasp(RIGHT, "bb"))],
        &[
            (20, grasp(LEFT, "a")),
            (10, SimCommand::Hand(HandCommand::Release(LEFT))),
            (30, grasp(RIGHT, "bb")),
            (0, SimCommand::History(HistoryCommand::Undo)),
            (0, SimCommand::History(HistoryCommand::Undo)),
        ],
    );
}

#[test]
fn a_command_that_was_refused_before_the_grasp_stays() {
    assert_same(
        &[(20, grasp(LEFT, "nothing"))],
        &[
            (20, grasp(LEFT, "nothing")),
            (0, grasp(LEFT, "a")),
            (47, SimCommand::History(HistoryCommand::Undo)),
        ],
    );
}

#[test]
fn a_release_and_a_grasp_of_one_tick_are_undone_one_by_one() {
    assert_same(
        &[
            (20, grasp(LEFT, "a")),
            (30, SimCommand::Hand(HandCommand::Release(LEFT))),
        ],
        &[
            (20, grasp(LEFT, "a")),
            (30, SimCommand::Hand(HandCommand::Release(LEFT))),
            (0, grasp(LEFT, "bb")),
            (20, SimCommand::History(HistoryCommand::Undo)),
        ],
    );
}

#[test]
fn the_second_of_two_equal_commands_begins_segments_of_its_own() {
    assert_same(
        &[
            (20, grasp(LEFT, "a")),
            (0, SimCommand::Hand(HandCommand::Release(LEFT))),
        ],
        &[
            (20, grasp(LEFT, "a")),
            (0, grasp(LEFT, "a")),
            (47, SimCommand::History(HistoryCommand::Undo)),
        ],
    );
}

#[test]
fn a_segment_without_a_logged_command_begins_after_all_of_its_tick() {
    let place = Place::new();
    let mut app = app(&place);
    let start = SimCommand::Recording(RecordingCommand::Start);
    run(&mut app, &[(0, scene(&["a"])), (1, start)]);
    let cause = CommandId(1000);
    app.world_mut().write_command(HandCommand::Select(LEFT));
    app.world_mut()
        .write_message(SimFact::History(HistoryFact::SegmentBegun { cause }));
    app.step(1);
    app.world_mut()
        .write_message(SimFact::History(HistoryFact::Undone { cause }));
    let finish = SimCommand::Recording(RecordingCommand::Finish);
    run(&mut app, &[(0, finish)]);
    assert!(place.read("session.jsonl").contains("Select"));
}

#[test]
fn an_undone_destroy_brings_the_object_back_without_a_line() {
    assert_same(
        &[(20, grasp(LEFT, "a"))],
        &[
            (20, grasp(LEFT, "a")),
            (30, SimCommand::Hand(HandCommand::Destroy(LEFT))),
            (33, SimCommand::History(HistoryCommand::Undo)),
        ],
    );
}

#[test]
fn objects_created_in_an_undone_segment_are_gone() {
    assert_same(
        &[
            (20, grasp(LEFT, "a")),
            (50, SimCommand::Hand(HandCommand::Release(LEFT))),
        ],
        &[
            (20, grasp(LEFT, "a")),
            (50, SimCommand::Hand(HandCommand::Release(LEFT))),
            (10, scene(&["a", "new", "newer"])),
            (10, grasp(RIGHT, "new")),
            (30, SimCommand::History(HistoryCommand::Undo)),
            (5, SimCommand::History(HistoryCommand::Undo)),
            (0, SimCommand::Hand(HandCommand::Release(LEFT))),
        ],
    );
}

#[test]
fn all_segments_can_be_undone() {
    assert_same(
        &[],
        &[
            (20, grasp(LEFT, "a")),
            (20, grasp(RIGHT, "bb")),
            (20, SimCommand::Hand(HandCommand::Destroy(RIGHT))),
            (20, SimCommand::Hand(HandCommand::Release(LEFT))),
            (20, SimCommand::History(HistoryCommand::Undo)),
            (20, SimCommand::History(HistoryCommand::Undo)),
            (20, SimCommand::History(HistoryCommand::Undo)),
            (20, SimCommand::History(HistoryCommand::Undo)),
        ],
    );
}

#[test]
fn a_redone_segment_was_never_undone() {
    let grasped_and_destroyed = [
        (20, grasp(LEFT, "a")),
        (30, SimCommand::Hand(HandCommand::Destroy(LEFT))),
    ];
    for (before_undo, before_redo) in [(1, 1), (1, 0), (47, 40), (15, 100)] {
        let redone = [
            &grasped_and_destroyed[..],
            &[
                (before_undo, SimCommand::History(HistoryCommand::Undo)),
                (before_redo, SimCommand::History(HistoryCommand::Redo)),
            ],
        ];
        // The tick in which the command to undo was given comes again with the redo.
        assert_same(&grasped_and_destroyed, &redone.concat());
    }
}

#[test]
fn several_segments_are_redone_in_their_order() {
    let segments = [
        (20, grasp(LEFT, "a")),
        (20, SimCommand::Hand(HandCommand::Destroy(LEFT))),
        (20, grasp(LEFT, "bb")),
    ];
    let turned = [
        (20, SimCommand::History(HistoryCommand::Undo)),
        (25, SimCommand::History(HistoryCommand::Undo)),
        (30, SimCommand::History(HistoryCommand::Undo)),
        (35, SimCommand::History(HistoryCommand::Redo)),
        (0, SimCommand::History(HistoryCommand::Redo)),
        (15, SimCommand::History(HistoryCommand::Redo)),
    ];
    assert_same(&segments, &[&segments[..], &turned].concat());
    assert_same(
        &segments[..2],
        &[
            &segments[..],
            &turned,
            &[(9, SimCommand::History(HistoryCommand::Undo))],
        ]
        .concat(),
    );
}

#[test]
fn a_new_segment_takes_the_place_of_the_undone_one() {
    assert_same(
        &[
            (20, grasp(RIGHT, "bb")),
            (40, SimCommand::Hand(HandCommand::Release(RIGHT))),
        ],
        &[
            (20, grasp(LEFT, "a")),
            (30, SimCommand::History(HistoryCommand::Undo)),
            (0, grasp(RIGHT, "bb")),
            (40, SimCommand::History(HistoryCommand::Redo)),
            (0, SimCommand::Hand(HandCommand::Release(RIGHT))),
        ],
    );
}

#[test]
fn an_undone_grasp_out_of_the_other_hand_is_a_release() {
    assert_same(
        &[
            (20, grasp(RIGHT, "a")),
            (20, SimCommand::Hand(HandCommand::Release(RIGHT))),
        ],
        &[
            (20, grasp(RIGHT, "a")),
            (20, grasp(LEFT, "a")),
            (20, SimCommand::History(HistoryCommand::Undo)),
        ],
    );
    let handed_over = [(20, grasp(RIGHT, "a")), (20, grasp(LEFT, "a"))];
    let redone = [
        (20, SimCommand::History(HistoryCommand::Undo)),
        (20, SimCommand::History(HistoryCommand::Redo)),
    ];
    assert_same(&handed_over, &[&handed_over[..], &redone].concat());
}

#[test]
fn undo_works_while_paused() {
    assert_same(
        &[
            (20, SimCommand::Clock(ClockCommand::SetPaused(true))),
            (5, SimCommand::Clock(ClockCommand::SetPaused(false))),
        ],
        &[
            (20, grasp(LEFT, "a")),
            (20, SimCommand::Clock(ClockCommand::SetPaused(true))),
            (5, SimCommand::History(HistoryCommand::Undo)),
            (5, SimCommand::Clock(ClockCommand::SetPaused(false))),
        ],
    );
}

#[test]
fn undone_segments_are_kept_until_they_cannot_be_redone() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["a"])),
            (1, SimCommand::Recording(RecordingCommand::Start)),
            (20, grasp(LEFT, "a")),
            (20, SimCommand::History(HistoryCommand::Undo)),
        ],
    );
    let undone = place.demo().join(".undone/1");
    for file in ["1.txt", "1", "session.jsonl", "states.csv"] {
        assert!(undone.join(file).exists(), "{file} is not kept");
    }
    run(&mut app, &[(5, grasp(LEFT, "a"))]);
    assert!(!place.demo().join(".undone").exists());
    run(&mut app, &[(5, SimCommand::History(HistoryCommand::Undo))]);
    assert!(undone.exists());
    run(
        &mut app,
        &[(5, SimCommand::Recording(RecordingCommand::Finish))],
    );
    assert!(!place.demo().join(".undone").exists());
}

#[test]
fn an_undo_without_a_segment_is_survived() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["a"])),
            (1, SimCommand::Recording(RecordingCommand::Start)),
        ],
    );
    let cause = CommandId(9);
    app.world_mut()
        .write_message(SimFact::History(HistoryFact::Undone { cause }));
    app.world_mut()
        .write_message(SimFact::History(HistoryFact::Redone { cause }));
    run(
        &mut app,
        &[(20, SimCommand::Recording(RecordingCommand::Finish))],
    );
    assert_eq!(place.frames(0), [0, 1, 2]);
}
