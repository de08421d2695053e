//! The tasks of environments.

use std::path::Path;

use tabletop_core::Random;
use tabletop_environment::{
    ActionSpace, EnvironmentOptions, EnvironmentTask, TaskEnvironment, registered_tasks,
};

use crate::{action, options, task};

#[test]
fn every_registered_environment_runs() {
    let tasks = registered_tasks();
    assert!(tasks.len() >= 30, "{}", tasks.len());
    for task in tasks {
        let options = EnvironmentOptions {
            robot: task.robot.clone(),
            ..options(ActionSpace::JointVelocity)
        };
        let mut environment = TaskEnvironment::new(task.task(true).unwrap(), &options)
            .unwrap_or_else(|error| panic!("{}: {error}", task.name));
        let mut random = Random::new(0);
        for seed in 0..3 {
            environment
                .reset(Some(seed))
                .unwrap_or_else(|error| panic!("{}: {error}", task.name));
            for _ in 0..5 {
                let action = action(&mut random, environment.action_len());
                let transition = environment.step(&action).unwrap();
                assert!(transition.reward.is_finite(), "{}", task.name);
                assert!(!transition.is_success, "{}", task.name);
            }
        }
    }
}

#[test]
fn crowded_tasks_find_room() {
    let task = task("BuildLetters");
    let mut environment = TaskEnvironment::new(task, &options(ActionSpace::JointVelocity)).unwrap();
    for seed in 0..100 {
        environment.reset(Some(seed)).unwrap();
    }
}

#[test]
fn a_stack_that_is_built_is_a_success() {
    let stack = EnvironmentTask::of_setup(
        Path::new("shipped:tablesetup/default.xml"),
        &[r#"OnTopOf(object: "RedBlock", of: "GreenBlock")"#.into()],
        false,
        &[],
    );
    let options = options(ActionSpace::PickPlace);
    let mut environment = TaskEnvironment::new(stack.unwrap(), &options).unwrap();
    environment.reset(Some(0)).unwrap();
    // The red block is at x = 2, the green one at -2; the table is 20 wide.
    let transition = environment.step(&[0.2, 0.0, -0.2, 0.0, 0.25]).unwrap();
    assert!(transition.is_success, "{transition:?}");
    assert!(transition.reward > 4.0, "{transition:?}");
    let verdicts: Vec<_> = environment.verdicts().collect();
    assert!(verdicts[0].1.gap.length() < 0.1);
}

#[test]
fn a_reached_target_is_a_success() {
    let options = options(ActionSpace::EndEffectorDelta);
    let mut environment = TaskEnvironment::new(task("Reach"), &options).unwrap();
    for seed in 0..5 {
        environment.reset(Some(seed)).unwrap();
        let gap = |environment: &TaskEnvironment| environment.verdicts().next().unwrap().1.gap;
        let mut reward = 0.0;
        let first = gap(&environment).length();
        let reached = (0..200).any(|_| {
            let gap = gap(&environment);
            let way = ((gap.desired - gap.achieved) * 10.0).to_array();
            let [x, y, z] = way.map(|share| share.clamp(-1.0, 1.0));
            let transition = environment
                .step(&[0.0, 0.0, 0.0, 0.0, 0.0, x, y, z, 0.0, 0.0])
                .unwrap();
            reward += transition.reward;
            transition.is_success
        });
        assert!(reached, "seed {seed}: {:?}", gap(&environment));
        let expected = first - gap(&environment).length() + 1.0;
        assert!((reward - expected).abs() < 1e-3, "{reward}, {expected}");
    }
}

#[test]
fn a_scenario_without_goal_or_setup_is_an_error() {
    let folder = std::env::temp_dir().join(format!("tabletop_tasks_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for (text, words) in [
        ("(steps: [Expect(AllAtRest)])", "it has no setup"),
        (
            "(setup: \"shipped:tablesetup/default.xml\", steps: [Expect(AllAtRest), Clear])",
            "it has no goal",
        ),
        ("(steps: [Jump])", "scenario.ron:1:10"),
    ] {
        let file = folder.join("scenario.ron");
        std::fs::write(&file, text).unwrap();
        let error = EnvironmentTask::of_scenario(&file, false, &[]).unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}
