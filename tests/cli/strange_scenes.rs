//! Scenes that were not made for a demonstration: the robot does it there, too, or says in a sentence why not.

use std::{
    fs,
    path::{Path, PathBuf},
};

use bevy::math::Vec3;

use crate::{
    imitate::recorded,
    support::{place, stderr, stdout, tabletop},
};

const RED: &str = r#"<block id="Red" location="(-3,-2.5,0.5)" color="red"/>"#;
const GREEN: &str = r#"<block id="Green" location="(0,-4,0.5)" color="green"/>"#;
const BLUE: &str = r#"<block id="Blue" location="(3,-2.5,0.5)" color="blue"/>"#;

/// The report on stacking green on blue and red on green among these objects, and a recording of it.
fn stacked(scene: &str, objects: &[&str]) -> (String, PathBuf) {
    let setup = place(&format!("strange_{scene}.xml"));
    let text = format!(
        "<tabletop xmlns=\"http://synapse.cs.umd.edu/tabletop-xml\">{}</tabletop>",
        objects.concat()
    );
    fs::write(&setup, text).unwrap();
    let demo = recorded("stack_three");
    imitated(&demo, &["--setup", setup.to_str().unwrap()])
}

/// The report on an imitation of this, and a recording of it.
fn imitated(demo: &str, options: &[&str]) -> (String, PathBuf) {
    let recording = PathBuf::from(format!("{demo}_robot"));
    let record = ["--record", recording.to_str().unwrap()];
    let _none = fs::remove_dir_all(&recording);
    let output = tabletop(&[&["imitate", demo], options, &record].concat());
    (stdout(&output) + &stderr(&output), recording)
}

/// Where an object is at the beginning and at the end of a recording.
fn places(recording: &Path, id: &str) -> [Vec3; 2] {
    let states = fs::read_to_string(recording.join("states.csv")).unwrap();
    let mut places = states.lines().filter_map(|line| {
        let fields: Vec<_> = line.split(',').collect();
        let number = |field: usize| fields[field].parse::<f32>().unwrap();
        (fields[1] == id).then(|| Vec3::new(number(2), number(3), number(4)))
    });
    let first = places.next().unwrap();
    [first, places.next_back().unwrap_or(first)]
}

fn is_stacked(scene: &str, objects: &[&str]) {
    let (told, _) = stacked(scene, objects);
    assert!(told.contains("Done: 2 steps"), "{told}");
}

fn fails(scene: &str, objects: &[&str], reason: &str) {
    let (told, _) = stacked(scene, objects);
    assert!(told.contains(reason), "{told}");
}

#[test]
fn an_object_on_a_goal_is_put_aside() {
    let yellow = r#"<block id="Yellow" location="(3,-2.5,1.5)" color="yellow"/>"#;
    is_stacked("occupied", &[RED, GREEN, BLUE, yellow]);
}

#[test]
fn an_object_that_cannot_be_put_aside_is_named() {
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
fn neighbours_of_an_object_are_put_aside_and_back() {
    let around: Vec<_> = ["-4.05,-2.5", "-1.95,-2.5", "-3,-1.45", "-3,-3.55"]
        .iter()
        .enumerate()
        .map(|(i, at)| format!(r#"<block id="W{i}" location="({at},0.5)" color="gray"/>"#))
        .collect();
    let (told, recording) = stacked("crowd", &[RED, GREEN, BLUE, &around.concat()]);
    assert!(told.contains("Done: 2 steps"), "{told}");
    let moved = (0..4).filter(|i| {
        let states = fs::read_to_string(recording.join("states.csv")).unwrap();
        states.matches(&format!(",W{i},")).count() > 30
    });
    assert!(moved.count() > 0, "nothing was in the way");
    for i in 0..4 {
        let [first, last] = places(&recording, &format!("W{i}"));
        assert!(first.distance(last) < 0.1, "W{i}: {first} {last}");
    }
}

#[test]
fn a_cover_is_lifted_off() {
    let cup = r#"<box id="Cup" location="(-3,-2.5,0.85)" rotation="(180,0,0)" xspan="1.6" yspan="1.6" zspan="1.7" thickness="0.1" color="orange"/>"#;
    is_stacked("covered", &[RED, GREEN, BLUE, cup]);
}

#[test]
fn an_object_enclosed_by_a_box_is_left_there() {
    let bin = r#"<box id="Bin" location="(-3,-2.5,1)" xspan="1.6" yspan="1.6" zspan="2" thickness="0.2" color="orange"/>"#;
    let red = r#"<block id="Red" location="(-3,-2.5,0.75)" color="red"/>"#;
    fails(
        "enclosed",
        &[red, GREEN, BLUE, bin],
        "there is no room for fingers around Red where it is",
    );
}

#[test]
fn objects_at_the_edge_are_taken() {
    for (scene, at) in [("left", "-9.5,-2.5"), ("near", "-3,-5.9")] {
        let red = format!(r#"<block id="Red" location="({at},0.5)" color="red"/>"#);
        is_stacked(scene, &[&red, GREEN, BLUE]);
    }
}

#[test]
fn an_unreachable_object_is_reported_before_anything_moves() {
    let red = r#"<block id="Red" location="(0,5,0.5)" color="red"/>"#;
    fails(
        "beyond",
        &[red, GREEN, BLUE],
        "Step 2 failed (Put the red block on the green block.): no arm gets its fingers around Red where it is; 0.5 s simulated",
    );
}

#[test]
fn where_no_arm_reaches_is_said_at_once() {
    let blue = r#"<block id="Blue" location="(0,5,0.5)" color="blue"/>"#;
    let (told, _) = stacked("goal_beyond", &[RED, GREEN, blue]);
    let reason = "no arm that reaches Green reaches where it belongs";
    assert!(told.contains(reason) && !told.contains("(again)"), "{told}");
}

#[test]
fn a_closed_lid_is_opened_and_closed_again() {
    let scenario = place("open_chest.ron");
    let steps = r#"(setup: "shipped:tablesetup/chest.xml", steps: [
        Grasp("chest-lid"), Glide(to: (-0.3, -2.5, 1.9), seconds: 1.5), WaitUntilThere(2), Release,
        WaitUntilRest(3),
        Start,
        Grasp("Yellow"), Glide(to: (-4, -3, 4), seconds: 0.6), Turn(axis: Z, degrees: -20),
        Glide(to: (2.6, -2.5, 4), seconds: 1.5), Glide(to: (2.6, -2.5, 0.72), seconds: 0.8), WaitUntilThere(1), Release,
        WaitUntilRest(3),
        Finish,
    ])"#;
    fs::write(&scenario, steps).unwrap();
    let demo = place("imitate_open_chest");
    let demo = demo.to_str().unwrap();
    let output = tabletop(&["run", scenario.to_str().unwrap(), "--record", demo]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let (told, recording) = imitated(demo, &[]);
    assert!(told.contains("Done: 1 step"), "{told}");
    let [first, last] = places(&recording, "chest-lid");
    assert!(first.distance(last) < 0.15, "{first} {last}");
    let inside = places(&recording, "Yellow")[1];
    assert!(inside.distance(Vec3::new(2.5, -2.5, 0.7)) < 1.0, "{inside}");
}

#[test]
fn missing_objects_are_named() {
    fails(
        "missing",
        &[RED, GREEN],
        "the green block, the blue block and the red block need an object each, and only Red and Green can be any of them",
    );
    fails("empty", &[], "the table is empty");
}
