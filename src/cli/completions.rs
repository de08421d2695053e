//! `tabletop completions`: scripts with which shells complete commands and options.

use std::process::ExitCode;

use clap::{Args, Command};
use clap_complete::{Shell, generate};

use super::{Failure, Output};

#[derive(Args)]
pub(super) struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

pub(super) fn completions(
    args: &CompletionsArgs,
    commands: &mut Command,
) -> Result<ExitCode, Failure> {
    let mut script = Vec::new();
    generate(args.shell, commands, "tabletop", &mut script);
    Output::Stdout.write(&script)?;
    Ok(ExitCode::SUCCESS)
}
