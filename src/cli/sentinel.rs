//! `tabletop sentinel`: the process beside one that drives a real robot, for robots that keep their speed when that one is killed. It is started by it, and
//! by nobody else.

use std::{
    io::{Write as _, stdin, stdout},
    path::PathBuf,
    process::ExitCode,
};

use clap::Args;

use crate::{
    bridge::{Address, keep_watch},
    real::find_interface,
};

use super::Failure;

#[derive(Args)]
pub(super) struct SentinelArgs {
    /// The robot
    address: Address,
    /// The folder with its bridge.ron, if it is not inside the program
    #[arg(long, value_name = "FOLDER")]
    folder: Option<PathBuf>,
    /// A limb that is driven [default: all]
    #[arg(long = "limb", value_name = "LIMB")]
    limbs: Vec<String>,
}

/// Waits for the end of standard input.
pub(super) fn run(args: &SentinelArgs) -> Result<ExitCode, Failure> {
    let profile = find_interface(&args.address, args.folder.as_deref());
    let profile = profile.map_err(Failure::input)?;
    let ready = || {
        let mut output = stdout();
        output.write_all(b"ready\n")?;
        output.flush()
    };
    keep_watch(&args.address, &profile, &args.limbs, stdin().lock(), ready)
        .map_err(Failure::run)?;
    Ok(ExitCode::SUCCESS)
}
