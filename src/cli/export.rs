//! `tabletop export`: recordings as datasets of other tools.

use std::{ffi::OsString, path::PathBuf, process::ExitCode, thread, time::Instant};

use crate::{
    core::TICKS_PER_SECOND,
    export::{
        ActionKind, DatasetFormat, EpisodeSelection, ExportError, ExportSummary, LeRobot, Matlab,
        Mcap, PictureSelection, Rlds, Robomimic, StateKind, export,
    },
    recorder::RecordingReader,
};
use clap::{Args, ValueEnum};

use super::{
    Failure, Output,
    allowed_paths::AllowedPaths,
    cut_off::say_if_cut_off,
    film_camera::{FilmCameras, cameras},
    picture_size::picture_size,
    progress::ProgressLine,
    range::NumberRange,
    recordings::recordings_in,
    terminal::show_warnings,
};

#[derive(Args)]
pub(super) struct ExportArgs {
    /// Folders of recordings, or folders that hold them, as `multiply` makes them
    #[arg(value_name = "DIR", required = true)]
    recordings: Vec<PathBuf>,
    /// The format, and the folder or file to write, to which further exports add episodes: `lerobot` (LeRobotDataset v3.0, a folder),
    /// `robomimic` (an HDF5 file), `rlds` (a folder, for TensorFlow Datasets), `mcap` or `mat` (a folder with a file an episode, for Foxglove and Rerun, or MATLAB)
    #[arg(long, value_names = ["FORMAT", "OUT"], num_args = 2, required = true)]
    to: Vec<OsString>,
    /// The state of a frame [default: objects; with the robot if it moves]
    #[arg(long, value_name = "KIND")]
    state: Option<StateChoice>,
    /// The action of a frame [default: hands; joints if the robot moves]
    #[arg(long, value_name = "KIND")]
    action: Option<ActionChoice>,
    /// Pictures a second: 1, 2, 3, 4, 5, 6, 10, 12, 15, 20, 30 or 60 [default: the recorded 4]
    #[arg(long, value_name = "N", value_parser = picture_rate, allow_negative_numbers = true)]
    fps: Option<u32>,
    /// The size of pictures, with sides from 1 to 8192 pixels, and 16777216 pixels at most [default: as recorded]
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = picture_size)]
    size: Option<(u32, u32)>,
    /// The cameras, separated by commas: `head`, hand cameras such as `left_hand`, and names with a location and, if it is not the centre of
    /// the table, the point that they look at, in units of 10 cm: `side=14,0,8` or `side=14,0,8,0,0,1` [default: as recorded]
    #[arg(long, value_name = "LIST", value_parser = cameras)]
    cameras: Option<FilmCameras>,
    /// Write the pictures of a LeRobot dataset as videos (AV1), which are smaller and not quite the same
    #[arg(long)]
    video: bool,
    /// Add the distance of each pixel, in m
    #[arg(long)]
    depth: bool,
    /// Add the number of the thing at each pixel: 0 nothing, 1 the table, n + 1 the n-th object, 65535 anything else
    #[arg(long)]
    ids: bool,
    #[command(flatten)]
    allowed: AllowedPaths,
    /// Leave out the columns with the parts of the task, which LeRobot reads from version 0.6 on
    #[arg(long)]
    no_language: bool,
    /// Number of recordings read at a time, from 1 to 256 [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = JOBS, allow_negative_numbers = true)]
    jobs: Option<usize>,
}

/// Reads a number of pictures a second.
fn picture_rate(text: &str) -> Result<u32, String> {
    let rate = text.parse().ok();
    rate.filter(|rate| *rate > 0 && TICKS_PER_SECOND.is_multiple_of(*rate))
        .ok_or_else(|| "expected 1, 2, 3, 4, 5, 6, 10, 12, 15, 20, 30 or 60".into())
}

const JOBS: NumberRange<usize> = NumberRange::whole(1, 256);

#[derive(Clone, Copy, ValueEnum)]
enum StateChoice {
    /// Positions of the robot's joints
    Robot,
    /// Poses of objects, and places and grips of hands
    Objects,
    /// Those of the robot, then those of the objects
    Both,
}

#[derive(Clone, Copy, ValueEnum)]
enum ActionChoice {
    /// The motion of each hand until the next frame, and whether it holds something then
    Hands,
    /// The positions of the robot's joints in the next frame
    Joints,
    /// The motion of each end effector until the next frame, and the opening of its gripper then
    EndEffector,
}

/// Exports the recordings.
pub(super) fn run(args: &ExportArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    let [format, out] = &args.to[..] else {
        return Err(Failure::input("--to takes a format and a place"));
    };
    let recordings = recordings_in(&args.recordings)?;
    for recording in &recordings {
        let recording = RecordingReader::open(recording).map_err(Failure::input)?;
        say_if_cut_off(&recording, "exported");
    }
    if args.video && format != "lerobot" {
        return Err(Failure::input(
            "--video goes with --to lerobot: no other format has videos",
        ));
    }
    let out = PathBuf::from(out);
    let start = Instant::now();
    let summary = match format.to_str() {
        Some("lerobot") => {
            let dataset = LeRobot::open(out).map_err(failed)?;
            let dataset = match args.no_language {
                true => dataset.without_language(),
                false => dataset,
            };
            args.export(&recordings, dataset)
        }
        Some("robomimic") => args.export(&recordings, Robomimic::open(out).map_err(failed)?),
        Some("mcap") => args.export(&recordings, Mcap::open(out).map_err(failed)?),
        Some("rlds") => args.export(&recordings, Rlds::open(out).map_err(failed)?),
        Some("mat") => args.export(&recordings, Matlab::open(out).map_err(failed)?),
        _ => {
            let format = format.display();
            return Err(Failure::input(format!(
                "there is no format {format}; expected lerobot, robomimic, rlds, mcap or mat"
            )));
        }
    }?;
    Output::Stdout.write(reported(summary, start.elapsed().as_secs_f64()).as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

impl ExportArgs {
    fn export<F: DatasetFormat>(
        &self,
        recordings: &[PathBuf],
        format: F,
    ) -> Result<ExportSummary, Failure> {
        let selection = EpisodeSelection {
            state: self.state.map(|state| match state {
                StateChoice::Robot => StateKind::Robot,
                StateChoice::Objects => StateKind::Objects,
                StateChoice::Both => StateKind::Both,
            }),
            action: self.action.map(|action| match action {
                ActionChoice::Hands => ActionKind::Hands,
                ActionChoice::Joints => ActionKind::Joints,
                ActionChoice::EndEffector => ActionKind::EndEffectors,
            }),
            pictures: PictureSelection {
                fps: self.fps,
                size: self.size.map(|(width, height)| [width, height]),
                cameras: self.cameras.clone().map(|FilmCameras(cameras)| cameras),
                has_video: self.video,
                has_depth: self.depth,
                has_ids: self.ids,
            },
            allowed: self.allowed.folders.clone(),
        };
        let cores = thread::available_parallelism().map_or(1, usize::from);
        let jobs = self.jobs.unwrap_or(cores);
        let mut line = ProgressLine::new(recordings.len() as u64, "");
        let result = export(recordings, &selection, format, jobs, |summary| {
            let note = format!(", {} frames", summary.frames);
            line.reach(summary.episodes as u64, &note);
        });
        line.end();
        result.map_err(failed)
    }
}

fn failed(error: ExportError) -> Failure {
    match error.is_of_input() {
        true => Failure::input(error),
        false => Failure::run(error),
    }
}

fn reported(summary: ExportSummary, seconds: f64) -> String {
    let ExportSummary { episodes, frames } = summary;
    let rate = frames as f64 / seconds.max(1e-3);
    format!("{episodes} episodes, {frames} frames; {rate:.0} frames a second.\n")
}
