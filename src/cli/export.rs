//! `tabletop export`: recordings as datasets of other tools.

use std::{ffi::OsString, path::PathBuf, process::ExitCode, thread, time::Instant};

use crate::{
    core::TICKS_PER_SECOND,
    export::{
        DatasetFormat, ExportError, ExportSummary, LeRobot, Matlab, Mcap, Rlds, Robomimic, export,
    },
    recorder::RecordingReader,
    training::{ActionKind, EpisodeSelection, PictureSelection, StateKind},
};
use clap::{Args, ValueEnum};

use super::{
    Failure, Output,
    allowed_paths::AllowedPaths,
    cameras::{Cameras, any_cameras},
    counted::counted,
    cut_off::say_if_cut_off,
    picture_size::picture_size,
    progress::ProgressLine,
    range::NumberRange,
    recordings::recordings_in,
    result_file::require_outside,
    terminal::show_warnings,
    wait::WaitOption,
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
    /// the table, the point that they look at, in units of 10 cm: `side=14,0,8` or `side=14,0,8,0,0,1`; or `none` [default: as recorded]
    #[arg(long, value_name = "LIST", value_parser = any_cameras)]
    cameras: Option<Cameras>,
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
    /// Add the parts of the task and other words for it to a LeRobot dataset, in columns that LeRobot reads from version 0.6 on and that no plain
    /// DataLoader collates. The program that a recording means (docs/task-programs.md) is among the words
    #[arg(long)]
    language: bool,
    /// Number of recordings read at a time, from 1 to 256 [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = JOBS, allow_negative_numbers = true)]
    jobs: Option<usize>,
    #[command(flatten)]
    wait: WaitOption,
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
    for (option, is_asked, what) in [
        ("--video", args.video, "videos"),
        ("--language", args.language, "language columns"),
    ] {
        if is_asked && format != "lerobot" {
            return Err(Failure::input(format!(
                "{option} goes with --to lerobot: no other format has {what}"
            )));
        }
    }
    let out = PathBuf::from(out);
    let read: Vec<_> = recordings.iter().map(PathBuf::as_path).collect();
    require_outside(&out, &read)?;
    let storage = args.wait.storage();
    let start = Instant::now();
    let summary = match format.to_str() {
        Some("lerobot") => {
            let dataset = LeRobot::open(out, &storage).map_err(failed)?;
            let dataset = match args.language {
                true => dataset.with_language(),
                false => dataset,
            };
            let has_program = dataset.has_language();
            args.export(&recordings, dataset, has_program)
        }
        Some("robomimic") => {
            let file = Robomimic::open(out, &storage).map_err(failed)?;
            args.export(&recordings, file, false)
        }
        Some("mcap") => args.export(
            &recordings,
            Mcap::open(out, &storage).map_err(failed)?,
            false,
        ),
        Some("rlds") => args.export(
            &recordings,
            Rlds::open(out, &storage).map_err(failed)?,
            false,
        ),
        Some("mat") => args.export(
            &recordings,
            Matlab::open(out, &storage).map_err(failed)?,
            false,
        ),
        _ => {
            let format = format.display();
            return Err(Failure::input(format!(
                "there is no format {format}; expected lerobot, robomimic, rlds, mcap or mat"
            )));
        }
    }?;
    Output::tell(&reported(summary, start.elapsed().as_secs_f64()))?;
    Ok(ExitCode::SUCCESS)
}

impl ExportArgs {
    fn export<F: DatasetFormat>(
        &self,
        recordings: &[PathBuf],
        format: F,
        has_program: bool,
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
                cameras: self.cameras.clone().map(|Cameras(cameras)| cameras),
                has_video: self.video,
                has_depth: self.depth,
                has_ids: self.ids,
            },
            has_program,
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
    let (episodes, frames) = (counted(episodes, "episode"), counted(frames, "frame"));
    format!("{episodes}, {frames}; {rate:.0} frames a second.\n")
}
