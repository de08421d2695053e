//! What is carried along: `explain`, `imitate` and `multiply` of things with something on them or in them.

use std::fs;

use crate::support::{place, record, stderr, stdout, tabletop};

const RED: &str = r#"<block id="Red" location="(-3,-3,0.3)" xspan="0.6" yspan="0.6" zspan="0.6" mass="0.2" color="red"/>"#;
const CAN: &str = r#"<cylinder id="Can" location="(0,-3,0.4)" rotation="(90,0,0)" radius="0.3" yspan="0.8" mass="0.2" color="green"/>"#;
const TRAY: &str = r#"<box id="Tray" location="(3,-3,0.25)" xspan="1.8" yspan="3" zspan="0.5" thickness="0.1" color="gray" mass="0.4"/>"#;
const BOX: &str = r#"<box id="Box" location="(3,-3,0.5)" xspan="1.5" yspan="1.5" zspan="1" thickness="0.1" color="blue" mass="0.4"/>"#;

/// Records these steps on a table with these objects.
fn shown(name: &str, objects: &[&str], steps: &str) -> String {
    let setup = place(&format!("loads_{name}.xml"));
    let namespace = "http://synapse.cs.umd.edu/tabletop-xml";
    let objects = objects.concat();
    let text =
        format!("<tabletop xmlns=\"{namespace}\" xspan=\"20\" yspan=\"12\">{objects}</tabletop>");
    fs::write(&setup, text).unwrap();
    let scenario = setup.with_extension("ron");
    let steps = format!("WaitUntilRest(3), Start, Select(Right), {steps} WaitUntilRest(5), Finish");
    fs::write(&scenario, format!("(setup: {setup:?}, steps: [{steps}])")).unwrap();
    record(scenario.to_str().unwrap(), &format!("loads_{name}"))
}

/// An object that is carried from one place to another, and put down at this height.
fn carried(id: &str, from: (f32, f32), to: (f32, f32), height: f32) -> String {
    let ((a, b), (x, y)) = (from, to);
    format!(
        "Grasp({id:?}), Glide(to: ({a}, {b}, 4), seconds: 0.7), Glide(to: ({x}, {y}, 4), seconds: 2), \
         Glide(to: ({x}, {y}, {height}), seconds: 1.2), WaitUntilThere(2), Release, WaitUntilRest(4), "
    )
}

fn means(demo: &str, expected: &[&str]) {
    let output = tabletop(&["explain", demo]);
    assert_eq!(stderr(&output), "");
    assert_eq!(stdout(&output).lines().collect::<Vec<_>>(), expected);
}

fn is_done(arguments: &[&str]) {
    let output = tabletop(arguments);
    let reported = stdout(&output) + &stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{reported}");
}

#[test]
fn a_tray_is_moved_with_what_is_on_it() {
    let steps = carried("Red", (-3.0, -3.0), (3.0, -3.8), 0.45)
        + &carried("Can", (0.0, -3.0), (3.0, -2.2), 0.55)
        + &carried("Tray", (3.0, -3.0), (-1.0, -4.0), 0.27);
    let demo = shown("tray", &[RED, CAN, TRAY], &steps);
    means(
        &demo,
        &[
            "1. Put the red block into the gray box.",
            "2. Put the green cylinder into the gray box. (at any time)",
            "3. Move the gray box with the green cylinder and the red block in it to (-1, -4). (after 1 and 2)",
        ],
    );
    for seed in ["1", "2"] {
        is_done(&["imitate", &demo, "--seed", seed]);
    }
}

#[test]
fn what_is_in_a_box_from_the_beginning_goes_along() {
    let inside = RED.replace("(-3,-3,0.3)", "(3,-3,0.4)");
    let steps = carried("Box", (3.0, -3.0), (-1.0, -4.0), 0.52);
    let demo = shown("boxed", &[&inside, BOX], &steps);
    means(
        &demo,
        &["1. Move the blue box with the red block in it to (-1, -4)."],
    );
    is_done(&["imitate", &demo, "--seed", "1"]);
    let many = place("loads_boxed_many");
    let many = many.to_str().unwrap();
    is_done(&["multiply", &demo, "--count", "3", "--out", many]);
}

#[test]
fn a_block_is_moved_with_the_block_on_it() {
    let cube = |id: &str, z: f32, color: &str| {
        format!("<block id=\"{id}\" location=\"(3,-3,{z})\" color=\"{color}\"/>")
    };
    let objects = [cube("Red", 1.5, "red"), cube("Green", 0.5, "green")];
    let steps = carried("Green", (3.0, -3.0), (-1.0, -4.0), 0.52);
    let demo = shown("stack", &objects.each_ref().map(String::as_str), &steps);
    means(
        &demo,
        &["1. Move the green block with the red block on it to (-1, -4)."],
    );
    is_done(&["imitate", &demo, "--seed", "1"]);
}

#[test]
fn a_box_that_is_held_while_it_is_filled_comes_after_its_content() {
    let held = "With(Left, Grasp(\"Box\")), With(Left, Glide(to: (3, -3, 3), seconds: 1)), With(Left, WaitUntilThere(2)), \
        Grasp(\"Red\"), Glide(to: (-3, -3, 5), seconds: 0.7), Glide(to: (3, -3, 5), seconds: 1), \
        Glide(to: (3, -3, 3), seconds: 1), WaitUntilThere(2), Release, WaitUntilRest(3), \
        With(Left, Glide(to: (-1, -4, 3), seconds: 2)), With(Left, Glide(to: (-1, -4, 0.52), seconds: 1)), \
        With(Left, WaitUntilThere(2)), With(Left, Release),";
    means(
        &shown("held", &[RED, BOX], held),
        &[
            "1. Put the red block into the blue box.",
            "2. Move the blue box with the red block in it to (-1, -4).",
        ],
    );
}

#[test]
fn what_is_poured_is_moved_for_good() {
    let objects = r#"<sphere id="Ball" location="(3,-3,0.5)" radius="0.3" mass="0.1" color="red"/>
        <box id="Cup" location="(3,-3,0.75)" xspan="1" yspan="1" zspan="1.5" thickness="0.1" color="blue" mass="0.3"/>
        <box id="Bowl" location="(-1,-3,0.4)" xspan="2.4" yspan="2.4" zspan="0.8" thickness="0.1" color="orange"/>"#;
    let steps = "Grasp(\"Cup\"), Glide(to: (3, -3, 3), seconds: 1), Glide(to: (-0.4, -3, 3), seconds: 2), \
        Turn(axis: Y, degrees: -120), Wait(2), Turn(axis: Y, degrees: 120), Wait(1), Glide(to: (3, -3, 3), seconds: 2), \
        Glide(to: (3, -3, 0.77), seconds: 1), WaitUntilThere(2), Release,";
    means(
        &shown("poured", &[objects], steps),
        &["1. Pour the red ball out of the blue box into the orange box."],
    );
}

#[test]
fn what_leans_or_stands_between_is_told_so() {
    let objects = r#"<block id="Plank" location="(-2,-3,0.1)" xspan="3" yspan="0.8" zspan="0.2" color="brown"/>
        <block id="Red" location="(3,-3,0.5)" color="red"/>"#;
    let steps = "Grasp(\"Plank\"), Glide(to: (-2, -3, 3), seconds: 1), Turn(axis: Y, degrees: -35), \
        Glide(to: (1.4, -3, 3), seconds: 2), Glide(to: (1.4, -3, 0.9), seconds: 1), Wait(1), Release, Wait(1),";
    means(
        &shown("leaning", &[objects], steps),
        &["1. Lean the brown block against the red block."],
    );
    let objects = r#"<block id="A" location="(-1.2,-3,0.5)" color="red"/>
        <block id="B" location="(1.3,-3,0.5)" color="green"/><block id="C" location="(5,-3,0.5)" color="blue"/>"#;
    let steps = carried("C", (5.0, -3.0), (0.0, -3.0), 0.52);
    means(
        &shown("between", &[objects], &steps),
        &["1. Put the blue block between the red block and the green block."],
    );
}
