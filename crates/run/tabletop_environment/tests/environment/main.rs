//! Environments, alone and many at once.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod same_bits;
mod tasks;
mod worlds;

use tabletop_camera::CameraSpec;
use tabletop_core::Random;
use tabletop_environment::{
    ActionSpace, EnvironmentOptions, EnvironmentTask, ObservationSpace, TaskEnvironment,
    registered_tasks,
};

/// The task of this name.
fn task(name: &str) -> EnvironmentTask {
    let tasks = registered_tasks();
    let task = tasks.iter().find(|task| task.name == name).unwrap();
    task.task(true).unwrap()
}

/// Small pictures, and a state.
fn options(action: ActionSpace) -> EnvironmentOptions {
    EnvironmentOptions {
        observation: ObservationSpace::Rgbd,
        camera: CameraSpec::head(32, 24),
        action,
        ..EnvironmentOptions::default()
    }
}

/// All that an environment shows, as bits.
fn bits(environment: &mut TaskEnvironment) -> Vec<u32> {
    let mut state = vec![0.0; environment.state_layout().numbers()];
    environment.observe_state(&mut state);
    let picture = environment.picture().unwrap();
    let rgb = picture.rgb.iter().map(|&byte| u32::from(byte));
    let depth = picture.depth.iter().map(|depth| depth.to_bits());
    let state = state.iter().map(|number| number.to_bits());
    state.chain(rgb).chain(depth).collect()
}

/// A random action.
fn action(random: &mut Random, length: usize) -> Vec<f32> {
    (0..length).map(|_| random.between((-1.0, 1.0))).collect()
}
