//! The keys of the window, as a list for people or as a file to change.

use std::{fmt::Write as _, path::PathBuf, process::ExitCode};

use crate::core::RobotLayout;
use crate::user::Keymap;
use clap::Args;
use tabletop_gui::{Preferences, keymap_file};

use super::{Failure, Output, WRONG_INPUT, robot_options::describe, terminal::say};

#[derive(Args)]
pub(super) struct KeysArgs {
    /// The keys that this file binds, instead of keys.ron in the folder of the preferences
    #[arg(long, value_name = "FILE")]
    keys: Option<PathBuf>,
    /// Print a complete file to change and to keep as keys.ron
    #[arg(long)]
    ron: bool,
    /// The robot whose joints the keys move: a robot.ron, or a URDF with Baxter's limbs and joints [default: Baxter]
    #[arg(long, value_name = "FILE")]
    robot: Option<PathBuf>,
}

/// Lists the keys, after the faults of the file that binds them.
pub(super) fn list(args: &KeysArgs) -> Result<ExitCode, Failure> {
    let preferences = Preferences::default();
    let layout = match &args.robot {
        Some(robot) => describe(robot)?.layout,
        None => RobotLayout::default(),
    };
    let (keymap, faults) = keymap_file::read(args.keys.as_deref(), &preferences, &layout);
    faults.iter().for_each(say);
    let text = match args.ron {
        true => keymap_file::write(&keymap),
        false => table(&keymap, &preferences),
    };
    Output::tell(&text)?;
    Ok(match faults.is_empty() {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(WRONG_INPUT),
    })
}

fn table(keymap: &Keymap, preferences: &Preferences) -> String {
    let mut text = String::new();
    for (group, name) in keymap.groups() {
        let _infallible = writeln!(text, "{name}");
        for action in keymap.actions_of(group) {
            let (keys, name) = (keymap.hint(action), action.to_string());
            let what = keymap.description(action);
            let _infallible = writeln!(text, "  {keys:<24}{name:<26}{what}");
        }
        text.push('\n');
    }
    text.push_str(
        "Keys are named by their places on a US keyboard, whatever is printed on them.\n",
    );
    if let Some(path) = preferences.file("keys") {
        let reported = match path.exists() {
            true => format!("Yours are in {}.", path.display()),
            false => format!(
                "To bind others: tabletop keys --ron > {}, and edit that file.",
                path.display()
            ),
        };
        let _infallible = writeln!(text, "{reported}");
    }
    text
}
