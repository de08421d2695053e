//! The options of environments.

use std::path::PathBuf;

use pyo3::prelude::*;
use tabletop::environment::{
    ActionSpace, EnvironmentOptions, EnvironmentTask, ObservationSpace, RegisteredTask, Reward,
    registered_tasks,
};

use crate::{
    camera::camera,
    error::{raise, refuse},
};

/// The options of environments, as Python gives them.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Options {
    name: Option<String>,
    scenario: Option<PathBuf>,
    setup: Option<PathBuf>,
    goal: Vec<String>,
    scatter: bool,
    allow_paths: Vec<PathBuf>,
    robot: Option<PathBuf>,
    dynamic: bool,
    observation: String,
    action: String,
    reward: String,
    size: (u32, u32),
    camera: String,
    smooth: bool,
    ticks_per_step: u64,
    max_steps: u64,
    record: Option<PathBuf>,
}

impl Options {
    /// The task, and the options that the program knows.
    pub fn read(self) -> PyResult<(EnvironmentTask, EnvironmentOptions)> {
        let mut robot = self.robot;
        let task = match (&self.name, &self.scenario, &self.setup) {
            (Some(name), None, None) => {
                let task = named(name)?;
                robot = robot.or(task.robot.clone());
                task.task(self.scatter)
            }
            (None, Some(scenario), None) => {
                EnvironmentTask::of_scenario(scenario, self.scatter, &self.allow_paths)
            }
            (None, None, Some(setup)) => {
                EnvironmentTask::of_setup(setup, &self.goal, self.scatter, &self.allow_paths)
            }
            _ => return Err(refuse("expected a name, a scenario, or a setup and a goal")),
        };
        let options = EnvironmentOptions {
            robot,
            is_dynamic: self.dynamic,
            observation: one_of(
                "observation",
                &self.observation,
                ObservationSpace::ALL.map(|it| (it.name(), it)),
            )?,
            action: one_of(
                "action",
                &self.action,
                ActionSpace::ALL.map(|it| (it.name(), it)),
            )?,
            reward: one_of(
                "reward",
                &self.reward,
                Reward::ALL.map(|it| (it.name(), it)),
            )?,
            camera: camera(&self.camera, self.size)?,
            is_smooth: self.smooth,
            ticks_per_step: self.ticks_per_step,
            most_steps: self.max_steps,
            record: self.record,
        };
        Ok((task.map_err(raise)?, options))
    }
}

fn named(name: &str) -> PyResult<RegisteredTask> {
    let mut tasks = registered_tasks().into_iter();
    tasks.find(|task| task.name == name).ok_or_else(|| {
        refuse(format!(
            "there is no environment {name}; tabletop.registered() lists them"
        ))
    })
}

fn one_of<T: Copy, const N: usize>(
    option: &str,
    found: &str,
    values: [(&str, T); N],
) -> PyResult<T> {
    let value = values.iter().find(|(name, _)| *name == found);
    value.map(|(_, value)| *value).ok_or_else(|| {
        let names = values.map(|(name, _)| name);
        refuse(format!(
            "{option}: expected {}, found {found}",
            names.join(", ")
        ))
    })
}
