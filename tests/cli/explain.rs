//! `tabletop explain` and `tabletop require`: tasks of demonstrations.

use std::{
    fs,
    path::{Path, PathBuf},
};

use serde_json::Value;

use crate::support::{
    place, record, record_shipped, replays_to_the_same_bytes, scenario, shipped, stderr, stdout,
    tabletop,
};

fn recorded(scenario: &str) -> String {
    record_shipped(scenario, &format!("explain_{scenario}"))
}

/// Records these steps on the default table: a red block at the right, turned by -15°, a green one at the left, turned by 45°.
fn shown(name: &str, steps: &str) -> String {
    let steps = format!("WaitUntilRest(5), Start, {steps}\nWaitUntilRest(5), Finish,");
    let file = scenario(&format!("explain_{name}.ron"), &steps);
    record(file.to_str().unwrap(), &format!("explain_{name}"))
}

/// Output of `explain`, line by line.
fn explained(demo: &str) -> Vec<String> {
    let output = tabletop(&["explain", demo]);
    assert_eq!(stderr(&output), "");
    stdout(&output).lines().map(str::to_owned).collect()
}

fn means(demo: &str, expected: &[&str]) {
    assert_eq!(explained(demo), expected);
}

#[test]
fn a_stack_is_understood() {
    means(
        &recorded("stack_two_blocks"),
        &["1. Put the red block on the green block."],
    );
    means(
        &recorded("stack_three"),
        &[
            "1. Put the green block on the blue block.",
            "2. Put the red block on the green block.",
        ],
    );
}

#[test]
fn grips_of_a_robot_are_understood_like_acts_of_hands() {
    let demo = recorded("robot_stack");
    means(
        &demo,
        &[
            "1. Put the red block on the green block.",
            "2. Put the blue block on the red block.",
        ],
    );
    let json = stdout(&tabletop(&["explain", &demo, "--json"]));
    let json: Value = serde_json::from_str(&json).unwrap();
    let hands = &json["task"]["steps"][0]["hands"];
    assert_eq!(*hands, serde_json::json!([{ "gripper": "right" }]));
}

#[test]
fn a_box_with_a_lid_is_opened_filled_and_closed() {
    means(
        &recorded("lidbox"),
        &[
            "1. Open the blue box.",
            "2. Put the yellow block into the blue box.",
            "3. Close the blue box.",
        ],
    );
}

#[test]
fn an_object_on_another_side_is_tipped() {
    means(
        &recorded("stand_up"),
        &[
            "1. Stand the red block up on the table at (-2, -2.5).",
            "2. Lay the green cylinder down on the table at (2, -2.5). (at any time)",
        ],
    );
    means(
        &recorded("turn_over"),
        &["1. Turn the blue box over and put it on the table at (0, -2.5)."],
    );
}

#[test]
fn a_swap_needs_a_third_place() {
    means(
        &recorded("swap"),
        &[
            "1. Put the red block aside.",
            "2. Put the blue block where the red block was.",
            "3. Put the red block where the blue block was.",
        ],
    );
}

#[test]
fn upper_blocks_of_a_wall_stand_on_lower_ones() {
    means(
        &recorded("wall"),
        &[
            "1. Put the green block on the table at (0, -2.5).",
            "2. Put the red block to the left of the green block.",
            "3. Put the yellow block to the right of the green block. (after 1)",
            "4. Put the orange block on the green block and the red block. (after 2)",
            "5. Put the blue block on the green block and the yellow block. (after 3)",
        ],
    );
}

#[test]
fn a_letter_is_built_from_its_first_bar_on() {
    means(
        &recorded("letter_u"),
        &[
            "1. Put the cyan block on the table at (0, -4.2).",
            "2. Put the blue block behind and to the left of the cyan block.",
            "3. Put the green block behind and to the right of the cyan block. (after 1)",
        ],
    );
}

#[test]
fn no_move_of_hanoi_is_a_detour() {
    means(
        &recorded("hanoi"),
        &[
            "1. Put Small around PegC.",
            "2. Put Middle around PegB.",
            "3. Put Small around PegB, on Middle.",
            "4. Put Big around PegC.",
            "5. Put Small around PegA.",
            "6. Put Middle around PegC, on Big.",
            "7. Put Small around PegC, on Middle.",
        ],
    );
}

/// The events of a recording alone, as far as they are `meant`: all that there is of a recording of the original program.
fn original(demo: &str, name: &str, meant: impl Fn(&str) -> bool) -> String {
    let folder = place(name);
    fs::create_dir(&folder).unwrap();
    for number in 0.. {
        let file = format!("{number}.txt");
        let Ok(text) = fs::read_to_string(Path::new(demo).join(&file)) else {
            break;
        };
        let lines = text.lines().filter(|line| meant(line));
        let kept: String = lines.map(|line| format!("{line}\n")).collect();
        fs::write(folder.join(file), kept).unwrap();
    }
    folder.to_str().unwrap().to_owned()
}

#[test]
fn a_recording_of_the_original_program_is_understood() {
    for scenario in ["stack_three", "swap", "wall"] {
        let demo = record_shipped(scenario, &format!("explain_events_{scenario}"));
        let events = original(&demo, &format!("explain_original_{scenario}"), |_| true);
        means_the_same(&demo, &events);
    }
}

#[test]
fn acts_of_hands_are_seen_in_the_poses() {
    for scenario in ["stack_three", "swap", "wall"] {
        let demo = record_shipped(scenario, &format!("explain_acts_{scenario}"));
        let is_pose = |line: &str| !line.contains(",grasp,") && !line.contains(",release,");
        let poses = original(&demo, &format!("explain_poses_{scenario}"), is_pose);
        means_the_same(&demo, &poses);
    }
}

fn means_the_same(demo: &str, other: &str) {
    let steps = |demo: &str| -> Vec<_> {
        let lines = explained(demo).into_iter();
        lines.filter(|line| !line.starts_with("Does")).collect()
    };
    assert_eq!(steps(other), steps(demo), "{other}");
}

#[test]
fn five_rings_need_thirty_one_moves() {
    let moves = explained(&recorded("hanoi_five"));
    assert_eq!(moves.len(), 31, "{moves:?}");
    assert_eq!(moves[0], "1. Put the red ring around PegC.");
    assert_eq!(moves[15], "16. Put the blue ring around PegC.");
    assert_eq!(
        moves[30],
        "31. Put the red ring around PegC, on the orange ring."
    );
}

#[test]
fn a_hand_over_is_one_step() {
    means(
        &recorded("hand_over"),
        &[
            "1. Hand the red block from the left hand to the right hand and put it on the blue block.",
            "Does not matter: the red block went from hand to hand (0.55 to 2.92 s).",
        ],
    );
}

/// A block that is lifted from its place to another one and put down there.
fn carry(id: &str, from: (f32, f32), to: (f32, f32)) -> String {
    let ((a, b), (x, y)) = (from, to);
    format!(
        "Grasp({id:?}), Glide(to: ({a}, {b}, 4), seconds: 0.3), Glide(to: ({x}, {y}, 4), seconds: 0.3), \
         Glide(to: ({x}, {y}, 1), seconds: 0.3), Release, WaitUntilRest(3),\n"
    )
}

const RED: (f32, f32) = (2.0, 0.0);
const GREEN: (f32, f32) = (-2.0, 0.0);

#[test]
fn moving_an_object_away_and_back_is_a_detour() {
    let away = carry("RedBlock", RED, (6.0, 2.0));
    let back = carry("RedBlock", (6.0, 2.0), RED);
    let lines = explained(&shown("back", &(away.clone() + &back)));
    assert_eq!(lines[0], "Nothing is moved for good.");
    assert!(
        lines[1].starts_with("Does not matter: the red block was put down on the way"),
        "{lines:?}"
    );
    assert!(
        lines[2].starts_with("Does not matter: the red block was moved away and back"),
        "{lines:?}"
    );

    // A stack that was taken apart to turn the object below, and built again.
    let onto_green = "Grasp(\"RedBlock\"), Glide(to: (2, 0, 5), seconds: 0.3), Glide(to: (-2, 0, 5), seconds: 0.3), \
        Glide(to: (-2, 0, 3), seconds: 0.3), Release, WaitUntilRest(3),\n";
    let turn = "Grasp(\"GreenBlock\"), Turn(axis: Z, degrees: 30), Wait(0.5), Release, WaitUntilRest(3),\n";
    let apart = carry("RedBlock", GREEN, (2.0, 0.0));
    let lines = explained(&shown(
        "rebuilt",
        &[onto_green, &apart, turn, onto_green].concat(),
    ));
    assert_eq!(
        lines[..2],
        [
            "1. Turn the green block by 30° counterclockwise.",
            "2. Put the red block on the green block.",
        ]
    );
}

#[test]
fn a_place_on_the_way_is_left_out() {
    let steps = carry("RedBlock", RED, (6.0, 2.0))
        + &carry("GreenBlock", GREEN, (-6.0, 0.0))
        + &carry("RedBlock", (6.0, 2.0), (6.0, -3.0));
    let lines = explained(&shown("way", &steps));
    assert_eq!(
        lines[..2],
        [
            "1. Put the green block on the table at (-6, 0).",
            "2. Put the red block on the table at (6, -3). (at any time)",
        ]
    );
    assert!(
        lines[2].starts_with("Does not matter: the red block was put down on the way"),
        "{lines:?}"
    );
}

#[test]
fn turning_holding_removing_and_keeping_are_distinguished() {
    means(
        &shown(
            "turned",
            "Grasp(\"RedBlock\"), Turn(axis: Z, degrees: 40), Wait(0.5), Release, WaitUntilRest(3),
             Grasp(\"GreenBlock\"), Wait(0.5), Release,",
        ),
        &[
            "1. Turn the red block by 40° counterclockwise.",
            "Does not matter: the green block was held in its place (1.13 to 1.65 s).",
        ],
    );
    means(
        &shown("removed", "Grasp(\"GreenBlock\"), Destroy,"),
        &["1. Remove the green block."],
    );
    means(
        &shown(
            "kept",
            "Grasp(\"GreenBlock\"), Glide(to: (-2, 0, 4), seconds: 1),",
        ),
        &["1. Pick up the green block."],
    );
    // A cube that is turned by 90° looks as before.
    let lines = explained(&shown(
        "quarter",
        "Grasp(\"RedBlock\"), Glide(to: (2, 0, 4), seconds: 0.3), Turn(axis: Z, degrees: 90), Glide(to: (2, 0, 1), seconds: 0.3), Release,",
    ));
    assert_eq!(lines[0], "Nothing is moved for good.");
}

#[test]
fn an_object_that_still_falls_at_the_end_was_put_nowhere() {
    for wait in ["", "Wait(0.1),"] {
        let steps = format!(
            "WaitUntilRest(5), Start, Grasp(\"Red\"), Glide(to: (-3, -3, 8), seconds: 0.5), \
             Glide(to: (3, -2.5, 8), seconds: 0.5), WaitUntilThere(2), Release, {wait} Finish,"
        );
        let file = place("explain_let_go.ron");
        let setup = "shipped:tablesetup/blocks.xml";
        fs::write(&file, format!("(setup: {setup:?}, steps: [{steps}])")).unwrap();
        let demo = record(file.to_str().unwrap(), "explain_let_go");
        means(&demo, &["1. Let go of the red block in the air."]);
        let output = tabletop(&["imitate", &demo]);
        assert_eq!(output.status.code(), Some(1));
        let told = stdout(&output) + &stderr(&output);
        assert!(told.contains("does not show where it belongs"), "{told}");
    }
}

#[test]
fn a_pushed_object_is_mentioned() {
    let lines = explained(&shown(
        "pushed",
        "Grasp(\"RedBlock\"), Glide(to: (-2, 0, 1), seconds: 1), WaitUntilThere(2), Release,",
    ));
    assert_eq!(lines.len(), 2, "{lines:?}");
    assert!(
        lines[1]
            .starts_with("- On its way, the red block moves the green block by 2.8, to (-4.8, "),
        "{lines:?}"
    );
    // One that is carried along is not.
    let lines = explained(&shown(
        "carried_along",
        "Grasp(\"RedBlock\"), Glide(to: (2, 0, 5), seconds: 0.3), Glide(to: (-2, 0, 5), seconds: 0.3), \
         Glide(to: (-2, 0, 3), seconds: 0.3), Release, WaitUntilRest(3), \
         Grasp(\"GreenBlock\"), Glide(to: (-4, 0, 1), seconds: 2), Release,",
    ));
    assert_eq!(lines.len(), 2, "{lines:?}");
    assert!(
        lines[1].starts_with("2. Move the green block with the red block on it to"),
        "{lines:?}"
    );
}

/// A block that is held and put down again this far to the right.
fn nudge(from: f32, by: f32) -> String {
    format!(
        "Grasp(\"RedBlock\"), Glide(to: ({}, 0, 1), seconds: 0.3), WaitUntilThere(1), Release, WaitUntilRest(3),\n",
        from + by
    )
}

#[test]
fn a_nudge_is_no_step_and_many_nudges_are_one() {
    let lines = explained(&shown("nudge", &nudge(2.0, 0.14)));
    assert_eq!(lines[0], "Nothing is moved for good.");
    assert!(lines[1].contains("was held in its place"), "{lines:?}");

    let nudges: String = [2.0, 2.14, 2.28].map(|from| nudge(from, 0.14)).concat();
    let lines = explained(&shown("nudges", &nudges));
    assert_eq!(lines[0], "1. Put the red block on the table at (2.4, 0).");

    let next = nudge(2.0, 0.14) + &carry("RedBlock", (2.14, 0.0), (6.0, 2.0));
    let lines = explained(&shown("nudged_first", &next));
    assert_eq!(lines[0], "1. Put the red block on the table at (6, 2).");
    assert!(lines[1].contains("was held in its place"), "{lines:?}");
}

#[test]
fn a_round_ring_is_put_around_a_round_peg() {
    means(
        &recorded("hanoi_rings"),
        &[
            "1. Put the red ring around PegC.",
            "2. Put the green ring around PegB.",
            "3. Put the red ring around PegB, on the green ring.",
            "4. Put the blue ring around PegC.",
            "5. Put the red ring around PegA.",
            "6. Put the green ring around PegC, on the blue ring.",
            "7. Put the red ring around PegC, on the green ring.",
        ],
    );
}

#[test]
fn both_hands_work_at_the_same_time() {
    let steps = "With(Left, Grasp(\"GreenBlock\")), With(Right, Grasp(\"RedBlock\")),
        With(Left, Glide(to: (-2, 0, 4), seconds: 0.3)), With(Right, Glide(to: (2, 0, 4), seconds: 0.3)),
        With(Left, Glide(to: (-7, 0, 1), seconds: 1)), With(Left, Release),
        With(Right, Glide(to: (7, 0, 1), seconds: 1)), With(Right, Release),";
    means(
        &shown("both", steps),
        &[
            "1. Put the green block on the table at (-7, 0).",
            "2. Meanwhile, put the red block on the table at (7, 0). (at any time)",
        ],
    );
}

#[test]
fn undone_steps_are_not_explained() {
    let steps = carry("GreenBlock", GREEN, (-6.0, 0.0))
        + &carry("RedBlock", RED, (6.0, 2.0))
        + "Undo, Undo,";
    means(
        &shown("undone", &steps),
        &["1. Put the green block on the table at (-6, 0)."],
    );
}

fn require(demo: &str, arguments: &[&str]) -> Result<Vec<String>, String> {
    let output = tabletop(&[&["require", demo], arguments].concat());
    match output.status.success() {
        true => Ok(stdout(&output).lines().map(str::to_owned).collect()),
        false => Err(stderr(&output)),
    }
}

fn bound(demo: &str, setup: &Path) -> Result<Vec<String>, String> {
    let output = tabletop(&["explain", demo, "--setup", setup.to_str().unwrap()]);
    let lines = stdout(&output);
    let taken = lines
        .lines()
        .filter(|line| line.contains(" is "))
        .map(str::to_owned);
    match output.status.success() {
        true => Ok(taken.collect()),
        false => Err(stderr(&output)),
    }
}

/// A table with unit cubes of these colours, `a`, `b`, ...
fn table(name: &str, colors: &[&str]) -> PathBuf {
    let blocks = colors
        .iter()
        .zip('a'..)
        .zip((-8..).step_by(2))
        .map(|((color, id), x)| {
            format!("<block id=\"{id}\" location=\"({x},0,0.5)\" color=\"{color}\"/>")
        });
    let path = place(name);
    let namespace = "http://synapse.cs.umd.edu/tabletop-xml";
    let blocks: String = blocks.collect();
    fs::write(
        &path,
        format!("<tabletop xmlns=\"{namespace}\">{blocks}</tabletop>"),
    )
    .unwrap();
    path
}

#[test]
fn requirements_are_kept_and_reported() {
    let demo = record_shipped("stack_three", "explain_required");
    let as_shown = [
        "Green (moved in step 1): as it was shown",
        "Blue (never moved): as it was shown",
        "Red (moved in step 2): as it was shown",
    ];
    assert_eq!(require(&demo, &[]).unwrap(), as_shown);
    let required = require(&demo, &["--step", "2", "color=red", "shape"]).unwrap();
    assert_eq!(required[2], "Red (moved in step 2): color=red shape=block");
    let required = require(&demo, &["--step", "1", "--other", "any"]).unwrap();
    assert_eq!(required[1], "Blue (never moved): any");
    means(
        &demo,
        &[
            "1. Put the green block on any object.",
            "2. Put the red block on the green block.",
        ],
    );
    // Requirements do not disturb a replay.
    replays_to_the_same_bytes(&demo);

    require(&demo, &["--step", "2", "--remove", "shape"]).unwrap();
    assert_eq!(
        explained(&demo)[1],
        "2. Put the red object on the green block."
    );
    require(&demo, &["--step", "2", "--remove"]).unwrap();
    assert_eq!(
        require(&demo, &["--step", "1", "--other", "--remove"]).unwrap(),
        as_shown
    );
    assert!(!PathBuf::from(&demo).join("task.json").exists());

    for (arguments, problem) in [
        (
            &["--step", "3", "any"][..],
            "the demonstration has no step 3",
        ),
        (&["--step", "1", "radius"], "`radius` is no requirement"),
        (
            &["--step", "1", "color=vermilion"],
            "`vermilion` is not a colour",
        ),
        (
            &["--step", "1", "--remove", "color"],
            "Green: color is required of it",
        ),
    ] {
        let error = require(&demo, arguments).unwrap_err();
        assert!(error.contains(problem), "{error}");
    }
}

#[test]
fn objects_of_another_table_take_the_roles() {
    let demo = record_shipped("stack_three", "explain_bound");
    let same = shipped("tablesetup", "blocks.xml");
    let by_id = [
        "The green block is Green.",
        "The blue block is Blue.",
        "The red block is Red.",
    ];
    assert_eq!(bound(&demo, &same).unwrap(), by_id);

    // Without these ids: shape and size, preferably the colour.
    let other = table(
        "explain_other.xml",
        &["red", "pink", "green", "blue", "red"],
    );
    let by_color = [
        "The green block is c.",
        "The blue block is d.",
        "The red block is a.",
    ];
    assert_eq!(bound(&demo, &other).unwrap(), by_color);

    // Requirements decide, not ids.
    require(&demo, &["--step", "2", "color=pink"]).unwrap();
    assert_eq!(bound(&demo, &other).unwrap()[2], "The pink object is b.");
    let error = bound(&demo, &same).unwrap_err();
    assert!(error.contains("step 2: nothing on the table can be the pink object: color pink is required, and Red has color #ff0000"), "{error}");

    // Two roles that only one object can take.
    require(&demo, &["--step", "1", "color=pink"]).unwrap();
    let error = bound(&demo, &other).unwrap_err();
    assert!(
        error.contains(
            "the first pink object and the second pink object need an object each, and only b can be either"
        ),
        "{error}"
    );

    let error = bound(&demo, &shipped("tablesetup", "hanoi.xml")).unwrap_err();
    assert!(error.contains("has color"), "{error}");
}

#[test]
fn json_tells_all_of_it() {
    let demo = recorded("swap");
    let output = tabletop(&["explain", &demo, "--json"]);
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    let step = &json["task"]["steps"][1];
    assert_eq!(
        step["sentence"],
        "Put the blue block where the red block was."
    );
    assert_eq!(step["after"], serde_json::json!([1]));
    assert_eq!(step["relations"][0]["kind"], "in-place-of");
    assert_eq!(step["goal"]["reference"]["kind"], "place-of");
    assert_eq!(step["goal"]["freedom"]["orientations"], 24);
    assert_eq!(json["task"]["roles"][0]["id"], "Red");
}

#[test]
fn a_folder_without_a_recording_is_reported() {
    let output = tabletop(&["explain", "tablesetup"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("session.jsonl"),
        "{}",
        stderr(&output)
    );
}
