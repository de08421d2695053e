//! `tabletop require`: requirements on the objects of a recording's task.

use std::{path::PathBuf, process::ExitCode};

use crate::task::{Furniture, Requirements, Role, Task};
use clap::Args;

use super::{
    Failure,
    explain::{print, read},
    range::NumberRange,
    terminal::show_warnings,
    wait::WaitOption,
};

const STEPS: NumberRange<usize> = NumberRange::whole(1, 1_000_000);

#[derive(Args)]
pub(super) struct RequireArgs {
    /// The recording's folder
    #[arg(value_name = "DIR")]
    recording: PathBuf,
    /// The step whose object is meant, from 1 to 1000000; without it, all requirements are listed
    #[arg(long, value_name = "N", value_parser = STEPS, allow_negative_numbers = true)]
    step: Option<usize>,
    /// The reference to which the step's object is put, instead of the object itself
    #[arg(long, requires = "step")]
    other: bool,
    /// Requirements: `color=red`, `xspan=1..2`, `shape` (as demonstrated), `same=1` (the object of step 1), or `any`
    #[arg(value_name = "PROPERTY[=VALUE]", requires = "step")]
    requirements: Vec<String>,
    /// Remove these requirements instead; without any, all requirements on the object
    #[arg(long, requires = "step")]
    remove: bool,
    #[command(flatten)]
    wait: WaitOption,
}

/// Prints or changes the requirements on the objects of a recording.
pub(super) fn require(args: &RequireArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    if let Some(number) = args.step {
        let task = Task::read(&args.recording).map_err(Failure::input)?;
        // A requirement that can never hold is read, so that it can be removed.
        let edit = Requirements::edit(&args.recording, &args.wait.storage());
        let mut edit = edit.map_err(Failure::input)?;
        let step = task
            .step(number)
            .ok_or_else(|| Failure::input(format!("the demonstration has no step {number}")))?;
        let role = match args.other {
            true => step.relations.iter().find_map(|relation| relation.object()),
            false => Some(step.object.as_str()),
        };
        let role = role.and_then(|role| task.role(role)).ok_or_else(|| {
            Failure::input(format!(
                "step {number} puts {} to no other object",
                step.object
            ))
        })?;
        change(&mut edit.requirements, &task, role, args)?;
        edit.finish().map_err(Failure::run)?;
    }
    let (task, requirements) = read(&args.recording, &Furniture::default())?;
    let lines = task.roles.iter().map(|role| {
        let required = match requirements.roles.get(&role.id) {
            None => "as it was shown".to_owned(),
            Some(required) if required.is_empty() => "any".to_owned(),
            Some(required) => {
                let all: Vec<_> = required
                    .iter()
                    .map(|(name, value)| format!("{name}={value}"))
                    .collect();
                all.join(" ")
            }
        };
        let of_role = task.steps.iter().filter(|step| step.object == role.id);
        let steps: Vec<_> = of_role.map(|step| step.number.to_string()).collect();
        let steps = match steps.is_empty() {
            true => "never moved".to_owned(),
            false => format!("moved in step {}", steps.join(", ")),
        };
        format!("{} ({steps}): {required}\n", role.id)
    });
    print(&lines.collect::<String>())
}

fn change(
    requirements: &mut Requirements,
    task: &Task,
    role: &Role,
    args: &RequireArgs,
) -> Result<(), Failure> {
    if !args.remove {
        let mut all = args.requirements.iter();
        return all.try_for_each(|text| requirements.add(task, role, text).map_err(Failure::input));
    }
    let names: Vec<_> = match args.requirements.is_empty() {
        true => vec![None],
        false => args
            .requirements
            .iter()
            .map(|name| Some(name.as_str()))
            .collect(),
    };
    for name in names {
        if !requirements.remove(role, name) {
            let name = name.unwrap_or("nothing");
            let reason = format!(
                "{}: {name} is required of it that could be removed",
                role.id
            );
            return Err(Failure::input(reason));
        }
    }
    Ok(())
}
