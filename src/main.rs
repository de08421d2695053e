//! The program.

use std::{env, process::ExitCode};

fn main() -> ExitCode {
    tabletop::bridge::stop_robots_at_the_end();
    tabletop::cli::main(env::args_os())
}
