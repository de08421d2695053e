//! `tabletop list`: the recordings of folders.

use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
    process::ExitCode,
};

use crate::{recorder::RecordingReader, task::Furniture};
use clap::Args;
use serde_json::json;

use super::{
    Failure,
    explain::{print, print_json, read, reported},
    quiet::seconds_of,
    recordings::recordings_in,
    terminal::show_warnings,
};

#[derive(Args)]
pub(super) struct ListArgs {
    /// Recordings, or folders that hold them
    #[arg(value_name = "DIR", required = true)]
    folders: Vec<PathBuf>,
    /// Print a JSON array: name, seconds and sentences of each
    #[arg(long)]
    json: bool,
}

/// A recording in the list.
struct Listed {
    name: String,
    seconds: f64,
    sentences: Vec<String>,
}

/// Lists recordings, a line each: folder, seconds, and what is done.
pub(super) fn list(args: &ListArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    let recordings = recordings_in(&args.folders)?;
    let listed = recordings.iter().map(|folder| Listed::read(folder));
    let listed = listed.collect::<Result<Vec<_>, _>>()?;
    if args.json {
        let rows = listed.iter().map(
            |it| json!({ "recording": it.name, "seconds": it.seconds, "sentences": it.sentences }),
        );
        return print_json(&rows.collect());
    }
    let width = listed.iter().map(|it| it.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for Listed {
        name,
        seconds,
        sentences,
    } in &listed
    {
        let shown = match sentences.is_empty() {
            true => "Nothing is moved for good.".into(),
            false => sentences.join(" "),
        };
        let _infallible = writeln!(text, "{name:<width$}  {seconds:>7.1} s  {shown}");
    }
    print(&text)
}

impl Listed {
    fn read(folder: &Path) -> Result<Self, Failure> {
        let recording = RecordingReader::open(folder).map_err(Failure::input)?;
        let (task, _) = read(folder, &Furniture::default())?;
        Ok(Self {
            name: folder.display().to_string(),
            seconds: seconds_of(&recording),
            sentences: reported(&task),
        })
    }
}
