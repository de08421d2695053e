//! A recording in which something was undone is, byte for byte, one in which it was never done.

use std::collections::BTreeMap;

use tabletop_core::{Hand, SimCommand, SimFact, SimTick};

use crate::stage::{Place, TurnTells, app, grasp, run, scene};

const LEFT: Hand = Hand::Left;
const RIGHT: Hand = Hand::Right;

/// Records a script whose commands come after so many ticks, until the clock stands at 200.
fn record(tells: TurnTells, script: &[(u64, SimCommand)]) -> BTreeMap<String, Vec<u8>> {
    let place = Place::new();
    let mut app = app(&place);
    app.insert_resource(tells);
    run(
        &mut app,
        &[
            (0, scene(&["a", "bb", "still"])),
            (3, SimCommand::StartRecording),
        ],
    );
    run(&mut app, script);
    let now = app.world().resource::<SimTick>().0;
    run(&mut app, &[(200 - now, SimCommand::FinishRecording)]);
    place.tree()
}

fn assert_same(done: &[(u64, SimCommand)], undone: &[(u64, SimCommand)]) {
    for tells in [TurnTells::Before, TurnTells::After, TurnTells::Nothing] {
        let expected = record(tells, done);
        let found = record(tells, undone);
        assert_eq!(
            expected.keys().collect::<Vec<_>>(),
            found.keys().collect::<Vec<_>>(),
            "{tells:?}"
        );
        for (name, content) in expected {
            assert!(
                content == found[&name],
                "{tells:?}: {name} is\n{}\ninstead of\n{}",
                String::from_utf8_lossy(&found[&name]),
                String::from_utf8_lossy(&content)
            );
        }
    }
}

#[test]
fn an_undone_grasp_was_never_made() {
    assert_same(
        &[(20, SimCommand::SelectHand(LEFT))],
        &[
            (20, SimCommand::SelectHand(LEFT)),
            (3, grasp(LEFT, "a")),
            (47, SimCommand::Undo),
        ],
    );
}

#[test]
fn commands_of_the_tick_before_the_grasp_stay() {
    assert_same(
        &[(20, scene(&["a", "c"])), (0, SimCommand::SelectHand(LEFT))],
        &[
            (20, scene(&["a", "c"])),
            (0, SimCommand::SelectHand(LEFT)),
            (0, grasp(LEFT, "a")),
            (47, SimCommand::Undo),
        ],
    );
}

#[test]
fn scenes_are_set_before_hands_act_whatever_the_order_of_the_commands() {
    assert_same(
        &[(20, scene(&["a", "c"]))],
        &[
            (20, grasp(LEFT, "a")),
            (0, scene(&["a", "c"])),
            (47, SimCommand::Undo),
        ],
    );
}

#[test]
fn hands_act_after_the_clock_was_turned_whatever_the_order_of_the_commands() {
    assert_same(
        &[(20, grasp(RIGHT, "bb"))],
        &[
            (20, grasp(LEFT, "a")),
            (10, SimCommand::Release(LEFT)),
            (30, grasp(RIGHT, "bb")),
            (0, SimCommand::Undo),
            (0, SimCommand::Undo),
        ],
    );
}

#[test]
fn an_undone_destroy_brings_the_object_back_without_a_line() {
    assert_same(
        &[(20, grasp(LEFT, "a"))],
        &[
            (20, grasp(LEFT, "a")),
            (30, SimCommand::Destroy(LEFT)),
            (33, SimCommand::Undo),
        ],
    );
}

#[test]
fn what_was_created_in_an_undone_segment_is_gone() {
    assert_same(
        &[(20, grasp(LEFT, "a")), (50, SimCommand::Release(LEFT))],
        &[
            (20, grasp(LEFT, "a")),
            (50, SimCommand::Release(LEFT)),
            (10, scene(&["a", "new", "newer"])),
            (10, grasp(RIGHT, "new")),
            (30, SimCommand::Undo),
            (5, SimCommand::Undo),
            (0, SimCommand::Release(LEFT)),
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
            (20, SimCommand::Destroy(RIGHT)),
            (20, SimCommand::Release(LEFT)),
            (20, SimCommand::Undo),
            (20, SimCommand::Undo),
            (20, SimCommand::Undo),
            (20, SimCommand::Undo),
        ],
    );
}

#[test]
fn a_redone_segment_was_never_undone() {
    let grasped_and_destroyed = [(20, grasp(LEFT, "a")), (30, SimCommand::Destroy(LEFT))];
    for (before_undo, before_redo) in [(1, 1), (1, 0), (47, 40), (15, 100)] {
        let redone = [
            &grasped_and_destroyed[..],
            &[
                (before_undo, SimCommand::Undo),
                (before_redo, SimCommand::Redo),
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
        (20, SimCommand::Destroy(LEFT)),
        (20, grasp(LEFT, "bb")),
    ];
    let turned = [
        (20, SimCommand::Undo),
        (25, SimCommand::Undo),
        (30, SimCommand::Undo),
        (35, SimCommand::Redo),
        (0, SimCommand::Redo),
        (15, SimCommand::Redo),
    ];
    assert_same(&segments, &[&segments[..], &turned].concat());
    assert_same(
        &segments[..2],
        &[&segments[..], &turned, &[(9, SimCommand::Undo)]].concat(),
    );
}

#[test]
fn a_new_segment_takes_the_place_of_the_undone_one() {
    assert_same(
        &[(20, grasp(RIGHT, "bb")), (40, SimCommand::Release(RIGHT))],
        &[
            (20, grasp(LEFT, "a")),
            (30, SimCommand::Undo),
            (0, grasp(RIGHT, "bb")),
            (40, SimCommand::Redo),
            (0, SimCommand::Release(RIGHT)),
        ],
    );
}

#[test]
fn an_undone_grasp_out_of_the_other_hand_is_a_release() {
    assert_same(
        &[(20, grasp(RIGHT, "a")), (20, SimCommand::Release(RIGHT))],
        &[
            (20, grasp(RIGHT, "a")),
            (20, grasp(LEFT, "a")),
            (20, SimCommand::Undo),
        ],
    );
    let handed_over = [(20, grasp(RIGHT, "a")), (20, grasp(LEFT, "a"))];
    let redone = [(20, SimCommand::Undo), (20, SimCommand::Redo)];
    assert_same(&handed_over, &[&handed_over[..], &redone].concat());
}

#[test]
fn undo_works_while_paused() {
    assert_same(
        &[
            (20, SimCommand::SetPaused(true)),
            (5, SimCommand::SetPaused(false)),
        ],
        &[
            (20, grasp(LEFT, "a")),
            (20, SimCommand::SetPaused(true)),
            (5, SimCommand::Undo),
            (5, SimCommand::SetPaused(false)),
        ],
    );
}

#[test]
fn what_is_undone_is_kept_until_it_cannot_be_redone() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[
            (0, scene(&["a"])),
            (1, SimCommand::StartRecording),
            (20, grasp(LEFT, "a")),
            (20, SimCommand::Undo),
        ],
    );
    let undone = place.demo().join(".undone/1");
    for file in ["1.txt", "1", "session.jsonl", "states.csv"] {
        assert!(undone.join(file).exists(), "{file} is not kept");
    }
    run(&mut app, &[(5, grasp(LEFT, "a"))]);
    assert!(!place.demo().join(".undone").exists());
    run(&mut app, &[(5, SimCommand::Undo)]);
    assert!(undone.exists());
    run(&mut app, &[(5, SimCommand::FinishRecording)]);
    assert!(!place.demo().join(".undone").exists());
}

#[test]
fn an_undo_of_what_was_never_begun_is_survived() {
    let place = Place::new();
    let mut app = app(&place);
    run(
        &mut app,
        &[(0, scene(&["a"])), (1, SimCommand::StartRecording)],
    );
    app.world_mut().write_message(SimFact::Undone);
    app.world_mut().write_message(SimFact::Redone);
    run(&mut app, &[(20, SimCommand::FinishRecording)]);
    assert_eq!(place.frames(0), [0, 1, 2]);
}
