//! `tabletop replay`: replays a recording.

use std::{path::PathBuf, process::ExitCode};

use crate::{
    core::{HeadCamera, SimTick, StepApp as _, TICKS_PER_SECOND},
    geometry::Pose,
    headless_app_with,
    recorder::{Channels, RecorderPlugin, whole_recording},
    replay::{Player, Replay, ReplayError},
    script::ScriptPlugin,
    storage::Storage,
};
use bevy::{math::Vec3, prelude::*};
use clap::Args;

use super::{
    Failure,
    allowed_paths::AllowedPaths,
    cameras::{ANGLES_OF_VIEW, COORDINATES},
    cut_off::say_if_cut_off,
    duration::{SECONDS, ticks},
    hand_cameras::HandCameraOption,
    picture_size::picture_size,
    progress::ProgressLine,
    quiet::QuietOption,
    recorded::say_moved_aside,
    result_file::require_outside,
    robot_options::{EngineOptions, script},
    script::{Script, headless_settings},
    terminal::{say, show_warnings},
    window,
};

/// Number of simulated seconds from which on the length of a replay is said.
const LONG: u64 = 3600;

#[derive(Args)]
#[command(mut_group("EngineOptions", |options| options.requires("script")))]
pub(super) struct ReplayArgs {
    /// The recording
    #[arg(value_name = "DIR")]
    recording: PathBuf,
    /// Compare every state and picture with the recorded ones; exit code 1 with the first difference
    #[arg(long)]
    verify: bool,
    /// Play it in the window
    #[arg(long, conflicts_with_all = ["verify", "out"])]
    window: bool,
    /// Keep the recording of the replay here
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    pictures: PictureArgs,
    #[command(flatten)]
    allowed: AllowedPaths,
    /// Let a script watch, as `tabletop run --script` lets it act; in the window the key M starts it
    #[arg(long, value_name = "LANGUAGE[:PATH]", value_parser = script, conflicts_with_all = ["verify", "out"])]
    script: Option<String>,
    /// Time for which the script then acts, from 0 to 31622400 seconds of simulated time [default: 0]
    #[arg(long, value_name = "S", value_parser = SECONDS, allow_negative_numbers = true, requires = "script", conflicts_with = "window")]
    seconds: Option<f64>,
    #[command(flatten)]
    engine: EngineOptions,
    #[command(flatten)]
    quiet: QuietOption,
}

/// Properties of a replay's pictures, in place of the recorded ones.
#[derive(Args)]
#[group(multiple = true, conflicts_with_all = ["verify", "window"], requires = "out")]
struct PictureArgs {
    /// Make the pictures again at another size, with sides from 1 to 8192 pixels, and 16777216 pixels at most
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = picture_size)]
    render: Option<(u32, u32)>,
    /// Make the pictures again from another place, with coordinates from -1000 to 1000 units of 10 cm
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    camera: Option<Vec3>,
    /// The point that this camera looks at, with coordinates from -1000 to 1000 [default: the centre of the table]
    #[arg(long, value_name = "X,Y,Z", value_parser = point, requires = "camera", allow_hyphen_values = true)]
    look_at: Option<Vec3>,
    /// Make the pictures again with this angle of view from top to bottom, from 1 to 179 degrees
    #[arg(long, value_name = "DEGREES", value_parser = ANGLES_OF_VIEW, allow_negative_numbers = true)]
    fov: Option<f32>,
    /// Add the pictures of the cameras in the robot's hands
    #[arg(long)]
    hand_cameras: bool,
    /// Write a 16-bit PNG file of distances beside each picture
    #[arg(long)]
    depth: bool,
    /// Write a 16-bit PNG file of the objects' numbers beside each picture
    #[arg(long)]
    ids: bool,
}

/// Reads a point such as `0,-8,12.5`.
fn point(text: &str) -> Result<Vec3, String> {
    let coordinates = text
        .split(',')
        .map(|number| COORDINATES.read(number.trim()));
    let coordinates: Result<Vec<f32>, _> = coordinates.collect();
    coordinates
        .ok()
        .and_then(|coordinates| <[f32; 3]>::try_from(coordinates).ok())
        .map(Vec3::from)
        .ok_or_else(|| format!("expected three numbers {COORDINATES}, such as 0,-8,12.5"))
}

pub(super) fn run(args: &ReplayArgs) -> Result<ExitCode, Failure> {
    let replay = Replay::read_allowing(&args.recording, &args.allowed.folders);
    let replay = replay.map_err(Failure::input)?;
    say_if_cut_off(replay.recording(), "replayed");
    if let Some(out) = &args.out {
        require_outside(out, &[&args.recording])?;
    }
    if args.window {
        let settings = args.engine.settings(args.script.as_deref())?;
        return window::play(replay, settings, args.allowed.folders.clone());
    }
    show_warnings();
    if let Some(script) = &args.script {
        return watch(&replay, script, args);
    }
    say_if_long(&replay);
    let mut progress = ProgressLine::new(in_seconds(replay.ticks()), " simulated s");
    let mut goes_on = |ticks| {
        progress.reach(in_seconds(ticks), "");
        true
    };
    let mut moved = None;
    let difference = match &args.out {
        None if args.verify => replay.verify(goes_on).map_err(refused),
        None => {
            replay.simulate_while(goes_on);
            Ok(None)
        }
        Some(out) => {
            let (recorder, camera) = args.pictures.recorder(&replay, out.clone())?;
            let recorded = whole_recording(out, &Storage::default(), |folder| {
                let recorder = RecorderPlugin {
                    folder: folder.to_owned(),
                    ..recorder
                };
                let recorded = replay.record_while(recorder, camera, &mut goes_on);
                recorded.map_err(Failure::run)
            });
            recorded.and_then(|(_, moved_aside)| {
                moved = moved_aside;
                match args.verify {
                    true => replay.first_difference(out).map_err(Failure::input),
                    false => Ok(None),
                }
            })
        }
    };
    progress.end();
    say_moved_aside(&moved);
    let Some(difference) = difference? else {
        args.sum_up(&replay);
        return Ok(ExitCode::SUCCESS);
    };
    let version = match replay.program() {
        env!("CARGO_PKG_VERSION") => String::new(),
        other => format!(" (it was recorded with version {other})"),
    };
    Err(Failure::run(format!(
        "the replay differs: {difference}{version}"
    )))
}

impl ReplayArgs {
    /// Says what was done.
    fn sum_up(&self, replay: &Replay) {
        let seconds = replay.ticks() as f64 / f64::from(TICKS_PER_SECOND);
        let folder = self.recording.display();
        if self.verify {
            self.quiet.sum_up(format_args!(
                "{folder}: {seconds:.1} s replayed, the same to the byte"
            ));
        } else if self.out.is_none() {
            self.quiet.sum_up(format_args!(
                "{folder}: {seconds:.1} s replayed; --verify compares them with the recording"
            ));
        }
        if let Some(out) = &self.out {
            self.quiet.sum_up_recording(out);
        }
    }
}

/// Lets a script watch, and then act.
fn watch(replay: &Replay, script: &str, args: &ReplayArgs) -> Result<ExitCode, Failure> {
    let settings = headless_settings(&args.engine, Some(script))?;
    let plugins = replay.plugins().disable::<RecorderPlugin>();
    let mut app = headless_app_with(plugins.set(ScriptPlugin { settings }));
    replay.play_in(&mut app);
    let start = app.world().resource::<Player>().start();
    while *app.world().resource::<SimTick>() < start {
        app.step(1);
    }
    let mut script = Script::start(&mut app, true);
    script.run_while(&mut app, |app| !app.world().resource::<Player>().is_over())?;
    let acted = script.act(&mut app, ticks(args.seconds.unwrap_or(0.0)));
    acted.and(Ok(ExitCode::SUCCESS))
}

/// The failure of a replay that cannot be recorded, or of a recording that cannot be read.
fn refused(error: ReplayError) -> Failure {
    match error {
        ReplayError::Record(_) => Failure::run(error),
        ReplayError::Session(_)
        | ReplayError::NoBeginning { .. }
        | ReplayError::Imported { .. }
        | ReplayError::Settings { .. }
        | ReplayError::Io { .. } => Failure::input(error),
    }
}

/// Says of a replay that takes long how long it is.
fn say_if_long(replay: &Replay) {
    let seconds = in_seconds(replay.ticks());
    if seconds >= LONG {
        let (folder, hours) = (replay.folder().display(), seconds as f64 / 3600.0);
        say(format_args!(
            "tabletop: {folder}: {hours:.1} hours of simulated time are replayed"
        ));
    }
}

fn in_seconds(ticks: u64) -> u64 {
    ticks / u64::from(TICKS_PER_SECOND)
}

impl PictureArgs {
    /// The recorder of a replay, and its camera.
    fn recorder(
        &self,
        replay: &Replay,
        folder: PathBuf,
    ) -> Result<(RecorderPlugin, HeadCamera), Failure> {
        let mut camera = replay.camera();
        if let Some((width, height)) = self.render {
            (camera.width, camera.height) = (width, height);
        }
        if let Some(from) = self.camera {
            let at = self.look_at.unwrap_or_default();
            if from == at {
                return Err(Failure::input("--camera and --look-at are the same point"));
            }
            camera.mount = Some(Pose::looking_at(from, at));
        }
        if let Some(degrees) = self.fov {
            camera.vertical_fov = degrees.to_radians();
        }
        let channels = Channels {
            depth: self.depth,
            ids: self.ids,
        };
        let asked = HandCameraOption {
            hand_cameras: self.hand_cameras,
        };
        let recorder = RecorderPlugin {
            folder,
            channels,
            hand_pictures: asked.of(replay.robot())?,
            ..default()
        };
        Ok((recorder, camera))
    }
}
