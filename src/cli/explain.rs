//! `tabletop explain`: the task that a recording shows.

use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use crate::{
    program::{Example, Meaning, Untouched},
    scene::{IdAllocator, assemble},
    shipped::read_faultless_task,
    task::{Demonstration, DetourKind, Furniture, Requirements, Role, Task, TaskStep},
};
use clap::Args;
use serde_json::{Value, json};
use tabletop_core::{SceneSpec, TICKS_PER_SECOND};

use super::{
    Failure, Output, allowed_paths::AllowedPaths, demonstration::read_demonstration, meaning::told,
    terminal::show_warnings,
};

#[derive(Args)]
pub(super) struct ExplainArgs {
    /// The recording's folder
    #[arg(value_name = "DIR")]
    recording: PathBuf,
    /// Print everything that is known of the task as JSON
    #[arg(long)]
    json: bool,
    /// Print what the demonstration means beyond its steps, as a program (docs/task-programs.md), and what else it may mean; its steps if that is all.
    /// Objects like those that were moved which were not are named
    #[arg(long, conflicts_with_all = ["json", "setup"])]
    program: bool,
    /// Print which objects of this task file take the roles; exit code 1 if none fit
    #[arg(long, value_name = "FILE")]
    setup: Option<PathBuf>,
    #[command(flatten)]
    allowed: AllowedPaths,
}

/// Prints the task of a recording.
pub(super) fn explain(args: &ExplainArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    let scene = match &args.setup {
        Some(setup) => {
            Some(read_faultless_task(setup, &args.allowed.folders).map_err(Failure::input)?)
        }
        None => None,
    };
    let furniture = scene.as_ref().map(furniture).unwrap_or_default();
    let shown = read_demonstration(&args.recording, &furniture).map_err(Failure::input)?;
    let (task, requirements) = understood(&shown, &args.recording)?;
    if args.program {
        let lines = program(&shown, &task).unwrap_or_else(|| steps(&shown, &task));
        return print(&(lines.join("\n") + "\n"));
    }
    let binding = match &args.setup {
        Some(setup) => {
            let binding = task.bind(&requirements, &furniture.objects);
            Some(
                binding
                    .map_err(|unbound| Failure::run(format!("{}: {unbound}", setup.display())))?,
            )
        }
        None => None,
    };
    if args.json {
        let mut json = json!({ "task": task, "requirements": requirements.roles });
        if let Some(binding) = binding {
            json["binding"] = json!(binding);
        }
        return print_json(&json);
    }
    let mut lines = reported(&task);
    if lines.is_empty() {
        lines.push("Nothing is moved for good.".into());
    }
    lines.extend(task.detours.iter().map(|detour| {
        let noun = task.noun(&detour.object);
        let what = match detour.kind {
            DetourKind::InPlace => "was held in its place",
            DetourKind::AwayAndBack => "was moved away and back",
            DetourKind::PutDown => "was put down on the way",
            DetourKind::HandedOver => "went from hand to hand",
        };
        let seconds = |tick: u64| tick as f64 / f64::from(TICKS_PER_SECOND);
        let [from, to] = [detour.grasp.0, detour.release.0].map(seconds);
        format!("Does not matter: {noun} {what} ({from:.2} to {to:.2} s).")
    }));
    if let Some(binding) = binding {
        let taken = |role: &Role| Some(format!("{} is {}.", role.noun, binding.object(&role.id)?));
        lines.extend(
            task.roles
                .iter()
                .filter_map(taken)
                .map(|line| capital(&line)),
        );
    }
    print(&(lines.join("\n") + "\n"))
}

/// What a demonstration means, if that is more than its steps.
fn program(shown: &Demonstration, task: &Task) -> Option<Vec<String>> {
    let meaning = Meaning::beyond_steps(shown, task)?;
    let program = meaning.program.as_ref()?.to_string();
    Some([vec![program], told(&meaning)].concat())
}

/// The steps of a demonstration, and the objects like those that were moved which were not.
fn steps(shown: &Demonstration, task: &Task) -> Vec<String> {
    let untouched = Example::of(shown, task)
        .map(|example| Meaning::untouched_in(&[example]))
        .unwrap_or_default();
    let untouched = untouched.iter().map(Untouched::to_string);
    reported(task).into_iter().chain(untouched).collect()
}

/// The steps with their numbers, and the operations and pushes between them.
pub(super) fn reported(task: &Task) -> Vec<String> {
    let steps = task.told().into_iter();
    let steps = steps.map(|(tick, step)| (tick, numbered(step)));
    let operations = task.operations.iter();
    let operations = operations.map(|done| (done.tick, format!("- {}", done.sentence())));
    let pushes = task.pushes.iter();
    let pushes = pushes.map(|push| (push.tick, format!("- {}", push.sentence)));
    let mut reported: Vec<_> = steps.chain(operations).chain(pushes).collect();
    reported.sort_by_key(|(tick, _)| *tick);
    reported.into_iter().map(|(_, line)| line).collect()
}

/// The objects of a scene, which complete a recording of the original program.
pub(super) fn furniture(scene: &SceneSpec) -> Furniture {
    let assembly = assemble(scene, &mut IdAllocator::default());
    Furniture {
        objects: assembly.objects,
        joints: assembly.joints,
    }
}

/// The task of a recording, with its requirements in its sentences. A recording that was cut off is reported.
pub(super) fn read(
    recording: &Path,
    furniture: &Furniture,
) -> Result<(Task, Requirements), Failure> {
    let shown = read_demonstration(recording, furniture).map_err(Failure::input)?;
    understood(&shown, recording)
}

/// The task that a demonstration shows, with the requirements of its recording in its sentences.
pub(super) fn understood(
    shown: &Demonstration,
    recording: &Path,
) -> Result<(Task, Requirements), Failure> {
    let mut task = Task::of(shown);
    let requirements = Requirements::read_for(&task, recording).map_err(Failure::input)?;
    task.phrase(&requirements);
    Ok((task, requirements))
}

/// A step with its number, and the steps that must come before it unless that is just the previous one.
fn numbered(step: &TaskStep) -> String {
    let TaskStep {
        number,
        sentence,
        after,
        ..
    } = step;
    let order = match after[..] {
        [] if *number > 1 => " (at any time)".to_owned(),
        [] => String::new(),
        [only] if only + 1 == *number => String::new(),
        _ => {
            let after: Vec<_> = after.iter().map(usize::to_string).collect();
            format!(" (after {})", after.join(" and "))
        }
    };
    format!("{number}. {sentence}{order}")
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|letter| letter.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}

pub(super) fn print_json(json: &Value) -> Result<ExitCode, Failure> {
    Output::Stdout.write(format!("{json:#}\n").as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

pub(super) fn print(text: &str) -> Result<ExitCode, Failure> {
    Output::tell(text)?;
    Ok(ExitCode::SUCCESS)
}
