//! `tabletop imitate`: the robot imitates demonstrations.

use std::{
    fs,
    path::PathBuf,
    sync::atomic::{AtomicU32, Ordering},
};

use crate::support::{
    place, record, record_shipped, replays_to_the_same_bytes, stderr, stdout, tabletop,
};

/// A recording of a shipped scenario, in a folder of its own.
pub fn recorded(scenario: &str) -> String {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    record_shipped(scenario, &format!("imitate_{number}_{scenario}"))
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
    for seed in ["1", "2", "3", "91"] {
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

/// A cabinet with a drawer, a cube to put in, and more.
fn cabinet(more: &str) -> String {
    let walls = r#"
        <sliderJoint location="(4,-2.2,1)" rotation="(0,0,90)" max="2" damping="0.5">
          <composite id="cabinet" location="(0,0,0)" mass="0">
            <block location="(0,0,-0.9)" xspan="3" yspan="3" zspan="0.2" color="brown"/>
            <block location="(0,0,0.9)" xspan="3" yspan="3" zspan="0.2" color="brown"/>
            <block location="(1.4,0,0)" xspan="0.2" yspan="3" zspan="1.6" color="brown"/>
            <block location="(-0.1,-1.4,0)" xspan="2.8" yspan="0.2" zspan="1.6" color="brown"/>
            <block location="(-0.1,1.4,0)" xspan="2.8" yspan="0.2" zspan="1.6" color="brown"/>
          </composite>
          <composite id="drawer" location="(-0.1,0,0)" mass="0.8">
            <box location="(0,0,0)" xspan="2.6" yspan="2.4" zspan="1.2" thickness="0.15" color="orange"/>
            <block location="(-1.75,0,0.2)" xspan="0.9" yspan="0.8" zspan="0.4" color="black"/>
          </composite>
        </sliderJoint>
        <block id="Cube" location="(-3,-3,0.3)" xspan="0.6" yspan="0.6" zspan="0.6" mass="0.2" color="blue"/>"#;
    walls.to_owned() + more
}

#[test]
fn a_drawer_is_opened_filled_and_closed() {
    let slid = |by: f32| {
        format!(
            "Grasp(\"drawer\"), MoveBy((0, {by}, 0)), WaitUntilThere(3), Release, WaitUntilRest(3),"
        )
    };
    let put = "Grasp(\"Cube\"), Glide(to: (-3, -3, 4), seconds: 0.5), Glide(to: (4, -4.4, 4), seconds: 1),
         Glide(to: (4, -4.4, 1), seconds: 0.8), WaitUntilThere(1), Release, WaitUntilRest(3),";
    let steps = [&slid(-1.7), put, &slid(1.9)].concat();
    let demo = shown("drawer", &cabinet(""), &steps);
    is_done(&demo, &[]);
    for seed in ["0", "1", "7"] {
        is_done(&demo, &["--seed", seed]);
    }
    // What is in its way is put aside, or named if nothing moves it.
    let in_its_way = |name: &str, mass: &str| {
        let block = r#"<block id="Red" location="(4.2,-5.3,0.5)" xspan="0.6" yspan="0.6" zspan="1" color="red""#;
        task_file(name, &cabinet(&format!("{block} mass=\"{mass}\"/>")))
    };
    let movable = in_its_way("drawer_blocked", "0.3");
    is_done(&demo, &["--setup", movable.to_str().unwrap()]);
    let fixed = in_its_way("drawer_barred", "0");
    let output = tabletop(&["imitate", &demo, "--setup", fixed.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(1));
    let reported = stdout(&output);
    assert!(
        reported.contains("Red is in the way of drawer, and nothing moves it"),
        "{reported}"
    );
}

/// A task file with these objects.
fn task_file(name: &str, objects: &str) -> PathBuf {
    let file = place(&format!("imitate_{name}.xml"));
    let namespace = "http://synapse.cs.umd.edu/tabletop-xml";
    let text =
        format!("<tabletop xmlns=\"{namespace}\" xspan=\"20\" yspan=\"12\">{objects}</tabletop>");
    fs::write(&file, text).unwrap();
    file
}

/// Records these steps on a table with these objects.
fn shown(name: &str, objects: &str, steps: &str) -> String {
    let task = task_file(name, objects);
    let file = task.with_extension("ron");
    let setup = task.file_name().unwrap();
    let text = format!(
        "(setup: {setup:?}, steps: [WaitUntilRest(2), Start, {steps} WaitUntilRest(3), Finish])"
    );
    fs::write(&file, text).unwrap();
    record(file.to_str().unwrap(), &format!("imitate_{name}"))
}

/// A block that is lifted, turned about Y, carried and put down.
fn carried(id: &str, from: f32, degrees: f32, to: (f32, f32)) -> String {
    let (x, z) = to;
    format!(
        "Grasp({id:?}), Glide(to: ({from}, -3, 4), seconds: 0.5), Turn(axis: Y, degrees: {degrees}),
         Glide(to: ({x}, -3, 4), seconds: 1), Glide(to: ({x}, -3, {z}), seconds: 0.8), WaitUntilThere(1),
         Release, WaitUntilRest(3),"
    )
}

#[test]
fn a_lying_peg_is_stood_up_in_a_hole() {
    let objects = r#"
        <composite id="Base" location="(2.5,-3,0.4)" mass="0">
          <block location="(0,0.75,0)" xspan="2.5" yspan="0.6" zspan="0.8" color="brown"/>
          <block location="(0,-0.75,0)" xspan="2.5" yspan="0.6" zspan="0.8" color="brown"/>
          <block location="(0.85,0,0)" xspan="0.8" yspan="0.9" zspan="0.8" color="brown"/>
          <block location="(-0.85,0,0)" xspan="0.8" yspan="0.9" zspan="0.8" color="brown"/>
        </composite>
        <block id="Peg" location="(-2.5,-3,0.35)" xspan="2.4" yspan="0.7" zspan="0.7" color="red"/>"#;
    let demo = shown("peg", objects, &carried("Peg", -2.5, 90.0, (2.5, 1.2)));
    is_done(&demo, &[]);
    for seed in ["1", "2", "3"] {
        is_done(&demo, &["--seed", seed]);
    }
}

#[test]
fn two_blocks_are_put_side_by_side_into_a_bin() {
    let objects = r#"
        <box id="Bin" location="(0,-3,0.6)" xspan="2.6" yspan="1.8" zspan="1.2" thickness="0.15" color="brown"/>
        <block id="Red" location="(-4,-3,0.5)" xspan="1" yspan="1" zspan="1" color="red"/>
        <block id="Green" location="(4,-3,0.5)" xspan="1" yspan="1" zspan="1" color="green"/>"#;
    let steps =
        carried("Red", -4.0, 0.0, (-0.55, 0.65)) + &carried("Green", 4.0, 0.0, (0.55, 0.65));
    let demo = shown("bin", objects, &steps);
    // In the first two, a block must not fall on the other one, where it would look the same.
    for seed in ["0", "1", "2", "3", "6"] {
        is_done(&demo, &["--seed", seed]);
    }
}

#[test]
fn a_bar_is_stood_up_and_a_can_laid_down() {
    let demo = recorded("stand_up");
    is_done(&demo, &[]);
    is_done(&demo, &["--seed", "2"]);
    // Here an arm that has let go must not end with its elbow at the screen.
    for seed in ["1", "12", "17"] {
        is_done(&demo, &["--seed", seed]);
    }
}

#[test]
fn a_box_is_turned_over() {
    let demo = recorded("turn_over");
    is_done(&demo, &[]);
    // Here only the last of its sides does on the way.
    is_done(&demo, &["--seed", "5"]);
    // Here it does so only farther away.
    is_done(&demo, &["--seed", "22"]);
}

#[test]
fn a_block_falls_into_a_bin_that_the_hand_does_not_fit_into() {
    let folder = place("imitate_bin");
    std::fs::create_dir(&folder).unwrap();
    let (setup, shown) = (folder.join("bin.xml"), folder.join("bin.ron"));
    let objects = r#"
        <tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml">
          <box id="Bin" location="(2,-3,1.25)" xspan="1.6" yspan="1.6" zspan="2.5" thickness="0.1" color="blue" mass="5"/>
          <block id="Yellow" location="(-3,-3,0.5)" color="yellow"/>
        </tabletop>"#;
    let steps = r#"(setup: "bin.xml", steps: [
        WaitUntilRest(2), Start, Select(Right),
        Grasp("Yellow"), Glide(to: (-3, -3, 5), seconds: 0.6), Glide(to: (2, -3, 5), seconds: 1),
        Glide(to: (2, -3, 0.62), seconds: 1), WaitUntilThere(1), Release,
        WaitUntilRest(3), Finish,
    ])"#;
    std::fs::write(&setup, objects.trim_start()).unwrap();
    std::fs::write(&shown, steps).unwrap();
    let demo = folder.join("demo");
    let [shown, demo] = [&shown, &demo].map(|path| path.to_str().unwrap());
    let output = tabletop(&["run", shown, "--record", demo, "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    is_done(demo, &[]);
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
fn an_imitation_can_be_replayed() {
    let demo = recorded("hand_over");
    let robot = place("imitate_replayed");
    let robot = robot.to_str().unwrap();
    is_done(&demo, &["--record", robot]);
    replays_to_the_same_bytes(robot);
}

#[test]
fn hand_cameras_record_an_imitation() {
    let demo = recorded("swap");
    let robot = place("imitate_hand_cameras");
    let folder = robot.to_str().unwrap();
    is_done(&demo, &["--record", folder, "--hand-cameras"]);
    let first = robot.join("0/0.right_hand_camera.png");
    assert!(first.is_file());
    replays_to_the_same_bytes(folder);
}

#[test]
fn a_robot_without_hand_cameras_is_named() {
    let demo = recorded("stack_three");
    let robot = place("imitate_no_hand_cameras");
    let output = tabletop(&[
        "imitate",
        &demo,
        "--robot",
        "shipped:assets/panda/robot.ron",
        "--hand-cameras",
        "--record",
        robot.to_str().unwrap(),
    ]);
    assert_eq!(output.status.code(), Some(2));
    let told = stderr(&output);
    assert!(told.contains("has no hand cameras"), "{told}");
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
fn an_impossible_step_is_reported_in_a_sentence() {
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
fn a_high_box_is_opened_filled_and_closed_from_beside() {
    let demo = recorded("lidbox");
    is_done(&demo, &[]);
    is_done(&demo, &["--dynamic"]);
    is_done(&demo, &["--seed", "1"]);
    // Here the block has to lean on its way over the rim.
    is_done(&demo, &["--seed", "3"]);
}

#[test]
fn objects_that_stand_on_each_other_are_no_endless_tower() {
    let folder = place("imitate_interlocked");
    std::fs::create_dir(&folder).unwrap();
    let (setup, shown) = (folder.join("steps.xml"), folder.join("steps.ron"));
    // Each has its upper block on the other's lower one.
    let interlocked = |id: &str, degrees: u16| {
        format!(
            r#"<composite id="{id}" location="(0,-2,0)" rotation="(0,0,{degrees})">
                 <block location="(-0.82,0,0.5)" xspan="1.6" yspan="0.8"/>
                 <block location="(0.52,0,1.5)" yspan="0.8"/>
               </composite>"#
        )
    };
    let objects = format!(
        r#"<tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml">{}{}</tabletop>"#,
        interlocked("First", 0),
        interlocked("Second", 180)
    );
    let steps = r#"(setup: "steps.xml", steps: [
        WaitUntilRest(2), Start, Grasp("First"), Glide(to: (0, -4, 0), seconds: 1.5), WaitUntilThere(1), Release,
        WaitUntilRest(3), Finish,
    ])"#;
    std::fs::write(&setup, objects).unwrap();
    std::fs::write(&shown, steps).unwrap();
    let demo = folder.join("demo");
    let [shown, demo] = [&shown, &demo].map(|path| path.to_str().unwrap());
    let output = tabletop(&["run", shown, "--record", demo, "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    for command in [&["imitate", demo][..], &["imitate", demo, "--seed", "1"]] {
        let output = tabletop(command);
        let reported = stdout(&output) + &stderr(&output);
        assert!(output.status.code().is_some(), "{reported}");
        assert!(
            reported.contains("Done: ") || reported.contains("failed ("),
            "{reported}"
        );
    }
}

#[test]
fn three_robots_imitate_one_demonstration() {
    let demo = recorded("stack_small");
    for robot in ["baxter", "panda", "so101"] {
        let layout = format!("assets/{robot}/robot.ron");
        let arguments = ["imitate", &demo, "--robot", &layout, "--trials", "5"];
        let output = stdout(&tabletop(&arguments));
        assert!(
            output.contains("done              5 of 5"),
            "{robot}: {output}"
        );
    }
}
