//! The command line of each engine.

use std::{
    path::{MAIN_SEPARATOR, Path, absolute},
    process::Command,
};

use crate::{
    config::{EngineConfig, Trigger},
    kind::EngineKind,
    worker::exchange_folder::ExchangeFolder,
};

/// The command that starts an engine.
pub(crate) fn command(config: &EngineConfig, session: &ExchangeFolder) -> Result<Command, String> {
    let mut command = Command::new(&config.engine.program);
    command.current_dir(&config.working_dir);
    let poll = || {
        format!(
            "{} tabletop_poll({}); exit",
            preparation(config, session),
            quoted(session.folder())
        )
    };
    match (config.engine.kind, config.trigger) {
        (EngineKind::Octave, trigger) => {
            command.args(["-q", "--no-history"]);
            if config
                .engine
                .program
                .file_stem()
                .is_some_and(|name| name == "octave")
            {
                command.arg("--no-gui");
            }
            if trigger == Trigger::Poll {
                command.args(["--eval", &poll()]);
            }
        }
        (EngineKind::Matlab, Trigger::Poll) => {
            let window = if cfg!(windows) { "-wait" } else { "-nodesktop" };
            command.args(["-nosplash", window, "-r", &poll()]);
        }
        (EngineKind::Python, Trigger::Stdin) => {
            command.args([
                "-u".as_ref(),
                session.driver().join("tabletop_driver.py").as_os_str(),
            ]);
            command.arg(session.folder());
        }
        (EngineKind::Driver, Trigger::Stdin) => {
            command.arg(session.folder());
        }
        (EngineKind::Matlab, Trigger::Stdin) => {
            return Err("MATLAB cannot be driven by its standard input".into());
        }
        (EngineKind::Python | EngineKind::Driver, Trigger::Poll) => {
            return Err(format!("{} does not poll", config.engine.kind));
        }
    }
    Ok(command)
}

/// The first commands to MATLAB and Octave. The user's own startup file may have gone to another folder, and where it waits for
/// keys it takes some of the spaces. Functions that the driver shadows are not reported.
pub(crate) fn preparation(config: &EngineConfig, session: &ExchangeFolder) -> String {
    let home = absolute(&config.working_dir).unwrap_or_else(|_| config.working_dir.clone());
    format!(
        "        if exist('OCTAVE_VERSION', 'builtin'), warning('off', 'Octave:shadowed-function'); end, addpath({}); cd({});",
        quoted(&session.driver()),
        quoted(&home)
    )
}

/// A folder as a Matlab text, with a separator at its end.
pub(crate) fn quoted(folder: &Path) -> String {
    let mut folder = folder.to_string_lossy().replace('\'', "''");
    folder.push(MAIN_SEPARATOR);
    format!("'{folder}'")
}
