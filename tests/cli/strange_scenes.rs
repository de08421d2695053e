//! Scenes that were not made for a demonstration: the robot does it there, too, or says in a sentence why not.

use std::fs;

use crate::{
    imitate::recorded,
    support::{place, stderr, stdout, tabletop},
};

const RED: &str = r#"<block id="Red" location="(-3,-2.5,0.5)" color="red"/>"#;
const GREEN: &str = r#"<block id="Green" location="(0,-4,0.5)" color="green"/>"#;
const BLUE: &str = r#"<block id="Blue" location="(3,-2.5,0.5)" color="blue"/>"#;

/// What is said of green on blue and red on green among these objects.
fn stacked(scene: &str, objects: &[&str]) -> String {
    let setup = place(&format!("strange_{scene}.xml"));
    let text = format!(
        "<tabletop xmlns=\"http://synapse.cs.umd.edu/tabletop-xml\">{}</tabletop>",
        objects.concat()
    );
    fs::write(&setup, text).unwrap();
    let demo = recorded("stack_three");
    let output = tabletop(&["imitate", &demo, "--setup", setup.to_str().unwrap()]);
    stdout(&output) + &stderr(&output)
}

fn is_stacked(scene: &str, objects: &[&str]) {
    let told = stacked(scene, objects);
    assert!(told.contains("Done: 2 steps"), "{told}");
}

fn fails(scene: &str, objects: &[&str], reason: &str) {
    let told = stacked(scene, objects);
    assert!(told.contains(reason), "{told}");
}

#[test]
fn what_occupies_a_goal_is_put_aside() {
    let yellow = r#"<block id="Yellow" location="(3,-2.5,1.5)" color="yellow"/>"#;
    is_stacked("occupied", &[RED, GREEN, BLUE, yellow]);
}

#[test]
fn what_cannot_be_put_aside_is_named() {
    let wide = r#"<block id="Wide" location="(3,-2.5,1.5)" xspan="2.5" yspan="2.5" zspan="1" color="yellow"/>"#;
    fails(
        "occupied_by_wide",
        &[RED, GREEN, BLUE, wide],
        "Step 1 failed (Put the green block on the blue block.): Wide cannot be taken: no part of it fits between the fingers",
    );
    let post = r#"<block id="Post" location="(3,-2.5,1.5)" color="black" mass="0"/>"#;
    fails(
        "occupied_by_fixed",
        &[RED, GREEN, BLUE, post],
        "Step 1 failed (Put the green block on the blue block.): Post is where Green belongs, and nothing moves it",
    );
}

#[test]
fn what_stands_around_an_object_is_put_aside() {
    let around: Vec<_> = ["-4.05,-2.5", "-1.95,-2.5", "-3,-1.45", "-3,-3.55"]
        .iter()
        .enumerate()
        .map(|(i, at)| format!(r#"<block id="W{i}" location="({at},0.5)" color="gray"/>"#))
        .collect();
    is_stacked("crowd", &[RED, GREEN, BLUE, &around.concat()]);
}

#[test]
fn what_covers_an_object_is_lifted_off() {
    let cup = r#"<box id="Cup" location="(-3,-2.5,0.85)" rotation="(180,0,0)" xspan="1.6" yspan="1.6" zspan="1.7" thickness="0.1" color="orange"/>"#;
    is_stacked("covered", &[RED, GREEN, BLUE, cup]);
}

#[test]
fn what_a_box_encloses_is_left_there() {
    let bin = r#"<box id="Bin" location="(-3,-2.5,1)" xspan="1.6" yspan="1.6" zspan="2" thickness="0.2" color="orange"/>"#;
    let red = r#"<block id="Red" location="(-3,-2.5,0.75)" color="red"/>"#;
    fails(
        "enclosed",
        &[red, GREEN, BLUE, bin],
        "there is no room for fingers around Red where it is",
    );
}

#[test]
fn what_is_at_the_edge_is_taken() {
    for (scene, at) in [("left", "-9.5,-2.5"), ("near", "-3,-5.9")] {
        let red = format!(r#"<block id="Red" location="({at},0.5)" color="red"/>"#);
        is_stacked(scene, &[&red, GREEN, BLUE]);
    }
}

#[test]
fn what_no_arm_reaches_is_said_before_anything_moves() {
    let red = r#"<block id="Red" location="(0,5,0.5)" color="red"/>"#;
    fails(
        "beyond",
        &[red, GREEN, BLUE],
        "Step 2 failed (Put the red block on the green block.): no arm gets its fingers around Red where it is; 0.5 s simulated",
    );
}

#[test]
fn what_is_missing_is_named() {
    fails(
        "missing",
        &[RED, GREEN],
        "the green block, the blue block and the red block need an object each, and only Red and Green can be any of them",
    );
    fails("empty", &[], "the table is empty");
}
