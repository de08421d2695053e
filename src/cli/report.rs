//! `tabletop report`: recordings as a page.

use std::{path::PathBuf, process::ExitCode};

use crate::{
    recorder::RecordingReader,
    report::{Chapter, OverviewRow, overview_page, recording_page},
};
use clap::Args;

use super::{
    Failure,
    counted::counted,
    cut_off::say_if_cut_off,
    progress::ProgressLine,
    quiet::QuietOption,
    recordings::recordings_in,
    result_file::{ResultFile, ResultKind},
    terminal::show_warnings,
};

#[derive(Args)]
pub(super) struct ReportArgs {
    /// Folders of recordings, or folders that hold them; and last the page, a file such as `demo.html`
    #[arg(value_names = ["DIR", "OUT"], num_args = 2.., required = true)]
    paths: Vec<PathBuf>,
    /// Replace the page that is there
    #[arg(long)]
    replace: bool,
    #[command(flatten)]
    quiet: QuietOption,
}

/// Makes the page.
pub(super) fn run(args: &ReportArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    let Some((out, folders)) = args.paths.split_last() else {
        return Err(Failure::input("expected a folder and a file"));
    };
    if out.is_dir() {
        let out = out.display();
        return Err(Failure::input(format!(
            "{out} is a folder; the last name is that of the page, such as report.html"
        )));
    }
    let page_path = out;
    let out = match args.replace {
        true => ResultFile::replacing(out, ResultKind::Page),
        false => ResultFile::new(out, ResultKind::Page),
    }?;
    let recordings = recordings_in(folders)?;
    let read = |recording: &PathBuf| {
        let reader = RecordingReader::open(recording).map_err(Failure::input)?;
        say_if_cut_off(&reader, "reported");
        Chapter::read(recording).map_err(Failure::input)
    };
    let page = match &recordings[..] {
        [recording] => recording_page(&read(recording)?),
        recordings => {
            let mut line = ProgressLine::new(recordings.len() as u64, " recordings");
            let mut rows = Vec::new();
            for recording in recordings {
                rows.push(OverviewRow::of(&read(recording)?));
                line.reach(rows.len() as u64, "");
            }
            line.end();
            overview_page(&rows)
        }
    };
    out.write(page.as_bytes())?;
    let count = counted(recordings.len(), "recording");
    args.quiet
        .sum_up(format_args!("{}: a page of {count}", page_path.display()));
    Ok(ExitCode::SUCCESS)
}
