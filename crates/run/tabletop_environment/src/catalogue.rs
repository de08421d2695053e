//! The environments that come with the program: one for each scenario inside it that has a goal, `Instruction` and `Reach`.

use std::path::{Path, PathBuf};

use tabletop_sim::shipped::shipped_files;

use crate::{error::EnvironmentError, task::EnvironmentTask};

/// An environment that comes with the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RegisteredTask {
    /// Its name: `StackThree`.
    pub name: String,
    kind: RegisteredKind,
    /// Its robot; `None` for Baxter.
    pub robot: Option<PathBuf>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum RegisteredKind {
    /// That of a scenario.
    Scenario(PathBuf),
    Instruction,
    Reach,
}

impl RegisteredTask {
    /// The task. With `scatters`, everything is at other places in each episode.
    ///
    /// # Errors
    /// None that the program's tests would not find.
    pub fn task(&self, scatters: bool) -> Result<EnvironmentTask, EnvironmentError> {
        match &self.kind {
            RegisteredKind::Scenario(scenario) => {
                EnvironmentTask::of_scenario(scenario, scatters, &[])
            }
            RegisteredKind::Instruction => EnvironmentTask::instruction(),
            RegisteredKind::Reach => Ok(EnvironmentTask::reach()),
        }
    }
}

/// The environments that come with the program, by name.
///
/// ```
/// let tasks = tabletop_environment::registered_tasks();
/// assert!(tasks.iter().any(|task| task.name == "StackThree"));
/// ```
pub fn registered_tasks() -> Vec<RegisteredTask> {
    let scenarios = shipped_files().in_folder("scenarios");
    let mut tasks: Vec<_> = scenarios
        .filter_map(|file| {
            let stem = Path::new(file.path).file_stem()?.to_str()?;
            let scenario = file.name();
            EnvironmentTask::of_scenario(&scenario, false, &[]).ok()?;
            Some(RegisteredTask {
                name: camel_case(stem),
                robot: stem
                    .starts_with("panda")
                    .then(|| "shipped:assets/panda/robot.ron".into()),
                kind: RegisteredKind::Scenario(scenario),
            })
        })
        .collect();
    for (name, kind) in [
        ("Instruction", RegisteredKind::Instruction),
        ("Reach", RegisteredKind::Reach),
    ] {
        tasks.push(RegisteredTask {
            name: name.into(),
            kind,
            robot: None,
        });
    }
    tasks.sort_by(|one, other| one.name.cmp(&other.name));
    tasks
}

fn camel_case(stem: &str) -> String {
    let words = stem.split('_').map(|word| {
        let (first, rest) = word.split_at(word.chars().next().map_or(0, char::len_utf8));
        first.to_uppercase() + rest
    });
    words.collect()
}
