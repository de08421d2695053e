//! `tabletop replay`: a recording, run again.

use std::{fs, path::PathBuf, process::ExitCode};

use clap::Args;
use tabletop::{
    core::HeadCamera,
    replay::{first_difference, replay},
};

use super::Failure;

#[derive(Args)]
pub(super) struct ReplayArgs {
    /// The recording
    #[arg(value_name = "DIR")]
    recording: PathBuf,
    /// Compare every state and picture with the recorded ones; exit code 1 with the first difference
    #[arg(long)]
    verify: bool,
    /// Make the pictures again at another size
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = size, conflicts_with = "verify", requires = "out")]
    render: Option<(u32, u32)>,
    /// Keep the recording of the replay here
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Reads a picture size such as `640x480`.
fn size(text: &str) -> Result<(u32, u32), String> {
    const MOST: u32 = 8192;
    text.split_once('x')
        .and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)))
        .filter(|(width, height)| (1..=MOST).contains(width) && (1..=MOST).contains(height))
        .ok_or_else(|| format!("expected a width and a height of 1 to {MOST}, such as 640x480"))
}

pub(super) fn run(args: &ReplayArgs) -> Result<ExitCode, Failure> {
    let camera = args.render.map(|(width, height)| HeadCamera {
        width,
        height,
        ..HeadCamera::default()
    });
    let temporary = std::env::temp_dir().join(format!("tabletop-replay-{}", std::process::id()));
    let out = args.out.as_ref().unwrap_or(&temporary);
    let replayed = replay(&args.recording, out, camera).map_err(Failure::input);
    let difference = match (&replayed, args.verify) {
        (Ok(()), true) => first_difference(&args.recording, out).map_err(Failure::input),
        _ => Ok(None),
    };
    // Nothing is there if the replay could not start.
    let _ = fs::remove_dir_all(&temporary);
    replayed?;
    match difference? {
        Some(difference) => Err(Failure::run(format!("the replay differs: {difference}"))),
        None => Ok(ExitCode::SUCCESS),
    }
}
