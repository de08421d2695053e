//! The window, and the run that replaces it where none can be opened.

use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use crate::{
    replay::Replay,
    script::ScriptSettings,
    shipped::{read_faultless_task, task_reader},
};
use clap::Args;

use super::{
    Failure, Output, WRONG_INPUT,
    allowed_paths::AllowedPaths,
    duration::SECONDS,
    range::SEEDS,
    robot_options::{EngineOptions, RobotOptions, script},
    run,
    terminal::say,
};

#[derive(Args)]
pub(super) struct WindowArgs {
    /// The task file to begin with
    #[arg(long, value_name = "FILE", default_value = run::DEFAULT_SETUP)]
    setup: PathBuf,
    #[command(flatten)]
    allowed: AllowedPaths,
    /// The file that binds keys, instead of keys.ron in the folder of the preferences; see `tabletop keys`
    #[cfg(feature = "window")]
    #[arg(long, value_name = "FILE")]
    keys: Option<PathBuf>,
    /// The seed of the colours and places of presets, from 0 to 18446744073709551615
    #[arg(long, value_name = "N", default_value = "5566", value_parser = SEEDS, allow_negative_numbers = true)]
    seed: u64,
    /// Save a picture of the window to this PNG file, and quit
    #[arg(long, value_name = "FILE")]
    screenshot: Option<PathBuf>,
    /// When to take the picture, from 0 to 31622400 seconds of simulated time
    #[arg(long, value_name = "S", default_value = "1", value_parser = SECONDS, allow_negative_numbers = true, requires = "screenshot")]
    after: f64,
    /// The scripts that the key M starts: `matlab` (those that matlab/agentBehavior.m names), `matlab:FOLDER`, `octave:FOLDER`,
    /// `matlab:FOLDER#reach` (reachInit.m and reachCallback.m), `python:FILE`, or `other:FILE`, which the driver runs that `--engine` names
    #[arg(long, value_name = "LANGUAGE[:PATH][#PAIR]", value_parser = script)]
    script: Option<String>,
    #[command(flatten)]
    engine: EngineOptions,
    #[command(flatten)]
    robot: RobotOptions,
    #[cfg(feature = "window")]
    #[command(flatten)]
    real: super::real::RealOptions,
    #[cfg(feature = "window")]
    #[command(flatten)]
    hand_cameras: super::hand_cameras::HandCameraOption,
    /// Keep a list of the widgets on the screen in this file, a line each with its name and place, for programs that click
    #[cfg(feature = "window")]
    #[arg(long, value_name = "FILE")]
    widgets: Option<PathBuf>,
    /// Write every command and every fact of the simulation to the console
    #[cfg(feature = "window")]
    #[arg(long)]
    debug: bool,
    #[cfg(feature = "window")]
    #[command(flatten)]
    display: super::display::DisplayArgs,
}

impl WindowArgs {
    /// Reads the files that are named, before there is a window. Faults of the task file are reported in the window and do not close it, but
    /// a picture of the rest of the scene gives exit code 2.
    fn read_files(&self) -> Result<ExitCode, Failure> {
        #[cfg(feature = "window")]
        if let Some(keys) = &self.keys {
            tabletop_gui::keymap_file::read_text(keys).map_err(Failure::input)?;
        }
        let reader = task_reader().allowing(&self.allowed.folders);
        let task = reader.read(&self.setup).map_err(Failure::input)?;
        Ok(match task.faults.is_empty() || self.screenshot.is_none() {
            true => ExitCode::SUCCESS,
            false => ExitCode::from(WRONG_INPUT),
        })
    }
}

#[cfg(feature = "window")]
impl WindowArgs {
    /// The table with which the window begins.
    fn table(&self) -> Result<crate::core::Table, Failure> {
        let reader = task_reader().allowing(&self.allowed.folders);
        let task = reader.read(&self.setup).map_err(Failure::input)?;
        Ok(task.scene.table)
    }
}

#[cfg(feature = "window")]
pub(super) fn open(args: WindowArgs) -> Result<ExitCode, Failure> {
    use crate::window::{self, Connected, ScreenshotAt, Show, WindowOptions};

    let result = args.read_files()?;
    let mut display = args.display.options();
    if args.screenshot.is_some() {
        display.ask.get_or_insert(false);
    }
    let robot = args.real.body(args.robot.plugin()?)?;
    let takes_picture = args.screenshot.is_some();
    let real = args.real.connect(&robot, &args.table()?)?;
    let address = args.real.address().map(ToString::to_string);
    let real = real.zip(address);
    let real = real.map(|(robot, address)| Connected { address, robot });
    let options = WindowOptions {
        show: Show::Task(args.setup.clone()),
        allowed: args.allowed.folders.clone(),
        hand_pictures: args.hand_cameras.of(&robot)?,
        robot,
        show_robot: args.robot.show_robot || real.is_some(),
        scripts: args.engine.settings(args.script.as_deref())?,
        display,
        keys: args.keys,
        seed: args.seed,
        screenshot: args.screenshot.map(|path| ScreenshotAt {
            path,
            seconds: args.after as f32,
        }),
        widgets: args.widgets,
        is_verbose: args.debug,
    };
    match window::run_beside(options, real) {
        Ok(exit) => Ok(exit_code(exit, result)),
        Err(no_window) if takes_picture => Err(Failure::run(no_window)),
        Err(no_window) => {
            say(format_args!("tabletop: {no_window}"));
            run_instead(&args.setup, &args.allowed.folders)
        }
    }
}

/// Plays a recording.
#[cfg(feature = "window")]
pub(super) fn play(
    replay: Replay,
    scripts: ScriptSettings,
    allowed: Vec<PathBuf>,
) -> Result<ExitCode, Failure> {
    use crate::{
        recorder::HandPictures,
        robot::RobotPlugin,
        window::{self, DisplayOptions, Show, WindowOptions},
    };

    let options = WindowOptions {
        show: Show::Replay(Box::new(replay)),
        allowed,
        hand_pictures: HandPictures::default(),
        robot: RobotPlugin::default(),
        show_robot: false,
        scripts,
        display: DisplayOptions {
            ask: Some(false),
            ..DisplayOptions::default()
        },
        keys: None,
        seed: window::DEFAULT_SEED,
        screenshot: None,
        widgets: None,
        is_verbose: false,
    };
    let exit = window::run(options).map_err(Failure::run)?;
    Ok(exit_code(exit, ExitCode::SUCCESS))
}

/// The exit code of a window, which is this one if nothing has failed in it.
#[cfg(feature = "window")]
fn exit_code(exit: bevy::app::AppExit, result: ExitCode) -> ExitCode {
    match exit {
        bevy::app::AppExit::Success => result,
        bevy::app::AppExit::Error(code) => ExitCode::from(code.get()),
    }
}

#[cfg(not(feature = "window"))]
const NO_WINDOW: &str = "this program was built without a window (feature `window`)";

#[cfg(not(feature = "window"))]
pub(super) fn open(args: WindowArgs) -> Result<ExitCode, Failure> {
    args.read_files()?;
    args.robot.plugin()?;
    args.engine.settings(args.script.as_deref())?;
    if args.screenshot.is_some() {
        return Err(Failure::run(NO_WINDOW));
    }
    say(format_args!("tabletop: {NO_WINDOW}"));
    run_instead(&args.setup, &args.allowed.folders)
}

#[cfg(not(feature = "window"))]
pub(super) fn play(_: Replay, _: ScriptSettings, _: Vec<PathBuf>) -> Result<ExitCode, Failure> {
    Err(Failure::run(NO_WINDOW))
}

/// The state that the window would have shown after ten seconds, as a table.
fn run_instead(setup: &Path, allowed: &[PathBuf]) -> Result<ExitCode, Failure> {
    let scene = read_faultless_task(setup, allowed).map_err(Failure::input)?;
    say(format_args!(
        "tabletop: running {} for 10 s without a window",
        setup.display()
    ));
    run::simulate(scene, 10.0, &Output::Stdout)
}
