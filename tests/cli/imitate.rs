//! `tabletop imitate`: the robot imitates demonstrations.

use crate::support::{place, stderr, stdout, tabletop};

fn recorded(scenario: &str) -> String {
    let demo = place(&format!("imitate_{scenario}"));
    let demo = demo.to_str().unwrap().to_owned();
    let scenario = format!("shipped:scenarios/{scenario}.ron");
    let output = tabletop(&["run", &scenario, "--record", &demo, "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    demo
}

fn is_done(demo: &str, options: &[&str]) {
    let output = tabletop(&[&["imitate", demo], options].concat());
    let reported = stdout(&output) + &stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{reported}");
    assert!(reported.contains("Done: "), "{reported}");
}

#[test]
fn a_stack_is_built_where_the_blocks_are_now() {
    let demo = recorded("stack_three");
    is_done(&demo, &[]);
    for seed in ["1", "2", "3"] {
        is_done(&demo, &["--seed", seed]);
    }
}

#[test]
fn two_blocks_change_places() {
    is_done(&recorded("swap"), &["--seed", "1"]);
}

#[test]
fn a_letter_is_built() {
    is_done(&recorded("letter_u"), &["--seed", "1"]);
}

#[test]
fn a_wall_is_built() {
    is_done(&recorded("wall"), &["--seed", "1"]);
}

#[test]
fn a_chest_is_opened_filled_and_closed() {
    is_done(&recorded("chest"), &[]);
}

#[test]
fn the_red_block_is_put_on_the_blue_one_whichever_they_are() {
    let demo = recorded("red_on_blue");
    for requirement in [
        ["--step", "1", "color=red"].as_slice(),
        &["--step", "1", "--other", "color=blue"],
    ] {
        let output = tabletop(&[&["require", &demo], requirement].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    for seed in ["1", "2"] {
        is_done(&demo, &["--exchange-colors", "--seed", seed]);
    }
}

#[test]
fn motors_build_a_stack() {
    is_done(&recorded("stack_three"), &["--dynamic"]);
}

#[test]
fn rings_go_from_peg_to_peg() {
    is_done(&recorded("hanoi"), &[]);
}

#[test]
fn what_the_robot_does_can_be_replayed() {
    let demo = recorded("hand_over");
    let robot = place("imitate_replayed");
    let robot = robot.to_str().unwrap();
    is_done(&demo, &["--record", robot]);
    let output = tabletop(&["replay", robot, "--verify"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn trials_are_counted() {
    let output = tabletop(&[
        "imitate",
        &recorded("stack_three"),
        "--trials",
        "2",
        "--seed",
        "5",
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let table = stdout(&output);
    assert!(table.starts_with("done              2 of 2\n"), "{table}");
}

#[test]
fn what_cannot_be_done_is_reported_in_a_sentence() {
    // The blocks of the default table are as wide as the gripper opens.
    let output = tabletop(&["imitate", &recorded("stack_two_blocks")]);
    assert_eq!(output.status.code(), Some(1));
    let reported = stdout(&output);
    assert!(
        reported.contains("Step 1 failed (Put the red block on the green block.): RedBlock cannot be taken: no part of it fits between the fingers"),
        "{reported}"
    );
}

#[test]
fn a_lid_that_is_too_high_to_be_taken_from_above_is_taken_from_beside() {
    let output = tabletop(&["imitate", &recorded("lidbox")]);
    let told = stderr(&output);
    // The block lies where no arm reaches it.
    assert!(
        told.contains("2. Put the yellow block into the blue box."),
        "{told}"
    );
    assert!(!told.contains("1. Open the blue box. (again)"), "{told}");
}
