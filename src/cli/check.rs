//! `tabletop check`: task files without a simulation.

use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use crate::{scene_dump, shipped::task_reader, xml::TaskReader};
use clap::Args;

use super::{Failure, Output, WRONG_INPUT, allowed_paths::AllowedPaths, terminal::say};

#[derive(Args)]
pub(super) struct CheckArgs {
    /// The task files; exit code 2 if one of them has a fault
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Print the scene of each file as JSON
    #[arg(long)]
    dump: bool,
    /// Print each file expanded: without includes, definitions, instances, variables and expressions
    #[arg(long, conflicts_with = "dump")]
    expand: bool,
    #[command(flatten)]
    allowed: AllowedPaths,
}

pub(super) fn check(args: &CheckArgs) -> Result<ExitCode, Failure> {
    let mut sound = true;
    let reader = task_reader().allowing(&args.allowed.folders);
    for file in &args.files {
        if args.expand {
            sound &= expand(&reader, file)?;
            continue;
        }
        let task = match reader.read(file) {
            Ok(task) => task,
            Err(error) => {
                say(error);
                sound = false;
                continue;
            }
        };
        for fault in &task.faults {
            say(fault);
        }
        sound &= task.faults.is_empty();
        if args.dump {
            let mut json = Vec::new();
            scene_dump::write_dump(&task.scene, &mut json).map_err(Failure::run)?;
            Output::Stdout.write(&json)?;
        } else if task.faults.is_empty() {
            Output::tell(&format!("{}: ok\n", file.display()))?;
        }
    }
    Ok(match sound {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(WRONG_INPUT),
    })
}

/// Prints an expanded task file; true if it has no faults.
fn expand(reader: &TaskReader, file: &Path) -> Result<bool, Failure> {
    let task = match reader.expand(file) {
        Ok(task) => task,
        Err(error) => {
            say(error);
            return Ok(false);
        }
    };
    for fault in &task.faults {
        say(fault);
    }
    Output::Stdout.write(task.text.as_bytes())?;
    Ok(task.faults.is_empty())
}
