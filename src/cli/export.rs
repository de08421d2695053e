//! `tabletop export`: recordings as datasets of other tools.

use std::{
    ffi::OsString,
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
    thread,
    time::Instant,
};

use clap::{Args, ValueEnum};
use tabletop::{
    export::{
        ActionKind, DatasetFormat, EpisodeSelection, ExportError, ExportSummary, LeRobot, Matlab,
        Mcap, Robomimic, StateKind, export,
    },
    recorder::RecordingReader,
};

use super::{
    Failure, Output, cut_off::say_if_cut_off, progress::ProgressLine, range::NumberRange,
    terminal::show_warnings,
};

#[derive(Args)]
pub(super) struct ExportArgs {
    /// Folders of recordings, or folders that hold them, as `multiply` makes them
    #[arg(value_name = "DIR", required = true)]
    recordings: Vec<PathBuf>,
    /// The format, and the folder or file to write, to which further exports add episodes: `lerobot` (LeRobotDataset v3.0, a folder),
    /// `robomimic` (an HDF5 file), `mcap` or `mat` (a folder with a file an episode, for Foxglove and Rerun, or MATLAB)
    #[arg(long, value_names = ["FORMAT", "OUT"], num_args = 2, required = true)]
    to: Vec<OsString>,
    /// The state of a frame [default: objects; with the robot if it moves]
    #[arg(long, value_name = "KIND")]
    state: Option<StateChoice>,
    /// The action of a frame [default: hands; joints if the robot moves]
    #[arg(long, value_name = "KIND")]
    action: Option<ActionChoice>,
    /// Leave out the columns with the parts of the task, which LeRobot reads from version 0.6 on
    #[arg(long)]
    no_language: bool,
    /// Number of recordings read at a time, from 1 to 256 [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = JOBS, allow_negative_numbers = true)]
    jobs: Option<usize>,
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
}

/// Exports the recordings.
pub(super) fn run(args: &ExportArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    let [format, out] = &args.to[..] else {
        return Err(Failure::input("--to takes a format and a place"));
    };
    let recordings = found(&args.recordings)?;
    for recording in &recordings {
        let recording = RecordingReader::open(recording).map_err(Failure::input)?;
        say_if_cut_off(&recording, "exported");
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
        Some("mat") => args.export(&recordings, Matlab::open(out).map_err(failed)?),
        _ => {
            let format = format.display();
            return Err(Failure::input(format!(
                "there is no format {format}; expected lerobot, robomimic, mcap or mat"
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
            }),
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

/// The recordings in these folders: each of them, or those in it, numbers in their order.
fn found(folders: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let is_recording = |folder: &Path| folder.join("session.jsonl").exists();
    let mut all = Vec::new();
    for folder in folders {
        if is_recording(folder) {
            all.push(folder.clone());
            continue;
        }
        let entries = fs::read_dir(folder)
            .map_err(|error| Failure::input(format!("{}: {error}", folder.display())))?;
        let mut inner: Vec<_> = entries
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| is_recording(path))
            .filter(|path| !name_of(path).starts_with('.'))
            .collect();
        if inner.is_empty() {
            return Err(Failure::input(format!(
                "{}: neither a recording nor a folder of recordings",
                folder.display()
            )));
        }
        inner.sort_by_key(|path| {
            let name = name_of(path);
            (name.parse().unwrap_or(u64::MAX), name)
        });
        all.extend(inner);
    }
    Ok(all)
}

fn name_of(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into()
}
