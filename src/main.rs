//! The program.

use std::{env, process::ExitCode};

fn main() -> ExitCode {
    tabletop::cli::main(env::args_os())
}
