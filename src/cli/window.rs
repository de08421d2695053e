//! The window, and what is done where none can be opened.

use std::{path::PathBuf, process::ExitCode};

use clap::Args;

use super::{Failure, Output, run};

#[derive(Args)]
pub(super) struct WindowArgs {
    /// The task file to begin with
    #[arg(long, value_name = "FILE", default_value = super::DEFAULT_SETUP)]
    setup: PathBuf,
    /// Save a picture of the window to this PNG file, and quit
    #[arg(long, value_name = "FILE")]
    screenshot: Option<PathBuf>,
    /// When to take the picture, in seconds of simulated time
    #[arg(long, value_name = "S", default_value = "1", value_parser = run::seconds, requires = "screenshot")]
    after: f64,
}

#[cfg(feature = "window")]
pub(super) fn open(args: WindowArgs) -> Result<ExitCode, Failure> {
    use tabletop::window::{ScreenshotAt, WindowOptions};

    let options = WindowOptions {
        setup: args.setup.clone(),
        screenshot: args.screenshot.map(|path| ScreenshotAt {
            path,
            seconds: args.after as f32,
        }),
    };
    match tabletop::window::run(options) {
        Ok(bevy::app::AppExit::Success) => Ok(ExitCode::SUCCESS),
        Ok(bevy::app::AppExit::Error(code)) => Ok(ExitCode::from(code.get())),
        Err(no_window) => {
            eprintln!("tabletop: {no_window}");
            run_instead(args.setup)
        }
    }
}

#[cfg(not(feature = "window"))]
pub(super) fn open(args: WindowArgs) -> Result<ExitCode, Failure> {
    eprintln!("tabletop: this program was built without a window (feature `window`)");
    run_instead(args.setup)
}

/// What the window would have shown after ten seconds, as a table.
fn run_instead(setup: PathBuf) -> Result<ExitCode, Failure> {
    eprintln!(
        "tabletop: running {} for 10 s without a window",
        setup.display()
    );
    run::simulate(&setup, 10.0, Some(&Output::Stdout))
}
