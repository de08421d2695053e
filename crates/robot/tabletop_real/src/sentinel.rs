//! The command of the process that brings a real robot to rest if this program is killed.

use std::{env, io, path::Path, process::Command};

use tabletop_bridge::Address;

/// The command `tabletop sentinel` of this very program, for some limbs of a robot, or all if none is named; the folder is that of its description.
///
/// # Errors
/// This program does not know where it is.
pub fn sentinel_command(
    address: &Address,
    folder: Option<&Path>,
    limbs: &[String],
) -> io::Result<Command> {
    let mut command = Command::new(env::current_exe()?);
    command.args(["sentinel", &address.to_string()]);
    if let Some(folder) = folder {
        command.arg("--folder").arg(folder);
    }
    for limb in limbs {
        command.args(["--limb", limb]);
    }
    Ok(command)
}
