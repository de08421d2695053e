//! The program that demonstrations mean.

use tabletop_user::OtherProgram;

use super::*;

const PROGRAM: &str = "Put every red block into the blue box.";
const OTHER: &str = "Put every block into the blue box.";

fn taught() -> Harness<'static, Desk> {
    let mut desk = Desk::new(TimelineStage::Finished);
    desk.task = ShownTask {
        folder: "demo".into(),
        steps: vec![ShownStep::default()],
        ..default()
    };
    desk.taught = TaughtProgram {
        sentences: PROGRAM.into(),
        demonstrations: 1,
        others: vec![OtherProgram {
            sentences: OTHER.into(),
            differs: "if there is another one like the green block".into(),
        }],
        untouched: vec!["Not moved, but of every block: Green.".into()],
        ..default()
    };
    let mut harness = Harness::builder()
        .with_size(vec2(680.0, 760.0))
        .build_ui_state(Desk::show, desk);
    harness.run();
    harness
}

#[test]
fn the_program_is_shown_with_what_is_open() {
    let harness = taught();
    for text in [
        PROGRAM,
        "From one demonstration; what is open:",
        "Not moved, but of every block: Green.",
        &format!("Or 1: {OTHER}"),
        "It differs if there is another one like the green block.",
    ] {
        assert!(harness.query_by_label(text).is_some(), "{text}");
    }
}

#[test]
fn questions_are_shown_and_answered() {
    let mut harness = taught();
    for (name, order) in [
        ("Let the robot do this", TaskOrder::Perform),
        ("Show it again", TaskOrder::ShowAgain),
        ("Show it here: 1", TaskOrder::Ask(1)),
        ("This is meant: 1", TaskOrder::Answer(1)),
    ] {
        assert_eq!(click(&mut harness, name), [Request::Task(order)], "{name}");
    }
    harness.state_mut().taught.is_awaiting = true;
    harness.run();
    let awaiting = "Show it once more: the next recording counts, too.";
    assert!(harness.query_by_label(awaiting).is_some());
    assert_eq!(click(&mut harness, "Show it again"), []);
}

#[test]
fn what_no_program_explains_is_said_and_done_by_nobody() {
    let mut harness = taught();
    let fault = "no program explains all 2 demonstrations";
    harness.state_mut().taught = TaughtProgram {
        demonstrations: 2,
        fault: Some(fault.into()),
        ..default()
    };
    harness.run();
    assert!(harness.query_by_label(fault).is_some());
    assert_eq!(click(&mut harness, "Let the robot do this"), []);
    harness.state_mut().taught = TaughtProgram::default();
    harness.run();
    assert!(harness.query_by_label("What is meant").is_none());
}
