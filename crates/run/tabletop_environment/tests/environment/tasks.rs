//! The tasks of environments.

use std::path::Path;

use tabletop_core::Random;
use tabletop_environment::{
    ActionSpace, EnvironmentOptions, EnvironmentTask, TaskEnvironment, registered_tasks,
};

use crate::{action, bits, options, task};

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
    assert!(environment.verdicts()[0].gap.length() < 0.1);
}

#[test]
fn a_reached_target_is_a_success() {
    let options = options(ActionSpace::EndEffectorDelta);
    let mut environment = TaskEnvironment::new(task("Reach"), &options).unwrap();
    for seed in 0..5 {
        environment.reset(Some(seed)).unwrap();
        let gap = |environment: &TaskEnvironment| environment.verdicts()[0].gap;
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

/// Moves what an instruction wants moved, from where it is to where it is to be. Returns whether that was a success.
fn follow(environment: &mut TaskEnvironment) -> bool {
    (0..12).any(|_| {
        let verdicts = environment.verdicts();
        let moved = verdicts.iter().filter(|it| it.gap.length() > 0.05);
        // What others are put on comes first.
        let lowest = moved.min_by(|one, other| one.gap.desired.z.total_cmp(&other.gap.desired.z));
        let Some(next) = lowest.map(|it| it.gap) else {
            return false;
        };
        let [from, to] = [next.achieved, next.desired].map(|at| [at.x / 10.0, at.y / 6.0]);
        let action = [from[0], from[1], to[0], to[1], 0.0];
        environment.step(&action).unwrap().is_success
    })
}

#[test]
fn who_does_what_an_instruction_says_has_done_it() {
    let options = options(ActionSpace::PickPlace);
    let mut environment = TaskEnvironment::new(task("Instruction"), &options).unwrap();
    let mut said = std::collections::BTreeSet::new();
    let mut undone = Vec::new();
    for seed in 0..40 {
        environment.reset(Some(seed)).unwrap();
        said.insert(environment.instruction().unwrap().to_owned());
        assert!(!environment.failures().is_empty());
        if !follow(&mut environment) {
            let instruction = environment.instruction().map(str::to_owned);
            undone.push((seed, instruction, environment.failures()));
        }
    }
    assert!(said.len() > 10, "{said:?}");
    assert!(undone.len() <= 4, "{undone:?}");
}

#[test]
fn a_seed_decides_the_instruction() {
    let options = options(ActionSpace::PickPlace);
    let mut environments =
        [0, 1].map(|_| TaskEnvironment::new(task("Instruction"), &options).unwrap());
    for seed in 0..10 {
        let told = environments.each_mut().map(|environment| {
            environment.reset(Some(seed)).unwrap();
            environment.step(&[0.0; 5]).unwrap();
            let said = environment.instruction().unwrap().to_owned();
            (said, bits(environment))
        });
        assert_eq!(told[0], told[1], "seed {seed}");
    }
}

#[test]
fn what_is_no_action_is_refused() {
    let options = options(ActionSpace::JointVelocity);
    let mut environment = TaskEnvironment::new(task("StackThree"), &options).unwrap();
    let mut action = vec![0.0; environment.action_len()];
    let refusal = |environment: &mut TaskEnvironment, action: &[f32]| {
        environment.step(action).unwrap_err().to_string()
    };
    assert_eq!(
        refusal(&mut environment, &action),
        "no episode has begun; reset it first"
    );
    environment.reset(Some(0)).unwrap();
    action[3] = f32::NAN;
    assert_eq!(
        refusal(&mut environment, &action),
        "number 3 of the action, from 0, is NaN; expected numbers from -1 to 1"
    );
    assert_eq!(
        refusal(&mut environment, &[0.0]),
        "an action of 1 numbers, expected 16"
    );
    action[3] = f32::INFINITY;
    environment.step(&action).unwrap();
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
