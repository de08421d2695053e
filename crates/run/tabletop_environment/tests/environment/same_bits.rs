//! The same seeds and actions lead through the same bits.

use bevy::{
    ecs::entity_disabling::Disabled,
    prelude::{Allow, Entity},
};
use tabletop_camera::CameraSpec;
use tabletop_core::Random;
use tabletop_environment::{
    ActionSpace, Autoreset, EnvironmentOptions, TaskEnvironment, VectorEnvironment,
};

use crate::{action, bits, options, task};

/// What an environment shows in an episode of some random steps.
fn rollout(environment: &mut TaskEnvironment, seed: u64, steps: usize) -> Vec<Vec<u32>> {
    environment.reset(Some(seed)).unwrap();
    let mut random = Random::new(seed);
    let mut shown = vec![bits(environment)];
    for _ in 0..steps {
        let action = action(&mut random, environment.action_len());
        environment.step(&action).unwrap();
        shown.push(bits(environment));
    }
    shown
}

#[test]
fn an_episode_is_the_same_after_others_as_in_a_new_environment() {
    for space in ActionSpace::ALL {
        let steps = match space {
            ActionSpace::PickPlace => 3,
            ActionSpace::JointVelocity
            | ActionSpace::JointPosition
            | ActionSpace::EndEffectorDelta => 40,
        };
        let make = || TaskEnvironment::new(task("StackThree"), &options(space)).unwrap();
        let mut used = make();
        rollout(&mut used, 1, steps);
        assert!(
            rollout(&mut used, 2, steps) == rollout(&mut make(), 2, steps),
            "{space:?}"
        );
    }
}

#[test]
fn a_restored_environment_goes_on_as_before() {
    let mut environment =
        TaskEnvironment::new(task("StackThree"), &options(ActionSpace::JointVelocity)).unwrap();
    rollout(&mut environment, 3, 20);
    let moment = environment.snapshot();
    let on = |environment: &mut TaskEnvironment| {
        let mut random = Random::new(9);
        let steps = (0..20).map(|_| {
            let action = action(&mut random, environment.action_len());
            let transition = environment.step(&action).unwrap();
            (transition.reward.to_bits(), bits(environment))
        });
        steps.collect::<Vec<_>>()
    };
    let once = on(&mut environment);
    rollout(&mut environment, 4, 5);
    environment.restore(&moment).unwrap();
    assert!(once == on(&mut environment));
}

/// What many environments show over some steps, in which episodes end.
fn shown_by_many(threads: usize, autoreset: Autoreset) -> Vec<Vec<u32>> {
    let options = EnvironmentOptions {
        most_steps: 7,
        ..options(ActionSpace::JointVelocity)
    };
    let mut many =
        VectorEnvironment::new(&task("StackThree"), &options, 5, threads, autoreset).unwrap();
    let seeds: Vec<_> = (0..5).map(Some).collect();
    many.reset(&seeds, || true).unwrap();
    let mut random = Random::new(5);
    let steps = (0..20).map(|_| {
        let actions = action(&mut random, 5 * many.action_len());
        many.step(&actions, || true).unwrap();
        let results = many.results();
        let states = results.states.iter().chain(&results.last.states);
        let numbers = states.chain(&results.depth).chain(&results.rewards);
        let bytes = results.rgb.iter().chain(&results.last.rgb);
        let numbers = numbers.map(|number| number.to_bits());
        let bytes = bytes.map(|&byte| u32::from(byte));
        let flags = results.truncations.iter().map(|&flag| u32::from(flag));
        numbers.chain(bytes).chain(flags).collect::<Vec<_>>()
    });
    steps.collect()
}

#[test]
fn the_number_of_threads_does_not_matter() {
    for autoreset in [Autoreset::NextStep, Autoreset::SameStep] {
        let alone = shown_by_many(1, autoreset);
        for threads in [2, 8] {
            assert!(
                shown_by_many(threads, autoreset) == alone,
                "{threads} threads"
            );
        }
    }
}

#[test]
fn environments_that_are_received_as_they_are_ready_show_the_same() {
    let options = options(ActionSpace::JointVelocity);
    let mut many =
        VectorEnvironment::new(&task("StackThree"), &options, 4, 2, Autoreset::NextStep).unwrap();
    many.reset(&[Some(0), Some(1), Some(2), Some(3)], || true)
        .unwrap();
    let length = many.action_len();
    let actions = vec![0.3; 4 * length];
    many.send(&[0, 1, 2, 3], &actions).unwrap();
    let error = many.step(&actions, || true).unwrap_err().to_string();
    assert_eq!(error, "4 environments are stepped; receive them first");
    let mut steps = [0; 4];
    let mut received = 0;
    while received < 40 {
        let ready = many.receive(2, || true).unwrap();
        for &number in &ready {
            steps[number] += 1;
        }
        received += ready.len();
        if received <= 36 {
            many.send(&ready, &actions[..2 * length]).unwrap();
        }
    }
    assert!(many.receive(1, || true).is_err());
    let states = many.results().states.clone();
    let mut alone = TaskEnvironment::new(task("StackThree"), &options).unwrap();
    let numbers = alone.state_layout().numbers();
    for (number, steps) in steps.into_iter().enumerate() {
        alone.reset(Some(number as u64)).unwrap();
        for _ in 0..steps {
            alone.step(&actions[..length]).unwrap();
        }
        let mut state = vec![0.0; numbers];
        alone.observe_state(&mut state);
        assert_eq!(state, states[number * numbers..][..numbers]);
    }
}

#[test]
fn environments_that_take_turns_on_a_thread_see_what_each_sees_alone() {
    let cases = [("StackThree", 1, [32, 24]), ("StackThree", 2, [20, 30])];
    let make = |(name, seed, [width, height]): (&str, u64, [u32; 2])| {
        let options = EnvironmentOptions {
            camera: CameraSpec::head(width, height),
            ..options(ActionSpace::JointVelocity)
        };
        let mut environment = TaskEnvironment::new(task(name), &options).unwrap();
        environment.reset(Some(seed)).unwrap();
        environment
    };
    // Every other step nothing moves, so that what is kept of pictures is used.
    let step = |environment: &mut TaskEnvironment, number: u8| {
        let speed = f32::from(number / 2 % 2);
        environment
            .step(&vec![speed; environment.action_len()])
            .unwrap();
        bits(environment)
    };
    let mut together = cases.map(make);
    let mut seen = [Vec::new(), Vec::new()];
    for number in 0..12 {
        for (environment, seen) in together.iter_mut().zip(&mut seen) {
            seen.push(step(environment, number));
        }
    }
    for (case, seen) in cases.into_iter().zip(seen) {
        let alone = std::thread::spawn(move || {
            let mut environment = make(case);
            (0..12)
                .map(|number| step(&mut environment, number))
                .collect::<Vec<_>>()
        });
        assert!(alone.join().unwrap() == seen, "{case:?}");
    }
}

#[test]
fn what_was_removed_is_kept_for_moments_alone() {
    let mut environment =
        TaskEnvironment::new(task("StackThree"), &options(ActionSpace::JointVelocity)).unwrap();
    let count = |environment: &mut TaskEnvironment| {
        let world = environment.table_world().world_mut();
        let mut all = world.query_filtered::<Entity, Allow<Disabled>>();
        all.iter(world).count()
    };
    environment.reset(Some(0)).unwrap();
    let alone = count(&mut environment);
    let moment = environment.snapshot();
    environment.reset(Some(1)).unwrap();
    assert!(count(&mut environment) > alone);
    environment.restore(&moment).unwrap();
    drop(moment);
    environment.reset(Some(2)).unwrap();
    assert_eq!(count(&mut environment), alone);
}
