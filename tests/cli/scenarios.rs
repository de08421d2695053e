//! Scenario files: the shipped ones, and messages of the command line about others.

use std::{fs, path::Path, process::Output};

use bevy::{
    ecs::schedule::{LogLevel, ScheduleBuildSettings},
    prelude::*,
};
use tabletop::{TabletopSimPlugins, core::StepApp as _, headless_app_with};

#[cfg(unix)]
use crate::support::small_files;
use crate::support::{command, place, scenario, shipped, stderr, stdout, tabletop};

fn run(scenario: &Path, arguments: &[&str]) -> Output {
    let command = ["run", scenario.to_str().unwrap()];
    tabletop(&[&command, arguments].concat())
}

fn passes(name: &str) {
    passes_with(name, &[]);
}

fn passes_with(name: &str, options: &[&str]) {
    passes_at(&shipped("scenarios", name), options);
}

fn passes_at(scenario: &Path, options: &[&str]) {
    let output = run(scenario, &[&["--quiet"], options].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stderr(&output), "");
}

#[test]
fn two_blocks_are_stacked() {
    passes("stack_two_blocks.ron");
}

#[test]
fn tasks_are_demonstrated() {
    for name in [
        "drawer",
        "gates",
        "panel",
        "dock",
        "lock",
        "dispenser",
        "valve",
        "stack_three",
        "stand_up",
        "turn_over",
        "swap",
        "wall",
        "letter_u",
        "hanoi",
        "hand_over",
        "hanoi_rings",
        "hanoi_five",
        "rings",
        "cup",
        "cut_wire",
        "buttons",
        "shears",
        "robot_cut",
        "chest",
        "letter_m",
        "red_on_blue",
        "stack_small",
        "pyramid",
    ] {
        passes(&format!("{name}.ron"));
    }
}

#[test]
fn the_example_for_learners_is_demonstrated() {
    passes_at(&shipped("examples/learn", "hanoi_colors.ron"), &[]);
}

#[test]
fn letters_are_built() {
    passes("build_letters.ron");
}

#[test]
fn presets_are_made_and_cleared() {
    passes("presets.ron");
}

#[test]
fn a_block_is_put_into_the_lid_box() {
    passes("lidbox.ron");
}

#[test]
fn a_chain_breaks() {
    passes("break_chain.ron");
}

#[test]
fn the_robot_builds_a_tower() {
    passes("robot_stack.ron");
}

#[test]
fn the_robot_puts_down_a_block_as_wide_as_its_gripper() {
    passes("robot_place.ron");
    passes_with("robot_place.ron", &["--dynamic"]);
}

#[test]
fn the_robot_screws_a_valve_tight() {
    passes("robot_valve.ron");
    passes_with("robot_valve.ron", &["--dynamic"]);
}

#[test]
fn the_plug_of_a_shut_valve_is_locked() {
    let shut = "Grasp(\"wheel\"), Glide(to: (1, -1, 4), seconds: 1), Glide(to: (1, -1, 2.6), seconds: 1), WaitUntilThere(2),
        Fasten(\"wheel\"), Fasten(\"wheel\"), Fasten(\"wheel\"), Release,";
    let steps = format!(
        "Load(file: \"shipped:tablesetup/valve.xml\"), Wait(0.5), {shut} Loosen(\"plug\"),"
    );
    let output = run(&scenario("locked.ron", &steps), &[]);
    assert_eq!(output.status.code(), Some(1));
    let words = "Loosen(\"plug\"): refused: `plug` cannot be turned: `drain` is locked";
    assert!(stderr(&output).contains(words), "{}", stderr(&output));
}

#[test]
fn a_sentence_is_done_as_tell_does_it() {
    let said = "Put the red block on the green block.";
    // `tell` lets everything settle for 30 ticks, also after the last step; a scenario's first and last ticks come with other steps.
    let steps = format!("Wait(0.484), With(Right, Do({said:?})), Wait(0.484),");
    let ended = run(
        &scenario("told.ron", &steps),
        &["--final-state", "-", "--quiet"],
    );
    assert_eq!(ended.status.code(), Some(0), "{}", stderr(&ended));
    let setup = shipped("tablesetup", "default.xml");
    let setup = setup.to_str().unwrap();
    let told = tabletop(&["tell", said, "--setup", setup, "--final-state", "-"]);
    assert_eq!(stdout(&ended), stdout(&told));
    let states = stdout(&told);
    let red = states.lines().find(|row| row.starts_with("RedBlock,"));
    let height: f32 = red.unwrap().split(',').nth(3).unwrap().parse().unwrap();
    assert!(height > 2.9, "{states}");
}

#[test]
fn a_sentence_that_is_none_or_cannot_be_done_is_a_fault_of_its_step() {
    let wrong = scenario(
        "told_wrong.ron",
        "Do(\"Put every red blokc into the box.\"),",
    );
    let output = run(&wrong, &[]);
    assert_eq!(output.status.code(), Some(2));
    let place = format!("{}:2:1: Do(", wrong.display());
    let said = stderr(&output);
    assert!(said.contains(&place) && said.contains("`blokc`"), "{said}");
    assert!(said.contains("Put every red block into the box."), "{said}");

    let output = run(
        &scenario(
            "told_impossible.ron",
            "Do(\"Put the pink block into the box.\"),",
        ),
        &[],
    );
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    assert!(said.contains("told_impossible.ron:2:1: Do("), "{said}");
    assert!(said.contains("pink block"), "{said}");
}

#[test]
fn a_run_ends_with_a_summary() {
    let path = scenario(
        "done.ron",
        "Wait(1), Expect(Exists(\"RedBlock\")), Wait(1),",
    );
    let said = stderr(&run(&path, &[]));
    let line = format!(
        "tabletop: {}: 3 steps done, 1 check passed; 2.0",
        path.display()
    );
    assert!(said.starts_with(&line), "{said}");
    assert!(
        said.contains(" s simulated in 0.") && said.lines().count() == 1,
        "{said}"
    );

    let path = scenario(
        "half_done.ron",
        "Wait(1), Expect(Gone(\"RedBlock\")), Wait(1),",
    );
    let said = stderr(&run(&path, &[]));
    let last = said.lines().last().unwrap();
    assert!(
        last.contains(": 1 of 3 steps done, 0 checks passed; 1.0"),
        "{said}"
    );

    let said = stderr(&tabletop(&["run", "--seconds", "3"]));
    let line = "tabletop: tablesetup/default.xml: 3.00 s simulated in ";
    assert!(said.starts_with(line), "{said}");
}

#[test]
fn another_robot_of_one_arm_builds_a_tower() {
    let robot = ["--robot", "assets/panda/robot.ron"];
    passes_with("panda_stack.ron", &robot);
    passes_with("panda_stack.ron", &[&robot[..], &["--dynamic"]].concat());
}

#[test]
fn a_scenario_of_another_robot_is_refused_before_it_begins() {
    let output = run(&shipped("scenarios", "panda_stack.ron"), &[]);
    assert_eq!(output.status.code(), Some(2));
    let said = stderr(&output);
    assert!(
        said.contains("the robot Baxter has no limb panda"),
        "{said}"
    );
}

#[test]
fn every_shipped_scenario_has_its_test() {
    let files = fs::read_dir(shipped("scenarios", "")).unwrap();
    let mut names: Vec<_> = files
        .map(|file| file.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let tested = [
        "break_chain.ron",
        "build_letters.ron",
        "buttons.ron",
        "chest.ron",
        "cup.ron",
        "cut_wire.ron",
        "dispenser.ron",
        "dock.ron",
        "drawer.ron",
        "gates.ron",
        "hand_over.ron",
        "hanoi.ron",
        "hanoi_five.ron",
        "hanoi_rings.ron",
        "letter_m.ron",
        "letter_u.ron",
        "lidbox.ron",
        "lock.ron",
        "panda_stack.ron",
        "panel.ron",
        "presets.ron",
        "pyramid.ron",
        "red_on_blue.ron",
        "rings.ron",
        "robot_cut.ron",
        "robot_place.ron",
        "robot_stack.ron",
        "robot_valve.ron",
        "shears.ron",
        "stack_small.ron",
        "stack_three.ron",
        "stack_two_blocks.ron",
        "stand_up.ron",
        "swap.ron",
        "turn_over.ron",
        "valve.ron",
        "wall.ron",
    ];
    assert_eq!(names, tested);
}

#[test]
fn a_failed_check_states_its_place_the_expected_and_the_found() {
    let path = scenario(
        "failing.ron",
        "  WaitUntilRest(2),\n  Expect(OnTopOf(object: \"RedBlock\", of: \"GreenBlock\")),",
    );
    let output = run(&path, &["--final-state", "-"]);
    assert_eq!(output.status.code(), Some(1));
    let expected = format!(
        "tabletop: {}:3:3: Expect(OnTopOf(object: \"RedBlock\", of: \"GreenBlock\")): \
         expected `RedBlock` on top of `GreenBlock`, found it",
        path.display()
    );
    assert!(
        stderr(&output).starts_with(&expected),
        "{}",
        stderr(&output)
    );
    assert_eq!(stdout(&output).lines().count(), 2, "{}", stdout(&output));
}

#[test]
fn a_refused_command_of_a_hand_fails_at_its_step() {
    let path = scenario("refused.ron", "  Grasp(\"BlueBlock\"),\n  Wait(9),");
    let output = run(&path, &[]);
    assert_eq!(output.status.code(), Some(1));
    let error = stderr(&output);
    assert!(
        error.contains(":2:3: Grasp(\"BlueBlock\"): refused: "),
        "{error}"
    );
}

#[test]
fn a_bad_file_is_exit_code_2_and_says_where() {
    for (name, steps, words) in [
        ("syntax.ron", "  Grab(\"RedBlock\"),", ":2:3: "),
        ("step.ron", "  Wait(-1),", ":2:3: Wait(-1): expected a time"),
        (
            "task.ron",
            "  Load(file: \"no such.xml\"),",
            ":2:3: Load(file: \"no such.xml\"): ",
        ),
        (
            "place.ron",
            "  Load(file: \"../../tablesetup/none.xml\", place: []),",
            ":2:3: Load(",
        ),
    ] {
        let path = scenario(name, steps);
        let output = run(&path, &[]);
        assert_eq!(output.status.code(), Some(2), "{name}");
        let at = format!("tabletop: {}{words}", path.display());
        assert!(stderr(&output).starts_with(&at), "{}", stderr(&output));
    }
    let output = run(Path::new("no such.ron"), &[]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("no such.ron: it cannot be read"));
}

#[test]
fn the_seed_decides_where_objects_are() {
    let task = "shipped:tablesetup/default.xml";
    let steps = format!(
        "  Load(file: {task:?}, place: [\n\
           (object: \"RedBlock\", x: (-8, 8), y: (-4, 4), turn: (0, 360)),\n\
           (object: \"GreenBlock\", x: (-8, 8), y: (-4, 4)),\n\
         ]),\n  WaitUntilRest(2), Expect(OnTable(object: \"RedBlock\")), Expect(OnTable(object: \"GreenBlock\")),"
    );
    let path = scenario("random.ron", &steps);
    let state = |seed: &str| {
        let output = run(&path, &["--seed", seed, "--final-state", "-"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        stdout(&output)
    };
    assert_eq!(state("5"), state("5"));
    assert_ne!(state("5"), state("6"));
    assert_eq!(state("0"), {
        let output = run(&path, &["--final-state", "-"]);
        stdout(&output)
    });
}

#[test]
fn a_pause_holds_the_world_and_not_the_scenario() {
    let path = scenario(
        "pause.ron",
        "  Grasp(\"RedBlock\"), MoveBy((0, 0, 5)), WaitUntilThere(2), Release, Pause(true), Wait(5),
           Expect(Location(object: \"RedBlock\", at: (2, 0, 6), within: 0.1)),
           Pause(false), WaitUntilRest(5), Expect(OnTable(object: \"RedBlock\")),",
    );
    let output = run(&path, &[]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

/// Destroys a block, and goes back and forth over that.
const UNDO: &str = "  Start, Grasp(\"RedBlock\"), Wait(0.5), Destroy, Expect(Gone(\"RedBlock\")),
    Undo, Expect(HeldBy(object: \"RedBlock\", hand: Any)), Redo, Expect(Gone(\"RedBlock\")), Finish";

#[test]
fn unrecorded_steps_can_be_undone_and_leave_no_files() {
    let path = scenario("unrecorded.ron", UNDO);
    let empty = place("unrecorded");
    fs::create_dir(&empty).unwrap();
    let output = command(&["run", path.to_str().unwrap()])
        .current_dir(&empty)
        .env("TMPDIR", &empty)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(fs::read_dir(&empty).unwrap().count(), 0);
}

#[test]
fn hands_do_not_act_while_paused() {
    let path = scenario("paused.ron", "  Pause(true),\n  Grasp(\"RedBlock\"),");
    let output = run(&path, &[]);
    assert_eq!(output.status.code(), Some(1));
    let error = stderr(&output);
    let words =
        ":3:3: Grasp(\"RedBlock\"): refused: hands cannot act while the simulation is paused";
    assert!(error.contains(words), "{error}");
}

#[test]
fn undo_brings_back_a_destroyed_object() {
    let path = scenario("undo.ron", UNDO);
    let folder = place("undo");
    let output = run(&path, &["--record", folder.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn a_scenario_is_recorded() {
    let folder = place("recorded");
    let arguments = ["--record", folder.to_str().unwrap(), "--seed", "3"];
    let output = run(&shipped("scenarios", "stack_two_blocks.ron"), &arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let session = fs::read_to_string(folder.join("session.jsonl")).unwrap();
    assert!(session.contains("\"seed\":3"), "{session}");
    assert!(folder.join("states.csv").exists());
    let events = fs::read_to_string(folder.join("1.txt")).unwrap();
    assert!(events.contains("RedBlock"), "{events}");
    assert!(fs::read_dir(folder.join("1")).unwrap().count() > 5);
}

#[cfg(unix)]
#[test]
fn a_recording_that_cannot_go_on_ends_the_scenario() {
    let folder = place("scenario-small-files");
    let path = shipped("scenarios", "stack_two_blocks.ron");
    let [path, folder] = [&path, &folder].map(|path| path.to_str().unwrap());
    let output = small_files(&["run", path, "--record", folder, "--quiet"]);
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    let words = format!(": the recording has ended: cannot write {folder}");
    assert!(
        said.contains("two_blocks.ron:") && said.contains(&words),
        "{said}"
    );
    assert_eq!(said.lines().count(), 1, "{said}");
}

#[test]
fn a_step_beyond_the_time_limit_fails() {
    let path = scenario("long.ron", "  Wait(3600),");
    let output = run(&path, &["--seconds", "2"]);
    assert_eq!(output.status.code(), Some(1));
    let error = stderr(&output);
    assert!(
        error.contains(":2:3: Wait(3600): the limit of 2 s is over"),
        "{error}"
    );
}

#[test]
fn another_task_file_can_be_named() {
    let path = scenario(
        "setup.ron",
        "  Expect(Exists(\"obj-box\")), Expect(Gone(\"RedBlock\")),",
    );
    assert_eq!(run(&path, &[]).status.code(), Some(1));
    let output = run(&path, &["--setup", "tablesetup/lidbox.xml"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn a_scenario_has_its_place_in_a_tick() {
    let mut app = headless_app_with(TabletopSimPlugins);
    app.edit_schedule(FixedUpdate, |schedule| {
        schedule.set_build_settings(ScheduleBuildSettings {
            ambiguity_detection: LogLevel::Error,
            ..default()
        });
    });
    app.step(1);
}

#[test]
fn a_recording_ends_with_its_scenario() {
    for (name, steps, reported) in [
        ("unfinished", "Start, Grasp(\"RedBlock\"), Wait(0.5),", ""),
        (
            "unstarted",
            "Wait(0.1),",
            "tabletop: nothing was recorded: the scenario has no Start\n",
        ),
    ] {
        let folder = place(name);
        let scenario = scenario(&format!("{name}.ron"), steps);
        let output = run(
            &scenario,
            &["--quiet", "--record", folder.to_str().unwrap()],
        );
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert_eq!(stderr(&output), reported);
        if reported.is_empty() {
            let output = tabletop(&["replay", folder.to_str().unwrap(), "--verify", "--quiet"]);
            assert_eq!(
                (output.status.code(), stderr(&output)),
                (Some(0), String::new())
            );
        }
    }
}

#[cfg(unix)]
#[test]
fn two_programs_do_not_record_into_one_folder() {
    let folder = place("shared");
    let into = folder.to_str().unwrap();
    let steps =
        "Grasp(\"RedBlock\"), MoveBy((0, 0, 3)), Wait(0.2), Release, Wait(0.3),".repeat(300);
    let long = scenario("shared_long.ron", &format!("Start, {steps} Finish,"));
    let mut first = command(&["run", long.to_str().unwrap(), "--record", into])
        .spawn()
        .unwrap();
    while !folder.join("1.txt").exists() {
        assert_eq!(first.try_wait().unwrap(), None, "it ended too early");
    }
    let short = scenario("shared_short.ron", "Start, Wait(0.1), Finish,");
    let output = run(&short, &["--quiet", "--record", into]);
    first.kill().unwrap();
    first.wait().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = stderr(&output);
    let words = format!("a recording is being made in {into}");
    assert!(said.contains(&words) && said.lines().count() == 1, "{said}");
    // The folder in the way is a recording that is no longer being made.
    let output = run(&short, &["--record", into]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    fs::remove_dir_all(format!("{into}-1")).unwrap();
}

#[test]
fn an_obstacle_of_an_arm_is_reported_once() {
    let steps = "Robot(Show), Robot(Move([(RightS1, 1.0)])), Wait(2), Robot(Move([(RightS1, 1.0)])), Wait(0.5),";
    let output = run(&scenario("stopped.ron", steps), &[]);
    let reported = stderr(&output);
    let stop = "tabletop: the right arm is stopped by torso\n";
    assert_eq!(reported.matches(stop).count(), 1, "{reported}");
}
